"""The HTML report: one file, nothing fetched, every text of the workbook escaped."""

import base64
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from assess import resources
from assess.errors import InputError
from assess.language import gettext, markup, nmarkup
from assess.motion.scenario import PROFILES
from assess.report import content as content_module
from assess.report import motions, trials, verified, words
from assess.report.content import Content, build_content
from assess.report.figures import draw_all
from assess.report.look import Look
from assess.report.rocked import choose_traced, draw_traced
from assess.results import Assessment

MOST_ROWS = 1000
"""Rows of the item tables that HTML and PDF show; the Excel report holds all."""


def write_html(assessment: Assessment, path: Path, look: Look) -> None:
    """Write report.html; raises InputError where a template of the firm's own cannot be used."""
    path.write_text(render(assessment, look), encoding="utf-8")


def render(assessment: Assessment, look: Look | None = None, *, for_print: bool = False) -> str:
    """Return the report as HTML; `for_print` adds the style of the page and the embedded fonts of the PDF.

    The language is the one in use: see `Look.spoken`.

    Raises
    ------
    InputError
        If a template cannot be used: it names the file, the line and what is the matter.
    """
    from jinja2 import TemplateError

    try:
        return _render_content(build_content(assessment), look or Look(), for_print)
    except TemplateError as error:
        raise InputError(_describe(error)) from None


def _describe(error: Any) -> str:
    """Return where in the templates something is wrong, and what."""
    name, line = getattr(error, "name", None), getattr(error, "lineno", None)
    if line is None:  # one that came up while rendering has its place in the traceback alone
        frames = [one for one in traceback.extract_tb(error.__traceback__) if one.filename.endswith((".j2", ".css"))]
        name, line = (Path(frames[-1].filename).name, frames[-1].lineno) if frames else (name, None)
    place = f"{name or 'a template'}{f', line {line}' if line else ''}"
    return f"--template: {place}: {error.message or type(error).__name__}"


def _environment(look: Look) -> Any:
    """Return where templates are rendered: a sandbox that escapes every text and is strict about names."""
    from jinja2 import FileSystemLoader, StrictUndefined
    from jinja2.sandbox import ImmutableSandboxedEnvironment

    environment = ImmutableSandboxedEnvironment(
        loader=FileSystemLoader(look.folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= _FILTERS
    environment.globals |= {"_": markup, "ngettext": nmarkup}
    return environment


def _render_content(content: Content, look: Look, for_print: bool) -> str:
    environment = _environment(look)
    traced = choose_traced(content)
    drawn = draw_all(content) | draw_traced(content, traced)
    figures = {name: _data_uri(svg, "image/svg+xml") for name, svg in drawn.items()}
    page: str = environment.get_template("report.html.j2").render(
        content=content,
        figures=_Figures(figures),
        logo=_logo(content),
        style=_style(look, for_print),
        language=look.language,
        for_print=for_print,
        most_rows=MOST_ROWS,
        used_profiles=motions.used_profiles(content.assessment.demands),
        traced=traced,
        summary_lines=verified.list_summary(content.verified),
        **_NAMES,
    )
    return page


class _Figures(dict[str, str]):
    """The figures by name; "" where a report has none of that name."""

    def __missing__(self, name: str) -> str:
        return ""


_NAMES: Mapping[str, Any] = {
    "treatment": motions.describe_treatment,
    "source": motions.describe_source,
    "origin": motions.describe_origin,
    "profiles": tuple(PROFILES.values()),
    "status": motions.profile_status,
    "clauses": motions.list_clauses,
    "envelopes": motions.ENVELOPES,
    "more": content_module.has_worse_motion,
    "marks": words.MARKS,
    "listed": trials.LISTED,
}
_FILTERS: Mapping[str, Any] = {
    "clip": words.clip,
    "percent": words.percent,
    "in_g": words.in_g,
    "in_cm_s": words.in_cm_s,
    "in_m": words.in_m,
    "fixed": words.fixed,
    "size": words.size,
    "risk_words": words.risk_words,
    "risk_notes": words.risk_notes,
    "class_marks": words.class_marks,
    "chance": words.chance,
    "under_record": words.under_record,
    "class_name": words.class_name,
    "plural": words.plural,
    "say": gettext,
}


def _style(look: Look, for_print: bool) -> str:
    names = ("base.css", "print.css") if for_print else ("base.css", "screen.css")
    sheets = [_font_faces()] if for_print else []
    return "\n".join([*sheets, _class_colours(), *(look.read(f"style/{name}") for name in names)])


def _class_colours() -> str:
    from assess.risk import RiskClass

    return "\n".join(
        f".{words.class_name(risk)} {{ background: {risk.fill}; color: {risk.ink}; }}" for risk in RiskClass
    )


def _font_faces() -> str:
    """Embed the fonts, so that a machine without any renders the same PDF."""
    faces = []
    for (family, style), path in resources.fonts().items():
        weight = "bold" if style == "bold" else "normal"
        slant = "italic" if style == "italic" else "normal"
        source = _data_uri(path.read_bytes(), "font/ttf")
        faces.append(
            f"@font-face {{ font-family: {family}; font-weight: {weight}; font-style: {slant}; src: url({source}); }}"
        )
    return "\n".join(faces)


def _logo(content: Content) -> str:
    path = content.assessment.inventory.building.logo
    if path is None:
        return ""
    data = path.read_bytes()
    return _data_uri(data, "image/png" if data.startswith(b"\x89PNG") else "image/jpeg")


def _data_uri(data: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
