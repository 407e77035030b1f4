"""FEMA E-74's form and the Tokyo checklist in the Excel report, and how large its Work list is printed."""

import openpyxl
import pytest

import assess
from assess.i18n import load_catalogue, speaking
from assess.report.content import Content
from assess.report.say.orders import list_lines
from assess.report.xlsx.form_sheets import TOKYO, find_priority, rate
from assess.settings import Settings
from tests.recalculate import write_report
from tests.report.routed import DOUBTED, assess_routed
from tests.workbooks import FLOORS, ITEMS, UNVERIFIED, assessed, write_sheets

PIECES = [
    *ITEMS,
    {"item": "B1", "floor": "2", "description": "Files", "breadth": 25, "width": 80, "height": 200,
     "importance": "function", "photo": "", "against_wall": "yes", "anchored": "no"},
    {"item": "B2", "floor": "2", "description": "Files", "breadth": 25, "width": 80, "height": 200,
     "importance": "function", "against_wall": "yes", "anchored": "no"},
    {"item": "B3", "floor": "1", "type": "Photocopier", "anchored": "yes", "centre_of_gravity": 60},
]  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("forms") / "w.xlsx", PIECES)


@pytest.fixture(scope="module")
def book(results, tmp_path_factory):
    path = tmp_path_factory.mktemp("forms") / "r.xlsx"
    write_report(results, path)
    return openpyxl.load_workbook(path)


def test_every_piece_stands_in_the_inventory_once_alike_ones_in_a_line_by_priority(results, book):
    head, *rows = book["FEMA E-74"].iter_rows(values_only=True)
    assert head[:7] == ("Priority", "Item", "Location", "Quantity", "LS", "PL", "FL")
    lines = [row for row in rows if isinstance(row[0], int)]
    assert sum(row[3] for row in lines) == sum(one.item.quantity for one in results)
    assert [row[0] for row in lines] == sorted(row[0] for row in lines)
    files = next(row for row in lines if row[1] == "Files: B1 and B2")
    assert (files[2], files[3], files[7]) == ("2", 2, "NE")
    anchored = next(row for row in lines if row[1].endswith("B3"))
    assert anchored[4:7] == ("L", "L", "L")
    assert anchored[8] == "check anchor"
    assert any(str(row[0]).startswith("LS (life safety)") for row in rows), "the rule"


def test_ratings_follow_class_importance_and_routes(results):
    found = {one.item.item: (one, rate(one)) for one in results}
    one, ratings = found["B1"]
    assert one.adopted.upper >= 2
    assert ratings == {"LS": "M", "PL": "M", "FL": "H"}
    one, ratings = found["A2"]  # life safety
    level = "LMHH"[max(one.adopted.risk, one.adopted.upper)]
    assert ratings["LS"] == level
    assert ratings["PL"] == {"H": "M", "M": "L", "L": "L"}[level]
    for at, text in enumerate(("HLL", "LLH", "LML", "LLL"), 1):
        assert find_priority(dict(zip(("LS", "PL", "FL"), text, strict=True))) == at


def test_the_checklist_is_answered_where_the_workbook_tells_and_only_there(book, tmp_path):
    _head, *rows = book["Tokyo 21 items"].iter_rows(values_only=True)
    answers = {row[0]: (row[2], row[3]) for row in rows if isinstance(row[0], int)}
    assert list(answers) == list(range(1, len(TOKYO) + 1)) == list(range(1, 22))
    assert answers[1][0] == "no"
    assert "B1" in answers[1][1]
    assert answers[3] == ("no", "B1, B2")
    assert answers[16] == ("no", "B3")
    assert answers[21][0] == "yes"
    looked = {at for at, (answer, _rows) in answers.items() if answer == "not known: look"}
    assert looked >= {2, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 17, 18, 19, 20}, "no route is named either"
    routed = assess_routed(tmp_path / "w.xlsx", Settings(verify="none"), **DOUBTED)
    write_report(routed, tmp_path / "r.xlsx")
    rows = list(openpyxl.load_workbook(tmp_path / "r.xlsx")["Tokyo 21 items"].iter_rows(values_only=True))
    assert rows[12][2] in ("yes", "no"), "something may fall into a way out, or not"


def _size_of_letters(page):
    """Return the size [pt] at which letters of 11 pt are printed across A4; a stored width is 7 pixels a character."""
    pixels = sum(7 * one.width * (one.max - one.min + 1) for one in page.column_dimensions.values())
    room = 297 - 25.4 * (page.page_margins.left + page.page_margins.right)
    return 11 * min(1, room / (pixels * 25.4 / 96))


@pytest.mark.parametrize("language", ["en", "it"])
def test_the_work_list_is_printed_at_eight_points_a_page_a_floor(verified_example, tmp_path, language):
    with speaking(load_catalogue(language)):
        write_report(verified_example, tmp_path / "r.xlsx")
        lines = list_lines(Content(verified_example))
    page = openpyxl.load_workbook(tmp_path / "r.xlsx").worksheets[1]
    assert _size_of_letters(page) >= 8
    assert page.page_setup.fitToHeight == 0
    floors = [line.work.row.floor for line in lines]
    assert len(page.row_breaks.brk) == len(dict.fromkeys(floors)) - 1
    assert [page.cell(row, 2).value for row in range(3, 3 + len(lines))] == [line.number for line in lines]
    total = page.cell(3 + len(lines), 6).value
    assert str(total).startswith("=SUMIFS(F3:F")
    assert "market-street.xlsx" in page["A1"].value


def test_with_costs_it_is_as_large_and_follows_another_unit_cost(tmp_path):
    costs = [{"detail": "L-bracket to studs", "unit_cost": 85.5}]
    path = write_sheets(tmp_path / "w.xlsx", {"Building": [{}], "Floors": FLOORS, "Items": PIECES, "Costs": costs})
    write_report(assess.run(assess.read_inventory(path), UNVERIFIED), tmp_path / "r.xlsx")
    page = openpyxl.load_workbook(tmp_path / "r.xlsx")["Work list"]
    assert _size_of_letters(page) >= 8
    heads = {cell.value: cell.column_letter for cell in page[2]}
    row = next(at for at in range(3, 20) if page[f"{heads['Unit cost']}{at}"].value == 85.5)
    unit, pieces = f"{heads['Unit cost']}{row}", f"{heads['Pieces']}{row}"
    assert page[f"{heads['Cost']}{row}"].value == f'=IF({unit}="","",{pieces}*{unit})'
