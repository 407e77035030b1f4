// Keys of the grid: those of spreadsheets.

import { ROW_HEIGHT } from "./grid.mjs";

const ARROWS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

/** Listens to the keys of the field of the grid. `act` does what the view does: find, menu, leave. */
export class Keys {
  #tabColumn = null;
  #leaves = false;

  constructor({ grid, editor, actions, store, act }) {
    Object.assign(this, { grid, editor, actions, store, act });
    editor.input.addEventListener("keydown", (event) => this.#down(event));
  }

  #down(event) {
    if (event.isComposing || event.keyCode === 229) return; // an input method has the key
    const done = this.editor.mode ? this.#whileTyping(event) : this.#whileIdle(event);
    if (event.key !== "Escape" && event.key !== "Shift" && event.key !== "Tab") this.#leaves = false;
    if (!done) return;
    event.preventDefault();
    event.stopPropagation();
  }

  // ---- while something is typed

  #whileTyping(event) {
    const { key, altKey, shiftKey } = event;
    const isControl = event.ctrlKey || event.metaKey;
    const { editor } = this;
    if (key === "Escape") return editor.cancel(), true;
    if (key === "Enter" && altKey) return editor.input.setRangeText("\n", editor.input.selectionStart, editor.input.selectionEnd, "end"), true;
    if (key === "Enter") return this.#enter(isControl, shiftKey), true;
    if (key === "Tab") return editor.commit(), this.#tab(shiftKey), true;
    if (key in ARROWS) return this.#arrowWhileTyping(event);
    return false;
  }

  #arrowWhileTyping({ key, altKey, ctrlKey }) {
    const { editor, grid } = this;
    const [down, right] = ARROWS[key];
    if (down && altKey) return editor.openChoices(), true;
    if (down && editor.list.isOpen) return editor.list.move(down), true;
    if (editor.mode !== "typing" || ctrlKey) return false;
    editor.commit();
    grid.selection.move(down, right);
    grid.show();
    return true;
  }

  #enter(isControl, isBack) {
    this.editor.commit({ all: isControl });
    if (isControl) return;
    const { selection } = this.grid;
    if (this.#tabColumn !== null) selection.set([selection.anchor[0], this.#tabColumn]);
    this.#tabColumn = null;
    selection.move(isBack ? -1 : 1, 0);
    this.grid.show();
  }

  #tab(isBack) {
    const { selection } = this.grid;
    this.#tabColumn ??= selection.anchor[1];
    selection.move(0, isBack ? -1 : 1);
    this.grid.show();
  }

  // ---- while nothing is typed

  #whileIdle(event) {
    const isControl = event.ctrlKey || event.metaKey;
    if (event.key in ARROWS) return this.#arrow(event, isControl);
    if (isControl) return this.#control(event);
    return this.#plain(event);
  }

  #arrow({ key, altKey, shiftKey }, isControl) {
    const [down, right] = ARROWS[key];
    const { selection } = this.grid;
    this.#tabColumn = null;
    if (altKey && key === "ArrowDown" && !(selection.isRows && !shiftKey)) {
      if (shiftKey) this.act.menu();
      else this.editor.openChoices();
      return true;
    }
    if (altKey && down && selection.isRows) return this.actions.moveRows(down), true;
    if (altKey) return false;
    if (isControl) selection.jump(down, right, shiftKey);
    else selection.move(down, right, shiftKey);
    this.grid.show();
    return true;
  }

  #plain(event) {
    const { key, shiftKey } = event;
    const { selection } = this.grid;
    const act = {
      PageUp: () => this.#page(-1, shiftKey), PageDown: () => this.#page(1, shiftKey),
      Home: () => this.#to([null, 0], shiftKey), End: () => this.#to([null, Infinity], shiftKey),
      F2: () => this.editor.edit(), Enter: () => this.#enter(false, shiftKey),
      Delete: () => this.actions.clear(), Backspace: () => this.editor.edit(""),
      Escape: () => (this.#leaves = true), ContextMenu: () => this.act.context(),
    }[key];
    if (act) return act(), true;
    if (key === "F10" && shiftKey) return this.act.context(), true;
    if (key === "Tab") return this.#leave(shiftKey);
    if (key === " " && shiftKey) return selection.rows(), true;
    return false;
  }

  /** Tab goes on to the next column; at the end of the row, and after Escape, out of the grid. */
  #leave(isBack) {
    const c = this.grid.selection.anchor[1];
    if (this.#leaves || c === (isBack ? 0 : this.grid.columns.length - 1)) return (this.#leaves = false);
    this.#tab(isBack);
    return true;
  }

  #page(down, extend) {
    const rows = Math.max(1, Math.floor(this.grid.box.clientHeight / ROW_HEIGHT) - 2);
    this.grid.selection.move(down * rows, 0, extend);
    this.grid.show();
  }

  #to([r, c], extend) {
    const { selection } = this.grid;
    selection.set([r ?? selection.head[0], c], extend);
    this.grid.show();
  }

  #control(event) {
    const { shiftKey, key } = event;
    const { selection } = this.grid;
    const act = {
      z: () => (shiftKey ? this.store.redo() : this.store.undo()), y: () => this.store.redo(),
      f: () => this.act.find(false), h: () => this.act.find(true), d: () => this.actions.fillDown(), r: () => this.actions.fillRight(), a: () => this.#all(),
      home: () => this.#to([0, 0], shiftKey), end: () => this.#to(this.#last(), shiftKey), " ": () => selection.columns(),
      "-": () => this.actions.deleteRows(), "+": () => this.actions.insertRows(),
    }[key.toLowerCase()];
    if (!act) return false;
    act();
    return true;
  }

  /** The last used row and the last column. */
  #last() {
    const { order, sheet, columns } = this.grid;
    let r = order.length - 1;
    while (r > 0 && !sheet.isUsed(order.row(r))) r -= 1;
    return [r, columns.length - 1];
  }

  #all() {
    this.grid.selection.setRange([0, 0], this.#last());
  }
}

