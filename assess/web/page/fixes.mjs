// The problems of the workbook in lists, and the fixes that the server offers for them.

import { el } from "./elements.mjs";
import { cellName } from "./sheet.mjs";
import { html } from "./vendor/lit-html.mjs";

/** A button for each fix of a problem, which is one step of undo; all go off with the first click, until there are new ones. */
export function fixButtons(store, problem) {
  const fix = (edits, label) => {
    for (const one of document.querySelectorAll("button.fix")) one.disabled = true; // their rows may be taken now
    store.edit(edits, label);
  };
  return (problem?.actions ?? []).map(({ label, edits }) => el("button", { type: "button", class: "fix", text: label, on: { click: () => fix(edits, label) } }));
}

/** A problem with a way to its cell, and its fixes. */
export function problemLine(store, problem) {
  const { severity, sheet, row, at, message, fix } = problem;
  const own = store.sheet(sheet);
  const go = () => ((location.hash = "#sheet"), store.reveal([sheet, row, at ?? 0]));
  const link = () => html`<button type="button" class="quiet link" @click=${go}>${cellName(own, row, at ?? 0)}</button>`;
  return html`<li class=${severity}>${row ? link() : html`<b>${own?.title ?? sheet}</b>`} ${message} ${fix} ${fixButtons(store, problem)}</li>`;
}
