// Geometry of the plan, in metres with Y up; angles in degrees, anticlockwise from X. Nothing here knows of the screen.

const FULL = 360;
const AXIS_WITHIN = 15; // degrees from X or Y

export const radians = (degrees) => (degrees * Math.PI) / 180;
export const distance = ([a, b], [c, d]) => Math.hypot(c - a, d - b);
export const middle = ([a, b], [c, d]) => [(a + c) / 2, (b + d) / 2];

/** A point turned about the origin. */
export function turnPoint([x, y], degrees) {
  const [cos, sin] = [Math.cos(radians(degrees)), Math.sin(radians(degrees))];
  return [x * cos - y * sin, x * sin + y * cos];
}

/** An angle from 0 to below 360, in whole degrees. */
export const wholeAngle = (degrees) => ((Math.round(degrees) % FULL) + FULL) % FULL;

/** The axis that an angle tells, as the core has it: 0 X, 1 Y, -1 neither. */
export function axisOf(angle) {
  const folded = ((angle % 180) + 180) % 180;
  if (Math.min(folded, 180 - folded) <= AXIS_WITHIN) return 0;
  return Math.abs(folded - 90) <= AXIS_WITHIN ? 1 : -1;
}

/** The direction from one point to another, in degrees. */
export const direction = ([a, b], [c, d]) => (Math.atan2(d - b, c - a) * 180) / Math.PI;

/** The corners of a piece on the plan: Breadth runs along its angle, Width across it. */
export function corners({ x, y, angle, breadth, width }) {
  const [b, w] = [breadth / 2, width / 2];
  return [[-b, -w], [b, -w], [b, w], [-b, w]].map((one) => {
    const [u, v] = turnPoint(one, angle);
    return [x + u, y + v];
  });
}

/** A ring that moves with a piece from one pose to another. */
export function moveRing(ring, from, to) {
  return ring.map(([x, y]) => {
    const [u, v] = turnPoint([x - from.x, y - from.y], to.angle - from.angle);
    return [to.x + u, to.y + v];
  });
}

/** The box round points: [x0, y0, x1, y1]. */
export function boxOf(points) {
  const [xs, ys] = [points.map((one) => one[0]), points.map((one) => one[1])];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

export function isInside([x, y], ring) {
  let inside = false;
  ring.forEach(([x1, y1], i) => {
    const [x0, y0] = ring.at(i - 1);
    if (y1 > y !== y0 > y && x < ((x0 - x1) * (y - y1)) / (y0 - y1) + x1) inside = !inside;
  });
  return inside;
}

/** A point inside a ring: its centroid, or where that lies outside the middle of the widest stretch at its height. */
export function pointInside(ring) {
  const centroid = centroidOf(ring);
  if (isInside(centroid, ring)) return centroid;
  const [, y0, , y1] = boxOf(ring);
  const y = (y0 + y1) / 2 + (y1 - y0) * 1e-3;
  const xs = ring.flatMap(([bx, by], i) => {
    const [ax, ay] = ring.at(i - 1);
    return by > y !== ay > y ? [bx + ((ax - bx) * (y - by)) / (ay - by)] : [];
  }).sort((a, b) => a - b);
  let best = [0, ring[0]];
  for (let i = 0; i + 1 < xs.length; i += 2) if (xs[i + 1] - xs[i] > best[0]) best = [xs[i + 1] - xs[i], [(xs[i] + xs[i + 1]) / 2, y]];
  return best[1];
}

function centroidOf(ring) {
  let [area, cx, cy] = [0, 0, 0];
  ring.forEach(([x, y], i) => {
    const [px, py] = ring.at(i - 1);
    const cross = px * y - x * py;
    area += cross;
    cx += (px + x) * cross;
    cy += (py + y) * cross;
  });
  return Math.abs(area) < 1e-9 ? ring[0] : [cx / (3 * area), cy / (3 * area)];
}

// ---- numbers as the workbook holds them

/** A number as people type it, with a point or a comma. */
export const readNumber = (text) => (text.trim() === "" ? NaN : Number(text.trim().replace(",", ".")));

/** A value rounded to a step, without the digits that binary numbers leave. */
export const roundTo = (value, step) => Number((Math.round(value / step) * step).toFixed(6));

/** A length in metres as a cell of a column holds it: rounded to `step` metres, in the unit of the column. */
export function inUnit(metres, column, step = 0.01) {
  const factor = column?.factor || 1;
  const decimals = Math.max(0, Math.ceil(-Math.log10(step / factor) - 1e-9));
  return Number((roundTo(metres, step) / factor).toFixed(decimals));
}

/** The text of an outline: "x y; x y; x y" in the unit of its column. */
export const writeOutline = (ring, column) => ring.map((point) => point.map((one) => inUnit(one, column)).join(" ")).join("; ");

/** As the core reads corners: 6,5 has a decimal comma, 1,500 can be read in two ways. */
const DECIMAL_COMMA = /^[-+]?(?![1-9]\d{0,2},\d{3}$)\d+,\d+$/;

/** The corners that a text names, in metres; null where it names fewer than three. */
export function readOutline(text, column) {
  const factor = column?.factor || 1;
  const ring = String(text ?? "").split(/[;\n]/).map((one) => one.trim().split(/\s+/).map((part) => Number(DECIMAL_COMMA.test(part) ? part.replace(",", ".") : part) * factor))
    .filter((one) => one.length === 2 && one.every(Number.isFinite));
  if (ring.length > 3 && distance(ring[0], ring.at(-1)) <= 1e-3) ring.pop();
  return ring.length >= 3 ? ring : null;
}

// ---- the picture

/** Where a point of the plan lies on a picture: in shares of its width, from its lower left corner. */
export function onPicture([x, y], { left, bottom, width, turn }) {
  const [u, v] = turnPoint([x - left, y - bottom], -turn);
  return [u / width, v / width];
}

/** Where a point of a picture lies on the plan. */
export function fromPicture([u, v], { left, bottom, width, turn }) {
  const [x, y] = turnPoint([u * width, v * width], turn);
  return [left + x, bottom + y];
}

/**
 * Place a picture so that two of its points lie at a known distance, and a known point where it belongs.
 * @param {number[][]} pair two points in shares of the picture
 * @param {number} length their distance [m]
 * @param {number[]} known a point of the picture, and `at` where it lies on the plan
 * @param {number} turn by which it is turned
 */
export function placePicture(pair, length, known, at, turn) {
  const width = length / distance(...pair);
  const [dx, dy] = turnPoint([known[0] * width, known[1] * width], turn);
  return { left: at[0] - dx, bottom: at[1] - dy, width, turn };
}
