// The files that the workbook names and that are missing: what each is for, and where to drop it.

import { send } from "./api.mjs";
import { clear, el } from "./elements.mjs";
import { notice } from "./messages.mjs";
import { cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";
import { whenSent } from "./watch.mjs";

const NAMED = 3;
const USES = {
  record: () => t("record of a motion: how the floor shook"),
  plan: () => t("plan of a floor, the picture under the furniture"),
  photo: () => t("photo of a piece, for the report"),
  logo: () => t("logo, for the cover of the report"),
  hazard: () => t("hazard curve or ShakeMap: how strong the ground shakes"),
};

let dialog = null;

/** Show the list of missing files. */
export function showFiles(store) {
  dialog?.remove();
  const title = el("h2", { id: "files-title", text: t("Files that the workbook names") });
  const body = el("div");
  dialog = el("dialog", { class: "files", "aria-labelledby": "files-title" }, title, body, closing());
  const update = () => fillIn(body, store);
  const events = ["book", "state"];
  for (const event of events) store.addEventListener(event, update);
  dialog.addEventListener("close", () => {
    for (const event of events) store.removeEventListener(event, update);
    dialog.remove();
  });
  update();
  document.body.append(dialog);
  dialog.showModal();
}

const closing = () =>
  el("div", { class: "buttons" }, el("button", { type: "button", text: t("Close"), on: { click: () => dialog.close() } }));

function fillIn(body, store) {
  const missing = store.book?.missing ?? [];
  clear(body);
  if (!missing.length) {
    body.append(el("p", { text: t("Nothing is missing.") }));
    return;
  }
  const text = t("These files were not found next to the workbook. Without them the floors, pictures or records that they hold are left out.");
  body.append(el("p", { text }), table(store, missing), dropArea(store));
}

function table(store, missing) {
  const head = el("tr", null, [t("File"), t("What it is for"), t("Named in")].map((text) => el("th", { scope: "col", text })));
  const rows = missing.map((one) => el("tr", null,
    el("th", { scope: "row", text: one.name }), el("td", { text: USES[one.kind]?.() ?? one.kind }), el("td", null, places(store, one.cells))));
  return el("div", { class: "scroll-x" }, el("table", { class: "plain" }, el("thead", null, head), el("tbody", null, rows)));
}

/** The cells that name a file, each of which leads to its place in the sheet. */
function places(store, cells) {
  const links = cells.slice(0, NAMED).map((cell) => {
    const [name, row, at] = cell;
    const go = () => (dialog.close(), (location.hash = "#sheet"), store.reveal(cell));
    return el("button", { type: "button", class: "quiet", text: cellName(store.sheet(name), row, at), on: { click: go } });
  });
  const more = cells.length - NAMED;
  return [links, more > 0 && ` ${tn("and {n} more", "and {n} more", more)}`];
}

function dropArea(store) {
  const input = el("input", { type: "file", multiple: true, class: "unseen", tabIndex: -1, "aria-label": t("Choose files") });
  input.addEventListener("change", () => addFiles(store, [...input.files]));
  const button = el("button", { type: "button", class: "primary", text: t("Choose files…"), on: { click: () => input.click() } });
  return el("div", { class: "drop" }, el("p", { text: t("Drop the files here, or anywhere on the page. Each is found by its name.") }), button, input);
}

/** Send files that the workbook names; says which were taken and why others were not. */
export async function addFiles(store, files) {
  const taken = [];
  await whenSent(store); // the answer is the whole book, with all that was edited
  for (const file of files) {
    try {
      const wanted = nameAsWanted(store, file.name);
      const answer = await send(`/api/file?name=${encodeURIComponent(wanted)}`, file);
      store.replaceBook(answer);
      taken.push(wanted);
    } catch (error) {
      const why = error.message || t("The server does not answer.");
      notice(t("{name} was not taken: {why}", { name: file.name, why }), { kind: "error" });
    }
  }
  if (taken.length) notice(tn("{names} is now used.", "{n} files are now used: {names}.", taken.length, { names: taken.join(", ") }));
}

/** The name as the workbook writes it: with its folder, its case; else the file's own. */
function nameAsWanted(store, name) {
  const missing = (store.book?.missing ?? []).map((one) => one.name);
  const last = (path) => path.split(/[\\/]/).at(-1).toLowerCase();
  return missing.find((one) => one === name) ?? missing.find((one) => last(one) === name.toLowerCase()) ?? name;
}
