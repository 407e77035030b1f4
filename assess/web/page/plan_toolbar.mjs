// The tools beside the plan, and above it: floor, what is shown, what the tool in use asks for; zoom and help on it.

import { icon } from "./icons.mjs";
import { readNumber } from "./plan_geometry.mjs";
import { DOOR } from "./plan_model.mjs";
import { number, t } from "./texts.mjs";
import { html } from "./vendor/lit-html.mjs";

const BUTTONS_UP_TO = 6; // floors; beyond that, or where the window is narrower, a list
export const WIDE = matchMedia("(min-width: 1200px)");
export const WITH_WIDTH = ["door", "exit"];

/** The tools: names, which are those of their icons, keys, labels, and the sheets that they need. */
export const TOOLS = [
  ["select", "V", () => t("Select"), "Items"], ["measure", "M", () => t("Measure"), "Items"],
  ["room", "O", () => t("Room"), "Places"], ["corridor", "C", () => t("Corridor"), "Places"],
  ["door", "D", () => t("Door"), "Places"], ["stair", "S", () => t("Stair"), "Places"],
  ["exit", "E", () => t("Exit"), "Places"], ["way", "W", () => t("Way"), "Routes"],
];

const icons = {}; // made once: a button that is pressed keeps its own
const iconOf = (name) => (icons[name] ??= icon(name));

export const toolColumn = ({ store, setTool, currentTool }) => html`
  <div class="plan-tools editing-only" role="toolbar" aria-orientation="vertical" aria-label=${t("Tools")}>${TOOLS.map(([name, key, label, sheet]) => html`
    <button type="button" class="tool quiet" title="${label()} (${key})" aria-label=${label()} data-tool=${name}
      aria-pressed=${name === currentTool().name} ?disabled=${!store.sheet(sheet)?.found} @click=${() => setTool(name)}>${iconOf(name)}<span>${label()}</span></button>`)}</div>`;

export function toolbar({ model, store, scene, select, tools, currentTool, canEdit, setFloor }) {
  const { unit, factor } = model.unit;
  const tool = currentTool();
  const setWidth = ({ target }) => {
    const metres = readNumber(target.value) * factor;
    target.setAttribute("aria-invalid", String(!(metres > 0) && target.value.trim() !== ""));
    for (const name of WITH_WIDTH) tools[name].width = metres > 0 ? metres : null;
  };
  const showFalls = ({ target }) => {
    scene.falls = target.value;
    scene.drawFalls();
  };
  const showRoutes = ({ target }) => {
    scene.showsRoutes = target.checked;
    scene.drawRoutes();
  };
  const falls = [["selected", t("selected")], ["all", t("all")], ["none", t("none")]];
  return html`<div class="plan-toolbar" role="toolbar" aria-label=${t("Settings of the plan")} tabindex="-1">
    <div class="plan-floors">${floorChoice(model, canEdit, setFloor)}</div>
    <div class="plan-group" role="group" aria-label=${t("What is shown")}>
      <label class="check editing-only" title=${t("Pieces snap to walls and to each other; Alt switches it off while dragging.")}><input type="checkbox" checked
        @change=${({ target }) => (select.snaps = target.checked)}>${t("Snap")}</label>
      <label class="inline" title=${t("The floor that a piece may cover when it falls")}>${t("Show fall zones:")}
        <select @change=${showFalls}>${falls.map(([value, text]) => html`<option value=${value}>${text}</option>`)}</select></label>
      <label class="check"><input type="checkbox" checked @change=${showRoutes}>${t("Show routes")}</label></div>
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

export function viewTools({ viewport, fit, help }) {
  const button = (name, label, run, key) => html`<button type="button" class=${key ? "square" : "square editing-only"}
    aria-label=${label} title=${key ? `${label} (${key})` : label} @click=${run}>${iconOf(name)}</button>`;
  return html`<div class="plan-view-tools" role="group" aria-label=${t("View")}>
    ${button("minus", t("Zoom out"), () => viewport.zoom(0.8), "-")}${button("plus", t("Zoom in"), () => viewport.zoom(1.25), "+")}
    ${button("fit", t("Show all"), fit, "0")}${button("help", t("Keys of the plan"), help)}</div>`;
}
