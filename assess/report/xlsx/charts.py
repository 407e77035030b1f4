"""The charts, all drawn from cells with formulas, so that an edit moves them.

Each class has a pattern beside its colour, as a grey printer shows no more.
"""

import math
from typing import Any

from assess.language import gettext as _
from assess.report.xlsx.pen import Pen
from assess.risk import RiskClass

_PATTERNS = {RiskClass.MEDIUM: "percent_20", RiskClass.HIGH: "wide_upward_diagonal"}
"""Of the classes in between; the lowest and the highest are plain, light and dark."""

LOWEST, HIGHEST = 320, 720
"""Heights of the chart by floor [pixels]: it stays on one printed page."""
OUTLINED = 40
"""Floors up to which bars have an outline, which would cover thinner ones."""
FLOOR_HEIGHT, LABEL_HEIGHT, AROUND = 22, 14, 120
"""Height of the bar of a floor, of its label, and of what stands around them [pixels]."""

ROW_HEIGHT = 20
"""Height of a row [pixels]."""


def fill(risk: RiskClass, *, outlined: bool = True) -> dict[str, Any]:
    """Return how XlsxWriter fills what stands for a class."""
    look: dict[str, Any] = {"border": {"color": "#444444", "width": 0.5} if outlined else {"none": True}}
    if risk in _PATTERNS:
        return look | {"pattern": {"pattern": _PATTERNS[risk], "fg_color": "#8a8a8a", "bg_color": risk.fill}}
    return look | {"fill": {"color": risk.fill}}


def add_classes(pen: Pen, page: Any, cell: tuple[int, int], top: int) -> None:
    """Draw the pieces of each class; `top` is the row of the classes, below which stand the counts."""
    sheet = pen.sheets["Summary"]
    chart = pen.book.add_chart({"type": "column"})
    first, last = 1, len(RiskClass)
    chart.add_series({
        "name": _("Pieces"),
        "categories": [sheet, top, first, top, last],
        "values": [sheet, top + 1, first, top + 1, last],
        "points": [fill(risk) for risk in RiskClass],
        "data_labels": {"value": True},
        "gap": 60,
    })  # fmt: skip
    chart.set_y_axis({"visible": False, "major_gridlines": {"visible": False}, "min": 0})
    chart.set_legend({"none": True})
    _place(page, cell, chart, _("Pieces by class"), (470, 280), _("Pieces of each class in the whole building"))


def add_highest(pen: Pen, page: Any, cell: tuple[int, int], rows: tuple[int, int], columns: tuple[int, int]) -> None:
    """Draw the highest chances, in the colour of their class.

    `rows` are the first and the last, `columns` those of the names and of the chances of the lowest class.
    """
    sheet, (first, last), (names, chances) = pen.sheets["Summary"], rows, columns
    chart = pen.book.add_chart({"type": "bar", "subtype": "stacked"})
    for at, risk in enumerate(RiskClass, chances):
        chart.add_series({
            "name": pen.terms.labels[risk],
            "categories": [sheet, first, names, last, names],
            "values": [sheet, first, at, last, at],
            "gap": 40,
            **fill(risk),
        })  # fmt: skip
    chart.set_x_axis({"min": 0, "max": 1, "num_format": "0%"})
    chart.set_y_axis({"reverse": True, "num_font": {"size": 8}, "label_position": "low"})
    chart.set_legend({"position": "bottom"})
    chart.show_hidden_data()
    told = _("Chances of the pieces most likely to fall, as in the table below")
    _place(page, cell, chart, _("Highest chances"), (715, 280), told)


def add_floors(pen: Pen, page: Any, cell: tuple[int, int], rows: tuple[int, int]) -> None:
    """Draw the pieces of each class on every floor; `rows` are those of the first and the last floor."""
    sheet, (first, last) = pen.sheets["Summary"], rows
    chart, floors = pen.book.add_chart({"type": "bar", "subtype": "stacked"}), last - first + 1
    for at, risk in enumerate(RiskClass, 1):
        chart.add_series({
            "name": [sheet, first - 1, at],
            "categories": [sheet, first, 0, last, 0],
            "values": [sheet, first, at, last, at],
            "gap": 40 if floors <= OUTLINED else 0,
            **fill(risk, outlined=floors <= OUTLINED),
        })  # fmt: skip
    height = _height(floors)
    every = math.ceil(floors * LABEL_HEIGHT / (height - AROUND))
    chart.set_y_axis({"reverse": True, "interval_unit": every, "num_font": {"size": 8}})
    chart.set_legend({"position": "bottom"})
    told = _("Pieces of each class on every floor, as in the table above")
    _place(page, cell, chart, _("Pieces by class and floor"), (1185, height), told)


def _height(floors: int) -> int:
    return min(HIGHEST, max(LOWEST, AROUND + FLOOR_HEIGHT * floors))


def count_rows(floors: int) -> int:
    """Return the rows that the chart by floor takes."""
    return math.ceil(_height(floors) / ROW_HEIGHT) + 1


def add_motion(pen: Pen, page: Any, cell: tuple[int, int], rows: tuple[int, int], columns: dict[str, int]) -> None:
    """Draw the PFA of every floor along both axes; `columns` are where it stands, by the axis."""
    sheet, (first, last) = pen.sheets["Floors"], rows
    chart = pen.book.add_chart({"type": "line"})
    looks = {"X": ("#1f3a4d", "solid", "square"), "Y": ("#b3541e", "dash", "circle")}
    for axis, column in columns.items():
        color, dash, marker = looks[axis]
        chart.add_series({
            "name": [sheet, 0, column],
            "categories": [sheet, first, 0, last, 0],
            "values": [sheet, first, column, last, column],
            "line": {"color": color, "width": 1.5, "dash_type": dash},
            "marker": {"type": marker, "size": 5, "fill": {"color": color}, "border": {"color": color}},
        })  # fmt: skip
    chart.set_x_axis({"name": _("Floor"), "num_font": {"size": 8}})
    chart.set_y_axis({"min": 0, "num_format": "0.0"})
    chart.set_legend({"position": "bottom"})
    told = _("Peak acceleration of every floor along X and Y, as in the table above")
    _place(page, cell, chart, _("PFA by floor"), (1000, 300), told)


def _place(page: Any, cell: tuple[int, int], chart: Any, title: str, size: tuple[int, int], told: str) -> None:
    """Set a chart on a page with its title, its size [pixels] and its text for those who cannot see it."""
    chart.set_title({"name": title, "name_font": {"size": 11}})
    chart.set_size({"width": size[0], "height": size[1]})
    page.insert_chart(*cell, chart, {"description": told, "object_position": 2})
