// What is done to the selected cells: clear, fill, copy, cut, paste, rows. Every action is one edit and one step of undo.

import { readBlock, writeBlock } from "./clipboard.mjs";
import { hasChoices, isComputed, showValue } from "./grid_cells.mjs";
import { continueSeries } from "./grid_fill.mjs";
import { isFilled, nextName } from "./sheet.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const MOST_CELLS = 400_000;

export class Actions {
  constructor(grid, store, say) {
    Object.assign(this, { grid, store, say });
  }

  get canEdit() {
    return this.grid.canEdit && this.grid.sheet?.found;
  }

  edit(edits, label) {
    return this.canEdit ? this.store.edit(edits, label) : Promise.resolve(false);
  }

  /** The selected range, without the blank rows at the end where whole columns are selected. */
  range() {
    const [r0, c0, r1, c1] = this.grid.selection.range;
    const { order, sheet } = this.grid;
    if (r0 > 0 || r1 < order.length - 1) return [r0, c0, r1, c1];
    let last = r1;
    while (last > r0 && !sheet.isUsed(order.row(last))) last -= 1;
    return [r0, c0, last, c1];
  }

  /** Edits of a block of cells: `value(r, c)` for each that can be edited. */
  #edits([r0, c0, r1, c1], value) {
    const { sheet, order, columns } = this.grid;
    const edits = [];
    for (let r = r0; r <= r1; r++) {
      const row = order.rowOrFree(r);
      if (row === null) break;
      for (let c = c0; c <= c1; c++) {
        if (!columns[c] || isComputed(columns[c])) continue;
        const next = value(r, c);
        if (next !== undefined) edits.push([sheet.name, row, columns[c].at, next]);
      }
    }
    return edits;
  }

  clear(label = t("clear")) {
    const filled = (r, c) => (isFilled(this.grid.value(r, c)) ? null : undefined);
    return this.edit(this.#edits(this.range(), filled), label);
  }

  fillSelection(value) {
    return this.edit(this.#edits(this.range(), () => value), t("fill"));
  }

  /** Ctrl+D: the first selected row into those below; of one row, the row above into it. */
  fillDown() {
    const [r0, c0, r1, c1] = this.range();
    const from = r0 === r1 ? r0 - 1 : r0;
    if (from < 0) return null;
    return this.edit(this.#edits([from + 1, c0, r1, c1], (r, c) => this.grid.value(from, c)), t("fill"));
  }

  fillRight() {
    const [r0, c0, r1, c1] = this.range();
    const from = c0 === c1 ? c0 - 1 : c0;
    if (from < 0) return null;
    return this.edit(this.#edits([r0, from + 1, r1, c1], (r) => this.grid.value(r, from)), t("fill"));
  }

  /**
   * Continue the selected cells over a larger range, as the fill handle does.
   * @param {number[]} target the whole range, with what was selected
   * @param {boolean} other Ctrl: copies in place of a series, a series in place of copies
   */
  fillTo(target, other) {
    const [r0, c0, r1, c1] = this.grid.selection.range;
    const [q0, d0, q1, d1] = target;
    const made = new Map();
    const along = (cells, ends, column) => {
      const values = cells.map(([r, c]) => this.grid.value(r, c));
      const copies = hasChoices(column) && !other;
      const next = copies ? ends.list.map((_, i) => values.at(ends.back ? -1 - (i % values.length) : i % values.length))
        : continueSeries(values, ends.list.length, { back: ends.back, other: other && !hasChoices(column) });
      ends.list.forEach(([r, c], i) => made.set(`${r},${c}`, next[i]));
    };
    const span = (from, to) => Array.from({ length: Math.max(0, to - from + 1) }, (_, i) => from + i);
    const { columns } = this.grid;
    if (q0 < r0 || q1 > r1) {
      const list = q0 < r0 ? span(q0, r0 - 1).reverse() : span(r1 + 1, q1);
      for (const c of span(c0, c1)) along(span(r0, r1).map((r) => [r, c]), { back: q0 < r0, list: list.map((r) => [r, c]) }, columns[c]);
    } else {
      const list = d0 < c0 ? span(d0, c0 - 1).reverse() : span(c1 + 1, d1);
      for (const r of span(r0, r1)) along(span(c0, c1).map((c) => [r, c]), { back: d0 < c0, list: list.map((c) => [r, c]) }, columns[c0]);
    }
    const edits = this.#edits(target, (r, c) => made.get(`${r},${c}`));
    this.grid.selection.setRange([q0, d0], [q1, d1]);
    return this.edit(edits, t("fill"));
  }

  // ---- clipboard

  copy(data) {
    const [r0, c0, r1, c1] = this.range();
    const { grid } = this;
    if ((r1 - r0 + 1) * (c1 - c0 + 1) > MOST_CELLS) return false;
    const values = [];
    for (let r = r0; r <= r1; r++) {
      values.push(Array.from({ length: c1 - c0 + 1 }, (_, i) => {
        const column = grid.columns[c0 + i];
        return isComputed(column) ? grid.text(r, c0 + i) : grid.value(r, c0 + i);
      }));
    }
    writeBlock(data, values, (value, i) => showValue(value, grid.columns[c0 + i]));
    const n = values.length * (c1 - c0 + 1);
    this.say(tn("{n:,} cell copied", "{n:,} cells copied", n));
    return true;
  }

  cut(data) {
    if (this.copy(data) && this.canEdit) this.clear(t("cut"));
  }

  /** Paste a block: repeated where the selection is a multiple of it, past the last row into free ones. */
  paste(data) {
    const block = readBlock(data);
    if (!block.length || !this.canEdit) return null;
    const [r0, c0, r1, c1] = this.range();
    const height = block.length;
    const width = Math.max(...block.map((row) => row.length));
    const reach = (first, last, size) => ((last - first + 1) % size === 0 ? last : first + size - 1);
    const end = [reach(r0, r1, height), reach(c0, c1, width)];
    const value = (r, c) => {
      const row = block[(r - r0) % height];
      const one = row[(c - c0) % width] ?? null;
      return one === "" ? null : one;
    };
    const edits = this.#edits([r0, c0, ...end], value);
    this.#tellCut(r0, end);
    const done = this.edit(edits, t("paste"));
    this.grid.order.extend();
    this.grid.selection.setRange([r0, c0], [Math.min(end[0], this.grid.order.length - 1), Math.min(end[1], this.grid.columns.length - 1)]);
    this.say(tn("{n:,} cell pasted", "{n:,} cells pasted", edits.length));
    return done;
  }

  #tellCut(r0, [r1, c1]) {
    const { order, columns } = this.grid;
    let lost = 0;
    for (let r = r1; r >= r0 && order.rowOrFree(r) === null; r--) lost += 1;
    if (lost) notice(tn("{n:,} row does not fit into this sheet and was left out.", "{n:,} rows do not fit into this sheet and were left out.", lost), { kind: "error" });
    const over = c1 + 1 - columns.length;
    if (over > 0) notice(tn("{n} column right of the last was left out.", "{n} columns right of the last were left out.", over), { kind: "error" });
  }

  // ---- rows

  /** Go to the first free row. */
  addRow() {
    const { sheet } = this.grid;
    const row = sheet.firstFreeRow();
    if (row === null) return notice(t("This sheet is full."), { kind: "error" });
    this.grid.order.extend();
    const first = this.grid.columns.find((column) => !isComputed(column));
    return this.grid.goTo(row, first?.at ?? 0);
  }

  /** Clear the selected rows; none below moves up, so that references of formulas stay. */
  clearRows() {
    const [r0, , r1] = this.range();
    const filled = (r, c) => (isFilled(this.grid.value(r, c)) ? null : undefined);
    return this.edit(this.#edits([r0, 0, r1, this.grid.columns.length - 1], filled), t("clear rows"));
  }

  /** Copy the selected rows to the first free ones; names of the first column, which must differ, go on counting. */
  duplicateRows() {
    const { sheet, order, columns } = this.grid;
    const [r0, , r1] = this.range();
    let free = sheet.firstFreeRow();
    if (free === null) return notice(t("This sheet is full."), { kind: "error" });
    const named = sheet.name === "Items" ? sheet.column("item") : null;
    const names = named ? sheet.names("item") : [];
    const first = free;
    const edits = [];
    for (let r = r0; r <= r1; r++) {
      const row = order.row(r);
      if (!sheet.isUsed(row) || (sheet.capacity && free > sheet.capacity)) continue;
      for (const column of columns) {
        const value = isComputed(column) ? null : sheet.value(row, column.at);
        if (!isFilled(value)) continue;
        const isName = named?.at === column.at;
        if (isName) names.push(nextName(value, names));
        edits.push([sheet.name, free, column.at, isName ? names.at(-1) : value]);
      }
      free += 1;
    }
    if (edits.length === 0) return null;
    const done = this.edit(edits, t("duplicate rows"));
    order.extend();
    this.grid.goTo(first, columns[0].at);
    return done;
  }
}
