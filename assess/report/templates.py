"""Templates: the frame of a page, the cover and the drawings of plans, the standard ones or a firm's own."""

import importlib
import re
import traceback
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from assess.errors import InputError
from assess.i18n import markup, nmarkup
from assess.progress import SILENT, Progress
from assess.report import measures, words
from assess.report.report_options import ReportOptions

LONGEST_WORD = 18
"""Letters of a word that a table never breaks."""
_WORD = re.compile(r"(\s+|(?<=[\w)])-(?=\w))")


def open_template(name: str, options: ReportOptions) -> Any:
    """Return a template, which escapes texts and is strict about names; a firm's own runs in a sandbox, more slowly."""
    return _environment(options.templates, options.folders).get_template(name)


def render_template(name: str, options: ReportOptions, values: Mapping[str, Any], progress: Progress = SILENT) -> str:
    """Return a template with its names filled in; raises CancelledError.

    Raises InputError with file, line and reason if a template of the firm's own cannot be used.
    """
    jinja2 = progress.wait_for(lambda: importlib.import_module("jinja2"))
    errors = (jinja2.TemplateError, TypeError, ValueError, ArithmeticError, LookupError, AttributeError)
    parts = []
    try:
        for part in progress.wait_for(lambda: open_template(name, options)).generate(**values):
            progress.check()
            parts.append(part)
    except errors as error:
        if options.templates is None:
            raise  # the standard templates are right, or it is a fault of this program
        raise InputError(_describe(error, options)) from None
    return "".join(parts)


def check_templates(options: ReportOptions) -> None:
    """Raise InputError if a template or catalogue of the firm's own cannot be read: before the long work.

    What only shows when a report is rendered, such as an undefined name, is found by `render_template`.
    """
    if options.templates is None:
        return
    from jinja2 import TemplateError

    with options.spoken():
        for path in sorted(options.templates.rglob("*.j2")):
            try:
                open_template(path.relative_to(options.templates).as_posix(), options)
            except TemplateError as error:
                raise InputError(_describe(error, options)) from None


def _describe(error: Exception, options: ReportOptions) -> str:
    """Return where in the templates something is wrong, and what."""
    name, line = getattr(error, "name", None), getattr(error, "lineno", None)
    frames = [one for one in traceback.extract_tb(error.__traceback__) if one.filename.endswith(".j2")]
    if line is None and frames:  # one that came up while rendering has its place in the traceback alone
        path, line = Path(frames[-1].filename), frames[-1].lineno
        name = next(path.relative_to(one).as_posix() for one in options.folders if path.is_relative_to(one))
    place = f"{name or 'a template'}{f', line {line}' if line else ''}"
    return f"templates: {place}: {error}"


@cache
def _environment(own: Path | None, folders: tuple[Path, ...]) -> Any:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from jinja2.sandbox import ImmutableSandboxedEnvironment

    environment = (Environment if own is None else ImmutableSandboxedEnvironment)(
        loader=FileSystemLoader(folders), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, optimized=False,  # what is compiled holds no text, so that all languages share it
    )  # fmt: skip
    environment.globals |= {"_": markup, "ngettext": nmarkup}
    environment.globals |= {"unit": measures.unit}
    environment.filters |= {"cut": words.cut, "in_m": words.in_m, "breakable": break_words}
    return environment


def break_words(text: str) -> Any:
    """Return a text as HTML whose words may be broken only where they are too long for a column.

    A word of up to `LONGEST_WORD` letters, as "electrocardiograph" has, is never broken; a longer one into parts of
    about equal length.
    """
    from markupsafe import Markup, escape

    parts = [""]
    for word in _WORD.split(text):
        count = -(-len(word) // LONGEST_WORD) if word.strip() else 1
        size = -(-len(word) // count) if word else 1
        pieces = [word[at : at + size] for at in range(0, len(word), size)] if count > 1 else [word]
        parts = [*parts[:-1], parts[-1] + pieces[0], *pieces[1:]]
    return Markup("<wbr>").join(escape(part) for part in parts)
