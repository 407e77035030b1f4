// Watches the server: whether it answers, whether the file was changed by another program, whether another window edits.

import { connection, get, post } from "./api.mjs";
import { ask, notice } from "./messages.mjs";
import { t } from "./texts.mjs";

const EVERY_MS = 2000;

export class Watch extends EventTarget {
  isGone = false;
  #store;
  #notices = {};
  #timer = 0;
  #isLooking = false;
  #isStranger = false;

  constructor(store) {
    super();
    this.#store = store;
    connection.addEventListener("gone", () => this.#onGone());
    connection.addEventListener("back", () => this.#onBack());
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
      if (error.status === 401) this.#onStranger();
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
    if (state.version > store.state.version) {
      this.#readAgain();
      return;
    }
    if (state.version === store.state.version) store.takeState(state);
    this.#showOutside(state.changed_outside);
  }

  /** Another window of this session changed the workbook. */
  async #readAgain() {
    await this.#store.load();
    notice(t("The workbook was changed in another window and has been read again."), { key: "again" });
  }

  #showOutside(isChanged) {
    if (!isChanged) {
      this.#notices.outside?.close();
      this.#notices.outside = null;
      return;
    }
    if (this.#notices.outside) return;
    const name = this.#store.book.name;
    const text = t("{name} was changed by another program, such as Excel. Your later changes here are not saved in it.", { name });
    const actions = [[t("Read the file again"), () => this.#reload()], [t("Download my version"), () => download()]];
    this.#notices.outside = notice(text, { kind: "error", actions, key: "outside" });
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
    this.isGone = true;
    this.dispatchEvent(new Event("connection"));
    const name = this.#store.book?.mode === "disk" ? this.#store.book.name : "";
    const command = `assess open ${name.includes(" ") ? `"${name}"` : name} --port ${location.port || 80}`.replace("  ", " ");
    const text = t("The program behind this page does not answer. Start it again: {command}. What you change meanwhile is kept in this page, and sent when it answers.", { command });
    this.#notices.gone = notice(text, { kind: "error", key: "gone" });
  }

  #onBack() {
    this.isGone = this.#isStranger = false;
    this.#notices.gone?.close();
    this.dispatchEvent(new Event("connection"));
    this.#store.resend();
  }

  /** The program was started anew, and does not know this window. */
  #onStranger() {
    if (this.#isStranger) return;
    this.isGone = this.#isStranger = true;
    this.dispatchEvent(new Event("connection"));
    const text = t("This window is no longer connected, as the program was started again. Use the window that it opened, or open the address that it printed.");
    this.#notices.gone = notice(text, { kind: "error", key: "gone" });
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
