// The card of the start on which a building model is chosen: how far its reading is, and why nothing came of it.

import { clear, el } from "./elements.mjs";
import { imports } from "./import_job.mjs";
import { number, t } from "./texts.mjs";

const SOON_S = 3;

export class ImportCard {
  /** @param {() => void} choose has the browser's dialog choose a file */
  constructor(choose) {
    this.choose = el("button", { type: "button", text: t("Choose a model…"), on: { click: choose } });
    this.cancel = el("button", { type: "button", text: t("Cancel"), on: { click: () => imports.cancel() } });
    this.words = el("span");
    this.seconds = el("span", { class: "muted", "aria-hidden": "true" });
    this.bar = el("progress", { max: 1, "aria-label": t("Reading the building model") });
    this.busy = el("div", { class: "reading" }, el("p", null, this.words, " ", this.seconds), this.bar, el("div", { class: "buttons" }, this.cancel));
    this.area = el("div", { class: "drop" }, el("p", { text: t("Drop a model anywhere on this page.") }), this.choose);
    this.status = el("p", { class: "unseen", role: "status" });
    this.fault = el("p", { class: "error-text fault", role: "alert" });
    this.read = el("p", null, el("a", { href: "#import" }));
    this.node = el("section", { class: "card import-card", "aria-label": t("Start from a building model") }, el("h3", { text: t("Start from a building model") }),
      this.area, this.busy, this.status, this.fault, this.read, this.#option(),
      el("p", { class: "hint", text: t("Makes a new workbook of its furniture, rooms and plans. Reads IFC (.ifc), COBie (.xlsx), RoomPlan (.json) and Sweet Home 3D (.sh3d).") }));
    imports.addEventListener("change", () => this.update());
    this.update();
  }

  #option() {
    this.drafts = el("input", { type: "checkbox", id: "drafts", "aria-describedby": "drafts-hint", checked: imports.drafts, on: { change: () => (imports.drafts = this.drafts.checked) } });
    return el("div", { class: "option" }, this.drafts, el("span", null, el("label", { for: "drafts", text: t("Draft evacuation routes") }),
      el("span", { class: "hint", id: "drafts-hint", text: t("From the rooms to the exits; check them on the plan.") })));
  }

  update() {
    const { isBusy, current, sending, fault } = imports;
    const hadFocus = this.node.contains(document.activeElement);
    const turned = this.busy.hidden === isBusy;
    this.busy.hidden = !isBusy;
    this.area.hidden = isBusy;
    this.drafts.disabled = isBusy;
    this.drafts.checked = imports.drafts;
    this.read.hidden = !current?.found;
    this.read.firstChild.textContent = t("What was taken from {name}", { name: current?.name ?? "" });
    if (turned && hadFocus) (isBusy ? this.cancel : this.choose).focus();
    const name = sending || current?.name || "";
    const words = !isBusy ? "" : sending ? t("Sending {name}", { name }) : t("Reading {name}", { name });
    if (this.words.textContent !== words) this.status.textContent = this.words.textContent = words;
    const spent = !sending && isBusy ? Math.floor(current.seconds) : 0;
    this.seconds.textContent = spent >= SOON_S ? t("{n} s. A large model takes up to two minutes; you may go on working.", { n: number(spent) }) : "";
    if (current?.share > 0 && !sending) this.bar.value = current.share;
    else this.bar.removeAttribute("value");
    this.fault.classList.toggle("error-text", !imports.isCancelled);
    if (this.fault.textContent !== fault) clear(this.fault).append(fault);
  }
}
