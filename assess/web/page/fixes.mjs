// The fixes that the server offers for a problem, as buttons.

import { el } from "./elements.mjs";

/** A button for each fix of a problem, which is one step of undo; all go off with the first click, until there are new ones. */
export function fixButtons(store, problem) {
  const fix = (edits, label) => {
    for (const one of document.querySelectorAll("button.fix")) one.disabled = true; // their rows may be taken now
    store.edit(edits, label);
  };
  return (problem?.actions ?? []).map(({ label, edits }) => el("button", { type: "button", class: "fix", text: label, on: { click: () => fix(edits, label) } }));
}
