// The tool that draws ways, the segments of routes, from place to place, and splits one where another begins or ends on it.

import { ask } from "./messages.mjs";
import { PointsTool } from "./plan_draft.mjs";
import { distance, isInside } from "./plan_geometry.mjs";
import { nameKey } from "./plan_model.mjs";
import { t, tn } from "./texts.mjs";

const SIGN_PX = 14; // within which a click means the sign of a place
const LINE_PX = 8; // within which it means the middle of a segment
const MISSED_PX = 40; // up to which the pointer goes before what it missed is forgotten

const isPlaced = (one) => one.x !== null && one.y !== null;

export class WayTool extends PointsTool {
  name = "way";
  route = "";
  #from = null;
  #missed = null;

  help() {
    return t("Click a room, corridor, door, stair or exit, then the next: each click adds a way. A click on a way splits it. Escape leaves.");
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
    const places = [...this.model.places.values()];
    const near = nearest(places.filter(isPlaced).map((one) => [distance([one.x, one.y], at), one]));
    const found = { point: at, guides: [] };
    if (near && near[0] * this.viewport.scale < SIGN_PX) return { ...found, place: near[1] };
    const row = Number(target.closest?.("[data-place]")?.dataset.place ?? 0);
    const place = this.model.places.get(row) ?? places.find((one) => one.outline && isInside(at, one.outline)) ?? null;
    return { ...found, ...this.#segmentAt(at), place };
  }

  #segmentAt(at) {
    const lines = this.scene.showsRoutes ? [...this.model.segments.values()].filter((one) => one.points.length === 2) : [];
    const found = nearest(lines.map((segment) => {
      const foot = footOn(segment.points, at);
      return [distance(foot, at), { segment, foot }];
    }));
    return found && found[0] * this.viewport.scale < LINE_PX ? found[1] : null;
  }

  add(found) {
    const { point, place, segment } = found;
    this.#missed = null;
    if (segment) this.#offerSplit(found);
    else if (place && isPlaced(place)) this.#connect(place);
    else {
      const text = place ? t("{place} has no X and Y yet: fill them in first.", { place: place.place }) : t("Click a room, corridor, door, stair or exit.");
      this.#missed = { point, text };
      this.say(text);
    }
  }

  #connect(place) {
    const from = this.#from;
    this.#from = place;
    this.say(t("From {place}", { place: place.place }));
    if (from && from.row !== place.row) this.edits.addSegment(this.route || this.nextRoute(), from, place);
  }

  async #offerSplit({ segment, foot, place }) {
    const question = [t("Split {way} here? It becomes two ways with a junction between them.", { way: `${segment.route}, ${segment.segment}` }), this.#keptPieces(segment)];
    const room = place && isPlaced(place) ? [[place.place, "room"]] : [];
    const answer = await ask(question.filter(Boolean).join(" "), [[t("Split it here"), "split"], ...room, [t("Cancel"), null]]);
    this.viewport.svg.focus({ preventScroll: true });
    const chosen = answer === "split" ? this.edits.splitSegment(segment.row, foot) : answer === "room" ? place : null;
    if (chosen) this.#connect(chosen);
  }

  /** Pieces that name the segment in the sheet stay with its first part: that is said. */
  #keptPieces({ route, segment }) {
    const own = (row, field) => nameKey(this.model.text("Items", row, field));
    const n = (this.store.sheet("Items")?.rowNumbers ?? []).filter((row) => own(row, "route") === nameKey(route) && own(row, "segment") === nameKey(segment)).length;
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

  draw({ point, place, segment, foot }) {
    const end = segment ? foot : place && isPlaced(place) ? [place.x, place.y] : null;
    const to = end ?? point;
    const lines = [...(end ? [{ name: "drawn", points: [to, to], dots: true }] : []), ...this.cross()];
    if (this.#from) lines.push({ name: "drawn", points: [[this.#from.x, this.#from.y], to] });
    if (this.#missed && distance(this.#missed.point, point) * this.viewport.scale > MISSED_PX) this.#missed = null;
    const missed = this.#missed && { at: this.#missed.point, text: this.#missed.text };
    const text = segment ? t("Split {way}", { way: segment.segment }) : place?.place;
    this.scene.sketch(lines, missed ? [missed] : end ? [{ at: to, text }] : []);
  }
}

const nearest = (all) => all.sort((a, b) => a[0] - b[0])[0];

/** The point of a straight line that is nearest to another. */
function footOn([[x0, y0], [x1, y1]], [x, y]) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const share = ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy || 1);
  const k = Math.min(1, Math.max(0, share));
  return [x0 + k * dx, y0 + k * dy];
}
