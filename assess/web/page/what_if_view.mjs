// The tab "What if": another shaking, another scenario, pieces anchored; what changes, beside the present. Nothing is saved.

import { post } from "./api.mjs";
import { CLASSES, badge, chanceText, describe, isPale } from "./classes.mjs";
import { ask } from "./messages.mjs";
import { nameKey } from "./plan_model.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";
import { results, summary } from "./what_if_results.mjs";

const ASK_MS = 150;
const AGAIN_MS = 400; // until all is simulated
const MOST = 300;
const ANCHORED_YES = 1; // among the choices of the column
/** Steps of the slider: about the same share apart. */
const SCALES = [0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.35, 1.5, 1.75, 2, 2.25, 2.5, 2.75, 3];
const AS_IT_IS = { scale: 1, scenario: null, first: 0 };
const [LEAST, GREATEST] = [SCALES[0], SCALES.at(-1)];

export const createView = (root, store) => new WhatIfView(root, store);

const button = (text, run) => html`<button type="button" @click=${run}>${text}</button>`;

class WhatIfView {
  #timer = 0;
  #abort = null;
  #isShown = false;
  #isBusy = true;
  #answer = null;
  #error = "";
  #stamp = null;
  #showsAll = false;
  #ticked = new Set(); // rows
  #asks = { ...AS_IT_IS };
  #words = []; // by which the list of pieces is filtered, and the class
  #class = "";

  constructor(root, store) {
    Object.assign(this, { root, store });
    root.classList.add("what-if");
    store.addEventListener("rows", ({ detail: { sheet, move } }) => sheet === "Items" && (this.#ticked = new Set([...this.#ticked].map(move).filter(Boolean))));
    store.addEventListener("book", () => {
      this.#answer = null;
      this.#ticked.clear();
      if (this.#isShown) this.#askSoon(0);
    });
    store.addEventListener("live", () => {
      if (!this.#isShown || !store.book) return;
      this.#draw();
      if (this.#stamp !== store.stamp) this.#askSoon();
    });
  }

  show() {
    this.#isShown = true;
    this.#draw();
    if (this.#stamp !== this.store.stamp) this.#askSoon(0);
  }

  hide() {
    this.#isShown = false;
    clearTimeout(this.#timer);
  }

  // ---- drawing

  #draw() {
    const focused = document.activeElement?.dataset?.tick;
    const answer = this.#answer;
    const toggle = (on) => ((this.#showsAll = on), this.#draw());
    render(html`<div class="what-if-banner"><p><b>${t("What if: nothing is saved.")}</b> ${t("The workbook stays as it is until you write into it.")}</p>
        <div class="buttons">${button(t("Reset"), () => (this.#ticked.clear(), this.#change(AS_IT_IS)))}<button type="button" class="primary editing-only"
          ?disabled=${!answer?.anchored.length} @click=${() => this.#write()}>${t("Write into the workbook…")}</button></div></div>
      <div class="what-if-main"><section class="what-if-controls" aria-label=${t("What to change")}>
          ${this.#scaleField()}${this.#scenarioField()}${this.#firstField()}${this.#pieceList()}</section>
        <div class="what-if-results"><p class="error-text" role="alert" ?hidden=${!this.#error}>${this.#error}</p>
          <div class="results" aria-busy=${this.#isBusy}>${answer ? results(answer, this.store, this.#showsAll, toggle) : html`<p class="muted">${t("Computing…")}</p>`}</div></div></div>
      <div class="unseen" role="status" aria-live="polite">${answer ? summary(answer) : ""}</div>`, this.root);
    if (focused) this.root.querySelector(`[data-tick="${focused}"]`)?.focus();
  }

  #scaleField() {
    const apart = SCALES.map((one) => Math.abs(Math.log(one / this.#asks.scale)));
    const type = ({ target }) => {
      const value = Number.isFinite(target.valueAsNumber) ? Math.min(GREATEST, Math.max(LEAST, target.valueAsNumber)) : 1;
      target.value = String(value);
      this.#change({ scale: value });
    };
    return html`<fieldset><legend>${t("Strength of the shaking")}</legend><div class="slider"><input type="range" min="0" max=${SCALES.length - 1} step="1"
        .value=${String(apart.indexOf(Math.min(...apart)))} aria-label=${t("Strength of the shaking")} aria-valuetext="× ${number(this.#asks.scale)}"
        @input=${({ target }) => this.#change({ scale: SCALES[target.valueAsNumber] })}>
      <span class="times">× <input type="number" min=${LEAST} max=${GREATEST} step="any" .value=${String(this.#asks.scale)} aria-label=${t("Factor on the shaking")} @change=${type}></span></div>
      <p class="hint">${t("1 is the shaking of the workbook, 2 twice as strong.")}</p></fieldset>`;
  }

  #scenarioField() {
    const { scenarios = [], scenario } = this.#answer ?? {};
    const chosen = this.#asks.scenario ?? scenario;
    return html`<label class="field"><span class="field-name">${t("Scenario")}</span><select @change=${({ target }) => this.#change({ scenario: target.value })}>
      ${scenarios.map(([value, text]) => html`<option value=${value} .selected=${value === chosen}>${text}</option>`)}</select></label>`;
  }

  #firstField() {
    const { entries = 0 } = this.#answer ?? {};
    const text = t("{n} of {all}", { n: this.#asks.first, all: entries });
    return html`<label class="field"><span class="field-name">${t("Anchor the first entries of the work list")}</span><div class="slider">
      <input type="range" min="0" max=${entries} step="1" ?disabled=${!entries} .value=${String(this.#asks.first)} aria-valuetext=${text}
        @input=${({ target }) => this.#change({ first: target.valueAsNumber })}><output class="times">${text}</output></div></label>`;
  }

  #pieceList() {
    const all = this.#shownPieces();
    const find = ({ target }) => ((this.#words = nameKey(target.value).split(" ").filter(Boolean)), this.#draw());
    const filter = ({ target }) => ((this.#class = target.value), this.#draw());
    const said = all.length ? tn("{n:,} piece ticked; the likeliest to fall first.", "{n:,} pieces ticked; the likeliest to fall first.", this.#ticked.size) : t("No piece has such a class or name.");
    return html`<fieldset class="tick-list"><legend>${t("Anchor pieces")}</legend>
      <div class="pair"><input type="search" placeholder=${t("Find a piece")} aria-label=${t("Find a piece")} @input=${find}>
        <select aria-label=${t("Class")} @change=${filter}><option value="">${t("all classes")}</option>
          ${CLASSES.map((key) => html`<option value=${key}>${describe(key).sign} ${describe(key).word}</option>`)}</select></div>
      <div class="buttons">${button(t("Tick all shown"), () => this.#tick(all.map((one) => one.row), true))}${button(t("Untick all"), () => this.#tick([...this.#ticked], false))}</div>
      <p class="hint">${said}</p><ul class="rows ticks">${all.slice(0, MOST).map((one) => this.#row(one))}
        ${all.length > MOST ? html`<li class="muted">${tn("{n:,} more", "{n:,} more", all.length - MOST)}</li>` : nothing}</ul></fieldset>`;
  }

  #row({ row, name, about, live }) {
    const isTicked = this.#ticked.has(row);
    const isListed = !isTicked && Boolean(this.#answer?.anchored.includes(row));
    return html`<li><label class="tick" title=${isListed ? t("Anchored by the list of what to fix") : about}><input type="checkbox" data-tick=${row}
      .checked=${isTicked || isListed} ?disabled=${isListed} @change=${({ target }) => this.#tick([row], target.checked)}>${badge(live.class, { isPale: isPale(live) })}
      <b>${name}</b><span class="about">${about}</span><span class="end">${chanceText(live)}</span></label></li>`;
  }

  // ---- the pieces that could be anchored

  #text(row, field) {
    const column = this.store.sheet("Items")?.column(field);
    return column ? String(this.store.sheet("Items").value(row, column.at) ?? "") : "";
  }

  /** Those with a class and what is looked for, the likeliest to fall first. */
  #shownPieces() {
    const about = (row) => [this.#text(row, "description") || this.#text(row, "type"), this.#text(row, "room")].filter(Boolean).join(", ");
    return [...this.store.live].filter(([, live]) => live.class && (!this.#class || live.class === this.#class))
      .map(([row, live]) => ({ row, name: this.#text(row, "item"), about: about(row), live }))
      .filter((one) => one.name && this.#words.every((word) => nameKey(`${one.name} ${one.about}`).includes(word)))
      .sort((a, b) => CLASSES.indexOf(a.live.class) - CLASSES.indexOf(b.live.class) || (b.live.chance ?? 0) - (a.live.chance ?? 0) || a.row - b.row);
  }

  #tick(rows, on) {
    for (const row of rows) this.#ticked[on ? "add" : "delete"](row);
    this.#askSoon();
  }

  // ---- asking

  /** Change what is asked for: scale, scenario, first. */
  #change(wish) {
    Object.assign(this.#asks, wish);
    this.#askSoon();
  }

  #askSoon(delay = ASK_MS) {
    clearTimeout(this.#timer);
    this.#isBusy = true;
    this.#draw();
    this.#timer = setTimeout(() => this.#ask(), delay);
  }

  async #ask() {
    if (!this.store.book) return;
    this.#abort?.abort();
    this.#abort = new AbortController();
    const anchor = [...this.#ticked].filter((row) => this.store.live.get(row)?.class).map((row) => this.#text(row, "item")).filter(Boolean);
    try {
      const { stamp } = this.store;
      const answer = await post("/api/what-if", { ...this.#asks, anchor }, this.#abort.signal);
      this.#stamp = stamp;
      this.#answer = answer;
      this.#error = answer.error;
      this.#asks.first = Math.min(this.#asks.first, answer.entries);
      this.#isBusy = ["running", "waiting"].includes(answer.simulation.state);
      if (this.#isBusy) this.#timer = setTimeout(() => this.#ask(), AGAIN_MS);
    } catch (error) {
      if (error.name === "AbortError") return;
      this.#error = error.message;
      this.#isBusy = false;
    }
    this.#draw();
  }

  /** Write Anchored = yes for the pieces that are anchored here: one step of undo. Shaking and scenario are not written. */
  async #write() {
    const rows = this.#answer.anchored;
    const question = tn("Write Anchored: yes into the workbook for {n:,} row? Strength and scenario are not written. Undo takes it back.", "Write Anchored: yes into the workbook for {n:,} rows? Strength and scenario are not written. Undo takes it back.", rows.length);
    if (!(await ask(question, [[t("Write"), true], [t("Cancel"), false]]))) return;
    const column = this.store.sheet("Items").column("anchored");
    if (!column || !(await this.store.edit(rows.map((row) => ["Items", row, column.at, column.choices[ANCHORED_YES]]), t("anchor")))) return;
    this.#ticked.clear();
    this.#asks.first = 0;
    this.#askSoon(0);
    this.store.offerUndo(tn("{n:,} row written.", "{n:,} rows written.", rows.length));
  }
}
