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
   * Compare with a book that was read from the file.
   * @param {Function} valueOf of sheet, row, column: what the book has there
   * @returns {{groups: Array, count: number, taken: Array, isKnown: Function}} what is not in it, step by step, and of how
   *   many cells; the cells that somebody else has set; whether a value is one that a cell had while it was edited here
   */
  compare(valueOf) {
    const chains = this.#chains();
    const missing = new Set();
    const taken = [];
    for (const [name, { cell, known, last }] of chains) {
      const now = valueOf(...cell);
      if (same(now, last)) continue;
      if (known.some((one) => same(one, now))) missing.add(name);
      else taken.push(cell);
    }
    const groups = this.#groups
      .map(({ label, cells }) => ({ label, cells: cells.filter(({ cell }) => missing.has(key(...cell))) }))
      .filter(({ cells }) => cells.length);
    const isKnown = (cell, value) => chains.get(key(...cell))?.known.some((one) => same(one, value)) ?? false;
    return { groups, count: missing.size, taken, isKnown };
  }

  /** Every value that a cell has had meanwhile, and the last. */
  #chains() {
    const chains = new Map();
    for (const { cells } of this.#groups) {
      for (const { cell, typed, stored, before } of cells) {
        const name = key(...cell);
        const chain = chains.get(name) ?? { cell, known: [] };
        chain.known.push(before, typed, stored);
        chain.last = stored;
        chains.set(name, chain);
      }
    }
    return chains;
  }
}
