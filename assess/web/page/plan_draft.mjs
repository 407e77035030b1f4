// Tools that take points one after the other: what they share, measure, draw rooms and corridors, doors, stairs and exits.

import { distance, roundTo } from "./plan_geometry.mjs";
import { DOOR } from "./plan_model.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { nearestWall, sidesOf } from "./plan_snap.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { t } from "./texts.mjs";

const CLOSE_PX = 10;
const STEP = 0.1; // of the cross-hair [m]
const FINE = 0.01;
const CROSS_PX = 14;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const LEAST_SIDE = 0.3; // of a rectangle [m]
const WALL_PX = 24; // within which a door goes to a wall

/**
 * What all of them share: a point follows the pointer, a press and release at the same place sets it. By keys a cross-hair
 * is moved, and Enter sets the point.
 */
export class PointsTool {
  takesTouch = true;
  points = [];
  cursor = null; // the cross-hair, while it is moved by keys
  pressed = null; // where the mouse was pressed
  #pointer = null;

  constructor(parts) {
    Object.assign(this, parts);
  }

  enter() {
    this.points = [];
    this.isActive = true;
    this.#pointer = null;
    this.say(`${this.help()} ${t("Arrow keys and Enter set points, too.")}`);
  }

  leave() {
    this.points = [];
    this.isActive = false;
    this.pressed = this.cursor = null;
    this.scene.sketch();
  }

  down(point) {
    this.pressed = point;
  }

  cancel() {
    this.pressed = null;
  }

  move(point) {
    this.#pointer = point.at;
    this.cursor = null;
    this.draw(this.snap(point), point);
  }

  up(point) {
    const from = this.pressed;
    this.pressed = null;
    if (from && isDrag(from.px, point.px) && this.dragsToo) this.add(this.snap(from), from);
    this.add(this.snap(point), point);
    if (this.isActive) this.draw(this.snap(point), point);
  }

  snap(point) {
    return this.select.snapDrawn(point, this.points.at(-1) ?? null);
  }

  /** Arrow keys move the cross-hair, Enter sets a point there. Escape takes the points back, and where there are none, leaves the tool. */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (event.key in ARROWS) return this.#step(ARROWS[event.key], event.shiftKey ? FINE : STEP), true;
    if (event.key === "Enter" && this.cursor) return this.#set(), true;
    return event.key === "Escape" && this.takeBack();
  }

  takeBack() {
    if (this.points.length === 0) return false;
    this.points = [];
    this.scene.sketch();
    return true;
  }

  #step([dx, dy], step) {
    const [x, y] = this.cursor ?? this.#pointer ?? this.viewport.centre;
    this.cursor = [roundTo(x + dx * step, step), roundTo(y + dy * step, step)];
    this.viewport.reveal(this.cursor);
    const found = this.snap(this.#aim());
    this.draw(found, this.#aim());
    const { unit } = this.model;
    const place = found.place ? `; ${found.place.place}` : "";
    this.say(t("X {x}, Y {y}", { x: shownLength(this.cursor[0], unit), y: shownLength(this.cursor[1], unit) }) + place);
  }

  /** The cross-hair as a point of the pointer; it stands where it was moved to, so nothing snaps. */
  #aim() {
    return { at: this.cursor, px: this.viewport.toScreen(this.cursor), target: this.viewport.svg, alt: true };
  }

  #set() {
    const aim = this.#aim();
    this.add(this.snap(aim), aim);
    if (this.cursor) this.draw(this.snap(aim), aim);
  }

  guides(found) {
    return [...found.guides.map((points) => ({ name: "guide", points })), ...this.cross()];
  }

  cross() {
    if (!this.cursor) return [];
    const [[x, y], r] = [this.cursor, CROSS_PX / this.viewport.scale];
    return [{ name: "cross-hair", points: [[x - r, y], [x + r, y]] }, { name: "cross-hair", points: [[x, y - r], [x, y + r]] }];
  }
}

export class MeasureTool extends PointsTool {
  name = "measure";
  dragsToo = true;

  help() {
    return t("Measure: click two points.");
  }

  add({ point }) {
    if (this.points.length === 2) this.points = [];
    this.points.push(point);
    if (this.points.length === 2) this.say(t("Length {length}", { length: shownLength(distance(...this.points), this.model.unit, 3) }));
  }

  draw(found) {
    const ends = this.points.length === 2 ? this.points : [...this.points, found.point];
    if (ends.length < 2) {
      this.scene.sketch(this.guides(found));
      return;
    }
    const text = shownLength(distance(...ends), this.model.unit, 3);
    this.scene.sketch([{ name: "measured", points: ends, dots: true }, ...(this.points.length === 2 ? [] : this.guides(found))], [{ at: [(ends[0][0] + ends[1][0]) / 2, (ends[0][1] + ends[1][1]) / 2], text }]);
  }
}

/** A room or a corridor: a rectangle that is dragged, or its corners one after the other. */
export class OutlineTool extends PointsTool {
  help() {
    return t("Drag a rectangle, or click the corners; Enter, a double click or a click on the first corner closes. Escape leaves.");
  }

  /** While the mouse is held: the corners of the rectangle from where it was pressed. */
  #rectangle(found, { px }) {
    if (!this.pressed || this.points.length || !isDrag(this.pressed.px, px)) return null;
    const [[a, b], [c, d]] = [this.snap(this.pressed).point, found.point];
    return [[a, b], [c, b], [c, d], [a, d]];
  }

  up(point) {
    const ring = this.#rectangle(this.snap(point), point);
    if (!ring) return super.up(point);
    this.cancel();
    return Math.min(distance(ring[0], ring[1]), distance(ring[1], ring[2])) >= LEAST_SIDE ? this.#finish(ring) : this.scene.sketch();
  }

  #finish(ring) {
    this.points = [];
    this.scene.sketch();
    this.edits.addPlace(this.kindAt, ring);
    this.done();
  }

  add({ point }, raw) {
    const [first] = this.points;
    const isLast = this.cursor && this.points.length && distance(this.points.at(-1), raw.at) <= FINE / 2; // Enter twice
    if (this.points.length >= 3 && (isLast || distance(first, raw.at) * this.viewport.scale < CLOSE_PX)) this.close();
    else if (!this.points.length || distance(this.points.at(-1), point) > 0.02) this.points.push(point);
  }

  double() {
    this.close();
  }

  close() {
    if (this.points.length >= 3) this.#finish(this.points);
  }

  key(event) {
    if (event.key === "Enter" && this.points.length && !this.cursor) return this.close(), true;
    if (event.key === "Backspace" && this.points.length) return this.points.pop(), true;
    return super.key(event);
  }

  draw(found, point) {
    const before = this.points.at(-1);
    const ring = this.#rectangle(found, point);
    const length = (a, b) => shownLength(distance(a, b), this.model.unit);
    const text = ring ? `${length(ring[0], ring[1])} × ${length(ring[1], ring[2])}` : before && length(before, found.point);
    this.scene.sketch([{ name: "drawn", points: ring ?? [...this.points, found.point], dots: true, isClosed: Boolean(ring) || this.points.length > 1 }, ...this.guides(found)], text ? [{ at: found.point, text }] : []);
  }
}

/** A door, a stair or an exit: one click; doors and exits go to the nearest wall, as wide as the toolbar says. */
export class PointTool extends PointsTool {
  width = null; // [m]

  help() {
    return this.hasWidth ? t("Click a wall where it is; with Alt it may stand anywhere.") : t("Click where it is.");
  }

  snap(point) {
    const walls = [...this.model.places.values()].filter((one) => one.outline).flatMap((one) => sidesOf(one.outline));
    const wall = this.hasWidth && !point.alt ? nearestWall(point.at, walls, WALL_PX / this.viewport.scale) : null;
    return wall ? { point: wall.point, guides: [[wall.a, wall.b]], wall } : super.snap(point);
  }

  add({ point }) {
    this.edits.addPlace(this.kindAt, null, point, this.hasWidth ? this.width : null);
    this.done();
  }

  draw({ point: [x, y], wall, ...found }) {
    const half = (this.width ?? DOOR) / 2;
    const [dx, dy] = wall && this.hasWidth ? wall.d.map((one) => one * half) : [0, 0];
    this.scene.sketch([...this.guides(found), { name: "drawn door", points: [[x - dx, y - dy], [x + dx, y + dy]], dots: true }]);
  }
}
