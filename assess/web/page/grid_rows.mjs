// The rows of the view: all in the file's order, or some of them sorted. The file's order is never changed.

import { cellText, sortKey } from "./grid_cells.mjs";
import { isFilled } from "./sheet.mjs";

const BLANK = 40;
const RANKS = { number: 0, boolean: 1, string: 2 };

export class RowOrder {
  /** How many of the used rows a filter leaves. */
  shown = 0;
  #rows = null;
  #indices = null;
  #top = 0;

  /** @param {RowOrder} [earlier] that of the same sheet before the book was read again */
  constructor(store, sheet, earlier) {
    this.store = store;
    this.sheet = sheet;
    const again = (one) => ({ ...one, column: sheet.columns.find(({ label, kind }) => label === one.column.label && kind !== "live") });
    const kept = [...(earlier?.filters ?? [])].map(([label, one]) => [label, again(one)]).filter(([, one]) => one.column);
    this.sort = earlier?.sort && again(earlier.sort).column ? again(earlier.sort) : null; // {column, down}
    this.filters = new Map(kept); // label -> {column, contains, values}
    this.only = earlier?.only ?? new Set(); // classes, "" for none, and "problems"
    this.collator = new Intl.Collator(document.documentElement.lang || undefined, { numeric: true, sensitivity: "base" });
    this.apply();
  }

  /** Whether the rows stand as in the file, all of them. */
  get isPlain() {
    return this.sort === null && this.filters.size === 0 && this.only.size === 0;
  }

  get #end() {
    const { capacity, lastRow } = this.sheet;
    return Math.max(lastRow, Math.min(lastRow + BLANK, capacity || Infinity));
  }

  get length() {
    return this.#rows ? this.#rows.length : Math.max(0, this.#end - this.sheet.headerRow);
  }

  /** How many rows are used. */
  get total() {
    return this.sheet.rowNumbers.filter((row) => this.sheet.isUsed(row)).length;
  }

  row(index) {
    return this.#rows ? this.#rows[index] : this.sheet.headerRow + 1 + index;
  }

  /** Where a row stands in the view, -1 where it is filtered out. */
  indexOf(row) {
    const at = row - this.sheet.headerRow - 1;
    if (!this.#rows) return at < this.length ? Math.max(-1, at) : -1;
    this.#indices ??= new Map(this.#rows.map((one, i) => [one, i]));
    return this.#indices.get(row) ?? -1;
  }

  /** The row at an index, also past the end of the view, where rows are free; null where the sheet has no more. */
  rowOrFree(index) {
    if (index < this.length) return this.row(index);
    const { capacity } = this.sheet;
    const row = (this.#rows ? this.#top : this.#end) + 1 + index - this.length;
    return capacity && row > capacity ? null : row;
  }

  /** Sort and filter anew. */
  apply() {
    this.#rows = this.#indices = null;
    if (this.isPlain) return;
    const bad = this.only.has("problems") ? this.store.rowsWithProblems(this.sheet.name) : null;
    const rows = this.sheet.rowNumbers.filter((row) => this.sheet.isUsed(row) && this.#passes(row) && (!bad || bad.has(row)));
    this.shown = rows.length;
    if (this.sort) this.#sortRows(rows);
    this.#rows = rows;
    this.#top = this.sheet.lastRow;
    this.extend();
  }

  /** Keep blank rows at the end of the view, and those that were filled there since. */
  extend() {
    if (!this.#rows) return;
    while (this.#top < this.#end) this.#rows.push((this.#top += 1));
    this.#indices = null;
  }

  /** Take a row into the view that it leaves out. */
  include(row) {
    if (!this.#rows || this.indexOf(row) >= 0) return;
    this.#rows.push(row);
    this.#indices = null;
  }

  /** Rows of the file come to lie elsewhere; new ones stand above the row that follows them. */
  shift(move, [at, count, to]) {
    if (!this.#rows) return;
    this.#rows = this.#rows.map(move).filter((row) => row !== null);
    this.#top = Math.max(this.sheet.lastRow, ...this.#rows);
    if (to === null && count > 0) {
      const next = this.#rows.indexOf(at + count);
      this.#rows.splice(next < 0 ? this.#rows.length : next, 0, ...Array.from({ length: count }, (_, i) => at + i));
    }
    this.extend();
  }

  #passes(row) {
    const classes = [...this.only].filter((one) => one !== "problems");
    if (classes.length && !classes.includes(this.store.live.get(row)?.class ?? "")) return false;
    for (const { column, contains, values } of this.filters.values()) {
      const text = cellText(this.store, this.sheet, row, column);
      if (contains && !text.toLowerCase().includes(contains.toLowerCase())) return false;
      if (values && !values.has(text)) return false;
    }
    return true;
  }

  #sortRows(rows) {
    const { column, down } = this.sort;
    const keys = new Map(rows.map((row) => [row, sortKey(this.store, this.sheet, row, column)]));
    const compare = (a, b) => {
      if (typeof a !== typeof b) return RANKS[typeof a] - RANKS[typeof b];
      return typeof a === "number" ? a - b : this.collator.compare(String(a), String(b));
    };
    rows.sort((one, other) => {
      const [a, b] = [keys.get(one), keys.get(other)];
      if (!isFilled(a) || !isFilled(b)) return isFilled(b) - isFilled(a) || one - other; // blank ones stand last
      return (down ? -1 : 1) * compare(a, b) || one - other;
    });
  }

  /** The different texts of a column with how often each occurs, sorted; of all used rows. */
  texts(column) {
    const counts = new Map();
    for (const row of this.sheet.rowNumbers) {
      if (!this.sheet.isUsed(row)) continue;
      const text = cellText(this.store, this.sheet, row, column);
      counts.set(text, (counts.get(text) ?? 0) + 1);
    }
    return [...counts].sort(([a], [b]) => this.collator.compare(a, b));
  }
}
