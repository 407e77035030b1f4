"""Documents as HTML: one file, nothing fetched, every text of the workbook escaped."""

import base64
import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markupsafe import Markup

from assess.errors import Problem
from assess.i18n import fill, gettext as _
from assess.progress import SILENT, Progress
from assess.report.blocks import Document
from assess.report.content import Content
from assess.report.cover import build_document
from assess.report.figures.math_figures import write_letters
from assess.report.fonts import font_faces, web_font_faces
from assess.report.html_blocks import HtmlWriter
from assess.report.report_options import ReportOptions
from assess.report.sections.methods import is_drawn
from assess.report.templates import render_template
from assess.report.view import Edition, View
from assess.report.words import apart_label, class_name, risk_label
from assess.risk import RiskClass
from assess.version import __version__

_HIDDEN = 'width="0" height="0" aria-hidden="true" style="position: absolute"'


@dataclass(frozen=True, kw_only=True)
class PageSection:
    """A section as the template of a page places it: `html` holds its heading and all that stands in it."""

    id: str
    heading: str
    html: Markup


@dataclass(frozen=True, kw_only=True)
class Page:
    """What the template page.html.j2 shows: a firm's own places `cover`, `sections` and `contents` as it likes.

    * `document`: title, author, description, keywords, conditions and kind.
    * `language`: its code.
    * `version`: of `assess`.
    * `for_print`: whether it is laid out as a PDF.
    * `style`, `script`, `script_hash`: the style sheets and the script of the page, and the hash that allows it.
    * `cover`, `contents`: HTML of what stands above the sections, and of the contents, "" where the cover has them.
    * `sections`: in the order of the edition.
    * `outlines`: SVG with the letters of equations, which the page holds once.
    * `filters`: classes by which the rows of all pieces can be filtered, as value and words; none without a script.
    """

    document: Document
    language: str
    for_print: bool
    style: Markup
    script: Markup
    script_hash: str
    cover: Markup
    contents: Markup
    sections: Sequence[PageSection]
    outlines: Markup
    filters: Sequence[tuple[str, str]] = ()
    version: str = __version__


def write_html(content: Content, path: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write report.html; raises InputError where a template of the firm's own cannot be used."""
    problems = progress.wait_for(lambda: list_missing_figures(content))
    page = render(content.with_problems(problems), options, progress=progress)
    path.write_text(page, encoding="utf-8")


def render(
    content: Content, options: ReportOptions | None = None, *, for_print: bool = False, edition: Edition = "all",
    progress: Progress = SILENT,
) -> str:  # fmt: skip
    """Return the report as HTML in the language in use (see `ReportOptions.spoken`).

    `for_print` takes the style and fonts of the PDF, without the script; `edition` its sections (`assess.report.view`).
    Raises InputError with file, line and reason if a template cannot be used; CancelledError if the work was cancelled.
    """
    options = options or ReportOptions()
    view = View(content=content, edition=edition, for_print=for_print, options=options, progress=progress)
    document = progress.wait_for(lambda: build_document(view))
    if for_print:
        styles = ("edition.css", *(("work.css",) if edition == "work" else ()))
        return render_document(document, options, *styles, for_print=True, progress=progress)
    total = content.total
    filters = [(class_name(risk), risk_label(risk)) for risk in RiskClass]
    filters += [("apart-unconfirmed", apart_label("unconfirmed"))] if total.unconfirmed else []
    filters += [("apart-formula", apart_label("formula"))] if total.by_formula else []
    filters += [("apart-rolls", apart_label("rolls"))] if total.rolls else []
    filters += [("anchored", _("anchored"))]
    filters, script = filters if content.results else [], options.read("script/report.js")
    return render_document(document, options, script=script, filters=filters, progress=progress)


def render_document(
    document: Document, options: ReportOptions, *styles: str, for_print: bool = False, script: str = "",
    filters: Sequence[tuple[str, str]] = (), template: str = "page.html.j2", more: Mapping[str, Any] | None = None,
    progress: Progress = SILENT,
) -> str:  # fmt: skip
    """Return a document as HTML with `styles` besides those of every page; raises what `render` does.

    A `template` of its own shows the `Page`, and `more` by name.
    """
    writer = HtmlWriter(for_print=for_print)

    def as_html(text: str) -> Markup:
        return Markup(text)  # noqa: S704 - written by this program, which escapes every text

    page = Page(
        document=document, language=options.spoken_language, for_print=for_print, filters=filters,
        style=as_html(build_style(options, for_print, *styles)), script=as_html(script),
        script_hash=hash_script(script), cover=as_html(writer.write_blocks(document.cover)),
        sections=[PageSection(id=one.id, heading=one.heading, html=as_html(writer.section(one)))
                  for one in progress.checked(document.sections)],
        contents=as_html(writer.write_blocks([document.contents]) if document.contents else ""),
        outlines=as_html(f"<svg {_HIDDEN}>{write_letters(writer.letters)}</svg>" if writer.letters else ""),
    )  # fmt: skip
    return render_template(template, options, {"page": page, **(more or {})}, progress)


def list_missing_figures(content: Content) -> list[Problem]:
    """Return a note that names the figures which are left out because the file with their series is gone."""
    if content.run.series.is_there:
        return []
    named = {
        _("risk over breadth and acceleration"): any(not one.is_anchored for one in content.results),
        _("motions and rotations of simulated pieces"): bool(content.verified.done),
        _("recorded motions"): any(is_drawn(one) for page in content.floors for one in page.motions),
        _("the logo"): content.run.building.logo is not None,
        _("plans under the pieces"): any(floor.plan for floor in content.run.floor_rows),
        _("photos of pieces"): any("photo" in item.more for item in content.run.item_rows),
    }
    names = ", ".join(name for name, is_there in named.items() if is_there)
    text = fill("Figures are left out, as the file of series of this run is gone: {names}.", names=names)
    return [Problem("note", "", "", text)] if names else []


def build_style(options: ReportOptions, for_print: bool, *more: str) -> str:
    """Return the style of a page: what screen and print share, one of them, and `more` files."""
    names = ("base.css", "print.css" if for_print else "screen.css", *more)
    colours = [f".{class_name(risk)} {{ background: {risk.fill}; color: {risk.ink}; }}" for risk in RiskClass]
    fonts = font_faces() if for_print else web_font_faces()
    return "\n".join([fonts, *colours, *(options.read(f"style/{name}") for name in names)])


def hash_script(text: str) -> str:
    """Return the source expression that allows an inline script of exactly this text.

    Source: W3C, Content Security Policy Level 3, section 2.3.1 (hash-source).
    """
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode()}"
