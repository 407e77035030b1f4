"""The sheet Items: every row of furniture, with live formulas for axis, PFA, risks and class."""

from collections.abc import Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.inventory.columns import ANCHORED
from assess.language import gettext as _
from assess.report.content import Content
from assess.report.xlsx.columns import INPUT, LIVE, PERCENT, TEXT, ItemColumn, chance_in_force, item_columns
from assess.report.xlsx.formulas import CLASS_WEIGHT, ROW, Place, item_formulas, unverified
from assess.report.xlsx.pen import LINE, Pen, count_lines
from assess.results import ItemResult
from assess.risk import RiskClass, classify

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""
MOST_LINES = 6
"""Lines of a row: a longer text is cut by its cell, and whole in it."""


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture."""
    columns = item_columns(content)
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    _comment(page, columns)  # now: what is above the row being written is left out
    place = _place(pen, columns, HEAD + len(content.floors))
    verified = item_formulas(place)
    formulas = {True: verified, False: unverified(verified, place.cells, pen.terms)}
    plan = [(at, column, _format(pen, column)) for at, column in enumerate(columns)]
    texts = [(column.read, column.width) for column in columns if column.look == TEXT and not column.hidden]
    for row, one in enumerate(content.results, HEAD):
        lines = max(count_lines(read(one), width, MOST_LINES) for read, width in texts)
        if lines > 1:
            page.set_row(row, LINE * lines)
        _write_row(pen, page, row, one, plan, formulas[one.is_verified])
    _dress(pen, page, columns, HEAD + max(1, len(content.results)))


def _write_row(
    pen: Pen, page: Any, row: int, one: ItemResult, plan: Sequence[tuple[int, ItemColumn, Any]],
    formulas: Mapping[str, str],
) -> None:  # fmt: skip
    number = str(row + 1)
    for at, column, form in plan:
        value = order_number(one, row) if column.key == "order" else column.read(one)
        if column.live and (one.is_verified or not column.of_verified):
            formula = formulas[column.key].replace(ROW, number)
            page.write_formula(row, at, formula, form, "" if value is None else value)
        elif column.look == INPUT or not (value is None or value == ""):
            pen.put(page, row, at, value, form)


def _place(pen: Pen, columns: Sequence[ItemColumn], last: int) -> Place:
    """Return where the formulas of a row look; `last` is the last row of Floors."""
    cells = {column.key: f"${xl_col_to_name(at)}{ROW}" for at, column in enumerate(columns)}
    return Place(cells, pen.refer("Floors"), last, pen.terms)


def _format(pen: Pen, column: ItemColumn) -> Any:
    named = {"num_format": column.number_format, "align": column.align}
    more = {name: value for name, value in named.items() if value}
    if column.look in (INPUT, LIVE):
        return pen.style({INPUT: "Input", LIVE: "Calculation"}[column.look], **more)
    if column.look in (TEXT, PERCENT):
        return {TEXT: pen.wrap, PERCENT: pen.percent}[column.look]
    return pen.format(column.number_format or "General", valign="top")


def order_number(one: ItemResult, row: int) -> float | None:
    """Return the number by which pieces stand in order, as the formula of its row has it; None for anchored ones."""
    chance = chance_in_force(one)
    if one.is_anchored or chance is None:
        return None
    upper = one.adopted.upper if one.is_verified else classify(chance)
    return CLASS_WEIGHT * int(upper or RiskClass.LOW) + chance - (row + 1) * 1e-9


def item_areas(pen: Pen, content: Content) -> dict[str, str]:
    """Return the cells of each column of Items by its key, as formulas of other sheets refer to them."""
    last, sheet = HEAD + max(1, len(content.results)), pen.refer("Items")
    letters = {column.key: xl_col_to_name(at) for at, column in enumerate(item_columns(content))}
    return {key: f"{sheet}${letter}${HEAD + 1}:${letter}${last}" for key, letter in letters.items()}


def _dress(pen: Pen, page: Any, columns: Sequence[ItemColumn], last: int) -> None:
    """Freeze, filter, hide the workings, colour, and set up the print; `last` is the last row."""
    letters = {column.key: xl_col_to_name(at) for at, column in enumerate(columns)}
    page.freeze_panes(1, 1)
    page.autofilter(0, 0, last - 1, len(columns) - 1)
    for at, column in enumerate(columns):
        if column.hidden:
            page.set_column(at, at, column.width, None, {"hidden": True})
    for key in ("class_formula", "class_verified", "class"):
        pen.colour(page, f"{letters[key]}2:{letters[key]}{last}")
    for key in ("or", "kh", "verified_chance", "chance"):
        pen.bar(page, f"{letters[key]}2:{letters[key]}{last}")
    area = f"{letters['class_verified']}2:{letters['class_verified']}{last}"
    void = {"type": "text", "criteria": "begins with", "value": pen.terms.void, "format": pen.void}
    page.conditional_format(area, void)
    _validate(page, letters, last)
    _print(page, columns, last)


def _comment(page: Any, columns: Sequence[ItemColumn]) -> None:
    comments = {
        "breadth": _(
            "Edit the coloured cells: chance, class, counts and charts follow. The columns as run hold what was run."
        ),
        "class_formula": _(
            "By the limits in Assumptions. * behind a class: outside the range in which the formula was checked by "
            "tests. ⚓ before it: anchored, so only as safe as its anchor; the class is that of the piece without it."
        ),
        "class_verified": _(
            "The class of the verified chance by the limits in Assumptions; at least high where the piece overturns "
            "under the record itself; where its motions are generic or PFV is estimated, never below the class of the "
            "formula. Where a size, the floor, the axis or the motion of the floor was edited since the run it is "
            "void: the column Class then shows the class of the formula until assess is run again."
        ),
        "class": _(
            "Chance and class in force: by verification where there is one and it holds, else by the formula. Columns "
            "to the right are not printed."
        ),
    }
    for at, column in enumerate(columns):
        if column.key in comments:
            page.write_comment(0, at, comments[column.key], {"x_scale": 3, "y_scale": 2})


def _validate(page: Any, letters: Mapping[str, str], last: int) -> None:
    """Let cells to edit take only what formulas can work with."""
    rules: dict[str, dict[str, Any]] = {
        "quantity": {"validate": "integer", "criteria": ">=", "value": 1},
        "axis_given": {"validate": "list", "source": ["X", "Y"]},
        "anchored": {"validate": "list", "source": [_(word) for word in ANCHORED]},
    }
    rules |= {key: {"validate": "decimal", "criteria": ">", "value": 0} for key in ("breadth", "width", "height")}
    for key, rule in rules.items():
        page.data_validation(f"{letters[key]}2:{letters[key]}{last}", rule)


def _print(page: Any, columns: Sequence[ItemColumn], last: int) -> None:
    """Print up to the class in force: on one page across, on two where the columns of the verification are shown."""
    page.repeat_rows(0)
    page.repeat_columns(0)
    printed = next(at for at, column in enumerate(columns) if column.key == "class")
    page.print_area(0, 0, last - 1, printed)
    is_verified = not next(column for column in columns if column.key == "class_verified").hidden
    page.fit_to_pages(2 if is_verified else 1, 0)
