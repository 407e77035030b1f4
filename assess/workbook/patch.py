"""Cells of an .xlsx set by editing the bytes of its sheets: whatever is not changed stays as it was, to the byte.

Loading a workbook in a library and saving it again loses what the library does not know: pictures, threaded comments,
sparklines, the stored results of formulas. Here the places of the cells are found in the XML of their sheet, and
only those bytes are replaced; every other part of the zip keeps its bytes, name, date and place. What is not
understood is refused: a change is only made where its effect is known. Office Open XML: ECMA-376 Part 1, 18.3
(worksheets), 18.6 (calculation chain), 22.9.2.19 (ST_Xstring).
"""

import io
import posixpath
import re
import zipfile
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill
from assess.workbook.open import (
    LOCKED,
    RELATIONS,
    SHEET_COLUMNS,
    SHEET_ROWS,
    TYPES,
    WORKBOOK,
    Area,
    Book,
    Part,
    Place,
    Tree,
    damaged,
    decode_text,
    unreadable,
)
from assess.workbook.plain_rows import column_letters, split_address, split_range
from assess.workbook.row_shift import Growth, NotMovedError, PartShift, Shift, shift_drawing, shift_shapes

Value = float | str | bool | None
"""What a cell may hold; None leaves it blank."""
LONGEST_TEXT = 32_767
"""Characters that a cell of a spreadsheet program holds."""
LARGEST_NUMBER = 9.99999999999999e307
"""The largest number that a cell holds."""
MOST_CHECKED = 4 * 2**20
"""Bytes up to which a sheet is read, before it is changed, to see whether it can be."""
MOST_NESTED = 100
"""Elements in one another; a sheet has a dozen."""
_FEW_ROWS = 8
_UNWRITABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]|_(?=x[0-9A-Fa-f]{4}_)")
_TAG = re.compile(rb"""<[^>"']*(?:(?:"[^"]*"|'[^']*')[^>"']*)*>""")
_ATTRIBUTE = re.compile(rb"""\s+([^\s=/>]+)\s*=\s*(?:"[^"]*"|'[^']*')""")
_ENCODINGS = ("utf-8", "us-ascii", "ascii")
_CONTENT = frozenset({"f", "v", "is"})
_LEVEL = 6


Values = Mapping[Place, Value]


@dataclass(frozen=True, slots=True)
class SheetEdits:
    """What is to be written into one sheet.

    * `shifts`: Rows inserted, deleted and moved, in their order, before all else.
    * `values`: A cell keeps its format; a formula in it is replaced; None leaves it blank. A cell or row that is
      missing is added in its place, with the format of its row or column.
    * `results`: The stored results of formulas, which stay; None takes the result out, so that every program computes
      it when it opens the workbook.
    * `growth`: Rows that were filled in directly below others: tables, filters, print areas, validations and
      conditional formats that end above them take them in.
    """

    values: Values = field(default_factory=dict)
    results: Values = field(default_factory=dict)
    shifts: tuple[Shift, ...] = ()
    growth: Growth = field(default_factory=Growth)


def write_edits(book: Book, edits: Mapping[str, SheetEdits]) -> bytes:
    """Return the bytes of a workbook with sheets edited, by its own names of them; every other byte of its parts stays.

    The same values set again give the same bytes. Where anything changed, programs are asked to recalculate the
    workbook when they open it.

    Raises WorkbookError if something in it cannot be changed with certainty. The problems name every cell that is
    refused: one where a formula of several cells begins, one of an array or data table, a header of a table, a value
    that a cell cannot hold.
    """
    check_sheets(book, list(edits))
    has_moved = any(one.shifts for one in edits.values())
    problems: list[Problem] = []
    for sheet, one in edits.items():
        path = book.sheets[sheet]
        for shift in one.shifts:
            _shift_rows(book, sheet, shift)
        if one.values or one.results:
            patch = _SheetPatch(book, sheet, one)
            book.changed[path] = patch.write()
            has_moved = has_moved or patch.has_replaced
            problems += patch.problems
        if one.growth.blocks:
            _grow(book, sheet, one.growth)
    if problems:
        raise WorkbookError(problems)
    book.changed |= set_recalculation(book)
    book.changed |= drop_chain(book) if has_moved else {}
    return _pack(book)


def check_sheets(book: Book, names: Sequence[str]) -> None:
    """Raise WorkbookError if a sheet is missing, or the workbook may not be changed."""
    missing = [one for one in names if one not in book.sheets]
    if missing:
        raise WorkbookError([Problem("error", one, "", fill("the sheet is missing.")) for one in missing])
    if any(part.startswith("_xmlsignatures/") for part in book.archive.namelist()):
        message = fill("{name} is digitally signed; a change would break the signature.", name=book.name)
        raise unreadable(message, fill("Save it from Excel without the signature."))


def check_layout(book: Book, sheet: str) -> None:
    """Raise WorkbookError if a sheet cannot be changed at all. Of a large one this shows only when it is changed."""
    check_sheets(book, [sheet])
    if book.part_size(book.sheets[sheet]) <= MOST_CHECKED:
        _ = SheetPlaces(book, book.sheets[sheet], {}).read().sheet_data


# ---------------------------------------------------------------- rows that move, and tables that grow

_OWN = ("table", "comments", "threadedComment", "pivotTable")
"""Parts that belong to a sheet and name its cells, by the ends of the kinds of their relations."""
_ALSO = ("xl/charts/", "xl/pivotCache/pivotCacheDefinition", "xl/ctrlProps/", "xl/tables/", "xl/worksheets/")
"""Where parts lie that name cells of any sheet."""


def _shift_rows(book: Book, sheet: str, shift: Shift) -> None:
    """Insert, delete or move rows of a sheet; whatever refers to its cells follows."""
    own = {path: kind for kind, path in _list_related(book, book.sheets[sheet])}
    for path in book.archive.namelist():
        kind = own.get(path, "")
        is_own = path == book.sheets[sheet] or kind in _OWN
        if kind == "drawing":
            book.changed[path] = shift_drawing(book.part_bytes(path), shift)
        elif kind == "vmlDrawing":
            book.changed[path] = shift_shapes(book.part_bytes(path), shift)
        elif is_own or path == WORKBOOK or (path.startswith(_ALSO) and path.endswith(".xml")):
            data = book.part_bytes(path)
            if is_own or any(escape(one, quote=False).encode() in data for one in (sheet, sheet.replace("'", "''"))):
                book.changed[path] = _move(path, PartShift(sheet, is_own, shift), data)


def _grow(book: Book, sheet: str, growth: Growth) -> None:
    path = book.sheets[sheet]
    for one in (path, WORKBOOK):
        book.changed[one] = _move(one, PartShift(sheet, one == path, growth), book.part_bytes(one))
    for table in list_tables(book, path):
        if not table.totals:
            left, right, _, _ = table.area
            move = PartShift(sheet, True, growth.of_columns(left, right))
            book.changed[table.path] = _move(table.path, move, book.part_bytes(table.path))


def _move(path: str, move: PartShift, data: bytes) -> bytes:
    try:
        return move.apply(data)
    except (NotMovedError, UnicodeDecodeError) as error:
        why = error.why if isinstance(error, NotMovedError) else fill("it is not written in UTF-8")
        raise not_understood(path, why) from None


@dataclass(frozen=True, slots=True)
class SheetTable:
    """A table of a sheet: its cells with the rows of its headers and its totals, and how many rows these are."""

    path: str
    area: Area
    headers: int
    totals: int


def list_tables(book: Book, path: str) -> list[SheetTable]:
    """Return the tables of a sheet. One keeps a copy of its headers; where they differ, Excel repairs the file."""
    found = []
    for kind, target in _list_related(book, path):
        for table in book.read(Tree, target).find("table") if kind == "table" else ():
            headers, totals = (table.get(name, "01"[at]) for at, name in ((1, "headerRowCount"), (0, "totalsRowCount")))
            if area := split_range(table.get("ref", "")):
                found.append(SheetTable(target, area, int(headers != "0"), int(totals) if totals.isdigit() else 0))
    return found


def _list_related(book: Book, path: str) -> list[tuple[str, str]]:
    """Return kind and path of the parts that a sheet refers to."""
    folder, name = posixpath.split(path)
    relations = book.find_part(folder, f"_rels/{name}.rels")
    links = book.read(Tree, relations).find("Relationship") if relations else iter(())
    found = [(one.get("Type", "").rpartition("/")[2], book.find_part(folder, one.get("Target", ""))) for one in links]
    return [(kind, target) for kind, target in found if target is not None]


# ---------------------------------------------------------------- cells that no edit may change


class Locks:
    """Why cells cannot be changed, by the areas that hold them.

    A sheet may have thousands of merged cells, and an edit hundreds of thousands of cells: areas of a few rows are
    listed by row, and of the others each stretch of rows that no edge of one parts is looked at once.
    """

    def __init__(self, areas: Iterable[tuple[Area, Text]]) -> None:
        self._rows: dict[int, list[tuple[int, int, Text]]] = {}
        self._tall: list[tuple[Area, Text]] = []
        for area, why in areas:
            left, right, top, bottom = area
            if bottom - top > _FEW_ROWS:
                self._tall.append((area, why))
            for row in range(top, bottom + 1) if bottom - top <= _FEW_ROWS else ():
                self._rows.setdefault(row, []).append((left, right, why))
        self._edges = sorted({edge for (_, _, top, bottom), _ in self._tall for edge in (top, bottom + 1)})
        self._stretches: dict[int, list[tuple[int, int, Text]]] = {}

    def find(self, row: int, at: int) -> Text | str:
        """Return why a cell cannot be changed, "" where it can."""
        stretch = bisect_right(self._edges, row)
        if stretch not in self._stretches:
            inside = ((left, right, why) for (left, right, top, bottom), why in self._tall if top <= row <= bottom)
            self._stretches[stretch] = list(dict.fromkeys(inside))
        areas = (*self._rows.get(row, ()), *self._stretches[stretch])
        return next((why for left, right, why in areas if left <= at + 1 <= right), "")


def list_headings(tables: Iterable[SheetTable]) -> Iterator[tuple[Area, Text]]:
    """Yield the areas of tables that no edit may change: their headers and totals."""
    for one in tables:
        left, right, top, bottom = one.area
        if one.headers:
            yield (left, right, top, top), fill("it is a header of a table.")
        if one.totals:
            yield (left, right, bottom - one.totals + 1, bottom), fill("it is in the totals row of a table.")


# ---------------------------------------------------------------- where elements lie

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
    """An element: its bytes from `start` to `end`, its start tag to `head`, its content to `foot`.

    `parts` are those in a cell, such as f (its formula) and v (its value).
    """

    name: str
    parent: str
    attributes: Mapping[str, str]
    start: int
    head: int
    foot: int = 0
    end: int = 0
    parts: "list[Element]" = field(default_factory=list)

    @property
    def bare(self) -> str:
        """Its name without the prefix."""
        return self.name.rpartition(":")[2]

    def part(self, name: str) -> "Element | None":
        """Return the element of a bare name in a cell."""
        return next((one for one in self.parts if one.bare == name), None)


def not_understood(part: str, why: Text) -> WorkbookError:
    """Build the error for a part that cannot be changed with certainty."""
    message = fill("{part} cannot be changed without risk: {why}.", part=part, why=why)
    return unreadable(message, fill("Open the workbook in Excel, save it under another name, and use that."))


class SmallPart(Part):
    """A part of the zip whose `elements`, down to the third level, can be found again in its bytes, `data`."""

    limits: tuple[int, int] | None = (24 * 2**20, 1_000_000)

    def __init__(self, book: Book, path: str) -> None:
        super().__init__(book, path)
        self.data = book.part_bytes(path)
        self.parser.CharacterDataHandler = None
        self.parser.StartDoctypeDeclHandler = self._refuse_types
        self.parser.XmlDeclHandler = self._check_encoding
        self.elements: list[Element] = []
        self._open: list[Element | None] = []

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Note where an element begins, if it is wanted."""
        if len(self._open) >= MOST_NESTED:
            raise self.not_understood(fill("it nests its elements too deep"))
        self._open.append(self.take(len(self._open) + 1, tag, attributes))

    def take(self, depth: int, tag: str, attributes: dict[str, str]) -> Element | None:
        """Return an element that begins, if its place is wanted; `depth` is 1 for the root."""
        if depth > 3:
            return None
        self.elements.append(self.locate(tag, attributes))
        return self.elements[-1]

    def locate(self, tag: str, attributes: dict[str, str]) -> Element:
        """Return an element that begins here."""
        start = self.parser.CurrentByteIndex
        head = _TAG.match(self.data, start)
        if head is None:
            raise self.not_understood(fill("a tag cannot be found in it"))
        above = self._open[-1] if self._open else None
        return Element(tag, above.name if above else "", attributes, start, head.end())

    def leave(self, tag: str) -> None:
        """Note where an element ends."""
        one = self._open.pop()
        if one is not None and self.data[one.head - 2 : one.head] == b"/>":
            one.foot = one.end = one.head
        elif one is not None:
            one.foot = self.parser.CurrentByteIndex
            one.end = self.data.index(b">", one.foot) + 1

    def named(self, name: str) -> Iterator[Element]:
        """Yield the elements of a name, whatever their prefix."""
        return (one for one in self.elements if one.bare == name)

    def not_understood(self, why: Text) -> WorkbookError:
        """Build the error for XML that cannot be changed with certainty."""
        return not_understood(self.path, why)

    def _refuse_types(self, *_: object) -> None:
        raise self.not_understood(fill("it declares a document type"))

    def _check_encoding(self, _version: str, encoding: str | None, _standalone: int) -> None:
        if encoding is not None and encoding.lower() not in _ENCODINGS:
            raise damaged(fill("{part} is not written in UTF-8", part=self.path))


@dataclass(slots=True)
class RowPlace:
    """Where a row lies, its wanted cells by their columns, from 1, and column and beginning of every cell."""

    element: Element
    cells: dict[int, Element] = field(default_factory=dict)
    starts: list[tuple[int, int]] = field(default_factory=list)


class SheetPlaces(SmallPart):
    """Where the rows of a sheet lie, and the cells that are `wanted`, columns by row, both from 1.

    `sheet_data` is the element that holds the rows, `dimension` the one that says how far they reach, `columns` the
    styles of columns by their first and last, `locked` the ranges of formulas of several cells with what they are.
    """

    limits = None

    def __init__(self, book: Book, path: str, wanted: Mapping[int, Collection[int]]) -> None:
        super().__init__(book, path)
        self.wanted = wanted
        self.rows: dict[int, RowPlace] = {}
        self.dimension: Element | None = None
        self.columns: list[tuple[int, int, str]] = []
        self.locked: list[tuple[Area, str]] = []
        self._sheet_data: Element | None = None
        self._numbers, self._starts = list[int](), list[int]()
        self._prefix, self._is_inside = "", False
        self._row: RowPlace | None = None
        self._cell: Element | None = None
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

    def take(self, depth: int, tag: str, attributes: dict[str, str]) -> Element | None:
        """Note what the sheet says of itself, its rows, and the cells of those that are wanted."""
        if self._is_inside and depth > 2:
            return (
                (self._take_row, self._take_cell, self._take_content)[depth - 3](tag, attributes) if depth < 6 else None
            )
        prefix, colon, name = tag.rpartition(":")
        if depth == 2:
            self._is_inside = name == "sheetData"
            kept = self.locate(tag, attributes) if name in ("sheetData", "dimension") else None
            if name == "dimension":
                self.dimension = kept
            elif self._is_inside:
                if self._sheet_data is not None:
                    raise self.not_understood(fill("it holds the rows of a sheet twice"))
                self._sheet_data, self._prefix = kept, prefix + colon
            return kept
        if name == "col" and "style" in attributes:
            self.columns.append((int(attributes["min"]), int(attributes["max"]), attributes["style"]))
        return None

    def _expect(self, tag: str, name: str) -> None:
        if tag != f"{self._prefix}{name}":
            raise self.not_understood(fill("{found} stands where {name} is expected", found=tag[:40], name=name))

    def _take_row(self, tag: str, attributes: dict[str, str]) -> Element | None:
        self._expect(tag, "row")
        number = int(attributes["r"]) if "r" in attributes else self._number + 1
        if number <= self._number:
            raise damaged(fill("the rows of {part} are out of order", part=self.path))
        self._number, self._column, self._row = number, 0, None
        self._numbers.append(number)
        self._starts.append(self.parser.CurrentByteIndex)
        if number not in self.wanted:
            return None
        self._row = self.rows[number] = RowPlace(self.locate(tag, attributes))
        return self._row.element

    def _take_cell(self, tag: str, attributes: dict[str, str]) -> Element | None:
        self._expect(tag, "c")
        self._cell = None
        if self._row is None:  # of these there may be a million
            return None
        self._column += 1
        if "r" in attributes:
            place = split_address(attributes["r"])
            if place is None or place[1] != self._number or place[0] < self._column:
                raise self.not_understood(
                    fill("cell {address} stands in row {row}", address=attributes["r"][:20], row=self._number)
                )
            self._column = place[0]
        self._row.starts.append((self._column, self.parser.CurrentByteIndex))
        if self._column in self.wanted[self._number]:
            self._cell = self._row.cells[self._column] = self.locate(tag, attributes)
        return self._cell

    def _take_content(self, tag: str, attributes: dict[str, str]) -> Element | None:
        kind = attributes.get("t", "")
        if kind in LOCKED and tag == f"{self._prefix}f":
            area = split_range(attributes.get("ref", ""))
            if area is None:
                raise self.not_understood(fill("a formula of several cells does not say of which"))
            self.locked.append((area, kind))
        if self._cell is None:
            return None
        self._cell.parts.append(self.locate(tag, attributes))
        return self._cell.parts[-1]


# ---------------------------------------------------------------- one sheet


def check_value(place: Place, value: Value) -> Text | str:
    """Return why a value cannot be written into a cell, "" where it can."""
    if not (1 <= place[0] <= SHEET_ROWS and 0 <= place[1] < SHEET_COLUMNS):
        return fill("it is no cell of a sheet.")
    if isinstance(value, str) and len(value) > LONGEST_TEXT:
        return fill("the text is longer than a cell holds: {most:,} characters.", most=LONGEST_TEXT)
    is_number = not isinstance(value, int | float) or abs(value) <= LARGEST_NUMBER
    return "" if is_number else fill("the value is not a number that a cell holds.")


class _SheetPatch:
    """Values and results of one sheet.

    `problems` tells what is refused, `has_replaced` whether a value takes the place of a formula.
    """

    def __init__(self, book: Book, sheet: str, edits: SheetEdits) -> None:
        self.sheet, path = sheet, book.sheets[sheet]
        self.has_replaced, self.problems = False, list[Problem]()
        self.changes, self.results = self._by_row(edits.values), self._by_row(edits.results)
        numbers = sorted({*self.changes, *self.results})
        wanted = {one: {*self.changes.get(one, ()), *self.results.get(one, ())} for one in numbers}
        self.places = SheetPlaces(book, path, wanted).read()
        areas = [(area, LOCKED[kind]) for area, kind in self.places.locked]
        self.locks = Locks([*areas, *list_headings(list_tables(book, path))])
        self.added: list[tuple[int, int]] = []

    def write(self) -> bytes:
        """Return the bytes of the sheet with the changes made."""
        edits: list[Edit] = []
        new_rows: list[tuple[int, bytes]] = []
        for number in self.places.wanted:
            for column in self.changes.get(number, ()):
                if why := self.locks.find(number, column - 1):
                    self._refuse((column, number), why)
            if number in self.places.rows:
                edits += self._edit_row(number, self.places.rows[number])
            elif cells := self._write_row(number):
                p = self.places.prefix
                new_rows.append((number, b'<%brow r="%d">%b</%brow>' % (p, number, cells, p)))
        edits += _insert_rows(self.places, new_rows)
        return apply_edits(self.places.data, [*edits, *_widen(self.places, self.added)])

    def _by_row(self, values: Values) -> dict[int, dict[int, Value]]:
        """Return values by row and column, both from 1."""
        found: dict[int, dict[int, Value]] = {}
        for (row, at), value in values.items():
            found.setdefault(row, {})[at + 1] = value
        return found

    def _refuse(self, cell: tuple[int, int], message: Text | str) -> None:
        address = f"{column_letters(cell[0] - 1)}{cell[1]}"
        self.problems.append(Problem("error", self.sheet, address, message, fill("Change this cell in Excel.")))

    def _write_row(self, number: int) -> bytes:
        """Return the cells of a row that the sheet lacks."""
        for column in self.results.get(number, ()):
            self._refuse((column, number), fill("it holds no formula."))
        values = sorted(self.changes.get(number, {}).items())
        return b"".join(self._new_cell(number, column, value, {}) for column, value in values if value is not None)

    def _edit_row(self, number: int, row: RowPlace) -> Iterator[Edit]:
        values, own = self.changes.get(number, {}), row.element.attributes
        new: list[tuple[int, bytes]] = []
        added = len(self.added)
        for column, value in sorted(values.items()):
            cell = row.cells.get(column)
            if cell is not None:
                yield cell.start, cell.end, self._changed_cell(number, column, cell, value)
            elif value is not None:
                at = next((start for other, start in row.starts if other > column), row.element.foot)
                new.append((at, self._new_cell(number, column, value, own)))
        for column, value in sorted(self.results.get(number, {}).items()):
            cell = row.cells.get(column)
            formula = cell.part("f") if cell is not None and column not in values else None
            if cell is None or formula is None:
                self._refuse((column, number), fill("it holds no formula."))
            else:
                kept = self.places.data[formula.start : formula.end]
                tag = self._tag(number, column, cell, (b"t",))
                yield cell.start, cell.end, _write_cell(self.places.prefix, tag, value, kept)
        if new:
            yield from self._insert(row.element, new, [column for column, _ in self.added[added:]])

    def _insert(self, one: Element, new: Sequence[tuple[int, bytes]], columns: Collection[int]) -> Iterator[Edit]:
        tag = self.places.data[one.start : one.head]
        spans = [split.partition(":") for split in one.attributes.get("spans", "").split()]
        inside = [range(int(first), int(last) + 1) for first, _, last in spans]
        wrong = any(not any(column in span for span in inside) for column in columns)
        changed = drop_attributes(tag, (b"spans",)) if wrong else tag
        if tag.endswith(b"/>"):
            cells = b"".join(text for _, text in new)
            yield one.start, one.head, open_tag(changed) + cells + b"</%brow>" % self.places.prefix
        else:
            yield one.start, one.head, changed
            yield from ((at, at, text) for at, text in new)

    def _new_cell(self, number: int, column: int, value: Value, of_row: Mapping[str, str]) -> bytes:
        """Return a cell with the style that it takes over from its row or column, as in spreadsheet programs."""
        self.added.append((column, number))
        found = (style for first, last, style in self.places.columns if first <= column <= last)
        style = next((style for style in found if style.isdigit() and int(style)), "")
        if of_row.get("customFormat") in ("1", "true") and of_row.get("s", "").isdigit():
            style = of_row["s"]
        p, address = self.places.prefix, f"{column_letters(column - 1)}{number}".encode()
        return _write_cell(p, b'<%bc r="%b"%b>' % (p, address, b' s="%b"' % style.encode() if style else b""), value)

    def _changed_cell(self, number: int, column: int, cell: Element, value: Value) -> bytes:
        formula = cell.part("f")
        if formula is not None:
            self.has_replaced = True
            if formula.attributes.get("t") == "shared" and "ref" in formula.attributes:
                self._refuse((column, number), fill("its formula is shared by other cells."))
        return _write_cell(self.places.prefix, self._tag(number, column, cell, (b"t", b"cm", b"vm")), value)

    def _tag(self, number: int, column: int, cell: Element, dropped: Collection[bytes]) -> bytes:
        known = {f"{self.places.prefix.decode()}{name}" for name in _CONTENT}
        unknown = [one.name for one in cell.parts if one.name not in known]
        if unknown:
            message = fill("it holds {element}, which is not known.", element=unknown[0][:40])
            self._refuse((column, number), message)
        return open_tag(drop_attributes(self.places.data[cell.start : cell.head], dropped))


def _write_cell(prefix: bytes, tag: bytes, value: Value, formula: bytes = b"") -> bytes:
    p, close = prefix, b"</%bc>" % prefix
    if value is None:
        return tag + formula + close if formula else tag[:-1].rstrip() + b"/>"
    if isinstance(value, str):
        text = escape(_code(value), quote=False).replace("\r", "&#13;").encode()
        if formula:
            return add_attribute(tag, b't="str"') + formula + b"<%bv>%b</%bv>" % (p, text, p) + close
        inline = b'<%bis><%bt xml:space="preserve">%b</%bt></%bis>' % (p, p, text, p, p)
        return add_attribute(tag, b't="inlineStr"') + inline + close
    if isinstance(value, bool):
        return add_attribute(tag, b't="b"') + formula + b"<%bv>%d</%bv>" % (p, value, p) + close
    return tag + formula + b"<%bv>%b</%bv>" % (p, _write_number(value).encode(), p) + close


def _write_number(value: float) -> str:
    number = float(value)
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _code(value: str) -> str:
    return _UNWRITABLE.sub(lambda found: f"_x{ord(found[0]):04X}_", value)


def read_back(value: Value) -> Value:
    """Return what reading finds in a cell of the general format that a value was written into."""
    if isinstance(value, str):
        return decode_text(_code(value)) or None
    if value is None or isinstance(value, bool):
        return value
    text = _write_number(value)
    return float(text) if any(sign in text for sign in ".e") else int(text)


def _insert_rows(places: SheetPlaces, rows: Sequence[tuple[int, bytes]]) -> list[Edit]:
    one = places.sheet_data
    tag = places.data[one.start : one.head]
    if rows and tag.endswith(b"/>"):
        text = b"".join(text for _, text in rows)
        return [(one.start, one.end, open_tag(tag) + text + b"</%bsheetData>" % places.prefix)]
    found = [(places.place_of_new(number), text) for number, text in rows]
    return [(at, at, text) for at, text in found]


def _widen(places: SheetPlaces, added: Sequence[tuple[int, int]]) -> list[Edit]:
    one = places.dimension
    span = split_range(one.attributes.get("ref", "")) if one is not None else None
    if one is None or span is None or not added:
        return []
    columns, rows = zip(*added, strict=True)
    wide = (min(span[0], *columns), max(span[1], *columns), min(span[2], *rows), max(span[3], *rows))
    if wide == span:
        return []
    reference = f"{column_letters(wide[0] - 1)}{wide[2]}:{column_letters(wide[1] - 1)}{wide[3]}".encode()
    tag = places.data[one.start : one.head]
    return [(one.start, one.head, add_attribute(drop_attributes(tag, (b"ref",)), b'ref="%b"' % reference))]


# ---------------------------------------------------------------- the zip


def _pack(book: Book) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=_LEVEL) as out:
        out.comment = book.archive.comment
        for info in book.archive.infolist():
            book.progress.check()
            content = book.changed[info.filename] if info.filename in book.changed else book.archive.read(info)
            if content is not None:
                found = zipfile.ZipInfo(info.filename, info.date_time)
                for name in ("compress_type", "comment", "extra", "create_system", "create_version", "extract_version",
                             "internal_attr", "external_attr"):  # fmt: skip
                    setattr(found, name, getattr(info, name))
                out.writestr(found, content, compresslevel=_LEVEL)
    return packed.getvalue()


# ---------------------------------------------------------------- what has to follow when cells change

_BEFORE_CALCULATION = frozenset({
    "fileVersion", "fileSharing", "workbookPr", "workbookProtection", "bookViews", "sheets", "functionGroups",
    "externalReferences", "definedNames",
})  # fmt: skip
"""What stands before calcPr in a workbook (ECMA-376 Part 1, 18.2.27)."""


def set_recalculation(book: Book) -> dict[str, bytes]:
    """Return the workbook's own part if it has to change so that programs recalculate every formula on opening it."""
    part = book.read(SmallPart, WORKBOOK)
    named = next(part.named("calcPr"), None)
    if named is not None:
        if named.attributes.get("fullCalcOnLoad") in ("1", "true"):
            return {}
        tag = drop_attributes(part.data[named.start : named.head], (b"fullCalcOnLoad",))
        edit = (named.start, named.head, add_attribute(tag, b'fullCalcOnLoad="1"'))
        return {WORKBOOK: apply_edits(part.data, [edit])}
    root = part.elements[0]
    prefix, colon, _ = root.name.rpartition(":")
    before = [one.end for one in part.elements if one.parent == root.name and one.bare in _BEFORE_CALCULATION]
    at = max(before, default=root.head)
    return {WORKBOOK: apply_edits(part.data, [(at, at, f'<{prefix}{colon}calcPr fullCalcOnLoad="1"/>'.encode())])}


def drop_chain(book: Book) -> dict[str, bytes | None]:
    """Return the parts that change as the calculation chain goes, with what refers to it: Excel makes it anew.

    A chain with an entry for a cell without a formula makes Excel repair the file.
    """
    path = book.parts.get("calcChain")
    if path is None:
        return {}
    changed: dict[str, bytes | None] = {path: None}
    for name, tag, attribute in ((TYPES, "Override", "PartName"), (RELATIONS, "Relationship", "Target")):
        part = book.read(SmallPart, name)
        found = [one for one in part.named(tag) if book.find_part("xl", one.attributes.get(attribute, "")) == path]
        if found:
            changed[name] = apply_edits(part.data, [(one.start, one.end, b"") for one in found])
    return changed
