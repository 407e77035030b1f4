// What gestures on the plan write into the workbook. Every function is one edit, so one step of undo.

import { standAlongWalls } from "./plan_arrange.mjs";
import { axisOf, corners, direction, inUnit, pointInside, roundTo, wholeAngle, writeOutline } from "./plan_geometry.mjs";
import { DOOR, nameKey } from "./plan_model.mjs";
import { nearestWall, sidesOf } from "./plan_snap.mjs";
import { isFilled, nextName } from "./sheet.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const CENTIMETRE = 0.01;
const MILLIMETRE = 0.001;
const UNMOVED = 0.0005;
const ANCHORED_YES = 1;
const CORRIDOR = 1;
const POINTS = new Set(["door", "stair", "exit"]);

export class PlanEdits {
  constructor(model, store) {
    Object.assign(this, { model, store });
  }

  // ---- cells

  /** A cell to edit: none where the workbook lacks the column. */
  cell(sheetName, row, field, value) {
    const column = this.store.sheet(sheetName)?.column(field);
    return column ? [[sheetName, row, column.at, value]] : [];
  }

  /** A length in metres for a cell. */
  length(sheetName, row, field, metres, step = CENTIMETRE) {
    const column = this.store.sheet(sheetName)?.column(field);
    return column ? [[sheetName, row, column.at, metres === null ? null : inUnit(metres, column, step)]] : [];
  }

  #choice(sheetName, field, at) {
    return this.store.sheet(sheetName)?.column(field)?.choices[at] ?? null;
  }

  #edit(edits, label) {
    return edits.length ? this.store.edit(edits, label) : Promise.resolve(true);
  }

  #freeRow(name) {
    const sheet = this.store.sheet(name);
    const row = sheet?.found ? sheet.firstFreeRow() : null;
    if (row === null) {
      const text = sheet?.found ? t("The sheet {sheet} is full.", { sheet: sheet.title }) : t("This workbook has no sheet {sheet}, or one without its headers.", { sheet: sheet?.title ?? name });
      notice(text, { kind: "error" });
    }
    return row;
  }

  /** Empty the cells of a row that somebody filled. */
  #clearRow(name, row) {
    const sheet = this.store.sheet(name);
    return sheet.columns.filter((column) => column.kind !== "live" && isFilled(sheet.value(row, column.at))).map((column) => [name, row, column.at, null]);
  }

  select(sheet, rows) {
    const column = this.store.sheet(sheet)?.columns[0];
    this.store.select({ sheet, row: rows[0] ?? 0, at: column?.at ?? 0, rows }, "plan");
  }

  // ---- pieces

  /** Write new poses [{row, x, y, angle}]; what did not change is left as it stands in the cell. */
  pose(poses, label) {
    const edits = poses.flatMap(({ row, x, y, angle }) => {
      const old = this.model.pieces.get(row);
      const moved = (value, before) => value !== undefined && (!old || Math.abs(value - before) > UNMOVED);
      return [
        ...(moved(x, old?.x) ? this.length("Items", row, "x", x) : []),
        ...(moved(y, old?.y) ? this.length("Items", row, "y", y) : []),
        ...(angle !== undefined && (!old || wholeAngle(angle) !== old.angle) ? this.#turned(row, old, wholeAngle(angle)) : []),
      ];
    });
    return this.#edit(edits, label);
  }

  /** A new angle. An Axis that agreed with the angle before follows it, so that the two do not contradict each other. */
  #turned(row, old, angle) {
    const edits = this.cell("Items", row, "angle_deg", angle);
    const column = this.store.sheet("Items").column("axis");
    const typed = column ? this.store.sheet("Items").value(row, column.at) : null;
    if (!isFilled(typed) || !old) return edits;
    const [before, after] = [axisOf(old.angle), axisOf(angle)];
    if (before < 0 || after < 0 || column.choices[before] !== typed) return edits;
    return [...edits, ...this.cell("Items", row, "axis", column.choices[after])];
  }

  move(rows, [dx, dy], label = t("move")) {
    const poses = rows.map((row) => this.model.pieces.get(row)).filter(Boolean)
      .map((one) => ({ row: one.row, x: dx ? roundTo(one.x + dx, CENTIMETRE) : one.x, y: dy ? roundTo(one.y + dy, CENTIMETRE) : one.y }));
    return this.pose(poses, label);
  }

  turn(rows, degrees) {
    const poses = rows.map((row) => this.model.pieces.get(row)).filter(Boolean).map((one) => ({ row: one.row, angle: one.angle + degrees }));
    return this.pose(poses, t("turn"));
  }

  /** Put pieces that are in the list onto the plan. */
  place(row, [x, y]) {
    const sheet = this.store.sheet("Items");
    const floor = sheet.column("floor");
    const other = floor && nameKey(sheet.value(row, floor.at)) !== nameKey(this.model.floor);
    const edits = [...this.length("Items", row, "x", x), ...this.length("Items", row, "y", y), ...(other ? this.cell("Items", row, "floor", this.model.floorValue) : [])];
    this.select("Items", [row]);
    return this.#edit(edits, t("place on the plan"));
  }

  takeOff(rows) {
    const edits = rows.flatMap((row) => [...this.cell("Items", row, "x", null), ...this.cell("Items", row, "y", null)]);
    return this.#edit(edits, t("take off the plan"));
  }

  deleteRows(sheet, rows) {
    return this.#edit(rows.flatMap((row) => this.#clearRow(sheet, row)), t("delete"));
  }

  /** The item that new pieces are named after: the last of the floor, else the last of all. */
  #lastName() {
    const sheet = this.store.sheet("Items");
    const item = sheet.column("item");
    const floor = sheet.column("floor");
    const named = sheet.rowNumbers.filter((row) => isFilled(sheet.value(row, item.at)));
    const own = floor ? named.filter((row) => nameKey(sheet.value(row, floor.at)) === nameKey(this.model.floor)) : [];
    const row = own.at(-1) ?? named.at(-1);
    return row === undefined ? null : sheet.value(row, item.at);
  }

  /** Add a piece of a type of the catalogue at a point. */
  add(type, [x, y], angle = 0) {
    const row = this.#freeRow("Items");
    if (row === null) return Promise.resolve(false);
    const names = this.store.sheet("Items").names("item");
    const last = this.#lastName();
    const name = last === null ? "A1" : nextName(last, names);
    const edits = [
      ...this.cell("Items", row, "item", name), ...this.cell("Items", row, "floor", this.model.floorValue), ...this.cell("Items", row, "type", type),
      ...this.length("Items", row, "x", x), ...this.length("Items", row, "y", y), ...this.cell("Items", row, "angle_deg", wholeAngle(angle)),
    ];
    const done = this.#edit(edits, t("add"));
    this.select("Items", [row]);
    return done;
  }

  /**
   * Copies of pieces, in the first free rows, with names of their own.
   * @param {number[]} rows those that are copied
   * @param {number[]} shift by which the copies stand apart
   */
  copy(rows, [dx, dy]) {
    const sheet = this.store.sheet("Items");
    const [names, edits, made] = [sheet.names("item"), [], []];
    let free = this.#freeRow("Items");
    for (const row of rows.filter((one) => sheet.isUsed(one))) {
      if (free === null || (sheet.capacity && free > sheet.capacity)) break;
      for (const column of sheet.columns) {
        const value = sheet.value(row, column.at);
        if (column.kind !== "live" && isFilled(value)) edits.push(["Items", free, column.at, this.#copied(column, value, names, [dx, dy])]);
      }
      made.push(free);
      free += 1;
    }
    const done = this.#edit(edits, t("copy"));
    if (made.length) this.select("Items", made);
    return done;
  }

  #copied(column, value, names, [dx, dy]) {
    if (column.field === "item") {
      names.push(nextName(value, names));
      return names.at(-1);
    }
    if (column.field === "floor") return this.model.floorValue;
    const shift = { x: dx, y: dy }[column.field];
    return shift && typeof value === "number" ? inUnit(value * column.factor + shift, column) : value;
  }

  /** The pieces of a room that are not on the plan yet. */
  unplacedIn(place) {
    return (this.model.plan?.unplaced ?? []).map((one) => one.row).filter((row) => this.model.roomNamed(this.model.text("Items", row, "room")) === place);
  }

  /** Stand the pieces of a room that are not on the plan yet along its walls, clear of doors, ways and pieces. */
  async placeAlongWalls(place) {
    const { model } = this;
    await model.loadTypes().catch(() => {});
    const rows = this.unplacedIn(place);
    const single = rows.filter((row) => !(model.length("Items", row, "quantity") > 1));
    const axis = this.store.sheet("Items").column("axis");
    const pieces = single.map((row) => ({ row, ...model.sizeOf(row), axis: axis ? axis.choices.indexOf(model.text("Items", row, "axis")) : -1 }));
    const others = [...model.pieces.values()].map(corners);
    const ways = [...model.segments.values()].map((one) => one.outline).filter(Boolean);
    const poses = standAlongWalls(place.outline, pieces, [...others, ...ways, ...this.#doorways()]);
    const placed = new Set(poses.map((one) => one.row));
    if (!(await this.pose(poses, t("place along the walls")))) return;
    if (poses.length) this.select("Items", poses.map((one) => one.row));
    const names = (all) => all.map((row) => model.text("Items", row, "item")).join(", ");
    const [left, several] = [single.filter((row) => !placed.has(row)), rows.filter((row) => !single.includes(row))];
    const text = [
      poses.length && tn("{n} piece placed along the walls of {room}.", "{n} pieces placed along the walls of {room}.", poses.length, { room: place.place }),
      left.length && t("No room along the walls for {items}.", { items: names(left) }),
      several.length && t("{items}: give each piece a row of its own.", { items: names(several) }),
    ].filter(Boolean).join(" ");
    if (poses.length) this.store.offerUndo(text);
    else notice(text);
  }

  /** What doors, stairs and exits on walls need to be free on both sides. */
  #doorways() {
    const { model } = this;
    const walls = [...model.places.values()].filter((one) => one.outline).flatMap((one) => sidesOf(one.outline));
    return [...model.places.values()].filter((one) => POINTS.has(one.kind) && one.x !== null && one.y !== null).map(({ x, y, ...one }) => {
      const width = model.widthOf(one) ?? DOOR;
      const wall = nearestWall([x, y], walls, DOOR / 2);
      return corners({ x, y, angle: wall ? direction([0, 0], wall.d) + 90 : 0, breadth: 2 * width, width: wall ? width : 2 * width });
    });
  }

  // ---- places and segments

  /** Add a place: a ring of corners, or a point; the width of a door is kept until a way leads through it. */
  addPlace(kindAt, ring, point, width = null) {
    const row = this.#freeRow("Places");
    if (row === null) return null;
    const sheet = this.store.sheet("Places");
    const kind = this.#choice("Places", "kind", kindAt);
    const [x, y] = point ?? pointInside(ring);
    const column = sheet.column("outline");
    const stem = `${this.model.floor} ${kind ?? ""}`.trim();
    const edits = [
      ...this.cell("Places", row, "place", nextName(`${stem} 0`, sheet.names("place"))), ...this.cell("Places", row, "floor", this.model.floorValue),
      ...this.length("Places", row, "x", x), ...this.length("Places", row, "y", y), ...this.cell("Places", row, "kind", kind),
      ...(ring && column ? this.cell("Places", row, "outline", writeOutline(ring, column)) : []),
    ];
    this.model.doorWidths.set(row, width);
    const done = this.#edit(edits, t("draw a place"));
    this.select("Places", [row]);
    return done;
  }

  /** The width of a door is the clear width of the ways through it. */
  doorWidth(place, width) {
    this.model.doorWidths.set(place.row, width);
    return this.#edit(this.model.waysAt(place).flatMap((one) => this.length("Routes", one.row, "clear_width", width)), t("width of a door"));
  }

  outline(row, ring, label = t("outline")) {
    const column = this.store.sheet("Places").column("outline");
    return this.#edit(this.cell("Places", row, "outline", ring ? writeOutline(ring, column) : null), label);
  }

  movePlace(row, [x, y]) {
    return this.#edit([...this.length("Places", row, "x", x), ...this.length("Places", row, "y", y)], t("move"));
  }

  /** Another name for a place, also where segments name it. */
  renamePlace(row, name) {
    const sheet = this.store.sheet("Places");
    const old = nameKey(sheet.value(row, sheet.column("place").at));
    const routes = this.store.sheet("Routes");
    const named = ["start", "end"].map((field) => routes?.column(field)).filter(Boolean).flatMap((column) =>
      routes.rowNumbers.filter((one) => nameKey(routes.value(one, column.at)) === old).map((one) => ["Routes", one, column.at, name]));
    return this.#edit([...this.cell("Places", row, "place", name), ...(name && old ? named : [])], t("name"));
  }

  /** Add a way between two places to a route; a door at its end has its width. */
  addSegment(route, from, to) {
    const widths = [from, to].filter((one) => POINTS.has(one.kind)).map((one) => this.model.widthOf(one)).filter((one) => one !== null);
    const row = this.#freeRow("Routes");
    if (row === null) return null;
    const sheet = this.store.sheet("Routes");
    const [routeAt, segmentAt] = [sheet.column("route").at, sheet.column("segment").at];
    const own = sheet.rowNumbers.filter((one) => nameKey(sheet.value(one, routeAt)) === nameKey(route)).map((one) => String(sheet.value(one, segmentAt) ?? ""));
    const edits = [
      ...this.cell("Routes", row, "route", route), ...this.cell("Routes", row, "segment", nextName(String(own.length), own)),
      ...this.cell("Routes", row, "floor", this.model.floorValue), ...this.cell("Routes", row, "start", from.place), ...this.cell("Routes", row, "end", to.place),
      ...(widths.length ? this.length("Routes", row, "clear_width", Math.min(...widths)) : []),
    ];
    const done = this.#edit(edits, t("draw a way"));
    this.select("Routes", [row]);
    return done;
  }

  /**
   * Split a segment in two at a point, with a new place between them.
   * @returns {{row, place, x, y} | null} the new place
   */
  splitSegment(row, [x, y]) {
    const [placeRow, segmentRow] = [this.#freeRow("Places"), this.#freeRow("Routes")];
    if (placeRow === null || segmentRow === null) return null;
    const [places, sheet] = [this.store.sheet("Places"), this.store.sheet("Routes")];
    const kind = this.#choice("Places", "kind", CORRIDOR);
    const place = nextName(`${this.model.floor} ${kind ?? ""}`.trim() + " 0", places.names("place"));
    const [routeAt, segmentAt] = [sheet.column("route").at, sheet.column("segment").at];
    const own = sheet.rowNumbers.filter((one) => nameKey(sheet.value(one, routeAt)) === nameKey(sheet.value(row, routeAt)));
    const segment = nextName(sheet.value(row, segmentAt), own.map((one) => String(sheet.value(one, segmentAt) ?? "")));
    const changed = { segment, start: place };
    const copied = sheet.columns.filter((column) => column.kind !== "live" && (isFilled(sheet.value(row, column.at)) || column.field in changed))
      .map((column) => ["Routes", segmentRow, column.at, changed[column.field] ?? sheet.value(row, column.at)]);
    this.#edit([
      ...this.cell("Places", placeRow, "place", place), ...this.cell("Places", placeRow, "floor", this.model.floorValue), ...this.cell("Places", placeRow, "kind", kind),
      ...this.length("Places", placeRow, "x", x, MILLIMETRE), ...this.length("Places", placeRow, "y", y, MILLIMETRE),
      ...this.cell("Routes", row, "end", place), ...copied,
    ], t("split a way"));
    return { row: placeRow, place, x, y };
  }

  // ---- the picture and anchors

  /** Where the picture lies, as the four numbers of the floor. */
  placePicture({ left, bottom, width, turn }, label = t("place the picture")) {
    const row = this.model.plan.floor_row;
    const edits = [
      ...this.length("Floors", row, "plan_left", left, MILLIMETRE), ...this.length("Floors", row, "plan_bottom", bottom, MILLIMETRE),
      ...this.length("Floors", row, "plan_width", width, MILLIMETRE), ...this.cell("Floors", row, "plan_turn", roundTo(turn, 0.01)),
    ];
    return this.#edit(edits, label);
  }

  namePicture(name) {
    return this.#edit(this.cell("Floors", this.model.plan.floor_row, "plan", name), t("picture"));
  }

  anchor(rows, label) {
    const yes = this.#choice("Items", "anchored", ANCHORED_YES);
    return this.#edit(rows.flatMap((row) => this.cell("Items", row, "anchored", yes)), label);
  }
}
