// The empty state: how to begin.
import { el } from "./elements.mjs";
import { t } from "./texts.mjs";
export function createView(root) {
  root.append(el("div", { class: "page-like" }, el("h2", { text: t("Start") })));
  return { show() {}, hide() {} };
}
