// One sheet of the workbook as the page holds it: its columns and the values of its rows.

/** The letters of a column counted from 0: 0 is A, 26 is AA. */
const columnLetters = (at) => (at < 26 ? "" : columnLetters(Math.floor(at / 26) - 1)) + String.fromCharCode(65 + (at % 26));

/** A cell as messages call it, with the title of the sheet: Items!H14. */
export const cellName = (sheet, row, at) => `${sheet?.title ?? "?"}!${columnLetters(at)}${row}`;

/** Where a row comes to lie after a shift `[at, count, to]` of `rows` in a CHANGE of docs/page.md; null where it is deleted. */
export function shiftRow(row, [at, count, to]) {
  if (to === null) return row < at ? row : count < 0 && row < at - count ? null : row + count;
  const [first, end, isUp] = [Math.min(at, to), Math.max(at + count, to), to < at];
  if (row < first || row >= end) return row;
  const isMoved = row >= at && row < at + count;
  const rest = isMoved ? end - first - count : count;
  return isMoved === isUp ? row - rest : row + rest;
}

/** Whether a value fills its cell. */
export const isFilled = (value) => value !== null && value !== undefined && value !== "";

export class Sheet {
  #rows = new Map();
  #numbers = null;
  #last = null;
  /** How often a value was set, for what is worked out from all of them. */
  revision = 0;
  /** Those that Excel computes. */
  #live = new Set();
  #fields = new Map();

  /** @param {object} data a sheet of `GET /api/book` */
  constructor(data) {
    Object.assign(this, {
      name: data.name, title: data.title || data.name, layout: data.layout ?? "table", found: data.found !== false,
      headerRow: data.header_row ?? 1, capacity: data.capacity ?? 0, frozen: data.frozen ?? 1, columns: data.columns ?? [],
    });
    for (const column of this.columns) {
      if (this.layout === "table" && column.kind === "live") this.#live.add(column.at);
      if (column.field) this.#fields.set(column.field, column);
    }
    for (const [row, cells] of data.rows ?? []) this.#rows.set(row, cells);
  }

  /** The numbers of the rows with any value, ascending; not to be changed. */
  get rowNumbers() {
    this.#numbers ??= [...this.#rows.keys()].filter((row) => row > this.headerRow || this.layout === "form").sort((a, b) => a - b);
    return this.#numbers;
  }

  /** The last row with any value that somebody filled in; the header where there is none. */
  get lastRow() {
    this.#last ??= this.rowNumbers.findLast((row) => this.isUsed(row)) ?? this.headerRow;
    return this.#last;
  }

  /** The value of a cell: null where it is blank. */
  value(row, at) {
    return this.#rows.get(row)?.[at] ?? null;
  }

  /** Set a value in this copy only. */
  put(row, at, value) {
    this.revision += 1;
    let cells = this.#rows.get(row);
    if (!cells) {
      if (value === null) return;
      this.#rows.set(row, (cells = []));
      this.#numbers = null;
    }
    while (cells.length < at) cells.push(null);
    cells[at] = value;
    this.#last = null;
    if (value !== null || cells.some(isFilled)) return;
    this.#rows.delete(row); // many rows that are blank again would have to be passed over each time
    this.#numbers = null;
  }

  /** Have rows come to lie elsewhere, in this copy only; `move` tells where, null for those that are deleted. */
  shift(move) {
    this.#rows = new Map([...this.#rows].map(([row, cells]) => [move(row), cells]).filter(([row]) => row !== null));
    this.#numbers = this.#last = null;
    this.revision += 1;
  }

  /** The column, or the line of a form, of a field; undefined where the workbook lacks it. */
  column(field) {
    return this.#fields.get(field);
  }

  /** Whether somebody filled a cell of the row; columns that Excel computes do not count. */
  isUsed(row) {
    const cells = this.#rows.get(row);
    return cells !== undefined && cells.some((value, at) => isFilled(value) && !this.#live.has(at));
  }

  /** The row below the last that is used; where the sheet ends there, the first that is blank, else null. */
  firstFreeRow() {
    const next = this.lastRow + 1;
    const end = this.capacity || Infinity;
    if (next <= end) return next;
    for (let row = this.headerRow + 1; row <= end; row++) if (!this.isUsed(row)) return row;
    return null;
  }

  /** The different texts of a column, in the order of the rows. */
  names(field) {
    const column = this.column(field);
    const values = column ? this.rowNumbers.map((row) => this.value(row, column.at)).filter(isFilled) : [];
    return [...new Set(values.map(String))];
  }
}

/** The next name after one that no other has: "A1" gives "A2", "Desk" gives "Desk 2". */
export function nextName(name, names) {
  const taken = new Set(names.map(String));
  const [, stem, digits] = /^(.*?)(\d*)$/s.exec(String(name));
  for (let n = digits ? Number(digits) + 1 : 2; ; n++) {
    const next = digits ? stem + String(n).padStart(digits.length, "0") : `${stem} ${n}`;
    if (!taken.has(next)) return next;
  }
}
