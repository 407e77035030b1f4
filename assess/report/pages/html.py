"""The HTML report: one file, nothing fetched, every text of the workbook escaped."""

import base64
import hashlib
import re
import traceback
from collections.abc import Mapping
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from assess.errors import InputError, Problem
from assess.progress import SILENT, Progress
from assess.report.content import Content
from assess.report.equations import Part, split_line
from assess.report.figures.math_figures import draw_math, write_letters
from assess.report.fonts import font_faces, web_font_faces
from assess.report.pages.context import FILTERS, GLOBALS, build_context, list_missing_figures
from assess.report.pages.editions import Edition
from assess.report.report_options import ReportOptions
from assess.report.words import class_name, list_breaks
from assess.risk import RiskClass

SCRIPT = "script/report.js"


def write_html(content: Content, path: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write report.html; raises InputError where a template of the firm's own cannot be used."""
    problems = progress.wait_for(lambda: list_missing_figures(content))
    page = render(with_problems(content, problems), options, progress=progress)
    path.write_text(page, encoding="utf-8")


def with_problems(content: Content, problems: list[Problem]) -> Content:
    """Return content whose data-quality log lists further problems, which concern one format alone."""
    if not problems:
        return content
    return replace(content, run=replace(content.run, problem_rows=(*content.run.problem_rows, *problems)))


def render(
    content: Content,
    options: ReportOptions | None = None,
    *,
    for_print: bool = False,
    edition: Edition = "all",
    progress: Progress = SILENT,
) -> str:
    """Return the report as HTML in the language in use (see `ReportOptions.spoken`).

    `for_print` takes the style of the page and the embedded fonts of the PDF, and leaves the script out; `edition`
    takes the sections of one of `assess.report.pages.editions`.

    Raises
    ------
    InputError
        If a template cannot be used: it names the file, the line and the reason.
    CancelledError
        If the work was cancelled.
    """
    options = options or ReportOptions()
    script = "" if for_print else options.read(SCRIPT)
    more = ("edition.css",) if for_print else ()
    context = build_context(content, options, for_print=for_print, edition=edition, progress=progress)
    context |= {"script": script, "script_hash": hash_script(script), "style": build_style(options, for_print, *more)}
    return render_page("report.html.j2", context, options, progress)


def render_page(
    name: str,
    context: Mapping[str, Any],
    options: ReportOptions,
    progress: Progress = SILENT,
    *,
    filters: Mapping[str, Any] | None = None,
) -> str:
    """Return a template with its names filled in, and `filters` besides those of reports; raises what `render` does."""
    TemplateError, SecurityError = progress.wait_for(_import_errors)
    parts, letters = list[str](), dict[str, str]()
    try:
        filled = {"equation": partial(write_equation, letters=None if context["for_print"] else letters)}
        environment = progress.wait_for(lambda: _environment(options, {**filled, **(filters or {})}))
        template = progress.wait_for(lambda: environment.get_template(name))
        for part in template.generate(**context):
            progress.check()
            parts.append(part)
    except (TemplateError, SecurityError, TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
        if options.templates is None:
            raise  # the standard templates are right, or it is a fault of this program
        raise InputError(_describe(error, options)) from None
    return _add_letters("".join(parts), letters)


def check_templates(options: ReportOptions) -> None:
    """Raise InputError if a template or catalogue of the firm's own cannot be read: before the long work.

    What only shows when a report is rendered, such as an undefined name, is found by `render`.
    """
    from jinja2 import TemplateError

    if options.templates is None:
        return
    with options.spoken():
        environment = _environment(options)
        for path in sorted(options.templates.rglob("*.j2")):
            try:
                environment.get_template(path.relative_to(options.templates).as_posix())
            except TemplateError as error:
                raise InputError(_describe(error, options)) from None


def _describe(error: Exception, options: ReportOptions) -> str:
    """Return where in the templates something is wrong, and what."""
    name, line = getattr(error, "name", None), getattr(error, "lineno", None)
    if line is None:  # one that came up while rendering has its place in the traceback alone
        frames = [one for one in traceback.extract_tb(error.__traceback__) if one.filename.endswith(".j2")]
        name, line = (_place(Path(frames[-1].filename), options), frames[-1].lineno) if frames else (name, None)
    place = f"{name or 'a template'}{f', line {line}' if line else ''}"
    return f"templates: {place}: {error}"


def _place(path: Path, options: ReportOptions) -> str:
    """Return the name of a template within its folder."""
    return next(path.relative_to(folder).as_posix() for folder in options.folders if path.is_relative_to(folder))


def _environment(options: ReportOptions, filters: Mapping[str, Any] | None = None) -> Any:
    """Return where templates are rendered: it escapes every text and is strict about names.

    Templates of a firm's own are rendered in a sandbox, which takes longer.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from jinja2.sandbox import ImmutableSandboxedEnvironment

    is_own = options.templates is not None
    environment = (ImmutableSandboxedEnvironment if is_own else Environment)(
        loader=FileSystemLoader(options.folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        optimized=False,  # what is compiled holds no result of a filter, so that all renderings share it
        bytecode_cache=_compiled(is_sandboxed=is_own),
    )
    environment.filters |= {
        **FILTERS,
        "equation": write_equation,
        "breakable": write_breakable,
        "lower_indices": lower_indices,
        **(filters or {}),
    }
    environment.globals |= GLOBALS
    return environment


@cache
def _compiled(*, is_sandboxed: bool) -> Any:  # templates are compiled otherwise for a sandbox
    """Return where compiled templates are kept while the program runs: a run renders most of them three times."""
    from jinja2 import BytecodeCache

    class Memory(BytecodeCache):
        def __init__(self) -> None:
            self.kept: dict[tuple[str, str], Any] = {}

        def load_bytecode(self, bucket: Any) -> None:
            bucket.code = self.kept.get((bucket.key, bucket.checksum))

        def dump_bytecode(self, bucket: Any) -> None:
            self.kept[bucket.key, bucket.checksum] = bucket.code

    return Memory()


def _import_errors() -> tuple[type[Exception], type[Exception]]:
    from jinja2 import TemplateError
    from jinja2.exceptions import SecurityError

    return TemplateError, SecurityError


# ---------------------------------------------------------------- parts of the page that are no plain text


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


_INDEX = re.compile(r"(?<=[^\W\d_])_([^\W_]+\*?)")
_POWER = re.compile(r"\^(?:\((-?\d+(?:[.,]\d+)?)\)|(-?\d+(?:[.,]\d+)?))")


def write_breakable(text: str) -> Any:
    """Return a text whose words may be broken only where they are too long for a column."""
    from markupsafe import Markup, escape

    return Markup("<wbr>").join(escape(part) for part in list_breaks(text))


def write_equation(text: str, letters: dict[str, str] | None = None) -> Any:
    """Return a line of a method as HTML: its equations as pictures, of which the plain text is the alternative.

    Without `letters` each picture is a file of its own; with them it is a part of the page, and adds to `letters` the
    outlines that it uses, which the page has to hold (`write_letters`): each once.

    Source: WCAG 2.2, 1.1.1 (non-text content).
    """
    from markupsafe import Markup

    return Markup("").join(_draw(part, letters) if part.tex else lower_indices(part.text) for part in split_line(text))


def _draw(part: Part, letters: dict[str, str] | None) -> Any:
    from markupsafe import Markup

    drawn = draw_math(part.tex)
    if letters is None:
        data = quote(drawn.write_alone(), safe=" /:=,;()-")
        return Markup('<img class="math" src="data:image/svg+xml,{}" alt="{}" style="{}">').format(
            data, part.text, drawn.style
        )
    letters |= drawn.letters
    return Markup('<svg class="math" role="img" aria-label="{}" viewBox="{}" style="{}">{}</svg>').format(
        part.text,
        drawn.view,
        drawn.style,
        Markup(drawn.placed),  # noqa: S704 - numbers and names of letters
    )


def _add_letters(page: str, letters: Mapping[str, str]) -> str:
    """Return a page that holds the outlines of the letters of its equations, at its end."""
    if not letters:
        return page
    before, end, after = page.rpartition("</body>")
    held = f'<svg width="0" height="0" aria-hidden="true" style="position: absolute">{write_letters(letters)}</svg>'
    return f"{before}{held}\n{end}{after}"


def lower_indices(text: str) -> Any:
    """Return words with quantities as HTML: what stands behind _ below the line, a number behind ^ above it."""
    from markupsafe import Markup, escape

    lowered = _INDEX.sub(r"<sub>\1</sub>", str(escape(text)))
    return Markup(_POWER.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", lowered))  # noqa: S704 - escaped above
