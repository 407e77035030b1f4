"""The Word edition of the client's report: the same page as report.pdf, as paragraphs, tables and pictures to edit."""

import base64
import io
import math
import re
import zipfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import docx
from docx.enum.style import WD_STYLE_TYPE
from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_TAB_ALIGNMENT, WD_TAB_LEADER
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from docx.shared import Mm, Pt, RGBColor
from docx.table import _Cell

from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import blocks
from assess.report.content import Content
from assess.report.cover import build_document
from assess.report.pages.html import build_style
from assess.report.provenance import report_time
from assess.report.report_options import ReportOptions
from assess.report.view import View
from assess.report.word.drawings import Drawing, draw_all, measure
from assess.report.words import ANCHORED_FILL, INK, NO_BREAK, class_name
from assess.risk import RiskClass
from assess.text import plain_text
from assess.version import __version__

FACE, FIXED = "Arial", "Courier New"
"""Faces that every word processor has, or replaces by one of the same widths."""
HEAD, TEXT, QUIET, WARNING = "1F3A4D", "1C1C1C", "4A4F54", "8C1D3F"
"""Colours of headings, text, captions and cautions, as in the style sheets."""
WIDTH, HEIGHT, SIDE, TOP = 210.0, 297.0, 16.0, 18.0
"""The page and its margins [mm]."""
SPACE = WIDTH - 2 * SIDE
_STYLES = {
    "Title": ("", 20, HEAD, True, 3), "Subtitle": ("", 9.5, QUIET, False, 2),
    "Heading 1": ("", 16, HEAD, True, 4), "Heading 2": ("", 11.5, HEAD, True, 3),
    "Heading 3": ("", 10, HEAD, True, 2), "Normal": ("", 9.5, TEXT, False, 4), "Caption": ("", 8.5, QUIET, False, 2),
    "List Bullet": ("", 9.5, TEXT, False, 2), "List Number": ("", 9.5, TEXT, False, 2),
    "Lead": ("Normal", 11, TEXT, None, 4), "Caution": ("Normal", 9.5, TEXT, None, 4),
    "Small": ("Normal", 8.5, QUIET, None, 2), "Cell": ("Normal", 8, TEXT, None, 0),
    "Cell Head": ("Cell", 8, HEAD, True, 0), "Listing": ("Normal", 7.5, TEXT, None, 0),
}  # fmt: skip
"""Styles: what each is based on ("" of those that Word has), size [pt], colour, whether bold, space after [pt]."""
_OF_KINDS = {"lead": "Lead", "caution": "Caution", "small": "Small", "legend": "Small", "note": "Small",
             "kind": "Subtitle", "scenario": "Subtitle", "band": "Small"}  # fmt: skip
"""Styles of paragraphs by their kind; the others are plain."""
FILLS = {"anchored": (ANCHORED_FILL, INK), **{class_name(risk): (risk.fill, risk.ink) for risk in RiskClass}}
"""Ground and ink of badges and tiles, by their kind."""
LOGO, PHOTO = 40.0, 24.0
"""Widths of a logo and of a photo of a piece [mm]."""
LEAST, MOST = 5.0, 34.0
"""Characters that the width of a column without one of its own is reckoned from."""
CHARACTER, MARGINS = 1.85, 2.4
"""Width of a character of a cell and of the margins of one [mm]."""
SIZE, SMALLEST = 8.0, 6.5
"""Sizes of the letters of a cell [pt]: that of its style, and the least."""
_OWN_WIDTH = re.compile(r"^w(\d+)$")
_SPACES = re.compile(r"[ \t\r\n\f]+")
_GROUND, _RULE = "E9EDF0", "C9CED3"


def write_word(content: Content, path: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write report.docx: the client's edition.

    Raises InputError if a template cannot be used; PdfUnavailableError if the native libraries that draw plans and
    charts are missing; OSError if the file cannot be written; CancelledError if the work was cancelled; nothing is
    written.
    """
    view = View(content=content, edition="client", for_print=True, options=options, progress=progress)
    document = progress.wait_for(lambda: build_document(view))
    writer = WordWriter(document, options.spoken_language, progress)
    writer.write(document, build_style(options, True, "edition.css"))
    packed = io.BytesIO()
    writer.file.save(packed)
    # times inside it are those of the report, so that the same run makes the same bytes
    with zipfile.ZipFile(packed) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        for one in source.infolist():
            progress.check()
            entry = zipfile.ZipInfo(one.filename, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            target.writestr(entry, source.read(one))


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

    def __init__(self, document: blocks.Document, language: str, progress: Progress) -> None:
        self.progress = progress
        self.file: Any = docx.Document()
        self.bookmarks = 0
        self.drawn: list[tuple[Any, Drawing]] = []
        section, properties = self.file.sections[0], self.file.core_properties
        section.page_width, section.page_height = Mm(WIDTH), Mm(HEIGHT)
        section.left_margin = section.right_margin = Mm(SIDE)
        section.top_margin = section.bottom_margin = Mm(TOP)
        section.header_distance = section.footer_distance = Mm(9)
        _set_styles(self.file, language)
        properties.title, properties.author = document.title[:255], document.author[:255]
        properties.comments, properties.language = f"assess {__version__}", language
        properties.created = properties.modified = report_time().replace(tzinfo=None)
        self._ids = {one.name: one.style_id for one in self.file.styles}

    def write(self, document: blocks.Document, style: str) -> None:
        """Write a document; `style` is the style sheet that drawings are drawn with."""
        self.write_blocks(document.cover)
        for section in document.sections:  # each on a new page unless it runs on
            if section.heading:
                is_new = {"run-on", "decision"}.isdisjoint(section.kind.split())
                self._head(section.heading, 1, section.id, is_new=is_new)
            self.write_blocks(section.blocks)
        pictures = draw_all([drawing for _run, drawing in self.drawn], style, self.progress)
        for (run, drawing), png in zip(self.drawn, pictures, strict=True):
            _add_picture(run, png, drawing.width, drawing.alternative)

    def write_blocks(self, found: Iterable[blocks.Block]) -> None:
        """Write blocks; an article behind another begins a page unless it is brief."""
        before: blocks.Block | None = None
        for one in found:
            self.progress.check()
            self._block(one, is_after_article=isinstance(before, blocks.Box) and before.tag == "article")
            before = one

    def _block(self, one: blocks.Block, *, is_after_article: bool) -> None:  # noqa: C901 - one case a kind of block
        match one:
            case blocks.Paragraph(words, kind):
                kinds = kind.split()
                style = next((_OF_KINDS[name] for name in kinds if name in _OF_KINDS), "Normal")
                self._paragraph(style, words, keep="lead-in" in kinds)
            case blocks.Title(words, short, status, conditions):
                self._write_margins(short, status, conditions)
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
                    self._add("Listing", text)
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
            start = _make("w:bookmarkStart", {"w:id": number, "w:name": name})
            paragraph._p.insert(1 if paragraph._p.pPr is not None else 0, start)
            paragraph._p.append(_make("w:bookmarkEnd", {"w:id": number}))

    def _write_margins(self, short: str, status: str, conditions: str) -> None:
        """Write the header and the footer: what every page has to say, the building, and the page of all pages."""
        section = self.file.sections[0]
        header, footer = section.header.paragraphs[0], section.footer.paragraphs[0]
        header.style = footer.style = self.file.styles["Small"]
        if conditions:
            header.add_run(conditions).bold = True
        footer.add_run(" · ".join(filter(None, (short, status))) + "\t")
        footer.paragraph_format.tab_stops.clear_all()
        footer.paragraph_format.tab_stops.add_tab_stop(Mm(SPACE), WD_TAB_ALIGNMENT.RIGHT)
        for text, field in ((_("Page") + " ", "PAGE"), (" " + _("of") + " ", "NUMPAGES")):
            footer.add_run(text)  # before what Word computes, and what it shows until then
            footer._p.append(_make("w:fldSimple", {"w:instr": field}, _make_run("w:t", "1")))

    def _add(self, style: str, text: str = "") -> Any:
        made = self.file.add_paragraph(text)
        self._set_style(made, style)
        return made

    def _set_style(self, paragraph: Any, style: str) -> None:
        if style != "Normal":  # by its identifier: looked up by name each takes milliseconds
            paragraph._p.style = self._ids[style]

    def _paragraph(self, style: str, words: blocks.Words, *, keep: bool = False) -> Any:
        paragraph = self._add(style)
        self._fill(paragraph, words)
        if keep:
            paragraph.paragraph_format.keep_with_next = True
        return paragraph

    def _contents(self, one: blocks.Contents) -> None:
        """Write a line for each heading, with a field for its page."""
        self._paragraph("Heading 2", one.heading)
        for line, _inner in one.lines:
            paragraph = self._add("Normal")
            link = next(span for span in blocks.list_words(line) if isinstance(span, blocks.Span))
            paragraph._p.append(
                _make("w:hyperlink", {"w:anchor": link.href[1:]}, _make_run("w:t", blocks.plain_words(line)))
            )
            paragraph.add_run("\t")
            page = {"w:instr": f"PAGEREF {link.href[1:]} \\h", "w:dirty": "true"}
            paragraph._p.append(_make("w:fldSimple", page, _make_run("w:t", "")))
            paragraph.paragraph_format.tab_stops.add_tab_stop(Mm(SPACE), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS)
            paragraph.paragraph_format.space_after = 0
        if one.after:
            self._paragraph("Small", one.after)

    # ------------------------------------------------------------ on a line

    def _fill(self, paragraph: Any, words: blocks.Words, look: Look | None = None) -> None:
        for one in blocks.list_words(words):
            self._inline(paragraph, one, look or Look())

    def _inline(self, paragraph: Any, one: blocks.Inline, look: Look) -> None:
        match one:
            case str():
                text = _SPACES.sub(" ", plain_text(one))
                text = text.replace(" ", NO_BREAK, 1) if look.ground else text  # a sign stays with its word
                if not text:
                    return
                run = paragraph.add_run(text)
                run.bold, run.italic = look.is_bold or None, look.is_italic or None
                run.font.subscript, run.font.superscript = look.rise == "sub" or None, look.rise == "sup" or None
                if look.ground:
                    _colour(run, look.ink)
                    _shade(run._r.get_or_add_rPr(), look.ground)
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
        if one.caption:
            self._paragraph("Caption", one.caption)
        rows = [row for group in one.groups for row in group]
        if any(column.heading for column in one.columns):
            rows.insert(0, blocks.Row([column.heading for column in one.columns], "head"))
        made = self.file.add_table(len(rows), len(one.columns))
        made.autofit = False
        widths, scale = _find_widths(one.columns, rows)
        for column, width in zip(made._tbl.tblGrid.gridCol_lst, widths, strict=True):
            column.w = Mm(width)
        for tr in made._tbl.tr_lst:
            for tc, width in zip(tr.tc_lst, widths, strict=True):
                tc.width = Mm(width)
        slots = [list(tr.tc_lst) for tr in made._tbl.tr_lst]
        for own, tr, row in zip(slots, made._tbl.tr_lst, rows, strict=True):
            self.progress.check()
            properties = tr.get_or_add_trPr()
            properties.append(_make("w:cantSplit", {}))
            if row.kind == "head":
                properties.append(_make("w:tblHeader", {}))
            is_head = row.kind in ("head", "part")
            for at, cell in row.place_cells():
                slot = _Cell(own[at], made)
                if cell.columns > 1:
                    slot = slot.merge(_Cell(own[at + cell.columns - 1], made))
                paragraph = slot.paragraphs[0]
                self._set_style(paragraph, "Cell Head" if is_head else "Cell")
                if one.columns[at].is_number and cell.columns == 1 and not cell.is_head:
                    paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
                paragraph.paragraph_format.keep_with_next = is_head
                self._fill(paragraph, cell.words, Look(is_bold=is_head or cell.is_head))
                for run in paragraph.runs if scale < 1 else ():  # else the words would not fit the page
                    run.font.size = Pt(round(max(SMALLEST, SIZE * scale), 1))
                if is_head:
                    _shade(slot._tc.get_or_add_tcPr(), _GROUND)
        _set_borders(made)
        self._add("Small")

    def _tiles(self, one: blocks.Tiles) -> None:
        """Write counts as one row of cells, each with the colour of its class."""
        made = self.file.add_table(1, len(one.tiles))
        for tc, tile in zip(made._tbl.tr_lst[0].tc_lst, one.tiles, strict=True):
            slot, colours = _Cell(tc, made), FILLS.get(tile.kind)
            for at, text in enumerate((tile.name, tile.number, tile.note)):
                paragraph = slot.paragraphs[0] if at == 0 else slot.add_paragraph()
                self._set_style(paragraph, "Cell")
                paragraph.alignment = WD_ALIGN_PARAGRAPH.CENTER
                run = paragraph.add_run(plain_text(text))
                run.bold, run.font.size = (True, Pt(18)) if at == 1 else (None, None)
                if colours:
                    _colour(run, colours[1])
            if colours:
                _shade(tc.get_or_add_tcPr(), colours[0])
        _set_borders(made)
        self._add("Small")


def _set_styles(file: Any, language: str) -> None:
    for name, (based, size, colour, is_bold, after) in _STYLES.items():
        style = file.styles.add_style(name, WD_STYLE_TYPE.PARAGRAPH) if based else file.styles[name]
        if based:
            style.base_style = file.styles[based]
        else:
            style.font.italic = False
        style.font.name, style.font.size, style.font.color.rgb = FACE, Pt(size), RGBColor.from_string(colour)
        style.font.bold = is_bold
        for spacing in style.element.get_or_add_rPr().findall(qn("w:spacing")):
            spacing.getparent().remove(spacing)
        fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
        for key in list(fonts.attrib):
            if key.endswith("Theme"):
                del fonts.attrib[key]
        for kind in ("ascii", "hAnsi", "cs", "eastAsia"):
            fonts.set(qn(f"w:{kind}"), FACE)
        style.paragraph_format.space_before = Pt(10 if "Heading" in name else 0)
        style.paragraph_format.space_after = Pt(after)
        style.paragraph_format.line_spacing = 1.1 if name in ("Normal", "Lead", "Caution") else 1.0
    file.styles["Listing"].font.name = FIXED
    for name in ("Heading 1", "Heading 2", "Heading 3", "Caption"):
        file.styles[name].paragraph_format.keep_with_next = True
    rule = _make("w:left", {"w:val": "single", "w:sz": "24", "w:space": "8", "w:color": WARNING})
    file.styles["Caution"].element.get_or_add_pPr().append(_make("w:pBdr", {}, rule))
    defaults = file.styles.element.find(f"{qn('w:docDefaults')}/{qn('w:rPrDefault')}/{qn('w:rPr')}")
    if defaults is not None:
        for one in defaults.findall(qn("w:lang")):
            defaults.remove(one)
        defaults.append(_make("w:lang", {"w:val": language}))


def _make(name: str, attributes: dict[str, str], *inside: Any) -> Any:
    """Return an element of WordprocessingML, ``w:shd``, with what stands inside."""
    element: Any = OxmlElement(name)
    for key, value in attributes.items():
        element.set(qn(key), value)
    element.extend(inside)
    return element


def _make_run(name: str, text: str) -> Any:
    """Return a run with an element that holds a text, ``w:t``."""
    element = _make(name, {})
    element.text = text
    return _make("w:r", {}, element)


def _shade(properties: Any, colour: str) -> None:
    """Fill the ground of a cell or a run; `properties` is its ``w:tcPr`` or ``w:rPr``."""
    properties.append(_make("w:shd", {"w:val": "clear", "w:color": "auto", "w:fill": colour.lstrip("#").upper()}))


def _colour(run: Any, ink: str) -> None:
    run.font.color.rgb = RGBColor.from_string(ink.lstrip("#").upper())


def _add_picture(run: Any, data: bytes, width: float, alternative: str) -> None:
    """Add a picture to a run, with its text for those who do not see it."""
    shape = run.add_picture(io.BytesIO(data), width=Mm(width))
    shape._inline.docPr.set("descr", plain_text(alternative)[:1000])


def _set_borders(table: Any) -> None:
    borders, margins = _make("w:tblBorders", {}), _make("w:tblCellMar", {})
    for side in ("top", "left", "bottom", "right", "insideH", "insideV"):
        value = "single" if side in ("top", "bottom", "insideH") else "nil"
        colour = HEAD if side in ("top", "bottom") else _RULE
        borders.append(_make(f"w:{side}", {"w:val": value, "w:sz": "4", "w:space": "0", "w:color": colour}))
    for side, width in (("top", "25"), ("left", "60"), ("bottom", "25"), ("right", "60")):
        margins.append(_make(f"w:{side}", {"w:w": width, "w:type": "dxa"}))
    table._tbl.tblPr.extend((borders, margins))


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
