"""The sheet Walk-down: pages to print and fill in by hand, one a room, and the numbered types.

Its labels are those of the columns of Items, in the language and with the units of the workbook. Reading a workbook
leaves the sheet out.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from assess.i18n import gettext as _
from assess.workbook.formulas import write_plainly
from assess.workbook.lists import Units
from assess.workbook.schema import BUILDING, ITEMS, WALK_DOWN, Sheet

PAGES, LINES = 3, 16
"""Pages, and lines for pieces on each."""
BOX = "☐"
_COLUMNS = (
    ("type", 8), ("quantity", 9), ("breadth", 9), ("width", 9), ("height", 9), ("anchored", 27),
    ("against_wall", 8), ("mobile", 8), ("notes", 24), ("photo", 8),
)  # fmt: skip
"""Columns of Items that are filled in, with their widths; before them stands a number, after them room for a sketch."""
_SKETCH = 34
_LISTED = ((0, 4), (5, 6), (7, 9), (10, 11))
"""First and last column of each column of the list of types."""
_HEAD, _HIGH = 20, 26
"""Heights of the lines of the head and of those of the table [points]."""


def write_walk_down(book: Any, units: Units, types: Sequence[str]) -> None:
    """Add the sheet: the pages, with a page break after each, and the list of `types`, numbered as in the Catalogue."""
    styles = {
        "line": {"border": 1, "border_color": "#8a9299", "valign": "vcenter", "text_wrap": True},
        "head": {"bold": True, "border": 1, "bg_color": "#e8ecef", "text_wrap": True, "valign": "top"},
        "label": {"bold": True, "valign": "bottom"},
        "answer": {"bottom": 1},
        "title": {"bold": True, "font_size": 12, "text_wrap": True, "valign": "top"},
        "small": {"font_size": 9, "text_wrap": True, "valign": "top"},
    }  # fmt: skip
    page = book.add_worksheet(_(WALK_DOWN))
    write_plainly(page)
    forms = {name: book.add_format(style) for name, style in styles.items()}
    last, height = len(_COLUMNS) + 1, ITEMS.column("height")
    unit = height.imperial if units == "imperial" else height.unit
    page.set_column(0, 0, 4)
    for at, (_name, width) in enumerate(_COLUMNS, 1):
        page.set_column(at, at, width)
    page.set_column(last, last, _SKETCH)
    text = _("Walk-down form: one page a room. Type: its number in the list at the end, or the sizes of a piece that "
             "is not in it. Sizes in {unit}; Breadth is the shorter side. Tick one box of each line; write on it the "
             "number of the photo and, under Notes, what stands on top of the piece or is heavy in it.",
             unit=unit)  # fmt: skip
    page.merge_range(0, 0, 0, last, text, forms["title"])
    page.set_row(0, 34)
    row, breaks = 1, []
    for number in range(1, PAGES + 1):
        row = _write_page(page, row, number, units, forms)
        breaks.append(row)
    page.merge_range(row, 0, row, last, _("Types: numbers of the column {type}", type=_label(ITEMS, "type")),
                     forms["title"])  # fmt: skip
    lines = -(-len(types) // len(_LISTED))
    for at, name in enumerate(types):
        (first, end), line = _LISTED[at // lines], row + 1 + at % lines
        page.merge_range(line, first, line, end, f"{at + 1}  {name}", forms["small"])
    page.set_landscape()
    page.set_paper(9)  # A4
    page.set_margins(left=0.4, right=0.4, top=0.4, bottom=0.6)
    page.fit_to_pages(1, 0)
    page.repeat_rows(0)
    page.set_h_pagebreaks(breaks)
    page.print_area(0, 0, row + lines, last)
    page.hide_gridlines(2)


def _write_page(page: Any, row: int, number: int, units: Units, forms: dict[str, Any]) -> int:
    """Write the page of one room; return the row below it."""
    last = len(_COLUMNS) + 1
    heads = ((_label(BUILDING, "building"), _label(ITEMS, "floor"), _label(ITEMS, "room")),
             (_("Date"), _("Surveyed by"), _("Page")))  # fmt: skip
    for labels in heads:
        page.set_row(row, _HEAD)
        for label, (at, first, end) in zip(labels, ((0, 2, 5), (6, 7, 9), (10, 11, 11)), strict=True):
            page.write_string(row, at, label, forms["label"])
            given = str(number) if labels is heads[1] and at == 10 else ""
            page.write_string(row, first, given, forms["answer"])
            for beside in range(first + 1, end + 1):
                page.write_blank(row, beside, None, forms["answer"])
        row += 1
    page.set_row(row, 6)
    row += 1
    page.set_row(row, 32)
    heads_of_table = [_("No."), *(_header(name, units) for name, _width in _COLUMNS), _("Sketch of the room")]
    for at, text in enumerate(heads_of_table):
        page.write_string(row, at, text, forms["head"])
    words = [_(one) for one in ITEMS.column("anchored").choices if one != "unknown"]
    boxes = {"anchored": "  ".join(f"{BOX} {word}" for word in (*words, "?")), "against_wall": BOX, "mobile": BOX}
    for line in range(1, LINES + 1):
        page.set_row(row + line, _HIGH)
        page.write_number(row + line, 0, line, forms["line"])
        for at, (name, _width) in enumerate(_COLUMNS, 1):
            page.write_string(row + line, at, boxes.get(name, ""), forms["line"])
    page.merge_range(row + 1, last, row + LINES, last, "", forms["line"])
    return row + LINES + 1


def _label(sheet: Sheet, name: str) -> str:
    return _(sheet.column(name).label)


def _header(name: str, units: Units) -> str:
    column = ITEMS.column(name)
    return replace(column, label=_(column.label)).header(units)
