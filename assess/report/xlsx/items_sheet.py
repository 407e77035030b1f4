"""The sheet Items: every row of furniture, with live formulas for axis, PFA, chances and class.

Its columns are the fields of `assess.fields` that Excel shows, with what is live, what simulation found, and, hidden at
the far right, the inputs as run. `item_values` tells what a row holds.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from xlsxwriter.utility import xl_col_to_name

from assess.fields import item_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.xlsx.item_formulas import AT_RUN, BRACKET, ROW, ItemFormulas, build_terms, live_formulas
from assess.report.xlsx.item_values import (
    chance_behind,
    class_by_formula,
    class_by_paper,
    class_in_force,
    class_notes,
    is_as_run,
    list_simulated,
    listed_chance,
    order_number,
    say_bracket_held,
    say_unsettled,
    under_record,
    upper_class,
    upper_end,
)
from assess.report.xlsx.motion_lines import find_places, list_lines
from assess.report.xlsx.pen import CHANCE, COUNT, LINE, LOOKS, Column, Pen, count_lines, of_field, widen, with_unit
from assess.results import BASES, CANNOT_ROCK, ItemResult, Results
from assess.table import Field
from assess.workbook.schema import ITEMS

if TYPE_CHECKING:
    from assess.methods import MethodInfo

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""
FROZEN = 3
"""Columns that stay in view: the item, its class and its upper class."""
MOST_LINES = 6
"""Lines of a row: a longer text is cut by its cell, and whole in it."""

Read = Callable[[ItemResult], Any]

FRONT = (
    "item", "floor", "room", "description", "type", "quantity", "breadth_cm", "width_cm", "height_cm",
    "centre_of_gravity", "axis_given", "anchored", "friction",
)  # fmt: skip
"""The fields that the sheet begins with."""
INPUTS = (
    "quantity", "breadth_cm", "width_cm", "height_cm", "centre_of_gravity", "axis_given", "anchored", "friction",
    *BRACKET,
)  # fmt: skip
"""Those to edit."""
_PLACED = (*FRONT, "breadth_to_height", "axis", "pfa_g", "pfv_cm_s", "pfa_source")
NUMBERS = ("breadth_cm", "width_cm", "height_cm", "friction")
CLASSES = ("class_formula", "class", "class_upper")
LISTED = tuple(basis for basis in BASES if basis != CANNOT_ROCK)
"""What has a list of the pieces most likely to fall."""
ORDERS = tuple(f"order_{basis}" for basis in LISTED)
"""Columns that hold the order of the pieces: each basis has its own list."""


# ---------------------------------------------------------------- columns


def item_columns(results: Results) -> list[Column]:
    """Return the columns of Items, in order: at the end those that the workbook had of its own, and hidden workings."""
    known = {one.key: one for one in item_fields(results.methods)}
    item, *front = (column for key in FRONT for column in _front(key, known))
    is_hidden = not results.has_simulated
    shown = [
        item,
        Column(_("Class"), 16, class_in_force, key="class", look="live", is_live=True),
        Column(_("Upper class"), 16, upper_class, key="class_upper", look="live", is_live=True, is_hidden=is_hidden),
        *front,
        *_live(known, results),
        *_in_force(results),
        *(_as_run(one) for one in results.methods if not one.is_live),
        Column(_("Marks (as run)"), 60, _marks, key="adopted_flags"),
        *(_further(one) for key, one in known.items() if "excel" in one.shows and key not in _PLACED),
    ]
    workings = list(_workings(results))
    return [*shown, *_own(results, {column.label for column in (*shown, *workings)}), *workings]


def has_brackets(results: Results) -> bool:
    """Tell whether it depends on a bracket of known capacity if a piece counts as anchored."""
    return any(one.anchor.bracket_capacity_kn is not None for one in results.item_rows)


def _front(key: str, known: Mapping[str, Field]) -> Iterator[Column]:
    """Yield a column that the sheet begins with; whether a piece counts as anchored stands next to what it says."""
    yield _centre_column() if key == "centre_of_gravity" else _given(known[key])
    if key == "anchored":
        held = known["counts_as_anchored"]
        yield Column(held.heading(), 10, lambda one: say_held(one.is_anchored), key="held", look="live", is_live=True)


def say_held(is_held: bool) -> str:
    """Return whether a piece counts as anchored, as its formula has it."""
    return _("yes") if is_held else _("no")


def _further(field: Field) -> Column:
    """Return a column of what follows no edit: what was computed says so."""
    column = _given(field)
    is_computed = field.place[0] == "anchor" and field.key not in INPUTS
    return replace(column, label=_("{what} (as run)", what=column.label)) if is_computed else column


def _centre_column() -> Column:
    """Return the height of the centre of gravity in percent of the piece's, as in the workbook."""
    field = ITEMS.column("centre_of_gravity")
    return Column(with_unit(_(field.label), field.unit), 9, _centre, "0.#", field.name, "input")


def _given(field: Field) -> Column:
    look = "input" if field.key in INPUTS else "text" if field.kind == "text" else ""
    align = "center" if field.key == "axis_given" else ""
    return of_field(field, read=lambda one: _show(field, one), look=look, align=align)


def _show(field: Field, one: ItemResult) -> Any:
    """Return the value of a field in the language in use; the names of axes are the same in each."""
    value = field.read(one)
    if field.key == "assumed":
        return ", ".join(_(ITEMS.column(name).label) for name in value)
    if isinstance(value, list):
        return ", ".join(map(str, value))
    return _(value) if value and field.choices and "axis" not in field.key else value


def _live(known: Mapping[str, Field], results: Results) -> Iterator[Column]:
    """Yield what formulas compute under the motion that governs."""
    yield of_field(known["breadth_to_height"], look="live", is_live=True)
    yield of_field(known["axis"], look="live", is_live=True, align="center")
    yield of_field(known["pfa_g"], look="live", is_live=True)
    yield of_field(known["pfv_cm_s"], look="live", is_live=True)
    names = live_formulas({})
    for method in (one for one in results.methods if one.is_live):
        for name in (column.name for column in method.columns if f"{method.key}_{column.name}" in names):
            yield of_field(known[f"{method.key}_{name}"], look="live", is_live=True)
        yield of_field(known[method.key], label=_(method.short_title), look="plain", is_live=True)
    yield Column(_("Class (formula)"), 16, class_by_formula, key="class_formula", look="live", is_live=True)
    yield Column(_("Class (OR)"), 16, class_by_paper, key="class_or", look="live", is_live=True)


def _in_force(results: Results) -> Iterator[Column]:
    """Yield what the class rests on, and what simulation found."""
    is_hidden, is_ideal, bases = not results.has_simulated, results.settings.ideal, build_terms().bases

    def column(key: str, label: str, width: int, read: Read, **more: Any) -> Column:
        chosen: dict[str, Any] = {"is_hidden": is_hidden, "look": "text", **more}
        return Column(label, width, read, key=key, **chosen)

    motion = attrgetter("governing.motion.label")
    yield column("basis", _("Basis"), 26, lambda one: bases[one.adopted.basis], is_live=True, is_hidden=False)
    for at, (key, label) in enumerate(zip(AT_RUN, name_found(is_ideal=is_ideal), strict=True)):
        yield column(key, label, 12, _found(at, is_ideal=is_ideal), format=CHANCE, look="plain", is_live=True)
    yield column("class_notes", _("Notes on the class"), 40, class_notes, is_live=True)
    yield column("runs", _("Runs"), 7, _runs, format=COUNT, look="plain")
    yield column("under_record", _("Under the record"), 20, under_record)
    yield column("axis_run", _("Axis (as run)"), 10, lambda one: one.governing.motion.axis)
    yield column("pfa_source", _("Motion used (as run)"), 30, motion)


def name_found(*, is_ideal: bool) -> tuple[str, str, str, str]:
    """Return the headings of `AT_RUN`: the adopted chance, its interval, and the chance to compare it with."""
    like, ideal = _("Chance in an earthquake like this one"), _("Chance if exactly this motion recurred")
    return ideal if is_ideal else like, _("Range low"), _("Range high"), like if is_ideal else ideal


def _found(at: int, *, is_ideal: bool) -> Read:
    return lambda one: list_simulated(one, is_ideal=is_ideal)[at]


def _as_run(method: "MethodInfo") -> Column:
    """Return the value of a method that is not live, a criterion in words."""
    label = _("{method} (as run)", method=_(method.title))

    def read(one: ItemResult) -> Any:
        value = one.governing.methods[method.key].value
        if value is None:
            return _("not evaluated")
        return _(method.words[0 if value else 1]) if method.kind == "criterion" else value

    if method.kind == "criterion":
        return Column(label, 26, read, key=method.key)
    return Column(label, 16, read, CHANCE, key=method.key, look="plain")


def _marks(one: ItemResult) -> str:
    texts = [_(flag.replace("_", " ")) for flag in one.adopted.flags]
    return ", ".join([*texts, *filter(None, (words.say_scanned(one), words.say_bracket(one)))])


def _own(results: Results, taken: set[str]) -> Iterator[Column]:
    """Yield the columns of the workbook that `assess` does not know."""
    for at, label in enumerate(results.provenance.extra_columns):
        name = label if label not in taken else _("{column} (own column)", column=label)
        yield Column(name, 16, _extra(at), key=f"own {at}", look="text")
        taken.add(name)


def _extra(at: int) -> Callable[[ItemResult], str]:
    return lambda one: one.item.extra[at] if at < len(one.item.extra) else ""


def _workings(results: Results) -> Iterator[Column]:
    """Yield what is hidden at the far right: the inputs as run, and the classes as numbers from 0, low, to 3."""
    is_ideal, places = results.settings.ideal, find_places(list_lines(results))

    def column(key: str, label: str, read: Read, **more: Any) -> Column:
        return Column(label, 24, read, key=key, is_hidden=True, **more)

    for key, label, read in _inputs():
        yield column(f"{key}_run", label, read)
    for at, (key, label) in enumerate(zip(AT_RUN, name_found(is_ideal=is_ideal), strict=True)):
        read = _if_as_run(listed_chance) if key == "chance" else _found(at, is_ideal=is_ideal)
        yield column(f"{key}_run", _("{what} (as run)", what=label), read)
    yield column("edited", _("Edited"), lambda one: "", is_live=True)
    yield column("fell", _("Fell under the record"), _if_as_run(lambda one: 1 if one.fell_in_record else ""))
    yield column("behind", _("Chance behind the class"), partial(chance_behind, is_ideal=is_ideal))
    yield column("upper_end", _("Upper end as run"), partial(upper_end, is_ideal=is_ideal))
    yield column("formula_run", _("Largest chance by formula as run"), _if_as_run(lambda one: one.formula.value))
    yield column("formula_pfa_run", _("PFA of that chance as run"), _if_as_run(lambda one: one.by_formula.motion.pfa_g))
    yield column(
        "motion_run", _("Line of the motion in Floors"), _if_as_run(lambda one: places[one.governing.motion.index])
    )
    yield column("held_yes", _("Held if anchored"), lambda one: int(one.item.anchor.holds is not False))
    yield column("held_partly", _("Held if partly anchored"), lambda one: int(one.item.anchor.holds_high is True))
    settle = _("How to settle the class")
    yield column("settle", settle, lambda one: say_unsettled(one) if one.adopted.is_unconfirmed else "")
    yield column("bracket_held", _("Bracket as run"), say_bracket_held)
    yield column("rank", _("Rank"), _if_as_run(lambda one: int(one.adopted.risk)), is_live=True)
    yield column("rank_upper", _("Rank, upper"), _if_as_run(lambda one: int(words.find_highest(one))), is_live=True)
    yield column("rank_formula", _("Rank, formula"), _if_as_run(lambda one: int(one.formula_class)), is_live=True)
    yield column("can_rock", _("Can rock"), lambda one: int(one.adopted.can_rock), is_live=True)
    for key, name in zip(ORDERS, map(build_terms().bases.__getitem__, LISTED), strict=True):
        yield column(key, _("Order: {basis}", basis=name), lambda one: None, is_live=True)


def _inputs() -> Iterator[tuple[str, str, Read]]:
    """Yield the inputs that a simulated class, or a bracket, holds for: key, heading as run, and how each is read."""
    yield "breadth_cm", with_unit(_("Breadth as run"), "cm"), lambda one: one.item.breadth_cm
    yield "width_cm", with_unit(_("Width as run"), "cm"), lambda one: one.item.width_cm
    yield "height_cm", with_unit(_("Height as run"), "cm"), lambda one: one.item.height_cm
    yield "centre_of_gravity", with_unit(_("Centre of gravity as run"), "%"), _centre
    yield "friction", _("Friction as run"), lambda one: one.item.friction
    yield "floor", _("Floor as run"), lambda one: one.item.floor
    yield "axis_given", _("Axis given as run"), lambda one: one.item.axis_given
    yield "bracket_capacity_kn", _("Bracket capacity as run"), lambda one: one.item.anchor.bracket_capacity_kn
    yield "bracket_height_cm", _("Bracket height as run"), lambda one: one.item.anchor.bracket_height_cm
    yield "weight_kg", _("Weight as run"), lambda one: one.item.weight_kg
    yield "rocks_from", _("Share of g b/z from which it may rock"), lambda one: one.adopted.rocks_from


def _centre(one: ItemResult) -> float:
    return 100 * one.item.centre_of_gravity


def _if_as_run(read: Read) -> Read:
    """Return what reads a row whose class rests on a simulation; the others hold nothing."""
    return lambda one: read(one) if is_as_run(one) else None


def _runs(one: ItemResult) -> int | None:
    return one.governing.simulation.runs if one.governing.simulation else None


# ---------------------------------------------------------------- the sheet


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture."""
    columns = widen(item_columns(content.run), content.results, ("text",))
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    _comment(page, columns)  # now: what is above the row being written is left out
    cells = {column.key: f"${xl_col_to_name(at)}{ROW}" for at, column in enumerate(columns)}
    last, lowest = HEAD + len(content.floors), HEAD + len(list_lines(content.run))
    formulas = ItemFormulas(
        cells, pen.refer("Floors"), last, lowest, pen.terms, content.run.formula, content.run.paper_formula
    )
    by_basis = {(basis, is_run): formulas.of(basis, is_run=is_run) for basis in BASES for is_run in (False, True)}
    plan = [(at, column, _style(pen, column)) for at, column in enumerate(columns)]
    texts = [(column.read, column.width) for column in columns if column.look == "text" and not column.is_hidden]
    for row, one in enumerate(content.results, HEAD):
        pen.progress.check()
        lines = max(count_lines(read(one), width, MOST_LINES) for read, width in texts)
        if lines > 1:
            page.set_row(row, LINE * lines)
        _write_row(pen, page, row, one, plan, by_basis[one.adopted.basis, is_as_run(one)])
    _dress(pen, page, columns, HEAD + max(1, len(content.results)))


def _write_row(
    pen: Pen, page: Any, row: int, one: ItemResult, plan: Sequence[tuple[int, Column, Any]],
    formulas: Mapping[str, str],
) -> None:  # fmt: skip
    number = str(row + 1)
    for at, column, form in plan:
        formula = formulas.get(column.key)
        value = order_number(one, row) if formula and column.key in ORDERS else column.read(one)
        if formula:
            page.write_formula(row, at, formula.replace(ROW, number), form, "" if value is None else value)
        elif column.look == "input" or not (value is None or value == ""):
            pen.put(page, row, at, value, form)


def _style(pen: Pen, column: Column) -> Any:
    align = {"align": column.align} if column.align else {}
    return pen.style(column.look if column.look in LOOKS else "plain", column.format, **align)


def item_areas(pen: Pen, content: Content) -> dict[str, str]:
    """Return the cells of each column of Items by its key, as formulas of other sheets refer to them."""
    last, sheet = HEAD + max(1, len(content.results)), pen.refer("Items")
    letters = {column.key: xl_col_to_name(at) for at, column in enumerate(item_columns(content.run))}
    return {key: f"{sheet}${letter}${HEAD + 1}:${letter}${last}" for key, letter in letters.items()}


def _dress(pen: Pen, page: Any, columns: Sequence[Column], last: int) -> None:
    """Freeze, filter, hide the workings, colour, and set up the print; `last` is the last row."""
    letters = {column.key: xl_col_to_name(at) for at, column in enumerate(columns)}
    page.freeze_panes(1, FROZEN)
    page.autofilter(0, 0, last - 1, len(columns) - 1)
    for at, column in enumerate(columns):
        if column.is_hidden:
            page.set_column(at, at, column.width, None, {"hidden": True})
        if column.key in CLASSES:
            pen.colour(page, f"{letters[column.key]}2:{letters[column.key]}{last}")
        elif column.format == CHANCE and column.is_live and column.key not in ("low", "high"):
            pen.bar(page, f"{letters[column.key]}2:{letters[column.key]}{last}")
    again = {"type": "text", "criteria": "begins with", "value": pen.terms.again, "format": pen.style("warning")}
    for key in ("basis", "class"):
        page.conditional_format(f"{letters[key]}2:{letters[key]}{last}", again)
    _validate(page, letters, last)
    _print(page, columns, last)


def _comment(page: Any, columns: Sequence[Column]) -> None:
    comments = _list_comments()
    for at, column in enumerate(columns):
        if column.key in comments:
            page.write_comment(0, at, comments[column.key], {"x_scale": 3, "y_scale": 2})


def _list_comments() -> dict[str, str]:
    return {
        "breadth_cm": _(
            "Edit the coloured cells. Quantity and Anchored change the counts at once. A row that was not simulated "
            "follows by the formula. A row that was simulated says 'run again' once its size, centre of gravity, "
            "friction, axis, floor or the floor's motion is edited: it then leaves all counts, lists and charts. So "
            "does a row held by a bracket of known capacity, and also once its bracket or weight is edited."
        ),
        "class_formula": _(
            "By the limits in Assumptions. * behind a class: outside the range in which the formula was checked. "
            "⚓ before it: anchored, so its risk depends on its anchor; the class is that of the piece without "
            "it."
        ),
        "basis": _(
            "What the class rests on. simulated: the chance found by simulation. formula (not simulated): the "
            "published formula, as nothing was simulated. unconfirmed: nothing is known of the building; or the "
            "formula, as simulation gave a lower class under motions that are too weak. The three are never added up. "
            "cannot rock: low; counted with the run."
        ),
        "beside": _(
            "For comparison. In an earthquake like this one: motion and piece differ from draw to draw. If exactly "
            "this motion recurred: the piece exactly as given, under motions with the spectrum of this one."
        ),
        "class": _(
            "The class in force, by the limits in Assumptions; at least high where the piece overturns under the "
            "record itself. Columns to the right of the notes are not printed."),
        "low": _(
            "The sampling interval; on assumed motion the chances in the slower and the faster third of the draws."
        ),
        "class_upper": _("By the upper end of the range, and at least that of the chance to compare with."),
    }  # fmt: skip


def _validate(page: Any, letters: Mapping[str, str], last: int) -> None:
    """Let cells to edit take only what formulas can work with."""
    choices = [_(word) for word in ITEMS.column("anchored").choices]
    rules: dict[str, dict[str, Any]] = {
        "quantity": {"validate": "integer", "criteria": ">=", "value": 1},
        "axis_given": {"validate": "list", "source": ["X", "Y"]},
        "anchored": {"validate": "list", "source": choices},
        **{key: {"validate": "decimal", "criteria": ">", "value": 0} for key in (*NUMBERS, *BRACKET)},
        "centre_of_gravity": {"validate": "decimal", "criteria": "between", "minimum": 5, "maximum": 95},
    }
    for key, rule in rules.items():
        page.data_validation(f"{letters[key]}2:{letters[key]}{last}", rule)


def _print(page: Any, columns: Sequence[Column], last: int) -> None:
    """Print up to what the class rests on: on one page across, on two where the simulation has columns."""
    page.repeat_rows(0)
    page.repeat_columns(0)
    at = {column.key: place for place, column in enumerate(columns)}
    is_short = columns[at["class_notes"]].is_hidden
    page.print_area(0, 0, last - 1, at["basis" if is_short else "class_notes"])
    page.fit_to_pages(1 if is_short else 2, 0)
