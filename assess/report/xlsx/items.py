"""The columns of the sheet Items in the Excel report: what stands in each, and its live formula."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.inventory.live import OUTSIDE
from assess.report import words
from assess.report.content import Content
from assess.report.data import edge
from assess.report.xlsx import verified
from assess.report.xlsx.formulas import ANCHORED, VOID, item_formula
from assess.report.xlsx.pen import Pen
from assess.results import ItemResult

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""


@dataclass(frozen=True, slots=True)
class ItemColumn:
    """One column of Items: heading, width, and what stands in a row: a value, or a formula with its result.

    A formula that is `of_verified` rows alone gives way to the value in the others.
    """

    label: str
    width: int
    read: Callable[[ItemResult], Any]
    formula: str = ""
    number_format: str = ""
    of_verified: bool = False


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture, with live formulas for axis, PFA, risks and class."""
    columns = item_columns(content)
    letters = {column.label: xl_col_to_name(at) for at, column in enumerate(columns)}
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    for row, one in enumerate(content.results, HEAD):
        cells = {label: f"${letter}{row + 1}" for label, letter in letters.items()}
        for at, column in enumerate(columns):
            form = pen.format(column.number_format) if column.number_format else None
            value = column.read(one)
            if column.formula and (one.is_verified or not column.of_verified):
                formula = item_formula(column.formula, cells, HEAD + len(content.floors))
                page.write_formula(row, at, formula, form, "" if value is None else value)
            else:
                pen.put(page, row, at, value, pen.input if column.label in INPUTS else form)
    _dress(pen, page, letters, HEAD + max(1, len(content.results)))


def _dress(pen: Pen, page: Any, letters: Mapping[str, str], last: int) -> None:
    """Freeze, filter, hide the workings and colour; `last` is the last row."""
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.repeat_columns(0)
    page.fit_to_pages(3, 0)  # on one page across nobody could read it
    page.autofilter(0, 0, last - 1, len(letters) - 1)
    for column in _WORKINGS:
        letter = letters[column.label]
        page.set_column(f"{letter}:{letter}", column.width, None, {"hidden": True})
    for label in ("Class (formula)", "Class (verified)", "Class"):
        pen.colour(page, f"{letters[label]}2:{letters[label]}{last}")
    area = f"{letters['Class (verified)']}2:{letters['Class (verified)']}{last}"
    void = {"type": "text", "criteria": "begins with", "value": VOID, "format": pen.void}
    page.conditional_format(area, void)
    page.write_comment(f"{letters['Class (verified)']}1", _EXPLAINED, {"x_scale": 3, "y_scale": 2})
    area = f"{letters['OR']}2:{letters['OR']}{last}"
    bar = {"type": "data_bar", "bar_color": "#9db7c9", "bar_solid": True}
    page.conditional_format(area, bar | {"min_type": "num", "max_type": "num", "min_value": 0, "max_value": 1})


INPUTS = ("Quantity", "Breadth [cm]", "Width [cm]", "Height [cm]", "Axis given", "Anchored")

_EXPLAINED = (
    "The class of the verified chance by the limits in Assumptions; at least high where the piece overturns under the "
    "record itself; where its motions are generic or PFV is estimated, never below the class of the formula. Where a "
    "size, the floor, the axis or the motion of the floor was edited since the run it is void: the column Class then "
    "shows the class of the formula until assess is run again."
)


def item_columns(content: Content) -> list[ItemColumn]:
    """Return the columns of Items, in order: at the end those that the workbook had of its own, and hidden workings."""
    others = [method for method in content.methods if method.key not in ("proposed_or", "kaneko_hayashi")]
    as_run = [
        ItemColumn(f"{one.title} (as run)", 23 if any(one.words) else 16, _as_run(one.key, one.words), "", "0.0%")
        for one in others
    ]
    columns = [*_SIZES, *_LIVE, *_VERIFIED, *as_run, *_REST]
    taken = {column.label for column in (*columns, *_WORKINGS)}
    for at, label in enumerate(content.assessment.inventory.extra_columns):
        name = label if label not in taken else f"{label} (own column)"
        columns.append(ItemColumn(name, 16, _extra(at)))
        taken.add(name)
    return [*columns, *_WORKINGS]


def _value(key: str) -> Callable[[ItemResult], Any]:
    return lambda one: one.by_formula.methods[key].value


def _mark(one: ItemResult) -> str:
    return ANCHORED if one.is_anchored else ""


def _class_by_formula(one: ItemResult) -> str:
    outside = OUTSIDE if "extrapolated" in one.by_formula.methods["proposed_or"].flags else ""
    return _mark(one) + one.formula_class.label + outside


def _class_verified(one: ItemResult) -> str:
    return (_mark(one) if one.is_verified else "") + verified.class_verified(one)


def _class_in_force(one: ItemResult) -> str:
    return _mark(one) + one.adopted.risk.label if one.is_verified else _class_by_formula(one)


def _if_verified(read: Callable[[ItemResult], Any]) -> Callable[[ItemResult], Any]:
    return lambda one: read(one) if one.is_verified else None


def _as_run(key: str, criterion: tuple[str, str]) -> Callable[[ItemResult], Any]:
    def read(one: ItemResult) -> Any:
        value = one.governing.methods[key].value
        if value is None:
            return "not evaluated"
        return value if criterion == ("", "") else criterion[0 if value else 1]

    return read


def _extra(at: int) -> Callable[[ItemResult], str]:
    return lambda one: one.item.extra[at] if at < len(one.item.extra) else ""


_SIZES = (
    ItemColumn("Item", 12, lambda one: one.item.item),
    ItemColumn("Floor", 8, lambda one: one.item.floor),
    ItemColumn("Room", 16, lambda one: one.item.room),
    ItemColumn("Description", 32, lambda one: one.item.description),
    ItemColumn("Type", 26, lambda one: one.item.type),
    ItemColumn("Quantity", 9, lambda one: one.item.quantity),
    ItemColumn("Breadth [cm]", 10, lambda one: edge(one.item.breadth, "cm")),
    ItemColumn("Width [cm]", 10, lambda one: edge(one.item.width, "cm")),
    ItemColumn("Height [cm]", 10, lambda one: edge(one.item.height, "cm")),
    ItemColumn("Axis given", 7, lambda one: one.item.axis),
    ItemColumn("Anchored", 10, lambda one: one.item.anchored),
)

_LIVE = (
    ItemColumn("B/H", 8, lambda one: one.item.breadth / one.item.height, "ratio", "0.000"),
    ItemColumn("Axis", 6, lambda one: one.by_formula.demand.axis, "axis"),
    ItemColumn("PFA used [g]", 9, lambda one: edge(one.by_formula.demand.pfa, "g"), "pfa", "0.000"),
    ItemColumn("PFV used [cm/s]", 9, lambda one: edge(one.by_formula.demand.pfv, "cm/s"), "pfv", "0.0"),
    ItemColumn("OR raw", 9, lambda one: one.by_formula.methods["proposed_or"].detail["raw"], "raw", "0.000"),
    ItemColumn("OR", 9, _value("proposed_or"), "or", "0.0%"),
    ItemColumn("Kaneko-Hayashi", 10, _value("kaneko_hayashi"), "kh", "0.0%"),
    ItemColumn("Class (formula)", 16, _class_by_formula, "class"),
)

_VERIFIED = (
    ItemColumn("Verified chance", 9, verified.adopted_chance, "", "0.0%"),
    ItemColumn("Interval low", 9, lambda one: one.adopted.low, "", "0.0%"),
    ItemColumn("Interval high", 9, lambda one: one.adopted.high, "", "0.0%"),
    ItemColumn("Runs", 7, verified.count_runs, "", "#,##0"),
    ItemColumn("Under the record", 34, verified.under_record),
    ItemColumn("Class (verified)", 62, _class_verified, "verified", of_verified=True),
    ItemColumn("Class", 16, _class_in_force, "in_force"),
    ItemColumn("Axis (as run)", 7, lambda one: one.governing.demand.axis),
)
"""What verification found, and the class in force; the columns as run stand for the axis named last."""

_WORKINGS = (
    ItemColumn("Breadth as run [cm]", 24, _if_verified(lambda one: edge(one.item.breadth, "cm"))),
    ItemColumn("Height as run [cm]", 24, _if_verified(lambda one: edge(one.item.height, "cm"))),
    ItemColumn("Floor as run", 24, _if_verified(lambda one: one.item.floor)),
    ItemColumn("Axis given as run", 24, _if_verified(lambda one: one.item.axis)),
    ItemColumn("Edited", 24, lambda one: "", "edited", of_verified=True),
    ItemColumn("Fell under the record", 24, lambda one: "yes" if words.fell_in_record(one) else ""),
    ItemColumn("Chance behind the class", 24, verified.chance_behind),
    ItemColumn("Upper end as run", 24, verified.upper_end),
    ItemColumn("Rank", 24, _if_verified(lambda one: int(one.adopted.risk)), "rank", of_verified=True),
    ItemColumn("Rank, upper", 24, _if_verified(lambda one: int(one.adopted.upper)), "rank_upper", of_verified=True),
    ItemColumn(
        "Rank, formula",
        10,
        _if_verified(lambda one: int(one.formula_class)),
        "rank_formula",
        of_verified=True,
    ),
)
"""Hidden at the far right: the inputs as run, and the classes as numbers from 0, low, to 3."""

_REST = (
    ItemColumn("Marks (as run)", 36, lambda one: ", ".join(flag.replace("_", " ") for flag in one.adopted.flags)),
    ItemColumn("Assumed", 28, lambda one: ", ".join(one.item.assumed)),
    ItemColumn("Friction", 9, lambda one: one.item.friction),
    ItemColumn("Importance", 12, lambda one: one.item.importance),
    ItemColumn("Route", 24, lambda one: one.item.route),
    ItemColumn("Segment", 24, lambda one: one.item.segment),
    ItemColumn("X [m]", 8, lambda one: one.item.x),
    ItemColumn("Y [m]", 8, lambda one: one.item.y),
    ItemColumn("Angle [deg]", 8, lambda one: one.item.angle_deg),
    ItemColumn("Notes", 40, lambda one: one.item.notes),
)
