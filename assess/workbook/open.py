"""Untrusted bytes to cells: a workbook's sheets as rows of values, with nothing interpreted.

An .xlsx file is a zip of XML. The directory of the zip is checked before anything is unpacked, and every part is
streamed once through expat with bounds on its size, its tags and the length of a row, so that a hostile or damaged
file ends in one clear sentence and takes little memory. The limits are far above honest use: 20,000 items take 15 MB.
"""

import io
import posixpath
import re
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Self, TypeVar
from xml.parsers import expat

from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill
from assess.progress import SILENT, Progress
from assess.resources import open_input
from assess.text import plain_line
from assess.workbook.plain_rows import (
    PlainCell,
    RowCutter,
    column_letters,
    column_number,
    list_cells,
    list_unsaved,
    split_range,
)

_DATES = frozenset({*range(14, 23), 45, 46, 47})
"""Numbers of the built-in formats that show a number as a date or a time."""


class Percent(float):
    """A number that its cell shows as a percentage."""


def find_format(number: str, codes: Mapping[str, str]) -> str | None:
    """Return the format that shows a number as a date or a time, or as a percentage ("%"); else None."""
    code = codes.get(number, "")
    if number in ("9", "10") or "%" in code:
        return "%"
    if not code:
        return ("[h]" if number == "46" else "d") if number.isdigit() and int(number) in _DATES else None
    if not any(letter in "dmhys" for letter in code.lower()):
        return None
    from openpyxl.styles.numbers import is_date_format

    return code if is_date_format(code) else None


def read_number(number: float, code: str | None, *, is_1904: bool) -> Any:
    """Return what the number of a cell means: a date, a time or a percentage where its format shows it so."""
    if code is None:
        return number
    if code == "%":
        return Percent(number)
    from openpyxl.styles.numbers import is_timedelta_format
    from openpyxl.utils.datetime import MAC_EPOCH, WINDOWS_EPOCH, from_excel

    try:
        epoch = MAC_EPOCH if is_1904 else WINDOWS_EPOCH
        return from_excel(number, epoch, timedelta=is_timedelta_format(code))
    except (OverflowError, ValueError):
        return "#VALUE!"


MAX_FILE, MAX_PARTS, MAX_TOTAL, MAX_RATIO = 100 * 2**20, 2000, 128 * 2**20, 200
MAX_ROWS, MAX_COLUMNS = 100_000, 256
"""Rows and columns that are read."""
SHEET_ROWS, SHEET_COLUMNS = 1_048_576, 16_384
"""Rows and columns that a sheet of a spreadsheet program has."""
HEADER_ROWS = 20
"""The header row of a table is looked for in so many rows from the top."""
MAX_ROW_BYTES, MAX_TAG, MAX_DEPTH = 2 * 2**20, 4 * 2**20, 1000
MAX_MERGED = 16_384

_CHUNK = 2**16
_ZIP, _OLE = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
REPORT_OF = "assess: report of "
"""How a property of a report begins that names its workbook; it stands in the part `PROPERTIES` of the file."""
PROPERTIES = "docProps/custom.xml"
TYPES, WORKBOOK, RELATIONS = "[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels"
_MAIN = ("sheet.main+xml", "template.main+xml", "sheet.macroEnabled.main+xml", "template.macroEnabled.main+xml")
_STRICT = "http://purl.oclc.org/ooxml/spreadsheetml/main"
_SMALL, _STRINGS = (8 * 2**20, 300_000), (24 * 2**20, 1_000_000)
"""Bytes and tags of the parts that are kept in memory."""
TRUE = ("1", "true")
"""How XML says yes."""

DAMAGE = (ValueError, TypeError, LookupError, OSError, EOFError, ArithmeticError, RuntimeError, NotImplementedError,
          zipfile.BadZipFile, zlib.error, expat.ExpatError)  # fmt: skip
"""What zipfile, zlib and expat raise on a damaged file."""

_CODED = re.compile("_x([0-9A-Fa-f]{4})_")
"""How programs write a character that XML cannot hold, and the underscore of a text that looks like one."""
_AROUND = "\ufeff\u200b\u2060\r\n"
"""Signs without width, and ends of lines, that come along when a text is copied: at its ends they mean nothing."""

UNSAVED = object()
"""The value of a cell that holds a formula without a saved result."""


_NO_VALUE = len("<v></v>")
_PLAIN_TAGS = {(False, False): set[str](), (False, True): {"v"}, (True, False): {"f"}, (True, True): {"f", "v"}}
"""The elements of a cell by whether it holds a formula and a value; never changed."""

Cells = dict[int, Any]
"""The values of a row by column, from 0; blank cells are left out."""


Place = tuple[int, int]
"""The row of a cell, from 1, and its column, from 0."""
Area = tuple[int, int, int, int]
"""First and last column, first and last row of cells, from 1."""
LOCKED = {"dataTable": fill("it belongs to a data table."), "array": fill("it belongs to an array formula.")}
"""Why no cell of a formula of several cells is changed by itself."""
_CONTENT = frozenset({"v", "f", "is", "t", "r", "rPh", "phoneticPr", "rPr", "rFont", "charset", "family", "b", "i",
                      "strike", "outline", "shadow", "condense", "extend", "color", "sz", "u", "vertAlign",
                      "scheme"})  # fmt: skip
"""What a cell may hold: its value, its formula, a text in parts with their fonts (ECMA-376 Part 1, 18.3.1.4, 18.4)."""


def decode_text(text: str) -> str:
    """Return the text of a cell from that in the file: with its coded characters, without signs that are not seen."""
    if "_x" in text:
        units = _CODED.sub(lambda found: chr(int(found[1], 16)), text).encode("utf-16", "surrogatepass")
        text = units.decode("utf-16", "replace")
    return text.strip(_AROUND)


def unreadable(message: str, fix: str) -> WorkbookError:
    """Build the error for a workbook that cannot be opened at all."""
    return WorkbookError([Problem("error", "", "", message, fix)])


def damaged(message: str) -> WorkbookError:
    """Build the error for a part that no spreadsheet program writes."""
    return unreadable(fill("the workbook is damaged: {why}.", why=message), fill("Open it in Excel and save it again."))


def _describe(error: BaseException) -> Text:
    if isinstance(error, expat.ExpatError):
        return fill("its XML is broken")
    if isinstance(error, (zipfile.BadZipFile, zlib.error, EOFError, OSError)):
        return fill("a part of it cannot be unpacked")
    return fill("a part of it is not as spreadsheet programs write it")


def _bomb(name: str) -> WorkbookError:
    return unreadable(
        fill(
            "{name} unpacks to far more than a furniture list needs, as a zip bomb does; it was not opened.", name=name
        ),
        fill("Copy the tables into a new workbook made with `assess new`."),
    )


def read_file(path: Path) -> bytes:
    """Return the bytes of a workbook; raises WorkbookError if `path` is no file that can be read, or is too large."""
    try:
        if path.is_dir():
            raise unreadable(fill("{path} is a folder, not a workbook.", path=path), fill("Name the .xlsx file in it."))
        with open_input(path) as file:
            head = file.read(len(_OLE))
            return head + file.read(MAX_FILE + 1) if head.startswith(_ZIP) else head
    except FileNotFoundError:
        raise unreadable(fill("{path} does not exist.", path=path), fill("Check the name and the folder.")) from None
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = getattr(error, "strerror", None) or error
        message = fill("{path} cannot be opened: {why}.", path=path, why=why)
        raise unreadable(message, fill("Check its name and its access rights.")) from None


# ---------------------------------------------------------------- the zip


def _open_archive(data: bytes, name: str) -> zipfile.ZipFile:
    """Open the zip, having checked its first bytes and what its directory declares.

    A declared size is a sound bound: Python's zipfile stops with an error after that many bytes.
    """
    if not data:
        raise unreadable(fill("{name} is empty (0 bytes).", name=name), fill("Download or copy it again."))
    if data.startswith(_OLE):
        raise unreadable(
            fill("{name} is an old .xls workbook or is protected by a password.", name=name),
            fill("Open it in Excel and save it as .xlsx without a password."),
        )
    if not data.startswith(_ZIP):
        message = fill("{name} is not an Excel workbook (.xlsx).", name=name)
        raise unreadable(message, fill("Save it from Excel as .xlsx."))
    if len(data) > MAX_FILE:
        message = fill("{name} is larger than {most} MB.", name=name, most=MAX_FILE >> 20)
        raise unreadable(message, fill("Remove pictures and unused sheets."))
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
    except DAMAGE:
        message = fill("{name} is damaged: its zip cannot be read.", name=name)
        raise unreadable(message, fill("Open it in Excel and save it again.")) from None
    _check_directory(name, archive.infolist())
    archive.NameToInfo = {one.filename: one for one in archive.infolist()}
    return archive


def _check_directory(name: str, parts: list[zipfile.ZipInfo]) -> None:
    for part in parts:  # some programs write the names of parts in their own way; Excel opens them
        own = part.filename.replace("\\", "/")
        part.filename = next((known for known in (TYPES, WORKBOOK, RELATIONS) if known.lower() == own.lower()), own)
    names = {part.filename for part in parts}
    if not {TYPES, WORKBOOK, RELATIONS} <= names:
        message = fill("{name} is a zip file, but not an Excel workbook (.xlsx).", name=name)
        raise unreadable(message, fill("Save it from Excel as .xlsx."))
    if any(part.flag_bits & 1 for part in parts):
        message = fill("{name} is protected by a password.", name=name)
        raise unreadable(message, fill("Save it without a password."))
    if len({one.lower() for one in names}) < len(parts):
        raise damaged(fill("its zip holds two parts of one name"))
    if any(part.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) for part in parts):
        raise damaged(fill("its zip uses a compression that Excel does not use"))
    bloated = any(one.file_size > max(2**20, MAX_RATIO * max(one.compress_size, 1)) for one in parts)
    if bloated or len(parts) > MAX_PARTS or sum(part.file_size for part in parts) > MAX_TOTAL:
        raise _bomb(name)


# ---------------------------------------------------------------- parts as XML


class Part:
    """One part of the zip as a stream of tags; a kind of part says what it does at each. Prefixes are left out."""

    limits: tuple[int, int] | None = _SMALL

    def __init__(self, book: "Book", path: str) -> None:
        self.book, self.path, self.name, self.progress = book, path, book.name, book.progress
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler, self.parser.EndElementHandler = self.enter, self.leave
        self.parser.CharacterDataHandler = self.text
        self.parser.EntityDeclHandler = self._refuse_entities
        self.depth = 0

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Count an element that begins and take it in by its bare name."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.too_deep()
        self.start(tag.rpartition(":")[2], attributes)

    def leave(self, tag: str) -> None:
        """Count an element that ends and take in its end."""
        self.depth -= 1
        self.end(tag.rpartition(":")[2])

    def too_deep(self) -> WorkbookError:
        """Build the error for more open elements than `MAX_DEPTH`."""
        return damaged(fill("{part} nests its elements over {most} deep", part=self.path, most=MAX_DEPTH))

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Take in the beginning of an element."""

    def end(self, tag: str) -> None:
        """Take in the end of an element."""

    def text(self, data: str) -> None:
        """Take in text."""

    def cut(self, piece: bytes) -> bytes:
        """Return what of a piece of the part goes through the parser."""
        return piece

    def held_back(self) -> bytes:
        """Return what `cut` has held back, at the end of the part."""
        return b""

    def _refuse_entities(self, *_: object) -> None:
        message = fill("{name} declares XML entities, as an attack does.", name=self.name)
        raise unreadable(message, fill("Save it again from Excel."))

    def feed(self) -> Iterator[int]:
        """Read the part; yield after every stretch how many bytes have been read."""
        done = tags = 0
        if self.limits and self.book.part_size(self.path) > self.limits[0]:
            raise _bomb(self.name)
        with self.book.open_part(self.path) as file:
            while piece := file.read(_CHUNK):
                self.progress.check()
                tags += piece.count(b"<")
                if self.limits and tags > self.limits[1]:
                    raise _bomb(self.name)
                if done == 0 and b"\0" in piece[:100]:
                    raise damaged(fill("{part} is not written in UTF-8", part=self.path))
                chunk = self.cut(piece)
                done += len(chunk)
                self.parser.Parse(chunk, False)
                if done - self.parser.CurrentByteIndex > MAX_TAG:  # it is scanned anew with every stretch
                    raise damaged(fill("{part} holds a tag of over {most} MB", part=self.path, most=MAX_TAG >> 20))
                yield done
        self.parser.Parse(self.held_back(), True)

    def read(self) -> Self:
        """Read the whole part and return itself."""
        for _ in self.feed():
            pass
        return self


_Kind = TypeVar("_Kind", bound=Part)


class Tree(Part):
    """A small part as a whole: its elements in their order, each with what encloses it, and its attributes."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.elements: list[tuple[str, str, dict[str, str]]] = []
        self._open = [""]

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Note an element."""
        self.elements.append((self._open[-1], tag, attributes))
        self._open.append(tag)

    def end(self, tag: str) -> None:
        """Note its end."""
        self._open.pop()

    def find(self, tag: str, within: str = "") -> Iterator[dict[str, str]]:
        """Yield the attributes of every element of a name, or of those within another."""
        found = ((outer, attributes) for outer, name, attributes in self.elements if name == tag)
        return (attributes for outer, attributes in found if outer == within or not within)


class _Strings(Part):
    limits = _STRINGS

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.found: list[str] = []
        self.parts: list[str] = []
        self.takes = self.is_phonetic = False

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Note whether text that follows is shown."""
        if tag == "si":
            self.parts = []
        self.is_phonetic = self.is_phonetic or tag == "rPh"
        self.takes = tag == "t" and not self.is_phonetic

    def text(self, data: str) -> None:
        """Keep text that is shown."""
        if self.takes:
            self.parts.append(data)

    def end(self, tag: str) -> None:
        """Note the end of a text."""
        self.takes = False
        self.is_phonetic = self.is_phonetic and tag != "rPh"
        if tag == "si":
            self.found.append(decode_text("".join(self.parts)))


# ---------------------------------------------------------------- sheets


@dataclass(frozen=True, slots=True)
class _Shared:
    strings: list[str] = field(default_factory=list)
    styles: list[str | None] = field(default_factory=list)
    is_1904: bool = False


@dataclass(slots=True)
class Marks:
    """What the values of a sheet's cells do not show; it stays while these change.

    * `formulas`: Cells that hold a formula.
    * `unknown`: Cells that hold elements which no change understands.
    * `locked`: Areas of formulas of several cells, and why none of their cells is changed by itself.
    * `formats`: The format of a cell that shows its number as a date, a time or a percentage; None for a cell that does
      not, although its row or column does.
    * `row_formats`, `column_formats`: That of the rows that have one; first and last column, from 0, and that of these.
    * `hollow`: Cells that hold something but no value that is read, such as a formula whose result is blank: columns by
      row.
    * `is_1904`: Whether dates are counted from 1904.
    """

    formulas: set[Place] = field(default_factory=set)
    unknown: set[Place] = field(default_factory=set)
    locked: list[tuple[Area, Text]] = field(default_factory=list)
    formats: dict[Place, str | None] = field(default_factory=dict)
    row_formats: dict[int, str | None] = field(default_factory=dict)
    column_formats: list[tuple[int, int, str | None]] = field(default_factory=list)
    hollow: dict[int, set[int]] = field(default_factory=dict)
    is_1904: bool = False

    def format_at(self, place: Place) -> str | None:
        """Return the format that a number in a cell gets: its own, else that of its row or column."""
        row, at = place
        if place in self.formats:
            return self.formats[place]
        if row in self.row_formats:
            return self.row_formats[row]
        return next((code for first, last, code in self.column_formats if first <= at <= last), None)


class SheetCells(Part):
    """The cells of one sheet.

    `rows` yields them once, row by row. After that `last_row` is the last row that holds a value or a formula (0 in
    an empty sheet), `far` the address of the first value right of the columns that are read ("" if there is none),
    `merged` the merged ranges, as in ``A1:C2``, `hidden_rows` and `hidden_columns` (from 0) what is not shown, and
    `marks` what the values do not show, if that was asked for: cells without a value are then looked at one by one.
    """

    limits = None
    header_rows, top, kept = HEADER_ROWS, "A1", None
    title = ""
    """The sheet as the workbook calls it."""

    @staticmethod
    def address(row: int, at: int | None = None) -> str:
        """Return how messages call a cell, ``C3``; that of the first column where no column is given."""
        return f"{column_letters(at or 0)}{row}"

    def __init__(self, book: "Book", path: str, shared: _Shared, marks: Marks | None) -> None:
        super().__init__(book, path)
        self.shared, self.marks = shared, marks
        self.last_row, self.far, self.merged = 0, "", list[str]()
        self.hidden_rows, self.hidden_columns = list[int](), set[int]()
        self._ready: list[tuple[int, Cells]] = []
        self._cells: Cells = {}
        self._number = self._at = self._count = 0
        self._row_start: int | None = None
        self._kind = self._style = self._address = ""
        self._texts: list[str] | None = None
        self._tags: set[str] = set()
        self._takes = False
        self._cutter = RowCutter()

    def cut(self, piece: bytes) -> bytes:
        """Return a piece without the cells of plain rows, which are taken in at the end of their row."""
        return self._cutter.cut(piece)

    def held_back(self) -> bytes:
        """Return what the cutter has held back."""
        return self._cutter.finish()

    def rows(self) -> Iterator[tuple[int, Cells]]:
        """Yield the number and the cells of each row that holds any, from the top."""
        for done in self.feed():
            if self._row_start is not None and done - self._row_start > MAX_ROW_BYTES + _CHUNK:
                message = fill("{part} holds a row of over {most} MB.", part=self.path, most=MAX_ROW_BYTES >> 20)
                raise unreadable(message, fill("Delete that row."))
            yield from self._ready
            self._ready = []
        yield from self._ready

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Open a row or a cell, or note what a cell holds, in one call: a sheet has tens of thousands of elements."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.too_deep()
        if ":" in tag:
            tag = tag.rpartition(":")[2]
        if tag == "c" and self._row_start is not None:
            self._open_cell(attributes)
        elif tag == "row":
            self._open_row(attributes)
        elif tag == "mergeCell" and len(self.merged) < MAX_MERGED:
            self.merged.append(attributes.get("ref", ""))
        elif tag == "col":
            self._open_column(attributes)
        elif self._texts is not None:
            self._tags.add(tag)
            self._takes = tag == "v" or (tag == "t" and "rPh" not in self._tags)
            if tag == "f" and self.marks and (why := LOCKED.get(attributes.get("t", ""))):
                area = split_range(attributes.get("ref", ""))
                self.marks.locked += [(area, why)] if area else []

    def leave(self, tag: str) -> None:
        """Close a row or a cell."""
        self.depth -= 1
        self._takes = False
        if ":" in tag:
            tag = tag.rpartition(":")[2]
        if tag == "c" and self._texts is not None:
            self._close_cell("".join(self._texts))
            self._texts = None
        elif tag == "rPh":
            self._tags.discard("rPh")
        elif tag == "row":
            if self._cutter.rows and (row := self._cutter.rows.pop(self._number, None)):
                self._take_plain(*row)
            self._row_start = None
            if self._cells:
                self._ready.append((self._number, self._cells))

    def text(self, data: str) -> None:
        """Keep the text of a cell."""
        if self._takes and self._texts is not None:
            self._texts.append(data)

    def _open_row(self, attributes: dict[str, str]) -> None:
        previous, number = self._number, attributes.get("r")
        if number is not None and not (number.isascii() and number.isdigit() and len(number) <= 7):
            raise damaged(fill("{part} has a row numbered {number}", part=self.path, number=number[:20]))
        self._number = previous + 1 if number is None else int(number)
        if not previous < self._number <= SHEET_ROWS:
            raise damaged(fill("the rows of {part} are out of order", part=self.path))
        if attributes.get("hidden") in TRUE and len(self.hidden_rows) < MAX_ROWS:
            self.hidden_rows.append(self._number)
        self._row_start = self.parser.CurrentByteIndex
        self._cells, self._at, self._count = {}, 0, 0
        if self.marks and attributes.get("customFormat") in TRUE and (style := attributes.get("s", "")).isdigit():
            self.marks.row_formats[self._number] = self._format(style)

    def _open_column(self, attributes: dict[str, str]) -> None:
        if attributes.get("hidden") in TRUE:
            first, last = (min(int(attributes.get(name, "0")), MAX_COLUMNS) for name in ("min", "max"))
            self.hidden_columns.update(range(first - 1, last))
        if self.marks and (style := attributes.get("style", "")).isdigit() and int(style):
            first, last = int(attributes["min"]) - 1, int(attributes["max"]) - 1
            self.marks.column_formats.append((first, last, self._format(style)))

    def _open_cell(self, attributes: dict[str, str]) -> None:
        self._address = attributes.get("r", "")
        self._at = column_number(self._address.rstrip("0123456789")) if self._address else self._at + 1
        self._count += 1
        if self._at > SHEET_COLUMNS or self._count > SHEET_COLUMNS:
            raise damaged(
                fill("row {row} of {part} has more cells than a sheet has columns", row=self._number, part=self.path)
            )
        self._kind, self._style = attributes.get("t", "n"), attributes.get("s", "")
        self._texts, self._tags = [], set()

    def _take_plain(self, cells: str, is_empty: bool) -> None:
        if self.marks:
            self._close_cells(list_cells(cells))
        elif not is_empty:
            self._close_cells(self._take_common(list_cells(cells)))
        elif unsaved := list_unsaved(cells):
            self.last_row = self._number
            self._cells.update(dict.fromkeys(unsaved, UNSAVED))
        self._texts, self._tags = None, set()

    def _take_common(self, cells: list[PlainCell]) -> Iterator[PlainCell]:
        """Keep shared texts and numbers without a style at once: most cells hold one; yield the other cells."""
        found, strings, is_styled = self._cells, self.shared.strings, self._format("") is not None
        for cell in cells:
            letters, _, style, kind, formula, value = cell
            if len(value) <= _NO_VALUE or (at := column_number(letters)) > MAX_COLUMNS:
                yield cell
            elif kind == "s":
                found[at - 1] = strings[int(value[3:-4])]
            elif kind or style or formula or is_styled:
                yield cell
            else:
                text = value[3:-4]
                found[at - 1] = float(text) if "." in text or "e" in text or "E" in text else int(text)
        if found:
            self.last_row = self._number

    def _close_cells(self, cells: Iterable[PlainCell]) -> None:
        for letters, digits, self._style, kind, formula, value in cells:
            self._address, self._at, self._kind = letters + digits, column_number(letters), kind or "n"
            self._tags = _PLAIN_TAGS[bool(formula), bool(value)]
            self._close_cell(value[3:-4])

    def _close_cell(self, text: str) -> None:
        if not self._tags.isdisjoint(("v", "f", "is")):
            self._keep(text)
        if self.marks:
            self._mark(self.marks)

    def _mark(self, marks: Marks) -> None:
        place = self._number, self._at - 1
        if "f" in self._tags:
            marks.formulas.add(place)
        if not self._tags <= _CONTENT:
            marks.unknown.add(place)
        if place[1] not in self._cells and not self._tags.isdisjoint(("v", "f", "is")):
            marks.hollow.setdefault(self._number, set()).add(place[1])
        code = self._format(self._style)
        if code is not None or marks.column_formats or marks.row_formats:
            marks.formats[place] = code

    def _keep(self, text: str) -> None:
        self.last_row = self._number
        if self._at > MAX_COLUMNS:
            self.far = self.far or self._address or fill("column {at} of row {row}", at=self._at, row=self._number)
            return
        value = self._value(text) if text else None
        if value is None and "f" in self._tags and not (self._kind == "str" and "v" in self._tags):
            value = UNSAVED
        if value is not None:
            self._cells[self._at - 1] = value

    def _value(self, text: str) -> Any:
        if self._kind == "s":
            return self.shared.strings[int(text)]
        if self._kind == "b":
            return bool(int(text))
        if self._kind == "n":
            return read_number(
                float(text) if any(sign in text for sign in ".eE") else int(text),
                self._format(self._style),
                is_1904=self.shared.is_1904,
            )
        if self._kind == "d":
            from openpyxl.utils.datetime import from_ISO8601

            return from_ISO8601(text)  # type: ignore[no-untyped-call]
        return decode_text(text)

    def _format(self, style: str) -> str | None:
        number = int(style) if style.isdigit() else 0
        return self.shared.styles[number] if number < len(self.shared.styles) else None


def _check_kind(types: Tree, book: Tree) -> None:
    for one in types.find("Override"):
        part = one.get("PartName", "").lstrip("/")
        if part and part != WORKBOOK and one.get("ContentType", "").endswith(_MAIN):
            raise damaged(fill("{part} stands for {expected}", part=part, expected=WORKBOOK))
    if any(_STRICT in one.values() for one in book.find("workbook")):
        message = fill("the workbook is saved as Strict Open XML.")
        raise unreadable(message, fill("In Excel: Save As, Excel Workbook (.xlsx), without Strict."))


def _check_report(properties: Tree, name: str) -> None:
    """Raise WorkbookError for a report of assess, which names the workbook that it is of."""
    for named in (one.get("name", "") for one in properties.find("property")):
        if named.startswith(REPORT_OF):
            files = {"name": plain_line(name), "file": plain_line(named.removeprefix(REPORT_OF))}
            message = fill("{name} is a report of {file}: edit {file} and run that.", **files)
            raise unreadable(message, "")


def _list_formats(styles: Tree) -> list[str | None]:
    codes = {one.get("numFmtId", ""): one.get("formatCode", "") for one in styles.find("numFmt")}
    return [find_format(one.get("numFmtId", "0"), codes) for one in styles.find("xf", "cellXfs")]


class Book:
    """An opened workbook; use it in a ``with`` statement.

    `sheets` tells the parts of its worksheets by their names, in their order; `parts`
    the parts that the workbook refers to, such as its calcChain, by kind. `archive` is the zip.

    `hidden` holds the names of those that are not shown, `changed` the parts that have other bytes now, None for one
    that is gone.

    Raises WorkbookError: also while its sheets are read: if the file is damaged, is no workbook, or is larger than an
    honest one.
    """

    def __init__(self, data: bytes, name: str, progress: Progress = SILENT) -> None:
        self.name, self.progress, self._shared = name, progress, _Shared()
        self.changed: dict[str, bytes | None] = {}
        self.archive = _open_archive(data, name)
        self._present = {one.lower(): one for one in self.archive.namelist()}
        with self:
            types, book = self.read(Tree, TYPES), self.read(Tree, WORKBOOK)
            _check_kind(types, book)
            if PROPERTIES in self.archive.namelist():
                _check_report(self.read(Tree, PROPERTIES), name)
            links = self._links()
            self.parts = kinds = dict(links.values())
            self.sheets, self.hidden = dict[str, str](), set[str]()
            for one in book.find("sheet"):
                link = next((value for name, value in one.items() if name.endswith(":id")), "")
                if links.get(link, ("",))[0] == "worksheet":
                    self.sheets[one.get("name", "")] = links[link][1]
                    if one.get("state", "visible") != "visible":
                        self.hidden.add(one.get("name", ""))
            self._shared = _Shared(
                self.read(_Strings, kinds["sharedStrings"]).found if "sharedStrings" in kinds else [],
                _list_formats(self.read(Tree, kinds["styles"])) if "styles" in kinds else [],
                any(one.get("date1904") in TRUE for one in book.find("workbookPr")),
            )

    def _links(self) -> dict[str, tuple[str, str]]:
        found = {}
        for one in self.read(Tree, RELATIONS).find("Relationship"):
            path = self.find_part("xl", one.get("Target", ""))
            if path is not None and one.get("TargetMode") != "External":
                found[one.get("Id", "")] = (one.get("Type", "").rpartition("/")[2], path)
        return found

    def find_part(self, folder: str, target: str) -> str | None:
        """Return the part that `target` means in `folder`, whatever the case of its name; None where there is none."""
        path = posixpath.normpath(posixpath.join("/", folder, target.replace("\\", "/"))).lstrip("/")
        return self._present.get(path.lower())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        """Turn what a damaged file raises into one sentence."""
        if isinstance(error, DAMAGE) and not isinstance(error, WorkbookError):
            message = fill("{name} is damaged or is no Excel workbook: {why}.", name=self.name, why=_describe(error))
            raise unreadable(message, fill("Open it in Excel and save it again.")) from error

    def read(self, kind: type[_Kind], path: str) -> _Kind:
        """Return a part of the zip, read as one kind of part."""
        return kind(self, path).read()

    def part_bytes(self, path: str) -> bytes:
        """Return the bytes of a part as they are now."""
        return self.changed.get(path) or self.archive.read(path)

    def open_part(self, path: str) -> IO[bytes]:
        """Open a part as it is now."""
        changed = self.changed.get(path)
        return self.archive.open(path) if changed is None else io.BytesIO(changed)

    def part_size(self, path: str) -> int:
        """Return how many bytes a part has now."""
        changed = self.changed.get(path)
        return self.archive.getinfo(path).file_size if changed is None else len(changed)

    def cells(self, sheet: str, *, is_marked: bool = False) -> SheetCells:
        """Return the cells of a sheet, with marks if these are asked for."""
        marks = Marks(is_1904=self._shared.is_1904) if is_marked else None
        cells = SheetCells(self, self.sheets[sheet], self._shared, marks)
        cells.title = sheet
        return cells
