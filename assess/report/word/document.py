"""A document of Word: its styles, its header and footer, and how it is saved."""

import io
import zipfile
from pathlib import Path
from typing import Any

from assess.i18n import gettext as _
from assess.progress import Progress
from assess.report.blocks import Document
from assess.report.provenance import report_time
from assess.version import __version__

FACE, FIXED = "Arial", "Courier New"
"""Faces that every word processor has, or replaces by one of the same widths."""
HEAD, INK, QUIET, WARNING = "1F3A4D", "1C1C1C", "4A4F54", "8C1D3F"
"""Colours of headings, text, captions and cautions, as in the style sheets."""
WIDTH, HEIGHT, SIDE, TOP = 210.0, 297.0, 22.0, 20.0
"""The page and its margins [mm]."""

_STYLES = {
    "Title": ("", 24, HEAD, True, 6), "Subtitle": ("", 12, QUIET, False, 6),
    "Heading 1": ("", 16, HEAD, True, 6), "Heading 2": ("", 12.5, HEAD, True, 4),
    "Heading 3": ("", 11, HEAD, True, 3), "Normal": ("", 10, INK, False, 6), "Caption": ("", 9, QUIET, False, 3),
    "List Bullet": ("", 10, INK, False, 2), "List Number": ("", 10, INK, False, 2),
    "Lead": ("Normal", 11, INK, None, 8), "Caution": ("Normal", 10, INK, None, 8),
    "Small": ("Normal", 9, QUIET, None, 4), "Cell": ("Normal", 9, INK, None, 0),
    "Cell Head": ("Cell", 9, HEAD, True, 0), "Listing": ("Normal", 7.5, INK, None, 0),
}  # fmt: skip
"""Styles: the one that each is based on ("" of those that Word has), size [pt], colour, whether bold, space after [pt].
"""


class Word:
    """A document of Word that is being written."""

    def __init__(self, document: Document, language: str, progress: Progress) -> None:
        import docx
        from docx.shared import Mm

        self.progress = progress
        self.file: Any = docx.Document()
        section = self.file.sections[0]
        section.page_width, section.page_height = Mm(WIDTH), Mm(HEIGHT)
        section.left_margin = section.right_margin = Mm(SIDE)
        section.top_margin = section.bottom_margin = Mm(TOP)
        section.header_distance = section.footer_distance = Mm(9)
        _set_styles(self.file, language)
        properties = self.file.core_properties
        properties.title, properties.author = document.title[:255], document.author[:255]
        properties.comments, properties.language = f"assess {__version__}", language
        properties.created = properties.modified = report_time().replace(tzinfo=None)
        self._ids = {one.name: one.style_id for one in self.file.styles}

    def add(self, style: str, text: str = "") -> Any:
        """Add a paragraph and return it."""
        made = self.file.add_paragraph(text)
        self.set_style(made, style)
        return made

    def set_style(self, paragraph: Any, style: str) -> None:
        """Set the style of a paragraph, by its identifier: looked up by name each takes milliseconds."""
        if style != "Normal":
            paragraph._p.style = self._ids[style]

    def save(self, path: Path) -> None:
        """Write the document; times inside it are those of the report, so that the same run makes the same bytes."""
        packed = io.BytesIO()
        self.file.save(packed)
        with zipfile.ZipFile(packed) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
            for one in source.infolist():
                self.progress.check()
                entry = zipfile.ZipInfo(one.filename, (1980, 1, 1, 0, 0, 0))
                entry.compress_type = zipfile.ZIP_DEFLATED
                target.writestr(entry, source.read(one))


def _set_styles(file: Any, language: str) -> None:
    from docx.enum.style import WD_STYLE_TYPE
    from docx.shared import Pt, RGBColor

    for name, (based, size, colour, is_bold, after) in _STYLES.items():
        style = file.styles.add_style(name, WD_STYLE_TYPE.PARAGRAPH) if based else file.styles[name]
        if based:
            style.base_style = file.styles[based]
        else:
            style.font.italic = False
        style.font.name, style.font.size, style.font.color.rgb = FACE, Pt(size), RGBColor.from_string(colour)
        style.font.bold = is_bold
        fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
        for key in list(fonts.attrib):
            if key.endswith("Theme"):
                del fonts.attrib[key]
        for kind in ("ascii", "hAnsi", "cs", "eastAsia"):
            fonts.set(_q(f"w:{kind}"), FACE)
        style.paragraph_format.space_before = Pt(10 if "Heading" in name else 0)
        style.paragraph_format.space_after = Pt(after)
        style.paragraph_format.line_spacing = 1.1 if name in ("Normal", "Lead", "Caution") else 1.0
    file.styles["Listing"].font.name = FIXED
    for name in ("Heading 1", "Heading 2", "Heading 3", "Caption"):
        file.styles[name].paragraph_format.keep_with_next = True
    borders = make("w:pBdr")
    borders.append(make("w:left", {"w:val": "single", "w:sz": "24", "w:space": "8", "w:color": WARNING}))
    file.styles["Caution"].element.get_or_add_pPr().append(borders)
    defaults = file.styles.element.find(f"{_q('w:docDefaults')}/{_q('w:rPrDefault')}/{_q('w:rPr')}")
    if defaults is not None:
        for one in defaults.findall(_q("w:lang")):
            defaults.remove(one)
        defaults.append(make("w:lang", {"w:val": language}))


def write_margins(word: Word, short: str, status: str, conditions: str) -> None:
    """Write the header and the footer: what every page has to say, the building, and the page of all pages."""
    from docx.enum.text import WD_TAB_ALIGNMENT
    from docx.shared import Mm

    section = word.file.sections[0]
    header, footer = section.header.paragraphs[0], section.footer.paragraphs[0]
    header.style = footer.style = word.file.styles["Small"]
    if conditions:
        run = header.add_run(conditions)
        run.bold = True
    footer.add_run(" · ".join(filter(None, (short, status))) + "\t")
    footer.paragraph_format.tab_stops.clear_all()
    footer.paragraph_format.tab_stops.add_tab_stop(Mm(WIDTH - 2 * SIDE), WD_TAB_ALIGNMENT.RIGHT)
    for text, field in ((_("Page") + " ", "PAGE"), (" " + _("of") + " ", "NUMPAGES")):
        footer.add_run(text)
        shown = make("w:fldSimple", {"w:instr": field})  # what Word computes, and what it shows until then
        shown.append(make_run("w:t", "1"))
        footer._p.append(shown)


def make(name: str, attributes: dict[str, str] | None = None) -> Any:
    """Return an element of WordprocessingML, ``w:shd``."""
    from docx.oxml import OxmlElement

    element = OxmlElement(name)
    for key, value in (attributes or {}).items():
        element.set(_q(key), value)
    return element


def _q(name: str) -> str:
    from docx.oxml.ns import qn

    return str(qn(name))


def make_run(name: str, text: str) -> Any:
    """Return a run with an element that holds a text, ``w:t``."""
    run, element = make("w:r"), make(name)
    element.text = text
    run.append(element)
    return run


def shade(properties: Any, colour: str) -> None:
    """Fill the ground of a cell or a run; `properties` is its ``w:tcPr`` or ``w:rPr``."""
    properties.append(make("w:shd", {"w:val": "clear", "w:color": "auto", "w:fill": colour.lstrip("#").upper()}))
