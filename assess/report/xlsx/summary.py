"""The sheet Summary: counts by class and floor, the pieces most likely to fall, and their charts, all of them live."""

from collections.abc import Mapping
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.inventory.live import OUTSIDE
from assess.language import gettext as _
from assess.language import ngettext
from assess.report.content import Content
from assess.report.findings.at_risk import describe_at_risk
from assess.report.findings.verified import describe_verification
from assess.report.summary import ROUTES
from assess.report.xlsx import charts, worst
from assess.report.xlsx.items import HEAD, item_areas
from assess.report.xlsx.pen import LINE, Pen, clip, count_lines
from assess.report.xlsx.said import hole, join, literal
from assess.risk import RiskClass

NAME_WIDTH, COUNT_WIDTH, CLASS_WIDTH = 34, 15, 40
"""Widths of the columns of names, of counts, and of classes."""
LAST = 7
"""Last column that is printed."""
CHART_ROWS = 15
"""Rows of the charts below the counts."""
MOST_FLOORS = 12
"""Floors up to which the summary is printed on one page."""


def write_summary(pen: Pen, page: Any, content: Content) -> None:
    """Write what is known in words, the pieces most likely to fall, and the counts by floor, with their charts."""
    page.set_column(0, 0, NAME_WIDTH)
    page.set_column(1, LAST - 1, COUNT_WIDTH)
    page.set_column(LAST, LAST, CLASS_WIDTH)
    page.write_string(0, 0, _("Furniture in earthquakes: {title}", title=clip(content.title, 100)), pen.title)
    areas = item_areas(pen, content)
    top = _write_lines(pen, page, content, areas) + 1
    listed = top + 3 + CHART_ROWS
    counted = listed + worst.count_rows(content) + 1
    bottom = counted + 2 + len(content.floors)
    _write_building(pen, page, content, top, bottom)
    worst.write_worst(pen, page, content, areas, listed)
    _write_counts(pen, page, content, areas, counted)
    charts.add_classes(pen, page, (top + 3, 0), top)
    worst.chart_worst(pen, page, content, (top + 3, 3), listed)
    charts.add_floors(pen, page, (bottom + 2, 0), (counted + 2, bottom - 1))
    page.print_area(0, 0, bottom + 2 + charts.count_rows(len(content.floors)), LAST)
    is_short = len(content.floors) <= MOST_FLOORS
    page.fit_to_pages(1, 1 if is_short else 0)
    if not is_short:
        page.repeat_rows(counted + 1)
        page.set_h_pagebreaks([bottom + 2])


def _write_lines(pen: Pen, page: Any, content: Content, areas: Mapping[str, str]) -> int:
    """Write the sentences below the title and return the row below them."""
    lines = [(text, "") for text in (*content.cautions, *_say_routes(content))]
    lines = [*_lines(pen, content, areas), *lines]
    width = NAME_WIDTH + COUNT_WIDTH * (LAST - 1) + CLASS_WIDTH
    for row, (text, formula) in enumerate(lines, 1):
        page.merge_range(row, 0, row, LAST, "", pen.wrap)
        page.set_row(row, LINE * count_lines(text, width))
        if formula:
            page.write_formula(row, 0, f"={formula}", pen.wrap, text)
        else:
            pen.put(page, row, 0, text, pen.wrap)
    return len(lines) + 1


def _say_routes(content: Content) -> list[str]:
    """Return what the summary says of the routes, and a line for each of those at risk that it names."""
    said, found = content.summary, content.summary.routes[:ROUTES]
    if not said.of_routes:
        return []
    more = len(said.routes) - len(found)
    texts = [_("Evacuation routes: {text}", text=" ".join(said.of_routes)), *map(describe_at_risk, found)]
    if more:
        texts.append(ngettext("{n:,} more route at risk stands in the sheet Routes.",
                              "{n:,} more routes at risk stand in the sheet Routes.", more))  # fmt: skip
    texts.append(_("What is said of routes is as run: it does not follow when a cell is edited."))
    return texts


def _lines(pen: Pen, content: Content, areas: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the sentences, each with its formula where it has one."""
    scenario = content.assessment.inventory.building.scenario
    texts = [_("Scenario: {scenario}", scenario=clip(scenario, 300))] if scenario else []
    texts.append(
        _("Chance of overturning in this scenario, not per year; the interval covers the number of records only.")
    )
    follow = _("Counts and chances follow the sheets Floors, Items and Assumptions when those are edited.")
    if not content.verified.done:
        told = _("Not verified: classes are those of a published formula; no direct integration has been run.")
        return [(text, "") for text in (*texts, told, follow)]
    rank = areas["rank"]
    lowered = f'SUMPRODUCT(({rank}<>"")*({rank}<{areas["rank_formula"]}))'
    void = f"COUNTIF({areas['class_verified']},{literal(pen.terms.void)})"
    changed = _("Rows whose class verification lowers: {lowered}; void, as an input was edited: {void}.",
                lowered=hole(0), void=hole(1))  # fmt: skip
    shown = changed.replace(hole(0), str(len(content.verified.lowered))).replace(hole(1), "0")
    return [
        *((text, "") for text in (*texts, describe_verification(content.assessment))),
        (shown, join(changed, lowered, void)),
        (_("Void rows fall back to the class of the formula until assess is run again."), ""),
        (follow, ""),
    ]


def _write_building(pen: Pen, page: Any, content: Content, top: int, bottom: int) -> None:
    """Write the counts of the building, which stand in the row `bottom` too."""
    _write_heads(pen, page, top, _("Building"))
    page.write_string(top + 1, 0, _("All floors"), pen.total)
    for at, value in enumerate(_totals(content), 1):
        page.write_formula(top + 1, at, f"={xl_col_to_name(at)}{bottom + 1}", pen.total, value)


def _write_counts(pen: Pen, page: Any, content: Content, areas: Mapping[str, str], top: int) -> None:
    """Write the counts by floor, and below them those of the building."""
    page.write_string(top, 0, _("Pieces by class and floor"), pen.heading)
    _write_heads(pen, page, top + 1, _("Floor"))
    for number, floor_page in enumerate(content.floors, HEAD + 1):
        row, counts = top + number, floor_page.counts
        pen.put(page, row, 0, floor_page.title, pen.wrap)
        page.set_row(row, LINE * count_lines(floor_page.title, NAME_WIDTH))
        formulas = _count(pen, areas, f"{pen.refer('Floors')}$A${number}")
        for at, (formula, count) in enumerate(
            zip(formulas, (*counts.by_class.values(), counts.anchored), strict=True), 1
        ):
            page.write_formula(row, at, formula, pen.live, count)
        page.write_formula(row, 6, f"=SUM(B{row + 1}:F{row + 1})", pen.live, counts.total)
    total = top + 2 + len(content.floors)
    page.write_string(total, 0, _("All floors"), pen.total)
    for at, value in enumerate(_totals(content), 1):
        letter = xl_col_to_name(at)
        page.write_formula(total, at, f"=SUM({letter}{top + 3}:{letter}{total})", pen.total, value)


def _totals(content: Content) -> tuple[int, ...]:
    return (*content.total.by_class.values(), content.total.anchored, content.total.total)


def _write_heads(pen: Pen, page: Any, row: int, label: str) -> None:
    page.write_string(row, 0, label, pen.head)
    for at, risk in enumerate(RiskClass, 1):
        page.write_string(row, at, pen.terms.labels[risk], pen.classes[risk])
    for at, told in enumerate((_("anchored"), _("all")), 1 + len(RiskClass)):
        page.write_string(row, at, told, pen.head)


def _count(pen: Pen, areas: Mapping[str, str], at_floor: str) -> list[str]:
    """Return the formulas that count the pieces of a floor: of each class, and those that are anchored."""
    on_floor = f"({areas['floor']}={at_floor})"  # SUMIFS would read names as criteria
    yes, quantity = literal(pen.terms.yes), areas["quantity"]
    formulas = []
    for label in pen.terms.labels:
        classed = f"(({areas['class']}={literal(label)})+({areas['class']}={literal(label + OUTSIDE)}))"
        formulas.append(f"=SUMPRODUCT({on_floor}*{classed}*({areas['anchored']}<>{yes}),{quantity})")
    return [*formulas, f"=SUMPRODUCT({on_floor}*({areas['anchored']}={yes}),{quantity})"]
