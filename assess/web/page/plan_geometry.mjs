// Geometry of the plan, in metres with Y up; angles in degrees, anticlockwise from X. Nothing here knows of the screen.

const AXIS_WITHIN = 15; // degrees from X or Y
const PARALLEL = Math.sin(Math.PI / 90); // of two directions, 2 degrees apart
const APART = 0.3; // sine from which two directions hold a piece both ways
const REACH = 1.5; // how far beyond its ends an edge still attracts [m]
const CENTIMETRE = 0.01;
const STEP = 0.25; // between places that are tried besides: sharp corners, slanted neighbours [m]
const SLACK = 0.011; // by which pieces may overlap: positions are whole centimetres [m]

export const radians = (degrees) => (degrees * Math.PI) / 180;
export const distance = ([a, b], [c, d]) => Math.hypot(c - a, d - b);
export const middle = ([a, b], [c, d]) => [(a + c) / 2, (b + d) / 2];
/** The direction from one point to another, in degrees. */
export const direction = ([a, b], [c, d]) => (Math.atan2(d - b, c - a) * 180) / Math.PI;
/** The remainder from 0 to below a number. */
export const modulo = (value, by) => ((value % by) + by) % by;
/** A value rounded to a step, without the digits that binary numbers leave. */
export const roundTo = (value, step) => Number((Math.round(value / step) * step).toFixed(6));
/** An angle from 0 to below 360, in whole steps. */
export const wholeAngle = (degrees, step = 1) => roundTo(modulo(degrees, 360), step) % 360;
/** The corners of a rectangle between two of them. */
export const rectangle = ([a, b], [c, d]) => [[a, b], [c, b], [c, d], [a, d]];

const cross = ([a, b], [c, d]) => a * d - b * c;
const dot = ([a, b], [c, d]) => a * c + b * d;
const less = ([a, b], [c, d]) => [a - c, b - d];
const across = ([a, b]) => [-b, a];

/** A point turned about the origin, then moved. */
export function turnPoint([x, y], degrees, [dx, dy] = [0, 0]) {
  const [cos, sin] = [Math.cos(radians(degrees)), Math.sin(radians(degrees))];
  return [dx + x * cos - y * sin, dy + x * sin + y * cos];
}

/** The axis that an angle tells, as the core has it: 0 X, 1 Y, -1 neither. */
export function axisOf(angle) {
  const folded = modulo(angle, 180);
  if (Math.min(folded, 180 - folded) <= AXIS_WITHIN) return 0;
  return Math.abs(folded - 90) <= AXIS_WITHIN ? 1 : -1;
}

/** The corners of a piece on the plan: Breadth runs along its angle, Width across it. */
export function corners({ x, y, angle, breadth, width }) {
  return rectangle([-breadth / 2, -width / 2], [breadth / 2, width / 2]).map((one) => turnPoint(one, angle, [x, y]));
}

/** A ring that moves with a piece from one pose to another. */
export const moveRing = (ring, from, to) =>
  ring.map((one) => turnPoint(less(one, [from.x, from.y]), to.angle - from.angle, [to.x, to.y]));

/** The box round points: [x0, y0, x1, y1]. */
export function boxOf(points) {
  const [xs, ys] = [points.map((one) => one[0]), points.map((one) => one[1])];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** Whether two boxes overlap. */
export const boxesMeet = (one, other) => [0, 1].every((i) => one[i] < other[i + 2] && other[i] < one[i + 2]);

/** Where a ring crosses the level of a Y, in order. */
const crossingsAt = (ring, y) => ring.flatMap(([bx, by], i) => {
  const [ax, ay] = ring.at(i - 1);
  return by > y !== ay > y ? [bx + ((ax - bx) * (y - by)) / (ay - by)] : [];
}).sort((a, b) => a - b);

export const isInside = ([x, y], ring) => crossingsAt(ring, y).filter((one) => one > x).length % 2 === 1;

/** A point inside a ring: its centroid, or where that lies outside the middle of the widest stretch at its height. */
export function pointInside(ring) {
  const centroid = centroidOf(ring);
  if (isInside(centroid, ring)) return centroid;
  const [, y0, , y1] = boxOf(ring);
  const y = (y0 + y1) / 2 + (y1 - y0) * 1e-3;
  const xs = crossingsAt(ring, y);
  const widths = xs.map((x, i) => (i % 2 ? x - xs[i - 1] : 0));
  const at = widths.indexOf(Math.max(...widths));
  return at > 0 ? [(xs[at - 1] + xs[at]) / 2, y] : ring[0];
}

function centroidOf(ring) {
  const sum = (value) => ring.reduce((all, one, i) => all + cross(ring.at(i - 1), one) * value(ring.at(i - 1), one), 0);
  const area = sum(() => 1);
  return Math.abs(area) < 1e-9 ? ring[0] : [0, 1].map((i) => sum((a, b) => a[i] + b[i]) / (3 * area));
}

// ---- lines: a point, a unit direction, a length

export function lineOf(a, b) {
  const length = distance(a, b);
  return { a, b, length, d: length ? less(b, a).map((one) => one / length) : [1, 0] };
}

export const sidesOf = (ring) => ring.map((point, i) => lineOf(point, ring[(i + 1) % ring.length])).filter((one) => one.length > 0);

const pointOn = ({ a, d }, s) => [a[0] + d[0] * s, a[1] + d[1] * s];

/** A line with the foot of a point on it, which is held within its ends, and how far off the point lies. */
export function footOn(at, line) {
  const s = dot(less(at, line.a), line.d);
  const held = Math.min(line.length, Math.max(0, s));
  const point = pointOn(line, held);
  return { ...line, point, off: distance(point, at), isBeside: s === held };
}

/** The one that is least off; null beyond `tolerance`. */
export const nearest = (all, tolerance) => all.filter(({ off }) => off <= tolerance).sort((a, b) => a.off - b.off)[0] ?? null;

/** The wall that is nearest to a point beside it, with its foot. */
export const nearestWall = (at, walls, tolerance) => nearest(walls.map((line) => footOn(at, line)).filter((one) => one.isBeside), tolerance);

// ---- snapping: {point or shift, guides: lines to draw}

/** The shift that brings sides of a moved piece onto lines: walls and sides of others. */
export function snapSides(sides, lines, tolerance) {
  const found = sides.flatMap((side) => lines.map((line) => compare(side, line, tolerance))).filter(Boolean).sort((a, b) => a.cost - b.cost);
  const [first] = found;
  if (!first) return { shift: [0, 0], guides: [] };
  const second = found.find((one) => Math.abs(cross(one.n, first.n)) > APART);
  const along = ({ n: [x, y], offset }) => [x * offset, y * offset];
  const meet = (one, other) => { // the shift that satisfies both
    const det = cross(one.n, other.n);
    return [(one.offset * other.n[1] - other.offset * one.n[1]) / det, (one.n[0] * other.offset - other.n[0] * one.offset) / det];
  };
  const guide = ({ line, ends }) => [pointOn(line, Math.min(0, ...ends)), pointOn(line, Math.max(line.length, ...ends))];
  return { shift: second ? meet(first, second) : along(first), guides: [first, second].filter(Boolean).map(guide) };
}

function compare(side, line, tolerance) {
  if (Math.abs(cross(side.d, line.d)) > PARALLEL) return null;
  const n = across(line.d);
  const offset = dot(less(line.a, side.a), n);
  if (Math.abs(offset) > tolerance) return null;
  const ends = [side.a, side.b].map((one) => dot(less(one, line.a), line.d));
  const gap = Math.max(0, Math.min(...ends) - line.length, -Math.max(...ends));
  return gap > REACH ? null : { n, offset, cost: Math.abs(offset) + 0.02 * gap, line, ends };
}

/** A drawn point: on a corner, else on a wall, else level with the point before it. */
export function snapPoint(at, { points, lines, before }, tolerance) {
  const corner = nearest(points.map((point) => ({ point, off: distance(point, at) })), tolerance);
  if (corner) return { point: corner.point, guides: [] };
  const level = before && levelWith(at, before, tolerance);
  const wall = nearestWall(level?.point ?? at, lines, tolerance);
  const point = (wall && level && crossing(level, wall)) ?? (wall ?? level)?.point ?? at;
  return { point, guides: [wall && [wall.a, wall.b], level && [before, level.point]].filter(Boolean) };
}

/** On the vertical or the level line through another point: {point, along}, the axis that stays. */
function levelWith([x, y], [bx, by], tolerance) {
  const [dx, dy] = [Math.abs(x - bx), Math.abs(y - by)];
  if (Math.min(dx, dy) > tolerance) return null;
  return dx < dy ? { point: [bx, y], along: 0 } : { point: [x, by], along: 1 };
}

function crossing({ point, along }, { a, d }) {
  if (Math.abs(d[along]) < PARALLEL) return null;
  const other = 1 - along;
  return point.with(other, a[other] + (d[other] * (point[along] - a[along])) / d[along]);
}

// ---- where several pieces come to stand: poses {row, x, y, angle}

/** The ways to align: the axis, 0 X and 1 Y, and the share of a piece's box that comes to lie at one place. */
const ALIGNED = { left: [0, 0], centre: [0, 0.5], right: [0, 1], top: [1, 1], middle: [1, 0.5], bottom: [1, 0] };

const shifted = (piece, axis, by) => ({ row: piece.row, [axis ? "y" : "x"]: roundTo((axis ? piece.y : piece.x) + by, CENTIMETRE) });

export function align(pieces, how) {
  const [axis, share] = ALIGNED[how];
  const at = (box) => box[axis] + share * (box[axis + 2] - box[axis]);
  const to = at(boxOf(pieces.flatMap(corners)));
  return pieces.map((one) => shifted(one, axis, to - at(boxOf(corners(one)))));
}

/** Equal gaps between pieces along an axis; the first and the last stay. */
export function distribute(pieces, axis) {
  const ends = (piece) => [0, 2].map((i) => boxOf(corners(piece))[axis + i]);
  const all = pieces.map((piece) => ({ piece, ends: ends(piece) })).sort((a, b) => a.ends[0] + a.ends[1] - b.ends[0] - b.ends[1]);
  const filled = all.reduce((sum, one) => sum + one.ends[1] - one.ends[0], 0);
  let at = all[0].ends[0];
  const gap = (all.at(-1).ends[1] - at - filled) / (all.length - 1);
  return all.map(({ piece, ends: [from, to] }) => {
    const by = at - from;
    at += to - from + gap;
    return shifted(piece, axis, by);
  });
}

/**
 * Stand pieces along the walls of a room, the largest first, clear of convex rings: the poses of those that find room. A
 * piece is {row, breadth, width, axis}; axis: 0 or 1 where its Breadth has to run along X or Y, else -1.
 */
export function standAlongWalls(ring, pieces, taken) {
  const walls = sidesOf(ring).sort((a, b) => b.length - a.length);
  const isLeft = ring.reduce((sum, one, i) => sum + cross(ring.at(i - 1), one), 0) > 0; // the room, of its sides
  const inward = (d) => across(d).map((one) => (isLeft ? one : -one));
  const long = (one) => Math.max(one.breadth, one.width);
  const blocked = [...walls.map(({ a, b }) => [a, b]), ...taken].map((one) => [one, boxOf(one)]);
  const fits = (pose) => {
    const own = corners(pose);
    return isInside([pose.x, pose.y], ring) && !blocked.some(([one, its]) => boxesMeet(boxOf(own), its) && overlap(own, one));
  };
  return [...pieces].sort((a, b) => long(b) - long(a)).flatMap((piece) => {
    const found = firstPose(piece, walls, inward, fits, blocked);
    if (!found) return [];
    blocked.push([corners(found), boxOf(corners(found))]);
    return [{ row: piece.row, x: found.x, y: found.y, angle: found.angle }];
  });
}

/** The first pose that fits: at the beginning of a wall, or behind something that stands in the way. */
function firstPose(piece, walls, inward, fits, blocked) {
  for (const { a, d, length } of walls) {
    const n = inward(d);
    const angle = wholeAngle(direction([0, 0], n) + (piece.width >= piece.breadth ? 0 : 90)) % 180;
    if (piece.axis >= 0 && axisOf(angle) !== piece.axis) continue;
    const own = corners({ ...piece, x: 0, y: 0, angle });
    const [deep, half] = [n, d].map((way) => Math.max(...own.map((one) => dot(one, way))));
    const behind = blocked.map(([one]) => Math.max(...one.map((point) => dot(less(point, a), d))));
    const steps = Array.from({ length: Math.ceil(length / STEP) }, (_, i) => i * STEP);
    const starts = [...steps, ...behind.filter((one) => one > 0)].map((one) => one + half).filter((s) => s <= length - half + SLACK / 2);
    for (const s of starts.sort((one, other) => one - other)) {
      const [x, y] = [0, 1].map((i) => roundTo(a[i] + d[i] * s + n[i] * deep, CENTIMETRE));
      if (fits({ ...piece, x, y, angle })) return { ...piece, x, y, angle };
    }
  }
  return null;
}

/** Whether two convex rings, or a ring and a line of two points, overlap by more than the slack. */
function overlap(one, other) {
  return [...sidesOf(one), ...sidesOf(other)].every(({ d }) => {
    const [a, b] = [one, other].map((ring) => ring.map((point) => dot(point, across(d))));
    return Math.min(Math.max(...a) - Math.min(...b), Math.max(...b) - Math.min(...a)) > SLACK;
  });
}

// ---- numbers as the workbook holds them

/** A number as people type it, with a point or a comma. */
export const readNumber = (text) => (text.trim() === "" ? NaN : Number(text.trim().replace(",", ".")));

/** A length in metres as a cell of a column holds it: rounded to `step` metres, in the unit of the column. */
export function inUnit(metres, column, step = CENTIMETRE) {
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
  const numberOf = (part) => Number(DECIMAL_COMMA.test(part) ? part.replace(",", ".") : part) * (column?.factor || 1);
  const ring = text.split(/[;\n]/).map((one) => one.trim().split(/\s+/).map(numberOf))
    .filter((one) => one.length === 2 && one.every(Number.isFinite));
  if (ring.length > 3 && distance(ring[0], ring.at(-1)) <= 1e-3) ring.pop();
  return ring.length >= 3 ? ring : null;
}

// ---- the picture: points on it in shares of its width, from its lower left corner

export const onPicture = ([x, y], { left, bottom, width, turn }) =>
  turnPoint([x - left, y - bottom], -turn).map((one) => one / width);

export const fromPicture = ([u, v], { left, bottom, width, turn }) => turnPoint([u * width, v * width], turn, [left, bottom]);

/** Place a picture: its width and turn, and a point of it where it belongs. */
export function putPicture(known, at, width, turn) {
  const [left, bottom] = less(at, turnPoint([known[0] * width, known[1] * width], turn));
  return { left, bottom, width, turn };
}
