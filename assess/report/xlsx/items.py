"""The columns of the sheet Items in the Excel report: what stands in each, and its live formula."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.inventory import live
from assess.report.content import Content
from assess.report.data import edge
from assess.report.xlsx.pen import Pen
from assess.results import ItemResult

ANCHORED = "⚓ "
"""Mark before the class of an anchored piece, which is that of the piece without its anchor; it is not coloured."""

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""


@dataclass(frozen=True, slots=True)
class ItemColumn:
    """One column of Items: heading, width, and what stands in a row: a value, or a formula with its result."""

    label: str
    width: int
    read: Callable[[ItemResult], Any]
    formula: str = ""
    number_format: str = ""


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture, with live formulas for axis, PFA, risks and class."""
    columns = item_columns(content)
    letters = {column.label: xl_col_to_name(at) for at, column in enumerate(columns)}
    last = HEAD + max(1, len(content.results))
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    for row, one in enumerate(content.results, HEAD):
        cells = {label: f"${letter}{row + 1}" for label, letter in letters.items()}
        for at, column in enumerate(columns):
            form = pen.format(column.number_format) if column.number_format else None
            value = column.read(one)
            if column.formula:
                formula = item_formula(column.formula, cells, HEAD + len(content.floors))
                page.write_formula(row, at, formula, form, "" if value is None else value)
            else:
                pen.put(page, row, at, value, pen.input if column.label in INPUTS else form)
    page.freeze_panes(1, 1)
    page.repeat_rows(0)
    page.autofilter(0, 0, last - 1, len(columns) - 1)
    letter = letters["Class (formula)"]
    pen.colour(page, f"{letter}2:{letter}{last}")
    letter = letters["OR"]
    bar = {"type": "data_bar", "bar_color": "#9db7c9", "bar_solid": True}
    ends = {"min_type": "num", "max_type": "num", "min_value": 0, "max_value": 1}
    page.conditional_format(f"{letter}2:{letter}{last}", bar | ends)


def item_formula(which: str, cells: Mapping[str, str], last: int) -> str:
    """Return a formula of `ItemColumn` for the cells of one row; `last` is the last row of Floors."""
    ratio, pfa, pfv = cells["B/H"], cells["PFA used [g]"], cells["PFV used [cm/s]"]
    breadth, height = cells["Breadth [cm]"], cells["Height [cm]"]
    risk, limits = cells["OR"], ("limit_medium", "limit_high", "limit_very_high")
    shown = f'IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa, limits)},"check")'

    def checked(formula: str) -> str:
        return f'IF(AND(ISNUMBER({ratio}),ISNUMBER({pfa})),{formula},"check")'

    formulas: dict[str, Callable[[], str]] = {
        "ratio": lambda: f'IFERROR(IF(OR({breadth}<=0,{height}<=0),"check",{breadth}/{height}),"check")',
        "axis": lambda: _axis(cells, last),
        "pfa": lambda: _on_axis(cells, "C", "F", last),
        "pfv": lambda: _on_axis(cells, "D", "G", last),
        "raw": lambda: checked(live.equation_9(ratio, pfa)),
        "or": lambda: checked(live.proposed_or(ratio, pfa)),
        "kh": lambda: checked(live.kaneko_hayashi(ratio, height, pfa, pfv, "zeta_a", "zeta_v", "slide_alpha")),
        "class": lambda: f'IF({cells["Anchored"]}="yes","{ANCHORED}","")&{shown}',
    }
    return f"={formulas[which]()}"


def _floor_value(cells: Mapping[str, str], letter: str, last: int) -> str:
    return f"INDEX(Floors!${letter}$2:${letter}${last},MATCH({cells['Floor']},Floors!$A$2:$A${last},0))"


def _axis(cells: Mapping[str, str], last: int) -> str:
    given, x, y = cells["Axis given"], _floor_value(cells, "C", last), _floor_value(cells, "F", last)
    return f'IF({given}<>"",{given},{live.worse_axis(x, y)})'


def _on_axis(cells: Mapping[str, str], for_x: str, for_y: str, last: int) -> str:
    x, y = _floor_value(cells, for_x, last), _floor_value(cells, for_y, last)
    chosen = f'IF({cells["Axis"]}="X",{x},{y})'
    return f'IF({chosen}="","",{chosen})'


INPUTS = ("Quantity", "Breadth [cm]", "Width [cm]", "Height [cm]", "Axis given", "Anchored")


def item_columns(content: Content) -> list[ItemColumn]:
    """Return the columns of Items, in order; those that the workbook had of its own come last."""
    others = [method for method in content.methods if method.key not in ("proposed_or", "kaneko_hayashi")]
    as_run = [ItemColumn(f"{one.title} (as run)", 16, _as_run(one.key, one.words), "", "0.0%") for one in others]
    columns = [*_SIZES, *_LIVE, *as_run, *_REST]
    taken = {column.label for column in columns}
    for at, label in enumerate(content.assessment.inventory.extra_columns):
        name = label if label not in taken else f"{label} (own column)"
        columns.append(ItemColumn(name, 16, _extra(at)))
        taken.add(name)
    return columns


def _value(key: str) -> Callable[[ItemResult], Any]:
    return lambda one: one.governing.methods[key].value


def _class_shown(one: ItemResult) -> str:
    outside = live.OUTSIDE if "extrapolated" in one.governing.methods["proposed_or"].flags else ""
    return (ANCHORED if one.is_anchored else "") + one.adopted.risk.label + outside


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
    ItemColumn("Axis", 6, lambda one: one.governing.demand.axis, "axis"),
    ItemColumn("PFA used [g]", 9, lambda one: edge(one.governing.demand.pfa, "g"), "pfa", "0.000"),
    ItemColumn("PFV used [cm/s]", 9, lambda one: edge(one.governing.demand.pfv, "cm/s"), "pfv", "0.0"),
    ItemColumn("OR raw", 9, lambda one: one.governing.methods["proposed_or"].detail["raw"], "raw", "0.000"),
    ItemColumn("OR", 9, _value("proposed_or"), "or", "0.0%"),
    ItemColumn("Kaneko-Hayashi", 10, _value("kaneko_hayashi"), "kh", "0.0%"),
    ItemColumn("Class (formula)", 16, _class_shown, "class"),
)

_REST = (
    ItemColumn("Marks (as run)", 36, lambda one: ", ".join(flag.replace("_", " ") for flag in one.adopted.flags)),
    ItemColumn("Assumed", 28, lambda one: ", ".join(one.item.assumed)),
    ItemColumn("Friction", 9, lambda one: one.item.friction),
    ItemColumn("Importance", 12, lambda one: one.item.importance),
    ItemColumn("Route", 10, lambda one: one.item.route),
    ItemColumn("Segment", 10, lambda one: one.item.segment),
    ItemColumn("X [m]", 8, lambda one: one.item.x),
    ItemColumn("Y [m]", 8, lambda one: one.item.y),
    ItemColumn("Angle [deg]", 8, lambda one: one.item.angle_deg),
    ItemColumn("Notes", 40, lambda one: one.item.notes),
)
