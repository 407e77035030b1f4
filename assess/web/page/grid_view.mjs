// The tab of the sheets: one grid or form, its tools and the problems.

import { clear, el } from "./elements.mjs";
import { fixButtons } from "./fixes.mjs";
import { isComputed, problemText } from "./grid_cells.mjs";
import { Actions } from "./grid_actions.mjs";
import { Editor } from "./grid_editor.mjs";
import { FindBar } from "./grid_find.mjs";
import { Form } from "./grid_form.mjs";
import { Grid } from "./grid.mjs";
import { Keys } from "./grid_keys.mjs";
import { ColumnMenu, describeOrder } from "./grid_menu.mjs";
import { Pointer } from "./grid_pointer.mjs";
import { icon } from "./icons.mjs";
import { ProblemsList } from "./problems_list.mjs";
import { t, tn } from "./texts.mjs";

const EDITED_FROM = "(min-width: 900px)";
const KEPT = "assess-sheet";
const FIRST = "Items";
const SAY_MS = 150;

export function createView(root, store) {
  const view = new GridView(root, store);
  return { show: () => view.show(), hide: () => view.hide() };
}

class GridView {
  #isShown = false;
  #waiting = null;
  #timer = 0;

  constructor(root, store) {
    this.store = store;
    this.grid = new Grid(store);
    this.form = new Form(store);
    this.actions = new Actions(this.grid, store, (text) => this.say(text));
    this.editor = new Editor(this.grid, this.actions, (text) => this.say(text));
    const focus = () => this.editor.focus();
    this.find = new FindBar(this.grid, focus);
    this.menu = new ColumnMenu(this.grid, () => this.#reorder(), focus);
    const act = { find: () => this.find.open(), menu: (c) => this.menu.open(c ?? this.grid.selection.anchor[1]) };
    const parts = { grid: this.grid, editor: this.editor, actions: this.actions, store, act };
    this.keys = new Keys(parts);
    this.pointer = new Pointer(parts);
    this.#build(root);
    this.#listen();
  }

  // ---- elements

  #build(root) {
    this.tabs = el("div", { class: "sheet-tabs", role: "tablist", "aria-label": t("Sheets") });
    this.tools = el("div", { class: "sheet-tools", role: "toolbar", "aria-label": t("Rows") }, this.#toolButtons());
    this.order = el("div", { class: "sheet-order", hidden: true });
    this.reading = el("p", { class: "sheet-reading", hidden: true, text: t("To edit, make the window at least 900 pixels wide; here the workbook can be read.") });
    this.where = el("b", { class: "sheet-cell" });
    this.about = el("span", { class: "sheet-about" });
    this.line = el("div", { class: "sheet-line" }, this.where, this.about);
    this.lacking = el("p", { class: "sheet-lacking", hidden: true });
    this.help = el("p", { class: "unseen", id: "grid-help", text: t("Arrow keys move, typing replaces, F2 edits, Alt and Down opens the choices, Escape and then Tab leaves the table.") });
    this.live = el("div", { class: "unseen", role: "status", "aria-live": "polite" });
    this.panel = el("div", { class: "sheet-panel", role: "tabpanel", id: "sheet-panel" }, this.lacking, this.grid.box, this.form.node);
    this.problems = new ProblemsList(this.store);
    this.editor.input.setAttribute("aria-describedby", "grid-help");
    root.classList.add("sheet-view");
    root.append(el("div", { class: "sheet-bar" }, this.tabs, this.tools, this.find.node), this.reading, this.order, this.panel, this.line, this.problems.node, this.menu.node, this.help, this.live);
  }

  #toolButtons() {
    const tool = (name, text, keys, click) => el("button", { type: "button", class: "quiet", title: keys ? `${text} (${keys})` : text, "aria-label": text, on: { click } }, icon(name), el("span", { text }));
    const button = (name, text, keys, click) => tool(name, text, keys, () => (click(), this.editor.focus()));
    const find = tool("search", t("Find"), "Ctrl+F", () => this.find.open());
    this.editing = [
      button("add-row", t("Add a row"), "", () => this.actions.addRow()),
      button("copy", t("Duplicate rows"), "", () => this.actions.duplicateRows()),
      button("clear-row", t("Clear rows"), "Ctrl+−", () => this.actions.clearRows()),
      button("fill-down", t("Fill down"), "Ctrl+D", () => this.actions.fillDown()),
    ];
    return [...this.editing, find];
  }

  #drawTabs() {
    const sheets = this.store.sheets;
    const focused = document.activeElement?.dataset?.sheet;
    clear(this.tabs).append(...sheets.map((sheet) => {
      const isOpen = sheet === this.sheet;
      const errors = this.store.problems.filter((one) => one.sheet === sheet.name && one.severity === "error").length;
      const mark = errors ? el("span", { class: "sheet-errors", title: tn("{n:,} error", "{n:,} errors", errors), text: `✖ ${errors}` }) : null;
      return el("button", { type: "button", role: "tab", class: sheet.found ? "" : "lacking", "aria-selected": String(isOpen), "aria-controls": "sheet-panel", tabindex: isOpen ? "0" : "-1", dataset: { sheet: sheet.name }, on: { click: () => this.open(sheet.name) } }, sheet.title, mark);
    }));
    if (focused) this.tabs.querySelector(`[data-sheet="${focused}"]`)?.focus();
  }

  // ---- listening

  #listen() {
    const { store, grid } = this;
    store.addEventListener("book", () => this.#opened());
    store.addEventListener("cells", ({ detail }) => this.#changed(detail));
    store.addEventListener("live", () => this.#draw());
    store.addEventListener("problems", () => (this.#drawTabs(), this.#draw(), this.#drawLine()));
    store.addEventListener("history", ({ detail }) => this.#isShown && this.#showChange(detail));
    store.addEventListener("reveal", ({ detail }) => this.reveal(detail));
    store.addEventListener("selection", ({ detail }) => detail.source !== "grid" && (this.#waiting = { ...store.selection }));
    grid.addEventListener("select", () => this.#selected());
    this.tabs.addEventListener("keydown", (event) => this.#tabKey(event));
    for (const kind of ["copy", "cut", "paste"]) grid.box.addEventListener(kind, (event) => this.#clipboard(kind, event));
    this.wide = matchMedia(EDITED_FROM);
    this.wide.addEventListener("change", () => this.#allowEditing());
    addEventListener("keydown", (event) => this.#globalKey(event));
    this.#allowEditing();
    if (store.book) this.#opened();
    if (store.toReveal) this.reveal(store.toReveal);
  }

  #allowEditing() {
    const canEdit = this.wide.matches;
    if (!canEdit) this.editor.commit();
    this.grid.canEdit = canEdit;
    this.form.canEdit = canEdit;
    this.reading.hidden = canEdit;
    for (const button of this.editing) button.hidden = !canEdit;
    this.#draw();
  }

  /** Ctrl+F finds in the grid, wherever the focus is on this tab. */
  #globalKey(event) {
    if (!this.#isShown || event.defaultPrevented || !(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "f") return;
    if (this.sheet?.layout === "form" || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    this.find.open();
  }

  #clipboard(kind, event) {
    if (this.editor.mode || event.target !== this.editor.input) return;
    event.preventDefault();
    this.actions[kind](event.clipboardData);
  }

  #tabKey(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const sheets = this.store.sheets;
    const next = sheets[(sheets.indexOf(this.sheet) + step + sheets.length) % sheets.length];
    event.preventDefault();
    this.open(next.name);
    this.tabs.querySelector(`[data-sheet="${next.name}"]`).focus();
  }

  // ---- what changes

  /** Another book, or the same read again: then what is being typed stays. */
  #opened() {
    const { book } = this.store;
    const isSame = book !== null && this.bookName === book.name;
    this.bookName = book?.name;
    if (!isSame) this.editor.drop();
    this.menu.node.hidden = true;
    if (!book) return;
    const kept = this.sheet?.name ?? sessionStorage.getItem(KEPT) ?? FIRST;
    if (!isSame) this.grid.forget();
    this.open(this.store.sheet(kept) ? kept : FIRST, isSame);
  }

  /** Show a sheet; `keepsTyping` where it is the one that is shown. */
  open(name, keepsTyping = false) {
    const sheet = this.store.sheet(name);
    if (!sheet) return;
    if (!keepsTyping) this.editor.commit();
    this.sheet = sheet;
    sessionStorage.setItem(KEPT, name);
    const isForm = sheet.layout === "form";
    this.grid.box.hidden = isForm || !sheet.found;
    this.form.node.hidden = !isForm || !sheet.found;
    this.tools.hidden = isForm || !sheet.found;
    this.line.hidden = isForm || !sheet.found;
    this.order.hidden = true;
    this.lacking.hidden = sheet.found;
    this.lacking.textContent = sheet.found ? "" : t("This workbook has no sheet {sheet}, or one without its headers.", { sheet: sheet.title });
    if (!this.find.node.hidden) this.find.close();
    this.#drawTabs();
    if (!sheet.found) return;
    if (isForm) this.form.open(sheet);
    else this.grid.open(sheet);
    this.#drawOrder();
  }

  #changed(cells) {
    if (!this.sheet || !cells.some(([name]) => name === this.sheet.name)) return;
    if (this.sheet.layout !== "form") {
      this.grid.order.extend();
      this.grid.selection.keepInside();
      this.find.refresh();
    }
    this.#draw();
  }

  #draw() {
    if (!this.#isShown || !this.sheet?.found) return;
    if (this.sheet.layout === "form") this.form.draw();
    else this.grid.ask();
  }

  #reorder() {
    this.grid.order.apply();
    this.grid.refreshColumns();
    this.grid.selection.keepInside();
    this.grid.box.scrollTop = 0;
    this.grid.draw();
    this.#drawOrder();
  }

  #drawOrder() {
    const text = this.sheet.layout === "form" ? "" : describeOrder(this.grid.order);
    this.order.hidden = text === "";
    const all = () => {
      this.grid.order.sort = null;
      this.grid.order.filters.clear();
      this.#reorder();
      this.editor.focus();
    };
    clear(this.order).append(el("span", { role: "status", text }), " ",
      el("button", { type: "button", class: "quiet", text: t("Sort and filter again"), on: { click: () => this.#reorder() } }), " ",
      el("button", { type: "button", class: "quiet", text: t("Show all"), on: { click: all } }));
  }

  // ---- selection

  #selected() {
    const { active, order, selection, sheet } = this.grid;
    if (!active) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.say(this.#describe(active)), SAY_MS);
    this.#drawLine();
    const [r0, , r1] = selection.range;
    const rows = Array.from({ length: r1 - r0 + 1 }, (_, i) => order.row(r0 + i));
    this.store.select({ sheet: sheet.name, row: active.row, at: active.column.at ?? 0, rows }, "grid");
  }

  #describe({ r, c, row, column, name }) {
    const problem = this.store.problemAt(this.sheet.name, row, column.at);
    const parts = [name, column.label, this.grid.text(r, c) || t("blank")];
    if (isComputed(column)) parts.push(t("computed"));
    if (problem) parts.push(problemText(problem));
    return parts.join(", ");
  }

  /** The line that tells the active cell, what its column is for, and its problem. */
  #drawLine() {
    const { active } = this.grid;
    if (!active || !this.sheet || this.sheet.layout === "form") return;
    const problem = this.store.problemAt(this.sheet.name, active.row, active.column.at);
    this.where.textContent = active.name;
    this.about.className = `sheet-about ${problem?.severity ?? ""}`;
    this.about.textContent = problem ? `${problemText(problem)} ` : [active.column.label, active.column.help].filter(Boolean).join(": ");
    this.about.append(...fixButtons(this.store, problem));
  }

  /** Tell something to those who hear the page. */
  say(text) {
    clearTimeout(this.#timer);
    this.live.textContent = text;
  }

  /** Show a cell; once the tab is shown, where it is not yet. */
  reveal(cell) {
    const [sheet, row, at] = cell;
    this.store.toReveal = null;
    this.#waiting = { sheet, row, at, takesFocus: true };
    if (this.#isShown) this.#goToWaiting();
  }

  #goToWaiting() {
    const to = this.#waiting;
    this.#waiting = null;
    if (!to?.row || !this.store.sheet(to.sheet)) return;
    if (this.sheet?.name !== to.sheet) this.open(to.sheet);
    if (!this.sheet.found) return;
    if (this.sheet.layout === "form") this.form.goTo(to.row);
    else {
      this.grid.goTo(to.row, to.at ?? this.grid.columns[0]?.at);
      if (to.takesFocus) this.editor.focus();
    }
  }

  /** After undo and redo: show what changed. */
  #showChange(cells) {
    if (cells.length === 0) return;
    const [sheet, row, at] = cells[0];
    if (this.sheet?.name === sheet && this.sheet.layout !== "form") {
      const active = this.grid.active?.row;
      if (cells.some(([name, one]) => name === sheet && one === active)) return;
    }
    this.#waiting = { sheet, row, at, takesFocus: true };
    this.#goToWaiting();
  }

  show() {
    this.#isShown = true;
    if (!this.sheet && this.store.book) this.#opened();
    if (this.#waiting) this.#goToWaiting();
    if (this.sheet?.found && this.sheet.layout !== "form") (this.grid.layOut(), this.grid.draw());
    if (this.grid.canEdit && !this.grid.box.hidden) this.editor.focus();
    this.#draw();
  }

  hide() {
    this.editor.commit();
    this.menu.node.hidden = true;
    this.#isShown = false;
  }
}
