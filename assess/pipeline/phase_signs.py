"""Which floors have records that can be compared, and the signs by which the phases of their motions are turned.

Two records are compared where they are along one axis, of one earthquake and on one clock, as far as their files show:

* the files give the same event, start and sampling interval, and both records are corrected or neither is;
* and the start is given to a hundredth of a second, or both are channels of one recorder, or both are of one file.

Where that cannot be shown a record has no sign, and its motions keep the phases as they are: a start to the minute is
no common clock, nor is the motion of the other axis a record along this one. Parallel records of one floor count each
for itself, as they are made at different places of it; a sign is found where two floors at least have such records.
"""

import math
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from assess.model import NEAR_AXIS, angle_between
from assess.motion.record import Motion, Record
from assess.pipeline.demand import Demand

if TYPE_CHECKING:
    from assess.motion.target import Grid

_HUNDREDTHS = re.compile(r":\d\d\.\d\d")
_Recorded = tuple[Demand, float | None, Motion]
"""A floor motion, the azimuth of its record [deg], and its record as treated."""


def find_phase_signs(
    demands: Iterable[Demand], grid: "Grid", azimuth: float | None = None
) -> dict[Demand, tuple[int, ...]]:
    """Return the signs of the floor motions that have any, 1 or -1 by octave of `assess.motion.envelope.octaves`.

    They are relative: those of the strongest motion of an axis are all 1. No factor common to all motions changes them.

    Parameters
    ----------
    demands : iterable of Demand
        All of the building.
    grid : Grid
        The samples that its floors share.
    azimuth : float, optional
        Of axis X, clockwise from north [deg]. A record that points against its axis is turned before it is compared;
        one that is more than 15 deg off is not compared. Where it is unknown, the strongest record gives the direction.
        Records of which none has a direction are taken to point alike.
    """
    groups: dict[Any, list[_Recorded]] = {}
    for one in demands:
        if one.record is not None and one.motion is not None and not one.is_borrowed:
            key = one.axis, find_clock(one.name, one.record)
            groups.setdefault(key, []).append((one, one.record.azimuth_deg, one.motion))
    found: dict[Demand, tuple[int, ...]] = {}
    for (axis, _), group in groups.items():
        found |= _find_signs(group, grid, None if azimuth is None else azimuth + 90 * (axis == "Y"))
    return found


def find_clock(name: str, record: Record) -> tuple[Any, ...]:
    """Return what tells on which clock, and in which earthquake, a record was made: the same for those on one clock.

    `name` is the record as the workbook names it.
    """
    common = (record.event, record.start, record.time_step, record.corrected)
    if _HUNDREDTHS.search(record.start):
        return ("start", *common)
    if record.recorder and (record.event or record.start):
        return ("recorder", record.recorder, *common)
    return ("file", name.partition("#")[0].strip(), record.file, *common)


def _find_signs(group: Sequence[_Recorded], grid: "Grid", along: float | None) -> dict[Demand, tuple[int, ...]]:
    """Return the signs of records on one clock; nothing where they are not of two floors at least."""
    directed = [
        (one, turn, motion) for (one, _, motion), turn in zip(group, _direct(group, along), strict=True) if turn
    ]
    if len({one.floor.floor for one, _, _ in directed}) < 2:
        return {}
    from assess.motion.floor_signs import find_signs
    from assess.motion.target import put_on_grid

    rows = np.stack([turn * put_on_grid(motion, grid) for _, turn, motion in directed])
    signs = find_signs(rows, grid.time_step).tolist()
    return {one: tuple(own) for (one, _, _), own in zip(directed, signs, strict=True)}


def _direct(group: Sequence[_Recorded], along: float | None) -> list[int]:
    """Return 1 for each record that points along a direction [deg], -1 for one that points against it, else 0."""
    known = [(demand.pfa, azimuth) for demand, azimuth, _ in group if azimuth is not None]
    if not known:
        return [1] * len(group)
    axis = max(known)[1] if along is None else along
    return [0 if azimuth is None else _turn(azimuth, axis) for _, azimuth, _ in group]


def _turn(azimuth: float, along: float) -> int:
    if angle_between(azimuth, along) > NEAR_AXIS:
        return 0
    return 1 if math.cos(math.radians(azimuth - along)) > 0 else -1
