"""The ranking: its sheets hold the tables' numbers, texts are no formulas, and groups are not added up."""

import io
from dataclasses import replace

import openpyxl
import pytest

from assess.portfolio.ranking_workbook import list_first_pieces, render_ranking
from assess.report.report_options import ReportOptions
from tests.portfolio.city_samples import NASTY, make_view


@pytest.fixture(scope="module")
def view():
    return make_view(60, draws=50)


@pytest.fixture(scope="module")
def book(view):
    return openpyxl.load_workbook(io.BytesIO(render_ranking(view)))


def _rows(sheet):
    heads, *rows = sheet.iter_rows(values_only=True)
    return [dict(zip(heads, row, strict=True)) for row in rows]


def test_the_sheets_have_filters_and_frozen_heads_and_no_cell_is_a_formula_or_a_link(book):
    names = ["Summary", "Buildings", "Types", "Pieces to fix first", "Routes", "Skipped", "Notes"]
    assert book.sheetnames == names
    for name in names[1:]:
        assert book[name].freeze_panes == "A2", name
        assert book[name].auto_filter.ref, name
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row]
    assert {cell.data_type for cell in cells} <= {"s", "n"}
    assert all(cell.hyperlink is None for cell in cells)
    assert any(cell.value and str(cell.value).startswith("=cmd|") for cell in cells)


def test_buildings_have_the_numbers_of_the_tables_in_the_order_of_the_rule(book, view):
    rows = _rows(book["Buildings"])
    known = view.buildings.set_index("path")
    assert len(rows) == 60
    for row in rows:
        own = known.loc[row["File"]]
        if own["status"] == "assessed":
            assert row["Expected falls"] == pytest.approx(own["expected_falls"])
            assert row["Pieces, very high"] == own["very_high"]
            counted = own["low"] + own["medium"] + own["high"] + own["very_high"]
            assert row["Share expected to fall"] == pytest.approx(own["expected_falls"] / counted)
            assert row["Ground PGA [g]"] == own["ground_pga_g"]
    assessed = [row for row in rows if row["Expected falls"] is not None]
    order = [(-round(row["People on blocked routes, expected"]), -row["Expected falls"]) for row in assessed]
    assert order == sorted(order)
    assert rows[: len(assessed)] == assessed  # skipped ones come last


def test_the_sums_of_surveyed_and_assumed_buildings_stand_in_columns_of_their_own(book, view):
    sheet = book["Summary"]
    rows = {row[0].value: [cell.value for cell in row[1:]] for row in sheet.iter_rows()}
    assert rows["Sums, kept apart"] == [
        "Surveyed buildings, simulated",
        "Buildings with an assumed inventory, simulated",
    ]
    for at, inventory in enumerate(("surveyed", "assumed")):
        own = view.buildings[view.buildings["inventory"] == inventory]
        assert rows["Expected falls"][at] == pytest.approx(own["expected_falls"].sum())
        assert rows["Buildings"][at] == len(own)
    assert rows["Expected falls with many pieces (90 % quantities)"][0] is None


def test_pieces_come_by_their_place_on_the_work_lists(view):
    found = list_first_pieces(view)
    places = [piece["work_place"] for _building, piece in found]
    assert places == sorted(places)
    assert all(building["path"] == piece["path"] for building, piece in found)
    assert {piece["work_place"] for _building, piece in found[:20]} == {1}


def test_skipped_buildings_say_why(book):
    rows = _rows(book["Skipped"])
    assert len(rows) == 5
    said = {
        "What": "height is 1.8 cm, expected 5 to 600.",
        "Place": "Items H14",
        "How to fix it": "Did you type metres?",
    }
    assert said.items() <= rows[0].items()


@pytest.mark.slow
def test_what_is_not_known_of_a_building_stands_beside_its_numbers(view):
    rows = view.buildings.copy()
    paths = [one["path"] for one in view.ranked[:2]]
    changed = {"occupants": 100, "people_not_known": 58, "routes": 1, "routes_blocked": 0, "routes_not_known": 1,
               "unconfirmed": 25, "own_motions": 2}  # fmt: skip
    rows.loc[rows["path"] == paths[0], list(changed)] = list(changed.values())
    none = ["routes", "routes_blocked", "routes_not_known"]
    rows.loc[rows["path"] == paths[1], none] = 0
    book = openpyxl.load_workbook(io.BytesIO(render_ranking(replace(view, buildings=rows))))
    found = {row["File"]: row for row in _rows(book["Buildings"])}
    row = found[paths[0]]
    assert (row["People on routes whose state is known"], row["People on routes not known"]) == (42, 58)
    assert (row["Unconfirmed"], row["Floors with motions of their own"]) == (25, 2)
    assert row["Routes blocked"] == "not known"
    assert found[paths[1]]["Routes blocked"] == "–"


@pytest.mark.slow
def test_formulas_alone_have_no_ranges():
    book = openpyxl.load_workbook(io.BytesIO(render_ranking(make_view(12, verify="none"))))
    rows = {row[0].value: [cell.value for cell in row[1:]] for row in book["Summary"].iter_rows()}
    assert rows["Falls that 95 % of the earthquakes do not exceed"] == [None]
    assert rows["Sums, kept apart"] == ["Surveyed buildings, by formula only"]
    assert any(str(text).startswith("Expected to overturn:") and "No range is known" in text for text in rows if text)


@pytest.mark.slow
def test_a_city_of_which_nothing_could_be_assessed_has_a_ranking_all_the_same():
    view = make_view(60, draws=5)
    assert render_ranking(view) == render_ranking(view), "the same bytes each time"
    gone = view.buildings[view.buildings["status"] == "skipped"]
    empty = replace(view, buildings=gone, pieces=view.pieces[:0], routes=view.routes[:0], draws=view.draws[:0])
    book = openpyxl.load_workbook(io.BytesIO(render_ranking(empty, options=ReportOptions(language="it"))))
    assert len(book.worksheets) == 7
    assert NASTY not in str(book.worksheets[0]["A1"].value)
