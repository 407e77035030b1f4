// A new building on one screen: what it is, how it shakes, what stands in its first room. Most may stay blank.

import { get } from "./api.mjs";
import { el, field } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { language, languages, number, t, tn } from "./texts.mjs";
import { html, nothing, render, svg } from "./vendor/lit-html.mjs";

const SUFFIX = ".xlsx";
const MOST_COUNT = 200;
const MOST_RECORDS = 2;
const [INCH, FOOT] = [0.0254, 0.3048];
const MANY = 3;
const PEAKS = "peaks";
const RECORD = "record";
const POINT = /^\s*([-+]?\d{1,3}(?:[.,]\d+)?)\s*°?\s*([NS]?)\s*[,;\s]\s*([-+]?\d{1,3}(?:[.,]\d+)?)\s*°?\s*([EWO]?)\s*$/i;
const TYPED = ["building", "address", "storeys", "height", "structure", "floor", "room"];

export class StartForm {
  node = el("form", { class: "new", noValidate: true });
  #offers;
  #begin;
  #leave;
  #values = { building: "", address: "", coordinates: "", storeys: "", height: "", structure: "", shaking: "", ground_pga: "", ground_pgv: "", floor: "0", room: "", units: "si", name: "" };
  #records = [];
  #pieces = [];
  #map = null;
  #said = "";

  /** `offers` are of GET /api/start, `begin(request, records)` has the workbook made, `leave` goes back to the choices. */
  constructor(offers, begin, leave) {
    this.#offers = { languages: languages(), ...offers };
    this.#begin = begin;
    this.#leave = leave;
    const codes = this.#offers.languages.map(([code]) => code);
    this.#values.use = offers.uses[0][0];
    this.#values.language = codes.includes(language()) ? language() : codes[0];
    this.node.addEventListener("submit", (event) => (event.preventDefault(), this.#send("template")));
    this.#followUse();
  }

  /** Say what is wrong, and show the field. */
  complain(text, field = "") {
    this.#said = text;
    this.#draw();
    this.node.querySelector(`[name="${field === "latitude" || field === "longitude" ? "coordinates" : field}"]`)?.focus();
  }

  #draw() {
    const { shaking } = this.#values;
    const { can_save: canSave, folder } = this.#offers;
    const shakings = [["", t("I do not know yet")], ...this.#offers.shakings, [PEAKS, t("I know PGA and PGV")], [RECORD, t("I have a record of the nearest station")]];
    const place = canSave
      ? t("It is made in the folder {folder}, in which assess open was started, and every change is saved in it.", { folder })
      : t("It is kept while this page is in use: download it when you are done.");
    render(html`
      <h2>${t("New building")}</h2>
      <p class="muted">${t("Only the name of the file is needed; the rest can be filled in later.")}</p>
      <div class="columns">
        <fieldset><legend>${t("The building")}</legend>${this.#building()}</fieldset>
        <div class="rest"><fieldset><legend>${t("How it shakes")}</legend>
          ${this.#choice("shaking", t("Shaking of the ground"), shakings, t("How strong the ground shakes where the building stands."))}
          ${shaking === PEAKS ? html`<div class="fields">${this.#number("ground_pga", t("Ground PGA"))}${this.#number("ground_pgv", t("Ground PGV"))}</div>` : nothing}
          ${shaking === RECORD ? this.#recordField() : nothing}
        </fieldset>
        <fieldset><legend>${t("The first pieces")}</legend>${this.#room()}</fieldset>
        <fieldset><legend>${t("The workbook")}</legend>
          ${this.#text("name", t("Name of the file"), this.#name)}
          <div class="fields">${this.#choice("language", t("Language of the workbook"), this.#offers.languages)}
            ${this.#choice("units", t("Units"), [["si", t("centimetres, kilograms")], ["imperial", t("inches, pounds")]])}</div>
          <p class="hint">${place}</p>
        </fieldset></div>
      </div>
      <p class="error-text fault" role="alert">${this.#said}</p>
      <div class="buttons">
        <button type="submit" class="primary">${t("Make the workbook")}</button>
        <button type="button" @click=${this.#leave}>${t("Back")}</button>
        <button type="button" title=${t("With every type of furniture, and no example")} @click=${() => this.#send("blank")}>${t("Blank workbook")}</button>
      </div>`, this.node);
  }

  #building() {
    const { storeys, height } = this.#values;
    const [, , unit] = this.#range("height");
    const each = this.#offers.storey / (unit === "ft" ? FOOT : 1);
    const assumed = storeys.trim() && !height.trim() && !this.#fault("storeys")
      ? t("Blank: {height} {unit} is assumed, {each} {unit} a storey.", { height: number(each * Number(storeys), 3), each: number(each, 3), unit }) : "";
    const load = async (event) => {
      if (event.target.open) this.#map ??= await get("/api/map").catch(() => null);
      this.#draw();
    };
    return html`
      <div class="fields">${this.#choice("use", t("Use"), this.#offers.uses)}${this.#text("building", t("Name of the building"))}</div>
      ${this.#text("address", t("Street and town"))}
      <div class="fields">${this.#number("storeys", t("Storeys"))}${this.#number("height", t("Height"), assumed)}
        ${this.#choice("structure", t("Structure"), [["", t("I do not know")], ...this.#offers.structures.filter(([key]) => key !== "unknown")])}</div>
      ${this.#text("coordinates", t("Coordinates"), this.#values.coordinates, t("Latitude and longitude, such as 37.87, -122.27."))}
      <details @toggle=${load}><summary>${t("On the map of San Francisco Bay")}</summary>${this.#map ? this.#drawMap() : nothing}</details>`;
  }

  #recordField() {
    const take = (event) => ((this.#records = [...event.target.files].slice(0, MOST_RECORDS)), this.#draw());
    return html`<div class="field"><label class="field-name" for="new-records">${t("Record of the nearest station")}</label>
      <input type="file" id="new-records" name="records" multiple aria-describedby="new-records-help" @change=${take}><span class="hint" id="new-records-help">${t("One or two horizontal components, in any format that assess reads. They become Record X and Record Y of floor 0, whose motion serves the floors above.")}</span></div>`;
  }

  #room() {
    const { use } = this.#values;
    const types = this.#offers.types[use] ?? [];
    const n = this.#fault("storeys") ? 0 : Number(this.#values.storeys);
    const isAbove = n && Number(/\d+/.exec(this.#values.floor)?.[0] ?? 0) >= n;
    const about = isAbove ? tn("The building has {n} storey: its only floor is 0.", "The building has {n} storeys: its floors are 0 to {top}.", n, { top: n - 1 })
      : t("0 is the ground floor.");
    return html`
      <div class="fields">${this.#text("floor", t("Floor"), this.#values.floor, about)}${this.#text("room", t("Room"), this.#values.room, "", "rooms-of-use")}</div>
      <datalist id="rooms-of-use">${(this.#offers.rooms[use] ?? []).map((room) => html`<option value=${room}></option>`)}</datalist>
      <ul class="pieces">${this.#pieces.map((piece, at) => html`<li>
        <input type="number" min="1" max=${MOST_COUNT} .value=${piece.count} aria-label=${t("How many")} @input=${(event) => (piece.count = event.target.value)}>
        <span aria-hidden="true">×</span>
        <select aria-label=${t("Type of furniture")} @change=${(event) => ((piece.type = event.target.value), this.#draw())}>
          ${types.map(({ type }) => html`<option value=${type} .selected=${type === piece.type}>${type}</option>`)}</select>
        <button type="button" class="quiet square" aria-label=${t("Remove this type")} title=${t("Remove this type")} @click=${() => (this.#pieces.splice(at, 1), this.#draw())}>${icon("close")}</button>
        <span class="hint">${describeSize(types.find((one) => one.type === piece.type), this.#values.units)}</span></li>`)}</ul>
      <div class="buttons"><button type="button" @click=${() => (this.#addPiece(), this.#draw())}>${icon("plus")} ${t("Add another type")}</button></div>`;
  }

  /** The map that comes along: a click sets the coordinates. */
  #drawMap() {
    const [west, south, east, north] = this.#map.edges;
    const across = Math.cos(((south + north) / 2) * (Math.PI / 180));
    const place = ([x, y]) => `${((x - west) * across).toFixed(4)} ${(north - y).toFixed(4)}`;
    const point = readPoint(this.#values.coordinates);
    const pick = (event) => {
      const box = event.currentTarget.getBoundingClientRect();
      const at = [north - ((event.clientY - box.top) / box.height) * (north - south), west + ((event.clientX - box.left) / box.width) * (east - west)];
      this.#set("coordinates", at.map((one) => one.toFixed(4)).join(", "));
    };
    return html`<svg class="map" role="img" aria-label=${t("Map of San Francisco Bay")} viewBox="0 0 ${(east - west) * across} ${north - south}" @click=${pick}>
      <path d=${this.#map.land.map((ring) => `M${ring.map(place).join("L")}Z`).join("")}></path>
      ${point ? svg`<circle cx=${(point[1] - west) * across} cy=${north - point[0]} r="0.03"></circle>` : nothing}</svg>
      <p class="hint">${t("A click sets the coordinates.")}</p>`;
  }

  // ---- fields, and what is wrong with what is typed

  #set(name, value) {
    this.#values[name] = value;
    if (name === "use") this.#followUse();
    else this.#draw();
  }

  #text(name, label, value = this.#values[name], help = "", list = nothing) {
    const fault = this.#fault(name);
    return html`<div class="field"><label class="field-name" for="new-${name}">${label}</label>
      <input type="text" id="new-${name}" name=${name} autocomplete="off" maxlength="200" list=${list} .value=${value} aria-invalid=${fault ? "true" : nothing} aria-describedby="new-${name}-help" @input=${(event) => this.#set(name, event.target.value)}>
      <span class=${fault ? "hint error-text" : "hint"} id="new-${name}-help" aria-live="polite">${fault || help}</span></div>`;
  }

  #number(name, label, help = "") {
    const unit = this.#range(name)[2];
    return this.#text(name, unit ? `${label} [${unit}]` : label, this.#values[name], help);
  }

  #choice(name, label, options, help = "") {
    const list = options.map(([key, text]) => html`<option value=${key} .selected=${key === this.#values[name]}>${text}</option>`);
    return field(label, html`<select name=${name} @change=${(event) => this.#set(name, event.target.value)}>${list}</select>`, help);
  }

  #range(name) {
    return this.#offers.ranges[this.#values.units][name];
  }

  #fault(name) {
    const text = (this.#values[name] ?? "").trim();
    if (name === "coordinates") return !text || readPoint(text) ? "" : t("Type latitude and longitude, such as 37.87, -122.27.");
    const range = this.#range(name);
    if (!range || !text) return "";
    const [low, high, unit] = range;
    const value = Number(text.replace(",", "."));
    if (Number.isNaN(value) && name !== "storeys" && /^[-+]?[\d.,]+ *\D+$/.test(text)) return ""; // with its unit, which the server reads
    if (value >= low && value <= high && (name !== "storeys" || Number.isInteger(value))) return "";
    if (name === "storeys") return t("Type a whole number from {low} to {high}.", { low, high });
    return t("Type a number from {low} to {high} {unit}.", { low: number(low), high: number(high), unit });
  }

  /** Rooms and types are those of the use; pieces that it does not have go. */
  #followUse() {
    this.#values.room = this.#offers.rooms[this.#values.use]?.[0] ?? "";
    this.#pieces = [];
    this.#addPiece();
    this.#draw();
  }

  #addPiece() {
    const types = this.#offers.types[this.#values.use] ?? [];
    if (types.length) this.#pieces.push({ count: "1", type: types[Math.min((this.#pieces.length + 1) * MANY, types.length - 1)].type });
  }

  /** The name of the file follows the building until somebody types another. */
  get #name() {
    const { building, use, name } = this.#values;
    if (name) return name;
    const label = building.trim() || this.#offers.uses.find(([key]) => key === use)[1];
    const plain = label.normalize("NFKD").replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-+|-+$/g, "").toLowerCase();
    return (plain || t("building")) + SUFFIX;
  }

  #send(kind) {
    const v = this.#values;
    const wrong = ["coordinates", "storeys", "height", ...(v.shaking === PEAKS ? ["ground_pga", "ground_pgv"] : [])].find((one) => this.#fault(one));
    if (wrong) return this.complain(this.#fault(wrong), wrong);
    const [latitude, longitude] = readPoint(v.coordinates) ?? ["", ""];
    const peaks = v.shaking === PEAKS ? { ground_pga: v.ground_pga, ground_pgv: v.ground_pgv } : {};
    const records = v.shaking === RECORD ? this.#records : [];
    const pieces = this.#pieces.map((one) => ({ type: one.type, count: Math.min(MOST_COUNT, Math.max(1, Math.round(Number(one.count) || 1))) }));
    const typed = Object.fromEntries(TYPED.map((one) => [one, v[one].trim()]));
    const name = this.#name.trim();
    this.#said = "";
    this.#draw();
    return this.#begin({
      ...typed, ...peaks, kind, name: /\.xlsx$/i.test(name) ? name : name + SUFFIX, use: v.use, language: v.language, units: v.units,
      latitude: String(latitude), longitude: String(longitude), shaking: [PEAKS, RECORD].includes(v.shaking) ? "" : v.shaking, records: records.map((one) => one.name), pieces,
    }, records);
  }
}

/** Latitude and longitude as they are typed, null where they cannot be read: 37.87, -122.27; 43,7° N 11,2° E. */
function readPoint(text) {
  const found = POINT.exec(text);
  if (!found) return null;
  const [, y, ns, x, ew] = found;
  const [latitude, longitude] = [y, x].map((one) => Number(one.replace(",", ".")));
  const point = [/s/i.test(ns) ? -latitude : latitude, /[wo]/i.test(ew) ? -longitude : longitude];
  return Math.abs(point[0]) <= 90 && Math.abs(point[1]) <= 180 ? point : null;
}

/** Breadth, width and height as the catalogue has them. */
function describeSize(type, units) {
  if (!type) return "";
  const isInches = units === "imperial";
  const size = (one) => (one ? number(Math.round(one / (isInches ? INCH : 0.01))) : "?");
  const values = { breadth: size(type.breadth), width: size(type.width), height: size(type.height) };
  return isInches ? t("{breadth} × {width} × {height} in", values) : t("{breadth} × {width} × {height} cm", values);
}
