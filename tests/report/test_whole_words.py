"""Words of the workbook stay whole in the tables of pieces, and identical rows stay together, on paper."""

from itertools import pairwise

import openpyxl
import pytest

import assess
from assess.report.words import list_breaks
from tests.report.reading import lay_out, render
from tests.workbooks import assessed

boxes = pytest.importorskip("weasyprint.formatting_structure.boxes")

FLOORS = [
    {"floor": name, "name": title, "elevation": at, "pfa_x": 0.5, "pfv_x": 40, "pfa_y": 0.5, "pfv_y": 45}
    for name, title, at in (("Second", "Second floor", 8), ("Mezzanine", "", 4), ("Basement", "", -3))
]  # fmt: skip
ROOMS = ["Physiotherapy", "Echocardiography waiting area", "Gastroenterology", "Sterilisation"]
WHAT = ["Refrigerator for vaccines", "Electrocardiograph on a trolley", "Bookcase, partly anchored",
        "Uninterruptible power supply"]  # fmt: skip
ITEMS = [
    {"item": f"{FLOORS[at % 3]['floor']}-{at:02}", "floor": FLOORS[at % 3]["floor"], "room": ROOMS[at % 4],
     "description": WHAT[at % 4], "breadth": 30 + 5 * (at % 4), "width": 80, "height": 180,
     "anchored": "yes" if at % 7 == 0 else "no", "importance": "life safety" if at % 5 == 0 else None}
    for at in range(24)
]  # fmt: skip
TABLES = {"items", "pieces", "named"}


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", [""]),
        ("Electrocardiograph on a trolley", ["Electrocardiograph on a trolley"]),
        ("Second-PHYS-14-12-Gastroenterology", ["Second-PHYS-14-12-Gastroenterology"]),
        ("Electroencephalograph", ["Electroence", "phalograph"]),
        ("a Supercalifragilisticexpialidocious-wing", ["a Supercalifragilis", "ticexpialidocious-wing"]),
    ],
)
def test_only_long_words_have_places_to_break_at(text, parts):
    assert list_breaks(text) == parts
    assert "".join(list_breaks(text)) == text


def walk(box):
    yield box
    for child in getattr(box, "children", ()):
        yield from walk(child)


def of(box, kind):
    return [one for one in walk(box) if isinstance(one, kind)]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("words") / "w.xlsx", ITEMS, FLOORS, building="General Hospital")


@pytest.fixture(scope="module")
def pages(results):
    html = render(results, for_print=True)
    return lay_out(html)


def broken(cell):
    """Return where a line of a cell ends within a word: not at a space, hyphen or slash."""
    words = "".join(cell.element.itertext()).split()
    lines = ["".join(one.text for one in of(line, boxes.TextBox)).split() for line in of(cell, boxes.LineBox)]
    ends = [(one[-1], other[0]) for one, other in pairwise(line for line in lines if line)]
    return [
        (last, first)
        for last, first in ends
        if last[-1] not in "-/" and any(last.rstrip("\N{HYPHEN}") + first in word for word in words)
    ]


def test_no_word_of_the_inventory_is_broken_over_lines(pages):
    seen = set()
    for page in pages:
        for table in of(page, boxes.TableBox):
            names = TABLES & set(table.element.get("class", "").split())
            for cell in of(table, boxes.TableCellBox) if names else ():
                assert broken(cell) == [], "".join(cell.element.itertext())
                seen |= set("".join(cell.element.itertext()).split())
    assert {"Physiotherapy", "Echocardiography", "Mezzanine", "Electrocardiograph"} <= seen


def test_columns_of_the_excel_report_hold_the_longest_word(results, tmp_path):
    written = assess.write_reports(results, tmp_path, ("xlsx",))["xlsx"]
    book = openpyxl.load_workbook(written)
    for name in ("item", "floor", "room", "description"):
        sheet = book["Items"]
        head = next(cell for cell in sheet[1] if cell.value == name.capitalize())
        words = [word for row in ITEMS for word in str(row[name]).replace("-", "- ").split()]
        assert sheet.column_dimensions[head.column_letter].width > max(map(len, words)), name
    book.close()
