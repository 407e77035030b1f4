// What changes: counts by class, states of routes and rooms, pieces of another class, each beside the present.

import { CLASSES, badge, chanceText, describe, isPale } from "./classes.mjs";
import { clear, el } from "./elements.mjs";
import { simulationText } from "./frame.mjs";
import { percent, t, tn } from "./texts.mjs";

const MOST = 300;
const ORDER = ["open", "doubtful", "not_known", "blocked"];
const SIGNS = { open: "✓", doubtful: "≈", not_known: "?", blocked: "✕" };

export class Results {
  #showsAll = false;
  #answer = null;

  constructor(store) {
    this.store = store;
    this.node = el("div", { class: "results", "aria-busy": "true" }, el("p", { class: "muted", text: t("Computing…") }));
  }

  draw(answer) {
    this.#answer = answer;
    clear(this.node).append(el("div", { class: "stack" }, this.#counts(answer), this.#states(answer)), this.#pieces(answer));
  }

  /** One sentence for those who hear the page. */
  summary({ before, after }) {
    const parts = CLASSES.map((key) => t("{word}: {before}, then {after}", { word: describe(key).word, before: before.counts[key] ?? 0, after: after.counts[key] ?? 0 }));
    return parts.join("; ");
  }

  // ---- counts

  #counts({ before, after }) {
    const keys = [...CLASSES, ""];
    const most = Math.max(1, ...keys.flatMap((key) => [before.counts[key] ?? 0, after.counts[key] ?? 0]));
    const rows = keys.map((key) => this.#bars(key, before.counts[key] ?? 0, after.counts[key] ?? 0, most));
    return el("section", { class: "card" }, el("h2", { text: t("Pieces by class") }), provisional(this.#answer),
      el("table", { class: "bars" }, el("thead", null, el("tr", null, el("th", { scope: "col", text: t("Class") }), el("th", { scope: "col", class: "num", text: t("now") }), el("th", { scope: "col", class: "num", text: t("then") }), el("th", { scope: "col", class: "num", text: t("change") }), el("td", { class: "bar-cell" }))), el("tbody", null, rows)));
  }

  #bars(key, before, after, most) {
    const { sign, word, css } = describe(key);
    const bar = (n, name) => el("div", { class: `bar ${name} ${css}`, style: { width: `${(100 * n) / most}%` } });
    const change = after - before;
    const shown = change === 0 ? "=" : change > 0 ? `+${change}` : `−${-change}`;
    return el("tr", null, el("th", { scope: "row" }, el("span", { class: `badge ${css}`, "aria-hidden": "true", text: sign }), ` ${key ? word : t("anchored or no class")}`),
      el("td", { class: "num", text: before }), el("td", { class: "num strong", text: after }), el("td", { class: `num ${change ? "changed" : "muted"}`, text: shown }),
      el("td", { class: "bar-cell", "aria-hidden": "true" }, bar(before, "was"), bar(after, "is")));
  }

  // ---- routes and rooms

  #states({ before, after }) {
    const pairs = [...join(before.routes, after.routes, (one) => one.route, () => t("Route")), ...join(before.rooms, after.rooms, (one) => one.room, () => t("Room"))];
    if (!pairs.length) return el("section", { class: "card" }, el("h2", { text: t("Routes and rooms") }), el("p", { class: "muted", text: t("The workbook has no routes.") }));
    const changed = pairs.filter(({ was, is }) => was?.word !== is?.word || was?.state !== is?.state);
    const box = el("input", { type: "checkbox", checked: this.#showsAll });
    box.addEventListener("change", () => ((this.#showsAll = box.checked), this.draw(this.#answer)));
    const shown = this.#showsAll ? pairs : changed;
    const said = changed.length ? tn("{n:,} state changes.", "{n:,} states change.", changed.length) : t("No state changes.");
    return el("section", { class: "card" }, el("h2", { text: t("Routes and rooms") }), this.#tally(before, after), el("div", { class: "buttons" }, el("p", { text: said }), el("label", { class: "check" }, box, t("Show all"))), shown.length > 0 && wide(t("Routes and rooms"), this.#stateTable(shown)));
  }

  /** How many routes and rooms are in each state, now and then. */
  #tally(before, after) {
    const count = (rows) => ORDER.map((state) => [state, rows.filter((one) => one.state === state).length]).filter(([, n]) => n);
    const list = (rows) => el("span", { class: "tally" }, count(rows).map(([state, n]) => el("span", { class: `state-${state.replace("_", "-")}` }, el("span", { class: "state-dot", "aria-hidden": "true", text: SIGNS[state] }), `${n}`, el("span", { class: "unseen", text: ` ${say(state)}` }))));
    const line = (label, was, is) => el("tr", null, el("th", { scope: "row", text: label }), el("td", null, list(was)), el("td", null, list(is)));
    return el("table", { class: "plain tallies" }, el("thead", null, el("tr", null, el("td"), el("th", { scope: "col", text: t("now") }), el("th", { scope: "col", text: t("then") }))),
      el("tbody", null, line(t("Routes"), before.routes, after.routes), line(t("Rooms"), before.rooms, after.rooms)));
  }

  #stateTable(pairs) {
    const cell = (one) => (one ? el("td", null, el("span", { class: `state-word state-${one.standing ? "standing" : one.state.replace("_", "-")}`, title: one.detail, text: one.word }), one.chance !== null && [" ", shownChance(one.chance)]) : el("td", { text: "–" }));
    return el("table", { class: "plain" }, el("thead", null, el("tr", null, [t("Route or room"), t("now"), t("then")].map((text) => el("th", { scope: "col", text })))),
      el("tbody", null, pairs.slice(0, MOST).map(({ kind, name, was, is }) => el("tr", null, el("th", { scope: "row" }, el("span", { class: "muted", text: `${kind} ` }), name), cell(was), cell(is)))));
  }

  // ---- pieces

  #pieces({ before, after, anchored }) {
    const was = byRow(before.items);
    const is = byRow(after.items);
    const items = this.store.sheet("Items");
    const at = items?.column("item")?.at ?? 0;
    const about = items?.column("description")?.at;
    const changed = [...is].filter(([row, one]) => one.class !== was.get(row)?.class).map(([row, one]) => ({ row, was: was.get(row), is: one }));
    const rank = (one) => (one?.class ? CLASSES.indexOf(one.class) : CLASSES.length);
    changed.sort((a, b) => rank(a.is) - rank(b.is) || rank(a.was) - rank(b.was) || a.row - b.row);
    const head = el("h2", { text: t("Pieces of another class ({n})", { n: changed.length }) });
    if (!changed.length) return el("section", { class: "card" }, head, el("p", { class: "muted", text: t("No piece changes its class.") }));
    const isAnchored = new Set(anchored);
    const cell = (one, row, isThen) => el("td", null, one?.class ? [badge(one.class, { isPale: isPale(one) }), " ", el("span", { class: "chance", text: chanceText(one) })] : isThen && isAnchored.has(row) ? `⚓ ${t("anchored")}` : one?.word || "–");
    const rows = changed.slice(0, MOST).map((one) => el("tr", null, el("th", { scope: "row", class: "chance", text: items?.value(one.row, at) ?? one.row }), el("td", { text: about === undefined ? "" : items.value(one.row, about) ?? "" }), cell(one.was, one.row, false), cell(one.is, one.row, true)));
    const more = changed.length - MOST;
    return el("section", { class: "card" }, head, wide(head.textContent, el("table", { class: "plain" }, el("thead", null, el("tr", null, [t("Item"), t("Description"), t("now"), t("then")].map((text) => el("th", { scope: "col", text })))), el("tbody", null, rows))), more > 0 && el("p", { class: "muted", text: tn("{n:,} more", "{n:,} more", more) }));
  }
}

/** How far the simulation is, while classes go by the formula. */
const provisional = ({ simulation }) => (simulation.state === "done" ? null : el("p", { class: "hint basis-note", text: simulationText(simulation) }));

/** A table that scrolls where it is wider than its card, by keys as well. */
const wide = (label, table) => el("div", { class: "scroll-x", tabIndex: 0, role: "region", "aria-label": label }, table);

const say = (state) => ({ open: t("open"), doubtful: t("doubtful"), not_known: t("not known"), blocked: t("blocked") })[state];

const shownChance = (chance) => el("span", { class: "chance", text: percent(chance) });

const byRow = ({ row, ...named }) => new Map(row.map((one, i) => [one, Object.fromEntries(Object.entries(named).map(([name, all]) => [name, all[i]]))]));

function join(before, after, nameOf, kindOf) {
  const was = new Map(before.map((one) => [nameOf(one), one]));
  const is = new Map(after.map((one) => [nameOf(one), one]));
  return [...new Set([...was.keys(), ...is.keys()])].map((name) => ({ kind: kindOf(), name, was: was.get(name), is: is.get(name) }));
}
