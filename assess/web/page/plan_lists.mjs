// The panel's lists: pieces by class and those not placed yet, types to add, states of routes and rooms; and dragging from them.

import { CLASSES, classStyle, describe } from "./classes.mjs";
import { el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { corners, roundTo } from "./plan_geometry.mjs";
import { nameKey, stateCss } from "./plan_model.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const MOST = 200;

/** A section of the panel: `content()` is its template. */
export class Section {
  constructor(parts, label) {
    Object.assign(this, parts, { node: el("section", { class: "plan-section", "aria-label": label }) });
  }

  draw() {
    render(this.content(), this.node);
  }
}

/** A section with a field by which its list is filtered. */
class List extends Section {
  words = [];

  search(label) {
    const filter = ({ target }) => ((this.words = nameKey(target.value).split(" ").filter(Boolean)), this.draw());
    return html`<input type="search" aria-label=${label} placeholder=${label} @input=${filter}>`;
  }

  matches = (...texts) => this.words.every((word) => texts.some((text) => nameKey(text).includes(word)));

  /** The first rows of a list, and how many more there are. */
  rows(all, row) {
    const rest = all.length - MOST;
    return html`<ul class="rows">${all.slice(0, MOST).map(row)}${rest > 0 ? html`<li>${tn("{n:,} more", "{n:,} more", rest)}</li>` : nothing}</ul>`;
  }

  /** Buttons are dragged onto the plan, or put in its middle by Enter; `find(dataset)` has the size() of one, and drop(at). */
  dragFrom(find) {
    let held = null; // {from, button, size, drop}
    let ghost = null;
    const end = () => {
      ghost?.remove();
      held = ghost = null;
      this.scene.sketch();
    };
    const on = (name, run) => this.node.addEventListener(name, (event) => run(event, event.target.closest(".draggable:not(:disabled)")));
    on("pointerdown", (event, button) => {
      if (event.button !== 0 || !button) return;
      held = { from: [event.clientX, event.clientY], button, ...find(button.dataset) };
      button.setPointerCapture(event.pointerId);
    });
    on("pointermove", (event) => {
      if (!held || (!ghost && !isDrag(held.from, [event.clientX, event.clientY]))) return;
      if (!ghost) document.body.append((ghost = el("div", { class: "plan-ghost", text: held.button.innerText })));
      ghost.style.setProperty("transform", `translate(${event.clientX + 12}px, ${event.clientY + 12}px)`);
      const found = this.#aim(event, held.size());
      ghost.hidden = found !== null;
      this.scene.sketch(found ? [{ name: "drawn", points: corners(found.piece), isClosed: true }] : [], [], found?.guides);
    });
    on("pointerup", (event) => {
      if (!held) return;
      const found = ghost && this.#aim(event, held.size());
      const { drop } = held;
      end();
      if (found) drop([found.piece.x, found.piece.y]);
    });
    on("pointercancel", end);
    on("keydown", (event, button) => {
      if (event.key === "Escape" && ghost) end();
      if (event.key !== "Enter" || !button) return;
      event.preventDefault();
      find(button.dataset).drop(this.viewport.centre.map((one) => roundTo(one, 0.01)));
    });
  }

  /** Where a piece would stand under the pointer; null outside the drawing. */
  #aim({ clientX, clientY, altKey }, size) {
    const at = this.viewport.toLocal(clientX, clientY);
    if (this.viewport.size.some((most, i) => at[i] < 0 || at[i] > most)) return null;
    const [x, y] = this.viewport.toWorld(at);
    const { at: [sx, sy], guides } = this.select.snapNew({ ...size, x, y }, altKey);
    return { piece: { ...size, x: sx, y: sy }, guides };
  }
}

export class PieceLists extends List {
  constructor(parts) {
    super(parts, t("Pieces"));
    this.dragFrom(({ row }) => ({ size: () => this.model.sizeOf(Number(row)), drop: (at) => this.edits.place(Number(row), at) }));
  }

  content() {
    const { model, scene: { pieces } } = this;
    const found = (all) => all.filter((one) => this.matches(one.item, one.description)).map((piece) => ({ piece, shown: pieces.classOf(piece) }));
    const placed = found(pieces.order().map((row) => model.pieces.get(row))).sort((a, b) => (b.shown.chance ?? -1) - (a.shown.chance ?? -1));
    const groups = [...CLASSES, ""].map((key) => [key, placed.filter((one) => one.shown.key === key)]).filter(([, all]) => all.length);
    return html`${this.search(t("Find a piece"))}<div class="unplaced">${this.#unplaced(found(model.plan?.unplaced ?? []))}</div><div class="by-class">${groups.map(([key, all]) => this.#group(key, all))}</div>
      ${placed.length ? nothing : html`<p class="muted">${t("No piece of this floor is on the plan.")}</p>`}`;
  }

  #group(key, all) {
    const { sign, word, css } = describe(key);
    return html`<div><h2 class="group-head"><span class="badge ${css}" aria-hidden="true">${sign}</span> ${word} (${all.length})</h2>${this.rows(all, ({ piece, shown }) => html`<li>
      <button type="button" class="quiet row" aria-pressed=${this.scene.pieces.selected.has(piece.row)} data-row=${piece.row} @click=${() => this.goTo("Items", [piece.row], [piece.x, piece.y])}>
        <b>${piece.item}</b><span>${piece.description}</span><span class="end">${shown.text}</span></button></li>`)}</div>`;
  }

  /** The pieces that are not on the plan: by room, the worst first. */
  #unplaced(all) {
    if (!all.length) return nothing;
    const rank = ({ shown: { key, chance } }) => (key ? CLASSES.indexOf(key) : CLASSES.length) - (chance ?? 0);
    const rooms = Map.groupBy(all.sort((a, b) => rank(a) - rank(b)), ({ piece }) => this.model.text("Items", piece.row, "room"));
    return html`<h2 class="group-head">${t("Not on the plan ({n})", { n: all.length })}</h2>
      ${this.canEdit() ? html`<p class="hint">${t("Drag one onto the plan, or press Enter to put it in the middle.")}</p>` : nothing}
      ${[...rooms].map(([room, own]) => html`${this.#room(room, this.model.roomNamed(room), rooms.size)}${this.rows(own, (one) => this.#unplacedRow(one))}`)}`;
  }

  #room(room, place, count) {
    if (!place && count === 1) return nothing;
    return html`<div class="room-head"><h3>${room || t("No room")}</h3>${place && this.canEdit() ? html`<button type="button" class="quiet"
      title=${t("Place the pieces of this room along its walls, as a start")} @click=${() => this.edits.placeAlongWalls(place)}>${icon("walls")}${t("Place along the walls")}</button>` : nothing}</div>`;
  }

  #unplacedRow({ piece, shown: { key, text, live } }) {
    const { sign, word } = describe(key);
    const shown = html`<span class="badge ${key ? classStyle(live) : "class-none"}" title=${word}>${sign}</span><b>${piece.item}</b><span>${piece.description}</span><span class="end">${text}</span>`;
    return html`<li>${this.canEdit() ? html`<button type="button" class="quiet row draggable" data-row=${piece.row}>${shown}</button>` : html`<div class="row">${shown}</div>`}</li>`;
  }
}

export class TypeList extends List {
  constructor(parts) {
    super(parts, t("Add"));
    this.dragFrom(({ type }) => {
      const { breadth, width } = this.model.types.find((one) => one.type === type);
      const size = { breadth: breadth ?? 0.4, width: width ?? breadth ?? 0.4, angle: 0 };
      return { size: () => size, drop: (at) => this.edits.add(type, at) };
    });
  }

  content() {
    const { types } = this.model;
    if (!types.length) this.model.loadTypes().then((found) => found.length && this.draw()).catch(() => {});
    const found = types.filter((one) => this.matches(one.type));
    const { unit, factor } = this.model.unit;
    const sizes = ({ breadth, width, height }) => [breadth, width, height].map((one) => (one ? number(one / factor, 2) : "?")).join(" × ");
    const row = (one) => html`<li><button type="button" class="quiet row draggable" data-type=${one.type}><b>${one.type}</b><span class="end">${sizes(one)} ${unit}</span></button></li>`;
    return html`${this.search(t("Find a type"))}<p class="hint">${t("Drag a type onto the plan, or press Enter to put it in the middle. Each becomes a row of the sheet.")}</p>
      ${found.length ? this.rows(found, row) : html`<p class="muted">${types.length ? t("No type has such a name.") : t("The catalogue of this workbook is empty.")}</p>`}`;
  }
}

export class RouteLists extends List {
  #all = false;

  constructor(parts) {
    super(parts, t("Routes"));
  }

  content() {
    const { model, model: { routes, routesOld } } = this;
    if (!routes) return html`<p class="muted">${t("Computing…")}</p>`;
    this.node.classList.toggle("old", routesOld);
    this.node.setAttribute("aria-busy", String(routesOld));
    const error = routes.error ? html`<p class="error-text">${routes.error}</p>` : nothing;
    if (!routes.routes.length && !routes.rooms.length) {
      return html`${error}<p class="muted">${t("The workbook has no routes. Draw rooms, doors and exits, then ways between them: their states are shown here.")}</p>${this.#drawn()}`;
    }
    const segments = Map.groupBy(model.segments.values(), (one) => nameKey(one.route));
    const ofRoutes = routes.routes.map((one) => ({ name: one.route, state: one, sheet: "Routes", rows: (segments.get(nameKey(one.route)) ?? []).map(({ row }) => row) }));
    const ofRooms = routes.rooms.filter((one) => this.#all || nameKey(one.floor) === nameKey(model.floor))
      .map((one) => ({ name: one.room, state: one, sheet: "Places", rows: model.places.has(one.place_row) ? [one.place_row] : [] }));
    const remarks = routes.remarks.map((text) => html`<p class="hint">${text}</p>`);
    return html`${error}<label class="check"><input type="checkbox" @change=${({ target }) => ((this.#all = target.checked), this.draw())}>${t("Of all floors")}</label>
      ${this.#group(t("Routes"), ofRoutes.filter(({ rows }) => this.#all || rows.length))}${this.#group(t("Rooms"), ofRooms)}${this.#drawn()}
      ${remarks.length ? html`<details><summary>${t("About these states")}</summary>${remarks}</details>` : nothing}`;
  }

  /** All rooms, exits and ways of the floor, so that each can be reached by keys. */
  #drawn() {
    const { model } = this;
    const rows = [
      ...[...model.places.values()].map((one) => [one.place, model.text("Places", one.row, "kind"), "Places", one.row]),
      ...[...model.segments.values()].map((one) => [`${one.route}, ${one.segment}`, `${one.from} – ${one.to}`, "Routes", one.row]),
    ];
    if (!rows.length) return nothing;
    return html`<details><summary>${t("Rooms, exits and ways of this floor ({n})", { n: rows.length })}</summary><ul class="rows">${rows.map(([name, about, sheet, row]) =>
      html`<li><button type="button" class="quiet row" @click=${() => this.goTo(sheet, [row])}><b>${name}</b><span class="end">${about}</span></button></li>`)}</ul></details>`;
  }

  /** The worst first. */
  #group(title, all) {
    const order = ["blocked", "doubtful", "not_known", "open"];
    const rank = ({ state: { state, standing, chance } }) => order.indexOf(state) - (standing ? 1 : 0) - (chance ?? 0) / 2;
    const items = all.sort((a, b) => rank(a) - rank(b)).map(({ name, state, sheet, rows }) => html`<li>
      <button type="button" class="quiet row ${stateCss(state)}" ?disabled=${!rows.length} title=${state.detail} @click=${() => this.goTo(sheet, rows)}>
        <span class="state-word">${state.word}</span><b>${name}</b><span class="detail">${state.detail}</span></button></li>`);
    return items.length ? html`<h2 class="group-head">${title} (${items.length})</h2><ul class="rows states">${items}</ul>` : nothing;
  }
}
