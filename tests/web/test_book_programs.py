"""A workbook with what only spreadsheet programs know, edited: all of it stays, and LibreOffice shows the same."""

import shutil
import zipfile
from pathlib import Path

import pytest
from openpyxl import load_workbook

from assess.pipeline.live_values import with_live
from assess.web.book import Book
from assess.workbook import template
from assess.workbook.lists import LETTERS, PLACES
from assess.workbook.schema import LIVE
from assess.workbook.template import Content, write_workbook
from assess.workbook.writer import write_book
from tests.recalculate import libreoffice, libreoffice_all, needs_libreoffice, stored_cells
from tests.web.opened import edit
from tests.workbooks import FLOORS, ITEMS

ROWS = {"Building": [{"building": "Hall", "ground_pga": 0.2, "period": 0.8}], "Floors": FLOORS, "Items": ITEMS}
USERS = Path(__file__).parents[1] / "nets" / "workbooks"


def parts_of(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.mark.slow
def test_everything_of_the_user_stays(tmp_path):
    """Charts, pictures, comments, tables, macros, links to other files, pivot tables, and what is not known."""
    kinds = set()
    for path in [Path(shutil.copy(one, tmp_path)) for one in sorted(USERS.glob("*.xls*"))]:
        before, book = parts_of(path), Book.open_disk(path)
        edit(book, ("Items", 2, "height", 151), ("Items", 2, "room", "Attic"))
        book.save()
        after = parts_of(path)
        assert list(before) == list(after), path.name
        changed = {name for name in before if before[name] != after[name]}
        assert len(changed) == 1, path.name
        assert changed.pop().startswith("xl/worksheets/sheet"), path.name
        kinds |= {name.split("/")[1].removesuffix(".bin") for name in before if name.startswith("xl/")}
    assert {"charts", "drawings", "media", "comments", "tables", "externalLinks", "pivotCache", "vbaProject"} <= kinds


def add_own(book):
    """Add a column, formulas and a sheet of the user."""
    items, mine = book.get_worksheet_by_name("Items"), book.add_worksheet("Mine")
    items.write_row(0, 60, ["Owner", "Twice"])
    for row in range(1, 6):
        items.write(row, 60, f"Person {row}")
        items.write_formula(row, 61, f"=2*{LETTERS['Items', 'height']}{row + 1}", None, 1.0)
    mine.write_formula("D1", f"=SUM(Items!{LETTERS['Items', 'height']}2:{LETTERS['Items', 'height']}6)", None, 5)


@needs_libreoffice
@pytest.mark.libreoffice
@pytest.mark.slow
def test_libreoffice_shows_the_same(tmp_path, monkeypatch):
    """Nothing but the edits and what follows from them differs; stored results are what LibreOffice computes."""
    rich = tmp_path / "rich.xlsx"
    monkeypatch.setattr(
        template, "write_book", lambda path, fill: write_book(path, lambda book: (fill(book), add_own(book)))
    )
    write_workbook(rich, with_live(Content(ROWS)), spare=3)
    (tmp_path / "before.xlsx").write_bytes(rich.read_bytes())
    book = Book.open_disk(rich)
    height, name = PLACES["Items", "height"], PLACES["Items", "item"]
    added = {"item": "A6", "floor": "1", "breadth": 30, "height": 150, "anchored": "no"}
    edits = [["Items", 2, height, 150], ["Items", 4, name, "A3 renamed"], ["Items", 3, 60, "New owner"]]
    edits += [["Items", 7, PLACES["Items", field], value] for field, value in added.items()]
    book.edit(1, [*edits, ["Floors", 3, PLACES["Floors", "pfa_x"], 0.8]], "x")
    book.save()
    as_users = stored_cells(libreoffice(rich, tmp_path / "users.xlsx", recalculates=False))
    both = libreoffice_all([tmp_path / "before.xlsx", rich], tmp_path / "recalculated")
    before, after = map(stored_cells, both)
    live = {("Items", f"{LETTERS['Items', label]}{row}") for label in LIVE for row in range(2, 8)}
    assert live <= after.keys()
    for cell in live:
        stored, computed = as_users.get(cell), after.get(cell)
        assert stored == (computed if isinstance(computed, str) else pytest.approx(computed, rel=1e-6)), cell
    changed = {cell for cell in before.keys() | after.keys() if before.get(cell) != after.get(cell)}
    assert {("Items", "A4"), ("Items", "BI3"), ("Items", f"{LETTERS['Items', 'height']}2"), ("Mine", "D1")} <= changed
    assert {sheet for sheet, _ in changed} == {"Items", "Mine", "Floors", "Lists"}


def test_undo_after_a_save_brings_rich_text_back(tmp_path):
    path = tmp_path / "own.xlsx"
    shutil.copy(USERS / "1904.xlsx", path)
    before = path.read_bytes()
    book = Book.open_disk(path)
    book.edit(1, [["Items", 3, 3, "Plain"]], "x")
    book.save()
    assert load_workbook(path)["Items"].cell(3, 4).value == "Plain"
    book.undo(book.version)
    assert book.state()["unsaved"]
    book.save()
    assert path.read_bytes() == before
    assert not book.state()["unsaved"]
    book.redo(book.version)
    book.save()
    assert load_workbook(path)["Items"].cell(3, 4).value == "Plain"
