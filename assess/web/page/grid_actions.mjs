// What is done to the selected cells: clear, fill, copy, cut, paste, rows. Every action is one edit and one step of undo.

import { readBlock, writeBlock } from "./clipboard.mjs";
import { cellText, cellValue, hasChoices, isComputed, showValue } from "./grid_cells.mjs";
import { isFilled, nextName } from "./sheet.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const MOST_CELLS = 400_000;
const TRAILING = /^(.*?)(\d+)$/s;

const span = (from, to) => Array.from({ length: Math.max(0, to - from + 1) }, (_, i) => from + i);
const cellsIn = (ranges) => ranges.reduce((sum, [r0, c0, r1, c1]) => sum + (r1 - r0 + 1) * (c1 - c0 + 1), 0);

export class Actions {
  /** Whether the next copy begins with the headers. */
  withHeaders = false;

  constructor(grid, store, say) {
    Object.assign(this, { grid, store, say });
  }

  get canEdit() {
    return this.grid.canEdit && this.grid.sheet?.found;
  }

  edit(edits, label) {
    return this.canEdit ? this.store.edit(edits, label) : Promise.resolve(false);
  }

  /** A range, the last selected one by default, without the blank rows at the end where whole columns are selected. */
  range([r0, c0, r1, c1] = this.grid.selection.range) {
    const { order, sheet } = this.grid;
    let last = r1;
    if (r0 === 0 && r1 === order.length - 1) while (last > r0 && !sheet.isUsed(order.row(last))) last -= 1;
    return [r0, c0, last, c1];
  }

  get ranges() {
    return this.grid.selection.ranges.map((range) => this.range(range));
  }

  #value(r, column) {
    const { store, sheet, order } = this.grid;
    return cellValue(store, sheet, order.row(r), column);
  }

  /** Edits of a block of cells: `value(r, column, i)` for each that can be edited, `columns` those of the range by default. */
  #edits([r0, c0, r1, c1], value, columns = this.grid.span(c0, c1)) {
    const { sheet, order } = this.grid;
    const edits = [];
    for (let r = r0; r <= r1; r++) {
      const row = order.rowOrFree(r);
      if (row === null) break;
      for (const [i, column] of columns.entries()) {
        const next = isComputed(column) ? undefined : value(r, column, i);
        if (next !== undefined) edits.push([sheet.name, row, column.at, next]);
      }
    }
    return edits;
  }

  #editAll(value, label, ranges = this.ranges) {
    return this.edit(ranges.flatMap((range) => this.#edits(range, value)), label);
  }

  #blank = (r, column) => (isFilled(this.#value(r, column)) ? null : undefined);

  clear(label = t("clear")) {
    return this.#editAll(this.#blank, label);
  }

  fillSelection(value) {
    return this.#editAll(() => value, t("fill"));
  }

  /** Ctrl+D: the first selected row into those below; of one row, the row above into it. */
  fillDown() {
    const edits = this.ranges.flatMap(([r0, c0, r1, c1]) => {
      const from = r0 === r1 ? r0 - 1 : r0;
      return from < 0 ? [] : this.#edits([from + 1, c0, r1, c1], (r, column) => this.#value(from, column));
    });
    return this.edit(edits, t("fill"));
  }

  fillRight() {
    const [r0, c0, r1, c1] = this.range();
    const from = c0 === c1 ? c0 - 1 : c0;
    if (from < 0) return null;
    return this.edit(this.#edits([r0, from + 1, r1, c1], (r) => this.grid.value(r, from)), t("fill"));
  }

  /** How many cells of the selection hold anything, and sum and average of its numbers; null where that is too much. */
  summarise() {
    const { ranges, grid } = this;
    if (cellsIn(ranges) > MOST_CELLS) return null;
    const inRow = (r, c0, c1) => span(c0, c1).map((c) => grid.value(r, c));
    const values = ranges.flatMap(([r0, c0, r1, c1]) => span(r0, r1).flatMap((r) => inRow(r, c0, c1)));
    const numbers = values.filter((value) => typeof value === "number");
    const sum = numbers.reduce((all, n) => all + n, 0);
    return { count: values.filter(isFilled).length, numbers: numbers.length, sum };
  }

  /** Continue the selected cells over a larger range; `other` (Ctrl): copies for a series, or a series for copies. */
  fillTo(target, other) {
    const [r0, c0, r1, c1] = this.grid.selection.range;
    const [q0, d0, q1, d1] = target;
    const made = new Map();
    const { columns } = this.grid;
    const along = (source, list, isBack, column) => {
      const values = source.map(([r, c]) => this.grid.value(r, c));
      if (isBack) values.reverse();
      const isSeries = other || !hasChoices(column);
      const copy = (n) => values[(n - 1) % values.length];
      const next = (isSeries && findSeries(values, other && !hasChoices(column))) || copy;
      list.forEach(([r, c], i) => made.set(`${r},${c}`, next(i + 1)));
    };
    const [isUp, isLeft] = [q0 < r0, d0 < c0];
    if (isUp || q1 > r1) {
      const rows = isUp ? span(q0, r0 - 1).reverse() : span(r1 + 1, q1);
      for (const c of span(c0, c1)) along(span(r0, r1).map((r) => [r, c]), rows.map((r) => [r, c]), isUp, columns[c]);
    } else {
      const list = isLeft ? span(d0, c0 - 1).reverse() : span(c1 + 1, d1);
      for (const r of span(r0, r1)) along(span(c0, c1).map((c) => [r, c]), list.map((c) => [r, c]), isLeft, columns[c0]);
    }
    const edits = this.#edits(target, (r, column) => made.get(`${r},${columns.indexOf(column)}`), columns.slice(d0, d1 + 1));
    this.grid.selection.setRange([q0, d0], [q1, d1]);
    return this.edit(edits, t("fill"));
  }

  // ---- clipboard

  /** Copy the selected ranges, several one below the other where they have the same columns, with the headers if asked for. */
  copy(data, withHeaders = this.withHeaders) {
    const { grid, ranges } = this;
    const [[, c0, , c1]] = ranges;
    if (ranges.some((one) => one[1] !== c0 || one[3] !== c1)) {
      notice(t("Ranges of different columns cannot be copied together. Select one of them."), { kind: "error" });
      return false;
    }
    const columns = grid.span(c0, c1);
    if (cellsIn(ranges.map(([r0, , r1]) => [r0, 1, r1, columns.length])) > MOST_CELLS) return false;
    const text = (r, column) => cellText(grid.store, grid.sheet, grid.order.row(r), column);
    const value = (r, column) => (isComputed(column) ? text(r, column) : this.#value(r, column));
    const values = withHeaders ? [columns.map(({ label, unit }) => (unit ? `${label} [${unit}]` : label))] : [];
    const rows = ranges.flatMap(([r0, , r1]) => span(r0, r1));
    for (const r of rows) values.push(columns.map((column) => value(r, column)));
    writeBlock(data, values, (shown, i) => showValue(shown, columns[i]));
    const n = values.length * columns.length;
    this.say(tn("{n:,} cell copied", "{n:,} cells copied", n));
    return true;
  }

  cut(data) {
    if (this.copy(data) && this.canEdit) this.clear(t("cut"));
  }

  /** Paste a block: repeated where the selection is a multiple of it, past the last row into free ones, also into folded columns. */
  paste(data) {
    const block = readBlock(data).map((row) => row.map((one) => (one === "" ? null : one)));
    if (!block.length || !this.canEdit) return null;
    const [r0, c0, r1, c1] = this.range();
    const { all, columns: shown } = this.grid;
    const height = block.length;
    const width = Math.max(...block.map((row) => row.length));
    const selected = this.grid.span(c0, c1).length;
    const first = all.indexOf(shown[c0]);
    const columns = all.slice(first, first + (selected % width === 0 ? selected : width));
    const last = (r1 - r0 + 1) % height === 0 ? r1 : r0 + height - 1;
    const value = (r, _, i) => block[(r - r0) % height][i % width] ?? null;
    const edits = this.#edits([r0, c0, last, c1], value, columns);
    const lost = span(r0, last).filter((r) => this.grid.order.rowOrFree(r) === null).length;
    if (lost) notice(tn("{n:,} row does not fit into this sheet and was left out.", "{n:,} rows do not fit into this sheet and were left out.", lost), { kind: "error" });
    const over = first + width - all.length;
    if (over > 0) notice(tn("{n} column right of the last was left out.", "{n} columns right of the last were left out.", over), { kind: "error" });
    const done = this.edit(edits, t("paste"));
    this.grid.order.extend();
    const end = shown.indexOf(columns.findLast((column) => shown.includes(column)));
    this.grid.selection.setRange([r0, c0], [Math.min(last, this.grid.order.length - 1), end]);
    this.say(tn("{n:,} cell pasted", "{n:,} cells pasted", edits.length));
    return done;
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

  /** Clear the selected rows; none below moves up. */
  clearRows() {
    const last = this.grid.columns.length - 1;
    return this.#editAll(this.#blank, t("clear rows"), this.ranges.map(([r0, , r1]) => [r0, 0, r1, last]));
  }

  /** The selected rows of the file from the top, as runs of first row and number of rows. */
  runs() {
    const { order } = this.grid;
    const rows = new Set(this.ranges.flatMap(([r0, , r1]) => span(r0, r1).map((r) => order.row(r))));
    const runs = [];
    for (const row of [...rows].sort((a, b) => a - b)) {
      if (runs.length && row === runs.at(-1)[0] + runs.at(-1)[1]) runs.at(-1)[1] += 1;
      else runs.push([row, 1]);
    }
    return runs;
  }

  async #changeRows(change, first, count) {
    const { grid } = this;
    const [, c0, , c1] = grid.selection.range;
    const isDone = this.canEdit && (await this.store.changeRows({ sheet: grid.sheet.name, ...change }));
    if (!isDone || first === undefined) return isDone;
    const r = Math.max(0, grid.order.indexOf(first));
    grid.selection.setRange([r, c0], [r + count - 1, c1]);
    grid.show(grid.selection.anchor);
    return true;
  }

  /** As many blank rows as are selected, above or below them. */
  insertRows(isBelow = false) {
    const [r0, , r1] = this.range();
    const { order } = this.grid;
    const [at, count] = [isBelow ? order.row(r1) + 1 : order.row(r0), r1 - r0 + 1];
    return this.#changeRows({ do: "insert", at, count }, at, count);
  }

  /** Delete the selected rows, from the bottom up; those below move up. */
  async deleteRows() {
    const runs = this.runs().filter(([row]) => row <= this.grid.sheet.lastRow);
    const n = runs.reduce((sum, [, count]) => sum + count, 0);
    const done = await Promise.all(runs.reverse().map(([at, count]) => this.#changeRows({ do: "delete", at, count })));
    if (done.length === 1 && done[0]) this.store.offerUndo(tn("{n:,} row deleted.", "{n:,} rows deleted.", n));
    return done.every(Boolean);
  }

  /** Move the selected rows to lie before a row, up (-1) or down (1) by one by default. */
  moveRows(step, before) {
    const { order, sheet } = this.grid;
    const [[at, count], ...others] = this.runs();
    if (others.length || !order.isPlain) return notice(t("Rows can be moved one block at a time, while the sheet is neither sorted nor filtered."), { kind: "error" });
    const to = before ?? (step < 0 ? at - 1 : at + count + 1);
    if (to <= sheet.headerRow || (to >= at && to <= at + count) || to > (sheet.capacity || Infinity) + 1) return null;
    return this.#changeRows({ do: "move", at, count, to }, to < at ? to : to - count, count);
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
      for (const column of sheet.columns) {
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

/** A function from 1, 2, ... to the values after the last, or null where they are to be copied. */
function findSeries(values, other) {
  const numbers = values.map((value) => (typeof value === "number" ? value : null));
  if (numbers.every((value) => value !== null)) {
    if (values.length === 1) return other ? count(numbers, 1, (n) => n) : null; // one height is copied, as in Excel
    const step = stepOf(numbers);
    return step === null || other ? null : count(numbers, step, (n) => n);
  }
  if (other) return null;
  const parts = values.map((value) => TRAILING.exec(String(value ?? "")));
  if (parts.some((part) => part === null || part[1] !== parts[0][1] || part[2].length > 9)) return null;
  const ends = parts.map((part) => Number(part[2]));
  const step = ends.length === 1 ? 1 : stepOf(ends);
  const width = parts[0][2].startsWith("0") ? parts[0][2].length : 0;
  if (step === null) return null;
  return count(ends, step, (n) => (n < 0 ? null : parts[0][1] + String(n).padStart(width, "0")));
}

function stepOf(numbers) {
  const step = numbers[1] - numbers[0];
  const isEven = numbers.every((n, i) => i === 0 || Math.abs(n - numbers[i - 1] - step) < 1e-9 * (1 + Math.abs(step)));
  return isEven ? step : null;
}

const count = (numbers, step, write) => (i) => write(Number((numbers.at(-1) + step * i).toPrecision(12)));
