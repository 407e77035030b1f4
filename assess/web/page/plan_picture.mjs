// The picture under the plan: add one, place it by two clicks and a distance, move and turn it, how strong it shows.

import { send } from "./api.mjs";
import { clear, el } from "./elements.mjs";
import { direction, distance, fromPicture, onPicture, placePicture, readNumber, roundTo, turnPoint } from "./plan_geometry.mjs";
import { notice } from "./messages.mjs";
import { number, t } from "./texts.mjs";
import { whenSent } from "./watch.mjs";

const PICTURES = ".png,.jpg,.jpeg,.svg,.dxf";
const KEPT = "assess-picture-opacity";

/** Two clicks on the picture, then the panel asks for the distance. */
export class PlacingTool {
  name = "placing";
  takesTouch = true;
  points = []; // in shares of the picture
  known = null;
  wantsKnown = false;

  constructor(parts) {
    Object.assign(this, parts);
  }

  enter() {
    this.points = [];
    this.known = null;
    this.wantsKnown = false;
    this.say(t("Click two points of the picture whose distance you know."));
    this.onChange();
  }

  leave() {
    this.points = [];
    this.scene.sketch();
    this.onChange();
  }

  up(point) {
    const at = onPicture(point.at, this.scene.placement());
    if (this.wantsKnown) {
      this.known = at;
      this.wantsKnown = false;
    } else if (this.points.length < 2) this.points.push(at);
    this.move(point);
    this.onChange();
  }

  move(point) {
    const placement = this.scene.placement();
    if (!placement) return;
    const ends = this.points.map((one) => fromPicture(one, placement));
    if (ends.length === 1) ends.push(point.at);
    const dots = this.known ? [{ name: "measured", points: [fromPicture(this.known, placement)], dots: true }] : [];
    this.scene.sketch([{ name: "measured", points: ends, dots: true }, ...dots]);
  }

  key(event) {
    if (event.key !== "Escape" || this.points.length === 0) return false;
    this.enter();
    this.scene.sketch();
    return true;
  }

  /** Place the picture: the distance in metres, the known point, how the line runs: "" as it is, else 0 or 90 degrees. */
  finish(length, at, run) {
    const placement = this.scene.placement();
    const [a, b] = this.points;
    if (distance(a, b) < 1e-6 || !(length > 0)) return;
    const slope = direction(a, b);
    const turn = run === "" ? placement.turn : Number(run) - slope;
    const placed = placePicture(this.points, length, this.known ?? a, at, ((turn % 360) + 360) % 360);
    this.edits.placePicture(placed);
    this.done();
    this.model.isRefitted = true;
  }
}

export class Picture {
  isUnlocked = false;

  constructor(parts) {
    Object.assign(this, parts);
    this.node = el("section", { class: "plan-section picture-panel", "aria-label": t("Picture") });
    const kept = Number(sessionStorage.getItem(KEPT) ?? NaN);
    if (Number.isFinite(kept)) this.scene.opacity = kept;
    this.tool.onChange = () => this.draw();
  }

  get picture() {
    return this.model.plan?.picture;
  }

  // ---- dragging the picture

  carry() {
    const from = this.scene.placement();
    if (!from) return {};
    const gesture = {};
    let now = from;
    gesture.drag = (point, { at }) => {
      const [dx, dy] = [point.at[0] - at[0], point.at[1] - at[1]];
      now = { ...from, left: from.left + dx, bottom: from.bottom + dy };
      this.scene.drawPicture(now);
    };
    gesture.drop = () => this.edits.placePicture(now, t("move the picture"));
    return gesture;
  }

  #centre(at) {
    return fromPicture([0.5, this.picture.aspect / 2], at);
  }

  handles() {
    if (!this.isUnlocked || !this.picture) return [];
    const at = this.scene.placement();
    return [{ name: "picture-turn", at: fromPicture([1, this.picture.aspect], at), stem: this.#centre(at), label: t("Turn the picture: drag; Alt for fine steps") }];
  }

  turning() {
    const from = this.scene.placement();
    const centre = this.#centre(from);
    let now = from;
    const gesture = {};
    gesture.drag = (point, { at }) => {
      const by = direction(centre, point.at) - direction(centre, at);
      const turn = roundTo((((from.turn + by) % 360) + 360) % 360, point.alt ? 0.1 : 1);
      const [u, v] = turnPoint([(from.width) / 2, (from.width * this.picture.aspect) / 2], turn);
      now = { ...from, turn, left: centre[0] - u, bottom: centre[1] - v };
      this.scene.drawPicture(now);
      this.scene.sketch([], [{ at: centre, text: `${number(turn)}°` }]);
    };
    gesture.drop = () => this.edits.placePicture(now, t("turn the picture"));
    return gesture;
  }

  // ---- the panel

  draw() {
    const { picture } = this;
    const canEdit = this.canEdit();
    clear(this.node);
    if (!picture) {
      this.node.append(el("p", { text: canEdit ? t("A picture of the floor can lie under the plan: PNG, JPEG, SVG or DXF.") : t("This floor has no picture.") }));
      if (canEdit) this.node.append(this.#chooser(t("Add a picture…")));
      return;
    }
    this.node.append(this.#opacity());
    if (!canEdit) return;
    if (this.currentTool() === this.tool) this.node.append(...this.#steps());
    else this.node.append(...this.#actions(picture));
  }

  #opacity() {
    const input = el("input", { type: "range", min: "0", max: "1", step: "0.05", value: String(this.scene.opacity) });
    input.addEventListener("input", () => {
      this.scene.opacity = Number(input.value);
      sessionStorage.setItem(KEPT, input.value);
      this.scene.drawPicture();
    });
    return el("label", { class: "field" }, el("span", { class: "field-name", text: t("Opacity") }), input);
  }

  #actions(picture) {
    const status = picture.placed ? t("Placed: {width} wide.", { width: this.shown(picture.width) }) : t("Not placed yet: it is fitted to the plan until then.");
    const unlock = el("input", { type: "checkbox", checked: this.isUnlocked });
    unlock.addEventListener("change", () => this.unlock(unlock.checked));
    return [
      el("p", { class: picture.placed ? "muted" : "warning-text", text: status }),
      el("div", { class: "buttons" }, el("button", { type: "button", class: picture.placed ? "" : "primary", text: t("Place by two points…"), on: { click: () => this.start() } })),
      el("label", { class: "check" }, unlock, t("Unlocked: drag and turn the picture")), this.#chooser(t("Another picture…")),
    ];
  }

  unlock(on) {
    this.isUnlocked = on;
    this.select.showHandles();
    this.viewport.svg.classList.toggle("picture-unlocked", on);
  }

  shown(metres) {
    const { unit, factor } = this.model.unit;
    return `${number(metres / factor, 2)} ${unit}`;
  }

  #steps() {
    const { tool } = this;
    const cancel = el("button", { type: "button", text: t("Cancel"), on: { click: () => tool.done() } });
    if (tool.points.length < 2) {
      const text = tool.points.length === 0 ? t("1. Click a point of the picture.") : t("2. Click a second point whose distance from the first you know.");
      return [el("p", { role: "status", text }), el("div", { class: "buttons" }, cancel)];
    }
    return [this.#form(cancel)];
  }

  #form(cancel) {
    const { tool } = this;
    const { unit, factor } = this.model.unit;
    const placement = this.scene.placement();
    const known = fromPicture(tool.known ?? tool.points[0], placement);
    const isPlaced = this.picture.placed;
    const field = (label, value) => {
      const input = el("input", { inputMode: "decimal", value, autocomplete: "off" });
      return [input, el("label", { class: "field" }, el("span", { class: "field-name", text: `${label} [${unit}]` }), input)];
    };
    const [length, lengthField] = field(t("Distance of the two points"), this.length ?? "");
    const shown = (metres) => number(roundTo(isPlaced && !tool.known ? metres / factor : 0, 0.001));
    const [x, xField] = field(tool.known ? t("X of the known point") : t("X of the first point"), shown(known[0]));
    const [y, yField] = field(tool.known ? t("Y of the known point") : t("Y of the first point"), shown(known[1]));
    const run = el("select", null, [["", t("as the picture is turned")], ["0", t("along X, to the right")], ["90", t("along Y, upward")]].map(([value, text]) => el("option", { value, text })));
    const origin = el("button", { type: "button", text: t("Click another known point"), on: { click: () => {
      this.length = length.value;
      tool.wantsKnown = true;
      tool.say(t("Click a point of the picture whose X and Y you know, such as the origin."));
    } } });
    const error = el("p", { class: "error-text", role: "alert" });
    const form = el("form", { class: "picture-form" }, lengthField, el("div", { class: "pair" }, xField, yField), origin,
      el("label", { class: "field" }, el("span", { class: "field-name", text: t("From the first point to the second it runs") }), run), error,
      el("div", { class: "buttons" }, el("button", { type: "submit", class: "primary", text: t("Place the picture") }), cancel));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const values = [length, x, y].map((one) => readNumber(one.value) * factor);
      if (!(values[0] > 0) || values.some((one) => !Number.isFinite(one))) {
        error.textContent = t("The distance is a number above 0, X and Y are numbers.");
        return;
      }
      this.length = null;
      tool.finish(values[0], [values[1], values[2]], run.value);
    });
    queueMicrotask(() => length.focus());
    return form;
  }

  // ---- adding a picture

  #chooser(label) {
    const input = el("input", { type: "file", accept: PICTURES, class: "unseen", tabIndex: -1, "aria-label": label });
    input.addEventListener("change", () => this.#add(input.files[0]));
    return el("div", { class: "buttons" }, el("button", { type: "button", text: label, on: { click: () => input.click() } }), input);
  }

  /** Name the file in the workbook, then send it: only files that it names are taken. */
  async #add(file) {
    if (!file) return;
    if (!(await this.edits.namePicture(file.name))) return;
    await whenSent(this.store);
    if (!this.store.book.missing.some((one) => one.name === file.name)) return;
    try {
      this.store.replaceBook(await send(`/api/file?name=${encodeURIComponent(file.name)}`, file));
    } catch (error) {
      notice(error.message, { kind: "error" });
    }
  }
}
