// Simulation and reports.
import { el } from "./elements.mjs";
import { t } from "./texts.mjs";
export function createView(root) {
  root.append(el("div", { class: "page-like" }, el("h2", { text: t("Simulate and report") })));
  return { show() {}, hide() {} };
}
