"""The Excel report in another language: names, words that formulas compare, and headings; formulas still agree."""

from collections.abc import Mapping

import openpyxl
import pytest

from assess.i18n import Catalogue, speaking
from assess.report.xlsx.item_formulas import literal, sentence
from assess.report.xlsx.pen import name_sheets, refer
from assess.settings import Settings
from tests.recalculate import compare_formulas, libreoffice, needs_libreoffice, poison, same, stored_cells, write_report
from tests.workbooks import FLOORS, ITEMS, assessed

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


class _Marked(Mapping[str, tuple[str, ...]]):
    """Every text between marks, among them an apostrophe, which names of sheets have to double."""

    def __getitem__(self, key):
        return (f"l'{key} à",) * 2

    def __iter__(self):
        return iter(())

    def __len__(self):
        return 0


MARKED = Catalogue("xx", _Marked())


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    path = tmp_path_factory.mktemp("language") / "w.xlsx"
    return assessed(path, ITEMS, FLOORS, settings=Settings(verify="all", runs=10))


def test_formulas_agree_and_every_heading_is_translated(verified, tmp_path):
    with speaking(MARKED):
        write_report(verified, tmp_path / "r.xlsx")
    stored = stored_cells(tmp_path / "r.xlsx")
    assert not [place for place, value in stored.items() if isinstance(value, str) and value.startswith("#")]
    for sheet in openpyxl.load_workbook(tmp_path / "r.xlsx"):
        assert sheet.title.startswith("l'"), sheet.title
        heads = [str(cell.value) for cell in sheet[1] if cell.value]
        assert heads
        assert all(head.startswith("l'") for head in heads), heads
    assert compare_formulas(tmp_path / "r.xlsx") > 12 * len(ITEMS)


@pytest.mark.libreoffice
@needs_libreoffice
def test_libreoffice_agrees_in_another_language(verified, tmp_path):
    path = tmp_path / "r.xlsx"
    with speaking(MARKED):
        write_report(verified, path)
    stored = stored_cells(path)
    poison(path)
    found = stored_cells(libreoffice(path, tmp_path / "again.xlsx"))
    assert not [place for place, value in stored.items() if not same(value, found.get(place))]


def test_names_of_sheets_hold_excels_rules():
    names = name_sheets({
        "a": "Qualità: log?", "b": "qualità  log", "c": "'x'", "d": "y" * 40, "e": "Y" * 40, "f": "[]",
    })  # fmt: skip
    assert names == {
        "a": "Qualità  log", "b": "qualità  log 2", "c": "x", "d": "y" * 31, "e": "Y" * 29 + " 2", "f": "f",
    }  # fmt: skip
    assert refer("L'arredo") == "'L''arredo'!"


def test_a_sentence_with_holes_is_an_expression():
    assert literal('a "b"') == '"a ""b"""'
    assert sentence("{all} of {some}.", some="A1", all="B2") == 'B2&" of "&A1&"."'
