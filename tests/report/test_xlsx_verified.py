"""The Excel report of simulated results: what stands beside the formula, and which edits ask for a new run."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import openpyxl
import openpyxl.utils
import pytest

import assess
from assess.motion.suite import read_suite
from assess.report import words
from assess.report.xlsx.item_formulas import ANCHORED
from assess.results import Results
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.recalculate import compare_formulas, evaluate, write_report
from tests.report.parallel import BASES, write_records
from tests.workbooks import assessed, write

FLOORS: list[dict[str, Any]] = [
    {"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "2", "record_x": "fast.csv", "record_y": "pulse.csv"},
    {"floor": "3", "pfa_x": 0.5},
]
_SIZES = [(20, 100, ""), (30, 200, "X"), (50, 190, "Y"), (60, 180, ""), (60, 180, "Y"), (60, 160, "X"), (45, 90, "")]
_FALLING = [(60, 190, "Y"), (61, 190, "Y"), (66, 220, "Y")]  # a few of the motions, and the record itself
AGAIN = "run again"
CHANCES = (
    "Chance in an earthquake like this one", "Range low", "Range high", "Chance if exactly this motion recurred",
)  # fmt: skip
MEDIUM, HIGH, VERY_HIGH = (("Assumptions", row, 2) for row in (2, 3, 4))


def _items():
    rows = [(floor, *size) for floor in "12" for size in _SIZES] + [("2", *size) for size in _FALLING]
    rows += [("2", 150, 100, ""), ("3", 40, 180, ""), ("3", 60, 120, "Y")]
    items = [
        {"item": f"{floor}-{at}", "floor": floor, "breadth": breadth, "width": 160, "height": height, "axis": axis}
        for at, (floor, breadth, height, axis) in enumerate(rows)
    ]
    items[0]["quantity"], items[1]["anchored"], items[9]["quantity"], items[10]["anchored"] = 4, "yes", 3, "yes"
    return [{name: value for name, value in item.items() if value != ""} for item in items]


@dataclass(frozen=True)
class Report:
    """A report with its results; `places` are the columns of Items."""

    results: Results
    path: Path
    places: dict[str, int]

    @property
    def rows(self):
        return {one.item.item: row for row, one in enumerate(self.results, 2)}

    def cell(self, item, label):
        return "Items", self.rows[item], self.places[label]

    def edit(self, *edits):
        """Return the book as an engine computes it after cells (sheet, row, column) were given values."""
        return evaluate(self.path, ((*place, value) for place, value in edits))

    def read(self, book, label):
        return {item: book.get_value("Items", row, self.places[label]) for item, row in self.rows.items()}

    def again(self, book):
        """Return the items that are to be run again."""
        items = {item for item, shown in self.read(book, "Class").items() if shown == AGAIN}
        assert items == {item for item, shown in self.read(book, "Basis").items() if shown == AGAIN}
        return items

    def named(self, floor, *axes):
        """Items on a floor that were simulated, or cannot rock, and whose axis is one of `axes` ("" is blank)."""
        own = (one for one in self.results if one.is_simulated or not one.adopted.can_rock)
        return {one.item.item for one in own if one.item.floor == floor and (one.item.axis_given or "") in axes}


def _report(folder, settings, items, floors, **building):
    write_records(folder)
    results = assessed(folder / "w.xlsx", items, floors, settings=settings, **building)
    write_report(results, folder / "report.xlsx")
    heads = openpyxl.load_workbook(folder / "report.xlsx")["Items"][1]
    return Report(results, folder / "report.xlsx", {str(cell.value): int(cell.column or 0) for cell in heads})


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    settings = Settings(verify="all", runs=30)
    return _report(tmp_path_factory.mktemp("verified"), settings, _items(), FLOORS, restitution=0.9)


def _copy(report, folder):
    (folder / "copy.xlsx").write_bytes(report.path.read_bytes())
    return folder / "copy.xlsx"


def _summary(report, book):
    """Return the counts that the Summary shows, by basis and floor, and of what has no class by floor."""
    sheet = openpyxl.load_workbook(report.path)["Summary"]
    heads = {str(sheet.cell(cell.row - 1, 1).value).split(": ")[1]: cell.row
             for cell in sheet["A"] if cell.value == "Floor"}  # fmt: skip
    shown = {
        (name, floor["floor"]): [book.get_value("Summary", row + at, column) for column in range(2, 6)]
        for name, row in heads.items()
        for at, floor in enumerate(FLOORS, 1)
    }
    first = min(heads.values())
    apart = {floor["floor"]: tuple(book.get_value("Summary", first + at, column) for column in (7, 8, 9))
             for at, floor in enumerate(FLOORS, 1)}  # fmt: skip
    return shown, apart


def _expected(report, again=(), edited=None):
    """Return these counts where the items `again` are to be run again, after an edit of quantities and anchors."""
    items = edited or _items()
    shown = {
        (BASES[one.apart or one.main_basis], floor["floor"]): [0] * 4 for one in report.results for floor in FLOORS
    }
    apart = {floor["floor"]: [0, 0, 0] for floor in FLOORS}
    for one, now in zip(report.results, items, strict=True):
        quantity, floor = now.get("quantity", 1), now["floor"]
        apart[floor][2] += quantity
        if now["item"] in again:
            apart[floor][0] += quantity
        elif now.get("anchored") == "yes":
            apart[floor][1] += quantity
        else:
            shown[BASES[one.apart or one.main_basis], floor][one.adopted.risk] += quantity
    return shown, {floor: tuple(counts) for floor, counts in apart.items()}


def test_stored_results_are_what_an_engine_computes_and_the_workings_are_hidden_and_stand_last(report, tmp_path):
    assert compare_formulas(_copy(report, tmp_path)) > 12 * len(_items())
    book = openpyxl.load_workbook(report.path)
    assert {sheet.oddHeader.center.text for sheet in book} == {None}, "no condition to be named"
    sheet = book["Items"]
    first = report.places["Breadth [cm] (as run)"]
    assert sheet.column_dimensions[openpyxl.utils.get_column_letter(first)].hidden
    assert first > report.places["Notes"]
    assert sheet.auto_filter.ref.endswith(f"{openpyxl.utils.get_column_letter(max(report.places.values()))}21")


EDITED = [
    ("Breadth [cm]", 50), ("Height [cm]", 250), ("Width [cm]", 161), ("Width [cm]", None), ("Friction", 0.3),
    ("Centre of gravity [%]", 55), ("Axis given", "X"), ("Floor", "3"), ("Breadth [cm]", None), ("Height [cm]", "abc"),
    ("Breadth [cm]", -3),
]  # fmt: skip


def test_an_edited_row_alone_is_to_be_run_again(report):
    """Simulated or unconfirmed: it never falls back to the formula, and leaves every count."""
    rows = [one.item.item for one in report.results if one.is_simulated and one.item.axis_given != "X"]
    simulated = {one.item.item for one in report.results if one.adopted.is_simulated}
    edited = ["2-11", *(item for item in rows if item != "2-11" and item[0] != "3")][: len(EDITED)]
    assert simulated & set(edited)
    assert set(edited) - simulated
    items = _items()
    for item, (label, value) in zip(edited, EDITED, strict=True):
        at = next(at for at, one in enumerate(items) if one["item"] == item)
        items[at]["floor"] = value if label == "Floor" else items[at]["floor"]
    book = report.edit(
        *((report.cell(item, label), value) for item, (label, value) in zip(edited, EDITED, strict=True))
    )
    assert report.again(book) == set(edited)
    for name in (*CHANCES, "Upper class", "Notes on the class"):
        shown = report.read(book, name)
        assert not any(shown[item] for item in edited)
    assert _summary(report, book) == _expected(report, edited, items)
    lines = [str(book.get_value("Summary", row, 1)) for row in range(1, 10)]
    assert any(line.startswith(f"Rows to be run again, as an input was edited: {len(edited)}.") for line in lines)


def test_an_edit_taken_back_counts_again_and_an_edited_peak_asks_for_a_run_of_the_rows_that_shake_along_it(report):
    sheet = openpyxl.load_workbook(report.path)["Items"]
    places = [report.cell("2-11", label) for label in ("Breadth [cm]", "Friction", "Axis given")]
    edits = [(place, 0.25) for place in places]
    assert report.again(report.edit(*edits)) == {"2-11"}
    assert not report.again(report.edit(*edits, *((place, sheet.cell(*place[1:]).value) for place in places)))
    items = _items()
    items[2]["quantity"], items[4]["anchored"] = 50, "yes"
    book = report.edit((report.cell("1-2", "Quantity"), 50), (report.cell("1-4", "Anchored"), "yes"))
    assert not report.again(book)
    assert _summary(report, book) == _expected(report, set(), items) != _expected(report)
    assert report.read(book, "Class")["1-4"].startswith(ANCHORED)
    x, y = ("Floors", 3, 3), ("Floors", 3, 6)
    assert report.again(report.edit((x, 0.9))) == report.named("2", "", "X")
    assert report.again(report.edit((y, 0.9))) == report.named("2", "", "Y")
    book = report.edit((x, 0.9), (y, 0.2))
    assert report.again(book) == report.named("2", "", "X", "Y")
    assert [book.get_value("Floors", row, column) for row in (2, 3) for column in (10, 11)] == ["", "", *["edited"] * 2]
    assert {floor: counts[2] for floor, counts in _summary(report, book)[1].items()} == {"1": 10, "2": 13, "3": 2}
    assert report.again(report.edit((("Floors", 2, 4), 60.0))) == report.named("1", "", "X")
    assert report.again(report.edit((("Floors", 4, 4), 60.0))) == report.named("3", "", "Y")  # none was given
    assert report.again(report.edit((("Floors", 4, 3), 0.6))) == report.named("3", "", "Y")


def test_a_row_that_was_not_simulated_follows_by_the_formula(tmp_path):
    """So does whether it can rock: a stocky piece that is made slender gets the formula's class, and back."""
    by_formula = _report(tmp_path, Settings(verify="none"), _items(), FLOORS)
    stocky = next(one.item.item for one in by_formula.results if not one.adopted.can_rock)
    assert by_formula.read(by_formula.edit(), "Class")[stocky] == "○ low"
    assert by_formula.read(by_formula.edit(), "Basis")[stocky] == "cannot rock"
    breadth = by_formula.cell(stocky, "Breadth [cm]")
    book = by_formula.edit((breadth, 20), (("Floors", 3, 6), 1.2))
    assert not by_formula.again(book)
    assert by_formula.read(book, "Class")[stocky] == by_formula.read(book, "Class (formula)")[stocky] == "■ very high"
    assert by_formula.read(book, "Class (OR)")[stocky] == "■ very high*", "not checked at that PFA"
    outside = by_formula.edit((breadth, 15), (("Floors", 3, 6), 1.2))
    assert by_formula.read(outside, "Class")[stocky] == "■ very high*"
    assert by_formula.read(book, "Basis")[stocky] == "formula (not simulated)"
    assert by_formula.read(by_formula.edit((breadth, 20), (breadth, 155)), "Class")[stocky] == "○ low"


def test_an_edited_class_limit_reclasses_simulated_rows(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0}]
    items = [{"item": f"{breadth}", "floor": "1", "breadth": breadth, "height": 180} for breadth in range(20, 60, 8)]
    report = _report(tmp_path, settings=Settings(runs=20), items=items, floors=floors, period=0.9)
    chances = {one.item.item: one.adopted.probability for one in report.results if one.adopted.is_simulated}
    item = next(item for item, chance in chances.items() if classify(chance) == RiskClass.MEDIUM)
    book = report.edit((MEDIUM, chances[item] / 4), (HIGH, chances[item] / 3), (VERY_HIGH, chances[item] / 2))
    for label in ("Class", "Upper class"):
        assert report.read(book, label)[item] == RiskClass.VERY_HIGH.label
    assert not report.again(book)


@pytest.mark.parametrize("limits", [(0.03, 0.3, 0.7), (0.6, 0.8, 0.95), (0.001, 0.01, 0.05)])
def test_no_limits_let_simulation_lower_what_it_may_not(report, limits):
    book = report.edit(*zip((MEDIUM, HIGH, VERY_HIGH), limits, strict=True))
    by_formula, shown = report.read(book, "Class (formula)"), report.read(book, "Class")
    labels, notes = [risk.label for risk in RiskClass], report.read(book, "Notes on the class")
    assert any("fell_in_record" in one.adopted.flags for one in report.results)
    for one in report.results:
        if one.is_simulated:
            ranks = [labels.index(found[one.item.item].removeprefix(ANCHORED).rstrip("*"))
                     for found in (shown, by_formula)]  # fmt: skip
            if "fell_in_record" in one.adopted.flags:
                assert ranks[0] >= RiskClass.HIGH
                assert "as it overturns under the record itself" in notes[one.item.item]
            if "unknown_building" in one.adopted.flags and one.adopted.can_rock:
                chances = [max(case.adopted.probability, case.simulation.if_faster) for case in one.cases]
                assert ranks[0] == sum(max(chances) >= limit for limit in limits), "by the faster third of the draws"
            elif all(case.adopted.is_doubtful for case in one.cases):
                assert ranks[0] >= ranks[1]


def test_an_unconfirmed_class_is_that_of_the_formula_or_of_the_faster_draws(report):
    kept = [one for one in report.results if one.adopted.is_unconfirmed]
    book = report.edit()
    by_formula, shown = report.read(book, "Class (formula)"), report.read(book, "Class")
    assert {one.item.floor for one in kept} == {"1", "2", "3"}
    for one in kept:
        if "unknown_building" in one.adopted.flags:
            assert shown[one.item.item].removeprefix(ANCHORED) == one.adopted.risk.label
        elif one.formula_class == one.adopted.risk:  # along its other axis simulation may give less than the formula
            assert shown[one.item.item] == by_formula[one.item.item].rstrip("*")
    pieces = sum(one.item.quantity for one in kept if not one.is_anchored)
    lines = [str(book.get_value("Summary", row, 1)) for row in range(1, 10)]
    line = next(line for line in lines if line.startswith("Unconfirmed pieces"))
    assert line.startswith(f"Unconfirmed pieces: {pieces};")
    assert line.endswith("to settle them: fill in Storeys or Period T1 in Building; use stronger motions.")
    fewer = report.edit((report.cell(kept[0].item.item, "Friction"), 0.9))
    lines = [str(fewer.get_value("Summary", row, 1)) for row in range(1, 10)]
    assert any(line.startswith(f"Unconfirmed pieces: {pieces - kept[0].item.quantity};") for line in lines)


@pytest.mark.slow
def test_a_suite_and_parallel_records_hold_too(tmp_path):
    folder = tmp_path / "own"
    folder.mkdir()
    for place in (tmp_path, folder):
        write_records(place)
    floors = [
        {"floor": "1", "pfa_x": 0.3},
        {"floor": "2", "record_x": "fast.csv; pulse.csv"},
        {"floor": "3", "pfa_x": 1},
    ]
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", _items(), floors, period=0.9))
    settings = Settings(verify="all", scale_motions=True)
    write_report(assess.run(inventory, settings, suite=read_suite(folder)), tmp_path / "report.xlsx")
    rows = list(openpyxl.load_workbook(tmp_path / "report.xlsx")["Verification"].iter_rows(min_row=2, values_only=True))
    served = [("1", "X"), ("1", "Y"), *[("2", "X")] * 2, *[("2", "Y")] * 2, ("3", "X"), ("3", "Y")]
    assert [row[:2] for row in rows] == served
    assert {row[4:8] for row in rows} == {("suite own, scaled", 2, None, None)}
    assert compare_formulas(tmp_path / "report.xlsx") > 12 * len(_items())


@pytest.mark.slow
def test_the_factor_on_the_motion_and_the_ideal_chance_are_named_on_every_sheet(tmp_path):
    items = [{"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180}]
    floors = [{"floor": "1", "pfa_x": 0.4}]
    found = _report(tmp_path, settings=Settings(runs=20, ideal=True, scale=0.8), items=items, floors=floors, period=0.9)
    book = openpyxl.load_workbook(found.path, data_only=True)
    assert {sheet.oddHeader.center.text.strip() for sheet in book} == {"motion × 0.8, if exactly this motion recurred"}
    lines = [str(row[0]) for row in book["Summary"].iter_rows(max_row=6, values_only=True)]
    assert "The motion of every floor is multiplied by 0.8." in lines
    assert any(line.startswith("Chances are those if exactly this motion recurred") for line in lines)
    row = {str(head.value): cell.value for head, cell in zip(book["Items"][1], book["Items"][2], strict=True)}
    simulation = found.results["a"].governing.simulation
    assert row[CHANCES[3]] == simulation.ideal.probability == found.results["a"].adopted.probability
    assert (row["Range low"], row["Range high"]) == words.find_range(found.results["a"])
    assert words.find_range(found.results["a"]) == (simulation.if_slower, simulation.if_faster), "on assumed motion"
    assert row[CHANCES[0]] == simulation.probability
    assert list(found.places).index(CHANCES[3]) < list(found.places).index(CHANCES[0])


@pytest.mark.slow
def test_a_piece_that_may_fall_along_either_axis_holds_the_chance_of_both(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.28, "pfv_y": 33.0}]
    items = [{"item": f"{breadth}", "floor": "1", "breadth": breadth, "width": breadth + 4, "height": 190}
             for breadth in range(30, 66, 6)]  # fmt: skip
    report = _report(tmp_path, settings=Settings(runs=30), items=items, floors=floors, period=0.9)
    larger = [one for one in report.results if one.adopted.probability > one.governing.simulation.probability]
    assert larger
    assert compare_formulas(_copy(report, tmp_path)) > 12 * len(items)
    book = openpyxl.load_workbook(report.path, data_only=True)["Items"]
    for one in larger:
        assert book.cell(report.rows[one.item.item], report.places[CHANCES[0]]).value == one.adopted.probability
