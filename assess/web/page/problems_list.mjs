// The problems of the workbook, each with a way to its cell: a drawer over the sheet, and the button that opens it.

import { el } from "./elements.mjs";
import { fixButtons } from "./fixes.mjs";
import { icon } from "./icons.mjs";
import { cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const MOST = 100;
const SIGNS = { error: "✖", warning: "▲", note: "ℹ" };
const SEVERITIES = Object.keys(SIGNS);
const count = {
  error: (n) => tn("{n:,} error", "{n:,} errors", n),
  warning: (n) => tn("{n:,} warning", "{n:,} warnings", n),
  note: (n) => tn("{n:,} note", "{n:,} notes", n),
};

export class ProblemsList {
  #hidden = new Set();
  #close = () => (this.toggle(false), this.button.focus());

  constructor(store) {
    this.store = store;
    this.node = el("section", { class: "problems", id: "problems", "aria-label": t("Problems") });
    this.button = el("button", { type: "button", class: "quiet problems-button", "aria-controls": "problems", on: { click: () => this.toggle() } });
    this.node.addEventListener("keydown", (event) => event.key === "Escape" && this.#close());
    this.toggle(sessionStorage.getItem("assess-problems") === "open");
    store.addEventListener("problems", () => this.draw());
  }

  toggle(isOpen = !this.isOpen) {
    this.isOpen = isOpen;
    sessionStorage.setItem("assess-problems", this.isOpen ? "open" : "closed");
    this.draw();
  }

  draw() {
    const { problems, liveError, moreProblems } = this.store;
    this.node.hidden = !this.isOpen;
    this.button.setAttribute("aria-expanded", String(this.isOpen));
    const counted = SEVERITIES.map((one) => [one, problems.filter(({ severity }) => severity === one).length]).filter(([, n]) => n);
    render(html`${t("Problems")}${counted.map(([one, n]) => html` <span class="problems-count ${one}" title=${count[one](n)}>${SIGNS[one]} ${n}</span>`)}`, this.button);
    const shown = problems.filter((one) => !this.#hidden.has(one.severity));
    shown.sort((one, other) => SEVERITIES.indexOf(one.severity) - SEVERITIES.indexOf(other.severity));
    const rest = Math.max(0, shown.length - MOST) + moreProblems;
    render(html`<div class="problems-top">
        <div class="problems-filters" role="group" aria-label=${t("Which problems to show")}>${counted.map((one) => this.#filter(...one))}</div>
        <button type="button" class="quiet square" aria-label=${t("Close")} title=${t("Close")} @click=${this.#close}>${icon("close")}</button>
      </div>
      <ul class="problems-rows">
        ${liveError ? html`<li class="error">${liveError}</li>` : nothing}
        ${shown.slice(0, MOST).map((one) => this.#row(one))}
        ${rest ? html`<li>${tn("{n:,} more", "{n:,} more", rest)}</li>` : shown.length || liveError ? nothing : html`<li>${t("No problems.")}</li>`}
      </ul>`, this.node);
  }

  #filter(severity, n) {
    const click = () => (this.#hidden.delete(severity) || this.#hidden.add(severity), this.draw());
    return html`<button type="button" class="problems-filter ${severity}" aria-pressed=${!this.#hidden.has(severity)} @click=${click}>${SIGNS[severity]} ${count[severity](n)}</button>`;
  }

  #row(problem) {
    const { severity, sheet, row, at, cell, message, fix } = problem;
    const isCell = row !== null && row !== undefined && at !== null && at !== undefined;
    const where = isCell ? cellName(this.store.sheet(sheet), row, at) : [this.store.sheet(sheet)?.title ?? sheet, cell].filter(Boolean).join(" ");
    const text = html`<span class="problems-sign" aria-hidden="true">${SIGNS[severity]}</span><b>${where}</b> ${message} <span class="problems-fix">${fix}</span>`;
    const show = () => this.store.reveal([sheet, row, at ?? 0]);
    return html`<li class=${severity}>${isCell || row ? html`<button type="button" @click=${show}>${text}</button>` : html`<p>${text}</p>`}${fixButtons(this.store, problem)}</li>`;
  }
}
