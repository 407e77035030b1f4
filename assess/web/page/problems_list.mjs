// The problems of the workbook, each with a way to its cell.

import { clear, el } from "./elements.mjs";
import { fixButtons } from "./fixes.mjs";
import { icon } from "./icons.mjs";
import { cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";

const MOST = 100;
const WIDE = 900;
const SEVERITIES = ["error", "warning", "note"];
const SIGNS = { error: "✖", warning: "▲", note: "ℹ" };
const count = {
  error: (n) => tn("{n:,} error", "{n:,} errors", n),
  warning: (n) => tn("{n:,} warning", "{n:,} warnings", n),
  note: (n) => tn("{n:,} note", "{n:,} notes", n),
};

export class ProblemsList {
  #hidden = new Set();

  constructor(store) {
    this.store = store;
    this.filters = el("div", { class: "problems-filters", role: "group", "aria-label": t("Which problems to show") });
    this.list = el("ul", { class: "problems-rows" });
    this.node = el("section", { class: "problems", "aria-label": t("Problems") }, this.filters, this.list);
    this.#restore();
    store.addEventListener("problems", () => this.draw());
    this.draw();
  }

  #restore() {
    const kept = sessionStorage.getItem("assess-problems");
    this.isOpen = kept ? kept === "open" : innerWidth >= WIDE;
  }

  #toggleOpen() {
    this.isOpen = !this.isOpen;
    sessionStorage.setItem("assess-problems", this.isOpen ? "open" : "closed");
    this.draw();
  }

  draw() {
    const { problems, liveError } = this.store;
    this.node.hidden = problems.length === 0 && !liveError;
    this.list.hidden = !this.isOpen;
    const open = el("button", { type: "button", class: "quiet", "aria-expanded": String(this.isOpen), on: { click: () => this.#toggleOpen() } }, icon(this.isOpen ? "down" : "right"), t("Problems"));
    clear(this.filters).append(open, ...SEVERITIES.map((one) => this.#filter(one)).filter(Boolean));
    const shown = problems.filter((one) => !this.#hidden.has(one.severity));
    shown.sort((one, other) => SEVERITIES.indexOf(one.severity) - SEVERITIES.indexOf(other.severity));
    clear(this.list).append(...(liveError ? [el("li", { class: "error", text: liveError })] : []), ...shown.slice(0, MOST).map((one) => this.#row(one)));
    const rest = Math.max(0, shown.length - MOST) + this.store.moreProblems;
    if (rest) this.list.append(el("li", { text: tn("{n:,} more", "{n:,} more", rest) }));
  }

  #filter(severity) {
    const n = this.store.problems.filter((one) => one.severity === severity).length;
    if (n === 0) return null;
    const isShown = !this.#hidden.has(severity);
    const click = () => {
      if (!this.#hidden.delete(severity)) this.#hidden.add(severity);
      this.draw();
      this.filters.querySelector(`[data-severity=${severity}]`)?.focus();
    };
    return el("button", { type: "button", class: `problems-filter ${severity}`, dataset: { severity }, "aria-pressed": String(isShown), text: `${SIGNS[severity]} ${count[severity](n)}`, on: { click } });
  }

  #row(problem) {
    const { severity, sheet, row, at, cell, message, fix } = problem;
    const isCell = row !== null && row !== undefined && at !== null && at !== undefined;
    const where = isCell ? cellName(this.store.sheet(sheet), row, at) : [this.store.sheet(sheet)?.title ?? sheet, cell].filter(Boolean).join(" ");
    const text = [el("span", { class: "problems-sign", "aria-hidden": "true", text: SIGNS[severity] }), el("b", { text: where }), ` ${message} `, fix ? el("span", { class: "problems-fix", text: fix }) : null];
    const line = isCell || row ? el("button", { type: "button", on: { click: () => this.store.reveal([sheet, row, at ?? 0]) } }, text) : el("p", null, text);
    return el("li", { class: severity }, line, fixButtons(this.store, problem));
  }
}
