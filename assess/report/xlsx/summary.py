"""The sheets Summary and Fix first."""

from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.inventory.live import OUTSIDE
from assess.report import words
from assess.report.content import Content
from assess.report.verified import describe_verification
from assess.report.xlsx.formulas import VOID
from assess.report.xlsx.items import HEAD, item_columns
from assess.report.xlsx.pen import LINE, Pen, count_lines
from assess.results import ItemResult
from assess.risk import RiskClass

CHART_ROWS = 18
NAME_WIDTH, CLASS_WIDTH = 34, 40
"""Widths of the columns of names and of classes."""


def write_summary(pen: Pen, page: Any, content: Content) -> None:
    """Write the counts by floor and class as formulas over Items, their chart, and the worst pieces."""
    page.set_column(0, 0, NAME_WIDTH)
    page.set_column(1, 6, 15)
    page.set_column(7, 7, CLASS_WIDTH)
    page.write_string(0, 0, f"Furniture in earthquakes: {words.clip(content.title, 100)}", pen.title)
    lines = _lines(content)
    for row, (line, formula) in enumerate(lines, 1):
        if formula:
            page.write_formula(row, 0, formula, None, line)
        else:
            pen.put(page, row, 0, line)
    for row, line in enumerate(content.cautions, len(lines) + 1):
        page.merge_range(row, 0, row, 6, "", pen.wrap)
        page.write_string(row, 0, line, pen.wrap)
        page.set_row(row, LINE * (1 + len(line) // 110))
    top = len(lines) + len(content.cautions) + 2
    bottom = _write_counts(pen, page, content, top)
    _chart(pen, page, top, bottom)
    _write_worst(pen, page, content, bottom + CHART_ROWS)


def _lines(content: Content) -> list[tuple[str, str]]:
    """Return the lines below the title, each with its formula where it has one."""
    scenario = content.assessment.inventory.building.scenario
    texts = [
        f"Scenario: {words.clip(scenario, 300)}" if scenario else "",
        "Chance of overturning in this scenario, not per year; the interval covers the number of records only.",
    ]
    follow = "Counts are pieces and follow the sheets Floors, Items and Assumptions when those are edited."
    if not content.verified.done:
        texts.append("Not verified: classes are those of a published formula; no direct integration has been run.")
        return [(text, "") for text in (*texts, follow)]
    item = _areas(content)
    rank, said = item["Rank"], "Rows whose class verification lowers: "
    lowered = f'SUMPRODUCT(({rank}<>"")*({rank}<{item["Rank, formula"]}))'
    void = f'COUNTIF({item["Class (verified)"]},"{VOID}")'
    live = f"{said}{len(content.verified.lowered)}; void, as an input was edited: 0."
    return [
        *((text, "") for text in (*texts, describe_verification(content.assessment))),
        (live, f'="{said}"&{lowered}&"; void, as an input was edited: "&{void}&"."'),
        ("Void rows fall back to the class of the formula until assess is run again.", ""),
        (follow, ""),
    ]


def _areas(content: Content) -> dict[str, str]:
    """Return the cells of each column of Items."""
    last = HEAD + max(1, len(content.results))
    letters = {column.label: xl_col_to_name(at) for at, column in enumerate(item_columns(content))}
    return {label: f"Items!${letter}${HEAD + 1}:${letter}${last}" for label, letter in letters.items()}


def _write_counts(pen: Pen, page: Any, content: Content, top: int) -> int:
    """Write the table of counts and return the row of its totals."""
    for at, label in enumerate(("Floor", *(risk.label for risk in RiskClass), "anchored", "all")):
        page.write_string(top, at, label, pen.head)
    item = _areas(content)
    total = top + 1 + len(content.floors)
    for row, (at_floor, floor_page) in enumerate(enumerate(content.floors, HEAD + 1), top + 1):
        pen.put(page, row, 0, floor_page.title)
        on_floor = f"({item['Floor']}=Floors!$A${at_floor})"  # SUMIFS would read names as criteria
        counts = floor_page.counts
        for at, risk in enumerate(RiskClass, 1):
            shown = item["Class"]
            classed = f'(({shown}="{risk.label}")+({shown}="{risk.label}{OUTSIDE}"))'
            formula = f'=SUMPRODUCT({on_floor}*{classed}*({item["Anchored"]}<>"yes"),{item["Quantity"]})'
            page.write_formula(row, at, formula, None, counts.by_class[risk])
        page.write_formula(
            row, 5, f'=SUMPRODUCT({on_floor}*({item["Anchored"]}="yes"),{item["Quantity"]})', None, counts.anchored
        )
        page.write_formula(row, 6, f"=SUM(B{row + 1}:F{row + 1})", None, counts.total)
    page.write_string(total, 0, "All floors", pen.bold)
    totals = (*content.total.by_class.values(), content.total.anchored, content.total.total)
    for at, value in enumerate(totals, 1):
        letter = xl_col_to_name(at)
        page.write_formula(total, at, f"=SUM({letter}{top + 2}:{letter}{total})", pen.bold, value)
    return total


def _chart(pen: Pen, page: Any, top: int, bottom: int) -> None:
    chart = pen.book.add_chart({"type": "bar", "subtype": "stacked"})
    for at, risk in enumerate(RiskClass, 1):
        chart.add_series({
            "name": ["Summary", top, at],
            "categories": ["Summary", top + 1, 0, bottom - 1, 0],
            "values": ["Summary", top + 1, at, bottom - 1, at],
            "fill": {"color": risk.fill},
            "border": {"color": "#444444", "width": 0.5},
        })  # fmt: skip
    chart.set_title({"name": "Pieces by class and floor", "name_font": {"size": 11}})
    chart.set_y_axis({"reverse": True})
    chart.set_legend({"position": "bottom"})
    chart.set_size({"width": 760, "height": 320})
    page.insert_chart(
        bottom + 1, 0, chart, {"description": "Pieces of each class on every floor, as in the table above"}
    )


def _write_worst(pen: Pen, page: Any, content: Content, row: int) -> None:
    page.write_string(row, 0, "The pieces most likely to fall (as run)", pen.bold)
    heads = ("Item", "Floor", "Room", "Pieces", "Chance", "Interval low", "Interval high", "Class")
    for at, label in enumerate(heads):
        page.write_string(row + 1, at, label, pen.head)
    percent = pen.format("0.0%", valign="top")
    for number, one in enumerate(content.worst, row + 2):
        described, said = _name(one), _class_words(one)
        page.set_row(number, LINE * max(count_lines(described, NAME_WIDTH), count_lines(said, CLASS_WIDTH)))
        for at, value in enumerate((described, one.item.floor, one.item.room, one.item.quantity)):
            pen.put(page, number, at, value, pen.wrap)
        for at, value in enumerate((one.adopted.probability, one.adopted.low, one.adopted.high), 4):
            pen.put(page, number, at, value, percent)
        pen.put(page, number, 7, said, pen.wrap)
    pen.colour(page, f"H{row + 3}:H{row + 3 + len(content.worst)}")


def _name(one: ItemResult) -> str:
    named = (one.item.item, one.item.description or one.item.type)
    return words.clip(": ".join(part for part in named if part), 80)


def _class_words(one: ItemResult) -> str:
    """Return the class as run with what must be said beside it, its symbol first: the colours go by that."""
    return f"{one.adopted.risk.symbol} {words.risk_words(one)}"


def write_fix_first(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces of at least medium class, what to fix first at the top."""
    rows = [
        (at, one.item.item, one.item.floor, one.item.room, one.item.description or one.item.type,
         one.item.importance, one.item.route, _class_words(one), one.adopted.probability, one.adopted.low,
         one.adopted.high, one.item.quantity, one.adopted.probability * one.item.quantity)
        for at, one in enumerate(content.fix_first, 1)
    ]  # fmt: skip
    heads = ("No.", "Item", "Floor", "Room", "Description", "Importance", "Route", "Class (as run)", "Chance",
             "Interval low", "Interval high", "Pieces", "Expected falls saved if the anchor holds")  # fmt: skip
    formats = dict.fromkeys((8, 9, 10), "0.0%") | {12: "0.00"}
    pen.listing(page, heads, (6, 12, 9, 16, 36, 13, 12, 36, 10, 10, 10, 8, 16), rows, formats)
    pen.colour(page, f"H2:H{len(rows) + 2}")
