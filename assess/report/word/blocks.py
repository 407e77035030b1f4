"""The page as blocks of Word: headings, paragraphs, lists, tables, figures, in their order."""

from collections.abc import Callable, Mapping
from typing import Any

from assess.report.word.document import Word, make, write_margins
from assess.report.word.runs import Line, Look, add_picture, find_picture, mark_place
from assess.report.word.word_tables import write_table, write_tiles

HEADINGS = {"h1": "Title", "h2": "Heading 1", "h3": "Heading 2", "h4": "Heading 3"}
"""Styles of the headings of the page."""
STYLES = {"lead": "Lead", "caution": "Caution", "small": "Small", "legend": "Small", "note": "Small",
          "kind": "Subtitle", "scenario": "Subtitle"}  # fmt: skip
"""Styles of paragraphs by their class in the page; the others are plain."""
_LEFT_OUT = ("script", "style", "conditions")


def write_page(word: Word, page: str) -> None:
    """Write all that stands in the body of a page of HTML, whose drawings are marks (`drawings.take_drawings`)."""
    from lxml import html

    body = html.fromstring(page).find("body")
    title = next(body.iter("h1"), None)
    if title is not None:
        names = ("data-short", "data-status", "data-conditions", "data-page", "data-of")
        write_margins(word, *(title.get(name, "") for name in names))
    _write_inside(word, body)


def _write_inside(word: Word, element: Any) -> None:
    for child in element:
        word.progress.check()
        if isinstance(child.tag, str):
            _write(word, child)


def _write(word: Word, element: Any) -> None:
    classes = element.get("class", "").split()
    if any(name in (element.tag, *classes) for name in _LEFT_OUT) or "hidden" in classes:
        return
    if "tiles" in classes:
        write_tiles(word, element)
    elif "contents" in classes:
        _write_contents(word, element)
    else:
        _WRITERS.get(element.tag, _write_inside)(word, element)


def _write_heading(word: Word, heading: Any) -> None:
    paragraph = word.add(HEADINGS[heading.tag])
    Line(word, paragraph).fill(heading)
    around = heading.getparent()
    is_first = around is not None and next(around.iterchildren()) is heading
    if is_first and around.tag in ("section", "article"):
        classes = around.get("class", "").split()
        is_new = around.tag == "section" and "run-on" not in classes
        is_next = around.tag == "article" and "brief" not in classes and around.getprevious().tag == "article"
        paragraph.paragraph_format.page_break_before = is_new or is_next
        if around.get("id"):
            mark_place(word, paragraph, around.get("id"))


def _write_paragraph(word: Word, element: Any) -> None:
    styles = [STYLES[name] for name in element.get("class", "").split() if name in STYLES]
    paragraph = word.add(styles[0] if styles else "Normal")
    Line(word, paragraph).fill(element)
    paragraph.paragraph_format.keep_with_next = "lead-in" in element.get("class", "").split() or None


def _write_list(word: Word, element: Any) -> None:
    style = "List Number" if element.tag == "ol" else "List Bullet"
    for item in element.iterchildren("li"):
        Line(word, word.add(style)).fill(item)


def _write_terms(word: Word, element: Any) -> None:
    for term in element.iter("dt"):
        line = Line(word, word.add("Normal"))
        line.fill(term)
        meaning = term.getnext()
        if meaning is not None and meaning.tag == "dd":
            line.write(": ", Look())
            line.fill(meaning)


def _write_listing(word: Word, element: Any) -> None:
    for text in "".join(element.itertext()).splitlines():
        word.add("Listing", text)


def _write_image(word: Word, element: Any) -> None:
    shown = find_picture(word, element)
    if shown is not None:
        paragraph = word.add("Normal")
        paragraph.paragraph_format.keep_with_next = True
        add_picture(paragraph, *shown)


def _write_contents(word: Word, element: Any) -> None:
    """Write the contents: a field that Word fills with pages, which shows the headings until then."""
    for heading in element.iterchildren("h2"):
        Line(word, word.add("Subtitle")).fill(heading)
    paragraph = word.add("Normal")
    paragraph._p.append(_field_part("begin"))
    code = make("w:r")
    text = make("w:instrText")
    text.text = ' TOC \\o "1-1" \\h \\z '
    code.append(text)
    paragraph._p.append(code)
    paragraph._p.append(_field_part("separate"))
    links = [one for one in element.iter("a") if one.get("href", "").startswith("#")]
    top = [one for one in links if sum(1 for above in one.iterancestors("ol")) == 1]
    for at, link in enumerate(top):
        if at:
            paragraph = word.add("Normal")
        _add_link(paragraph, link)
        paragraph.paragraph_format.space_after = 0
        if at == len(top) - 1:
            paragraph._p.append(_field_part("end"))
    for note in element.iterchildren("p"):
        _write_paragraph(word, note)


def _field_part(kind: str) -> Any:
    run = make("w:r")
    run.append(make("w:fldChar", {"w:fldCharType": kind}))
    return run


def _add_link(paragraph: Any, link: Any) -> None:
    """Add a line of the contents: the heading, as a link to it, and the field of its page."""
    target = link.get("href")[1:]
    made = make("w:hyperlink", {"w:anchor": target})
    run = make("w:r")
    text = make("w:t")
    text.text = " ".join("".join(link.itertext()).split())
    run.append(text)
    made.append(run)
    paragraph._p.append(made)


_WRITERS: Mapping[str, Callable[[Word, Any], None]] = {
    **dict.fromkeys(HEADINGS, _write_heading),
    "figcaption": lambda word, element: Line(word, word.add("Caption")).fill(element),
    "p": _write_paragraph, "ul": _write_list, "ol": _write_list, "dl": _write_terms,
    "table": write_table, "pre": _write_listing, "img": _write_image,
}  # fmt: skip
"""What writes an element, by its tag; of any other, what stands inside it is written."""
