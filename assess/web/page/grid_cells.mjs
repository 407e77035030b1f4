// What a cell shows: its text, its looks and its problem.

import { CLASSES, classStyle, classText } from "./classes.mjs";
import { isFilled } from "./sheet.mjs";
import { number, t } from "./texts.mjs";

const LIVE_DIGITS = 3;
const CLASS_WIDTH = 24;

/** The text of a value, as shown and as edited. */
export function showValue(value, column) {
  if (!isFilled(value)) return "";
  if (typeof value === "number") return number(value);
  if (typeof value === "boolean") return column?.choices?.length === 2 ? column.choices[value ? 0 : 1] : String(value).toUpperCase();
  return String(value);
}

/** Whether nobody can type into a column. */
export const isComputed = (column) => column.kind === "live";

export const isClass = (column) => column.field === "class" && column.kind === "live";

/** The one column of the class, in place of that of the file, which Excel computes by the formula; a file without it shows it, too. */
export const classColumn = (column = {}) => ({
  at: null, field: "class", kind: "live", unit: "", choices: [], offered: [], source: "", ...column, label: t("Class"), width: CLASS_WIDTH,
  help: t("The class of the simulation, with the chance that the piece overturns and the range that it lies in; ≈ by the formula until it has been simulated. In Excel the column shows the class by the formula."),
});

/** What a cell holds for sorting, filtering, finding and copying. */
export function cellValue(store, sheet, row, column) {
  if (column.kind !== "live") return sheet.value(row, column.at);
  if (isClass(column)) return classText(store.live.get(row)) || null;
  return store.live.get(row)?.values[column.at] ?? null;
}

/** The text of a cell as it is shown. */
export function cellText(store, sheet, row, column) {
  const value = cellValue(store, sheet, row, column);
  if (column.kind === "live" && typeof value === "number") return number(Number(value.toPrecision(LIVE_DIGITS)));
  return showValue(value, column);
}


/** What a column is sorted by. */
export function sortKey(store, sheet, row, column) {
  const live = store.live.get(row);
  if (!isClass(column)) return cellValue(store, sheet, row, column);
  return live?.class ? CLASSES.length - CLASSES.indexOf(live.class) + (live.chance ?? 0) / 2 : live?.word || null;
}

const SIZES = new Set(["breadth", "width", "height"]);
const plainName = (name) => String(name).trim().replace(/\s+/g, " ").toLowerCase();
let sizes = {}; // of the Catalogue, by type

/** The size that the Catalogue has for a blank cell of Items, in the unit of its column; "" where there is none. */
function catalogueText(store, sheet, row, column) {
  const source = store.sheet("Catalogue");
  const type = sheet.name === "Items" && SIZES.has(column.field) && sheet.value(row, sheet.column("type")?.at);
  if (!type || !source?.column("type")) return "";
  if (sizes.source !== source || sizes.revision !== source.revision) {
    sizes = { source, revision: source.revision, rows: new Map(source.rowNumbers.map((one) => [plainName(source.value(one, source.column("type").at)), one])) };
  }
  const own = source.column(column.field);
  const value = own && source.value(sizes.rows.get(plainName(type)), own.at);
  return typeof value === "number" ? number(Number((value * own.factor / column.factor).toPrecision(6))) : "";
}

/** The looks of a cell: text, what stands in a blank one in grey, classes of style, and its problem if it has one; on a phone chances without their range. */
export function describeCell(store, sheet, row, column, isNarrow = false) {
  const own = isNarrow && isClass(column) ? classText(store.live.get(row), false) : cellText(store, sheet, row, column);
  const text = own || catalogueText(store, sheet, row, column);
  let css = own === text ? "" : " ghost";
  if (column.kind === "number" || column.kind === "count" || (column.kind === "live" && column.field !== "class")) css += " number";
  else if (column.kind === "own" && typeof sheet.value(row, column.at) === "number") css += " number";
  if (column.kind === "live") css += " live";
  if (isClass(column)) css += ` risk ${classStyle(store.live.get(row))}`;
  return { text, css, problem: column.at === null ? undefined : store.problemAt(sheet.name, row, column.at) };
}

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
