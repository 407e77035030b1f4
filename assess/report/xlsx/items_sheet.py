"""The sheet Items: every row of furniture, with live formulas for axis, PFA, chances and class.

Its columns are the fields of `assess.fields` that Excel shows, with what is live, what simulation found, and, hidden at
the far right, the inputs as run.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from xlsxwriter.utility import xl_col_to_name

from assess.fields import Field, item_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.xlsx.item_formulas import ANCHORED, CLASS_WEIGHT, ROW, ItemFormulas, live_formulas
from assess.report.xlsx.pen import CHANCE, COUNT, LINE, LOOKS, Column, Pen, count_lines, of_field, with_unit
from assess.results import CaseRow, ItemResult, Results
from assess.risk import RiskClass, classify
from assess.workbook.formulas import OUTSIDE, say_class
from assess.workbook.schema import ITEMS

if TYPE_CHECKING:
    from assess.methods import MethodInfo

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""
MOST_LINES = 6
"""Lines of a row: a longer text is cut by its cell, and whole in it."""

FRONT = (
    "item", "floor", "room", "description", "type", "quantity", "breadth_cm", "width_cm", "height_cm", "axis_given",
    "anchored",
)  # fmt: skip
"""The fields that the sheet begins with."""
INPUTS = ("quantity", "breadth_cm", "width_cm", "height_cm", "axis_given", "anchored")
"""Those to edit."""
_PLACED = (*FRONT, "breadth_to_height", "axis", "pfa_g", "pfv_cm_s")


# ---------------------------------------------------------------- columns


def item_columns(results: Results) -> list[Column]:
    """Return the columns of Items, in order: at the end those that the workbook had of its own, and hidden workings."""
    known = {one.key: one for one in item_fields(results)}
    shown = [
        *(_given(known[key]) for key in FRONT),
        *_live(known, results),
        *_simulated(is_hidden=not results.has_simulated),
        *(_as_run(one) for one in results.methods if not one.is_live),
        Column(_("Marks (as run)"), 60, _marks, key="adopted_flags"),
        *(_given(one) for key, one in known.items() if "excel" in one.shows and key not in _PLACED),
    ]
    workings = list(_workings())
    return [*shown, *_own(results, {column.label for column in (*shown, *workings)}), *workings]


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
    """Yield what formulas compute under the motion that the formula alone would have govern."""
    yield of_field(known["breadth_to_height"], look="live", is_live=True)
    yield of_field(known["axis"], read=lambda one: one.by_formula.motion.axis, look="live", is_live=True,
                   align="center")  # fmt: skip
    yield of_field(known["pfa_g"], read=lambda one: one.by_formula.motion.pfa_g, look="live", is_live=True)
    yield of_field(known["pfv_cm_s"], read=lambda one: one.by_formula.motion.pfv_cm_s, look="live", is_live=True)
    names = live_formulas({})
    for method in (one for one in results.methods if one.is_live):
        for name in (column.name for column in method.columns if f"{method.key}_{column.name}" in names):
            yield of_field(known[f"{method.key}_{name}"], read=_detail(method.key, name), look="live", is_live=True)
        yield of_field(
            known[method.key], label=_(method.short_title), read=_value(method.key), look="plain", is_live=True
        )
    yield Column(_("Class (formula)"), 16, _class_by_formula, key="class_formula", look="live", is_live=True)


def _detail(method: str, name: str) -> Callable[[ItemResult], Any]:
    return lambda one: one.by_formula.methods[method].detail[name]


def _value(method: str) -> Callable[[ItemResult], Any]:
    return lambda one: one.by_formula.methods[method].value


def _simulated(*, is_hidden: bool) -> Iterator[Column]:
    """Yield what simulation found, and what is in force; columns as run are for the axis named last."""

    def column(key: str, label: str, width: int, read: Callable[[ItemResult], Any], code: str = "") -> Column:
        return Column(label, width, read, code, key, "plain" if code else "text", is_hidden=is_hidden)

    yield column("simulated_chance", _("Verified chance"), 9, _simulated_chance, CHANCE)
    yield column("low", _("Interval low"), 9, lambda one: one.adopted.low, CHANCE)
    yield column("high", _("Interval high"), 9, lambda one: one.adopted.high, CHANCE)
    yield column("runs", _("Runs"), 7, _runs, COUNT)
    yield column("under_record", _("Under the record"), 20, under_record)
    yield Column(_("Class (verified)"), 40, class_simulated, key="class_simulated", look="text", is_live=True,
                 needs_simulation=True, is_hidden=is_hidden)  # fmt: skip
    yield Column(_("Chance"), 9, chance_in_force, CHANCE, "chance", "plain", is_live=True)
    yield Column(_("Class"), 16, class_in_force, key="class", look="live", is_live=True)
    yield column("axis_run", _("Axis (as run)"), 10, lambda one: one.governing.motion.axis)


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
    return ", ".join(_(flag.replace("_", " ")) for flag in one.adopted.flags)


def _own(results: Results, taken: set[str]) -> Iterator[Column]:
    """Yield the columns of the workbook that `assess` does not know."""
    for at, label in enumerate(results.provenance.extra_columns):
        name = label if label not in taken else _("{column} (own column)", column=label)
        yield Column(name, 16, _extra(at), key=f"own {at}", look="text")
        taken.add(name)


def _extra(at: int) -> Callable[[ItemResult], str]:
    return lambda one: one.item.extra[at] if at < len(one.item.extra) else ""


def _workings() -> Iterator[Column]:
    """Yield what is hidden at the far right: the inputs as run, and the classes as numbers from 0, low, to 3."""

    def column(key: str, label: str, read: Callable[[ItemResult], Any], **more: Any) -> Column:
        return Column(label, 24, read, key=key, is_hidden=True, **more)

    formula = {"is_live": True, "needs_simulation": True}
    yield column("breadth_cm_run", with_unit(_("Breadth as run"), "cm"), _if_simulated(lambda one: one.item.breadth_cm))
    yield column("height_cm_run", with_unit(_("Height as run"), "cm"), _if_simulated(lambda one: one.item.height_cm))
    yield column("floor_run", _("Floor as run"), _if_simulated(lambda one: one.item.floor))
    yield column("axis_given_run", _("Axis given as run"), _if_simulated(lambda one: one.item.axis_given))
    yield column("chance_run", _("Chance as run"), _if_simulated(lambda one: one.adopted.probability))
    yield column("edited", _("Edited"), lambda one: "", **formula)
    yield column("fell", _("Fell under the record"), lambda one: 1 if one.fell_in_record else "")
    yield column("behind", _("Chance behind the class"), _chance_behind)
    yield column("upper_end", _("Upper end as run"), _upper_end)
    yield column("rank", _("Rank"), _if_simulated(lambda one: int(one.adopted.risk)), **formula)
    yield column("rank_upper", _("Rank, upper"), _if_simulated(lambda one: int(one.adopted.upper)), **formula)
    yield column("rank_formula", _("Rank, formula"), _if_simulated(lambda one: int(one.formula_class)), **formula)
    yield column("order", _("Order"), lambda one: None, is_live=True)


# ---------------------------------------------------------------- what a row holds


def _if_simulated(read: Callable[[ItemResult], Any]) -> Callable[[ItemResult], Any]:
    """Return what reads a row that was simulated; the others hold nothing."""
    return lambda one: read(one) if one.is_simulated else None


def chance_in_force(one: ItemResult) -> float | None:
    """Return the chance that counts: the adopted one where it was simulated, else that of the formula."""
    return one.adopted.probability if one.is_simulated else one.formula.value


def class_in_force(one: ItemResult) -> str:
    """Return the class that counts, as the sheet shows it."""
    return _mark(one) + say_class(one.adopted.risk) if one.is_simulated else _class_by_formula(one)


def _mark(one: ItemResult) -> str:
    return ANCHORED if one.is_anchored else ""


def _class_by_formula(one: ItemResult) -> str:
    return _mark(one) + say_class(one.formula_class) + (OUTSIDE if "extrapolated" in one.formula.flags else "")


def class_simulated(one: ItemResult) -> str:
    """Return its class by simulation, with its notes."""
    if not one.is_simulated:
        return _("not verified")
    adopted, texts = one.adopted, [_mark(one) + say_class(one.adopted.risk)]
    if adopted.upper > adopted.risk:
        texts.append(words.could_be(say_class(adopted.upper)))
    if adopted.lowered_from is not None:
        texts.append(words.was_lowered(say_class(adopted.lowered_from)))
    return ", ".join(texts)


def _simulated_chance(one: ItemResult) -> float | None:
    return one.adopted.probability if one.adopted.method != one.formula_key else None


def _runs(one: ItemResult) -> int | None:
    return one.governing.simulation.runs if one.governing.simulation else None


def _chance_behind(one: ItemResult) -> float | None:
    """Return the chance by which it is classed, whatever the limits: None where it was not simulated.

    It is the largest under any of its motions. Where simulation may not lower a class, a larger chance of the formula
    counts, so that other limits do not lower it either.
    """

    def chance(case: CaseRow) -> float:
        formula = case.methods[one.formula_key].value or 0.0
        simulated = case.simulation.probability if case.simulation else 0.0
        return max(formula, simulated) if case.adopted.is_doubtful else simulated

    return max(map(chance, one.cases)) if one.is_simulated else None


def _upper_end(one: ItemResult) -> float | None:
    """Return the highest upper end of its intervals, whether or not the chance is adopted."""
    return max((case.simulation.high for case in one.cases if case.simulation), default=None)


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


def order_number(one: ItemResult, row: int) -> float | None:
    """Return the number by which pieces stand in order, as the formula of its row has it; None for anchored ones."""
    chance = chance_in_force(one)
    if one.is_anchored or chance is None:
        return None
    upper = one.adopted.upper if one.is_simulated else classify(chance)
    return CLASS_WEIGHT * int(upper or RiskClass.LOW) + chance - (row + 1) * 1e-9


# ---------------------------------------------------------------- the sheet


def write_items(pen: Pen, page: Any, content: Content) -> None:
    """Write every row of furniture."""
    columns = item_columns(content.run)
    pen.heads(page, [column.label for column in columns], [column.width for column in columns])
    _comment(page, columns)  # now: what is above the row being written is left out
    cells = {column.key: f"${xl_col_to_name(at)}{ROW}" for at, column in enumerate(columns)}
    last = HEAD + len(content.floors)
    formulas = ItemFormulas(cells, pen.refer("Floors"), last, pen.terms, content.run.formula.key)
    by_simulation = {True: formulas.of_simulated(), False: formulas.of_others()}
    plan = [(at, column, _style(pen, column)) for at, column in enumerate(columns)]
    texts = [(column.read, column.width) for column in columns if column.look == "text" and not column.is_hidden]
    for row, one in enumerate(content.results, HEAD):
        pen.progress.check()
        lines = max(count_lines(read(one), width, MOST_LINES) for read, width in texts)
        if lines > 1:
            page.set_row(row, LINE * lines)
        _write_row(pen, page, row, one, plan, by_simulation[one.is_simulated])
    _dress(pen, page, columns, HEAD + max(1, len(content.results)))


def _write_row(
    pen: Pen, page: Any, row: int, one: ItemResult, plan: Sequence[tuple[int, Column, Any]],
    formulas: Mapping[str, str],
) -> None:  # fmt: skip
    number = str(row + 1)
    for at, column, form in plan:
        value = order_number(one, row) if column.key == "order" else column.read(one)
        if column.is_live and (one.is_simulated or not column.needs_simulation):
            formula = formulas[column.key].replace(ROW, number)
            page.write_formula(row, at, formula, form, "" if value is None else value)
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
    page.freeze_panes(1, 1)
    page.autofilter(0, 0, last - 1, len(columns) - 1)
    for at, column in enumerate(columns):
        if column.is_hidden:
            page.set_column(at, at, column.width, None, {"hidden": True})
        if column.key.startswith("class"):
            pen.colour(page, f"{letters[column.key]}2:{letters[column.key]}{last}")
        elif column.format == CHANCE and (column.is_live or column.key == "simulated_chance"):
            pen.bar(page, f"{letters[column.key]}2:{letters[column.key]}{last}")
    area = f"{letters['class_simulated']}2:{letters['class_simulated']}{last}"
    void = {"type": "text", "criteria": "begins with", "value": pen.terms.void, "format": pen.style("warning")}
    page.conditional_format(area, void)
    _validate(page, letters, last)
    _print(page, columns, last)


def _comment(page: Any, columns: Sequence[Column]) -> None:
    comments = {
        "breadth_cm": _(
            "Edit the coloured cells: chance, class, counts and charts follow. The columns as run hold what was run."
        ),
        "class_formula": _(
            "By the limits in Assumptions. * behind a class: outside the range in which the formula was checked by "
            "tests. ⚓ before it: anchored, so its risk depends on its anchor; the class is that of the piece without "
            "it."
        ),
        "class_simulated": _(
            "The class of the simulated chance by the limits in Assumptions; at least high where the piece overturns "
            "under the record itself; where its motions are generic or PFV is estimated, never below the class of the "
            "formula. Where a size, the floor, the axis or the motion of the floor was edited since the run it is "
            "void: the column Class then shows the class of the formula until assess is run again."
        ),
        "class": _(
            "Chance and class in force: by simulation where there is one and it holds, else by the formula. Columns "
            "to the right are not printed."
        ),
    }
    for at, column in enumerate(columns):
        if column.key in comments:
            page.write_comment(0, at, comments[column.key], {"x_scale": 3, "y_scale": 2})


def _validate(page: Any, letters: Mapping[str, str], last: int) -> None:
    """Let cells to edit take only what formulas can work with."""
    choices = [_(word) for word in ITEMS.column("anchored").choices]
    rules: dict[str, dict[str, Any]] = {
        "quantity": {"validate": "integer", "criteria": ">=", "value": 1},
        "axis_given": {"validate": "list", "source": ["X", "Y"]},
        "anchored": {"validate": "list", "source": choices},
        **{
            key: {"validate": "decimal", "criteria": ">", "value": 0} for key in ("breadth_cm", "width_cm", "height_cm")
        },
    }
    for key, rule in rules.items():
        page.data_validation(f"{letters[key]}2:{letters[key]}{last}", rule)


def _print(page: Any, columns: Sequence[Column], last: int) -> None:
    """Print up to the class in force: on one page across, on two where the columns of the simulation are shown."""
    page.repeat_rows(0)
    page.repeat_columns(0)
    at = {column.key: place for place, column in enumerate(columns)}
    page.print_area(0, 0, last - 1, at["class"])
    page.fit_to_pages(1 if columns[at["class_simulated"]].is_hidden else 2, 0)
