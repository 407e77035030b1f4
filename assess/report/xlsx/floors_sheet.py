"""The sheet Floors: the motion that serves each floor and axis, to be edited, with whether it was.

It has one line a floor, then one for every further record that serves a floor. Where several records serve a floor, the
one with the largest peak that rules the formula, along each axis, stands in the floor's own line, which formulas look
up by its name; the others stand in lines of the same name below the last floor.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _
from assess.model import AXES
from assess.report.content import Content, order_floors
from assess.report.say.ground import describe_source, factors
from assess.report.xlsx import charts
from assess.report.xlsx.item_formulas import FLOOR_AT, FLOOR_KEYS, differs, literal
from assess.report.xlsx.pen import HEAD, LINE, Pen, count_lines
from assess.results import FloorRow, MotionRow, Results

_WIDTHS = {"floor": 12, "name": 22, "pfa": 12, "pfv": 14, "source": 44, "elevation": 12, "edited": 10}
_CODES = {"pfa": "0.000", "pfv": "0.0"}


@dataclass(frozen=True, slots=True)
class MotionLine:
    """One line: the motion of a floor along each axis that has one.

    `further` are the lines, from 0, of its other records; it is empty in a line that is not the floor's own.
    """

    floor: FloorRow
    motions: Mapping[str, MotionRow]
    further: tuple[int, ...] = ()


def list_lines(results: Results) -> list[MotionLine]:
    """Return the lines in order; of parallel motions, that of the largest ruling peak first."""
    peak = attrgetter({"pfa": "pfa_g", "pfv": "pfv_cm_s"}[results.formula.ruled_by])

    def sort(motions: Sequence[MotionRow]) -> list[MotionRow]:
        largest = max(motions, key=lambda one: round(peak(one) or 0.0, 9), default=None)
        return sorted(motions, key=lambda one: one is not largest)

    floors = order_floors(results.floor_rows)
    own: list[MotionLine] = []
    below: list[MotionLine] = []
    for floor in floors:
        motions = {axis: sort(results.motions_of(floor.floor, axis)) for axis in AXES}
        first = len(floors) + len(below)
        below += [
            MotionLine(floor, {axis: rows[at] for axis, rows in motions.items() if at < len(rows)})
            for at in range(1, max(map(len, motions.values())))
        ]
        places = tuple(range(first, len(floors) + len(below)))
        own.append(MotionLine(floor, {axis: rows[0] for axis, rows in motions.items() if rows}, places))
    return [*own, *below]


def write_floors(pen: Pen, page: Any, content: Content) -> None:
    """Write the motions: Items and Summary follow what is edited here."""
    run, rows = content.run, len(content.floors)
    lines, ruling = list_lines(run), run.formula.ruled_by
    heads = (
        (_("Floor"), ""), (_("Name"), ""), (_("PFA X"), "g"), (_("PFV X"), "cm/s"), (_("Source X"), ""),
        (_("PFA Y"), "g"), (_("PFV Y"), "cm/s"), (_("Source Y"), ""), (_("Elevation"), "m"),
        (_("X since the run"), ""), (_("Y since the run"), ""), (_("PFA X as run"), "g"), (_("PFV X as run"), "cm/s"),
        (_("PFA Y as run"), "g"), (_("PFV Y as run"), "cm/s"),
        (_("PFA X of the stronger record"), "g"), (_("PFV X of that record"), "cm/s"),
        (_("PFA Y of the stronger record"), "g"), (_("PFV Y of that record"), "cm/s"),
    )  # fmt: skip
    labels = [f"{label} [{unit}]" if unit else label for label, unit in heads]
    pen.heads(page, labels, [_WIDTHS.get(key.split("_")[0], 20) for key in FLOOR_KEYS])
    edit_here = _("Edit the PFA and PFV here: rows that were not simulated follow; simulated rows on the floor say "
                  "'run again' and leave all counts. Where several records serve a floor, the one with the largest "
                  "{peak} stands in its line; the others follow below the last floor. Simulated rows show the record "
                  "that governed the run, other rows go by the largest {peak}. Interpolated floors and those of a "
                  "code's profile hold numbers as run: they do not follow when another floor is edited.",
                  peak=ruling.upper())  # written now: what is above the row being written is left out  # fmt: skip
    page.write_comment(0, FLOOR_AT["pfa_X"], edit_here, {"x_scale": 2, "y_scale": 1.5})
    for row, line in enumerate(lines, HEAD):
        texts = (line.floor.name, *map(_say_source, line.motions.values()))
        heights = map(count_lines, texts, (_WIDTHS["name"], _WIDTHS["source"], _WIDTHS["source"]))
        page.set_row(row, LINE * max(heights))
        pen.put(page, row, FLOOR_AT["floor"], line.floor.floor, pen.style("text"))
        pen.put(page, row, FLOOR_AT["name"], line.floor.name, pen.style("text"))
        for axis in line.motions:
            records = {HEAD + at: lines[at].motions[axis] for at in line.further if axis in lines[at].motions}
            _write_motion(pen, page, {row: line.motions[axis], **records}, ruling, is_own=row < HEAD + rows)
        pen.put(page, row, FLOOR_AT["elevation"], line.floor.elevation_m, pen.style("plain"))
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.autofilter(0, 0, len(lines), len(FLOOR_KEYS) - 1)
    for axis in AXES:
        at = FLOOR_AT[f"pfa_{axis}"]
        page.data_validation(HEAD, at, len(lines), at, {"validate": "decimal", "criteria": ">=", "value": 0})
    # hidden: the run's motions, and what shows edits where no row asks for a new run
    has_brackets = any(one.anchor.bracket_capacity_kn is not None for one in run.item_rows)
    first = "pfa_run_X" if run.has_simulated or has_brackets else "edited_X"
    page.set_column(FLOOR_AT[first], len(FLOOR_KEYS) - 1, 10, None, {"hidden": True})
    tops: dict[str, int] = {axis: FLOOR_AT[f"pfa_top_{axis}"] for axis in AXES}
    charts.add_motion(pen, page, (HEAD + len(lines) + 1, 0), (HEAD, HEAD + rows - 1), tops)


def _write_motion(pen: Pen, page: Any, records: Mapping[int, MotionRow], ruling: str, *, is_own: bool) -> None:
    """Write the motion of a line along an axis, as run and now, and whether it was edited.

    `records` are those of the axis by their rows, that of the line first; `is_own`: in the floor's own line, which
    also holds the peaks of the record of the largest ruling peak.
    """
    row, motion = next(iter(records.items()))
    axis, other = motion.axis, "Y" if motion.axis == "X" else "X"
    values = {"pfa": motion.pfa_g, "pfv": motion.pfv_cm_s}
    for peak, value in values.items():
        at, formula = FLOOR_AT[f"{peak}_{axis}"], ""
        if motion.is_borrowed:  # what serves this axis is the other one's: it follows when that is edited
            cell = _cell(f"{peak}_{other}", row)
            formula = f'=IF({cell}="","",{cell})'
        elif peak == "pfv" and motion.pfv_follows and motion.pfv_cm_s and motion.pfa_g:
            formula = f"={_cell(f'pfa_{axis}', row)}*{motion.pfv_cm_s / motion.pfa_g!r}"
        if formula:
            page.write_formula(row, at, formula, pen.style("live", _CODES[peak]), "" if value is None else value)
        else:
            pen.put(page, row, at, value, pen.style("input", _CODES[peak]))
        pen.put(page, row, FLOOR_AT[f"{peak}_run_{axis}"], value)
    pen.put(page, row, FLOOR_AT[f"source_{axis}"], _say_source(motion), pen.style("text"))
    tests = []
    for at, one in records.items():
        pfa, pfv, pfa_run, pfv_run = (_cell(f"{name}_{axis}", at) for name in ("pfa", "pfv", "pfa_run", "pfv_run"))
        # where PFV was not known as run, any value differs
        tests += [differs(pfa, pfa_run), f'{pfv}<>""' if one.pfv_cm_s is None else differs(pfv, pfv_run)]
    edited = f'=IF(IFERROR(OR({",".join(tests)}),TRUE),{literal(pen.terms.edited)},"")'
    page.write_formula(row, FLOOR_AT[f"edited_{axis}"], edited, pen.style("warning"), "")
    if not is_own:
        return
    peaks = sorted(values, key=lambda peak: peak != ruling)
    first, second = ([_cell(f"{peak}_{axis}", at) for at in records] for peak in peaks)
    if len(records) == 1:
        formulas = [f'=IF({cell}="","",{cell})' for cell in (*first, *second)]
    else:
        found = '""'
        for peak, beside in zip(reversed(first), reversed(second), strict=True):
            found = f'IF({peak}={_cell(f"{ruling}_top_{axis}", row)},IF({beside}="","",{beside}),{found})'
        formulas = [f'=IF(COUNT({",".join(first)})=0,"",MAX({",".join(first)}))', f"={found}"]
    for peak, formula in zip(peaks, formulas, strict=True):
        known = values[peak]
        page.write_formula(row, FLOOR_AT[f"{peak}_top_{axis}"], formula, None, "" if known is None else known)


def _cell(key: str, row: int) -> str:
    return f"{xl_col_to_name(FLOOR_AT[key])}{row + 1}"


def _say_source(motion: MotionRow) -> str:
    detail = factors(motion) if motion.profile else motion.record
    source = describe_source(motion)
    return _("{source}: {detail}", source=source, detail=detail) if detail else source
