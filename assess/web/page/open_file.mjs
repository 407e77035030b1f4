// Opens workbooks, has building models read, and takes files: chosen, or dropped anywhere on the page.

import { send } from "./api.mjs";
import { el } from "./elements.mjs";
import { addFiles } from "./files_view.mjs";
import { imports } from "./import_job.mjs";
import { ask, notice } from "./messages.mjs";
import { t } from "./texts.mjs";

const WORKBOOK = /\.xls[xm]$/i;
const OLD = /\.(xls|ods|numbers|csv)$/i;

const MODEL = /\.(ifc|ifczip|ifcxml|json|sh3d)$/i;

/** Have the browser's dialog choose a workbook or a building model, and open or read it. */
export const chooseFile = (store) =>
  choose(".xlsx,.xlsm,.ifc,.json,.sh3d", (file) => (WORKBOOK.test(file.name) ? openWorkbook(store, file) : readModel(store, file)));

function choose(accept, take) {
  const input = el("input", { type: "file", accept });
  input.addEventListener("change", () => input.files[0] && take(input.files[0]));
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
export async function openWorkbook(store, file) {
  if (!(await canLeave(store, file.name))) return false;
  try {
    const answer = await send(`/api/upload?name=${encodeURIComponent(file.name)}`, file);
    if (answer.import) { // a COBie file, which is no inventory yet
      location.hash = "#start";
      imports.follow(answer);
      return false;
    }
    store.replaceBook(answer);
  } catch (error) {
    explain(error, file.name);
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

/** Say why a file cannot be used, with the problems that the server names. */
export function explain(error, name) {
  const problems = (error.body?.problems ?? []).slice(0, 5).map((one) => [one.cell, one.message, one.fix].filter(Boolean).join(" "));
  const why = error.message || t("The server does not answer.");
  const text = [t("{name} was not opened: {why}", { name, why }), ...problems.filter((one) => !why.includes(one))].join("\n");
  notice(text, { kind: "error" });
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
  if (book && !(await openWorkbook(store, book))) return;
  const model = others.find((file) => MODEL.test(file.name) && !isMissing(store, file.name));
  if (model && !book) {
    if (others.length > 1) notice(t("One building model is read at a time: {name}. The other files were not taken.", { name: model.name }));
    await readModel(store, model);
    return;
  }
  if (!others.length) return;
  const old = others.find((file) => OLD.test(file.name) && !isMissing(store, file.name));
  if (old && !book) {
    const text = t("{name} cannot be opened. Save it as an Excel workbook (.xlsx) first, in Excel or LibreOffice.", { name: old.name });
    notice(text, { kind: "error" });
    return;
  }
  if (!store.book) notice(t("Open a workbook first, then drop the files that it names."), { kind: "error" });
  else await addFiles(store, others);
}

/** Whether the workbook names a file that it lacks. */
const isMissing = (store, name) => Boolean(store.book?.missing?.some((one) => one.name === name));
