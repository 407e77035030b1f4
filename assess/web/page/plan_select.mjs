// The tool in use at first: select, drag and turn pieces; move places and the corners of their outlines; a frame selects.

import { boxOf, corners, direction, distance, middle, roundTo, turnPoint } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { lineOf, sidesOf, snapPoint, snapSides } from "./plan_snap.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { t } from "./texts.mjs";

const SNAP_PX = 9;
const TURN_STEP = 15;
const HANDLE_PX = 34;

export class SelectTool {
  name = "select";
  snaps = true;
  #gesture = null;

  /** @param {{model, store, scene, viewport, edits, say, canEdit}} parts */
  constructor(parts) {
    Object.assign(this, parts);
  }

  get pieces() {
    return this.scene.pieces;
  }

  // ---- pointers

  down(point) {
    const { target } = point;
    const handle = target.closest(".handle");
    if (handle && this.canEdit()) this.#gesture = this.#onHandle(handle, point);
    else if (target.closest(".piece")) this.#gesture = this.#onPiece(Number(target.closest(".piece").dataset.row), point);
    else this.#gesture = this.#onGround(target, point);
    if (this.#gesture) Object.assign(this.#gesture, { from: point, isMoved: false });
  }

  move(point, isDown) {
    const gesture = this.#gesture;
    if (!isDown || !gesture) return;
    if (!gesture.isMoved) {
      if (!isDrag(gesture.from.px, point.px)) return;
      gesture.isMoved = true;
      this.model.hold();
    }
    gesture.last = point;
    gesture.frame ??= requestAnimationFrame(() => {
      gesture.frame = null;
      if (gesture === this.#gesture && gesture.last) gesture.drag?.(gesture.last, gesture.from);
    });
  }

  up(point) {
    const gesture = this.#gesture;
    this.#gesture = null;
    if (!gesture) return;
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

  double(point) {
    if (point.target.closest(".handle.vertex")) this.removeVertex(point.target.closest(".handle"));
  }

  get isDragging() {
    return Boolean(this.#gesture?.isMoved);
  }

  #end(gesture) {
    cancelAnimationFrame(gesture.frame);
    this.scene.sketch();
    this.pieces.endPreview();
    this.scene.drawPicture();
    this.scene.drawFalls();
    this.showHandles();
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
    if (!this.canEdit()) return { click };
    const rows = [...pieces.selected].filter((one) => this.model.pieces.has(one));
    return { click, rows, ...this.#carry(row, rows) };
  }

  /** Drag some pieces; the one that is held snaps. */
  #carry(row, rows) {
    const held = this.model.pieces.get(row);
    const poses = new Map(rows.map((one) => [one, this.model.pieces.get(one)]));
    const lines = this.linesBut(rows);
    const gesture = {};
    gesture.drag = (point, from) => {
      const shift = [point.at[0] - from.at[0], point.at[1] - from.at[1]];
      const snapped = this.#snap(held, shift, lines, point.alt);
      gesture.shift = snapped.shift;
      this.pieces.preview(new Map([...poses].map(([one, pose]) => [one, this.#shifted(pose, snapped.shift)])));
      this.scene.drawFalls();
      this.showHandles();
      const now = this.#shifted(held, snapped.shift);
      this.scene.sketch(snapped.guides.map((points) => ({ name: "guide", points })), [{ at: [now.x, now.y], text: this.#xy(now) }]);
    };
    gesture.drop = () => {
      if (!gesture.shift) return;
      const moved = [...poses].map(([one, pose]) => ({ row: one, ...this.#shifted(pose, gesture.shift), angle: undefined }));
      this.edits.pose(moved, t("move"));
      const now = this.#shifted(held, gesture.shift);
      this.say(`${held.item}: ${this.#xy(now)}`);
    };
    return gesture;
  }

  /** Positions are whole centimetres; one that is not moved along an axis stays as it is. */
  #shifted(pose, [dx, dy]) {
    const moved = (value, by) => (Math.abs(by) < 0.005 ? value : roundTo(value + by, 0.01));
    return { ...pose, x: moved(pose.x, dx), y: moved(pose.y, dy) };
  }

  #xy({ x, y }) {
    const unit = this.model.unit;
    return t("X {x}, Y {y}", { x: shownLength(x, unit), y: shownLength(y, unit) });
  }

  #snap(piece, shift, lines, isOff) {
    if (!this.snaps || isOff) return { shift, guides: [] };
    const sides = sidesOf(corners({ ...piece, x: piece.x + shift[0], y: piece.y + shift[1] }));
    const found = snapSides(sides, lines, SNAP_PX / this.viewport.scale);
    return { shift: [shift[0] + found.shift[0], shift[1] + found.shift[1]], guides: found.guides };
  }

  /** Walls, and sides of the pieces that stay. */
  linesBut(rows) {
    const moving = new Set(rows);
    const others = [...this.model.pieces.values()].filter((one) => !moving.has(one.row));
    return [...this.walls(), ...others.flatMap((one) => sidesOf(corners(one)))];
  }

  walls() {
    return (this.model.plan?.walls ?? []).map(([a, b]) => lineOf(a, b)).filter((one) => one.length > 0);
  }

  /** Where a new piece of a size would snap to. */
  snapNew(piece, isOff) {
    const { shift, guides } = this.#snap(piece, [0, 0], this.linesBut([]), isOff);
    return { at: [roundTo(piece.x + shift[0], 0.01), roundTo(piece.y + shift[1], 0.01)], guides };
  }

  // ---- ground: frames, places, segments

  #onGround(target, point) {
    const place = Number(target.closest("[data-place]")?.dataset.place ?? 0);
    const segment = Number(target.closest("[data-segment]")?.dataset.segment ?? 0);
    const click = () => {
      if (place) this.edits.select("Places", [place]);
      else if (segment) this.edits.select("Routes", [segment]);
      else if (!point.more) this.edits.select("Items", []);
    };
    if (this.picture?.isUnlocked && this.canEdit() && !target.closest(".mark")) return { click, ...this.picture.carry() };
    if (place && target.closest(".mark") && this.canEdit() && this.#isSelectedPlace(place)) return { click, ...this.#carryPlace(place) };
    return { click, ...this.#frame(point) };
  }

  #frame(point) {
    const inside = (to) => {
      const [x0, y0, x1, y1] = boxOf([point.at, to.at]);
      return [...this.model.pieces.values()].filter((one) => one.x >= x0 && one.x <= x1 && one.y >= y0 && one.y <= y1).map((one) => one.row);
    };
    return {
      drag: (to) => {
        const [[a, b], [c, d]] = [point.at, to.at];
        this.scene.sketch([{ name: "frame", points: [[a, b], [c, b], [c, d], [a, d]], isClosed: true }]);
      },
      drop: (to) => this.edits.select("Items", point.more ? [...new Set([...this.pieces.selected, ...inside(to)])] : inside(to)),
    };
  }

  #isSelectedPlace(row) {
    const { selection } = this.store;
    return selection.sheet === "Places" && selection.rows.includes(row);
  }

  #carryPlace(row) {
    const place = this.model.places.get(row);
    let at = [place.x, place.y];
    return {
      drag: (point) => {
        const found = this.snapDrawn(point, null, [row]);
        at = found.point;
        this.scene.sketch([{ name: "guide", points: [[place.x, place.y], at] }], [{ at, text: this.#xy({ x: at[0], y: at[1] }) }]);
      },
      drop: () => this.edits.movePlace(row, at),
    };
  }

  /** A drawn point on corners, walls and right angles, unless snapping is off. */
  snapDrawn(point, before, without = []) {
    if (!this.snaps || point.alt) return { point: point.at, guides: [] };
    const rings = [...this.model.places.values()].filter((one) => one.outline && !without.includes(one.row)).map((one) => one.outline);
    const targets = { points: rings.flat(), lines: rings.flatMap(sidesOf), before };
    return snapPoint(point.at, targets, SNAP_PX / this.viewport.scale);
  }

  // ---- handles

  showHandles() {
    this.scene.showHandles(this.canEdit() ? [...this.#turnHandle(), ...this.#vertexHandles(), ...(this.picture?.handles() ?? [])] : []);
  }

  #turnHandle() {
    const rows = [...this.pieces.selected].filter((row) => this.model.pieces.has(row));
    if (rows.length !== 1) return [];
    const pose = this.pieces.pose(rows[0]);
    const [u, v] = turnPoint([pose.breadth / 2 + HANDLE_PX / this.viewport.scale, 0], pose.angle);
    const [su, sv] = turnPoint([pose.breadth / 2, 0], pose.angle);
    return [{ name: "turn", at: [pose.x + u, pose.y + v], stem: [pose.x + su, pose.y + sv], label: t("Turn: drag; Alt for single degrees"), data: { row: rows[0] } }];
  }

  #vertexHandles() {
    const { selection } = this.store;
    const place = selection.sheet === "Places" && selection.rows.length === 1 ? this.model.places.get(selection.row) : null;
    const ring = this.ring ?? place?.outline;
    if (!place || !ring) return [];
    return ring.flatMap((at, i) => [
      { name: "midpoint", at: middle(at, ring[(i + 1) % ring.length]), label: t("Drag to add a corner"), data: { vertex: i + 1, add: 1 } },
      { name: "vertex", at, label: t("Drag to move the corner; double-click or Alt and click to take it out"), data: { vertex: i } },
    ]);
  }

  #onHandle(handle, point) {
    if (handle.classList.contains("turn")) return this.#turning(Number(handle.dataset.row));
    if (handle.classList.contains("picture-turn")) return this.picture.turning();
    if (handle.classList.contains("vertex") && point.alt) return { click: () => this.removeVertex(handle) };
    return this.#bending(handle);
  }

  #turning(row) {
    const piece = this.model.pieces.get(row);
    let angle = piece.angle;
    return {
      drag: (point) => {
        const raw = direction([piece.x, piece.y], point.at);
        const step = point.alt || !this.snaps ? 1 : TURN_STEP;
        angle = ((Math.round(raw / step) * step) % 360 + 360) % 360;
        this.pieces.preview(new Map([[row, { ...piece, angle }]]));
        this.scene.drawFalls();
        this.showHandles();
        this.scene.sketch([], [{ at: [piece.x, piece.y], text: `${angle}°` }]);
      },
      drop: () => {
        this.edits.pose([{ row, angle }], t("turn"));
        this.say(t("{item}: angle {angle}°", { item: piece.item, angle }));
      },
    };
  }

  /** Move a corner of an outline, or make a new one of the middle of a side. */
  #bending(handle) {
    const row = this.store.selection.row;
    const at = Number(handle.dataset.vertex);
    const old = this.model.places.get(row).outline;
    const ring = handle.dataset.add ? [...old.slice(0, at), middle(old[at - 1], old[at % old.length]), ...old.slice(at)] : [...old];
    return {
      drag: (point) => {
        const found = this.snapDrawn(point, ring.at(at - 1), [row]);
        ring[at] = found.point;
        this.ring = ring;
        this.scene.sketch([{ name: "drawn", points: ring, isClosed: true }, ...found.guides.map((points) => ({ name: "guide", points }))],
          [{ at: found.point, text: shownLength(distance(ring.at(at - 1), found.point), this.model.unit) }]);
        this.showHandles();
      },
      drop: () => {
        this.ring = null;
        this.edits.outline(row, ring);
      },
    };
  }

  removeVertex(handle) {
    const row = this.store.selection.row;
    const ring = this.model.places.get(row)?.outline;
    if (!ring) return;
    if (ring.length <= 3) this.say(t("An outline needs three corners."));
    else this.edits.outline(row, ring.filter((_, i) => i !== Number(handle.dataset.vertex)));
  }
}
