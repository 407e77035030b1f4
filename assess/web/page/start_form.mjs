// A new workbook in three short steps, each of which can be skipped: the building, the shaking, the first room.

import { choose, clear, el, labelled } from "./elements.mjs";
import { language, languages, number, t } from "./texts.mjs";

const SUFFIX = ".xlsx";
const MOST_COUNT = 200;
const INCH = 0.0254;
const MANY = 3;

export class StartForm {
  node = el("form", { class: "steps", noValidate: true });
  #offers;
  #begin;
  #step = 0;
  #pieces = [];
  #isNamed = false;
  #fields = {};
  #steps = [];

  /**
   * @param {object} offers the answer of GET /api/start
   * @param {(request: object) => void} begin has the workbook made
   */
  constructor(offers, begin) {
    this.#offers = { uses: [], shakings: [], languages: languages(), rooms: {}, types: {}, ...offers };
    this.#begin = begin;
    this.#makeFields();
    this.#steps = [this.#buildingStep(), this.#shakingStep(), this.#roomStep()];
    this.error = el("p", { class: "error-text", role: "alert" });
    this.node.addEventListener("submit", (event) => (event.preventDefault(), this.#forward()));
    this.#followUse();
    this.#draw();
  }

  get language() {
    return this.#fields.language.value;
  }

  /** Say what is wrong, or that nothing is. */
  complain(text) {
    this.error.textContent = text;
  }

  #makeFields() {
    const f = this.#fields;
    const known = this.#offers.languages.some(([code]) => code === language());
    const text = (props) => el("input", { type: "text", autocomplete: "off", ...props });
    f.use = choose(this.#offers.uses, undefined, { on: { change: () => this.#followUse() } });
    f.building = text({ maxLength: 100, on: { input: () => this.#followName() } });
    f.town = text({ maxLength: 100 });
    f.shaking = choose([["", t("I do not know yet")], ...this.#offers.shakings.filter(([key]) => key)], "");
    f.floor = text({ value: "1", maxLength: 40, size: 8 });
    f.rooms = el("datalist", { id: "rooms-of-use" });
    f.room = text({ maxLength: 60, list: "rooms-of-use" });
    f.pieces = el("ul", { class: "pieces" });
    f.name = text({ maxLength: 80, required: true, on: { input: () => (this.#isNamed = true) } });
    f.language = choose(this.#offers.languages, known ? language() : undefined);
    f.units = choose([["si", t("centimetres, kilograms")], ["imperial", t("inches, pounds")]], "si");
    f.units.addEventListener("change", () => this.#pieces.forEach((piece) => piece.showSize()));
  }

  #buildingStep() {
    const f = this.#fields;
    return [t("1. The building"), [
      el("div", { class: "fields" },
        labelled(t("Use"), f.use, t("The list of furniture is made for it.")), labelled(t("Name of the building"), f.building),
        labelled(t("Street and town"), f.town))]];
  }

  #shakingStep() {
    const help = t("How strong the ground shakes where the building stands. It is a start: Floors and Building take recorded motions and values of a code.");
    return [t("2. How it shakes"), [el("div", { class: "fields" }, labelled(t("Shaking of the ground"), this.#fields.shaking, help))]];
  }

  #roomStep() {
    const f = this.#fields;
    const add = el("button", { type: "button", text: t("Add another type"), on: { click: () => this.#addPiece() } });
    const pieces = el("fieldset", null, el("legend", { text: t("What stands in it") }), f.pieces, el("div", { class: "buttons" }, add));
    return [t("3. The first room"), [
      el("div", { class: "fields" }, labelled(t("Floor"), f.floor), labelled(t("Room"), f.room), f.rooms), pieces,
      el("div", { class: "fields" }, labelled(t("Language of the workbook"), f.language), labelled(t("Units"), f.units))]];
  }

  #draw() {
    const [title, parts] = this.#steps[this.#step];
    const isLast = this.#step === this.#steps.length - 1;
    const button = (label, run, more) => el("button", { type: "button", text: label, on: { click: run }, ...more });
    const { name } = this.#fields;
    clear(this.node).append(
      el("ol", { class: "step-list", "aria-label": t("Steps") }, this.#steps.map(([label], at) => this.#stepLink(label, at))),
      el("fieldset", { class: "step" }, el("legend", { text: title, tabIndex: -1 }), ...parts),
      labelled(t("Name of the file"), name), this.error,
      el("div", { class: "buttons" },
        el("button", { type: "submit", class: "primary", text: isLast ? t("Make the workbook") : t("Next") }),
        this.#step > 0 && button(t("Back"), () => this.#go(this.#step - 1)),
        !isLast && button(t("Skip the rest and make it"), () => this.#send("template")),
        button(t("Blank workbook"), () => this.#send("blank"), { title: t("With every type of furniture, and no example") })));
  }

  #stepLink(label, at) {
    const current = at === this.#step ? "step" : null;
    return el("li", null, el("button", { type: "button", class: "quiet", "aria-current": current, text: label, on: { click: () => this.#go(at) } }));
  }

  #go(step) {
    this.#step = step;
    this.#draw();
    this.node.querySelector("legend").focus();
  }

  #forward() {
    if (this.#step < this.#steps.length - 1) this.#go(this.#step + 1);
    else this.#send("template");
  }

  /** Types and rooms are those of the use; pieces that it does not have go. */
  #followUse() {
    const f = this.#fields;
    const rooms = this.#offers.rooms[f.use.value] ?? [];
    clear(f.rooms).append(...rooms.map((room) => el("option", { value: room })));
    f.room.value = rooms[0] ?? "";
    this.#pieces = [];
    clear(f.pieces);
    this.#addPiece();
    this.#followName();
  }

  #addPiece() {
    const types = this.#offers.types[this.#fields.use.value] ?? [];
    if (!types.length) return;
    const next = types[Math.min((this.#pieces.length + 1) * MANY, types.length - 1)].type;
    const piece = {
      type: choose(types.map((one) => [one.type, one.label ?? one.type]), next, { "aria-label": t("Type of furniture") }),
      count: el("input", { type: "number", min: 1, max: MOST_COUNT, value: "1", "aria-label": t("How many") }),
      size: el("span", { class: "hint" }),
    };
    const showSize = () => (piece.size.textContent = describeSize(types.find((one) => one.type === piece.type.value), this.#fields.units.value));
    piece.showSize = showSize;
    piece.type.addEventListener("change", showSize);
    showSize();
    const line = el("li", null, piece.count, el("span", { "aria-hidden": "true", text: "×" }), piece.type, piece.size, this.#removal(() => {
      this.#pieces.splice(this.#pieces.indexOf(piece), 1);
      line.remove();
    }));
    this.#pieces.push(piece);
    this.#fields.pieces.append(line);
  }

  #removal(run) {
    return el("button", { type: "button", "aria-label": t("Remove this type"), title: t("Remove this type"), text: t("Remove"), on: { click: run } });
  }

  /** The name of the file follows the building until somebody types another. */
  #followName() {
    if (this.#isNamed) return;
    const { building, use, name } = this.#fields;
    const label = building.value.trim() || use.selectedOptions[0]?.textContent || t("building");
    const plain = label.normalize("NFKD").replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-+|-+$/g, "").toLowerCase();
    name.value = (plain || t("building")) + SUFFIX;
  }

  #send(kind) {
    const f = this.#fields;
    const name = f.name.value.trim();
    if (!name) {
      this.complain(t("Give the file a name."));
      f.name.focus();
      return;
    }
    const isWhole = kind === "template" && this.#step === this.#steps.length - 1;
    const pieces = isWhole ? this.#pieces.map((one) => ({ type: one.type.value, count: countOf(one.count) })) : [];
    this.#begin({
      kind, name: /\.xlsx$/i.test(name) ? name : name + SUFFIX, use: f.use.value, building: f.building.value.trim(), town: f.town.value.trim(),
      shaking: f.shaking.value, language: f.language.value, units: f.units.value, floor: f.floor.value.trim(), room: f.room.value.trim(), pieces,
    });
  }
}

const countOf = (field) => Math.min(MOST_COUNT, Math.max(1, Math.round(Number(field.value) || 1)));

/** Breadth, width and height as the catalogue has them. */
function describeSize(type, units) {
  if (!type) return "";
  const isInches = units === "imperial";
  const sizes = [type.breadth, type.width, type.height].map((one) => (one ? number(Math.round(one / (isInches ? INCH : 0.01))) : "?"));
  const values = { breadth: sizes[0], width: sizes[1], height: sizes[2] };
  return isInches ? t("{breadth} × {width} × {height} in", values) : t("{breadth} × {width} × {height} cm", values);
}
