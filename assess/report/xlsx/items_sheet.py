"""The sheet Items: every row of furniture, with live formulas for axis, PFA, chances and class.

Its columns are the fields of `assess.fields` that Excel shows, with what is live, what simulation found, and, hidden at
the far right, the inputs as run. A column reads what a row holds as run; `item_formulas` computes the same from cells.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from xlsxwriter.utility import xl_col_to_name

from assess.fields import item_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.page_columns import say_flag
from assess.report.xlsx.floors_sheet import list_lines
from assess.report.xlsx.item_formulas import (
    ANCHORED,
    AT_RUN,
    BRACKET,
    CLASS_WEIGHT,
    ROLLING,
    ROW,
    SAME,
    SAME_WORDS,
    ItemFormulas,
    build_terms,
    live_formulas,
)
from assess.report.xlsx.pen import CHANCE, COUNT, HEAD, LINE, Column, Pen, count_lines, of_field, refer, widen
from assess.results import BASES, CANNOT_ROCK, ROLLS, CaseRow, ItemResult, MethodResult, Results
from assess.risk import RiskClass, classify
from assess.table import Field
from assess.workbook.formulas import OUTSIDE, say_class
from assess.workbook.schema import BUILDING, ITEMS

if TYPE_CHECKING:
    from assess.methods import MethodInfo


Read = Callable[[ItemResult], Any]

FRONT = (
    "item", "floor", "room", "description", "type", "quantity", "breadth_cm", "width_cm", "height_cm",
    "centre_of_gravity", "axis_given", "anchored", "friction",
)  # fmt: skip
"""The fields that the sheet begins with."""
INPUTS = (*FRONT[FRONT.index("quantity") :], *BRACKET)
"""Those to edit."""
UNDER_MOTION = ("breadth_to_height", "axis", "pfa_g", "pfv_cm_s")
"""The fields that formulas compute under the motion that governs."""
LISTED = tuple(basis for basis in BASES if basis not in (CANNOT_ROCK, ROLLS))
"""What has a list of the pieces most likely to fall."""
ORDERS = tuple(f"order_{basis}" for basis in LISTED)
"""Columns that hold the order of the pieces: each basis has its own list."""


def is_as_run(one: ItemResult) -> bool:
    """Tell whether its class holds for the inputs as run alone: it rests on what a simulation found.

    So does, in a run that simulated others, one that cannot rock; else that follows its inputs as the formula does.
    """
    return (one.main_basis if not one.adopted.can_rock else one.adopted.basis) != "formula"


def say_inputs_that_settle(one: ItemResult) -> str:
    """Return what to fill in or change so that the class of an unconfirmed piece rests on simulation."""
    building = {name: _(BUILDING.column(name).label) for name in ("storeys", "period")}
    texts = {
        "unknown_building": _("fill in {storeys} or {period} in {sheet}", sheet=_(BUILDING.name), **building),
        "weak_motions": _("use stronger motions"),
    }
    return ", ".join(text for flag, text in texts.items() if flag in one.adopted.flags)


def say_unsettled(one: ItemResult) -> str:
    """Return how to settle the class of an unconfirmed piece; "" of any other."""
    return _("to settle it, {how}", how=say_inputs_that_settle(one)) if one.adopted.is_unconfirmed else ""


def list_simulated(one: ItemResult, *, is_ideal: bool) -> tuple[float | None, ...]:
    """Return the adopted chance of a simulated piece, its range, and the chance to compare it with.

    That is the chance if exactly this motion recurred; with `is_ideal`, where this one is adopted, the chance in an
    earthquake like it.
    """
    adopted, found = one.adopted, one.governing.simulation
    if not adopted.is_simulated or found is None:
        return (None,) * 4
    exact = None if found.ideal is None else found.ideal.probability
    beside = found.probability if is_ideal else exact
    return adopted.probability, *(words.find_range(one) or (None, None)), beside


def listed_chance(one: ItemResult) -> float | None:
    """Return the chance by which it stands in the list of its basis."""
    return one.adopted.probability if is_as_run(one) else one.formula.value


def chance_behind(one: ItemResult, *, is_ideal: bool) -> float | None:
    """Return the chance by which it is classed at any limits; None if nothing was simulated.

    It is the largest under any of its motions. Where simulation may not lower a class, a larger chance of the formula
    counts; where nothing is known of the building, that of the faster third of the draws.
    """

    def chance(case: CaseRow) -> float:
        formula, found, adopted = case.methods[one.formula_key].value or 0.0, case.simulation, case.adopted
        if adopted.basis == ROLLS:
            return adopted.probability
        if adopted.is_unconfirmed and adopted.has_simulated:
            return max(adopted.probability, (found and found.if_faster) or 0.0)
        if found is None or adopted.is_simulated:  # the adopted one may be that of a fall along either axis
            return max(formula, adopted.probability) if adopted.is_doubtful else adopted.probability
        return max(formula, found.ideal.probability if is_ideal and found.ideal else found.probability)

    if not one.adopted.can_rock:
        return 0.0 if is_as_run(one) else None
    return max(map(chance, one.cases)) if is_as_run(one) else None


def upper_end(one: ItemResult, *, is_ideal: bool) -> float | None:
    """Return the chance behind the upper class: the highest upper end of its ranges, or a higher ideal chance."""
    if not one.adopted.can_rock:
        return None
    ends = [case.adopted.high for case in one.cases if case.adopted.high is not None]
    ends += [thirds[1]] if not one.apart and (thirds := words.find_thirds(one)) else []
    for found in (case.simulation for case in one.cases if case.simulation):
        exact = found.ideal
        ends += [found.high] if exact is None else [exact.high] if is_ideal else [found.high, exact.probability]
    return max(ends, default=None)


def under_record(one: ItemResult) -> str:
    """Return its response to the recorded motion itself, the worst of several; "" where no record is known."""
    ratios = {
        case.motion.axis: (found.record_overturned, found.record_max_rotation_ratio or 0.0)
        for case in one.cases
        if (found := case.simulation) is not None and found.record_overturned is not None
    }
    if not ratios:
        return ""
    worst, text = max(ratios, key=lambda axis: ratios[axis]), words.under_record(one)
    return text if worst == one.governing.motion.axis else _("{what} (along {axis})", what=text, axis=worst)


def _class(one: ItemResult, risk: RiskClass, found: MethodResult | None = None) -> str:
    """Return a class as the sheet shows it, marked where the method that gave it was not checked."""
    is_outside = found is not None and one.adopted.can_rock and "extrapolated" in found.flags
    return (
        (ANCHORED if one.is_anchored else ROLLING if one.apart == ROLLS else "")
        + say_class(risk)
        + OUTSIDE * is_outside
    )


def class_in_force(one: ItemResult) -> str:
    """Return the class that counts, as the sheet shows it."""
    if is_as_run(one) or not one.adopted.can_rock:
        return _class(one, one.adopted.risk)
    return _class(one, one.formula_class, one.formula)


def class_notes(one: ItemResult) -> str:
    """Return the remarks on the class."""
    adopted, highest = one.adopted, words.find_highest(one)
    texts = [
        say_unsettled(one),
        words.could_be(say_class(highest)) if highest > adopted.risk else "",
        "" if adopted.lowered_from is None else words.was_lowered(say_class(adopted.lowered_from)),
        _("as it overturns under the record itself") if is_as_run(one) and one.fell_in_record else "",
        say_bracket_held(one),
    ]
    return ", ".join(filter(None, texts))


def say_bracket_held(one: ItemResult) -> str:
    """Return the remark on the bracket by which a piece counts as anchored; "" for other pieces."""
    return words.say_bracket(one) if one.is_anchored and is_as_run(one) else ""


def order_number(one: ItemResult, row: int) -> float | None:
    """Return the number by which pieces stand in order, as the formula of its row has it; None for anchored ones."""
    chance = listed_chance(one)
    if one.is_anchored or chance is None or not one.adopted.can_rock:
        return None
    upper = words.find_highest(one) if is_as_run(one) else classify(chance)
    return CLASS_WEIGHT * int(upper or RiskClass.LOW) + chance - (row + 1) * 1e-9


def item_columns(results: Results) -> list[Column]:
    """Return the columns of Items, in order, the workbook's own columns and hidden workings last."""
    known, is_hidden = {one.key: one for one in item_fields(results.methods)}, not results.has_simulated

    def live(key: str, label: str, width: int, read: Read, **more: Any) -> Column:
        return Column(label, width, read, key=key, look="live", **more)

    shown = []
    for key in FRONT:
        if key == "centre_of_gravity":  # in percent of the piece's height, as in the workbook
            centre = ITEMS.column(key)
            label = f"{_(centre.label)} [{centre.unit}]"
            shown.append(Column(label, 9, lambda one: 100 * one.item.centre_of_gravity, "0.#", key, "input"))
        else:
            shown.append(_given(known[key]))
        if key == "item":
            shown += [
                live("class", _("Class"), 16, class_in_force),
                live("class_upper", _("Upper class"), 16, is_hidden=is_hidden,
                     read=lambda one: _class(one, words.find_highest(one)) if is_as_run(one) else ""),
            ]  # fmt: skip
        if key == "anchored":  # whether a piece counts as anchored stands next to what it says
            held = known["counts_as_anchored"].heading()
            shown.append(live("held", held, 10, lambda one: words.yes_or_no(one.is_anchored)))
    for key in UNDER_MOTION:
        shown.append(of_field(known[key], look="live", align="center" if key == "axis" else ""))
    names = live_formulas({})
    for method in (one for one in results.methods if one.is_live):
        keys = (f"{method.key}_{column.name}" for column in method.columns)
        shown += [of_field(known[key], look="live") for key in keys if key in names]
        shown.append(of_field(known[method.key], label=_(method.short_title), look="plain"))
    shown += [
        live("class_formula", _("Class (formula)"), 16, lambda one: _class(one, one.formula_class, one.formula)),
        live("class_or", _("Class (OR)"), 16,
             lambda one: _class(one, one.paper_class, one.governing.methods[one.paper_key])),
        *_list_found(results),
        *(_of_method(one) for one in results.methods if not one.is_live),
        Column(_("Marks (as run)"), 60, key="adopted_flags", read=lambda one: ", ".join(
            filter(None, (*map(say_flag, one.adopted.flags), words.say_scanned(one), words.say_bracket(one))))),
    ]  # fmt: skip
    for key, field in known.items():
        if "excel" in field.shows and key not in (*FRONT, *UNDER_MOTION, "pfa_source"):
            column = _given(field)
            if field.place[0] == "anchor" and key not in INPUTS:  # what was computed, and follows no edit, says so
                column = replace(column, label=_("{what} (as run)", what=column.label))
            shown.append(column)
    workings = list(_list_workings(results, {one.key: one for one in shown}))
    taken = {column.label for column in (*shown, *workings)}
    for at, label in enumerate(results.provenance.extra_columns):  # of the workbook, which `assess` does not know
        name = label if label not in taken else _("{column} (own column)", column=label)
        read = partial(lambda at, one: one.item.extra[at] if at < len(one.item.extra) else "", at)
        shown.append(Column(name, 16, read, key=f"own {at}", look="text"))
        taken.add(name)
    return [*shown, *workings]


def _given(field: Field) -> Column:
    def read(one: ItemResult) -> Any:
        value = field.read(one)
        if field.key == "assumed":
            return ", ".join(_(ITEMS.column(name).label) for name in value)
        if isinstance(value, list):
            return ", ".join(map(str, value))
        is_word = value and field.choices and "axis" not in field.key  # the names of axes are the same in each language
        return _(value) if is_word else value

    look = "input" if field.key in INPUTS else "text" if field.kind == "text" else ""
    return of_field(field, read=read, look=look, align="center" if field.key == "axis_given" else "")


def _list_found(results: Results) -> Iterator[Column]:
    is_hidden, is_ideal, bases = not results.has_simulated, results.settings.ideal, build_terms().bases

    def column(key: str, label: str, width: int, read: Read, **more: Any) -> Column:
        return Column(label, width, read, key=key, **{"is_hidden": is_hidden, "look": "text", **more})

    yield column("basis", _("Basis"), 26, lambda one: bases[one.adopted.basis], is_hidden=False)
    for at, (key, label) in enumerate(zip(AT_RUN, name_found(is_ideal=is_ideal), strict=True)):
        read = partial(lambda at, one: list_simulated(one, is_ideal=is_ideal)[at], at)
        yield column(key, label, 12, read, format=CHANCE, look="plain")
    yield column("class_notes", _("Notes on the class"), 40, class_notes)
    found = attrgetter("governing.simulation")
    yield column("runs", _("Runs"), 7, lambda one: found(one) and found(one).runs, format=COUNT, look="plain")
    yield column("under_record", _("Under the record"), 20, under_record)
    yield column("axis_run", _("Axis (as run)"), 10, lambda one: one.governing.motion.axis)
    yield column("pfa_source", _("Motion used (as run)"), 30, lambda one: one.governing.motion.label)


def name_found(*, is_ideal: bool) -> tuple[str, str, str, str]:
    """Return the headings of `AT_RUN`: the adopted chance, its interval, and the chance to compare it with."""
    like, ideal = _("Chance in an earthquake like this one"), _("Chance if exactly this motion recurred")
    return ideal if is_ideal else like, _("Range low"), _("Range high"), like if is_ideal else ideal


def _of_method(method: "MethodInfo") -> Column:
    is_criterion = method.kind == "criterion"

    def read(one: ItemResult) -> Any:
        value = one.governing.methods[method.key].value
        if value is None:
            return _("not evaluated")
        return _(method.words[0 if value else 1]) if is_criterion else value

    label = _("{method} (as run)", method=_(method.title))
    width, code, look = (26, "", "") if is_criterion else (16, CHANCE, "plain")
    return Column(label, width, read, code, key=method.key, look=look)


def _list_workings(results: Results, shown: Mapping[str, Column]) -> Iterator[Column]:
    """Yield what is hidden at the far right: the inputs as run, and the classes as numbers from 0, low, to 3."""
    is_ideal = results.settings.ideal
    places = {one.index: at for at, line in enumerate(list_lines(results), 1) for one in line.motions.values()}

    def column(key: str, label: str, read: Read, **more: Any) -> Column:
        return Column(label, 24, read, key=key, is_hidden=True, **more)

    def if_as_run(read: Read) -> Read:
        """Return what reads a row whose class rests on a simulation; the others hold nothing."""
        return lambda one: read(one) if is_as_run(one) else None

    for key in (*SAME, *SAME_WORDS, *BRACKET):
        yield column(f"{key}_run", _("{what} (as run)", what=shown[key].label), shown[key].read)
    yield column("rocks_from_run", _("Share of g b/z from which it may rock"), lambda one: one.adopted.rocks_from)
    for key, label in zip(AT_RUN, name_found(is_ideal=is_ideal), strict=True):
        read = if_as_run(listed_chance) if key == "chance" else shown[key].read
        yield column(f"{key}_run", _("{what} (as run)", what=label), read)
    yield column("edited", _("Edited"), lambda one: "")
    yield column("fell", _("Fell under the record"), if_as_run(lambda one: 1 if one.fell_in_record else ""))
    yield column("behind", _("Chance behind the class"), partial(chance_behind, is_ideal=is_ideal))
    yield column("upper_end", _("Upper end as run"), partial(upper_end, is_ideal=is_ideal))
    yield column("formula_run", _("Largest chance by formula as run"), if_as_run(lambda one: one.formula.value))
    yield column("formula_pfa_run", _("PFA of that chance as run"), if_as_run(lambda one: one.by_formula.motion.pfa_g))
    line = if_as_run(lambda one: places[one.governing.motion.index])
    yield column("motion_run", _("Line of the motion in Floors"), line)
    yield column("held_yes", _("Held if anchored"), lambda one: int(one.item.anchor.holds is not False))
    yield column("held_partly", _("Held if partly anchored"), lambda one: int(one.item.anchor.holds_high is True))
    yield column("settle", _("How to settle the class"), say_unsettled)
    yield column("bracket_held", _("Bracket as run"), say_bracket_held)
    yield column("rank", _("Rank"), if_as_run(lambda one: int(one.adopted.risk)))
    yield column("rank_upper", _("Rank, upper"), if_as_run(lambda one: int(words.find_highest(one))))
    yield column("rank_formula", _("Rank, formula"), if_as_run(lambda one: int(one.formula_class)))
    yield column("can_rock", _("Can rock"), lambda one: int(one.adopted.can_rock))
    for key, name in zip(ORDERS, map(build_terms().bases.__getitem__, LISTED), strict=True):
        yield column(key, _("Order: {basis}", basis=name), lambda one: None)


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture."""
    columns = widen(item_columns(content.run), content.results, ("text",))
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    comments = _list_comments()  # now: what is above the row being written is left out
    for at, column in enumerate(columns):
        if column.key in comments:
            page.write_comment(0, at, comments[column.key], {"x_scale": 3, "y_scale": 2})
    cells = {column.key: f"${xl_col_to_name(at)}{ROW}" for at, column in enumerate(columns)}
    last, lowest = HEAD + len(content.floors), HEAD + len(list_lines(content.run))
    formulas = ItemFormulas(
        cells, refer(pen.sheets["Floors"]), last, lowest, pen.terms, content.run.formula, content.run.paper_formula
    )
    by_basis = {(basis, is_run): formulas.of(basis, is_run=is_run) for basis in BASES for is_run in (False, True)}
    live = {key for own in by_basis.values() for key in own}
    plan = [(at, one, pen.style(one.look or "plain", one.format, align=one.align)) for at, one in enumerate(columns)]
    texts = [(column.read, column.width) for column in columns if column.look == "text" and not column.is_hidden]
    for row, one in enumerate(content.results, HEAD):
        pen.progress.check()
        lines = max(count_lines(read(one), width, 6) for read, width in texts)  # a longer text is cut by its cell
        if lines > 1:
            page.set_row(row, LINE * lines)
        own, number = by_basis[one.adopted.basis, is_as_run(one)], str(row + 1)
        for at, column, form in plan:
            formula = own.get(column.key)
            value = order_number(one, row) if formula and column.key in ORDERS else column.read(one)
            if formula:
                page.write_formula(row, at, formula.replace(ROW, number), form, "" if value is None else value)
            elif column.look == "input" or not (value is None or value == ""):
                pen.put(page, row, at, value, form)
    _dress(pen, page, columns, live, HEAD + max(1, len(content.results)))


def item_areas(pen: Pen, content: Content) -> dict[str, str]:
    """Return the cells of each column of Items by its key, as formulas of other sheets refer to them."""
    last, sheet = HEAD + max(1, len(content.results)), refer(pen.sheets["Items"])
    letters = {column.key: xl_col_to_name(at) for at, column in enumerate(item_columns(content.run))}
    return {key: f"{sheet}${letter}${HEAD + 1}:${letter}${last}" for key, letter in letters.items()}


def _dress(pen: Pen, page: Any, columns: Sequence[Column], live: Collection[str], last: int) -> None:
    """Freeze, filter, hide the workings, colour, let cells take only what formulas can work with, set up the print."""
    areas = {column.key: f"{xl_col_to_name(at)}2:{xl_col_to_name(at)}{last}" for at, column in enumerate(columns)}
    page.freeze_panes(1, 3)  # the item, its class and its upper class stay in view
    page.autofilter(0, 0, last - 1, len(columns) - 1)
    for at, column in enumerate(columns):
        if column.is_hidden:
            page.set_column(at, at, column.width, None, {"hidden": True})
        if column.key in ("class_formula", "class", "class_upper"):
            pen.colour(page, areas[column.key])
        elif column.format == CHANCE and column.key in live and column.key not in ("low", "high"):
            pen.bar(page, areas[column.key])
    again = {"type": "text", "criteria": "begins with", "value": pen.terms.again, "format": pen.style("warning")}
    for key in ("basis", "class"):
        page.conditional_format(areas[key], again)
    rules: dict[str, dict[str, Any]] = {
        "quantity": {"validate": "integer", "criteria": ">=", "value": 1},
        "axis_given": {"validate": "list", "source": ["X", "Y"]},
        "anchored": {"validate": "list", "source": [_(word) for word in ITEMS.column("anchored").choices]},
        **{key: {"validate": "decimal", "criteria": ">", "value": 0}
           for key in ("breadth_cm", "width_cm", "height_cm", "friction", *BRACKET)},
        "centre_of_gravity": {"validate": "decimal", "criteria": "between", "minimum": 5, "maximum": 95},
    }  # fmt: skip
    for key, rule in rules.items():
        page.data_validation(areas[key], rule)
    page.repeat_rows(0)
    page.repeat_columns(0)
    places = {column.key: place for place, column in enumerate(columns)}
    is_short = columns[places["class_notes"]].is_hidden  # else on two pages across: the simulation has columns
    page.print_area(0, 0, last - 1, places["basis" if is_short else "class_notes"])
    page.fit_to_pages(1 if is_short else 2, 0)


def _list_comments() -> dict[str, str]:
    return {
        "breadth_cm": _("Edit the coloured cells. Quantity and Anchored change the counts at once. A row that was not "
                        "simulated follows by the formula. A row that was simulated says 'run again' once its size, "
                        "centre of gravity, friction, axis, floor or the floor's motion is edited: it then leaves all "
                        "counts, lists and charts. So does a row held by a bracket of known capacity, and also once "
                        "its bracket or weight is edited."),
        "class_formula": _("By the limits in Assumptions. * behind a class: outside the range in which the formula was "
                           "checked. ⚓ before it: anchored, so its risk depends on its anchor; ◎: on castors, so it "
                           "rolls; the class is that of the piece without them."),
        "basis": _("What the class rests on. simulated: the chance found by simulation. formula (not simulated): the "
                   "published formula, as nothing was simulated. unconfirmed: nothing is known of the building; or the "
                   "formula, as simulation gave a lower class under motions that are too weak. The three are never "
                   "added up. cannot rock: low; counted with the run. rolls: on castors, in no count of classes."),
        "beside": _("For comparison. In an earthquake like this one: motion and piece differ from draw to draw. If "
                    "exactly this motion recurred: the piece exactly as given, under motions with the spectrum of this "
                    "one."),
        "class": _("The class in force, by the limits in Assumptions; at least high where the piece overturns under "
                   "the record itself. Columns to the right of the notes are not printed."),
        "low": _("The sampling interval; on assumed motion the chances in the slower and the faster third of the "
                 "draws."),
        "class_upper": _("By the upper end of the range, and at least that of the chance to compare with."),
    }  # fmt: skip
