// Snapping: of a moved piece to walls and to the edges of other pieces, of a drawn corner to corners, walls and right angles.

import { distance, radians } from "./plan_geometry.mjs";

const PARALLEL = Math.sin(radians(2));
const APART = 0.3; // sine from which two directions hold a piece both ways
const REACH = 1.5; // how far beyond its ends an edge still attracts [m]

/** The sides of a ring as lines: a point, a unit direction, a length. */
export const sidesOf = (ring) => ring.map((point, i) => lineOf(point, ring[(i + 1) % ring.length])).filter((one) => one.length > 0);

export function lineOf(a, b) {
  const length = distance(a, b);
  return { a, b, length, d: length ? [(b[0] - a[0]) / length, (b[1] - a[1]) / length] : [1, 0] };
}

const cross = ([a, b], [c, d]) => a * d - b * c;
const dot = ([a, b], [c, d]) => a * c + b * d;
const less = ([a, b], [c, d]) => [a - c, b - d];

/**
 * The shift that brings sides of a moved piece onto lines.
 * @param {object[]} sides of the piece where it would stand
 * @param {object[]} lines walls and sides of others
 * @param {number} tolerance in metres
 * @returns {{shift: number[], guides: number[][][]}}
 */
export function snapSides(sides, lines, tolerance) {
  const found = [];
  for (const side of sides) for (const line of lines) {
    const one = compare(side, line, tolerance);
    if (one) found.push(one);
  }
  found.sort((a, b) => a.cost - b.cost);
  const [first] = found;
  if (!first) return { shift: [0, 0], guides: [] };
  const second = found.find((one) => Math.abs(cross(one.n, first.n)) > APART);
  return { shift: second ? meet(first, second) : along(first), guides: [first, second].filter(Boolean).map(guide) };
}

function compare(side, line, tolerance) {
  if (Math.abs(cross(side.d, line.d)) > PARALLEL) return null;
  const n = [-line.d[1], line.d[0]];
  const offset = dot(less(line.a, side.a), n);
  if (Math.abs(offset) > tolerance) return null;
  const ends = [dot(less(side.a, line.a), line.d), dot(less(side.b, line.a), line.d)];
  const gap = Math.max(0, Math.min(...ends) - line.length, -Math.max(...ends));
  if (gap > REACH) return null;
  return { n, offset, cost: Math.abs(offset) + 0.02 * gap, line, ends };
}

const along = ({ n, offset }) => [n[0] * offset, n[1] * offset];

/** The shift that satisfies both. */
function meet(one, other) {
  const det = cross(one.n, other.n);
  return [(one.offset * other.n[1] - other.offset * one.n[1]) / det, (one.n[0] * other.offset - other.n[0] * one.offset) / det];
}

function guide({ line, ends }) {
  const at = (s) => [line.a[0] + line.d[0] * s, line.a[1] + line.d[1] * s];
  return [at(Math.min(0, ...ends)), at(Math.max(line.length, ...ends))];
}

/**
 * A drawn point: on a corner, else on a wall, else level with the point before it.
 * @returns {{point: number[], guides: number[][][]}}
 */
export function snapPoint(point, { points, lines, before }, tolerance) {
  const near = points.filter((one) => distance(one, point) <= tolerance).sort((a, b) => distance(a, point) - distance(b, point))[0];
  if (near) return { point: near, guides: [] };
  const level = before && levelWith(point, before, tolerance);
  const wall = lines.map((line) => footOn(level?.point ?? point, line)).filter((one) => one && one.off <= tolerance).sort((a, b) => a.off - b.off)[0];
  if (wall && !level) return { point: wall.point, guides: [[wall.line.a, wall.line.b]] };
  if (wall && level) return { point: crossing(level, wall.line) ?? wall.point, guides: [[wall.line.a, wall.line.b], level.guide] };
  return level ? { point: level.point, guides: [level.guide] } : { point, guides: [] };
}

function levelWith([x, y], [bx, by], tolerance) {
  const [dx, dy] = [Math.abs(x - bx), Math.abs(y - by)];
  if (Math.min(dx, dy) > tolerance) return null;
  const point = dx < dy ? [bx, y] : [x, by];
  return { point, guide: [[bx, by], point], isVertical: dx < dy };
}

function crossing({ point, isVertical }, { a, d }) {
  const [along, across] = isVertical ? [0, 1] : [1, 0];
  if (Math.abs(d[along]) < PARALLEL) return null;
  const s = (point[along] - a[along]) / d[along];
  const found = [...point];
  found[across] = a[across] + d[across] * s;
  return found;
}

/** The wall that is nearest to a point, with its foot on it: {point, off, ...line}; null beyond `tolerance`. */
export function nearestWall(point, walls, tolerance) {
  const found = walls.map((line) => footOn(point, line)).filter((one) => one && one.off <= tolerance).sort((a, b) => a.off - b.off)[0];
  return found ? { ...found.line, point: found.point, off: found.off } : null;
}

function footOn(point, line) {
  const s = dot(less(point, line.a), line.d);
  if (s < 0 || s > line.length) return null;
  const foot = [line.a[0] + line.d[0] * s, line.a[1] + line.d[1] * s];
  return { point: foot, off: distance(foot, point), line };
}
