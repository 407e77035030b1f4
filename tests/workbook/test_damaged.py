"""Workbooks damaged at random: read, or refused in words; never another exception."""

import contextlib
import io
import tempfile
import zipfile
from pathlib import Path

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import assess
from assess.errors import WorkbookError
from assess.workbook.catalogue import read_catalogue
from assess.workbook.example import example_content
from assess.workbook.read import read_inventory
from tests.workbook.books import FLOORS, ITEMS, problems_of, write, write_shared
from tests.workbook.raw import (
    RELATIONS,
    SHEET,
    STRINGS,
    WORKBOOK,
    zip_bytes,
)
from tests.workbooks import UNVERIFIED


def sound() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        items = [[*ITEMS[0], "Notes"], ["A1", "1", 40, 180, "=1+1"], ["A2", "1", 30, "x", "é"]]
        return write_shared(Path(folder) / "book.xlsx", {"Items": items, "Floors": FLOORS}).read_bytes()


EXAMPLE = {**example_content().rows, "Catalogue": read_catalogue()}
SOUND = sound()
with zipfile.ZipFile(io.BytesIO(SOUND)) as _archive:
    PARTS = {name: _archive.read(name) for name in _archive.namelist()}
QUICK = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
CHANGES = st.lists(
    st.tuples(st.sampled_from(["flip", "cut", "insert", "drop"]), st.floats(0, 1), st.binary(min_size=1, max_size=6)),
    min_size=1,
    max_size=4,
)


def damage(data: bytes, changes: list[tuple[str, float, bytes]]) -> bytes:
    for what, share, new in changes:
        at = int(share * len(data))
        data = {
            "flip": data[:at] + new + data[at + len(new) :],
            "cut": data[:at],
            "insert": data[:at] + new + data[at:],
            "drop": data[:at] + data[at + len(new) :],
        }[what]
    return data


def read_or_refuse(path: Path) -> None:
    with contextlib.suppress(WorkbookError):
        read_inventory(path)


@QUICK
@given(CHANGES)
def test_damaged_file(tmp_path: Path, changes: list[tuple[str, float, bytes]]) -> None:
    path = tmp_path / "book.xlsx"
    path.write_bytes(damage(SOUND, changes))
    read_or_refuse(path)


@QUICK
@given(st.sampled_from(sorted(PARTS)), CHANGES)
@example(WORKBOOK, [("flip", 0.0, b'<?xml version="1.0" encoding="no-such"?>')])
def test_damaged_part(tmp_path: Path, part: str, changes: list[tuple[str, float, bytes]]) -> None:
    """Damage inside the zip, with sums that are right: it reaches the XML parser, and openpyxl."""
    path = tmp_path / "book.xlsx"
    path.write_bytes(zip_bytes({**PARTS, part: damage(PARTS[part], changes)}))
    read_or_refuse(path)


WORDS = st.sampled_from(
    [
        "s",
        "n",
        "str",
        "e",
        "b",
        "d",
        "inlineStr",
        "-1",
        "1e999",
        "nan",
        "99999999999",
        "",
        "A0",
        "zz",
        "../x",
        "#REF!",
        "true",
    ]
)


@QUICK
@given(st.sampled_from([SHEET, STRINGS, WORKBOOK, RELATIONS, "xl/styles.xml", "[Content_Types].xml"]), st.data())
def test_attributes_exchanged(tmp_path: Path, part: str, data: st.DataObject) -> None:
    """Sound XML with values that openpyxl does not expect."""
    pieces = PARTS[part].decode().split('"')
    if len(pieces) < 3:
        return
    at = data.draw(st.integers(0, (len(pieces) - 3) // 2)) * 2 + 1
    pieces[at] = data.draw(WORDS)
    path = tmp_path / "book.xlsx"
    path.write_bytes(zip_bytes({**PARTS, part: '"'.join(pieces).encode()}))
    read_or_refuse(path)


def test_every_problem_can_be_printed(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item\x07".replace("\x07", ""), "Floor"], ["A" * 30_000, "\u202e1"]])
    for problem in problems_of(path):
        assert len(str(problem)) < 400


JUNK = st.sampled_from(
    [None, "", "x", "#REF!", "9", -1, 0, 1e9, True, "1,5", "Hall", "1", "2", "Way out", "aisle", "exit", float("nan")]
)
CHANGED = st.lists(st.tuples(st.sampled_from(list(EXAMPLE)), st.floats(0, 1), st.floats(0, 1), JUNK), max_size=8)


@QUICK
@given(CHANGED)
def test_whatever_the_rows_hold_what_can_be_read_can_be_assessed(
    changes: list[tuple[str, float, float, object]],
) -> None:
    rows = {name: [dict(row) for row in content] for name, content in EXAMPLE.items()}
    for name, row_share, field_share, value in changes:
        row = rows[name][int(row_share * (len(rows[name]) - 1))]
        row[sorted(row)[int(field_share * (len(row) - 1))]] = value
    inventory = read_inventory(rows, strict=False)
    floors = {one.floor for one in inventory.floors}
    places = {one.place for one in inventory.places}
    assert {one.floor for one in inventory.items} | {one.floor for one in inventory.places} <= floors
    assert all(name in places for one in inventory.routes for name in (one.start, one.end) if name)
    with contextlib.suppress(WorkbookError):  # a floor of which nothing is left that tells how it shakes
        assess.run(inventory, UNVERIFIED)
    with contextlib.suppress(WorkbookError):
        assert read_inventory(rows).problems == inventory.problems
