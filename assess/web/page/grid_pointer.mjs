// The pointer in the grid: selecting, the fill handle, widths of columns, the arrow of a list.

import { ROW_HEIGHT } from "./grid.mjs";

const ARROW = 22;
const EDGE_STEP = 18;

export class Pointer {
  #drag = null;
  #moved = 0;

  constructor({ grid, editor, actions, act }) {
    Object.assign(this, { grid, editor, actions, act });
    const { box } = grid;
    box.addEventListener("pointerdown", (event) => this.#down(event));
    box.addEventListener("pointermove", (event) => this.#move(event));
    box.addEventListener("pointerup", (event) => this.#up(event));
    box.addEventListener("pointercancel", () => this.#end());
    box.addEventListener("dblclick", (event) => this.#double(event));
    box.addEventListener("click", (event) => this.#click(event));
    box.addEventListener("contextmenu", (event) => this.#context(event));
  }

  /** The row and column of the view at a point of the window, as near as there is one. */
  cellAt({ clientX, clientY }) {
    const { grid } = this;
    const edge = grid.box.getBoundingClientRect();
    const inBox = clientX - edge.left;
    const x = inBox < grid.frozenWidth ? inBox : inBox + grid.box.scrollLeft;
    const r = Math.floor((clientY - edge.top + grid.box.scrollTop - grid.headHeight) / ROW_HEIGHT);
    const at = grid.columns.findIndex((column) => x < column.x + column.px);
    const last = grid.order.length - 1;
    return [Math.max(0, Math.min(last, r)), at < 0 ? grid.columns.length - 1 : at];
  }

  #down(event) {
    const { target } = event;
    if (event.button !== 0 || target === this.editor.input || target.closest(".grid-choices, .grid-menu-button")) return;
    if (event.pointerType === "touch" && !target.closest(".grid-handle")) return; // a touch scrolls; its click selects
    const kind = this.#kind(target, event);
    if (!kind) return;
    event.preventDefault();
    this.editor.commit();
    this.editor.focus();
    this.#drag = { kind, x: event.clientX, y: event.clientY, event };
    this.grid.box.setPointerCapture(event.pointerId);
    this[`_${kind}`]?.(event);
  }

  #kind(target, event) {
    if (target.closest(".grid-edge")) return "width";
    if (target.closest(".grid-handle")) return "fill";
    if (target.closest("[role=columnheader]")) return target.closest("[data-column]") ? "columns" : "all";
    if (target.closest("[role=rowheader]")) return "rows";
    const cell = target.closest("[role=gridcell]");
    if (cell?.classList.contains("choices") && cell.getBoundingClientRect().right - event.clientX < ARROW) return "list";
    return cell ? "cells" : null;
  }

  // ---- beginnings

  /** Ctrl keeps what was selected before. */
  #keeps({ ctrlKey, metaKey, shiftKey }) {
    const keeps = (ctrlKey || metaKey) && !shiftKey;
    if (keeps) this.grid.selection.keep();
    return keeps || shiftKey;
  }

  _cells(event) {
    this.grid.selection.set(this.cellAt(event), event.shiftKey, this.#keeps(event));
  }

  _list() {
    this.#drag = null;
    this.editor.openChoices();
  }

  _rows(event) {
    const [r] = this.cellAt(event);
    const { selection, columns } = this.grid;
    const isPlain = !event.shiftKey && !event.ctrlKey && !event.metaKey;
    if (isPlain && this.#drag && this.grid.canEdit && selection.isRows && selection.hasRow(r)) return void (this.#drag.kind = "move");
    selection.setRange([event.shiftKey ? selection.anchor[0] : r, 0], [r, columns.length - 1], this.#keeps(event));
  }

  _columns(event) {
    const c = Number(event.target.closest("[data-column]").dataset.column);
    const { selection, order } = this.grid;
    selection.setRange([0, event.shiftKey ? selection.anchor[1] : c], [order.length - 1, c], this.#keeps(event));
  }

  _all() {
    this.#drag = null;
    this.grid.selection.setRange([0, 0], [this.grid.order.length - 1, this.grid.columns.length - 1]);
  }

  _width(event) {
    const c = Number(event.target.closest("[data-column]").dataset.column);
    Object.assign(this.#drag, { c, from: this.grid.columns[c].px });
  }

  // ---- while it moves

  #move(event) {
    if (!this.#drag) return;
    this.#drag.event = event;
    this.#follow();
    if (this.#drag.kind !== "width" && this.#isOutside(event)) this.#scroll();
  }

  #follow() {
    const { kind, event, c, from, x } = this.#drag;
    const { selection, columns, order } = this.grid;
    const [r, at] = this.cellAt(event);
    if (kind === "cells") selection.set([r, at], true);
    else if (kind === "rows") selection.setRange([selection.anchor[0], 0], [r, columns.length - 1], true);
    else if (kind === "columns") selection.setRange([0, selection.anchor[1]], [order.length - 1, at], true);
    else if (kind === "move") this.#showMove(r);
    else if (kind === "width") this.#resize(c, from + event.clientX - x);
    else if (kind === "fill") this.#showFill(r, at);
  }

  #resize(c, width) {
    this.grid.setWidth(c, width);
  }

  #isOutside({ clientX, clientY }) {
    const edge = this.grid.box.getBoundingClientRect();
    return clientY < edge.top + this.grid.headHeight || clientY > edge.bottom || clientX < edge.left + this.grid.frozenWidth || clientX > edge.right;
  }

  /** Scroll while the pointer is held outside. */
  #scroll() {
    if (this.#moved) return;
    const step = () => {
      this.#moved = 0;
      if (!this.#drag || !this.#isOutside(this.#drag.event)) return;
      const { clientX, clientY } = this.#drag.event;
      const { box, frozenWidth } = this.grid;
      const edge = box.getBoundingClientRect();
      if (clientY < edge.top + this.grid.headHeight) box.scrollTop -= EDGE_STEP;
      if (clientY > edge.bottom) box.scrollTop += EDGE_STEP;
      if (clientX > edge.right) box.scrollLeft += EDGE_STEP;
      if (clientX < edge.left + frozenWidth && this.grid.selection.head[1] > 0 && box.scrollLeft > 0) box.scrollLeft -= EDGE_STEP;
      this.#follow();
      this.#moved = requestAnimationFrame(step);
    };
    this.#moved = requestAnimationFrame(step);
  }

  /** The range that the handle is dragged over: down or up, or to a side, whichever is further. */
  #showFill(r, c) {
    const [r0, c0, r1, c1] = this.grid.selection.range;
    const down = r > r1 ? r - r1 : Math.min(0, r - r0);
    const right = c > c1 ? c - c1 : Math.min(0, c - c0);
    const isDown = Math.abs(down) >= Math.abs(right);
    this.#drag.target = isDown ? [Math.min(r0, r), c0, Math.max(r1, r), c1] : [r0, Math.min(c0, c), r1, Math.max(c1, c)];
    this.grid.fillTarget = this.#drag.target;
    this.grid.ask();
  }

  /** Where the selected rows come to lie that are dragged by their numbers. */
  #showMove(r) {
    const { selection, order, columns } = this.grid;
    const [r0, , r1] = selection.range;
    const to = r < r0 ? r : r > r1 ? r - (r1 - r0) : r0;
    this.#drag.to = r < r0 ? order.row(r) : r > r1 ? order.row(r) + 1 : null;
    this.grid.fillTarget = [to, 0, to + r1 - r0, columns.length - 1];
    this.grid.ask();
  }

  // ---- endings

  #up(event) {
    const drag = this.#drag;
    this.#end();
    if (drag?.kind === "move" && !drag.to) this._rows(event);
    else if (drag?.kind === "move") this.actions.moveRows(0, drag.to);
    else if (drag?.kind === "fill" && drag.target) this.actions.fillTo(drag.target, event.ctrlKey || event.metaKey);
  }

  #end() {
    this.#drag = null;
    this.grid.fillTarget = null;
    this.grid.ask();
  }

  /** The pointer is captured by the box, so its events do not tell what is below. */
  #double({ clientX, clientY }) {
    const target = document.elementFromPoint(clientX, clientY);
    const edge = target?.closest(".grid-edge");
    if (edge) this.grid.fitWidth(Number(edge.closest("[data-column]").dataset.column));
    else if (target?.closest("[role=gridcell]") && !this.editor.mode) this.editor.edit();
  }

  /** The right button, or a long touch: what is pointed at is selected, unless it is already. */
  #context(event) {
    event.preventDefault();
    if (event.target === this.editor.input || this.editor.mode) return;
    const { selection } = this.grid;
    const [r, c] = this.cellAt(event);
    const kind = this.#kind(event.target, event);
    if (kind === "rows" && !(selection.isRows && selection.hasRow(r))) this._rows(event);
    else if (kind === "columns") this._columns(event);
    else if (!selection.has(r, c)) selection.set([r, c]);
    this.act.context([event.clientX, event.clientY]);
  }

  #click(event) {
    const button = event.target.closest(".grid-menu-button");
    if (button) this.act.menu(Number(button.closest("[data-column]").dataset.column));
    else if (event.pointerType === "touch" && event.target.closest("[role=gridcell]")) {
      this.grid.selection.set(this.cellAt(event));
      if (this.grid.canEdit) this.editor.focus();
    }
  }
}
