"""What is shown of each row of Items: its class, or the word in its place, its chance and its live values."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.i18n import LANGUAGES, gettext, load_catalogue
from assess.methods import Method, adopted_formula, paper_formula
from assess.model import Inventory
from assess.pipeline.assessment import Assessment
from assess.risk import RiskClass, classify_all
from assess.units import GRAVITY, LENGTH, VELOCITY
from assess.web.columns import PageSheet
from assess.web.evaluation import Evaluation
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, say_class
from assess.workbook.lists import NO_SHAKING, NO_UNIT, RUN_ASSESS, WRONG
from assess.workbook.live_row import IS_ANCHORED, NO_AXIS, NO_FLOOR, NO_TYPE
from assess.workbook.names import key, plain, split_header
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import build_catalogue, defined, filled_sizes
from assess.workbook.schema import CLASS, CLASS_OR, LIVE, NO, WORKINGS, YES

CLASSES = tuple(one.name.lower() for one in RiskClass)
"""How the page calls the classes, in rising order."""
SHOWN_WORKINGS = WORKINGS[2:]
"""Columns from which the live ones are computed: the axis, PFV and sizes that were used."""
DECIMALS = 9
"""Decimals of the live values: what a sheet shows, with room to spare."""

Values = tuple[float | str | None, ...]


class LiveRow(NamedTuple):
    """What is shown of a row: `values` are those of the columns that Excel computes, in their order in the sheet."""

    risk: str
    word: str
    chance: float | None
    outside: bool
    values: Values


def find_live_columns(sheet: PageSheet) -> dict[int, str]:
    """Return the columns of Items that Excel computes, by their place in the sheet, as `LIVE` and `WORKINGS` have them.

    Those of which nothing is shown, as the row of Floors, are left out.
    """
    labels = {at: _live_labels().get(plain(one.label)) for at, one in sheet.columns.items() if one.is_live}
    return {at: label for at, label in sorted(labels.items()) if label is not None}


@cache
def _live_labels() -> dict[str, str]:
    names = {label: split_header(label)[0] for label in (*SHOWN_WORKINGS, *LIVE)}
    return {plain(load_catalogue(code).find(name)): label for code in LANGUAGES for label, name in names.items()}


def list_rows(
    tables: Tables, inventory: Inventory, evaluation: Evaluation, columns: Iterable[str]
) -> dict[int, LiveRow]:
    """Return what is shown of each row of Items that holds anything, by its number, in the language in use."""
    labels = tuple(columns)
    known = {} if evaluation.assessment is None else _list_assessed(evaluation.assessment, labels)
    words, anchored = _Words(tables, evaluation.unserved), {one.row: one.anchored for one in inventory.items}
    return {
        row.number: known.get(row.number) or words.describe(row, labels, anchored.get(row.number))
        for row in tables["Items"].rows
    }


def count_classes(rows: Mapping[int, LiveRow], quantities: Mapping[int, int]) -> dict[str, int]:
    """Return the number of pieces (not rows) of each class, "" for those without; `quantities` by row."""
    counts = dict.fromkeys((*CLASSES, ""), 0)
    for number, row in rows.items():
        counts[row.risk] += quantities.get(number, 1)
    return counts


def list_quantities(table: Table) -> dict[int, int]:
    """Return how many pieces each row of Items stands for, where that is filled in."""
    return {row.number: row.get("quantity") for row in table.rows if row.get("quantity") is not None}


# ---------------------------------------------------------------- pieces that were assessed


def _list_assessed(assessment: Assessment, labels: Sequence[str]) -> dict[int, LiveRow]:
    at, adoption = assessment.governing, assessment.adoption
    outside = _find_outside(assessment, adopted_formula(assessment.settings.class_by))
    words = {risk: say_class(risk) for risk in RiskClass}
    anchored, texts = gettext(IS_ANCHORED), []
    found = zip(
        assessment.inventory.items, adoption.risk[at].tolist(), adoption.probability[at].tolist(), outside.tolist(),
        assessment.anchors.held.tolist(), strict=True,
    )  # fmt: skip
    rows: list[tuple[int, str, str, float | None, bool]] = []
    for item, risk, chance, is_outside, is_held in found:
        if is_held:
            texts.append(anchored)
            rows.append((item.row, "", anchored, None, False))
        else:
            texts.append(words[RiskClass(risk)] + OUTSIDE * is_outside)
            rows.append((item.row, CLASSES[risk], "", chance, is_outside))
    values = _list_values(assessment, labels, texts)
    return {one[0]: LiveRow(*one[1:], shown) for one, shown in zip(rows, values, strict=True)}


def _find_outside(assessment: Assessment, method: Method) -> NDArray[np.bool_]:
    """Return which pieces lie outside the range in which a method was checked, and can rock."""
    found = assessment.outcomes[method.key].flags["extrapolated"] & assessment.adoption.can_rock
    return np.asarray(found[assessment.governing])


def _say_paper_classes(assessment: Assessment) -> list[str]:
    """Return the class of each piece by the paper's formula, which is low where it cannot rock."""
    at, method = assessment.governing, paper_formula()
    classes = np.where(assessment.adoption.can_rock, classify_all(assessment.outcomes[method.key].value), RiskClass.LOW)
    words = [say_class(RiskClass(one)) for one in classes[at].tolist()]
    outside = _find_outside(assessment, method).tolist()
    return [gettext(IS_ANCHORED) if held else word + OUTSIDE * marked
            for word, marked, held in zip(words, outside, assessment.anchors.held.tolist(), strict=True)]  # fmt: skip


def _list_values(assessment: Assessment, labels: Sequence[str], classes: Sequence[str]) -> Iterator[Values]:
    """Yield what the columns show of each piece under the motion that governs it."""
    columns = _columns(assessment, classes)
    blank = [None] * len(classes)
    if not labels:
        return iter([()] * len(classes))
    return zip(*(columns.get(label, blank) for label in labels), strict=True)


def _columns(assessment: Assessment, classes: Sequence[str]) -> dict[str, Sequence[Any]]:
    at, cases = assessment.governing, assessment.cases
    yes, no = gettext(YES), gettext(NO)
    ratio, pfa, *methods, risk, by_paper, can_rock = LIVE
    axis, pfv, breadth, height = SHOWN_WORKINGS
    outcomes = (assessment.outcomes[method.key].value[at] for method in LIVE_METHODS)
    return {
        ratio: _plain_numbers(cases.breadth_to_height[at]),
        pfa: _plain_numbers(cases.pfa[at] / GRAVITY),
        **dict(zip(methods, map(_plain_numbers, outcomes), strict=True)),
        risk: classes,
        by_paper: _say_paper_classes(assessment),
        can_rock: [yes if one else no for one in assessment.adoption.can_rock[at].tolist()],
        axis: [assessment.case_demand[case].axis for case in at.tolist()],
        pfv: _plain_numbers(cases.pfv[at] / VELOCITY["cm/s"]),
        breadth: _plain_numbers(cases.breadth[at] / LENGTH["cm"]),
        height: _plain_numbers(cases.height[at] / LENGTH["cm"]),
    }


def _plain_numbers(values: Any) -> list[float | str]:
    """Return numbers for JSON; "" for NaN, as a sheet shows it."""
    return ["" if one != one else one for one in np.round(values, DECIMALS).tolist()]


# ---------------------------------------------------------------- pieces without a class


class _Words:
    """Why rows have no class, in the words of the class column of the workbook.

    `unserved` are the floors whose motion is not known, as names are compared.
    """

    def __init__(self, tables: Tables, unserved: Collection[str]) -> None:
        self.table, self.unserved = tables["Items"], unserved
        self.types = {key(one.type): one for one in build_catalogue(tables["Catalogue"])}
        self.floors = defined(tables["Floors"])

    def describe(self, row: Row, labels: Sequence[str], anchored: str | None) -> LiveRow:
        """Return what is shown of a row; `anchored` is what counts in place of its own cell, if anything does."""
        sizes, word = filled_sizes(self.table, row, self.types), self.explain(row)
        shown: dict[str, float | str] = dict.fromkeys(LIVE, word)
        if word == gettext(NO_SHAKING):
            shown[LIVE[0]] = round(sizes["breadth"] / sizes["height"], DECIMALS)
            if (anchored or row.get("anchored")) == YES:
                is_known = row.get("bracket_capacity") is not None and row.get("anchored") == YES
                word = shown[CLASS] = shown[CLASS_OR] = gettext(RUN_ASSESS if is_known else IS_ANCHORED)
        return LiveRow("", word, None, False, tuple(shown.get(label) for label in labels))

    def explain(self, row: Row) -> str:
        """Return the word; "" where the row is not filled in as far as its name and sizes."""
        table = self.table
        sizes = ("breadth", "height")
        if row.get("item") is None:
            return ""
        if any(name in table.blind for name in sizes):
            return gettext(NO_UNIT)
        if any(table.spoilt(name, row) for name in sizes):
            return gettext(WRONG)
        if len(filled_sizes(table, row, self.types).keys() & set(sizes)) < len(sizes):
            return gettext(NO_TYPE) if self._names_no_type(row) else ""
        return gettext(self._explain_motion(row))

    def _names_no_type(self, row: Row) -> bool:
        """Whether its sizes are to come from a type that the catalogue does not have."""
        return row.get("type") is not None and key(row.get("type")) not in self.types

    def _explain_motion(self, row: Row) -> str:
        floor = key(row.get("floor") or "")
        if floor not in self.floors:
            return NO_FLOOR
        if self.table.spoilt("axis", row):
            return NO_AXIS
        return NO_SHAKING if floor in self.unserved else WRONG
