"""Edits of the Excel report: a weaker earthquake raises no count; a bracket that may hold no longer asks for a run."""

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import openpyxl.utils
import pytest

from assess.report.xlsx.items_sheet import item_columns
from assess.results import Results
from assess.risk import RiskClass
from assess.settings import Settings
from tests.recalculate import libreoffice_all, needs_libreoffice, same, stored_cells, write_report
from tests.report.parallel import (
    BRACKETS,
    HELD,
    Cells,
    Edit,
    assess_rich,
    read_items,
    recalculate,
    write_edited,
    write_wave,
)
from tests.workbooks import assessed

AGAIN, ANCHORED = "run again", "⚓ "
LABELS = [risk.label for risk in RiskClass]
DECIDED = {f"{floor}-{kind}{at}" for floor in "12" for kind in "bs" for at, (word, capacity) in enumerate(BRACKETS)
           if word != "no" and capacity}  # fmt: skip
"""Pieces of which a bracket of known capacity decides whether they count as anchored."""


@dataclass(frozen=True)
class Book:
    results: Results
    path: Path

    @property
    def letters(self) -> dict[str, str]:
        return {one.key: openpyxl.utils.get_column_letter(at) for at, one in enumerate(item_columns(self.results), 1)}

    def cell(self, item: str, key: str) -> tuple[str, str]:
        row = next(at for at, one in enumerate(self.results, 2) if one.item.item == item)
        return "Items", f"{self.letters[key]}{row}"

    def scaled(self, factor: float) -> list[Edit]:
        """Return the edits that scale every PFA and PFV that is typed in Floors."""
        sheet = openpyxl.load_workbook(self.path)["Floors"]
        return [("Floors", cell.coordinate, factor * cell.value) for column in "CDFG" for cell in sheet[column][1:]
                if isinstance(cell.value, float | int)]  # fmt: skip

    @property
    def peaks_of_records(self) -> list[tuple[Any, tuple[Any, Any]]]:
        """Rows of Floors, with PFA and PFV along X, of the parallel records of floor 2."""
        sheet = openpyxl.load_workbook(self.path, data_only=True)["Floors"]
        rows = [row for row in sheet.iter_rows(min_row=2) if row[0].value == "2"]
        return [(row[0].row, (row[2].value, row[3].value)) for row in rows]

    def with_the_largest_below(self, column: str) -> list[Edit]:
        """Return the edit of the record in the floor's own line to half of the other, in a column of Floors."""
        (first, _), (_, other) = self.peaks_of_records
        return [("Floors", f"{column}{first}", other["CD".index(column)] / 2)]

    def items(self, cells: Cells) -> dict[str, dict[str, Any]]:
        return {one["item"]: one for one in read_items(cells, self.results)}

    def counts(self, cells: Cells) -> dict[tuple[str, int], tuple[list[int], list[int]]]:
        """Return what the tables by floor of the Summary show, by basis and place of the floor.

        First the pieces of each class and above, then those that have no class: run again, anchored, all.
        """
        sheet = openpyxl.load_workbook(self.path)["Summary"]
        floors, found = len(self.results.floor_rows), {}
        for head in (cell.row for cell in sheet["A"] if cell.value == "Floor"):
            basis = str(sheet.cell(head - 1, 1).value).split(": ")[1]
            for row in range(head + 1, head + 1 + floors):
                by_class = [cells.get(("Summary", f"{letter}{row}"), 0) for letter in "BCDE"]
                others = [cells.get(("Summary", f"{letter}{row}"), 0) for letter in "GHI"]
                found[basis, row - head] = [sum(by_class[at:]) for at in range(4)], others
        return found


def _rank(shown: str) -> int:
    """Return the place of a class as the sheet shows it; -1 where the row is to be run again."""
    return -1 if shown == AGAIN else LABELS.index(shown.removeprefix(ANCHORED).rstrip("*"))


@pytest.fixture(scope="module")
def books(request, tmp_path_factory):
    """Return a report of a run by the formulas, by that of the paper, and of one that simulates every piece."""
    runs = {
        "by_formula": Settings(verify="none"),
        "by_paper": Settings(verify="none", class_by="proposed OR"),
        "simulated": Settings(verify="all", runs=40),
        "simulated_by_paper": Settings(verify="all", runs=40, class_by="proposed OR"),
        "partly": Settings(verify="high", runs=40),
    }

    @cache
    def make(name: str) -> Book:
        folder = tmp_path_factory.mktemp(name)
        is_example = name == "example"
        results = request.getfixturevalue("verified_example") if is_example else assess_rich(folder, runs[name])
        write_report(results, folder / "r.xlsx")
        return Book(results, folder / "r.xlsx")

    return make


@pytest.fixture(params=["by_formula", "partly", pytest.param("example", marks=pytest.mark.long)])
def book(request, books):
    return books(request.param)


@pytest.mark.slow
def test_weaker_floors_raise_no_count_and_no_class_and_stronger_ones_lower_none_of_a_row_that_follows(book):
    """Of each class and above: of a class alone there may be more, as those of higher classes fall into it."""
    edits = book.scaled(0.7)
    assert len(edits) >= len(book.results.floor_rows)
    stored, cells = stored_cells(book.path), recalculate(book.path, edits)
    before, after = book.counts(stored), book.counts(cells)
    assert before.keys() == after.keys()
    for place, (classes, others) in before.items():
        assert all(new <= old for new, old in zip(after[place][0], classes, strict=True)), place
        assert after[place][1][1] <= others[1], "anchored"
        assert after[place][1][2] == others[2], "all"
    rows = book.items(cells)
    for item, row in book.items(stored).items():
        assert _rank(rows[item]["class"]) <= _rank(row["class"]), item
    _check_waiting(book, rows, cells)
    stored = stored_cells(book.path)
    cells = recalculate(book.path, book.scaled(1.5))
    rows = book.items(cells)
    for item, row in book.items(stored).items():
        if rows[item]["class"] != AGAIN:
            assert _rank(rows[item]["class"]) >= _rank(row["class"]), item
    _check_waiting(book, rows, cells)


def _check_waiting(book: Book, rows: dict[str, dict[str, Any]], cells: Cells) -> None:
    """Where every floor is edited, what was simulated waits for a run, and what a bracket decides."""
    bases = {one.item.item: one.adopted.basis if one.adopted.can_rock else one.main_basis for one in book.results}
    waiting = {item for item, basis in bases.items() if basis != "formula"}
    known = {one.item.item for one in book.results if one.item.item in DECIDED}
    assert {item for item, row in rows.items() if row["class"] == AGAIN} == waiting | known
    pieces = sum(one.item.quantity for one in book.results if one.item.item in waiting | known)
    assert sum(others[0] for _, others in book.counts(cells).values() if isinstance(others[0], int | float)) == pieces
    sheet = openpyxl.load_workbook(book.path)["Summary"]
    tops = [cell.row for cell in sheet["A"] if str(cell.value).startswith("The pieces most likely to fall")]
    for top in tops:  # the lists, which the charts draw
        names = [str(cells.get(("Summary", f"A{row}")) or "").split(":")[0] for row in range(top + 2, top + 12)]
        assert not (waiting | known) & set(names)


@pytest.mark.slow
def test_what_counts_as_anchored_is_what_the_bracket_says(books):
    for one in map(books, ("by_formula", "simulated")):
        rows = one.items(stored_cells(one.path))
        for floor in "12":
            for kind in "bs":
                shown = [rows[f"{floor}-{kind}{at}"] for at in range(len(BRACKETS))]
                by_weight = shown[4]["pfa_g"] * math.exp(0.4) * 0.8 <= 0.75
                expected = [by_weight if held is None else held for held in HELD[kind]]
                assert [row["held"] == "yes" for row in shown] == expected
                assert [row["class"].startswith(ANCHORED) for row in shown] == expected


YES, NO, PARTLY = 0, 6, 3
"""Places in BRACKETS of an anchored piece without capacity, one not anchored, and a partly anchored one without."""
SINGLE: dict[str, tuple[int, str, Any, str]] = {
    "no longer anchored": (YES, "anchored", "no", "free"),
    "anchored by a bracket that holds": (NO, "anchored", "yes", "held"),
    "partly anchored by one that holds at 84 %": (NO, "anchored", "partly", "held"),
    "partly anchored, capacity not known": (YES, "anchored", "partly", "free"),
    "a bracket that fails stays one": (1, "anchored", "partly", "free"),
    "a capacity is typed": (YES, "bracket_capacity_kn", 1.0, "again"),
    "a capacity of a partly anchored one": (PARTLY, "bracket_capacity_kn", 1.0, "again"),
    "a stronger bracket": (1, "bracket_capacity_kn", 50.0, "again"),
    "a capacity is cleared": (2, "bracket_capacity_kn", None, "again"),
    "a capacity that is no number": (2, "bracket_capacity_kn", "abc", "again"),
    "its height": (2, "bracket_height_cm", 50.0, "again"),
    "its weight": (5, "weight_kg", 4000.0, "again"),
    "a capacity that nothing hangs on": (NO, "bracket_capacity_kn", 0.02, "free"),
    "a weight that nothing hangs on": (YES, "weight_kg", 4000.0, "held"),
}


@pytest.mark.parametrize("kind", ["by_formula", "simulated"])
@pytest.mark.slow
def test_edited_anchors_and_brackets(kind, books):
    """As many edits at once as there are rows of the kind: one on each floor. Rows and counts follow."""
    one, left = books(kind), list(SINGLE.values())
    as_run = one.items(stored_cells(one.path))
    while left:
        edits, expected = [], {}
        for edit in tuple(left):
            at, key, value, state = edit
            item = next((name for name in (f"1-b{at}", f"2-b{at}") if name not in expected), None)
            if item:
                edits.append((*one.cell(item, key), value))
                expected[item] = state
                left.remove(edit)
        cells = recalculate(one.path, edits)
        rows, wanted = one.items(cells), {item: _state(row) for item, row in as_run.items()} | expected
        assert {item: _state(row) for item, row in rows.items()} == wanted
        sums = [sum(rows[item]["quantity"] for item, own in wanted.items() if own == state)
                for state in ("free", "again", "held")]  # fmt: skip
        counts = list(one.counts(cells).values())
        apart = [others for _, others in counts if isinstance(others[0], int | float)]  # of the first table alone
        assert [sum(classes[0] for classes, _ in counts), *(sum(own[at] for own in apart) for at in (0, 1))] == sums
        for item, state in expected.items():
            if state != "again":
                assert rows[item]["class"].removeprefix(ANCHORED) == as_run[item]["class"].removeprefix(ANCHORED)


def _state(row: dict[str, Any]) -> str:
    if row["class"] == AGAIN:
        return "again"
    return "held" if row["class"].startswith(ANCHORED) else "free"


@pytest.mark.parametrize("verify", ["none", "all"])
@pytest.mark.slow
def test_a_bracket_of_a_piece_of_unknown_width(tmp_path, verify):
    """What counts as anchored is as run and after Anchored is edited; once a width is typed, it is to be run again."""
    bare = {"floor": "1", "breadth": 30, "height": 200, "bracket_capacity": 50.0}
    items = [bare | {"item": name, "anchored": word} for name, word in (("a", "yes"), ("b", "partly"), ("c", "yes"))]
    items += [bare | {"item": "d", "anchored": "partly"}, bare | {"item": "e", "anchored": "yes"}]
    items[-1]["bracket_capacity"] = 0.01
    floors = [{"floor": "1", "pfa_x": 0.5, "pfa_y": 0.5}]
    results = assessed(tmp_path / "w.xlsx", items, floors, settings=Settings(verify=verify, runs=40))
    write_report(results, tmp_path / "r.xlsx")
    book = Book(results, tmp_path / "r.xlsx")
    shown = {item: _state(row) for item, row in book.items(stored_cells(book.path)).items()}
    assert shown == {"a": "held", "b": "free", "c": "held", "d": "free", "e": "free"}
    assert {one.item.item for one in results if one.is_anchored} == {"a", "c"}
    edits: list[Edit] = [(*book.cell("a", "width_cm"), 90.0), (*book.cell("b", "width_cm"), 90.0)]
    edits += [(*book.cell("c", "anchored"), "partly"), (*book.cell("d", "anchored"), "yes")]
    cells = recalculate(book.path, edits)
    found = {item: _state(row) for item, row in book.items(cells).items()}
    assert found == {"a": "again", "b": "again", "c": "free", "d": "held", "e": "free"}


@pytest.mark.parametrize(("name", "column"), [("by_formula", "D"), ("by_paper", "C")])
@pytest.mark.slow
def test_a_row_by_formula_goes_by_the_largest_of_parallel_records(name, column, books):
    """The record in the floor's own line is edited below the other one, which then governs.

    Which is the largest is by PFV in FEMA P-58, and by PFA in OR.
    """
    book, at = books(name), "CD".index(column)
    (_, largest), (_, other) = book.peaks_of_records
    assert largest[at] > other[at]
    assert largest[1 - at] < other[1 - at], "the other peak alone would have the other record govern"
    row = book.items(stored_cells(book.path))["2-0"]
    assert (row["axis"], row["pfa_g"], row["pfv_cm_s"]) == ("X", *map(pytest.approx, largest))
    cells = recalculate(book.path, book.with_the_largest_below(column))
    row = book.items(cells)["2-0"]
    assert (row["axis"], row["pfa_g"], row["pfv_cm_s"]) == ("X", *map(pytest.approx, other))


@pytest.fixture(scope="module")
def several_motions(tmp_path_factory):
    """Return a report where the larger PFV has too small a PFA to rock the stockier pieces."""
    folder = tmp_path_factory.mktemp("several")
    time = np.arange(0, 20, 0.01)
    for name, pfa, cycles in (("fast.csv", 500, 4), ("slow.csv", 60, 0.25)):
        write_wave(folder / name, time, pfa * np.sin(2 * np.pi * cycles * time) * np.exp(-(((time - 10) / 4) ** 2)))
    floors = [
        {"floor": "1", "pfa_x": 0.06, "pfv_x": 40.0, "pfa_y": 0.5, "pfv_y": 20.0},
        {"floor": "2", "record_x": "fast.csv; slow.csv", "record_y": "slow.csv"},
        {"floor": "3", "record_x": "slow.csv", "record_y": "slow.csv; fast.csv"},
    ]
    items = [
        {"item": f"{floor}-{breadth}{axis}", "floor": floor, "breadth": breadth, "width": 90, "height": 100}
        | ({"axis": axis} if axis else {})
        for floor in "123" for breadth in (15, 60, 90) for axis in ("X", "Y", "")
    ]  # fmt: skip
    results = assessed(folder / "w.xlsx", items, floors, settings=Settings(verify="none"), period=1.0)
    write_report(results, folder / "r.xlsx")
    return Book(results, folder / "r.xlsx")


def test_of_several_motions_the_strongest_that_can_start_the_piece_governs(several_motions):
    book, results = several_motions, several_motions.results
    largest = {one.item.item: max((case.motion.pfv_cm_s, case.motion.pfa_g) for case in one.cases) for one in results}
    passed = {one.item.item for one in results if one.governing.motion.pfv_cm_s < largest[one.item.item][0]}
    assert {"1-60", "2-60", "3-60", "2-60X", "3-60Y"} <= passed
    shown = book.items(recalculate(book.path, []))
    for one in results:
        row, motion = shown[one.item.item], one.governing.motion
        assert row["axis"] == motion.axis, one.item.item
        assert [row["pfa_g"], row["pfv_cm_s"]] == pytest.approx([motion.pfa_g, motion.pfv_cm_s]), one.item.item
        assert row["class"].rstrip("*") == one.adopted.risk.label


@pytest.mark.libreoffice
@needs_libreoffice
@pytest.mark.parametrize(
    ("as_run", "weaker"),
    [
        (("simulated",), ("by_formula", "partly")),
        pytest.param(("by_paper", "partly", "simulated_by_paper", "example"), ("example",), marks=pytest.mark.long),
    ],
)
def test_libreoffice_computes_what_the_other_engine_does(as_run, weaker, books, several_motions, tmp_path):
    """In reports as run, and after the edits of the tests above: in every cell."""
    cases: list[tuple[Book, list[Edit]]] = [(several_motions, [])]
    cases += [(books(name), []) for name in as_run]
    cases += [(books(name), books(name).scaled(0.7)) for name in weaker]
    for name, column in (("by_formula", "D"), ("by_paper", "C")):
        cases.append((books(name), books(name).with_the_largest_below(column)))
    edited = [write_edited(book.path, edits, tmp_path / f"{at}.xlsx") for at, (book, edits) in enumerate(cases)]
    for (book, edits), path in zip(cases, libreoffice_all(edited, tmp_path / "again"), strict=True):
        shown = stored_cells(path)
        wanted = {place: value for place, value in recalculate(book.path, edits).items() if value not in ("", None)}
        assert [place for place in shown if shown[place] != "" and place not in wanted] == []
        assert [place for place, value in wanted.items() if not same(shown.get(place), value)] == []
