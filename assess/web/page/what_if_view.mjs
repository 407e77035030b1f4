// The tab "What if": another shaking, another scenario, pieces anchored; what changes, beside the present. Nothing is saved.

import { post } from "./api.mjs";
import { CLASSES, badge, chanceText, describe, isPale } from "./classes.mjs";
import { clear, el } from "./elements.mjs";
import { ask } from "./messages.mjs";
import { PlanEdits } from "./plan_edits.mjs";
import { PlanModel, nameKey } from "./plan_model.mjs";
import { isFilled } from "./sheet.mjs";
import { number, t, tn } from "./texts.mjs";
import { Results } from "./what_if_results.mjs";

const ASK_MS = 150;
const AGAIN_MS = 400; // until all is simulated
const MOST = 300;
/** Steps of the slider: about the same share apart. */
const SCALES = [0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.35, 1.5, 1.75, 2, 2.25, 2.5, 2.75, 3];
const ONE = SCALES.indexOf(1);
const [LEAST, GREATEST] = [SCALES[0], SCALES.at(-1)];

export function createView(root, store) {
  const view = new WhatIfView(root, store);
  return { show: () => view.show(), hide: () => view.hide() };
}

class WhatIfView {
  #timer = 0;
  #abort = null;
  #asked = 0;
  #isShown = false;
  #answer = null;
  #stamp = null;
  #ticked = new Set(); // rows
  #scale = 1;
  #scenario = null;
  #first = 0;

  constructor(root, store) {
    Object.assign(this, { root, store });
    this.edits = new PlanEdits(new PlanModel(store), store);
    this.results = new Results(store);
    this.#build();
    this.#listen();
  }

  // ---- elements

  #build() {
    this.root.classList.add("what-if");
    this.error = el("p", { class: "error-text", role: "alert", hidden: true });
    this.status = el("div", { class: "unseen", role: "status", "aria-live": "polite" });
    this.write = el("button", { type: "button", class: "primary editing-only", text: t("Write into the workbook…"), disabled: true, on: { click: () => this.#write() } });
    const reset = el("button", { type: "button", text: t("Reset"), on: { click: () => this.#reset() } });
    const banner = el("div", { class: "what-if-banner" }, el("p", null, el("b", { text: t("What if: nothing is saved.") }), " ", t("The workbook stays as it is until you write into it.")), el("div", { class: "buttons" }, reset, this.write));
    const controls = el("section", { class: "what-if-controls", "aria-label": t("What to change") }, this.#scaleField(), this.#scenarioField(), this.#firstField(), this.#pieceList());
    this.root.append(banner, el("div", { class: "what-if-main" }, controls, el("div", { class: "what-if-results" }, this.error, this.results.node)), this.status);
  }

  #scaleField() {
    this.slider = el("input", { type: "range", min: "0", max: String(SCALES.length - 1), step: "1", value: String(ONE), "aria-label": t("Strength of the shaking") });
    this.scaleInput = el("input", { type: "number", min: String(LEAST), max: String(GREATEST), step: "any", value: "1", "aria-label": t("Factor on the shaking") });
    this.slider.addEventListener("input", () => this.#setScale(SCALES[Number(this.slider.value)]));
    this.scaleInput.addEventListener("change", () => this.#setScale(this.scaleInput.valueAsNumber));
    return el("fieldset", null, el("legend", { text: t("Strength of the shaking") }), el("div", { class: "slider" }, this.slider, el("span", { class: "times" }, "× ", this.scaleInput)),
      el("p", { class: "hint", text: t("1 is the shaking of the workbook, 2 twice as strong.") }));
  }

  #setScale(value) {
    this.#scale = Number.isFinite(value) ? Math.min(GREATEST, Math.max(LEAST, value)) : 1;
    const nearest = SCALES.reduce((best, one, i) => (Math.abs(Math.log(one / this.#scale)) < Math.abs(Math.log(SCALES[best] / this.#scale)) ? i : best), 0);
    this.slider.value = String(nearest);
    this.slider.setAttribute("aria-valuetext", `× ${number(this.#scale)}`);
    this.scaleInput.value = String(this.#scale);
    this.#askSoon();
  }

  #scenarioField() {
    this.scenario = el("select", null);
    this.scenario.addEventListener("change", () => {
      this.#scenario = this.scenario.value;
      this.#askSoon();
    });
    return el("label", { class: "field" }, el("span", { class: "field-name", text: t("Scenario") }), this.scenario);
  }

  #firstField() {
    this.firstSlider = el("input", { type: "range", min: "0", max: "0", step: "1", value: "0" });
    this.firstText = el("output", { class: "times" });
    this.firstSlider.addEventListener("input", () => {
      this.#first = this.firstSlider.valueAsNumber;
      this.#drawFirst();
      this.#askSoon();
    });
    return el("label", { class: "field" }, el("span", { class: "field-name", text: t("Anchor the first entries of the work list") }), el("div", { class: "slider" }, this.firstSlider, this.firstText));
  }

  #drawFirst() {
    const entries = this.#answer?.entries ?? 0;
    this.firstSlider.max = String(entries);
    this.firstSlider.disabled = entries === 0;
    this.#first = Math.min(this.#first, entries);
    this.firstSlider.value = String(this.#first);
    const text = t("{n} of {all}", { n: this.#first, all: entries });
    this.firstText.textContent = text;
    this.firstSlider.setAttribute("aria-valuetext", text);
  }

  #pieceList() {
    this.search = el("input", { type: "search", placeholder: t("Find a piece"), "aria-label": t("Find a piece"), on: { input: () => this.#drawPieces() } });
    this.filter = el("select", { "aria-label": t("Class"), on: { change: () => this.#drawPieces() } }, [["", t("all classes")], ...CLASSES.map((key) => [key, `${describe(key).sign} ${describe(key).word}`])].map(([value, text]) => el("option", { value, text })));
    this.count = el("p", { class: "hint" });
    this.list = el("ul", { class: "rows ticks" });
    const all = el("button", { type: "button", text: t("Tick all shown"), on: { click: () => this.#tickShown(true) } });
    const none = el("button", { type: "button", text: t("Untick all"), on: { click: () => this.#tickShown(false) } });
    return el("fieldset", { class: "tick-list" }, el("legend", { text: t("Anchor pieces") }), el("div", { class: "pair" }, this.search, this.filter), el("div", { class: "buttons" }, all, none), this.count, this.list);
  }

  #listen() {
    const { store } = this;
    store.addEventListener("rows", ({ detail: { sheet, move } }) => sheet === "Items" && (this.#ticked = new Set([...this.#ticked].map(move).filter(Boolean))));
    store.addEventListener("book", () => {
      this.#answer = null;
      this.#ticked.clear();
      if (this.#isShown) this.#askSoon(0);
    });
    store.addEventListener("live", () => {
      if (!this.#isShown || !store.book) return;
      this.#drawPieces();
      if (this.#stamp !== store.stamp) this.#askSoon();
    });
  }

  show() {
    this.#isShown = true;
    this.#drawPieces();
    if (this.#stamp !== this.store.stamp) this.#askSoon(0);
  }

  hide() {
    this.#isShown = false;
    clearTimeout(this.#timer);
  }

  // ---- the pieces that could be anchored

  /** Those with a class, the likeliest to fall first. */
  #candidates() {
    const items = this.store.sheet("Items");
    if (!items?.found) return [];
    const text = (row, field) => {
      const column = items.column(field);
      return column ? String(items.value(row, column.at) ?? "") : "";
    };
    return [...this.store.live].filter(([, live]) => live.class).map(([row, live]) => ({
      row, name: text(row, "item"), about: [text(row, "description") || text(row, "type"), text(row, "room")].filter(Boolean).join(", "), key: live.class, chance: live.chance ?? 0, live,
    })).filter((one) => one.name).sort((a, b) => CLASSES.indexOf(a.key) - CLASSES.indexOf(b.key) || b.chance - a.chance || a.row - b.row);
  }

  #shownPieces() {
    const words = nameKey(this.search.value).split(" ").filter(Boolean);
    return this.#candidates().filter((one) => (!this.filter.value || one.key === this.filter.value) && words.every((word) => nameKey(`${one.name} ${one.about}`).includes(word)));
  }

  #drawPieces() {
    const all = this.#shownPieces();
    const byList = new Set(this.#answer?.anchored ?? []);
    const focused = document.activeElement?.dataset?.tick;
    clear(this.list).append(...all.slice(0, MOST).map((one) => this.#row(one, byList)));
    if (all.length > MOST) this.list.append(el("li", { class: "muted", text: tn("{n:,} more", "{n:,} more", all.length - MOST) }));
    if (focused) this.list.querySelector(`[data-tick="${focused}"]`)?.focus();
    const n = this.#ticked.size;
    this.count.textContent = all.length ? tn("{n:,} piece ticked; the likeliest to fall first.", "{n:,} pieces ticked; the likeliest to fall first.", n) : t("No piece has such a class or name.");
  }

  #row(one, byList) {
    const isTicked = this.#ticked.has(one.row);
    const isListed = byList.has(one.row) && !isTicked;
    const box = el("input", { type: "checkbox", checked: isTicked || isListed, disabled: isListed, dataset: { tick: one.row } });
    box.addEventListener("change", () => this.#tick(one.row, box.checked));
    return el("li", null, el("label", { class: "tick", title: isListed ? t("Anchored by the list of what to fix") : one.about }, box, badge(one.key, { isPale: isPale(one.live) }), el("b", { text: one.name }), el("span", { class: "about", text: one.about }), el("span", { class: "end", text: chanceText(one.live) })));
  }

  #tick(row, on) {
    if (on) this.#ticked.add(row);
    else this.#ticked.delete(row);
    this.#drawPieces();
    this.#askSoon();
  }

  #tickShown(on) {
    if (on) for (const one of this.#shownPieces()) this.#ticked.add(one.row);
    else this.#ticked.clear();
    this.#drawPieces();
    this.#askSoon();
  }

  // ---- asking

  #askSoon(delay = ASK_MS) {
    clearTimeout(this.#timer);
    this.results.node.setAttribute("aria-busy", "true");
    this.#timer = setTimeout(() => this.#ask(), delay);
  }

  #names() {
    const items = this.store.sheet("Items");
    const column = items?.column("item");
    if (!column) return [];
    return [...this.#ticked].filter((row) => this.store.live.get(row)?.class).map((row) => items.value(row, column.at)).filter(isFilled).map(String);
  }

  async #ask() {
    if (!this.store.book) return;
    const asked = ++this.#asked;
    this.#abort?.abort();
    this.#abort = new AbortController();
    const request = { scale: this.#scale, anchor: this.#names(), first: this.#first, ...(this.#scenario === null ? {} : { scenario: this.#scenario }) };
    try {
      const { stamp } = this.store;
      const answer = await post("/api/what-if", request, this.#abort.signal);
      if (asked !== this.#asked) return;
      this.#stamp = stamp;
      this.#take(answer);
      const isOpen = ["running", "waiting"].includes(answer.simulation.state);
      if (isOpen) this.#timer = setTimeout(() => this.#ask(), AGAIN_MS);
      this.results.node.setAttribute("aria-busy", String(isOpen));
    } catch (error) {
      if (error.name === "AbortError" || asked !== this.#asked) return;
      this.#fail(error.message);
    }
  }

  #fail(message) {
    this.error.hidden = false;
    this.error.textContent = message;
    this.results.node.setAttribute("aria-busy", "false");
  }

  #take(answer) {
    this.#answer = answer;
    this.error.hidden = !answer.error;
    this.error.textContent = answer.error;
    this.#drawScenarios(answer);
    this.#drawFirst();
    this.#drawPieces();
    this.results.draw(answer);
    this.write.disabled = answer.anchored.length === 0;
    this.status.textContent = this.results.summary(answer);
  }

  #drawScenarios({ scenarios, scenario }) {
    const key = JSON.stringify(scenarios);
    if (key !== this.scenariosShown) clear(this.scenario).append(...scenarios.map(([value, text]) => el("option", { value, text })));
    this.scenariosShown = key;
    this.scenario.value = this.#scenario ?? scenario;
  }

  // ---- what to do with it

  #reset() {
    this.#ticked.clear();
    this.#first = 0;
    this.#scenario = null;
    this.#setScale(1);
    this.#drawFirst();
    this.#drawPieces();
  }

  /** Write Anchored = yes for the pieces that are anchored here: one step of undo. Shaking and scenario are not written. */
  async #write() {
    const rows = this.#answer?.anchored ?? [];
    if (!rows.length) return;
    const question = tn("Write Anchored: yes into the workbook for {n:,} row? Strength and scenario are not written. Undo takes it back.", "Write Anchored: yes into the workbook for {n:,} rows? Strength and scenario are not written. Undo takes it back.", rows.length);
    if (!(await ask(question, [[t("Write"), true], [t("Cancel"), false]]))) return;
    if (!(await this.edits.anchor(rows, t("anchor")))) return;
    this.#ticked.clear();
    this.#first = 0;
    this.#askSoon(0);
    this.store.offerUndo(tn("{n:,} row written.", "{n:,} rows written.", rows.length));
  }
}
