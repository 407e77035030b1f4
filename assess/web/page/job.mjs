// The runs of this session, and the building model that is sent and read: one watch of each for the whole page; they are
// found again after a reload.

import { get, leave, post, send } from "./api.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const RUN_MS = 500;
const IMPORT_MS = 400;
const SETTLED_MS = 400;
const MOST_PROBLEMS = 5;
const MEGABYTE = 2 ** 20;

/** What the server does, `current`: asked for again while it is at work. Tells `change` with every answer. */
class Watched extends EventTarget {
  /** The latest; null where there is nothing. */
  current = null;
  store = null;
  #timer = 0;
  #asked = 0;

  constructor(path, everyMs) {
    super();
    Object.assign(this, { path, everyMs });
  }

  get isRunning() {
    return this.current?.state === "running";
  }

  /** Follow it from now on. */
  attach(store) {
    this.store = store;
    store.addEventListener("book", () => this.refresh());
    return this.refresh();
  }

  async refresh() {
    clearTimeout(this.#timer);
    const asked = (this.#asked += 1);
    try {
      const answer = await get(this.path);
      if (asked === this.#asked) this.take(answer);
    } catch {
      // the watch of the server tells that it is gone
    }
    if (asked === this.#asked && this.isRunning) this.lookLater(this.everyMs);
  }

  lookLater(time) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), time);
  }

  /** Take an answer to a request of this page. */
  follow(answer) {
    this.take(answer);
    if (this.isRunning) this.lookLater(this.everyMs);
  }

  /** What is under way tells of before. */
  forgetAsked() {
    this.#asked += 1;
    clearTimeout(this.#timer);
  }

  async post(path, body) {
    this.forgetAsked();
    try {
      this.follow(await post(path, body));
    } catch (error) {
      if (this.isRunning) this.lookLater(this.everyMs);
      throw error;
    }
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }
}

/** The runs: all requests that change them go through `post`, which rejects with ApiError. */
class Jobs extends Watched {
  /** All runs that have results. */
  runs = [];
  scenarios = [];
  #version = null;

  async attach(store) {
    store.addEventListener("state", () => this.#onState());
    await super.attach(store);
  }

  /** Look again where the server tells of another run, such as one that another window began. */
  compare(summary) {
    if (!summary || this.isRunning) return;
    if (summary.id !== this.current?.id || summary.state !== this.current.state) this.refresh();
  }

  take({ job, runs, scenarios }) {
    Object.assign(this, { current: job ?? null, runs, scenarios });
    this.#version = this.store.state.version;
    this.tell();
  }

  /** An edit may make a run old. */
  #onState() {
    const { state, waiting } = this.store;
    if (this.current?.state !== "done" || waiting || state.version === this.#version) return;
    this.#version = state.version;
    this.lookLater(SETTLED_MS);
  }
}

/** What is read, or has been read and is not opened. */
class Imports extends Watched {
  /** What the open workbook was made of, null for others. */
  opened = null;
  /** The name of the file that is being sent. */
  sending = "";
  /** Why nothing came of the last one; "" where it went well. */
  fault = "";
  /** Whether that was by intention. */
  isCancelled = false;
  /** Whether routes are to be drafted. */
  drafts = false;
  #most = Infinity;
  #begun = "";
  #ending = null;

  async attach(store) {
    addEventListener("pagehide", () => this.isBusy && this.#begun && leave("/api/import/cancel"));
    await super.attach(store);
  }

  get isBusy() {
    return this.isRunning || this.sending !== "";
  }

  /** What can be shown of an import: what is to be opened, or what the open workbook was made of. */
  get shown() {
    return this.current?.found ? this.current : this.opened?.book === this.store?.state.server ? this.opened : null;
  }

  /** Send a file, and have it read. */
  async begin(file) {
    if (this.isBusy) return void notice(t("Another model is being read: cancel that first, or wait for it."), { kind: "error" });
    const { name } = file;
    if (file.size > this.#most) return void this.#fail(t("{name} is larger than {n} MB. Export fewer storeys, or furniture, spaces, doors and walls only.", { name, n: Math.round(this.#most / MEGABYTE) }));
    this.sending = name;
    this.fault = "";
    this.#ending = new AbortController();
    this.tell();
    try {
      const path = `/api/import?name=${encodeURIComponent(name)}&routes=${this.drafts ? "draft" : "none"}`;
      this.followBegun(await send(path, file, this.#ending.signal));
    } catch (error) {
      this.sending = "";
      if (error.name === "AbortError") this.#noteCancelled(name);
      else this.#fail(sayWhy(name, error.message, error.body));
    }
  }

  /** Follow what the server has begun to read. */
  followBegun(answer) {
    this.forgetAsked();
    this.sending = this.fault = "";
    this.isCancelled = false;
    this.#begun = answer.import.id;
    this.follow(answer);
  }

  /** End the reading, or drop what was read. */
  async cancel() {
    if (this.sending) return void this.#ending.abort();
    const explain = (error) => this.#fail(error.message || t("The server does not answer."));
    if (this.current) await this.post("/api/import/cancel").catch(explain);
  }

  /** Have the new workbook be made and opened; rejects with ApiError. */
  async open(shaking) {
    const { name } = this.current;
    const book = await post("/api/import/open", { shaking });
    this.opened = { ...this.current, book: book.state.server };
    this.current = null;
    this.store.replaceBook(book);
    location.hash = "#sheet";
    const text = t("{book} was made from {name}.", { book: book.name, name });
    const show = [t("What was imported"), () => (location.hash = "#import")];
    const line = this.store.sheet("Building")?.column("shaking");
    if (shaking || !line) notice(text, { actions: [show] });
    else notice(`${text} ${t("What is still missing is how the ground shakes: choose Shaking in Building.")}`, { actions: [[t("Choose the shaking"), () => this.store.reveal(["Building", line.row, 1])], show] });
  }

  take({ import: found, opened, most }) {
    Object.assign(this, { current: found, opened });
    this.#most = most;
    if (found && found.id === this.#begun && found.state !== "running") this.#end(found);
    this.tell();
  }

  /** What this page had begun has ended: its list is shown, unless somebody looks at something else. */
  #end({ name, state, message, fix, problems, found }) {
    this.#begun = "";
    const isSeen = !this.store.book || location.hash === "#start";
    if (state === "failed") this.#fail(sayWhy(name, [message, fix].filter(Boolean).join(" "), { problems }), !isSeen);
    else if (state === "cancelled") this.#noteCancelled(name);
    else if (isSeen) location.hash = "#import";
    else notice(tn("{name} has been read: {n:,} piece.", "{name} has been read: {n:,} pieces.", found.pieces, { name }), { actions: [[t("Show it"), () => (location.hash = "#import")]], lasting: true });
  }

  #noteCancelled(name) {
    this.#fail(t("Reading {name} was cancelled. Nothing of it was kept.", { name }), false, true);
  }

  #fail(text, isNoticed = false, isCancelled = false) {
    Object.assign(this, { fault: text, isCancelled });
    if (isNoticed) notice(text, { kind: "error" });
    this.tell();
  }
}

/** Why a file was not read: the message of the server, else the problems that it lists. */
function sayWhy(name, message, body) {
  const problems = (body?.problems ?? []).slice(0, MOST_PROBLEMS).map((one) => [one.sheet, one.cell, one.message, one.fix].filter(Boolean).join(" "));
  const lines = problems.length ? problems : [message || t("The server does not answer.")];
  return lines.some((one) => one.includes(name)) ? lines.join("\n") : [t("{name} was not read.", { name }), ...lines].join("\n");
}

export const jobs = new Jobs("/api/job", RUN_MS);
export const imports = new Imports("/api/import", IMPORT_MS);
