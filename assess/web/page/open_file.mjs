// Opens workbooks, has building models read, and takes files: chosen, or dropped anywhere on the page. Lists those that the
// workbook names and that are missing: what each is for, and where to drop it.

import { send } from "./api.mjs";
import { el } from "./elements.mjs";
import { imports } from "./job.mjs";
import { ask, notice } from "./messages.mjs";
import { cellName } from "./sheet.mjs";
import { t, tn } from "./texts.mjs";
import { html, render } from "./vendor/lit-html.mjs";
import { whenSent } from "./watch.mjs";

const NAMED = 3;
const USES = {
  record: () => t("record of a motion: how the floor shook"),
  plan: () => t("plan of a floor, the picture under the furniture"),
  photo: () => t("photo of a piece, for the report"),
  logo: () => t("logo, for the cover of the report"),
  hazard: () => t("hazard curve or ShakeMap: how strong the ground shakes"),
};
const WORKBOOK = /\.xls[xm]$/i;
const OLD = /\.(xls|ods|numbers|csv)$/i;
const MODEL = /\.(ifc|ifczip|ifcxml|json|sh3d)$/i;

/** Have the browser's dialog choose a workbook or a building model, and open or read it. */
export function chooseFile(store) {
  const input = el("input", { type: "file", accept: ".xlsx,.xlsm,.ifc,.json,.sh3d" });
  const open = (file) => (WORKBOOK.test(file.name) ? openWorkbook(store, file) : readModel(store, file));
  input.addEventListener("change", () => input.files[0] && open(input.files[0]));
  input.click();
}

/** Have a building model be read into a new workbook; asks first where a workbook is open and the choice of routes is not seen. */
async function readModel(store, file) {
  const { name } = file;
  if (store.book && location.hash !== "#start") {
    const question = t("{name} is read into a new workbook. {old} stays as it is.", { name, old: store.book.name });
    const answer = await ask(question, [[t("Read it"), "none"], [t("Read it, and draft evacuation routes"), "draft"], [t("Cancel"), null]]);
    if (answer === null) return;
    imports.drafts = answer === "draft";
    location.hash = "#start";
  }
  await imports.begin(file);
}

/** Open a workbook in place of the present one; asks first where changes would be lost. Returns whether it was opened. */
async function openWorkbook(store, file) {
  if (!(await canLeave(store, file.name))) return false;
  try {
    const answer = await send(`/api/upload?name=${encodeURIComponent(file.name)}`, file);
    if (answer.import) { // a COBie file, which is no inventory yet
      location.hash = "#start";
      imports.followBegun(answer);
      return false;
    }
    store.replaceBook(answer);
  } catch (error) {
    const line = (one) => [one.cell, one.message, one.fix].filter(Boolean).join(" ");
    const problems = (error.body?.problems ?? []).slice(0, 5).map(line);
    const why = error.message || t("The server does not answer.");
    const more = problems.filter((one) => !why.includes(one));
    notice([t("{name} was not opened: {why}", { name: file.name, why }), ...more].join("\n"), { kind: "error" });
    return false;
  }
  if (location.hash === "#start") location.hash = "#sheet";
  notice(t("{name} is open as a copy: download it when you are done. The file that you chose stays as it is.", { name: file.name }));
  return true;
}

/** Ask before the present workbook is left; true where it may be. */
export async function canLeave(store, name) {
  const { book, state, waiting } = store;
  if (!book || !(waiting || (state.unsaved && (book.mode === "held" || state.save_error || state.changed_outside)))) return true;
  const question = t("Open {name} in place of {old}? Changes of {old} that were not downloaded are lost.", { name, old: book.name });
  return (await ask(question, [[t("Cancel"), false], [t("Open {name}", { name }), true]])) === true;
}

/** Take files that are dropped anywhere on the page: a workbook is opened, others are those that it names. */
export function acceptDrops(store) {
  let sign = null;
  const hasFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  const end = () => (sign?.remove(), (sign = null));
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    if (sign) return;
    sign = el("div", { id: "dropping", "aria-hidden": "true", text: t("Drop a workbook, a building model, or files that the workbook names") });
    (document.querySelector("dialog[open]") ?? document.body).append(sign);
  });
  addEventListener("dragleave", (event) => event.relatedTarget === null && end());
  addEventListener("drop", (event) => {
    end();
    if (!hasFiles(event) || event.defaultPrevented) return;
    event.preventDefault();
    take(store, [...event.dataTransfer.files]);
  });
}

async function take(store, files) {
  const book = files.find((file) => WORKBOOK.test(file.name));
  const others = files.filter((file) => file !== book);
  if (book && !(await openWorkbook(store, book))) return null;
  const model = others.find((file) => MODEL.test(file.name) && !isMissing(store, file.name));
  if (model && !book) {
    if (others.length > 1) notice(t("One building model is read at a time: {name}. The other files were not taken.", { name: model.name }));
    return readModel(store, model);
  }
  if (!others.length) return null;
  const old = others.find((file) => OLD.test(file.name) && !isMissing(store, file.name));
  const say = (text) => notice(text, { kind: "error" });
  if (old && !book) return say(t("{name} cannot be opened. Save it as an Excel workbook (.xlsx) first, in Excel or LibreOffice.", { name: old.name }));
  return store.book ? addFiles(store, others) : say(t("Open a workbook first, then drop the files that it names."));
}

/** Whether the workbook names a file that it lacks. */
const isMissing = (store, name) => Boolean(store.book?.missing?.some((one) => one.name === name));

// ---- files that are missing

let dialog = null;

/** Show the list of missing files. */
export function showFiles(store) {
  dialog?.remove();
  dialog = el("dialog", { class: "files", "aria-labelledby": "files-title" });
  const update = () => render(missingFiles(store), dialog);
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

function missingFiles(store) {
  const missing = store.book?.missing ?? [];
  const row = ({ name, kind, cells }) => html`<tr><th scope="row">${name}</th><td>${USES[kind]?.() ?? kind}</td>
    <td>${cells.slice(0, NAMED).map((cell) => cellLink(store, cell))}${cells.length > NAMED ? ` ${tn("and {n} more", "and {n} more", cells.length - NAMED)}` : ""}</td></tr>`;
  const take = ({ target }) => {
    addFiles(store, [...target.files]);
    target.value = ""; // the same one may be chosen again
  };
  const list = () => html`<p>${t("These files were not found next to the workbook. Without them the floors, pictures or records that they hold are left out.")}</p>
    <div class="scroll-x"><table class="plain">
      <thead><tr>${[t("File"), t("What it is for"), t("Named in")].map((text) => html`<th scope="col">${text}</th>`)}</tr></thead>
      <tbody>${missing.map(row)}</tbody></table></div>
    <div class="drop"><p>${t("Drop the files here, or anywhere on the page. Each is found by its name.")}</p>
      <button type="button" class="primary" @click=${() => dialog.querySelector("input").click()}>${t("Choose files…")}</button>
      <input type="file" multiple class="unseen" tabindex="-1" aria-label=${t("Choose files")} @change=${take}></div>`;
  return html`<h2 id="files-title">${t("Files that the workbook names")}</h2>
    ${missing.length ? list() : html`<p>${t("Nothing is missing.")}</p>`}
    <div class="buttons"><button type="button" @click=${() => dialog.close()}>${t("Close")}</button></div>`;
}

/** A cell that names a file, which leads to its place in the sheet. */
function cellLink(store, cell) {
  const [sheet, row, at] = cell;
  const go = () => (dialog.close(), (location.hash = "#sheet"), store.reveal(cell));
  return html`<button type="button" class="quiet" @click=${go}>${cellName(store.sheet(sheet), row, at)}</button>`;
}

/** Send files that the workbook names; says which were taken and why others were not. */
async function addFiles(store, files) {
  const taken = [];
  const last = (path) => path.split(/[\\/]/).at(-1).toLowerCase();
  await whenSent(store); // the answer is the whole book, with all that was edited
  for (const file of files) {
    try {
      const { name } = file; // or as the workbook writes it: with its folder, its case
      const missing = (store.book?.missing ?? []).map((one) => one.name);
      const wanted = missing.find((one) => one === name) ?? missing.find((one) => last(one) === name.toLowerCase()) ?? name;
      store.replaceBook(await send(`/api/file?name=${encodeURIComponent(wanted)}`, file));
      taken.push(wanted);
    } catch (error) {
      const why = error.message || t("The server does not answer.");
      notice(t("{name} was not taken: {why}", { name: file.name, why }), { kind: "error" });
    }
  }
  if (taken.length) notice(tn("{names} is now used.", "{n} files are now used: {names}.", taken.length, { names: taken.join(", ") }));
}
