"""The sheets on motions: Floors, to be edited, with whether it was; Motions, all of them; Verification, their fit."""

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.fields import MOTION_FIELDS
from assess.i18n import gettext as _
from assess.model import AXES
from assess.report import words
from assess.report.content import Content
from assess.report.say.ground import describe_origin, describe_source, describe_treatment, factors
from assess.report.xlsx import charts
from assess.report.xlsx.item_formulas import FLOOR_AT, FLOOR_KEYS, edited_motion, top_motion
from assess.report.xlsx.items_sheet import HEAD, has_brackets
from assess.report.xlsx.motion_lines import list_lines
from assess.report.xlsx.pen import COUNT, LINE, Column, Pen, count_lines, of_field, with_unit
from assess.results import MotionRow

_WIDTHS = {"floor": 12, "name": 22, "pfa": 12, "pfv": 14, "source": 44, "elevation": 12, "edited": 10}
_CODES = {"pfa": "0.000", "pfv": "0.0"}


def write_floors(pen: Pen, page: Any, content: Content) -> None:
    """Write the motion that serves each floor and axis, to be edited: Items and Summary follow."""
    lines, rows = list_lines(content.run), len(content.floors)
    pen.heads(page, _heads(), [_WIDTHS.get(key.split("_")[0], 20) for key in FLOOR_KEYS])
    _comment(page, content.run.formula.ruled_by)  # now: what is above the row being written is left out
    for row, line in enumerate(lines, HEAD):
        floor, motions = line.floor, line.motions
        texts = (floor.name, *map(_source, motions.values()))
        heights = map(count_lines, texts, (_WIDTHS["name"], _WIDTHS["source"], _WIDTHS["source"]))
        page.set_row(row, LINE * max(heights))
        pen.put(page, row, FLOOR_AT["floor"], floor.floor, pen.style("text"))
        pen.put(page, row, FLOOR_AT["name"], floor.name, pen.style("text"))
        for axis, motion in motions.items():
            further = [at for at in line.further if axis in lines[at].motions]
            _write_motion(pen, page, row, motion)
            _write_as_run(pen, page, row, [motion, *(lines[at].motions[axis] for at in further)], further)
            if row < HEAD + rows:
                _write_top(page, row, motion, further, content.run.formula.ruled_by)
        pen.put(page, row, FLOOR_AT["elevation"], floor.elevation_m, pen.style("plain"))
    _dress(page, len(lines), has_edits=content.run.has_simulated or has_brackets(content.run))
    tops: dict[str, int] = {axis: FLOOR_AT[f"pfa_top_{axis}"] for axis in AXES}
    charts.add_motion(pen, page, (HEAD + len(lines) + 1, 0), (HEAD, HEAD + rows - 1), tops)


def _heads() -> list[str]:
    return [
        _("Floor"), _("Name"), with_unit(_("PFA X"), "g"), with_unit(_("PFV X"), "cm/s"), _("Source X"),
        with_unit(_("PFA Y"), "g"), with_unit(_("PFV Y"), "cm/s"), _("Source Y"), with_unit(_("Elevation"), "m"),
        _("X since the run"), _("Y since the run"), with_unit(_("PFA X as run"), "g"),
        with_unit(_("PFV X as run"), "cm/s"), with_unit(_("PFA Y as run"), "g"), with_unit(_("PFV Y as run"), "cm/s"),
        with_unit(_("PFA X of the stronger record"), "g"), with_unit(_("PFV X of that record"), "cm/s"),
        with_unit(_("PFA Y of the stronger record"), "g"), with_unit(_("PFV Y of that record"), "cm/s"),
    ]  # fmt: skip


def _comment(page: Any, ruling: str) -> None:
    edit_here = _(
        "Edit the PFA and PFV here: rows that were not simulated follow; simulated rows on the floor say 'run again' "
        "and leave all counts. Where several records serve a floor, the one with the largest {peak} stands in its "
        "line; the others follow below the last floor. Simulated rows show the record that governed the run, other "
        "rows go by the largest {peak}. Interpolated floors and those of a code's profile hold numbers as run: they "
        "do not follow when another floor is edited.",
        peak=ruling.upper(),
    )
    page.write_comment(0, FLOOR_AT["pfa_X"], edit_here, {"x_scale": 2, "y_scale": 1.5})


def _dress(page: Any, lines: int, *, has_edits: bool) -> None:
    """Freeze, filter, hide what holds the run's motions, and what shows edits where no row asks for a new run."""
    last = len(FLOOR_KEYS) - 1
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.autofilter(0, 0, lines, last)
    for axis in AXES:
        at = FLOOR_AT[f"pfa_{axis}"]
        page.data_validation(HEAD, at, lines, at, {"validate": "decimal", "criteria": ">=", "value": 0})
    first = "pfa_run_X" if has_edits else "edited_X"
    page.set_column(FLOOR_AT[first], last, 10, None, {"hidden": True})


def _write_motion(pen: Pen, page: Any, row: int, motion: MotionRow) -> None:
    axis, other = motion.axis, "Y" if motion.axis == "X" else "X"
    for peak, value in (("pfa", motion.pfa_g), ("pfv", motion.pfv_cm_s)):
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
    pen.put(page, row, FLOOR_AT[f"source_{axis}"], _source(motion), pen.style("text"))


def _write_as_run(pen: Pen, page: Any, row: int, motions: Sequence[MotionRow], further: Sequence[int]) -> None:
    """Write the motion of an axis as run, and whether it, or one of the further lines, was edited since."""
    axis = motions[0].axis
    pen.put(page, row, FLOOR_AT[f"pfa_run_{axis}"], motions[0].pfa_g)
    pen.put(page, row, FLOOR_AT[f"pfv_run_{axis}"], motions[0].pfv_cm_s)
    names = ("pfa", "pfv", "pfa_run", "pfv_run")
    cells = [{name: _cell(f"{name}_{axis}", at) for name in names} for at in (row, *(HEAD + at for at in further))]
    formula = edited_motion(
        pen.terms, [(own, one.pfv_cm_s is not None) for own, one in zip(cells, motions, strict=True)]
    )
    page.write_formula(row, FLOOR_AT[f"edited_{axis}"], formula, pen.style("warning"), "")


def _write_top(page: Any, row: int, motion: MotionRow, further: Sequence[int], ruling: str) -> None:
    """Write the peaks of the record of the largest ruling peak along an axis: as run, that of the floor's own line."""
    axis, rows = motion.axis, (row, *(HEAD + at for at in further))
    other = "pfa" if ruling == "pfv" else "pfv"
    first, second = ([_cell(f"{peak}_{axis}", at) for at in rows] for peak in (ruling, other))
    values = {"pfa": motion.pfa_g, "pfv": motion.pfv_cm_s}
    for peak, formula in zip(
        (ruling, other), top_motion(first, second, _cell(f"{ruling}_top_{axis}", row)), strict=True
    ):
        value = values[peak]
        page.write_formula(row, FLOOR_AT[f"{peak}_top_{axis}"], formula, None, "" if value is None else value)


def _cell(key: str, row: int) -> str:
    return f"{xl_col_to_name(FLOOR_AT[key])}{row + 1}"


def _source(motion: MotionRow) -> str:
    detail = factors(motion) if motion.profile else motion.record
    source = describe_source(motion)
    return _("{source}: {detail}", source=source, detail=detail) if detail else source


def _of_motion(key: str, width: int = 10, **more: Any) -> Column:
    field = next(one for one in MOTION_FIELDS if one.key == key)
    return of_field(field, width=width, **more)


def write_motions(pen: Pen, page: Any, content: Content) -> None:
    """Write every motion, with what was done to it."""
    columns = [
        Column(_("Floor"), 9, lambda one: one.floor),
        _of_motion("axis", 6),
        Column(_("Source"), 30, describe_source),
        Column(_("Record"), 30, lambda one: one.record),
        Column(_("Computed from"), 36, lambda one: "" if one.has_record else describe_origin(one)),
        *map(_of_motion, ("height_ratio", "amplification", "pfa_g", "pfv_cm_s", "pfa_file_g")),
        _of_motion("station", 24),
        _of_motion("event", 24),
        _of_motion("azimuth_deg"),
        Column(_("Treatment"), 60, describe_treatment),
    ]
    pen.listing(page, columns, [one for floor in content.floors for one in floor.motions])


_FIT = (
    "matched_to_s", "mean_deviation", "worst_deviation", "worst_period_s", "pfa_ratio", "pfa_scatter", "pfv_ratio",
    "pfv_scatter", "spectrum_scatter",
)  # fmt: skip


def write_verification(pen: Pen, page: Any, content: Content) -> None:
    """Write the motions of every floor and axis under which pieces were simulated, and how they meet their target."""
    suite, seed = content.run.provenance.suite, content.run.settings.seed

    def kind(one: MotionRow) -> str:
        if suite is None:
            return _("assumed") if one.ensemble and one.ensemble.assumed_motion else _("recorded")
        folder = words.cut(suite.folder, 60)
        return _("suite {folder}, scaled", folder=folder) if suite.is_scaled else _("suite {folder}", folder=folder)

    columns = [
        Column(_("Floor"), 9, lambda one: one.floor),
        _of_motion("axis", 6),
        Column(_("Source"), 34, describe_source),
        Column(_("Record"), 30, lambda one: one.record),
        Column(_("Motion"), 14, kind),
        _of_motion("ensemble_motions", 9),
        Column(_("Seed"), 8, lambda _one: None if suite else seed, "0"),
        *(_of_motion(f"ensemble_fit_{name}") for name in _FIT),
        Column(_("Rows"), 8, lambda one: one.ensemble.cases, COUNT),
        Column(_("Rows that overturn under the record"), 18, lambda one: one.ensemble.fell_in_record, COUNT),
    ]
    pen.listing(page, columns, [one for floor in content.floors for one in floor.motions if one.ensemble])
