"""Long lists in a compact form: lines of fixed columns, which a PDF lays out many times faster than a table's cells."""

import unicodedata
from collections.abc import Sequence

from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Listing, Span, Words
from assess.report.page_columns import PageColumn
from assess.results import ItemResult

LINES = 58
"""Lines of one block: what a page holds."""
MOST_LINES = 5000
"""Rows that a list shows; beyond that a PDF gets too long for anybody to read."""


def fit(text: str, width: int, *, to_right: bool = False) -> str:
    """Return a text that takes `width` places in a font of equal widths, cut where it is longer."""
    text = " ".join(text.split())
    taken = sum(map(_places, text))
    if taken > width:
        kept, left = "", width - 1
        for character in text:
            left -= _places(character)
            if left < 0:
                break
            kept += character
        text, taken = kept + "…", sum(map(_places, kept)) + 1
    return " " * (width - taken) + text if to_right else text + " " * (width - taken)


def _places(character: str) -> int:
    """Return how many places a character takes: none if it stands above another one, two if it is a wide one."""
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def list_lines(results: Sequence[ItemResult], columns: Sequence[PageColumn]) -> list[Listing]:
    """Return a line a row, with those of the columns of a table that have a place in it, and the class at its end."""
    shown = [one for one in columns if one.places]
    head = "  ".join([*(_put(one, one.line_heading or one.heading) for one in shown), _("Class")])
    lines = [_line(shown, one) for one in results[:MOST_LINES]]
    return [Listing(head, lines[at : at + LINES]) for at in range(0, len(lines), LINES)]


def _put(column: PageColumn, text: str) -> str:
    return fit(text, column.places, to_right=column.is_number or column.is_method)


def _line(columns: Sequence[PageColumn], one: ItemResult) -> Words:
    text = "  ".join(_put(column, (column.line or column.text)(one)) for column in columns)
    marks = words.class_marks(one)
    if one.is_anchored:
        mark = _("anchored")
        return f"{text}  {words.ANCHORED} {mark} ({words.class_label(one)}{marks})"
    if one.apart:
        return f"{text}  {words.class_label(one)} ({words.apart_note(one)})"
    risk = one.adopted.risk
    return [f"{text}  ", Span(f"{words.risk_label(risk)}{marks}", f"badge {words.class_name(risk)}")]
