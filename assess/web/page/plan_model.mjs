// One floor as the plan holds it: what the server answers, and until it does, what the edited cells say.

import { get } from "./api.mjs";
import { corners, isInside, moveRing, readOutline } from "./plan_geometry.mjs";
import { isFilled } from "./sheet.mjs";

const ASK_MS = 40;
const ROUTES_MS = 300;
const UNKNOWN_SIZE = 0.4; // as the server draws a piece of unknown sizes [m]
/** The width of a way or a door where none is given, as the routes assume [m]. */
export const DOOR = 0.9;
export const KINDS = ["room", "corridor", "door", "stair", "exit"]; // as the workbook lists them; the first two have an outline
const SIZES = ["breadth", "width", "height"];
const ANCHORED = ["no", "yes", "partly", "unknown"];

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
  isRefitted = false; // whether the next answer is to be seen whole
  doorWidths = new Map(); // of doors that no way leads through yet, by their rows [m]
  #book = "";
  #floor = null;
  #shownFloor = null;
  #asked = 0;
  #timer = 0;
  #routesTimer = 0;
  #routesAsked = 0;
  #abort = null;
  #held = false;
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

  hide() {
    this.isShown = false;
  }

  // ---- the unit of lengths

  get unit() {
    const column = this.store.sheet("Items")?.column("x");
    return { unit: column?.unit || "m", factor: column?.factor || 1 };
  }

  get floor() {
    return this.plan?.floor ?? "";
  }

  /** The cell that names the floor, as it stands there. */
  get floorValue() {
    const sheet = this.store.sheet("Floors");
    const column = sheet?.column("floor");
    return (column && this.plan?.floor_row && sheet.value(this.plan.floor_row, column.at)) ?? this.floor;
  }

  // ---- asking

  #reset() {
    const name = this.store.book?.name ?? "";
    if (name !== this.#book) this.#floor = this.#shownFloor = null;
    this.#book = name;
    this.plan = null;
    if (!name) this.pieces = this.places = this.segments = new Map();
    this.routes = null;
    this.types = [];
    this.#routesStamp = null;
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
    const asked = ++this.#asked;
    this.#abort?.abort();
    this.#abort = new AbortController();
    try {
      const query = this.#floor === null ? "" : `?floor=${encodeURIComponent(this.#floor)}`;
      const answer = await get(`/api/plan${query}`, this.#abort.signal);
      if (asked === this.#asked) this.#take(answer);
    } catch (error) {
      if (error.name === "AbortError" || asked !== this.#asked) return;
      this.error = error.message;
      this.#tell("plan");
    }
  }

  /** Take an answer, unless the page knows better: what it changed has not been answered yet, or is being dragged. */
  #take(answer) {
    const { store } = this;
    if (store.waiting || answer.version < store.state.version) return;
    if (this.#held) {
      this.#isStale = true;
      return;
    }
    const isOther = this.#shownFloor !== answer.floor;
    this.plan = answer;
    this.#floor = this.#shownFloor = answer.floor;
    this.error = "";
    this.#isStale = false;
    this.pieces = new Map(answer.pieces.map((one) => [one.row, one]));
    this.places = new Map(answer.places.map((one) => [one.row, one]));
    this.segments = new Map(answer.segments.map((one) => [one.row, one]));
    if (isOther || this.isRefitted) this.#tell("floor");
    this.isRefitted = false;
    this.#tell("plan");
  }

  /** While something is dragged, answers wait. */
  hold() {
    this.#held = true;
  }

  release() {
    this.#held = false;
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
    const asked = ++this.#routesAsked;
    let answer;
    try {
      answer = await get("/api/routes");
    } catch (error) {
      answer = { version: null, routes: [], rooms: [], segments: [], remarks: [], problems: [], error: error.message };
    }
    if (asked !== this.#routesAsked) return;
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

  /** Whether a piece is anchored: yes, no, partly, unknown. */
  anchored = (row) => this.#choice("Items", row, "anchored", ANCHORED) || "unknown";

  /** The size of a piece by its cells and its type, also of one that is not on the plan [m, deg]. */
  sizeOf(row) {
    const type = this.types.find((one) => nameKey(one.type) === nameKey(this.text("Items", row, "type")));
    const size = (field) => this.length("Items", row, field) ?? type?.[field] ?? null;
    const breadth = size("breadth") ?? UNKNOWN_SIZE;
    return { breadth, width: size("width") ?? breadth, angle: this.length("Items", row, "angle_deg") ?? 0 };
  }

  /** The outlined place that the Room of pieces means: by its name, also after the floor's, else the one in which its pieces stand. */
  roomNamed(room) {
    const name = nameKey(room);
    const outlined = name ? [...this.places.values()].filter((one) => one.outline) : [];
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

  /** A length of a cell in metres; `old` where it is no number. */
  length(sheetName, row, field, old = null) {
    const sheet = this.store.sheet(sheetName);
    const column = sheet?.column(field);
    const value = column ? sheet.value(row, column.at) : null;
    if (typeof value === "number") return value * column.factor;
    return isFilled(value) ? old : null;
  }

  text(sheetName, row, field) {
    const sheet = this.store.sheet(sheetName);
    const column = sheet?.column(field);
    return column ? String(sheet.value(row, column.at) ?? "") : "";
  }

  /** The English word of a choice. */
  #choice(sheetName, row, field, words) {
    const choices = this.store.sheet(sheetName)?.column(field)?.choices ?? [];
    const at = choices.map(nameKey).indexOf(nameKey(this.text(sheetName, row, field)));
    return words[at] ?? "";
  }

  #patchPiece(row) {
    const old = this.pieces.get(row);
    const isHere = nameKey(this.text("Items", row, "floor")) === nameKey(this.floor);
    const [x, y] = [this.length("Items", row, "x", old?.x), this.length("Items", row, "y", old?.y)];
    const unplaced = this.plan.unplaced.filter((one) => one.row !== row);
    const item = this.text("Items", row, "item");
    const description = this.text("Items", row, "description") || this.text("Items", row, "type");
    if (isHere && (x === null || y === null) && item) unplaced.push({ row, item, description });
    this.plan.unplaced = unplaced;
    if (!isHere || x === null || y === null) this.pieces.delete(row);
    else this.pieces.set(row, this.#localPiece(row, { x, y, item, description }, old));
  }

  #localPiece(row, base, old) {
    const isY = this.#choice("Items", row, "axis", ["X", "Y"]) === "Y";
    const angle = this.length("Items", row, "angle_deg", old?.angle) ?? (isY ? 90 : 0);
    const type = this.types.find((one) => nameKey(one.type) === nameKey(this.text("Items", row, "type")));
    const size = (field) => this.length("Items", row, field, old?.[field]) ?? type?.[field] ?? null;
    const [b, w] = [size("breadth"), size("width")];
    const breadth = b ?? old?.breadth ?? UNKNOWN_SIZE;
    const width = w ?? old?.width ?? b ?? UNKNOWN_SIZE;
    const piece = {
      row, ...base, angle, breadth, width, height: size("height") ?? old?.height ?? null,
      anchored: this.anchored(row), quantity: old?.quantity ?? 1,
      missing: SIZES.filter((field) => size(field) === null && (old?.missing.includes(field) ?? true)), fallen: [],
    };
    const isSame = old && old.breadth === piece.breadth && old.width === piece.width && old.height === piece.height;
    if (isSame) piece.fallen = old.fallen.map((ring) => moveRing(ring, old, piece));
    return piece;
  }

  #patchPlace(row) {
    const old = this.places.get(row);
    const name = this.text("Places", row, "place");
    if (!name || nameKey(this.text("Places", row, "floor")) !== nameKey(this.floor)) {
      this.places.delete(row);
      return;
    }
    const outline = readOutline(this.text("Places", row, "outline"), this.store.sheet("Places").column("outline"));
    this.places.set(row, {
      row, place: name, kind: this.#choice("Places", row, "kind", KINDS), outline,
      x: this.length("Places", row, "x", old?.x), y: this.length("Places", row, "y", old?.y),
    });
  }

  /** Segments follow their places; the band is drawn once the server answers. */
  #patchSegments(rows) {
    const places = new Map([...this.places.values()].map((one) => [nameKey(one.place), one]));
    for (const row of new Set([...this.segments.keys(), ...rows])) {
      const [from, to] = [this.text("Routes", row, "start"), this.text("Routes", row, "end")];
      const ends = [places.get(nameKey(from)), places.get(nameKey(to))];
      const isNamed = this.text("Routes", row, "route") !== "" || this.text("Routes", row, "segment") !== "";
      const old = this.segments.get(row);
      if (!isNamed || (ends.includes(undefined) && !old)) {
        this.segments.delete(row);
        continue;
      }
      const points = ends.every((one) => one && one.x !== null && one.y !== null) ? ends.map((one) => [one.x, one.y]) : [];
      const isSame = old && JSON.stringify(old.points) === JSON.stringify(points);
      const width = this.length("Routes", row, "clear_width") ?? this.length("Routes", row, "required_width") ?? old?.width ?? DOOR;
      this.segments.set(row, {
        row, route: this.text("Routes", row, "route"), segment: this.text("Routes", row, "segment"), points, width, from, to,
        outline: isSame && old.width === width ? old.outline : bandOf(points, width),
      });
    }
  }

  #patchPicture() {
    const { picture, floor_row: row } = this.plan;
    if (!picture) return;
    const number = (field) => this.length("Floors", row, field);
    const [left, bottom, width] = [number("plan_left"), number("plan_bottom"), number("plan_width")];
    Object.assign(picture, { left, bottom, width: width ?? picture.width, turn: number("plan_turn") ?? 0 });
    picture.placed = left !== null && bottom !== null && picture.width !== null;
  }
}

function bandOf(points, width) {
  if (points.length < 2) return null;
  const [[x0, y0], [x1, y1]] = points;
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (length === 0) return null;
  const angle = (Math.atan2(y1 - y0, x1 - x0) * 180) / Math.PI;
  return corners({ x: (x0 + x1) / 2, y: (y0 + y1) / 2, angle, breadth: length, width });
}
