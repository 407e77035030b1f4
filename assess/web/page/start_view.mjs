// The empty state: a new building, or a file to open; the worked example as a link.

import { get, post, send } from "./api.mjs";
import { el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { imports } from "./job.mjs";
import { notice } from "./messages.mjs";
import { canLeave, chooseFile } from "./open_file.mjs";
import { StartForm } from "./start_form.mjs";
import { language, number, t } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const EXAMPLE = "market-street.xlsx";
const MOST_EXAMPLES = 20;
const CONFLICT = 409;
const SOON_S = 3;

class StartView {
  #root;
  #store;
  #offers = null;
  #fault = "";
  #form = null;
  #isBusy = false;
  #card = el("section", { class: "choice import-card", "aria-label": t("Open a file") });

  constructor(root, store) {
    this.#root = root.appendChild(el("div", { class: "page-like start" }));
    this.#store = store;
    imports.addEventListener("change", () => this.#drawCard());
    this.#drawCard();
  }

  async show() {
    this.#form = null;
    try {
      this.#offers = await get("/api/start");
      this.#fault = "";
    } catch (error) {
      this.#fault = error.message || t("The server does not answer.");
    }
    this.#draw();
  }

  hide() {}

  #draw() {
    const parts = this.#fault ? html`<p role="alert">${this.#fault}</p>` : this.#form ? this.#form.node : this.#choices();
    render(parts, this.#root);
  }

  #choices() {
    const { book } = this.#store;
    const { can_save: canSave, folder } = this.#offers;
    const example = (event) => (event.preventDefault(), this.#begin({ kind: "example", name: EXAMPLE, language: language() }));
    return html`
      <h2>${t("Which furniture overturns in an earthquake, and what to fix first")}</h2>
      ${book ? html`<p><a href="#sheet">${t("Back to {name}", { name: book.name })}</a></p>` : nothing}
      <div class="ways">
        <section class="choice">
          <button type="button" class="new-building" @click=${() => this.#showForm(true)}>
            ${icon("plus")}<strong>${t("New building")}</strong><span class="muted">${t("A workbook with the floors of your building and its first pieces. Risk classes show while you type.")}</span>
          </button>
        </section>
        ${this.#card}
      </div>
      <p class="example"><a href="#example" @click=${example}>${t("Open the worked example")}</a>
        <span class="hint">${t("An office tower in San Francisco with the motions recorded on its floors in 1989. Its furniture is made up. You may change everything.")}
          ${canSave ? t("It is made as {name} in the folder {folder}.", { name: EXAMPLE, folder }) : nothing}</span></p>
      <p class="hint">${t("Nothing leaves this machine, unless the page was opened at the address of another one.")}</p>`;
  }

  /** The choice that opens a file: a workbook, or a building model, with how far its reading is and why nothing came of it. */
  #drawCard() {
    const { isBusy, isCancelled, current, sending, fault, drafts } = imports;
    const hadFocus = this.#card.contains(document.activeElement);
    const name = sending || current?.name || "";
    const words = !isBusy ? "" : sending ? t("Sending {name}", { name }) : t("Reading {name}", { name });
    render(html`
      ${isBusy ? this.#reading(words) : html`<button type="button" @click=${() => chooseFile(this.#store)}>${icon("folder")}<strong>${t("Open a file")}</strong><span class="muted">${t("A workbook (.xlsx), or a building model: IFC (.ifc), COBie (.xlsx), a RoomPlan scan (.json), a Sweet Home 3D plan (.sh3d). Or drop it anywhere on this page.")}</span></button>`}
      <p class="unseen" role="status">${words}</p>
      <p class="fault ${isCancelled ? "" : "error-text"}" role="alert">${fault}</p>
      ${current?.found ? html`<p><a href="#import">${t("What was taken from {name}", { name })}</a></p>` : nothing}
      <div class="option"><input type="checkbox" id="drafts" aria-describedby="drafts-hint" .checked=${drafts} ?disabled=${isBusy} @change=${(event) => (imports.drafts = event.target.checked)}>
        <span><label for="drafts">${t("Draft evacuation routes")}</label> <span class="hint" id="drafts-hint">${t("Of a building model: from the rooms to the exits; check them on the plan.")}</span></span></div>`, this.#card);
    if (hadFocus && !this.#card.contains(document.activeElement)) this.#card.querySelector("button").focus();
  }

  #reading(words) {
    const { current, sending } = imports;
    const spent = sending ? 0 : Math.floor(current.seconds);
    const share = !sending && current.share > 0 ? current.share : nothing;
    return html`<div class="reading">
      <p><span>${words}</span> <span class="muted" aria-hidden="true">${spent >= SOON_S ? t("{n} s. A large model takes up to two minutes; you may go on working.", { n: number(spent) }) : nothing}</span></p>
      <progress max="1" value=${share} aria-label=${t("Reading the building model")}></progress>
      <div class="buttons"><button type="button" @click=${() => imports.cancel()}>${t("Cancel")}</button></div></div>`;
  }

  #showForm(isShown) {
    this.#form = isShown ? new StartForm(this.#offers, (request, records) => this.#begin(request, records), () => this.#showForm(false)) : null;
    this.#draw();
    this.#root.querySelector(isShown ? "select" : ".new-building").focus();
  }

  /** Have the server make the workbook, send the records that it names, and show its first piece. */
  async #begin(request, records = []) {
    if (this.#isBusy || !(await canLeave(this.#store, request.name))) return;
    this.#isBusy = true;
    try {
      const book = await this.#make(request);
      this.#store.replaceBook(book);
      location.hash = "#sheet";
      const named = request.records ?? [];
      const missing = (book.missing ?? []).filter((one) => one.kind === "record");
      for (const [at, { name }] of named.length ? missing.entries() : []) this.#store.replaceBook(await send(`/api/file?name=${encodeURIComponent(name)}`, records[at]));
    } catch (error) {
      const why = [error.message || t("The server does not answer."), ...(error.body?.problems ?? []).map((one) => one.message)].join("\n");
      if (this.#form && location.hash !== "#sheet") this.#form.complain(why, error.body?.field);
      else notice(why, { kind: "error" });
    } finally {
      this.#isBusy = false;
    }
  }

  /** The example is made under another name where it was made before. */
  async #make(request) {
    for (let n = 2; request.kind === "example" && n <= MOST_EXAMPLES; n += 1) {
      try {
        return await post("/api/start", request);
      } catch (error) {
        if (error.status !== CONFLICT) throw error;
        request = { ...request, name: EXAMPLE.replace(".", `-${n}.`) };
      }
    }
    return post("/api/start", request);
  }
}

export const createView = (root, store) => new StartView(root, store);
