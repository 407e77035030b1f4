"""What the sheets share: formats, cells written as what they are, tables."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from assess.risk import RiskClass

LONGEST = 32_000
"""Characters of a text that are kept; a cell holds 32,767."""

LINE = 15
"""Height of a line [points]: not every program grows a row to its text by itself."""

INPUT = {"font_color": "#0000c0", "bg_color": "#fffbe6"}
"""Look of the cells that are meant to be edited."""


class Pen:
    """Writes into the sheets of one workbook; makes each format once."""

    def __init__(self, book: Any) -> None:
        self.book = book
        self._formats: dict[str, Any] = {}
        self.head = self.format(
            bold=True, bg_color="#1f3a4d", font_color="#ffffff", text_wrap=True, valign="top", border=1
        )
        self.title = self.format(bold=True, font_size=15, font_color="#1f3a4d")
        self.bold = self.format(bold=True)
        self.wrap = self.format(text_wrap=True, valign="top")
        self.top = self.format(valign="top")
        self.input = self.format(**INPUT)
        self.void = self.format(font_color="#a03000", italic=True)

    def format(self, num_format: str = "General", **more: Any) -> Any:
        """Return a format, the same one for the same look."""
        name = repr((num_format, sorted(more.items())))
        if name not in self._formats:
            self._formats[name] = self.book.add_format({"num_format": num_format, **more})
        return self._formats[name]

    def put(self, page: Any, row: int, column: int, value: Any, form: Any = None) -> None:
        """Write a value as what it is: a text is never a formula, a link or a number."""
        if value is None or value == "":
            if form:
                page.write_blank(row, column, None, form)
        elif isinstance(value, bool | int | float):
            page.write_number(row, column, value, form)
        else:
            text = str(value)
            page.write_string(row, column, text if len(text) <= LONGEST else f"{text[:LONGEST]}… (cut)", form)

    def heads(self, page: Any, heads: Sequence[str], widths: Sequence[int]) -> None:
        """Write the heading row of a table, and set its columns' widths."""
        page.set_row(0, LINE * max(count_lines(label, width) for label, width in zip(heads, widths, strict=True)))
        for at, (label, width) in enumerate(zip(heads, widths, strict=True)):
            page.set_column(at, at, width)
            page.write_string(0, at, label, self.head)

    def listing(
        self,
        page: Any,
        heads: Sequence[str],
        widths: Sequence[int],
        rows: Sequence[Sequence[Any]],
        formats: Mapping[int, str] | None = None,
    ) -> None:
        """Write a sheet that is one table: frozen head, filter, head repeated on each printed page.

        `formats` are the number formats of columns that need one.
        """
        self.heads(page, heads, widths)
        shown = {at: self.format(code, valign="top") for at, code in (formats or {}).items()}
        for number, row in enumerate(rows, 1):
            page.set_row(
                number, LINE * max(count_lines(value, width) for value, width in zip(row, widths, strict=True))
            )
            for at, value in enumerate(row):
                self.put(page, number, at, value, self.wrap if isinstance(value, str) else shown.get(at, self.top))
        page.freeze_panes(1, 0)
        page.repeat_rows(0)
        if rows:
            page.autofilter(0, 0, len(rows), len(heads) - 1)

    def colour(self, page: Any, area: str) -> None:
        """Colour the cells of an area by the symbol of the class that they begin with."""
        for risk in reversed(RiskClass):
            form = self.format(bg_color=risk.fill, font_color=risk.ink)
            rule = {
                "type": "text",
                "criteria": "begins with",
                "value": risk.symbol,
                "format": form,
                "stop_if_true": True,
            }
            page.conditional_format(area, rule)


def count_lines(value: Any, width: int) -> int:
    """Return the lines that a text takes in a column of a width [characters], 20 at most."""
    return min(20, max(1, math.ceil(len(value) * 1.1 / width))) if isinstance(value, str) else 1
