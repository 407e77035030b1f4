// The building model that is sent and read: one for the whole page, found again after a reload.

import { get, leave, post, send } from "./api.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const EVERY_MS = 400;
const MOST_PROBLEMS = 5;
const MEGABYTE = 2 ** 20;

/** Tells `change` with every step. */
class Imports extends EventTarget {
  /** What is read, or has been read and is not opened; null where there is nothing. */
  current = null;
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
  #store = null;
  #most = Infinity;
  #begun = "";
  #timer = 0;
  #asked = 0;
  #ending = null;

  /** Look what there is, and follow it from now on. */
  async attach(store) {
    this.#store = store;
    store.addEventListener("book", () => this.refresh());
    addEventListener("pagehide", () => this.isBusy && this.#begun && leave("/api/import/cancel"));
    await this.refresh();
  }

  get isRunning() {
    return this.current?.state === "running";
  }

  get isBusy() {
    return this.isRunning || this.sending !== "";
  }

  /** What can be shown of an import: what is to be opened, or what the open workbook was made of. */
  get shown() {
    return this.current?.found ? this.current : this.opened?.book === this.#store?.state.server ? this.opened : null;
  }

  async refresh() {
    clearTimeout(this.#timer);
    const asked = (this.#asked += 1);
    try {
      const answer = await get("/api/import");
      if (asked === this.#asked) this.#take(answer);
    } catch {
      // the watch of the server tells that it is gone
    }
    if (asked === this.#asked && this.isRunning) this.#timer = setTimeout(() => this.refresh(), EVERY_MS);
  }

  /** Send a file, and have it read. */
  async begin(file) {
    if (this.isBusy) return notice(t("Another model is being read: cancel that first, or wait for it."), { kind: "error" });
    if (file.size > this.#most) return this.#fail(t("{name} is larger than {n} MB. Export fewer storeys, or furniture, spaces, doors and walls only.", { name: file.name, n: Math.round(this.#most / MEGABYTE) }));
    this.sending = file.name;
    this.fault = "";
    this.#ending = new AbortController();
    this.#tell();
    try {
      const path = `/api/import?name=${encodeURIComponent(file.name)}&routes=${this.drafts ? "draft" : "none"}`;
      this.follow(await send(path, file, this.#ending.signal));
    } catch (error) {
      this.sending = "";
      if (error.name === "AbortError") this.#noteCancelled(file.name);
      else this.#fail(sayWhy(file.name, error.message, error.body));
    }
    return null;
  }

  /** Follow what the server has begun to read. */
  follow(answer) {
    this.#asked += 1; // an answer that is under way tells of the one before
    this.sending = this.fault = "";
    this.isCancelled = false;
    this.#begun = answer.import.id;
    this.#take(answer);
    if (this.isRunning) this.#timer = setTimeout(() => this.refresh(), EVERY_MS);
  }

  /** End the reading, or drop what was read. */
  async cancel() {
    if (this.sending) return this.#ending.abort();
    if (!this.current) return null;
    this.#asked += 1;
    clearTimeout(this.#timer);
    try {
      this.#take(await post("/api/import/cancel"));
    } catch (error) {
      this.#fail(error.message || t("The server does not answer."));
    }
    return null;
  }

  /** Have the new workbook be made and opened; rejects with ApiError. */
  async open(shaking) {
    const { name } = this.current;
    const book = await post("/api/import/open", { shaking });
    this.opened = { ...this.current, book: book.state.server };
    this.current = null;
    this.#store.replaceBook(book);
    location.hash = "#sheet";
    this.#tellOpened(book, name, shaking);
  }

  #tellOpened(book, name, shaking) {
    const text = t("{book} was made from {name}.", { book: book.name, name });
    const show = [t("What was imported"), () => (location.hash = "#import")];
    const line = this.#store.sheet("Building")?.column("shaking");
    if (shaking || !line) notice(text, { actions: [show] });
    else notice(`${text} ${t("What is still missing is how the ground shakes: choose Shaking in Building.")}`, { actions: [[t("Choose the shaking"), () => this.#store.reveal(["Building", line.row, 1])], show] });
  }

  #take({ import: found, opened, most }) {
    this.current = found;
    this.opened = opened;
    this.#most = most;
    if (found && found.id === this.#begun && found.state !== "running") this.#end(found);
    this.#tell();
  }

  /** What this page had begun has ended: its list is shown, unless somebody looks at something else. */
  #end({ name, state, message, fix, problems, found }) {
    this.#begun = "";
    const isSeen = !this.#store.book || location.hash === "#start";
    if (state === "failed") this.#fail(sayWhy(name, [message, fix].filter(Boolean).join(" "), { problems }), !isSeen);
    else if (state === "cancelled") this.#noteCancelled(name);
    else if (isSeen) location.hash = "#import";
    else notice(tn("{name} has been read: {n:,} piece.", "{name} has been read: {n:,} pieces.", found.pieces, { name }), { actions: [[t("Show it"), () => (location.hash = "#import")]], lasting: true });
  }

  #noteCancelled(name) {
    this.fault = t("Reading {name} was cancelled. Nothing of it was kept.", { name });
    this.isCancelled = true;
    this.#tell();
  }

  #fail(text, isNoticed = false) {
    this.fault = text;
    this.isCancelled = false;
    if (isNoticed) notice(text, { kind: "error" });
    this.#tell();
  }

  #tell() {
    this.dispatchEvent(new Event("change"));
  }
}

export const imports = new Imports();

/** Why a file was not read: the message of the server, else the problems that it lists. */
function sayWhy(name, message, body) {
  const problems = (body?.problems ?? []).slice(0, MOST_PROBLEMS).map((one) => [one.sheet, one.cell, one.message, one.fix].filter(Boolean).join(" "));
  const lines = problems.length ? problems : [message || t("The server does not answer.")];
  return lines.some((one) => one.includes(name)) ? lines.join("\n") : [t("{name} was not read.", { name }), ...lines].join("\n");
}
