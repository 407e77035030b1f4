// Notices at the edge of the page, and questions that wait for an answer.

import { el } from "./elements.mjs";
import { icon } from "./icons.mjs";
import { t } from "./texts.mjs";

const SHOWN_MS = 8000;
const WITH_ACTIONS_MS = 15000;
const ERROR_MS = 30000;
const MOST = 5;
const shown = new Map();

/**
 * Show a notice: `kind` "info" or "error", `actions` [label, run]. One with the same text, or the same `key`, takes the place
 * of the earlier one. All but `lasting` ones and errors with actions go by themselves after a while; one with `until` goes as
 * soon as `endNotices` is called with another moment. The answer has `close`.
 */
export function notice(text, { kind = "info", actions = [], key = text, lasting = false, until } = {}) {
  shown.get(key)?.close();
  const node = el("div", { class: `notice notice-${kind}`, role: kind === "error" ? "alert" : "status" });
  const one = { until, close: () => (clearTimeout(one.timer), node.remove(), shown.get(key) === one && shown.delete(key)) };
  const buttons = actions.map(([label, run]) => el("button", { type: "button", text: label, on: { click: () => (one.close(), run()) } }));
  const close = el("button", { type: "button", class: "quiet close", "aria-label": t("Close"), on: { click: one.close } }, icon("close"));
  node.append(el("p", { text }), ...buttons, close);
  (document.getElementById("notices") ?? document.body.appendChild(el("div", { id: "notices" }))).append(node);
  shown.set(key, one);
  if (shown.size > MOST) [...shown.values()].find((other) => other.timer)?.close();
  const isError = kind === "error";
  if (lasting || (isError && actions.length)) return one;
  const time = isError ? ERROR_MS : actions.length ? WITH_ACTIONS_MS : SHOWN_MS;
  const start = () => (one.timer = setTimeout(one.close, time)); // but not while somebody reads it
  node.addEventListener("pointerenter", () => clearTimeout(one.timer));
  node.addEventListener("pointerleave", start);
  start();
  return one;
}

/** Ask a question: the value of the choice, [label, value], of which the first is proposed; null where it was closed. */
export function ask(question, choices) {
  return new Promise((resolve) => {
    let answer = null;
    const dialog = el("dialog", { class: "question", "aria-label": question });
    const buttons = choices.map(([label, value], at) =>
      el("button", { type: "button", class: at === 0 ? "primary" : "", text: label, on: { click: () => ((answer = value), dialog.close()) } }));
    dialog.append(el("p", { text: question }), el("div", { class: "buttons" }, buttons));
    dialog.addEventListener("close", () => (dialog.remove(), resolve(answer)));
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** Take the notices away that belong to another moment: what they offer would act on something else. */
export function endNotices(moment) {
  for (const one of [...shown.values()]) if (one.until !== undefined && one.until !== moment) one.close();
}
