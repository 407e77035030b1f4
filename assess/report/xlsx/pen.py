"""What the sheets share: looks, columns, tables, names of sheets, print set-up; cells are written as what they are."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any

from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report.xlsx.item_formulas import Terms, build_terms
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.table import Field
from assess.workbook.formulas import write_plainly
from assess.workbook.open import REPORT_OF
from assess.workbook.writer import write_book

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""
LONGEST = 32_000
"""Characters of a text that are kept; a cell holds 32,767."""
LINE = 15
"""Height of a line [points]: not every program grows a row to its text by itself."""
CHANCE, COUNT = "0.0%", "#,##0"

LOOKS: Mapping[str, Mapping[str, Any]] = {
    "title": {"bold": True, "font_size": 15, "font_color": "#1f3a4d"},
    "head": {"bold": True, "bg_color": "#1f3a4d", "font_color": "#ffffff", "text_wrap": True, "valign": "top",
             "border": 1},
    "heading": {"bold": True, "font_size": 12, "font_color": "#1f3a4d"},
    "input": {"font_color": "#0000c0", "bg_color": "#fffbe6", "valign": "top"},
    "live": {"font_color": "#1f3a4d", "valign": "top"},
    "total": {"bold": True, "top": 1, "valign": "top"},
    "warning": {"font_color": "#a03000", "italic": True},
    "text": {"text_wrap": True, "valign": "top"},
    "plain": {"valign": "top"},
}  # fmt: skip
"""The looks of cells."""


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a sheet: its heading in the language in use, its width in characters, and what reads a row.

    `format` is how Excel shows a number, `look` one of `LOOKS` ("" goes by the value), `align` "center" or "". In Items
    a column has a key, by which formulas name it; `read` returns what they result in as run.
    """

    label: str
    width: int
    read: Callable[[Any], Any]
    format: str = ""
    key: str = ""
    look: str = ""
    is_hidden: bool = False
    align: str = ""


def of_field(field: Field, **more: Any) -> Column:
    """Return the column of a field of the results; `more` are parameters of `Column` that differ."""
    return replace(Column(field.heading(), field.width, field.read, field.format, field.key), **more)


_WORD_ENDS = re.compile(r"\s+|(?<=-)")
WIDEST = 30
"""Characters that a column is widened to at most."""


def widen(columns: Sequence[Column], rows: Iterable[Any], looks: Sequence[str] = ("", "text")) -> list[Column]:
    """Return columns of these `looks` at least as wide as the longest word in them, up to `WIDEST` characters."""
    wide = {at: one for at, one in enumerate(columns) if one.look in looks and not one.is_hidden}
    longest = dict.fromkeys(wide, 0)
    for row in rows:
        for at, column in wide.items():
            text = column.read(row)
            if isinstance(text, str) and len(text) > longest[at]:  # only then can a word of it be longer
                longest[at] = max(longest[at], *map(len, _WORD_ENDS.split(text)))
    return [
        replace(one, width=max(one.width, min(longest[at] + 2, WIDEST))) if at in wide else one
        for at, one in enumerate(columns)
    ]


class Pen:
    """Writes into the sheets of one workbook; makes each format once.

    `sheets` are the names of its sheets by their keys.
    """

    def __init__(self, book: Any, sheets: Mapping[str, str], progress: Progress = SILENT) -> None:
        self.book, self.sheets, self.progress = book, sheets, progress
        self.terms: Terms = build_terms()
        self._formats: dict[str, Any] = {}
        self.classes = {risk: self.style("text", bg_color=risk.fill, font_color=risk.ink) for risk in RiskClass}
        inks = {RouteState.NOT_KNOWN: "#000000", RouteState.BLOCKED: "#ffffff"}
        states = {
            state.symbol: self.style("text", bold=True, bg_color=state.fill, font_color=inks.get(state, "#1a1a1a"))
            for state in RouteState
        }
        self._marked = {risk.symbol: style for risk, style in self.classes.items()} | states

    def format(self, **look: Any) -> Any:
        """Return a format, the same one for the same look; what is "" counts for nothing."""
        own = {name: value for name, value in look.items() if value != ""}
        name = repr(sorted(own.items()))
        if name not in self._formats:
            self._formats[name] = self.book.add_format(own)
        return self._formats[name]

    def style(self, name: str, code: str = "", **more: Any) -> Any:
        """Return the format of one of `LOOKS`, with a number format and what differs."""
        return self.format(**LOOKS[name], num_format=code, **more)

    def put(self, page: Any, row: int, column: int, value: Any, form: Any = None) -> None:
        """Write a value as what it is: a text is never a formula, a link or a number."""
        if value is None or value == "":
            if form:
                page.write_blank(row, column, None, form)
        elif isinstance(value, bool | int | float):
            page.write_number(row, column, value, form)
        else:
            text = str(value)
            page.write_string(row, column, text if len(text) <= LONGEST else f"{text[:LONGEST]}…", form)

    def paragraph(self, page: Any, row: int, text: str, widths: Sequence[int]) -> None:
        """Write a text across the columns of a sheet, in a row that is high enough for it."""
        page.merge_range(row, 0, row, len(widths) - 1, "", self.style("text"))
        page.set_row(row, LINE * count_lines(text, sum(widths)))
        self.put(page, row, 0, text, self.style("text"))

    def heads(self, page: Any, labels: Sequence[str], widths: Sequence[int], row: int = 0) -> None:
        """Write the heading row of a table, and set its columns' widths where it begins a sheet."""
        page.set_row(row, row_height(labels, widths))
        for at, (label, width) in enumerate(zip(labels, widths, strict=False)):
            if row == 0:
                page.set_column(at, at, width)
            self.put(page, row, at, label, self.style("head"))

    def listing(self, page: Any, columns: Sequence[Column], rows: Sequence[Any]) -> int:
        """Write a sheet that is one table: frozen head, filter, head repeated on each printed page.

        A class or a state is coloured by the symbol that it begins with. Returns the row below the table.
        """
        columns = widen(columns, rows)
        widths = [one.width for one in columns]
        self.heads(page, [one.label for one in columns], widths)
        below = self._rows(page, 1, columns, widths, rows)
        page.freeze_panes(1, 0)
        page.repeat_rows(0)
        if rows:
            page.autofilter(0, 0, len(rows), len(columns) - 1)
        return below

    def below(
        self, page: Any, row: int, title: str, columns: Sequence[Column], widths: Sequence[int], rows: Sequence[Any]
    ) -> int:
        """Write a further table below the first of a sheet, whose columns have `widths`; return the row below it."""
        page.write_string(row, 0, title, self.style("heading"))
        self.heads(page, [one.label for one in columns], widths, row + 1)
        return self._rows(page, row + 2, columns, widths, rows)

    def _rows(self, page: Any, top: int, columns: Sequence[Column], widths: Sequence[int], rows: Sequence[Any]) -> int:
        shown, text = [self.style("plain", one.format, align=one.align) for one in columns], self.style("text")
        for number, row in enumerate(rows, top):
            self.progress.check()
            values = [one.read(row) for one in columns]
            page.set_row(number, row_height(values, widths))
            for at, value in enumerate(values):
                style = shown[at]
                if isinstance(value, str):  # a text has the colour of the class or state whose symbol it begins with
                    style = self._marked.get(value[:1], text) if value[1:2] == " " else text
                self.put(page, number, at, value, style)
        return top + len(rows)

    def colour(self, page: Any, area: str) -> None:
        """Colour the cells of an area by the symbol of the class that they begin with."""
        rule = {"type": "text", "criteria": "begins with", "stop_if_true": True}
        for risk in reversed(RiskClass):
            form = self.format(bg_color=risk.fill, font_color=risk.ink)
            page.conditional_format(area, {**rule, "value": risk.symbol, "format": form})

    def bar(self, page: Any, area: str) -> None:
        """Show chances as bars that are full at 1."""
        rule = {"type": "data_bar", "bar_color": "#9db7c9", "bar_solid": True, "min_type": "num", "max_type": "num",
                "min_value": 0, "max_value": 1}  # fmt: skip
        page.conditional_format(area, rule)


def row_height(values: Iterable[Any], widths: Iterable[int]) -> int:
    """Return the height of a row [points] by its texts in columns of these widths [characters]."""
    return LINE * max(count_lines(value, width) for value, width in zip(values, widths, strict=False))


def count_lines(value: Any, width: int, most: int = 20) -> int:
    """Return the lines, at most `most`, that a text takes in a column of a width [characters]."""
    return min(most, max(1, math.ceil(len(value) * 1.1 / width))) if isinstance(value, str) else 1


def refer(name: str) -> str:
    """Return a sheet's name as formulas write it before a cell."""
    return "'" + name.replace("'", "''") + "'!"


def name_sheets(titles: Mapping[str, str]) -> dict[str, str]:
    """Return the names of sheets by their keys: at most 31 characters, none that Excel forbids, unique in any case."""
    names: dict[str, str] = {}
    for key, title in titles.items():
        plain = re.sub(r"[\[\]:*?/\\]", " ", title).strip().strip("'")[:31].strip() or key
        taken, at, found = {one.casefold() for one in names.values()}, 1, plain
        while found.casefold() in taken:
            at += 1
            found = f"{plain[: 31 - len(f' {at}')]} {at}"
        names[key] = found
    return names


Write = Callable[[Pen, Any], object]


def write_sheets(
    path: Path, sheets: Sequence[tuple[str, str, Write]], *, title: str, created: datetime, texts: tuple[str, str, str],
    progress: Progress = SILENT, report_of: str = "",
) -> None:  # fmt: skip
    """Write a workbook: of each sheet its key, its title in the language in use, and what writes it.

    `title` and `created` are what the file says of itself, `report_of` the workbook that it is a report of; `texts`
    stand on every printed page: at the head, in the middle of it what holds for all numbers, and at the foot. Raises
    OSError if the file cannot be written; CancelledError if `progress` was cancelled (no file is left).
    """
    head, conditions, foot = map(_plain, texts)  # a blank ends the size before each, whose digits would count to it

    def write(book: Any) -> None:
        book.set_properties({"title": title, "created": created})
        if report_of:
            book.set_custom_property(f"{REPORT_OF}{report_of[:200]}", "yes")
        pen = Pen(book, name_sheets({key: name for key, name, _write in sheets}), progress)
        pages = [book.add_worksheet(name) for name in pen.sheets.values()]
        for page, name, (_key, _title, write_own) in zip(pages, pen.sheets.values(), sheets, strict=True):
            progress.check()
            write_plainly(page)
            page.set_landscape()
            page.set_paper(9)  # A4
            page.set_margins(left=0.5, right=0.5, top=0.75, bottom=0.75)
            page.fit_to_pages(1, 0)
            middle = f"&C&8 {conditions}" if conditions else ""
            page.set_header(f"&L&8 {head}{middle}&R&8 {_plain(name)}")
            number = _plain(_("Page {page} of {pages}", page="\ue000", pages="\ue001"))  # signs for private use
            number = number.replace("\ue000", "&P").replace("\ue001", "&N")
            page.set_footer(f"&L&8 {foot}&R&8 {number}")
            write_own(pen, page)

    write_book(path, write, by_row=True, progress=progress)


def _plain(text: str) -> str:
    """Escape ampersands, which begin commands in headers and footers."""
    return text.replace("&", "&&")
