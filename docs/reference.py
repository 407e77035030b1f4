"""Write the generated parts of workbook.md, methods.md, commands.md and portfolio.md: ``python docs/reference.py``.

Each page is written by hand down to the line `MARK`; what follows repeats what the code says of itself: the columns of
the workbook, the methods, the help of the commands. A test compares the pages with what this script writes.
"""

import ast
import inspect
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields as fields_of
from pathlib import Path

import typer

from assess.cli.app import app, find_commands
from assess.methods import MethodInfo, all_methods
from assess.portfolio.table_schemas import TABLES
from assess.report.blocks import Document
from assess.report.pages.html import Page, PageSection
from assess.report.view import list_all_parts
from assess.units import QUANTITIES
from assess.workbook.names import translate
from assess.workbook.schema import CLASS, LIVE, SHEETS, WORKINGS, Column
from assess.workbook.template import describe

DOCS = Path(__file__).parent
METHODS = DOCS.parent / "assess" / "methods"
MARK = "<!-- Generated from here on: change the code, then run `python docs/reference.py`. -->"
OTHER = "it"
"""The language in which the names of the workbook are listed next to the English ones."""


def main() -> None:
    """Write the pages."""
    for name, text in build_pages().items():
        (DOCS / name).write_text(text, encoding="utf-8")


def build_pages() -> dict[str, str]:
    """Return the text of every page by the name of its file."""
    return {name: _build_page(name, lines) for name, lines in _pages().items()}


def _pages() -> dict[str, Iterator[str]]:
    return {"workbook.md": _describe_workbook(), "methods.md": _describe_methods(),
            "commands.md": _describe_commands(), "portfolio.md": _describe_tables()}  # fmt: skip


def _build_page(name: str, lines: Iterable[str]) -> str:
    by_hand = (DOCS / name).read_text(encoding="utf-8").split(MARK)[0]
    return f"{by_hand}{MARK}\n\n" + "\n".join(lines).rstrip("\n") + "\n"


def _build_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    yield f"| {' | '.join(heads)} |"
    yield "|" + "---|" * len(heads)
    yield from (f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |" for row in rows)
    yield ""


def _join(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


# ---------------------------------------------------------------- the tables of a portfolio


def _describe_tables() -> Iterator[str]:
    yield "## Columns of the tables"
    yield ""
    yield "text: VARCHAR; number: DOUBLE; count: BIGINT; flag: BOOLEAN. What is not known is NULL."
    yield ""
    for name, columns in TABLES.items():
        yield f"### {name}"
        yield ""
        yield from _build_table(("column", "type", "what"), ((f"`{one.key}`", one.kind, one.help) for one in columns))


# ---------------------------------------------------------------- the workbook


def _describe_workbook() -> Iterator[str]:
    yield "## Units of a header"
    yield ""
    yield from _build_table(
        ("quantity", "units"), ((quantity, _join(factors)) for quantity, factors in QUANTITIES.items())
    )
    for sheet in SHEETS:
        other = translate(sheet, OTHER)
        yield f"## Sheet {sheet.name}"
        yield ""
        form = "Labels stand in column A, values in column B. " if sheet.layout == "form" else ""
        need = "The sheet is required." if sheet.required else "The sheet is optional."
        yield f"{sheet.help} {form}{need} In Italian: {other.name}."
        yield ""
        rows = (
            (
                f"{column.header()}{' *' if column.required else ''}",
                its.label,
                _describe_values(column),
                describe(column),
            )
            for column, its in zip(sheet.columns, other.columns, strict=True)
        )
        yield from _build_table(("column", "Italian", "value", "what to fill in"), rows)
    yield "## Columns that Excel computes"
    yield ""
    others = (label for label in LIVE if label != CLASS)
    yield f"In Items, `{CLASS}` next to the item; at the right {_join(others)}, and what they are computed"
    yield f"from: {_join(WORKINGS)}. They update while you type, and are left out when the workbook is read."


KINDS = {
    "count": "whole number", "records": "names of files", "file": "name of a file", "flag": "choice",
    "language": "choice",
}  # fmt: skip


def _describe_values(column: Column) -> str:
    """Return what a cell may hold: its kind, and its limits in the unit of the header."""
    parts = [KINDS.get(column.kind, column.kind)]
    if column.low is not None and column.high is not None and column.low > -1e5:
        parts.append(f"{column.low:g} to {column.high:g} {column.unit}".rstrip())
    if column.usual_low is not None:
        parts.append(f"warning outside {column.usual_low:g} to {column.usual_high:g}")
    return "; ".join(parts)


# ---------------------------------------------------------------- the methods


def _describe_methods() -> Iterator[str]:
    infos = [method.info for method in all_methods()]
    yield from _build_table(
        ("method", "key", "result", "role", "needs"),
        ((info.title, f"`{info.key}`", info.kind, info.role, _join(sorted(info.needs))) for info in infos),
    )
    for info in infos:
        yield from _describe_method(info)


def _describe_method(info: MethodInfo) -> Iterator[str]:
    sections = _read_sections(info.key)
    yield f"## {info.title}"
    yield ""
    yield info.predicts
    yield ""
    yield f"**Source.** {info.reference}"
    yield ""
    checked = (f"{name} {one.low:g} to {one.high:g} {one.unit}".rstrip() for name, one in info.valid.items())
    validity = "; ".join(checked)
    yield from ("**Validity.**", "", f"{f'Checked for {validity}. ' if validity else ''}{sections['Validity']}", "")
    for heading, texts in (("Equations", info.equations), ("Assumptions", info.assumptions)):
        yield from (f"**{heading}.**", "", *(f"* {text}" for text in texts), "") if texts else ()
    yield from ("**Departures from the source.**", "", sections["Departures"], "")
    if info.flags:
        yield from _build_table(("flag", "meaning"), ((f"`{flag}`", str(text)) for flag, text in info.flags.items()))


def _read_sections(key: str) -> dict[str, str]:
    """Return the text of each section of a method's docstring by its heading."""
    docstring = ast.get_docstring(ast.parse((METHODS / f"{key}.py").read_text(encoding="utf-8"))) or ""
    _, *parts = re.split(r"^(\w+)\n-+\n", docstring, flags=re.MULTILINE)
    return {heading: text.strip() for heading, text in zip(parts[::2], parts[1::2], strict=True)}


# ---------------------------------------------------------------- the commands


def _describe_commands() -> Iterator[str]:
    group = typer.main.get_command(app)
    context = group.context_class(group, info_name="assess")
    for name, module in find_commands():
        command = group.commands[name]  # type: ignore[attr-defined]
        yield f"## assess {name}"
        yield ""
        yield command.help
        yield ""
        records = (parameter.get_help_record(context) for parameter in command.params)
        rows = [(f"`{record[0]}`", record[1]) for record in records if record]
        yield from _build_table(("argument or option", "meaning"), rows) if rows else ()
        yield from ("```", *module.EXAMPLES, "```", "")
    yield from _describe_templates()


def _describe_templates() -> Iterator[str]:
    yield "## What a template can show"
    yield ""
    yield "`page.html.j2` and `cover.html.j2` have one name, `page`:"
    yield ""
    for name, kind in (("page", Page), ("page.sections[]", PageSection), ("page.document", Document)):
        fields = [f"`{name}.{one.name}`" for one in fields_of(kind)]
        what, *parts = (inspect.getdoc(kind) or "").split("\n* ")
        yield f"* {', '.join(fields)}: {' '.join(what.split())}"
        yield from (f"  * {' '.join(one.split())}" for one in parts)
    yield ""
    named = [part for part in list_all_parts() if "all" in part.places or "client" in part.places]
    rows = [(f"`{one.key}`", one.heading, ", ".join(one.places)) for one in named]
    yield from _build_table(("section", "heading", "editions"), rows)


if __name__ == "__main__":
    main()
