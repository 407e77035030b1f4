"""Workbooks taken apart: their zip, their XML, and a process of its own to read them in."""

import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

from tests.apart import run_apart
from tests.motion.writers import zipped
from tests.workbook.books import FLOORS, ITEMS
from tests.workbooks import parts_of

STRINGS = "xl/sharedStrings.xml"
SHEETS = {"Items": ITEMS, "Floors": FLOORS}

MOST_MEMORY = 300
"""MB at the peak, 70 of them for Python and its libraries."""

SECONDS = 600

SHEET = "xl/worksheets/sheet1.xml"  # Items
WORKBOOK = "xl/workbook.xml"
RELATIONS = "xl/_rels/workbook.xml.rels"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"

_CHILD = """
import json, pathlib, sys
import assess

def read(path):
    try:
        return f"{len(assess.read_inventory(path).items)} items"
    except assess.WorkbookError as error:
        return str(error)

print(json.dumps({path.stem: read(path) for path in pathlib.Path(sys.argv[1]).glob("*.xlsx")}))
"""


def read_apart(folder: Path) -> dict[str, str]:
    """Read a folder's workbooks in a process of their own; return what it says of each, having checked its memory."""
    found: dict[str, str] = json.loads(run_apart(_CHILD, folder, most_memory=MOST_MEMORY, seconds=SECONDS))
    return found


def add_part(path: Path, name: str, pieces: Iterator[bytes]) -> Path:
    """Write a large part into a workbook's zip piece by piece, in place of the one that is there."""
    parts = parts_of(path)
    parts.pop(name, None)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for one, data in parts.items():
            archive.writestr(one, data)
        with archive.open(name, "w", force_zip64=True) as part:
            for piece in pieces:
                part.write(piece)
    return path


def sheet_of(rows: Iterator[bytes], before: bytes = b"", after: bytes = b"") -> Iterator[bytes]:
    yield f'<worksheet xmlns="{MAIN}">'.encode() + before + b"<sheetData>"
    yield from rows
    yield b"</sheetData>" + after + b"</worksheet>"


def text_cell(address: str, text: str) -> str:
    return f'<c r="{address}" t="inlineStr"><is><t>{text}</t></is></c>'


HEADER = '<row r="1">{}</row>'.format(
    "".join(text_cell(f"{letter}1", text) for letter, text in zip("ABCD", ITEMS[0], strict=True))
)
FIRST = f'<row r="2">{text_cell("A2", "A1")}{text_cell("B2", "1")}<c r="C2"><v>40</v></c><c r="D2"><v>180</v></c></row>'
TABLE = (HEADER + FIRST).encode()


def zip_bytes(parts: dict[str, bytes]) -> bytes:
    return zipped(parts, zipfile.ZIP_STORED)
