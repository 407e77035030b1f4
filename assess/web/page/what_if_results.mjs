// What changes: counts by class, states of routes and rooms, pieces of another class, each beside the present.

import { CLASSES, badge, chanceText, describe, isPale } from "./classes.mjs";
import { simulationText } from "./frame.mjs";
import { STATES, stateCss, stateWords } from "./plan_model.mjs";
import { percent, t, tn } from "./texts.mjs";
import { html, nothing } from "./vendor/lit-html.mjs";

const MOST = 300;

/** One sentence for those who hear the page. */
export const summary = ({ before, after }) =>
  CLASSES.map((key) => t("{word}: {before}, then {after}", { word: describe(key).word, before: before.counts[key] ?? 0, after: after.counts[key] ?? 0 })).join("; ");

/** All of it; `showsAll`: also the states that stay, `toggle` is called with another wish. */
export const results = (answer, store, showsAll, toggle) =>
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
