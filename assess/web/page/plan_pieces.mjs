// The pieces on the plan: a rectangle each, with its class as colour and sign, its name, and the sides that are Breadth.

import { basisWords, chanceText, classStyle, describe, isPale } from "./classes.mjs";
import { svg } from "./elements.mjs";
import { boxOf, corners, turnPoint } from "./plan_geometry.mjs";
import { number, percent, t } from "./texts.mjs";

const LEAST_SIGN = 7; // font size [px]
const MOST_SIGN = 15;
const LETTER = 6.4; // width of a letter of a name [px]
const NAME_HEIGHT = 12;
const NAMED_FROM = 45; // pixels a metre from which names stand below pieces, too
const UNKNOWN_PX = 9; // of the question marks beyond the ends

/** Lengths in metres as the page shows them, in the unit of the workbook. */
export function shownLength(metres, { unit, factor }, digits = 2) {
  return `${number(metres / factor, digits)} ${unit}`;
}

export class PieceLayer {
  #nodes = new Map();
  #previews = new Map();
  active = 0; // the piece that Tab reaches

  constructor(model, store) {
    Object.assign(this, { model, store, scale: 40, selected: new Set() });
    this.node = svg("g", { class: "pieces" });
  }

  // ---- drawing

  draw() {
    const { pieces } = this.model;
    for (const [row, parts] of this.#nodes) {
      if (pieces.has(row)) continue;
      parts.node.remove();
      this.#nodes.delete(row);
    }
    for (const piece of pieces.values()) {
      const parts = this.#nodes.get(piece.row) ?? this.#make(piece.row);
      this.#update(parts, piece);
    }
    this.#nameBeside();
    this.#setRole(pieces.size > 0);
    if (!pieces.has(this.active)) this.active = this.order()[0] ?? 0;
    this.#setTabStops();
  }

  #setRole(hasAny) {
    const { node } = this;
    if (!hasAny) for (const name of ["role", "aria-multiselectable", "aria-label"]) node.removeAttribute(name);
    else {
      node.setAttribute("role", "listbox");
      node.setAttribute("aria-multiselectable", "true");
      node.setAttribute("aria-label", t("Pieces on floor {floor}", { floor: this.model.floor }));
    }
  }

  #make(row) {
    const parts = { title: svg("title"), body: svg("rect", { class: "body" }), sides: svg("path", { class: "sides" }), sign: svg("text", { class: "sign" }), name: svg("text", { class: "name" }) };
    parts.turned = svg("g", null, parts.body, parts.sides);
    parts.unknown = svg("g", { class: "unknown-ends" });
    parts.px = svg("g", { class: "px" }, parts.sign, parts.name);
    parts.node = svg("g", { class: "piece", role: "option", "data-row": row, tabindex: "-1" }, parts.title, parts.turned, parts.unknown, parts.px);
    this.#nodes.set(row, parts);
    this.node.append(parts.node);
    return parts;
  }

  #update(parts, piece) {
    const { breadth: b, width: w } = piece;
    const shown = this.classOf(piece);
    const isSelected = this.selected.has(piece.row);
    const pose = this.#previews.get(piece.row) ?? piece;
    const label = this.label(piece);
    const mark = [label, b, w, piece.missing, isSelected, classStyle(shown.live), shown.isAnchored, pose.x, pose.y, pose.angle, this.scale].join("|");
    if (parts.mark === mark) return;
    parts.mark = mark;
    const set = (node, values) => Object.entries(values).forEach(([name, value]) => node.setAttribute(name, value));
    set(parts.body, { x: -b / 2, y: -w / 2, width: b, height: w });
    set(parts.sides, { d: `M${-b / 2} ${-w / 2}H${b / 2}M${-b / 2} ${w / 2}H${b / 2}` });
    const { key, isAnchored } = shown;
    const classes = ["piece", key ? classStyle(shown.live) : describe("").css, isSelected && "selected", isAnchored && !key && "anchored", piece.missing.length && "sizes-missing", piece.missing.includes("width") && "width-missing"];
    set(parts.node, { class: classes.filter(Boolean).join(" "), "aria-selected": String(isSelected), "aria-label": label });
    parts.title.textContent = label;
    parts.sign.textContent = this.#sign(key, isAnchored);
    parts.name.textContent = piece.item;
    this.#put(parts, pose);
    this.#markEnds(parts, piece, pose.angle);
    this.#fitText(parts, piece);
  }

  /** Question marks where it is not known how far a piece reaches. */
  #markEnds(parts, { breadth: b, width: w, missing }, angle) {
    const ends = [...(missing.includes("width") ? [[0, w / 2], [0, -w / 2]] : []), ...(missing.includes("breadth") ? [[b / 2, 0], [-b / 2, 0]] : [])];
    parts.unknown.replaceChildren(...ends.map((end) => {
      const [x, y] = turnPoint(end, angle);
      const k = UNKNOWN_PX / Math.hypot(x, y);
      return svg("g", { transform: `translate(${x.toFixed(4)} ${(-y).toFixed(4)})` }, svg("text", { class: "px unknown", x: x * k, y: -y * k, text: "?" }));
    }));
  }

  #sign(key, isAnchored) {
    if (key) return describe(key).sign;
    return isAnchored ? "⚓" : "–";
  }

  #put(parts, { x, y, angle }) {
    if (parts.pose === `${x} ${y} ${angle}`) return;
    parts.pose = `${x} ${y} ${angle}`;
    parts.node.setAttribute("transform", `translate(${x.toFixed(4)} ${(-y).toFixed(4)})`);
    parts.turned.setAttribute("transform", `rotate(${-angle})`);
    parts.angle = angle;
  }

  /** Sign and name as large as the piece allows; the name along its longer side, upright or read from the right. */
  #fitText(parts, piece) {
    const [b, w] = [piece.breadth * this.scale, piece.width * this.scale];
    const [long, short] = [Math.max(b, w), Math.min(b, w)];
    const size = Math.min(MOST_SIGN, Math.max(LEAST_SIGN, 0.85 * short));
    const room = long - size - 6;
    const isNamed = short >= NAME_HEIGHT && room >= piece.item.length * LETTER;
    const along = (((parts.angle + (w >= b ? 90 : 0)) % 180) + 180) % 180;
    const shown = isNamed ? (along > 90 ? along - 180 : along) : 0;
    parts.px.style.transform = `scale(var(--u)) rotate(${-shown}deg)`;
    parts.sign.style.fontSize = `${size.toFixed(1)}px`;
    parts.isNamed = isNamed || this.selected.has(piece.row);
    parts.name.style.display = parts.isNamed ? "" : "none";
    const shift = isNamed ? (piece.item.length * LETTER) / 2 + 2 : 0;
    parts.sign.setAttribute("x", -shift);
    parts.name.setAttribute("x", isNamed ? size / 2 + 1 : 0);
    parts.name.setAttribute("y", isNamed ? 0 : Math.max(10, this.#reach(piece, parts.angle)) + 10);
    parts.name.classList.toggle("beside", !isNamed);
  }

  /** Zoomed in, names stand below pieces that have no room for them, where they cover neither a piece nor a name. */
  #nameBeside() {
    if (this.scale < NAMED_FROM) return;
    const [k, pieces] = [this.scale, [...this.model.pieces.values()]];
    const taken = pieces.map((one) => boxOf(corners(one).map(([x, y]) => [x * k, -y * k])));
    for (const piece of pieces) {
      const parts = this.#nodes.get(piece.row);
      if (!parts || parts.isNamed) continue;
      const [x, y, half] = [piece.x * k, -piece.y * k + Number(parts.name.getAttribute("y")), (piece.item.length * LETTER) / 2];
      const own = [x - half, y - NAME_HEIGHT / 2, x + half, y + NAME_HEIGHT / 2];
      if (taken.some((one) => own[0] < one[2] && one[0] < own[2] && own[1] < one[3] && one[1] < own[3])) continue;
      taken.push(own);
      parts.name.style.display = "";
    }
  }

  /** Half the height of a piece on the screen. */
  #reach({ breadth, width }, angle) {
    const a = (angle * Math.PI) / 180;
    return ((Math.abs(breadth * Math.sin(a)) + Math.abs(width * Math.cos(a))) / 2) * this.scale;
  }

  zoom(scale) {
    this.scale = scale;
    for (const [row, parts] of this.#nodes) {
      const piece = this.model.pieces.get(row);
      if (piece) this.#fitText(parts, piece);
    }
    this.#nameBeside();
  }

  // ---- while dragged

  /** Show pieces elsewhere than they stand: Map of rows to {x, y, angle}. */
  preview(poses) {
    this.#previews = poses;
    for (const [row, pose] of poses) {
      const parts = this.#nodes.get(row);
      if (parts) parts.mark = "";
      if (parts) this.#put(parts, pose);
      if (parts && pose.angle !== undefined) this.#markEnds(parts, this.model.pieces.get(row), pose.angle);
      if (parts) this.#fitText(parts, this.model.pieces.get(row));
    }
  }

  endPreview() {
    const rows = [...this.#previews.keys()];
    this.#previews = new Map();
    for (const row of rows) {
      const [parts, piece] = [this.#nodes.get(row), this.model.pieces.get(row)];
      if (parts && piece) this.#update(parts, piece);
    }
  }

  /** Where a piece is shown. */
  pose(row) {
    const piece = this.model.pieces.get(row);
    return piece && { ...piece, ...this.#previews.get(row) };
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
  label(piece) {
    const { key, word, live } = this.classOf(piece);
    const unit = this.model.unit;
    const parts = [[piece.item, piece.description].filter(Boolean).join(", "), key ? t("class {word}", { word: describe(key).word }) : word || describe("").word];
    if (chanceText(live)) parts.push(t("chance {chance}", { chance: chanceText(live) }));
    for (const [said] of basisWords(live)) parts.push(said);
    const sheet = this.store.sheet("Items");
    for (const name of piece.missing) parts.push(t("{size} is not known", { size: sheet.column(name)?.label ?? name }));
    parts.push(t("X {x}, Y {y}, angle {angle}°", { x: shownLength(piece.x, unit), y: shownLength(piece.y, unit), angle: number(piece.angle) }));
    return parts.join("; ");
  }

  // ---- keyboard

  /** The rows of pieces in the order of reading: from above, from the left. */
  order() {
    return [...this.model.pieces.values()].sort((a, b) => Math.round(b.y - a.y) || a.x - b.x).map((one) => one.row);
  }

  #setTabStops() {
    for (const [row, parts] of this.#nodes) parts.node.setAttribute("tabindex", row === this.active ? "0" : "-1");
  }

  activate(row) {
    this.active = row;
    this.#setTabStops();
  }

  focus(row = this.active) {
    this.activate(row);
    this.#nodes.get(row)?.node.focus({ preventScroll: true });
  }

  select(rows) {
    const changed = [...new Set([...this.selected, ...rows])];
    this.selected = new Set(rows);
    for (const row of changed) {
      const [parts, piece] = [this.#nodes.get(row), this.model.pieces.get(row)];
      if (parts && piece) this.#update(parts, piece);
    }
    this.#nameBeside();
    if (rows.length && this.model.pieces.has(rows[0])) this.activate(rows[0]);
    this.#raise(rows);
  }

  /** Selected pieces lie on top; focus survives, as the nodes that are moved past stay where they are. */
  #raise(rows) {
    if (rows.length > 20) return;
    for (const row of rows) {
      const node = this.#nodes.get(row)?.node;
      if (!node || node.contains(document.activeElement) || node === this.node.lastChild) continue;
      this.node.append(node);
    }
  }
}
