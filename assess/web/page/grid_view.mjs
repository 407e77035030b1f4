// The tab of the sheets: one grid or form, its tools and the problems.

import { el } from "./elements.mjs";
import { fixButtons } from "./fixes.mjs";
import { isComputed, problemText } from "./grid_cells.mjs";
import { CLASSES, describe } from "./classes.mjs";
import { Actions } from "./grid_actions.mjs";
import { Editor } from "./grid_editor.mjs";
import { FindBar } from "./grid_find.mjs";
import { Form } from "./grid_form.mjs";
import { Grid } from "./grid.mjs";
import { Keys } from "./grid_keys.mjs";
import { ColumnMenu, ContextMenu, describeOrder } from "./grid_menu.mjs";
import { Pointer } from "./grid_pointer.mjs";
import { icon } from "./icons.mjs";
import { ProblemsList } from "./problems_list.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const EDITED_FROM = "(min-width: 900px)";
const KEPT = "assess-sheet";
const FIRST = "Items";
const SAY_MS = 150;

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
    this.find = new FindBar(this);
    this.menu = new ColumnMenu(this);
    this.context = new ContextMenu(this);
    new Keys(this);
    new Pointer(this);
    this.#build(root);
    this.#listen();
  }

  // ---- elements

  #build(root) {
    this.tabs = el("div", { class: "sheet-tabs", role: "tablist", "aria-label": t("Sheets") });
    this.tools = el("div", { class: "sheet-tools", role: "toolbar", "aria-label": t("Rows") });
    this.order = el("div", { class: "sheet-order", hidden: true });
    this.reading = el("p", { class: "sheet-reading", hidden: true, text: t("To edit, make the window at least 900 pixels wide; here the workbook can be read.") });
    this.where = el("b", { class: "sheet-cell" });
    this.about = el("span", { class: "sheet-about" });
    this.sums = el("span", { class: "sheet-sums" });
    this.chips = el("div", { class: "sheet-chips", role: "group", "aria-label": t("Show only these rows") });
    this.problems = new ProblemsList(this.store);
    this.line = el("div", { class: "sheet-line" }, this.where, el("span", { class: "sheet-abouts" }, this.about), this.sums, this.order, this.problems.button);
    this.lacking = el("p", { class: "sheet-lacking", hidden: true });
    this.help = el("p", { class: "unseen", id: "grid-help", text: t("Arrow keys move, typing replaces, F2 edits, Alt and Down opens the choices, Escape and then Tab leaves the table.") });
    this.live = el("div", { class: "unseen", role: "status", "aria-live": "polite" });
    this.panel = el("div", { class: "sheet-panel", role: "tabpanel", id: "sheet-panel" }, this.lacking, this.grid.box, this.form.node, this.problems.node);
    const tool = (name, text, keys, click) => el("button", { type: "button", class: "quiet", title: keys ? `${text} (${keys})` : text, "aria-label": text, on: { click } }, icon(name), el("span", { text }));
    const edit = (name, text, run) => tool(name, text, "", () => (run(), this.editor.focus()));
    this.editing = [
      edit("add-row", t("Add a row"), () => this.actions.addRow()),
      edit("copy", t("Duplicate rows"), () => this.actions.duplicateRows()),
    ];
    this.tools.append(...this.editing, tool("search", t("Find"), "Ctrl+F", () => this.find.open()),
      tool("more", t("Cells and rows"), "Shift+F10", () => this.context.open()));
    this.editor.input.setAttribute("aria-describedby", "grid-help");
    root.classList.add("sheet-view");
    root.append(el("div", { class: "sheet-bar" }, this.tabs, this.chips, this.tools, this.find.node), this.reading, this.panel, this.line, this.menu.node, this.context.node, this.help, this.live);
  }

  #drawTabs() {
    const sheets = this.store.sheets;
    render(sheets.map((sheet) => {
      const isOpen = sheet === this.sheet;
      const errors = this.store.problems.filter((one) => one.sheet === sheet.name && one.severity === "error").length;
      const mark = errors ? html`<span class="sheet-errors" title=${tn("{n:,} error", "{n:,} errors", errors)}>✖ ${errors}</span>` : nothing;
      return html`<button type="button" role="tab" class=${sheet.found ? "" : "lacking"} aria-selected=${isOpen} aria-controls="sheet-panel" tabindex=${isOpen ? 0 : -1} data-sheet=${sheet.name} @click=${() => this.open(sheet.name)}>${sheet.title}${mark}</button>`;
    }), this.tabs);
  }

  // ---- listening

  #listen() {
    const { store, grid } = this;
    store.addEventListener("book", () => this.#opened());
    store.addEventListener("cells", ({ detail }) => this.#changed(detail));
    store.addEventListener("live", () => (this.#draw(), this.#drawChips()));
    store.addEventListener("problems", () => (this.#drawTabs(), this.#drawChips(), this.#draw(), this.#drawLine()));
    store.addEventListener("rows", ({ detail: { sheet, shift, move } }) => {
      if (this.sheet?.name !== sheet) return;
      this.grid.order.shift(move, shift);
      this.editor.shift(sheet, move);
    });
    store.addEventListener("history", ({ detail }) => this.#isShown && this.#showChange(detail));
    store.addEventListener("reveal", ({ detail }) => this.reveal(detail));
    store.addEventListener("selection", ({ detail }) => detail.source !== "grid" && (this.#waiting = { ...store.selection }));
    grid.addEventListener("select", () => this.#selected());
    this.tabs.addEventListener("keydown", (event) => this.#tabKey(event));
    for (const kind of ["copy", "cut", "paste"]) grid.box.addEventListener(kind, (event) => {
      if (this.editor.mode || event.target !== this.editor.input) return;
      event.preventDefault();
      this.actions[kind](event.clipboardData);
    });
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
    this.grid.canEdit = this.form.canEdit = canEdit;
    this.reading.hidden = canEdit;
    for (const button of this.editing) button.hidden = !canEdit;
    this.#draw();
  }

  /** Ctrl+F finds and Ctrl+H replaces in the grid, wherever the focus is on this tab. */
  #globalKey(event) {
    const key = event.key.toLowerCase();
    if (!this.#isShown || event.defaultPrevented || !(event.ctrlKey || event.metaKey) || !"fh".includes(key)) return;
    if (this.sheet?.layout === "form" || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    this.find.open(key === "h");
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
    const isGrid = sheet.found && !isForm;
    this.form.node.hidden = !isForm || !sheet.found;
    for (const one of [this.grid.box, this.tools, this.where, this.about, this.sums]) one.hidden = !isGrid;
    this.order.hidden = true;
    this.lacking.hidden = sheet.found;
    this.lacking.textContent = sheet.found ? "" : t("This workbook has no sheet {sheet}, or one without its headers.", { sheet: sheet.title });
    if (!this.find.node.hidden) this.find.close();
    this.#drawTabs();
    if (!sheet.found) return;
    if (isForm) this.form.open(sheet);
    else this.grid.open(sheet);
    this.#drawOrder();
    this.#drawChips();
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

  reorder() {
    const { active } = this.grid;
    this.grid.order.apply();
    this.grid.refreshColumns();
    if (active && this.grid.order.indexOf(active.row) < 0) this.grid.selection.set([0, active.c]); // it has been filtered out
    else this.grid.selection.keepInside();
    this.grid.box.scrollTop = 0;
    this.grid.draw();
    this.#drawOrder();
  }

  #drawOrder() {
    const text = this.sheet.layout === "form" ? "" : describeOrder(this.grid.order);
    this.order.hidden = text === "";
    const all = () => {
      const { order } = this.grid;
      order.sort = null;
      order.filters.clear();
      order.only.clear();
      this.reorder();
      this.editor.focus();
    };
    render(html`<span role="status">${text}</span>
      <button type="button" class="quiet" @click=${() => this.reorder()}>${t("Sort and filter again")}</button>
      <button type="button" class="quiet" @click=${all}>${t("Show all")}</button>`, this.order);
  }

  /** Classes with the number of their pieces, and rows with problems: each shows only these rows, or all again. */
  #drawChips() {
    const { store, sheet } = this;
    if (!sheet) return;
    const isTable = sheet.found && sheet.layout !== "form";
    const n = isTable ? store.rowsWithProblems(sheet.name).size : 0;
    const { only } = (isTable && this.grid.order) || { only: new Set() };
    const classes = sheet.name === "Items" ? [...CLASSES, ""].filter((key) => store.counts[key] || only.has(key)) : [];
    const chip = (key, css, label, text) => {
      const click = () => (only.delete(key) || only.add(key), this.reorder(), this.#drawChips());
      return html`<button type="button" class="sheet-chip ${css}" aria-pressed=${only.has(key)} title=${label} aria-label=${label} data-only=${key} @click=${click}>${text}</button>`;
    };
    const pale = store.isSimulating ? "pale" : "";
    render(html`${classes.map((key) => {
      const { sign, word, css } = describe(key);
      const count = store.counts[key] ?? 0;
      return chip(key, `${css} ${pale}`, t("{word}: {n:,}", { word, n: count }), `${sign} ${number(count)}`);
    })}${n || only.has("problems") ? chip("problems", "", t("With problems {n:,}", { n }), html`<span class="wide">${t("With problems {n:,}", { n })}</span><span class="narrow">! ${number(n)}</span>`) : nothing}`, this.chips);
  }

  // ---- selection

  #selected() {
    const { active, order, selection, sheet } = this.grid;
    if (!active) return;
    const say = () => {
      const problem = this.store.problemAt(sheet.name, active.row, active.column.at);
      const cell = [active.name, active.column.label, this.grid.text(active.r, active.c) || t("blank")];
      const more = [isComputed(active.column) && t("computed"), problem && problemText(problem), this.#drawSums()];
      this.say([...cell, ...more].filter(Boolean).join(", "));
    };
    clearTimeout(this.#timer);
    this.#timer = setTimeout(say, SAY_MS);
    const { quiet } = this.store;
    if (quiet && (quiet[0] !== sheet.name || quiet[1] !== active.row)) this.store.hush(null);
    this.#drawLine();
    const rows = selection.ranges.flatMap(([r0, , r1]) => Array.from({ length: r1 - r0 + 1 }, (_, i) => order.row(r0 + i)));
    this.store.select({ sheet: sheet.name, row: active.row, at: active.column.at ?? 0, rows }, "grid");
  }

  /** Show and return count, sum and average of what is selected, where it is more than one cell. */
  #drawSums() {
    const { selection } = this.grid;
    const [r0, c0, r1, c1] = selection.range;
    const found = selection.others.length || r0 !== r1 || c0 !== c1 ? this.actions.summarise() : null;
    const parts = found?.count ? [t("Count {n:,}", { n: found.count })] : [];
    const round = (value) => number(Number(value.toPrecision(12)));
    if (found?.numbers) parts.push(t("Sum {sum}", { sum: round(found.sum) }), t("Average {average}", { average: number(Number((found.sum / found.numbers).toPrecision(6))) }));
    this.sums.textContent = parts.join("   ");
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
    const active = this.sheet?.name === sheet && this.sheet.layout !== "form" ? this.grid.active?.row : null;
    if (cells.some(([name, one]) => name === sheet && one === active)) return;
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

export const createView = (root, store) => new GridView(root, store);
