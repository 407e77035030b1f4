"""Cells of an .xlsx set by editing the bytes of its sheets: whatever is not changed stays as it was, to the byte.

Loading a workbook in a library and saving it again loses what the library does not know: pictures, threaded comments,
sparklines, the stored results of formulas. Here the places of the cells are found in the XML of their sheet, and
only those bytes are replaced; every other part of the zip keeps its bytes, name, date and place. Office Open XML:
ECMA-376 Part 1, 18.3 (worksheets), 18.6 (calculation chain), 22.9.2.19 (ST_Xstring).
"""

import io
import posixpath
import re
import zipfile
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill
from assess.progress import SILENT, Progress
from assess.workbook.open import (
    RELATIONS,
    SHEET_COLUMNS,
    SHEET_ROWS,
    TYPES,
    WORKBOOK,
    Book,
    Tree,
    decode_text,
    unreadable,
)
from assess.workbook.places import (
    CellPlace,
    Edit,
    RowPlace,
    SheetPlaces,
    SmallPart,
    add_attribute,
    apply_edits,
    drop_attributes,
    open_tag,
)
from assess.workbook.plain_rows import column_letters, split_address, split_range

Value = float | str | bool | None
"""What a cell may hold; None leaves it blank."""
Area = tuple[int, int, int, int]
"""First and last column, first and last row of cells, from 1."""
Values = Mapping[str, Value]
"""Values by the addresses of cells, ``{"H14": 45.0}``."""

LONGEST_TEXT = 32_767
"""Characters that a cell of a spreadsheet program holds."""
LARGEST_NUMBER = 9.99999999999999e307
"""The largest number that a cell holds."""
MOST_CHECKED = 4 * 2**20
"""Bytes up to which a sheet is read, before it is changed, to see whether it can be."""
_UNWRITABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]|_(?=x[0-9A-Fa-f]{4}_)")
LOCKED = {"dataTable": fill("it belongs to a data table."), "array": fill("it belongs to an array formula.")}
"""Why no cell of a formula of several cells is changed by itself."""
_HEADER = fill("it is a header of a table.")
_CONTENT = frozenset({"f", "v", "is"})
_LEVEL = 6


@dataclass(frozen=True, slots=True)
class Patched:
    """A workbook with cells changed: its bytes, and sheet and address of each formula that a value replaced."""

    data: bytes
    formulas: tuple[tuple[str, str], ...] = ()


def patch_workbook(
    data: bytes,
    changes: Mapping[str, Values],
    results: Mapping[str, Values] | None = None,
    *,
    name: str = "workbook.xlsx",
    progress: Progress = SILENT,
) -> Patched:
    """Set cells of a workbook and leave every other byte of its parts as it is.

    * `data`: The .xlsx or .xlsm.
    * `changes`: The values by the workbook's own names of its sheets and the addresses of cells. A cell keeps its
      format; a formula in it is replaced; None leaves it blank. A cell or row that is missing is added in its place,
      with the format of its row or column.
    * `results`: Likewise the stored results of formulas, which stay; None takes the result out, so that every program
      computes it when it opens the workbook.
    * `name`: How messages call the workbook.
    * `progress`: Checked while it is read.

    The same values set again give the same bytes. Where anything changed, programs are asked to recalculate the
    workbook when they open it.

    Raises WorkbookError if it cannot be opened, or if something in it cannot be changed with certainty; nothing is
    changed then. The problems name every cell that is refused: one where a formula of several cells begins, one of an
    array or data table, a header of a table, a value that a cell cannot hold.
    """
    kept = {sheet: values for sheet, values in (results or {}).items() if values}
    wanted = {sheet: values for sheet, values in changes.items() if values}
    with Book(data, name, progress) as book:
        _check_names(book, [*wanted, *kept])
        parts: dict[str, bytes | None] = {}
        formulas: list[tuple[str, str]] = []
        problems: list[Problem] = []
        for sheet in dict.fromkeys([*wanted, *kept]):
            one = _SheetPatch(book, sheet, wanted.get(sheet, {}), kept.get(sheet, {}))
            parts[book.sheets[sheet]] = one.write()
            formulas += [(sheet, address) for address in one.formulas]
            problems += one.problems
        if problems:
            raise WorkbookError(problems)
        if not parts:
            return Patched(data)
        parts |= set_recalculation(book)
        parts |= drop_from_chain(book, formulas)
        return Patched(_pack(book, parts), tuple(formulas))


def find_headers(data: bytes, sheet: str, *, name: str = "workbook.xlsx") -> list[tuple[Area, Text]]:
    """Return the cells of a sheet that `patch_workbook` refuses to change since they are headers of tables, with why.

    Raises WorkbookError if the workbook cannot be opened, or if the sheet cannot be changed at all. Of a large sheet
    this shows only when it is changed.
    """
    with Book(data, name) as book:
        _check_names(book, [sheet])
        path = book.sheets[sheet]
        if book.archive.getinfo(path).file_size <= MOST_CHECKED:
            _ = SheetPlaces(book.archive, path, name, {}, SILENT).read().sheet_data
        return [((left, right, top, top), _HEADER) for left, right, top in find_headings(book, path)]


def _check_names(book: Book, names: Sequence[str]) -> None:
    missing = [one for one in names if one not in book.sheets]
    if missing:
        raise WorkbookError([Problem("error", one, "", fill("the sheet is missing.")) for one in missing])
    if any(part.startswith("_xmlsignatures/") for part in book.archive.namelist()):
        message = fill("{name} is digitally signed; a change would break the signature.", name=book.name)
        raise unreadable(message, fill("Save it from Excel without the signature."))


# ---------------------------------------------------------------- one sheet


@dataclass(slots=True)
class _SheetPatch:
    book: Book
    sheet: str
    changes: Values
    results: Values
    formulas: list[str] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    def write(self) -> bytes:
        """Return the bytes of the sheet with the changes made; `problems` tells what is refused."""
        changes, results = self._by_row(self.changes), self._by_row(self.results)
        book, path = self.book, self.book.sheets[self.sheet]
        wanted = {number: {*changes.get(number, ()), *results.get(number, ())} for number in {*changes, *results}}
        headings = find_headings(book, path)
        places = SheetPlaces(book.archive, path, book.name, wanted, book.progress).read()
        edits: list[Edit] = []
        new_rows: list[tuple[int, bytes]] = []
        added: list[tuple[int, int]] = []
        for number in sorted(wanted):
            values = changes.get(number, {})
            for column in values:
                address = f"{column_letters(column - 1)}{number}"
                for (left, right, top, bottom), kind in places.locked:
                    if left <= column <= right and top <= number <= bottom:
                        self._refuse(address, LOCKED[kind])
                if any(left <= column <= right and number == top for left, right, top in headings):
                    self._refuse(address, _HEADER)
            row = places.rows.get(number)
            one = _RowPatch(places, number, row, values, results.get(number, {}))
            if row is None:
                new_rows += [(number, text)] if (text := one.write_new()) else []
            else:
                edits += one.edit(row)
            self.formulas += one.formulas
            added += [(column, number) for column in one.added]
            for refused, why in one.refused:
                self._refuse(f"{column_letters(refused - 1)}{one.number}", why)
        edits += _insert_rows(places, new_rows)
        edits += _widen(places, added)
        return apply_edits(places.data, edits)

    def _by_row(self, values: Values) -> dict[int, dict[int, Value]]:
        found: dict[int, dict[int, Value]] = {}
        for address, value in values.items():
            place = split_address(address)
            if place is None or place[0] > SHEET_COLUMNS or place[1] > SHEET_ROWS:
                self._refuse(address, fill("{address} is no cell of a sheet.", address=address[:20]))
                continue
            if isinstance(value, str) and len(value) > LONGEST_TEXT:
                message = fill("the text is longer than a cell holds: {most:,} characters.", most=LONGEST_TEXT)
                self._refuse(address, message)
            elif isinstance(value, int | float) and not abs(value) <= LARGEST_NUMBER:
                self._refuse(address, fill("the value is not a number that a cell holds."))
            else:
                found.setdefault(place[1], {})[place[0]] = value
        return found

    def _refuse(self, address: str, message: str) -> None:
        fix = fill("Change this cell in Excel.")
        self.problems.append(Problem("error", self.sheet, address, message, fix))


@dataclass(slots=True)
class _RowPatch:
    places: SheetPlaces
    number: int
    row: RowPlace | None
    values: Mapping[int, Value]
    results: Mapping[int, Value]
    formulas: list[str] = field(default_factory=list)
    added: list[int] = field(default_factory=list)
    refused: list[tuple[int, str]] = field(default_factory=list)

    def write_new(self) -> bytes:
        """Return a row that the sheet lacks; nothing where it would be blank."""
        self.refused += [(column, fill("it holds no formula.")) for column in self.results]
        cells = b"".join(self._new_cell(column) for column, value in sorted(self.values.items()) if value is not None)
        p = self.places.prefix
        return b'<%brow r="%d">%b</%brow>' % (p, self.number, cells, p) if cells else b""

    def edit(self, row: RowPlace) -> list[Edit]:
        """Return the edits of a row that is there."""
        edits: list[Edit] = []
        new: list[tuple[int, bytes]] = []
        for column, value in sorted(self.values.items()):
            cell = row.cells.get(column)
            if cell is not None:
                edits.append((cell.element.start, cell.element.end, self._changed_cell(cell, value)))
            elif value is not None:
                new.append((self._place_after(row, column), self._new_cell(column)))
        for column, value in sorted(self.results.items()):
            cell = row.cells.get(column)
            formula = cell.part("f") if cell is not None and column not in self.values else None
            if cell is None or formula is None:
                self.refused.append((column, fill("it holds no formula.")))
            else:
                kept = self.places.data[formula.start : formula.end]
                text = _write_cell(self.places.prefix, self._tag(cell, keeps=True), value, kept)
                edits.append((cell.element.start, cell.element.end, text))
        return edits + self._insert(row, new)

    def _insert(self, row: RowPlace, new: Sequence[tuple[int, bytes]]) -> list[Edit]:
        if not new:
            return []
        one, data = row.element, self.places.data
        tag = data[one.start : one.head]
        spans = [split.partition(":") for split in one.attributes.get("spans", "").split()]
        inside = [range(int(first), int(last) + 1) for first, _, last in spans]
        wrong = any(not any(column in span for span in inside) for column in self.added)
        changed = drop_attributes(tag, (b"spans",)) if wrong else tag
        if tag.endswith(b"/>"):
            cells = b"".join(text for _, text in new)
            return [(one.start, one.head, open_tag(changed) + cells + b"</%brow>" % self.places.prefix)]
        return [(one.start, one.head, changed), *((at, at, text) for at, text in new)]

    def _place_after(self, row: RowPlace, column: int) -> int:
        return next((start for at, start in row.starts if at > column), row.element.foot)

    def _new_cell(self, column: int) -> bytes:
        self.added.append(column)
        p, address = self.places.prefix, f"{column_letters(column - 1)}{self.number}".encode()
        style = self._style(column)
        tag = b'<%bc r="%b"%b>' % (p, address, b' s="%b"' % style.encode() if style else b"")
        return _write_cell(p, tag, self.values[column])

    def _style(self, column: int) -> str:
        """Return the style that a new cell takes over from its row or column, as in spreadsheet programs."""
        of_row = self.row.element.attributes if self.row else {}
        if of_row.get("customFormat") in ("1", "true") and of_row.get("s", "").isdigit():
            return of_row["s"]
        found = (style for first, last, style in self.places.columns if first <= column <= last)
        return next((style for style in found if style.isdigit() and int(style)), "")

    def _changed_cell(self, cell: CellPlace, value: Value) -> bytes:
        formula = cell.part("f")
        if formula is not None:
            self.formulas.append(f"{column_letters(cell.column - 1)}{self.number}")
            if formula.attributes.get("t") == "shared" and "ref" in formula.attributes:
                self.refused.append((cell.column, fill("its formula is shared by other cells.")))
        return _write_cell(self.places.prefix, self._tag(cell), value)

    def _tag(self, cell: CellPlace, *, keeps: bool = False) -> bytes:
        known = {f"{self.places.prefix.decode()}{name}" for name in _CONTENT}
        unknown = [one.name for one in cell.parts if one.name not in known]
        if unknown:
            self.refused.append((cell.column, fill("it holds {element}, which is not known.", element=unknown[0][:40])))
        tag = self.places.data[cell.element.start : cell.element.head]
        return open_tag(drop_attributes(tag, (b"t",) if keeps else (b"t", b"cm", b"vm")))


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


def _pack(book: Book, parts: Mapping[str, bytes | None]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=_LEVEL) as out:
        out.comment = book.archive.comment
        for info in book.archive.infolist():
            book.progress.check()
            content = parts.get(info.filename, b"") if info.filename in parts else book.archive.read(info)
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
    root = part.elements[-1]
    prefix, colon, _ = root.name.rpartition(":")
    before = [
        one.end
        for one in part.elements
        if one.parent == root.name and one.name.rpartition(":")[2] in _BEFORE_CALCULATION
    ]
    at = max(before, default=root.head)
    return {WORKBOOK: apply_edits(part.data, [(at, at, f'<{prefix}{colon}calcPr fullCalcOnLoad="1"/>'.encode())])}


def drop_from_chain(book: Book, formulas: Sequence[tuple[str, str]]) -> dict[str, bytes | None]:
    """Return the parts that change when cells lose their formulas: the calculation chain loses their entries.

    A chain with an entry for a cell without a formula makes Excel repair the file. One that would be empty is left
    out, with what refers to it. An entry without a sheet is on the sheet of the one before it.
    """
    path = book.parts.get("calcChain")
    if path is None or not formulas:
        return {}
    part = book.read(SmallPart, path)
    gone = {(book.sheet_ids[sheet], address) for sheet, address in formulas}
    edits, kept = _edit_chain(part, gone)
    if kept:
        return {path: apply_edits(part.data, edits)} if edits else {}
    return {path: None, **_drop_references(book, path)}


def _edit_chain(part: SmallPart, gone: Collection[tuple[str, str]]) -> tuple[list[Edit], int]:
    edits: list[Edit] = []
    sheet = written = "0"
    kept = 0
    for one in part.named("c"):
        sheet = one.attributes.get("i", sheet)
        if (sheet, one.attributes.get("r", "")) in gone:
            edits.append((one.start, one.end, b""))
            continue
        kept += 1
        if "i" not in one.attributes and sheet != written:
            tag = part.data[one.start : one.head]
            edits.append((one.start, one.head, add_attribute(tag, f'i="{sheet}"'.encode())))
        written = sheet
    return edits, kept


def _drop_references(book: Book, path: str) -> Mapping[str, bytes]:
    changed = {}
    for name, tag, attribute in ((TYPES, "Override", "PartName"), (RELATIONS, "Relationship", "Target")):
        part = book.read(SmallPart, name)
        found = [one for one in part.named(tag) if book.find_part("xl", one.attributes.get(attribute, "")) == path]
        if found:
            changed[name] = apply_edits(part.data, [(one.start, one.end, b"") for one in found])
    return changed


def find_headings(book: Book, path: str) -> list[tuple[int, int, int]]:
    """Return first and last column and the row of the headers of each table of a sheet.

    A table keeps a copy of its headers; where they differ, Excel repairs the file.
    """
    return [span[:3] for span, table in _list_tables(book, path) if table.get("headerRowCount", "1") != "0"]


def find_totals(data: bytes, sheet: str, name: str) -> list[int]:
    """Return the rows of a sheet that are totals rows of tables; WorkbookError if the workbook cannot be opened."""
    with Book(data, name) as book:
        tables = _list_tables(book, book.sheets[sheet]) if sheet in book.sheets else []
    return [
        row
        for (_, _, _, bottom), table in tables
        if (count := table.get("totalsRowCount", "0")).isdigit()
        for row in range(bottom - int(count) + 1, bottom + 1)
    ]


def _list_tables(book: Book, path: str) -> list[tuple[tuple[int, int, int, int], Mapping[str, str]]]:
    folder, name = posixpath.split(path)
    relations = book.find_part(folder, f"_rels/{name}.rels")
    if relations is None:
        return []
    found: list[tuple[tuple[int, int, int, int], Mapping[str, str]]] = []
    for one in book.read(Tree, relations).find("Relationship"):
        target = book.find_part(folder, one.get("Target", ""))
        if one.get("Type", "").endswith("/table") and target is not None:
            for table in book.read(Tree, target).find("table"):
                span = split_range(table.get("ref", ""))
                if span is not None:
                    found.append((span, table))
    return found
