// Tells for a moment what an undo or a redo changed, which may be out of sight or from another window.

import { el } from "./elements.mjs";
import { cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";

const SHOWN_MS = 6000;

export function undoneLine(store) {
  const line = el("div", { class: "undone", role: "status" });
  let timer = 0;
  const show = (text) => {
    clearTimeout(timer);
    line.textContent = text;
    timer = setTimeout(() => (line.textContent = ""), SHOWN_MS);
  };
  store.addEventListener("step", ({ detail }) => (detail.cells.length || detail.rows.length) && show(describe(store, detail)));
  store.addEventListener("book", () => show(""));
  return line;
}

function describe(store, { isUndo, cells, rows }) {
  if (rows.length) return isUndo ? t("Undone: rows of {sheet}", { sheet: store.sheet(rows[0][0]).title }) : t("Redone: rows of {sheet}", { sheet: store.sheet(rows[0][0]).title });
  const n = cells.length;
  if (n > 1) return isUndo ? tn("Undone: {n:,} cell", "Undone: {n:,} cells", n) : tn("Redone: {n:,} cell", "Redone: {n:,} cells", n);
  const [name, row, at] = cells[0];
  const cell = cellName(store.sheet(name), row, at);
  return isUndo ? t("Undone: {cell}", { cell }) : t("Redone: {cell}", { cell });
}
