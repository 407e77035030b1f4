"""The sheet Summary: counts by class and floor, and the pieces most likely to fall.

All of it but the sentences on routes is live. What was simulated, what was not, and what is unconfirmed stand apart in
every count, list and chart.
"""

import heapq
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _, ngettext
from assess.report import words
from assess.report.content import Content
from assess.report.say import route
from assess.report.say.ground import say_ground
from assess.report.say.simulation import INTERVAL, say_scenario
from assess.report.xlsx import charts
from assess.report.xlsx.item_formulas import AT_RUN, literal, sentence
from assess.report.xlsx.items_sheet import (
    class_in_force,
    class_notes,
    item_areas,
    list_simulated,
    listed_chance,
    name_found,
    order_number,
    say_inputs_that_settle,
)
from assess.report.xlsx.pen import CHANCE, HEAD, Pen, refer, row_height
from assess.results import CANNOT_ROCK, ROLLS, ItemResult, count_pieces
from assess.risk import RiskClass
from assess.workbook.formulas import OUTSIDE

WIDTHS = (34, 14, 14, 14, 14, 14, 14, 14, 44, 14)
"""Of the columns of the summary that are printed: of names, of numbers, of classes, and of all pieces."""
LAST = len(WIDTHS) - 1

PLACE, CHANCES = LAST + 1, LAST + 2
"""Hidden columns: the row of the piece in Items, and its chance in the column of its class."""
LONGEST = 80
"""Characters of a name in a list."""
CHART_ROWS = 15
"""Rows of the charts below the counts."""

SUM = 1 + len(RiskClass)
"""Column of the pieces of a basis: after those of its classes."""


@dataclass(frozen=True, slots=True)
class _Plan:
    """What the summary has, and where: `bases` that there are, and the rows of its tables.

    `top` is the row of the counts of the building, `lists` the first row of each list, `tables` of each table by floor.
    """

    pen: Pen
    page: Any
    content: Content
    areas: Mapping[str, str]
    bases: Sequence[str]
    top: int
    lists: Mapping[str, int]
    tables: Mapping[str, int]

    def total(self, basis: str) -> int:
        """Row of the sums of a table by floor."""
        return self.tables[basis] + 2 + len(self.content.floors)


ROUTES = 4
"""Routes that the sheet has room for."""


def write_summary(pen: Pen, page: Any, content: Content) -> None:
    """Write the sentences, the counts, the pieces most likely to fall, the counts by floor, and their charts."""
    for at, width in enumerate(WIDTHS):
        page.set_column(at, at, width)
    title = _("Furniture in earthquakes: {title}", title=words.cut(content.title, 100))
    page.write_string(0, 0, title, pen.style("title"))
    areas, there = item_areas(pen, content), {one.apart or one.main_basis for one in content.run}
    bases: list[str] = [basis for basis in ("simulated", "formula", "unconfirmed") if basis in there]
    worst: dict[str, Found] = {}
    for basis in bases:
        known = (
            (number, row, one)
            for row, one in enumerate(content.results, HEAD)
            if one.adopted.basis == basis and (number := order_number(one, row)) is not None
        )
        worst[basis] = [(row, one) for _number, row, one in heapq.nlargest(10, known, key=itemgetter(0))]
    lines = list(_list_lines(pen, content, areas, bases))
    top = 2 + len(lines)
    row = first = top + 3 + len(bases) + len(_list_apart(content)) + CHART_ROWS
    lists, tables = {}, {}
    for basis, found in worst.items():
        lists[basis], row = row, row + 3 + len(found)
    for basis in bases:
        tables[basis], row = row, row + 4 + len(content.floors)
    plan = _Plan(pen, page, content, areas, bases, top, lists, tables)
    for at, (text, formula) in enumerate(lines, 1):
        pen.paragraph(page, at, text, WIDTHS)
        if formula:
            page.write_formula(at, 0, f"={formula}", pen.style("text"), text)
    row, results = top, content.results
    _write_heads(plan, row, _("Building"), [_("pieces")])  # a row a basis, then what has no class
    for row, basis in enumerate(bases, top + 1):
        page.write_string(row, 0, pen.terms.bases[basis], pen.style("total"))
        for at, value in enumerate(_count_as_run(results, basis), 1):
            formula = f"={xl_col_to_name(at)}{plan.total(basis) + 1}"
            page.write_formula(row, at, formula, pen.style("total"), value)
    for at, (label, value) in enumerate(_count_apart(content, results).items() if bases else (), 1):
        page.write_string(row + at, 0, label, pen.style("total"))
        formula = f"={xl_col_to_name(SUM + at)}{plan.total(bases[0]) + 1}"
        page.write_formula(row + at, SUM, formula, pen.style("total"), value)
    for basis, found in worst.items():  # rows are written from the top: what is above the last one is left out
        _write_worst(plan, basis, found)
    for basis in bases:
        _write_floors(plan, basis)
    _draw(plan, first - CHART_ROWS, worst)


def _list_lines(
    pen: Pen, content: Content, areas: Mapping[str, str], bases: Sequence[str]
) -> Iterator[tuple[str, str]]:
    """Yield the sentences below the title, each with its formula or ""."""
    run, verified = content.run, content.verified
    if run.building.scenario:
        yield _("Scenario: {scenario}", scenario=words.cut(run.building.scenario, 300)), ""
    if shaking := say_ground(run):
        yield shaking, ""
    if run.settings.scale != 1:
        yield _("The motion of every floor is multiplied by {scale:g}.", scale=run.settings.scale), ""
    if run.settings.ideal:
        yield _("Chances are those if exactly this motion recurred and every piece were exactly as filled in: the "
                "uncertainty of the earthquake and of the pieces is left out."), ""  # fmt: skip
    if not run.has_simulated:
        status, meaning = verified.status
        yield say_scenario(run), ""
        yield f"{status}: {meaning}.", ""
    else:
        yield f"{say_scenario(run)} {_(INTERVAL)[0].upper()}{_(INTERVAL)[1:]}.", ""
        yield verified.sentence, ""
        if len(bases) > 1:
            yield _("What was simulated, what was not, and what is unconfirmed are counted apart."), ""
        unconfirmed = literal(pen.terms.bases["unconfirmed"])
        if "unconfirmed" in bases:
            own = [one for one in content.results if one.adopted.is_unconfirmed]
            ways = "; ".join(dict.fromkeys(map(say_inputs_that_settle, own)))
            text = _("Unconfirmed pieces: {n}; to settle them: {ways}.")
            n = count_pieces(one for one in own if not one.is_anchored)
            free = f"({areas['held']}<>{literal(pen.terms.yes)})"
            counted = f"SUMPRODUCT(({areas['basis']}={unconfirmed})*{free},{areas['quantity']})"
            yield text.format(n=n, ways=ways), sentence(text, n=counted, ways=literal(ways))
        rank, n = areas["rank"], sum(one.adopted.lowered_from is not None for one in content.results)
        is_lowered = f'({rank}<>"")*({rank}<{areas["rank_formula"]})'
        lowered = f"SUMPRODUCT({is_lowered}*({areas['basis']}<>{unconfirmed}))"
        text = _("Rows whose class simulation lowers: {n}.")
        yield text.format(n=n), sentence(text, n=lowered)
    file, again = run.provenance.workbook, f"COUNTIF({areas['basis']},{literal(pen.terms.again)})"
    text = _("Rows to be run again, as an input was edited: {n}. They are in no count by class, list or chart. To "
             "count them, make the same changes in {file} and run it again; a report cannot be run.")  # fmt: skip
    yield text.format(n=0, file=file), sentence(text, n=again, file=literal(file))
    yield _("Counts and chances follow the sheets Floors, Items and Assumptions when those are edited."), ""
    yield from ((one.text, "") for one in content.cautions)
    yield from ((one, "") for one in (content.annual.paragraphs[:1] if content.annual else ()))
    if said := route.say_routes(run):
        found = route.list_at_risk(run.route_tables)
        yield _("Evacuation routes: {text}", text=" ".join(said)), ""
        for one in found[:ROUTES]:
            floors, likely = ", ".join(one.floors), one.most_likely_piece
            name = _("{route} (floor {floors})", route=one.route, floors=floors) if floors else one.route
            values = {"route": name, "state": route.say_outlook(one, run.route_tables.risk),
                      "chance": route.say_blocked(one)}  # fmt: skip
            if likely is None or not likely.item or not one.is_fixed:
                yield _("{route}: {state}, blocked in {chance}.", **values), ""
            else:
                yield _("{route}: {state}, blocked in {chance}, most likely by {item}.", **values, item=likely.item), ""
        if more := len(found[ROUTES:]):
            yield ngettext("{n:,} more route at risk is in the sheet Routes.",
                           "{n:,} more routes at risk are in the sheet Routes.", more), ""  # fmt: skip
        yield _("The text on routes is as run: it does not follow when a cell is edited."), ""


Found = Sequence[tuple[int, ItemResult]]
"""Pieces with their places in Items, 1 for the first."""


def _write_worst(plan: _Plan, basis: str, found: Found) -> None:
    pen, page, row, is_ideal = plan.pen, plan.page, plan.lists[basis], plan.content.run.settings.ideal
    is_simulated = basis == "simulated"
    title = _("The pieces most likely to fall: {basis}", basis=pen.terms.bases[basis])
    page.write_string(row, 0, title, pen.style("heading"))
    chances = name_found(is_ideal=is_ideal) if is_simulated else (_("Chance by formula"), "", "", "")
    heads = _("Item"), _("Floor"), _("Room"), _("Pieces"), *chances, _("Class")
    pen.heads(page, heads, WIDTHS, row + 1)
    plain, live, chance = pen.style("text"), pen.style("live"), pen.style("plain", CHANCE)
    looks = (plain, plain, plain, live, *(chance,) * len(AT_RUN), plain)
    areas, order = plan.areas, plan.areas[f"order_{basis}"]
    for number, (place, one) in enumerate(found, 1):
        at, cell = row + 1 + number, f"${xl_col_to_name(PLACE)}{row + 2 + number}"
        known = list_simulated(one, is_ideal=is_ideal) if is_simulated else (listed_chance(one), None, None, None)
        kind = one.item.description or one.item.type
        name = (one.item.item + (f": {kind}" if kind else ""))[:LONGEST]
        label = ", ".join(filter(None, (class_in_force(one), class_notes(one))))
        values = (name, one.item.floor, one.item.room, one.item.quantity, *known, label)
        page.set_row(at, row_height(values, WIDTHS))
        page.write_formula(at, PLACE, f'=IFERROR(MATCH(LARGE({order},{number}),{order},0),"")', None, place)
        of = {key: f"INDEX({areas[key]},{cell})" for key in areas}
        text = f'IF({of["description"]}<>"",": "&{of["description"]},IF({of["type"]}<>"",": "&{of["type"]},""))'
        by_formula = of["chance_run" if basis == "unconfirmed" else plan.content.run.formula.key]
        formulas = [
            f"LEFT({of['item']}&{text},{LONGEST})",
            of["floor"],
            f'{of["room"]}&""',
            of["quantity"],
            *([of[key] for key in AT_RUN] if is_simulated else [by_formula, *['""'] * 3]),
            f'{of["class"]}&IF({of["class_notes"]}="","",", "&{of["class_notes"]})',
        ]
        for column, (formula, value, look) in enumerate(zip(formulas, values, looks, strict=True)):
            page.write_formula(at, column, f'=IF({cell}="","",{formula})', look, "" if value is None else value)
        for risk, label in zip(RiskClass, pen.terms.labels, strict=True):
            is_it = f"LEFT(INDEX({areas['class']},{cell}),{len(label)})={literal(label)}"
            own = listed_chance(one) if class_in_force(one).startswith(label) else ""
            formula = f'=IF({cell}="","",IF({is_it},$E{at + 1},""))'
            page.write_formula(at, CHANCES + risk, formula, None, own)
    if found:
        pen.colour(page, f"I{row + 3}:I{row + 2 + len(found)}")
        pen.bar(page, f"E{row + 3}:E{row + 2 + len(found)}")
    page.set_column(PLACE, CHANCES + len(RiskClass) - 1, 10, None, {"hidden": True})


def _draw(plan: _Plan, row: int, worst: Mapping[str, Found]) -> None:
    """Draw the charts, each of what rests on one basis alone, and set up the printed pages.

    The sheet is printed on one page where there is room; else the tables by floor, and their charts, begin pages.
    """
    pen, page, floors, tables = plan.pen, plan.page, len(plan.content.floors), list(plan.tables.values())
    first = plan.total(plan.bases[-1]) + 2 if plan.bases else plan.top + 6
    for at, basis in enumerate(plan.bases):
        named, found = pen.terms.bases[basis], worst[basis]
        if at == 0:
            charts.add_classes(pen, page, (row, 0), plan.top, named)
        if at == 0 and found:
            rows = (plan.lists[basis] + 2, plan.lists[basis] + 1 + len(found))
            charts.add_highest(pen, page, (row, 3), rows, (0, CHANCES), named)
        top = tables[at] + 2
        charts.add_floors(pen, page, (first + at * charts.count_rows(floors), 0), (top, top + floors - 1), named)
    page.print_area(0, 0, first + len(plan.bases) * charts.count_rows(floors), LAST)
    is_many = floors > 12  # then the summary is printed on several pages
    is_short = not is_many and len(plan.bases) <= 1
    page.fit_to_pages(1, 1 if is_short else 0)
    if not is_short:
        page.set_h_pagebreaks([*list(plan.lists.values())[1:2], *(tables if is_many else tables[:1]), first - 1])


def _list_apart(content: Content) -> list[str]:
    """Return what is counted without a class: rows to be run again, anchored pieces, any that roll, and all pieces."""
    return list(_count_apart(content, ()))


def _count_as_run(results: Sequence[ItemResult], basis: str) -> list[int]:
    own = [one for one in results if (one.apart or one.main_basis) == basis and not one.is_anchored]
    counts = [count_pieces(one for one in own if one.adopted.risk == risk) for risk in RiskClass]
    return [*counts, sum(counts)]


def _count_apart(content: Content, results: Sequence[ItemResult]) -> dict[str, int]:
    """Return the numbers of `_list_apart` of some rows, as run."""
    loose = [one for one in results if not one.is_anchored]
    found = {_("run again"): 0, _("anchored"): count_pieces(results) - count_pieces(loose)}
    if content.total.rolls:
        found[_(words.BASES[ROLLS])] = count_pieces(one for one in loose if one.apart == ROLLS)
    return found | {_("all"): count_pieces(results)}


def _write_floors(plan: _Plan, basis: str) -> None:
    pen, page, content, top, below = plan.pen, plan.page, plan.content, plan.tables[basis], plan.total(basis)
    title = _("Pieces by class and floor: {basis}", basis=pen.terms.bases[basis])
    page.write_string(top, 0, title, pen.style("heading"))
    is_first = basis == plan.bases[0]
    _write_heads(plan, top + 1, _("Floor"), [_("pieces"), *(_list_apart(content) if is_first else ())])
    areas, terms, quantity, letter = plan.areas, pen.terms, plan.areas["quantity"], xl_col_to_name(SUM)
    anchored = f"({areas['held']}={literal(terms.yes)})"
    again = f"({areas['basis']}={literal(terms.again)})"
    bases = (basis, CANNOT_ROCK) if basis == content.run.main_basis else (basis,)
    rests = "+".join(f"({areas['basis']}={literal(terms.bases[one])})" for one in bases)
    classes = [f"({areas['class']}={literal(label)})" for label in terms.labels]
    if basis == "formula":
        outside = (f"({areas['class']}={literal(label + OUTSIDE)})" for label in terms.labels)
        classes = [f"({inside}+{marked})" for inside, marked in zip(classes, outside, strict=True)]
    for number, floor in enumerate(content.floors, 1):
        row = top + 1 + number
        pen.put(page, row, 0, floor.title, pen.style("text"))
        page.set_row(row, row_height([floor.title], WIDTHS))
        on_floor = (
            f"({areas['floor']}={refer(pen.sheets['Floors'])}$A${HEAD + number})"  # SUMIFS takes names for criteria
        )
        formulas = [f"=SUMPRODUCT({on_floor}*(1-{anchored})*({rests})*{one},{quantity})" for one in classes]
        formulas.append(f"=SUM(B{row + 1}:{xl_col_to_name(SUM - 1)}{row + 1})")
        values = _count_as_run(floor.results, basis)
        if is_first:  # what has no class on a floor, and all pieces
            apart = [f"{on_floor}*{again}", f"{on_floor}*(1-{again})*{anchored}"]
            if content.total.rolls:
                apart.append(f"{on_floor}*(1-{anchored})*({areas['basis']}={literal(terms.bases[ROLLS])})")
            sums = [f"{letter}{plan.tables[one] + 2 + number}" for one in plan.bases]
            sums += [f"{xl_col_to_name(SUM + at)}{row + 1}" for at in range(1, 1 + len(apart))]
            formulas += [*(f"=SUMPRODUCT({one},{quantity})" for one in apart), f"={'+'.join(sums)}"]
            values += _count_apart(content, floor.results).values()
        for at, (formula, count) in enumerate(zip(formulas, values, strict=True), 1):
            page.write_formula(row, at, formula, pen.style("live"), count)
    page.write_string(below, 0, _("All floors"), pen.style("total"))
    values = _count_as_run(content.results, basis) + (
        [*_count_apart(content, content.results).values()] if is_first else []
    )
    for at, value in enumerate(values, 1):
        column = xl_col_to_name(at)
        page.write_formula(below, at, f"=SUM({column}{top + 3}:{column}{below})", pen.style("total"), value)


def _write_heads(plan: _Plan, row: int, label: str, more: Sequence[str]) -> None:
    pen, page = plan.pen, plan.page
    page.write_string(row, 0, label, pen.style("head"))
    for at, risk in enumerate(RiskClass, 1):
        page.write_string(row, at, pen.terms.labels[risk], pen.classes[risk])
    for at, text in enumerate(more, SUM):
        page.write_string(row, at, text, pen.style("head"))
