"""Workbooks damaged at random: read, or refused in words; never another exception."""

import contextlib
import io
import tempfile
import zipfile
from pathlib import Path

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from assess.errors import WorkbookError
from assess.inventory.workbook import read_inventory
from tests.inventory.books import FLOORS, ITEMS, problems_of, write, write_shared
from tests.inventory.raw import (
    RELATIONS,
    SHEET,
    STRINGS,
    WORKBOOK,
    zip_bytes,
)


def sound() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        items = [[*ITEMS[0], "Notes"], ["A1", "1", 40, 180, "=1+1"], ["A2", "1", 30, "x", "é"]]
        return write_shared(Path(folder) / "book.xlsx", {"Items": items, "Floors": FLOORS}).read_bytes()


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
