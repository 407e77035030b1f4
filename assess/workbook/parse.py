"""Cells to typed rows: every sheet as a table of values in SI, by the fields of `assess.workbook.schema`.

Nothing here changes a row that has been read, and nothing is compared between rows: that is `check` and `resolve`.
Every problem is collected with its cell and reading goes on, so that one run names them all.
"""

import re
from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, groupby, islice
from typing import TYPE_CHECKING, Any, TypeAlias

from assess.errors import Correction, FurnitureGap, Gap, Problem, Severity
from assess.i18n import fill, join, nfill
from assess.units import QUANTITIES, read_unit
from assess.workbook.habits import CellError, name_some, shorten
from assess.workbook.names import ENGLISH, find_column, find_near_column, is_live, plain, split_header, versions
from assess.workbook.open import HEADER_ROWS, MAX_COLUMNS, MAX_ROWS, UNSAVED, Cells, SheetCells
from assess.workbook.plain_rows import column_letters, split_range
from assess.workbook.schema import Column, Sheet
from assess.workbook.values import ERRORS, CellReader, cell_reader, is_blank, read_text

if TYPE_CHECKING:
    from assess.workbook.store import Worksheet

FIRST_COLUMNS = 4
"""A heading stands in one of so many columns from the left."""
_MOST_RANGES = 10
_RANGE = re.compile(r"([A-Z]{1,3})(\d+):([A-Z]{1,3})(\d+)")
_ROWS = re.compile(r"\brow (\d+)|^[A-Z]+(\d+)(?::[A-Z]+(\d+))?$")


class CodeCells:
    """Rows given in code, as the cells of a sheet: keys are fields, in the units of an empty workbook, or headers."""

    header_rows, top, title, kept = 0, "", "", None
    last_row, far = 0, ""
    merged: Sequence[str] = ()
    hidden_rows: Sequence[int] = ()
    hidden_columns: frozenset[int] = frozenset()

    def __init__(self, sheet: Sheet, given: Sequence[Mapping[str, Any]]) -> None:
        self.sheet, self.given = sheet, given
        fields = {column.name: column.header() for column in sheet.columns}
        keys = list(dict.fromkeys(str(name) for row in given for name in row))
        required = [] if given else [column.name for column in sheet.columns if column.required]
        self.keys = keys or required
        self.headers = [fields.get(name, name) for name in self.keys]

    def rows(self) -> Iterator[tuple[int, Cells]]:
        """Yield the headers, then the rows; for a form the lines of its one row."""
        if self.sheet.layout == "form":
            row = self.given[0] if self.given else {}
            yield from ((at, {0: self.headers[at], 1: _native(row[name])}) for at, name in enumerate(self.keys))
            return
        yield 0, dict(enumerate(self.headers))
        for number, given in enumerate(self.given, 1):
            yield number, {at: _native(given[name]) for at, name in enumerate(self.keys) if name in given}

    def address(self, row: int, at: int | None = None) -> str:
        """Return ``row 3 Height``; the header alone for a form and for the headers themselves."""
        if self.sheet.layout == "form":
            return split_header(self.headers[row])[0]
        if at is None or at >= len(self.headers):
            return f"row {row}" if 0 < row <= len(self.given) else ""
        return f"row {row} {split_header(self.headers[at])[0]}" if row else self.headers[at]


def _native(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and value != value else value


Source: TypeAlias = "SheetCells | Worksheet | CodeCells"
"""The cells of one sheet; `last_row`, `far` and `merged` are known once `rows` has ended."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table: its number, its usable values by field (SI), and the texts of the unknown columns."""

    number: int
    values: Mapping[str, Any]
    extra: tuple[str, ...] = ()

    def get(self, name: str) -> Any:
        """Return the value of a field, None where it is blank or could not be read."""
        return self.values.get(name)

    def quote(self, name: str) -> str:
        """Return the value of a field as messages quote it."""
        return shorten(self.values.get(name))


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """One sheet as it was read; a form is a table of one row.

    * `sheet`: With the names that the workbook gives it and its columns; `language` is that of its own name.
    * `places`: In which column of the sheet a field stands, from 0; in which row, for a form.
    * `rows`: Those that hold anything; `extra` are the headers of unknown columns, `header` is the row of the headers,
      0 where none was found and in a form.
    * `blind`: Fields whose header gives no known unit, which has been reported; `units` are those of the others.
    * `failed`: Addresses of the cells that have been reported as wrong.
    """

    sheet: Sheet
    language: str = ENGLISH
    found: bool = False
    places: Mapping[str, int] = field(default_factory=dict)
    rows: tuple[Row, ...] = ()
    extra: tuple[str, ...] = ()
    blind: frozenset[str] = frozenset()
    failed: frozenset[str] = frozenset()
    corrections: tuple[Correction, ...] = ()
    source: "Source | None" = None
    header: int = 0
    units: Mapping[str, str] = field(default_factory=dict)

    def cell(self, name: str, row: int) -> str:
        """Address of a field in a row; the first column where the sheet lacks the field, "" where a form does."""
        if self.source is None or (self.sheet.layout == "form" and name not in self.places):
            return ""
        if self.sheet.layout == "form":
            return self.source.address(self.places[name], 1)
        return self.source.address(row, self.places.get(name))

    @property
    def letters(self) -> dict[str, str]:
        """In which column of the sheet a field stands, by its letters; nothing for a form, or rows built in code."""
        is_file = self.source is not None and self.source.top and self.sheet.layout == "table"
        return {name: column_letters(at) for name, at in self.places.items()} if is_file else {}

    def label(self, name: str) -> str:
        """Return the label of a field as the workbook has it."""
        return self.sheet.column(name).label

    def problem(self, name: str, row: Row, message: str, fix: str = "", severity: Severity = "error") -> Problem:
        """Return a problem of one field of a row."""
        return Problem(severity, self.sheet.name, self.cell(name, row.number), message, fix)

    def habit(self, name: str, row: Row, message: str, fix: str = "", severity: Severity = "error") -> Problem:
        """Return a problem of one field of a row that other rows may have alike: these are shown as one."""
        return replace(self.problem(name, row, message, fix, severity), group=name)

    def problem_at_top(self, message: str, fix: str, severity: Severity = "error") -> Problem:
        """Return a problem of the sheet as a whole, at its first cell."""
        return Problem(severity, self.sheet.name, self.source.top if self.source else "", message, fix)

    def spoilt(self, name: str, row: Row) -> bool:
        """Tell whether a field of a row was filled in but cannot be used, which has been reported."""
        if name in self.blind or not self.failed:
            return name in self.blind
        return name in self.places and self.cell(name, row.number) in self.failed

    def says(self, row: Row, *names: str) -> bool:
        """Tell whether one of these fields is filled in, be it usable or not."""
        return any(row.get(name) is not None or self.spoilt(name, row) for name in names)

    def lacks(self, row: Row, name: str) -> bool:
        """Tell whether a field is blank."""
        return not self.says(row, name)

    def sound(self, name: str, row: Row) -> Any:
        """Return the value of a field that is filled in and can be used, else None."""
        return None if self.spoilt(name, row) else row.get(name)

    def with_all(self, *names: str) -> list[Row]:
        """Return the rows that have these fields; why others lack one has been reported."""
        wanted = {*names}
        return [row for row in self.rows if wanted <= row.values.keys()]

    def kept(self, purpose: str) -> tuple[dict[int, tuple[Any, Any, Any]], frozenset[int]]:
        """Return what an earlier reading made of rows for a purpose, by their number, and the rows that have errors.

        It may be taken where the row is the very same, what else it rests on is equal, and the row has no error.
        """
        held = None if self.source is None else self.source.kept
        found = {} if held is None or self.blind else held.made.setdefault(purpose, {})
        return found, frozenset(number for cell in self.failed for number in row_numbers(cell))

    def with_failed(self, problems: Sequence[Problem]) -> "Table":
        """Return the table with the cells of errors noted."""
        cells = {one.cell for one in problems if one.severity == "error" and one.sheet == self.sheet.name}
        return replace(self, failed=self.failed | cells) if cells - self.failed else self


def first_row(cell: str) -> int:
    """Return the number of the first row that an address names, 0 for none."""
    return next(iter(row_numbers(cell)), 0)


def row_numbers(cell: str) -> range:
    """Return the numbers of the rows that an address names."""
    if (found := _ROWS.search(cell)) is None:
        return range(0)
    first = int(found[1] or found[2])
    return range(first, int(found[3] or first) + 1)


Tables = Mapping[str, Table]
"""The tables by the English names of their sheets."""


def parse_sheet(english: Sheet, own: Sheet, language: str, source: Source) -> tuple[Table, list[Problem]]:
    """Read a sheet: `english` with its English names, `own` with the name and the labels of its `language`."""
    parser = _Parser(english, own, source)
    rows = parser.read_form() if own.layout == "form" else parser.read_table()
    if source.last_row > MAX_ROWS or source.far:
        cell, fix = source.far, fill("Delete the columns right of the table.")
        message = fill("a value far to the right of the table; at most {most} columns are read.", most=MAX_COLUMNS)
        if source.last_row > MAX_ROWS:
            cell, fix = source.address(source.last_row), fill("Delete the rows below the table.")
            message = fill("a value far below the table; at most {most:,} rows are read.", most=MAX_ROWS)
        problems = [Problem("error", own.name, cell, message, fix)]
        return Table(sheet=own, language=language, found=True, source=source).with_failed(problems), problems
    named = {column.name: column for column in parser.headers.values()}
    sheet = replace(own, columns=tuple(named.get(column.name, column) for column in own.columns))
    table = Table(sheet=sheet, language=language, found=True, source=source, places=parser.places, rows=tuple(rows),
                  extra=tuple(parser.others.values()), blind=frozenset(parser.blind), failed=frozenset(parser.covered),
                  corrections=tuple(parser.corrections), header=parser.header, units=parser.units)  # fmt: skip
    return table.with_failed(parser.problems), parser.problems


class _Parser:
    def __init__(self, english: Sheet, own: Sheet, source: Source) -> None:
        self.english, self.own, self.source = english, own, source
        self.problems: list[Problem] = []
        self.corrections: list[Correction] = []
        self.headers: dict[str, Column] = {}  # by the address of the header
        self.columns: dict[int, Column] = {}
        self.others: dict[int, str] = {}
        self.required: set[int] = set()
        self.places: dict[str, int] = {}
        self.units: dict[str, str] = {}
        self.readers: dict[str, CellReader] = {}
        self.blind: set[str] = set()
        self.covered: list[str] = []  # addresses of the cells that a reported merge hides
        self.header = 0

    def report(self, cell: str, message: str, fix: str = "", severity: Severity = "error", group: str = "") -> None:
        self.problems.append(Problem(severity, self.own.name, cell, message, fix, group))

    def read_form(self) -> list[Row]:
        values: dict[str, Any] = {}
        for number, cells in self.source.rows():
            header, value = _shown(cells.get(0)), cells.get(1)
            if is_blank(header):
                continue
            cell, text = self.source.address(number, 0), read_text(header)
            column, is_wrong = self._match(text, cell)
            if column:
                self.places[column.name] = number
                if (found := self._value(column, value, number, 1)) is not None:
                    values[column.name] = found
            elif value is not None and not is_wrong:
                message = fill("{name} is not known; it is not used.", name=shorten(text))
                self.report(cell, message, severity="note")
        return [Row(0, values)]

    def read_table(self) -> list[Row]:
        rows = self.source.rows()
        top = list(islice(rows, HEADER_ROWS))  # rows without cells are not among them
        candidates = [one for one in top if one[0] <= self.source.header_rows]
        labels = [[plain(split_header(str(value))[0]) for value in cells.values()] for _, cells in candidates]
        body, known, best = chain(top, rows), set[str](), None
        for version in versions(self.english):
            known |= {plain(label) for column in version.columns for label in column.labels}
            scores = [sum(label in known for label in own) for own in labels]
            best = scores.index(max(scores)) if any(scores) else None
            if best is not None and {plain(one.label) for one in version.columns if one.required} <= {*labels[best]}:
                break
        if best is None:
            if self.own.required or candidates:
                needed = [column.header() for column in self.own.columns if column.required]
                message = fill("no header row was found in the first {rows} rows.", rows=HEADER_ROWS)
                fix = fill("It needs the headers: {headers}.", headers=", ".join(needed))
                self.report(self.source.top, message, fix)
            for _ in body:  # the rest is read for the bounds of the sheet
                pass
            return []
        self.header, headers = candidates[best]
        self._read_headers(headers)
        if self.source.kept is not None:
            self.source.kept.serve((self.columns, self.others, self.units, self.blind))
        found = self._read_rows(headers, body)
        self._check_merged([self.header, *(row.number for row in found)])
        self._note_hidden(found)
        if self.own.required and not found and not self._missing():
            # a building may have no furniture, yet no report can do without a floor
            cell, fix = self.source.address(self.header + 1), fill("Fill in at least one.")
            if self.own.columns[0].name == "item":
                message = fill("the table has no rows: nothing is assessed.")
                self.problems.append(FurnitureGap("warning", self.own.name, cell, message, fix))
            else:
                self.problems.append(Gap("error", self.own.name, cell, fill("the table has no rows."), fix))
        return found

    def _read_rows(self, headers: Cells, body: Iterable[tuple[int, Cells]]) -> list[Row]:
        """Return the rows that are entries; those that hold a text alone only where a table asks for no more."""
        known, first = {*self.columns, *self.others}, sorted(self.columns)[:FIRST_COLUMNS]
        header, needed, kept = self.header, sorted(self.required), self.source.kept
        found: dict[int, Row | None] = {}
        lone: dict[int, tuple[int, Cells]] = {}
        for number, cells in body:
            if not header < number <= MAX_ROWS:
                continue
            if (at := find_lone_text(cells, known, first)) is not None:
                lone[number] = at, cells
            elif (
                needed
                and cells.get(needed[0]) == headers[needed[0]]
                and all(cells.get(at) == headers[at] for at in needed)
                and sum(headers.get(at) == value for at, value in cells.items()) > 1
            ):
                message = nfill("the row repeats the headers; it is skipped.",
                                "{n:,} rows repeat the headers; they are skipped ({cells}).", 1, cells="")  # fmt: skip
                self.report(self.source.address(number, needed[0]), message, "", "note", "headers")
            elif kept is None:
                found[number] = self._row(number, cells)
            elif (known_row := kept.rows.get(number)) is not None and known_row[0] is cells:  # from an earlier reading
                found[number] = known_row[1]
                self.problems += known_row[2]
                self.corrections += known_row[3]
            else:
                reported, corrected = len(self.problems), len(self.corrections)
                row = found[number] = self._row(number, cells)
                kept.rows[number] = cells, row, self.problems[reported:], self.corrections[corrected:]
        ranges = (match for one in self.source.merged if (match := _RANGE.fullmatch(one)))
        spanned = {int(one[2]) for one in ranges if one[1] != one[3] and one[2] == one[4]}
        needs_more = sum(column.required for column in self.own.columns) > 1
        for number, (at, cells) in lone.items():
            if self.source.top and (needs_more or number in spanned):
                message = nfill(
                    "{text} stands alone in its row; it is taken for a heading and skipped.",
                    "{n:,} rows hold a text alone, such as {text}; they are taken for headings and skipped ({cells}).",
                    1, text=shorten(cells[at]), cells="",
                )  # fmt: skip
                self.report(self.source.address(number, at), message, "", "note", "heading")
            else:
                found[number] = self._row(number, cells)
        return [row for _, row in sorted(found.items()) if row]

    def _check_merged(self, rows: Sequence[int]) -> None:
        """Report merged cells in these rows; that the cells which a merge hides are blank is no error of its own."""
        for reference in self.source.merged:
            merged = row_numbers(reference)
            at = bisect_left(rows, merged.start)
            if at == len(rows) or rows[at] >= merged.stop:
                continue
            message = fill("cells are merged inside the table.")
            self.report(reference, message, fill("Unmerge them and fill each cell."))
            own, span = rows[at : bisect_left(rows, merged.stop)], split_range(reference)
            if span is not None and len(self.covered) + len(own) * len(self.columns) <= MAX_ROWS:
                left, right, top, _ = span
                cells = ((row, at) for row in own for at in self.columns if left <= at + 1 <= right)
                self.covered += [self.source.address(*one) for one in cells if one != (top, left - 1)]
        covered = set(self.covered)
        self.problems = [one for one in self.problems if one.severity != "error" or one.cell not in covered]

    def _note_hidden(self, found: Sequence[Row]) -> None:
        hidden = set(self.source.hidden_rows)
        rows = [row.number for row in found if row.number in hidden] if hidden else []
        if rows:
            runs = [[number for _, number in run] for _, run in groupby(enumerate(rows), lambda one: one[1] - one[0])]
            ranges = [
                str(run[0]) if len(run) == 1 else fill("{first} to {last}", first=str(run[0]), last=str(run[-1]))
                for run in runs
            ]
            named = {"rows": name_some(ranges, _MOST_RANGES)}
            message = nfill(
                "hidden row {rows} is read as well.", "{n:,} hidden rows are read as well: {rows}.", len(rows), **named
            )
            if self.own.columns[0].name == "item":
                message = nfill("hidden row {rows} is assessed as well.",
                                "{n:,} hidden rows are assessed as well: {rows}.", len(rows), **named)  # fmt: skip
            self.report(self.source.address(rows[0]), message, severity="note")
        columns = [at for at in sorted(self.columns) if at in self.source.hidden_columns]
        names = {at: self.columns[at].name for at in columns}
        filled = [at for at in columns if any(row.get(names[at]) is not None for row in found)]
        if filled:
            labels = join(", ", [fill(self.columns[at].label) for at in filled])
            message = nfill("the hidden column {labels} is read as well.",
                            "{n:,} hidden columns are read as well: {labels}.", len(filled), labels=labels)  # fmt: skip
            self.report(f"{column_letters(filled[0])}1", message, severity="note")

    def _read_headers(self, cells: Cells) -> None:
        texts = {at: read_text(value) for at, value in sorted(cells.items()) if _shown(value) is not None}
        labels = {plain(split_header(text)[0]) for text in texts.values()}
        for at, text in texts.items():
            if not text or is_live(self.english, split_header(text)[0]):
                continue
            cell = self.source.address(self.header, at)
            column, is_wrong = self._match(text, cell, labels)
            if column:
                self.columns[at], self.places[column.name] = column, at
                if column.required:
                    self.required.add(at)
            elif not is_wrong:
                self.others[at] = text
                message = fill("the column {name} is not known; it is kept, not used.", name=shorten(text))
                self.report(cell, message, severity="note")
        for column in self._missing():
            message = fill("the column {header} is missing.", header=column.header())
            self.report(self.source.address(self.header), message, fill("Add it to the header row."))

    def _missing(self) -> list[Column]:
        found = {column.name for column in self.headers.values()}
        return [column for column in self.own.columns if column.required and column.name not in found]

    def _match(self, header: str, cell: str, labels: set[str] | None = None) -> tuple[Column | None, bool]:
        is_line = self.own.layout == "form"
        label, unit = split_header(header)
        column = find_column(self.english, label)
        if column is None:
            near = find_near_column(self.english, self.own, header, labels or set())
            if near:
                unknown = fill("the line {name} is not known.", name=shorten(header))
                if not is_line:
                    unknown = fill("the column {name} is not known.", name=shorten(header))
                self.report(cell, unknown, fill("Did you mean {name}?", name=near.header()))
            return None, near is not None
        also = next((place for place, one in self.headers.items() if one.name == column.name), None)
        if also is not None:
            twice = fill("duplicate line {label}, also in {cell}.", label=column.label, cell=also)
            if not is_line:
                twice = fill("duplicate column {label}, also in {cell}.", label=column.label, cell=also)
            self.report(cell, twice, fill("Delete one of them."))
            return None, True
        self.headers[cell], spelt = column, read_unit(unit or "")
        self.units[column.name] = spelt if column.quantity else ""
        self.readers[column.name] = cell_reader(column, self.units[column.name])
        if column.quantity and spelt not in QUANTITIES[column.quantity]:
            self.blind.add(column.name)
            wrong = fill("{label} has no unit.", label=column.label)
            if unit is not None:
                wrong = fill("the unit {unit} of {label} is not known.", unit=shorten(unit), label=column.label)
            values = {"header": column.header(), "units": ", ".join(QUANTITIES[column.quantity])}
            fix = fill("Write the unit that the numbers are in, such as {header}; known units: {units}.", **values)
            self.report(cell, wrong, fix)
        return column, False

    def _row(self, number: int, cells: Cells) -> Row | None:
        columns = self.columns
        if all(is_blank(value) for at, value in cells.items() if at in columns):
            stray = next((at for at in self.others if not is_blank(_shown(cells.get(at)))), None)
            if stray is not None:
                message = fill("stands in a row without an entry; the row is left out.")
                self.report(self.source.address(number, stray), message, severity="warning")
            return None
        shown = [_shown(cells.get(at)) for at in self.others]
        extra = tuple(["" if is_blank(value) else read_text(value) for value in shown])
        values = {}
        for at in cells if self.required <= cells.keys() else columns:
            if at in columns and (value := self._value(columns[at], cells.get(at), number, at)) is not None:
                values[columns[at].name] = value
        return Row(number, values, extra)

    def _value(self, column: Column, value: Any, number: int, at: int) -> Any:
        if value is None and not column.required:
            return None
        if self.blind and column.name in self.blind and value is not UNSAVED:
            return None  # the unit in the header is not known, and has been reported there
        try:
            found, remarks = self.readers[column.name](value)
        except CellError as error:
            self.report(self.source.address(number, at), error.message, error.fix, group=column.name)
            return None
        for remark in remarks:
            cell = self.source.address(number, at)
            group = f"{column.name}: {remark.habit}" if remark.habit else column.name
            self.report(cell, remark.message, remark.fix, remark.severity, group)
            if remark.value is not None and self.source.title:
                self.corrections.append(Correction(self.source.title, cell, str(value), remark.value, remark.why))
        if found is None and column.required:
            message = fill("{label} is blank.", label=column.label)
            fix = fill("Fill it in, or delete the row.")
            self.report(self.source.address(number, at), message, fix, group=column.name)
        return found


def _shown(value: Any) -> Any:
    return None if value is UNSAVED else value


def find_lone_text(cells: Cells, known: Collection[int], first: Collection[int]) -> int | None:
    """Return the column of the only filled cell of the `known`, if one of the `first` and words; else None."""
    filled = None
    for at, value in cells.items():
        if at in known and not is_blank(value):
            if filled is not None:
                return None
            filled = at
    value = cells.get(filled) if filled in first and filled is not None else None
    is_text = isinstance(value, str) and value.strip() not in ERRORS and any(map(str.isalpha, value))
    return filled if is_text else None
