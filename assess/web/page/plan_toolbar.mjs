// The tools above the plan: floor, tools, snapping, what is shown, zoom, help.

import { choose, clear, el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { t } from "./texts.mjs";

const BUTTONS_UP_TO = 6; // floors; beyond that, or where the window is narrower, a list
const WIDE = matchMedia("(min-width: 1200px)");
const KINDS = 5;

export class Toolbar {
  /** @param {{model, store, scene, viewport, select, tools, currentTool, canEdit, setTool, setFloor, fit, help}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    this.floors = el("div", { class: "plan-floors" });
    this.#buildTools();
    this.#buildShown();
    this.#buildView();
    WIDE.addEventListener("change", () => this.draw());
    this.node = el("div", { class: "plan-toolbar", role: "toolbar", "aria-label": t("Tools of the plan") }, this.floors, this.toolGroup, this.options, this.shown);
  }

  #buildTools() {
    const tool = (name, label, key) => el("button", { type: "button", class: "tool", title: `${label} (${key})`, "aria-label": label, dataset: { tool: name }, on: { click: () => this.setTool(name) } }, icon(name === "place" ? "room" : name === "segment" ? "way" : name), el("span", { text: label }));
    this.toolGroup = el("div", { class: "plan-group tools editing-only", role: "group", "aria-label": t("Tools") },
      tool("select", t("Select"), "V"), tool("measure", t("Measure"), "M"), tool("place", t("Place"), "P"), tool("segment", t("Segment"), "S"));
    this.options = el("div", { class: "plan-group options editing-only" });
    this.snap = el("input", { type: "checkbox", checked: true });
    this.snap.addEventListener("change", () => (this.tools.select.snaps = this.snap.checked));
    this.kind = el("select", { "aria-label": t("Kind of place") });
    this.kind.addEventListener("change", () => {
      this.tools.place.kindAt = this.kind.selectedIndex;
      this.tools.place.leave();
      this.tools.place.enter();
    });
    this.route = el("input", { class: "route-name", list: "plan-routes", autocomplete: "off", "aria-label": t("Route of new segments") });
    this.route.addEventListener("input", () => (this.tools.segment.route = this.route.value.trim()));
    this.routeList = el("datalist", { id: "plan-routes" });
    this.placeOptions = el("label", { class: "inline" }, t("Kind"), this.kind);
    this.routeOptions = el("label", { class: "inline" }, t("Route"), this.route, this.routeList);
    const ofTool = el("div", { class: "tool-option" }, this.placeOptions, this.routeOptions); // one place for both, kept: the plan must not move
    this.options.append(ofTool);
  }

  #buildShown() {
    const falls = choose([["selected", t("of the selected")], ["all", t("of all")], ["none", t("of none")]], this.scene.falls);
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
    this.shown = el("div", { class: "plan-group shown", role: "group", "aria-label": t("Settings of the plan") }, snap,
      el("label", { class: "inline", title: t("The floor that a piece may cover when it falls") }, t("Falls"), falls), el("label", { class: "check" }, routes, t("Routes")));
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
    for (const button of this.toolGroup.children) button.setAttribute("aria-pressed", String(button.dataset.tool === tool.name));
    this.placeOptions.classList.toggle("unused", tool.name !== "place");
    this.routeOptions.classList.toggle("unused", tool.name !== "segment");
    if (tool.name === "place") this.#drawKinds();
    if (tool.name === "segment") this.#drawRoutes(tool);
    for (const name of ["place", "segment"]) {
      const button = this.toolGroup.querySelector(`[data-tool="${name}"]`);
      button.disabled = !this.store.sheet(name === "place" ? "Places" : "Routes")?.found;
    }
  }

  #drawKinds() {
    const choices = this.store.sheet("Places")?.column("kind")?.choices ?? [];
    if (this.kind.options.length === choices.length) return;
    clear(this.kind).append(...choices.slice(0, KINDS).map((one) => el("option", { value: one, text: one })));
    this.kind.selectedIndex = this.tools.place.kindAt;
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
