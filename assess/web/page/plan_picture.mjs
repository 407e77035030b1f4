// The picture under the plan: add one, place it by two clicks and a distance, move and turn it, how strong it shows.

import { send } from "./api.mjs";
import { PointsTool } from "./plan_draft.mjs";
import { direction, distance, fromPicture, onPicture, putPicture, readNumber, roundTo, wholeAngle } from "./plan_geometry.mjs";
import { Section } from "./plan_lists.mjs";
import { notice } from "./messages.mjs";
import { number, t } from "./texts.mjs";
import { html, nothing } from "./vendor/lit-html.mjs";
import { whenSent } from "./watch.mjs";

const PICTURES = ".png,.jpg,.jpeg,.svg,.dxf";
const KEPT = "assess-picture-opacity";

/** Two clicks on the picture, then the panel asks for the distance. */
export class PlacingTool extends PointsTool {
  name = "placing";
  points = []; // in shares of the picture
  known = null;
  wantsKnown = false;

  help() {
    return t("Click two points of the picture whose distance you know.");
  }

  enter() {
    this.known = null;
    this.wantsKnown = false;
    super.enter();
    this.onChange();
  }

  leave() {
    super.leave();
    this.onChange();
  }

  clear() {
    super.clear();
    if (this.isActive) this.enter();
  }

  snap({ at }) {
    return { point: at };
  }

  add({ point }) {
    const at = onPicture(point, this.scene.placement());
    if (this.wantsKnown) this.known = at;
    else if (this.points.length < 2) this.points.push(at);
    this.wantsKnown = false;
    this.onChange();
  }

  draw({ point }) {
    const placement = this.scene.placement();
    if (!placement) return;
    const ends = this.points.map((one) => fromPicture(one, placement));
    if (ends.length === 1) ends.push(point);
    const known = this.known ? [fromPicture(this.known, placement)] : [];
    this.sketch([ends, known].map((points) => ({ name: "measured", points, dots: true })));
  }

  /** Place the picture: the distance in metres, the known point, how the line runs: "" as it is, else 0 or 90 degrees. */
  finish(length, at, run) {
    const [a, b] = this.points;
    if (distance(a, b) < 1e-6) return;
    const turn = run === "" ? this.scene.placement().turn : Number(run) - direction(a, b);
    this.edits.placePicture(putPicture(this.known ?? a, at, length / distance(a, b), wholeAngle(turn, 1e-6)), t("place the picture"));
    this.done();
    this.model.isRefitted = true;
  }
}

export class Picture extends Section {
  isUnlocked = false;
  #error = "";

  constructor(parts) {
    super(parts, t("Picture"));
    this.scene.opacity = Number(sessionStorage.getItem(KEPT) ?? this.scene.opacity);
    this.tool.onChange = () => this.draw();
  }

  get picture() {
    return this.model.plan?.picture;
  }

  // ---- dragging the picture

  /** A gesture: `moved(point, from)` is where the picture lies meanwhile. */
  #gesture(label, moved) {
    let now = null;
    return {
      drag: (point, from) => this.scene.drawPicture((now = moved(point, from))),
      drop: () => this.edits.placePicture(now, label),
    };
  }

  carry() {
    const from = this.scene.placement();
    if (!from) return {};
    return this.#gesture(t("move the picture"), ({ at: [x, y] }, { at: [x0, y0] }) => ({ ...from, left: from.left + x - x0, bottom: from.bottom + y - y0 }));
  }

  #centre = (at) => fromPicture([0.5, this.picture.aspect / 2], at);

  handles() {
    if (!this.isUnlocked || !this.picture) return [];
    const at = this.scene.placement();
    return [{ name: "picture-turn", at: fromPicture([1, this.picture.aspect], at), stem: this.#centre(at), label: t("Turn the picture: drag; Alt for fine steps") }];
  }

  turning() {
    const from = this.scene.placement();
    const centre = this.#centre(from);
    return this.#gesture(t("turn the picture"), (point, { at }) => {
      const turn = wholeAngle(from.turn + direction(centre, point.at) - direction(centre, at), point.alt ? 0.1 : 1);
      this.scene.sketch([], [{ at: centre, text: `${number(turn)}°` }]);
      return putPicture([0.5, this.picture.aspect / 2], centre, from.width, turn);
    });
  }

  // ---- the panel

  content() {
    const { picture } = this;
    const canEdit = this.canEdit();
    if (!picture) {
      const text = canEdit ? t("A picture of the floor can lie under the plan: PNG, JPEG, SVG or DXF.") : t("This floor has no picture.");
      return html`<p>${text}</p>${canEdit ? this.#chooser(t("Add a picture…")) : nothing}`;
    }
    const fade = ({ target }) => {
      sessionStorage.setItem(KEPT, target.value);
      this.scene.draw({ opacity: target.valueAsNumber });
    };
    return html`<label class="field"><span class="field-name">${t("Opacity")}</span>
      <input type="range" min="0" max="1" step="0.05" .value=${String(this.scene.opacity)} @input=${fade}></label>
      ${canEdit ? (this.currentTool() === this.tool ? this.#steps() : this.#actions(picture)) : nothing}`;
  }

  #actions({ placed, width }) {
    const status = placed ? t("Placed: {width} wide.", { width: this.model.shownLength(width) }) : t("Not placed yet: it is fitted to the plan until then.");
    const unlock = ({ target }) => {
      this.isUnlocked = target.checked;
      this.select.showHandles();
      this.viewport.svg.classList.toggle("picture-unlocked", this.isUnlocked);
    };
    return html`<p class=${placed ? "muted" : "warning-text"}>${status}</p>
      <div class="buttons"><button type="button" class=${placed ? "" : "primary"} @click=${() => this.setTool("placing")}>${t("Place by two points…")}</button></div>
      <label class="check"><input type="checkbox" .checked=${this.isUnlocked} @change=${unlock}>${t("Unlocked: drag and turn the picture")}</label>
      ${this.#chooser(t("Another picture…"))}`;
  }

  #steps() {
    const { tool } = this;
    const cancel = html`<button type="button" @click=${() => tool.done()}>${t("Cancel")}</button>`;
    if (tool.points.length === 2) return this.#form(cancel);
    this.#error = "";
    const text = tool.points.length ? t("2. Click a second point whose distance from the first you know.") : t("1. Click a point of the picture.");
    return html`<p role="status">${text}</p><div class="buttons">${cancel}</div>`;
  }

  #form(cancel) {
    const { tool, model: { unit: { unit, factor } } } = this;
    const known = fromPicture(tool.known ?? tool.points[0], this.scene.placement());
    const shown = (metres) => number(roundTo(this.picture.placed && !tool.known ? metres / factor : 0, 0.001));
    const field = (name, label, value) => html`<label class="field"><span class="field-name">${label} [${unit}]</span>
      <input name=${name} inputmode="decimal" autocomplete="off" .value=${value}></label>`;
    const runs = [["", t("as the picture is turned")], ["0", t("along X, to the right")], ["90", t("along Y, upward")]];
    const wantKnown = ({ target: { form } }) => {
      form.x.value = form.y.value = "0";
      tool.wantsKnown = true;
      this.say(t("Click a point of the picture whose X and Y you know, such as the origin."));
    };
    return html`<form class="picture-form" @submit=${(event) => this.#submit(event)}>${field("apart", t("Distance of the two points"), "")}
      <div class="pair">${field("x", tool.known ? t("X of the known point") : t("X of the first point"), shown(known[0]))}
        ${field("y", tool.known ? t("Y of the known point") : t("Y of the first point"), shown(known[1]))}</div>
      <button type="button" @click=${wantKnown}>${t("Click another known point")}</button>
      <label class="field"><span class="field-name">${t("From the first point to the second it runs")}</span>
        <select name="run">${runs.map(([value, text]) => html`<option value=${value}>${text}</option>`)}</select></label>
      <p class="error-text" role="alert">${this.#error}</p>
      <div class="buttons"><button type="submit" class="primary">${t("Place the picture")}</button>${cancel}</div></form>`;
  }

  draw() {
    const had = this.node.querySelector("form");
    super.draw();
    if (!had) this.node.querySelector("form")?.apart.focus();
  }

  #submit(event) {
    event.preventDefault();
    const { apart, x, y, run } = event.target;
    const [length, ...at] = [apart, x, y].map((one) => readNumber(one.value) * this.model.unit.factor);
    const isRight = length > 0 && [length, ...at].every(Number.isFinite);
    this.#error = isRight ? "" : t("The distance is a number above 0, X and Y are numbers.");
    if (isRight) this.tool.finish(length, at, run.value);
    else this.draw();
  }

  // ---- adding a picture

  #chooser(label) {
    return html`<div class="buttons"><button type="button" @click=${({ target }) => target.nextElementSibling.click()}>${label}</button>
      <input type="file" accept=${PICTURES} class="unseen" tabindex="-1" aria-label=${label} @change=${({ target }) => this.#add(target)}></div>`;
  }

  /** Name the file in the workbook, then send it: only files that it names are taken. */
  async #add(input) {
    const [file] = input.files;
    input.value = ""; // the same file may be chosen for another floor
    if (!file || !(await this.edits.change("Floors", [this.model.plan.floor_row], { plan: file.name }, t("picture")))) return;
    await whenSent(this.store);
    if (!this.store.book.missing.some((one) => one.name === file.name)) return;
    try {
      this.store.replaceBook(await send(`/api/file?name=${encodeURIComponent(file.name)}`, file));
    } catch (error) {
      notice(error.message, { kind: "error" });
    }
  }
}
