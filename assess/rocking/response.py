"""How one block moves under one motion, step by step: what `assess rock` draws.

Importing this imports numba: do so where a block is to be rocked.
"""

import math
from dataclasses import dataclass

import numpy as np

from assess.arrays import FloatArray
from assess.rocking import block, kernel
from assess.rocking.ensemble import Bodies, check_motions, divide

MOST_TRACED = 10_000_000
"""Steps of which the path is kept, 240 MB; the outcome is that of all."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response:
    """What one block did under one motion.

    * `critical_angle`, `frequency_parameter`, `restitution`: the block's alpha [rad], p [rad/s] and eta [-].
    * `overturned`, `rotation`, `fall_time`, `impacts`: as of `assess.rocking.ensemble.Rocking`, for one pair.
    * `times`, `theta` (t,): path of the rotation [s, rad], whose points are unevenly spaced: the ends of steps,
      impacts, and both ends of each rest. It ends where the block has overturned, at pi/2; else with the motion, or,
      where the block is still rocking then, up to a step before it is known that it can no longer fall. Peaks lie
      between points, so that the largest of `theta` may be below `rotation`.
    * `impact_times` (impacts,): [s]; an impact after which the block rests is put at the next sample.
    """

    critical_angle: float
    frequency_parameter: float
    restitution: float
    overturned: bool
    rotation: float
    fall_time: float
    impacts: int
    times: FloatArray
    theta: FloatArray
    impact_times: FloatArray


def follow_block(
    breadth: float,
    height: float,
    acceleration: FloatArray,
    time_step: float,
    *,
    restitution: float = math.nan,
    centre: float = block.MIDDLE,
) -> Response:
    """Integrate one block under one motion, as `assess.rocking.ensemble.rock_blocks` does, and keep its path.

    * `breadth`, `height`: sizes of the block [m]; breadth is the side parallel to the motion.
    * `acceleration` (n,): base acceleration [m/s2].
    * `time_step`: [s].
    * `restitution`: angular velocity after an impact over that before it [-], 0 to 1; NaN is that of equal angular
      momentum.
    * `centre`: height of the centre of gravity as a share of the block's [-].

    Raises ValueError as `rock_blocks`.
    """
    body = Bodies.of(breadth, height, restitution, centre, 1.0)
    motions = check_motions(np.asarray(acceleration)[np.newaxis], time_step)
    parts = int(body.count_parts(time_step)[0])
    motions, step = divide(motions, parts), time_step / parts
    blocks, outcome = body.to_kernel(step), np.array([[[0.0, -1.0, 0.0]]])
    # The first pass counts the steps, the second keeps them, but for the last: together they take milliseconds.
    taken = kernel.rock(blocks, motions, 0, 1, outcome, np.zeros((0, 3))) // kernel.LANES
    trace = np.zeros((min(max(taken - 1, 0), MOST_TRACED), 3))
    kernel.rock(blocks, motions, 0, 1, outcome, trace)
    rotation, fall, struck = (float(value) for value in outcome[0, 0])
    path = _build_path(motions[0], blocks[0, 0, 3], trace, taken - 1 <= MOST_TRACED, fall, int(struck))
    times, theta, impact_times = path
    return Response(
        critical_angle=float(blocks[0, 0, 0]),
        frequency_parameter=float(block.frequency_parameter(breadth, height, centre)),
        restitution=float(body.restitution[0, 0]), overturned=fall >= 0, rotation=rotation,
        fall_time=fall * step if fall >= 0 else math.nan, impacts=int(struck), times=times * step, theta=theta,
        impact_times=impact_times * step,
    )  # fmt: skip


def _build_path(
    motion: FloatArray, threshold: float, trace: FloatArray, is_whole: bool, fall: float, struck: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times, theta and times of impacts [samples] of a trace, with zeros from rest to rest.

    What the last step brought, the fall, or the impact after which the block rests, is not in the trace, and is added
    where that `is_whole`. From the end of the motion on, one sample after its last, the last step shows that the block
    can no longer fall, and the path ends before it.
    """
    own, last = motion[:-2], motion.size - 3.0
    at = int((np.abs(own) > threshold).argmax())
    if abs(own[at]) <= threshold:  # it never starts
        return np.array([0.0, last]), np.zeros(2), np.zeros(0)
    before = own[at - 1]
    start = 0.0 if at == 0 else float(at - 1 + (math.copysign(threshold, own[at]) - before) / (own[at] - before))
    times, theta = np.append(start, trace[:, 0]), np.append(0.0, trace[:, 1])
    ends = np.floor(times) + 1  # of the steps from each point; where the next is later, the block has been at rest
    impact_times = np.minimum(times[1:], ends[:-1])[np.diff(trace[:, 2], prepend=0.0) > 0]
    rests = np.flatnonzero(times[1:] > ends[:-1])
    times, theta = np.insert(times, rests + 1, ends[rests]), np.insert(theta, rests + 1, 0.0)
    rest = np.zeros(1 if start > 0 else 0)
    times, theta = np.append(rest, times), np.append(rest, theta)
    if not is_whole:
        return times, theta, impact_times
    if fall >= 0:
        return np.append(times, fall), np.append(theta, math.copysign(math.pi / 2, theta[-1])), impact_times
    end = math.floor(times[-1]) + 1.0
    strikes = struck > impact_times.size
    added = ([end] if strikes or end <= last else []) + ([last] if end < last else [])
    impact_times = np.append(impact_times, end) if strikes else impact_times
    return np.append(times, added), np.append(theta, np.zeros(len(added))), impact_times
