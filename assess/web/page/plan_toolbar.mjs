// The tools beside the plan, and above it: floor, what is shown, what the tool in use asks for; zoom and help on it.

import { choose, clear, el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { readNumber } from "./plan_geometry.mjs";
import { DOOR } from "./plan_model.mjs";
import { number, t } from "./texts.mjs";

const BUTTONS_UP_TO = 6; // floors; beyond that, or where the window is narrower, a list
const WIDE = matchMedia("(min-width: 1200px)");
export const WITH_WIDTH = ["door", "exit"];

/** The tools with their names and keys. */
export const listTools = () => [
  ["select", t("Select"), "V"], ["measure", t("Measure"), "M"], ["room", t("Room"), "O"], ["corridor", t("Corridor"), "C"],
  ["door", t("Door"), "D"], ["stair", t("Stair"), "S"], ["exit", t("Exit"), "E"], ["way", t("Way"), "W"],
];

export class Toolbar {
  /** @param {{model, store, scene, viewport, select, tools, currentTool, canEdit, setTool, setFloor, fit, help}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.floors = el("div", { class: "plan-floors" });
    this.#buildTools();
    this.#buildShown();
    this.#buildView();
    WIDE.addEventListener("change", () => this.draw());
    this.node = el("div", { class: "plan-toolbar", role: "toolbar", "aria-label": t("Settings of the plan"), tabIndex: -1 }, this.floors, this.shown, this.options);
  }

  #buildTools() {
    const tool = ([name, label, key]) => el("button", { type: "button", class: "tool quiet", title: `${label} (${key})`, "aria-label": label, dataset: { tool: name }, on: { click: () => this.setTool(name) } }, icon(name), el("span", { text: label }));
    this.toolGroup = el("div", { class: "plan-tools editing-only", role: "toolbar", "aria-orientation": "vertical", "aria-label": t("Tools") }, listTools().map(tool));
    this.snap = el("input", { type: "checkbox", checked: true });
    this.snap.addEventListener("change", () => (this.tools.select.snaps = this.snap.checked));
    this.width = el("input", { class: "door-width", inputMode: "decimal", autocomplete: "off", "aria-label": t("Width of the door or exit") });
    this.width.addEventListener("input", () => this.#setWidth());
    this.route = el("input", { class: "route-name", list: "plan-routes", autocomplete: "off", "aria-label": t("Route of new ways") });
    this.route.addEventListener("input", () => (this.tools.way.route = this.route.value.trim()));
    this.routeList = el("datalist", { id: "plan-routes" });
    this.unit = el("span");
    this.widthOption = el("label", { class: "inline", title: t("It becomes the clear width of the ways that are drawn through it.") }, t("Width"), this.width, this.unit);
    this.routeOption = el("label", { class: "inline" }, t("Route"), this.route, this.routeList);
    this.options = el("div", { class: "plan-group editing-only" }, this.widthOption, this.routeOption);
  }

  #setWidth() {
    const metres = readNumber(this.width.value) * this.model.unit.factor;
    this.width.setAttribute("aria-invalid", String(!(metres > 0) && this.width.value.trim() !== ""));
    for (const name of WITH_WIDTH) this.tools[name].width = metres > 0 ? metres : null;
  }

  #buildShown() {
    const falls = choose([["selected", t("selected")], ["all", t("all")], ["none", t("none")]], this.scene.falls);
    falls.addEventListener("change", () => {
      this.scene.falls = falls.value;
      this.scene.drawFalls();
    });
    const routes = el("input", { type: "checkbox", checked: true });
    routes.addEventListener("change", () => {
      this.scene.showsRoutes = routes.checked;
      this.scene.drawRoutes();
    });
    const snap = el("label", { class: "check editing-only", title: t("Pieces snap to walls and to each other; Alt switches it off while dragging.") }, this.snap, t("Snap"));
    this.shown = el("div", { class: "plan-group", role: "group", "aria-label": t("What is shown") }, snap,
      el("label", { class: "inline", title: t("The floor that a piece may cover when it falls") }, t("Show fall zones:"), falls), el("label", { class: "check" }, routes, t("Show routes")));
  }

  #buildView() {
    const button = (name, label, run, key) => el("button", { type: "button", class: "square", "aria-label": label, title: key ? `${label} (${key})` : label, on: { click: run } }, icon(name));
    this.view = el("div", { class: "plan-view-tools", role: "group", "aria-label": t("View") },
      button("minus", t("Zoom out"), () => this.viewport.zoom(0.8), "-"), button("plus", t("Zoom in"), () => this.viewport.zoom(1.25), "+"), button("fit", t("Show all"), () => this.fit(), "0"),
      el("button", { type: "button", class: "square editing-only", "aria-label": t("Keys of the plan"), title: t("Keys of the plan"), on: { click: () => this.help() } }, icon("help")));
  }

  // ---- drawing

  draw() {
    this.#drawFloors();
    const tool = this.currentTool();
    for (const button of this.toolGroup.children) {
      button.setAttribute("aria-pressed", String(button.dataset.tool === tool.name));
      const sheet = { select: "Items", measure: "Items", way: "Routes" }[button.dataset.tool] ?? "Places";
      button.disabled = !this.store.sheet(sheet)?.found;
    }
    this.widthOption.hidden = !WITH_WIDTH.includes(tool.name);
    this.routeOption.hidden = tool.name !== "way";
    const { unit, factor } = this.model.unit;
    this.unit.textContent = unit;
    this.width.placeholder = number(DOOR / factor, 1);
    if (tool.name === "way") this.#drawRoutes(tool);
  }

  #drawRoutes(tool) {
    const names = this.store.sheet("Routes")?.names("route") ?? [];
    clear(this.routeList).append(...names.map((value) => el("option", { value })));
    if (!tool.route) tool.nextRoute();
    if (document.activeElement !== this.route) this.route.value = tool.route;
  }

  #drawFloors() {
    const { plan } = this.model;
    const floors = plan?.floors ?? [];
    const isList = floors.length > BUTTONS_UP_TO || (floors.length > 1 && !(WIDE.matches && this.canEdit()));
    const mark = JSON.stringify([floors, plan?.floor, isList]);
    if (mark === this.floorsShown) return;
    this.floorsShown = mark;
    const name = (one) => (one.name && one.name !== one.floor ? one.name : t("Floor {floor}", { floor: one.floor }));
    const hadFocus = this.floors.contains(document.activeElement);
    clear(this.floors);
    if (isList) {
      const list = choose(floors.map((one) => [one.floor, name(one)]), plan.floor, { "aria-label": t("Floor") });
      list.addEventListener("change", () => this.setFloor(list.value));
      this.floors.append(list);
    } else {
      this.floors.append(el("div", { class: "segmented", role: "group", "aria-label": t("Floor") }, floors.map((one) =>
        el("button", { type: "button", text: name(one), dataset: { floor: one.floor }, "aria-pressed": String(one.floor === plan.floor), on: { click: () => this.setFloor(one.floor) } }))));
    }
    if (hadFocus) this.floors.querySelector('[aria-pressed="true"], select')?.focus();
  }
}
