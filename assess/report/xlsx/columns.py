"""The columns of the sheet Items in the Excel report: what stands in each."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from assess.inventory.columns import ITEMS
from assess.inventory.live import OUTSIDE, say_class
from assess.language import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.data import edge
from assess.report.xlsx import verified
from assess.report.xlsx.pen import with_unit
from assess.report.xlsx.said import ANCHORED
from assess.results import ItemResult

TEXT, INPUT, LIVE, PERCENT, PLAIN = "text", "input", "live", "percent", "plain"
"""How a column looks: wrapped text, an input to edit, what a formula computes, a chance, anything else."""


@dataclass(frozen=True, slots=True)
class ItemColumn:
    """One column of Items: its key for formulas, heading, width, and what stands in a row.

    One that is `live` holds a formula, of which `read` gives the result; one `of_verified` rows alone holds the value
    in the others.
    """

    key: str
    label: str
    width: int
    read: Callable[[ItemResult], Any]
    look: str = PLAIN
    number_format: str = ""
    live: bool = False
    of_verified: bool = False
    hidden: bool = False
    align: str = ""


def item_columns(content: Content) -> list[ItemColumn]:
    """Return the columns of Items, in order: at the end those that the workbook had of its own, and hidden workings."""
    others = [method for method in content.methods if method.key not in ("proposed_or", "kaneko_hayashi")]
    as_run = [
        ItemColumn(
            one.key,
            _("{method} (as run)", method=_(one.title)),
            26 if any(one.words) else 16,
            _as_run(one.key, one.words),
            PLAIN if any(one.words) else PERCENT,
        )
        for one in others
    ]
    workings = _workings()
    columns = [*_sizes(), *_live(), *_verified(hidden=not content.verified.done), *as_run, *_rest()]
    taken = {column.label for column in (*columns, *workings)}
    for at, label in enumerate(content.assessment.inventory.extra_columns):
        name = label if label not in taken else _("{column} (own column)", column=label)
        columns.append(ItemColumn(f"own {at}", name, 16, _extra(at), TEXT))
        taken.add(name)
    return [*columns, *workings]


def _sizes() -> tuple[ItemColumn, ...]:
    return (
        ItemColumn("item", _("Item"), 12, lambda one: one.item.item, TEXT),
        ItemColumn("floor", _("Floor"), 8, lambda one: one.item.floor, TEXT),
        ItemColumn("room", _("Room"), 16, lambda one: one.item.room, TEXT),
        ItemColumn("description", _("Description"), 32, lambda one: one.item.description, TEXT),
        ItemColumn("type", _("Type"), 22, lambda one: one.item.type, TEXT),
        ItemColumn("quantity", _("Quantity"), 9, lambda one: one.item.quantity, INPUT, "#,##0"),
        ItemColumn("breadth", with_unit(_("Breadth"), "cm"), 9, lambda one: edge(one.item.breadth, "cm"), INPUT),
        ItemColumn("width", with_unit(_("Width"), "cm"), 9, lambda one: edge(one.item.width, "cm"), INPUT),
        ItemColumn("height", with_unit(_("Height"), "cm"), 9, lambda one: edge(one.item.height, "cm"), INPUT),
        ItemColumn("axis_given", _("Axis given"), 7, lambda one: one.item.axis, INPUT, align="center"),
        ItemColumn("anchored", _("Anchored"), 10, lambda one: _(one.item.anchored), INPUT),
    )


def _live() -> tuple[ItemColumn, ...]:
    def column(key: str, label: str, width: int, read: Callable[[ItemResult], Any], code: str = "") -> ItemColumn:
        return ItemColumn(key, label, width, read, PERCENT if code == "0.0%" else LIVE, code, live=True)

    return (
        column("ratio", _("B/H"), 8, lambda one: one.item.breadth / one.item.height, "0.000"),
        ItemColumn("axis", _("Axis"), 6, lambda one: one.by_formula.demand.axis, LIVE, live=True, align="center"),
        column("pfa", with_unit(_("PFA used"), "g"), 9, lambda one: edge(one.by_formula.demand.pfa, "g"), "0.000"),
        column("pfv", with_unit(_("PFV used"), "cm/s"), 9, lambda one: edge(one.by_formula.demand.pfv, "cm/s"), "0.0"),
        column("raw", _("OR raw"), 9, lambda one: one.by_formula.methods["proposed_or"].detail["raw"], "0.000"),
        column("or", _("OR"), 9, _value("proposed_or"), "0.0%"),
        column("kh", _("Kaneko-Hayashi"), 10, _value("kaneko_hayashi"), "0.0%"),
        column("class_formula", _("Class (formula)"), 16, _class_by_formula),
    )


def _verified(hidden: bool) -> tuple[ItemColumn, ...]:
    """Return what verification found, and what is in force; the columns as run stand for the axis named last."""

    def column(key: str, label: str, width: int, read: Callable[[ItemResult], Any], look: str = PLAIN) -> ItemColumn:
        return ItemColumn(key, label, width, read, look, hidden=hidden)

    return (
        column("verified_chance", _("Verified chance"), 9, verified.adopted_chance, PERCENT),
        column("low", _("Interval low"), 9, lambda one: one.adopted.low, PERCENT),
        column("high", _("Interval high"), 9, lambda one: one.adopted.high, PERCENT),
        ItemColumn("runs", _("Runs"), 7, verified.count_runs, PLAIN, "#,##0", hidden=hidden),
        column("under_record", _("Under the record"), 20, verified.under_record, TEXT),
        ItemColumn("class_verified", _("Class (verified)"), 40, _class_verified, TEXT, live=True, of_verified=True,
                   hidden=hidden),
        ItemColumn("chance", _("Chance"), 9, chance_in_force, PERCENT, live=True),
        ItemColumn("class", _("Class"), 16, class_in_force, LIVE, live=True),
        column("axis_run", _("Axis (as run)"), 10, lambda one: one.governing.demand.axis),
    )  # fmt: skip


def _rest() -> tuple[ItemColumn, ...]:
    return (
        ItemColumn("marks", _("Marks (as run)"), 60, _marks),
        ItemColumn("assumed", _("Assumed"), 28, lambda one: ", ".join(map(_column_name, one.item.assumed))),
        ItemColumn("friction", _("Friction"), 9, lambda one: one.item.friction),
        ItemColumn("importance", _("Importance"), 12, lambda one: _or_blank(one.item.importance)),
        ItemColumn("route", _("Route"), 24, lambda one: one.item.route, TEXT),
        ItemColumn("segment", _("Segment"), 24, lambda one: one.item.segment, TEXT),
        ItemColumn("x", with_unit(_("X"), "m"), 8, lambda one: one.item.x),
        ItemColumn("y", with_unit(_("Y"), "m"), 8, lambda one: one.item.y),
        ItemColumn("angle", with_unit(_("Angle"), "deg"), 8, lambda one: one.item.angle_deg),
        ItemColumn("notes", _("Notes"), 40, lambda one: one.item.notes, TEXT),
    )


def _workings() -> tuple[ItemColumn, ...]:
    """Return what is hidden at the far right: the inputs as run, and the classes as numbers from 0, low, to 3."""

    def column(key: str, label: str, read: Callable[[ItemResult], Any], **more: Any) -> ItemColumn:
        return ItemColumn(key, label, 24, read, hidden=True, **more)

    formula = {"live": True, "of_verified": True}
    return (
        column(
            "breadth_run", with_unit(_("Breadth as run"), "cm"), if_verified(lambda one: edge(one.item.breadth, "cm"))
        ),
        column("height_run", with_unit(_("Height as run"), "cm"), if_verified(lambda one: edge(one.item.height, "cm"))),
        column("floor_run", _("Floor as run"), if_verified(lambda one: one.item.floor)),
        column("axis_given_run", _("Axis given as run"), if_verified(lambda one: one.item.axis)),
        column("chance_run", _("Chance as run"), if_verified(lambda one: one.adopted.probability)),
        column("edited", _("Edited"), lambda one: "", **formula),
        column("fell", _("Fell under the record"), lambda one: 1 if words.fell_in_record(one) else ""),
        column("behind", _("Chance behind the class"), verified.chance_behind),
        column("upper_end", _("Upper end as run"), verified.upper_end),
        column("rank", _("Rank"), if_verified(lambda one: int(one.adopted.risk)), **formula),
        column("rank_upper", _("Rank, upper"), if_verified(lambda one: int(one.adopted.upper)), **formula),
        column("rank_formula", _("Rank, formula"), if_verified(lambda one: int(one.formula_class)), **formula),
        column("order", _("Order"), lambda one: None, live=True),
    )


def if_verified(read: Callable[[ItemResult], Any]) -> Callable[[ItemResult], Any]:
    """Return what reads a verified row; nothing stands in the others."""
    return lambda one: read(one) if one.is_verified else None


def chance_in_force(one: ItemResult) -> float | None:
    """Return the chance that counts: the adopted one where it was verified, else that of the formula."""
    return one.adopted.probability if one.is_verified else one.by_formula.methods["proposed_or"].value


def class_in_force(one: ItemResult) -> str:
    """Return the class that counts, as the sheet shows it."""
    return _mark(one) + say_class(one.adopted.risk) if one.is_verified else _class_by_formula(one)


def _value(key: str) -> Callable[[ItemResult], Any]:
    return lambda one: one.by_formula.methods[key].value


def _mark(one: ItemResult) -> str:
    return ANCHORED if one.is_anchored else ""


def _class_by_formula(one: ItemResult) -> str:
    outside = OUTSIDE if "extrapolated" in one.by_formula.methods["proposed_or"].flags else ""
    return _mark(one) + say_class(one.formula_class) + outside


def _class_verified(one: ItemResult) -> str:
    return (_mark(one) if one.is_verified else "") + verified.class_verified(one)


def _as_run(key: str, criterion: tuple[str, str]) -> Callable[[ItemResult], Any]:
    said, blank = [_or_blank(word) for word in criterion], _("not evaluated")

    def read(one: ItemResult) -> Any:
        value = one.governing.methods[key].value
        if value is None:
            return blank
        return value if criterion == ("", "") else said[0 if value else 1]

    return read


def _or_blank(text: str) -> str:
    return _(text) if text else ""


def _marks(one: ItemResult) -> str:
    return ", ".join(_(flag.replace("_", " ")) for flag in one.adopted.flags)


def _column_name(name: str) -> str:
    return _(ITEMS.column(name).label)


def _extra(at: int) -> Callable[[ItemResult], str]:
    return lambda one: one.item.extra[at] if at < len(one.item.extra) else ""
