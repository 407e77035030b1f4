"""What the page knows of the sheets and their columns: labels, units, kinds, choices, as the workbook has them."""

import datetime
import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from assess.i18n import gettext, load_catalogue, speaking
from assess.units import QUANTITIES
from assess.workbook.lists import FROZEN, PLACES
from assess.workbook.names import find_live, is_live, split_header, translate, translate_choices
from assess.workbook.open import MAX_ROWS, UNSAVED, Percent
from assess.workbook.parse import Table, Tables
from assess.workbook.plain_rows import column_letters
from assess.workbook.schema import CLASS, GROUPS, ITEMS, SHEETS, WORKING_GROUP, Column, Sheet
from assess.workbook.store import Workbook, Worksheet
from assess.workbook.template import describe
from assess.workbook.values import is_blank, read_text

IMPERIAL = frozenset({"in", "ft", "in/s", "lb", "lbf"})
OWN_WIDTH = 14
"""Width of a column of the user [characters]."""

Shown = float | str | bool | None
"""A cell as the page shows it."""


@dataclass(frozen=True, slots=True)
class PageColumn:
    """One column of a table, or one line of a form.

    * `at`, `row`: the column of its values, from 0; of a line its row, of a column 0.
    * `label`, `unit`: as the header says.
    * `column`: that of the schema, with its label in the workbook's language; None for one of the user or a live one.
    * `live`: of a column that Excel computes its header, of `assess.workbook.schema.LIVE` or `WORKINGS`; else blank.
    * `is_blind`: whether its header lacks a unit that is known, so that its numbers mean nothing.
    * `is_hidden`: whether the workbook hides it.
    """

    at: int
    row: int
    label: str
    unit: str = ""
    column: Column | None = None
    live: str = ""
    is_blind: bool = False
    is_hidden: bool = False

    @property
    def kind(self) -> str:
        """What a cell of it holds, as the page calls it."""
        return self.column.kind if self.column else "live" if self.live else "own"

    def describe(self, language: str) -> dict[str, Any]:
        """Return it as the page takes it, in the language of its sheet; its factor leads to SI, 1 where it is unknown.

        Languages are called by their own names.
        """
        one, catalogue = self.column, load_catalogue(language)
        found: dict[str, Any] = {
            "at": self.at, "field": one.name if one else "class" if self.live == CLASS else "",
            "label": self.label, "unit": self.unit,
            "factor": QUANTITIES.get(one.quantity, {}).get(self.unit, 1.0) if one else 1.0, "kind": self.kind,
            "help": "", "choices": [], "offered": [], "source": "", "required": False, "width": OWN_WIDTH,
            "hidden": self.is_hidden, "group": "", "heading": "",
        }  # fmt: skip
        if one:
            is_named = one.kind in ("choice", "flag")
            with speaking(catalogue):
                found["help"] = describe(one)
            found |= {
                "choices": list(translate_choices(one.choices, language) if is_named else one.choices),
                "offered": list(map(catalogue.find, one.offered)), "source": one.source, "required": one.required,
                "width": one.width,
            }  # fmt: skip
        return {**found, "row": self.row} if self.row else found


@dataclass(frozen=True, slots=True)
class PageSheet:
    """One sheet of the schema in a workbook.

    * `sheet`: with its English name, by which the page calls it.
    * `title`, `language`: as the workbook calls it, and the language of that.
    * `found`: whether it can be read and edited: it is there, and so are the headers of a table.
    * `header`: the row of the headers, 0 for a form.
    * `columns`: by the column of a table, by the row of a form's line.
    """

    sheet: Sheet
    title: str
    language: str
    found: bool = False
    header: int = 0
    columns: Mapping[int, PageColumn] = field(default_factory=dict)

    @property
    def live(self) -> frozenset[int]:
        """The columns that Excel computes."""
        return frozenset(at for at, one in self.columns.items() if one.live)

    def find(self, row: int, at: int) -> PageColumn | None:
        """Return the column of a cell, or the line of a form; None for a cell of neither, as headers are."""
        if self.sheet.layout == "form":
            return self.columns.get(row) if at == 1 else None
        return self.columns.get(at) if row > self.header else None

    def field(self, name: str) -> PageColumn | None:
        """Return the column of a field; None where the workbook lacks it."""
        return next((one for one in self.columns.values() if one.column and one.column.name == name), None)

    def place(self, name: str, row: int) -> tuple[int, int] | None:
        """Return the row and the column of a field of a row; of a form the row does not count."""
        one = self.field(name)
        return None if one is None else (one.row or row, one.at)

    def describe(self, cells: Worksheet | None) -> dict[str, Any]:
        """Return it as the page takes it, with its rows."""
        is_form, live, rows = self.sheet.layout == "form", self.live, list[list[Any]]()
        if cells is not None and self.found:
            numbered = ((number, row) for number, row in cells.cells.items() if self.header < number <= MAX_ROWS)
            rows = [[number, shown] for number, row in numbered if (shown := _show_row(row, live))]
        last = max([self.header, *(one[0] for one in rows[-1:])])
        return {
            "name": self.sheet.name, "title": self.title, "layout": self.sheet.layout, "found": self.found,
            "header_row": self.header, "last_row": last, "capacity": last if is_form else MAX_ROWS,
            "frozen": 0 if is_form else self._count_frozen(),
            "columns": [{**one.describe(self.language), **self._find_group(one)} for one in self.columns.values()],
            "rows": rows,
        }  # fmt: skip

    def _find_group(self, column: PageColumn) -> dict[str, str]:
        """Return the group of a column of Items and its heading; nothing for the user's own, and in other sheets."""
        if self.sheet is not ITEMS or (column.column is None and not column.live):
            return {}
        fields = [one.name for one in self.sheet.columns]
        at = fields.index(column.column.name) if column.column else 0
        group = [name for name, first in GROUPS if fields.index(first) <= at][-1]
        group = WORKING_GROUP if column.live and column.live != CLASS else group
        return {"group": group, "heading": gettext(group)}

    def _count_frozen(self) -> int:
        """Return how many columns at the left stay in view: as in an empty workbook where they stand as there."""
        known = [one for one in self.columns.values() if one.column]
        is_alike = all(PLACES[self.sheet.name, one.column.name] == one.at for one in known if one.column)
        return FROZEN.get(self.sheet.name, 1) if is_alike else 1


# ---------------------------------------------------------------- cells as the page shows them


def show(value: Any) -> Shown:
    """Return a cell as the page shows it: a date as its text, a formula without result as nothing."""
    if value is None or value is UNSAVED:
        return None
    if isinstance(value, datetime.datetime) and value.time() == datetime.time():
        return value.date().isoformat()
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, float) and math.isfinite(value):
        return float(value) if isinstance(value, Percent) else value
    return read_text(value)


_PLAIN = frozenset({int, str, bool, type(None)})


def _show_row(cells: Mapping[int, Any], live: Collection[int]) -> list[Shown]:
    """Return the cells of a row up to the last that is filled; those of live columns are left out."""
    last = max((at for at in cells if at not in live), default=-1)
    row = [None if at in live else cells.get(at) for at in range(last + 1)]
    return [one if type(one) in _PLAIN else show(one) for one in row]


# ---------------------------------------------------------------- finding them


def find_sheets(workbook: Workbook, tables: Tables) -> dict[str, PageSheet]:
    """Return the sheets of the schema with their columns, by their English names."""
    return {sheet.name: _find_sheet(sheet, tables[sheet.name], workbook.sheets.get(sheet.name)) for sheet in SHEETS}


def find_units(sheets: Mapping[str, PageSheet]) -> str:
    """Return in which units most headers of a workbook are: "si" or "imperial"."""
    units = [one.unit for sheet in sheets.values() for one in sheet.columns.values() if one.column and one.unit]
    lengths = [one for one in units if one in IMPERIAL or one in ("mm", "cm", "m", "cm/s", "m/s", "kg", "N", "kN")]
    return "imperial" if 2 * sum(one in IMPERIAL for one in lengths) > len(lengths) else "si"


def _find_sheet(sheet: Sheet, table: Table, cells: Worksheet | None) -> PageSheet:
    language = table.language
    if cells is None:
        return PageSheet(sheet, translate(sheet, language).name, language)
    if sheet.layout == "form":
        lines = {one.row: one for one in _list_lines(table, cells)}
        return PageSheet(sheet, cells.title, language, found=True, columns=lines)
    columns = {one.at: one for one in _list_columns(sheet, table, cells)} if table.header else {}
    return PageSheet(sheet, cells.title, language, found=bool(columns), header=table.header, columns=columns)


def _known(table: Table, name: str, at: int, row: int, label: str, *, is_hidden: bool = False) -> PageColumn:
    text, written = split_header(label)
    is_blind = name in table.blind
    unit = (written or "") if is_blind else table.units.get(name, "")
    return PageColumn(at, row, text, unit, table.sheet.column(name), is_blind=is_blind, is_hidden=is_hidden)


def _list_lines(table: Table, cells: Worksheet) -> Iterator[PageColumn]:
    names = {row: name for name, row in table.places.items()}
    for row, one in cells.cells.items():
        label = one.get(0)
        if row > MAX_ROWS or label is UNSAVED or is_blank(label):
            continue
        text = read_text(label)
        yield _known(table, names[row], 1, row, text) if row in names else PageColumn(1, row, text)


def _list_columns(sheet: Sheet, table: Table, cells: Worksheet) -> Iterator[PageColumn]:
    names = {at: name for name, at in table.places.items()}
    headers = {at: read_text(one) for at, one in cells.cells[table.header].items() if one is not UNSAVED}
    filled = {at for number, row in cells.cells.items() if number > table.header for at in row}
    for at in sorted({at for at, text in headers.items() if text} | filled):
        label, is_hidden = headers.get(at, ""), at in cells.hidden_columns
        text, unit = split_header(label)
        if at in names:
            yield _known(table, names[at], at, 0, label, is_hidden=is_hidden)
        elif label and is_live(sheet, text):
            yield PageColumn(at, 0, text, unit or "", live=find_live(text) or "", is_hidden=is_hidden)
        else:
            yield PageColumn(at, 0, label or column_letters(at), is_hidden=is_hidden)
