// The tab of the plan: tools, the drawing, the lists beside it, and how they work together.

import { clear, el, svg } from "./elements.mjs";
import { ask } from "./messages.mjs";
import { Details } from "./plan_details.mjs";
import { MeasureTool, OutlineTool, PointTool } from "./plan_draft.mjs";
import { PlanEdits } from "./plan_edits.mjs";
import { boxOf } from "./plan_geometry.mjs";
import { PlanKeys, listKeys } from "./plan_keys.mjs";
import { PieceLists, RouteLists, TypeList } from "./plan_lists.mjs";
import { KINDS, PlanModel, nameKey } from "./plan_model.mjs";
import { Picture, PlacingTool } from "./plan_picture.mjs";
import { PlanPointer } from "./plan_pointer.mjs";
import { Scene } from "./plan_scene.mjs";
import { WayTool } from "./plan_segments.mjs";
import { SelectTool } from "./plan_select.mjs";
import { dragFrom } from "./plan_drop.mjs";
import { Toolbar, WITH_WIDTH } from "./plan_toolbar.mjs";
import { Viewport } from "./plan_viewport.mjs";
import { t, tn } from "./texts.mjs";

const SWIPE_PX = 30;
const EDITED_FROM = "(min-width: 900px)";
const TABS = [["selected", () => t("Selected")], ["pieces", () => t("Pieces")], ["add", () => t("Add")], ["routes", () => t("Routes")], ["picture", () => t("Picture")]];

export function createView(root, store) {
  const view = new PlanView(root, store);
  return { show: () => view.show(), hide: () => view.hide() };
}

class PlanView {
  #tab = "pieces";
  #views = new Map(); // floors to what was seen of them
  #follows = "start"; // who selected something elsewhere since the plan was shown

  constructor(root, store) {
    Object.assign(this, { root, store });
    this.wide = matchMedia(EDITED_FROM);
    this.model = new PlanModel(store);
    this.#buildDrawing();
    this.#buildTools();
    this.#buildPanel();
    this.#assemble();
    this.#listen();
  }

  canEdit = () => this.wide.matches;
  say = (text) => {
    this.status.textContent = text;
    this.line.textContent = text;
  };

  // ---- elements

  #buildDrawing() {
    const pattern = svg("pattern", { id: "plan-hatch", width: 7, height: 7, patternUnits: "userSpaceOnUse" }, svg("path", { d: "M0 7L7 0M-1 1L1 -1M6 8L8 6" }));
    this.svg = svg("svg", { class: "plan", tabindex: "-1", role: "group", "aria-label": t("Plan of the floor"), "aria-describedby": "plan-about" }, svg("defs", null, pattern));
    const world = svg("g", { class: "world" });
    this.svg.append(world);
    this.viewport = new Viewport(this.svg, world);
    this.scene = new Scene(this.model, this.store, this.viewport);
    this.bar = el("div", { class: "scale-bar", "aria-hidden": "true" });
    this.scene.onScale = ({ px, text }) => {
      this.bar.style.setProperty("width", `${px}px`);
      this.bar.textContent = text;
    };
    this.about = el("p", { class: "unseen", id: "plan-about" });
    this.status = el("div", { class: "unseen", role: "status", "aria-live": "polite" });
    this.line = el("div", { class: "plan-line", "aria-hidden": "true" });
    this.empty = el("div", { class: "plan-empty", hidden: true });
    this.drawing = el("div", { class: "plan-drawing" }, this.svg, this.bar, this.line, this.empty, this.about, this.status);
  }

  #buildTools() {
    const { model, store, scene, viewport, say, canEdit } = this;
    this.edits = new PlanEdits(model, store);
    const parts = { model, store, scene, viewport, say, canEdit, edits: this.edits };
    this.select = new SelectTool(parts);
    const done = () => this.setTool("select");
    const more = { ...parts, select: this.select, done };
    this.tools = { select: this.select, measure: new MeasureTool(more), way: new WayTool(more), placing: new PlacingTool(more) };
    KINDS.forEach((name, kindAt) => (this.tools[name] = new (kindAt < 2 ? OutlineTool : PointTool)({ ...more, name, kindAt, hasWidth: WITH_WIDTH.includes(name) })));
    this.tool = this.select;
    this.picture = new Picture({ ...more, tool: this.tools.placing, currentTool: () => this.tool, start: () => this.setTool("placing") });
    this.select.picture = this.picture;
    this.pointer = new PlanPointer({ viewport, tool: () => this.tool, canEdit });
    this.keys = new PlanKeys({ ...parts, root: this.root, tool: () => this.tool, setTool: (name) => this.setTool(name), remove: (rows) => this.remove(rows), fit: () => this.fit(), onPreview: () => this.select.showHandles() });
    const actions = { setTool: (name) => this.setTool(name), setFloor: (name) => this.#setFloor(name), fit: () => this.fit(), help: () => this.#help() };
    this.toolbar = new Toolbar({ ...parts, tools: this.tools, currentTool: () => this.tool, ...actions });
  }

  #buildPanel() {
    const { model, store, scene, edits, canEdit } = this;
    const goTo = (sheet, rows, at) => this.#goTo(sheet, [rows].flat(), at);
    const startDrag = (list, find) => dragFrom(list, this, find);
    this.details = new Details({ model, store, scene, edits, canEdit, keys: this.keys, remove: (rows) => this.remove(rows), currentTool: () => this.tool });
    this.lists = new PieceLists({ model, store, scene, edits, canEdit, startDrag, goTo });
    this.types = new TypeList({ model, edits, startDrag });
    this.routes = new RouteLists({ model, store, goTo });
    this.sections = { selected: this.details, pieces: this.lists, add: this.types, routes: this.routes, picture: this.picture };
    this.tabs = el("div", { class: "plan-tabs", role: "tablist", "aria-label": t("Lists of the plan") });
    this.body = el("div", { class: "plan-body", id: "plan-panel", role: "tabpanel", tabIndex: 0 }, Object.values(this.sections).map((one) => one.node));
    this.legend = el("div", { class: "plan-legend" });
    this.panel = el("aside", { class: "plan-panel", "aria-label": t("Lists of the plan") }, this.tabs, this.body, this.legend);
    this.tabs.addEventListener("keydown", (event) => this.#tabKey(event));
    let from = 0; // of a swipe on the tabs
    this.tabs.addEventListener("touchstart", ({ touches }) => (from = touches[0].clientY), { passive: true });
    this.tabs.addEventListener("touchend", ({ changedTouches: [{ clientY }] }) => Math.abs(clientY - from) > SWIPE_PX && this.#raise(clientY < from));
  }

  /** On a phone the panel lies below the plan: only its tabs, or risen over it. */
  #raise(isRaised) {
    this.panel.classList.toggle("raised", isRaised);
  }

  #covered() {
    return this.canEdit() ? 0 : this.drawing.getBoundingClientRect().bottom - this.panel.getBoundingClientRect().top;
  }

  #assemble() {
    this.root.classList.add("plan-view");
    this.root.append(this.toolbar.node, el("div", { class: "plan-main" }, this.toolbar.toolGroup, this.drawing, this.panel));
    this.drawing.append(this.toolbar.view);
    this.#drawTabs();
  }

  #listen() {
    const { model, store } = this;
    model.addEventListener("floor", () => this.#onFloor());
    model.addEventListener("plan", () => this.#draw());
    model.addEventListener("classes", () => this.#drawClasses());
    model.addEventListener("routes", () => this.#drawRoutes());
    store.addEventListener("selection", ({ detail }) => this.#selected(detail.source));
    store.addEventListener("history", ({ detail }) => this.#showChange(detail));
    this.viewport.addEventListener("view", () => this.select.showHandles());
    this.wide.addEventListener("change", () => this.#allowEditing());
    this.#allowEditing();
  }

  #allowEditing() {
    this.root.classList.toggle("reading", !this.canEdit());
    if (!this.canEdit()) this.setTool("select");
    if (!this.canEdit() && (this.#tab === "add" || this.#tab === "picture")) this.#tab = "pieces";
    this.#drawTabs();
    this.#draw();
  }

  // ---- tabs of the panel

  #drawTabs() {
    const shown = TABS.filter(([key]) => this.canEdit() || key !== "add");
    clear(this.tabs).append(...shown.map(([key, label]) => el("button", {
      type: "button", role: "tab", text: label(), dataset: { panel: key }, "aria-controls": "plan-panel", "aria-selected": String(key === this.#tab), tabIndex: key === this.#tab ? 0 : -1, on: { click: () => this.#tapTab(key) },
    })));
    this.panel.dataset.tab = this.#tab;
    for (const [key, one] of Object.entries(this.sections)) one.node.hidden = key !== this.#tab;
  }

  /** A tap on the tab that is open closes the panel of a phone. */
  #tapTab(key) {
    const isRaised = this.#tab !== key || !this.panel.classList.contains("raised");
    this.#openTab(key);
    this.#raise(isRaised);
  }

  #openTab(key) {
    if (this.#tab !== key) {
      const hadFocus = this.tabs.contains(document.activeElement);
      this.#tab = key;
      this.#drawTabs();
      this.sections[key].draw();
      if (hadFocus) this.tabs.querySelector(`[data-panel="${key}"]`).focus();
    }
  }

  #tabKey(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const all = [...this.tabs.children];
    const next = all[(all.findIndex((one) => one.dataset.panel === this.#tab) + step + all.length) % all.length];
    event.preventDefault();
    this.#openTab(next.dataset.panel);
  }

  // ---- what is shown

  show() {
    this.isShown = true;
    this.model.loadTypes().catch(() => {});
    if (this.#follows) this.#followFloor();
    if (this.#follows === "overview" && this.store.selection.sheet === "Places") this.#tapTab("selected");
    this.#follows = "";
    this.model.show();
    if (this.model.plan) this.#draw();
  }

  hide() {
    this.keys.endBurst();
    this.setTool("select");
    this.isShown = false;
    this.model.hide();
  }

  #setFloor(name) {
    if (this.model.plan) this.#views.set(this.model.floor, [this.viewport.scale, this.viewport.left, this.viewport.top, this.viewport.wanted]);
    this.setTool(this.tool.name === "placing" ? "select" : this.tool.name);
    this.model.setFloor(name);
  }

  #onFloor() {
    const kept = this.#views.get(this.model.floor);
    if (kept && !kept[3] && !this.model.isRefitted) {
      this.viewport.wanted = null;
      this.viewport.set(...kept.slice(0, 3));
    } else this.fit();
    this.say(t("Floor {floor}", { floor: this.model.floor }));
  }

  fit() {
    const { plan } = this.model;
    if (!plan) return;
    const points = [...this.model.pieces.values()].map((one) => [one.x, one.y]);
    const [x0, y0, x1, y1] = plan.frame;
    this.viewport.fit(boxOf([[x0, y0], [x1, y1], ...points]));
  }

  #draw() {
    const { model } = this;
    if (!model.plan || !this.isShown) {
      this.#explain();
      return;
    }
    this.#explain();
    this.scene.pieces.selected = new Set(this.#ownRows());
    if (!this.select.isDragging) this.scene.draw();
    this.select.showHandles();
    this.toolbar.draw();
    this.sections[this.#tab].draw();
    this.#drawLegend();
    const count = tn("{n:,} piece on floor {floor}.", "{n:,} pieces on floor {floor}.", model.pieces.size, { floor: model.floor });
    this.about.textContent = `${count} ${t("Tab goes through them, arrow keys move them; all keys are in the help.")}`;
  }

  #explain() {
    const { plan, error } = this.model;
    const text = error || (plan && !plan.floors.length ? t("The workbook has no floors yet. Fill in the sheet Floors first.") : "");
    const isBlank = plan && plan.floors.length > 0 && !plan.pieces.length && !this.model.pieces.size && !plan.picture && !this.model.places.size;
    const lead = isBlank && this.canEdit() ? t("Nothing is on this floor yet. Drag a type from the list Add, or add a picture of the floor.") : "";
    this.empty.hidden = !(text || lead);
    this.empty.textContent = text || lead;
  }

  #drawClasses() {
    if (!this.model.plan || !this.isShown) return;
    if (!this.select.isDragging) this.scene.pieces.draw();
    this.toolbar.draw();
    if (this.#tab === "pieces" || this.#tab === "selected") this.sections[this.#tab].draw();
  }

  #drawRoutes() {
    if (!this.isShown) return;
    this.scene.drawRoutes();
    if (this.#tab === "routes" || this.#tab === "selected") this.sections[this.#tab].draw();
    this.#drawLegend();
  }

  #drawLegend() {
    const states = this.model.routes && this.model.segments.size ? this.scene.legend() : [];
    clear(this.legend).append(
      el("p", null, el("span", { class: "key-breadth" }), t("A piece topples in the direction of its thick sides."), " ⚓ ", t("anchored")),
      states.length ? el("ul", { class: "key-states" }, states.map(({ css, sign, word }) => el("li", { class: css }, el("span", { class: "state-dot", "aria-hidden": "true", text: sign }), word))) : "");
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
    this.scene.pieces.select(rows);
    this.scene.drawFalls();
    this.scene.drawRoutes();
    this.select.showHandles();
    const { selection } = this.store;
    if (source === "plan" && this.isShown) {
      const hasAny = rows.length || (selection.row && selection.sheet !== "Items");
      if (hasAny) this.#openTab("selected");
      this.#raise(Boolean(hasAny));
      const piece = this.model.pieces.get(rows[0]);
      if (piece && !this.canEdit()) this.viewport.reveal([piece.x, piece.y], this.#covered());
    }
    if (this.isShown) this.sections[this.#tab].draw();
    if (source === "plan" && rows.length > 1) this.say(tn("{n:,} piece selected", "{n:,} pieces selected", rows.length));
  }

  /** Show the floor of what was selected in the grid. */
  #followFloor() {
    const { sheet, row } = this.store.selection;
    if (!row || !["Items", "Places", "Floors"].includes(sheet)) return;
    const floor = this.model.text(sheet, row, "floor");
    if (floor && nameKey(floor) !== nameKey(this.model.floor)) this.model.setFloor(floor);
  }

  /** Undo and redo show the floor where something changed. */
  #showChange(cells) {
    const cell = cells.find(([sheet]) => sheet === "Items" || sheet === "Places");
    if (!this.isShown || !cell) return;
    const floor = this.model.text(cell[0], cell[1], "floor");
    if (floor && nameKey(floor) !== nameKey(this.model.floor)) this.#setFloor(floor);
    this.say(tn("{n:,} cell changed", "{n:,} cells changed", cells.length));
  }

  #goTo(sheet, rows, at) {
    this.edits.select(sheet, rows);
    const place = sheet === "Places" ? this.model.places.get(rows[0]) : null;
    const ends = sheet === "Routes" ? this.model.segments.get(rows[0])?.points : null;
    const to = at ?? (place?.x !== null && place ? [place.x, place.y] : ends?.[0]);
    if (to) this.viewport.reveal(to, this.#covered());
  }

  // ---- actions

  setTool(name) {
    const tool = this.tools[name];
    if (tool !== this.tool) {
      const old = this.tool;
      this.tool = tool;
      old.leave?.();
      this.line.textContent = "";
      if (name === "way" || tool.kindAt !== undefined) this.edits.select("Places", []); // the panel is of what is drawn
      tool.enter?.();
      this.svg.classList.toggle("drawing", name !== "select");
      if (name === "placing") this.#openTab("picture");
      if (name !== "select") this.svg.focus({ preventScroll: true });
      this.sections?.[this.#tab].draw();
    }
    this.toolbar?.draw();
  }

  async remove(rows) {
    if (!rows.length) {
      this.details.deleteSelected();
      return;
    }
    const names = rows.length === 1 ? this.model.pieces.get(rows[0]).item : tn("{n:,} piece", "{n:,} pieces", rows.length);
    const question = t("Remove {names} from the plan, or delete from the workbook? Undo brings everything back.", { names });
    const answer = await ask(question, [[t("Remove from the plan"), "off"], [t("Delete the row"), "row"], [t("Cancel"), null]]);
    if (answer === "off") this.edits.takeOff(rows);
    if (answer === "row") this.edits.deleteRows("Items", rows);
    if (answer) this.svg.focus({ preventScroll: true });
  }

  #help() {
    const dialog = el("dialog", { class: "plan-help", "aria-labelledby": "plan-help-title" },
      el("h2", { id: "plan-help-title", text: t("Keys of the plan") }),
      el("dl", null, listKeys().map(([keys, text]) => [el("dt", null, el("kbd", { text: keys })), el("dd", { text })])),
      el("div", { class: "buttons" }, el("button", { type: "button", class: "primary", text: t("Close"), on: { click: () => dialog.close() } })));
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  }
}
