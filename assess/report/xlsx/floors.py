"""The sheet Floors: the motion that serves each floor and axis, to be edited, and whether it was."""

from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.demand import AXES, Demand
from assess.inventory.model import Axis
from assess.methods import kaneko_hayashi as kh
from assess.methods._method import ALIKE
from assess.motion.estimate import HIGHEST_FLOOR_FREQUENCY
from assess.report.content import Content
from assess.report.data import edge
from assess.report.motions import describe_source, factors
from assess.report.xlsx.formulas import EDITED_LETTERS, edited_motion
from assess.report.xlsx.items import HEAD
from assess.report.xlsx.pen import INPUT, Pen
from assess.units import GRAVITY

_EDIT_HERE = (
    "Edit the PFA and PFV here: Items and Summary follow. Where several records serve an axis, the one with the "
    "largest PFA stands here; the sheet Motions lists all. Interpolated floors and those of a code's profile hold "
    "numbers as run: they do not follow when another floor is edited."
)

_COLUMNS = {"X": 2, "Y": 5}
"""Where PFA, PFV and source of an axis begin."""

_AS_RUN = {"X": 11, "Y": 13}
"""Where PFA and PFV of an axis as run begin: hidden, and there where pieces were verified."""


def write_floors(pen: Pen, page: Any, content: Content) -> None:
    """Write the motion that serves each floor and axis, to be edited: Items and Summary follow."""
    has_run, period = bool(content.assessment.joints), content.assessment.inventory.building.period
    heads = ["Floor", "Name", "PFA X [g]", "PFV X [cm/s]", "Source X", "PFA Y [g]", "PFV Y [cm/s]", "Source Y",
             "Elevation [m]"]  # fmt: skip
    widths = [12, 22, 12, 14, 60, 12, 14, 60, 12]
    if has_run:
        heads += ["X since the run", "Y since the run", "PFA X as run [g]", "PFV X as run [cm/s]", "PFA Y as run [g]",
                  "PFV Y as run [cm/s]"]  # fmt: skip
        widths += [10, 10, 20, 20, 20, 20]
    pen.heads(page, heads, widths)
    for row, floor_page in enumerate(content.floors, HEAD):
        pen.put(page, row, 0, floor_page.floor.floor)
        pen.put(page, row, 1, floor_page.floor.name)
        for axis in AXES:
            demand = _governing(content, floor_page.floor.floor, axis)
            _write_demand(pen, page, row, _COLUMNS[axis], demand, period)
            if has_run:
                _write_as_run(pen, page, row, demand, counts_pfv=content.assessment.suite is None)
        pen.put(page, row, 8, floor_page.floor.elevation)
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.write_comment("C1", _EDIT_HERE, {"x_scale": 2})
    if has_run:
        page.set_column(_AS_RUN["X"], _AS_RUN["Y"] + 1, 10, None, {"hidden": True})


def _write_as_run(pen: Pen, page: Any, row: int, demand: Demand, *, counts_pfv: bool) -> None:
    """Write the motion of an axis as run, and whether it was edited since; PFV matters where no record is known."""
    now, as_run = _COLUMNS[demand.axis], _AS_RUN[demand.axis]
    pfv = edge(demand.pfv, "cm/s")
    pen.put(page, row, as_run, edge(demand.pfa, "g"))
    pen.put(page, row, as_run + 1, pfv)
    cells = [f"{xl_col_to_name(at)}{row + 1}" for at in (now, now + 1, as_run, as_run + 1)]
    counts = counts_pfv and demand.motion is None
    formula = edited_motion(*cells, counts_pfv=counts, had_pfv=pfv is not None)
    page.write_formula(f"{EDITED_LETTERS[demand.axis]}{row + 1}", formula, pen.void, "")


def _governing(content: Content, floor: str, axis: Axis) -> Demand:
    return max(content.assessment.demands[floor, axis], key=lambda demand: round(demand.pfa / GRAVITY, ALIKE))


def _write_demand(pen: Pen, page: Any, row: int, at: int, demand: Demand, period: float | None) -> None:
    if demand.is_borrowed:  # what serves this axis is the other one's: it follows when that is edited
        other = _COLUMNS["Y" if demand.axis == "X" else "X"]
        values = (edge(demand.pfa, "g"), edge(demand.pfv, "cm/s"))
        for place, (value, code) in enumerate(zip(values, ("0.000", "0.0"), strict=True)):
            cell = f"{xl_col_to_name(other + place)}{row + 1}"
            formula = f'=IF({cell}="","",{cell})'
            page.write_formula(row, at + place, formula, pen.format(code), "" if value is None else value)
        pen.put(page, row, at + 2, _source(demand))
        return
    form = pen.format("0.000", **INPUT)
    page.write_number(row, at, edge(demand.pfa, "g"), form)
    pfv = edge(demand.pfv, "cm/s")
    if "pfv_estimated" in demand.flags and period is not None and not demand.between:
        cell = f"{xl_col_to_name(at)}{row + 1}"
        formula = f"={cell}*{kh.G!r}/(2*PI()*{min(1 / period, HIGHEST_FLOOR_FREQUENCY)!r})"
        page.write_formula(row, at + 1, formula, pen.format("0.0"), pfv)
    else:
        pen.put(page, row, at + 1, pfv, pen.format("0.0", **INPUT))
    pen.put(page, row, at + 2, _source(demand))


def _source(demand: Demand) -> str:
    if demand.profile:
        return f"{describe_source(demand)}: {factors(demand)}"
    return describe_source(demand) + (f": {demand.name}" if demand.name else "")
