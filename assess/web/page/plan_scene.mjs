// The drawing: picture, grid, rooms, bands of segments, what falling pieces cover, pieces, signs, handles, guides.

import { svg } from "./elements.mjs";
import { PieceLayer } from "./plan_pieces.mjs";
import { boxOf, direction, distance, middle, moveRing, nearestWall, turnPoint } from "./plan_geometry.mjs";
import { DOOR, STATES, isPlaced, stateCss } from "./plan_model.mjs";
import { number } from "./texts.mjs";

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
};
const DOT = "M-3 0A3 3 0 1 0 3 0A3 3 0 1 0 -3 0Z"; // of all others

const path = (ring, isClosed = true) => ring.map(([x, y], i) => `${i ? "L" : "M"}${x} ${-y}`).join("") + (isClosed ? "Z" : "");

/** A group at a point, with attributes. */
const groupAt = ([x, y], props, ...children) => svg("g", { transform: `translate(${x} ${-y})`, ...props }, ...children);

/** Question marks on both sides of what a piece of unknown width covers. */
function markSides(ring, { x, y, angle }) {
  const [u0, v0, u1, v1] = boxOf(ring.map((one) => turnPoint([one[0] - x, one[1] - y], -angle)));
  return [v0, v1].map((v) => groupAt(turnPoint([(u0 + u1) / 2, v], angle, [x, y]), null, svg("text", { class: "px unknown", text: "?" })));
}

const signOf = (state) => svg("text", { text: STATES[state.state] ?? "?" });

export class Scene {
  falls = "selected"; // selected, all, none
  opacity = 0.6;
  showsRoutes = true;
  #pictureShown = null;
  #frame = null;

  constructor({ model, store, viewport, bar }) {
    Object.assign(this, { model, store, viewport, bar, pieces: new PieceLayer(model, store) });
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
    this.bar.style.width = `${bar * viewport.scale}px`;
    this.bar.textContent = `${number(Number((bar / factor).toPrecision(6)))} ${unit}`;
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
    const [x0, y0, x1, y1] = frame;
    const { left, bottom, width, turn, aspect } = picture;
    return { left: left ?? x0, bottom: bottom ?? y0, width: width ?? Math.min(x1 - x0, (y1 - y0) / aspect), turn: turn ?? 0 };
  }

  // ---- routes

  drawRoutes() {
    const { model } = this;
    if (!model.plan) return;
    const [places, { outlined, walls }] = [[...model.places.values()], model];
    const segments = this.showsRoutes ? [...model.segments.values()].filter((one) => one.points.length === 2) : [];
    const marks = this.showsRoutes ? places.filter(isPlaced) : [];
    this.rooms.replaceChildren(...outlined.map(({ row, place, outline }) => this.#group("room", "Places", row, place, null, svg("path", { d: path(outline) }))), ...places.flatMap((one) => this.#opening(one, walls)));
    this.bands.replaceChildren(...segments.map(({ row, route, segment, points, outline }) => this.#group("band", "Routes", row, `${route}, ${segment}`, null,
      outline && svg("path", { class: "ground", d: path(outline) }), svg("path", { class: "line", d: path(points, false) }))));
    this.marks.replaceChildren(...segments.flatMap((one) => this.#segmentSign(one)), ...marks.map((one) => this.#mark(one)));
    this.viewport.svg.classList.toggle("states-old", model.routesOld);
  }

  #isSelected(sheet, row) {
    const { selection } = this.store;
    return selection.sheet === sheet && (selection.rows.includes(row) || selection.row === row);
  }

  /** The group of a place or a segment: its class by its state, and a title. */
  #group(css, sheet, row, name, props, ...children) {
    const state = this.model.stateOf(sheet === "Places" ? "place" : "segment", row);
    const text = state ? [name, state.word, state.detail].filter(Boolean).join(": ") : name;
    const classes = `${css} ${stateCss(state)}${this.#isSelected(sheet, row) ? " selected" : ""}`;
    return svg("g", { class: classes, [sheet === "Places" ? "data-place" : "data-segment"]: row, ...props }, svg("title", { text }), ...children);
  }

  /** A door or an exit on a wall: a gap as wide as it. */
  #opening(place, walls) {
    const { x, y, kind } = place;
    const wall = (kind === "door" || kind === "exit") && isPlaced(place) && nearestWall([x, y], walls, ON_WALL);
    if (!wall) return [];
    const [half, jamb] = [(this.model.widthOf(place) ?? DOOR) / 2, 5 / this.viewport.scale];
    return groupAt([x, y], { class: "opening", transform: `translate(${x} ${-y}) rotate(${-direction(wall.a, wall.b)})`, "aria-hidden": "true" },
      svg("path", { class: "gap", d: `M${-half} 0H${half}` }), svg("path", { d: `M${-half} ${-jamb}V${jamb}M${half} ${-jamb}V${jamb}` }));
  }

  #segmentSign({ row, points }) {
    const state = this.model.stateOf("segment", row);
    const length = distance(...points) * this.viewport.scale;
    if (!state || length <= (state.state === "open" ? SIGN_PX : 1)) return [];
    const held = state.word.includes("⚓") && svg("text", { class: "held", x: 15, text: "⚓" });
    return groupAt(middle(...points), { class: `state-sign ${stateCss(state)}`, "data-segment": row, "aria-hidden": "true" },
      svg("g", { class: "px" }, svg("circle", { r: 8 }), signOf(state), held));
  }

  #mark(place) {
    const { row, kind, x, y } = place;
    const state = this.model.stateOf("place", row);
    const sign = state ? svg("g", { class: "state-sign", "aria-hidden": "true" }, svg("circle", { r: 8 }), signOf(state)) : svg("path", { d: MARKS[kind] ?? DOT });
    return this.#group(`mark mark-${kind || "point"}`, "Places", row, place.place, { transform: `translate(${x} ${-y})` },
      svg("g", { class: "px" }, svg("circle", { class: "reach", r: 12 }), sign, this.#name(place)));
  }

  /** The name of a place; of a room or a corridor along it, and left out where there is no room for it. */
  #name({ row, place, outline }) {
    const text = (props) => svg("text", { class: outline ? "place-name outlined" : "place-name", y: 18, text: place, ...props });
    if (!outline) return text();
    const [x0, y0, x1, y1] = boxOf(outline);
    const fits = (metres) => metres * this.viewport.scale >= place.length * LETTER_PX;
    return fits(x1 - x0) || this.#isSelected("Places", row) ? text() : fits(y1 - y0) && text({ transform: "rotate(-90)" });
  }

  // ---- what pieces cover when they fall

  drawFalls() {
    const { pieces } = this;
    const rows = { all: [...this.model.pieces.keys()], none: [] }[this.falls] ?? [...pieces.selected];
    this.fallen.replaceChildren(...rows.flatMap((row) => {
      const [piece, pose] = [this.model.pieces.get(row), pieces.pose(row)];
      const rings = (piece?.fallen ?? []).map((ring) => moveRing(ring, piece, pose));
      return rings.flatMap((ring) => [svg("path", { d: path(ring) }), ...(piece.missing.includes("width") ? markSides(ring, pose) : [])]);
    }));
  }

  // ---- drafts

  /** Draw what is being drawn, [{name, points, isClosed, dots}], texts, [{at, text}], and guides, as lines of two points. */
  sketch(lines = [], texts = [], guides = []) {
    const all = [...lines, ...guides.map((points) => ({ name: "guide", points }))];
    const dots = lines.filter((one) => one.dots).flatMap((one) => one.points);
    this.draft.replaceChildren(
      ...all.map(({ name, points, isClosed = false }) => svg("path", { class: name, d: path(points, isClosed) })),
      ...dots.map((at) => groupAt(at, null, svg("circle", { class: "px dot", r: 4 }))),
      ...texts.map(({ at, text }) => groupAt(at, null, svg("text", { class: "px readout", y: -10, text }))));
  }

  /** Handles: of the corners of a selected place, of turning a selected piece or the picture. */
  showHandles(handles) {
    this.handles.replaceChildren(...handles.map(({ name, at, label, data = {}, stem }) => {
      const props = Object.fromEntries(Object.entries(data).map(([key, value]) => [`data-${key}`, value]));
      return svg("g", null, stem && svg("path", { class: "stem", d: path([stem, at], false) }), groupAt(at, { class: `handle ${name}`, ...props },
        svg("title", { text: label }), svg("circle", { class: "px reach", r: 12 }), svg("circle", { class: "px", r: name === "midpoint" ? 4 : 6 })));
    }));
  }
}
