"""The sheet Floors: the motion that serves each floor and axis, to be edited, and whether it was."""

from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.demand import AXES, Demand
from assess.inventory.model import Axis
from assess.language import gettext as _
from assess.methods import kaneko_hayashi as kh
from assess.methods._method import ALIKE
from assess.motion.estimate import HIGHEST_FLOOR_FREQUENCY
from assess.report.content import Content
from assess.report.data import edge
from assess.report.findings.motions import describe_source, factors
from assess.report.xlsx import charts
from assess.report.xlsx.formulas import EDITED_LETTERS, edited_motion
from assess.report.xlsx.items import HEAD
from assess.report.xlsx.pen import LINE, Pen, count_lines, with_unit
from assess.units import GRAVITY

_COLUMNS = {"X": 2, "Y": 5}
"""Where PFA, PFV and source of an axis begin."""

_AS_RUN = {"X": 11, "Y": 13}
"""Where PFA and PFV of an axis as run begin: hidden, and there where pieces were verified."""

_WIDTHS = [12, 22, 12, 14, 44, 12, 14, 44, 12, 10, 10, 20, 20, 20, 20]
_PLAIN = 9
"""Columns where no piece was verified."""


def write_floors(pen: Pen, page: Any, content: Content) -> None:
    """Write the motion that serves each floor and axis, to be edited: Items and Summary follow."""
    has_run, period = bool(content.assessment.joints), content.assessment.inventory.building.period
    heads = _heads()[: None if has_run else _PLAIN]
    pen.heads(page, heads, _WIDTHS[: len(heads)])
    _comment(page)  # now: what is above the row being written is left out
    for row, floor_page in enumerate(content.floors, HEAD):
        demands = {axis: _governing(content, floor_page.floor.floor, axis) for axis in AXES}
        texts = (floor_page.floor.name, *map(_source, demands.values()))
        page.set_row(row, LINE * max(map(count_lines, texts, (_WIDTHS[1], _WIDTHS[4], _WIDTHS[7]))))
        pen.put(page, row, 0, floor_page.floor.floor, pen.wrap)
        pen.put(page, row, 1, floor_page.floor.name, pen.wrap)
        for axis, demand in demands.items():
            _write_demand(pen, page, row, _COLUMNS[axis], demand, period)
            if has_run:
                _write_as_run(pen, page, row, demand, counts_pfv=content.assessment.suite is None)
        pen.put(page, row, 8, floor_page.floor.elevation, pen.top)
    _dress(page, len(content.floors), len(heads))
    if has_run:
        page.set_column(_AS_RUN["X"], _AS_RUN["Y"] + 1, 10, None, {"hidden": True})
    first, last = HEAD, HEAD + len(content.floors) - 1
    charts.add_motion(pen, page, (last + 2, 0), (first, last), _COLUMNS)


def _heads() -> list[str]:
    return [
        _("Floor"), _("Name"), with_unit(_("PFA X"), "g"), with_unit(_("PFV X"), "cm/s"), _("Source X"),
        with_unit(_("PFA Y"), "g"), with_unit(_("PFV Y"), "cm/s"), _("Source Y"), with_unit(_("Elevation"), "m"),
        _("X since the run"), _("Y since the run"), with_unit(_("PFA X as run"), "g"),
        with_unit(_("PFV X as run"), "cm/s"), with_unit(_("PFA Y as run"), "g"), with_unit(_("PFV Y as run"), "cm/s"),
    ]  # fmt: skip


def _comment(page: Any) -> None:
    edit_here = _(
        "Edit the PFA and PFV here: Items and Summary follow. Where several records serve an axis, the one with the "
        "largest PFA stands here; the sheet Motions lists all. Interpolated floors and those of a code's profile hold "
        "numbers as run: they do not follow when another floor is edited."
    )
    page.write_comment(0, _COLUMNS["X"], edit_here, {"x_scale": 2, "y_scale": 1.5})


def _dress(page: Any, floors: int, columns: int) -> None:
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.autofilter(0, 0, floors, columns - 1)
    for axis in AXES:
        at = _COLUMNS[axis]
        page.data_validation(HEAD, at, floors, at, {"validate": "decimal", "criteria": ">=", "value": 0})


def _write_as_run(pen: Pen, page: Any, row: int, demand: Demand, *, counts_pfv: bool) -> None:
    """Write the motion of an axis as run, and whether it was edited since; PFV matters where no record is known."""
    now, as_run = _COLUMNS[demand.axis], _AS_RUN[demand.axis]
    pfv = edge(demand.pfv, "cm/s")
    pen.put(page, row, as_run, edge(demand.pfa, "g"))
    pen.put(page, row, as_run + 1, pfv)
    pfa_cell, pfv_cell, pfa_run, pfv_run = (
        f"{xl_col_to_name(at)}{row + 1}" for at in (now, now + 1, as_run, as_run + 1)
    )
    counts = counts_pfv and demand.motion is None
    cells = (pfa_cell, pfv_cell, pfa_run, pfv_run)
    formula = edited_motion(pen.terms, cells, counts_pfv=counts, had_pfv=pfv is not None)
    page.write_formula(f"{EDITED_LETTERS[demand.axis]}{row + 1}", formula, pen.warning, "")


def _governing(content: Content, floor: str, axis: Axis) -> Demand:
    return max(content.assessment.demands[floor, axis], key=lambda demand: round(demand.pfa / GRAVITY, ALIKE))


def _write_demand(pen: Pen, page: Any, row: int, at: int, demand: Demand, period: float | None) -> None:
    if demand.is_borrowed:  # what serves this axis is the other one's: it follows when that is edited
        other = _COLUMNS["Y" if demand.axis == "X" else "X"]
        values = (edge(demand.pfa, "g"), edge(demand.pfv, "cm/s"))
        for place, (value, code) in enumerate(zip(values, ("0.000", "0.0"), strict=True)):
            cell = f"{xl_col_to_name(other + place)}{row + 1}"
            formula = f'=IF({cell}="","",{cell})'
            look = pen.style("Calculation", num_format=code)
            page.write_formula(row, at + place, formula, look, "" if value is None else value)
        pen.put(page, row, at + 2, _source(demand), pen.wrap)
        return
    page.write_number(row, at, edge(demand.pfa, "g"), pen.style("Input", num_format="0.000"))
    pfv = edge(demand.pfv, "cm/s")
    if "pfv_estimated" in demand.flags and period is not None and not demand.between:
        cell = f"{xl_col_to_name(at)}{row + 1}"
        formula = f"={cell}*{kh.G!r}/(2*PI()*{min(1 / period, HIGHEST_FLOOR_FREQUENCY)!r})"
        page.write_formula(row, at + 1, formula, pen.style("Calculation", num_format="0.0"), pfv)
    else:
        pen.put(page, row, at + 1, pfv, pen.style("Input", num_format="0.0"))
    pen.put(page, row, at + 2, _source(demand), pen.wrap)


def _source(demand: Demand) -> str:
    if demand.profile:
        return _("{source}: {detail}", source=describe_source(demand), detail=factors(demand))
    if demand.name:
        return _("{source}: {detail}", source=describe_source(demand), detail=demand.name)
    return describe_source(demand)
