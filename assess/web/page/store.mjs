// The page's copy of the workbook. Edits show at once and reach the server one after the other; classes, live values and
// problems come from the server after each change.

import { connection, get, post } from "./api.mjs";
import { notice } from "./messages.mjs";
import { Sheet, cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";

const REFUSED = new Set([400, 413, 422]);
const NAMED = 5;
const TIMES_REPEATED = 3;
const SEVERITIES = ["error", "warning", "note"];

const key = (sheet, row, at) => `${sheet}|${row}|${at}`;
const same = (one, other) => one === other || (one ?? "") === (other ?? "");

class Store extends EventTarget {
  book = null;
  /** What `GET /api/book` answers where no workbook is open. */
  start = null;
  state = { version: 0, unsaved: false, save_error: "", changed_outside: false, can_undo: false, can_redo: false };
  live = new Map();
  problems = [];
  /** How many problems there are besides those. */
  moreProblems = 0;
  counts = {};
  floors = [];
  liveError = "";
  selection = { sheet: "Items", row: 0, at: 0, rows: [] };
  #sheets = new Map();
  #byCell = new Map();
  #simulated = new Map();
  #queue = [];
  #sending = null;
  #stopped = false;
  #liveVersion = null;
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
    try {
      this.replaceBook(await get("/api/book"));
    } catch (error) {
      if (error.status !== 404) throw error;
      this.start = error.body ?? {};
      this.replaceBook(null);
    }
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
    this.#simulated = new Map();
    this.#takeLive({ version: 0, whole: true });
    this.#liveVersion = null;
    if (book?.state) this.state = book.state;
    this.#tell("book");
    this.#tell("state");
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
    this.#tell("state");
  }

  /** How many edits have not reached the server yet. */
  get waiting() {
    return this.#queue.length;
  }

  get simulated() {
    return this.#simulated;
  }

  set simulated(rows) {
    this.#simulated = rows ?? new Map();
    this.#tell("simulated");
  }

  // ---- edits

  /**
   * Change cells: shown at once, sent in order; one call is one step of undo.
   * @param {Array<[string, number, number, *]>} edits sheet, row, column, value (null clears)
   * @param {string} label what was done, for the history
   * @returns {Promise<boolean>} false where the server refused it, which a notice explains
   */
  edit(edits, label = "") {
    const changed = edits.filter(([name, row, at, value]) => this.sheet(name) && !same(this.sheet(name).value(row, at), value));
    if (changed.length === 0) return Promise.resolve(true);
    const before = changed.map(([name, row, at]) => [name, row, at, this.sheet(name).value(row, at)]);
    this.#put(changed);
    return new Promise((resolve) => {
      this.#queueUp({ edits: changed, before, label, resolve, keys: new Set(changed.map((cell) => key(...cell))) });
      this.#send();
    });
  }

  /** Add a change to what waits; one of the very cells that the last waiting one changes takes its place. */
  #queueUp(group) {
    const last = this.#queue.at(-1);
    const replaces = last && !last.isSent && !last.path && last.label === group.label && last.keys.size === group.keys.size &&
      [...group.keys].every((one) => last.keys.has(one));
    if (!replaces) {
      this.#queue.push(group);
      return;
    }
    const values = new Map(group.edits.map((cell) => [key(...cell), cell]));
    last.edits = last.edits.map((cell) => values.get(key(...cell)));
    const earlier = last.resolve;
    last.resolve = (done) => (earlier(done), group.resolve(done));
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
      group.isSent = true;
      this.#tell("state");
      try {
        const body = { version: this.state.version, ...(group.path ? {} : { edits: group.edits, label: group.label }) };
        const change = await post(group.path ?? "/api/edit", body);
        if (book !== this.#books) return;
        this.#queue.shift();
        await this.#accept(change);
        if (group.path) this.#tell("history", change.cells ?? []);
        group.resolve(true);
      } catch (error) {
        if (book === this.#books) await this.#handleFault(error, group);
      }
    }
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
    if (refused.length === 0 && group.path) {
      notice(error.message, { kind: "error" });
      return;
    }
    if (refused.length === 0) {
      const [name, row, at] = group.edits[0];
      const where = cellName(this.sheet(name), row, at);
      notice(t("Not changed: {cell}. {why}", { cell: where, why: error.message }), { kind: "error" });
      return;
    }
    const lines = refused.slice(0, NAMED).map(([name, row, at, why]) => `${cellName(this.sheet(name), row, at)}: ${why}`);
    if (refused.length > NAMED) lines.push(tn("{n} more", "{n} more", refused.length - NAMED, { n: refused.length - NAMED }));
    notice(`${t("Not changed, because cells cannot be changed:")} ${lines.join("; ")}`, { kind: "error" });
  }

  /** Read the book again where the server has another version, and explain what of the changes that wait is lost. */
  async #resume(error) {
    const old = this.state.version;
    const first = this.#queue[0];
    first.repeated = (first.repeated ?? 0) + 1;
    try {
      const lost = await this.#reread(() => this.state.version !== old && first.repeated <= TIMES_REPEATED);
      this.#tellConflict(error, lost);
    } catch (fault) {
      if (fault.status !== 409) await this.#handleFault(fault, first);
    }
  }

  /** Read the book again; what waits is kept where nobody else changed its cells. Returns what is not. */
  async #reread(canSend = () => true) {
    const book = await get("/api/book");
    const waiting = this.#queue;
    this.#queue = [];
    this.replaceBook(book);
    const lost = [];
    for (const group of waiting) {
      const isFree = group.before.every(([name, row, at, value]) => same(this.sheet(name)?.value(row, at), value));
      if (!canSend() || !isFree || (group.path && group.isSent)) {
        lost.push(group);
        group.resolve(false);
        continue;
      }
      group.isSent = false;
      this.#put(group.edits);
      this.#queue.push(group);
    }
    return lost;
  }

  #tellConflict(error, lost) {
    const cells = lost.flatMap((group) => group.edits).map(([name, row, at]) => cellName(this.sheet(name), row, at));
    if (cells.length === 0) {
      notice(t("The workbook was changed in another window and has been read again."), { kind: "info" });
      return;
    }
    const named = cells.slice(0, NAMED).join(", ") + (cells.length > NAMED ? " …" : "");
    const text = this.state.changed_outside && error.message
      ? error.message
      : t("The workbook was changed in another window and has been read again.");
    notice(`${text} ${t("Not changed: {cells}.", { cells: named })}`, { kind: "error" });
  }

  async #accept(change) {
    const wait = new Set(this.#queue.flatMap((group) => [...group.keys]));
    this.#put((change.cells ?? []).filter((cell) => !wait.has(key(...cell))));
    this.state = change.state;
    if (change.missing) this.book.missing = change.missing;
    const other = change.language && change.language !== this.book.language;
    this.#tell("state");
    if (other) await this.#reread(); // titles and choices are in the language of the workbook
    else this.refreshLive();
  }

  #put(cells) {
    for (const [name, row, at, value] of cells) this.sheet(name)?.put(row, at, value ?? null);
    if (cells.length) this.#tell("cells", cells);
  }

  undo() {
    return this.#step("/api/undo");
  }

  redo() {
    return this.#step("/api/redo");
  }

  /** Undo and redo stand in the same queue as edits, so that each finds the version that it expects. */
  #step(path) {
    const can = path === "/api/undo" ? this.state.can_undo : this.state.can_redo;
    if (!this.book || (!can && this.#queue.length === 0)) return Promise.resolve(false);
    return new Promise((resolve) => {
      this.#queue.push({ path, edits: [], before: [], label: "", resolve, keys: new Set() });
      this.#send();
    });
  }

  // ---- live values

  /** Ask for classes, live values and problems; one request at a time, and once more where something changed meanwhile. */
  refreshLive() {
    this.#askAgain = true;
    this.#asking ??= this.#askAll().finally(() => (this.#asking = null));
    return this.#asking;
  }

  async #askAll() {
    while (this.#askAgain && this.book) {
      this.#askAgain = false;
      const book = this.#books;
      const since = this.#liveVersion === null ? "" : `?since=${this.#liveVersion}`;
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
    const items = answer.items ?? {};
    (items.row ?? []).forEach((row, i) => {
      const values = Object.fromEntries(Object.entries(items.values ?? {}).map(([at, all]) => [at, all[i]]));
      this.live.set(row, { class: items.class[i], word: items.word[i], chance: items.chance[i], outside: items.outside[i], values });
    });
    for (const row of answer.gone ?? []) this.live.delete(row);
    this.#liveVersion = answer.version;
    this.counts = answer.counts ?? {};
    this.floors = answer.floors ?? [];
    this.liveError = answer.error ?? "";
    this.moreProblems = answer.more ?? 0;
    this.#takeProblems(answer.problems ?? []);
    this.#tell("live");
    this.#tell("problems");
  }

  #takeProblems(problems) {
    this.problems = problems;
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

  /** The worst problem of a cell, undefined where it has none. */
  problemAt(sheet, row, at) {
    return this.#byCell.get(key(sheet, row, at));
  }

  // ---- selection

  /** @param source who selected, so that it does not follow itself */
  select(selection, source) {
    this.selection = { at: 0, rows: selection.row ? [selection.row] : [], ...selection };
    this.dispatchEvent(new CustomEvent("selection", { detail: { source } }));
  }

  /** Show a cell in the grid. */
  reveal(cell) {
    this.#tell("reveal", cell);
  }

  #tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

export const store = new Store();
