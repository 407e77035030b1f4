// The tab of the plan: tools, the drawing, the lists beside it, and how they work together.

import { el, svg } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { ask } from "./messages.mjs";
import { Details } from "./plan_details.mjs";
import { MeasureTool, OutlineTool, PointTool, TOOLS, WITH_WIDTH, WayTool } from "./plan_draft.mjs";
import { PlanEdits } from "./plan_edits.mjs";
import { boxOf, readNumber } from "./plan_geometry.mjs";
import { PlanKeys, listKeys } from "./plan_keys.mjs";
import { PieceLists, RouteLists, TypeList } from "./plan_lists.mjs";
import { DOOR, KINDS, PlanModel, STATES, isPlaced, nameKey, stateWords } from "./plan_model.mjs";
import { Picture, PlacingTool } from "./plan_picture.mjs";
import { PlanPointer, Viewport } from "./plan_pointer.mjs";
import { Scene } from "./plan_scene.mjs";
import { SelectTool } from "./plan_select.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const SWIPE_PX = 30;
const BUTTONS_UP_TO = 6; // floors; beyond that, or where the window is narrower, a list
const WIDE = matchMedia("(min-width: 1200px)");
const EDITED_FROM = matchMedia("(min-width: 900px)");
const TABS = [["selected", () => t("Selected")], ["pieces", () => t("Pieces")], ["add", () => t("Add")], ["routes", () => t("Routes")], ["picture", () => t("Picture")]];

export const createView = (root, store) => new PlanView(root, store);

class PlanView {
  #tab = "pieces";
  #isRaised = false; // on a phone the panel lies below the plan: only its tabs, or risen over it
  #views = new Map(); // floors to what was seen of them
  #follows = "start"; // who selected something elsewhere since the plan was shown
  #swipe = 0; // where one on the tabs began

  constructor(root, store) {
    this.root = root;
    this.store = store;
    root.classList.add("plan-view");
    this.#build();
    this.#listen();
  }

  canEdit = () => EDITED_FROM.matches;
  currentTool = () => this.tool;
  say = (text) => (this.status.textContent = this.line.textContent = text);

  /** The parts, each with those before it, and what they ask of the whole. */
  #build() {
    const { root, store, canEdit, currentTool, say, setTool, remove, fit, goTo } = this;
    const hatch = svg("path", { d: "M0 7L7 0M-1 1L1 -1M6 8L8 6" });
    const pattern = svg("pattern", { id: "plan-hatch", width: 7, height: 7, patternUnits: "userSpaceOnUse" }, hatch);
    const world = svg("g", { class: "world" });
    this.svg = svg("svg", { class: "plan", tabindex: "-1", role: "group", "aria-label": t("Plan of the floor"), "aria-describedby": "plan-about" }, svg("defs", null, pattern), world);
    this.bar = el("div", { class: "scale-bar", "aria-hidden": "true" });
    this.status = el("div", { class: "unseen", role: "status", "aria-live": "polite" });
    this.line = el("div", { class: "plan-line", "aria-hidden": "true" });
    const done = () => setTool("select");
    const parts = { root, store, svg: this.svg, world, bar: this.bar, canEdit, currentTool, say, setTool, remove, fit, goTo, done };
    const add = (name, Part, more) => (this[name] = parts[name] = new Part({ ...parts, ...more }));
    this.model = parts.model = new PlanModel(store);
    add("viewport", Viewport);
    add("scene", Scene);
    add("edits", PlanEdits);
    this.tool = add("select", SelectTool);
    const [measure, way, placing] = [MeasureTool, WayTool, PlacingTool].map((Tool) => new Tool(parts));
    const kinds = KINDS.map((name, kindAt) => [name, new (kindAt < 2 ? OutlineTool : PointTool)({ ...parts, name, kindAt, hasWidth: WITH_WIDTH.includes(name) })]);
    this.tools = { select: this.select, measure, way, placing, ...Object.fromEntries(kinds) };
    this.select.picture = add("picture", Picture, { tool: placing });
    new PlanPointer(parts);
    add("keys", PlanKeys);
    this.sections = { selected: add("details", Details), pieces: new PieceLists(parts), add: new TypeList(parts), routes: new RouteLists(parts), picture: this.picture };
  }

  #listen() {
    const { model, store } = this;
    model.addEventListener("floor", () => this.#onFloor());
    model.addEventListener("plan", () => this.#draw());
    model.addEventListener("classes", () => this.#redraw("pieces", () => !model.plan || this.select.isDragging || this.scene.pieces.draw()));
    model.addEventListener("routes", () => this.#redraw("routes", () => this.scene.drawRoutes()));
    store.addEventListener("selection", ({ detail }) => this.#selected(detail.source));
    store.addEventListener("history", ({ detail }) => this.#showChange(detail));
    this.viewport.addEventListener("view", () => this.select.showHandles());
    EDITED_FROM.addEventListener("change", () => this.#allowEditing());
    WIDE.addEventListener("change", () => this.#drawFrame());
    this.#allowEditing();
  }

  #allowEditing() {
    const isReading = !this.canEdit();
    this.root.classList.toggle("reading", isReading);
    if (isReading) this.setTool("select");
    if (isReading && (this.#tab === "add" || this.#tab === "picture")) this.#tab = "pieces";
    this.#draw();
  }

  // ---- the frame: all but the drawing and the open list

  #drawFrame() {
    const text = this.#explain();
    const { pieces, floor } = this.model;
    const count = tn("{n:,} piece on floor {floor}.", "{n:,} pieces on floor {floor}.", pieces.size, { floor });
    for (const [key, one] of Object.entries(this.sections)) one.node.hidden = key !== this.#tab;
    render(html`${toolbar(this)}<div class="plan-main">${toolColumn(this)}
      <div class="plan-drawing">${this.svg}${this.bar}${this.line}<div class="plan-empty" ?hidden=${!text}>${text}</div>
        <p class="unseen" id="plan-about">${count} ${t("Tab goes through them, arrow keys move them; all keys are in the help.")}</p>${this.status}${viewTools(this)}</div>
      <aside class=${this.#isRaised ? "plan-panel raised" : "plan-panel"} aria-label=${t("Lists of the plan")} data-tab=${this.#tab}>${this.#tabs()}
        <div class="plan-body" id="plan-panel" role="tabpanel" tabindex="0">${Object.values(this.sections).map((one) => one.node)}</div>
        <div class="plan-legend">${this.#legend()}</div></aside></div>`, this.root);
  }

  #explain() {
    const { plan, error, pieces, places } = this.model;
    if (error || !plan) return error;
    if (!plan.floors.length) return t("The workbook has no floors yet. Fill in the sheet Floors first.");
    const isBlank = !plan.pieces.length && !pieces.size && !plan.picture && !places.size;
    return isBlank && this.canEdit() ? t("Nothing is on this floor yet. Drag a type from the list Add, or add a picture of the floor.") : "";
  }

  #legend() {
    const states = Object.entries({ ...stateWords(), standing: t("blocked as it stands") });
    const list = html`<ul class="key-states">${states.map(([key, word]) => html`<li class="state-${key.replace("_", "-")}">
      <span class="state-dot" aria-hidden="true">${STATES[key] ?? STATES.blocked}</span>${word}</li>`)}</ul>`;
    return html`<p><span class="key-breadth"></span>${t("A piece topples in the direction of its thick sides.")} ⚓ ${t("anchored")}</p>
      ${this.model.routes && this.model.segments.size ? list : nothing}`;
  }

  #tabs() {
    const swipe = ({ changedTouches: [{ clientY }] }) => {
      if (Math.abs(clientY - this.#swipe) > SWIPE_PX) this.#isRaised = clientY < this.#swipe;
      this.#drawFrame();
    };
    const shown = TABS.filter(([key]) => this.canEdit() || key !== "add");
    return html`<div class="plan-tabs" role="tablist" aria-label=${t("Lists of the plan")} @keydown=${(event) => this.#tabKey(event, shown)}
      @touchstart=${({ touches }) => (this.#swipe = touches[0].clientY)} @touchend=${swipe}>${shown.map(([key, label]) => html`<button type="button" role="tab"
        data-panel=${key} aria-controls="plan-panel" aria-selected=${key === this.#tab} tabindex=${key === this.#tab ? 0 : -1} @click=${() => this.#tapTab(key)}>${label()}</button>`)}</div>`;
  }

  /** How much of the drawing the panel of a phone covers [px]. */
  #covered() {
    if (this.canEdit()) return 0;
    return this.svg.getBoundingClientRect().bottom - this.root.querySelector(".plan-panel").getBoundingClientRect().top;
  }

  /** A tap on the tab that is open closes the panel of a phone. */
  #tapTab(key) {
    this.#isRaised = this.#tab !== key || !this.#isRaised;
    this.#openTab(key);
  }

  #openTab(key) {
    const isOther = this.#tab !== key;
    this.#tab = key;
    this.#drawFrame();
    if (isOther) this.sections[key].draw();
  }

  #tabKey(event, shown) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    this.#openTab(shown.at((shown.findIndex(([key]) => key === this.#tab) + step) % shown.length)[0]);
    this.root.querySelector(`[data-panel="${this.#tab}"]`).focus();
  }

  // ---- what is shown

  show() {
    this.isShown = true;
    this.model.loadTypes().catch(() => {});
    const { sheet, row } = this.store.selection;
    if (this.#follows && row && ["Items", "Places", "Floors"].includes(sheet)) this.#showFloorOf(sheet, row);
    if (this.#follows === "overview" && sheet === "Places") this.#tapTab("selected");
    this.#follows = "";
    this.model.show();
    if (this.model.plan) this.#draw();
  }

  hide() {
    this.keys.endBurst();
    this.setTool("select");
    this.isShown = this.model.isShown = false;
  }

  setFloor = (name) => {
    const { scale, left, top, wanted } = this.viewport;
    if (this.model.plan) this.#views.set(this.model.floor, { scale, left, top, wanted });
    if (this.tool.name === "placing") this.setTool("select");
    this.model.setFloor(name);
  };

  #showFloorOf(sheet, row) {
    const floor = this.model.text(sheet, row, "floor");
    if (floor && nameKey(floor) !== nameKey(this.model.floor)) this.setFloor(floor);
  }

  #onFloor() {
    const { floor, isRefitted } = this.model;
    const kept = this.#views.get(floor);
    if (kept && !kept.wanted && !isRefitted) {
      this.viewport.wanted = null;
      this.viewport.set(kept.scale, kept.left, kept.top);
    } else this.fit();
    this.say(t("Floor {floor}", { floor }));
  }

  fit = () => {
    const { plan, pieces } = this.model;
    if (!plan) return;
    const [x0, y0, x1, y1] = plan.frame;
    this.viewport.fit(boxOf([[x0, y0], [x1, y1], ...[...pieces.values()].map((one) => [one.x, one.y])]));
  };

  #draw() {
    this.#drawFrame();
    if (!this.model.plan || !this.isShown) return;
    this.scene.pieces.selected = new Set(this.#ownRows());
    if (!this.select.isDragging) this.scene.draw();
    this.select.showHandles();
    this.sections[this.#tab].draw();
  }

  /** Draw what is told anew of pieces or routes, and the list that shows it. */
  #redraw(list, draw) {
    if (!this.isShown) return;
    draw();
    this.#drawFrame();
    if (this.#tab === list || this.#tab === "selected") this.sections[this.#tab].draw();
  }

  // ---- selection

  #ownRows() {
    const { sheet, rows } = this.store.selection;
    return sheet === "Items" ? rows.filter((row) => this.model.pieces.has(row)) : [];
  }

  #selected(source) {
    if (source !== "plan" && !this.isShown) this.#follows = source ?? "other";
    if (!this.model.plan) return;
    const rows = this.#ownRows();
    const { sheet, row } = this.store.selection;
    this.scene.pieces.select(rows);
    this.scene.drawFalls();
    this.scene.drawRoutes();
    this.select.showHandles();
    if (source === "plan" && this.isShown) {
      this.#isRaised = Boolean(rows.length || (row && sheet !== "Items"));
      this.#openTab(this.#isRaised ? "selected" : this.#tab);
      const piece = this.model.pieces.get(rows[0]);
      if (piece && !this.canEdit()) this.viewport.reveal([piece.x, piece.y], this.#covered());
    }
    if (this.isShown) this.sections[this.#tab].draw();
    if (source === "plan" && rows.length > 1) this.say(tn("{n:,} piece selected", "{n:,} pieces selected", rows.length));
  }

  /** Undo and redo show the floor where something changed. */
  #showChange(cells) {
    const cell = cells.find(([sheet]) => sheet === "Items" || sheet === "Places");
    if (!this.isShown || !cell) return;
    this.#showFloorOf(cell[0], cell[1]);
    this.say(tn("{n:,} cell changed", "{n:,} cells changed", cells.length));
  }

  /** Select rows of a sheet and show a point, or where the first of them lies. */
  goTo = (sheet, rows, point) => {
    this.edits.select(sheet, rows);
    const place = sheet === "Places" && this.model.places.get(rows[0]);
    const ends = sheet === "Routes" && this.model.segments.get(rows[0])?.points;
    const to = point ?? (place && isPlaced(place) ? [place.x, place.y] : ends?.[0]);
    if (to) this.viewport.reveal(to, this.#covered());
  };

  // ---- actions

  setTool = (name) => {
    const [tool, old] = [this.tools[name], this.tool];
    if (tool !== old) {
      this.tool = tool;
      old.leave?.();
      this.line.textContent = "";
      if (name === "way" || tool.kindAt !== undefined) this.edits.select("Places", []); // the panel is of what is drawn
      tool.enter?.();
      this.svg.classList.toggle("drawing", name !== "select");
      if (name === "placing") this.#openTab("picture");
      if (name !== "select") this.svg.focus({ preventScroll: true });
      this.sections[this.#tab].draw();
    }
    this.#drawFrame();
  };

  remove = async (rows) => {
    if (!rows.length) return this.details.deleteSelected();
    const names = rows.length === 1 ? this.model.pieces.get(rows[0]).item : tn("{n:,} piece", "{n:,} pieces", rows.length);
    const question = t("Remove {names} from the plan, or delete from the workbook? Undo brings everything back.", { names });
    const answer = await ask(question, [[t("Remove from the plan"), "off"], [t("Delete the row"), "row"], [t("Cancel"), null]]);
    if (answer === "off") this.edits.change("Items", rows, { x: null, y: null }, t("take off the plan"));
    if (answer === "row") this.edits.deleteRows("Items", rows);
    return answer && this.svg.focus({ preventScroll: true });
  };

  help = () => {
    const dialog = el("dialog", { class: "plan-help", "aria-labelledby": "plan-help-title" });
    render(html`<h2 id="plan-help-title">${t("Keys of the plan")}</h2>
      <dl>${listKeys().map(([keys, text]) => html`<dt><kbd>${keys}</kbd></dt><dd>${text}</dd>`)}</dl>
      <div class="buttons"><button type="button" class="primary" @click=${() => dialog.close()}>${t("Close")}</button></div>`, dialog);
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  };
}

// ---- the tools beside the drawing, above it and on it

const icons = {}; // made once: a button that is pressed keeps its own
const iconOf = (name) => (icons[name] ??= icon(name));

const toolColumn = ({ store, setTool, currentTool }) => html`
  <div class="plan-tools editing-only" role="toolbar" aria-orientation="vertical" aria-label=${t("Tools")}>${TOOLS.map(([name, key, label, sheet]) => html`
    <button type="button" class="tool quiet" title="${label()} (${key})" aria-label=${label()} data-tool=${name}
      aria-pressed=${name === currentTool().name} ?disabled=${!store.sheet(sheet)?.found} @click=${() => setTool(name)}>${iconOf(name)}<span>${label()}</span></button>`)}</div>`;

function toolbar({ model, store, scene, select, tools, currentTool, canEdit, setFloor }) {
  const { unit, factor } = model.unit;
  const tool = currentTool();
  const setWidth = ({ target }) => {
    const metres = readNumber(target.value) * factor;
    target.setAttribute("aria-invalid", String(!(metres > 0) && target.value.trim() !== ""));
    for (const name of WITH_WIDTH) tools[name].width = metres > 0 ? metres : null;
  };
  const falls = [["selected", t("selected")], ["all", t("all")], ["none", t("none")]];
  return html`<div class="plan-toolbar" role="toolbar" aria-label=${t("Settings of the plan")} tabindex="-1">
    <div class="plan-floors">${floorChoice(model, canEdit, setFloor)}</div>
    <div class="plan-group" role="group" aria-label=${t("What is shown")}>
      <label class="check editing-only" title=${t("Pieces snap to walls and to each other; Alt switches it off while dragging.")}><input type="checkbox" checked
        @change=${({ target }) => (select.snaps = target.checked)}>${t("Snap")}</label>
      <label class="inline" title=${t("The floor that a piece may cover when it falls")}>${t("Show fall zones:")}
        <select @change=${({ target }) => scene.draw({ falls: target.value })}>${falls.map(([value, text]) => html`<option value=${value}>${text}</option>`)}</select></label>
      <label class="check"><input type="checkbox" checked @change=${({ target }) => scene.draw({ showsRoutes: target.checked })}>${t("Show routes")}</label></div>
    <div class="plan-group editing-only">
      <label class="inline" ?hidden=${!WITH_WIDTH.includes(tool.name)} title=${t("It becomes the clear width of the ways that are drawn through it.")}>${t("Width")}
        <input class="door-width" inputmode="decimal" autocomplete="off" aria-label=${t("Width of the door or exit")} placeholder=${number(DOOR / factor, 1)}
          @input=${setWidth}><span>${unit}</span></label>
      <label class="inline" ?hidden=${tool.name !== "way"}>${t("Route")}
        <input class="route-name" list="plan-routes" autocomplete="off" aria-label=${t("Route of new ways")} .value=${tools.way.route}
          @input=${({ target }) => (tools.way.route = target.value)}>
        <datalist id="plan-routes">${(store.sheet("Routes")?.names("route") ?? []).map((value) => html`<option value=${value}></option>`)}</datalist></label></div></div>`;
}

function floorChoice(model, canEdit, setFloor) {
  const { floors = [], floor } = model.plan ?? {};
  const name = (one) => (one.name && one.name !== one.floor ? one.name : t("Floor {floor}", { floor: one.floor }));
  if (floors.length > BUTTONS_UP_TO || (floors.length > 1 && !(WIDE.matches && canEdit()))) {
    return html`<select aria-label=${t("Floor")} @change=${({ target }) => setFloor(target.value)}>${floors.map((one) => html`
      <option value=${one.floor} .selected=${one.floor === floor}>${name(one)}</option>`)}</select>`;
  }
  return html`<div class="segmented" role="group" aria-label=${t("Floor")}>${floors.map((one) => html`
    <button type="button" data-floor=${one.floor} aria-pressed=${one.floor === floor} @click=${() => setFloor(one.floor)}>${name(one)}</button>`)}</div>`;
}

function viewTools({ viewport, fit, help }) {
  const button = (name, label, run, key) => html`<button type="button" class=${key ? "square" : "square editing-only"}
    aria-label=${label} title=${key ? `${label} (${key})` : label} @click=${run}>${iconOf(name)}</button>`;
  return html`<div class="plan-view-tools" role="group" aria-label=${t("View")}>
    ${button("minus", t("Zoom out"), () => viewport.zoom(0.8), "-")}${button("plus", t("Zoom in"), () => viewport.zoom(1.25), "+")}
    ${button("fit", t("Show all"), fit, "0")}${button("help", t("Keys of the plan"), help)}</div>`;
}
