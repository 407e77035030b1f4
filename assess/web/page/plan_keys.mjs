// The plan by keyboard alone: Tab goes through the pieces, arrows move them, letters turn, copy and take them off.

import { roundTo } from "./plan_geometry.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { listTools } from "./plan_toolbar.mjs";
import { tn, t } from "./texts.mjs";

const STEP = 0.05; // metres
const FINE = 0.01;
const TURN = 90;
const TURN_FINE = 15;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const APART = 0.5; // where a copy stands [m]
const FIELDS = "input, textarea, select, [contenteditable], dialog";

/** The keys, for the help. */
export const listKeys = () => [
  ["Tab", t("next piece; Escape, then Tab leaves the plan")],
  [t("Space or Enter"), t("select the piece, or with Shift also")],
  [t("Arrow keys"), t("move by 5 cm, with Shift by 1 cm")],
  ["R", t("turn by 90°, with Shift by 15°")],
  ["Ctrl+D", t("a copy next to it")],
  ["Ctrl+C, Ctrl+V", t("copy; paste on this floor or another, at the pointer")],
  [t("Delete"), t("remove from the plan, or delete the row")],
  ["Ctrl+Z, Ctrl+Y", t("undo, redo")],
  ["Ctrl+A", t("select all pieces of the floor")],
  [t("Arrow keys, Enter"), t("while drawing: move the cross-hair by 10 cm, with Shift by 1 cm; set a point, twice to close")],
  ["Alt", t("while dragging: no snapping")],
  [t("Wheel, + and −"), t("zoom; 0 shows all")],
  [t("Space and drag, middle button"), t("move the view")],
  [listTools().map(([, , key]) => key).join(", "), listTools().map(([, label]) => label).join(", ")],
];

export class PlanKeys {
  #clipboard = [];
  #copiedAt = null; // where the pointer was
  #pastes = 0; // since it moved
  #burst = null;
  #leaves = false;
  #pointer = null;

  /** @param {{root, model, store, scene, viewport, edits, say, canEdit, tool, setTool, remove}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.root.addEventListener("keydown", (event) => this.#down(event));
    this.root.addEventListener("keyup", (event) => event.key in ARROWS && this.endBurst());
    this.root.addEventListener("focusout", () => this.endBurst());
    const { svg } = this.viewport;
    svg.addEventListener("pointermove", (event) => (this.#pointer = this.viewport.toWorld(this.viewport.toLocal(event.clientX, event.clientY))));
    svg.addEventListener("pointerleave", () => (this.#pointer = null));
    svg.addEventListener("focusin", (event) => this.#focused(event));
  }

  get pieces() {
    return this.scene.pieces;
  }

  /** A piece that gets the focus by Tab comes into view. */
  #focused(event) {
    const row = Number(event.target.closest?.(".piece")?.dataset.row ?? 0);
    if (!row) return;
    this.pieces.activate(row);
    const piece = this.model.pieces.get(row);
    if (piece && event.target.matches(":focus-visible")) this.viewport.reveal([piece.x, piece.y]);
  }

  #down(event) {
    if (event.defaultPrevented || event.target.closest(FIELDS)) return;
    const isInPlan = event.target.closest("svg.plan") !== null;
    const isButton = event.target.closest("button, a, [role=tab]") !== null;
    if (isInPlan && this.tool().key?.(event)) return event.preventDefault();
    const isDone = event.ctrlKey || event.metaKey ? this.#control(event) : isInPlan ? this.#plain(event) : !isButton && this.#letter(event);
    if (isDone) event.preventDefault();
    return null;
  }

  /** What the keys act on: the selected pieces, else the one that has the focus. */
  #rows() {
    const selected = [...this.pieces.selected].filter((row) => this.model.pieces.has(row));
    const focused = Number(document.activeElement?.closest?.(".piece")?.dataset.row ?? 0);
    if (focused && !selected.includes(focused)) return [focused];
    return selected;
  }

  #control(event) {
    const key = event.key.toLowerCase();
    const rows = this.#rows();
    if (key === "a") return this.edits.select("Items", this.pieces.order()), true;
    if (!this.canEdit()) return false;
    if (key === "d" && rows.length) return this.#copy(rows), true;
    if (key === "c" && rows.length && !String(getSelection())) {
      this.#clipboard = rows;
      this.#copiedAt = this.#pointer;
      this.#pastes = 0;
      this.say(tn("{n} piece copied", "{n} pieces copied", rows.length));
      return true;
    }
    if (key === "v" && this.#clipboard.length) return this.#paste(), true;
    return false;
  }

  #copy(rows) {
    this.edits.copy(rows, [APART, -APART]);
    this.#focusSelected();
  }

  /** Paste at the pointer where it was moved over the plan, else next to the original, or in the middle on another floor. */
  #paste() {
    const rows = this.#clipboard;
    const at = rows.map((row) => [this.model.length("Items", row, "x"), this.model.length("Items", row, "y")]).filter((one) => one[0] !== null && one[1] !== null);
    if (!at.length) return;
    const centre = [0, 1].map((i) => at.reduce((sum, one) => sum + one[i], 0) / at.length);
    const isHere = rows.some((row) => this.model.pieces.has(row));
    const pointer = this.#pointer;
    const hasMoved = pointer && (!this.#copiedAt || pointer[0] !== this.#copiedAt[0] || pointer[1] !== this.#copiedAt[1]);
    if (hasMoved) this.#pastes = 0;
    const first = hasMoved || (pointer && !isHere) ? pointer : isHere ? [centre[0] + APART, centre[1] - APART] : this.viewport.centre;
    const to = [first[0] + this.#pastes * APART, first[1] - this.#pastes * APART]; // never one over the other
    this.#copiedAt = pointer;
    this.#pastes += 1;
    this.edits.copy(rows, [roundTo(to[0] - centre[0], FINE), roundTo(to[1] - centre[1], FINE)]);
    this.#focusSelected();
    this.say(tn("{n} piece pasted", "{n} pieces pasted", at.length));
  }

  #focusSelected() {
    const [row] = this.store.selection.rows;
    if (row && this.model.pieces.has(row)) this.pieces.focus(row);
  }

  #plain(event) {
    if (event.key in ARROWS) return this.#arrow(event);
    if (event.key === "Tab") return this.#tab(event.shiftKey);
    if (event.key === " " || event.key === "Enter") return this.#pick(event.shiftKey);
    if (event.key === "Escape") return this.#escape();
    return this.#letter(event);
  }

  #letter({ key, shiftKey, altKey }) {
    if (altKey) return false;
    const view = { "+": () => this.viewport.zoom(1.25), "=": () => this.viewport.zoom(1.25), "-": () => this.viewport.zoom(0.8), "−": () => this.viewport.zoom(0.8), 0: () => this.fit() }[key];
    if (view) return view(), true;
    if (!this.canEdit()) return false;
    const tool = listTools().find((one) => one[2] === key.toUpperCase());
    if (tool) return this.setTool(tool[0]), true;
    const rows = this.#rows();
    if (key.toLowerCase() === "r" && rows.length) return this.turn(rows, shiftKey ? TURN_FINE : TURN), true;
    if (key === "Delete" || key === "Backspace") return this.remove(rows), true;
    return false;
  }

  turn(rows, degrees) {
    this.edits.turn(rows, degrees);
    const piece = this.model.pieces.get(rows[0]);
    if (rows.length === 1) this.say(t("{item}: angle {angle}°", { item: piece.item, angle: piece.angle }));
  }

  /** Tab goes on in the order of reading; past the last, and after Escape, it leaves. */
  #tab(isBack) {
    const focused = Number(document.activeElement?.closest?.(".piece")?.dataset.row ?? 0);
    const order = this.pieces.order();
    const next = order[order.indexOf(focused) + (isBack ? -1 : 1)];
    if (this.#leaves || !focused || next === undefined) return (this.#leaves = false);
    this.pieces.focus(next);
    return true;
  }

  #pick(adds) {
    const focused = Number(document.activeElement?.closest?.(".piece")?.dataset.row ?? 0);
    if (!focused) return false;
    const rows = this.pieces.selected;
    const others = [...rows].filter((row) => row !== focused);
    this.edits.select("Items", adds ? (rows.has(focused) ? others : [focused, ...others]) : [focused]);
    return true;
  }

  #escape() {
    this.#leaves = true;
    if (this.tool().name !== "select") this.setTool("select");
    else if (this.store.selection.rows.length) this.edits.select("Items", []);
    else this.viewport.svg.focus();
    return true;
  }

  // ---- arrows: moved at once, written when the key is released, so that a held key is one step of undo

  #arrow(event) {
    const rows = this.#rows();
    if (!rows.length || !this.canEdit() || event.altKey) return false;
    const [dx, dy] = ARROWS[event.key].map((one) => one * (event.shiftKey ? FINE : STEP));
    if (this.#burst && this.#burst.rows.join() !== rows.join()) this.endBurst();
    this.#burst ??= { rows, shift: [0, 0] };
    this.model.hold();
    const { shift } = this.#burst;
    shift[0] = roundTo(shift[0] + dx, FINE);
    shift[1] = roundTo(shift[1] + dy, FINE);
    const poses = rows.map((row) => this.model.pieces.get(row)).map((one) => [one.row, { ...one, x: one.x + shift[0], y: one.y + shift[1] }]);
    this.pieces.preview(new Map(poses));
    this.scene.drawFalls();
    this.onPreview();
    return true;
  }

  endBurst() {
    const burst = this.#burst;
    this.#burst = null;
    if (!burst) return;
    this.edits.move(burst.rows, burst.shift);
    this.pieces.endPreview();
    this.model.release();
    this.scene.drawFalls();
    this.onPreview();
    const piece = this.model.pieces.get(burst.rows[0]);
    if (piece) this.say(`${piece.item}: ${t("X {x}, Y {y}", { x: shownLength(piece.x, this.model.unit), y: shownLength(piece.y, this.model.unit) })}`);
  }
}
