// What a cell shows: its text, its looks and its problem.

import { CLASSES, describe } from "./classes.mjs";
import { isFilled } from "./sheet.mjs";
import { number, percent, t } from "./texts.mjs";

export const SIMULATED = "simulated";
const LIVE_DIGITS = 3;

/** The text of a value, as shown and as edited. */
export function showValue(value, column) {
  if (!isFilled(value)) return "";
  if (typeof value === "number") return number(value);
  if (typeof value === "boolean") return column?.choices?.length === 2 ? column.choices[value ? 0 : 1] : String(value).toUpperCase();
  return String(value);
}

/** Whether nobody can type into a column. */
export const isComputed = (column) => column.kind === "live" || column.kind === SIMULATED;

/** The column of the simulated classes, which is in no file. */
export const simulatedColumn = () => ({
  at: null, field: SIMULATED, kind: SIMULATED, label: t("Simulated class"), unit: "", width: 23, choices: [], offered: [], source: "",
  help: t("The class by simulation, and the share of motions in which the piece overturns; grey where its row changed since."),
});

/** The class by the formulas, for a workbook without the column. */
export const classColumn = () => ({
  at: null, field: "class", kind: "live", label: t("Class"), unit: "", width: 16, choices: [], offered: [], source: "", help: t("The class by the formulas."),
});

/** What a cell holds for sorting, filtering, finding and copying. */
export function cellValue(store, sheet, row, column) {
  if (column.kind === SIMULATED) return store.simulated.get(row)?.chance ?? null;
  if (column.kind !== "live") return sheet.value(row, column.at);
  if (column.field === "class") return classText(store.live.get(row)) || null;
  return store.live.get(row)?.values[column.at] ?? null;
}

/** The text of a cell as it is shown. */
export function cellText(store, sheet, row, column) {
  if (column.kind === SIMULATED) return simulatedText(store.simulated.get(row));
  const value = cellValue(store, sheet, row, column);
  if (column.kind === "live" && typeof value === "number") return number(Number(value.toPrecision(LIVE_DIGITS)));
  return showValue(value, column);
}

function classText(live) {
  if (!live) return "";
  if (!live.class) return live.word ?? "";
  const { sign, word } = describe(live.class);
  return `${sign} ${word}${live.outside ? "*" : ""}`;
}

function simulatedText(result) {
  if (!result?.class) return "";
  const { sign, word } = describe(result.class);
  return result.chance === null || result.chance === undefined ? `${sign} ${word}` : `${sign} ${word} ${percent(result.chance)}`;
}

/** The rank of a class from low to very high; null without one. */
function classRank(key) {
  const at = CLASSES.indexOf(key);
  return at < 0 ? null : CLASSES.length - at;
}

/** What a column is sorted by. */
export function sortKey(store, sheet, row, column) {
  if (column.field === "class" && column.kind === "live") return classRank(store.live.get(row)?.class) ?? (store.live.get(row)?.word || null);
  return cellValue(store, sheet, row, column);
}

/** The looks of a cell: text, classes of style, and its problem if it has one. */
export function describeCell(store, sheet, row, column) {
  const text = cellText(store, sheet, row, column);
  let css = "";
  if (column.kind === "number" || column.kind === "count" || (column.kind === "live" && column.field !== "class")) css = " number";
  else if (column.kind === "own" && typeof sheet.value(row, column.at) === "number") css = " number";
  if (column.kind === "live") css += " live";
  if (column.field === "class" && column.kind === "live") css += ` risk ${riskStyle(store.live.get(row)?.class)}`;
  if (column.kind === SIMULATED) css += ` live risk ${riskStyle(store.simulated.get(row)?.class)}${store.simulated.get(row)?.stale ? " stale" : ""}`;
  return { text, css, problem: column.at === null ? undefined : store.problemAt(sheet.name, row, column.at) };
}

const riskStyle = (key) => (key ? describe(key).css : "none");

/** A problem in one text: what is wrong and how to fix it. */
export const problemText = (problem) => (problem.fix ? `${problem.message} ${problem.fix}` : problem.message);

/** The names that a cell of the column may take, and whether others are wrong. */
export function listChoices(store, column) {
  if (column.choices?.length) return { names: column.choices.map(String), isClosed: true };
  const source = column.source ? store.sheet(column.source) : null;
  const field = source && (source.column(column.field) ? column.field : source.columns.find((one) => one.field)?.field);
  const names = field ? source.names(field) : [];
  return { names: [...new Set([...names, ...(column.offered ?? []).map(String)])], isClosed: false };
}

export const hasChoices = (column) => Boolean(column.choices?.length || column.source || column.offered?.length);
