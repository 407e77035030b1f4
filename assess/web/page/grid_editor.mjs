// The field in which one types. It always has the focus while the grid has, so that input methods can compose into it; it is
// seen only while something is typed.

import { clear, el } from "./elements.mjs";
import { hasChoices, isComputed, listChoices } from "./grid_cells.mjs";
import { ROW_HEIGHT } from "./grid.mjs";
import { t, tn } from "./texts.mjs";

const MOST = 200;
const HEIGHT = 232;

const plain = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

/** The list below a cell: the names that it may take, fewer with each letter that is typed. */
class ChoiceList {
  constructor(box, input, take, say) {
    Object.assign(this, { box, input, say });
    this.node = el("div", { class: "grid-choices", role: "listbox", id: "grid-choices", tabindex: "0", hidden: true, "aria-label": t("Choices") });
    this.node.addEventListener("pointerdown", (event) => {
      event.preventDefault(); // the field keeps the focus
      const option = event.target.closest("[role=option]");
      if (option) take(option.dataset.name);
    });
    box.append(this.node);
  }

  get isOpen() {
    return !this.node.hidden;
  }

  /** Show the names that contain all words of a text, those first that begin with it; `current` or a guess is marked. */
  open({ names, isClosed }, text, current) {
    const part = plain(text.trim());
    const words = part.split(/\s+/);
    const has = names.filter((name) => words.every((word) => plain(name).includes(word)));
    const begins = (name) => plain(name).startsWith(part);
    this.names = [...has.filter(begins), ...has.filter((name) => !begins(name))];
    this.marked = this.names.indexOf(current ?? guessName(names.filter(begins), part, isClosed));
    this.isGuess = current === undefined;
    if (!this.names.length) return void this.close();
    this.node.hidden = false;
    const shown = this.names.slice(0, MOST).map((name, i) => el("div", { class: "grid-choice", role: "option", id: `grid-choice-${i}`, dataset: { name }, text: name }));
    clear(this.node).append(...shown);
    if (this.names.length > MOST) this.node.append(el("div", { class: "grid-choice more", role: "presentation", text: t("{n} more: type to find them", { n: this.names.length - MOST }) }));
    this.#mark();
    this.input.setAttribute("aria-controls", "grid-choices");
    this.say(tn("{n} choice", "{n} choices", this.names.length));
  }

  /** Stand below the cell, or above it where there is no room below. */
  place({ left, top, width, height }) {
    const below = this.box.scrollTop + this.box.clientHeight - top - height;
    const space = Math.min(HEIGHT, this.node.scrollHeight + 2);
    const y = below < space && top - this.box.scrollTop > space ? top - space : top + height;
    Object.assign(this.node.style, { minWidth: `${width}px`, transform: `translate(${left}px, ${y}px)` });
  }

  move(step) {
    const count = Math.min(this.names.length, MOST);
    const stays = this.isGuess && step > 0 && this.marked === 0; // the first one down takes what was only guessed
    this.isGuess = false;
    if (stays) return;
    this.marked = this.marked < 0 ? (step > 0 ? 0 : count - 1) : (this.marked + step + count) % count;
    this.#mark();
  }

  #mark() {
    [...this.node.children].forEach((node, i) => node.setAttribute("aria-selected", i === this.marked));
    const node = this.node.children[this.marked];
    node?.scrollIntoView({ block: "nearest" });
    if (node) this.input.setAttribute("aria-activedescendant", node.id);
    else this.input.removeAttribute("aria-activedescendant");
  }

  /** The marked name, null where none is. */
  get chosen() {
    return this.isOpen ? (this.names[this.marked] ?? null) : null;
  }

  close() {
    this.node.hidden = true;
    this.input.setAttribute("aria-controls", "grid");
  }
}

/** The name that is meant without choosing: of a closed list the first that begins so, else one that is the only one. */
function guessName(starting, part, isClosed) {
  const [first = null, second] = starting;
  const isClear = isClosed || (second === undefined && part.length > 1 && !/^\d+$/.test(part));
  return part ? (starting.find((name) => plain(name) === part) ?? (isClear ? first : null)) : null;
}

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
    const { box } = grid;
    const inside = (value, low, high) => Math.max(low, Math.min(high, value));
    const [x, y] = this.mode ? [left, top] : [
      inside(left, box.scrollLeft, Math.max(box.scrollLeft, box.scrollLeft + box.clientWidth - 60)),
      inside(top, box.scrollTop + grid.headHeight, Math.max(box.scrollTop, box.scrollTop + box.clientHeight - ROW_HEIGHT)),
    ];
    Object.assign(input.style, { transform: `translate(${x}px, ${y}px)`, minWidth: `${width}px`, minHeight: `${ROW_HEIGHT}px` });
    input.classList.toggle("over", isFrozen);
    const height = Math.max(ROW_HEIGHT, input.offsetHeight);
    if (this.list.isOpen) return void this.list.place({ left, top, width, height });
    const label = `${active.name} ${active.column.label}`;
    if (input.getAttribute("aria-label") !== label) input.setAttribute("aria-label", label);
    if (document.getElementById("grid-active")) input.setAttribute("aria-activedescendant", "grid-active");
    else input.removeAttribute("aria-activedescendant");
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
    this.list.open(listChoices(this.grid.store, this.target.column), this.input.value);
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
    const { r, c, column } = this.grid.active;
    if (!hasChoices(column)) return void this.edit();
    const current = this.mode ? this.input.value : this.grid.text(r, c);
    if (!this.mode) this.edit();
    this.input.select();
    this.list.open(listChoices(this.grid.store, column), "", current);
    this.place();
  }

  #choose(name) {
    this.input.value = name;
    this.list.close();
    this.commit();
    this.focus();
  }

  /** End editing and keep what was typed; with `all` into every cell of the selection. */
  commit({ all = false } = {}) {
    if (!this.mode) return;
    const { grid, target } = this;
    const text = this.list.chosen ?? this.input.value;
    const isShown = target.sheet === grid.sheet && grid.order.row(target.r) === target.row;
    const shown = isShown ? grid.text(target.r, target.c) : null;
    this.drop();
    if (all) this.actions.fillSelection(text === "" ? null : text);
    else if (text !== shown) {
      grid.store.hush([target.sheet.name, target.row]);
      this.actions.edit([[target.sheet.name, target.row, target.column.at, text === "" ? null : text]], t("typing"));
    }
  }

  /** Rows come to lie elsewhere: what is typed goes with its own. */
  shift(sheet, move) {
    if (!this.mode || this.target.sheet.name !== sheet) return;
    const row = move(this.target.row);
    if (row === null) return void this.drop();
    Object.assign(this.target, { row, r: this.grid.order.indexOf(row) });
  }

  /** End editing and leave the cell as it was. */
  cancel() {
    if (this.list.isOpen && this.mode === "typing") this.list.close();
    else this.drop();
  }

  /** Forget what is typed: its workbook is gone. */
  drop() {
    if (!this.mode) return;
    this.mode = this.target = null;
    this.list.close();
    this.input.value = "";
    this.input.classList.remove("shown");
    this.grid.ask();
  }
}
