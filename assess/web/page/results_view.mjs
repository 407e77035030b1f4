// Results: what a run found, its files made one by one as they are asked for, earlier runs, and what differs between two.

import { get } from "./api.mjs";
import { CLASSES, badge } from "./classes.mjs";
import { field } from "./elements.mjs";
import { problemLine } from "./fixes.mjs";
import { icon } from "./icons.mjs";
import { jobs } from "./job.mjs";
import { notice } from "./messages.mjs";
import { bytes, language, number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const MINUTE_S = 60;
const MOST_SHOWN = 20;
const RUNS = [100, 200, 500, 1000, 2000];
const USUAL = { verify: "all", runs: 200, seed: 1, scale: 1, scenario: "", first: 0 };
const FORMATS = {
  pdf: () => t("Report for the client (PDF)"),
  html: () => t("Report as a web page"),
  xlsx: () => t("Report with live formulas (Excel)"),
  docx: () => t("Report for the client (Word)"),
  annex: () => t("Annex with all details (PDF)"),
  work: () => t("Work orders by room, with stickers (PDF)"),
  csv: () => t("Table of the pieces (CSV)"),
  json: () => t("All results, for other programs (JSON)"),
};
const VERIFY = { all: () => t("All pieces"), high: () => t("Pieces at risk or on a route"), none: () => t("None: by the formula only") };
const APART = { unconfirmed: () => t("unconfirmed"), formula: () => t("not simulated"), rolls: () => t("rolls"), anchored: () => t("anchored") };

class ResultsView {
  #root;
  #store;
  #isShown = false;
  #fault = null;
  /** Requests go one after another: whether the run at hand serves is known once the one before is answered. */
  #making = Promise.resolve();
  #pair = [null, null];
  #compared = null;

  constructor(root, store) {
    this.#root = root;
    this.#store = store;
    jobs.addEventListener("change", () => this.#onChange());
    this.#draw();
  }

  show() {
    this.#isShown = true;
    this.#onChange();
  }

  hide() {
    this.#isShown = false;
  }

  #onChange() {
    if (!this.#isShown) return;
    const ids = jobs.runs.map((one) => one.id);
    if (!this.#pair.every((id) => ids.includes(id))) this.#choose(ids[1] ?? null, ids[0] ?? null);
    this.#draw();
  }

  #draw() {
    const job = jobs.current;
    const isRunning = job?.state === "running";
    render(html`<div class="page-like results-view">
      ${job?.found ? this.#found(job) : html`<section class="outcome"><h2>${t("Results")}</h2><p class="muted">${t("Every file is made of the workbook as it is now, all pieces simulated, while you go on working.")}</p></section>`}
      ${isRunning ? this.#progress(job) : nothing}
      <div role="alert">${this.#fault ? this.#complain(this.#fault) : job?.state === "failed" ? this.#complain(job) : nothing}</div>
      ${job?.state === "cancelled" ? html`<p role="status">${t("The run was cancelled. Nothing was written.")}</p>` : nothing}
      ${this.#files(job, isRunning)}
      ${jobs.runs.length ? this.#runs() : nothing}
      ${this.#compared ? this.#comparison(this.#compared) : nothing}
    </div>`, this.#root);
  }

  // ---- what was found

  #found({ found, time, is_old: isOld, settings }) {
    const { counts } = found;
    return html`<section class="outcome" aria-label=${t("Outcome")}>
      <h2>${found.outcome}</h2>
      <p class="muted">${t("Run of {time}, {settings}.", { time: when(time), settings: settingsText(settings) })} ${isOld ? html`<b class="warning-text">${t("The workbook has been changed since.")}</b>` : nothing}</p>
      <ul class="tiles" aria-label=${t("Pieces by class")}>${CLASSES.map((key) => html`<li>${badge(key)} <b>${number(counts[key], 0, true)}</b></li>`)}
        ${Object.entries(APART).filter(([key]) => counts[key]).map(([key, label]) => html`<li><span class="badge apart-${key}">${label()}</span> <b>${number(counts[key], 0, true)}</b></li>`)}</ul>
      ${found.about.map((text) => html`<p>${text}</p>`)}
    </section>`;
  }

  // ---- files

  #files(job, isRunning) {
    const isNow = job && !job.is_old && ["running", "done"].includes(job.state);
    const files = new Map((isNow ? job.files : []).map((one) => [one.format, one]));
    return html`<section class="card" aria-labelledby="files-head"><h3 id="files-head">${t("Files")}</h3>
      <ul class="file-rows">${Object.entries(FORMATS).map(([key, label]) => this.#file(key, label(), files.get(key), isRunning && !isNow))}</ul>
      <p class="hint"><a href="/api/download" download>${t("Download the workbook")}</a> ${t("In it Excel shows the class by the formula. The simulated class is on this page and in the reports.")}</p>
      <details class="fold"><summary>${t("Settings")}</summary>${this.#settings()}</details>
    </section>`;
  }

  #file(key, label, file = { state: "" }, isBlocked) {
    const id = encodeURIComponent(jobs.current?.id ?? "");
    const { state, message, name, bytes: size } = file;
    const make = html`<button type="button" class=${key === "pdf" && !isBlocked ? "primary" : ""} ?disabled=${isBlocked} aria-label=${t("Make: {file}", { file: label })} @click=${() => (this.#making = this.#making.then(() => this.#make(key)))}>${state === "failed" ? t("Try again") : t("Make")}</button>`;
    const there = () => html`<span class="hint">${bytes(size)}</span>
      ${key === "html" ? html`<a class="button" href="/api/job/report?id=${id}" target="_blank" rel="noopener">${icon("external")}${t("Open")}</a>` : nothing}
      <a class="button" href="/api/job/file/${name}?id=${id}" download=${name} aria-label=${t("Download {name}", { name })}>${icon("download")}${t("Download")}</a>`;
    const words = { waiting: t("waiting"), writing: t("being written…") };
    return html`<li class=${state || "none"}><span class="file-label">${label}${message ? html` <span class="error-text">${message}</span>` : nothing}</span>
      ${state === "there" ? there() : words[state] ? html`<span class="muted">${words[state]}</span>` : make}</li>`;
  }

  #settings() {
    const scenarios = jobs.scenarios ?? [];
    const options = (pairs, usual) => pairs.map(([value, label]) => html`<option value=${value} ?selected=${value === usual}>${label}</option>`);
    const runs = [...RUNS.map((n) => [String(n), n === USUAL.runs ? t("{n} (usual)", { n: number(n, 0, true) }) : number(n, 0, true)]), ["auto", t("as many as every class needs, up to 5,000")]];
    return html`<form class="fields run-settings" @submit=${(event) => event.preventDefault()}>
      ${field(t("Which pieces are simulated"), html`<select name="verify">${options(Object.entries(VERIFY).map(([key, label]) => [key, label()]), USUAL.verify)}</select>`)}
      ${field(t("Motions of each floor"), html`<select name="runs">${options(runs, String(USUAL.runs))}</select>`, t("More motions narrow the range of each chance, and take longer."))}
      ${field(t("Seed"), html`<input name="seed" type="number" min="0" step="1" value="1">`, t("The same seed gives the same result."))}
      ${field(t("Scale of the shaking"), html`<input name="scale" type="number" min="0.1" max="10" step="0.1" value="1">`)}
      ${field(t("Scenario"), html`<select name="scenario"><option value="">${t("As in the workbook")}</option>${options(scenarios)}</select>`)}
      ${field(t("As if fixed: first entries of what to fix"), html`<input name="first" type="number" min="0" step="1" value="0">`)}
    </form>`;
  }

  #request() {
    const form = this.#root.querySelector(".run-settings");
    const { verify, runs, seed, scale, scenario, first } = Object.fromEntries(new FormData(form));
    const whole = (text) => Math.max(0, Math.round(Number(text) || 0));
    return { verify, runs: runs === "auto" ? runs : Number(runs), seed: whole(seed), scale: Number(scale) || 1, scenario, first: whole(first) };
  }

  /** Make a file of the run at hand where that is of the workbook as it is, and of these settings; else of a new one. */
  async #make(format) {
    const job = jobs.current;
    const request = this.#request();
    const isSame = job && !job.is_old && ["running", "done"].includes(job.state) && Object.entries(request).every(([name, value]) => usual(job.settings)[name] === value);
    this.#fault = null;
    try {
      if (isSame) await jobs.post("/api/job/files", { id: job.id, formats: [format] });
      else await jobs.post("/api/job", { ...request, formats: [format] });
    } catch (error) {
      this.#fault = { message: error.message || t("The server does not answer."), problems: error.body?.problems ?? [] };
    }
    this.#draw();
  }

  // ---- how far it is

  #progress({ label, detail, share, seconds_left: left }) {
    const parts = [label, language() === "en" && detail !== label ? detail : "", `${Math.floor(100 * share)} %`, typeof left === "number" ? timeLeft(left) : ""]; // the detail is not translated
    return html`<section class="card" aria-label=${t("Progress")}><p role="status">${parts.filter(Boolean).join(", ")}</p>
      <progress max="1" .value=${share} aria-label=${t("Progress")}></progress>
      <div class="buttons"><button type="button" @click=${() => this.#post("cancel")}>${t("Cancel")}</button></div></section>`;
  }

  #post(what, body) {
    return jobs.post(`/api/job/${what}`, body).catch(explain);
  }

  /** What keeps it from running: the errors alone, each with a way to its cell. */
  #complain({ message, problems = [] }) {
    const errors = problems.filter((one) => one.severity === "error");
    const rest = errors.length - MOST_SHOWN;
    return html`<section class="card"><h3 class="error-text">${t("No report was made")}</h3>
      <p><b>${errors.length ? tn("{n:,} error to correct first", "{n:,} errors to correct first", errors.length) : message}</b></p>
      ${errors.length ? html`<ul class="problem-list">${errors.slice(0, MOST_SHOWN).map((one) => this.#error(one))}${rest > 0 ? html`<li>${tn("{n:,} more", "{n:,} more", rest)}</li>` : nothing}</ul>` : nothing}</section>`;
  }

  #error(problem) {
    const [, letters, row] = /^([A-Z]{1,3})(\d+)/.exec(problem.cell ?? "") ?? [];
    const at = [...(letters ?? "")].reduce((sum, letter) => 26 * sum + letter.charCodeAt(0) - 64, 0) - 1;
    return problemLine(this.#store, { ...problem, row: Number(row ?? 0), at, actions: [] });
  }

  // ---- runs

  #runs() {
    const many = jobs.runs.length > 1;
    const radio = (place, id, label) => html`<td><input type="radio" name=${`run-${place}`} aria-label=${label} .checked=${this.#pair[place] === id} @change=${() => this.#choose(...this.#pair.with(place, id))}></td>`;
    return html`<section class="card" aria-labelledby="runs-head"><h3 id="runs-head">${t("Runs of this workbook")}</h3>
      <div class="scroll-x" tabindex="0" role="region" aria-labelledby="runs-head"><table class="plain runs-table"><thead><tr>${many ? html`<th scope="col">${t("Before")}</th><th scope="col">${t("After")}</th>` : nothing}<th scope="col">${t("Run")}</th><th scope="col">${t("Outcome")}</th><th scope="col">${t("Files")}</th><td></td></tr></thead>
      <tbody>${jobs.runs.map((one) => html`<tr>${many ? html`${radio(0, one.id, t("Before: {time}", { time: when(one.time) }))}${radio(1, one.id, t("After: {time}", { time: when(one.time) }))}` : nothing}
        <th scope="row">${when(one.time)}<span class="hint"> ${t("version {n}", { n: one.version })}, ${settingsText(one.settings)}</span></th><td>${one.outcome}</td>
        <td>${one.files.map(({ name }) => html`<a href="/api/job/file/${name}?id=${one.id}" download=${name}>${name}</a> `)}</td>
        <td><button type="button" class="quiet square" aria-label=${t("Remove the run of {time}", { time: when(one.time) })} title=${t("Remove")} @click=${() => this.#post("remove", { id: one.id })}>${icon("trash")}</button></td></tr>`)}</tbody></table></div>
      ${many ? nothing : html`<p class="hint">${t("Change something and make a report again: both runs are compared here.")}</p>`}
    </section>`;
  }

  async #choose(before, after) {
    this.#pair = [before, after];
    this.#compared = null;
    this.#draw();
    if (!before || !after || before === after) return;
    const found = await get(`/api/job/compare?before=${before}&after=${after}`).catch(explain);
    if (this.#pair[0] === before && this.#pair[1] === after) this.#compared = found;
    this.#draw();
  }

  #comparison({ headline, tone, warnings, conditions, counts, routes, pieces, ways, more }) {
    const [before, after] = this.#pair;
    const heads = (first, css) => html`<thead><tr><th scope="col">${first}</th>${[t("Before"), t("After"), t("Change")].map((text) => html`<th scope="col" class=${css}>${text}</th>`)}</tr></thead>`;
    const table = (first, rows, css = "num") => rows.length ? html`<div class="scroll-x" tabindex="0" role="region" aria-label=${first}><table class="plain">${heads(first, css)}<tbody>${rows.map(([head, ...cells]) => html`<tr><th scope="row">${head}</th>${cells.slice(0, 3).map((text, at) => html`<td class=${css}>${text}${at === 2 && cells[3] ? html`<span class="hint"> ${cells[3]}</span>` : nothing}</td>`)}</tr>`)}</tbody></table></div>` : nothing;
    return html`<section class="card compared ${tone}" aria-labelledby="compared-head"><h3 id="compared-head">${headline}</h3>
      ${[...warnings, conditions].filter(Boolean).map((text) => html`<p class="warning-text">${text}</p>`)}
      ${table(t("Pieces"), counts)}${table(t("Routes and rooms"), routes)}${table(t("Pieces that changed"), pieces, "")}
      ${more ? html`<p>${tn("and {n:,} more", "and {n:,} more", more)}</p>` : nothing}${table(t("Ways out that changed"), ways, "")}
      <div class="buttons"><a class="button" href="/api/job/compare?before=${before}&after=${after}&as=page" target="_blank" rel="noopener">${icon("external")}${t("Open the whole comparison")}</a></div></section>`;
  }
}

const explain = (error) => void notice(error.message || t("The server does not answer."), { kind: "error" });
const when = (time) => new Date(time).toLocaleString(language() === "en" ? "en-GB" : language(), { dateStyle: "medium", timeStyle: "short" });

/** The settings of a run, all of them. */
function usual(settings) {
  const { anchor, ...given } = settings;
  return { ...USUAL, ...given, first: Number(/^first:(\d+)$/.exec(anchor ?? "")?.[1] ?? 0) };
}

/** What sets a run apart from the usual one. */
function settingsText(settings) {
  const { verify, runs, seed, scale, scenario, first } = usual(settings);
  const parts = [
    verify !== USUAL.verify && t("simulated: {which}", { which: VERIFY[verify]?.() ?? verify }), runs !== USUAL.runs && t("motions: {n}", { n: runs }),
    seed !== USUAL.seed && t("seed {n}", { n: seed }), scale !== USUAL.scale && t("shaking × {n}", { n: scale }),
    scenario && (jobs.scenarios.find(([key]) => key === scenario)?.[1] ?? scenario), first && tn("{n:,} entry taken as fixed", "{n:,} entries taken as fixed", first),
  ];
  return parts.filter(Boolean).join(", ") || t("usual settings");
}

const timeLeft = (seconds) => (seconds < MINUTE_S
  ? tn("about {n} s left", "about {n} s left", Math.max(1, Math.round(seconds)))
  : tn("about {n} min left", "about {n} min left", Math.round(seconds / MINUTE_S)));

export const createView = (root, store) => new ResultsView(root, store);
