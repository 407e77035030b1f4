"""What stands within a line: text, bold and italic, links, signs with the colour of their class, pictures."""

import io
import re
from dataclasses import dataclass, replace
from typing import Any

from assess.plain_text import plain_text
from assess.report.word.document import Word, make, shade
from assess.report.word.drawings import MARK
from assess.report.words import NO_BREAK, class_name
from assess.risk import RiskClass

FILLS = {
    **{class_name(risk): (risk.fill, risk.ink) for risk in RiskClass},
    "anchored": ("#e3e3e3", "#1c1c1c"),
}
"""Ground and ink of badges and tiles, by their class in the page."""
PICTURE = "data:image/"
LOGO, PHOTO = 40.0, 24.0
"""Widths of a logo and of a photo of a piece [mm]."""
_SPACE = re.compile(r"[ \t\r\n\f]+")
_BOLD, _ITALIC = ("strong", "b", "th", "dt"), ("em", "i")
_LEFT_OUT = ("script", "style", "title", "col", "colgroup", "wbr")


@dataclass(frozen=True, slots=True)
class Look:
    """How text looks: what the tags around it say."""

    is_bold: bool = False
    is_italic: bool = False
    rise: str = ""
    ground: str = ""
    ink: str = ""


class Line:
    """One paragraph of Word that is being filled; white space is joined as a browser joins it."""

    def __init__(self, word: Word, paragraph: Any) -> None:
        self.word, self.paragraph = word, paragraph
        self.is_at_space = True

    def fill(self, element: Any, look: Look | None = None) -> None:
        """Write all that an element holds, with its own tag taken into account."""
        look = _look(element, look or Look())
        self.write(element.text, look)
        for child in element:
            if isinstance(child.tag, str) and child.tag not in _LEFT_OUT:
                self._open(child, look)
            self.write(child.tail, look)

    def _open(self, child: Any, look: Look) -> None:
        classes = child.get("class", "").split()
        if child.tag == "br":
            self.paragraph.add_run().add_break()
            self.is_at_space = True
        elif child.tag == "img":
            if "photo" in classes:
                self.paragraph.add_run().add_break()
            shown = find_picture(self.word, child)
            if shown is not None:
                add_picture(self.paragraph, *shown)
                self.is_at_space = False
        elif "hidden" not in classes and child.get("aria-hidden") != "true":
            if child.tag in ("p", "div", "li", "ul", "figure") and self.paragraph.runs:
                self.paragraph.add_run().add_break()
                self.is_at_space = True
            self.fill(child, look)

    def write(self, text: str | None, look: Look) -> None:
        """Write text, its white space as single spaces."""
        said = _SPACE.sub(NO_BREAK if look.ground else " ", plain_text(text or ""))
        said = said.lstrip(" ") if self.is_at_space else said
        if said:
            self.is_at_space = said.endswith(" ")
            _dress(self.paragraph.add_run(said), look)


def _look(element: Any, look: Look) -> Look:
    classes = element.get("class", "").split()
    look = replace(look, is_bold=True) if element.tag in _BOLD else look
    look = replace(look, is_italic=True) if element.tag in _ITALIC else look
    look = replace(look, rise=element.tag) if element.tag in ("sub", "sup") else look
    if "badge" in classes:
        for name in classes:
            if name in FILLS:
                look = replace(look, ground=FILLS[name][0], ink=FILLS[name][1])
    return look


def _dress(run: Any, look: Look) -> None:
    run.bold = look.is_bold or None
    run.italic = look.is_italic or None
    run.font.subscript = look.rise == "sub" or None
    run.font.superscript = look.rise == "sup" or None
    if look.ground:
        from docx.shared import RGBColor

        run.font.color.rgb = RGBColor.from_string(look.ink.lstrip("#").upper())
        shade(run._r.get_or_add_rPr(), look.ground)


def find_picture(word: Word, image: Any) -> tuple[bytes, float, str] | None:
    """Return the bytes of an image of the page, its width [mm] and what it says; None where there is none."""
    mark = image.get(MARK)
    if mark is not None:
        picture = word.pictures[int(mark)]
        return picture.png, picture.width, picture.alternative
    source = image.get("src", "")
    if not source.startswith(PICTURE):
        return None
    import base64

    width = PHOTO if "photo" in image.get("class", "").split() else LOGO
    return base64.b64decode(source.partition(",")[2]), width, image.get("alt", "")


def add_picture(paragraph: Any, data: bytes, width: float, alternative: str) -> None:
    """Add a picture to a paragraph, with its text for those who do not see it."""
    from docx.shared import Mm

    shape = paragraph.add_run().add_picture(io.BytesIO(data), width=Mm(width))
    shape._inline.docPr.set("descr", plain_text(alternative)[:1000])


def mark_place(word: Word, paragraph: Any, name: str) -> None:
    """Make a paragraph a place that links lead to."""
    word.bookmarks += 1
    number = str(word.bookmarks)
    paragraph._p.insert(
        1 if paragraph._p.pPr is not None else 0, make("w:bookmarkStart", {"w:id": number, "w:name": name})
    )
    paragraph._p.append(make("w:bookmarkEnd", {"w:id": number}))
