// Keys of the grid: those of spreadsheets.

import { ROW_HEIGHT } from "./grid.mjs";

const ARROWS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

/** Listens to the keys of the field of the grid. */
export class Keys {
  #tabColumn = null;
  #leaves = false;

  constructor(view) {
    const { grid, editor, actions, store } = view;
    Object.assign(this, { view, grid, editor, actions, store });
    editor.input.addEventListener("keydown", (event) => this.#down(event));
  }

  #down(event) {
    const { key, isComposing, keyCode, ctrlKey, metaKey } = event;
    if (isComposing || keyCode === 229) return; // an input method has the key
    const isControl = ctrlKey || metaKey;
    const act = this.editor.mode ? this.#whileTyping : key in ARROWS ? this.#arrow : this.#whileIdle;
    const done = act.call(this, event, isControl);
    if (key !== "Escape" && key !== "Shift" && key !== "Tab") this.#leaves = false;
    if (!done) return;
    event.preventDefault();
    event.stopPropagation();
  }

  #whileTyping({ key, altKey, shiftKey, ctrlKey }, isControl) {
    const { editor } = this;
    const { input } = editor;
    const [down, right] = ARROWS[key] ?? [];
    if (key === "Escape") editor.cancel();
    else if (key === "Enter" && altKey) input.setRangeText("\n", input.selectionStart, input.selectionEnd, "end");
    else if (key === "Enter") this.#enter(isControl, shiftKey);
    else if (key === "Tab") this.#tab(shiftKey);
    else if (down && altKey) editor.openChoices();
    else if (down && editor.list.isOpen) editor.list.move(down);
    else if (right === undefined || editor.mode !== "typing" || ctrlKey) return false;
    else {
      editor.commit();
      this.#move(down, right);
    }
    return true;
  }

  #move(down, right, extend) {
    this.grid.selection.move(down, right, extend);
    this.grid.show();
  }

  #enter(isControl, isBack) {
    this.editor.commit({ all: isControl });
    if (isControl) return;
    const { selection } = this.grid;
    if (this.#tabColumn !== null) selection.set([selection.anchor[0], this.#tabColumn]);
    this.#tabColumn = null;
    this.#move(isBack ? -1 : 1, 0);
  }

  #tab(isBack) {
    this.editor.commit();
    this.#tabColumn ??= this.grid.selection.anchor[1];
    this.#move(0, isBack ? -1 : 1);
  }

  #arrow({ key, altKey, shiftKey }, isControl) {
    const [down, right] = ARROWS[key];
    const { selection } = this.grid;
    this.#tabColumn = null;
    if (altKey && key === "ArrowDown" && shiftKey) this.view.menu.open();
    else if (altKey && down && selection.isRows) this.actions.moveRows(down);
    else if (altKey && key === "ArrowDown") this.editor.openChoices();
    else if (altKey) return false;
    else {
      if (isControl) selection.jump(down, right, shiftKey);
      else selection.move(down, right, shiftKey);
      this.grid.show();
    }
    return true;
  }

  #whileIdle({ key, shiftKey }, isControl) {
    const { view, grid, editor, actions, store } = this;
    const { selection } = grid;
    const go = (cell) => (selection.set(cell, shiftKey), grid.show());
    const page = Math.max(1, Math.floor(grid.box.clientHeight / ROW_HEIGHT) - 2);
    const controlled = {
      z: () => (shiftKey ? store.redo() : store.undo()), y: () => store.redo(),
      f: () => view.find.open(false), h: () => view.find.open(true),
      d: () => actions.fillDown(), r: () => actions.fillRight(), a: () => selection.setRange([0, 0], this.#last()),
      home: () => go([0, 0]), end: () => go(this.#last()), " ": () => selection.columns(),
      "-": () => actions.deleteRows(), "+": () => actions.insertRows(),
    };
    const plain = {
      pageup: () => this.#move(-page, 0, shiftKey), pagedown: () => this.#move(page, 0, shiftKey),
      home: () => go([selection.head[0], 0]), end: () => go([selection.head[0], Infinity]),
      f2: () => editor.edit(), enter: () => this.#enter(false, shiftKey),
      delete: () => actions.clear(), backspace: () => editor.edit(""),
      escape: () => (this.#leaves = true), contextmenu: () => view.context.open(),
      ...(shiftKey && { f10: () => view.context.open(), " ": () => selection.rows() }),
    };
    if (key === "Tab" && !isControl) return this.#leave(shiftKey);
    const act = (isControl ? controlled : plain)[key.toLowerCase()];
    act?.();
    return Boolean(act);
  }

  /** Tab goes on to the next column; at the end of the row, and after Escape, out of the grid. */
  #leave(isBack) {
    const c = this.grid.selection.anchor[1];
    if (this.#leaves || c === (isBack ? 0 : this.grid.columns.length - 1)) return (this.#leaves = false);
    this.#tab(isBack);
    return true;
  }

  /** The last used row and the last column. */
  #last() {
    const { order, sheet, columns } = this.grid;
    let r = order.length - 1;
    while (r > 0 && !sheet.isUsed(order.row(r))) r -= 1;
    return [r, columns.length - 1];
  }
}
