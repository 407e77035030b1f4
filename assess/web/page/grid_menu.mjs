// The menus of the grid: how one column of the view is sorted and filtered, and what can be done with what is selected.

import { el } from "./elements.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const MOST_VALUES = 200;
const MARGIN = 4;

class Menu {
  constructor(view, props) {
    const { grid, editor, actions } = view;
    Object.assign(this, { view, grid, editor, actions });
    this.node = el("div", { ...props, hidden: true });
    this.node.addEventListener("keydown", (event) => this.key(event));
    document.addEventListener("pointerdown", ({ target }) => this.node.contains(target) || (this.node.hidden = true), true);
  }

  /** Show it near a point of the window, with the focus on its first button. */
  showAt(x, y) {
    const { node } = this;
    node.hidden = false;
    node.style.left = `${Math.max(MARGIN, Math.min(x, innerWidth - node.offsetWidth - MARGIN))}px`;
    node.style.top = `${Math.max(MARGIN, Math.min(y, innerHeight - node.offsetHeight - MARGIN))}px`;
    node.querySelector("button").focus();
  }

  close() {
    this.node.hidden = true;
    this.editor.focus();
  }
}

export class ColumnMenu extends Menu {
  constructor(view) {
    super(view, { class: "grid-menu", role: "dialog" });
  }

  open(c = this.grid.selection.anchor[1]) {
    const column = this.grid.columns[c];
    const { order } = this.grid;
    const now = order.filters.get(column.label) ?? { contains: "", values: null };
    const contains = el("input", { type: "search", value: now.contains, placeholder: t("contains …"), "aria-label": t("Rows whose text contains") });
    const texts = order.texts(column);
    const box = (text) => el("input", { type: "checkbox", checked: !now.values || now.values.has(text) });
    const boxes = new Map(texts.slice(0, MOST_VALUES).map(([text]) => [text, box(text)]));
    const value = ([text, count]) => el("label", null, boxes.get(text), " ", text || t("(blank)"), el("span", { class: "grid-menu-count", text: ` ${count}` }));
    const act = (change) => () => (change(), this.close(), this.view.reorder());
    const apply = act(() => {
      const ticked = [...boxes].filter(([, one]) => one.checked).map(([text]) => text);
      const values = ticked.length === boxes.size || texts.length > MOST_VALUES ? null : new Set(ticked);
      const text = contains.value.trim();
      if (text || values) order.filters.set(column.label, { column, contains: text, values });
      else order.filters.delete(column.label);
    });
    const sort = (down) => act(() => (order.sort = { column, down }));
    const tick = (on) => () => boxes.forEach((one) => (one.checked = on));
    const button = (text, click, css = "") => el("button", { type: "button", class: css, text, on: { click } });
    this.node.replaceChildren(
      el("div", { class: "grid-menu-title", text: column.label }),
      button(t("Sort ascending"), sort(false)),
      button(t("Sort descending"), sort(true)),
      button(t("Fit the width to the texts"), () => (this.close(), this.grid.fitWidth(c))),
      contains,
      el("div", { class: "grid-menu-ticks" }, button(t("All"), tick(true), "quiet"), button(t("None"), tick(false), "quiet")),
      el("div", { class: "grid-menu-values", role: "group", "aria-label": t("Rows with these values") }, texts.slice(0, MOST_VALUES).map(value),
        texts.length > MOST_VALUES ? el("p", { text: t("More than {n} values: use the text above.", { n: MOST_VALUES }) }) : null),
      el("div", { class: "grid-menu-end" }, button(t("Filter"), apply, "primary"),
        button(t("Clear the filter"), act(() => order.filters.delete(column.label)))),
    );
    contains.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault(); // the focus goes to the grid: the key must not be typed there
      apply();
    });
    this.node.setAttribute("aria-label", t("Sort and filter {column}", { column: column.label }));
    const head = this.grid.head.querySelector(`[data-column="${c}"]`).getBoundingClientRect();
    this.showAt(head.left, head.bottom);
  }

  /** Tab stays inside. */
  key(event) {
    const stops = [...this.node.querySelectorAll("button, input")];
    const [end, other] = event.shiftKey ? [stops[0], stops.at(-1)] : [stops.at(-1), stops[0]];
    if (event.key === "Escape") this.close();
    else if (event.key !== "Tab") return;
    else if (document.activeElement === end) {
      event.preventDefault();
      other.focus();
    }
    event.stopPropagation();
  }
}

/** What can be done with what is selected: by the right button, the Menu key or the button for touch. */
export class ContextMenu extends Menu {
  constructor(view) {
    super(view, { class: "grid-context", role: "menu", "aria-label": t("Cells and rows") });
    this.node.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** Groups of entries: text, keys, what is done, whether it changes the workbook, and of a group of columns if it is shown. */
  #entries() {
    const { actions, grid, view } = this;
    const [r0, , r1] = actions.range();
    const n = r1 - r0 + 1;
    const { order } = grid;
    const { r, c, column } = grid.active;
    const sort = (down) => () => ((order.sort = { column, down }), view.reorder());
    const filter = () => (order.filters.set(column.label, { column, contains: "", values: new Set([grid.text(r, c)]) }), view.reorder());
    const groups = [...new Map(grid.all.filter(({ group }) => group).map((one) => [one.group, one.heading]))];
    return [
      [[t("Cut"), "Ctrl+X", () => (this.#copy(), actions.clear(t("cut"))), true], [t("Copy"), "Ctrl+C", () => this.#copy()],
        [t("Copy with headers"), "", () => this.#copy(true)], [t("Paste"), "Ctrl+V", () => this.#paste(), true]],
      [[tn("Insert {n:,} row above", "Insert {n:,} rows above", n), "Ctrl+Shift++", () => actions.insertRows(), true],
        [tn("Insert {n:,} row below", "Insert {n:,} rows below", n), "", () => actions.insertRows(true), true],
        [t("Delete rows"), "Ctrl+−", () => actions.deleteRows(), true],
        [t("Move rows up"), "Alt+↑", () => actions.moveRows(-1), true], [t("Move rows down"), "Alt+↓", () => actions.moveRows(1), true]],
      [[t("Clear cells"), "Del", () => actions.clear(), true], [t("Clear rows"), "", () => actions.clearRows(), true],
        [t("Fill down"), "Ctrl+D", () => actions.fillDown(), true]],
      [[t("Filter by this value"), "", filter], [t("Sort ascending"), "", sort(false)], [t("Sort descending"), "", sort(true)]],
      groups.map(([group, heading]) => [t("Columns: {group}", { group: heading }), "", () => grid.fold(group), false, !grid.folded.has(group)]),
    ];
  }

  /** @param {[number, number]} [point] of the window; without one it opens at the active cell */
  open(point) {
    const { active, box, headHeight } = this.grid;
    if (!active) return;
    const allowed = ([, , , edits]) => !edits || this.actions.canEdit;
    const groups = this.#entries().map((all) => all.filter(allowed)).filter((all) => all.length);
    const line = (at) => (at ? el("hr", { role: "separator" }) : "");
    this.node.replaceChildren(...groups.flatMap((all, at) => [line(at), ...all.map((one) => this.#entry(one))]));
    const edge = box.getBoundingClientRect();
    const cell = this.grid.rectangle(active.r, active.c);
    const top = edge.top + Math.max(headHeight, cell.top - box.scrollTop) + cell.height;
    this.showAt(...(point ?? [edge.left + cell.left - box.scrollLeft, top]));
  }

  #entry([text, keys, run, , isShown]) {
    const role = isShown === undefined ? { role: "menuitem" } : { role: "menuitemcheckbox", "aria-checked": String(isShown) };
    const click = () => (this.close(), run());
    return el("button", { type: "button", tabindex: "-1", ...role, on: { click } }, el("span", { text }), keys && el("kbd", { text: keys }));
  }

  key(event) {
    const buttons = [...this.node.querySelectorAll("button")];
    const at = buttons.indexOf(document.activeElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1 + buttons.length, Home: 0, End: buttons.length - 1 }[event.key];
    if (to !== undefined) buttons[to % buttons.length].focus();
    else if (event.key === "Escape" || event.key === "Tab") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Copy as Ctrl+C does, which a page may do only where something is selected. */
  #copy(withHeaders = false) {
    const { input } = this.editor;
    input.value = " ";
    input.select();
    this.actions.withHeaders = withHeaders;
    document.execCommand("copy");
    this.actions.withHeaders = false;
    input.value = "";
  }

  async #paste() {
    const found = new Map();
    try {
      for (const item of await navigator.clipboard.read()) {
        for (const type of item.types) found.set(type, await (await item.getType(type)).text());
      }
    } catch {
      notice(t("The browser does not let this page read the clipboard. Press Ctrl+V to paste."));
      return;
    }
    this.actions.paste({ getData: (type) => found.get(type) ?? "" });
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
