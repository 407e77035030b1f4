// Opens workbooks and takes files: chosen, or dropped anywhere on the page.

import { send } from "./api.mjs";
import { el } from "./elements.mjs";
import { addFiles } from "./files_view.mjs";
import { ask, notice } from "./messages.mjs";
import { t } from "./texts.mjs";

const WORKBOOK = /\.xls[xm]$/i;
const OLD = /\.(xls|ods|numbers|csv)$/i;

/** Have the browser's dialog choose a workbook, and open it. */
export function chooseWorkbook(store) {
  const input = el("input", { type: "file", accept: ".xlsx,.xlsm" });
  input.addEventListener("change", () => input.files[0] && openWorkbook(store, input.files[0]));
  input.click();
}

/** Open a workbook in place of the present one; asks first where changes would be lost. Returns whether it was opened. */
export async function openWorkbook(store, file) {
  if (!(await canLeave(store, file.name))) return false;
  try {
    store.replaceBook(await send(`/api/upload?name=${encodeURIComponent(file.name)}`, file));
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
    sign = el("div", { id: "dropping", "aria-hidden": "true", text: t("Drop a workbook, or files that it names") });
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
  if (!others.length) return;
  const old = others.find((file) => OLD.test(file.name) && !store.book?.missing?.some((one) => one.name === file.name));
  if (old && !book) {
    const text = t("{name} cannot be opened. Save it as an Excel workbook (.xlsx) first, in Excel or LibreOffice.", { name: old.name });
    notice(text, { kind: "error" });
    return;
  }
  if (!store.book) notice(t("Open a workbook first, then drop the files that it names."), { kind: "error" });
  else await addFiles(store, others);
}
