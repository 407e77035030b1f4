"""What the sheets share: names, styles, cells written as what they are, tables."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from assess.report import words
from assess.report.xlsx.said import Terms, refer, say_terms
from assess.report.xlsx.styles import LOOKS, Style, class_looks, state_looks, write_names
from assess.risk import RiskClass

LONGEST = 32_000
"""Characters of a text that are kept; a cell holds 32,767."""

LINE = 15
"""Height of a line [points]: not every program grows a row to its text by itself."""
MOST_LINES = 20
"""Lines of a row; Excel allows 409 points."""

ITALIC: dict[str, Any] = {"font_color": "#a03000", "italic": True}


class Pen:
    """Writes into the sheets of one workbook; makes each format once.

    `sheets` are the names of its sheets by their keys.
    """

    def __init__(self, book: Any, sheets: Mapping[str, str]) -> None:
        self.book, self.sheets = book, sheets
        self.terms: Terms = say_terms()
        self._formats: dict[str, Any] = {}
        self._named: dict[str, tuple[int | None, list[Any]]] = {}
        self.head, self.title, self.wrap = map(self.style, ("Heading 1", "Title", "Explanatory Text"))
        self.heading, self.total, self.input = map(self.style, ("Heading 2", "Total", "Input"))
        self.percent, self.live = self.style("Percent"), self.style("Calculation")
        self.classes = {risk: self._name(name, None, look) for risk, (name, look) in class_looks().items()}
        self.states = {state: self._name(name, None, look) for state, (name, look) in state_looks().items()}
        self._marked: dict[str, Any] = {risk.symbol: form for risk, form in self.classes.items()}
        self._marked |= {state.symbol: form for state, form in self.states.items()}
        self.warning = self.style("Warning Text")
        self.top, self.void = self.format(valign="top"), self.format(**ITALIC)
        write_names(book, self._styles)

    def format(self, num_format: str = "General", **more: Any) -> Any:
        """Return a format, the same one for the same look."""
        name = repr((num_format, sorted(more.items())))
        if name not in self._formats:
            self._formats[name] = self.book.add_format({"num_format": num_format, **more})
        return self._formats[name]

    def style(self, name: str, **more: Any) -> Any:
        """Return the format of a named style, with what is otherwise in some of its cells."""
        builtin, look = LOOKS[name]
        if more:
            self.style(name)
        return self._name(name, builtin, look | more)

    def _name(self, name: str, builtin: int | None, look: Mapping[str, Any]) -> Any:
        made = self.format(**look)
        made._get_xf_index()  # so that it is written whether or not a cell has it
        formats = self._named.setdefault(name, (builtin, []))[1]
        if made not in formats:
            formats.append(made)
        return made

    def _styles(self) -> list[Style]:
        """Return the named styles with the places of their formats, once all have been made."""
        return [
            Style(name, builtin, [one._get_xf_index() for one in formats])
            for name, (builtin, formats) in self._named.items()
        ]

    def refer(self, sheet: str) -> str:
        """Return a sheet by its key as formulas write it before a cell."""
        return refer(self.sheets[sheet])

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

    def heads(self, page: Any, heads: Sequence[str], widths: Sequence[int], row: int = 0) -> None:
        """Write the heading row of a table, and set its columns' widths where it begins a sheet."""
        page.set_row(row, LINE * max(count_lines(label, width) for label, width in zip(heads, widths, strict=True)))
        for at, (label, width) in enumerate(zip(heads, widths, strict=True)):
            if row == 0:
                page.set_column(at, at, width)
            page.write_string(row, at, label, self.head)

    def listing(
        self,
        page: Any,
        heads: Sequence[str],
        widths: Sequence[int],
        rows: Sequence[Sequence[Any]],
        formats: Mapping[int, str] | None = None,
    ) -> None:
        """Write a sheet that is one table: frozen head, filter, head repeated on each printed page.

        `formats` are the number formats of columns that need one. A class stands in the style of the class.
        """
        self.heads(page, heads, widths)
        self._rows(page, 1, widths, rows, formats or {})
        page.freeze_panes(1, 0)
        page.repeat_rows(0)
        if rows:
            page.autofilter(0, 0, len(rows), len(heads) - 1)

    def below(
        self, page: Any, row: int, title: str, heads: Mapping[str, str], widths: Sequence[int],
        rows: Sequence[Sequence[Any]],
    ) -> int:  # fmt: skip
        """Write a further table below the first of a sheet, whose columns have `widths`; return the row below it.

        `heads` holds the number formats by the headings.
        """
        widths = widths[: len(heads)]
        page.write_string(row, 0, title, self.heading)
        self.heads(page, tuple(heads), widths, row + 1)
        self._rows(page, row + 2, widths, rows, {at: code for at, code in enumerate(heads.values()) if code})
        return row + 2 + len(rows)

    def _rows(
        self, page: Any, top: int, widths: Sequence[int], rows: Sequence[Sequence[Any]], formats: Mapping[int, str]
    ) -> None:
        shown = {at: self._format(code) for at, code in formats.items()}
        for number, row in enumerate(rows, top):
            lines = max(count_lines(value, width) for value, width in zip(row, widths, strict=True))
            page.set_row(number, LINE * lines)
            for at, value in enumerate(row):
                text = self._class(value) if isinstance(value, str) else None
                self.put(page, number, at, value, text or shown.get(at, self.top))

    def _format(self, code: str) -> Any:
        return self.percent if code == "0.0%" else self.format(code, valign="top")

    def _class(self, text: str) -> Any:
        """Return the style of a text: that of a class or state where it begins with the symbol of one."""
        return self._marked.get(text[0], self.wrap) if text[1:2] == " " else self.wrap

    def colour(self, page: Any, area: str) -> None:
        """Colour the cells of an area by the symbol of the class that they begin with."""
        for risk in reversed(RiskClass):
            form = self.format(bg_color=risk.fill, font_color=risk.ink)
            rule = {"type": "text", "criteria": "begins with", "value": risk.symbol, "format": form,
                    "stop_if_true": True}  # fmt: skip
            page.conditional_format(area, rule)

    def bar(self, page: Any, area: str) -> None:
        """Show chances as bars that are full at 1."""
        rule = {"type": "data_bar", "bar_color": "#9db7c9", "bar_solid": True, "min_type": "num", "max_type": "num",
                "min_value": 0, "max_value": 1}  # fmt: skip
        page.conditional_format(area, rule)


def count_lines(value: Any, width: int, most: int = MOST_LINES) -> int:
    """Return the lines that a text takes in a column of a width [characters], `most` at most."""
    return min(most, max(1, math.ceil(len(value) * 1.1 / width))) if isinstance(value, str) else 1


def with_unit(label: str, unit: str) -> str:
    """Return a heading with its unit in brackets."""
    return f"{label} [{unit}]"


def clip(text: str, longest: int) -> str:
    """Return a text on one line, cut where it is longer."""
    return words.cut(text, longest)
