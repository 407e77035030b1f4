// What of the floor is seen, metres to pixels, and pointers: wheel, pinch and pan move the view, all else goes to the tool in use.

const LEAST = 2; // pixels a metre
const MOST = 1200;
const MARGIN = 24;
const WHEEL = 0.0016; // zoom a pixel of the wheel
const LINE_PX = 16;
const CLICK_PX = 4;
const DOUBLE_MS = 450;

const bound = (scale) => Math.min(MOST, Math.max(LEAST, scale));

/** Whether a pointer went far enough to be a drag. */
export const isDrag = ([a, b], [c, d]) => Math.hypot(c - a, d - b) >= CLICK_PX;

/** The world group of the drawing is in metres with Y down. */
export class Viewport extends EventTarget {
  scale = 40;
  left = 0; // of the origin in the drawing [px]
  top = 0;
  #size = [0, 0];

  constructor({ svg, world }) {
    super();
    Object.assign(this, { svg, world });
    new ResizeObserver(() => this.#resize()).observe(svg);
  }

  get size() {
    return [this.svg.clientWidth || 1, this.svg.clientHeight || 1];
  }

  /** Keep what is in the middle there. */
  #resize() {
    const [w, h] = this.size;
    const [oldW, oldH] = this.#size;
    this.#size = [w, h];
    if (w < 2) return;
    if (this.wanted) this.fit(this.wanted); // also one that was asked for before there was any room
    else if (oldW >= 2) this.set(this.scale, this.left + (w - oldW) / 2, this.top + (h - oldH) / 2);
  }

  set(scale, left, top) {
    Object.assign(this, { scale: bound(scale), left, top });
    this.world.setAttribute("transform", `translate(${left.toFixed(2)} ${top.toFixed(2)}) scale(${this.scale.toFixed(4)})`);
    this.world.style.setProperty("--u", String(1 / this.scale));
    this.dispatchEvent(new Event("view"));
  }

  /** Show a box [x0, y0, x1, y1] whole; it is kept so until the user zooms or pans. */
  fit(box) {
    this.wanted = box;
    const [w, h] = this.size;
    if (w < 2) return;
    const [x0, y0, x1, y1] = box;
    const margin = 2 * Math.min(MARGIN, w / 20);
    const scale = bound(Math.min((w - margin) / Math.max(x1 - x0, 0.5), (h - margin) / Math.max(y1 - y0, 0.5)));
    this.set(scale, w / 2 - ((x0 + x1) / 2) * scale, h / 2 + ((y0 + y1) / 2) * scale);
  }

  /** Zoom by a factor about a point of the drawing [px]. */
  zoom(factor, px = this.size[0] / 2, py = this.size[1] / 2) {
    this.wanted = null;
    const scale = bound(this.scale * factor);
    const k = scale / this.scale;
    this.set(scale, px - (px - this.left) * k, py - (py - this.top) * k);
  }

  pan(dx, dy) {
    this.wanted = null;
    this.set(this.scale, this.left + dx, this.top + dy);
  }

  /** Bring a point of the floor into view, if it is not; of the height so much is covered at the bottom [px]. */
  reveal(point, covered = 0) {
    const [w, whole] = this.size;
    const margin = Math.min(60, w / 6);
    const shift = (at, size) => Math.max(margin - at, 0) || Math.min(size - margin - at, 0);
    const [px, py] = this.toScreen(point);
    const [dx, dy] = [shift(px, w), shift(py, whole - covered)];
    if (dx || dy) this.pan(dx, dy);
  }

  /** Pixels of the drawing at a place of the window. */
  toLocal(clientX, clientY) {
    const box = this.svg.getBoundingClientRect();
    return [clientX - box.left, clientY - box.top];
  }

  /** Metres at a pixel of the drawing. */
  toWorld = ([px, py]) => [(px - this.left) / this.scale, (this.top - py) / this.scale];

  toScreen = ([x, y]) => [this.left + x * this.scale, this.top - y * this.scale];

  get centre() {
    return this.toWorld(this.size.map((one) => one / 2));
  }
}

export class PlanPointer {
  #touches = new Map();
  #pan = null;
  #pinch = null;
  #tool = null;
  #isSpace = false;
  #click = null;

  constructor({ viewport, currentTool, canEdit }) {
    Object.assign(this, { viewport, currentTool, canEdit, svg: viewport.svg });
    const { svg } = this;
    svg.addEventListener("pointerdown", (event) => this.#down(event));
    svg.addEventListener("pointermove", (event) => this.#move(event));
    svg.addEventListener("pointerup", (event) => this.#up(event));
    svg.addEventListener("pointercancel", (event) => this.#up(event, true));
    svg.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    svg.addEventListener("auxclick", (event) => event.preventDefault());
    addEventListener("keydown", (event) => this.#space(event, true));
    addEventListener("keyup", (event) => this.#space(event, false));
    addEventListener("blur", () => (this.#isSpace = false));
  }

  /** A place of the window as tools take it. */
  #point({ clientX, clientY, target, altKey, shiftKey, ctrlKey, metaKey }) {
    const px = this.viewport.toLocal(clientX, clientY);
    return { at: this.viewport.toWorld(px), px, target, alt: altKey, more: shiftKey || ctrlKey || metaKey };
  }

  #space(event, isDown) {
    if (event.key !== " " || event.target.closest?.("input, textarea, select, button, a, dialog, [role=tab]")) return;
    if (isDown && !this.svg.checkVisibility?.()) return;
    if (isDown) event.preventDefault();
    this.#isSpace = isDown;
    this.svg.classList.toggle("panning", isDown);
  }

  #down(event) {
    const [at, isTouch] = [[event.clientX, event.clientY], event.pointerType === "touch"];
    if (isTouch) this.#touches.set(event.pointerId, at);
    this.svg.setPointerCapture(event.pointerId);
    if (this.#touches.size === 2) {
      this.#tool?.cancel?.();
      this.#tool = this.#pan = null;
      this.#pinch = this.#spread();
    }
    if (this.#touches.size > 1) return;
    const isDraggable = this.canEdit() && (this.currentTool().takesTouch || event.target.closest(".piece, .handle")); // by a finger
    if (event.button === 1) event.preventDefault();
    if (event.button === 1 || this.#isSpace || (isTouch && !isDraggable)) this.#pan = { from: at, first: at, event };
    else if (event.button === 0) {
      this.#tool = this.currentTool();
      this.#tool.down?.(this.#point(event));
    }
  }

  #move(event) {
    const at = [event.clientX, event.clientY];
    if (this.#touches.has(event.pointerId)) this.#touches.set(event.pointerId, at);
    if (this.#pinch && this.#touches.size === 2) this.#pinchMove();
    else if (this.#pan) {
      const [x, y] = this.#pan.from;
      this.#pan.from = at;
      this.viewport.pan(at[0] - x, at[1] - y);
    } else (this.#tool ?? this.currentTool()).move?.(this.#point(event), this.#tool !== null);
  }

  #up(event, isCancelled = false) {
    const [tool, pan] = [this.#tool, this.#pan];
    this.#tool = this.#pan = null;
    this.#touches.delete(event.pointerId);
    if (this.#touches.size < 2) this.#pinch = null;
    if (pan) {
      const isTap = event.pointerType === "touch" && Math.hypot(event.clientX - pan.first[0], event.clientY - pan.first[1]) < 2 * CLICK_PX;
      if (isTap && !isCancelled) this.currentTool().tap?.({ ...this.#point(pan.event), more: false });
    } else if (tool && isCancelled) tool.cancel?.();
    else if (tool) {
      tool.up?.(this.#point(event));
      this.#countClick(event);
    }
  }

  /** Two clicks at one place. The browser tells of none where the first replaced what lies there. */
  #countClick(event) {
    const before = this.#click;
    const now = { at: [event.clientX, event.clientY], time: event.timeStamp };
    const isSecond = before && now.time - before.time < DOUBLE_MS && !isDrag(before.at, now.at);
    this.#click = isSecond ? null : now;
    const target = document.elementFromPoint(...now.at) ?? event.target; // of a captured pointer it is the drawing itself
    if (isSecond) this.currentTool().double?.({ ...this.#point(event), target });
  }

  #spread() {
    const [[a, b], [c, d]] = [...this.#touches.values()];
    return { distance: Math.hypot(c - a, d - b) || 1, centre: [(a + c) / 2, (b + d) / 2] };
  }

  #pinchMove() {
    const before = this.#pinch;
    this.#pinch = this.#spread();
    const { centre, distance } = this.#pinch;
    this.viewport.pan(centre[0] - before.centre[0], centre[1] - before.centre[1]);
    this.viewport.zoom(distance / before.distance, ...this.viewport.toLocal(...centre));
  }

  #wheel(event) {
    event.preventDefault();
    const px = event.deltaMode === 1 ? event.deltaY * LINE_PX : event.deltaY;
    const speed = event.ctrlKey ? 4 * WHEEL : WHEEL; // a pinch on a touchpad comes as a wheel with Ctrl, in small steps
    this.viewport.zoom(Math.exp(-Math.max(-250, Math.min(250, px)) * speed), ...this.viewport.toLocal(event.clientX, event.clientY));
  }
}
