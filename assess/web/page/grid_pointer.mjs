// The pointer in the grid: selecting, the fill handle, widths of columns, the arrow of a list.

import { ROW_HEIGHT } from "./grid.mjs";

const ARROW = 22;
const EDGE_STEP = 18;

export class Pointer {
  #drag = null;
  #moved = 0;

  constructor(view) {
    const { grid, editor, actions } = view;
    Object.assign(this, { view, grid, editor, actions });
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
    return [Math.max(0, Math.min(grid.order.length - 1, r)), at < 0 ? grid.columns.length - 1 : at];
  }

  #down(event) {
    const { target, clientX: x, pointerType } = event;
    if (event.button !== 0 || target === this.editor.input || target.closest(".grid-choices, .grid-menu-button")) return;
    if (pointerType === "touch" && !target.closest(".grid-handle")) return; // a touch scrolls; its click selects
    const kind = this.#kind(event);
    if (!kind) return;
    event.preventDefault();
    this.editor.commit();
    this.editor.focus();
    if (kind === "list") return void this.editor.openChoices();
    this.grid.box.setPointerCapture(event.pointerId);
    const isPlain = !event.shiftKey && !event.ctrlKey && !event.metaKey;
    const moves = kind === "rows" && isPlain && this.grid.canEdit && this.#isOnRows(event);
    this.#drag = { kind: moves ? "move" : kind, x, event };
    const c = columnOf(target);
    if (kind === "width") Object.assign(this.#drag, { c, from: this.grid.columns[c].px });
    else if (kind !== "fill" && !moves) this.#select(kind, event);
  }

  #kind({ target, clientX }) {
    if (target.closest(".grid-edge")) return "width";
    if (target.closest(".grid-handle")) return "fill";
    if (target.closest("[role=columnheader]")) return target.closest("[data-column]") ? "columns" : "all";
    if (target.closest("[role=rowheader]")) return "rows";
    const cell = target.closest("[role=gridcell]");
    if (cell?.classList.contains("choices") && cell.getBoundingClientRect().right - clientX < ARROW) return "list";
    return cell ? "cells" : null;
  }

  /** Whether whole rows are selected and the pointer is on one of them. */
  #isOnRows(event) {
    return this.grid.selection.isRows && this.grid.selection.hasRow(this.cellAt(event)[0]);
  }

  /** Select what is pointed at, up to it where it extends; Ctrl keeps what was selected before. */
  #select(kind, event, extend = event.shiftKey) {
    const { selection, order, columns } = this.grid;
    const [r, c] = this.cellAt(event);
    const [r0, c0] = extend ? selection.anchor : [r, c];
    const [bottom, right] = [order.length - 1, columns.length - 1];
    const keeps = (event.ctrlKey || event.metaKey) && !extend && kind !== "all";
    if (keeps) selection.others.push(selection.range);
    const ranges = {
      cells: [[r0, c0], [r, c]], rows: [[r0, 0], [r, right]], columns: [[0, c0], [bottom, c]],
      all: [[0, 0], [bottom, right]],
    };
    selection.setRange(...ranges[kind], keeps || (extend && kind !== "all"));
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
    if (kind === "width") this.grid.setWidth(c, from + event.clientX - x);
    else if (kind === "move") this.#showMove(event);
    else if (kind === "fill") this.#showFill(event);
    else this.#select(kind, event, true);
  }

  #isOutside({ clientX, clientY }) {
    const edge = this.grid.box.getBoundingClientRect();
    return clientY < edge.top + this.grid.headHeight || clientY > edge.bottom || clientX < edge.left + this.grid.frozenWidth || clientX > edge.right;
  }

  /** Scroll while the pointer is held outside. */
  #scroll() {
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
    this.#moved ||= requestAnimationFrame(step);
  }

  #showTarget(range) {
    this.grid.fillTarget = range;
    this.grid.ask();
  }

  /** The range that the handle is dragged over: down or up, or to a side, whichever is further. */
  #showFill(event) {
    const [r, c] = this.cellAt(event);
    const [r0, c0, r1, c1] = this.grid.selection.range;
    const down = r > r1 ? r - r1 : Math.min(0, r - r0);
    const right = c > c1 ? c - c1 : Math.min(0, c - c0);
    const isDown = Math.abs(down) >= Math.abs(right);
    this.#drag.target = isDown ? [Math.min(r0, r), c0, Math.max(r1, r), c1] : [r0, Math.min(c0, c), r1, Math.max(c1, c)];
    this.#showTarget(this.#drag.target);
  }

  /** Where the selected rows come to lie that are dragged by their numbers. */
  #showMove(event) {
    const [r] = this.cellAt(event);
    const { selection, order, columns } = this.grid;
    const [r0, , r1] = selection.range;
    const to = r < r0 ? r : r > r1 ? r - (r1 - r0) : r0;
    this.#drag.to = r < r0 ? order.row(r) : r > r1 ? order.row(r) + 1 : null;
    this.#showTarget([to, 0, to + r1 - r0, columns.length - 1]);
  }

  // ---- endings

  #up(event) {
    const { kind, to, target } = this.#drag ?? {};
    this.#end();
    if (kind === "move" && !to) this.#select("rows", event);
    else if (kind === "move") this.actions.moveRows(0, to);
    else if (target) this.actions.fillTo(target, event.ctrlKey || event.metaKey);
  }

  #end() {
    this.#drag = null;
    this.#showTarget(null);
  }

  /** The pointer is captured by the box, so its events do not tell what is below. */
  #double({ clientX, clientY }) {
    const target = document.elementFromPoint(clientX, clientY);
    if (target?.closest(".grid-edge")) this.grid.fitWidth(columnOf(target));
    else if (target?.closest("[role=gridcell]") && !this.editor.mode) this.editor.edit();
  }

  /** The right button, or a long touch: what is pointed at is selected, unless it is already. */
  #context(event) {
    event.preventDefault();
    if (event.target === this.editor.input || this.editor.mode) return;
    const kind = this.#kind(event);
    const cell = this.cellAt(event);
    if (kind === "columns" || (kind === "rows" && !this.#isOnRows(event))) this.#select(kind, event);
    else if (!this.grid.selection.has(...cell)) this.grid.selection.set(cell);
    this.view.context.open([event.clientX, event.clientY]);
  }

  #click(event) {
    if (event.target.closest(".grid-menu-button")) this.view.menu.open(columnOf(event.target));
    else if (event.pointerType === "touch" && event.target.closest("[role=gridcell]")) {
      this.grid.selection.set(this.cellAt(event));
      if (this.grid.canEdit) this.editor.focus();
    }
  }
}

const columnOf = (node) => Number(node.closest("[data-column]")?.dataset.column);
