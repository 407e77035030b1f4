// The tab "What if": another shaking, another scenario, pieces anchored; what changes, beside the present. Nothing is saved.

import { post } from "./api.mjs";
import { CLASSES, badge, chanceText, describe, isPale } from "./classes.mjs";
import { simulationText } from "./frame.mjs";
import { ask } from "./messages.mjs";
import { STATES, nameKey, stateCss, stateWords } from "./plan_model.mjs";
import { number, percent, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

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

// ---- what changes, each beside the present

/** One sentence for those who hear the page. */
const summary = ({ before, after }) =>
  CLASSES.map((key) => t("{word}: {before}, then {after}", { word: describe(key).word, before: before.counts[key] ?? 0, after: after.counts[key] ?? 0 })).join("; ");

/** All of it; `showsAll`: also the states that stay, `toggle` is called with another wish. */
const results = (answer, store, showsAll, toggle) =>
  html`<div class="stack">${countsCard(answer)}${statesCard(answer, showsAll, toggle)}</div>${piecesCard(answer, store)}`;

const card = (title, content) => html`<section class="card"><h2>${title}</h2>${content}</section>`;

const headers = (...texts) => html`<thead><tr>${texts.map((text) => html`<th scope="col">${text}</th>`)}</tr></thead>`;

/** A table that scrolls where it is wider than its card, by keys as well. */
const wide = (label, head, rows) => html`<div class="scroll-x" tabindex="0" role="region" aria-label=${label}>
  <table class="plain">${head}<tbody>${rows.slice(0, MOST)}</tbody></table></div>`;

// ---- counts

function countsCard({ before, after, simulation }) {
  const keys = [...CLASSES, ""];
  const pairs = keys.map((key) => [before, after].map(({ counts }) => counts[key] ?? 0));
  const most = Math.max(1, ...pairs.flat());
  return card(t("Pieces by class"), html`${simulation.state === "done" ? nothing : html`<p class="hint basis-note">${simulationText(simulation)}</p>`}
    <table class="bars"><thead><tr><th scope="col">${t("Class")}</th>${[t("now"), t("then"), t("change")].map((text) => html`<th scope="col" class="num">${text}</th>`)}
      <td class="bar-cell"></td></tr></thead><tbody>${keys.map((key, i) => bars(key, pairs[i], most))}</tbody></table>`);
}

function bars(key, [before, after], most) {
  const { sign, word, css } = describe(key);
  const bar = (n, name) => html`<div class="bar ${name} ${css}" .style="width: ${(100 * n) / most}%"></div>`;
  const change = after - before;
  const shown = change === 0 ? "=" : change > 0 ? `+${change}` : `−${-change}`;
  return html`<tr><th scope="row"><span class="badge ${css}" aria-hidden="true">${sign}</span> ${key ? word : t("anchored or no class")}</th>
    <td class="num">${before}</td><td class="num strong">${after}</td><td class="num ${change ? "changed" : "muted"}">${shown}</td>
    <td class="bar-cell" aria-hidden="true">${bar(before, "was")}${bar(after, "is")}</td></tr>`;
}

// ---- routes and rooms

function statesCard({ before, after }, showsAll, toggle) {
  const title = t("Routes and rooms");
  const pairs = [...join(before.routes, after.routes, "route", t("Route")), ...join(before.rooms, after.rooms, "room", t("Room"))];
  if (!pairs.length) return card(title, html`<p class="muted">${t("The workbook has no routes.")}</p>`);
  const changed = pairs.filter(({ was, is }) => was?.word !== is?.word || was?.state !== is?.state);
  const shown = showsAll ? pairs : changed;
  const said = changed.length ? tn("{n:,} state changes.", "{n:,} states change.", changed.length) : t("No state changes.");
  const cell = (one) => html`<td>${one ? html`<span class="state-word ${stateCss(one)}" title=${one.detail}>${one.word}</span>
    ${one.chance === null ? nothing : html`<span class="chance">${percent(one.chance)}</span>`}` : "–"}</td>`;
  const rows = shown.map(({ kind, name, was, is }) => html`<tr><th scope="row"><span class="muted">${kind} </span>${name}</th>${cell(was)}${cell(is)}</tr>`);
  return card(title, html`${tally(before, after)}<div class="buttons"><p>${said}</p>
    <label class="check"><input type="checkbox" .checked=${showsAll} @change=${({ target }) => toggle(target.checked)}>${t("Show all")}</label></div>
    ${shown.length ? wide(title, headers(t("Route or room"), t("now"), t("then")), rows) : nothing}`);
}

/** How many routes and rooms are in each state, now and then. */
function tally(before, after) {
  const words = stateWords();
  const count = (rows) => html`<td><span class="tally">${Object.keys(STATES).map((state) => {
    const n = rows.filter((one) => one.state === state).length;
    return n ? html`<span class=${stateCss({ state })}><span class="state-dot" aria-hidden="true">${STATES[state]}</span>${n}<span class="unseen"> ${words[state]}</span></span>` : nothing;
  })}</span></td>`;
  const line = (label, name) => html`<tr><th scope="row">${label}</th>${count(before[name])}${count(after[name])}</tr>`;
  return html`<table class="plain tallies"><thead><tr><td></td><th scope="col">${t("now")}</th><th scope="col">${t("then")}</th></tr></thead>
    <tbody>${line(t("Routes"), "routes")}${line(t("Rooms"), "rooms")}</tbody></table>`;
}

function join(before, after, field, kind) {
  const [was, is] = [before, after].map((rows) => new Map(rows.map((one) => [one[field], one])));
  return [...new Set([...was.keys(), ...is.keys()])].map((name) => ({ kind, name, was: was.get(name), is: is.get(name) }));
}

// ---- pieces

const byRow = ({ row, ...named }) => new Map(row.map((one, i) => [one, Object.fromEntries(Object.entries(named).map(([name, all]) => [name, all[i]]))]));

function piecesCard({ before, after, anchored }, store) {
  const [then, now] = [byRow(after.items), byRow(before.items)];
  const items = store.sheet("Items");
  const text = (row, field) => items?.column(field) && items.value(row, items.column(field).at);
  const rank = (one) => (one?.class ? CLASSES.indexOf(one.class) : CLASSES.length);
  const changed = [...then].map(([row, is]) => ({ row, is, was: now.get(row) })).filter(({ is, was }) => is.class !== was?.class)
    .sort((a, b) => rank(a.is) - rank(b.is) || rank(a.was) - rank(b.was) || a.row - b.row);
  const title = t("Pieces of another class ({n})", { n: changed.length });
  if (!changed.length) return card(title, html`<p class="muted">${t("No piece changes its class.")}</p>`);
  const shown = (one, isAnchored) => {
    if (one?.class) return html`${badge(one.class, { isPale: isPale(one) })} <span class="chance">${chanceText(one)}</span>`;
    return isAnchored ? `⚓ ${t("anchored")}` : one?.word || "–";
  };
  const rows = changed.map(({ row, was, is }) => html`<tr><th scope="row" class="chance">${text(row, "item") ?? row}</th>
    <td>${text(row, "description") ?? ""}</td><td>${shown(was, false)}</td><td>${shown(is, anchored.includes(row))}</td></tr>`);
  const more = changed.length - MOST;
  return card(title, html`${wide(title, headers(t("Item"), t("Description"), t("now"), t("then")), rows)}
    ${more > 0 ? html`<p class="muted">${tn("{n:,} more", "{n:,} more", more)}</p>` : nothing}`);
}
