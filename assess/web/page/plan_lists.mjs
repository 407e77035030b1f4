// Lists beside the plan: pieces by class and those not placed yet, types to add, states of routes and rooms.

import { CLASSES, chanceText, describe, isPale } from "./classes.mjs";
import { clear, el } from "./elements.mjs";
import { nameKey } from "./plan_model.mjs";
import { shownLength } from "./plan_pieces.mjs";
import { percent, t, tn } from "./texts.mjs";

const MOST = 200;

/** A field that filters a list as one types. */
function searchField(label, draw) {
  return el("input", { type: "search", "aria-label": label, placeholder: label, on: { input: draw } });
}

const matches = (words, ...texts) => words.every((word) => texts.some((text) => nameKey(text).includes(word)));
const wordsOf = (input) => nameKey(input.value).split(" ").filter(Boolean);

export class PieceLists {
  /** @param {{model, store, scene, edits, canEdit, startDrag, goTo}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.search = searchField(t("Find a piece"), () => this.draw());
    this.unplaced = el("div", { class: "unplaced" });
    this.list = el("div", { class: "by-class" });
    this.node = el("section", { class: "plan-section", "aria-label": t("Pieces") }, this.search, this.unplaced, this.list);
  }

  draw() {
    const words = wordsOf(this.search);
    this.#drawUnplaced((this.model.plan?.unplaced ?? []).filter((one) => matches(words, one.item, one.description)));
    const found = this.scene.pieces.order().map((row) => this.model.pieces.get(row)).filter((one) => matches(words, one.item, one.description));
    const chance = (one) => this.scene.pieces.classOf(one).chance ?? 0;
    const sorted = [...found].sort((one, other) => chance(other) - chance(one)); // stable: else in the order of reading
    const groups = [...CLASSES, ""].map((key) => [key, sorted.filter((one) => this.scene.pieces.classOf(one).key === key)]).filter(([, all]) => all.length);
    clear(this.list).append(...groups.map(([key, all]) => this.#group(key, all)));
    if (!found.length) this.list.append(el("p", { class: "muted", text: t("No piece of this floor is on the plan.") }));
  }

  #group(key, pieces) {
    const { sign, word, css } = describe(key);
    const heading = el("h2", { class: "group-head" }, el("span", { class: `badge ${css}`, "aria-hidden": "true", text: sign }), ` ${word} (${pieces.length})`);
    const rest = pieces.length - MOST;
    return el("div", null, heading, el("ul", { class: "rows" }, pieces.slice(0, MOST).map((one) => this.#row(one)), rest > 0 && el("li", { text: tn("{n:,} more", "{n:,} more", rest) })));
  }

  #row(piece) {
    const { chance, isAnchored, word, live } = this.scene.pieces.classOf(piece);
    const fails = chance === null ? "" : ` ${t("{chance} if the anchor fails", { chance: percent(chance) })}`;
    const isSelected = this.scene.pieces.selected.has(piece.row);
    return el("li", null, el("button", { type: "button", class: "quiet row", "aria-pressed": String(isSelected), dataset: { row: piece.row }, on: { click: () => this.goTo("Items", piece.row, [piece.x, piece.y]) } },
      el("b", { text: piece.item }), el("span", { text: piece.description }), el("span", { class: "end", text: live?.class ? chanceText(live) || (isPale(live) ? "≈" : "") : isAnchored ? `⚓ ${word}${fails}` : word })));
  }

  #drawUnplaced(rows) {
    clear(this.unplaced);
    if (!rows.length) return;
    this.unplaced.append(el("h2", { class: "group-head", text: t("Not on the plan ({n})", { n: rows.length }) }));
    if (this.canEdit()) this.unplaced.append(el("p", { class: "hint", text: t("Drag one onto the plan, or press Enter to put it in the middle.") }));
    this.unplaced.append(el("ul", { class: "rows" }, rows.slice(0, MOST).map((one) => this.#unplacedRow(one))));
  }

  #unplacedRow(one) {
    const place = (at) => this.edits.place(one.row, at);
    const button = el("button", { type: "button", class: "quiet row draggable", disabled: !this.canEdit(), dataset: { row: one.row } }, el("b", { text: one.item }), el("span", { text: one.description }));
    if (this.canEdit()) this.startDrag(button, () => this.#sizeOf(one.row), place);
    return el("li", null, button);
  }

  #sizeOf(row) {
    const type = this.model.types.find((one) => nameKey(one.type) === nameKey(this.model.text("Items", row, "type")));
    const size = (field) => this.model.length("Items", row, field) ?? type?.[field] ?? null;
    const breadth = size("breadth") ?? 0.4;
    return { breadth, width: size("width") ?? breadth, angle: this.model.length("Items", row, "angle_deg") ?? 0 };
  }
}

export class TypeList {
  /** @param {{model, edits, startDrag}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.search = searchField(t("Find a type"), () => this.draw());
    this.list = el("ul", { class: "rows types" });
    this.node = el("section", { class: "plan-section", "aria-label": t("Add") }, this.search, el("p", { class: "hint", text: t("Drag a type onto the plan, or press Enter to put it in the middle. Each becomes a row of the sheet.") }), this.list);
  }

  async draw() {
    const types = await this.model.loadTypes().catch(() => []);
    const words = wordsOf(this.search);
    const found = types.filter((one) => matches(words, one.type));
    clear(this.list).append(...found.slice(0, MOST).map((one) => this.#row(one)));
    if (!found.length) this.list.append(el("li", { class: "muted", text: types.length ? t("No type has such a name.") : t("The catalogue of this workbook is empty.") }));
  }

  #row(one) {
    const { unit, factor } = this.model.unit;
    const sizes = [one.breadth, one.width, one.height].map((size) => (size ? shownLength(size, { unit: "", factor }).trim() : "?")).join(" × ");
    const button = el("button", { type: "button", class: "quiet row draggable", dataset: { type: one.type } }, el("b", { text: one.type }), el("span", { class: "end", text: `${sizes} ${unit}` }));
    const breadth = one.breadth ?? 0.4;
    this.startDrag(button, () => ({ breadth, width: one.width ?? breadth, angle: 0 }), (at) => this.edits.add(one.type, at));
    return el("li", null, button);
  }
}

export class RouteLists {
  #all = false;
  #isOpen = false;

  /** @param {{model, store, goTo}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.node = el("section", { class: "plan-section", "aria-label": t("Routes") });
  }

  draw() {
    const { model } = this;
    const { routes } = model;
    clear(this.node);
    if (!routes) {
      this.node.append(el("p", { class: "muted", text: t("Computing…") }));
      return;
    }
    this.node.classList.toggle("old", model.routesOld);
    this.node.setAttribute("aria-busy", String(model.routesOld));
    if (routes.error) this.node.append(el("p", { class: "error-text", text: routes.error }));
    if (!routes.routes.length && !routes.rooms.length) {
      this.node.append(el("p", { class: "muted", text: t("The workbook has no routes. Draw rooms, doors and exits, then segments between them: their states are shown here.") }), ...this.#drawn());
      return;
    }
    this.node.append(this.#switch(), ...this.#group(t("Routes"), this.#routes()), ...this.#group(t("Rooms"), this.#rooms()), ...this.#drawn(), ...this.#remarks(routes));
  }

  /** All places and segments of the floor, so that each can be reached by keys. */
  #drawn() {
    const { places, segments } = this.model;
    const row = (name, about, run) => el("li", null, el("button", { type: "button", class: "quiet row", on: { click: run } }, el("b", { text: name }), el("span", { class: "end", text: about })));
    const rows = [
      ...[...places.values()].map((one) => row(one.place, this.model.text("Places", one.row, "kind"), () => this.goTo("Places", one.row))),
      ...[...segments.values()].map((one) => row(`${one.route}, ${one.segment}`, `${one.from} – ${one.to}`, () => this.goTo("Routes", one.row))),
    ];
    if (!rows.length) return [];
    const details = el("details", { open: this.#isOpen, on: { toggle: () => (this.#isOpen = details.open) } }, el("summary", { text: t("Places and segments of this floor ({n})", { n: rows.length }) }), el("ul", { class: "rows" }, rows));
    return [details];
  }

  #switch() {
    const box = el("input", { type: "checkbox", checked: this.#all });
    box.addEventListener("change", () => ((this.#all = box.checked), this.draw()));
    return el("label", { class: "check" }, box, t("Of all floors"));
  }

  #routes() {
    const own = new Map();
    for (const one of this.model.segments.values()) own.set(nameKey(one.route), [...(own.get(nameKey(one.route)) ?? []), one.row]);
    return this.model.routes.routes.filter((one) => this.#all || own.has(nameKey(one.route)))
      .map((one) => this.#row(one.route, one, () => this.goTo("Routes", own.get(nameKey(one.route)) ?? []), own.has(nameKey(one.route))));
  }

  #rooms() {
    return this.model.routes.rooms.filter((one) => this.#all || nameKey(one.floor) === nameKey(this.model.floor))
      .map((one) => this.#row(one.room, one, () => this.goTo("Places", one.place_row), this.model.places.has(one.place_row)));
  }

  #group(title, rows) {
    return rows.length ? [el("h2", { class: "group-head", text: `${title} (${rows.length})` }), el("ul", { class: "rows states" }, rows)] : [];
  }

  #row(name, state, run, isHere) {
    const css = `state-${state.standing ? "standing" : state.state.replace("_", "-")}`;
    return el("li", null, el("button", { type: "button", class: `quiet row ${css}`, disabled: !isHere, title: state.detail, on: { click: run } },
      el("span", { class: "state-word", text: state.word }), el("b", { text: name }), el("span", { class: "detail", text: state.detail })));
  }

  #remarks({ remarks }) {
    return remarks.length ? [el("details", null, el("summary", { text: t("About these states") }), remarks.map((text) => el("p", { class: "hint", text })))] : [];
  }
}
