// Where several pieces come to stand: in line, at equal distances, along the walls of a room. Poses {row, x, y, angle} in metres and degrees.

import { axisOf, boxOf, corners, direction, isInside, roundTo, wholeAngle } from "./plan_geometry.mjs";
import { sidesOf } from "./plan_snap.mjs";

const CENTIMETRE = 0.01;
const STEP = 0.25; // between places that are tried besides: sharp corners, slanted neighbours
const SLACK = 0.011; // by which pieces may overlap: positions are whole centimetres

/** The ways to align: the axis, 0 X and 1 Y, and the share of a piece's box that comes to lie at one place. */
const ALIGNED = { left: [0, 0], centre: [0, 0.5], right: [0, 1], top: [1, 1], middle: [1, 0.5], bottom: [1, 0] };

const shifted = (piece, axis, by) => ({ row: piece.row, [axis ? "y" : "x"]: roundTo((axis ? piece.y : piece.x) + by, CENTIMETRE) });

/** @param {object[]} pieces @param {"left"|"centre"|"right"|"top"|"middle"|"bottom"} how */
export function align(pieces, how) {
  const [axis, share] = ALIGNED[how];
  const at = (box) => box[axis] + share * (box[axis + 2] - box[axis]);
  const to = at(boxOf(pieces.flatMap(corners)));
  return pieces.map((one) => shifted(one, axis, to - at(boxOf(corners(one)))));
}

/** Equal gaps between pieces along an axis; the first and the last stay. */
export function distribute(pieces, axis) {
  const all = pieces.map((piece) => ({ piece, box: boxOf(corners(piece)) })).sort((a, b) => a.box[axis] + a.box[axis + 2] - b.box[axis] - b.box[axis + 2]);
  const size = ({ box }) => box[axis + 2] - box[axis];
  const span = all.at(-1).box[axis + 2] - all[0].box[axis];
  const gap = (span - all.reduce((sum, one) => sum + size(one), 0)) / (all.length - 1);
  let at = all[0].box[axis];
  return all.map((one) => {
    const by = at - one.box[axis];
    at += size(one) + gap;
    return shifted(one.piece, axis, by);
  });
}

/**
 * Stand pieces along the walls of a room: the longer side on the wall, the largest first, along the longest wall first.
 * @param {number[][]} ring corners of the room
 * @param {object[]} pieces {row, breadth, width, axis}; axis: 0 or 1 where Breadth has to run along X or Y, else -1
 * @param {number[][][]} taken convex rings on which nothing may stand
 * @returns {object[]} poses of those that find room
 */
export function standAlongWalls(ring, pieces, taken) {
  const walls = sidesOf(ring).sort((a, b) => b.length - a.length);
  const isLeft = ring.reduce((sum, [x, y], i) => sum + ring.at(i - 1)[0] * y - x * ring.at(i - 1)[1], 0) > 0; // the room, of its sides
  const inward = (d) => (isLeft ? [-d[1], d[0]] : [d[1], -d[0]]);
  const long = (one) => Math.max(one.breadth, one.width);
  const blocked = [...walls.map(({ a, b }) => [a, b]), ...taken].map((one) => [one, boxOf(one)]);
  const fits = (pose) => {
    const [own, at] = [corners(pose), [pose.x, pose.y]];
    const box = boxOf(own);
    return isInside(at, ring) && !blocked.some(([one, its]) => [0, 1].every((i) => box[i] < its[i + 2] && its[i] < box[i + 2]) && overlap(own, one));
  };
  const poses = [];
  for (const piece of [...pieces].sort((a, b) => long(b) - long(a))) {
    const found = firstPose(piece, walls, inward, fits, blocked);
    if (!found) continue;
    poses.push({ row: piece.row, x: found.x, y: found.y, angle: found.angle });
    blocked.push([corners(found), boxOf(corners(found))]);
  }
  return poses;
}

/** The first pose that fits: at the beginning of a wall, or behind something that stands in the way. */
function firstPose(piece, walls, inward, fits, blocked) {
  const dot = ([a, b], [c, d]) => a * c + b * d;
  for (const { a, d, length } of walls) {
    const n = inward(d);
    const angle = wholeAngle(direction([0, 0], n) + (piece.width >= piece.breadth ? 0 : 90)) % 180;
    if (piece.axis >= 0 && axisOf(angle) !== piece.axis) continue;
    const own = corners({ ...piece, x: 0, y: 0, angle });
    const [deep, half] = [n, d].map((way) => Math.max(...own.map((one) => dot(one, way))));
    const behind = blocked.map(([one]) => Math.max(...one.map(([x, y]) => dot([x - a[0], y - a[1]], d))));
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
  const range = (ring, n) => {
    const along = ring.map(([x, y]) => x * n[0] + y * n[1]);
    return [Math.min(...along), Math.max(...along)];
  };
  return [...sidesOf(one), ...sidesOf(other)].every(({ d }) => {
    const n = [-d[1], d[0]];
    const [[a, b], [c, e]] = [range(one, n), range(other, n)];
    return Math.min(b - c, e - a) > SLACK;
  });
}
