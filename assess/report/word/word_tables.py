"""Tables of the page as tables of Word: heads that repeat on every page, rows that stay whole, columns as wide."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from assess.report.word.document import HEAD, SIDE, WIDTH, Word, make, shade
from assess.report.word.runs import FILLS, Line

SPACE = WIDTH - 2 * SIDE
LEAST, MOST = 5.0, 34.0
"""Characters that the width of a column without one of its own is reckoned from."""
CHARACTER, MARGINS = 2.05, 2.4
"""Width of a character of a cell and of the margins of one [mm]."""
_OWN_WIDTH = re.compile(r"^w(\d+)$")
SIZE, SMALLEST = 9.0, 6.5
"""Sizes of the letters of a cell [pt]: that of its style, and the least."""
_WORDS = re.compile(r"[ \t\n]+")
_GROUND, _RULE = "E9EDF0", "C9CED3"


@dataclass(frozen=True, slots=True)
class Placed:
    """A cell of the page with the row and column of the table at which it begins, and how many it spans."""

    cell: Any
    row: int
    column: int
    rows: int
    columns: int


def place_cells(rows: Sequence[Any]) -> list[Placed]:
    """Return the cells of the rows of a page where a browser puts them: beside those that span rows from above."""
    taken: set[tuple[int, int]] = set()
    found = []
    for at, row in enumerate(rows):
        column = 0
        for cell in row.iterchildren("td", "th"):
            while (at, column) in taken:
                column += 1
            high = min(int(cell.get("rowspan") or 1), len(rows) - at)
            found.append(Placed(cell, at, column, high, int(cell.get("colspan") or 1)))
            taken |= {(at + down, column + right) for down in range(high) for right in range(found[-1].columns)}
            column += found[-1].columns
    return found


def write_table(word: Word, table: Any) -> None:
    """Write a table of the page; its caption stands above it."""
    from docx.shared import Pt

    for caption in table.findall("caption"):
        Line(word, word.add("Caption")).fill(caption)
    parts = [(part, part.tag == "thead") for part in table.iterchildren("thead", "tbody", "tfoot")]
    rows = [(row, is_head) for part, is_head in parts or [(table, False)] for row in part.findall("tr")]
    placed = place_cells([row for row, _is_head in rows])
    columns = max((one.column + one.columns for one in placed), default=0)
    if not columns:
        return
    made = word.file.add_table(len(rows), columns)
    made.autofit = False
    widths, scale = _find_widths(table, placed, columns)
    _set_columns(made, widths)
    slots = [list(tr.tc_lst) for tr in made._tbl.tr_lst]
    for tr, (_row, is_head) in zip(made._tbl.tr_lst, rows, strict=True):
        word.progress.check()
        properties = tr.get_or_add_trPr()
        properties.append(make("w:cantSplit"))
        if is_head:
            properties.append(make("w:tblHeader"))
    for one in placed:
        row, is_head = rows[one.row]
        slot = _write_slot(word, made, slots, one, is_head=is_head or "part" in row.get("class", "").split())
        for run in slot.paragraphs[0].runs if scale < 1 else ():  # else the words would not fit the page
            run.font.size = Pt(round(max(SMALLEST, SIZE * scale), 1))
    _set_borders(made)
    word.add("Small")


def _write_slot(word: Word, table: Any, slots: list[list[Any]], one: Placed, *, is_head: bool) -> Any:
    from docx.table import _Cell

    first = _Cell(slots[one.row][one.column], table)
    last = slots[one.row + one.rows - 1][one.column + one.columns - 1]
    slot = first.merge(_Cell(last, table)) if one.rows > 1 or one.columns > 1 else first
    _write_cell(word, slot, one.cell, is_head=is_head)
    if is_head:
        shade(slot._tc.get_or_add_tcPr(), _GROUND)
    return slot


def _write_cell(word: Word, slot: Any, cell: Any, *, is_head: bool) -> None:
    from docx.enum.text import WD_ALIGN_PARAGRAPH

    paragraph = slot.paragraphs[0]
    word.set_style(paragraph, "Cell Head" if is_head else "Cell")
    if "num" in cell.get("class", "").split():
        paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
    paragraph.paragraph_format.keep_with_next = is_head
    Line(word, paragraph).fill(cell)


# ---------------------------------------------------------------- widths


def _find_widths(table: Any, placed: Sequence[Placed], columns: int) -> tuple[list[float], float]:
    """Return the width of each column [mm], in percent where the page says so, else by what it holds; and a scale.

    None is narrower than its longest word; the scale is that of the letters at which there is room for all.
    """
    texts: list[list[str]] = [[] for _column in range(columns)]
    for one in placed:
        if one.columns == 1:
            texts[one.column].append(" ".join(one.cell.itertext()))
    names = [col.get("class", "").split() for col in table.iterfind("colgroup/col")][:columns]
    own = [next((float(found[1]) for name in one if (found := _OWN_WIDTH.match(name))), None) for one in names]
    own += [None] * (columns - len(own))
    shares = [min(MOST, max(LEAST, *map(_reckon, one), LEAST)) for one in texts]
    left = max(100.0 - sum(one or 0.0 for one in own), 10.0)
    rest = sum(share for share, one in zip(shares, own, strict=True) if one is None)
    wanted = [one if one is not None else left * share / rest for share, one in zip(shares, own, strict=True)]
    longest = [max((len(word) for text in one for word in _WORDS.split(text)), default=0) for one in texts]
    needed = [min(one, MOST) * CHARACTER + MARGINS for one in longest]
    return _fit([SPACE * one / sum(wanted) for one in wanted], needed), min(1.0, SPACE / sum(needed))


def _fit(wanted: list[float], needed: list[float]) -> list[float]:
    """Return widths that sum up to the page's: as wanted, but none below what it needs while the others have room."""
    widths = [max(pair) for pair in zip(wanted, needed, strict=True)]
    slack = sum(width - need for width, need in zip(widths, needed, strict=True))
    excess = sum(widths) - SPACE
    if excess > slack:
        return [SPACE * need / sum(needed) for need in needed]
    share = excess / slack if slack else 0.0
    return [width - share * (width - need) for width, need in zip(widths, needed, strict=True)]


def _reckon(text: str) -> float:
    """Return how many characters wide a cell would be: its longest word, or some of its text."""
    longest = max(map(len, _WORDS.split(text)))
    return max(float(longest), math.pow(len(text), 0.75))


def _set_columns(table: Any, widths: list[float]) -> None:
    from docx.shared import Mm

    for column, width in zip(table._tbl.tblGrid.gridCol_lst, widths, strict=True):
        column.w = Mm(width)
    for tr in table._tbl.tr_lst:
        for tc, width in zip(tr.tc_lst, widths, strict=True):
            tc.width = Mm(width)


def _set_borders(table: Any) -> None:
    properties = table._tbl.tblPr
    borders = make("w:tblBorders")
    for side in ("top", "left", "bottom", "right", "insideH", "insideV"):
        is_drawn = side in ("top", "bottom", "insideH")
        value = {"w:val": "single" if is_drawn else "nil", "w:sz": "4", "w:space": "0"}
        borders.append(make(f"w:{side}", {**value, "w:color": HEAD if side in ("top", "bottom") else _RULE}))
    margins = make("w:tblCellMar")
    for side, width in (("top", 25), ("left", 60), ("bottom", 25), ("right", 60)):
        margins.append(make(f"w:{side}", {"w:w": str(width), "w:type": "dxa"}))
    properties.append(borders)
    properties.append(margins)


def write_tiles(word: Word, tiles: Any) -> None:
    """Write the counts of the summary: one row of cells, each with the colour of its class."""
    from docx.enum.text import WD_ALIGN_PARAGRAPH
    from docx.table import _Cell

    own = list(tiles.iterchildren("div"))
    if not own:
        return
    made = word.file.add_table(1, len(own))
    for tc, tile in zip(made._tbl.tr_lst[0].tc_lst, own, strict=True):
        slot = _Cell(tc, made)
        colours = [FILLS[name] for name in tile.get("class", "").split() if name in FILLS]
        for at, part in enumerate(tile.iterchildren("span")):
            paragraph = slot.paragraphs[0] if at == 0 else slot.add_paragraph()
            word.set_style(paragraph, "Cell")
            paragraph.alignment = WD_ALIGN_PARAGRAPH.CENTER
            Line(word, paragraph).fill(part)
            _dress_tile(paragraph, part, colours)
        if colours:
            shade(slot._tc.get_or_add_tcPr(), colours[0][0])
    _set_borders(made)
    word.add("Small")


def _dress_tile(paragraph: Any, part: Any, colours: list[tuple[str, str]]) -> None:
    from docx.shared import Pt, RGBColor

    is_number = "tile-number" in part.get("class", "").split()
    for run in paragraph.runs:
        run.bold = is_number or None
        run.font.size = Pt(18) if is_number else None
        if colours:
            run.font.color.rgb = RGBColor.from_string(colours[0][1].lstrip("#").upper())
