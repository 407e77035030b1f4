// Simulate and report: what to simulate and to write, how far it is, and what came out.

import { el, clear } from "./elements.mjs";
import { jobs } from "./job.mjs";
import { describeOptions } from "./simulate_options.mjs";
import { ResultsView } from "./simulate_results.mjs";
import { language, t, tn } from "./texts.mjs";
import { notice } from "./messages.mjs";

const MINUTE_S = 60;
const MOST_SHOWN = 20;
const SIGNS = { error: "✖", warning: "▲", note: "ℹ" };

class SimulateView {
  #root;
  #store;
  #shown = "";
  #isShown = false;

  constructor(root, store) {
    this.#store = store;
    this.form = describeOptions((request) => this.#start(request));
    this.options = el("details", { class: "fold", open: true }, el("summary", { text: t("What to simulate and what to write") }), this.form.node);
    this.progress = this.#progressCard();
    this.fault = el("div", { role: "alert" });
    this.results = new ResultsView(store, (cell) => this.#reveal(cell), (request) => this.#start(request));
    this.#root = el("div", { class: "page-like simulate" }, el("h2", { text: t("Simulate and report") }),
      el("p", { class: "muted", text: t("Risk classes of the sheet come from a formula. A simulation shakes every piece by many motions of its floor, and confirms or corrects its class. You may go on working meanwhile.") }),
      this.options, el("div", { class: "buttons" }, this.form.button), this.progress.node, this.fault, this.results.node);
    root.append(this.#root);
    jobs.addEventListener("change", () => this.#update());
    store.addEventListener("live", () => this.#showResults());
  }

  show() {
    this.#isShown = true;
    this.#update();
  }

  hide() {
    this.#isShown = false;
  }

  /** Results are drawn only while they are seen: there may be thousands of rows. */
  #showResults() {
    if (this.#isShown && jobs.current?.state === "done") this.results.update(jobs.current);
  }

  #progressCard() {
    const bar = el("progress", { max: 1, value: 0, "aria-label": t("Progress") });
    const words = el("p", { role: "status" });
    const cancel = el("button", { type: "button", text: t("Cancel"), on: { click: () => this.#cancel() } });
    const node = el("section", { class: "card", "aria-label": t("Progress") }, words, bar, el("div", { class: "buttons" }, cancel));
    return { node, bar, words, cancel };
  }

  async #start(request) {
    clear(this.fault);
    this.form.button.disabled = true;
    try {
      await jobs.start(request);
    } catch (error) {
      this.#complain(error.message || t("The server does not answer."), error.body?.problems ?? []);
    }
    this.#update();
  }

  async #cancel() {
    this.progress.cancel.disabled = true;
    try {
      await jobs.cancel();
    } catch (error) {
      notice(error.message || t("The server does not answer."), { kind: "error" });
    }
    this.progress.cancel.disabled = false;
  }

  #update() {
    const job = jobs.current;
    const state = job?.state ?? "";
    this.progress.node.hidden = state !== "running";
    this.form.button.disabled = state === "running";
    this.form.button.textContent = job?.state === "done" ? t("Simulate again") : t("Start the run");
    if (state === "running") this.#showProgress(job);
    this.results.node.hidden = state !== "done";
    const key = `${job?.id} ${state}`;
    this.#showResults();
    if (key === this.#shown) return;
    this.#shown = key;
    this.options.open = state !== "done";
    clear(this.fault);
    if (state === "failed") this.#complain(job.message || t("The simulation failed."), job.problems ?? []);
    if (state === "cancelled") this.fault.append(el("p", { text: t("The simulation was cancelled. Nothing was written.") }));
  }

  #showProgress(job) {
    const { bar, words } = this.progress;
    bar.value = job.share;
    const detail = language() === "en" ? (job.detail ?? "") : ""; // it is not translated
    const text = t("{stage} {detail}: {share} %", { stage: job.label || job.stage, detail, share: Math.floor(100 * job.share) });
    const left = typeof job.seconds_left === "number" ? timeLeft(job.seconds_left) : "";
    const shown = [text.replace(/\s+:/, ":"), left].filter(Boolean).join(", ");
    if (words.textContent !== shown) words.textContent = shown;
  }

  /** What keeps it from running: the errors alone, each with a way to its cell; the rest is folded away. */
  #complain(message, problems) {
    const errors = problems.filter((one) => one.severity === "error");
    const others = problems.filter((one) => one.severity !== "error");
    const first = errors.length ? tn("{n:,} error to correct first", "{n:,} errors to correct first", errors.length) : message;
    const list = (some) => el("ul", { class: "problem-list" }, some.slice(0, MOST_SHOWN).map((one) => this.#line(one)), some.length > MOST_SHOWN && el("li", { text: tn("{n:,} more", "{n:,} more", some.length - MOST_SHOWN) }));
    const folded = others.length > 0 && el("details", { class: "fold" }, el("summary", { text: tn("{n:,} warning or note, which does not keep it from running", "{n:,} warnings and notes, which do not keep it from running", others.length) }), list(others));
    clear(this.fault).append(el("section", { class: "card" }, el("h3", { class: "error-text", text: t("Not simulated") }),
      el("p", null, el("b", { text: first })), errors.length > 0 && list(errors), folded));
  }

  #line(one) {
    const cell = placeOf(one);
    const sheet = this.#store.sheet(one.sheet);
    const name = one.cell ? `${sheet?.title ?? one.sheet}!${one.cell}` : (sheet?.title ?? one.sheet);
    const link = cell ? el("button", { type: "button", class: "quiet link", text: name, on: { click: () => this.#reveal(cell) } }) : el("b", { text: name });
    return el("li", { class: one.severity }, el("span", { class: "problems-sign", "aria-hidden": "true", text: SIGNS[one.severity] ?? "" }), link, ` ${[one.message, one.fix].filter(Boolean).join(" ")}`);
  }

  #reveal(cell) {
    location.hash = "#sheet";
    this.#store.reveal(cell);
  }
}

/** The cell of a problem as [sheet, row, column], from its name such as J3; null where it has none. */
function placeOf({ sheet, cell }) {
  const found = /^([A-Z]{1,3})(\d+)$/.exec(cell ?? "");
  if (!found) return null;
  const at = [...found[1]].reduce((sum, letter) => 26 * sum + letter.charCodeAt(0) - 64, 0) - 1;
  return [sheet, Number(found[2]), at];
}

function timeLeft(seconds) {
  if (seconds < MINUTE_S) return tn("about {n} s left", "about {n} s left", Math.max(1, Math.round(seconds)));
  return tn("about {n} min left", "about {n} min left", Math.round(seconds / MINUTE_S));
}

export const createView = (root, store) => new SimulateView(root, store);
