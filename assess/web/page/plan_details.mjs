// The panel for what is selected: pieces, a room or exit, a way, with the cells that matter; of a tool that draws, how it is used.

import { badge, chanceText, classDetail, isPale } from "./classes.mjs";
import { fixButtons } from "./fixes.mjs";
import { icon } from "./icons.mjs";
import { ask } from "./messages.mjs";
import { align, distance, distribute, readNumber, roundTo } from "./plan_geometry.mjs";
import { TOOLS, WITH_WIDTH } from "./plan_draft.mjs";
import { Section } from "./plan_lists.mjs";
import { DOOR, stateCss } from "./plan_model.mjs";
import { isFilled } from "./sheet.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing } from "./vendor/lit-html.mjs";

const ALL_PIECES = ["floor", "room", "type", "breadth", "width", "height", "anchored", "against_wall"];
const PIECE_FIELDS = ["item", ...ALL_PIECES, "x", "y", "angle_deg"];
const PLACE_FIELDS = ["place", "kind", "x", "y"];
const WAY_FIELDS = ["route", "segment", "start", "end", "room", "clear_width", "required_width", "occupants"];
const WIDE = new Set(["type", "place"]);

const button = (text, run, title = "") => html`<button type="button" title=${title} @click=${run}>${text}</button>`;

export class Details extends Section {
  #shown = "";
  #typed = null; // a name while it is typed

  constructor(parts) {
    super(parts, t("Selected"));
    this.node.classList.add("details");
  }

  draw() {
    const { sheet, rows } = this.store.selection;
    const shown = `${this.currentTool().name} ${sheet} ${rows.join()}`;
    const typed = this.node.contains(document.activeElement) ? document.activeElement : {};
    if (shown !== this.#shown) {
      this.#shown = shown; // what is typed belongs to what was selected: it is written before something else is shown
      if (typed.dataset?.shown !== undefined && typed.value !== typed.dataset.shown) typed.blur();
      this.#typed = null;
    }
    super.draw();
    for (const field of this.node.querySelectorAll("[data-shown]")) { // but not over what is being typed
      const value = field.dataset.shown;
      if (field !== document.activeElement || field.was !== value) field.value = value;
      field.was = value;
    }
  }

  content() {
    const { model, store: { selection } } = this;
    const tool = this.currentTool();
    if (tool.kindAt !== undefined || tool.name === "way") return html`<h2>${TOOLS.find(([name]) => name === tool.name)[2]()}</h2><p class="muted">${tool.help()}</p>`;
    const pieces = selection.sheet === "Items" ? selection.rows.filter((row) => model.pieces.has(row)) : [];
    if (pieces.length === 1) return this.#piece(pieces[0]);
    if (pieces.length > 1) return this.#several(pieces);
    if (selection.sheet === "Places" && model.places.has(selection.row)) return this.#place(model.places.get(selection.row));
    if (selection.sheet === "Routes" && model.segments.has(selection.row)) return this.#way(model.segments.get(selection.row));
    const how = this.canEdit() ? t("Click a piece, a room, an exit or a way; drag a frame to select several pieces.") : `${t("Tap a piece, a room, an exit or a way.")} ${t("To edit, make the window at least 900 pixels wide; here the plan can be read.")}`;
    return html`<p class="muted">${how}</p><p class="muted">${tn("{n:,} piece on this floor.", "{n:,} pieces on this floor.", model.pieces.size)}</p>`;
  }

  // ---- pieces

  #piece(row) {
    const piece = this.model.pieces.get(row);
    const { key, text, live } = this.scene.pieces.classOf(piece);
    const { unit, factor } = this.model.unit;
    const sizes = ["breadth", "width", "height"].map((name) => (piece.missing.includes(name) ? "?" : number(piece[name] / factor, 2))).join(" × ");
    const lacking = piece.missing.map((name) => this.store.sheet("Items").column(name)).filter(Boolean);
    const fillIn = (column) => {
      const said = t("Fill in {size}: how far it reaches is not known.", { size: column.label });
      return this.canEdit() ? html`<button type="button" class="quiet to-cell" @click=${() => this.#reveal("Items", row, column)}>${said}</button>` : said;
    };
    return html`<h2>${this.#typed ?? piece.item}</h2>${piece.description ? html`<p>${piece.description}</p>` : nothing}
      <p>${badge(key, { isPale: isPale(live) })} ${key ? chanceText(live) : text}</p>
      ${classDetail(live) ? html`<p class="hint">${classDetail(live)}</p>` : nothing}
      <p class="muted">${t("Breadth × Width × Height: {sizes} {unit}", { sizes, unit })}</p>
      ${lacking.map((column) => html`<p class="warning-text">${fillIn(column)}</p>`)}
      ${this.canEdit() ? [this.#fields("Items", [row], PIECE_FIELDS), this.#pieceButtons([row])] : nothing}`;
  }

  #several(rows) {
    const items = rows.map((row) => this.model.pieces.get(row).item);
    return html`<h2>${tn("{n:,} piece selected", "{n:,} pieces selected", rows.length)}</h2>
      <p class="muted">${items.slice(0, 12).join(", ") + (items.length > 12 ? " …" : "")}</p>
      ${this.canEdit() ? [this.#arranging(rows), this.#fields("Items", rows, ALL_PIECES), this.#pieceButtons(rows)] : nothing}`;
  }

  #arranging(rows) {
    const pieces = () => rows.map((row) => this.model.pieces.get(row));
    const button = (name, label, poses, isOff = false) => html`<button type="button" class="square" title=${label} aria-label=${label} ?disabled=${isOff}
      @click=${() => this.edits.pose(poses(), label)}>${icon(name)}</button>`;
    const sides = [["left", t("Align left")], ["centre", t("Align centres, one above the other")], ["right", t("Align right")], ["top", t("Align top")], ["middle", t("Align centres, side by side")], ["bottom", t("Align bottom")]];
    const gaps = [["x", t("Equal gaps from left to right")], ["y", t("Equal gaps from top to bottom")]];
    return html`<div class="arranging" role="group" aria-label=${t("Align and distribute")}>
      ${sides.map(([how, label]) => button(`align-${how}`, label, () => align(pieces(), how)))}
      ${gaps.map(([name, label], axis) => button(`distribute-${name}`, label, () => distribute(pieces(), axis), rows.length < 3))}</div>`;
  }

  #pieceButtons(rows) {
    return html`<div class="buttons">${button(t("Turn 90°"), () => this.keys.turn(rows, 90), "R")}${button(t("Copy"), () => this.edits.copy(rows, [0.5, -0.5]), "Ctrl+D")}
      ${button(t("Remove…"), () => this.remove(rows), t("Delete"))}${button(t("Show in the sheet"), () => this.#reveal("Items", rows[0]))}</div>`;
  }

  #reveal(sheet, row, column = this.store.sheet(sheet).columns[0]) {
    location.hash = "#sheet";
    this.store.reveal([sheet, row, column.at]);
  }

  // ---- rooms, exits and ways

  #state(kind, row) {
    const state = this.model.stateOf(kind, row);
    return state ? html`<p class="state-line ${stateCss(state)}${this.model.routesOld ? " old" : ""}"><b>${state.word}</b> ${state.detail}</p>` : nothing;
  }

  #place(place) {
    const { row, outline } = place;
    const corners = outline ? tn("Outline with {n} corner", "Outline with {n} corners", outline.length) : t("No outline");
    const waiting = outline ? this.edits.unplacedIn(place).length : 0;
    return html`<h2>${this.#typed ?? place.place}</h2>${this.#state("place", row)}${WITH_WIDTH.includes(place.kind) ? nothing : html`<p class="muted">${corners}</p>`}
      ${this.canEdit() ? html`${this.#fields("Places", [row], PLACE_FIELDS, WITH_WIDTH.includes(place.kind) ? this.#doorWidth(place) : nothing)}
        <div class="buttons">
          ${waiting ? button(html`${icon("walls")}${tn("Place {n} piece along the walls", "Place {n} pieces along the walls", waiting)}`, () => this.edits.placeAlongWalls(place)) : nothing}
          ${outline ? button(t("Remove outline"), () => this.edits.change("Places", [row], { outline: null }, t("outline"))) : nothing}
          ${button(t("Delete…"), () => this.deleteSelected())}${button(t("Show in the sheet"), () => this.#reveal("Places", row))}</div>
        ${outline ? html`<p class="hint">${t("Drag its corners; drag the middle of a side to add one; double-click a corner to remove it.")}</p>` : nothing}` : nothing}`;
  }

  #doorWidth(place) {
    const { unit, factor } = this.model.unit;
    const width = this.model.widthOf(place);
    const required = Math.max(...this.model.waysAt(place).map((one) => this.model.length("Routes", one.row, "required_width") ?? DOOR));
    const write = ({ target }) => {
      const metres = target.value.trim() === "" ? null : readNumber(target.value) * factor;
      if (metres === null || metres > 0) this.edits.doorWidth(place, metres);
      this.draw();
    };
    return html`<label class="field" title=${t("The clear width of the ways through it.")}><span class="field-name">${t("Width")} [${unit}]</span>
      <input inputmode="decimal" autocomplete="off" placeholder=${number(DOOR / factor, 1)} data-shown=${width === null ? "" : number(roundTo(width / factor, 0.01))} @change=${write}>
      ${width !== null && width < required ? html`<span class="warning-text hint">${t("Narrower than Required width: ways through it count as blocked.")}</span>` : nothing}</label>`;
  }

  #way(one) {
    const name = `${one.route}, ${one.segment}`;
    return html`<h2>${name}</h2>${this.#state("segment", one.row)}
      <p class="muted">${one.points.length ? t("Length {length}", { length: this.model.shownLength(distance(...one.points)) }) : t("A place of it has no X and Y.")}</p>
      ${this.canEdit() ? html`${this.#fields("Routes", [one.row], WAY_FIELDS)}<div class="buttons">
        ${button(t("Delete…"), () => this.deleteSelected())}${button(t("Show in the sheet"), () => this.#reveal("Routes", one.row))}</div>` : nothing}`;
  }

  /** The place or the way that is selected. */
  async deleteSelected() {
    const { sheet, row } = this.store.selection;
    const one = { Places: this.model.places, Routes: this.model.segments }[sheet]?.get(row);
    if (!one) return;
    const name = one.place ?? `${one.route}, ${one.segment}`;
    const answer = await ask(t("Delete {name} from the workbook? Undo brings it back.", { name }), [[t("Delete"), true], [t("Cancel"), false]]);
    if (answer) this.edits.deleteRows(sheet, [row]);
  }

  // ---- fields: one a column, for the cells of all rows

  #fields(sheetName, rows, fields, more = nothing) {
    const sheet = this.store.sheet(sheetName);
    return html`<div class="cell-fields">${fields.map((field) => sheet.column(field)).filter(Boolean).map((column) => this.#field(sheet, rows, column))}${more}</div>`;
  }

  #field(sheet, rows, column) {
    const values = [...new Set(rows.map((row) => sheet.value(row, column.at) ?? ""))];
    const isMixed = values.length > 1;
    const problem = rows.length === 1 ? this.store.problemAt(sheet.name, rows[0], column.at) : null;
    const css = problem?.severity === "error" ? "error-text hint" : "warning-text hint";
    const shown = isMixed ? "" : typeof values[0] === "number" ? number(values[0]) : String(values[0]);
    const write = ({ target }) => this.#write(sheet.name, rows, column, target);
    const own = { shown, isMixed, title: problem ? problem.message : column.help, isWrong: problem?.severity === "error", write };
    return html`<label class=${WIDE.has(column.field) ? "field wide" : "field"}><span class="field-name">${column.unit ? `${column.label} [${column.unit}]` : column.label}</span>
      ${column.choices.length ? this.#choices(column, own) : this.#input(column, own)}${problem ? html`<span class=${css}>${problem.message}</span>${fixButtons(this.store, problem)}` : nothing}</label>`;
  }

  #choices(column, { shown, isMixed, title, isWrong, write }) {
    const others = shown && !column.choices.includes(shown) ? [shown] : [];
    return html`<select title=${title} aria-invalid=${isWrong} data-shown=${isMixed ? " " : shown} @change=${write}>
      ${isMixed ? html`<option value=" " hidden>${t("several")}</option>` : nothing}<option value="">–</option>${[...column.choices, ...others].map((one) => html`<option value=${one}>${one}</option>`)}</select>`;
  }

  #input(column, { shown, isMixed, title, isWrong, write }) {
    const source = column.source && this.store.sheet(column.source);
    const names = source?.found ? source.names(source.columns.find((one) => one.required)?.field ?? "") : [];
    const isName = column.field === "item" || column.field === "place";
    const typed = isName ? ({ target }) => ((this.#typed = target.value), this.draw()) : null;
    return html`<input title=${title} aria-invalid=${isWrong} autocomplete="off" inputmode=${column.kind === "number" ? "decimal" : "text"} placeholder=${isMixed ? t("several") : ""}
      list=${names.length ? `plan-list-${column.field}` : nothing} data-shown=${shown} @input=${typed} @change=${write}>
      ${names.length ? html`<datalist id="plan-list-${column.field}">${names.map((name) => html`<option value=${name}></option>`)}</datalist>` : nothing}`;
  }

  async #write(sheet, rows, column, field) {
    const value = isFilled(field.value.trim()) ? field.value.trim() : null;
    const isName = sheet === "Places" && column.field === "place";
    const done = await (isName ? this.edits.renamePlace(rows[0], value) : this.store.edit(rows.map((row) => [sheet, row, column.at, value]), column.label));
    this.#typed = null;
    if (!done && field.isConnected) field.value = field.dataset.shown;
    this.draw();
  }
}
