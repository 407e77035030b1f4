"""The workbook that `assess new` writes: drop-downs, units, help, and columns that compute as one types.

Everything is derived from `schema`; the sheet Lists, which drop-downs and formulas refer to, is written by `lists`.

Formulas stand in the first `ROWS` of Items; drop-downs and colours go on to `CHECKED`, which costs nothing. A workbook
opens and is read the faster the fewer cells it holds, and most have some dozens of rows. Whoever fills in more copies
the formulas down: they refer to their own row and to names only, Help says so, and a filled row without them turns
red. A table of Excel would extend them by itself, but only there; and it asks that its part of the file repeats every
header, so that a header edited by another program, as when a unit is changed, makes Excel call the file damaged.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from itertools import product
from pathlib import Path
from typing import Any

from assess.i18n import gettext
from assess.risk import LIMITS, RiskClass
from assess.workbook.catalogue import read_catalogue
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, write_plainly
from assess.workbook.lists import FROZEN, LETTERS, PLACES, ROW, ROWS, ListsWriter, Units
from assess.workbook.live_row import list_live
from assess.workbook.names import translate_header
from assess.workbook.schema import CATALOGUE, CLASS, CLASS_OR, HELP, ITEMS, LISTS, LIVE, SHEETS, WORKINGS, Column
from assess.workbook.walk_down import write_walk_down
from assess.workbook.writer import write_book

__all__ = ["ROWS", "Content", "Rows", "Units", "describe", "write_workbook"]
Rows = Sequence[Mapping[str, Any]]
TITLE = "Furniture in earthquakes: how to fill this in"
HEADS = ("Sheet", "Column", "What to fill in")
FIRST_LINES = (
    "1. Building: what you know of the building and the earthquake. Every line may stay blank.",
    "2. Floors: one row a floor with furniture. Give its peak floor acceleration (PFA), or name the file of a recorded "
    "motion that lies beside this workbook. Where you know neither, give the floor's Elevation: its motion is then "
    "interpolated between the floors above and below, which may be lower than the truth, or worked out from Ground "
    "PGA in Building. Where you do not know that either, choose an intensity in Shaking in Building.",
    "3. Items: one row a piece, or a row for several alike. Choose a Type, and its sizes come from the Catalogue; or "
    "type the sizes. Class (formula), next to Item, shows the risk class at once; the grey columns at the right show "
    "where it comes from.",
    "4. Places and Routes are for evacuation routes and may stay empty.",
    "5. Check it with: assess check FILE.xlsx. Make the report with: assess run FILE.xlsx.",
    "The unit in the bracket of a header is the unit of the column: write Height [mm] or Height [in], and numbers "
    "below are read as such. Lengths: mm, cm, m, in, ft; accelerations: g, m/s2, cm/s2, gal; velocities: cm/s, m/s, "
    "in/s.",
    "Items has formulas in its first {rows} rows. To fill in more, copy Class (formula) and the grey columns at the "
    "right down from the row above. The program reads every row, with formulas or without.",
    "Columns may stand in any order, and you may add your own: they are kept and come back in the Excel report. "
    "Columns marked * are required.",
    "The classes: ○ low below {low:g} %, ◇ medium below {medium:g} %, ▲ high below {high:g} %, ■ very high from "
    "{high:g} % chance of overturning in this scenario, not per year. A * behind a class: outside the range in which "
    "the formula was checked by tests.",
    "Words in place of a class: needs shaking: nothing tells how the floor shakes: fill in its PFA, or choose Shaking "
    "in Building. run assess: assess run works out the motion of the floor, from a record, from other floors or from "
    "the ground. check: a cell holds a text, or a number out of range, or Breadth is above Width: nothing is computed "
    "with it here; assess check tells which cell, and its option fix writes a copy in which such cells are corrected "
    "where they can be read in one way only. floor?, axis?, type?, unit?: the floor, the axis, the type or the unit "
    "of a header is not known.",
)
CLASS_NOTE = (
    "Computed by Excel from this row, by the formula that Class by in Building chooses. {mark} behind a class: outside "
    "the range in which the formula was checked. needs shaking: nothing tells how the floor shakes. run assess: only "
    "assess run can tell. check: a cell holds a text, or a number out of range; assess check tells which, and may "
    "take it all the same."
)
ROCK_NOTE = (
    "Whether the piece can start to rock in an earthquake like this one, if it is as strong as is taken into account "
    "(Motion uncertainty in Building). no: simulation will find the class low, whatever the formula gives here."
)
FOOTER = "&C&A, page &P of &N"
"""In the spreadsheet program's own signs: centred, the sheet's name, its page and the number of pages."""
COPY_TITLE = "No formula in this row"
COPY_NOTE = (
    "Copy the cell above down to here, and the grey columns at the right with it. The program reads the row all the "
    "same."
)
"""Input message of the class below the last row that has formulas."""
CHECKED = {ITEMS.name: 2000}
"""Rows that have drop-downs and colours, where these are more than `ROWS`."""
_LIVE_FORMATS = {
    "B/H": "0.000", "PFA used [g]": "0.000", **dict.fromkeys((one.short_title for one in LIVE_METHODS), "0.00"),
    "Row in Floors": "0", "Row in Catalogue": "0", "PFV used [cm/s]": "0.0", "Breadth used [cm]": "0.0",
    "Height used [cm]": "0.0",
}  # fmt: skip
"""Number formats of the columns that Excel computes, where they hold numbers."""
_LIVE_WIDTHS, _HELP_WIDTH = {CLASS: 17, CLASS_OR: 17}, 90
MOST_NAMED = 8
"""Choices that a help names; of more, the drop-down shows them all, and a spreadsheet cuts long helps."""
CREATED = datetime(2000, 1, 1)
"""Date in the properties of every workbook: the same content gives the same bytes."""


@dataclass(frozen=True, slots=True)
class Content:
    """What to fill in: rows by sheet, each a value by field name in the units of the headers, choices in English.

    `live` holds the results of the live columns, one sequence an item, stored so that a viewer that does not
    calculate shows them.
    """

    rows: Mapping[str, Rows] = field(default_factory=dict)
    live: Sequence[Sequence[float | str]] = ()


def write_workbook(
    path: Path, content: Content | None = None, units: Units = "si", *, spare: int | None = None
) -> None:
    """Write a workbook to fill in, or one that is filled in already, in the language in use.

    Raises OSError if it cannot be written.

    * `path`: Where to; overwritten.
    * `content`: What to fill in; an empty workbook still has the catalogue.
    * `units` ("si" or "imperial"): Of the headers.
    * `spare`: Rows of each sheet that are prepared beyond those filled in, for many small workbooks; None prepares
      `ROWS`, and the form for a walk-down.
    """
    filled = content or Content()

    def fill(book: Any) -> None:
        title, made = gettext("Furniture inventory"), gettext("Made with assess new")
        book.set_properties({"title": title, "comments": made, "created": CREATED})
        _Writer(book, filled, units, spare).write()

    write_book(path, fill)


class _Writer:
    def __init__(self, book: Any, content: Content, units: Units, spare: int | None) -> None:
        self.book, self.content, self.units, self.has_form = book, content, units, spare is None
        self.head = book.add_format({"bold": True, "bg_color": "#1f3a4d", "font_color": "#ffffff", "text_wrap": True,
                                     "valign": "top", "border": 1})  # fmt: skip
        self.live_head = book.add_format({"bold": True, "bg_color": "#5b6b76", "font_color": "#ffffff",
                                          "text_wrap": True, "valign": "top", "border": 1})  # fmt: skip
        self.text = book.add_format({"num_format": "@", "align": "left", "indent": 1, "valign": "top"})
        self.line = book.add_format({"align": "left", "indent": 1, "valign": "top"})
        self.live_formats = {
            label: book.add_format({"bg_color": "#f1f3f5", "num_format": _LIVE_FORMATS[label]}
                                   if label in _LIVE_FORMATS else {"bg_color": "#f1f3f5", "align": "left", "indent": 1})
            for label in (*LIVE, *WORKINGS)
        }  # fmt: skip
        self.title = book.add_format({"bold": True, "font_size": 14})
        self.wrap = book.add_format({"text_wrap": True, "valign": "top"})
        self.help = book.add_format({"text_wrap": True, "valign": "top", "align": "left", "indent": 1})
        self.bold = book.add_format({"bold": True, "valign": "top"})
        self.head_lines: dict[str, int] = {}
        self.rows = {sheet.name: content.rows.get(sheet.name, ()) for sheet in SHEETS}
        self.rows[CATALOGUE.name] = self.rows[CATALOGUE.name] or read_catalogue(units)
        filled = {name: len(self.rows[name]) for name in ROWS}
        self.last = {name: 1 + max(ROWS[name] if spare is None else n + spare, n) for name, n in filled.items()}

    def write(self) -> None:
        help_sheet = self.book.add_worksheet(gettext(HELP))
        pages = {sheet.name: self.book.add_worksheet(gettext(sheet.name)) for sheet in SHEETS}
        lists = self.book.add_worksheet(gettext(LISTS))
        for page in (*pages.values(), lists):
            write_plainly(page)
        ListsWriter(self.book, lists, self.title, self.units, self.last).write()
        self._write_help(help_sheet)
        for sheet in SHEETS:
            page, rows = pages[sheet.name], self.rows[sheet.name]
            headers = {column.name: self._header(column) for column in sheet.columns}
            if sheet.layout == "form":
                page.set_column(0, 0, max(fit_width(header.replace(" ", "_"), 22) for header in headers.values()))
                page.set_column(1, 1, 44, self.line)
                page.set_column(2, 2, _HELP_WIDTH, self.help)
                for at, column in enumerate(sheet.columns):
                    page.write_string(at, 0, headers[column.name], self.head)
                    self._write_cell(page, at, 1, column, rows[0].get(column.name) if rows else None, self.line)
                    self._write_wrapped(page, at, gettext(column.help))
                    self._validate(page, column, at, 1, at)
                self._set_up_print(page)
                continue
            last = max(self.last[sheet.name] - 1, CHECKED.get(sheet.name, 0))
            for column in sheet.columns:
                at, style = PLACES[sheet.name, column.name], self.text if column.kind == "text" else None
                self._write_head(page, at, headers[column.name], column.width, style)
                self._validate(page, column, 1, at, last)
            for (number, row), column in product(enumerate(rows, 1), sheet.columns):
                self._write_cell(page, number, PLACES[sheet.name, column.name], column, row.get(column.name))
            page.freeze_panes(1, FROZEN.get(sheet.name, 1))
            page.autofilter(0, 0, last, max(at for (name, _), at in PLACES.items() if name == sheet.name))
            page.repeat_rows(0)
            self._set_up_print(page)
        self._write_live(pages["Items"])
        if self.has_form:
            write_walk_down(self.book, self.units, [row["type"] for row in self.rows[CATALOGUE.name]])
        pages["Items"].activate() if self.content.rows else help_sheet.activate()

    def _set_up_print(self, page: Any) -> None:
        page.set_landscape()
        page.fit_to_pages(1, 0)
        page.set_footer(gettext(FOOTER))

    def _write_head(self, page: Any, at: int, heading: str, width: float, style: Any, *, is_live: bool = False) -> None:
        width = fit_width(heading, width)
        page.set_column(at, at, width + bool(style), style)
        page.write_string(0, at, heading, self.live_head if is_live else self.head)
        room = (width - _EDGE) / _BOLD
        lines, used = _wrap(heading, room)
        lines += used > room - _BUTTON / _BOLD  # one for the button of the filter
        self.head_lines[page.name] = max(self.head_lines.get(page.name, 1), lines)
        page.set_row(0, LINE * self.head_lines[page.name])

    def _header(self, column: Column) -> str:
        return replace(column, label=gettext(column.label)).header(self.units)

    def _write_cell(self, page: Any, row: int, at: int, column: Column, value: Any, style: Any = None) -> None:
        if isinstance(value, str):
            page.write_string(row, at, gettext(value) if column.choices else value, self.text)
        elif value is not None:
            page.write_number(row, at, value, style)

    def _validate(self, page: Any, column: Column, row: int, at: int, last: int) -> None:
        text = describe(column)
        shown = text if len(text) <= 255 else text[:254] + "…"
        options = {"input_title": gettext(column.label)[:32], "input_message": shown, "ignore_blank": True}
        if column.choices:
            options |= {"validate": "list", "source": f"=list_{column.name}"}
        elif column.offered:
            options |= {"validate": "list", "source": f"=list_{column.name}", "error_type": "information"}
        elif column.source:
            options |= {"validate": "list", "source": f"=list_{column.source.lower()}", "error_type": "warning"}
        elif column.kind == "count":
            options |= {"validate": "integer", "criteria": "between", "minimum": column.low, "maximum": column.high}
        elif column.kind == "number":
            options |= {"validate": "decimal", "criteria": ">", "value": -1e9}
            options |= {"error_message": gettext("Type a number.")}
        else:
            options |= {"validate": "any"}
        page.data_validation(row, at, last, at, options)

    def _write_wrapped(self, page: Any, row: int, text: str) -> None:
        """Write the help of a column and set the height of its row: not every program does."""
        page.write_string(row, 2, text, self.help)
        page.set_row(row, LINE * count_text_lines(text, _HELP_WIDTH - 1))

    def _write_live(self, page: Any) -> None:
        for label in (*LIVE, *WORKINGS):
            at = PLACES[ITEMS.name, label]
            self._write_head(page, at, translate_header(label), _LIVE_WIDTHS.get(label, 13), None, is_live=True)
        page.write_comment(
            0, PLACES[ITEMS.name, CLASS], gettext(CLASS_NOTE, mark=OUTSIDE), {"x_scale": 3, "y_scale": 1.6}
        )
        page.write_comment(0, PLACES[ITEMS.name, "Can rock"], gettext(ROCK_NOTE), {"x_scale": 2})
        formulas = list_live()
        for row in range(2, self.last[ITEMS.name] + 1):
            stored = self.content.live[row - 2] if row - 2 < len(self.content.live) else ()
            values = dict(zip(LIVE, stored, strict=bool(stored)))
            for label, formula in formulas.items():
                at, value = PLACES[ITEMS.name, label], values.get(label, "")
                page.write_formula(row - 1, at, formula.replace(ROW, str(row)), self.live_formats[label], value)
        first = self.last[ITEMS.name] + 1
        last = max(first - 1, CHECKED[ITEMS.name] + 1)
        item, column, by_paper, floor = (LETTERS[ITEMS.name, name] for name in ("item", CLASS, CLASS_OR, "floor"))
        for risk in reversed(RiskClass):
            form = self.book.add_format({"bg_color": risk.fill, "font_color": risk.ink, "bold": risk >= RiskClass.HIGH})
            shown = {"type": "text", "criteria": "begins with", "value": risk.symbol, "format": form}
            for letter in (column, by_paper):
                page.conditional_format(f"{letter}2:{letter}{last}", shown | {"stop_if_true": True})
        wrong = self.book.add_format({"bg_color": "#ffc7ce"})
        page.conditional_format(f"{item}2:{item}{last}", {"type": "duplicate", "format": wrong})
        blank = {"type": "formula", "criteria": f'=AND(${item}2<>"",${floor}2="")', "format": wrong}
        page.conditional_format(f"{floor}2:{floor}{last}", blank)
        if first <= last:
            bare = {"type": "formula", "criteria": f'=AND(${item}{first}<>"",${column}{first}="")', "format": wrong}
            page.conditional_format(f"{column}{first}:{column}{last}", bare)
            note = {"validate": "any", "input_title": gettext(COPY_TITLE), "input_message": gettext(COPY_NOTE)}
            page.data_validation(f"{column}{first}:{column}{last}", note)

    def _write_help(self, page: Any) -> None:
        page.set_column(0, 0, 14)
        headings = [self._header(column) + " *" for sheet in SHEETS for column in sheet.columns]
        width = max(fit_width(heading.replace(" ", "_"), 22) for heading in headings)
        page.set_column(1, 1, width)
        page.set_column(2, 2, _HELP_WIDTH, self.help)
        page.hide_gridlines(2)
        self._set_up_print(page)
        page.write_string(0, 0, gettext(TITLE), self.title)
        row = 2
        limits = dict(zip(("low", "medium", "high"), (100 * one for one in LIMITS), strict=True))
        for line in (gettext(text, rows=self.last[ITEMS.name] - 1, **limits) for text in FIRST_LINES):
            page.merge_range(row, 0, row, 2, line, self.wrap)
            page.set_row(row, LINE * count_text_lines(line, 14 + width + _HELP_WIDTH))
            row += 1
        for at, head in enumerate(HEADS):
            page.write_string(row + 1, at, gettext(head), self.head)
        row += 2
        for sheet in SHEETS:
            for column in sheet.columns:
                page.write_string(row, 0, gettext(sheet.name), self.bold)
                page.write_string(row, 1, self._header(column) + (" *" if column.required else ""), self.bold)
                self._write_wrapped(page, row, describe(column))
                row += 1


def describe(column: Column) -> str:
    """Return the help of a column with its choices, if they are few, and what a blank means, in the language in use."""
    parts = [gettext(column.help)]
    if 0 < len(column.choices) <= MOST_NAMED:
        parts.append(gettext("One of: {choices}.", choices=", ".join(map(gettext, column.choices))))
    if column.default:
        parts.append(gettext("Blank: {default}.", default=gettext(column.default)))
    return " ".join(parts)


LINE = 15
"""Height of one line [points]."""
_BOLD = 1.15
"""Width of a bold letter, of the wider fonts that stand in where the workbook's is missing."""
_REGULAR = 0.95
"""Width of a letter that is not bold."""
_EDGE, _BUTTON = 1, 3
"""Left free at the edges, and for the button of a filter, which covers the end of the last line."""


def fit_width(heading: str, width: float) -> float:
    """Return the width at which no word of a heading is broken, at least `width` [characters of the sheet's font]."""
    words = heading.split()
    return max(width, *(_BOLD * len(word) + _EDGE for word in words), _BOLD * len(words[-1]) + _EDGE + _BUTTON)


def count_text_lines(text: str, width: float) -> int:
    """Return the lines that a text which is not bold takes in a column."""
    return _wrap(text, (width - _EDGE) / _REGULAR)[0]


def _wrap(text: str, room: float) -> tuple[int, int]:
    """Return the lines that a text takes, and the characters of the last one."""
    lines, used = 1, 0
    for word in text.split():
        needed = used + bool(used) + len(word)
        lines, used = (lines, needed) if needed <= room or not used else (lines + 1, len(word))
    return lines, used
