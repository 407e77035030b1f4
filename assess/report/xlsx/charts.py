"""The charts, all drawn from cells with formulas, so that an edit moves them.

Each class has a pattern next to its colour, as a grey printer shows no more.
"""

import math
from collections.abc import Mapping
from typing import Any

from assess.i18n import gettext as _
from assess.report.xlsx.pen import Pen
from assess.risk import RiskClass

_PATTERNS = {RiskClass.MEDIUM: "percent_20", RiskClass.HIGH: "wide_upward_diagonal"}
"""Of the classes in between; the lowest and the highest are plain, light and dark."""
_LINES = {"X": ("#1f3a4d", "solid", "square"), "Y": ("#b3541e", "dash", "circle")}
AROUND = 120
"""Height of what stands around the bars of floors [pixels]."""

Cell = tuple[int, int]
Area = tuple[int, int, int, int]


def fill(risk: RiskClass, *, outlined: bool = True) -> dict[str, Any]:
    """Return how XlsxWriter fills what stands for a class."""
    look: dict[str, Any] = {"border": {"color": "#444444", "width": 0.5} if outlined else {"none": True}}
    if risk in _PATTERNS:
        return look | {"pattern": {"pattern": _PATTERNS[risk], "fg_color": "#8a8a8a", "bg_color": risk.fill}}
    return look | {"fill": {"color": risk.fill}}


def add_classes(pen: Pen, page: Any, cell: Cell, top: int, basis: str) -> None:
    """Draw the pieces of each class; `top` is the row of the classes, below which are the counts of the basis."""
    series = {"name": _("Pieces"), "points": [fill(risk) for risk in RiskClass], "data_labels": {"value": True}}
    chart = pen.book.add_chart({"type": "column"})
    _add(chart, pen.sheets["Summary"], (top, 1, top, len(RiskClass)), (top + 1, 1, top + 1, len(RiskClass)),
         {"gap": 60, **series})  # fmt: skip
    chart.set_y_axis({"visible": False, "major_gridlines": {"visible": False}, "min": 0})
    description = _("Pieces of each class in the whole building")
    _place(page, cell, chart, _("Pieces by class: {basis}", basis=basis), (470, 280), description)
    chart.set_legend({"none": True})


def add_highest(pen: Pen, page: Any, cell: Cell, rows: Cell, columns: Cell, basis: str) -> None:
    """Draw the highest chances, in the colour of their class.

    `rows` are the first and the last, `columns` those of the names and of the chances of the lowest class.
    """
    (first, last), (names, chances) = rows, columns
    chart = pen.book.add_chart({"type": "bar", "subtype": "stacked"})
    for at, risk in enumerate(RiskClass, chances):
        _add(chart, pen.sheets["Summary"], (first, names, last, names), (first, at, last, at),
             {"name": pen.terms.labels[risk], "gap": 40, **fill(risk)})  # fmt: skip
    chart.set_x_axis({"min": 0, "max": 1, "num_format": "0%"})
    chart.set_y_axis({"reverse": True, "num_font": {"size": 8}, "label_position": "low"})
    chart.show_hidden_data()
    description = _("Chances of the pieces most likely to fall, as in the table below")
    _place(page, cell, chart, _("Highest chances: {basis}", basis=basis), (715, 280), description)


def add_floors(pen: Pen, page: Any, cell: Cell, rows: Cell, basis: str) -> None:
    """Draw the pieces of each class on every floor; `rows` are those of the first and the last floor."""
    sheet, (first, last) = pen.sheets["Summary"], rows
    chart, floors = pen.book.add_chart({"type": "bar", "subtype": "stacked"}), last - first + 1
    outlined, height = floors <= 40, _height(floors)  # an outline would cover thinner bars
    for at, risk in enumerate(RiskClass, 1):
        _add(chart, sheet, (first, 0, last, 0), (first, at, last, at),
             {"name": [sheet, first - 1, at], "gap": 40 * outlined, **fill(risk, outlined=outlined)})  # fmt: skip
    every = math.ceil(floors * 14 / (height - AROUND))  # a label takes 14 pixels
    chart.set_y_axis({"reverse": True, "interval_unit": every, "num_font": {"size": 8}})
    description = _("Pieces of each class on every floor, as in the table above")
    _place(page, cell, chart, _("Pieces by class and floor: {basis}", basis=basis), (1185, height), description)


def _height(floors: int) -> int:
    return min(720, max(320, AROUND + 22 * floors))  # [pixels]: it stays on one printed page


def count_rows(floors: int) -> int:
    """Return the rows that the chart by floor takes."""
    return math.ceil(_height(floors) / 20) + 1  # [pixels]


def add_motion(pen: Pen, page: Any, cell: Cell, rows: Cell, columns: Mapping[str, int]) -> None:
    """Draw the PFA of every floor along both axes; `columns` are where it stands, by the axis, and may be hidden."""
    sheet, (first, last) = pen.sheets["Floors"], rows
    chart = pen.book.add_chart({"type": "line"})
    for axis, column in columns.items():
        color, dash, marker = _LINES[axis]
        line = {"color": color, "width": 1.5, "dash_type": dash}
        mark = {"type": marker, "size": 5, "fill": {"color": color}, "border": {"color": color}}
        _add(chart, sheet, (first, 0, last, 0), (first, column, last, column),
             {"name": [sheet, 0, column], "line": line, "marker": mark})  # fmt: skip
    chart.set_x_axis({"name": _("Floor"), "num_font": {"size": 8}})
    chart.set_y_axis({"min": 0, "num_format": "0.0"})
    chart.show_hidden_data()
    description = _("Peak acceleration of every floor along X and Y, as in the table above")
    _place(page, cell, chart, _("PFA by floor"), (1000, 300), description)


def _add(chart: Any, sheet: str, categories: Area, values: Area, more: Mapping[str, Any]) -> None:
    """Add a series; areas are first row and column, last row and column."""
    chart.add_series({"categories": [sheet, *categories], "values": [sheet, *values], **more})


def _place(page: Any, cell: Cell, chart: Any, title: str, size: tuple[int, int], description: str) -> None:
    """Set a chart on a page with its title, its size [pixels] and its text for those who cannot see it."""
    chart.set_title({"name": title, "name_font": {"size": 11}})
    chart.set_size({"width": size[0], "height": size[1]})
    chart.set_legend({"position": "bottom"})
    page.insert_chart(*cell, chart, {"description": description, "object_position": 2})
