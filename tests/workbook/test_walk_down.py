"""The form of a walk-down: pages to print with the labels of Items, which no reading takes for data."""

import openpyxl
import pytest

from assess.cli.command_new import write_new_workbook
from assess.i18n import gettext, load_catalogue, speaking
from assess.workbook.read import read_inventory
from assess.workbook.schema import ITEMS
from assess.workbook.walk_down import BOX, LINES, PAGES


@pytest.mark.parametrize(("language", "units"), [("en", "si"), ("it", "imperial")])
def test_its_pages_are_printed_one_a_room_and_have_the_labels_of_items(tmp_path, language, units):
    path = tmp_path / "w.xlsx"
    write_new_workbook(path, units, language=language, use="Hospital", example=True)
    book = openpyxl.load_workbook(path)
    page = book.worksheets[-1]
    with speaking(load_catalogue(language)):
        assert page.title == gettext("Walk-down")
        labels = [gettext(ITEMS.column(name).label) for name in ("type", "quantity", "breadth", "anchored", "photo")]
        room = gettext("Room")
    unit = "[in]" if units == "imperial" else "[cm]"
    setup = page.page_setup
    assert (setup.orientation, setup.paperSize, setup.fitToHeight) == ("landscape", 9, 0)
    assert page.print_title_rows == "$1:$1"
    rows = [[cell.value for cell in row] for row in page.iter_rows()]
    heads = [row for row in rows if row[1] == labels[0]]
    assert len(heads) == PAGES == len(page.row_breaks.brk)
    assert all(set(labels) <= {str(text).removesuffix(f" {unit}") for text in head} for head in heads)
    assert sum(row[0] in range(1, LINES + 1) for row in rows) == PAGES * LINES
    assert sum(room in row for row in rows) == PAGES
    boxes = [row[6] for row in rows if str(row[6]).startswith(BOX)]
    assert len(boxes) == PAGES * LINES
    assert boxes[0].count(BOX) == 4
    types = [str(row[0].value) for row in book.worksheets[6].iter_rows(min_row=2, max_col=1) if row[0].value]
    listed = {str(text).partition("  ")[2]: text for row in rows for text in row if str(text)[:1].isdigit()}
    assert [int(listed[name].split()[0]) for name in types] == list(range(1, len(types) + 1))


def test_reading_and_checking_leave_it_out(tmp_path):
    path = tmp_path / "w.xlsx"
    write_new_workbook(path, "si", example=True)
    book = openpyxl.load_workbook(path)
    page = book["Walk-down"]
    found = read_inventory(path)
    page["B6"], page["C6"], page["D6"] = "not a number", "many", -3
    book.save(path)
    assert read_inventory(path).problems == found.problems
    assert len(read_inventory(path).items) == len(found.items)
