"""The Excel report: what it stores, and that an edit recomputes it, in real spreadsheet engines."""

import formualizer
import openpyxl
import pytest

from assess.risk import RiskClass
from tests.recalculate import compare_formulas, libreoffice, needs_libreoffice, poison, same, stored_cells, write_report
from tests.workbooks import ITEMS, UNVERIFIED, assessed

FLOORS = [
    {"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "2", "pfa_x": 0.5, "pfa_y": 0.62},
    {"floor": "3", "pfa_y": 0.9, "pfv_y": 12.0},
]


def _items():
    sizes = [(20, 200), (25, 180), (30, 200), (36, 92), (45, 90), (60, 60), (80, 70), (28, 202)]
    return [
        {"item": f"{floor}-{at}", "floor": floor, "breadth": breadth, "width": 120, "height": height, **axis}
        for floor in "123"
        for at, (breadth, height) in enumerate(sizes)
        for axis in ({"axis": "X"}, {"axis": "Y"}, {})[at % 3 : at % 3 + 1]
    ]


def _column(sheet, label):
    return next(cell.column for cell in sheet[1] if cell.value == label)


@pytest.fixture
def report(tmp_path):
    results = assessed(tmp_path / "w.xlsx", _items(), FLOORS, period=0.9, motion_uncertainty=0.4)
    write_report(results, tmp_path / "report.xlsx")
    return results, tmp_path / "report.xlsx"


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_stored_results_are_what_an_engine_computes(report):
    _, path = report
    assert compare_formulas(path) > 8 * len(_items())


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
@pytest.mark.libreoffice
@needs_libreoffice
def test_libreoffice_agrees(report, tmp_path):
    _, path = report
    stored = stored_cells(path)
    poison(path)
    found = stored_cells(libreoffice(path, tmp_path / "recalculated.xlsx"))
    differing = [place for place, value in stored.items() if not same(value, found.get(place))]
    assert not differing


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_items_agree_with_the_program(report):
    results, path = report
    book = formualizer.load_workbook(str(path))
    book.evaluate_all()
    sheet = openpyxl.load_workbook(path)["Items"]
    labels = (
        "B/H", "PFA used [g]", "OR as printed", "OR", "Kaneko-Hayashi", "FEMA P-58", "Class (formula)", "Class (OR)",
    )  # fmt: skip
    at = {label: _column(sheet, label) for label in labels}
    for row, one in enumerate(results, 2):
        methods = one.governing.methods
        found = {label: book.get_value("Items", row, column) for label, column in at.items()}
        assert found["B/H"] == pytest.approx(one.item.breadth_to_height, abs=1e-9)
        assert found["OR as printed"] == pytest.approx(methods["proposed_or"].detail["raw"], abs=1e-9)
        assert found["OR"] == pytest.approx(methods["proposed_or"].value, abs=1e-9)
        assert found["Kaneko-Hayashi"] == pytest.approx(methods["kaneko_hayashi"].value, abs=1e-9)
        assert found["FEMA P-58"] == pytest.approx(methods["fema_p58"].value, abs=1e-9)
        assert found["Class (formula)"].rstrip("*") == one.adopted.risk.label
        assert found["Class (formula)"].endswith("*") == ("extrapolated" in methods["fema_p58"].flags)
        assert found["Class (OR)"].rstrip("*") == one.paper_class.label
        assert found["Class (OR)"].endswith("*") == ("extrapolated" in methods["proposed_or"].flags)


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_an_edit_recomputes_class_and_counts_as_a_run_would(report, tmp_path):
    _, path = report
    floors = [FLOORS[0], {"floor": "2", "pfa_x": 1.1, "pfa_y": 0.62}, FLOORS[2]]
    items = _items()
    items[0]["breadth"], items[0]["height"] = 100, 150
    again = assessed(tmp_path / "edited.xlsx", items, floors, period=0.9, motion_uncertainty=0.4)

    book = formualizer.load_workbook(str(path))
    sheet = openpyxl.load_workbook(path)["Items"]
    book.set_value("Floors", 3, 3, 1.1)
    book.set_value("Items", 2, _column(sheet, "Breadth [cm]"), 100)
    book.set_value("Items", 2, _column(sheet, "Height [cm]"), 150)
    book.evaluate_all()
    for row, one in enumerate(again, 2):
        methods = one.governing.methods
        assert book.get_value("Items", row, _column(sheet, "OR")) == pytest.approx(
            methods["proposed_or"].value, abs=1e-9
        )
        found = book.get_value("Items", row, _column(sheet, "Kaneko-Hayashi"))
        assert found == pytest.approx(methods["kaneko_hayashi"].value, abs=1e-9)
        found = book.get_value("Items", row, _column(sheet, "FEMA P-58"))
        assert found == pytest.approx(methods["fema_p58"].value, abs=1e-9)
    summary = openpyxl.load_workbook(path)["Summary"]
    top = next(cell.row for row in summary.iter_rows(max_col=1) for cell in row if cell.value == "Floor")
    for row, floor in enumerate(floors, top + 1):
        own = [one for one in again if one.item.floor == floor["floor"]]
        by_class = [sum(one.adopted.risk == risk for one in own) for risk in RiskClass]
        found = [book.get_value("Summary", row, column) for column in range(2, 10)]
        assert found == [*by_class, len(own), 0, 0, len(own)], "by class, their sum, run again, anchored, all"


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_an_edited_class_limit_moves_the_classes(report):
    results, path = report
    book = formualizer.load_workbook(str(path))
    sheet = openpyxl.load_workbook(path)["Items"]
    before = sum(one.adopted.risk.word == "very high" for one in results)
    book.set_value("Assumptions", 4, 2, 0.999999)
    book.evaluate_all()
    after = sum(
        book.get_value("Items", row, _column(sheet, "Class (formula)")).startswith("■")
        for row in range(2, 2 + len(results))
    )
    assert after < before


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_unknown_columns_come_back(tmp_path):
    from tests.workbooks import write

    path = write(tmp_path / "w.xlsx", ITEMS)
    book = openpyxl.load_workbook(path)
    sheet = book["Items"]
    sheet.cell(1, 30, "Inventory tag")
    sheet.cell(2, 30, "T-17")
    book.save(path)
    import assess

    results = assess.run(assess.read_inventory(path), UNVERIFIED)
    write_report(results, tmp_path / "r.xlsx")
    items = openpyxl.load_workbook(tmp_path / "r.xlsx")["Items"]
    assert items.cell(2, _column(items, "Inventory tag")).value == "T-17"


def test_bytes_are_the_same_twice(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    results = assessed(tmp_path / "w.xlsx")
    write_report(results, tmp_path / "a.xlsx")
    write_report(results, tmp_path / "b.xlsx")
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_an_axis_that_borrows_its_motion_follows_the_edit(report, tmp_path):
    _, path = report
    floors = [*FLOORS[:2], {"floor": "3", "pfa_y": 0.2, "pfv_y": 80.0}]
    again = assessed(tmp_path / "edited.xlsx", _items(), floors, period=0.9)
    book = formualizer.load_workbook(str(path))
    sheet = openpyxl.load_workbook(path)["Items"]
    book.set_value("Floors", 4, 6, 0.2)
    book.set_value("Floors", 4, 7, 80.0)
    book.evaluate_all()
    for row, one in enumerate(again, 2):
        for label, key in (("OR", "proposed_or"), ("Kaneko-Hayashi", "kaneko_hayashi")):
            found = book.get_value("Items", row, _column(sheet, label))
            assert found == pytest.approx(one.governing.methods[key].value, abs=1e-9)


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_a_size_that_is_cleared_shows_check_and_leaves_the_counts_alive(report):
    _, path = report
    book = formualizer.load_workbook(str(path))
    sheet = openpyxl.load_workbook(path)["Items"]
    book.set_value("Items", 2, _column(sheet, "Breadth [cm]"), "abc")
    book.evaluate_all()
    for label in ("B/H", "OR as printed", "OR", "Kaneko-Hayashi", "Class (formula)"):
        assert book.get_value("Items", 2, _column(sheet, label)) == "check"
    summary = openpyxl.load_workbook(path)["Summary"]
    top = next(cell.row for row in summary.iter_rows(max_col=1) for cell in row if cell.value == "Floor")
    assert book.get_value("Summary", top + 1, 9) == 7


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_an_anchored_piece_is_marked_and_not_coloured(tmp_path):
    from assess.report.xlsx.item_formulas import ANCHORED

    write_report(assessed(tmp_path / "w.xlsx", ITEMS), tmp_path / "r.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "r.xlsx", data_only=True)["Items"]
    shown = {row[0].value: row[_column(sheet, "Class (formula)") - 1].value for row in sheet.iter_rows(min_row=2)}
    assert shown["A4"].startswith(ANCHORED)
    assert not shown["A3"].startswith(ANCHORED)


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_without_verification_the_class_is_that_of_the_formula(report):
    _, path = report
    book = openpyxl.load_workbook(path, data_only=True)
    sheet = book["Items"]
    by_formula, basis, shown = (_column(sheet, label) for label in ("Class (formula)", "Basis", "Class"))
    for row in sheet.iter_rows(min_row=2, values_only=True):
        assert row[basis - 1] == "formula (not simulated)"
        assert row[shown - 1] == row[by_formula - 1]
    assert "Verification" not in book.sheetnames
    lines = [str(row[0]) for row in book["Summary"].iter_rows(values_only=True)]
    assert any(line.startswith("Not simulated: classes come from a published formula") for line in lines)
