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
from assess.workbook.schema import BUILDING, ITEMS, WALK_DOWN

PAGES, LINES = 3, 16
"""Pages, and lines for pieces on each."""
BOX = "☐"
_COLUMNS = (
    ("type", 8), ("quantity", 9), ("breadth", 9), ("width", 9), ("height", 9), ("anchored", 27),
    ("against_wall", 8), ("mobile", 8), ("notes", 24), ("photo", 8),
)  # fmt: skip
"""Columns of Items that are filled in, with their widths; before them stands a number, after them room for a sketch."""
_SKETCH = 34
_LISTED = (0, 5, 7, 10)
"""Where each column of the list of types begins."""
_HEAD, _HIGH = 20, 26
"""Heights of the lines of the head and of those of the table [points]."""


def write_walk_down(book: Any, units: Units, types: Sequence[str]) -> None:
    """Add the sheet: the pages, with a page break after each, and the list of `types`, numbered as in the Catalogue."""
    page = book.add_worksheet(_(WALK_DOWN))
    write_plainly(page)
    line = {"border": 1, "text_wrap": True, "valign": "top"}
    styles = {
        "line": line | {"border_color": "#8a9299", "valign": "vcenter"},
        "head": line | {"bold": True, "bg_color": "#e8ecef"},
        "label": {"bold": True}, "answer": {"bottom": 1}, "small": {"font_size": 9},
        "title": {"bold": True, "font_size": 12, "text_wrap": True, "valign": "top"},
    }  # fmt: skip
    forms = {name: book.add_format(style) for name, style in styles.items()}
    last, height = len(_COLUMNS) + 1, ITEMS.column("height")
    for at, width in enumerate((4, *(width for _name, width in _COLUMNS), _SKETCH)):
        page.set_column(at, at, width)
    text = _("Walk-down form: one page a room. Type: its number in the list at the end, or the sizes of a piece that "
             "is not in it. Sizes in {unit}; Breadth is the shorter side. Tick one box of each line; write on it the "
             "number of the photo and, under Notes, what stands on top of the piece or is heavy in it.",
             unit=height.imperial if units == "imperial" else height.unit)  # fmt: skip
    page.merge_range(0, 0, 0, last, text, forms["title"])
    page.set_row(0, 34)
    breaks = [_write_page(page, number, units, forms) for number in range(1, PAGES + 1)]
    row, lines = breaks[-1], -(-len(types) // len(_LISTED))
    text = _("Types: numbers of the column {type}", type=_(ITEMS.column("type").label))
    page.merge_range(row, 0, row, last, text, forms["title"])
    for at, name in enumerate(types):
        page.write_string(row + 1 + at % lines, _LISTED[at // lines], f"{at + 1}  {name}", forms["small"])
    page.set_landscape()
    page.set_paper(9)  # A4
    page.set_margins(left=0.4, right=0.4, top=0.4, bottom=0.6)
    page.fit_to_pages(1, 0)
    page.repeat_rows(0)
    page.set_h_pagebreaks(breaks)
    page.print_area(0, 0, row + lines, last)
    page.hide_gridlines(2)


def _write_page(page: Any, number: int, units: Units, forms: dict[str, Any]) -> int:
    """Write the page of one room; return the row below it."""
    top, last = 1 + (number - 1) * (LINES + 4), len(_COLUMNS) + 1
    of_room = (BUILDING.column("building"), ITEMS.column("floor"), ITEMS.column("room"))
    heads = ([_(one.label) for one in of_room], (_("Date"), _("Surveyed by"), _("Page")))
    for row, labels in enumerate(heads, top):
        page.set_row(row, _HEAD)
        for label, (at, first, end) in zip(labels, ((0, 2, 5), (6, 7, 9), (10, 11, 11)), strict=True):
            page.write_string(row, at, label, forms["label"])
            for beside in range(first, end + 1):
                page.write_blank(row, beside, None, forms["answer"])
    page.write_number(top + 1, last, number, forms["answer"])
    page.set_row(top + 2, 6)
    row = top + 3
    page.set_row(row, 32)
    columns = [ITEMS.column(name) for name, _width in _COLUMNS]
    headers = (replace(one, label=_(one.label)).header(units) for one in columns)
    for at, text in enumerate((_("No."), *headers, _("Sketch of the room"))):
        page.write_string(row, at, text, forms["head"])
    words = [_(one) for one in ITEMS.column("anchored").choices if one != "unknown"]
    boxes = {"anchored": "  ".join(f"{BOX} {word}" for word in (*words, "?")), "against_wall": BOX, "mobile": BOX}
    for line in range(1, LINES + 1):
        page.set_row(row + line, _HIGH)
        page.write_number(row + line, 0, line, forms["line"])
        for at, one in enumerate(columns, 1):
            page.write_string(row + line, at, boxes.get(one.name, ""), forms["line"])
    page.merge_range(row + 1, last, row + LINES, last, "", forms["line"])
    return row + LINES + 1
