// The menu of the grid, by the right button, the Menu key or the button for touch: what can be done with what is selected.

import { el } from "./elements.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const MARGIN = 4;

export class ContextMenu {
  constructor({ grid, editor, actions, act }) {
    Object.assign(this, { grid, editor, actions, act });
    this.node = el("div", { class: "grid-context", role: "menu", hidden: true, "aria-label": t("Cells and rows") });
    this.node.addEventListener("keydown", (event) => this.#key(event));
    this.node.addEventListener("contextmenu", (event) => event.preventDefault());
    document.addEventListener("pointerdown", ({ target }) => this.node.contains(target) || (this.node.hidden = true), true);
  }

  /** Groups of entries: text, keys, what is done, whether it changes the workbook, and of a group of columns if it is shown. */
  #entries() {
    const { actions, grid, act } = this;
    const n = actions.range()[2] - actions.range()[0] + 1;
    const { r, c, column } = grid.active;
    const sort = (isDown) => () => ((grid.order.sort = { column, down: isDown }), act.reorder());
    const filter = () => (grid.order.filters.set(column.label, { column, contains: "", values: new Set([grid.text(r, c)]) }), act.reorder());
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
    const entries = this.#entries().map((all) => all.filter(([, , , edits]) => !edits || this.actions.canEdit)).filter((all) => all.length);
    this.node.replaceChildren(...entries.flatMap((all, at) => [at ? el("hr", { role: "separator" }) : "", ...all.map((one) => this.#entry(one))]));
    this.node.hidden = false;
    const edge = box.getBoundingClientRect();
    const cell = this.grid.rectangle(active.r, active.c);
    const [x, y] = point ?? [edge.left + cell.left - box.scrollLeft, edge.top + Math.max(headHeight, cell.top - box.scrollTop) + cell.height];
    this.node.style.left = `${Math.max(MARGIN, Math.min(x, innerWidth - this.node.offsetWidth - MARGIN))}px`;
    this.node.style.top = `${Math.max(MARGIN, Math.min(y, innerHeight - this.node.offsetHeight - MARGIN))}px`;
    this.#buttons[0].focus();
  }

  #entry([text, keys, run, , isShown]) {
    const click = () => {
      this.close();
      run();
    };
    const role = isShown === undefined ? "menuitem" : "menuitemcheckbox";
    const checked = isShown === undefined ? {} : { "aria-checked": String(isShown) };
    return el("button", { type: "button", role, tabindex: "-1", ...checked, on: { click } }, el("span", { text }), keys ? el("kbd", { text: keys }) : null);
  }

  get #buttons() {
    return [...this.node.querySelectorAll("button")];
  }

  #key(event) {
    const buttons = this.#buttons;
    const at = buttons.indexOf(document.activeElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1 + buttons.length, Home: 0, End: buttons.length - 1 }[event.key];
    if (to !== undefined) buttons[to % buttons.length].focus();
    else if (event.key === "Escape" || event.key === "Tab") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  close() {
    this.node.hidden = true;
    this.editor.focus();
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
