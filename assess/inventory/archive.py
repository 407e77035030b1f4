"""The workbook's file, looked at before anything opens it.

An .xlsx is a zip of XML. Openpyxl trusts what the file says of itself: the sizes in the zip, the dimension of a sheet,
the saved results of formulas. Here each is checked on the raw bytes, cheaply and in little memory, so that a hostile
or damaged file ends in one clear sentence. The limits are far above honest use: 20,000 items take 15 MB.
"""

import posixpath
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from assess.errors import Problem, WorkbookError

MAX_FILE = 100 * 2**20
MAX_PARTS = 2000
MAX_TOTAL = 128 * 2**20
MAX_RATIO = 200
MAX_ROWS = 100_000
MAX_COLUMNS = 256

_ZIP = b"PK\x03\x04"
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_TYPES = "[Content_Types].xml"
_WORKBOOK = "xl/workbook.xml"
_RELATIONS = "xl/_rels/workbook.xml.rels"
_MAIN = ("sheet.main+xml", "template.main+xml", "sheet.macroEnabled.main+xml", "template.macroEnabled.main+xml")
_LIMITS = {"sharedStrings+xml": (24 * 2**20, 1_000_000), "styles+xml": (8 * 2**20, 300_000)}
"""Bytes and tags of the parts that are read whole, by how their content type ends."""

_SPREADSHEET = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_STRICT = "{http://purl.oclc.org/ooxml/spreadsheetml/main}"

DAMAGE = (ValueError, TypeError, AttributeError, LookupError, OSError, EOFError, SyntaxError, AssertionError,
          ArithmeticError, RuntimeError, struct.error, zipfile.BadZipFile, zlib.error)  # fmt: skip
"""What openpyxl and the XML parser raise on a damaged file: ParseError is a SyntaxError, say."""


def unreadable(message: str, mend: str) -> WorkbookError:
    """Build the error for a workbook that cannot be opened at all."""
    return WorkbookError([Problem("error", "", "", message, mend)])


def damaged(message: str) -> WorkbookError:
    """Build the error for a part of the workbook that no honest program writes."""
    return unreadable(f"the workbook is damaged: {message}.", "Open it in Excel and save it again.")


def check_file(path: Path) -> None:
    """Raise WorkbookError unless `path` is a file that looks like an .xlsx."""
    try:
        if path.exists() and not path.is_file():
            raise unreadable(f"{path} is a folder, not a workbook.", "Name the .xlsx file in it.")
        with path.open("rb") as file:
            head = file.read(8)
    except FileNotFoundError:
        raise unreadable(f"{path} is not there.", "Check the name and the folder.") from None
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = getattr(error, "strerror", None) or error
        raise unreadable(f"{path} cannot be opened: {why}.", "Check its name and who may read it.") from None
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
    except DAMAGE:
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
    if not {_TYPES, _WORKBOOK, _RELATIONS} <= names:
        raise unreadable(f"{name} is a zip file, but not an Excel workbook (.xlsx).", "Save it from Excel as .xlsx.")
    if any(part.flag_bits & 1 for part in parts):
        raise unreadable(f"{name} is protected by a password.", "Save it without a password.")
    if len(names) < len(parts):
        raise damaged("its zip holds two parts of one name")
    if any(part.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) for part in parts):
        raise damaged("its zip is packed in a way that Excel does not use")
    if len(parts) > MAX_PARTS or sum(part.file_size for part in parts) > MAX_TOTAL or any(map(_is_bloated, parts)):
        raise _bomb(name)


def _is_bloated(part: zipfile.ZipInfo) -> bool:
    return part.file_size > 2**20 and part.file_size > MAX_RATIO * max(part.compress_size, 1)


def _bomb(name: str) -> WorkbookError:
    return unreadable(
        f"{name} unpacks to far more than a furniture list needs, as a zip bomb does; it was not opened.",
        "Copy the tables into a new workbook made with `assess new`.",
    )


def check_parts(archive: zipfile.ZipFile, name: str) -> None:
    """Check the parts that are read whole, which each tag makes ten times as large in memory.

    Raises
    ------
    WorkbookError
        If one is larger than in an honest workbook, or the workbook itself is not where it belongs.
    """
    from defusedxml import ElementTree

    limits = dict.fromkeys((_TYPES, _WORKBOOK, _RELATIONS), _LIMITS["styles+xml"])
    _check_sizes(archive, limits, name)
    found: dict[str, tuple[int, int]] = {}
    for one in ElementTree.fromstring(archive.read(_TYPES)):
        part, kind = one.get("PartName", "").lstrip("/"), one.get("ContentType", "")
        if part and kind.endswith(_MAIN) and part != _WORKBOOK:
            raise damaged(f"{part} stands for {_WORKBOOK}")
        found.update((part, limit) for end, limit in _LIMITS.items() if kind.endswith(end))
    _check_sizes(archive, found, name)


def _check_sizes(archive: zipfile.ZipFile, limits: Mapping[str, tuple[int, int]], name: str) -> None:
    present = set(archive.namelist())
    for part, (size, tags) in limits.items():
        if part in present and (archive.getinfo(part).file_size > size or archive.read(part).count(b"<") > tags):
            raise _bomb(name)
        if part in present and b"<!ENTITY" in archive.read(part):  # where lxml is installed, openpyxl leaves them out
            raise _entities(name)


def explain(error: BaseException, name: str) -> WorkbookError:
    """Return what to tell of an error of `DAMAGE`."""
    if _declares_entities(error):
        return _entities(name)
    mend = "Open it in Excel and save it again."
    return unreadable(f"{name} is damaged or is no Excel workbook ({type(error).__name__}).", mend)


def _entities(name: str) -> WorkbookError:
    return unreadable(f"{name} declares XML entities, as an attack does.", "Save it again from Excel.")


def _declares_entities(error: BaseException | None) -> bool:
    """Tell whether defusedxml stopped the reading; openpyxl wraps its errors."""
    from defusedxml.common import DefusedXmlException

    return error is not None and (isinstance(error, DefusedXmlException) or _declares_entities(error.__cause__))


def sheet_paths(archive: zipfile.ZipFile) -> dict[str, str]:
    """Return the name and the path inside the zip of every worksheet, in the workbook's order.

    Raises
    ------
    WorkbookError
        If the workbook is of the strict kind, which openpyxl does not read.
    """
    from defusedxml import ElementTree

    relations = ElementTree.fromstring(archive.read(_RELATIONS))
    target = {one.get("Id"): one.get("Target", "") for one in relations if one.get("TargetMode") != "External"}
    workbook = ElementTree.fromstring(archive.read(_WORKBOOK))
    if workbook.tag.startswith(_STRICT):
        raise unreadable(
            "the workbook is saved as Strict Open XML.", "In Excel: Save As, Excel Workbook (.xlsx), without Strict."
        )
    present = set(archive.namelist())
    found = {}
    for sheet in workbook.iter(f"{_SPREADSHEET}sheet"):
        link = next((value for name, value in sheet.attrib.items() if name.endswith("}id")), "")
        path = posixpath.normpath(posixpath.join("/xl", target.get(link, ""))).lstrip("/")
        if path in present:
            found[sheet.get("name", "")] = path
    return found
