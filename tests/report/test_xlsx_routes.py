"""The sheets of the routes in the Excel report: how they look, and that their cells are texts."""

import openpyxl
import pytest

from assess.i18n import Catalogue, load_catalogue, speaking
from assess.route_results import RouteState
from assess.settings import Settings
from tests.recalculate import compare_formulas, write_report
from tests.report.routed import DOUBTED, ITEMS, assess_routed

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("routes")
    results = assess_routed(folder / "w.xlsx", Settings(verify="all", runs=20), **DOUBTED)
    write_report(results, folder / "r.xlsx")
    return results, openpyxl.load_workbook(folder / "r.xlsx"), folder / "r.xlsx"


def _colour(state):
    return f"FF{state.fill.removeprefix('#').upper()}"


def test_states_have_sign_and_colour(written):
    results, book, _ = written
    for at, one in enumerate(results.route_tables.segments, 2):
        cell = book["Routes"].cell(at, 6)
        assert cell.value.startswith(f"{one.state.symbol} ")
        assert cell.fill.fgColor.rgb == _colour(one.state)
    worst = max((one.state for one in results.route_tables.segments), key=lambda state: state.severity)
    assert worst in (RouteState.BLOCKED, RouteState.NOT_KNOWN)
    assert _colour(worst) in {cell.fill.fgColor.rgb for row in book["Routes"].iter_rows() for cell in row}


def test_the_sheets_are_set_up(written):
    _, book, _ = written
    for name, frozen, area in (("Routes", "C2", "A1:AF6"), ("Route pieces", "A2", "A1:P4"),
                               ("Route rooms", "B2", "A1:Z3")):  # fmt: skip
        sheet = book[name]
        assert sheet.freeze_panes == frozen
        assert sheet.auto_filter.ref == area
        assert sheet.print_title_rows == "$1:$1"
        assert sheet.page_setup.orientation == "landscape"
        assert sheet["A1"].fill.fgColor.rgb == "FF1F3A4D"
    assert book["Routes"]["G2"].number_format == "0.0%"
    assert book["Routes"]["U2"].number_format == "0.00"


def test_no_text_is_a_formula(written):
    _, book, path = written
    for name in ("Routes", "Route pieces", "Route rooms"):
        for row in book[name].iter_rows():
            assert all(cell.data_type != "f" and cell.hyperlink is None for cell in row)
    assert book["Routes"]["AF2"].value == "=1+1"
    assert compare_formulas(path) > len(ITEMS)


@pytest.mark.parametrize("language", ["it", "marked"])
def test_headings_in_another_language_stay_apart(written, language, tmp_path):
    """Columns are told apart by their headings: two with the same translation would be one."""
    texts = {"Clear width": ("Larghezza",), "Route": ("Via",)}
    with speaking(load_catalogue("it") if language == "it" else Catalogue("xx", texts)):
        write_report(written[0], tmp_path / "r.xlsx")
    book = openpyxl.load_workbook(tmp_path / "r.xlsx")
    own = [sheet for sheet in book.worksheets if sheet.title not in written[1].sheetnames] or book.worksheets
    for sheet in own:
        heads = [cell.value for cell in sheet[1] if cell.value]
        assert len(heads) == len(set(heads)), sheet.title
    widths = {len([cell for cell in sheet[1] if cell.value]) for sheet in book.worksheets}
    assert {32, 16, 26} <= widths
