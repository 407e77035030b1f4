// The drawing: picture, grid, rooms, bands of segments, what falling pieces cover, pieces, signs, handles, guides.

import { svg } from "./elements.mjs";
import { PieceLayer } from "./plan_pieces.mjs";
import { boxOf, direction, moveRing, turnPoint } from "./plan_geometry.mjs";
import { DOOR } from "./plan_model.mjs";
import { nearestWall, sidesOf } from "./plan_snap.mjs";
import { number, t } from "./texts.mjs";

const SIGNS = { open: "✓", doubtful: "≈", not_known: "?", blocked: "✕" };
const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500];
const GRID_PX = 22; // least distance of grid lines
const BAR_PX = 70; // least length of the scale bar
const NAMED_FROM = 55; // pixels a metre from which points of routes show their names
const TINY_TO = 18; // pixels a metre below which a piece is a fleck of its class
const LETTER_PX = 6.2;
const ON_WALL = 0.15; // distance from a wall up to which a door is one of it [m]
const SIGN_PX = 46; // length of an open segment from which its sign is drawn
const MARKS = {
  exit: "M-7 -3H0V-7L8 0L0 7V3H-7Z", stair: "M-7 6V2.5H-3.5V-1H0V-4.5H3.5V-8H7V6Z", door: "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z",
  room: "M-3 0A3 3 0 1 0 3 0A3 3 0 1 0 -3 0Z", corridor: "M-3 0A3 3 0 1 0 3 0A3 3 0 1 0 -3 0Z",
};

const path = (ring, isClosed = true) => ring.map(([x, y], i) => `${i ? "L" : "M"}${x} ${-y}`).join("") + (isClosed ? "Z" : "");

/** Question marks on both sides of what a piece of unknown width covers. */
function markSides(ring, { x, y, angle }) {
  const [u0, v0, u1, v1] = boxOf(ring.map((one) => turnPoint([one[0] - x, one[1] - y], -angle)));
  return [v0, v1].map((v) => {
    const [dx, dy] = turnPoint([(u0 + u1) / 2, v], angle);
    return svg("g", { transform: `translate(${x + dx} ${-(y + dy)})` }, svg("text", { class: "px unknown", text: "?" }));
  });
}

/** How a state is called in the style sheet: as the reports, with what stands in the way already apart. */
const stateClass = (state) => (state ? `state-${state.standing ? "standing" : state.state.replace("_", "-")}` : "state-none");
const signOf = (state) => (state ? SIGNS[state.state] ?? "?" : "");

export class Scene {
  falls = "selected"; // selected, all, none
  opacity = 0.6;
  showsRoutes = true;
  #pictureShown = null;
  #frame = null;

  constructor(model, store, viewport) {
    Object.assign(this, { model, store, viewport });
    this.pieces = new PieceLayer(model, store);
    const layer = (name, props) => (this[name] = svg("g", { class: name, ...props }));
    viewport.world.append(
      (this.image = svg("image", { class: "picture", preserveAspectRatio: "none", hidden: "" })), layer("grid", { "aria-hidden": "true" }),
      layer("rooms"), layer("bands"), layer("fallen", { "aria-hidden": "true" }), this.pieces.node, layer("marks"), layer("handles"), layer("draft", { "aria-hidden": "true" }),
    );
    this.hatch = viewport.svg.querySelector("pattern");
    viewport.addEventListener("view", () => (this.#frame ??= requestAnimationFrame(() => this.#onView())));
  }

  #onView() {
    this.#frame = null;
    const { scale } = this.viewport;
    this.hatch.setAttribute("patternTransform", `scale(${1 / scale})`);
    if (scale !== this.pieces.scale) {
      this.pieces.zoom(scale);
      this.drawRoutes();
    }
    this.viewport.svg.classList.toggle("far", scale < NAMED_FROM);
    this.viewport.svg.classList.toggle("tiny", scale < TINY_TO);
    this.#drawGrid();
  }

  draw() {
    this.drawPicture();
    this.drawRoutes();
    this.pieces.draw();
    this.drawFalls();
  }

  // ---- ground

  #drawGrid() {
    const { viewport } = this;
    const { unit, factor } = this.model.unit;
    const [w, h] = viewport.size;
    const stepFor = (px) => (STEPS.find((one) => one * factor * viewport.scale >= px) ?? STEPS.at(-1)) * factor;
    const step = stepFor(GRID_PX);
    const [[x0, y1], [x1, y0]] = [viewport.toWorld([0, 0]), viewport.toWorld([w, h])];
    const lines = [[], []];
    const add = (i, d) => lines[i % 5 === 0 ? 1 : 0].push(d);
    for (let i = Math.ceil(x0 / step); i <= x1 / step; i++) add(i, `M${(i * step).toFixed(4)} ${-y0}V${-y1}`);
    for (let i = Math.ceil(y0 / step); i <= y1 / step; i++) add(i, `M${x0} ${(-i * step).toFixed(4)}H${x1}`);
    this.grid.replaceChildren(svg("path", { d: lines[0].join("") }), svg("path", { class: "fifth", d: lines[1].join("") }));
    const bar = stepFor(BAR_PX);
    this.bar = { px: bar * viewport.scale, text: `${number(Number((bar / factor).toPrecision(6)))} ${unit}` };
    this.onScale?.(this.bar);
  }

  /** The picture where it lies: where it is placed, else fitted to the frame, by the shape that it has. */
  drawPicture(placement = null) {
    const { picture } = this.model.plan ?? {};
    const at = placement ?? this.placement();
    this.image.toggleAttribute("hidden", !at);
    if (!at) return;
    if (this.#pictureShown !== picture.url) this.image.setAttribute("href", (this.#pictureShown = picture.url));
    const height = at.width * picture.aspect;
    const values = { x: 0, y: -height, width: at.width, height, transform: `translate(${at.left} ${-at.bottom}) rotate(${-at.turn})`, opacity: this.opacity };
    for (const [name, value] of Object.entries(values)) this.image.setAttribute(name, value);
  }

  /** Where the picture lies: {left, bottom, width, turn}; null where there is none. */
  placement() {
    const { picture, frame } = this.model.plan ?? {};
    if (!picture) return null;
    if (picture.placed) return { left: picture.left, bottom: picture.bottom, width: picture.width, turn: picture.turn };
    const [x0, y0, x1, y1] = frame;
    const width = picture.width ?? Math.min(x1 - x0, (y1 - y0) / picture.aspect);
    return { left: picture.left ?? x0, bottom: picture.bottom ?? y0, width, turn: picture.turn ?? 0 };
  }

  // ---- routes

  drawRoutes() {
    const { model } = this;
    if (!model.plan) return;
    const rooms = [...model.places.values()].filter((one) => one.outline);
    const walls = rooms.flatMap((one) => sidesOf(one.outline));
    this.rooms.replaceChildren(...rooms.map((one) => this.#room(one)), ...[...model.places.values()].map((one) => this.#opening(one, walls)).filter(Boolean));
    const segments = this.showsRoutes ? [...model.segments.values()] : [];
    this.bands.replaceChildren(...segments.map((one) => this.#band(one)).filter(Boolean));
    const marks = this.showsRoutes ? [...model.places.values()].filter((one) => one.x !== null && one.y !== null) : [];
    this.marks.replaceChildren(...segments.map((one) => this.#segmentSign(one)).filter(Boolean), ...marks.map((one) => this.#mark(one)));
    this.viewport.svg.classList.toggle("states-old", model.routesOld);
  }

  #isSelected(sheet, row) {
    const { selection } = this.store;
    return selection.sheet === sheet && (selection.rows.includes(row) || selection.row === row);
  }

  #title(name, state) {
    return svg("title", { text: state ? [name, state.word, state.detail].filter(Boolean).join(": ") : name });
  }

  #room(place) {
    const state = this.model.stateOf("place", place.row);
    const classes = ["room", stateClass(state), this.#isSelected("Places", place.row) && "selected"].filter(Boolean).join(" ");
    return svg("g", { class: classes, "data-place": place.row }, this.#title(place.place, state), svg("path", { d: path(place.outline) }));
  }

  /** A door or an exit on a wall: a gap as wide as it. */
  #opening(place, walls) {
    const { x, y, kind } = place;
    const wall = (kind === "door" || kind === "exit") && x !== null && y !== null && nearestWall([x, y], walls, ON_WALL);
    if (!wall) return null;
    const [half, jamb] = [(this.model.widthOf(place) ?? DOOR) / 2, 5 / this.viewport.scale];
    return svg("g", { class: "opening", transform: `translate(${x} ${-y}) rotate(${-direction(wall.a, wall.b)})`, "aria-hidden": "true" },
      svg("path", { class: "gap", d: `M${-half} 0H${half}` }), svg("path", { d: `M${-half} ${-jamb}V${jamb}M${half} ${-jamb}V${jamb}` }));
  }

  #band(segment) {
    const state = this.model.stateOf("segment", segment.row);
    if (segment.points.length < 2) return null;
    const classes = ["band", stateClass(state), this.#isSelected("Routes", segment.row) && "selected"].filter(Boolean).join(" ");
    const name = `${segment.route}, ${segment.segment}`;
    return svg("g", { class: classes, "data-segment": segment.row }, this.#title(name, state),
      segment.outline && svg("path", { class: "ground", d: path(segment.outline) }), svg("path", { class: "line", d: path(segment.points, false) }));
  }

  #segmentSign(segment) {
    const state = this.model.stateOf("segment", segment.row);
    if (!state || segment.points.length < 2) return null;
    const [[x0, y0], [x1, y1]] = segment.points;
    const length = Math.hypot(x1 - x0, y1 - y0) * this.viewport.scale;
    const isLong = length > (state.state === "open" ? SIGN_PX : 1);
    const held = state.word.includes("⚓") ? "⚓" : "";
    return isLong && svg("g", { class: `state-sign ${stateClass(state)}`, transform: `translate(${(x0 + x1) / 2} ${-(y0 + y1) / 2})`, "data-segment": segment.row, "aria-hidden": "true" },
      svg("g", { class: "px" }, svg("circle", { r: 8 }), svg("text", { text: signOf(state) }), held && svg("text", { class: "held", x: 15, text: held })));
  }

  #mark(place) {
    const state = this.model.stateOf("place", place.row);
    const isSelected = this.#isSelected("Places", place.row);
    const classes = ["mark", `mark-${place.kind || "point"}`, stateClass(state), isSelected && "selected"].filter(Boolean).join(" ");
    const sign = state && svg("g", { class: "state-sign", "aria-hidden": "true" }, svg("circle", { r: 8 }), svg("text", { text: signOf(state) }));
    return svg("g", { class: classes, transform: `translate(${place.x} ${-place.y})`, "data-place": place.row }, this.#title(place.place, state),
      svg("g", { class: "px" }, svg("circle", { class: "reach", r: 12 }), sign || svg("path", { d: MARKS[place.kind] ?? MARKS.corridor }), this.#name(place, isSelected)));
  }

  /** The name of a place; of a room or a corridor along it, and left out where there is no room for it. */
  #name({ place, outline }, isSelected) {
    const text = (props) => svg("text", { class: outline ? "place-name outlined" : "place-name", y: 18, text: place, ...props });
    if (!outline) return text();
    const [x0, y0, x1, y1] = boxOf(outline);
    const fits = (metres) => metres * this.viewport.scale >= place.length * LETTER_PX;
    return fits(x1 - x0) || isSelected ? text() : fits(y1 - y0) && text({ transform: "rotate(-90)" });
  }

  // ---- what pieces cover when they fall

  drawFalls() {
    const { pieces } = this;
    const rows = this.falls === "all" ? [...this.model.pieces.keys()] : this.falls === "none" ? [] : [...pieces.selected];
    const falls = rows.flatMap((row) => {
      const piece = this.model.pieces.get(row);
      const pose = pieces.pose(row);
      return piece && pose ? piece.fallen.map((ring) => [moveRing(ring, piece, pose), piece.missing.includes("width") && pose]) : [];
    });
    this.fallen.replaceChildren(...falls.flatMap(([ring, open]) => [svg("path", { d: path(ring) }), ...(open ? markSides(ring, open) : [])]));
  }

  // ---- drafts

  /** Draw guides and what is being drawn: [{class, points, isClosed}], and texts [{at, text}]. */
  sketch(lines = [], texts = []) {
    const drawn = lines.map(({ name, points, isClosed = false }) => svg("path", { class: name, d: path(points, isClosed) }));
    const dots = lines.filter((one) => one.dots).flatMap((one) => one.points).map(([x, y]) => svg("g", { transform: `translate(${x} ${-y})` }, svg("circle", { class: "px dot", r: 4 })));
    const words = texts.map(({ at, text }) => svg("g", { transform: `translate(${at[0]} ${-at[1]})` }, svg("text", { class: "px readout", y: -10, text })));
    this.draft.replaceChildren(...drawn, ...dots, ...words);
  }

  /** Handles: of the corners of a selected place, of turning a selected piece or the picture. */
  showHandles(handles) {
    const node = ({ name, at, label, data = {}, stem }) => svg("g", null,
      stem && svg("path", { class: "stem", d: path([stem, at], false) }),
      svg("g", { class: `handle ${name}`, transform: `translate(${at[0]} ${-at[1]})`, ...Object.fromEntries(Object.entries(data).map(([key, value]) => [`data-${key}`, value])) },
        svg("title", { text: label }), svg("circle", { class: "px reach", r: 12 }), svg("circle", { class: "px", r: name === "midpoint" ? 4 : 6 })));
    this.handles.replaceChildren(...handles.map(node));
  }

  legend() {
    return [["open", t("open")], ["doubtful", t("doubtful")], ["not-known", t("not known")], ["blocked", t("blocked")], ["standing", t("blocked as it stands")]]
      .map(([key, word]) => ({ css: `state-${key}`, sign: SIGNS[key.replace("-", "_")] ?? SIGNS.blocked, word }));
  }
}
