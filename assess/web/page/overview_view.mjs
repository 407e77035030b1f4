// The overview: what is to be expected of the building in one sentence, floor by floor, and what to do first.

import { get } from "./api.mjs";
import { CLASSES, badge, classStyle, classText, describe } from "./classes.mjs";
import { problemLine } from "./fixes.mjs";
import { simulationText } from "./frame.mjs";
import { showFiles } from "./open_file.mjs";
import { number, percent, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const SETTLED_MS = 300;
const MOST_DOTS = 300; // of a floor; more are counted
const MOST_LACKS = 5;
const SIGNS = { blocked: "✕", not_known: "?", doubtful: "≈", open: "✓" };
const STATES = { blocked: (n) => tn("{n:,} blocked", "{n:,} blocked", n), not_known: (n) => tn("{n:,} not known", "{n:,} not known", n), doubtful: (n) => tn("{n:,} doubtful", "{n:,} doubtful", n), open: (n) => tn("{n:,} open", "{n:,} open", n) };
const floorName = (floor) => (floor ? t("Floor {floor}", { floor }) : t("On no floor of the workbook"));

class OverviewView {
  #root;
  #store;
  #data = null;
  #stamp = null;
  #timer = 0;
  #asked = 0;
  #isShown = false;

  constructor(root, store) {
    this.#root = root;
    this.#store = store;
    root.setAttribute("aria-busy", "true");
    store.addEventListener("live", () => this.#follow());
    store.addEventListener("book", () => ((this.#data = this.#stamp = null), this.#follow()));
    this.#draw();
  }

  show() {
    this.#isShown = true;
    if (this.#stamp === null) this.#ask();
    else this.#follow();
  }

  hide() {
    this.#isShown = false;
  }

  /** Dots follow every change at once; all that is counted is asked for once changes pause. */
  #follow() {
    if (!this.#isShown || !this.#store.book) return;
    this.#draw();
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#ask(), this.#stamp === null ? 0 : SETTLED_MS);
  }

  async #ask() {
    const { stamp, isSimulating, state } = this.#store;
    if (stamp === null || stamp === this.#stamp) return;
    const { basis, version } = this.#data ?? {};
    if (isSimulating && (basis === "simulated" || (basis && version === state.version))) return; // more is to come
    const asked = (this.#asked += 1);
    try {
      const data = await get("/api/overview");
      if (asked === this.#asked) [this.#data, this.#stamp] = [data, stamp];
    } catch (error) {
      if (error.status && asked === this.#asked) this.#data = { error: error.message };
    }
    if (asked !== this.#asked) return;
    this.#root.removeAttribute("aria-busy");
    this.#draw();
  }

  #draw() {
    const data = this.#data;
    const { simulation } = this.#store;
    render(data ? html`<div class="page-like overview">
      <section class="outcome" aria-label=${t("Outcome")}>
        <h2>${data.outcome || data.error || t("Nothing has a class yet.")}</h2>
        ${simulation.state !== "done" ? html`<p class="provisional">${simulationText(simulation)}</p>` : nothing}
        ${(data.about ?? []).map((text) => html`<p class="muted">${text}</p>`)}
      </section>
      ${data.ways ? this.#ways(data.ways) : nothing}
      <div class="column">${data.floors?.length ? this.#floors(data.floors) : nothing}${data.worst?.length ? this.#worst(data.worst) : nothing}${this.#lacks()}</div>
      ${data.fixes?.length ? this.#fixes(data) : nothing}
    </div>` : html`<div class="page-like"><p class="muted">${t("Computing…")}</p></div>`, this.#root);
  }

  // ---- ways out

  #ways({ routes, floors, worst, error }) {
    const n = sum(routes);
    if (!n && !floors.length) return nothing;
    return html`<section class="card ways-out" aria-labelledby="ways-title">
      <h3 id="ways-title">${t("Ways out of the building, worst first")}</h3>
      ${error ? html`<p class="warning-text">${error}</p>` : nothing}
      ${n ? html`<p>${tn("{n:,} route:", "{n:,} routes:", n)} ${tally(routes)}</p>` : nothing}
      ${floors.length ? nothing : html`<ul class="states">${worst.map((one) => state(one, one.route))}</ul>`}
      ${floors.map((floor) => html`<div class="way-floor">
        <button type="button" class="quiet" @click=${() => this.#openPlan("Floors", floor.row)}><b>${floorName(floor.floor)}</b> ${tally(floor.rooms)}</button>
        ${floor.worst.length ? html`<ul class="states">${floor.worst.map((one) => state(one, one.room, () => this.#openPlan("Places", one.place_row)))}</ul>` : nothing}
      </div>`)}
    </section>`;
  }

  // ---- floors

  #floors(floors) {
    const onDot = ({ target }) => target.dataset?.row && this.#reveal(Number(target.dataset.row));
    return html`<section class="card" aria-labelledby="floors-title">
      <h3 id="floors-title">${t("Pieces by floor")}</h3>
      <div class="stack" @click=${onDot}>${floors.map((one) => this.#floor(one))}</div>
    </section>`;
  }

  #floor({ row, floor, name, items }) {
    const sheet = this.#store.sheet("Items");
    const [at, of] = [sheet?.column("quantity")?.at, sheet?.column("item")?.at ?? 0];
    const rank = (one) => (one?.class ? CLASSES.indexOf(one.class) : CLASSES.length);
    const rows = items.map((one) => ({ row: one, live: this.#store.live.get(one), n: Number(at === undefined ? 1 : sheet.value(one, at) ?? 1) || 1 }));
    rows.sort((a, b) => rank(a.live) - rank(b.live) || (b.live?.chance ?? 0) - (a.live?.chance ?? 0) || a.row - b.row);
    const counts = {};
    for (const one of rows) counts[one.live?.class ?? ""] = (counts[one.live?.class ?? ""] ?? 0) + one.n;
    const said = [...CLASSES, ""].filter((key) => counts[key]).map((key) => t("{word}: {n:,}", { word: describe(key).word, n: counts[key] })).join(", ");
    const title = (one) => [sheet.value(one.row, of), classText(one.live)].filter(Boolean).join(", ");
    const dots = (one) => Array.from({ length: one.n }, () =>
      html`<span class="dot ${classStyle(one.live)}" data-row=${one.row} title=${title(one)}>${describe(one.live?.class).sign}</span>`);
    const label = html`<b>${floor ? floor : floorName("")}</b>${name && name !== floor ? html` <span class="muted">${name}</span>` : nothing}<span class="unseen"> ${said}</span>`;
    return html`<div class="storey">
      <span class="storey-name">${row ? html`<button type="button" class="quiet" title=${t("Show on the plan")} @click=${() => this.#openPlan("Floors", row)}>${label}</button>` : label}</span>
      <span class="dots" aria-hidden="true">${sum(counts) > MOST_DOTS ? [...CLASSES, ""].filter((key) => counts[key]).map((key) => html`<span class="dot many ${describe(key).css}">${describe(key).sign} ${number(counts[key], 0, true)}</span>`) : rows.map(dots)}</span>
    </div>`;
  }

  // ---- pieces and fixes

  #worst(worst) {
    return html`<section class="card" aria-labelledby="worst-title">
      <h3 id="worst-title">${t("Most likely to fall")}</h3>
      <table class="plain"><tbody>${worst.map((one) => html`<tr>
        <th scope="row"><button type="button" class="quiet link" @click=${() => this.#reveal(one.row)}>${one.item}</button><span class="hint"> ${one.what}, ${floorName(one.floor)}</span></th>
        <td>${badge(one.class, { isPale: one.basis === "formula" })}${one.basis === "unconfirmed" ? html` <span class="hint">${t("unconfirmed")}</span>` : nothing}</td><td class="num">${one.basis === "formula" ? nothing : one.chance}</td></tr>`)}</tbody></table>
    </section>`;
  }

  #fixes({ fixes, entries, falls, ways, after }) {
    const hasWays = sum(ways.routes) > 0;
    const left = (pieces, states) => html`<td class="num">${number(pieces, 1)}</td>${hasWays ? html`<td class="num">${states ? tally(states, ["blocked", "doubtful", "not_known"], true) : "…"}</td>` : nothing}`;
    return html`<section class="card wide" aria-labelledby="fixes-title">
      <h3 id="fixes-title">${t("What to fix first, and what remains")}</h3>
      <div class="scroll-x" tabindex="0" role="region" aria-labelledby="fixes-title"><table class="plain">
        <thead><tr><td></td><th scope="col" class="num">${t("Expected falls")}</th>${hasWays ? html`<th scope="col" class="num">${t("Ways out not open")}</th>` : nothing}</tr></thead>
        <tbody><tr><th scope="row">${t("Today")}</th>${left(falls[0], ways.routes)}</tr>
        ${fixes.map((one, at) => html`<tr><th scope="row">${at + 1}. <button type="button" class="quiet link" @click=${() => this.#reveal(one.row)}>${one.item}</button> ${badge(one.class, { isPale: one.basis === "formula" })}
          <span class="hint">${one.what}, ${floorName(one.floor)}; ${one.why}</span></th>${left(one.falls_left, one.ways_left)}</tr>`)}
        ${entries > fixes.length ? html`<tr><th scope="row">${t("All {n:,} entries", { n: entries })}</th>${left(after.falls, after.ways)}</tr>` : nothing}</tbody>
      </table></div>
      <div class="buttons"><a class="button" href="#what-if">${t("Try it in What if")}</a></div>
    </section>`;
  }

  // ---- what is missing

  #lacks() {
    const { problems, book } = this.#store;
    const found = problems.filter((one) => one.severity === "error" || one.lacks);
    const files = book?.missing?.length ?? 0;
    if (!found.length && !files) return nothing;
    const rest = found.length - MOST_LACKS;
    return html`<section class="card lacks" aria-labelledby="lacks-title">
      <h3 id="lacks-title">${t("What is missing")}</h3>
      <ul class="problem-list">${found.slice(0, MOST_LACKS).map((one) => problemLine(this.#store, one))}
        ${rest > 0 ? html`<li><a href="#sheet">${tn("{n:,} more in the sheet", "{n:,} more in the sheet", rest)}</a></li>` : nothing}
        ${files ? html`<li><button type="button" @click=${() => showFiles(this.#store)}>${tn("{n} file missing", "{n} files missing", files)}</button></li>` : nothing}</ul>
    </section>`;
  }

  // ---- where it leads

  #reveal(row) {
    location.hash = "#sheet";
    this.#store.reveal(["Items", row, this.#store.sheet("Items")?.column("item")?.at ?? 0]);
  }

  #openPlan(sheet, row) {
    this.#store.select({ sheet, row }, "overview");
    location.hash = "#plan";
  }
}

const sum = (counts) => Object.values(counts).reduce((all, n) => all + n, 0);

/** How many routes or rooms are in each state; `isShort`: signs and numbers, words for those who hear the page. */
function tally(counts, states = Object.keys(STATES), isShort = false) {
  const shown = states.filter((key) => counts[key]);
  const words = (key) => (isShort ? html`${counts[key]}<span class="unseen"> ${STATES[key](counts[key])}</span>` : STATES[key](counts[key]));
  return html`<span class="tally">${shown.length ? nothing : "0"}${shown.map((key) => html`<span class="state-${key.replace("_", "-")}" title=${STATES[key](counts[key])}><span class="state-dot" aria-hidden="true">${SIGNS[key]}</span>${words(key)}</span>`)}</span>`;
}

/** A route or a room in its state; `run` shows it. */
function state({ state: key, standing, word, chance, detail }, name, run) {
  const css = `state-${standing ? "standing" : key.replace("_", "-")}`;
  return html`<li class=${css} title=${detail}>${run ? html`<button type="button" class="quiet link" @click=${run}>${name}</button>` : html`<b>${name}</b>`}
    <span class="state-word">${word}</span>${chance === null ? nothing : html` <span class="chance">${percent(chance)}</span>`}</li>`;
}

export const createView = (root, store) => new OverviewView(root, store);
