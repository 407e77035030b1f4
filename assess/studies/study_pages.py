"""Pages of studies from their templates, `templates/studies/<name>.md.j2`, whose blocks are the texts of a `Finding`.

A paragraph or an item of a list may stand on several lines of a template; a row of a table stands on one.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING

from assess.resources import templates
from assess.studies.study import Finding, Table

if TYPE_CHECKING:
    from jinja2 import Environment

STARTS = ("|", "* ", "#", "![")
"""Beginnings of lines that do not continue a paragraph: rows of tables, items of lists, headings, pictures."""


def write_finding(
    study: str,
    values: Mapping[str, object],
    *,
    tables: Mapping[str, Table],
    figures: Mapping[str, bytes],
    files: Mapping[str, str] | None = None,
) -> Finding:
    """Return the results of a study: its tables, figures and files, and the blocks of its template for `values`."""
    page, overview, summary, failures = (
        render_block(study, block, **values) for block in ("page", "overview", "summary", "failures")
    )
    return Finding(
        page=page,
        overview=overview,
        summary=[line for line in summary if line],
        failures=[line for line in failures if line],
        tables=tables,
        figures=figures,
        files=files or {},
    )


def render_block(name: str, block: str, /, **values: object) -> list[str]:
    """Return the lines of one block of a template; none if the template does not define it."""
    template = _environment().get_template(f"{name}.md.j2")
    if block not in template.blocks:
        return []
    return _join_lines("".join(template.blocks[block](template.new_context(values))))


def render_page(name: str, /, **values: object) -> str:
    """Return the whole of a template."""
    return "\n".join(_join_lines(_environment().get_template(f"{name}.md.j2").render(values))) + "\n"


def _join_lines(text: str) -> list[str]:
    """Return paragraphs and items on one line each, with one empty line where there are several."""
    lines = [""]
    for line in map(str.strip, text.split("\n")):
        if line and lines[-1] and not line.startswith(STARTS):
            lines[-1] += f" {line}"
        elif line or lines[-1]:
            lines.append(line)
    return lines[1 : len(lines) - (not lines[-1])] if len(lines) > 1 else []


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(  # noqa: S701 - the pages are Markdown
        loader=FileSystemLoader(templates() / "studies"),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    made.filters |= {"form": format, "forms": _forms, "percent": percent, "points": _points, "span": _span}
    made.globals |= {"zip": zip}
    return made


def percent(share: float) -> str:
    """Return a share [-] as pages write it; "-" for NaN."""
    return "-" if share != share else f"{100 * share:.0f} %"


def _forms(values: Iterable[float], form: str, separator: str = "/") -> str:
    return separator.join(format(value, form) for value in values)


def _points(share: float, sign: str = "") -> str:
    """Return a share or a difference of shares [-] in percentage points; "-" for NaN."""
    return "-" if share != share else f"{100 * share:{sign}.1f}"


def _span(values: Sequence[float], decimals: int) -> str:
    low, high = f"{min(values):.{decimals}f}", f"{max(values):.{decimals}f}"
    return low if low == high else f"{low} to {high}"
