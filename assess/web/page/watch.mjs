// Watches the server: whether it answers, whether the file was changed by another program, whether another window edits.

import { connection, get, post } from "./api.mjs";
import { ask, notice } from "./messages.mjs";
import { t } from "./texts.mjs";

const EVERY_MS = 2000;
const UNREAD_LOOKS = 3; // so often a file that another program writes may not be readable yet

export class Watch extends EventTarget {
  isGone = false;
  #store;
  #notices = {};
  #why = "";
  #timer = 0;
  #isLooking = false;
  #isStranger = false;
  #reading = null;
  #unread = 0;
  #told = "";

  constructor(store) {
    super();
    this.#store = store;
    connection.addEventListener("gone", () => this.#onGone());
    connection.addEventListener("back", () => this.#onBack());
    store.addEventListener("book", () => {
      const { book, state } = store;
      this.#showTrouble(book ? state : {});
      if (!book?.remark || this.#told === state.server) return;
      this.#told = state.server;
      notice(book.remark, { key: "remark", lasting: true });
    });
    document.addEventListener("visibilitychange", () => !document.hidden && this.look());
  }

  start() {
    clearInterval(this.#timer);
    this.#timer = setInterval(() => document.hidden || this.look(), EVERY_MS);
  }

  /** Ask for the state once. */
  async look() {
    if (this.#isLooking) return;
    this.#isLooking = true;
    try {
      this.#take(await get("/api/state", AbortSignal.timeout(5 * EVERY_MS)));
    } catch (error) {
      if (error.status !== 401 || this.#isStranger) return;
      this.#isStranger = true; // the program was started anew, and does not know this window
      this.#tellGone(t("The program was restarted, and this window is no longer connected. Use the window that it opened, or open the address that it printed."));
    } finally {
      this.#isLooking = false;
    }
  }

  #take(answer) {
    const store = this.#store;
    const state = answer.state ?? {};
    if (this.#isStranger) this.#onBack();
    this.dispatchEvent(new CustomEvent("job", { detail: answer.job }));
    if (!store.book || store.waiting || typeof state.version !== "number") return;
    if (state.server !== store.state.server || state.version > store.state.version) {
      // another window of this session changed the workbook, the server read the file again, or it is another server
      this.#reading ??= store.readAgain().catch(() => {}).finally(() => (this.#reading = null)); // else the next look does
      return;
    }
    if (state.version === store.state.version) store.takeState(state);
    this.#showOutside(state);
    this.#showTrouble(state);
  }

  /** The server reads a file that changed by itself; where changes would be lost by that, the user decides. */
  #showOutside({ changed_outside: isChanged, unsaved }) {
    if (!isChanged) {
      this.#notices.outside?.close();
      this.#notices.outside = null;
      this.#unread = 0;
      return;
    }
    this.#unread += 1;
    if (this.#notices.outside || (!unsaved && this.#unread < UNREAD_LOOKS)) return;
    const { name } = this.#store.book;
    const text = unsaved
      ? t("{name} was changed by another program, such as Excel, while you edited it here. Nothing is lost yet: your edits are in this page, the other changes in the file. Download your version to keep your edits, or read the file again to discard them.", { name })
      : t("{name} was changed by another program and cannot be read as it is now. The page shows what it held before.", { name });
    const actions = [[t("Download my version"), download], [t("Read the file again"), () => this.#reload()]];
    this.#notices.outside = notice(text, { kind: unsaved ? "info" : "error", actions, key: "outside", lasting: true });
  }

  /** What stands in the way of saving, how to end it, and a way to keep the changes; gone once saving works. */
  #showTrouble({ save_error: why = "", unsaved = false }) {
    const text = why && unsaved ? t("Not saved: {why} Saving is tried again every few seconds.", { why }) : why;
    if (text === this.#why) return;
    this.#notices.trouble?.close();
    this.#why = text;
    const actions = unsaved ? [[t("Download my version"), download]] : [];
    if (text) this.#notices.trouble = notice(text, { kind: unsaved ? "error" : "info", actions, key: "trouble", lasting: true });
  }

  async #reload() {
    this.#notices.outside = null;
    const { state, waiting } = this.#store;
    const question = t("Read the file again? Changes made here that are not saved in it are lost.");
    if ((state.unsaved || waiting) && !(await ask(question, [[t("Read the file again"), true], [t("Cancel"), false]]))) return;
    try {
      this.#store.replaceBook(await post("/api/reload"));
    } catch (error) {
      notice(error.message, { kind: "error" });
    }
  }

  #onGone() {
    const name = this.#store.book?.mode === "disk" ? this.#store.book.name : "";
    const command = `assess open ${name.includes(" ") ? `"${name}"` : name} --port ${location.port || 80}`.replace("  ", " ");
    this.#tellGone(t("The program behind this page does not answer. Start it again: {command}. Changes made meanwhile are kept in this page and sent as soon as it answers.", { command }));
  }

  #tellGone(text) {
    this.isGone = true;
    this.dispatchEvent(new Event("connection"));
    this.#notices.gone = notice(text, { kind: "error", key: "gone", lasting: true });
  }

  #onBack() {
    this.isGone = this.#isStranger = false;
    this.#notices.gone?.close();
    this.dispatchEvent(new Event("connection"));
    this.#store.resend();
  }
}

/** Wait until every edit has reached the server. */
export function whenSent(store) {
  return new Promise((resolve) => {
    const look = () => {
      if (store.waiting) return;
      store.removeEventListener("state", look);
      resolve();
    };
    store.addEventListener("state", look);
    look();
  });
}

function download() {
  const link = Object.assign(document.createElement("a"), { href: "/api/download", download: "" });
  document.body.append(link);
  link.click();
  link.remove();
}
