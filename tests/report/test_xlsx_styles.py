"""Named cell styles of the Excel report, which Excel lists under Cell Styles."""

import re
import zipfile

import openpyxl
import pytest

from assess.language import Catalogue, speaking
from assess.report.xlsx import write_xlsx
from assess.report.xlsx.styles import LOOKS, Style, name_styles
from tests.recalculate import libreoffice, needs_libreoffice
from tests.workbooks import assessed

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

CLASSES = {"Class low", "Class medium", "Class high", "Class very high"}
STATES = {"Route open", "Route reduced", "Route blocked"}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("styles")
    write_xlsx(assessed(folder / "w.xlsx"), folder / "r.xlsx")
    return folder / "r.xlsx"


def _styles(sheet):
    return {cell.style for row in sheet.iter_rows() for cell in row if cell.has_style}


def test_styles_have_names_and_cells_belong_to_them(path):
    book = openpyxl.load_workbook(path)
    assert {"Normal", *LOOKS, *CLASSES, *STATES} == set(book.named_styles)
    items = book["Items"]
    heads = {str(cell.value): cell.column for cell in items[1]}
    for label, style in (("Height [cm]", "Input"), ("OR", "Percent"), ("PFA used [g]", "Calculation")):
        assert items.cell(2, heads[label]).style == style
    assert {cell.style for cell in items[1]} == {"Heading 1"}
    assert book["Floors"]["C2"].style == "Input"
    assert book["Assumptions"]["B2"].style == "Input"
    assert book["Summary"]["A1"].style == "Title"
    assert _styles(book["Summary"]) >= {"Heading 1", "Heading 2", "Total", "Percent", *CLASSES}
    assert _styles(book["Fix first"]) & CLASSES


def _inside(text, name):
    return text.split(f"<{name} ")[1].split(f"</{name}>")[0]


def test_every_number_in_the_file_of_styles_holds(path):
    with zipfile.ZipFile(path) as archive:
        text = archive.read("xl/styles.xml").decode()
    counts = re.findall(r'<(cellStyleXfs|cellXfs|cellStyles|fonts|fills|borders) count="(\d+)">', text)
    count = {name: int(number) for name, number in counts}
    own, formats, names = (_inside(text, name) for name in ("cellStyleXfs", "cellXfs", "cellStyles"))
    assert own.count("<xf ") == count["cellStyleXfs"]
    assert formats.count("<xf ") == count["cellXfs"]
    assert names.count("<cellStyle ") == count["cellStyles"] == count["cellStyleXfs"]
    assert "xfId" not in own
    assert {int(number) for number in re.findall(r'xfId="(\d+)"', formats + names)} == set(range(count["cellStyles"]))
    for name, part in (("fontId", "fonts"), ("fillId", "fills"), ("borderId", "borders")):
        assert max(int(number) for number in re.findall(rf'{name}="(\d+)"', own + formats)) < count[part]


def test_a_file_of_styles_that_is_not_as_expected_stays_as_it_is():
    style = Style("Input", 20, [1])
    assert name_styles("<styleSheet/>", [style]) == "<styleSheet/>"
    few = (
        '<cellStyleXfs count="1"><xf numFmtId="0"/></cellStyleXfs><cellXfs count="1"><xf numFmtId="0" xfId="0"/>'
        '</cellXfs><cellStyles count="1"><cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles>'
    )
    assert name_styles(few, [style]) == few
    assert 'name="Input" xfId="1"' in name_styles(few, [Style("Input", 20, [0])])


def test_names_are_in_the_language_of_the_report_and_escaped(tmp_path):
    with speaking(Catalogue("xx", {"Class low": ('Classe <"bassa"> & co.',)})):
        write_xlsx(assessed(tmp_path / "w.xlsx"), tmp_path / "r.xlsx")
    assert 'Classe <"bassa"> & co.' in openpyxl.load_workbook(tmp_path / "r.xlsx").named_styles


@pytest.mark.libreoffice
@needs_libreoffice
def test_libreoffice_keeps_the_styles(path, tmp_path):
    book = openpyxl.load_workbook(libreoffice(path, tmp_path / "again.xlsx"))
    assert set(book.named_styles) >= CLASSES
