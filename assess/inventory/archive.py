"""The workbook's file, looked at before anything opens it.

An .xlsx is a zip of XML. Openpyxl trusts what the file says of itself: the sizes in the zip, the dimension of a sheet,
the saved results of formulas. Here each is checked on the raw bytes, cheaply and in little memory, so that a hostile
or damaged file ends in one clear sentence. The limits are far above honest use: 20,000 items take 15 MB.
"""

import re
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from assess.errors import Problem, WorkbookError

MAX_FILE = 100 * 2**20
MAX_PARTS = 2000
MAX_TOTAL = 256 * 2**20
MAX_STRINGS = 64 * 2**20
MAX_PART = 8 * 2**20
MAX_RATIO = 200
MAX_ROW_BYTES = 16 * 2**20
FAR = 2**20

_ZIP = b"PK\x03\x04"
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_RELATIONS = "xl/_rels/workbook.xml.rels"
_SPREADSHEET = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_STRICT = "{http://purl.oclc.org/ooxml/spreadsheetml/main}"


@dataclass(frozen=True, slots=True)
class Scan:
    """What the raw bytes of a sheet tell that openpyxl's quick reader does not.

    Parameters
    ----------
    last : str
        Address of the last cell that holds a value, "" in an empty sheet.
    last_row : int
        Its row; `FAR` where the cells do not say their addresses.
    merged : tuple of str
        Merged ranges, ``A1:C2``.
    uncached : frozenset of str
        Addresses of formulas without a saved result.
    """

    last: str
    last_row: int
    merged: tuple[str, ...]
    uncached: frozenset[str]


def unreadable(message: str, mend: str) -> WorkbookError:
    """Build the error for a workbook that cannot be opened at all."""
    return WorkbookError([Problem("error", "", "", message, mend)])


def check_file(path: Path) -> None:
    """Raise WorkbookError unless `path` is a file that looks like an .xlsx."""
    if not path.exists():
        raise unreadable(f"{path} is not there.", "Check the name and the folder.")
    if not path.is_file():
        raise unreadable(f"{path} is a folder, not a workbook.", "Name the .xlsx file in it.")
    try:
        with path.open("rb") as file:
            head = file.read(8)
    except OSError as error:
        raise unreadable(f"{path} cannot be opened: {error.strerror}.", "Check who may read it.") from None
    if head == _OLE:
        raise unreadable(
            f"{path.name} is an old .xls workbook or is protected by a password.",
            "Open it in Excel and save it as .xlsx without a password.",
        )
    if not head.startswith(_ZIP):
        raise unreadable(f"{path.name} is not an Excel workbook (.xlsx).", "Save it from Excel as .xlsx.")
    if path.stat().st_size > MAX_FILE:
        raise unreadable(f"{path.name} is larger than {MAX_FILE >> 20} MB.", "Remove pictures and unused sheets.")


def open_archive(path: Path) -> zipfile.ZipFile:
    """Open the zip, having checked what its directory declares.

    A declared size is a sound bound: Python's zipfile stops with an error after that many bytes.

    Raises
    ------
    WorkbookError
        If the file is damaged, is no workbook, or would unpack to far more than an honest one.
    """
    check_file(path)
    try:
        archive = zipfile.ZipFile(path)
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError):
        raise unreadable(
            f"{path.name} is damaged: its zip cannot be read.", "Open it in Excel and save it again."
        ) from None
    try:
        _check_directory(path.name, archive.infolist())
    except WorkbookError:
        archive.close()
        raise
    return archive


def _check_directory(name: str, parts: list[zipfile.ZipInfo]) -> None:
    names = {part.filename for part in parts}
    if "xl/workbook.xml" not in names or _RELATIONS not in names:
        raise unreadable(f"{name} is a zip file, but not an Excel workbook (.xlsx).", "Save it from Excel as .xlsx.")
    if any(part.flag_bits & 1 for part in parts):
        raise unreadable(f"{name} is protected by a password.", "Save it without a password.")
    if len(parts) > MAX_PARTS or sum(part.file_size for part in parts) > MAX_TOTAL or any(map(_swollen, parts)):
        raise unreadable(
            f"{name} unpacks to far more than a furniture list needs, as a zip bomb does; it was not opened.",
            "Copy the tables into a new workbook made with `assess new`.",
        )


def _swollen(part: zipfile.ZipInfo) -> bool:
    sheet = part.filename.startswith("xl/worksheets/")
    limit = MAX_TOTAL if sheet else MAX_STRINGS if part.filename.endswith("sharedStrings.xml") else MAX_PART
    if not part.filename.endswith((".xml", ".rels")):
        limit = MAX_TOTAL
    bloated = part.file_size > 2**20 and part.file_size > MAX_RATIO * max(part.compress_size, 1)
    return part.file_size > limit or bloated


def sheet_paths(archive: zipfile.ZipFile) -> dict[str, str]:
    """Return the name and the path inside the zip of every worksheet, in the workbook's order."""
    from defusedxml import ElementTree

    relations = ElementTree.fromstring(archive.read(_RELATIONS))
    target = {one.get("Id"): one.get("Target", "") for one in relations}
    workbook = ElementTree.fromstring(archive.read("xl/workbook.xml"))
    found = {}
    for sheet in workbook.iter():
        if sheet.tag in (f"{_SPREADSHEET}sheet", f"{_STRICT}sheet"):
            link = next((value for name, value in sheet.attrib.items() if name.endswith("}id")), "")
            path = target.get(link, "")
            path = path.lstrip("/") if path.startswith("/") else str(PurePosixPath("xl") / path)
            if path in archive.namelist():
                found[sheet.get("name", "")] = path
    return found


_CELL = re.compile(rb'\br="([A-Z]{1,3})(\d{1,7})"')
_VALUE = (b"<v>", b":v>", b"<is>", b":is>", b"<f>", b":f>", b"<f ", b":f ")
_TAG = rb"<(?:\w+:)?"
_UNCACHED = re.compile(
    _TAG + rb'c\b[^<>]*?\br="([A-Z]{1,3}\d{1,7})"[^<>]*>\s*' + _TAG + rb"f\b[^<>]*(?:/>|>[^<]*</(?:\w+:)?f>)\s*"
    rb"(?:" + _TAG + rb"v\s*/>|" + _TAG + rb"v\s*>\s*</(?:\w+:)?v>)?\s*</(?:\w+:)?c>"
)  # fmt: skip
_MERGED = re.compile(_TAG + rb'mergeCell\b[^<>]*?\bref="([A-Z]{1,3}\d{1,7}(?::[A-Z]{1,3}\d{1,7})?)"')


def scan_sheet(archive: zipfile.ZipFile, path: str) -> Scan:
    """Read a sheet's bytes once, a stretch of whole rows at a time.

    Raises
    ------
    WorkbookError
        If one row alone is larger than an honest sheet.
    """
    last, last_row = "", 0
    merged: list[str] = []
    uncached: set[str] = set()
    for stretch in _stretches(archive, path):
        last, last_row = _last_value(stretch) or (last, last_row)
        if b"<f" in stretch or b":f" in stretch:
            uncached.update(match.decode() for match in _UNCACHED.findall(stretch))
        if b"mergeCell" in stretch:
            merged += [match.decode() for match in _MERGED.findall(stretch)]
    return Scan(last, last_row, tuple(merged), frozenset(uncached))


def _stretches(archive: zipfile.ZipFile, path: str) -> Iterator[bytes]:
    """Yield the bytes of a part, cut where a row begins."""
    rest = b""
    with archive.open(path) as part:
        while chunk := part.read(2**20):
            rest += chunk
            cut = max(rest.rfind(b"<row "), rest.rfind(b"<", 0, max(rest.rfind(b":row "), 0)))
            if cut > 0:
                yield rest[:cut]
                rest = rest[cut:]
            elif len(rest) > MAX_ROW_BYTES:
                raise unreadable(f"{path} holds a row of over {MAX_ROW_BYTES >> 20} MB.", "Delete that row.")
    yield rest


def _last_value(stretch: bytes) -> tuple[str, int] | None:
    """Address of the last cell with a value, ("", FAR) where the cell does not say its address."""
    place = max(stretch.rfind(tag) for tag in _VALUE)
    if place < 0:
        return None
    start = max(stretch.rfind(b"<c ", 0, place), stretch.rfind(b":c ", 0, place), 0)
    match = _CELL.search(stretch, start, place)
    return (match[1].decode() + match[2].decode(), int(match[2])) if match else ("", FAR)


DAMAGE = (KeyError, ValueError, TypeError, AttributeError, IndexError, OSError, EOFError, SyntaxError,
          AssertionError, ArithmeticError, zipfile.BadZipFile, zlib.error, NotImplementedError)  # fmt: skip
"""What openpyxl and the XML parser raise on a damaged file; ParseError is a SyntaxError, EntitiesForbidden a ValueError."""
