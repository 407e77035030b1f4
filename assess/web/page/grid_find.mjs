// Find a text in the rows of the view, and replace it.

import { el } from "./elements.mjs";
import { isComputed } from "./grid_cells.mjs";
import { icon } from "./icons.mjs";
import { t, tn } from "./texts.mjs";

const WAIT_MS = 120;

export class FindBar {
  #matches = [];
  #at = -1;
  #timer = 0;

  constructor(view) {
    const { grid, actions } = view;
    Object.assign(this, { view, grid, actions });
    this.input = el("input", { type: "search", "aria-label": t("Find"), placeholder: t("Find") });
    this.count = el("span", { class: "grid-find-count", role: "status" });
    const button = (name, text, click) => el("button", { type: "button", class: "quiet", "aria-label": text, title: text, on: { click } }, icon(name));
    const replace = (text, isAll) => el("button", { type: "button", text, on: { click: () => this.#replace(isAll) } });
    this.other = el("input", { type: "text", "aria-label": t("Replace with"), placeholder: t("Replace with") });
    this.replacing = el("span", { class: "grid-replace", hidden: true }, this.other, replace(t("Replace"), false), replace(t("Replace all"), true));
    this.node = el("div", { class: "grid-find", role: "search", hidden: true }, this.input, this.replacing, this.count,
      button("up", t("Previous"), () => this.step(-1)), button("down", t("Next"), () => this.step(1)), button("close", t("Close"), () => this.close()));
    this.input.addEventListener("input", () => {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#search(), WAIT_MS);
    });
    this.node.addEventListener("keydown", (event) => this.#key(event));
  }

  open(replaces = !this.replacing.hidden) {
    this.node.hidden = false;
    this.replacing.hidden = !replaces || !this.actions.canEdit;
    this.input.focus();
    this.input.select();
    this.#search();
  }

  close() {
    clearTimeout(this.#timer);
    this.node.hidden = true;
    this.grid.found = "";
    this.grid.ask();
    this.view.editor.focus();
  }

  #key(event) {
    const key = event.key.toLowerCase();
    if (event.key === "Escape") this.close();
    else if (event.key === "Enter" && event.target === this.input) this.step(event.shiftKey ? -1 : 1);
    else if (event.key === "Enter" && event.target === this.other) this.#replace(false);
    else if ((event.ctrlKey || event.metaKey) && "fh".includes(key)) this.open(key === "h");
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #search() {
    clearTimeout(this.#timer);
    const text = this.input.value.trim().toLowerCase();
    this.grid.found = text;
    this.#matches = text ? this.#list(text) : [];
    const [r, c] = this.grid.selection.anchor;
    const next = this.#matches.findIndex(([q, d]) => q > r || (q === r && d >= c));
    this.#at = this.#matches.length ? Math.max(0, next) : -1;
    this.#show();
  }

  #list(text) {
    const { order, sheet, columns } = this.grid;
    const matches = [];
    for (let r = 0; r < order.length; r++) {
      if (!sheet.isUsed(order.row(r))) continue;
      for (let c = 0; c < columns.length; c++) if (this.grid.text(r, c).toLowerCase().includes(text)) matches.push([r, c]);
    }
    return matches;
  }

  step(step) {
    if (this.input.value.trim().toLowerCase() !== this.grid.found) this.#search();
    else if (this.#matches.length) {
      this.#at = (this.#at + step + this.#matches.length) % this.#matches.length;
      this.#show();
    }
  }

  #show() {
    const { length } = this.#matches;
    this.count.textContent = length ? t("{at:,} of {n:,}", { at: this.#at + 1, n: length }) : this.grid.found ? t("not found") : "";
    if (length) {
      this.grid.selection.set(this.#matches[this.#at]);
      this.grid.show();
    }
    this.grid.ask();
  }

  /** Replace the text in the cell that is found, or in all of them, as one step. */
  async #replace(isAll) {
    this.#search();
    const { sheet, order, columns } = this.grid;
    const cells = (isAll ? this.#matches : this.#matches.slice(this.#at, this.#at + 1)).filter(([, c]) => !isComputed(columns[c]));
    const pattern = new RegExp(this.grid.found.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"), "gi");
    const edits = cells.map(([r, c]) => [sheet.name, order.row(r), columns[c].at, this.grid.text(r, c).replace(pattern, () => this.other.value) || null]);
    if (!isAll) this.#at = Math.min(this.#at + 1, this.#matches.length - 1);
    const next = isAll ? null : this.#matches[this.#at];
    if (!edits.length || !(await this.actions.edit(edits, t("replace")))) return;
    this.#matches = this.#list(this.grid.found);
    this.#at = Math.max(0, this.#matches.findIndex(([r, c]) => r === next?.[0] && c === next?.[1]));
    this.#show();
    this.count.textContent = tn("{n:,} cell replaced", "{n:,} cells replaced", edits.length);
  }

  /** Where the sheet has changed: count anew without moving. */
  refresh() {
    if (this.node.hidden || !this.grid.found) return;
    this.#matches = this.#list(this.grid.found);
    this.#at = Math.min(this.#at, this.#matches.length - 1);
    this.count.textContent = tn("{n:,} match", "{n:,} matches", this.#matches.length);
  }
}
