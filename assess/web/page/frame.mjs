// The frame of the page: header, tabs, what they show.

import { countBadges } from "./classes.mjs";
import { choose, clear, el, labelled } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { imports, jobs } from "./job.mjs";
import { acceptDrops, showFiles } from "./open_file.mjs";
import { notice } from "./messages.mjs";
import { cellName } from "./sheet.mjs";
import { Tabs } from "./tabs.mjs";
import { language, languages, loadTexts, t, tn } from "./texts.mjs";
import { themeSwitch } from "./theme.mjs";
import { Watch, whenSent } from "./watch.mjs";

/** What keeps an undo of its own: text fields, and the questions of dialogs. */
const OWN_UNDO = `textarea, [contenteditable], dialog, input:not(${["checkbox", "radio", "range", "button", "submit", "reset", "file", "color"].map((one) => `[type="${one}"]`).join()})`;

/** The save state in words, and whether something has to be done about it. */
function saveState(store, isGone) {
  const { book, state } = store;
  if (!book) return ["", false];
  if (isGone) return [t("Not connected: changes are kept in this page"), true];
  if (state.changed_outside && state.unsaved) return [t("Changed by another program, not saved"), true];
  if (state.save_error) return [state.unsaved ? t("Not saved: {why}", { why: state.save_error }) : state.save_error, true];
  if (store.waiting || (book.mode === "disk" && state.unsaved)) return [t("Saving…"), false];
  if (book.mode === "disk") return [t("All changes saved"), false];
  return [state.unsaved ? t("Not downloaded yet") : t("No changes since the last download"), false];
}

const UNDONE_MS = 6000;

/** Tells for a moment what an undo or a redo changed, which may be out of sight or from another window. */
function undoneLine(store) {
  const line = el("div", { class: "undone", role: "status" });
  let timer = 0;
  const show = (text) => {
    clearTimeout(timer);
    line.textContent = text;
    timer = setTimeout(() => (line.textContent = ""), UNDONE_MS);
  };
  store.addEventListener("step", ({ detail }) => (detail.cells.length || detail.rows.length) && show(describe(store, detail)));
  store.addEventListener("book", () => show(""));
  return line;
}

function describe(store, { isUndo, cells, rows }) {
  if (rows.length) return isUndo ? t("Undone: rows of {sheet}", { sheet: store.sheet(rows[0][0]).title }) : t("Redone: rows of {sheet}", { sheet: store.sheet(rows[0][0]).title });
  const n = cells.length;
  if (n > 1) return isUndo ? tn("Undone: {n:,} cell", "Undone: {n:,} cells", n) : tn("Redone: {n:,} cell", "Redone: {n:,} cells", n);
  const [name, row, at] = cells[0];
  const cell = cellName(store.sheet(name), row, at);
  return isUndo ? t("Undone: {cell}", { cell }) : t("Redone: {cell}", { cell });
}

class Frame {
  #store;
  #parts = {};
  #isReloading = false;

  constructor(store) {
    this.#store = store;
    this.tabs = new Tabs(store);
    this.watch = new Watch(store);
    const notices = el("div", { id: "notices", role: "region", "aria-label": t("Notices") });
    const skip = (event) => (event.preventDefault(), this.tabs.main.focus());
    document.body.append(el("a", { class: "skip", href: "#view", text: t("Skip to the content"), on: { click: skip } }), this.#header(), this.tabs.main, notices);
    store.addEventListener("book", () => this.#showBook());
    store.addEventListener("state", () => this.#showState());
    store.addEventListener("live", () => this.#showCounts());
    this.watch.addEventListener("connection", () => this.#showState());
    addEventListener("keydown", (event) => this.#onKey(event));
    addEventListener("beforeunload", (event) => {
      const { book, state, waiting } = store;
      const isLost = waiting || (book && state.unsaved && (state.save_error || state.changed_outside || book.mode === "held"));
      if (isLost && !this.#isReloading) event.preventDefault();
    });
    this.watch.addEventListener("job", (event) => jobs.compare(event.detail));
    imports.addEventListener("change", () => {
      this.#parts.imported.hidden = !imports.opened || imports.opened.book !== store.state.server;
    });
    acceptDrops(store);
  }

  async start() {
    await imports.attach(this.#store); // first: which view the address names depends on it
    await this.#store.load();
    jobs.attach(this.#store);
    this.tabs.update();
    this.watch.start();
  }

  /** One line, whatever it tells: what is too long is cut off and stands in the title. */
  #header() {
    const p = this.#parts;
    p.name = el("h1", { text: "assess" });
    p.state = el("div", { class: "save-state", role: "status" });
    p.badges = el("ul", { class: "counts", "aria-label": t("Pieces by class") });
    p.progress = el("progress", { class: "simulating", max: 1, hidden: true });
    p.counts = el("div", { class: "counts-line" }, p.progress, p.badges);
    const button = (label, name, run, more = {}) =>
      el("button", { type: "button", class: "quiet square", "aria-label": label, title: label, on: { click: run }, ...more }, icon(name));
    p.undo = button(t("Undo"), "undo", () => this.#store.undo(), { class: "quiet square editing-only" });
    p.redo = button(t("Redo"), "redo", () => this.#store.redo(), { class: "quiet square editing-only" });
    p.missing = el("span");
    p.files = el("button", { type: "button", class: "quiet missing", on: { click: () => showFiles(this.#store) } }, icon("warning"), p.missing);
    p.download = el("a", { class: "button", href: "/api/download", download: "" }, icon("download"), (p.downloads = el("span")));
    p.download.addEventListener("click", (event) => this.#onDownload(event));
    const more = button(t("Menu"), "menu", null, { popovertarget: "menu" });
    p.tools = el("div", { class: "group" }, p.files, p.undo, p.redo);
    return el("header", { class: "top" },
      el("div", { class: "book-name" }, p.name, el("div", { class: "save-line" }, undoneLine(this.#store), p.state)),
      this.tabs.nav, p.counts, p.tools, more, this.#menu());
  }

  /** What is not always needed. */
  #menu() {
    const p = this.#parts;
    const open = el("a", { class: "button editing-only", href: "#start", title: t("Make a new workbook, or open another") }, icon("folder"), t("New or open…"));
    p.imported = el("a", { class: "button", href: "#import", title: t("What was imported, and what was skipped"), hidden: true }, icon("info"), t("Imported"));
    p.items = el("div", { class: "items", on: { click: () => p.menu.hidePopover() } }, open, p.imported);
    const select = choose(languages(), language());
    select.addEventListener("change", async () => {
      await loadTexts(select.value);
      await whenSent(this.#store);
      this.#isReloading = true; // what waits is sent, and the book is the server's: nothing is lost
      location.reload();
    });
    p.menu = el("div", { id: "menu", popover: "auto" }, p.items, labelled(t("Language of the page"), select), labelled(t("Colours"), themeSwitch()));
    return p.menu;
  }

  async #onDownload(event) {
    if (this.#store.waiting === 0) {
      notice(t("In the downloaded workbook Excel shows the class by the formula. The simulated class is on this page and in the reports."), { key: "download" });
      setTimeout(() => this.watch.look(), 500); // the server knows then that it was downloaded
      return;
    }
    event.preventDefault();
    await whenSent(this.#store);
    this.#parts.download.click();
  }

  #onKey(event) {
    if (event.defaultPrevented || !(event.ctrlKey || event.metaKey) || event.altKey || !this.#store.book) return;
    if (event.target.closest?.(OWN_UNDO)) return;
    const run = { z: event.shiftKey ? "redo" : "undo", y: "redo" }[event.key.toLowerCase()];
    if (!run) return;
    event.preventDefault();
    this.#store[run]();
  }

  #showBook() {
    const p = this.#parts;
    const { book } = this.#store;
    p.name.textContent = book?.name ?? "assess";
    p.tools.hidden = p.counts.hidden = p.items.hidden = !book;
    const isHeld = book?.mode === "held"; // then this is how it is saved
    p.downloads.textContent = isHeld ? t("Download") : t("Download a copy");
    (isHeld ? p.tools : p.items).append(p.download);
    this.tabs.update();
  }

  #showState() {
    const p = this.#parts;
    const { book, state } = this.#store;
    const [words, isBad] = saveState(this.#store, this.watch.isGone);
    if (p.state.textContent !== words) p.state.textContent = words;
    p.state.title = words;
    p.state.classList.toggle("bad", isBad);
    p.undo.disabled = !state.can_undo;
    p.redo.disabled = !state.can_redo;
    const n = book?.missing?.length ?? 0;
    p.files.hidden = n === 0;
    p.missing.textContent = n;
    p.files.title = tn("{n} file missing", "{n} files missing", n);
    p.files.setAttribute("aria-label", p.files.title);
  }

  #showCounts() {
    const p = this.#parts;
    const { counts, simulation, isSimulating } = this.#store;
    clear(p.badges).append(...countBadges(counts, isSimulating || simulation.state === "failed"));
    p.progress.hidden = !isSimulating;
    p.progress.value = simulation.of ? simulation.done / simulation.of : 0;
    p.counts.title = simulationText(simulation);
    p.progress.setAttribute("aria-label", p.counts.title);
  }
}

/** How far the simulation is, in a sentence. */
export function simulationText({ state, done, of, message }) {
  if (state === "failed") return message;
  if (state === "waiting") return t("Other users simulate at the moment. Until it is this workbook's turn, ≈ marks classes by the formula.");
  if (state === "running") return t("Simulated: {done:,} of {of:,} rows. ≈ marks classes by the formula until then.", { done, of });
  return t("Pieces by class, as simulated and as reports have them. Those under – are anchored, or have no class.");
}

export const buildFrame = (store) => new Frame(store);
