// Find a text in the rows of the view.

import { el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { t, tn } from "./texts.mjs";

const WAIT_MS = 120;

export class FindBar {
  #matches = [];
  #at = -1;
  #timer = 0;

  constructor(grid, focus) {
    Object.assign(this, { grid, focus });
    this.input = el("input", { type: "search", "aria-label": t("Find"), placeholder: t("Find") });
    this.count = el("span", { class: "grid-find-count", role: "status" });
    const button = (name, label, click) => el("button", { type: "button", class: "quiet", "aria-label": label, title: label, on: { click } }, icon(name));
    this.node = el("div", { class: "grid-find", role: "search", hidden: true }, this.input, this.count,
      button("up", t("Previous"), () => this.step(-1)), button("down", t("Next"), () => this.step(1)), button("close", t("Close"), () => this.close()));
    this.input.addEventListener("input", () => {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#search(), WAIT_MS);
    });
    this.node.addEventListener("keydown", (event) => this.#key(event));
  }

  open() {
    this.node.hidden = false;
    this.input.focus();
    this.input.select();
    this.#search();
  }

  close() {
    clearTimeout(this.#timer);
    this.node.hidden = true;
    this.grid.found = "";
    this.grid.ask();
    this.focus();
  }

  #key(event) {
    const isControl = event.ctrlKey || event.metaKey;
    if (event.key === "Escape") this.close();
    else if (event.key === "Enter" && event.target === this.input) this.step(event.shiftKey ? -1 : 1);
    else if (isControl && event.key.toLowerCase() === "f") this.input.select();
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

  /** Where the sheet has changed: count anew without moving. */
  refresh() {
    if (this.node.hidden || !this.grid.found) return;
    this.#matches = this.#list(this.grid.found);
    this.#at = Math.min(this.#at, this.#matches.length - 1);
    this.count.textContent = tn("{n:,} match", "{n:,} matches", this.#matches.length);
  }
}
