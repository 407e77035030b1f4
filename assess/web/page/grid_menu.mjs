// Sort and filter one column of the view; the file keeps its order.

import { el } from "./elements.mjs";
import { t, tn } from "./texts.mjs";

const MOST_VALUES = 200;

export class ColumnMenu {
  constructor(grid, changed, focus) {
    Object.assign(this, { grid, changed, focus });
    this.node = el("div", { class: "grid-menu", role: "dialog", hidden: true });
    this.node.addEventListener("keydown", (event) => this.#key(event));
    document.addEventListener("pointerdown", (event) => {
      if (!this.node.hidden && !this.node.contains(event.target)) this.close(false);
    }, true);
  }

  open(c) {
    const column = this.grid.columns[c];
    const { order } = this.grid;
    const now = order.filters.get(column.label) ?? { contains: "", values: null };
    const chosen = new Map();
    const contains = el("input", { type: "search", value: now.contains, placeholder: t("contains …"), "aria-label": t("Rows whose text contains") });
    const texts = order.texts(column);
    const values = texts.slice(0, MOST_VALUES).map(([text, count]) => this.#value(text, count, now, chosen));
    const apply = () => this.#filter(column, contains.value.trim(), chosen, texts.length);
    const tick = (on) => () => chosen.forEach((box) => (box.checked = on));
    const button = (text, click, css = "") => el("button", { type: "button", class: css, text, on: { click } });
    this.node.replaceChildren(
      el("div", { class: "grid-menu-title", text: column.label }),
      button(t("Sort ascending"), () => this.#sort(column, false)),
      button(t("Sort descending"), () => this.#sort(column, true)),
      button(t("Fit the width to the texts"), () => (this.close(), this.grid.fitWidth(c))),
      contains,
      el("div", { class: "grid-menu-ticks" }, button(t("All"), tick(true), "quiet"), button(t("None"), tick(false), "quiet")),
      el("div", { class: "grid-menu-values", role: "group", "aria-label": t("Rows with these values") }, values,
        texts.length > MOST_VALUES ? el("p", { text: t("More than {n} values: use the text above.", { n: MOST_VALUES }) }) : null),
      el("div", { class: "grid-menu-end" }, button(t("Filter"), apply, "primary"), button(t("Clear the filter"), () => this.#clear(column))),
    );
    contains.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault(); // the focus goes to the grid: the key must not be typed there
      apply();
    });
    this.node.setAttribute("aria-label", t("Sort and filter {column}", { column: column.label }));
    this.node.hidden = false;
    this.#place(c);
    this.node.querySelector("button").focus();
  }

  #value(text, count, now, chosen) {
    const box = el("input", { type: "checkbox", checked: !now.values || now.values.has(text) });
    chosen.set(text, box);
    return el("label", null, box, " ", text || t("(blank)"), el("span", { class: "grid-menu-count", text: ` ${count}` }));
  }

  #place(c) {
    const head = this.grid.head.querySelector(`[data-column="${c}"]`).getBoundingClientRect();
    const { offsetWidth, offsetHeight } = this.node;
    this.node.style.left = `${Math.max(4, Math.min(head.left, innerWidth - offsetWidth - 4))}px`;
    this.node.style.top = `${Math.max(4, Math.min(head.bottom, innerHeight - offsetHeight - 4))}px`;
  }

  #sort(column, down) {
    this.grid.order.sort = { column, down };
    this.#done();
  }

  #filter(column, contains, chosen, count) {
    const ticked = [...chosen].filter(([, box]) => box.checked).map(([text]) => text);
    const values = ticked.length === chosen.size || count > MOST_VALUES ? null : new Set(ticked);
    if (contains || values) this.grid.order.filters.set(column.label, { column, contains, values });
    else this.grid.order.filters.delete(column.label);
    this.#done();
  }

  #clear(column) {
    this.grid.order.filters.delete(column.label);
    this.#done();
  }

  #done() {
    this.close();
    this.changed();
  }

  #key(event) {
    if (event.key === "Escape") this.close();
    else if (event.key === "Tab") this.#keepInside(event);
    else return;
    event.stopPropagation();
  }

  #keepInside(event) {
    const stops = [...this.node.querySelectorAll("button, input")];
    const end = event.shiftKey ? stops[0] : stops.at(-1);
    if (document.activeElement !== end) return;
    event.preventDefault();
    (event.shiftKey ? stops.at(-1) : stops[0]).focus();
  }

  close(takesFocus = true) {
    this.node.hidden = true;
    if (takesFocus) this.focus();
  }
}

/** The line above the grid: how many rows are in sight, and by what they are sorted and filtered. */
export function describeOrder(order) {
  if (order.isPlain) return "";
  const parts = [tn("{shown:,} of {n:,} row", "{shown:,} of {n:,} rows", order.total, { shown: order.shown })];
  if (order.sort) {
    const { column, down } = order.sort;
    parts.push(down ? t("sorted by {column}, descending", { column: column.label }) : t("sorted by {column}", { column: column.label }));
  }
  for (const { column } of order.filters.values()) parts.push(t("filtered by {column}", { column: column.label }));
  if ([...order.only].some((one) => one !== "problems")) parts.push(t("filtered by class"));
  if (order.only.has("problems")) parts.push(t("with problems"));
  return parts.join("; ");
}
