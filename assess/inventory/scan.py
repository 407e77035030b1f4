"""A sheet's raw bytes, read once before openpyxl: what its quick reader does not tell, or would pass over in silence.

It leaves out rows that stand out of order, cells beyond what it takes for the last column, and does not tell a blank
cell from a formula without a saved result. Every repeat is possessive and of one set of characters, so that no bytes
can make it slow; no group is possessive: Python before 3.11.5 matches such groups wrongly (CPython issue 106052).
"""

import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, field

from openpyxl.utils import column_index_from_string

from assess.inventory.archive import MAX_COLUMNS, damaged, unreadable

MAX_ROW_BYTES = 2 * 2**20
MAX_TAIL_BYTES = 16 * 2**20
MAX_CELLS = 16_384
MAX_UNCACHED = 500_000
LAST_ROW = 1_048_576

_CHUNK = 2**20
_TAG = rb"<(?:\w++:)?"
_END = rb"</(?:\w++:)?"
_ROW = re.compile(_TAG + rb"row\b([^<>]*+)>")
_CELL = re.compile(_TAG + rb"c(?=[\s/>])([^<>]*+)>(?:\s*+" + _TAG + rb"(f|v|is)\b)?")
_FORMULA = re.compile(
    _TAG + rb"c(?=[\s/>])([^<>]*+)>\s*+" + _TAG + rb"f\b[^<>]*+>(?:[^<]*+" + _END + rb"f\s*+>)?\s*+"
    rb"(" + _TAG + rb"v\b[^<>]*+>(?:\s*+" + _END + rb"v\s*+>)?)?\s*+" + _END + rb"c\s*+>"
)  # fmt: skip
_MERGED = re.compile(_TAG + rb"mergeCell\b([^<>]*+)>")
_R = re.compile(rb"""(?:^|\s)r\s*+=\s*+["']([^"']*+)["']""")
_REF = re.compile(rb"""\sref\s*+=\s*+["']([A-Z]{1,3}\d{1,7}(?::[A-Z]{1,3}\d{1,7})?)["']""")
_ADDRESS = re.compile(rb"([A-Z]{1,3})\d{1,7}")
_IS_TEXT = re.compile(rb"""\st\s*+=\s*+["']str["']""")
_FAR = re.compile(rb"""\sr\s*+=\s*+["'](?:[A-Z]{3}|[J-Z][A-Z]|I[W-Z])\d""")
_VALUES = (b"<v>", b":v>", b"<v ", b":v ", b"<is>", b":is>", b"<f>", b":f>", b"<f ", b":f ")


@dataclass(slots=True)
class Scan:
    """What the raw bytes of a sheet tell.

    Parameters
    ----------
    last_row : int
        The last row that holds a value or a formula; 0 in an empty sheet.
    far : str
        Address of the first value right of the last column that is read, "" if there is none.
    merged : list of str
        Merged ranges, ``A1:C2``.
    uncached : set of str
        Addresses of formulas without a saved result.
    """

    last_row: int = 0
    far: str = ""
    merged: list[str] = field(default_factory=list)
    uncached: set[str] = field(default_factory=set)


def scan_sheet(archive: zipfile.ZipFile, path: str) -> Scan:
    """Read a sheet's bytes once, a stretch of whole rows at a time.

    Raises
    ------
    WorkbookError
        If the sheet holds what no honest one does: rows out of order, or rows of several megabytes.
    """
    scan, number = Scan(), 0
    for stretch in _stretches(archive, path):
        number = _scan_rows(scan, stretch, number, path)
        if b"<f" in stretch or b":f" in stretch:
            _scan_formulas(scan, stretch, path)
        if b"mergeCell" in stretch and len(scan.merged) < MAX_CELLS:
            found = (_REF.search(tag[1]) for tag in _MERGED.finditer(stretch))
            scan.merged += [ref[1].decode() for ref in found if ref]
    return scan


def _stretches(archive: zipfile.ZipFile, path: str) -> Iterator[bytes]:
    """Yield the bytes of a part, cut where a row begins."""
    rest, start = b"", True
    with archive.open(path) as part:
        while chunk := part.read(_CHUNK):
            if start and b"\0" in chunk[:100]:
                raise damaged(f"{path} is not written in UTF-8")
            rest, start = rest + chunk, False
            cut = max(rest.rfind(b"<row"), rest.rfind(b"<", 0, max(rest.rfind(b":row"), 0)))
            if cut > 0:
                yield rest[:cut]
                rest = rest[cut:]
            _check_length(rest, path)
    if not rest.rstrip().endswith(b"sheet>"):
        raise damaged(f"{path} breaks off")
    yield rest


def _check_length(rest: bytes, path: str) -> None:
    """Stop at a row, or at what follows the last row, that is longer than an honest one."""
    if len(rest) <= MAX_ROW_BYTES + _CHUNK:
        return
    end = rest.find(b"/row>")
    if (end < 0 or end > MAX_ROW_BYTES) or len(rest) > MAX_TAIL_BYTES:
        raise unreadable(f"{path} holds a row of over {MAX_ROW_BYTES >> 20} MB.", "Delete that row.")


def _scan_rows(scan: Scan, stretch: bytes, number: int, path: str) -> int:
    """Check the rows of a stretch; return the number of its last row."""
    last_value = max(stretch.rfind(tag) for tag in _VALUES)
    tags = list(_ROW.finditer(stretch))
    ends = [*(tag.start() for tag in tags), len(stretch)][1:]
    far = _FAR.search(stretch) is not None
    for tag, end in zip(tags, ends, strict=False):
        previous, number = number, _row_number(tag[1], number, path)
        if not previous < number <= LAST_ROW:
            raise damaged(f"the rows of {path} are out of order")
        if tag.start() < last_value:
            scan.last_row = number
        if not scan.far and (far or _cells(stretch, tag.end(), end) > MAX_COLUMNS):
            scan.far = _far_value(stretch, tag.end(), end, number, path)
    return number


def _row_number(attributes: bytes, previous: int, path: str) -> int:
    found = _R.search(attributes)
    if not found:
        return previous + 1
    if not (found[1].isdigit() and len(found[1]) <= 7):
        raise damaged(f"{path} has a row numbered {found[1][:20].decode(errors='replace')}")
    return int(found[1])


def _cells(stretch: bytes, start: int, end: int) -> int:
    """At least the number of cells between two places; it counts quickly, and the ends of prefixed tags, too."""
    return stretch.count(b"<c", start, end) + stretch.count(b":c", start, end)


def _far_value(stretch: bytes, start: int, end: int, row: int, path: str) -> str:
    """Return the address of the first value of a row that stands too far right, "" if there is none."""
    if _cells(stretch, start, end) > 2 * MAX_CELLS:
        raise damaged(f"row {row} of {path} has more cells than a sheet has columns")
    at = 0
    for cell in _CELL.finditer(stretch, start, end):
        address = _R.search(cell[1])
        letters = _ADDRESS.fullmatch(address[1]) if address else None
        at = column_index_from_string(letters[1].decode()) if letters else at + 1
        if at > MAX_COLUMNS and cell[2]:
            return f"{address[1].decode()}" if address else f"column {at} of row {row}"
    return ""


def _scan_formulas(scan: Scan, stretch: bytes, path: str) -> None:
    """Note the formulas without a saved result; one that was saved as an empty text is a blank cell."""
    for cell in _FORMULA.finditer(stretch):
        if cell[2] and _IS_TEXT.search(cell[1]):
            continue
        address = _R.search(cell[1])
        if not address or len(scan.uncached) >= MAX_UNCACHED:
            raise unreadable(f"{path} is full of formulas with no saved value.", "Open it in Excel and save it.")
        scan.uncached.add(address[1].decode(errors="replace"))
