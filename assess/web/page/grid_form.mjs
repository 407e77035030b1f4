// A form sheet, such as Building: one line a value, with its help beside.

import { clear, el } from "./elements.mjs";
import { hasChoices, isComputed, listChoices, problemText, showValue } from "./grid_cells.mjs";
import { t } from "./texts.mjs";

const AT = 1;

export class Form {
  canEdit = true;

  constructor(store) {
    this.store = store;
    this.node = el("form", { class: "grid-form", autocomplete: "off", on: { submit: (event) => event.preventDefault() } });
    this.lines = [];
  }

  open(sheet) {
    const isSame = this.sheet && JSON.stringify(this.sheet.columns) === JSON.stringify(sheet.columns);
    this.sheet = sheet;
    if (isSame) return this.draw(); // the same book read again: what is being typed stays
    this.lines = sheet.columns.filter((column) => !column.hidden).map((column) => this.#line(column));
    clear(this.node).append(...this.lines.map((line) => line.node));
    return this.draw();
  }

  #line(column) {
    const { row } = column;
    const id = `form-${row}`;
    const input = el("input", { type: "text", id, "aria-describedby": `${id}-help ${id}-problem`, spellcheck: false });
    const names = hasChoices(column) ? el("datalist", { id: `${id}-names` }) : null;
    if (names) input.setAttribute("list", names.id);
    const label = el("label", { for: id }, column.label, column.unit ? el("span", { class: "grid-unit", text: ` [${column.unit}]` }) : null);
    const problem = el("p", { class: "form-problem", id: `${id}-problem`, hidden: true });
    const help = el("p", { class: "form-help", id: `${id}-help`, text: column.help });
    const node = el("div", { class: "form-line" }, label, el("div", null, input, names, problem), help);
    const line = { column, row, input, names, problem, node };
    input.addEventListener("change", () => this.#commit(line));
    input.addEventListener("focus", () => this.#focused(line));
    input.addEventListener("keydown", (event) => this.#key(event, line));
    return line;
  }

  #text({ column, row }) {
    return showValue(this.sheet.value(row, AT), column);
  }

  #focused(line) {
    if (line.names) clear(line.names).append(...listChoices(this.store, line.column).names.map((name) => el("option", { value: name })));
    this.store.select({ sheet: this.sheet.name, row: line.row, at: AT }, "grid");
  }

  #commit(line) {
    const text = line.input.value;
    if (text === this.#text(line)) return;
    this.store.edit([[this.sheet.name, line.row, AT, text === "" ? null : text]], t("typing"));
  }

  /** Enter goes on to the next line; undo reaches the workbook where nothing is typed in the field itself. */
  #key(event, line) {
    const isControl = event.ctrlKey || event.metaKey;
    const isTyped = line.input.value !== this.#text(line);
    if (event.key === "Enter") {
      this.#commit(line);
      this.lines[this.lines.indexOf(line) + 1]?.input.focus();
    } else if (event.key === "Escape" && isTyped) line.input.value = this.#text(line);
    else if (isControl && !isTyped && event.key.toLowerCase() === "z") event.shiftKey ? this.store.redo() : this.store.undo();
    else if (isControl && !isTyped && event.key.toLowerCase() === "y") this.store.redo();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  draw() {
    for (const line of this.lines) {
      const { input, problem } = line;
      const text = this.#text(line);
      if (line.shown !== text) {
        line.shown = text;
        input.value = text;
      }
      input.readOnly = !this.canEdit || isComputed(line.column);
      const found = this.store.problemAt(this.sheet.name, line.row, AT);
      problem.hidden = !found;
      problem.textContent = found ? problemText(found) : "";
      problem.className = `form-problem ${found?.severity ?? ""}`;
      input.classList.toggle("error", found?.severity === "error");
      input.setAttribute("aria-invalid", String(found?.severity === "error"));
    }
  }

  /** Go to the line of a row. */
  goTo(row) {
    const line = this.lines.find((one) => one.row === row);
    if (!line) return;
    line.input.focus();
    line.node.scrollIntoView({ block: "nearest" });
  }
}
