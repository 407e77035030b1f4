// Tools that take points one after the other: measure; draw rooms, corridors, doors, stairs, exits and the ways between them.

import { ask } from "./messages.mjs";
import { distance, footOn, isInside, lineOf, middle, nearest, nearestWall, rectangle, roundTo } from "./plan_geometry.mjs";
import { DOOR, isPlaced, nameKey } from "./plan_model.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { t, tn } from "./texts.mjs";

const CLOSE_PX = 10;
const STEP = 0.1; // of the cross-hair [m]
const FINE = 0.01;
const CROSS_PX = 14;
export const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
export const WITH_WIDTH = ["door", "exit"];
const LEAST_SIDE = 0.3; // of a rectangle [m]
const WALL_PX = 24; // within which a door goes to a wall
const SIGN_PX = 14; // within which a click means the sign of a place
const LINE_PX = 8; // within which it means the middle of a segment
const MISSED_PX = 40; // up to which the pointer goes before what it missed is forgotten

/** The tools: names, which are those of their icons, keys, labels, and the sheets that they need. */
export const TOOLS = [
  ["select", "V", () => t("Select"), "Items"], ["measure", "M", () => t("Measure"), "Items"],
  ["room", "O", () => t("Room"), "Places"], ["corridor", "C", () => t("Corridor"), "Places"],
  ["door", "D", () => t("Door"), "Places"], ["stair", "S", () => t("Stair"), "Places"],
  ["exit", "E", () => t("Exit"), "Places"], ["way", "W", () => t("Way"), "Routes"],
];

/** A point follows the pointer, a press and release sets it; by keys a cross-hair is moved, and Enter sets the point. */
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
    this.isActive = false;
    this.cursor = null;
    this.clear();
  }

  clear() {
    this.points = [];
    this.pressed = null;
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
    this.#set(point);
  }

  #set(point) {
    this.add(this.snap(point), point);
    if (this.isActive) this.draw(this.snap(point), point);
  }

  snap(point) {
    return this.select.snapDrawn(point, this.points.at(-1) ?? null);
  }

  /** Escape takes the points back, and where there are none, leaves the tool. */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (event.key in ARROWS) return this.#step(ARROWS[event.key], event.shiftKey ? FINE : STEP), true;
    if (event.key === "Enter" && this.cursor) return this.#set(this.#aim()), true;
    return event.key === "Escape" && this.takeBack();
  }

  takeBack() {
    if (this.points.length === 0) return false;
    this.clear();
    return true;
  }

  #step([dx, dy], step) {
    const [x, y] = this.cursor ?? this.#pointer ?? this.viewport.centre;
    this.cursor = [roundTo(x + dx * step, step), roundTo(y + dy * step, step)];
    this.viewport.reveal(this.cursor);
    const found = this.snap(this.#aim());
    this.draw(found, this.#aim());
    this.say(this.model.shownAt(this.cursor) + (found.place ? `; ${found.place.place}` : ""));
  }

  /** The cross-hair as a point of the pointer; it stands where it was moved to, so nothing snaps. */
  #aim() {
    return { at: this.cursor, px: this.viewport.toScreen(this.cursor), target: this.viewport.svg, alt: true };
  }

  /** Draw lines and texts, with the cross-hair. */
  sketch(lines, texts, guides) {
    const [[x, y], r] = [this.cursor ?? [], CROSS_PX / this.viewport.scale];
    const cross = this.cursor ? [[[x - r, y], [x + r, y]], [[x, y - r], [x, y + r]]] : [];
    this.scene.sketch([...lines, ...cross.map((points) => ({ name: "cross-hair", points }))], texts, guides);
  }
}

export class MeasureTool extends PointsTool {
  name = "measure";
  dragsToo = true;

  help() {
    return t("Measure: click two points.");
  }

  #length = (ends) => this.model.shownLength(distance(...ends), 3);

  add({ point }) {
    if (this.points.length === 2) this.points = [];
    this.points.push(point);
    if (this.points.length === 2) this.say(t("Length {length}", { length: this.#length(this.points) }));
  }

  draw({ point, guides }) {
    const isDone = this.points.length === 2;
    const ends = isDone ? this.points : [...this.points, point];
    if (ends.length < 2) this.sketch([], [], guides);
    else this.sketch([{ name: "measured", points: ends, dots: true }], [{ at: middle(...ends), text: this.#length(ends) }], isDone ? [] : guides);
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
    return rectangle(this.snap(this.pressed).point, found.point);
  }

  up(point) {
    const ring = this.#rectangle(this.snap(point), point);
    if (!ring) return super.up(point);
    this.clear();
    return Math.min(distance(ring[0], ring[1]), distance(ring[1], ring[2])) >= LEAST_SIDE && this.#finish(ring);
  }

  #finish(ring) {
    this.clear();
    this.edits.addPlace(this.kindAt, ring);
    this.done();
  }

  add({ point }, raw) {
    const [first] = this.points;
    const isLast = this.cursor && this.points.length && distance(this.points.at(-1), raw.at) <= FINE / 2; // Enter twice
    if (this.points.length >= 3 && (isLast || distance(first, raw.at) * this.viewport.scale < CLOSE_PX)) this.double();
    else if (!this.points.length || distance(this.points.at(-1), point) > 0.02) this.points.push(point);
  }

  double() {
    if (this.points.length >= 3) this.#finish(this.points);
  }

  key(event) {
    if (event.key === "Enter" && this.points.length && !this.cursor) return this.double(), true;
    if (event.key === "Backspace" && this.points.length) return this.points.pop(), true;
    return super.key(event);
  }

  draw({ point, guides }, raw) {
    const before = this.points.at(-1);
    const ring = this.#rectangle({ point }, raw);
    const length = (a, b) => this.model.shownLength(distance(a, b));
    const text = ring ? `${length(ring[0], ring[1])} × ${length(ring[1], ring[2])}` : before && length(before, point);
    const points = ring ?? [...this.points, point];
    this.sketch([{ name: "drawn", points, dots: true, isClosed: points.length > 2 }], text ? [{ at: point, text }] : [], guides);
  }
}

/** A door, a stair or an exit: one click; doors and exits go to the nearest wall, as wide as the toolbar says. */
export class PointTool extends PointsTool {
  width = null; // [m]

  help() {
    return this.hasWidth ? t("Click a wall where it is; with Alt it may stand anywhere.") : t("Click where it is.");
  }

  snap(point) {
    const wall = this.hasWidth && !point.alt ? nearestWall(point.at, this.model.walls, WALL_PX / this.viewport.scale) : null;
    return wall ? { point: wall.point, guides: [[wall.a, wall.b]], wall } : super.snap(point);
  }

  add({ point }) {
    this.edits.addPlace(this.kindAt, null, point, this.hasWidth ? this.width : null);
    this.done();
  }

  draw({ point: [x, y], wall, guides }) {
    const [dx, dy] = (wall?.d ?? [0, 0]).map((one) => (one * (this.width ?? DOOR)) / 2);
    this.sketch([{ name: "drawn door", points: [[x - dx, y - dy], [x + dx, y + dy]], dots: true }], [], guides);
  }
}

/** Ways, the segments of routes, from place to place; a click on one splits it where another begins or ends. */
export class WayTool extends PointsTool {
  name = "way";
  route = "";
  #from = null;
  #missed = null;

  help() {
    return t("Click a room, corridor, door, stair or exit, then the next: each click adds a way. A click on a way splits it. Escape leaves.");
  }

  enter() {
    if (!this.route.trim()) this.nextRoute();
    super.enter();
  }

  leave() {
    this.#from = this.#missed = null;
    super.leave();
  }

  takeBack() {
    if (!this.#from) return false;
    this.leave();
    return (this.isActive = true);
  }

  /** What lies at a point: the sign of a place, else a segment, else the room around it. */
  snap({ target, at }) {
    const { model, viewport: { scale } } = this;
    const places = [...model.places.values()];
    const sign = nearest(places.filter(isPlaced).map((place) => ({ place, off: distance([place.x, place.y], at) })), SIGN_PX / scale);
    if (sign) return { point: at, place: sign.place };
    const lines = this.scene.showsRoutes ? [...model.segments.values()].filter((one) => one.points.length === 2) : [];
    const found = nearest(lines.map((segment) => ({ segment, ...footOn(at, lineOf(...segment.points)) })), LINE_PX / scale);
    const row = Number(target.closest?.("[data-place]")?.dataset.place ?? 0);
    const place = model.places.get(row) ?? model.outlined.find((one) => isInside(at, one.outline)) ?? null;
    return { point: found?.point ?? at, segment: found?.segment, place };
  }

  add({ point, place, segment }) {
    this.#missed = null;
    if (segment) this.#offerSplit(segment, point, place);
    else if (place && isPlaced(place)) this.#connect(place);
    else {
      const text = place ? t("{place} has no X and Y yet: fill them in first.", { place: place.place }) : t("Click a room, corridor, door, stair or exit.");
      this.#missed = { at: point, text };
      this.say(text);
    }
  }

  #connect(place) {
    const from = this.#from;
    this.#from = place;
    this.say(t("From {place}", { place: place.place }));
    if (from && from.row !== place.row) this.edits.addSegment(this.route.trim() || this.nextRoute(), from, place);
  }

  async #offerSplit(segment, point, place) {
    const question = [t("Split {way} here? It becomes two ways with a junction between them.", { way: `${segment.route}, ${segment.segment}` }), this.#keptPieces(segment)];
    const room = place && isPlaced(place) ? [[place.place, "room"]] : [];
    const answer = await ask(question.filter(Boolean).join(" "), [[t("Split it here"), "split"], ...room, [t("Cancel"), null]]);
    this.viewport.svg.focus({ preventScroll: true });
    const chosen = answer === "split" ? this.edits.splitSegment(segment.row, point) : answer === "room" ? place : null;
    if (chosen) this.#connect(chosen);
  }

  /** Pieces that name the segment in the sheet stay with its first part: that is said. */
  #keptPieces(segment) {
    const isOwn = (row) => ["route", "segment"].every((field) => nameKey(this.model.text("Items", row, field)) === nameKey(segment[field]));
    const n = (this.store.sheet("Items")?.rowNumbers ?? []).filter(isOwn).length;
    return n ? tn("{n} piece that names it in the sheet Items stays with the first part.", "{n} pieces that name it in the sheet Items stay with the first part.", n) : "";
  }

  /** The first name for a route that is free. */
  nextRoute() {
    const names = new Set(this.store.sheet("Routes").names("route"));
    for (let n = 1; ; n++) {
      const name = t("Route {n}", { n });
      if (!names.has(name)) return (this.route = name);
    }
  }

  draw({ point, place, segment }) {
    const end = segment ? point : place && isPlaced(place) ? [place.x, place.y] : null;
    const lines = end ? [{ name: "drawn", points: [end, end], dots: true }] : [];
    if (this.#from) lines.push({ name: "drawn", points: [[this.#from.x, this.#from.y], end ?? point] });
    if (this.#missed && distance(this.#missed.at, point) * this.viewport.scale > MISSED_PX) this.#missed = null;
    const text = segment ? t("Split {way}", { way: segment.segment }) : place?.place;
    this.sketch(lines, this.#missed ? [this.#missed] : end ? [{ at: end, text }] : []);
  }
}
