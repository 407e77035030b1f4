// The choice of the start that opens a file: a workbook, or a building model, with how far its reading is and why nothing came of it.

import { el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { imports } from "./import_job.mjs";
import { number, t } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const SOON_S = 3;

export class ImportCard {
  node = el("section", { class: "choice import-card", "aria-label": t("Open a file") });
  #choose;

  /** @param {() => void} choose has the browser's dialog choose a file */
  constructor(choose) {
    this.#choose = choose;
    imports.addEventListener("change", () => this.update());
    this.update();
  }

  update() {
    const { isBusy, isCancelled, current, sending, fault, drafts } = imports;
    const hadFocus = this.node.contains(document.activeElement);
    const name = sending || current?.name || "";
    const words = !isBusy ? "" : sending ? t("Sending {name}", { name }) : t("Reading {name}", { name });
    render(html`
      ${isBusy ? this.#reading(words) : html`<button type="button" @click=${this.#choose}>${icon("folder")}<strong>${t("Open a file")}</strong><span class="muted">${t("A workbook (.xlsx), or a building model: IFC (.ifc), COBie (.xlsx), a RoomPlan scan (.json), a Sweet Home 3D plan (.sh3d). Or drop it anywhere on this page.")}</span></button>`}
      <p class="unseen" role="status">${words}</p>
      <p class="fault ${isCancelled ? "" : "error-text"}" role="alert">${fault}</p>
      ${current?.found ? html`<p><a href="#import">${t("What was taken from {name}", { name })}</a></p>` : nothing}
      <div class="option"><input type="checkbox" id="drafts" aria-describedby="drafts-hint" .checked=${drafts} ?disabled=${isBusy} @change=${(event) => (imports.drafts = event.target.checked)}>
        <span><label for="drafts">${t("Draft evacuation routes")}</label> <span class="hint" id="drafts-hint">${t("Of a building model: from the rooms to the exits; check them on the plan.")}</span></span></div>`, this.node);
    if (hadFocus && !this.node.contains(document.activeElement)) this.node.querySelector("button").focus();
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
}
