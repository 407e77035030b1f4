// The tabs of the page: which there are, which is shown, and their views, made when they are first asked for.

import { clear, el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { imports } from "./job.mjs";
import { t } from "./texts.mjs";

/** Key, which is its icon too, label and module of every tab; each module exports createView(root, store) -> {show, hide}. */
const TABS = [
  ["overview", () => t("Overview"), () => import("./overview_view.mjs")],
  ["sheet", () => t("Sheet"), () => import("./grid_view.mjs")],
  ["plan", () => t("Plan"), () => import("./plan_view.mjs")],
  ["what-if", () => t("What if"), () => import("./what_if_view.mjs")],
  ["results", () => t("Results"), () => import("./results_view.mjs")],
];
const IMPORT = ["import", () => t("What was imported"), () => import("./import_view.mjs")];
const START = ["start", () => t("Start"), () => import("./start_view.mjs")];

export class Tabs {
  #store;
  #views = new Map();
  #shown = "";
  #hasAll = false;

  constructor(store) {
    this.#store = store;
    const link = ([key, label]) => el("a", { href: `#${key}`, dataset: { tab: key } }, icon(key), label());
    this.nav = el("nav", { class: "tabs", "aria-label": t("Views") }, TABS.map(link));
    this.main = el("main", { id: "view", tabIndex: -1 });
    addEventListener("hashchange", () => this.update());
  }

  /** Show the tab of the address, or the start where no workbook is open; what was imported only where there is something. */
  update() {
    const wanted = location.hash.slice(1);
    const found = TABS.find(([key]) => key === wanted) ?? TABS[0];
    const isImport = wanted === "import" && imports.shown;
    const tab = isImport ? IMPORT : !this.#store.book || wanted === "start" ? START : found;
    this.nav.hidden = !this.#store.book;
    for (const link of this.nav.children) link.setAttribute("aria-current", link.dataset.tab === tab[0] ? "page" : "false");
    document.title = [tab[1](), this.#store.book?.name, "assess"].filter(Boolean).join(" – ");
    if (tab[0] !== this.#shown) this.#change(tab);
  }

  async #change(tab) {
    const [key] = tab;
    const before = this.#views.get(this.#shown);
    this.#shown = key;
    before?.view?.hide?.();
    if (before) before.root.hidden = true;
    if (!this.#views.has(key)) this.#views.set(key, this.#make(tab));
    const one = this.#views.get(key);
    one.root.hidden = false;
    await one.ready;
    if (this.#shown === key) one.view?.show?.();
    if (!this.#store.book || this.#hasAll) return;
    this.#hasAll = true; // the modules of the other views, so that they can be shown while the server does not answer
    for (const [, , load] of TABS) load().catch(() => {}); // it is explained where the view is asked for
  }

  #make([key, label, load]) {
    const root = el("section", { class: "view", id: `view-${key}`, "aria-label": label() });
    this.main.append(root);
    const one = { root, view: null };
    const make = ({ createView }) => (one.view = createView(root, this.#store));
    one.ready = load().then(make).catch((error) => this.#explain(root, error));
    return one;
  }

  /** A view that fails says so in its place and leaves the rest of the page as it is. */
  #explain(root, error) {
    console.error(error);
    const again = el("button", { type: "button", text: t("Reload the page"), on: { click: () => location.reload() } });
    const text = t("This view could not be shown. Nothing of the workbook is lost, and the other views work.");
    clear(root).append(el("div", { class: "page-like" }, el("p", { role: "alert", text }), el("div", { class: "buttons" }, again)));
  }
}
