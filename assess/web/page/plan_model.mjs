// One floor as the plan holds it: what the server answers, and until it does, what the edited cells say.

import { get } from "./api.mjs";
import { corners, direction, distance, isInside, middle, moveRing, readOutline, sidesOf } from "./plan_geometry.mjs";
import { isFilled } from "./sheet.mjs";
import { number, t } from "./texts.mjs";

const ASK_MS = 40;
const ROUTES_MS = 300;
const UNKNOWN_SIZE = 0.4; // as the server draws a piece of unknown sizes [m]
/** The width of a way or a door where none is given, as the routes assume [m]. */
export const DOOR = 0.9;
export const KINDS = ["room", "corridor", "door", "stair", "exit"]; // as the workbook lists them; the first two have an outline
const SIZES = ["breadth", "width", "height"];
const ANCHORED = ["no", "yes", "partly", "unknown"];
/** States of routes and rooms, the best first, and their signs. */
export const STATES = { open: "✓", doubtful: "≈", not_known: "?", blocked: "✕" };

export const stateWords = () => ({ open: t("open"), doubtful: t("doubtful"), not_known: t("not known"), blocked: t("blocked") });

/** The class of a state in the style sheet: as the reports, with what stands in the way already apart. */
export const stateCss = (state) => (state ? `state-${state.standing ? "standing" : state.state.replace("_", "-")}` : "state-none");

export const isPlaced = ({ x, y }) => x !== null && y !== null;

/** Names as the workbook compares them. */
export const nameKey = (name) => String(name ?? "").trim().replace(/\s+/g, " ").toLowerCase();

export class PlanModel extends EventTarget {
  plan = null;
  routes = null;
  routesOld = false;
  error = "";
  pieces = new Map();
  places = new Map();
  segments = new Map();
  types = [];
  isShown = false;
  isHeld = false; // while something is dragged answers wait
  isRefitted = false; // whether the next answer is to be seen whole
  doorWidths = new Map(); // of doors that no way leads through yet, by their rows [m]
  #book = "";
  #floor = null;
  #shownFloor = null;
  #timer = 0;
  #routesTimer = 0;
  #abort = null;
  #routesAbort = null;
  #isStale = true;
  #routesStamp = null;

  constructor(store) {
    super();
    this.store = store;
    store.addEventListener("book", () => this.#reset());
    store.addEventListener("cells", ({ detail }) => this.#patch(detail));
    store.addEventListener("state", () => this.#follow());
    store.addEventListener("live", () => (this.#tell("classes"), this.isShown && this.#askRoutesSoon()));
  }

  #tell(name) {
    this.dispatchEvent(new Event(name));
  }

  show() {
    this.isShown = true;
    if (this.#isStale || !this.plan) this.#ask();
    this.#askRoutesSoon(0);
  }

  // ---- the unit of lengths

  get unit() {
    const column = this.store.sheet("Items")?.column("x");
    return { unit: column?.unit || "m", factor: column?.factor || 1 };
  }

  /** A length in metres as the page shows it. */
  shownLength(metres, digits = 2) {
    const { unit, factor } = this.unit;
    return `${number(metres / factor, digits)} ${unit}`;
  }

  shownAt = ([x, y]) => t("X {x}, Y {y}", { x: this.shownLength(x), y: this.shownLength(y) });

  get floor() {
    return this.plan?.floor ?? "";
  }

  /** The cell that names the floor, as it stands there. */
  get floorValue() {
    return this.value("Floors", this.plan?.floor_row, "floor") ?? this.floor;
  }

  /** Whether a row is of this floor. */
  isHere = (sheet, row) => nameKey(this.text(sheet, row, "floor")) === nameKey(this.floor);

  // ---- asking

  #reset() {
    const name = this.store.book?.name ?? "";
    if (name !== this.#book) this.#floor = this.#shownFloor = null;
    this.#book = name;
    if (!name) this.pieces = this.places = this.segments = new Map();
    this.plan = this.routes = this.#routesStamp = null;
    this.types = [];
    this.doorWidths = new Map();
    this.#isStale = true;
    if (this.isShown) this.#ask();
    this.#askRoutesSoon(0);
  }

  /** Show another floor. */
  setFloor(name) {
    this.#floor = name;
    this.#isStale = true;
    this.#ask();
  }

  #follow() {
    const { store } = this;
    if (!store.book || store.waiting || this.plan?.version === store.state.version) return;
    this.#isStale = true;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#ask(), ASK_MS);
    this.#askRoutesSoon(ROUTES_MS);
  }

  async #ask() {
    if (!this.isShown || !this.store.book) return;
    this.#abort?.abort();
    this.#abort = new AbortController();
    try {
      const query = this.#floor === null ? "" : `?floor=${encodeURIComponent(this.#floor)}`;
      this.#take(await get(`/api/plan${query}`, this.#abort.signal));
    } catch (error) {
      if (error.name === "AbortError") return;
      this.error = error.message;
      this.#tell("plan");
    }
  }

  /** Take an answer, unless the page knows better: what it changed has not been answered yet, or is being dragged. */
  #take(answer) {
    const { store } = this;
    if (store.waiting || answer.version < store.state.version) return;
    this.#isStale = this.isHeld;
    if (this.isHeld) return;
    const isOther = this.#shownFloor !== answer.floor;
    this.plan = answer;
    this.#floor = this.#shownFloor = answer.floor;
    this.error = "";
    for (const name of ["pieces", "places", "segments"]) this[name] = new Map(answer[name].map((one) => [one.row, one]));
    if (isOther || this.isRefitted) this.#tell("floor");
    this.isRefitted = false;
    this.#tell("plan");
  }

  release() {
    this.isHeld = false;
    if (this.#isStale) this.#ask();
  }

  #askRoutesSoon(delay = ROUTES_MS) {
    if (!this.isShown || !this.store.book) return;
    if (this.#routesStamp === this.store.stamp && this.routes) return;
    this.routesOld = this.routes !== null;
    if (this.routesOld) this.#tell("routes");
    clearTimeout(this.#routesTimer);
    this.#routesTimer = setTimeout(() => this.#askRoutes(), delay);
  }

  async #askRoutes() {
    this.#routesAbort?.abort();
    this.#routesAbort = new AbortController();
    const failed = ({ name, message }) => (name === "AbortError" ? null : { version: null, routes: [], rooms: [], segments: [], remarks: [], error: message });
    const answer = await get("/api/routes", this.#routesAbort.signal).catch(failed);
    if (!answer) return;
    this.routes = answer;
    this.#routesStamp = answer.stamp ?? null;
    this.routesOld = answer.version !== null && answer.version < this.store.state.version;
    this.#tell("routes");
  }

  async loadTypes() {
    if (this.types.length === 0) this.types = (await get("/api/catalogue")).types;
    return this.types;
  }

  /** The state of a place or a segment by its row; undefined where routes say nothing of it. */
  stateOf(kind, row) {
    if (!this.routes) return undefined;
    return kind === "segment" ? this.routes.segments.find((one) => one.row === row) : this.routes.rooms.find((one) => one.place_row === row);
  }

  anchored = (row) => this.#choice("Items", row, "anchored", ANCHORED) || "unknown";

  /** A size of a piece by its cells and its type [m]. */
  #size(row, field, old = null) {
    const type = nameKey(this.text("Items", row, "type"));
    return this.length("Items", row, field, old) ?? this.types.find((one) => nameKey(one.type) === type)?.[field] ?? null;
  }

  /** How a piece that is not on the plan would lie there [m, deg]. */
  sizeOf(row) {
    const breadth = this.#size(row, "breadth") ?? UNKNOWN_SIZE;
    return { breadth, width: this.#size(row, "width") ?? breadth, angle: this.length("Items", row, "angle_deg") ?? 0 };
  }

  /** The places with an outline, and the sides of all. */
  get outlined() {
    return [...this.places.values()].filter((one) => one.outline);
  }

  get walls() {
    return this.outlined.flatMap((one) => sidesOf(one.outline));
  }

  /** The outlined place that the Room of pieces means: by its name, also after the floor's, else where its pieces stand. */
  roomNamed(room) {
    const name = nameKey(room);
    const outlined = name ? this.outlined : [];
    const named = outlined.find(({ place }) => [name, nameKey(`${this.floor} ${room}`)].includes(nameKey(place)));
    if (named || !outlined.length) return named;
    const stand = [...this.pieces.values()].filter((one) => nameKey(this.text("Items", one.row, "room")) === name);
    const counted = outlined.map((place) => [stand.filter(({ x, y }) => isInside([x, y], place.outline)).length, place]);
    return counted.sort((a, b) => b[0] - a[0]).find(([n]) => n > stand.length / 2)?.[1];
  }

  /** The ways of this floor that begin or end at a place. */
  waysAt({ place }) {
    return [...this.segments.values()].filter((one) => [one.from, one.to].some((name) => nameKey(name) === nameKey(place)));
  }

  /** The width of a door or an exit: the least clear width of the ways through it [m]; null where it is not known. */
  widthOf(place) {
    const widths = this.waysAt(place).map((one) => this.length("Routes", one.row, "clear_width")).filter((one) => one !== null);
    return widths.length ? Math.min(...widths) : this.doorWidths.get(place.row) ?? null;
  }

  // ---- what edited cells say before the server answers

  #patch(cells) {
    if (cells.some(([name]) => name === "Catalogue")) this.types = [];
    if (!this.plan) return;
    const rows = (name) => new Set(cells.filter(([sheet]) => sheet === name).map(([, row]) => row));
    for (const row of rows("Items")) this.#patchPiece(row);
    for (const row of rows("Places")) this.#patchPlace(row);
    if (rows("Floors").has(this.plan.floor_row)) this.#patchPicture();
    if (rows("Places").size || rows("Routes").size) this.#patchSegments(rows("Routes"));
    this.#tell("plan");
  }

  /** The value of a cell by its field; null where it is blank or the workbook lacks the column. */
  value(sheetName, row, field) {
    const sheet = this.store.sheet(sheetName);
    const column = sheet?.column(field);
    return column ? sheet.value(row, column.at) : null;
  }

  /** A length of a cell in metres; `old` where it is no number. */
  length(sheetName, row, field, old = null) {
    const value = this.value(sheetName, row, field);
    if (typeof value === "number") return value * this.store.sheet(sheetName).column(field).factor;
    return isFilled(value) ? old : null;
  }

  text = (sheetName, row, field) => String(this.value(sheetName, row, field) ?? "");

  /** The English word of a choice. */
  #choice(sheetName, row, field, words) {
    const choices = this.store.sheet(sheetName)?.column(field)?.choices ?? [];
    const at = choices.map(nameKey).indexOf(nameKey(this.text(sheetName, row, field)));
    return words[at] ?? "";
  }

  #patchPiece(row) {
    const old = this.pieces.get(row);
    const at = { x: this.length("Items", row, "x", old?.x), y: this.length("Items", row, "y", old?.y) };
    const [item, description, type] = ["item", "description", "type"].map((field) => this.text("Items", row, field));
    const named = { row, item, description: description || type };
    const isHere = this.isHere("Items", row);
    this.plan.unplaced = this.plan.unplaced.filter((one) => one.row !== row);
    if (isHere && !isPlaced(at) && item) this.plan.unplaced.push(named);
    if (!isHere || !isPlaced(at)) this.pieces.delete(row);
    else this.pieces.set(row, this.#localPiece({ ...named, ...at }, old));
  }

  #localPiece(named, old) {
    const { row } = named;
    const isY = this.#choice("Items", row, "axis", ["X", "Y"]) === "Y";
    const known = Object.fromEntries(SIZES.map((field) => [field, this.#size(row, field, old?.[field])]));
    const piece = {
      ...named, angle: this.length("Items", row, "angle_deg", old?.angle) ?? (isY ? 90 : 0), fallen: [],
      breadth: known.breadth ?? old?.breadth ?? UNKNOWN_SIZE, width: known.width ?? old?.width ?? known.breadth ?? UNKNOWN_SIZE,
      height: known.height ?? old?.height ?? null, anchored: this.anchored(row),
      missing: SIZES.filter((field) => known[field] === null && (old?.missing.includes(field) ?? true)),
    };
    const isSame = old && SIZES.every((field) => old[field] === piece[field]);
    if (isSame) piece.fallen = old.fallen.map((ring) => moveRing(ring, old, piece));
    return piece;
  }

  #patchPlace(row) {
    const old = this.places.get(row);
    const name = this.text("Places", row, "place");
    if (!name || !this.isHere("Places", row)) return this.places.delete(row);
    const outline = readOutline(this.text("Places", row, "outline"), this.store.sheet("Places").column("outline"));
    return this.places.set(row, {
      row, place: name, kind: this.#choice("Places", row, "kind", KINDS), outline,
      x: this.length("Places", row, "x", old?.x), y: this.length("Places", row, "y", old?.y),
    });
  }

  /** Segments follow their places; the band is drawn once the server answers. */
  #patchSegments(rows) {
    const places = new Map([...this.places.values()].map((one) => [nameKey(one.place), one]));
    for (const row of new Set([...this.segments.keys(), ...rows])) {
      const [route, segment, from, to] = ["route", "segment", "start", "end"].map((field) => this.text("Routes", row, field));
      const ends = [from, to].map((one) => places.get(nameKey(one)));
      const old = this.segments.get(row);
      if ((!route && !segment) || (ends.includes(undefined) && !old)) {
        this.segments.delete(row);
        continue;
      }
      const points = ends.every((one) => one && isPlaced(one)) ? ends.map((one) => [one.x, one.y]) : [];
      const width = this.length("Routes", row, "clear_width") ?? this.length("Routes", row, "required_width") ?? old?.width ?? DOOR;
      const isSame = old && JSON.stringify([old.points, old.width]) === JSON.stringify([points, width]);
      const outline = isSame ? old.outline : bandOf(points, width);
      this.segments.set(row, { row, route, segment, points, width, from, to, outline });
    }
  }

  #patchPicture() {
    const { picture, floor_row: row } = this.plan;
    if (!picture) return;
    const [left, bottom, width, turn] = ["left", "bottom", "width", "turn"].map((field) => this.length("Floors", row, `plan_${field}`));
    Object.assign(picture, { left, bottom, width: width ?? picture.width, turn: turn ?? 0 });
    picture.placed = left !== null && bottom !== null && picture.width !== null;
  }
}

function bandOf([a, b], width) {
  const length = b ? distance(a, b) : 0;
  const [x, y] = length ? middle(a, b) : [];
  return length ? corners({ x, y, angle: direction(a, b), breadth: length, width }) : null;
}
