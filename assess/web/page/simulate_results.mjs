// The results of a simulation: counts before and after, classes that changed, files, the report.

import { CLASSES, badge } from "./classes.mjs";
import { clear, el } from "./elements.mjs";
import { countPieces, countSimulated } from "./job.mjs";
import { bytes, number, percent, t, tn } from "./texts.mjs";

const ARCHIVE = "report.zip";
const MOST_CHANGED = 200;
const MOST_OPEN = 10;
const LABELS = {
  "report.html": () => t("Report as a page"),
  "report.pdf": () => t("Report for the client (PDF)"),
  "annex.pdf": () => t("Annex with all details (PDF)"),
  "report.xlsx": () => t("Report with live formulas (Excel)"),
  "report.docx": () => t("Report for the client (Word)"),
  "results.json": () => t("All results, for other programs (JSON)"),
  "items.csv": () => t("Table of the pieces (CSV)"),
};
const address = (name) => `/api/job/file/${encodeURIComponent(name)}`;

export class ResultsView {
  #store;
  #reveal;
  #begin;
  #framed = "";
  #isListOpen = false;

  /** `begin` gets the request of POST /api/job. */
  constructor(store, reveal, begin) {
    this.#store = store;
    this.#reveal = reveal;
    this.#begin = begin;
    this.top = el("div", { class: "results" });
    this.frame = el("div", { class: "report" });
    this.node = el("section", { class: "results", "aria-label": t("Results"), hidden: true }, this.top, this.frame);
  }

  update(job) {
    const rows = this.#rows(job);
    clear(this.top).append(...[
      el("h2", { text: t("Results") }), this.#stale(job), this.#files(job), countsCard(job), fixing(job), this.#changed(rows),
    ].filter(Boolean));
    this.#showReport(job);
  }

  /** Every row with its class by the formula and the one that the run adopted, both as the run found them. */
  #rows(job) {
    const { row, chance, low, high, simulated, formula } = job.items;
    const stale = new Set(job.stale);
    return row.map((one, at) => ({
      row: one, before: formula[at], after: job.items.class[at], chance: chance[at], low: low[at], high: high[at],
      isSimulated: simulated[at], isStale: stale.has(one),
    }));
  }

  #stale(job) {
    const n = job.stale.length;
    if (!n) return null;
    const text = tn("Inputs changed since this run: {n:,} piece. Its simulated class is shown in grey.", "Inputs changed since this run: {n:,} pieces. Their simulated classes are shown in grey.", n);
    return el("p", { class: "warning-text stale-note", role: "status", text });
  }

  #files(job) {
    const one = ({ name, bytes: size }) =>
      el("li", null, el("a", { href: address(name), download: name, text: LABELS[name]?.() ?? name }), " ", el("span", { class: "hint", text: `${name}, ${bytes(size)}` }));
    const files = job.files.filter(({ name }) => name !== ARCHIVE);
    const hasAll = job.files.some(({ name }) => name === ARCHIVE);
    const request = { ...job.settings, first: job.before_after?.first, formats: [...job.formats, "annex"] };
    const annex = el("button", { type: "button", text: t("Simulate again with the annex (PDF)"), on: { click: () => this.#begin(request) } });
    return el("section", { class: "card" }, el("h3", { text: t("Files") }), el("ul", { class: "file-list" }, files.map(one)),
      el("div", { class: "buttons" }, hasAll && el("a", { class: "button primary", href: address(ARCHIVE), download: ARCHIVE, text: t("Download all in one file (ZIP)") }),
        !job.formats.includes("annex") && annex));
  }

  #changed(rows) {
    if (!rows.some((one) => one.isSimulated)) return null;
    const order = (one) => CLASSES.indexOf(one.after) * 10 - (one.chance ?? 0);
    const changed = rows.filter((one) => one.before !== one.after && one.isSimulated).sort((a, b) => order(a) - order(b));
    const title = el("h3", { text: tn("{n:,} class changed by the simulation", "{n:,} classes changed by the simulation", changed.length) });
    if (!changed.length) return el("section", { class: "card" }, title, el("p", { text: t("Every simulated piece keeps the class of the formula.") }));
    const more = changed.length - MOST_CHANGED;
    const list = table([t("Item"), t("By the formula"), t("Simulated"), t("Chance"), ""], changed.slice(0, MOST_CHANGED).map((one) => this.#line(one)));
    const rest = more > 0 && el("p", { text: tn("and {n:,} more: see the sheet", "and {n:,} more: see the sheet", more) });
    if (changed.length <= MOST_OPEN) return el("section", { class: "card" }, title, list);
    const fold = el("details", { class: "fold", open: this.#isListOpen }, el("summary", { text: t("Show the list") }), list, rest);
    fold.addEventListener("toggle", () => (this.#isListOpen = fold.open)); // results are drawn anew after every change
    return el("section", { class: "card" }, title, fold);
  }

  #line(one) {
    const items = this.#store.sheet("Items");
    const at = items?.column("item")?.at ?? 0;
    const name = String(items?.value(one.row, at) ?? t("row {n}", { n: one.row }));
    const range = one.low !== null && el("span", { class: "range hint", text: t("({low} to {high})", { low: percent(one.low), high: percent(one.high) }) });
    const isHigher = CLASSES.indexOf(one.after) < CLASSES.indexOf(one.before);
    const change = one.isStale ? t("inputs changed") : isHigher ? t("↑ raised") : t("↓ lowered");
    const link = el("button", { type: "button", class: "quiet link", text: name, on: { click: () => this.#reveal(["Items", one.row, at]) } });
    return el("tr", { class: one.isStale ? "stale" : "" }, el("th", { scope: "row" }, link), el("td", null, badge(one.before)), el("td", null, badge(one.after)),
      el("td", null, percent(one.chance), " ", range), el("td", { class: "change", text: change }));
  }

  /** The report in a frame that can do nothing but show it; made once a run, so that it does not jump. */
  #showReport(job) {
    if (this.#framed === job.id) return;
    this.#framed = job.id;
    clear(this.frame);
    if (!job.files.some(({ name }) => name === "report.html")) return;
    const frame = el("iframe", { src: `/api/job/report?id=${encodeURIComponent(job.id)}`, title: t("Report"), loading: "lazy" });
    frame.setAttribute("sandbox", "allow-scripts");
    this.frame.append(el("h2", { text: t("Report") }), frame);
  }
}

function table(heads, rows, isNumbers = false) {
  const head = el("tr", null, heads.map((text, at) => (text ? el("th", { scope: "col", class: at && isNumbers ? "num" : null, text }) : el("td"))));
  return el("div", { class: "scroll-x", tabIndex: 0, role: "group", "aria-label": heads[0] }, el("table", { class: "plain" }, el("thead", null, head), el("tbody", null, rows)));
}

const row = (head, ...numbers) => el("tr", null, el("th", { scope: "row" }, head), numbers.map((text) => el("td", { class: "num", text })));
const whole = (n) => number(n ?? 0, 0, true);
/** The expected falls, with what 5 and 95 % of the draws do not exceed. */
const falls = (side) => `${number(side.falls, 1)}${side.falls_low === null ? "" : ` (${whole(side.falls_low)}–${whole(side.falls_high)})`}`;

/** Pieces by class by the formula and by the simulation, both of the same run: each column is all pieces. */
function countsCard(job) {
  const simulated = countSimulated(job);
  if (!simulated) return el("p", { text: t("Nothing was simulated: all classes are those of the formula.") });
  const { items } = job;
  const formula = countPieces(items, (at) => items.formula[at]);
  const all = items.quantity.reduce((sum, n) => sum + n, 0);
  const anchored = countPieces(items, (at) => items.class[at])[""] ?? 0;
  const apart = (simulated[""] ?? 0) - anchored;
  const rows = CLASSES.map((key) => row(badge(key), whole(formula[key]), whole(simulated[key])));
  if (apart) rows.push(row(t("formula's class only"), "–", whole(apart)));
  rows.push(row(t("anchored"), whole(anchored), whole(anchored)), row(t("All pieces"), whole(all), whole(all)));
  return el("section", { class: "card" }, el("h3", { text: t("Pieces by class") }), table([t("Class"), t("By the formula"), t("With the simulation")], rows, true),
    apart > 0 && el("p", { class: "hint", text: t("Formula's class only: not simulated, or the simulation gave a lower class that its motions do not confirm.") }));
}

/** What fixing everything on the list would change: each column is all pieces. */
function fixing(job) {
  const sums = job.before_after;
  if (!sums?.entries) return null;
  const { before, after } = sums;
  const pair = (head, find) => row(head, whole(find(before)), whole(find(after)));
  const sum = (side) => CLASSES.reduce((n, key) => n + (side.counts[key] ?? 0), side.anchored + side.apart);
  const rows = CLASSES.map((key) => pair(badge(key), (side) => side.counts[key]));
  if (before.apart || after.apart) rows.push(pair(t("formula's class only"), (side) => side.apart));
  rows.push(pair(t("anchored"), (side) => side.anchored), pair(t("All pieces"), sum));
  rows.push(row(t("Pieces expected to overturn"), falls(before), falls(after)));
  const title = tn("If the {n:,} entry of the list of fixes is done", "If all {n:,} entries of the list of fixes are done", sums.entries);
  const basis = countSimulated(job) ? t("The list by the simulation, as in the reports. By the formulas, as in What if, it may have another number of entries.") : t("The list by the formula, as in the reports.");
  return el("section", { class: "card" }, el("h3", { text: title }), el("p", { class: "hint", text: basis }), table([t("Pieces"), t("Now"), t("Once fixed")], rows, true));
}
