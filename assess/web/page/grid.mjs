// The table of one sheet and what is selected in it: only the rows and columns in sight are elements. Typing, pointer and
// keys are in grid_editor.mjs, grid_pointer.mjs and grid_keys.mjs.

import { clear, el } from "./elements.mjs";
import { cellText, cellValue, classColumn, describeCell, hasChoices, isClass, isComputed, problemText } from "./grid_cells.mjs";
import { RowOrder } from "./grid_rows.mjs";
import { icon } from "./icons.mjs";
import { cellName } from "./sheet.mjs";
import { t } from "./texts.mjs";

export const ROW_HEIGHT = 28;
const HEAD_HEIGHT = 46;
const GROUP_HEIGHT = 24;
const FOLDED = "assess-folded";
const FOLDED_AT_FIRST = ["Details", "Working values"];
const NUMBERS_WIDTH = 52;
const MARGIN_ROWS = 6;
const MARGIN_PX = 200;
const CHARACTER = 7.2;
const HEAD_CHARACTER = 8.4;
const PADDING = 26;
const NARROWEST = 44;
const WIDEST = 340;
const NARROW_PAGE = 600;
const NARROW_COLUMN = 108;
const NARROW_CLASS = 138; // without the range

const isIn = ([r0, c0, r1, c1], r, c) => r >= r0 && r <= r1 && c >= c0 && c <= c1;
const clamp = (value, count) => Math.max(0, Math.min(count - 1, value));

/** From the anchor, the active cell, to the head, which Shift moves: rows of the view, columns among those shown. */
class Selection {
  anchor = [0, 0];
  head = [0, 0];
  /** Ranges that were selected before, and kept by Ctrl. */
  others = [];

  constructor(grid) {
    this.grid = grid;
  }

  /** First row, first column, last row, last column. */
  get range() {
    const [[r, c], [q, d]] = [this.anchor, this.head];
    return [Math.min(r, q), Math.min(c, d), Math.max(r, q), Math.max(c, d)];
  }

  get ranges() {
    return [...this.others, this.range];
  }

  /** Whether whole rows are selected. */
  get isRows() {
    const [, c0, , c1] = this.range;
    return c0 === 0 && c1 === this.grid.columns.length - 1;
  }

  has(r, c) {
    return this.ranges.some((range) => isIn(range, r, c));
  }

  hasRow(r) {
    return this.ranges.some(([r0, , r1]) => r >= r0 && r <= r1);
  }

  /** Keep it inside after rows or columns have gone. */
  keepInside(from = this.anchor, to = this.head, keeps = false) {
    if (!keeps) this.others = [];
    const { order, columns } = this.grid;
    [this.anchor, this.head] = [from, to].map(([r, c]) => [clamp(r, order?.length ?? 0), clamp(c, columns.length)]);
  }

  setRange(from, to, keeps) {
    this.keepInside(from, to, keeps);
    this.grid.dispatchEvent(new Event("select"));
    this.grid.ask();
  }

  /** Select one cell, or with `extend` up to it. */
  set(cell, extend = false) {
    this.setRange(extend ? this.anchor : cell, cell, extend);
  }

  move(down, right, extend = false) {
    const [r, c] = extend ? this.head : this.anchor;
    this.set([r + down, c + right], extend);
  }

  /** To the edge of what is filled, as Ctrl and an arrow do in a spreadsheet. */
  jump(down, right, extend = false) {
    let [r, c] = extend ? this.head : this.anchor;
    const { order, columns } = this.grid;
    const isIndex = (at, { length }) => at >= 0 && at < length;
    const isNext = () => isIndex(r + down, order) && isIndex(c + right, columns);
    const has = (q, d) => this.grid.text(q, d) !== "";
    const step = () => ((r += down), (c += right));
    const runs = isNext() && has(r, c) && has(r + down, c + right);
    if (isNext()) step();
    if (runs) while (isNext() && has(r + down, c + right)) step();
    else while (isNext() && !has(r, c)) step();
    this.set([r, c], extend);
  }

  rows() {
    const [r0, , r1] = this.range;
    this.setRange([r0, 0], [r1, this.grid.columns.length - 1]);
  }

  columns() {
    const [, c0, , c1] = this.range;
    this.setRange([0, c0], [this.grid.order.length - 1, c1]);
  }
}
export class Grid extends EventTarget {
  canEdit = true;
  /** What the find bar looks for, in small letters. */
  found = "";
  /** The range over which the fill handle is dragged. */
  fillTarget = null;
  #rows = [];
  #asked = 0;
  /** By sheet: its order, and where it was left. */
  #kept = new Map();

  constructor(store) {
    super();
    this.store = store;
    this.columns = [];
    this.folded = new Set(JSON.parse(localStorage.getItem(FOLDED) ?? "null") ?? FOLDED_AT_FIRST);
    this.groups = el("div", { class: "grid-groups", role: "group", "aria-label": t("Groups of columns") });
    this.head = el("div", { class: "grid-row grid-head", role: "row", "aria-rowindex": 1 });
    this.table = el("div", { class: "grid-table", role: "grid", id: "grid", "aria-multiselectable": "true" }, this.head);
    this.handle = el("div", { class: "grid-handle", title: t("Drag to fill") });
    this.frame = el("div", { class: "grid-frame", "aria-hidden": "true" });
    this.box = el("div", { class: "grid-box" }, this.groups, this.table, this.frame, this.handle);
    this.selection = new Selection(this);
    this.box.addEventListener("scroll", () => this.ask(), { passive: true });
    new ResizeObserver(() => (this.layOut(), this.ask())).observe(this.box);
  }

  // ---- what is shown

  /** Show another sheet, where it was left. */
  open(sheet) {
    const { box, selection } = this;
    if (this.sheet) {
      const { anchor, head } = selection;
      Object.assign(this.#kept.get(this.sheet.name), { top: box.scrollTop, left: box.scrollLeft, anchor, head });
    }
    this.sheet = sheet;
    const kept = this.#kept.get(sheet.name) ?? { top: 0, left: 0, anchor: [0, 0], head: [0, 0] };
    this.order = kept.order?.sheet === sheet ? kept.order : new RowOrder(this.store, sheet, kept.order);
    this.#kept.set(sheet.name, { ...kept, order: this.order });
    this.refreshColumns();
    selection.setRange(kept.anchor, kept.head);
    box.scrollTo(kept.left, kept.top);
    this.table.setAttribute("aria-label", sheet.title);
    this.draw();
  }

  /** Forget where sheets were left, and their order: another workbook is open. */
  forget() {
    this.sheet = null;
    this.#kept.clear();
  }

  /** Build the columns anew: after another sheet. */
  refreshColumns() {
    const shown = this.sheet.columns.filter((column) => !column.hidden);
    const at = shown.findIndex(isClass);
    if (at >= 0) shown[at] = classColumn(shown[at]);
    else if (this.sheet.name === "Items") shown.splice(1, 0, classColumn());
    const isFrozen = (column) => (column.at === null ? isClass(column) : column.at < this.sheet.frozen);
    this.all = shown.map((column) => ({ ...column, isFrozen: isFrozen(column) }));
    this.all.sort((one, other) => other.isFrozen - one.isFrozen);
    this.columns = this.all.filter((column) => column.isFrozen || !this.folded.has(column.group));
    this.layOut();
    this.#drawHead();
  }

  /** Hide the columns of a group, or show them again; in this browser it stays so. */
  fold(group, isFolded = !this.folded.has(group)) {
    const { active } = this;
    if (isFolded) this.folded.add(group);
    else this.folded.delete(group);
    localStorage.setItem(FOLDED, JSON.stringify([...this.folded]));
    this.refreshColumns();
    const c = this.columns.findIndex((column) => column.at === active?.column.at);
    if (c >= 0) this.selection.set([active.r, c]);
    else this.selection.keepInside();
    this.draw();
  }

  /** The columns from one that is shown to another, with the folded ones between them; of whole rows all. */
  span(c0, c1) {
    const isAll = c0 === 0 && c1 === this.columns.length - 1;
    return this.all.slice(this.all.indexOf(this.columns[c0]), isAll ? this.all.length : this.all.indexOf(this.columns[c1]) + 1);
  }

  #widthKey(column) {
    return `assess-width:${this.sheet.name}:${column.label}`;
  }

  widthOf(column) {
    const kept = Number(localStorage.getItem(this.#widthKey(column)));
    const width = kept || Math.min(WIDEST, PADDING + Math.max((column.width || 10) * CHARACTER, headLength(column) * HEAD_CHARACTER));
    return this.isNarrow && column.isFrozen ? Math.min(width, isClass(column) ? NARROW_CLASS : NARROW_COLUMN) : Math.max(NARROWEST, Math.round(width));
  }

  setWidth(c, width) {
    localStorage.setItem(this.#widthKey(this.columns[c]), String(Math.max(NARROWEST, Math.round(width))));
    this.layOut();
    this.#drawHead();
    this.draw();
  }

  /** Make a column as wide as its longest text. */
  fitWidth(c) {
    const column = this.columns[c];
    const texts = this.sheet.rowNumbers.map((row) => cellText(this.store, this.sheet, row, column)).sort((a, b) => b.length - a.length).slice(0, 50);
    const pen = (this.pen ??= document.createElement("canvas").getContext("2d"));
    pen.font = getComputedStyle(this.box).font;
    const header = `${column.label} ${column.unit}`;
    this.setWidth(c, Math.min(3 * WIDEST, Math.max(...[...texts, header].map((text) => pen.measureText(text).width)) + PADDING + 10));
  }

  layOut() {
    if (!this.sheet) return;
    this.isNarrow = this.box.clientWidth > 0 && this.box.clientWidth < NARROW_PAGE;
    this.numbersWidth = this.isNarrow ? 0 : NUMBERS_WIDTH;
    let x = this.numbersWidth;
    this.frozenWidth = x;
    this.bands = []; // the groups from the left: of a folded one a gap is left, in which its heading stands
    for (const column of this.all) {
      const isFolded = !column.isFrozen && this.folded.has(column.group);
      const isNew = column.group && !column.isFrozen && this.bands.at(-1)?.group !== column.group;
      if (isNew) this.bands.push({ group: column.group, heading: column.heading, x, px: 0, isFolded });
      if (isFolded && !isNew) continue;
      if (!isFolded) Object.assign(column, { x, px: this.widthOf(column) });
      const px = isFolded ? 34 + CHARACTER * column.heading.length : column.px;
      if (column.group && !column.isFrozen) this.bands.at(-1).px += px;
      x += px;
      if (column.isFrozen) this.frozenWidth = x;
    }
    this.width = x;
    this.headHeight = HEAD_HEIGHT + (this.bands.length ? GROUP_HEIGHT : 0);
    this.box.style.setProperty("--groups", `${this.headHeight - HEAD_HEIGHT}px`);
    this.table.style.width = `${x}px`;
    this.box.classList.toggle("narrow", this.isNarrow);
    const isOther = this.drawnNarrow !== this.isNarrow;
    this.drawnNarrow = this.isNarrow;
    if (isOther && this.head.childElementCount) this.#drawHead();
  }

  get height() {
    return HEAD_HEIGHT + this.order.length * ROW_HEIGHT;
  }

  // ---- drawing

  /** Draw before the next frame. */
  ask() {
    this.#asked ||= requestAnimationFrame(() => {
      this.#asked = 0;
      this.draw();
    });
  }

  #drawHead() {
    const corner = el("div", { class: "grid-groups-corner", style: { width: `${this.frozenWidth}px` } });
    clear(this.groups).append(corner, ...this.bands.map(({ group, heading, x, px, isFolded }) => el("button", {
      type: "button", class: "grid-group", "aria-expanded": String(!isFolded), dataset: { group },
      style: { left: `${x}px`, width: `${px}px` }, on: { click: () => this.fold(group) },
    }, icon(isFolded ? "right" : "down"), heading)));
    this.groups.hidden = this.bands.length === 0;
    const number = el("div", {
      class: "grid-cell grid-number frozen", role: "columnheader", "aria-colindex": 1, "aria-label": t("Row"),
      hidden: this.isNarrow, style: { width: `${this.numbersWidth}px` },
    });
    clear(this.head).append(number, ...this.columns.map((column, c) => this.#headCell(column, c)));
    this.head.style.width = this.groups.style.width = `${this.width}px`;
  }

  #headCell({ label, unit, help, required, isFrozen, x, px }, c) {
    const { sort, filters } = this.order;
    const rule = sort?.column.label === label ? (sort.down ? "descending" : "ascending") : null;
    const inUnit = unit ? ` [${unit}]` : "";
    return el("div", {
      class: `grid-cell${required ? " required" : ""}${isFrozen ? " frozen" : ""}`, role: "columnheader",
      title: [label + inUnit, help].filter(Boolean).join("\n"), "aria-colindex": c + 2, "aria-sort": rule,
      dataset: { column: c, label }, style: { left: `${x}px`, width: `${px}px` },
    }, el("span", { class: "grid-label" }, label, unit && el("span", { class: "grid-unit", text: inUnit })), el("button", {
      type: "button", class: `grid-menu-button${rule || filters.has(label) ? " used" : ""}`, tabindex: "-1",
      "aria-label": t("Sort and filter {column}", { column: label }),
    }, icon(rule === "ascending" ? "up" : "down")), el("div", { class: "grid-edge", "aria-hidden": "true" }));
  }

  /** Rows and columns in sight, with a margin: first and one past the last. */
  #window() {
    const { scrollTop, scrollLeft, clientHeight, clientWidth } = this.box;
    const first = Math.max(0, Math.floor(scrollTop / ROW_HEIGHT) - MARGIN_ROWS);
    const last = Math.min(this.order.length, Math.ceil((scrollTop + clientHeight - this.headHeight) / ROW_HEIGHT) + MARGIN_ROWS);
    const inSight = (column) => column.isFrozen || (column.x + column.px > scrollLeft - MARGIN_PX && column.x < scrollLeft + clientWidth + MARGIN_PX);
    return { first, last, columns: this.columns.flatMap((column, c) => (inSight(column) ? [c] : [])) };
  }

  draw() {
    if (!this.sheet || !this.box.clientHeight) return;
    this.table.style.height = `${this.height}px`;
    this.table.setAttribute("aria-rowcount", this.order.length + 1);
    this.table.setAttribute("aria-colcount", this.columns.length + 1);
    const { first, last, columns } = this.#window();
    this.#makeRows(last - first);
    for (let r = first; r < last; r++) this.#drawRow(this.#rows[r % this.#rows.length], r, columns, this.selection.hasRow(r));
    for (const row of this.#rows) if (row.r < first || row.r >= last) Object.assign(row, { r: -1 }).node.hidden = true;
    this.#drawFrame();
    this.dispatchEvent(new Event("drawn"));
  }

  /** As many row elements as are needed; they are used again for other rows while scrolling. */
  #makeRows(count) {
    if (this.#rows.length >= count && this.#rows.length <= count + 4 * MARGIN_ROWS) return;
    for (const row of this.#rows) row.node.remove();
    this.#rows = Array.from({ length: count + 2 }, () => {
      const number = el("div", { class: "grid-cell grid-number frozen", role: "rowheader", "aria-colindex": 1 });
      const node = el("div", { class: "grid-row", role: "row", hidden: true }, number);
      this.table.append(node);
      return { node, number, cells: [], r: -1 };
    });
  }

  #drawRow(row, r, columns, isSelected) {
    const number = this.order.row(r);
    row.node.hidden = false;
    if (row.r !== r) {
      row.r = r;
      row.node.style.transform = `translateY(${HEAD_HEIGHT + r * ROW_HEIGHT}px)`;
      row.node.setAttribute("aria-rowindex", r + 2);
    }
    row.node.style.width = `${this.width}px`;
    row.number.textContent = number;
    row.number.hidden = this.isNarrow;
    row.number.style.width = `${this.numbersWidth}px`;
    row.number.classList.toggle("selected", isSelected);
    while (row.cells.length > columns.length) row.cells.pop().remove();
    while (row.cells.length < columns.length) {
      row.cells.push(el("div", { class: "grid-cell", role: "gridcell" }));
      row.node.append(row.cells.at(-1));
    }
    columns.forEach((c, i) => this.#drawCell(row.cells[i], r, c, number));
  }

  #drawCell(node, r, c, number) {
    const column = this.columns[c];
    const { text, css, problem } = describeCell(this.store, this.sheet, number, column, this.isNarrow);
    if (node.textContent !== text) node.textContent = text;
    const isActive = r === this.selection.anchor[0] && c === this.selection.anchor[1];
    const isSelected = this.selection.has(r, c);
    let look = `grid-cell${column.isFrozen ? " frozen" : ""}${css}${problem ? ` ${problem.severity}` : ""}`;
    if (isSelected) look += isActive ? " active" : " selected";
    if (isActive && this.canEdit && hasChoices(column) && !isComputed(column)) look += " choices";
    if (this.found && text.toLowerCase().includes(this.found)) look += " found";
    if (node.className !== look) node.className = look;
    node.r = r;
    node.c = c;
    const where = `${column.x}|${column.px}`;
    if (node.where !== where) {
      node.where = where;
      node.style.left = `${column.x}px`;
      node.style.width = `${column.px}px`;
    }
    const states = `${c}|${isSelected}|${isActive}|${problem?.severity ?? ""}|${isComputed(column) || !this.canEdit}`;
    if (node.states !== states) this.#setStates(node, states, { c, isSelected, isActive, problem, column });
    const title = problem ? problemText(problem) : css.startsWith(" ghost") ? t("From the Catalogue; typing replaces it.") : "";
    if (node.title !== title) node.title = title;
  }

  #setStates(node, states, { c, isSelected, isActive, problem, column }) {
    node.states = states;
    node.setAttribute("aria-colindex", c + 2);
    node.setAttribute("aria-selected", isSelected);
    node.setAttribute("aria-readonly", isComputed(column) || !this.canEdit);
    if (problem && problem.severity === "error") node.setAttribute("aria-invalid", "true");
    else node.removeAttribute("aria-invalid");
    if (isActive) node.id = "grid-active";
    else node.removeAttribute("id");
  }

  /** Where cells stand inside the box: left, top, width and height; frozen columns follow the scroll. */
  rectangle(r, c, r1 = r, c1 = c) {
    const [first, last] = [this.columns[c], this.columns[c1]];
    const shift = (column) => (column.isFrozen ? this.box.scrollLeft : 0);
    const left = first.x + shift(first);
    const right = Math.max(last.x + last.px + shift(last), left);
    return { left, top: this.headHeight + r * ROW_HEIGHT, width: right - left, height: (r1 - r + 1) * ROW_HEIGHT, isFrozen: first.isFrozen };
  }

  #drawFrame() {
    const [r0, c0, r1, c1] = this.fillTarget ?? this.selection.range;
    this.frame.hidden = !this.columns.length || !this.order.length;
    this.handle.hidden = this.frame.hidden || !this.canEdit;
    if (this.frame.hidden) return;
    const { left, top, width, height, isFrozen } = this.rectangle(r0, c0, r1, c1);
    Object.assign(this.frame.style, { transform: `translate(${left}px, ${top}px)`, width: `${width}px`, height: `${height}px` });
    this.frame.classList.toggle("over", isFrozen);
    this.frame.classList.toggle("filling", Boolean(this.fillTarget));
    this.handle.style.transform = `translate(${left + width - 4}px, ${top + height - 4}px)`;
    this.handle.classList.toggle("over", this.columns[c1].isFrozen);
  }

  // ---- selection

  /** The active cell: its row of the sheet, its column and its name. */
  get active() {
    const [r, c] = this.selection.anchor;
    const row = this.order?.row(r);
    const column = this.columns[c];
    return column && row ? { r, c, row, column, name: cellName(this.sheet, row, column.at ?? 0) } : null;
  }

  /** Scroll so that a cell is in sight. */
  show([r, c] = this.selection.head) {
    const column = this.columns[c];
    if (!column) return;
    const { box } = this;
    const top = r * ROW_HEIGHT;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + ROW_HEIGHT + this.headHeight > box.scrollTop + box.clientHeight) box.scrollTop = top + ROW_HEIGHT + this.headHeight - box.clientHeight;
    if (column.isFrozen) return;
    if (column.x < box.scrollLeft + this.frozenWidth) box.scrollLeft = column.x - this.frozenWidth;
    else if (column.x + column.px > box.scrollLeft + box.clientWidth) box.scrollLeft = Math.min(column.x - this.frozenWidth, column.x + column.px - box.clientWidth);
  }

  /** Select a cell by its row of the sheet and its column, and scroll to it; false where a filter hides it. */
  goTo(row, at) {
    const hidden = this.all.find((column) => column.at === at && !this.columns.includes(column));
    if (hidden) this.fold(hidden.group, false);
    const c = Math.max(0, this.columns.findIndex((column) => column.at === at));
    this.order.include(row);
    const r = this.order.indexOf(row);
    if (r < 0) return false;
    this.table.style.height = `${this.height}px`;
    this.selection.set([r, c]);
    this.show();
    return true;
  }

  value(r, c) {
    return cellValue(this.store, this.sheet, this.order.row(r), this.columns[c]);
  }

  text(r, c) {
    return cellText(this.store, this.sheet, this.order.row(r), this.columns[c]);
  }
}

/** Characters of the longer line of a header, its unit included, when it is broken into two. */
function headLength({ label, unit }) {
  const words = [...label.split(/\s+/), ...(unit ? [`[${unit}]`] : [])];
  return Math.min(...words.map((_, at) => Math.max(words.slice(0, at + 1).join(" ").length, words.slice(at + 1).join(" ").length)));
}
