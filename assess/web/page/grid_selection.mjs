// The selected range of the grid: from the anchor, the active cell, to the head, which Shift moves. Rows are counted in the
// view, columns among those shown.

const isIn = ([r0, c0, r1, c1], r, c) => r >= r0 && r <= r1 && c >= c0 && c <= c1;
const clamp = (value, low, high) => Math.max(low, Math.min(high, value));

export class Selection {
  anchor = [0, 0];
  head = [0, 0];
  /** Ranges that were selected before, and kept by Ctrl. */
  others = [];

  /**
   * @param {{rows: function(): number, columns: function(): number, isFilled: function(number, number): boolean}} size
   * @param {function} changed called after each change
   */
  constructor(size, changed) {
    this.size = size;
    this.changed = changed;
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
    return c0 === 0 && c1 === this.size.columns() - 1;
  }

  has(r, c) {
    return isIn(this.range, r, c) || this.others.some((range) => isIn(range, r, c));
  }

  hasRow(r) {
    return this.ranges.some(([r0, , r1]) => r >= r0 && r <= r1);
  }

  /** Keep what is selected while something else is selected. */
  keep() {
    this.others.push(this.range);
  }

  #inside([r, c]) {
    return [clamp(r, 0, Math.max(0, this.size.rows() - 1)), clamp(c, 0, Math.max(0, this.size.columns() - 1))];
  }

  /** Select one cell, or with `extend` up to it. */
  set(cell, extend = false, keeps = extend) {
    if (!keeps) this.others = [];
    this.head = this.#inside(cell);
    if (!extend) this.anchor = [...this.head];
    this.changed();
  }

  setRange(from, to, keeps = false) {
    if (!keeps) this.others = [];
    this.anchor = this.#inside(from);
    this.head = this.#inside(to);
    this.changed();
  }

  /** Keep it inside after rows or columns have gone. */
  keepInside() {
    this.others = [];
    this.anchor = this.#inside(this.anchor);
    this.head = this.#inside(this.head);
  }

  move(down, right, extend = false) {
    const [r, c] = extend ? this.head : this.anchor;
    this.set([r + down, c + right], extend);
  }

  /** To the edge of what is filled, as Ctrl and an arrow do in a spreadsheet. */
  jump(down, right, extend = false) {
    let [r, c] = extend ? this.head : this.anchor;
    const isInside = () => r + down >= 0 && r + down < this.size.rows() && c + right >= 0 && c + right < this.size.columns();
    const step = () => ((r += down), (c += right));
    const runs = isInside() && this.size.isFilled(r, c) && this.size.isFilled(r + down, c + right);
    if (isInside()) step();
    if (runs) while (isInside() && this.size.isFilled(r + down, c + right)) step();
    else while (isInside() && !this.size.isFilled(r, c)) step();
    this.set([r, c], extend);
  }

  rows() {
    const [r0, , r1] = this.range;
    this.anchor = [r0, 0];
    this.setRange([r0, 0], [r1, this.size.columns() - 1]);
  }

  columns() {
    const [, c0, , c1] = this.range;
    this.setRange([0, c0], [this.size.rows() - 1, c1]);
  }
}
