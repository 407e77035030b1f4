// The list below a cell: the names that it may take, fewer with each letter that is typed.

import { clear, el } from "./elements.mjs";
import { t, tn } from "./texts.mjs";

const MOST = 200;
const HEIGHT = 232;

const plain = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

/** The names that contain all words of a text, those first that begin with it. */
export function filterNames(names, text) {
  const part = plain(text.trim());
  const words = part.split(/\s+/);
  const has = names.filter((name) => words.every((word) => plain(name).includes(word)));
  const begins = (name) => plain(name).startsWith(part);
  return [...has.filter(begins), ...has.filter((name) => !begins(name))];
}

/** The name that is meant without choosing: of a closed list the first that begins so, else one that is the only one. */
export function guessName(names, text, isClosed) {
  const part = plain(text.trim());
  if (!part) return null;
  const starting = names.filter((name) => plain(name).startsWith(part));
  const exact = starting.find((name) => plain(name) === part);
  if (exact !== undefined) return exact;
  if (isClosed) return starting[0] ?? null;
  return starting.length === 1 && part.length > 1 && !/^\d+$/.test(part) ? starting[0] : null;
}

export class ChoiceList {
  constructor(box, input, take, say) {
    Object.assign(this, { box, input, take, say });
    this.node = el("div", { class: "grid-choices", role: "listbox", id: "grid-choices", tabindex: "0", hidden: true, "aria-label": t("Choices") });
    this.node.addEventListener("pointerdown", (event) => {
      event.preventDefault(); // the field keeps the focus
      const option = event.target.closest("[role=option]");
      if (option) take(option.dataset.name);
    });
    box.append(this.node);
  }

  get isOpen() {
    return !this.node.hidden;
  }

  /** @param {{names: string[], isClosed: boolean}} choices  @param {string} text what is typed so far */
  open(choices, text, current) {
    this.choices = choices;
    this.filter(text, current);
  }

  filter(text, current) {
    const { names, isClosed } = this.choices;
    this.names = filterNames(names, text);
    this.marked = this.names.indexOf(current ?? guessName(names, text, isClosed));
    this.isGuess = current === undefined;
    this.node.hidden = this.names.length === 0;
    if (this.node.hidden) return this.close();
    const shown = this.names.slice(0, MOST).map((name, i) => el("div", { class: "grid-choice", role: "option", id: `grid-choice-${i}`, dataset: { name }, text: name }));
    clear(this.node).append(...shown);
    if (this.names.length > MOST) this.node.append(el("div", { class: "grid-choice more", role: "presentation", text: t("{n} more: type to find them", { n: this.names.length - MOST }) }));
    this.#mark();
    this.input.setAttribute("aria-controls", "grid-choices");
    this.say(tn("{n} choice", "{n} choices", this.names.length));
    return null;
  }

  /** Stand below the cell, or above it where there is no room below. */
  place({ left, top, width, height }) {
    const below = this.box.scrollTop + this.box.clientHeight - top - height;
    const space = Math.min(HEIGHT, this.node.scrollHeight + 2);
    const y = below < space && top - this.box.scrollTop > space ? top - space : top + height;
    this.node.style.minWidth = `${width}px`;
    this.node.style.transform = `translate(${left}px, ${y}px)`;
  }

  move(step) {
    const count = Math.min(this.names.length, MOST);
    const stays = this.isGuess && step > 0 && this.marked === 0; // the first one down takes what was only guessed
    this.isGuess = false;
    if (stays) return;
    this.marked = this.marked < 0 ? (step > 0 ? 0 : count - 1) : (this.marked + step + count) % count;
    this.#mark();
  }

  #mark() {
    [...this.node.children].forEach((node, i) => node.setAttribute("aria-selected", i === this.marked));
    const node = this.node.children[this.marked];
    if (node) {
      node.scrollIntoView({ block: "nearest" });
      this.input.setAttribute("aria-activedescendant", node.id);
    } else this.input.removeAttribute("aria-activedescendant");
  }

  /** The marked name, null where none is. */
  get chosen() {
    return this.isOpen ? (this.names[this.marked] ?? null) : null;
  }

  close() {
    this.node.hidden = true;
    this.input.setAttribute("aria-controls", "grid");
  }
}
