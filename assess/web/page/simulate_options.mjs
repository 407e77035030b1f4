// What to simulate and which files to write, with the defaults of the command.

import { choose, el, labelled } from "./elements.mjs";
import { number, t } from "./texts.mjs";

const RUNS = [100, 200, 500, 1000, 2000];
const USUAL_RUNS = 200;
const AUTO = "auto";

const VERIFY = () => [
  ["all", t("All pieces"), t("The most reliable, and the longest.")],
  ["high", t("Pieces at risk"), t("High and very high by a formula, outside its checked range, or on an evacuation route.")],
  ["none", t("None: reports by the formula only"), t("Takes seconds.")],
];
const FORMATS = () => [
  ["html", t("Report as a page, shown below (HTML)"), true],
  ["pdf", t("Report for the client (PDF)"), true],
  ["xlsx", t("Report with live formulas (Excel)"), true],
  ["annex", t("Annex with all details (PDF)"), false],
  ["docx", t("Report for the client (Word)"), false],
  ["json", t("All results, for other programs (JSON)"), true],
  ["csv", t("Table of the pieces (CSV)"), true],
];

/** The form; `begin` gets the request of POST /api/job. */
export function describeOptions(begin) {
  const verify = VERIFY().map(([value, label, help]) => option("radio", { name: "verify", value, checked: value === "all" }, label, help));
  const formats = FORMATS().map(([value, label, checked]) => option("checkbox", { name: "format", value, checked }, label));
  const runs = choose([...RUNS.map((n) => [String(n), runsLabel(n)]), [AUTO, t("as many as every class needs, up to 5,000")]], String(USUAL_RUNS));
  const seed = el("input", { type: "number", min: 0, step: 1, value: "1" });
  const button = el("button", { type: "submit", form: "simulate-options", class: "primary", text: t("Start the run") });
  const node = el("form", { id: "simulate-options", class: "card options", noValidate: true },
    el("div", { class: "columns" },
      el("fieldset", null, el("legend", { text: t("Which pieces") }), verify),
      el("fieldset", null, el("legend", { text: t("What to write") }), formats)),
    el("div", { class: "fields" },
      labelled(t("Motions of each floor"), runs, t("More motions narrow the range of each chance, and take longer.")),
      labelled(t("Seed"), seed, t("The same seed gives the same result."))));
  node.addEventListener("submit", (event) => {
    event.preventDefault();
    begin(read(node, runs, seed));
  });
  return { node, button };
}

const runsLabel = (n) => (n === USUAL_RUNS ? t("{n} (usual)", { n: number(n, 0, true) }) : number(n, 0, true));

function option(type, props, label, help = "") {
  return el("label", { class: "option" }, el("input", { type, ...props }), el("span", null, label, help && el("span", { class: "hint", text: help })));
}

function read(form, runs, seed) {
  const chosen = (name) => [...form.querySelectorAll(`input[name="${name}"]:checked`)].map((one) => one.value);
  const formats = chosen("format");
  return {
    verify: chosen("verify")[0], runs: runs.value === AUTO ? AUTO : Number(runs.value),
    seed: Math.max(0, Math.round(Number(seed.value) || 0)), formats: formats.length ? formats : ["json"],
  };
}
