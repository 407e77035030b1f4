"""The HTML report: one file, nothing fetched, every text of the workbook escaped."""

import traceback
from pathlib import Path
from typing import Any

from assess.errors import InputError
from assess.report.content import build_content
from assess.report.look import Look
from assess.report.pages.context import FILTERS, GLOBALS, build_context
from assess.report.pages.fonts import font_faces
from assess.report.words import class_name
from assess.results import Assessment
from assess.risk import RiskClass


def write_html(assessment: Assessment, path: Path, look: Look) -> None:
    """Write report.html; raises InputError where a template of the firm's own cannot be used."""
    path.write_text(render(assessment, look), encoding="utf-8")


def render(assessment: Assessment, look: Look | None = None, *, for_print: bool = False) -> str:
    """Return the report as HTML in the language in use (see `Look.spoken`).

    `for_print` takes the style of the page and the embedded fonts of the PDF, and leaves the script out.

    Raises
    ------
    InputError
        If a template cannot be used: it names the file, the line and what is the matter.
    """
    from jinja2 import TemplateError
    from jinja2.exceptions import SecurityError

    look = look or Look()
    context = build_context(build_content(assessment), look, for_print=for_print)
    try:
        page: str = _environment(look).get_template("report.html.j2").render(**context, style=_style(look, for_print))
    except (TemplateError, SecurityError, TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
        if look.templates is None:
            raise  # ours are right, or it is a fault of ours
        raise InputError(_describe(error, look)) from None
    return page


def check_look(look: Look) -> None:
    """Raise InputError if a template or catalogue of the firm's own cannot be read: before the long work.

    What only shows when a report is rendered, such as an undefined name, `render` tells.
    """
    from jinja2 import TemplateError

    if look.templates is None:
        return
    with look.spoken():
        environment = _environment(look)
        for path in sorted(look.templates.rglob("*.j2")):
            try:
                environment.get_template(path.relative_to(look.templates).as_posix())
            except TemplateError as error:
                raise InputError(_describe(error, look)) from None


def _describe(error: Exception, look: Look) -> str:
    """Return where in the templates something is wrong, and what."""
    name, line = getattr(error, "name", None), getattr(error, "lineno", None)
    if line is None:  # one that came up while rendering has its place in the traceback alone
        frames = [one for one in traceback.extract_tb(error.__traceback__) if one.filename.endswith(".j2")]
        name, line = (_place(Path(frames[-1].filename), look), frames[-1].lineno) if frames else (name, None)
    place = f"{name or 'a template'}{f', line {line}' if line else ''}"
    return f"--template: {place}: {error}"


def _place(path: Path, look: Look) -> str:
    """Return the name of a template within its folder."""
    return next(path.relative_to(folder).as_posix() for folder in look.folders if path.is_relative_to(folder))


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
    environment.filters |= FILTERS
    environment.globals |= GLOBALS
    return environment


def _style(look: Look, for_print: bool) -> str:
    names = ("base.css", "print.css") if for_print else ("base.css", "screen.css")
    sheets = [font_faces()] if for_print else []
    return "\n".join([*sheets, _class_colours(), *(look.read(f"style/{name}") for name in names)])


def _class_colours() -> str:
    return "\n".join(f".{class_name(risk)} {{ background: {risk.fill}; color: {risk.ink}; }}" for risk in RiskClass)
