"""Blocks as paragraphs, tables and pictures of Word, in their order."""

import base64
import io
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from assess.report import blocks
from assess.report.word.document import HEAD, SIDE, WIDTH, Word, make, make_run, shade, write_margins
from assess.report.word.drawings import Drawing, draw_all, measure
from assess.report.words import ANCHORED_FILL, INK, NO_BREAK, class_name
from assess.risk import RiskClass
from assess.text import plain_text

STYLES = {"lead": "Lead", "caution": "Caution", "small": "Small", "legend": "Small", "note": "Small",
          "kind": "Subtitle", "scenario": "Subtitle"}  # fmt: skip
"""Styles of paragraphs by their kind; the others are plain."""
FILLS = {"anchored": (ANCHORED_FILL, INK), **{class_name(risk): (risk.fill, risk.ink) for risk in RiskClass}}
"""Ground and ink of badges and tiles, by their kind."""
LOGO, PHOTO = 40.0, 24.0
"""Widths of a logo and of a photo of a piece [mm]."""
SPACE = WIDTH - 2 * SIDE
LEAST, MOST = 5.0, 34.0
"""Characters that the width of a column without one of its own is reckoned from."""
CHARACTER, MARGINS = 2.05, 2.4
"""Width of a character of a cell and of the margins of one [mm]."""
SIZE, SMALLEST = 9.0, 6.5
"""Sizes of the letters of a cell [pt]: that of its style, and the least."""
_OWN_WIDTH = re.compile(r"^w(\d+)$")
_SPACES = re.compile(r"[ \t\r\n\f]+")
_GROUND, _RULE = "E9EDF0", "C9CED3"


@dataclass(frozen=True, slots=True)
class Look:
    """How text looks: what the spans around it say."""

    is_bold: bool = False
    is_italic: bool = False
    rise: str = ""
    ground: str = ""
    ink: str = ""


class WordWriter:
    """Writes the blocks of a document; what is drawn is put in its place at the end, as all is drawn at once."""

    def __init__(self, word: Word) -> None:
        self.word = word
        self.bookmarks = 0
        self.drawn: list[tuple[Any, Drawing]] = []

    def write(self, document: blocks.Document, style: str) -> None:
        """Write a document; `style` is the style sheet that drawings are drawn with."""
        self.write_blocks(document.cover)
        for section in document.sections:  # each on a new page unless it runs on
            if section.heading:
                self._head(section.heading, 1, section.id, is_new="run-on" not in section.kind.split())
            self.write_blocks(section.blocks)
        pictures = draw_all([drawing for _run, drawing in self.drawn], style, self.word.progress)
        for (run, _drawing), picture in zip(self.drawn, pictures, strict=True):
            _add_picture(run, picture.png, picture.width, picture.alternative)

    def write_blocks(self, found: Iterable[blocks.Block]) -> None:
        """Write blocks; an article behind another begins a page unless it is brief."""
        before: blocks.Block | None = None
        for one in found:
            self.word.progress.check()
            self._block(one, is_after_article=isinstance(before, blocks.Box) and before.tag == "article")
            before = one

    def _block(self, one: blocks.Block, *, is_after_article: bool) -> None:  # noqa: C901 - one case a kind of block
        match one:
            case blocks.Paragraph(words, kind):
                kinds = kind.split()
                style = next((STYLES[name] for name in kinds if name in STYLES), "Normal")
                self._paragraph(style, words, keep="lead-in" in kinds)
            case blocks.Title(words, short, status, conditions):
                write_margins(self.word, short, status, conditions)
                self._paragraph("Title", words)
            case blocks.Heading(words, level):
                self._paragraph(f"Heading {level - 1}", words)
            case blocks.Bullets(items):
                for item in items:
                    self._paragraph("List Bullet", item)
            case blocks.Terms(items):
                for term, text in items:
                    self._paragraph("Normal", [blocks.Span(term, "strong"), ": ", *blocks.list_words(text)])
            case blocks.Table():
                self._table(one)
            case blocks.Tiles():
                self._tiles(one)
            case blocks.Figure(image, caption, _, legend):
                self._paragraph("Normal", image, keep=True)
                self.write_blocks(legend)
                if caption:
                    self._paragraph("Caption", caption)
            case blocks.Listing(head, lines):
                for text in (head, *map(blocks.plain_words, lines)):
                    self.word.add("Listing", text)
            case blocks.Equations(lines):
                for line in lines:
                    self._paragraph("Normal", line)
            case blocks.Contents():
                self._contents(one)
            case blocks.Box([blocks.Heading(words, level), *inside], kind, "article", id_):
                is_next = is_after_article and "brief" not in kind.split()
                self._head(words, level - 1, id_, is_new=is_next)
                self.write_blocks(inside)
            case blocks.Box(inside):
                self.write_blocks(inside)

    def _head(self, words: blocks.Words, level: int, name: str, *, is_new: bool) -> None:
        """Write a heading that links lead to."""
        paragraph = self._paragraph(f"Heading {level}", words)
        paragraph.paragraph_format.page_break_before = is_new
        if name:
            self.bookmarks += 1
            number = str(self.bookmarks)
            start = make("w:bookmarkStart", {"w:id": number, "w:name": name})
            paragraph._p.insert(1 if paragraph._p.pPr is not None else 0, start)
            paragraph._p.append(make("w:bookmarkEnd", {"w:id": number}))

    def _paragraph(self, style: str, words: blocks.Words, *, keep: bool = False) -> Any:
        paragraph = self.word.add(style)
        self._fill(paragraph, words)
        if keep:
            paragraph.paragraph_format.keep_with_next = True
        return paragraph

    def _contents(self, one: blocks.Contents) -> None:
        """Write a field that Word fills with pages, which shows the headings until then."""
        begin, separate, end = (make("w:r") for _part in range(3))
        for run, kind in ((begin, "begin"), (separate, "separate"), (end, "end")):
            run.append(make("w:fldChar", {"w:fldCharType": kind}))
        self._paragraph("Subtitle", one.heading)
        paragraph = self.word.add("Normal")
        paragraph._p.extend((begin, make_run("w:instrText", ' TOC \\o "1-1" \\h \\z '), separate))
        for at, (line, _inner) in enumerate(one.lines):
            paragraph = self.word.add("Normal") if at else paragraph
            link = next(span for span in blocks.list_words(line) if isinstance(span, blocks.Span))
            made = make("w:hyperlink", {"w:anchor": link.href[1:]})
            made.append(make_run("w:t", blocks.plain_words(line)))
            paragraph._p.append(made)
            paragraph.paragraph_format.space_after = 0
        paragraph._p.append(end)
        if one.after:
            self._paragraph("Small", one.after)

    # ------------------------------------------------------------ on a line

    def _fill(self, paragraph: Any, words: blocks.Words, look: Look | None = None) -> None:
        for one in blocks.list_words(words):
            self._inline(paragraph, one, look or Look())

    def _inline(self, paragraph: Any, one: blocks.Inline, look: Look) -> None:
        match one:
            case str():
                text = _SPACES.sub(NO_BREAK if look.ground else " ", plain_text(one))
                if not text:
                    return
                run = paragraph.add_run(text)
                run.bold, run.italic = look.is_bold or None, look.is_italic or None
                run.font.subscript, run.font.superscript = look.rise == "sub" or None, look.rise == "sup" or None
                if look.ground:
                    _colour(run, look.ink)
                    shade(run._r.get_or_add_rPr(), look.ground)
            case blocks.Span() if one == blocks.BREAK:
                paragraph.add_run().add_break()
            case blocks.Span(words, "strong"):
                self._fill(paragraph, words, replace(look, is_bold=True))
            case blocks.Span(words, "em"):
                self._fill(paragraph, words, replace(look, is_italic=True))
            case blocks.Span(words, "sub" | "sup" as rise):
                self._fill(paragraph, words, replace(look, rise=rise))
            case blocks.Span(words, kind):
                names = kind.split()
                own = next((FILLS[name] for name in names if name in FILLS), None) if "badge" in names else None
                self._fill(paragraph, words, replace(look, ground=own[0], ink=own[1]) if own else look)
            case blocks.Equation(text):
                self._fill(paragraph, blocks.lower_indices(text), look)
            case blocks.Image(source, alternative, kind):
                if kind == "photo":
                    paragraph.add_run().add_break()
                run = paragraph.add_run()
                if one.is_drawn or source.startswith("data:image/svg+xml"):
                    self.drawn.append((run, measure(one)))
                else:
                    data = base64.b64decode(source.partition(",")[2])
                    _add_picture(run, data, PHOTO if kind == "photo" else LOGO, alternative)

    # ------------------------------------------------------------ tables

    def _table(self, one: blocks.Table) -> None:
        """Write a table, its caption above it: heads repeat on every page, rows stay whole."""
        from docx.enum.text import WD_ALIGN_PARAGRAPH
        from docx.shared import Mm, Pt
        from docx.table import _Cell

        if one.caption:
            self._paragraph("Caption", one.caption)
        rows = [row for group in one.groups for row in group]
        if any(column.heading for column in one.columns):
            rows.insert(0, blocks.Row([column.heading for column in one.columns], "head"))
        made = self.word.file.add_table(len(rows), len(one.columns))
        made.autofit = False
        widths, scale = _find_widths(one.columns, rows)
        for column, width in zip(made._tbl.tblGrid.gridCol_lst, widths, strict=True):
            column.w = Mm(width)
        for tr in made._tbl.tr_lst:
            for tc, width in zip(tr.tc_lst, widths, strict=True):
                tc.width = Mm(width)
        slots = [list(tr.tc_lst) for tr in made._tbl.tr_lst]
        for own, tr, row in zip(slots, made._tbl.tr_lst, rows, strict=True):
            self.word.progress.check()
            properties = tr.get_or_add_trPr()
            properties.append(make("w:cantSplit"))
            if row.kind == "head":
                properties.append(make("w:tblHeader"))
            is_head = row.kind in ("head", "part")
            for at, cell in row.place_cells():
                slot = _Cell(own[at], made)
                if cell.columns > 1:
                    slot = slot.merge(_Cell(own[at + cell.columns - 1], made))
                paragraph = slot.paragraphs[0]
                self.word.set_style(paragraph, "Cell Head" if is_head else "Cell")
                if one.columns[at].is_number and cell.columns == 1 and not cell.is_head:
                    paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
                paragraph.paragraph_format.keep_with_next = is_head
                self._fill(paragraph, cell.words, Look(is_bold=is_head or cell.is_head))
                for run in paragraph.runs if scale < 1 else ():  # else the words would not fit the page
                    run.font.size = Pt(round(max(SMALLEST, SIZE * scale), 1))
                if is_head:
                    shade(slot._tc.get_or_add_tcPr(), _GROUND)
        _set_borders(made)
        self.word.add("Small")

    def _tiles(self, one: blocks.Tiles) -> None:
        """Write counts as one row of cells, each with the colour of its class."""
        from docx.enum.text import WD_ALIGN_PARAGRAPH
        from docx.shared import Pt
        from docx.table import _Cell

        made = self.word.file.add_table(1, len(one.tiles))
        for tc, tile in zip(made._tbl.tr_lst[0].tc_lst, one.tiles, strict=True):
            slot, colours = _Cell(tc, made), FILLS.get(tile.kind)
            for at, text in enumerate((tile.name, tile.number, tile.note)):
                paragraph = slot.paragraphs[0] if at == 0 else slot.add_paragraph()
                self.word.set_style(paragraph, "Cell")
                paragraph.alignment = WD_ALIGN_PARAGRAPH.CENTER
                run = paragraph.add_run(plain_text(text))
                run.bold, run.font.size = (True, Pt(18)) if at == 1 else (None, None)
                if colours:
                    _colour(run, colours[1])
            if colours:
                shade(tc.get_or_add_tcPr(), colours[0])
        _set_borders(made)
        self.word.add("Small")


def _colour(run: Any, ink: str) -> None:
    from docx.shared import RGBColor

    run.font.color.rgb = RGBColor.from_string(ink.lstrip("#").upper())


def _add_picture(run: Any, data: bytes, width: float, alternative: str) -> None:
    """Add a picture to a run, with its text for those who do not see it."""
    from docx.shared import Mm

    shape = run.add_picture(io.BytesIO(data), width=Mm(width))
    shape._inline.docPr.set("descr", plain_text(alternative)[:1000])


# ---------------------------------------------------------------- widths


def _find_widths(columns: Sequence[blocks.Column], rows: Sequence[blocks.Row]) -> tuple[list[float], float]:
    """Return the width of each column [mm], its own in percent, else by what it holds; and a scale.

    None is narrower than its longest word; the scale is that of the letters at which there is room for all.
    """
    texts: list[list[str]] = [[] for _column in columns]
    for row in rows:
        for at, cell in row.place_cells():
            if cell.columns == 1:
                texts[at].append(blocks.plain_words(cell.words))
    own = [float(found[1]) if (found := _OWN_WIDTH.match(column.width)) else None for column in columns]
    shares = [
        min(MOST, max(LEAST, *(max(_longest(text), math.pow(len(text), 0.75)) for text in one), LEAST)) for one in texts
    ]
    left = max(100.0 - sum(one or 0.0 for one in own), 10.0)
    rest = sum(share for share, one in zip(shares, own, strict=True) if one is None)
    wanted = [one if one is not None else left * share / rest for share, one in zip(shares, own, strict=True)]
    needed = [min(max(map(_longest, one), default=0.0), MOST) * CHARACTER + MARGINS for one in texts]
    scale = min(1.0, SPACE / sum(needed))
    widths = [max(SPACE * one / sum(wanted), need) for one, need in zip(wanted, needed, strict=True)]
    slack = sum(width - need for width, need in zip(widths, needed, strict=True))
    excess = sum(widths) - SPACE
    if excess > slack:
        return [SPACE * need / sum(needed) for need in needed], scale
    share = excess / slack if slack else 0.0
    return [width - share * (width - need) for width, need in zip(widths, needed, strict=True)], scale


def _longest(text: str) -> float:
    return float(max(map(len, _SPACES.split(text))))


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
