"""Where the elements of a workbook's XML lie, in bytes, so that some can be changed and every other byte stays.

What is not understood is refused: a change is only made where its effect is known.
"""

import re
import zipfile
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from assess.errors import WorkbookError
from assess.i18n import Text, fill
from assess.progress import SILENT, Progress
from assess.workbook.open import Part, damaged, unreadable
from assess.workbook.plain_rows import split_address, split_range

_TAG = re.compile(rb"""<[^>"']*(?:(?:"[^"]*"|'[^']*')[^>"']*)*>""")
_ATTRIBUTE = re.compile(rb"""\s+([^\s=/>]+)\s*=\s*(?:"[^"]*"|'[^']*')""")
MOST_NESTED = 100
"""Elements in one another; a sheet has a dozen."""
_ENCODINGS = ("utf-8", "us-ascii", "ascii")

Edit = tuple[int, int, bytes]
"""Bytes from a place up to another, and what stands there instead."""


def apply_edits(data: bytes, edits: Iterable[Edit]) -> bytes:
    """Return `data` with edits made; none may overlap, and those at one place keep their order."""
    out, at = [], 0
    for start, end, new in sorted(edits, key=lambda edit: edit[:2]):
        out += [data[at:start], new]
        at = end
    return b"".join((*out, data[at:]))


def drop_attributes(tag: bytes, names: Collection[bytes]) -> bytes:
    """Return a start tag without some of its attributes."""
    return _ATTRIBUTE.sub(lambda found: b"" if found[1] in names else found[0], tag)


def add_attribute(tag: bytes, text: bytes) -> bytes:
    """Return a start tag with ``name="value"`` at its end."""
    end = -2 if tag.endswith(b"/>") else -1
    return tag[:end].rstrip() + b" " + text + tag[end:]


def open_tag(tag: bytes) -> bytes:
    """Return the start tag of an element that has no content as one that may have some."""
    return tag[:-2].rstrip() + b">" if tag.endswith(b"/>") else tag


@dataclass(slots=True)
class Element:
    """An element: its bytes from `start` to `end`, its start tag to `head`, its content to `foot`."""

    name: str
    parent: str
    attributes: Mapping[str, str]
    start: int
    head: int
    foot: int = 0
    end: int = 0


class LocatedPart(Part):
    """A part of the zip whose elements can be found again in its bytes, `data`."""

    limits: tuple[int, int] | None = None

    def __init__(self, archive: zipfile.ZipFile, path: str, name: str, progress: Progress = SILENT) -> None:
        super().__init__(archive, path, name, progress)
        self.data = archive.read(path)
        self.parser.CharacterDataHandler = None
        self.parser.StartDoctypeDeclHandler = self._refuse_types
        self.parser.XmlDeclHandler = self._check_encoding
        self._open: list[Element | None] = []

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Note where an element begins, if it is wanted."""
        self.depth = len(self._open) + 1
        if self.depth > MOST_NESTED:
            raise self.not_understood(fill("it nests its elements too deep"))
        kept = None
        if self.wants(tag, attributes):
            start = self.parser.CurrentByteIndex
            head = _TAG.match(self.data, start)
            if head is None:
                raise self.not_understood(fill("a tag cannot be found in it"))
            above = self._open[-1] if self._open else None
            kept = Element(tag, above.name if above else "", attributes, start, head.end())
        self._open.append(kept)

    def leave(self, tag: str) -> None:
        """Note where it ends."""
        self.depth = len(self._open)
        one = self._open.pop()
        if one is None:
            return
        if self.data[one.head - 2 : one.head] == b"/>":
            one.foot = one.end = one.head
        else:
            one.foot = self.parser.CurrentByteIndex
            one.end = self.data.index(b">", one.foot) + 1
        self.found(one)

    def wants(self, tag: str, attributes: dict[str, str]) -> bool:
        """Tell whether the place of an element that begins is to be noted; `depth` is 1 for the root."""
        raise NotImplementedError

    def found(self, one: Element) -> None:
        """Take in an element that has ended."""
        raise NotImplementedError

    def not_understood(self, why: Text) -> WorkbookError:
        """Build the error for XML that cannot be changed with certainty."""
        message = fill("{part} cannot be changed without risk: {why}.", part=self.path, why=why)
        return unreadable(message, fill("Open the workbook in Excel, save it under another name, and use that."))

    def _refuse_types(self, *_: object) -> None:
        raise self.not_understood(fill("it declares a document type"))

    def _check_encoding(self, _version: str, encoding: str | None, _standalone: int) -> None:
        if encoding is not None and encoding.lower() not in _ENCODINGS:
            raise damaged(fill("{part} is not written in UTF-8", part=self.path))


class SmallPart(LocatedPart):
    """A small part: all elements down to the third level, in the order in which they end."""

    limits = (24 * 2**20, 1_000_000)

    def __init__(self, archive: zipfile.ZipFile, path: str, name: str, progress: Progress = SILENT) -> None:
        super().__init__(archive, path, name, progress)
        self.elements: list[Element] = []

    def wants(self, tag: str, attributes: dict[str, str]) -> bool:
        """Note the root, its children and theirs."""
        return self.depth <= 3

    def found(self, one: Element) -> None:
        """Keep an element."""
        self.elements.append(one)

    def named(self, name: str) -> Iterator[Element]:
        """Yield the elements of a name, whatever their prefix."""
        return (one for one in self.elements if one.name.rpartition(":")[2] == name)


# ---------------------------------------------------------------- sheets


@dataclass(slots=True)
class CellPlace:
    """Where a cell lies; `parts` are the elements in it, such as f (its formula) and v (its value)."""

    column: int
    element: Element
    parts: list[Element] = field(default_factory=list)

    def part(self, name: str) -> Element | None:
        """Return the element of a name in it."""
        return next((one for one in self.parts if one.name.rpartition(":")[2] == name), None)


@dataclass(slots=True)
class RowPlace:
    """Where a row lies, its wanted cells by their columns, from 1, and column and beginning of every cell."""

    number: int
    element: Element
    cells: dict[int, CellPlace] = field(default_factory=dict)
    starts: list[tuple[int, int]] = field(default_factory=list)


class SheetPlaces(LocatedPart):
    """Where the rows of a sheet lie, and the cells that are `wanted`, columns by row, both from 1.

    `sheet_data` is the element that holds the rows, `dimension` the one that says how far they reach, `columns` the
    styles of columns by their first and last, `locked` the ranges of formulas of several cells with what they are.
    """

    def __init__(
        self, archive: zipfile.ZipFile, path: str, name: str, wanted: Mapping[int, Collection[int]], progress: Progress
    ) -> None:
        super().__init__(archive, path, name, progress)
        self.wanted = wanted
        self.rows: dict[int, RowPlace] = {}
        self.dimension: Element | None = None
        self.columns: list[tuple[int, int, str]] = []
        self.locked: list[tuple[tuple[int, int, int, int], str]] = []
        self._sheet_data: Element | None = None
        self._numbers, self._starts = list[int](), list[int]()
        self._prefix, self._is_inside = "", False
        self._row: RowPlace | None = None
        self._cell: CellPlace | None = None
        self._number = self._column = 0

    @property
    def sheet_data(self) -> Element:
        """The element that holds the rows; raises WorkbookError if there is none."""
        if self._sheet_data is None:
            raise self.not_understood(fill("it holds no rows"))
        return self._sheet_data

    @property
    def prefix(self) -> bytes:
        """The prefix of the names of elements, with its colon."""
        return self._prefix.encode()

    def place_of_new(self, number: int) -> int:
        """Return where the first row after one that is missing begins; the end of all rows if it is the last."""
        at = bisect_right(self._numbers, number)
        return self._starts[at] if at < len(self._starts) else self.sheet_data.foot

    def wants(self, tag: str, attributes: dict[str, str]) -> bool:
        """Note what the sheet says of itself, rows, and the cells of some."""
        if self.depth == 2:
            return self._start_part(tag)
        if not self._is_inside:
            if tag.rpartition(":")[2] == "col" and "style" in attributes:
                self.columns.append((int(attributes["min"]), int(attributes["max"]), attributes["style"]))
            return False
        if self.depth == 3:
            return self._start_row(tag, attributes)
        if self.depth == 4:
            return self._start_cell(tag, attributes)
        if self.depth == 5:
            return self._start_content(tag, attributes)
        return False

    def _start_part(self, tag: str) -> bool:
        prefix, colon, name = tag.rpartition(":")
        self._is_inside = name == "sheetData"
        if self._is_inside:
            if self._sheet_data is not None:
                raise self.not_understood(fill("it holds the rows of a sheet twice"))
            self._prefix = prefix + colon
        return name in ("sheetData", "dimension")

    def _expect(self, tag: str, name: str) -> None:
        if tag != f"{self._prefix}{name}":
            raise self.not_understood(fill("{found} stands where {name} is expected", found=tag[:40], name=name))

    def _start_row(self, tag: str, attributes: dict[str, str]) -> bool:
        self._expect(tag, "row")
        number = int(attributes["r"]) if "r" in attributes else self._number + 1
        if number <= self._number:
            raise damaged(fill("the rows of {part} are out of order", part=self.path))
        self._number, self._column, self._row = number, 0, None
        self._numbers.append(number)
        self._starts.append(self.parser.CurrentByteIndex)
        return number in self.wanted

    def _start_cell(self, tag: str, attributes: dict[str, str]) -> bool:
        self._expect(tag, "c")
        self._column += 1
        if "r" in attributes:
            place = split_address(attributes["r"])
            if place is None or place[1] != self._number or place[0] < self._column:
                raise self.not_understood(
                    fill("cell {address} stands in row {row}", address=attributes["r"][:20], row=self._number)
                )
            self._column = place[0]
        self._cell = None
        if self._row is None:
            return False
        self._row.starts.append((self._column, self.parser.CurrentByteIndex))
        return self._column in self.wanted[self._number]

    def _start_content(self, tag: str, attributes: dict[str, str]) -> bool:
        kind = attributes.get("t", "")
        if kind in ("array", "dataTable") and tag == f"{self._prefix}f":
            locked = split_range(attributes.get("ref", ""))
            if locked is None:
                raise self.not_understood(fill("a formula of several cells does not say of which"))
            self.locked.append((locked, kind))
        return self._cell is not None

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Note where an element begins, and the cell that it begins."""
        if self._row is None and self._is_inside and len(self._open) > 2:
            self._pass_over(tag, attributes)
            return
        super().enter(tag, attributes)
        one = self._open[-1]
        if one is None or not self._is_inside:
            return
        if self.depth == 3:
            self._row = self.rows[self._number] = RowPlace(self._number, one)
        elif self.depth == 4 and self._row is not None:
            self._cell = self._row.cells[self._column] = CellPlace(self._column, one)
        elif self.depth == 5 and self._cell is not None:
            self._cell.parts.append(one)

    def _pass_over(self, tag: str, attributes: dict[str, str]) -> None:
        """Take in an element of a row that is not wanted, of which there may be a million."""
        self._open.append(None)
        depth = len(self._open)
        if depth == 4:
            self._expect(tag, "c")
        elif depth == 5 and "t" in attributes:
            self._start_content(tag, attributes)
        elif depth > MOST_NESTED:
            raise self.not_understood(fill("it nests its elements too deep"))

    def found(self, one: Element) -> None:
        """Keep the element that holds the rows, and the one that says how far they reach."""
        name = one.name.rpartition(":")[2]
        if self.depth == 2 and name == "sheetData":
            self._sheet_data = one
        elif self.depth == 2 and name == "dimension":
            self.dimension = one
