// The empty state: a workbook that there is, a building model, the worked example, or a new one in three short steps.

import { get, post } from "./api.mjs";
import { clear, el } from "./elements.mjs";
import { ImportCard } from "./import_card.mjs";
import { notice } from "./messages.mjs";
import { canLeave, chooseModel, chooseWorkbook } from "./open_file.mjs";
import { StartForm } from "./start_form.mjs";
import { t } from "./texts.mjs";

const EXAMPLE = "market-street.xlsx";
const MOST_EXAMPLES = 20;
const CONFLICT = 409;

class StartView {
  #root;
  #store;
  #isBusy = false;

  constructor(root, store) {
    this.#root = root;
    this.#store = store;
    this.card = new ImportCard(() => chooseModel(store));
  }

  async show() {
    try {
      this.#draw(await get("/api/start"));
    } catch (error) {
      clear(this.#root).append(el("div", { class: "page-like" }, el("p", { role: "alert", text: error.message || t("The server does not answer.") })));
    }
  }

  hide() {}

  #draw(offers) {
    this.form = new StartForm(offers, (request) => this.#begin(request));
    const back = el("p", null, el("a", { href: "#sheet", text: t("Back to {name}", { name: this.#store.book?.name ?? "" }) }));
    clear(this.#root).append(el("div", { class: "page-like start" },
      el("h2", { text: t("Which furniture overturns in an earthquake, and what to fix first") }),
      el("p", { class: "muted", text: t("You list the furniture of a building in an Excel workbook, as a sheet and on a plan. Risk classes show while you type.") }),
      this.#store.book && back,
      el("div", { class: "ways" }, this.#openCard(), this.card.node, this.#exampleCard(offers)),
      el("section", { class: "card" }, el("h3", { text: t("Make a new workbook") }), place(offers), this.form.node),
      el("p", { class: "hint", text: t("Nothing leaves this machine, unless the page was opened at the address of another one.") })));
  }

  #openCard() {
    const open = el("button", { type: "button", text: t("Choose a workbook…"), on: { click: () => chooseWorkbook(this.#store) } });
    return el("section", { class: "card" }, el("h3", { text: t("Open a workbook") }),
      el("div", { class: "drop" }, el("p", { text: t("Drop an Excel workbook (.xlsx) anywhere on this page.") }), open));
  }

  #exampleCard(offers) {
    const begin = () => this.#begin({ kind: "example", name: EXAMPLE, language: this.form.language });
    return el("section", { class: "card" }, el("h3", { text: t("Look at an example") }),
      el("p", { text: t("An office tower in San Francisco with the motions recorded on its floors in 1989. Its furniture is made up. You may change everything.") }),
      el("div", { class: "buttons" }, el("button", { type: "button", text: t("Open the worked example"), on: { click: begin } })),
      offers.can_save && el("p", { class: "hint", text: t("It is made as {name} in the folder {folder}.", { name: EXAMPLE, folder: offers.folder }) }));
  }

  /** Have the server make the workbook, and show its first piece. */
  async #begin(request) {
    if (this.#isBusy || !(await canLeave(this.#store, request.name))) return;
    this.#isBusy = true;
    this.form.complain("");
    try {
      this.#store.replaceBook(await this.#make(request));
      location.hash = "#sheet";
    } catch (error) {
      const why = [error.message || t("The server does not answer."), ...(error.body?.problems ?? []).map((one) => one.message)];
      if (request.kind === "example") notice(why.join("\n"), { kind: "error" });
      else this.form.complain(why.join("\n"));
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

/** Where the new file will be. */
function place(offers) {
  const text = offers.can_save
    ? t("It is made in the folder {folder}, in which assess open was started, and every change is saved in it.", { folder: offers.folder })
    : t("It is kept while this page is in use: download it when you are done.");
  return el("p", { class: "muted", text });
}

export const createView = (root, store) => new StartView(root, store);
