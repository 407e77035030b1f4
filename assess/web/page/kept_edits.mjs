// Edits that the server has taken and not saved in the file yet: where it is killed, they are sent again to the next one.

export const key = (sheet, row, at) => `${sheet}|${row}|${at}`;
export const same = (one, other) => one === other || (one ?? "") === (other ?? "");

export class KeptEdits {
  /** [{version, label, cells: [{cell: [sheet, row, at], typed, stored, before}]}] in their order */
  #groups = [];
  #blocked = 0;

  /** Keep nothing until a version is in the file: rows have other numbers there. */
  block(version) {
    this.#groups = [];
    this.#blocked = version;
  }

  add(version, label, cells) {
    if (cells.length && !this.#blocked) this.#groups.push({ version, label, cells });
  }

  /** Forget what is in the file. */
  drop(savedVersion = Infinity) {
    if (savedVersion >= this.#blocked) this.#blocked = 0;
    this.#groups = this.#groups.filter((one) => one.version > savedVersion);
  }

  /**
   * Compare with a book that was read from the file, of which `valueOf(cell)` tells what it holds.
   * @returns {{groups: Array, count: number, taken: Array, isKnown: Function}} what is not in it, step by step, and of how
   *   many cells; the cells that somebody else has set; whether a value is one that a cell had while it was edited here
   */
  compare(valueOf) {
    const known = new Map(); // by cell: every value that it has had meanwhile, the last one last
    for (const { cell, typed, stored, before } of this.#groups.flatMap(({ cells }) => cells)) {
      known.set(key(...cell), [...(known.get(key(...cell)) ?? []), before, typed, stored]);
    }
    const isKnown = (cell, value) => (known.get(key(...cell)) ?? []).some((one) => same(one, value));
    const missing = new Set();
    const taken = new Map();
    for (const { cell } of this.#groups.flatMap(({ cells }) => cells)) {
      const now = valueOf(cell);
      if (same(now, known.get(key(...cell)).at(-1))) continue;
      if (isKnown(cell, now)) missing.add(key(...cell));
      else taken.set(key(...cell), cell);
    }
    const groups = this.#groups
      .map(({ label, cells }) => ({ label, cells: cells.filter(({ cell }) => missing.has(key(...cell))) }))
      .filter(({ cells }) => cells.length);
    return { groups, count: missing.size, taken: [...taken.values()], isKnown };
  }
}
