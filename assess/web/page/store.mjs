// The page's copy of the workbook. Edits show at once and reach the server one after the other; classes, live values and
// problems come from the server after each change.

import { ApiError, connection, get, post } from "./api.mjs";
import { KeptEdits, key, same } from "./kept_edits.mjs";
import { endNotices, notice } from "./messages.mjs";
import { Sheet, cellName, shiftRow } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";

const REFUSED = new Set([400, 413, 422]);
const NAMED = 5;
const TIMES_REPEATED = 3;
const SOON_MS = 250; // between two looks for classes that have been simulated
/** What tells a request from others: one that comes again, as it was not answered, is taken once. */
const newId = () => Math.random().toString(36).slice(2);
const SEVERITIES = ["error", "warning", "note"];

class Store extends EventTarget {
  book = null;
  /** What `GET /api/book` answers where no workbook is open. */
  start = null;
  state = { version: 0, unsaved: false, save_error: "", changed_outside: false, can_undo: false, can_redo: false };
  live = new Map();
  /** The row that is being filled in, [sheet, row], or null: its problems are shown once it is left. */
  quiet = null;
  #problems = [];
  /** How many problems there are besides those. */
  moreProblems = 0;
  counts = {};
  floors = [];
  liveError = "";
  toReveal = null;
  selection = { sheet: "Items", row: 0, at: 0, rows: [] };
  #sheets = new Map();
  #byCell = new Map();
  #queue = [];
  #kept = new KeptEdits();
  #sending = null;
  #stopped = false;
  /** How far the simulation is: {state, done, of, message}. */
  simulation = { state: "done", done: 0, of: 0, message: "" };
  /** Which state of classes the page has; it changes with every version, and with every batch that was simulated. */
  stamp = null;
  #later = 0;
  #asking = null;
  #askAgain = false;
  #books = 0;

  constructor() {
    super();
    connection.addEventListener("back", () => this.resend());
  }

  // ---- the book

  /** Read the book from the server; null where none is open. */
  async load() {
    const found = await get("/api/book");
    if (found.start) this.start = found;
    this.replaceBook(found.start ? null : found);
    return this.book;
  }

  /** Take another book: the answer of `GET /api/book`, or null. What waits to be sent is dropped. */
  replaceBook(book) {
    for (const group of this.#queue) group.resolve(false);
    this.#queue = [];
    this.#stopped = false;
    this.#books += 1;
    this.#sheets = new Map((book?.sheets ?? []).map((sheet) => [sheet.name, new Sheet(sheet)]));
    if (book) book.sheets = book.sheets.map(({ rows, ...rest }) => rest); // the rows are held by the sheets now
    this.book = book;
    this.#takeLive({ version: 0, whole: true });
    this.stamp = null;
    if (book?.state?.server !== this.state.server) this.#kept = new KeptEdits();
    if (book?.state) this.state = book.state;
    this.#tell("book");
    this.takeState(this.state);
    if (book) this.refreshLive();
  }

  sheet(name) {
    return this.#sheets.get(name);
  }

  get sheets() {
    return [...this.#sheets.values()];
  }

  /** Take the state of an answer, such as that of `POST /api/save`. */
  takeState(state) {
    this.state = state;
    this.#kept.drop(this.state.saved_version);
    endNotices(this.#moment);
    this.#tell("state");
  }

  /** What an offer to undo is bound to. */
  get #moment() {
    return `${this.state.server} ${this.state.version}`;
  }

  /** How many edits have not reached the server yet. */
  get waiting() {
    return this.#queue.length;
  }

  // ---- edits

  /**
   * Change cells, `[sheet, row, column, value]` (null clears): shown at once, sent in order; one call is a step of undo.
   * @returns {Promise<boolean>} false where the server refused it, which a notice explains
   */
  edit(edits, label = "") {
    const changed = edits.filter(([name, row, at, value]) => this.sheet(name) && !same(this.sheet(name).value(row, at), value));
    if (changed.length === 0) return Promise.resolve(true);
    const before = changed.map(([name, row, at]) => [name, row, at, this.sheet(name).value(row, at)]);
    this.#put(changed);
    endNotices(null);
    return this.#enqueue({ edits: changed, before, label });
  }

  /** Add a change to what waits, or in place of the last where that still waits and changes the very same cells. */
  #enqueue({ edits = [], before = [], label = "", ...request }) {
    return new Promise((resolve) => {
      const [id, keys] = [newId(), new Set(edits.map((cell) => key(...cell)))];
      const last = this.#queue.at(-1);
      const isSame = last && !last.wasSent && !last.path && !request.path && last.label === label &&
        last.keys.size === keys.size && [...keys].every((one) => last.keys.has(one));
      if (isSame) {
        const values = new Map(edits.map((cell) => [key(...cell), cell]));
        Object.assign(last, { id, edits: last.edits.map((cell) => values.get(key(...cell))) });
        const earlier = last.resolve;
        last.resolve = (done) => (earlier(done), resolve(done));
      } else this.#queue.push({ ...request, id, edits, before, label, keys, resolve });
      this.#send();
    });
  }
  #send() {
    if (this.#stopped) return;
    this.#sending ??= this.#sendAll().finally(() => {
      this.#sending = null;
      if (this.#queue.length) this.#send();
    });
  }

  async #sendAll() {
    while (this.#queue.length && !this.#stopped) {
      const group = this.#queue[0];
      const book = this.#books;
      group.isSent = group.wasSent = true;
      this.#tell("state");
      try {
        const { version, server } = this.state;
        const content = group.path ? group.body : { edits: group.edits, label: group.label };
        const body = { id: group.id, version, server, ...content };
        const change = await post(group.path ?? "/api/edit", body);
        if (book !== this.#books) return;
        this.#queue.shift();
        this.#keep(group, change);
        await this.#accept(change);
        if (group.path && group.path !== "/api/rows") {
          const { cells = [], rows = [] } = change;
          this.#tell("history", cells.length ? cells : rows.map(([name, at]) => [name, at, 0]));
          this.#tell("step", { isUndo: group.path === "/api/undo", cells, rows });
        }
        group.resolve(true);
      } catch (error) {
        if (book === this.#books) await this.#handleFault(error, group);
      }
    }
  }

  /** Keep what the server has taken until it is in the file. */
  #keep(group, { cells = [], state }) {
    if (this.book.mode !== "disk") return;
    const typed = new Map(group.edits.map((cell) => [key(...cell), cell[3]]));
    const before = new Map(group.before.map((cell) => [key(...cell), cell[3]]));
    const kept = cells.map(([name, row, at, stored]) => {
      const one = key(name, row, at);
      const old = before.has(one) ? before.get(one) : this.sheet(name)?.value(row, at);
      return { cell: [name, row, at], stored, typed: typed.has(one) ? typed.get(one) : stored, before: old };
    });
    this.#kept.add(state.version, group.label, kept);
  }

  async #handleFault(error, group) {
    if (error.status === 409) return this.#resume(error);
    if (REFUSED.has(error.status)) {
      this.#queue.shift();
      this.#takeBack(group);
      this.#tell("state");
      this.#explain(error, group);
      group.resolve(false);
      return null;
    }
    this.#stopped = true;
    group.isSent = false;
    this.#tell("state");
    if (error.status === 0 || error.status === 401) return null; // the frame tells that the server is gone, and when it is back
    const n = this.#queue.length;
    const text = tn("{n} change has not been sent yet. {why}", "{n} changes have not been sent yet. {why}", n, { why: error.message });
    return notice(text, { kind: "error", key: "unsent", actions: [[t("Try again"), () => this.resend()]] });
  }

  /** Send what waits once more, after the server did not answer. */
  resend() {
    if (!this.#stopped) return;
    this.#stopped = false;
    this.#send();
  }

  /** Set refused cells back, except those that a later change has set since. */
  #takeBack(group) {
    const back = group.before.filter((cell) => {
      const later = this.#queue.find((one) => one.keys.has(key(...cell)));
      if (later) later.before = later.before.map((old) => (key(...old) === key(...cell) ? cell : old));
      return !later;
    });
    this.#put(back);
  }

  #explain(error, group) {
    const refused = error.body?.refused ?? [];
    const name = ([sheet, row, at]) => cellName(this.sheet(sheet), row, at);
    let text = error.message;
    if (refused.length) {
      const lines = refused.slice(0, NAMED).map((cell) => `${name(cell)}: ${cell[3]}`);
      if (refused.length > NAMED) lines.push(tn("{n} more", "{n} more", refused.length - NAMED));
      text = t("Not changed: {cell}", { cell: lines.join("; ") });
    } else if (!group.path) text = t("Not changed: {cell}. {why}", { cell: name(group.edits[0]), why: error.message });
    notice(text, { kind: "error" });
  }
  /** Read the book again where the server has another version, and explain what of the changes that wait is lost. */
  async #resume(error) {
    const old = this.#moment;
    const first = this.#queue[0];
    first.repeated = (first.repeated ?? 0) + 1;
    try {
      this.#tellConflict(error, await this.#reread(() => this.#moment !== old && first.repeated <= TIMES_REPEATED));
    } catch (fault) {
      if (fault.status !== 409) await this.#handleFault(fault, first);
    }
  }

  /** Read the book again, as the server has another version of it, or another server has it. */
  async readAgain() {
    this.#tellConflict(null, await this.#reread());
    this.#send();
  }

  /** Read the book again; what waits is kept where nobody else changed its cells. Why, and the cells that lose changes. */
  async #reread(canSend = () => true) {
    const book = await get("/api/book");
    if (book.start) throw new ApiError(404, { message: t("No workbook is open.") });
    const { book: oldBook, state: old } = this;
    const [kept, waiting] = [this.#kept, this.#queue];
    this.#queue = [];
    this.replaceBook(book);
    const isAnew = this.state.server !== old.server;
    const isOther = isAnew && (book.mode !== "disk" || book.file !== oldBook?.file);
    const again = (isAnew && !isOther ? kept : new KeptEdits()).compare(this.#value);
    for (const group of again.groups) this.#queueAgain(group);
    const lost = waiting.filter((group) => !this.#queueWaiting(group, again, !isOther && canSend()));
    const text = isOther ? t("Another workbook was opened: {name}.", { name: book.name }) : this.#whyRead(old, isAnew, again.count);
    return { text, cells: [...again.taken, ...lost.flatMap((group) => group.edits)] };
  }

  #value = ([name, row, at]) => this.sheet(name)?.value(row, at);

  /** Queue what the server before had taken and not saved. */
  #queueAgain({ label, cells }) {
    const before = cells.map(({ cell }) => [...cell, this.#value(cell)]);
    this.#put(cells.map(({ cell, stored }) => [...cell, stored]));
    const edits = cells.map(({ cell, typed }) => [...cell, typed]);
    const keys = new Set(edits.map((cell) => key(...cell)));
    this.#queue.push({ id: newId(), edits, before, label, resolve: () => {}, keys });
  }

  /** Queue what had not been answered; false where that cannot be. */
  #queueWaiting(group, again, canSend) {
    const isNow = (cell) => same(this.#value(cell), cell[3]);
    const isDone = group.isSent && !group.path && group.edits.every(isNow);
    const isFree = group.before.every((cell) => isNow(cell) || again.isKnown(cell, this.#value(cell)));
    const isQueued = canSend && !isDone && isFree && !(group.path && (group.isSent || group.body));
    if (isQueued) {
      group.isSent = false;
      this.#put(group.edits);
      this.#queue.push(group);
    } else group.resolve(isDone);
    return isQueued || isDone;
  }

  #whyRead(old, isAnew, n) {
    if (n) return tn("The server was started again; {n:,} change that it had not saved was sent again.", "The server was started again; {n:,} changes that it had not saved were sent again.", n);
    if (isAnew) return t("The server was started again, and the workbook has been read again.");
    if (this.state.read_version > old.version) return t("The file was changed by another program and has been read again.");
    return t("The workbook was changed in another window and has been read again.");
  }

  #tellConflict(error, { text, cells }) {
    if (cells.length === 0) return void notice(text, { key: "again" });
    const names = cells.slice(0, NAMED).map(([name, row, at]) => (this.sheet(name) ? cellName(this.sheet(name), row, at) : name));
    const named = names.join(", ") + (cells.length > NAMED ? " …" : "");
    const why = this.state.changed_outside && error?.message ? error.message : text;
    notice(`${why} ${t("Not changed: {cells}.", { cells: named })}`, { kind: "error" });
  }

  async #accept(change) {
    for (const [name, ...shift] of change.rows ?? []) this.#shiftRows(name, shift);
    if (change.rows?.length) this.#kept.block(change.state.version);
    const wait = new Set(this.#queue.flatMap((group) => [...group.keys]));
    this.#put((change.cells ?? []).filter((cell) => !wait.has(key(...cell))));
    if (change.missing) this.book.missing = change.missing;
    const other = change.language && change.language !== this.book.language;
    this.takeState(change.state);
    if (other) await this.#reread(); // titles and choices are in the language of the workbook
    else this.refreshLive();
  }

  #put(cells) {
    for (const [name, row, at, value] of cells) this.sheet(name)?.put(row, at, value ?? null);
    if (cells.length) this.#tell("cells", cells);
  }

  /** Rows of a sheet come to lie elsewhere: what waits, live values and the selection follow. */
  #shiftRows(name, shift) {
    const move = (row) => shiftRow(row, shift);
    const moved = (cells) => cells.map(([sheet, row, ...rest]) => [sheet, sheet === name ? move(row) : row, ...rest]).filter(([, row]) => row !== null);
    this.sheet(name)?.shift(move);
    for (const group of this.#queue) {
      Object.assign(group, { edits: moved(group.edits), before: moved(group.before) });
      group.keys = new Set(group.edits.map((cell) => key(...cell)));
      if (group.body?.sheet === name) group.body.at = move(group.body.at) ?? group.body.at;
    }
    if (name === "Items") this.live = new Map([...this.live].map(([row, one]) => [move(row), one]));
    const { selection } = this; // of the grid, which selects by itself, and of the plan
    if (selection.sheet === name) this.select({ ...selection, row: move(selection.row) ?? 0, rows: selection.rows.map(move).filter(Boolean) }, "grid");
    this.stamp = null; // rows have other numbers: all are asked for anew
    this.quiet = null;
    this.#tell("rows", { sheet: name, shift, move });
    this.#tell("cells", [[name, shift[0], 0]]);
  }

  /** Insert, delete or move rows, `{sheet, do, at, count, to}` of `POST /api/rows`, in the order of the edits. */
  changeRows(body) {
    endNotices(null);
    return this.#enqueue({ path: "/api/rows", body });
  }

  undo() {
    return this.#step("/api/undo");
  }

  redo() {
    return this.#step("/api/redo");
  }

  /** Tell of the last change, with an Undo that goes as soon as there is a later one. */
  offerUndo(text) {
    const actions = this.waiting ? [] : [[t("Undo"), () => this.undo()]];
    notice(text, { actions, until: this.#moment });
  }

  /** Undo and redo stand in the same queue as edits, so that each finds the version that it expects. */
  #step(path) {
    const can = path === "/api/undo" ? this.state.can_undo : this.state.can_redo;
    if (!this.book || (!can && this.#queue.length === 0)) return Promise.resolve(false);
    endNotices(null);
    return this.#enqueue({ path });
  }

  // ---- live values

  /** Ask for classes, live values and problems; one request at a time, and once more where something changed meanwhile. */
  refreshLive() {
    clearTimeout(this.#later);
    this.#askAgain = true;
    this.#asking ??= this.#askAll().finally(() => (this.#asking = null));
    return this.#asking;
  }

  async #askAll() {
    while (this.#askAgain && this.book) {
      this.#askAgain = false;
      const book = this.#books;
      const since = this.stamp === null ? "" : `?since=${this.stamp}`;
      try {
        const answer = await get(`/api/live${since}`);
        if (book === this.#books) this.#takeLive(answer);
        else this.#askAgain = true;
      } catch (error) {
        this.liveError = error.message;
        this.#tell("problems");
      }
    }
  }

  #takeLive(answer) {
    if (answer.whole) this.live.clear();
    const { row: rows = [], values: columns = {}, ...named } = answer.items ?? {};
    const ofRow = (lists, i) => Object.fromEntries(Object.entries(lists).map(([name, all]) => [name, all[i]]));
    rows.forEach((row, i) => this.live.set(row, { ...ofRow(named, i), values: ofRow(columns, i) }));
    for (const row of answer.gone ?? []) this.live.delete(row);
    this.stamp = answer.stamp ?? null;
    this.simulation = answer.simulation ?? { state: "done", done: 0, of: 0, message: "" };
    if (this.isSimulating) this.#later = setTimeout(() => this.refreshLive(), SOON_MS);
    this.counts = answer.counts ?? {};
    this.floors = answer.floors ?? [];
    this.liveError = answer.error ?? "";
    this.moreProblems = answer.more ?? 0;
    this.#takeProblems(answer.problems ?? []);
    this.#tell("live");
    this.#tell("problems");
  }

  /** Whether more simulated classes are to come. */
  get isSimulating() {
    return ["running", "waiting"].includes(this.simulation.state);
  }

  #takeProblems(problems) {
    this.#problems = problems;
    this.#byCell = new Map();
    for (const problem of problems) {
      const isOne = problem.row !== null && problem.row !== undefined && problem.at !== null;
      const cells = problem.cells ?? (isOne ? [[problem.row, problem.at]] : []);
      for (const [n, [row, at]] of cells.entries()) {
        const cell = key(problem.sheet, row, at);
        const [message, fix] = problem.own?.[n] ?? [problem.message, problem.fix];
        const worst = this.#byCell.get(cell);
        if (!worst || SEVERITIES.indexOf(problem.severity) < SEVERITIES.indexOf(worst.severity)) this.#byCell.set(cell, { ...problem, message, fix });
      }
    }
  }

  /** The problems, the worst first, but for those of the row that is being filled in. */
  get problems() {
    const isQuiet = ({ sheet, row, cells }) => row !== null && this.#isQuiet(sheet, row) && (cells ?? []).every(([one]) => one === row);
    return this.quiet ? this.#problems.filter((one) => !isQuiet(one)) : this.#problems;
  }

  #isQuiet = (sheet, row) => this.quiet !== null && this.quiet[0] === sheet && this.quiet[1] === row;

  /** Show no problems of a row, `[sheet, row]`, as long as it is being filled in; null ends that. */
  hush(row) {
    if (!row && !this.quiet) return;
    this.quiet = row;
    this.#tell("problems");
  }

  /** The rows of a sheet that have an error or a warning. */
  rowsWithProblems(name) {
    const found = this.problems.filter((one) => one.sheet === name && one.severity !== "note" && one.row !== null);
    return new Set(found.flatMap((one) => (one.cells?.length ? one.cells.map(([row]) => row) : [one.row])));
  }

  /** The worst problem of a cell, undefined where it has none. */
  problemAt(sheet, row, at) {
    return this.#isQuiet(sheet, row) ? undefined : this.#byCell.get(key(sheet, row, at));
  }

  // ---- selection

  /** @param source who selected, so that it does not follow itself */
  select(selection, source) {
    this.selection = { at: 0, rows: selection.row ? [selection.row] : [], ...selection };
    this.#tell("selection", { source });
  }

  /** Show a cell in the grid, which may not be made yet: it looks at `toReveal` then. */
  reveal(cell) {
    this.toReveal = cell;
    this.#tell("reveal", cell);
  }

  #tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

export const store = new Store();
