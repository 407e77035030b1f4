"""A workbook with what only spreadsheet programs know, edited: all of it stays, and LibreOffice shows the same."""

import shutil
from pathlib import Path

import pytest
from openpyxl import load_workbook

from assess.web.book import Book
from tests.web.opened import edit
from tests.workbooks import parts_of

USERS = Path(__file__).parents[1] / "nets" / "workbooks"


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
