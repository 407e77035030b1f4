"""Cells held in memory: what is read of them is what would be read of the bytes, and files are read once."""

import io
import random
import shutil
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import xlsxwriter
from hypothesis import given, settings, strategies as st

from assess.errors import WorkbookError
from assess.model import Inventory
from assess.plans import Drawing, read_plan
from assess.workbook.kept_files import KeptFiles
from assess.workbook.lists import PLACES
from assess.workbook.open import Place
from assess.workbook.patch import Value
from assess.workbook.read import build_inventory, open_workbook, parse_workbook, read_inventory
from assess.workbook.store import Workbook, Worksheet
from assess.workbook.template import Content, write_workbook
from tests.pictures import picture

TESTS = Path(__file__).parents[1]
RECORD = "891018_1.cra-1.0210a.smc"
RECORDS = Path(__file__).parents[2] / "inventories" / "records" / "575-market"


def _odd_book() -> bytes:
    """A workbook with what changes how cells are read: formats of cells, rows and columns, merges, hidden rows."""
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed, {"strings_to_formulas": False}) as book:
        percent, date = book.add_format({"num_format": "0.0%"}), book.add_format({"num_format": "yyyy-mm-dd"})
        plain, hours = book.add_format({"bold": True}), book.add_format({"num_format": "[h]:mm"})
        floors, items, form = book.add_worksheet("Floors"), book.add_worksheet("Items"), book.add_worksheet("Building")
        floors.write_row(0, 0, ["A title above the table"])
        floors.write_row(2, 0, ["Floor", "PFA X [g]", "Elevation [m]", "Record X", "Plan"])
        floors.write_row(3, 0, ["1", 0.5, 3])
        floors.write_row(4, 0, ["2", None, 6], plain)
        items.write_row(0, 0, ["Item", "Floor", "Breadth [cm]", "Height [m]", "Mine", "Centre of gravity [%]",
                               "Quantity", "Anchored", "Class (formula)", "B/H", "Notes"])  # fmt: skip
        items.set_column(5, 5, None, percent)
        items.set_row(6, None, date)
        items.set_row(7, None, None, {"hidden": True})
        for row in range(1, 8):
            items.write_row(row, 0, [f"A{row}", "1" if row % 2 else "2", 40 + row, 1.8], plain if row < 3 else None)
            items.write_formula(row, 8, f"=C{row + 1}", None, "" if row > 4 else "low")
        items.write(2, 4, 45000.25, date)
        items.write(3, 5, 0.45, percent)
        items.write(4, 6, 2, hours)
        items.write(5, 5, 40, plain)
        items.write_formula(6, 10, "=1+1", None, 2)
        items.merge_range("A12:C12", "Heading")
        for row, line in enumerate((["Building", "Town hall"], ["Report date", 45000], ["Ground PGA [g]", 0.2])):
            form.write_row(row, 0, line, date if row == 1 else None)
    return packed.getvalue()


ODD = _odd_book()
FIXED = {"Items": {(row, at) for row in range(2, 9) for at in (8, 10)}}
"""Cells that hold formulas; the page edits none of them."""

VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 200),
    st.floats(-1e6, 1e6),
    st.sampled_from([1e15, 123456789012345678, -0.0, 45000.5, 0.3, 5e-324, 9e307]),
    st.sampled_from(["", " ", "1", "2", "A1", "45 cm", "1,80 m", "yes", "no", "42%", "2024-05-01", "Floor", "Item",
                     "a.png", "_x0041_", "_x005F_", "a\x00b", "\r\nline\r", "\ud800", "=1+1", "<b>&", "\t", "è"]),
)  # fmt: skip
CELLS = st.tuples(st.sampled_from(["Items", "Floors", "Building"]), st.integers(1, 14), st.integers(0, 11))


def _read(held: Workbook, folder: Path | None = None, kept: KeptFiles | None = None) -> Inventory:
    tables, problems = parse_workbook(held)
    return build_inventory(tables, problems, Path("inventory.xlsx"), folder, kept=kept)


def _read_bytes(data: bytes, folder: Path | None = None) -> Inventory:
    return replace(read_inventory(data, records=folder, strict=False), sha256="")


@given(first=st.dictionaries(CELLS, VALUES, max_size=30), second=st.dictionaries(CELLS, VALUES, max_size=8))
@settings(max_examples=40, deadline=None)
@pytest.mark.slow
def test_what_is_held_reads_as_the_bytes_do(first: dict[Any, Any], second: dict[Any, Any]) -> None:
    held = open_workbook(ODD, "inventory.xlsx")
    assert _read(held) == _read_bytes(ODD)
    for changes in (first, second):
        edits: dict[str, dict[Place, Value]] = {}
        for (sheet, row, at), value in changes.items():
            if (row, at) not in FIXED.get(sheet, ()):
                edits.setdefault(sheet, {})[row, at] = value
        held = held.set(edits)
        data = held.to_bytes()
        anew = open_workbook(data, "inventory.xlsx")
        assert {name: one.cells for name, one in held.sheets.items()} == {
            name: one.cells for name, one in anew.sheets.items()
        }
        assert _read(held) == _read_bytes(data)


RICH = sorted(one for folder in ("nets/workbooks", "data/workbooks") for one in (TESTS / folder).glob("*.xls[xm]"))
SOME = [None, None, True, False, 7, -2.5, 1e15, 45000.25, 0.3, "", " x ", "45 cm", "=1+1", "<b>&\"'", "_x0041_", "a\r\nb",
        "\u200b", "è" * 40, "12,5 %", "2024-05-01"]  # fmt: skip


def _edit(book: Workbook, draw: random.Random) -> Workbook:
    """One random edit: some cells set, or rows inserted, deleted or moved; the same workbook where it is refused."""
    name = draw.choice(
        [*book.sheets, *(one for one in book.titles if one not in {s.title for s in book.sheets.values()})]
    )
    sheet = book.sheet(name)
    row, kind = draw.randint(1, sheet.last_row + 3), draw.random()
    try:
        if kind < 0.15:
            return book.insert_rows(name, row, draw.randint(1, 3), like=draw.choice([0, max(row - 1, 1), row]))
        if kind < 0.3:
            return book.delete_rows(name, row, draw.randint(1, 3))
        if kind < 0.45:
            return book.move_rows(
                name, row, count := draw.randint(1, 3), draw.choice([max(1, row - 2), row + count + 2])
            )
        places = {(max(1, row + draw.randint(-2, 6)), draw.randint(0, 20)) for _ in range(draw.randint(1, 12))}
        free = [one for one in places if not book.find_lock(name, one) or draw.random() < 0.02]
        return book.set({name: {place: draw.choice(SOME) for place in free}})
    except WorkbookError as error:
        if error.problems[0].sheet != sheet.title:
            raise
        return book


def _show(sheet: Worksheet) -> dict[str, Any]:
    """What reading tells of a sheet. A format counts where a number would get it."""
    marks, rows = sheet.marks, range(1, sheet.last_row + 5)
    return {
        "cells": {row: {at: (type(one), one) for at, one in cells.items()} for row, cells in sheet.rows()},
        "formulas": marks.formulas, "unknown": marks.unknown, "locked": sorted(marks.locked), "hollow": marks.hollow,
        "formats": {(row, at): code for row in rows for at in range(24) if (code := marks.format_at((row, at)))},
        "merged": sorted(sheet.merged), "hidden rows": list(sheet.hidden_rows), "hidden columns": sheet.hidden_columns,
        "tables": [(one.area[:3], one.headers, one.totals) for one in sheet.tables],
        "locks": {(row, at): why for row in rows for at in range(24) if (why := sheet.find_lock((row, at)))},
    }  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("path", RICH, ids=lambda path: path.name)
def test_any_edits_of_a_rich_workbook_read_as_they_were_made(path: Path) -> None:
    """read(bytes(edit(x))) == edit(read(x)): cells, formulas, formats, merged cells, tables, what is hidden or locked."""
    draw = random.Random(path.name)
    for _ in range(10):
        book = open_workbook(path.read_bytes(), path.name)
        for _ in range(10):
            book = _edit(book, draw)
        try:
            data = book.to_bytes()
        except WorkbookError as error:
            if any(not one.cell for one in error.problems):
                raise
            continue  # a cell of an array formula, or the like, was set all the same
        anew = open_workbook(data, path.name)
        assert anew.titles == book.titles
        for name, sheet in book.sheets.items():
            assert _show(anew.sheet(name)) == _show(sheet), name
        assert anew.set({}).to_bytes() is data
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for part in archive.namelist():
                if part.endswith((".xml", ".rels")):
                    ElementTree.fromstring(archive.read(part))


def test_what_was_held_stays_and_is_written_back_as_it_was_read() -> None:
    held = open_workbook(ODD, "inventory.xlsx")
    before = _read(held)
    changed = held.set({"Items": {(2, 2): 50, (30, 0): "new", (3, 0): None}})
    assert changed.sheets["Items"].value((2, 2)) == 50
    assert changed.sheets["Floors"] is held.sheets["Floors"]
    assert changed.sheets["Items"].cells[5] is held.sheets["Items"].cells[5]  # rows that no edit touches are shared
    assert list(changed.sheets["Items"].cells) == sorted(changed.sheets["Items"].cells)
    assert _read(changed) != before
    assert _read(held) == before
    # A date that an edit replaced returns as the number that its cell shows as a date.
    held = open_workbook(ODD, "inventory.xlsx")
    cells = held.sheets["Items"]
    places = [(3, 4), (4, 5), (5, 6), (2, 0), (6, 5)]
    old = {place: cells.value(place) for place in places}
    gone = held.set({"Items": dict.fromkeys(places)})
    back = {place: cells.as_written(value) for place, value in old.items()}
    again = open_workbook(gone.to_bytes(), "inventory.xlsx").set({"Items": back})
    anew = open_workbook(again.to_bytes(), "inventory.xlsx").sheet("Items")
    assert {place: anew.value(place) for place in places} == old
    assert gone.set({"Items": back}).to_bytes() == ODD, "what is set back is as it was opened"


@pytest.fixture
def named(tmp_path: Path) -> Path:
    """The folder of a workbook that names a record, two photos, a logo and a plan."""
    shutil.copy(RECORDS / RECORD, tmp_path / "a.smc")
    for name in ("p1.png", "p2.png", "logo.png", "plan.png"):
        (tmp_path / name).write_bytes(picture("PNG"))
    (tmp_path / "hazard.csv").write_text("pga_g,annual_rate\n0.1,0.01\n0.2,0.004\n0.4,0.0008\n")
    rows = {
        "Building": [{"logo": "logo.png", "hazard": "hazard.csv", "ground_pga": 0.2}],
        "Floors": [{"floor": "1", "record_x": "a.smc", "plan": "plan.png", "plan_left": 0, "plan_bottom": 0,
                    "plan_width": 10}],
        "Items": [{"item": f"A{at}", "floor": "1", "breadth": 40, "height": 180, "photo": f"p{at}.png"}
                  for at in (1, 2)],
    }  # fmt: skip
    write_workbook(tmp_path / "book.xlsx", Content(rows))
    return tmp_path


def _read_kept(folder: Path, kept: KeptFiles) -> Inventory:
    held = open_workbook((folder / "book.xlsx").read_bytes(), "inventory.xlsx")
    with kept:
        return _read(held, folder, kept)


def test_files_that_have_not_changed_are_read_once(named: Path) -> None:
    kept, data = KeptFiles(), (named / "book.xlsx").read_bytes()
    one, two = _read_kept(named, kept), _read_kept(named, kept)
    assert two == _read_bytes(data, named)
    assert one.floors[0].records["X"][0].record is two.floors[0].records["X"][0].record
    assert one.photos["p1.png"] is two.photos["p1.png"]
    assert one.hazard is not None
    assert one.hazard is two.hazard

    shutil.copy(RECORDS / RECORD.replace("a.smc", "b.smc"), named / "a.smc")
    (named / "p1.png").write_bytes(b"no picture")
    (named / "p2.png").unlink()
    three = _read_kept(named, kept)
    fresh = _read_bytes(data, named)
    assert three.problems == fresh.problems
    assert three.files == fresh.files != one.files
    assert [one.severity for one in three.problems] == ["warning", "warning"]
    (named / "p1.png").write_bytes(picture("PNG"))
    (named / "p2.png").write_bytes(picture("PNG"))
    assert not _read_kept(named, kept).problems


def test_a_drawing_is_read_once_whatever_the_width_of_the_plan(named: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One at its limits takes ten seconds, and the width changes with every step of placing it."""
    (named / "plan.png").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path d="M0 0 L9 9"/></svg>'
    )
    kept, held = KeptFiles(), open_workbook((named / "book.xlsx").read_bytes(), "inventory.xlsx")
    read: list[float | None] = []

    def count(data: bytes, width: float | None) -> Drawing:
        read.append(width)
        return read_plan(data, width)

    monkeypatch.setattr("assess.workbook.picture_files.read_plan", count)
    place = (2, PLACES["Floors", "plan_width"])
    for width in (10, 11, 12):
        with kept:
            plan = _read(held.set({"Floors": {place: width}}), named, kept).floors[0].plan
        assert plan is not None
        assert plan.width == width
    assert read == [10]
    (named / "plan.png").write_bytes(picture("PNG"))
    for width in (10, 11, 200, 300):
        with kept:
            _read(held.set({"Floors": {place: width}}), named, kept)
    assert read == [10, 10, 11, 200]  # as many pixels for 300 m as for 200 m


@pytest.mark.parametrize(
    ("limit", "most"),
    [("MOST_PHOTOS", 1), ("MOST_PHOTO_BYTES", 700), ("MOST_PICTURE_PIXELS", 2000), ("MOST_RECORD_BYTES", 1000),
     ("MOST_RECORD_SAMPLES", 10)],
)  # fmt: skip
def test_limits_hold_for_kept_files(named: Path, monkeypatch: pytest.MonkeyPatch, limit: str, most: int) -> None:
    kept, data = KeptFiles(), (named / "book.xlsx").read_bytes()
    assert not _read_kept(named, kept).problems
    monkeypatch.setattr(f"assess.workbook.kept_files.{limit}", most)
    expected = _read_bytes(data, named).problems
    assert expected
    assert _read_kept(named, kept).problems == expected
    monkeypatch.undo()
    assert not _read_kept(named, kept).problems
