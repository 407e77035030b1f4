"""The columns of the tables in a document: heading, alignment and text of each follow from the fields of the results.

HTML, PDF, Word and the compact lists show the same columns; the styles hold how wide each is, by its key.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from assess.fields import MOTION_FIELDS, item_fields, route_fields
from assess.i18n import gettext as _, number
from assess.report import measures, words
from assess.report.blocks import Cell, Column, Runs, Span, Table, Words, join_words, note, table
from assess.report.say.ground import describe_origin, describe_source
from assess.report.say.piece import describe
from assess.results import ItemResult, Results
from assess.route_results import BesideRow, FloorRoutesRow, RoomRow, RouteRow, SegmentRow
from assess.table import Field, Where

if TYPE_CHECKING:
    from assess.methods import MethodInfo

NUMBERS = ("number", "count", "share")
COMPACT: Mapping[str, int] = {
    "item": 12, "floor": 6, "room": 14, "description": 30, "quantity": 5, "breadth_to_height": 6,
    "axis": 5, "pfa_g": 7, "pfv_cm_s": 10,
}  # fmt: skip
"""Places of a column in a compact list, by key."""
SIMULATED = frozenset(("verification_record_overturned", "verification_ideal_probability"))
"""Left out where nothing was simulated."""
NOT_COMPACT = frozenset(("verification_record_overturned", "adopted_class", "adopted_flags"))


@dataclass(frozen=True, slots=True)
class PageColumn:
    """One column of a table on a page, by the `key` of a field, or of what is composed of several: styles go by it.

    `text` says what the cell of a row says, `show` what it shows where that is more, such as the badge of a class,
    `sort` what it is sorted by; `line` and `line_heading` are for a compact list, where they differ, and `places` the
    characters there, 0 where it is left out. The numbers of a wide column may take two lines.
    """

    key: str
    heading: str
    text: Callable[[Any], str]
    is_number: bool = False
    sort: Callable[[Any], Any] | None = None
    places: int = 0
    line: Callable[[Any], str] | None = None
    line_heading: str = ""
    show: Callable[[Any], Words] | None = None
    is_wide: bool = False
    is_method: bool = False

    @property
    def column(self) -> Column:
        """The column of a table; its width goes by its key, of every method the same."""
        width = "method" if self.is_method else self.key.replace("_", "-")
        label, bracket, unit = self.heading.rpartition(" [")
        heading: Words = [f"{label} ", Span(f"[{unit}", "unit")] if bracket else self.heading
        return Column(heading, width, self.is_number)

    def cell(self, one: Any, *, can_sort: bool = False) -> Cell | Words:
        """Return the cell of a row."""
        shown = (self.show or self.text)(one)
        kind = "size" if self.key == "size" else "wraps" if self.is_wide and self.is_number else ""
        if not can_sort or self.sort is None:
            return Cell(shown, kind) if kind or can_sort else shown
        value = self.sort(one)
        return Cell(shown, kind, sort="" if value is None else value)


def build_table(columns: Sequence[PageColumn], rows: Iterable[Any], kind: str, caption: Words = "") -> Table:
    """Return a table of rows by columns."""
    cells = ([column.cell(row) for column in columns] for row in rows)
    return table([one.column for one in columns], cells, kind, caption, is_named=True)


def of_field(field: Field, **more: Any) -> PageColumn:
    """Return the column of a field of the results; `more` are parameters of `PageColumn` that differ."""
    is_number = field.kind in NUMBERS
    heading = field.short_heading().replace(f"[{field.unit}]", f"[{measures.unit(field.unit)}]")
    column = PageColumn(field.key, heading, lambda row: format_value(field, field.read(row)), is_number,
                        sort=field.read if is_number else None)  # fmt: skip
    return replace(column, **more)


def format_value(field: Field, value: Any) -> str:
    """Return a value as a page shows it, by the kind and the format of its field: a dash for what is unknown."""
    if value is None or value == "":
        return "" if field.kind == "text" else words.DASH
    if field.kind == "share":
        return words.percent(value)
    if field.kind == "count":
        return number(value, ",d")
    if field.unit in ("m", "cm"):
        return measures.show(value, field.unit)
    if field.kind == "number":
        value = measures.convert(value, field.unit)
        return words.fixed(value, len(field.format.partition(".")[2].rstrip("%")) if field.format else 1)
    if field.kind == "flag":
        return words.yes_or_no(value)
    if field.kind == "list":
        value = ", ".join(_(str(one)) for one in value)
    elif field.choices or field.kind == "class":
        value = value if "axis" in field.key else _(value)
    return words.cut(str(value), 20 if field.key == "floor" else 40)


# ---------------------------------------------------------------- signs


def badge(one: ItemResult) -> Words:
    """Return the class of a piece as a badge, with its notes in words."""
    if one.is_anchored:
        free = ", ".join(words.list_risk_words(one))
        return [
            Span(f"{words.ANCHORED} " + _("depends on its anchor"), "badge anchored"),
            note(" (" + _("free-standing: {words}", words=free) + ")"),
        ]
    sign = Span(words.class_label(one), f"badge {words.style_name(one)}")
    apart, notes = [note(f" {words.apart_note(one)}")] if one.apart else [], words.risk_notes(one)
    return [sign, *apart, *([note(f", {', '.join(notes)}")] if notes else [])]


def mark(one: ItemResult) -> Runs:
    """Return the class of a piece as a badge, where there is no room for more words."""
    if one.is_anchored:
        doubt = note(words.say_bracket(one)) if words.has_doubtful_bracket(one) else ""
        return join_words((Span(words.apart_label("anchored"), "badge anchored"), doubt))
    return [Span(words.class_span(one), f"badge {words.style_name(one)}")]


def flags(names: Iterable[str]) -> Words:
    """Return flags as marks."""
    return join_words(Span(say_flag(name), "flag") for name in names)


def _show_flags(one: ItemResult) -> Words:
    further = words.list_remarks(one)
    return join_words([flags(one.adopted.flags), note("; ".join(further)) if further else ""])


# ---------------------------------------------------------------- pieces


def list_columns(results: Results, where: Where) -> tuple[PageColumn, ...]:
    """Return the columns of a list of pieces: every field that it shows, in their order."""
    methods = {one.key: one for one in results.methods}
    left_out = frozenset() if results.has_simulated else SIMULATED
    found = [field for field in item_fields(results.methods) if where in field.shows and field.key not in left_out]
    composed: Mapping[str, Mapping[str, Any]] = {
        "breadth_cm": {"key": "size", "text": words.size, "sort": lambda one: one.item.height_cm, "places": 17},
        "adopted_probability": {"text": words.chance, "places": 25, "is_wide": True},
        "verification_record_overturned": {"text": words.under_record},
        "verification_ideal_probability": {"text": words.ideal_chance, "places": 25, "is_wide": True},
        "adopted_class": {
            "text": words.risk_words,
            "show": badge,
            "sort": lambda one: int(one.adopted.risk) - (10 if one.is_anchored else 0),
        },
        "adopted_flags": {
            "text": lambda one: ", ".join([*map(say_flag, one.adopted.flags), *words.list_remarks(one)]),
            "show": _show_flags,
        },
        "description": {  # stands for the type where there is none
            "text": lambda one: (
                words.cut(one.item.description or one.item.type, 120) if where == "pieces" else describe(one, 60)
            ),
            "line": lambda one: describe(one, COMPACT["description"]),
        },
    }
    columns = []
    for field in found:
        column = of_field(field, places=0 if field.key in NOT_COMPACT else COMPACT.get(field.key, field.width))
        method = methods.get(field.key)
        own = composed.get(field.key, {})
        columns.append(replace(column, **own) if method is None else _of_method(column, where, method))
    if not results.has_simulated:
        columns = [replace(one, places=7) if one.key == "adopted_probability" else one for one in columns]
    if where == "methods":
        columns.append(PageColumn("marks", _("Marks"), lambda one: ", ".join(map(say_flag, list_flags(one))),
                                  show=lambda one: flags(list_flags(one))))  # fmt: skip
    return tuple(columns)


def short_columns(results: Results, *keys: str) -> tuple[PageColumn, ...]:
    """Return columns of pieces by key for a table with little room."""
    known = {one.key: one for one in list_columns(results, "risky")}
    longest = 28 if "place" in keys else 40
    known["piece"] = PageColumn("piece", _("Piece"),
                                lambda one: f"{words.cut(one.item.item, 14)}: {describe(one, longest)}")  # fmt: skip
    known["place"] = PageColumn(
        "place", _("Floor, room"),
        lambda one: ", ".join(filter(None, (words.cut(one.item.floor, 8), words.cut(one.item.room, 18)))),
    )  # fmt: skip
    known["formula"] = PageColumn("formula", _("By formula"), _format_formula)
    known["chance"] = replace(known["adopted_probability"], key="chance", heading=_("Chance (interval)"))
    known["room_short"] = replace(known["room"], text=lambda one: words.cut(one.item.room, 14))
    known["ideal"] = PageColumn("ideal", _("If exactly this motion recurred"), words.ideal_chance,
                                is_number=True, is_wide=True)  # fmt: skip
    known["class"] = replace(known["adopted_class"], key="class", show=mark)
    return tuple(known[key] for key in keys)


def list_flags(one: ItemResult) -> list[str]:
    """Return the flags of all methods under the governing motion, each once."""
    return list(dict.fromkeys(flag for found in one.governing.methods.values() for flag in found.flags))


def say_flag(flag: str) -> str:
    """Return a flag in words."""
    return _(flag.replace("_", " "))


def _format_formula(one: ItemResult) -> str:
    """Return the class by formula and its chance; behind an arrow a larger one under another motion of the row."""
    found, worst = one.governing.methods[one.formula_key].value, one.formula.value
    more = f" → {words.percent(worst)}" if has_worse_motion(one, one.formula_key) else ""
    return f"{words.risk_label(one.formula_class)}, {words.percent(found)}{more}"


def _of_method(column: PageColumn, where: Where, method: "MethodInfo") -> PageColumn:
    """Return the column of a method: with the value as printed in the list of all pieces, under its title elsewhere."""
    is_chance = method.kind == "probability"
    raw = next((one for one in method.columns if one.name == "raw" and where == "pieces"), None)

    def say(value: float | None) -> str:
        return words.percent(value) if is_chance or value is None else _(method.words[0 if value else 1])

    def text(one: ItemResult) -> str:
        found, worst = one.governing.methods[method.key], one.worst(method.key)
        if raw is not None:
            value = found.detail[raw.name]
            return f"{say(found.value)} ({words.fixed(value if isinstance(value, float) else None, 3)})"
        has_more = where == "methods" and has_worse_motion(one, method.key)
        return f"{say(found.value)} → {say(worst)}" if has_more else say(found.value)

    name = method.short_title if where == "pieces" else method.title
    title = _(name)
    return replace(
        column, heading=_("{title} (raw)", title=title) if raw else title, text=text,
        line=lambda one: say(one.governing.methods[method.key].value), line_heading=title, is_number=is_chance,
        places=7 if where == "pieces" else max(map(len, map(_, method.words))) if any(method.words) else 17,
        is_wide=raw is not None, is_method=True,
    )  # fmt: skip


def has_worse_motion(one: ItemResult, key: str) -> bool:
    """Tell whether a method gives more under another motion of the item than under the governing one."""
    governing, worst = one.governing.methods[key].value, one.worst(key)
    return worst is not None and (governing is None or worst > governing + 0.0005)


# ---------------------------------------------------------------- floors and routes


def motion_columns(*keys: str) -> tuple[PageColumn, ...]:
    """Return columns of the motions of floors by key."""
    known = {one.key: of_field(one) for one in MOTION_FIELDS}
    known["source"] = PageColumn("source", _("Source"), describe_source)
    known["origin"] = PageColumn("origin", _("Record, or how it was computed"), describe_origin)
    return tuple(known[key] for key in keys)


ROUTE_TABLES: Mapping[str, tuple[type, tuple[str, ...]]] = {
    "routes": (RouteRow, (
        "route", "floors", "state", "blocked_probability", "blocked_or_reduced_probability", "blocked_is_joint",
        "blocked_if_anchors_fail_probability", "most_likely_piece",
    )),
    "rooms": (RoomRow, (
        "room", "floor", "exits", "state", "loses_every_exit_probability", "loses_if_anchors_fail_probability",
        "most_likely_piece", "ways",
    )),
    "floors": (FloorRoutesRow, (
        "floor", "segments", "blocked_segments_expected", "unknown_segments", "routes", "blocked_routes_expected",
        "unknown_routes", "rooms", "cut_off_rooms_expected", "unknown_rooms", "any_room_cut_off_probability",
        "uncounted_pieces",
    )),
    "segments": (SegmentRow, (
        "segment", "floor", "from_place", "clear_width_used_m", "required_width_used_m", "standing_width_m",
        "least_width_m", "state", "blocked_probability", "blocked_independent", "blocked_or_reduced_probability",
        "needed_width_m",
    )),
    "beside": (BesideRow, (
        "item", "by_plan", "distance_m", "reach_m", "left_m", "blocks_alone", "falls_while_blocked",
    )),
}  # fmt: skip
"""The columns of the tables on evacuation routes by the keys of their fields."""
SENTENCES = frozenset(("needed_width_m",))
"""Numbers that stand in a sentence with others."""
ANCHORS = frozenset(("blocked_if_anchors_fail_probability", "loses_if_anchors_fail_probability"))
"""Left out where no piece is anchored."""
DOUBTFUL = frozenset(("unknown_segments", "unknown_routes", "unknown_rooms"))
"""Left out where all is known."""


def route_columns(*, has_anchors: bool, has_unknown: bool = False) -> dict[str, tuple[PageColumn, ...]]:
    """Return the columns of every table on evacuation routes; the captions give the unit of widths."""
    left_out = (frozenset() if has_anchors else ANCHORS) | (frozenset() if has_unknown else DOUBTFUL)
    return {
        name: tuple(
            of_field(one, heading=_(one.short or one.label), is_number=one.kind in NUMBERS and one.key not in SENTENCES)
            for one in (route_fields(row)[key] for key in keys if key not in left_out)
        )
        for name, (row, keys) in ROUTE_TABLES.items()
    }
