// A form sheet, such as Building: one line a value, with its help beside.

import { el } from "./elements.mjs";
import { hasChoices, isComputed, listChoices, problemText, showValue } from "./grid_cells.mjs";
import { t } from "./texts.mjs";
import { html, nothing, render } from "./vendor/lit-html.mjs";

const AT = 1;

export class Form {
  canEdit = true;
  #names = null; // the row whose choices are listed

  constructor(store) {
    this.store = store;
    this.node = el("form", { class: "grid-form", autocomplete: "off", on: { submit: (event) => event.preventDefault() } });
  }

  open(sheet) {
    const isSame = this.sheet && JSON.stringify(this.sheet.columns) === JSON.stringify(sheet.columns);
    this.sheet = sheet;
    if (!isSame) render(nothing, this.node); // of the same book read again what is being typed stays
    this.draw();
  }

  draw() {
    render(this.sheet.columns.filter((column) => !column.hidden).map((column) => this.#line(column)), this.node);
  }

  #line(column) {
    const { row, label, unit, help } = column;
    const id = `form-${row}`;
    const found = this.store.problemAt(this.sheet.name, row, AT);
    const isWrong = found?.severity === "error";
    const focused = () => {
      this.#names = row;
      this.draw();
      this.store.select({ sheet: this.sheet.name, row, at: AT }, "grid");
    };
    const names = this.#names === row ? listChoices(this.store, column).names : [];
    return html`<div class="form-line">
      <label for=${id}>${label}${unit ? html`<span class="grid-unit"> [${unit}]</span>` : nothing}</label>
      <div>
        <input type="text" id=${id} class=${isWrong ? "error" : ""} aria-describedby="${id}-help ${id}-problem" aria-invalid=${isWrong} spellcheck="false"
          list=${hasChoices(column) ? `${id}-names` : nothing} ?readonly=${!this.canEdit || isComputed(column)} .value=${this.#text(column)}
          @change=${({ target }) => this.#commit(column, target.value)} @focus=${focused} @keydown=${(event) => this.#key(event, column)}>
        ${hasChoices(column) ? html`<datalist id="${id}-names">${names.map((name) => html`<option value=${name}></option>`)}</datalist>` : nothing}
        <p class="form-problem ${found?.severity ?? ""}" id="${id}-problem" ?hidden=${!found}>${found ? problemText(found) : ""}</p>
      </div>
      <p class="form-help" id="${id}-help">${help}</p>
    </div>`;
  }

  #text(column) {
    return showValue(this.sheet.value(column.row, AT), column);
  }

  #commit(column, text) {
    if (text === this.#text(column)) return;
    this.store.edit([[this.sheet.name, column.row, AT, text === "" ? null : text]], t("typing"));
  }

  /** Enter goes on to the next line; undo reaches the workbook where nothing is typed in the field itself. */
  #key(event, column) {
    const { target: input, key, shiftKey } = event;
    const isControl = event.ctrlKey || event.metaKey;
    const isTyped = input.value !== this.#text(column);
    if (key === "Enter") {
      this.#commit(column, input.value);
      input.closest(".form-line").nextElementSibling?.querySelector("input").focus();
    } else if (key === "Escape" && isTyped) input.value = this.#text(column);
    else if (isControl && !isTyped && key.toLowerCase() === "z") shiftKey ? this.store.redo() : this.store.undo();
    else if (isControl && !isTyped && key.toLowerCase() === "y") this.store.redo();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Go to the line of a row. */
  goTo(row) {
    const input = this.node.querySelector(`#form-${row}`);
    input?.focus();
    input?.closest(".form-line").scrollIntoView({ block: "nearest" });
  }
}
