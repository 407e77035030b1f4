// The tool in use at first: select, drag and turn pieces; move places and the corners of their outlines; a frame selects.

import { boxOf, corners, direction, distance, middle, rectangle, roundTo, sidesOf, snapPoint, snapSides, turnPoint, wholeAngle } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { t } from "./texts.mjs";

const SNAP_PX = 9;
const TURN_STEP = 15;
const HANDLE_PX = 34;

export class SelectTool {
  name = "select";
  snaps = true;
  #gesture = null;

  constructor(parts) {
    Object.assign(this, parts, { pieces: parts.scene.pieces });
  }

  // ---- pointers

  down(point) {
    const handle = point.target.closest(".handle");
    const piece = point.target.closest(".piece");
    if (handle && this.canEdit()) this.#gesture = this.#onHandle(handle, point);
    else this.#gesture = piece ? this.#onPiece(Number(piece.dataset.row), point) : this.#onGround(point);
    Object.assign(this.#gesture, { from: point, isMoved: false });
  }

  move(point, isDown) {
    const gesture = this.#gesture;
    if (!isDown || !gesture) return;
    if (!gesture.isMoved) {
      if (!isDrag(gesture.from.px, point.px)) return;
      gesture.isMoved = true;
      this.model.isHeld = true;
    }
    gesture.last = point;
    gesture.frame ??= requestAnimationFrame(() => {
      gesture.frame = null;
      if (gesture === this.#gesture) gesture.drag?.(gesture.last, gesture.from);
    });
  }

  up(point) {
    const gesture = this.#gesture;
    if (!gesture) return;
    this.#gesture = null;
    if (gesture.isMoved) {
      gesture.drag?.(point, gesture.from);
      gesture.drop?.(point);
    } else gesture.click?.(point);
    this.#end(gesture);
  }

  cancel() {
    const gesture = this.#gesture;
    this.#gesture = null;
    if (gesture) this.#end(gesture);
  }

  /** A tap of a finger that moved nothing: select what is there. */
  tap(point) {
    this.down(point);
    this.up(point);
  }

  double({ target }) {
    const vertex = target.closest(".handle.vertex");
    if (vertex) this.#removeVertex(vertex);
  }

  get isDragging() {
    return Boolean(this.#gesture?.isMoved);
  }

  #end(gesture) {
    cancelAnimationFrame(gesture.frame);
    this.ring = null;
    this.scene.sketch();
    this.scene.drawPicture();
    this.preview([]);
    if (gesture.isMoved) this.model.release();
  }

  // ---- pieces

  #onPiece(row, point) {
    const { pieces } = this;
    const isSelected = pieces.selected.has(row);
    if (point.more && !isSelected) this.edits.select("Items", [row, ...pieces.selected]);
    else if (!isSelected) this.edits.select("Items", [row]);
    pieces.focus(row);
    const click = () => {
      if (point.more && isSelected) this.edits.select("Items", [...pieces.selected].filter((one) => one !== row));
      else if (!point.more) this.edits.select("Items", [row]);
    };
    return this.canEdit() ? { click, ...this.#carry(row, [...pieces.selected].filter((one) => this.model.pieces.has(one))) } : { click };
  }

  /** Drag some pieces; the one that is held snaps. */
  #carry(row, rows) {
    const held = this.model.pieces.get(row);
    const poses = rows.map((one) => this.model.pieces.get(one));
    const lines = this.#linesBut(rows);
    let shift = null;
    return {
      drag: (point, { at: [x, y] }) => {
        const snapped = this.#snap(held, [point.at[0] - x, point.at[1] - y], lines, point.alt);
        shift = snapped.shift;
        this.preview(poses.map((one) => this.#shifted(one, shift)));
        const now = this.#shifted(held, shift);
        this.scene.sketch([], [{ at: [now.x, now.y], text: this.model.shownAt([now.x, now.y]) }], snapped.guides);
      },
      drop: () => {
        const moved = poses.map((one) => ({ ...this.#shifted(one, shift), angle: undefined }));
        this.edits.pose(moved, t("move"));
        const now = this.#shifted(held, shift);
        this.say(`${held.item}: ${this.model.shownAt([now.x, now.y])}`);
      },
    };
  }

  /** Show pieces as they would stand, with what they cover. */
  preview(poses) {
    this.pieces.preview(poses);
    this.scene.drawFalls();
    this.showHandles();
  }

  /** Positions are whole centimetres; one that is not moved along an axis stays as it is. */
  #shifted(pose, [dx, dy]) {
    const moved = (value, by) => (Math.abs(by) < 0.005 ? value : roundTo(value + by, 0.01));
    return { ...pose, x: moved(pose.x, dx), y: moved(pose.y, dy) };
  }

  #snap(piece, shift, lines, isOff) {
    if (!this.snaps || isOff) return { shift, guides: [] };
    const sides = sidesOf(corners({ ...piece, x: piece.x + shift[0], y: piece.y + shift[1] }));
    const found = snapSides(sides, lines, SNAP_PX / this.viewport.scale);
    return { shift: [shift[0] + found.shift[0], shift[1] + found.shift[1]], guides: found.guides };
  }

  /** Walls, and sides of the pieces that stay. */
  #linesBut(rows) {
    const others = [...this.model.pieces.values()].filter((one) => !rows.includes(one.row));
    return [...this.model.walls, ...others.flatMap((one) => sidesOf(corners(one)))];
  }

  /** Where a new piece of a size would snap to. */
  snapNew(piece, isOff) {
    const { shift, guides } = this.#snap(piece, [0, 0], this.#linesBut([]), isOff);
    return { at: [roundTo(piece.x + shift[0], 0.01), roundTo(piece.y + shift[1], 0.01)], guides };
  }

  // ---- ground: frames, places, segments

  #onGround(point) {
    const { target } = point;
    const place = Number(target.closest("[data-place]")?.dataset.place ?? 0);
    const segment = Number(target.closest("[data-segment]")?.dataset.segment ?? 0);
    const click = () => {
      if (place) this.edits.select("Places", [place]);
      else if (segment) this.edits.select("Routes", [segment]);
      else if (!point.more) this.edits.select("Items", []);
    };
    const isMark = this.canEdit() && target.closest(".mark");
    if (this.canEdit() && !isMark && this.picture.isUnlocked) return { click, ...this.picture.carry() };
    return { click, ...(isMark && this.#selectedPlace === place ? this.#carryPlace(place) : this.#frame(point)) };
  }

  #frame(point) {
    const inside = (to) => {
      const [x0, y0, x1, y1] = boxOf([point.at, to.at]);
      return [...this.model.pieces.values()].filter((one) => one.x >= x0 && one.x <= x1 && one.y >= y0 && one.y <= y1).map((one) => one.row);
    };
    return {
      drag: (to) => this.scene.sketch([{ name: "frame", points: rectangle(point.at, to.at), isClosed: true }]),
      drop: (to) => this.edits.select("Items", [...new Set([...(point.more ? this.pieces.selected : []), ...inside(to)])]),
    };
  }

  /** The row of the one place that is selected, else 0. */
  get #selectedPlace() {
    const { sheet, row, rows } = this.store.selection;
    return sheet === "Places" && rows.length === 1 ? row : 0;
  }

  #carryPlace(row) {
    const { x, y } = this.model.places.get(row);
    let at = [x, y];
    return {
      drag: (point) => {
        at = this.snapDrawn(point, null, [row]).point;
        this.scene.sketch([], [{ at, text: this.model.shownAt(at) }], [[[x, y], at]]);
      },
      drop: () => this.edits.change("Places", [row], { x: at[0], y: at[1] }, t("move")),
    };
  }

  /** A drawn point on corners, walls and right angles, unless snapping is off. */
  snapDrawn(point, before, without = []) {
    if (!this.snaps || point.alt) return { point: point.at, guides: [] };
    const rings = this.model.outlined.filter((one) => !without.includes(one.row)).map((one) => one.outline);
    const targets = { points: rings.flat(), lines: rings.flatMap(sidesOf), before };
    return snapPoint(point.at, targets, SNAP_PX / this.viewport.scale);
  }

  // ---- handles

  showHandles() {
    this.scene.showHandles(this.canEdit() ? [...this.#turnHandle(), ...this.#vertexHandles(), ...this.picture.handles()] : []);
  }

  #turnHandle() {
    const rows = [...this.pieces.selected].filter((row) => this.model.pieces.has(row));
    if (rows.length !== 1) return [];
    const { x, y, angle, breadth } = this.pieces.pose(rows[0]);
    const end = (by) => turnPoint([breadth / 2 + by, 0], angle, [x, y]);
    return [{ name: "turn", at: end(HANDLE_PX / this.viewport.scale), stem: end(0), label: t("Turn: drag; Alt for single degrees"), data: { row: rows[0] } }];
  }

  #vertexHandles() {
    const ring = this.ring ?? this.model.places.get(this.#selectedPlace)?.outline ?? [];
    return ring.flatMap((at, i) => [
      { name: "midpoint", at: middle(at, ring[(i + 1) % ring.length]), label: t("Drag to add a corner"), data: { vertex: i + 1, add: 1 } },
      { name: "vertex", at, label: t("Drag to move the corner; double-click or Alt and click to take it out"), data: { vertex: i } },
    ]);
  }

  #onHandle(handle, point) {
    if (handle.classList.contains("turn")) return this.#turning(Number(handle.dataset.row));
    if (handle.classList.contains("picture-turn")) return this.picture.turning();
    if (handle.classList.contains("vertex") && point.alt) return { click: () => this.#removeVertex(handle) };
    return this.#bending(handle);
  }

  #turning(row) {
    const piece = this.model.pieces.get(row);
    const centre = [piece.x, piece.y];
    let angle = piece.angle;
    return {
      drag: (point) => {
        angle = wholeAngle(direction(centre, point.at), point.alt || !this.snaps ? 1 : TURN_STEP);
        this.preview([{ ...piece, angle }]);
        this.scene.sketch([], [{ at: centre, text: `${angle}°` }]);
      },
      drop: () => {
        this.edits.pose([{ row, angle }], t("turn"));
        this.say(t("{item}: angle {angle}°", { item: piece.item, angle }));
      },
    };
  }

  /** Move a corner of an outline, or make a new one of the middle of a side. */
  #bending({ dataset: { vertex, add } }) {
    const row = this.#selectedPlace;
    const at = Number(vertex);
    const old = this.model.places.get(row).outline;
    const ring = add ? old.toSpliced(at, 0, middle(old[at - 1], old[at % old.length])) : [...old];
    return {
      drag: (point) => {
        const found = this.snapDrawn(point, ring.at(at - 1), [row]);
        ring[at] = found.point;
        this.ring = ring;
        const text = this.model.shownLength(distance(ring.at(at - 1), found.point));
        this.scene.sketch([{ name: "drawn", points: ring, isClosed: true }], [{ at: found.point, text }], found.guides);
        this.showHandles();
      },
      drop: () => this.edits.change("Places", [row], { outline: ring }, t("outline")),
    };
  }

  #removeVertex({ dataset: { vertex } }) {
    const row = this.#selectedPlace;
    const ring = this.model.places.get(row)?.outline;
    if (ring?.length <= 3) this.say(t("An outline needs three corners."));
    else if (ring) this.edits.change("Places", [row], { outline: ring.toSpliced(Number(vertex), 1) }, t("outline"));
  }
}
