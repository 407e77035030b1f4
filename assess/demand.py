"""How each floor shakes: from records and given peaks to one demand per floor, axis and source.

Precedence, as filled: a floor's record on an axis, then its given PFA and PFV. Where one axis alone is known it serves
both, flagged ``one_axis_only``. A PFV that is not given is estimated from T1, flagged ``pfv_estimated``.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from assess.errors import Problem, WorkbookError
from assess.inventory.model import Axis, Floor, FloorRecord, Inventory
from assess.motion.estimate import estimate_pfv
from assess.motion.record import Motion, Record, treat

LOSS_TO_TELL = 0.02
"""Where treatment lowers PFA by more than this share, the report says so."""

LOSS_TO_WARN = 0.1
"""Where it lowers PFA by more than this share, the record may be a corrected one that does not say so."""

FLAGS: Mapping[str, str] = {
    "one_axis_only": "motion of the kind used is known along one axis only; it serves both",
    "pfv_estimated": "PFV was not given: estimated from PFA and the building's period T1",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demand:
    """The motion of one floor along one axis from one source.

    Parameters
    ----------
    floor : Floor
        The floor.
    axis : "X" or "Y"
        The axis that it serves.
    source : "record" or "given"
        Where it comes from.
    pfa, pfv : float
        Peak floor acceleration [m/s2] and velocity [m/s]; `pfv` is NaN where it is unknown.
    name : str
        The record as the workbook names it, else "".
    record, motion : Record, Motion, optional
        The recorded motion, as in the file and as treated.
    flags : tuple of str
        Keys of `FLAGS`.
    """

    floor: Floor
    axis: Axis
    source: Literal["record", "given"]
    pfa: float
    pfv: float
    name: str = ""
    record: Record | None = None
    motion: Motion | None = None
    flags: tuple[str, ...] = ()

    @property
    def loss(self) -> float:
        """Share of the file's own peak that treatment took away [-]; 0 where no record is."""
        return 1 - self.pfa / self.record.file_pfa if self.record and self.record.file_pfa else 0.0


def build_demands(inventory: Inventory, scenario: str) -> dict[tuple[str, Axis], tuple[Demand, ...]]:
    """Return the demands of every floor (by its name) and axis; parallel records give several.

    Raises
    ------
    WorkbookError
        If a floor has no motion of the kind that `scenario` asks for.
    """
    problems: list[Problem] = []
    demands: dict[tuple[str, Axis], tuple[Demand, ...]] = {}
    for floor in inventory.floors:
        by_axis = {axis: _axis_demands(floor, axis, scenario, inventory.building.period) for axis in _AXES}
        if not any(by_axis.values()):
            problems.append(_missing(floor, scenario))
        demands[floor.floor, "X"] = by_axis["X"] or _borrowed(by_axis["Y"], "X")
        demands[floor.floor, "Y"] = by_axis["Y"] or _borrowed(by_axis["X"], "Y")
    if problems:
        raise WorkbookError(problems)
    return demands


_AXES: tuple[Axis, Axis] = ("X", "Y")


def _axis_demands(floor: Floor, axis: Axis, scenario: str, period: float | None) -> tuple[Demand, ...]:
    if scenario in ("as filled", "recorded") and floor.records.get(axis):
        return tuple(_recorded(floor, axis, one) for one in floor.records[axis])
    if scenario in ("as filled", "given") and axis in floor.pfa:
        return (_given(floor, axis, period),)
    return ()


def _recorded(floor: Floor, axis: Axis, one: FloorRecord) -> Demand:
    motion = treat(one.record)
    return Demand(
        floor=floor, axis=axis, source="record", pfa=motion.pfa, pfv=motion.pfv,
        name=one.name, record=one.record, motion=motion,
    )  # fmt: skip


def _given(floor: Floor, axis: Axis, period: float | None) -> Demand:
    pfa, pfv = floor.pfa[axis], floor.pfv.get(axis, math.nan)
    if math.isnan(pfv) and period is not None:
        pfv = estimate_pfv(pfa, period)
        return Demand(floor=floor, axis=axis, source="given", pfa=pfa, pfv=pfv, flags=("pfv_estimated",))
    return Demand(floor=floor, axis=axis, source="given", pfa=pfa, pfv=pfv)


def _borrowed(demands: tuple[Demand, ...], axis: Axis) -> tuple[Demand, ...]:
    return tuple(replace(demand, axis=axis, flags=(*demand.flags, "one_axis_only")) for demand in demands)


def _missing(floor: Floor, scenario: str) -> Problem:
    wanted = {"recorded": "record", "given": "PFA"}.get(scenario, "record and no PFA")
    message = f"floor '{floor.floor}' has no {wanted}, which the scenario '{scenario}' asks for."
    return Problem("error", "Floors", f"A{floor.row}", message, "Fill it in, or choose another scenario.")
