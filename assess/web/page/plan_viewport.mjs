// What of the floor is seen: metres to pixels, zoom, pan, fit. The world group of the drawing is in metres with Y down.

const LEAST = 2; // pixels a metre
const MOST = 1200;
const MARGIN = 24;

export class Viewport extends EventTarget {
  scale = 40;
  left = 0; // of the origin in the drawing [px]
  top = 0;
  #size = [0, 0];

  constructor(svg, world) {
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
    this.scale = Math.min(MOST, Math.max(LEAST, scale));
    Object.assign(this, { left, top });
    this.world.setAttribute("transform", `translate(${left.toFixed(2)} ${top.toFixed(2)}) scale(${this.scale.toFixed(4)})`);
    this.world.style.setProperty("--u", String(1 / this.scale));
    this.dispatchEvent(new Event("view"));
  }

  /** Show a box [x0, y0, x1, y1] whole; it is kept so until the user zooms or pans. */
  fit(box) {
    const [w, h] = this.size;
    if (w < 2) {
      this.wanted = box;
      return;
    }
    const [x0, y0, x1, y1] = box;
    const margin = Math.min(MARGIN, w / 20);
    const scale = Math.min((w - 2 * margin) / Math.max(x1 - x0, 0.5), (h - 2 * margin) / Math.max(y1 - y0, 0.5));
    const bound = Math.min(MOST, Math.max(LEAST, scale));
    this.set(bound, w / 2 - ((x0 + x1) / 2) * bound, h / 2 + ((y0 + y1) / 2) * bound);
    this.wanted = box;
  }

  /** Zoom by a factor about a point of the drawing [px]. */
  zoom(factor, px = this.size[0] / 2, py = this.size[1] / 2) {
    this.wanted = null;
    const scale = Math.min(MOST, Math.max(LEAST, this.scale * factor));
    const k = scale / this.scale;
    this.set(scale, px - (px - this.left) * k, py - (py - this.top) * k);
  }

  pan(dx, dy) {
    this.wanted = null;
    this.set(this.scale, this.left + dx, this.top + dy);
  }

  /** Bring a point of the floor into view, if it is not; of the height so much is covered at the bottom [px]. */
  reveal([x, y], covered = 0) {
    const [w, whole] = this.size;
    const h = whole - covered;
    const [px, py] = this.toScreen([x, y]);
    const margin = Math.min(60, w / 6);
    const dx = px < margin ? margin - px : px > w - margin ? w - margin - px : 0;
    const dy = py < margin ? margin - py : py > h - margin ? h - margin - py : 0;
    if (dx || dy) this.pan(dx, dy);
  }

  /** Pixels of the drawing at a place of the window. */
  toLocal(clientX, clientY) {
    const box = this.svg.getBoundingClientRect();
    return [clientX - box.left, clientY - box.top];
  }

  /** Metres at a pixel of the drawing. */
  toWorld([px, py]) {
    return [(px - this.left) / this.scale, (this.top - py) / this.scale];
  }

  toScreen([x, y]) {
    return [this.left + x * this.scale, this.top - y * this.scale];
  }

  get centre() {
    const [w, h] = this.size;
    return this.toWorld([w / 2, h / 2]);
  }
}
