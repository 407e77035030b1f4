"""The workbook to fill in: it says what `columns` says, and every spreadsheet program can use it."""

import re
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.workbook.catalogue import read_catalogue
from assess.workbook.lists import LETTERS
from assess.workbook.read import read_inventory
from assess.workbook.schema import ITEMS, LIVE, SHEETS, WORKINGS
from assess.workbook.template import ROWS, Content, Units, write_workbook
from tests.workbook.books import problems_of, read_part

UNITS: tuple[Units, Units] = ("si", "imperial")
TABLES = [sheet for sheet in SHEETS if sheet.layout == "table"]
NAMES = [sheet.name for sheet in SHEETS]


@pytest.fixture(scope="module", params=UNITS)
def units(request: pytest.FixtureRequest) -> Units:
    found: Units = request.param
    return found


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory, units: Units) -> Path:
    path = tmp_path_factory.mktemp(units) / "blank.xlsx"
    write_workbook(path, units=units)
    return path


@pytest.fixture(scope="module")
def book(path: Path) -> Any:
    return openpyxl.load_workbook(path)


def test_it_lacks_nothing_but_rows_of_which_two_suffice(path: Path, tmp_path: Path, units: Units) -> None:
    assert [str(problem) for problem in problems_of(path)] == [
        "Floors!A2: the table has no rows. Fill in at least one.",
        "Items!A2: the table has no rows: nothing is assessed. Fill in at least one.",
    ]
    copy = tmp_path / "filled.xlsx"
    book = openpyxl.load_workbook(path)
    book["Floors"]["A2"], book["Floors"]["D2"] = "1", 0.5
    for name, value in {"item": "A1", "floor": "1", "type": "Bookcase 5 shelves"}.items():
        book["Items"][f"{LETTERS['Items', name]}2"] = value
    book.save(copy)
    inventory = read_inventory(copy)
    assert inventory.problems == ()
    assert inventory.items[0].breadth == pytest.approx(0.321, rel=5e-4)
    assert inventory.items[0].height == pytest.approx(1.803, rel=5e-4)
    assert len(inventory.catalogue) == len(read_catalogue(units))
    write_workbook(tmp_path / "again.xlsx", units=units)
    assert (tmp_path / "again.xlsx").read_bytes() == path.read_bytes()


def test_tables_can_be_scrolled_sorted_and_printed(book: Any) -> None:
    assert book.sheetnames == ["Help", *NAMES, "Lists", "Walk-down"]
    for sheet in TABLES:
        page = book[sheet.name]
        assert page.freeze_panes == ("C2" if sheet is ITEMS else "B2")
        assert page.auto_filter.ref.startswith("A1:")
        assert page.print_title_rows == "$1:$1"
        assert (page.page_setup.orientation, page.page_setup.fitToHeight) == ("landscape", 0)
        assert "&P" in page.oddFooter.center.text


def test_formulas_are_those_of_excel_2007(path: Path) -> None:
    """No dynamic arrays, no @, no functions that need a prefix, within 8192 characters."""
    for number in (4, len(SHEETS) + 2):
        formulas = re.findall("<f>(.*?)</f>", read_part(path, f"xl/worksheets/sheet{number}.xml"))
        assert formulas
        for formula in formulas:
            assert len(formula) < 8192
            assert "_xl" not in formula
            assert "@" not in formula
            functions = set(re.findall(r"([A-Z.]+)\(", formula))
            assert functions <= {
                "IF", "OR", "AND", "NOT", "IFERROR", "INDEX", "MATCH", "MAX", "MIN", "MOD", "ABS", "ISNUMBER", "ISTEXT", "LN", "EXP",
                "ATAN", "COS", "SIN", "SUM",
                "ROUND", "SQRT", "NORMSDIST", "PI", "TRIM", "VLOOKUP", "LOWER", "SUBSTITUTE", "MID", "FIND",
                "COUNT", "COUNTIF", "SUMPRODUCT",
            }  # fmt: skip


def test_texts_stay_texts(tmp_path: Path) -> None:
    """What looks like a formula, a link or a number is written as it stands."""
    texts = ["=1+1", "{=1}", "+1", "@SUM(A1)", "http://example.org", "007", "<b>"]
    rows = [{"item": text, "floor": "1", "breadth": 40, "height": 180, "notes": text} for text in texts]
    write_workbook(tmp_path / "book.xlsx", Content({"Items": rows, "Floors": [{"floor": "1", "pfa_x": 0.5}]}))
    assert [one.notes for one in read_inventory(tmp_path / "book.xlsx").items] == texts


@pytest.mark.slow
def test_more_rows_than_prepared(tmp_path: Path) -> None:
    count = max(ROWS.values()) + 20
    floors = [{"floor": f"F{n}", "pfa_x": 0.5} for n in range(count)]
    types = [{"type": f"T{n}", "breadth": 40, "height": 180} for n in range(count)]
    items = [{"item": f"A{n}", "floor": f"F{n}", "type": f"T{n}"} for n in range(count)]
    path = tmp_path / "book.xlsx"
    write_workbook(path, Content({"Floors": floors, "Catalogue": types, "Items": items}))
    assert len(read_inventory(path).items) == count
    book = openpyxl.load_workbook(path)
    for name in ("list_floors", "list_catalogue", "floor_best"):
        assert book.defined_names[name].attr_text.endswith(f"${count + 1}")
    for label in (*LIVE, *WORKINGS):
        assert str(book["Items"][f"{LETTERS['Items', label]}{count + 1}"].value).startswith("=")
