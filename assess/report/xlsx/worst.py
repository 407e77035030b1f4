"""The pieces most likely to fall: a live list on the summary, and all that are worth fixing in a sheet of their own."""

import heapq
from collections.abc import Mapping
from typing import Any

from assess.language import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.xlsx import charts
from assess.report.xlsx.columns import chance_in_force, class_in_force
from assess.report.xlsx.items import HEAD, order_number
from assess.report.xlsx.pen import LINE, Pen, count_lines
from assess.report.xlsx.said import literal
from assess.report.xlsx.verified import class_verified
from assess.results import ItemResult
from assess.risk import RiskClass

LISTED = 10
"""Pieces in the list of the summary."""
PLACE, CHANCES = 8, 9
"""Hidden columns: the row of the piece in Items, and its chance in the column of its class."""
_LONGEST = 80
_WIDTHS = (34, 15, 15, 15, 15, 15, 15, 40)


def write_worst(pen: Pen, page: Any, content: Content, areas: Mapping[str, str], row: int) -> None:
    """Write the pieces of highest class and chance."""
    page.write_string(row, 0, _("The pieces most likely to fall"), pen.heading)
    heads = (_("Item"), _("Floor"), _("Room"), _("Pieces"), _("Chance"), _("Interval low"), _("Interval high"),
             _("Class"))  # fmt: skip
    pen.heads(page, heads, _WIDTHS, row + 1)
    found = _find(content)
    for at, one in enumerate(found, 1):
        _write_row(pen, page, areas, (row + 1 + at, at), one)
    last = row + 1 + len(found)
    if found:
        pen.colour(page, f"H{row + 3}:H{last + 1}")
        pen.bar(page, f"E{row + 3}:E{last + 1}")
    page.set_column(PLACE, CHANCES + len(RiskClass) - 1, 10, None, {"hidden": True})


def count_rows(content: Content) -> int:
    """Return the rows that `write_worst` takes."""
    return 2 + len(_find(content))


def chart_worst(pen: Pen, page: Any, content: Content, cell: tuple[int, int], row: int) -> None:
    """Draw the list that `write_worst` has written at `row`."""
    found = _find(content)
    if found:
        charts.add_highest(pen, page, cell, (row + 2, row + 1 + len(found)), (0, CHANCES))


def _find(content: Content) -> list[tuple[int, ItemResult]]:
    """Return the pieces of highest class and chance with their places in Items, 1 for the first."""
    numbers = ((order_number(one, row), row, one) for row, one in enumerate(content.results, HEAD))
    known = ((number, row, one) for number, row, one in numbers if number is not None)
    return [(row, one) for _number, row, one in heapq.nlargest(LISTED, known, key=lambda entry: entry[0])]


def _write_row(
    pen: Pen, page: Any, areas: Mapping[str, str], at: tuple[int, int], found: tuple[int, ItemResult]
) -> None:
    (row, number), (place, one) = at, found
    values = _values(one)
    page.set_row(row, LINE * max(count_lines(value, width) for value, width in zip(values, _WIDTHS, strict=True)))
    order, cell = areas["order"], f"$I{row + 1}"
    page.write_formula(row, PLACE, f'=IFERROR(MATCH(LARGE({order},{number}),{order},0),"")', None, place)
    looks = (pen.wrap, pen.wrap, pen.wrap, pen.live, pen.percent, pen.percent, pen.percent, pen.wrap)
    for column, (formula, value, look) in enumerate(zip(_formulas(areas, cell), values, looks, strict=True)):
        page.write_formula(row, column, f'=IF({cell}="","",{formula})', look, "" if value is None else value)
    for risk, label in zip(RiskClass, pen.terms.labels, strict=True):
        is_it = f"LEFT(INDEX({areas['class']},{cell}),{len(label)})={literal(label)}"
        formula = f'=IF({cell}="","",IF({is_it},$E{row + 1},""))'
        own = class_in_force(one).startswith(label)
        page.write_formula(row, CHANCES + risk, formula, None, chance_in_force(one) if own else "")


def _values(one: ItemResult) -> tuple[Any, ...]:
    said = class_verified(one) if one.is_verified else class_in_force(one)
    low, high = (one.adopted.low, one.adopted.high) if one.is_verified else (None, None)
    return (_name(one), one.item.floor, one.item.room, one.item.quantity, chance_in_force(one), low, high, said)


def _name(one: ItemResult) -> str:
    told = one.item.description or one.item.type
    return (one.item.item + (f": {told}" if told else ""))[:_LONGEST]


def _formulas(areas: Mapping[str, str], cell: str) -> list[str]:
    """Return the formulas of a row of the list by the cell that holds the place of its piece."""

    def of(key: str) -> str:
        return f"INDEX({areas[key]},{cell})"

    told = f'IF({of("description")}<>"",": "&{of("description")},IF({of("type")}<>"",": "&{of("type")},""))'
    verified = f"ISNUMBER({of('rank')})"
    intervals = [f'IF({verified},IF({of(key)}="","",{of(key)}),"")' for key in ("low", "high")]
    return [
        f"LEFT({of('item')}&{told},{_LONGEST})",
        of("floor"),
        f'{of("room")}&""',
        of("quantity"),
        of("chance"),
        *intervals,
        f"IF({verified},{of('class_verified')},{of('class')})",
    ]


def write_fix_first(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces of at least medium class and those that a route needs fixed, what to fix first at the top."""
    rows = [
        (at, one.item.item, one.item.floor, one.item.room, one.item.description or one.item.type,
         _(one.item.importance) if one.item.importance else "", ", ".join(one.routes),
         f"{one.adopted.risk.symbol} {words.risk_words(one)}", one.adopted.probability, one.adopted.low,
         one.adopted.high, one.item.quantity, fix.saved, fix.reason)
        for at, one, fix in ((fix.place, fix.result, fix) for fix in content.summary.fixes)
    ]  # fmt: skip
    heads = (_("No."), _("Item"), _("Floor"), _("Room"), _("Description"), _("Importance"), _("Route"),
             _("Class (as run)"), _("Chance"), _("Interval low"), _("Interval high"), _("Pieces"),
             _("Expected falls saved if the anchor holds"), _("Why first"))  # fmt: skip
    order = _(
        "High and very high classes come first, or what may be; among them and among the others life safety and "
        "routes, then the class, then chance times number. Behind a route stands the chance that it is blocked, before "
        "and after."
    )
    page.write_comment(0, len(heads) - 1, order, {"x_scale": 3, "y_scale": 2})  # now, as the rows below follow
    formats = dict.fromkeys((8, 9, 10), "0.0%") | {12: "0.000"}
    pen.listing(page, heads, (6, 12, 9, 16, 36, 13, 12, 36, 10, 10, 10, 8, 16, 60), rows, formats)
    if rows:
        pen.bar(page, f"I2:I{len(rows) + 1}")
