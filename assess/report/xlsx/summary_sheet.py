"""The sheets Summary and Fix first: counts by class and floor, the pieces most likely to fall, what to fix first.

All of the summary but the sentences on routes is live; the list of what to fix first is as run.
"""

import heapq
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.content import Content
from assess.report.findings.at_risk import describe_at_risk
from assess.report.findings.verified import INTERVAL, SCENARIO
from assess.report.summary import ROUTES
from assess.report.xlsx import charts
from assess.report.xlsx.item_formulas import literal, sentence
from assess.report.xlsx.items_sheet import (
    HEAD,
    chance_in_force,
    class_in_force,
    class_simulated,
    item_areas,
    order_number,
)
from assess.report.xlsx.pen import CHANCE, LINE, Column, Pen, count_lines, row_height
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.workbook.formulas import OUTSIDE

WIDTHS = (34, 15, 15, 15, 15, 15, 15, 40)
"""Of the columns that are printed: of names, of counts, and of classes."""
LAST = len(WIDTHS) - 1
CHART_ROWS = 15
"""Rows of the charts below the counts."""
MOST_FLOORS = 12
"""Floors up to which the summary is printed on one page."""
LISTED = 10
"""Pieces in the list."""
PLACE, CHANCES = LAST + 1, LAST + 2
"""Hidden columns: the row of the piece in Items, and its chance in the column of its class."""
_LONGEST = 80


def write_summary(pen: Pen, page: Any, content: Content) -> None:
    """Write the sentences, the counts, the pieces most likely to fall, the counts by floor, and their charts."""
    for at, width in enumerate(WIDTHS):
        page.set_column(at, at, width)
    title = _("Furniture in earthquakes: {title}", title=words.cut(content.title, 100))
    page.write_string(0, 0, title, pen.style("title"))
    areas, worst = item_areas(pen, content), _find_worst(content)
    top = _write_lines(pen, page, content, areas) + 1
    listed = top + 3 + CHART_ROWS
    counted = listed + 3 + len(worst)
    bottom = counted + 2 + len(content.floors)
    _write_building(pen, page, content, top, bottom)
    _write_worst(pen, page, areas, listed, worst)
    _write_counts(pen, page, content, areas, counted)
    charts.add_classes(pen, page, (top + 3, 0), top)
    if worst:
        charts.add_highest(pen, page, (top + 3, 3), (listed + 2, listed + 1 + len(worst)), (0, CHANCES))
    charts.add_floors(pen, page, (bottom + 2, 0), (counted + 2, bottom - 1))
    page.print_area(0, 0, bottom + 2 + charts.count_rows(len(content.floors)), LAST)
    is_short = len(content.floors) <= MOST_FLOORS
    page.fit_to_pages(1, 1 if is_short else 0)
    if not is_short:
        page.repeat_rows(counted + 1)
        page.set_h_pagebreaks([bottom + 2])


# ---------------------------------------------------------------- sentences


def _write_lines(pen: Pen, page: Any, content: Content, areas: Mapping[str, str]) -> int:
    """Write the sentences below the title and return the row below them."""
    others = ((text, "") for text in (*content.cautions, *_say_routes(content)))
    lines = [*_lines(pen, content, areas), *others]
    for row, (text, formula) in enumerate(lines, 1):
        page.merge_range(row, 0, row, LAST, "", pen.style("text"))
        page.set_row(row, LINE * count_lines(text, sum(WIDTHS)))
        if formula:
            page.write_formula(row, 0, f"={formula}", pen.style("text"), text)
        else:
            pen.put(page, row, 0, text, pen.style("text"))
    return len(lines) + 1


def _lines(pen: Pen, content: Content, areas: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield the sentences, each with its formula where it has one."""
    scenario, verified = content.run.building.scenario, content.verified
    follow = _("Counts and chances follow the sheets Floors, Items and Assumptions when those are edited.")
    if scenario:
        yield _("Scenario: {scenario}", scenario=words.cut(scenario, 300)), ""
    if not verified.done:
        status, meaning = verified.status
        yield _(SCENARIO), ""
        yield f"{status}: {meaning}.", ""
        yield follow, ""
        return
    yield f"{_(SCENARIO)} {_(INTERVAL)[0].upper()}{_(INTERVAL)[1:]}.", ""
    yield verified.sentence, ""
    rank = areas["rank"]
    lowered = f'SUMPRODUCT(({rank}<>"")*({rank}<{areas["rank_formula"]}))'
    void = f"COUNTIF({areas['class_simulated']},{literal(pen.terms.void)})"
    changed = _("Rows whose class simulation lowers: {lowered}; void, as an input was edited: {void}.")
    yield changed.format(lowered=len(verified.lowered), void=0), sentence(changed, lowered=lowered, void=void)
    yield _("Void rows fall back to the class of the formula until assess is run again."), ""
    yield follow, ""


def _say_routes(content: Content) -> Iterator[str]:
    """Yield what the summary says of the routes, and a line for each of those at risk that it names."""
    summary, found = content.summary, content.summary.routes[:ROUTES]
    if not summary.of_routes:
        return
    yield _("Evacuation routes: {text}", text=" ".join(summary.of_routes))
    yield from map(describe_at_risk, found)
    if more := len(summary.routes) - len(found):
        yield ngettext(
            "{n:,} more route at risk is in the sheet Routes.",
            "{n:,} more routes at risk are in the sheet Routes.",
            more,
        )
    yield _("The text on routes is as run: it does not follow when a cell is edited.")


# ---------------------------------------------------------------- counts


def _write_building(pen: Pen, page: Any, content: Content, top: int, bottom: int) -> None:
    """Write the counts of the building, which stand in the row `bottom` too."""
    _write_heads(pen, page, top, _("Building"))
    formulas = [f"={xl_col_to_name(at)}{bottom + 1}" for at in range(1, LAST)]
    _write_row_of_totals(pen, page, content, top + 1, formulas)


def _write_counts(pen: Pen, page: Any, content: Content, areas: Mapping[str, str], top: int) -> None:
    """Write the counts by floor, and below them those of the building."""
    page.write_string(top, 0, _("Pieces by class and floor"), pen.style("heading"))
    _write_heads(pen, page, top + 1, _("Floor"))
    for number, floor_page in enumerate(content.floors, HEAD + 1):
        row, counts = top + number, floor_page.counts
        pen.put(page, row, 0, floor_page.title, pen.style("text"))
        page.set_row(row, row_height([floor_page.title], WIDTHS))
        formulas = [*_count(pen, areas, f"{pen.refer('Floors')}$A${number}"), f"=SUM(B{row + 1}:F{row + 1})"]
        values = (*counts.by_class.values(), counts.anchored, counts.total)
        for at, (formula, count) in enumerate(zip(formulas, values, strict=True), 1):
            page.write_formula(row, at, formula, pen.style("live"), count)
    total = top + 2 + len(content.floors)
    letters = (xl_col_to_name(at) for at in range(1, LAST))
    _write_row_of_totals(pen, page, content, total, [f"=SUM({one}{top + 3}:{one}{total})" for one in letters])


def _write_row_of_totals(pen: Pen, page: Any, content: Content, row: int, formulas: Sequence[str]) -> None:
    page.write_string(row, 0, _("All floors"), pen.style("total"))
    values = (*content.total.by_class.values(), content.total.anchored, content.total.total)
    for at, (formula, value) in enumerate(zip(formulas, values, strict=True), 1):
        page.write_formula(row, at, formula, pen.style("total"), value)


def _write_heads(pen: Pen, page: Any, row: int, label: str) -> None:
    page.write_string(row, 0, label, pen.style("head"))
    for at, risk in enumerate(RiskClass, 1):
        page.write_string(row, at, pen.terms.labels[risk], pen.classes[risk])
    for at, text in enumerate((_("anchored"), _("all")), 1 + len(RiskClass)):
        page.write_string(row, at, text, pen.style("head"))


def _count(pen: Pen, areas: Mapping[str, str], at_floor: str) -> list[str]:
    """Return the formulas that count the pieces of a floor: of each class, and those that are anchored."""
    on_floor = f"({areas['floor']}={at_floor})"  # SUMIFS would read names as criteria
    yes, quantity = literal(pen.terms.yes), areas["quantity"]
    formulas = []
    for label in pen.terms.labels:
        classed = f"(({areas['class']}={literal(label)})+({areas['class']}={literal(label + OUTSIDE)}))"
        formulas.append(f"=SUMPRODUCT({on_floor}*{classed}*({areas['anchored']}<>{yes}),{quantity})")
    return [*formulas, f"=SUMPRODUCT({on_floor}*({areas['anchored']}={yes}),{quantity})"]


# ---------------------------------------------------------------- the pieces most likely to fall


def _find_worst(content: Content) -> list[tuple[int, ItemResult]]:
    """Return the pieces of highest class and chance with their places in Items, 1 for the first."""
    numbers = ((order_number(one, row), row, one) for row, one in enumerate(content.results, HEAD))
    known = ((number, row, one) for number, row, one in numbers if number is not None)
    return [(row, one) for _number, row, one in heapq.nlargest(LISTED, known, key=lambda entry: entry[0])]


def _write_worst(
    pen: Pen, page: Any, areas: Mapping[str, str], row: int, found: Sequence[tuple[int, ItemResult]]
) -> None:
    """Write the pieces of highest class and chance."""
    page.write_string(row, 0, _("The pieces most likely to fall"), pen.style("heading"))
    heads = (_("Item"), _("Floor"), _("Room"), _("Pieces"), _("Chance"), _("Interval low"), _("Interval high"),
             _("Class"))  # fmt: skip
    pen.heads(page, heads, WIDTHS, row + 1)
    for number, (place, one) in enumerate(found, 1):
        _write_piece(pen, page, areas, row + 1 + number, number, place, one)
    last = row + 1 + len(found)
    if found:
        pen.colour(page, f"H{row + 3}:H{last + 1}")
        pen.bar(page, f"E{row + 3}:E{last + 1}")
    page.set_column(PLACE, CHANCES + len(RiskClass) - 1, 10, None, {"hidden": True})


def _write_piece(
    pen: Pen, page: Any, areas: Mapping[str, str], row: int, number: int, place: int, one: ItemResult
) -> None:
    """Write one piece of the list, the `number`-th; it is in the row `place` of Items."""
    values = _values(one)
    page.set_row(row, row_height(values, WIDTHS))
    order, cell = areas["order"], f"${xl_col_to_name(PLACE)}{row + 1}"
    page.write_formula(row, PLACE, f'=IFERROR(MATCH(LARGE({order},{number}),{order},0),"")', None, place)
    text, live, chance = pen.style("text"), pen.style("live"), pen.style("plain", CHANCE)
    looks = (text, text, text, live, chance, chance, chance, text)
    for column, (formula, value, look) in enumerate(zip(_formulas(areas, cell), values, looks, strict=True)):
        page.write_formula(row, column, f'=IF({cell}="","",{formula})', look, "" if value is None else value)
    for risk, label in zip(RiskClass, pen.terms.labels, strict=True):
        is_it = f"LEFT(INDEX({areas['class']},{cell}),{len(label)})={literal(label)}"
        formula = f'=IF({cell}="","",IF({is_it},$E{row + 1},""))'
        is_own = class_in_force(one).startswith(label)
        page.write_formula(row, CHANCES + risk, formula, None, chance_in_force(one) if is_own else "")


def _values(one: ItemResult) -> tuple[Any, ...]:
    risk = class_simulated(one) if one.is_simulated else class_in_force(one)
    low, high = (one.adopted.low, one.adopted.high) if one.is_simulated else (None, None)
    text = one.item.description or one.item.type
    name = (one.item.item + (f": {text}" if text else ""))[:_LONGEST]
    return name, one.item.floor, one.item.room, one.item.quantity, chance_in_force(one), low, high, risk


def _formulas(areas: Mapping[str, str], cell: str) -> list[str]:
    """Return the formulas of a row of the list by the cell that holds the place of its piece."""

    def of(key: str) -> str:
        return f"INDEX({areas[key]},{cell})"

    text = f'IF({of("description")}<>"",": "&{of("description")},IF({of("type")}<>"",": "&{of("type")},""))'
    simulated = f"ISNUMBER({of('rank')})"
    intervals = [f'IF({simulated},IF({of(key)}="","",{of(key)}),"")' for key in ("low", "high")]
    return [
        f"LEFT({of('item')}&{text},{_LONGEST})",
        of("floor"),
        f'{of("room")}&""',
        of("quantity"),
        of("chance"),
        *intervals,
        f"IF({simulated},{of('class_simulated')},{of('class')})",
    ]


# ---------------------------------------------------------------- what to fix first


def write_fix_first(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces of at least medium class and those that a route needs fixed, what to fix first at the top."""
    columns = [
        Column(_("No."), 6, lambda fix: fix.place),
        Column(_("Item"), 12, lambda fix: fix.result.item.item),
        Column(_("Floor"), 9, lambda fix: fix.result.item.floor),
        Column(_("Room"), 16, lambda fix: fix.result.item.room),
        Column(_("Description"), 36, lambda fix: fix.result.item.description or fix.result.item.type),
        Column(_("Importance"), 13, lambda fix: _(fix.result.item.importance) if fix.result.item.importance else ""),
        Column(_("Route"), 12, lambda fix: ", ".join(fix.result.routes)),
        Column(_("Class (as run)"), 36, lambda fix: class_as_run(fix.result)),
        Column(_("Chance"), 10, lambda fix: fix.result.adopted.probability, CHANCE),
        Column(_("Interval low"), 10, lambda fix: fix.result.adopted.low, CHANCE),
        Column(_("Interval high"), 10, lambda fix: fix.result.adopted.high, CHANCE),
        Column(_("Pieces"), 8, lambda fix: fix.result.item.quantity),
        Column(_("Expected falls avoided if the anchors hold"), 16, lambda fix: fix.saved, "0.000"),
        Column(_("Why first"), 60, lambda fix: fix.reason),
    ]
    order = _(
        "Sorted by class (upper estimate): high and very high first; within that life safety and routes, then the "
        "class, then chance times number. After a route: the chance that it is blocked, before and after."
    )
    page.write_comment(0, len(columns) - 1, order, {"x_scale": 3, "y_scale": 2})  # now, as the rows below follow
    below = pen.listing(page, columns, content.summary.fixes)
    if content.summary.fixes:
        pen.bar(page, f"I2:I{below}")


def class_as_run(one: ItemResult) -> str:
    """Return the adopted class with its symbol and notes; an anchored one keeps its own words."""
    return f"{one.adopted.risk.symbol} {words.risk_words(one)}"
