// What gestures on the plan write into the workbook. Every function is one edit, so one step of undo.

import { axisOf, corners, direction, inUnit, nearestWall, pointInside, roundTo, standAlongWalls, wholeAngle, writeOutline } from "./plan_geometry.mjs";
import { DOOR, isPlaced, nameKey } from "./plan_model.mjs";
import { isFilled, nextName } from "./sheet.mjs";
import { notice } from "./messages.mjs";
import { t, tn } from "./texts.mjs";

const CENTIMETRE = 0.01;
const MILLIMETRE = 0.001;
const UNMOVED = 0.0005;
const CORRIDOR = 1;
const POINTS = new Set(["door", "stair", "exit"]);
const LENGTHS = new Set(["x", "y", "clear_width", "plan_left", "plan_bottom", "plan_width"]);

export class PlanEdits {
  constructor({ model, store }) {
    Object.assign(this, { model, store });
  }

  // ---- cells

  /** The cells of a row by their fields, lengths in metres; none where the workbook lacks the column, or for undefined. */
  #cells(sheetName, row, values, step = CENTIMETRE) {
    return Object.entries(values).flatMap(([field, value]) => {
      const column = this.store.sheet(sheetName)?.column(field);
      if (!column || value === undefined) return [];
      const isLength = LENGTHS.has(field) && value !== null;
      return [[sheetName, row, column.at, isLength ? inUnit(value, column, step) : Array.isArray(value) ? writeOutline(value, column) : value]];
    });
  }

  #edit(edits, label) {
    return edits.length ? this.store.edit(edits, label) : Promise.resolve(true);
  }

  /** Change cells of rows by their fields. */
  change(sheetName, rows, values, label, step = CENTIMETRE) {
    return this.#edit(rows.flatMap((row) => this.#cells(sheetName, row, values, step)), label);
  }

  /** Fill in a new row, which is selected then. */
  #addRow(sheetName, row, values, label) {
    const done = this.change(sheetName, [row], { floor: this.model.floorValue, ...values }, label);
    this.select(sheetName, [row]);
    return done;
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

  /** The columns of a row that somebody filled. */
  #filled = (sheet, row) => sheet.columns.filter((column) => column.kind !== "live" && isFilled(sheet.value(row, column.at)));

  select(sheet, rows) {
    const column = this.store.sheet(sheet)?.columns[0];
    this.store.select({ sheet, row: rows[0] ?? 0, at: column?.at ?? 0, rows }, "plan");
  }

  // ---- pieces

  /** Write new poses [{row, x, y, angle}]; what did not change is left as it stands in the cell. */
  pose(poses, label) {
    const edits = poses.flatMap(({ row, x, y, angle }) => {
      const old = this.model.pieces.get(row);
      const moved = (value, before) => (value !== undefined && (!old || Math.abs(value - before) > UNMOVED) ? value : undefined);
      const isTurned = angle !== undefined && (!old || wholeAngle(angle) !== old.angle);
      const turned = isTurned ? this.#turned(row, old, wholeAngle(angle)) : {};
      return this.#cells("Items", row, { x: moved(x, old?.x), y: moved(y, old?.y), ...turned });
    });
    return this.#edit(edits, label);
  }

  /** A new angle. An Axis that agreed with the angle before follows it, so that the two do not contradict each other. */
  #turned(row, old, angle) {
    const typed = this.model.value("Items", row, "axis");
    if (!isFilled(typed) || !old) return { angle_deg: angle };
    const { choices } = this.store.sheet("Items").column("axis");
    const [before, after] = [axisOf(old.angle), axisOf(angle)];
    const follows = before >= 0 && after >= 0 && choices[before] === typed;
    return { angle_deg: angle, axis: follows ? choices[after] : undefined };
  }

  /** Put a piece that is in the list onto the plan. */
  place(row, [x, y]) {
    const floor = this.model.isHere("Items", row) ? undefined : this.model.floorValue;
    this.select("Items", [row]);
    return this.change("Items", [row], { x, y, floor }, t("place on the plan"));
  }

  deleteRows(name, rows) {
    const sheet = this.store.sheet(name);
    return this.#edit(rows.flatMap((row) => this.#filled(sheet, row).map((column) => [name, row, column.at, null])), t("delete"));
  }

  /** The name of a new piece: after the last item of the floor, else the last of all. */
  #newItem() {
    const sheet = this.store.sheet("Items");
    const named = sheet.rowNumbers.filter((row) => this.model.text("Items", row, "item"));
    const row = named.findLast((one) => this.model.isHere("Items", one)) ?? named.at(-1);
    return row === undefined ? "A1" : nextName(this.model.value("Items", row, "item"), sheet.names("item"));
  }

  /** Add a piece of a type of the catalogue at a point. */
  add(type, [x, y]) {
    const row = this.#freeRow("Items");
    return row === null ? null : this.#addRow("Items", row, { item: this.#newItem(), type, x, y, angle_deg: 0 }, t("add"));
  }

  /** Copies of pieces, moved by a shift, in the first free rows, with names of their own. */
  copy(rows, shift) {
    const sheet = this.store.sheet("Items");
    const [names, edits, made] = [sheet.names("item"), [], []];
    let free = this.#freeRow("Items");
    for (const row of rows.filter((one) => sheet.isUsed(one))) {
      if (free === null || (sheet.capacity && free > sheet.capacity)) break;
      for (const column of this.#filled(sheet, row)) edits.push(["Items", free, column.at, this.#copied(column, sheet.value(row, column.at), names, shift)]);
      made.push(free);
      free += 1;
    }
    const done = this.#edit(edits, t("copy"));
    if (made.length) this.select("Items", made);
    return done;
  }

  #copied(column, value, names, [x, y]) {
    if (column.field === "item") return names[names.push(nextName(value, names)) - 1];
    if (column.field === "floor") return this.model.floorValue;
    const shift = { x, y }[column.field];
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
    const axes = this.store.sheet("Items").column("axis")?.choices ?? [];
    const pieces = single.map((row) => ({ row, ...model.sizeOf(row), axis: axes.indexOf(model.text("Items", row, "axis")) }));
    const others = [...model.pieces.values()].map(corners);
    const ways = [...model.segments.values()].map((one) => one.outline).filter(Boolean);
    const poses = standAlongWalls(place.outline, pieces, [...others, ...ways, ...this.#doorways()]);
    const placed = poses.map((one) => one.row);
    if (!(await this.pose(poses, t("place along the walls")))) return;
    if (poses.length) this.select("Items", placed);
    const names = (all) => all.map((row) => model.text("Items", row, "item")).join(", ");
    const [left, several] = [single.filter((row) => !placed.includes(row)), rows.filter((row) => !single.includes(row))];
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
    const { model, model: { walls } } = this;
    return [...model.places.values()].filter((one) => POINTS.has(one.kind) && isPlaced(one)).map((place) => {
      const { x, y } = place;
      const width = model.widthOf(place) ?? DOOR;
      const wall = nearestWall([x, y], walls, DOOR / 2);
      return corners({ x, y, angle: wall ? direction([0, 0], wall.d) + 90 : 0, breadth: 2 * width, width: wall ? width : 2 * width });
    });
  }

  // ---- places and segments

  /** The name and kind of a new place. */
  #newPlace(kindAt) {
    const sheet = this.store.sheet("Places");
    const kind = sheet.column("kind")?.choices[kindAt] ?? null;
    return { place: nextName(`${this.model.floor} ${kind ?? ""}`.trim() + " 0", sheet.names("place")), kind };
  }

  /** Add a place: a ring of corners, or a point; the width of a door is kept until a way leads through it. */
  addPlace(kindAt, outline, point, width = null) {
    const row = this.#freeRow("Places");
    if (row === null) return null;
    const [x, y] = point ?? pointInside(outline);
    this.model.doorWidths.set(row, width);
    return this.#addRow("Places", row, { ...this.#newPlace(kindAt), x, y, outline: outline ?? undefined }, t("draw a place"));
  }

  /** The width of a door is the clear width of the ways through it. */
  doorWidth(place, width) {
    this.model.doorWidths.set(place.row, width);
    return this.change("Routes", this.model.waysAt(place).map((one) => one.row), { clear_width: width }, t("width of a door"));
  }

  /** Another name for a place, also where segments name it. */
  renamePlace(row, name) {
    const old = nameKey(this.model.value("Places", row, "place"));
    const isNamed = (one, field) => name && old && nameKey(this.model.value("Routes", one, field)) === old;
    const named = ["start", "end"].flatMap((field) =>
      (this.store.sheet("Routes")?.rowNumbers ?? []).filter((one) => isNamed(one, field)).flatMap((one) => this.#cells("Routes", one, { [field]: name })));
    return this.#edit([...this.#cells("Places", row, { place: name }), ...named], t("name"));
  }

  /** The names of the segments of a route. */
  #segmentsOf(route) {
    const rows = this.store.sheet("Routes").rowNumbers.filter((one) => nameKey(this.model.value("Routes", one, "route")) === nameKey(route));
    return rows.map((one) => this.model.text("Routes", one, "segment"));
  }

  /** Add a way between two places to a route; a door at its end has its width. */
  addSegment(route, from, to) {
    const widths = [from, to].filter((one) => POINTS.has(one.kind)).map((one) => this.model.widthOf(one)).filter((one) => one !== null);
    const row = this.#freeRow("Routes");
    if (row === null) return null;
    const own = this.#segmentsOf(route);
    const width = widths.length ? Math.min(...widths) : undefined;
    const values = { route, segment: nextName(String(own.length), own), start: from.place, end: to.place, clear_width: width };
    return this.#addRow("Routes", row, values, t("draw a way"));
  }

  /** Split a segment in two at a point, with a new place {row, place, x, y} between them. */
  splitSegment(row, [x, y]) {
    const [placeRow, segmentRow] = [this.#freeRow("Places"), this.#freeRow("Routes")];
    if (placeRow === null || segmentRow === null) return null;
    const sheet = this.store.sheet("Routes");
    const value = (field) => this.model.value("Routes", row, field);
    const made = this.#newPlace(CORRIDOR);
    const changed = { segment: nextName(value("segment"), this.#segmentsOf(value("route"))), start: made.place };
    const copied = this.#filled(sheet, row).filter((one) => !(one.field in changed)).map((one) => ["Routes", segmentRow, one.at, sheet.value(row, one.at)]);
    this.#edit([
      ...this.#cells("Places", placeRow, { ...made, floor: this.model.floorValue, x, y }, MILLIMETRE),
      ...this.#cells("Routes", row, { end: made.place }), ...copied, ...this.#cells("Routes", segmentRow, changed),
    ], t("split a way"));
    return { row: placeRow, place: made.place, x, y };
  }

  /** Where the picture lies, as the four numbers of the floor. */
  placePicture({ left, bottom, width, turn }, label) {
    const values = { plan_left: left, plan_bottom: bottom, plan_width: width, plan_turn: roundTo(turn, 0.01) };
    return this.change("Floors", [this.model.plan.floor_row], values, label, MILLIMETRE);
  }
}
