// Pointers on the plan: wheel, pinch and pan move the view; everything else goes to the tool in use.

const WHEEL = 0.0016; // zoom a pixel of the wheel
const LINE_PX = 16;
const CLICK_PX = 4;
const DOUBLE_MS = 450;

export class PlanPointer {
  #touches = new Map();
  #pan = null;
  #pinch = null;
  #tool = null;
  #isSpace = false;
  #click = null;

  /** @param {{viewport: object, tool: () => object, canEdit: () => boolean}} parts */
  constructor(parts) {
    Object.assign(this, parts);
    const { svg } = parts.viewport;
    this.svg = svg;
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
  point(event) {
    const px = this.viewport.toLocal(event.clientX, event.clientY);
    return { at: this.viewport.toWorld(px), px, target: event.target, alt: event.altKey, shift: event.shiftKey, more: event.shiftKey || event.ctrlKey || event.metaKey, isTouch: event.pointerType === "touch" };
  }

  get isBusy() {
    return this.#tool !== null;
  }

  #space(event, isDown) {
    if (event.key !== " " || event.target.closest?.("input, textarea, select, button, a, dialog, [role=tab]")) return;
    if (isDown && !this.svg.checkVisibility?.()) return;
    if (isDown) event.preventDefault();
    this.#isSpace = isDown;
    this.svg.classList.toggle("panning", isDown);
  }

  #down(event) {
    if (event.pointerType === "touch") this.#touches.set(event.pointerId, [event.clientX, event.clientY]);
    this.svg.setPointerCapture(event.pointerId);
    if (this.#touches.size === 2) {
      this.#endTool(true);
      this.#pan = null;
      this.#pinch = this.#spread();
      return;
    }
    if (this.#touches.size > 2) return;
    const isForView = event.button === 1 || this.#isSpace || (event.pointerType === "touch" && this.#pansByTouch(event));
    if (event.button === 1) event.preventDefault();
    if (isForView) this.#pan = { from: [event.clientX, event.clientY], first: [event.clientX, event.clientY], event };
    else if (event.button === 0) {
      this.#tool = this.tool();
      this.#tool.down?.(this.point(event));
    }
  }

  /** One finger moves the view, unless it lies on something that can be dragged or a tool waits for points. */
  #pansByTouch(event) {
    if (!this.canEdit()) return true;
    return !this.tool().takesTouch && !event.target.closest(".piece, .handle");
  }

  #move(event) {
    if (this.#touches.has(event.pointerId)) this.#touches.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.#pinch && this.#touches.size === 2) return this.#pinchMove();
    if (this.#pan) {
      const [x, y] = this.#pan.from;
      this.viewport.pan(event.clientX - x, event.clientY - y);
      this.#pan.from = [event.clientX, event.clientY];
      return null;
    }
    return (this.#tool ?? this.tool()).move?.(this.point(event), this.#tool !== null);
  }

  #up(event, isCancelled = false) {
    this.#touches.delete(event.pointerId);
    if (this.#touches.size < 2) this.#pinch = null;
    if (this.#pan) {
      const [x, y] = this.#pan.first;
      const isTap = event.pointerType === "touch" && Math.hypot(event.clientX - x, event.clientY - y) < 2 * CLICK_PX;
      const down = this.#pan.event;
      this.#pan = null;
      if (isTap && !isCancelled) this.tool().tap?.({ ...this.point(down), more: false });
      return;
    }
    if (!this.#tool) return;
    const tool = this.#tool;
    this.#tool = null;
    if (isCancelled) {
      tool.cancel?.();
      return;
    }
    tool.up?.(this.point(event));
    this.#countClick(event);
  }

  /** Two clicks at one place. The browser tells of none where the first replaced what lies there. */
  #countClick(event) {
    const before = this.#click;
    const now = { at: [event.clientX, event.clientY], time: event.timeStamp };
    const isSecond = before && now.time - before.time < DOUBLE_MS && !isDrag(before.at, now.at);
    this.#click = isSecond ? null : now;
    if (isSecond) this.tool().double?.({ ...this.point(event), target: targetAt(event) });
  }

  #endTool() {
    this.#tool?.cancel?.();
    this.#tool = null;
  }

  #spread() {
    const [[a, b], [c, d]] = [...this.#touches.values()];
    return { distance: Math.hypot(c - a, d - b) || 1, centre: [(a + c) / 2, (b + d) / 2] };
  }

  #pinchMove() {
    const before = this.#pinch;
    const now = this.#spread();
    const [px, py] = this.viewport.toLocal(...now.centre);
    this.viewport.pan(now.centre[0] - before.centre[0], now.centre[1] - before.centre[1]);
    this.viewport.zoom(now.distance / before.distance, px, py);
    this.#pinch = now;
  }

  #wheel(event) {
    event.preventDefault();
    const px = event.deltaMode === 1 ? event.deltaY * LINE_PX : event.deltaY;
    const speed = event.ctrlKey ? 4 * WHEEL : WHEEL; // a pinch on a touchpad comes as a wheel with Ctrl, in small steps
    this.viewport.zoom(Math.exp(-Math.max(-250, Math.min(250, px)) * speed), ...this.viewport.toLocal(event.clientX, event.clientY));
  }
}

/** What lies under a pointer; events of captured pointers name the drawing itself. */
const targetAt = ({ clientX, clientY, target }) => document.elementFromPoint(clientX, clientY) ?? target;

/** Whether a pointer went far enough to be a drag. */
export const isDrag = ([a, b], [c, d]) => Math.hypot(c - a, d - b) >= CLICK_PX;
