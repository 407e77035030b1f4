"""The ranking: how its sheets are set up, that texts are no formulas, and what comes first; see test_shown.py."""

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


def test_sheets_have_filters_and_frozen_heads_no_cell_is_a_formula_and_pieces_come_by_their_place(book, view):
    names = ["Summary", "Buildings", "Types", "Pieces to fix first", "Routes", "Skipped", "Notes"]
    assert book.sheetnames == names
    for name in names[1:]:
        assert book[name].freeze_panes == "A2", name
        assert book[name].auto_filter.ref, name
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row]
    assert {cell.data_type for cell in cells} <= {"s", "n"}
    assert all(cell.hyperlink is None for cell in cells)
    assert any(cell.value and str(cell.value).startswith("=cmd|") for cell in cells)
    found = list_first_pieces(view)
    places = [row["work_place"] for row in found]
    assert places == sorted(places)
    buildings = dict(zip(view.buildings["path"], view.buildings["building"], strict=True))
    assert all(row["building"] == buildings[row["path"]] for row in found)
    assert set(places[:20]) == {1}


@pytest.mark.slow
def test_a_city_of_which_nothing_could_be_assessed_has_a_ranking_all_the_same():
    view = make_view(60, draws=5)
    assert render_ranking(view) == render_ranking(view), "the same bytes each time"
    gone = view.buildings[view.buildings["status"] == "skipped"]
    empty = replace(view, buildings=gone, pieces=view.pieces[:0], routes=view.routes[:0], draws=view.draws[:0])
    book = openpyxl.load_workbook(io.BytesIO(render_ranking(empty, options=ReportOptions(language="it"))))
    assert len(book.worksheets) == 7
    assert NASTY not in str(book.worksheets[0]["A1"].value)
