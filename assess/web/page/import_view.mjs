// What was taken of a building model and what was skipped, what to check, and the way into the new workbook.

import { get } from "./api.mjs";
import { writeList } from "./clipboard.mjs";
import { choose, clear, el, labelled } from "./elements.mjs";
import { imports } from "./job.mjs";
import { notice } from "./messages.mjs";
import { canLeave } from "./open_file.mjs";
import { number, t, tn } from "./texts.mjs";

const FIRST = 12;
const SIGNS = { warning: "▲", note: "ℹ" };

class ImportView {
  #root;
  #store;
  #shown = "";
  #isShown = false;
  #offers = null;

  constructor(root, store) {
    this.#root = root;
    this.#store = store;
    imports.addEventListener("change", () => this.#isShown && this.#update());
  }

  async show() {
    this.#isShown = true;
    this.#offers ??= await get("/api/start").catch(() => ({ shakings: [] }));
    this.#shown = "";
    this.#update();
    this.#root.querySelector("h2")?.focus({ preventScroll: true });
  }

  hide() {
    this.#isShown = false;
  }

  #update() {
    const one = imports.shown;
    const key = `${one?.id} ${one?.book}`;
    if (key === this.#shown) return;
    this.#shown = key;
    if (one) this.#draw(one);
    else clear(this.#root).append(el("div", { class: "page-like" }, el("p", { text: t("No building model has been read.") })));
  }

  #draw(one) {
    const { found } = one;
    this.#root.scrollTop = 0;
    clear(this.#root).append(el("div", { class: "page-like imported" },
      el("h2", { tabIndex: -1, text: t("What was taken from {name}", { name: one.name }) }), headline(found),
      this.#skipped(found), checks(found), one.book ? this.#back() : this.#opening(one)));
  }

  // ---- what was skipped

  #skipped(found) {
    const maybe = found.skipped.filter((group) => group.is_furniture);
    const others = found.skipped.filter((group) => !group.is_furniture);
    const n = total(others);
    const summary = tn("{n:,} element skipped that is not furniture", "{n:,} elements skipped that are not furniture", n);
    const copy = el("button", { type: "button", text: t("Copy the list"), on: { click: () => copyList(found) } });
    return [
      maybe.length > 0 && el("section", { class: "card" }, el("div", { class: "head" },
        el("h3", { text: tn("{n:,} piece skipped that may be furniture", "{n:,} pieces skipped that may be furniture", total(maybe)) }), copy),
      el("p", { class: "muted", text: t("Add those that stand on the floor and can fall to the sheet Items by hand.") }), table(maybe)),
      others.length > 0 && el("details", { class: "card fold", open: maybe.length === 0 && found.pieces === 0 }, el("summary", { text: summary }),
        maybe.length === 0 && el("div", { class: "buttons" }, copy), table(others)),
    ];
  }

  // ---- into the workbook

  #opening(one) {
    const offers = this.#offers.shakings.filter(([key]) => key);
    this.shaking = choose([["", t("I do not know yet")], ...offers], "");
    this.open = el("button", { type: "button", class: "primary", text: t("Open the workbook"), on: { click: () => this.#open(one) } });
    const drop = el("button", { type: "button", text: t("Discard"), on: { click: () => this.#drop() } });
    const place = this.#offers.can_save
      ? t("It is saved as {name} in the folder {folder}, plans beside it. No file is replaced.", { name: one.workbook, folder: this.#offers.folder })
      : t("It is opened as {name} and kept while this page is in use: download it when you are done.", { name: one.workbook });
    const { book } = this.#store;
    return el("section", { class: "card opening", "aria-label": t("The new workbook") },
      labelled(t("Shaking of the ground"), this.shaking, t("The file does not say how strong the ground shakes. Without it there are no risk classes yet.")),
      el("div", { class: "way" }, el("div", { class: "buttons" }, this.open, drop), el("p", { class: "hint" }, place, book && ` ${t("{name} is closed first.", { name: book.name })}`)));
  }

  #back() {
    return el("div", { class: "buttons" }, el("a", { class: "button primary", href: "#sheet", text: t("Back to {name}", { name: this.#store.book?.name ?? "" }) }));
  }

  async #open(one) {
    if (this.open.disabled || !(await canLeave(this.#store, one.workbook))) return;
    this.open.disabled = true;
    this.open.textContent = t("Making the workbook…");
    try {
      await imports.open(this.shaking.value);
    } catch (error) {
      notice(error.message || t("The server does not answer."), { kind: "error" });
    }
    this.open.disabled = false;
    this.open.textContent = t("Open the workbook");
  }

  async #drop() {
    await imports.cancel();
    location.hash = this.#store.book ? "#sheet" : "#start";
  }
}

const total = (groups) => groups.reduce((sum, group) => sum + group.count, 0);

/** How much was taken, in one line, and what else there is. */
function headline(found) {
  const floors = tn("{n} floor", "{n} floors", found.floors);
  const pieces = found.pieces === found.of
    ? tn("{n:,} piece", "{n:,} pieces", found.pieces) : tn("{n:,} of {of:,} piece", "{n:,} of {of:,} pieces", found.of, { n: found.pieces, of: found.of });
  const more = [
    found.pieces > 0 && tn("{n:,} type", "{n:,} types", found.types),
    found.rooms > 0 && tn("{n:,} room", "{n:,} rooms", found.rooms),
    found.plans > 0 && tn("{n:,} plan", "{n:,} plans", found.plans),
    found.pieces > 0 && found.pieces === found.of && t("no furniture skipped"),
    found.routes > 0 && tn("{n:,} drafted route", "{n:,} drafted routes", found.routes),
  ].filter(Boolean);
  const first = found.pieces ? t("{pieces} on {floors}", { pieces, floors }) : t("No furniture was found: fill in the sheet Items by hand.");
  return el("p", { class: "taken" }, el("strong", { text: first }), more.length > 0 && el("span", { class: "muted", text: more.join(" · ") }));
}

/** Types and their numbers, by the reason for which they were skipped. */
function table(groups) {
  const head = el("tr", null, el("th", { scope: "col", text: t("Type") }), el("th", { scope: "col", class: "num", text: t("Number") }));
  return el("div", { class: "scroll-x" }, el("table", { class: "plain skipped" }, el("thead", null, head), groups.map(body)));
}

function body(group) {
  const row = ([type, n]) => el("tr", null, el("td", { text: type }), el("td", { class: "num", text: number(n, undefined, true) }));
  const node = el("tbody", null,
    el("tr", { class: "reason" }, el("th", { scope: "rowgroup", text: capital(group.reason) }), el("td", { class: "num", text: number(group.count, undefined, true) })),
    group.types.slice(0, FIRST).map(row));
  const rest = group.types.slice(FIRST);
  const all = () => (more.replaceWith(...rest.map(row)), node.querySelector("th").focus());
  const label = tn("Show {n:,} more type", "Show {n:,} more types", rest.length);
  const more = el("tr", null, el("td", { colSpan: 2 }, el("button", { type: "button", class: "quiet link", text: label, on: { click: all } })));
  if (rest.length) node.append(more);
  if (group.more) node.append(el("tr", null, el("td", { colSpan: 2, text: tn("{n:,} more type", "{n:,} more types", group.more) })));
  return node;
}

const capital = (text) => text.charAt(0).toLocaleUpperCase() + text.slice(1);

function checks({ warnings, remarks }) {
  const line = (kind) => (text) => el("li", { class: kind }, el("span", { class: "problems-sign", "aria-hidden": "true", text: SIGNS[kind] }), el("span", { text }));
  if (warnings.length + remarks.length === 0) return null;
  return el("section", { class: "card" }, el("h3", { text: t("What to check") }),
    el("ul", { class: "problem-list" }, warnings.map(line("warning")), remarks.map(line("note"))));
}

/** The list as lines with tabs, which a spreadsheet takes as cells. */
async function copyList(found) {
  const rows = found.skipped.flatMap((group) => group.types.map(([type, n]) => [group.reason, type, n]));
  try {
    await navigator.clipboard.writeText(writeList([[t("Reason"), t("Type"), t("Number")], ...rows]));
    notice(t("The list was copied: paste it into a spreadsheet or a message."));
  } catch {
    notice(t("The browser does not allow copying. Select the table, and copy it with Ctrl and C."), { kind: "error" });
  }
}

export const createView = (root, store) => new ImportView(root, store);
