// Tools that take points one after the other: measure, draw a place, draw a segment.

import { distance, isInside } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { t } from "./texts.mjs";

const CLOSE_PX = 10;
const OUTLINED = 2; // kinds from this on are points: door, stair, exit

/** What all of them share: a point follows the pointer, a press and release at the same place sets it. */
class PointsTool {
  takesTouch = true;
  points = [];
  #pressed = null;

  constructor(parts) {
    Object.assign(this, parts);
  }

  enter() {
    this.points = [];
    this.say(this.help());
  }

  leave() {
    this.points = [];
    this.scene.sketch();
  }

  down(point) {
    this.#pressed = point;
  }

  cancel() {
    this.#pressed = null;
  }

  move(point) {
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

  /** Escape takes the points back, and where there are none, leaves the tool. */
  key(event) {
    if (event.key !== "Escape") return false;
    if (this.points.length === 0) return false;
    this.points = [];
    this.scene.sketch();
    return true;
  }

  guides(found) {
    return found.guides.map((points) => ({ name: "guide", points }));
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
    if (first && this.points.length >= 3 && distance(first, raw.at) * this.viewport.scale < CLOSE_PX) this.close();
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
    if (event.key === "Enter" && this.points.length) return this.close(), true;
    if (event.key === "Backspace" && this.points.length) return this.points.pop(), true;
    return super.key(event);
  }

  draw(found) {
    const before = this.points.at(-1);
    const text = before ? [{ at: found.point, text: shownLength(distance(before, found.point), this.model.unit) }] : [];
    this.scene.sketch([{ name: "drawn", points: [...this.points, found.point], dots: true, isClosed: this.points.length > 1 }, ...this.guides(found)], text);
  }
}

export class SegmentTool extends PointsTool {
  name = "segment";
  route = "";
  #from = null;

  help() {
    return t("Click a place, then the next: each click adds a segment of the route. Escape leaves.");
  }

  leave() {
    this.#from = null;
    super.leave();
  }

  key(event) {
    if (event.key !== "Escape" || !this.#from) return false;
    this.leave();
    return true;
  }

  snap(point) {
    return { point: point.at, place: this.#placeAt(point), guides: [] };
  }

  /** The place at a point: its sign, else the nearest sign, else the room around it. */
  #placeAt({ target, at }) {
    const row = Number(target.closest?.("[data-place]")?.dataset.place ?? 0);
    const places = [...this.model.places.values()].filter((one) => one.x !== null && one.y !== null);
    const near = places.map((one) => [distance([one.x, one.y], at), one]).sort((a, b) => a[0] - b[0])[0];
    if (near && near[0] * this.viewport.scale < 14) return near[1];
    const found = this.model.places.get(row) ?? places.find((one) => one.outline && isInside(at, one.outline));
    return found && found.x !== null && found.y !== null ? found : null;
  }

  add({ place }) {
    if (!place) {
      this.say(t("There is no place here: draw rooms, doors and exits first, with the tool Place."));
      return;
    }
    const from = this.#from;
    this.#from = place;
    this.say(t("From {place}", { place: place.place }));
    if (from && from.row !== place.row) this.edits.addSegment(this.route || this.nextRoute(), from.place, place.place);
  }

  /** The first name for a route that is free. */
  nextRoute() {
    const names = new Set(this.store.sheet("Routes").names("route"));
    for (let n = 1; ; n++) {
      const name = t("Route {n}", { n });
      if (!names.has(name)) return (this.route = name);
    }
  }

  draw({ point, place }) {
    const to = place ? [place.x, place.y] : point;
    const lines = place ? [{ name: "drawn", points: [to, to], dots: true }] : [];
    if (this.#from) lines.push({ name: "drawn", points: [[this.#from.x, this.#from.y], to] });
    this.scene.sketch(lines, place ? [{ at: to, text: place.place }] : []);
  }
}
