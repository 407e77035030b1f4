// The drawing: picture, grid, rooms, bands of segments, what falling pieces cover, pieces, signs, handles, guides.

import { basisWords, chanceText, classStyle, describe, isPale } from "./classes.mjs";
import { svg } from "./elements.mjs";
import { boxOf, boxesMeet, corners, direction, distance, middle, modulo, moveRing, nearestWall, radians, turnPoint } from "./plan_geometry.mjs";
import { DOOR, STATES, isPlaced, stateCss } from "./plan_model.mjs";
import { number, percent, t } from "./texts.mjs";
import { render, svg as template } from "./vendor/lit-html.mjs";

const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500];
const GRID_PX = 22; // least distance of grid lines
const BAR_PX = 70; // least length of the scale bar
const NAMED_FROM = 55; // pixels a metre from which points of routes show their names
const TINY_TO = 18; // pixels a metre below which a piece is a fleck of its class
const ON_WALL = 0.15; // distance from a wall up to which a door is one of it [m]
const SIGN_PX = 46; // length of an open segment from which its sign is drawn
const LEAST_SIGN = 7; // font size [px]
const MOST_SIGN = 15;
const LETTER = 6.4; // width of a letter of a name [px]
const NAME_HEIGHT = 12;
const PIECES_NAMED_FROM = 45; // pixels a metre from which names stand below pieces, too
const UNKNOWN_PX = 9; // of the question marks beyond the ends
const RAISED_UP_TO = 20; // selected pieces
const MARKS = {
  exit: "M-7 -3H0V-7L8 0L0 7V3H-7Z", stair: "M-7 6V2.5H-3.5V-1H0V-4.5H3.5V-8H7V6Z", door: "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z",
};
const DOT = "M-3 0A3 3 0 1 0 3 0A3 3 0 1 0 -3 0Z"; // of all others

const path = (ring, isClosed = true) => ring.map(([x, y], i) => `${i ? "L" : "M"}${x} ${-y}`).join("") + (isClosed ? "Z" : "");

const translate = (x, y) => `translate(${x.toFixed(4)} ${(-y).toFixed(4)})`;

/** A group at a point, with attributes. */
const groupAt = ([x, y], props, ...children) => svg("g", { transform: translate(x, y), ...props }, ...children);

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
      this.pieces.scale = scale;
      this.pieces.draw();
      this.drawRoutes();
    }
    this.viewport.svg.classList.toggle("far", scale < NAMED_FROM);
    this.viewport.svg.classList.toggle("tiny", scale < TINY_TO);
    this.#drawGrid();
  }

  /** Draw all, with a wish: falls, opacity, showsRoutes. */
  draw(wish = {}) {
    Object.assign(this, wish);
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
    return groupAt([x, y], { class: "opening", transform: `${translate(x, y)} rotate(${-direction(wall.a, wall.b)})`, "aria-hidden": "true" },
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
    return this.#group(`mark mark-${kind || "point"}`, "Places", row, place.place, { transform: translate(x, y) },
      svg("g", { class: "px" }, svg("circle", { class: "reach", r: 12 }), sign, this.#name(place)));
  }

  /** The name of a place; of a room or a corridor along it, and left out where there is no room for it. */
  #name({ row, place, outline }) {
    const text = (props) => svg("text", { class: outline ? "place-name outlined" : "place-name", y: 18, text: place, ...props });
    if (!outline) return text();
    const [x0, y0, x1, y1] = boxOf(outline);
    const fits = (metres) => metres * this.viewport.scale >= place.length * LETTER;
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

/** The pieces: a rectangle each, with its class as colour and sign, its name, and the sides that are Breadth. */
class PieceLayer {
  #nodes = new Map();
  #previews = new Map();
  #besides = new Set(); // rows of those whose names stand below them
  active = 0; // the piece that Tab reaches

  constructor(model, store) {
    Object.assign(this, { model, store, scale: 40, selected: new Set(), node: svg("g", { class: "pieces" }) });
  }

  // ---- drawing

  draw() {
    const { model: { pieces, floor }, node } = this;
    for (const [row, one] of this.#nodes) {
      if (pieces.has(row)) continue;
      one.remove();
      this.#nodes.delete(row);
    }
    if (!pieces.has(this.active)) this.active = this.order()[0] ?? 0;
    this.#placeNames();
    this.#drawPieces(pieces.keys());
    const named = { role: "listbox", "aria-multiselectable": "true", "aria-label": t("Pieces on floor {floor}", { floor }) };
    for (const [name, value] of Object.entries(named)) {
      if (pieces.size) node.setAttribute(name, value);
      else node.removeAttribute(name);
    }
  }

  #drawPieces(rows) {
    for (const row of rows) if (this.model.pieces.has(row)) this.#drawPiece(this.model.pieces.get(row));
  }

  #drawPiece(piece) {
    const { row, item, breadth: b, width: w, missing } = piece;
    const { x, y, angle } = this.pose(row);
    const { key, isAnchored, live } = this.classOf(piece);
    const [isSelected, label, fit] = [this.selected.has(row), this.label(piece), this.#fit(piece, angle)];
    if (!this.#nodes.has(row)) this.#nodes.set(row, this.node.appendChild(svg("g", { role: "option", "data-row": row })));
    const node = this.#nodes.get(row);
    const style = key ? classStyle(live) : describe("").css;
    const classes = ["piece", style, isSelected && "selected", isAnchored && !key && "anchored", missing.length && "sizes-missing", missing.includes("width") && "width-missing"];
    const values = { class: classes.filter(Boolean).join(" "), transform: translate(x, y), tabindex: row === this.active ? "0" : "-1", "aria-selected": String(isSelected), "aria-label": label };
    for (const [name, value] of Object.entries(values)) if (node.getAttribute(name) !== value) node.setAttribute(name, value);
    const isNamed = fit.isInside || isSelected || this.#besides.has(row);
    render(template`<title>${label}</title>
      <g transform="rotate(${-angle})"><rect class="body" x=${-b / 2} y=${-w / 2} width=${b} height=${w}></rect>
        <path class="sides" d="M${-b / 2} ${-w / 2}H${b / 2}M${-b / 2} ${w / 2}H${b / 2}"></path></g>${this.#unknownEnds(piece, angle)}
      <g class="px" .style="transform: scale(var(--u)) rotate(${-fit.turn}deg)">
        <text class="sign" .style="font-size: ${fit.size.toFixed(1)}px" x=${-fit.shift}>${key ? describe(key).sign : isAnchored ? "⚓" : "–"}</text>
        <text class=${fit.isInside ? "name" : "name beside"} .style=${isNamed ? "" : "display: none"} x=${fit.isInside ? fit.size / 2 + 1 : 0} y=${fit.y}>${item}</text></g>`, node);
  }

  /** Question marks where it is not known how far a piece reaches. */
  #unknownEnds({ breadth: b, width: w, missing }, angle) {
    const ends = [...(missing.includes("width") ? [[0, w / 2], [0, -w / 2]] : []), ...(missing.includes("breadth") ? [[b / 2, 0], [-b / 2, 0]] : [])];
    return ends.map((end) => {
      const [x, y] = turnPoint(end, angle);
      const k = UNKNOWN_PX / Math.hypot(x, y);
      return template`<g transform=${translate(x, y)}><text class="px unknown" x=${x * k} y=${-y * k}>?</text></g>`;
    });
  }

  /** Sign and name as large as the piece allows; the name along its longer side, upright or read from the right, else below it. */
  #fit({ item, breadth, width }, angle) {
    const [b, w] = [breadth * this.scale, width * this.scale];
    const short = Math.min(b, w);
    const size = Math.min(MOST_SIGN, Math.max(LEAST_SIGN, 0.85 * short));
    const letters = item.length * LETTER;
    if (short >= NAME_HEIGHT && Math.max(b, w) - size - 6 >= letters) {
      const along = modulo(angle + (w >= b ? 90 : 0), 180);
      return { isInside: true, size, turn: along > 90 ? along - 180 : along, shift: letters / 2 + 2, y: 0 };
    }
    const a = radians(angle);
    const reach = (Math.abs(b * Math.sin(a)) + Math.abs(w * Math.cos(a))) / 2; // half its height on the screen
    return { isInside: false, size, turn: 0, shift: 0, y: Math.max(10, reach) + 10 };
  }

  /** Zoomed in, names stand below pieces that have no room for them, where they cover neither a piece nor a name. */
  #placeNames() {
    this.#besides.clear();
    if (this.scale < PIECES_NAMED_FROM) return;
    const [k, pieces] = [this.scale, [...this.model.pieces.values()]];
    const taken = pieces.map((one) => boxOf(corners(one).map(([x, y]) => [x * k, -y * k])));
    for (const piece of pieces) {
      const fit = this.#fit(piece, piece.angle);
      if (fit.isInside || this.selected.has(piece.row)) continue;
      const [x, y, half] = [piece.x * k, -piece.y * k + fit.y, (piece.item.length * LETTER) / 2];
      const own = [x - half, y - NAME_HEIGHT / 2, x + half, y + NAME_HEIGHT / 2];
      if (taken.some((one) => boxesMeet(own, one))) continue;
      taken.push(own);
      this.#besides.add(piece.row);
    }
  }

  // ---- while dragged

  /** Show pieces elsewhere than they stand, [{row, x, y, angle}]; all others where they do. */
  preview(poses) {
    const rows = new Set([...this.#previews.keys(), ...poses.map((one) => one.row)]);
    this.#previews = new Map(poses.map((one) => [one.row, one]));
    this.#drawPieces(rows);
  }

  /** Where a piece is shown. */
  pose(row) {
    const piece = this.model.pieces.get(row);
    const { x, y, angle } = this.#previews.get(row) ?? piece ?? {};
    return piece && { ...piece, x, y, angle };
  }

  // ---- classes and words

  /** The class of a piece and the text beside it in lists: its chance, or why it has no class. */
  classOf({ row, anchored = this.model.anchored(row) }) {
    const live = this.store.live.get(row);
    const { class: key = "", chance = null, word = "" } = live ?? {};
    const isAnchored = anchored === "yes";
    const none = isAnchored ? `⚓ ${chance === null ? word : t("{chance} if the anchor fails", { chance: percent(chance) })}` : word;
    return { key, chance, isAnchored, word, live, text: key ? chanceText(live) || (isPale(live) ? "≈" : "") : none };
  }

  /** What is said of a piece: name, what it is, class, position. */
  label({ row, item, description, anchored, missing, x, y, angle }) {
    const { key, word, live } = this.classOf({ row, anchored });
    const chance = chanceText(live);
    const sheet = this.store.sheet("Items");
    const { model } = this;
    return [
      description ? `${item}, ${description}` : item, key ? t("class {word}", { word: describe(key).word }) : word || describe("").word,
      ...(chance ? [t("chance {chance}", { chance })] : []), ...basisWords(live).map(([said]) => said),
      ...missing.map((name) => t("{size} is not known", { size: sheet.column(name)?.label ?? name })),
      t("X {x}, Y {y}, angle {angle}°", { x: model.shownLength(x), y: model.shownLength(y), angle: number(angle) }),
    ].join("; ");
  }

  // ---- keyboard

  /** The rows of pieces in the order of reading: from above, from the left. */
  order() {
    return [...this.model.pieces.values()].sort((a, b) => Math.round(b.y - a.y) || a.x - b.x).map((one) => one.row);
  }

  activate(row) {
    this.active = row;
    for (const [one, node] of this.#nodes) node.setAttribute("tabindex", one === row ? "0" : "-1");
  }

  focus(row = this.active) {
    this.activate(row);
    this.#nodes.get(row)?.focus({ preventScroll: true });
  }

  /** Selected pieces lie on top; focus survives, as the nodes that are moved past stay where they are. */
  select(rows) {
    const before = [...this.selected, ...this.#besides];
    this.selected = new Set(rows);
    if (this.model.pieces.has(rows[0])) this.activate(rows[0]);
    this.#placeNames();
    this.#drawPieces(new Set([...before, ...rows, ...this.#besides]));
    if (rows.length > RAISED_UP_TO) return;
    const nodes = rows.map((row) => this.#nodes.get(row)).filter((node) => node && !node.contains(document.activeElement));
    for (const node of nodes) if (node !== this.node.lastChild) this.node.append(node);
  }
}
