// The pieces on the plan: a rectangle each, with its class as colour and sign, its name, and the sides that are Breadth.

import { basisWords, chanceText, classStyle, describe, isPale } from "./classes.mjs";
import { svg as element } from "./elements.mjs";
import { boxOf, boxesMeet, corners, modulo, radians, turnPoint } from "./plan_geometry.mjs";
import { number, percent, t } from "./texts.mjs";
import { render, svg } from "./vendor/lit-html.mjs";

const LEAST_SIGN = 7; // font size [px]
const MOST_SIGN = 15;
const LETTER = 6.4; // width of a letter of a name [px]
const NAME_HEIGHT = 12;
const NAMED_FROM = 45; // pixels a metre from which names stand below pieces, too
const UNKNOWN_PX = 9; // of the question marks beyond the ends
const RAISED_UP_TO = 20; // selected pieces

const translate = (x, y) => `translate(${x.toFixed(4)} ${(-y).toFixed(4)})`;

export class PieceLayer {
  #nodes = new Map();
  #previews = new Map();
  #besides = new Set(); // rows of those whose names stand below them
  active = 0; // the piece that Tab reaches

  constructor(model, store) {
    Object.assign(this, { model, store, scale: 40, selected: new Set(), node: element("g", { class: "pieces" }) });
  }

  // ---- drawing

  draw() {
    const { model: { pieces, floor }, node } = this;
    for (const [row, one] of this.#nodes) {
      if (pieces.has(row)) continue;
      one.remove();
      this.#nodes.delete(row);
    }
    if (!pieces.has(this.active)) this.active = this.order()[0] ?? 0;
    this.#placeNames();
    for (const piece of pieces.values()) this.#drawPiece(piece);
    const named = { role: "listbox", "aria-multiselectable": "true", "aria-label": t("Pieces on floor {floor}", { floor }) };
    for (const [name, value] of Object.entries(named)) {
      if (pieces.size) node.setAttribute(name, value);
      else node.removeAttribute(name);
    }
  }

  #drawPiece(piece) {
    const { row, item, breadth: b, width: w, missing } = piece;
    const { x, y, angle } = this.pose(row);
    const { key, isAnchored, live } = this.classOf(piece);
    const [isSelected, label, fit] = [this.selected.has(row), this.label(piece), this.#fit(piece, angle)];
    if (!this.#nodes.has(row)) this.#nodes.set(row, this.node.appendChild(element("g", { role: "option", "data-row": row })));
    const node = this.#nodes.get(row);
    const style = key ? classStyle(live) : describe("").css;
    const classes = ["piece", style, isSelected && "selected", isAnchored && !key && "anchored", missing.length && "sizes-missing", missing.includes("width") && "width-missing"];
    const values = { class: classes.filter(Boolean).join(" "), transform: translate(x, y), tabindex: row === this.active ? "0" : "-1", "aria-selected": String(isSelected), "aria-label": label };
    for (const [name, value] of Object.entries(values)) if (node.getAttribute(name) !== value) node.setAttribute(name, value);
    const isNamed = fit.isInside || isSelected || this.#besides.has(row);
    render(svg`<title>${label}</title>
      <g transform="rotate(${-angle})"><rect class="body" x=${-b / 2} y=${-w / 2} width=${b} height=${w}></rect>
        <path class="sides" d="M${-b / 2} ${-w / 2}H${b / 2}M${-b / 2} ${w / 2}H${b / 2}"></path></g>${this.#unknownEnds(piece, angle)}
      <g class="px" .style="transform: scale(var(--u)) rotate(${-fit.turn}deg)">
        <text class="sign" .style="font-size: ${fit.size.toFixed(1)}px" x=${-fit.shift}>${key ? describe(key).sign : isAnchored ? "⚓" : "–"}</text>
        <text class=${fit.isInside ? "name" : "name beside"} .style=${isNamed ? "" : "display: none"} x=${fit.isInside ? fit.size / 2 + 1 : 0} y=${fit.y}>${item}</text></g>`, node);
  }

  /** Question marks where it is not known how far a piece reaches. */
  #unknownEnds({ breadth: b, width: w, missing }, angle) {
    const ends = [...(missing.includes("width") ? [[0, w / 2], [0, -w / 2]] : []), ...(missing.includes("breadth") ? [[b / 2, 0], [-b / 2, 0]] : [])];
    return ends.map((end) => {
      const [x, y] = turnPoint(end, angle);
      const k = UNKNOWN_PX / Math.hypot(x, y);
      return svg`<g transform=${translate(x, y)}><text class="px unknown" x=${x * k} y=${-y * k}>?</text></g>`;
    });
  }

  /** Sign and name as large as the piece allows; the name along its longer side, upright or read from the right, else below it. */
  #fit({ item, breadth, width }, angle) {
    const [b, w] = [breadth * this.scale, width * this.scale];
    const short = Math.min(b, w);
    const size = Math.min(MOST_SIGN, Math.max(LEAST_SIGN, 0.85 * short));
    const letters = item.length * LETTER;
    if (short >= NAME_HEIGHT && Math.max(b, w) - size - 6 >= letters) {
      const along = modulo(angle + (w >= b ? 90 : 0), 180);
      return { isInside: true, size, turn: along > 90 ? along - 180 : along, shift: letters / 2 + 2, y: 0 };
    }
    const a = radians(angle);
    const reach = (Math.abs(b * Math.sin(a)) + Math.abs(w * Math.cos(a))) / 2; // half its height on the screen
    return { isInside: false, size, turn: 0, shift: 0, y: Math.max(10, reach) + 10 };
  }

  /** Zoomed in, names stand below pieces that have no room for them, where they cover neither a piece nor a name. */
  #placeNames() {
    this.#besides.clear();
    if (this.scale < NAMED_FROM) return;
    const [k, pieces] = [this.scale, [...this.model.pieces.values()]];
    const taken = pieces.map((one) => boxOf(corners(one).map(([x, y]) => [x * k, -y * k])));
    for (const piece of pieces) {
      const fit = this.#fit(piece, piece.angle);
      if (fit.isInside || this.selected.has(piece.row)) continue;
      const [x, y, half] = [piece.x * k, -piece.y * k + fit.y, (piece.item.length * LETTER) / 2];
      const own = [x - half, y - NAME_HEIGHT / 2, x + half, y + NAME_HEIGHT / 2];
      if (taken.some((one) => boxesMeet(own, one))) continue;
      taken.push(own);
      this.#besides.add(piece.row);
    }
  }

  zoom(scale) {
    this.scale = scale;
    this.draw();
  }

  // ---- while dragged

  /** Show pieces elsewhere than they stand: [{row, x, y, angle}]. */
  preview(poses) {
    this.#previews = new Map(poses.map((one) => [one.row, one]));
    for (const { row } of poses) if (this.model.pieces.has(row)) this.#drawPiece(this.model.pieces.get(row));
  }

  endPreview() {
    const rows = [...this.#previews.keys()];
    this.#previews.clear();
    for (const row of rows) if (this.model.pieces.has(row)) this.#drawPiece(this.model.pieces.get(row));
  }

  /** Where a piece is shown. */
  pose(row) {
    const piece = this.model.pieces.get(row);
    const { x, y, angle } = this.#previews.get(row) ?? piece ?? {};
    return piece && { ...piece, x, y, angle };
  }

  // ---- classes and words

  /** The class of a piece and the text beside it in lists: its chance, or why it has no class. */
  classOf({ row, anchored = this.model.anchored(row) }) {
    const live = this.store.live.get(row);
    const { class: key = "", chance = null, word = "" } = live ?? {};
    const isAnchored = anchored === "yes";
    const none = isAnchored ? `⚓ ${chance === null ? word : t("{chance} if the anchor fails", { chance: percent(chance) })}` : word;
    return { key, chance, isAnchored, word, live, text: key ? chanceText(live) || (isPale(live) ? "≈" : "") : none };
  }

  /** What is said of a piece: name, what it is, class, position. */
  label({ row, item, description, anchored, missing, x, y, angle }) {
    const { key, word, live } = this.classOf({ row, anchored });
    const chance = chanceText(live);
    const sheet = this.store.sheet("Items");
    const { model } = this;
    return [
      description ? `${item}, ${description}` : item, key ? t("class {word}", { word: describe(key).word }) : word || describe("").word,
      ...(chance ? [t("chance {chance}", { chance })] : []), ...basisWords(live).map(([said]) => said),
      ...missing.map((name) => t("{size} is not known", { size: sheet.column(name)?.label ?? name })),
      t("X {x}, Y {y}, angle {angle}°", { x: model.shownLength(x), y: model.shownLength(y), angle: number(angle) }),
    ].join("; ");
  }

  // ---- keyboard

  /** The rows of pieces in the order of reading: from above, from the left. */
  order() {
    return [...this.model.pieces.values()].sort((a, b) => Math.round(b.y - a.y) || a.x - b.x).map((one) => one.row);
  }

  activate(row) {
    this.active = row;
    for (const [one, node] of this.#nodes) node.setAttribute("tabindex", one === row ? "0" : "-1");
  }

  focus(row = this.active) {
    this.activate(row);
    this.#nodes.get(row)?.focus({ preventScroll: true });
  }

  /** Selected pieces lie on top; focus survives, as the nodes that are moved past stay where they are. */
  select(rows) {
    this.selected = new Set(rows);
    if (this.model.pieces.has(rows[0])) this.active = rows[0];
    this.draw();
    if (rows.length > RAISED_UP_TO) return;
    const nodes = rows.map((row) => this.#nodes.get(row)).filter((node) => node && !node.contains(document.activeElement));
    for (const node of nodes) if (node !== this.node.lastChild) this.node.append(node);
  }
}
