// The plan by keyboard alone: Tab goes through the pieces, arrows move them, letters turn, copy and take them off.

import { ARROWS, TOOLS } from "./plan_draft.mjs";
import { roundTo } from "./plan_geometry.mjs";
import { isPlaced } from "./plan_model.mjs";
import { tn, t } from "./texts.mjs";

const STEP = 0.05; // metres
const FINE = 0.01;
const TURN = 90;
const TURN_FINE = 15;
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
  [TOOLS.map(([, key]) => key).join(", "), TOOLS.map(([, , label]) => label()).join(", ")],
];

export class PlanKeys {
  #clipboard = { rows: [], at: null, pastes: 0 }; // where the pointer was, and how often they were pasted since it moved
  #burst = null;
  #leaves = false;
  #pointer = null;

  constructor(parts) {
    Object.assign(this, parts, { pieces: parts.scene.pieces });
    this.root.addEventListener("keydown", (event) => this.#down(event));
    this.root.addEventListener("keyup", (event) => event.key in ARROWS && this.endBurst());
    this.root.addEventListener("focusout", () => this.endBurst());
    const { svg, viewport } = this;
    svg.addEventListener("pointermove", ({ clientX, clientY }) => (this.#pointer = viewport.toWorld(viewport.toLocal(clientX, clientY))));
    svg.addEventListener("pointerleave", () => (this.#pointer = null));
    svg.addEventListener("focusin", (event) => this.#onFocus(event));
  }

  /** The row of the piece that has the focus, else 0. */
  #focused = (node = document.activeElement) => Number(node?.closest?.(".piece")?.dataset.row ?? 0);

  /** A piece that gets the focus by Tab comes into view. */
  #onFocus({ target }) {
    const row = this.#focused(target);
    const piece = this.model.pieces.get(row);
    if (row) this.pieces.activate(row);
    if (piece && target.matches(":focus-visible")) this.viewport.reveal([piece.x, piece.y]);
  }

  #down(event) {
    if (event.defaultPrevented || event.target.closest(FIELDS)) return;
    const isInPlan = event.target.closest("svg.plan") !== null;
    const isButton = event.target.closest("button, a, [role=tab]") !== null;
    const isDone = (isInPlan && this.currentTool().key?.(event))
      || (event.ctrlKey || event.metaKey ? this.#control(event) : isInPlan ? this.#plain(event) : !isButton && this.#letter(event));
    if (isDone) event.preventDefault();
  }

  /** What the keys act on: the selected pieces, else the one that has the focus. */
  #rows() {
    const selected = [...this.pieces.selected].filter((row) => this.model.pieces.has(row));
    const focused = this.#focused();
    return focused && !selected.includes(focused) ? [focused] : selected;
  }

  #control(event) {
    const key = event.key.toLowerCase();
    const rows = this.#rows();
    if (key === "a") return this.edits.select("Items", this.pieces.order()), true;
    if (!this.canEdit()) return false;
    if (key === "v") return this.#paste(this.#clipboard);
    if (!rows.length) return false;
    if (key === "d") return this.#copy(rows, [APART, -APART]), true;
    if (key !== "c" || String(getSelection())) return false;
    this.#clipboard = { rows, at: this.#pointer, pastes: 0 };
    this.say(tn("{n} piece copied", "{n} pieces copied", rows.length));
    return true;
  }

  #copy(rows, shift) {
    this.edits.copy(rows, shift);
    const [row] = this.store.selection.rows;
    if (row && this.model.pieces.has(row)) this.pieces.focus(row);
  }

  /** Paste at the pointer where it was moved over the plan, else next to the original, or in the middle on another floor. */
  #paste({ rows, at, pastes }) {
    const pointer = this.#pointer;
    const all = rows.map((row) => ({ x: this.model.length("Items", row, "x"), y: this.model.length("Items", row, "y") })).filter(isPlaced);
    if (!all.length) return rows.length > 0;
    const centre = ["x", "y"].map((axis) => all.reduce((sum, one) => sum + one[axis], 0) / all.length);
    const isHere = rows.some((row) => this.model.pieces.has(row));
    const hasMoved = pointer && String(pointer) !== String(at);
    const first = hasMoved || (pointer && !isHere) ? pointer : isHere ? [centre[0] + APART, centre[1] - APART] : this.viewport.centre;
    const n = hasMoved ? 0 : pastes; // never one over the other
    this.#clipboard = { rows, at: pointer, pastes: n + 1 };
    this.#copy(rows, [n * APART, -n * APART].map((by, i) => roundTo(first[i] + by - centre[i], FINE)));
    this.say(tn("{n} piece pasted", "{n} pieces pasted", all.length));
    return true;
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
    const zoom = { "+": 1.25, "=": 1.25, "-": 0.8, "−": 0.8 }[key];
    if (zoom) return this.viewport.zoom(zoom), true;
    if (key === "0") return this.fit(), true;
    if (!this.canEdit()) return false;
    const tool = TOOLS.find((one) => one[1] === key.toUpperCase());
    if (tool) return this.setTool(tool[0]), true;
    const rows = this.#rows();
    if (key.toLowerCase() === "r" && rows.length) return this.turn(rows, shiftKey ? TURN_FINE : TURN), true;
    if (key === "Delete" || key === "Backspace") return this.remove(rows), true;
    return false;
  }

  turn(rows, degrees) {
    this.edits.pose(rows.map((row) => ({ row, angle: this.model.pieces.get(row).angle + degrees })), t("turn"));
    const { item, angle } = this.model.pieces.get(rows[0]);
    if (rows.length === 1) this.say(t("{item}: angle {angle}°", { item, angle }));
  }

  /** Tab goes on in the order of reading; past the last, and after Escape, it leaves. */
  #tab(isBack) {
    const focused = this.#focused();
    const order = this.pieces.order();
    const next = order[order.indexOf(focused) + (isBack ? -1 : 1)];
    if (this.#leaves || !focused || next === undefined) return (this.#leaves = false);
    this.pieces.focus(next);
    return true;
  }

  #pick(adds) {
    const focused = this.#focused();
    if (!focused) return false;
    const rows = this.pieces.selected;
    const others = [...rows].filter((row) => row !== focused);
    this.edits.select("Items", adds ? (rows.has(focused) ? others : [focused, ...others]) : [focused]);
    return true;
  }

  #escape() {
    this.#leaves = true;
    if (this.currentTool().name !== "select") this.setTool("select");
    else if (this.store.selection.rows.length) this.edits.select("Items", []);
    else this.viewport.svg.focus();
    return true;
  }

  // ---- arrows: moved at once, written when the key is released, so that a held key is one step of undo

  #arrow(event) {
    const rows = this.#rows();
    if (!rows.length || !this.canEdit() || event.altKey) return false;
    const step = event.shiftKey ? FINE : STEP;
    if (String(this.#burst?.rows) !== String(rows)) this.endBurst();
    this.model.isHeld = true;
    const shift = ARROWS[event.key].map((one, i) => roundTo((this.#burst?.shift[i] ?? 0) + one * step, FINE));
    this.#burst = { rows, shift };
    this.select.preview(this.#poses());
    return true;
  }

  /** Where the pieces of the burst stand; along an axis that they are not moved along, as before. */
  #poses() {
    const { rows, shift: [dx, dy] } = this.#burst;
    const moved = (value, by) => (by ? roundTo(value + by, FINE) : value);
    const pieces = rows.map((row) => this.model.pieces.get(row)).filter(Boolean);
    return pieces.map((one) => ({ ...one, x: moved(one.x, dx), y: moved(one.y, dy) }));
  }

  endBurst() {
    if (!this.#burst) return;
    const poses = this.#poses();
    this.#burst = null;
    this.edits.pose(poses.map(({ row, x, y }) => ({ row, x, y })), t("move"));
    this.model.release();
    this.select.preview([]);
    const [piece] = poses;
    if (piece) this.say(`${piece.item}: ${this.model.shownAt([piece.x, piece.y])}`);
  }
}
