"""The Excel report of a verified results: what stands beside the formula, and what an edit makes void."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import formualizer
import numpy as np
import openpyxl
import openpyxl.utils
import pytest

import assess
from assess.motion.suite import read_suite
from assess.report.xlsx.item_formulas import ANCHORED
from assess.results import Results
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.recalculate import compare_formulas, libreoffice, needs_libreoffice, poison, same, stored_cells, write_report
from tests.workbooks import UNVERIFIED, assessed, write

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

FLOORS: list[dict[str, Any]] = [
    {"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "2", "record_x": "fast.csv", "record_y": "pulse.csv"},
    {"floor": "3", "pfa_x": 0.5},
]
_SIZES = [(20, 100, ""), (30, 200, "X"), (50, 190, "Y"), (60, 180, ""), (60, 180, "Y"), (60, 160, "X"), (45, 90, "")]
_FALLING = [(60, 190, "Y"), (61, 190, "Y"), (66, 220, "Y")]  # a few of the motions, and the record itself
VOID = "void: inputs changed"
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


def _write_records(folder):
    """A burst of fast shaking, and one slow pulse."""
    time = np.arange(0, 12, 0.01)
    fast = 680 * np.sin(2 * np.pi * 6 * time) * np.exp(-(((time - 5) / 2) ** 2))
    pulse = np.where((time > 4) & (time < 5), 412 * np.sin(2 * np.pi * (time - 4)), 0) + np.sin(4 * np.pi * time)
    for name, values in (("fast.csv", fast), ("pulse.csv", pulse)):
        rows = "\n".join(f"{at:.2f},{value:.4f}" for at, value in zip(time, values, strict=True))
        (folder / name).write_text(f"time [s],x [cm/s2]\n{rows}\n", encoding="utf-8")


@dataclass(frozen=True)
class Report:
    """A report with its results; `places` are the columns of Items."""

    results: Results
    path: Path
    places: dict[str, int]

    @property
    def rows(self):
        """Row in the sheet, by item."""
        return {one.item.item: row for row, one in enumerate(self.results, 2)}

    def cell(self, item, label):
        """Address of a cell of Items."""
        return "Items", self.rows[item], self.places[label]

    def edit(self, *edits):
        """Return the book as an engine computes it after cells (sheet, row, column) were given values."""
        book = formualizer.load_workbook(str(self.path))
        for place, value in edits:
            sheet, row, column = place
            book.set_value(sheet, row, column, value)
        book.evaluate_all()
        return book

    def read(self, book, label):
        """Return what a column of Items shows, by item."""
        return {item: book.get_value("Items", row, self.places[label]) for item, row in self.rows.items()}

    def void(self, book):
        """Return the items whose class is void."""
        return {item for item, shown in self.read(book, "Class (verified)").items() if shown == VOID}

    def named(self, floor, *axes):
        """Items on a floor that are verified and whose axis is one of `axes` ("" is blank)."""
        return {one.item.item for one in self.results
                if one.is_simulated and one.item.floor == floor and (one.item.axis_given or "") in axes}  # fmt: skip


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verified")
    _write_records(folder)
    results = assessed(folder / "w.xlsx", _items(), FLOORS, settings=Settings(verify="all", runs=30), restitution=0.9)
    write_report(results, folder / "report.xlsx")
    heads = openpyxl.load_workbook(folder / "report.xlsx")["Items"][1]
    return Report(results, folder / "report.xlsx", {str(cell.value): int(cell.column or 0) for cell in heads})


def _copy(report, folder):
    (folder / "copy.xlsx").write_bytes(report.path.read_bytes())
    return folder / "copy.xlsx"


def _summary(report, book):
    """Return the counts that the Summary shows, by floor: the four classes, then anchored."""
    sheet = openpyxl.load_workbook(report.path)["Summary"]
    top = next(cell.row for row in sheet.iter_rows(max_col=1) for cell in row if cell.value == "Floor")
    return {floor["floor"]: [book.get_value("Summary", top + at, column) for column in range(2, 7)]
            for at, floor in enumerate(FLOORS, 1)}  # fmt: skip


def _expected(report, void, edited=None):
    """Return the counts by floor where the items `void` have the class of the formula, after an edit of the items."""
    items = edited or _items()
    path = write(report.path.parent / "edited.xlsx", items, FLOORS)
    again = {one.item.item: one for one in assess.run(assess.read_inventory(path), UNVERIFIED)}
    counts: dict[str, Counter[Any]] = {floor["floor"]: Counter() for floor in FLOORS}
    for one in report.results:
        now = again[one.item.item]
        risk = now.adopted.risk if one.item.item in void else one.adopted.risk
        counts[now.item.floor]["anchored" if now.is_anchored else risk] += now.item.quantity
    return {floor: [found[kind] for kind in (*RiskClass, "anchored")] for floor, found in counts.items()}


def test_stored_results_are_what_an_engine_computes(report, tmp_path):
    assert compare_formulas(_copy(report, tmp_path)) > 12 * len(_items())


@pytest.mark.libreoffice
@needs_libreoffice
def test_libreoffice_agrees(report, tmp_path):
    path = _copy(report, tmp_path)
    stored = stored_cells(path)
    poison(path)
    found = stored_cells(libreoffice(path, tmp_path / "recalculated.xlsx"))
    assert not [place for place, value in stored.items() if not same(value, found.get(place))]


def test_items_show_what_the_program_found(report):
    book = report.edit()
    shown = {label: report.read(book, label) for label in report.places}
    for one in report.results:
        found = {label: values[one.item.item] for label, values in shown.items()}
        adopted, mark = one.adopted, ANCHORED if one.is_anchored else ""
        if not one.is_simulated:
            assert found["Class (verified)"] == "not verified"
            assert found["Class"] == found["Class (formula)"]
            continue
        assert found["Runs"] == 30
        assert found["Class"] == mark + adopted.risk.label
        assert found["Class (verified)"].startswith(mark + adopted.risk.label)
        assert ("lowered" in found["Class (verified)"]) == (adopted.lowered_from is not None)
        assert ("could be" in found["Class (verified)"]) == (adopted.upper > adopted.risk)
        is_kept = "not_lowered" in adopted.flags
        assert [found["Verified chance"], found["Interval low"], found["Interval high"]] == [
            None if is_kept else pytest.approx(value, abs=1e-12)
            for value in (adopted.probability, adopted.low, adopted.high)
        ]
        assert found["OR"] == pytest.approx(one.by_formula.methods["proposed_or"].value, abs=1e-9)
        assert found["Axis"] == one.by_formula.motion.axis
    assert any(one.governing.motion.axis != one.by_formula.motion.axis for one in report.results)
    assert not all(one.is_simulated for one in report.results)


def test_what_a_piece_does_under_the_record_is_told(report):
    shown = report.read(report.edit(), "Under the record")
    assert all((shown[one.item.item] is None) == (one.item.floor != "2" or not one.is_simulated)
               for one in report.results)  # fmt: skip
    kinds = {str(value).split(" (")[0].lstrip("<0123456789. ") for value in shown.values() if value}
    assert kinds - {"stays at rest"} == {"overturns", "of critical"}


def test_counts_are_those_of_the_adopted_classes(report):
    assert _summary(report, report.edit()) == _expected(report, set())


def test_the_list_on_the_summary_follows_an_edit(report):
    sheet = openpyxl.load_workbook(report.path)["Summary"]
    top = next(cell.row for cell in sheet["A"] if cell.value == "Item")
    for edits in ((), ((("Floors", 3, 3), 0.9), (("Floors", 3, 6), 0.9))):
        book = report.edit(*edits)
        chances, shown, void = report.read(book, "Chance"), report.read(book, "Class"), report.void(book)
        rows = [[book.get_value("Summary", row, column) for column in range(1, 9)] for row in range(top + 1, top + 11)]
        assert bool(edits) == bool(void & {row[0] for row in rows})
        for item, *_, chance, low, high, said in rows:
            assert chance == pytest.approx(chances[item], abs=1e-12)
            assert said.startswith(shown[item])
            is_simulated = next(one for one in report.results if one.item.item == item).is_simulated
            if item in void or not is_simulated:
                assert (low, high) == ("", "")
        free = [item for item, label in shown.items() if not label.startswith(ANCHORED)]
        assert max(chances[item] for item in free) == pytest.approx(max(row[4] for row in rows))


@pytest.mark.parametrize(("label", "value", "name"), [("Breadth [cm]", 50, "breadth"), ("Height [cm]", 250, "height")])
def test_an_edited_size_voids_its_row_alone(report, label, value, name):
    items, at, edited = _items(), 11, "2-11"
    items[at][name] = value
    book = report.edit((report.cell(edited, label), value))
    assert report.void(book) == {edited}
    assert report.read(book, "Class")[edited] == report.read(book, "Class (formula)")[edited]
    assert _summary(report, book) == _expected(report, {edited}, items) != _expected(report, set())
    lines = [book.get_value("Summary", row, 1) for row in range(1, 10)]
    assert any("void, as an input was edited: 1." in str(line) for line in lines)
    same_again = report.edit((report.cell(edited, label), value), (report.cell(edited, label), _items()[at][name]))
    assert not report.void(same_again)


@pytest.mark.parametrize("value", [None, "abc", -3])
def test_a_size_that_is_none_voids_its_row_and_shows_check(report, value):
    book = report.edit((report.cell("2-7", "Breadth [cm]"), value))
    assert report.void(book) == {"2-7"}
    assert report.read(book, "Class")["2-7"] == "check"


def test_an_edited_peak_voids_the_rows_that_shake_along_it(report):
    x, y = ("Floors", 3, 3), ("Floors", 3, 6)
    assert report.void(report.edit((x, 0.9))) == report.named("2", "", "X")
    assert report.void(report.edit((y, 0.9))) == report.named("2", "", "Y")
    book = report.edit((x, 0.9), (y, 0.2))
    assert report.void(book) == report.named("2", "", "X", "Y")
    assert [book.get_value("Floors", row, column) for row in (2, 3) for column in (10, 11)] == ["", "", *["edited"] * 2]
    by_formula, shown = report.read(book, "Class (formula)"), report.read(book, "Class")
    assert all(shown[item] == by_formula[item] for item in report.void(book))
    assert {floor: sum(counts) for floor, counts in _summary(report, book).items()} == {"1": 10, "2": 13, "3": 2}


def test_a_floor_whose_other_motion_is_borrowed_is_void_along_both_axes(report):
    assert report.void(report.edit((("Floors", 4, 3), 0.6))) == report.named("3", "", "Y")


def test_an_edited_velocity_matters_where_the_motions_were_made_for_it(report):
    assert report.void(report.edit((("Floors", 2, 4), 60.0))) == report.named("1", "", "X")
    assert not report.void(report.edit((("Floors", 3, 4), 60.0), (("Floors", 3, 7), 60.0)))
    assert report.void(report.edit((("Floors", 4, 4), 60.0))) == report.named("3", "", "Y")  # none was given


def test_an_edited_axis_or_floor_voids_its_row(report):
    book = report.edit((report.cell("2-8", "Axis given"), "Y"), (report.cell("2-7", "Axis given"), "X"))
    assert report.void(book) == {"2-7", "2-8"}
    assert report.void(report.edit((report.cell("2-9", "Axis given"), None))) == {"2-9"}
    assert report.void(report.edit((report.cell("2-9", "Floor"), "1"))) == {"2-9"}


def test_an_edited_quantity_counts_and_voids_nothing(report):
    items = _items()
    items[2]["quantity"], items[4]["anchored"] = 50, "yes"
    book = report.edit((report.cell("1-2", "Quantity"), 50), (report.cell("1-4", "Anchored"), "yes"))
    assert not report.void(book)
    assert _summary(report, book) == _expected(report, set(), items) != _expected(report, set())
    assert report.read(book, "Class")["1-4"].startswith(ANCHORED)


def test_an_edited_class_limit_reclasses_verified_rows(report):
    chances = {one.item.item: one.adopted.probability for one in report.results
               if one.adopted.low is not None and "fell_in_record" not in one.adopted.flags}  # fmt: skip
    item = next(item for item, chance in chances.items() if classify(chance) == RiskClass.MEDIUM)
    book = report.edit((MEDIUM, chances[item] / 4), (HIGH, chances[item] / 3), (VERY_HIGH, chances[item] / 2))
    assert report.read(book, "Class")[item] == RiskClass.VERY_HIGH.label
    assert report.read(book, "Class (verified)")[item] == RiskClass.VERY_HIGH.label
    assert not report.void(book)


@pytest.mark.parametrize("limits", [(0.03, 0.3, 0.7), (0.2, 0.45, 0.5), (0.6, 0.8, 0.95), (0.001, 0.01, 0.05)])
def test_no_limits_let_verification_lower_what_it_may_not(report, limits):
    book = report.edit(*zip((MEDIUM, HIGH, VERY_HIGH), limits, strict=True))
    by_formula, shown = report.read(book, "Class (formula)"), report.read(book, "Class")
    labels = [risk.label for risk in RiskClass]
    for one in report.results:
        if one.is_simulated:
            ranks = [labels.index(found[one.item.item].removeprefix(ANCHORED).rstrip("*"))
                     for found in (shown, by_formula)]  # fmt: skip
            if "fell_in_record" in one.adopted.flags:
                assert ranks[0] >= RiskClass.HIGH
            if one.item.floor != "2":
                assert ranks[0] >= ranks[1]


def test_a_piece_that_falls_in_the_record_is_at_least_high(report):
    fell = [one for one in report.results if "fell_in_record" in one.adopted.flags]
    small = next(one for one in fell if one.adopted.probability < 0.3).item.item
    for book in (report.edit(), report.edit((HIGH, 0.65))):
        assert report.read(book, "Class")[small] == RiskClass.HIGH.label
        assert report.read(book, "Under the record")[small] == "overturns"


def test_a_class_that_may_not_be_lowered_is_that_of_the_formula(report):
    kept = [one for one in report.results if "not_lowered" in one.adopted.flags]
    book = report.edit()
    by_formula, shown = report.read(book, "Class (formula)"), report.read(book, "Class (verified)")
    assert kept
    for one in kept:
        assert shown[one.item.item] == by_formula[one.item.item].rstrip("*")


def test_a_lowered_class_says_so_wherever_it_stands(report):
    lowered = {one.item.item: one.adopted for one in report.results
               if one.adopted.lowered_from is not None and not one.is_anchored}  # fmt: skip
    assert {adopted.risk for adopted in lowered.values()} >= {RiskClass.LOW, RiskClass.MEDIUM}
    shown = report.read(report.edit(), "Class (verified)")
    book = openpyxl.load_workbook(report.path)
    fix_first = {row[1]: row for row in book["Fix first"].iter_rows(min_row=2, values_only=True)}
    for item, adopted in lowered.items():
        assert shown[item].endswith(f"lowered by simulation (formula: {adopted.lowered_from.label})")
        row = fix_first[item]
        assert row[7].startswith(f"{adopted.risk.label}")
        assert f"lowered by simulation (formula: {adopted.lowered_from.word})" in row[7]
        assert row[8:11] == pytest.approx((adopted.probability, adopted.low, adopted.high))
    summary = openpyxl.load_workbook(report.path, data_only=True)["Summary"]
    assert any("lowered by simulation" in str(row[7]) for row in summary.iter_rows(values_only=True))


def test_the_sheet_verification_holds_the_fit_of_every_floor_and_axis(report):
    rows = list(openpyxl.load_workbook(report.path)["Verification"].iter_rows(values_only=True))
    heads, found = rows[0], {row[:2]: row for row in rows[1:]}
    assert set(found) == {(floor, axis) for floor in "123" for axis in "XY"}
    for motion in (one for one in report.results.motions if one.ensemble):
        row, ensemble = dict(zip(heads, found[motion.floor, motion.axis], strict=True)), motion.ensemble
        assert row["Motions"] == ensemble.motions == 30
        assert row["Spectrum"] == ("recorded" if motion.floor == "2" else "generic")
        assert row["Seed"] == 1
        assert row["Rows"] == ensemble.cases
        assert row["Worst deviation"] == pytest.approx(ensemble.fit.worst_deviation)
        assert row["PFA over the target's"] == pytest.approx(ensemble.fit.pfa_ratio)
        assert row["Rows that overturn under the record"] == ensemble.fell_in_record
        assert (ensemble.fell_in_record is None) == (motion.floor != "2")
    assert found["2", "Y"][-1] >= 2


def test_a_suite_and_parallel_records_hold_too(tmp_path):
    folder = tmp_path / "own"
    folder.mkdir()
    for place in (tmp_path, folder):
        _write_records(place)
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


def test_the_restitution_used_stands_among_the_assumptions(report):
    rows = openpyxl.load_workbook(report.path)["Assumptions"].iter_rows(values_only=True)
    assert any("Restitution" in str(row[0]) and "0.9" in str(row[1]) for row in rows)


def test_the_workings_are_hidden_and_stand_last(report):
    sheet = openpyxl.load_workbook(report.path)["Items"]
    first = report.places["Breadth as run [cm]"]
    assert sheet.column_dimensions[openpyxl.utils.get_column_letter(first)].hidden
    assert first > report.places["Notes"]
    assert sheet.auto_filter.ref.endswith(f"{openpyxl.utils.get_column_letter(max(report.places.values()))}21")
