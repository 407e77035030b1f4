// Makes elements. Text of users is set by textContent only, so that markup in it stays text.

import { html, nothing } from "./vendor/lit-html.mjs";

const SVG = "http://www.w3.org/2000/svg";
const ATTRIBUTES = new Set(["list", "form", "role", "for", "type", "width", "height"]);

/**
 * An element with children, and props: class, text, dataset {name: value}, style {property: value}, on {event: listener}; all
 * others are properties where it has them, else attributes; null, undefined and (for attributes) false leave them out.
 */
export const el = (tag, props, ...children) => fillIn(document.createElement(tag), props, children, false);

/** The same for SVG: every property is an attribute. */
export const svg = (tag, props, ...children) => fillIn(document.createElementNS(SVG, tag), props, children, true);

function fillIn(node, props, children, isSvg) {
  const isGiven = (value) => value !== null && value !== undefined;
  for (const [name, value] of Object.entries(props ?? {})) if (isGiven(value)) setOne(node, name, value, isSvg);
  node.append(...children.flat(Infinity).filter((child) => isGiven(child) && child !== false));
  return node;
}

function setOne(node, name, value, isSvg) {
  if (name === "class") node.setAttribute("class", value);
  else if (name === "text") node.textContent = value;
  else if (name === "dataset") Object.assign(node.dataset, value);
  else if (name === "style") for (const [key, one] of Object.entries(value)) node.style.setProperty(key, one);
  else if (name === "on") for (const [event, listener] of Object.entries(value)) node.addEventListener(event, listener);
  else if (!isSvg && name in node && !ATTRIBUTES.has(name)) node[name] = value;
  else if (value === false && !name.startsWith("aria-")) node.removeAttribute(name);
  else node.setAttribute(name, value === true && !name.startsWith("aria-") ? "" : value);
}

/** Take all children out. */
export function clear(node) {
  node.replaceChildren();
  return node;
}

/** A label above its field. */
export function labelled(label, field, help = "") {
  return el("label", { class: "field" }, el("span", { class: "field-name", text: label }), field, help && el("span", { class: "hint", text: help }));
}

/** The same as a template of lit-html. */
export const field = (label, input, hint = "") => html`<label class="field"><span class="field-name">${label}</span>
  ${input}${hint ? html`<span class="hint">${hint}</span>` : nothing}</label>`;

/** A drop-down of [value, label] pairs. */
export function choose(options, value, props) {
  const select = el("select", props, options.map(([key, label]) => el("option", { value: key, text: label })));
  select.value = value ?? options[0]?.[0] ?? "";
  return select;
}
