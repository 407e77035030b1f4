// The field in which one types. It always has the focus while the grid has, so that input methods can compose into it; it is
// seen only while something is typed.

import { el } from "./elements.mjs";
import { hasChoices, isComputed, listChoices } from "./grid_cells.mjs";
import { ChoiceList } from "./grid_choices.mjs";
import { ROW_HEIGHT } from "./grid.mjs";
import { t } from "./texts.mjs";

export class Editor {
  /** null while nothing is typed, "typing" (arrows end it) or "editing" (arrows move the caret). */
  mode = null;
  target = null;

  constructor(grid, actions, say) {
    this.grid = grid;
    this.actions = actions;
    this.input = el("textarea", { class: "grid-input", rows: 1, spellcheck: false, autocomplete: "off", "aria-label": t("Cell"), "aria-controls": "grid" });
    grid.box.append(this.input);
    this.list = new ChoiceList(grid.box, this.input, (name) => this.#choose(name), say);
    this.input.addEventListener("input", () => this.#typed());
    this.input.addEventListener("compositionstart", () => this.#start("typing"));
    this.input.addEventListener("blur", () => this.commit());
    grid.addEventListener("drawn", () => this.place());
    grid.addEventListener("select", () => (this.input.readOnly = !this.canType)); // at once: the next key may come before the next frame
  }

  focus() {
    if (document.activeElement !== this.input) this.input.focus({ preventScroll: true });
  }

  /** Whether the active cell can be typed into. */
  get canType() {
    const { active, canEdit, sheet } = this.grid;
    return Boolean(canEdit && active && sheet.found && !isComputed(active.column));
  }

  /** Stand over the active cell; while nothing is typed, always in sight, so that the first letter does not scroll. */
  place() {
    const { grid, input } = this;
    const active = this.target ?? grid.active;
    input.readOnly = !this.canType;
    input.inputMode = grid.canEdit ? "text" : "none";
    if (!active) return;
    const { left, top, width, isFrozen } = grid.rectangle(active.r, active.c);
    const [x, y] = this.mode ? [left, top] : this.#inSight(left, top);
    Object.assign(input.style, { transform: `translate(${x}px, ${y}px)`, minWidth: `${width}px`, minHeight: `${ROW_HEIGHT}px` });
    input.classList.toggle("over", isFrozen);
    if (this.list.isOpen) this.list.place({ left, top, width, height: Math.max(ROW_HEIGHT, input.offsetHeight) });
    else this.#describe(active);
  }

  #inSight(left, top) {
    const { box } = this.grid;
    const inside = (value, low, high) => Math.max(low, Math.min(high, value));
    return [
      inside(left, box.scrollLeft, Math.max(box.scrollLeft, box.scrollLeft + box.clientWidth - 60)),
      inside(top, box.scrollTop + this.grid.headHeight, Math.max(box.scrollTop, box.scrollTop + box.clientHeight - ROW_HEIGHT)),
    ];
  }

  #describe(active) {
    const label = `${active.name} ${active.column.label}`;
    if (this.input.getAttribute("aria-label") !== label) this.input.setAttribute("aria-label", label);
    const isDrawn = document.getElementById("grid-active") !== null;
    if (isDrawn) this.input.setAttribute("aria-activedescendant", "grid-active");
    else this.input.removeAttribute("aria-activedescendant");
  }

  #start(mode) {
    if (!this.mode) {
      this.target = this.grid.active;
      this.target.sheet = this.grid.sheet;
      this.grid.show(this.grid.selection.anchor);
      this.input.classList.add("shown");
    }
    this.mode = mode;
    this.place();
  }

  #typed() {
    if (!this.mode && !this.canType) return void (this.input.value = "");
    if (!this.mode) this.#start("typing");
    if (!hasChoices(this.target.column)) return;
    if (this.list.isOpen) this.list.filter(this.input.value);
    else this.list.open(listChoices(this.grid.store, this.target.column), this.input.value);
    this.place();
  }

  /** Edit what the active cell holds, or what is given. */
  edit(text) {
    if (!this.canType) return;
    const { r, c } = this.grid.active;
    this.input.value = text ?? this.grid.text(r, c);
    this.focus();
    this.#start("editing");
    this.input.setSelectionRange(this.input.value.length, this.input.value.length);
  }

  /** Open the list of choices with all names. */
  openChoices() {
    if (!this.canType) return;
    const { column } = this.grid.active;
    if (!hasChoices(column)) return this.edit();
    const current = this.mode ? this.input.value : this.grid.text(this.grid.active.r, this.grid.active.c);
    if (!this.mode) this.edit();
    this.input.select();
    this.list.open(listChoices(this.grid.store, column), "", current);
    this.place();
    return null;
  }

  #choose(name) {
    this.input.value = name;
    this.list.close();
    this.commit();
    this.focus();
  }

  /**
   * End editing and keep what was typed.
   * @param {{all?: boolean}} [how] `all`: into every cell of the selection
   */
  commit({ all = false } = {}) {
    if (!this.mode) return;
    const { target } = this;
    const text = this.list.chosen ?? this.input.value;
    const shown = this.#shown(target);
    this.#end();
    if (all) this.actions.fillSelection(text === "" ? null : text);
    else if (text !== shown) {
      this.grid.store.hush([target.sheet.name, target.row]);
      this.actions.edit([[target.sheet.name, target.row, target.column.at, text === "" ? null : text]], t("typing"));
    }
  }

  /** Rows come to lie elsewhere: what is typed goes with its own. */
  shift(sheet, move) {
    if (!this.mode || this.target.sheet.name !== sheet) return;
    const row = move(this.target.row);
    if (row === null) return void this.#end();
    Object.assign(this.target, { row, r: this.grid.order.indexOf(row) });
  }

  #shown(target) {
    return target.sheet === this.grid.sheet && this.grid.order.row(target.r) === target.row ? this.grid.text(target.r, target.c) : null;
  }

  /** End editing and leave the cell as it was. */
  cancel() {
    if (this.list.isOpen && this.mode === "typing") return this.list.close();
    return this.#end();
  }

  /** Forget what is typed: its workbook is gone. */
  drop() {
    if (this.mode) this.#end();
  }

  #end() {
    this.mode = null;
    this.target = null;
    this.list.close();
    this.input.value = "";
    this.input.classList.remove("shown");
    this.grid.ask();
  }
}
