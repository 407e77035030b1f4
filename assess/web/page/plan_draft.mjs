// Tools that take points one after the other: what they share, measure, draw a place.

import { distance, roundTo } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { t } from "./texts.mjs";

const CLOSE_PX = 10;
const STEP = 0.1; // of the cross-hair [m]
const FINE = 0.01;
const CROSS_PX = 14;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const OUTLINED = 2; // kinds from this on are points: door, stair, exit

/**
 * What all of them share: a point follows the pointer, a press and release at the same place sets it. By keys a cross-hair
 * is moved, and Enter sets the point.
 */
export class PointsTool {
  takesTouch = true;
  points = [];
  cursor = null; // the cross-hair, while it is moved by keys
  #pointer = null;
  #pressed = null;

  constructor(parts) {
    Object.assign(this, parts);
  }

  enter() {
    this.points = [];
    this.#pointer = null;
    this.say(`${this.help()} ${t("Arrow keys and Enter set points, too.")}`);
  }

  leave() {
    this.points = [];
    this.cursor = null;
    this.scene.sketch();
  }

  down(point) {
    this.#pressed = point;
  }

  cancel() {
    this.#pressed = null;
  }

  move(point) {
    this.#pointer = point.at;
    this.cursor = null;
    this.draw(this.snap(point));
  }

  up(point) {
    const from = this.#pressed;
    this.#pressed = null;
    if (from && isDrag(from.px, point.px) && this.dragsToo) this.add(this.snap(from), from);
    this.add(this.snap(point), point);
    this.draw(this.snap(point));
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
    this.draw(found);
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
    if (this.cursor) this.draw(this.snap(aim));
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

export class PlaceTool extends PointsTool {
  name = "place";
  kindAt = 0;

  get isPoint() {
    return this.kindAt >= OUTLINED;
  }

  help() {
    return this.isPoint ? t("Click where it is.") : t("Click the corners; Enter, a double click or a click on the first corner closes. Escape leaves.");
  }

  add({ point }, raw) {
    if (this.isPoint) {
      this.edits.addPlace(this.kindAt, null, point);
      this.done();
      return;
    }
    const [first] = this.points;
    const isLast = this.cursor && this.points.length && distance(this.points.at(-1), raw.at) <= FINE / 2; // Enter twice
    if (this.points.length >= 3 && (isLast || distance(first, raw.at) * this.viewport.scale < CLOSE_PX)) this.close();
    else if (!this.points.length || distance(this.points.at(-1), point) > 0.02) this.points.push(point);
  }

  double() {
    this.close();
  }

  close() {
    if (this.points.length < 3) return;
    const ring = this.points;
    this.points = [];
    this.scene.sketch();
    this.edits.addPlace(this.kindAt, ring);
    this.done();
  }

  key(event) {
    if (event.key === "Enter" && this.points.length && !this.cursor) return this.close(), true;
    if (event.key === "Backspace" && this.points.length) return this.points.pop(), true;
    return super.key(event);
  }

  draw(found) {
    const before = this.points.at(-1);
    const text = before ? [{ at: found.point, text: shownLength(distance(before, found.point), this.model.unit) }] : [];
    this.scene.sketch([{ name: "drawn", points: [...this.points, found.point], dots: true, isClosed: this.points.length > 1 }, ...this.guides(found)], text);
  }
}
