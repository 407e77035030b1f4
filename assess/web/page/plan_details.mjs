// The panel for what is selected: a piece, several, a place, a segment, with the cells that matter.

import { badge, chanceText, classDetail, isPale } from "./classes.mjs";
import { clear, el } from "./elements.mjs";
import { fixButtons } from "./fixes.mjs";
import { ask } from "./messages.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { isFilled } from "./sheet.mjs";
import { number, t, tn } from "./texts.mjs";

const PIECE_FIELDS = ["item", "room", "type", "anchored", "x", "y", "angle_deg", "against_wall"];
const PLACE_FIELDS = ["place", "kind", "x", "y"];
const WIDE = new Set(["type", "place"]);
const SEGMENT_FIELDS = ["route", "segment", "start", "end", "room", "clear_width", "required_width", "occupants"];

export class Details {
  #shown = "";

  /** @param {{model, store, scene, edits, canEdit, remove, keys}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.node = el("section", { class: "plan-section details", "aria-label": t("Selected") });
  }

  draw() {
    const { selection } = this.store;
    const { model } = this;
    if (this.node.contains(document.activeElement) && document.activeElement.matches("input, select") && this.#shown === this.#key()) return;
    this.#shown = this.#key();
    clear(this.node);
    const pieces = selection.sheet === "Items" ? selection.rows.filter((row) => model.pieces.has(row)) : [];
    if (pieces.length === 1) this.#piece(pieces[0]);
    else if (pieces.length > 1) this.#several(pieces);
    else if (selection.sheet === "Places" && model.places.has(selection.row)) this.#place(selection.row);
    else if (selection.sheet === "Routes" && model.segments.has(selection.row)) this.#segment(selection.row);
    else this.#nothing();
  }

  #key() {
    const { sheet, rows } = this.store.selection;
    return `${sheet} ${rows.join()}`;
  }

  #add(...children) {
    this.node.append(...children.filter(Boolean));
  }

  #nothing() {
    const count = this.model.pieces.size;
    this.#add(el("p", { class: "muted", text: this.canEdit() ? t("Click a piece, a place or a segment; drag a frame to select several pieces.") : t("Tap a piece, a place or a segment.") }),
      el("p", { class: "muted", text: tn("{n:,} piece on this floor.", "{n:,} pieces on this floor.", count) }));
  }

  // ---- pieces

  #piece(row) {
    const piece = this.model.pieces.get(row);
    const { key, word, live } = this.scene.pieces.classOf(piece);
    const unit = this.model.unit;
    const sizes = ["breadth", "width", "height"].map((name) => (piece.missing.includes(name) ? "?" : number(piece[name] / unit.factor, 2))).join(" × ");
    this.#add(
      el("h2", { text: piece.item }), piece.description && el("p", { text: piece.description }),
      el("p", { class: "class-line" }, badge(key, { isPale: isPale(live) }), ` ${key ? chanceText(live) : word}`),
      classDetail(live) && el("p", { class: "hint", text: classDetail(live) }),
      el("p", { class: "muted", text: t("Breadth × Width × Height: {sizes} {unit}", { sizes, unit: unit.unit }) }),
      ...piece.missing.map((name) => this.#lacking(row, name)));
    if (!this.canEdit()) return;
    this.#add(this.#fields("Items", row, PIECE_FIELDS), this.#pieceButtons([row]));
  }

  /** A size that is not known, and the way to its cell. */
  #lacking(row, name) {
    const column = this.store.sheet("Items").column(name);
    if (!column) return null;
    const text = t("Fill in {size}: how far it reaches is not known.", { size: column.label });
    return el("p", { class: "warning-text" }, this.canEdit() ? this.#button(text, () => this.#reveal("Items", row, column), { class: "quiet to-cell" }) : text);
  }

  #several(rows) {
    const pieces = rows.map((row) => this.model.pieces.get(row));
    this.#add(el("h2", { text: tn("{n:,} piece selected", "{n:,} pieces selected", rows.length) }),
      el("p", { class: "muted", text: pieces.slice(0, 12).map((one) => one.item).join(", ") + (pieces.length > 12 ? " …" : "") }));
    if (this.canEdit()) this.#add(this.#pieceButtons(rows));
  }

  #button(text, run, props = {}) {
    return el("button", { type: "button", text, on: { click: run }, ...props });
  }

  #pieceButtons(rows) {
    return el("div", { class: "buttons" },
      this.#button(t("Turn 90°"), () => this.keys.turn(rows, 90), { title: "R" }),
      this.#button(t("Copy"), () => this.edits.copy(rows, [0.5, -0.5]), { title: "Ctrl+D" }),
      this.#button(t("Remove…"), () => this.remove(rows), { title: t("Delete") }),
      this.#button(t("Show in the sheet"), () => this.#reveal("Items", rows[0])));
  }

  #reveal(sheet, row, column = this.store.sheet(sheet).columns[0]) {
    location.hash = "#sheet";
    this.store.reveal([sheet, row, column.at]);
  }

  // ---- places and segments

  #state(kind, row) {
    const state = this.model.stateOf(kind, row);
    return state && el("p", { class: `state-line state-${state.standing ? "standing" : state.state.replace("_", "-")}${this.model.routesOld ? " old" : ""}` }, el("b", { text: state.word }), " ", state.detail);
  }

  #place(row) {
    const place = this.model.places.get(row);
    const corners = place.outline ? tn("Outline with {n} corner", "Outline with {n} corners", place.outline.length) : t("No outline");
    this.#add(el("h2", { text: place.place }), this.#state("place", row), el("p", { class: "muted", text: corners }));
    if (!this.canEdit()) return;
    this.#add(this.#fields("Places", row, PLACE_FIELDS), el("div", { class: "buttons" },
      place.outline && this.#button(t("Take the outline away"), () => this.edits.outline(row, null, t("outline"))),
      this.#button(t("Delete…"), () => this.#delete("Places", row, place.place)), this.#button(t("Show in the sheet"), () => this.#reveal("Places", row))));
    if (place.outline) this.#add(el("p", { class: "hint", text: t("Drag its corners; drag the middle of a side to add one; double-click a corner to take it out.") }));
  }

  #segment(row) {
    const one = this.model.segments.get(row);
    const length = one.points.length === 2 ? Math.hypot(one.points[1][0] - one.points[0][0], one.points[1][1] - one.points[0][1]) : null;
    this.#add(el("h2", { text: `${one.route}, ${one.segment}` }), this.#state("segment", row),
      el("p", { class: "muted", text: length === null ? t("A place of it has no X and Y.") : t("Length {length}", { length: shownLength(length, this.model.unit) }) }));
    if (!this.canEdit()) return;
    this.#add(this.#fields("Routes", row, SEGMENT_FIELDS), el("div", { class: "buttons" },
      this.#button(t("Delete…"), () => this.#delete("Routes", row, `${one.route}, ${one.segment}`)), this.#button(t("Show in the sheet"), () => this.#reveal("Routes", row))));
  }

  /** The place or the segment that is selected. */
  deleteSelected() {
    const { sheet, row } = this.store.selection;
    const [place, segment] = [this.model.places.get(row), this.model.segments.get(row)];
    if (sheet === "Places" && place) this.#delete(sheet, row, place.place);
    else if (sheet === "Routes" && segment) this.#delete(sheet, row, `${segment.route}, ${segment.segment}`);
  }

  async #delete(sheet, row, name) {
    const answer = await ask(t("Delete {name} from the workbook? Undo brings it back.", { name }), [[t("Delete"), true], [t("Cancel"), false]]);
    if (answer) this.edits.deleteRows(sheet, [row]);
  }

  // ---- fields: one a cell

  #fields(sheetName, row, fields) {
    const sheet = this.store.sheet(sheetName);
    const columns = fields.map((field) => sheet.column(field)).filter(Boolean);
    return el("div", { class: "cell-fields" }, columns.map((column) => this.#field(sheet, row, column)));
  }

  #field(sheet, row, column) {
    const value = sheet.value(row, column.at);
    const problem = this.store.problemAt(sheet.name, row, column.at);
    const label = column.unit ? `${column.label} [${column.unit}]` : column.label;
    const input = column.choices.length ? this.#choices(column, value) : this.#input(column, value);
    input.addEventListener("change", () => this.#write(sheet.name, row, column, input.value));
    input.title = problem ? problem.message : column.help;
    if (problem?.severity === "error") input.setAttribute("aria-invalid", "true");
    const isWide = WIDE.has(column.field);
    return el("label", { class: isWide ? "field wide" : "field" }, el("span", { class: "field-name", text: label }), input, problem && el("span", { class: problem.severity === "error" ? "error-text hint" : "warning-text hint", text: problem.message }), problem && fixButtons(this.store, problem));
  }

  #choices(column, value) {
    const options = ["", ...column.choices, ...(isFilled(value) && !column.choices.includes(value) ? [String(value)] : [])];
    const select = el("select", null, options.map((one) => el("option", { value: one, text: one || "–" })));
    select.value = isFilled(value) ? String(value) : "";
    return select;
  }

  #input(column, value) {
    const input = el("input", { value: typeof value === "number" ? number(value) : value ?? "", autocomplete: "off", inputMode: column.kind === "number" ? "decimal" : "text" });
    const source = column.source && this.store.sheet(column.source);
    const names = source?.found ? source.names(source.columns.find((one) => one.required)?.field ?? "") : [];
    if (!names.length) return input;
    const id = `plan-list-${column.field}`;
    input.setAttribute("list", id);
    this.#add(el("datalist", { id }, names.map((name) => el("option", { value: name }))));
    return input;
  }

  #write(sheet, row, column, text) {
    const value = text.trim() === "" ? null : text.trim();
    if (sheet === "Places" && column.field === "place") this.edits.renamePlace(row, value);
    else this.store.edit([[sheet, row, column.at, value]], column.label);
  }
}
