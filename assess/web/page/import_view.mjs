// What was taken of a building model and what was skipped, what to check, and the way into the new workbook.

import { get } from "./api.mjs";
import { writeList } from "./clipboard.mjs";
import { field } from "./elements.mjs";
import { imports } from "./job.mjs";
import { notice } from "./messages.mjs";
import { canLeave } from "./open_file.mjs";
import { number, t, tn } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const FIRST = 12;

class ImportView {
  #root;
  #store;
  #shown = "";
  #isShown = false;
  #isOpening = false;
  #offers = null;
  /** The reasons whose types are all listed. */
  #whole = new Set();

  constructor(root, store) {
    this.#root = root;
    this.#store = store;
    imports.addEventListener("change", () => this.#isShown && this.#offers && this.#draw());
  }

  async show() {
    this.#isShown = true;
    this.#offers ??= await get("/api/start").catch(() => ({ shakings: [] }));
    this.#shown = "";
    this.#draw();
    this.#root.querySelector("h2")?.focus({ preventScroll: true });
  }

  hide() {
    this.#isShown = false;
  }

  #draw() {
    const one = imports.shown;
    const key = `${one?.id} ${one?.book}`;
    if (key !== this.#shown) {
      render(nothing, this.#root); // what was chosen belongs to another one
      this.#root.scrollTop = 0;
      this.#whole.clear();
    }
    this.#shown = key;
    const parts = one ? this.#parts(one) : html`<p>${t("No building model has been read.")}</p>`;
    render(html`<div class="page-like ${one ? "imported" : ""}">${parts}</div>`, this.#root);
  }

  #parts({ name, found, book, workbook }) {
    const maybe = found.skipped.filter((group) => group.is_furniture);
    const others = found.skipped.filter((group) => !group.is_furniture);
    const isOnly = maybe.length === 0;
    const copy = html`<button type="button" @click=${() => copyList(found)}>${t("Copy the list")}</button>`;
    const summary = (n) => tn("{n:,} element skipped that is not furniture", "{n:,} elements skipped that are not furniture", n);
    const head = (n) => tn("{n:,} piece skipped that may be furniture", "{n:,} pieces skipped that may be furniture", n);
    return html`<h2 tabindex="-1">${t("What was taken from {name}", { name })}</h2>${headline(found)}
      ${isOnly ? nothing : html`<section class="card"><div class="head"><h3>${head(total(maybe))}</h3>${copy}</div>
        <p class="muted">${t("Add those that stand on the floor and can fall to the sheet Items by hand.")}</p>${this.#table(maybe)}</section>`}
      ${others.length ? html`<details class="card fold" ?open=${isOnly && !found.pieces}><summary>${summary(total(others))}</summary>
        ${isOnly ? html`<div class="buttons">${copy}</div>` : nothing}${this.#table(others)}</details>` : nothing}
      ${checks(found)}
      ${book ? html`<div class="buttons"><a class="button primary" href="#sheet">${t("Back to {name}", { name: this.#store.book?.name ?? "" })}</a></div>`
        : this.#opening(workbook)}`;
  }

  /** Types and their numbers, by the reason for which they were skipped. */
  #table(groups) {
    const count = (n) => html`<td class="num">${number(n, undefined, true)}</td>`;
    const whole = (text) => html`<tr><td colspan="2">${text}</td></tr>`;
    const body = ({ reason, count: n, types, more }) => {
      const shown = this.#whole.has(reason) ? types : types.slice(0, FIRST);
      const rest = types.length - shown.length;
      const all = () => (this.#whole.add(reason), this.#draw());
      return html`<tbody>
        <tr class="reason"><th scope="rowgroup">${reason.charAt(0).toLocaleUpperCase() + reason.slice(1)}</th>${count(n)}</tr>
        ${shown.map(([type, of]) => html`<tr><td>${type}</td>${count(of)}</tr>`)}
        ${rest ? whole(html`<button type="button" class="quiet link" @click=${all}>${tn("Show {n:,} more type", "Show {n:,} more types", rest)}</button>`) : nothing}
        ${more ? whole(tn("{n:,} more type", "{n:,} more types", more)) : nothing}</tbody>`;
    };
    return html`<div class="scroll-x"><table class="plain skipped">
      <thead><tr><th scope="col">${t("Type")}</th><th scope="col" class="num">${t("Number")}</th></tr></thead>${groups.map(body)}</table></div>`;
  }

  // ---- into the workbook

  #opening(name) {
    const { can_save: canSave, folder, shakings } = this.#offers;
    const { book } = this.#store;
    const place = canSave
      ? t("It is saved as {name} in the folder {folder}, plans beside it. No file is replaced.", { name, folder })
      : t("It is opened as {name} and kept while this page is in use: download it when you are done.", { name });
    const offers = [["", t("I do not know yet")], ...shakings.filter(([key]) => key)];
    const select = html`<select>${offers.map(([key, label]) => html`<option value=${key}>${label}</option>`)}</select>`;
    return html`<section class="card opening" aria-label=${t("The new workbook")}>
      ${field(t("Shaking of the ground"), select, t("The file does not say how strong the ground shakes. Without it there are no risk classes yet."))}
      <div class="way"><div class="buttons">
        <button type="button" class="primary" ?disabled=${this.#isOpening} @click=${() => this.#open(name)}>${this.#isOpening ? t("Making the workbook…") : t("Open the workbook")}</button>
        <button type="button" @click=${() => this.#drop()}>${t("Discard")}</button></div>
        <p class="hint">${place} ${book ? t("{name} is closed first.", { name: book.name }) : nothing}</p></div></section>`;
  }

  async #open(name) {
    if (this.#isOpening || !(await canLeave(this.#store, name))) return;
    const shaking = this.#root.querySelector("select").value;
    this.#isOpening = true;
    this.#draw();
    await imports.open(shaking).catch((error) => notice(error.message || t("The server does not answer."), { kind: "error" }));
    this.#isOpening = false;
    this.#draw();
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
  return html`<p class="taken"><strong>${first}</strong>${more.length ? html`<span class="muted">${more.join(" · ")}</span>` : nothing}</p>`;
}

function checks({ warnings, remarks }) {
  const line = (kind, sign) => (text) => html`<li class=${kind}><span class="problems-sign" aria-hidden="true">${sign}</span><span>${text}</span></li>`;
  if (warnings.length + remarks.length === 0) return nothing;
  return html`<section class="card"><h3>${t("What to check")}</h3>
    <ul class="problem-list">${warnings.map(line("warning", "▲"))}${remarks.map(line("note", "ℹ"))}</ul></section>`;
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
