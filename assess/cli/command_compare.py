"""``assess compare``: two runs of a building, and what changed between them."""

import contextlib
import hashlib
import shlex
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli.console import say, say_written, show_progress
from assess.cli.options import AsJson, language_of, list_of, read_formats, spell_options
from assess.errors import InputError
from assess.i18n import LANGUAGES, find_language
from assess.resources import read_input
from assess.settings import CLASS_BY, SCENARIOS
from assess.version import find_code

if TYPE_CHECKING:
    from assess.compare.changes import Comparison
    from assess.compare.past_run import PastRun

ORDER = 4
EXAMPLES = (
    "assess compare building-report anchored-report",
    "assess compare before/results.json after/results.json --out change --formats html,xlsx --language it",
    "assess compare building-report stronger-report --json > change.json",
    "assess compare report-of-last-year building-report --as-is",
)
FORMATS = ("html", "pdf", "xlsx", "json")
"""Those of `assess.compare.comparison_files`, which takes long to import."""
FOLDER = Path("compare")
OPTIONS = (
    "scenario", "class_by", "verify", "runs", "seed", "scale", "anchor", "ideal", "scale_motions", "city", "route_risk",
)  # fmt: skip
"""Settings that `assess run` has an option for."""
_FILLED = (SCENARIOS[0], CLASS_BY[0])  # what stands for the workbook's own, where that says nothing else
PDF = "report.pdf"
MOST_BYTES = 1 << 28  # size [bytes] above which a workbook is not looked at

Run = Annotated[
    Path, typer.Argument(help="A results.json of assess run, or the folder that holds it.", show_default=False)
]


def command(
    before: Run,
    after: Run,
    out: Annotated[Path, typer.Option(help="Folder of the files, by default in the current folder.")] = FOLDER,
    formats: Annotated[
        str, typer.Option(help="Files to write, separated by commas.", autocompletion=list_of(FORMATS))
    ] = ",".join(FORMATS[:-1]),
    language: Annotated[str | None, language_of("the files", "AFTER's workbook's")] = None,
    as_is: Annotated[
        bool, typer.Option("--as-is", help="Compare runs that were computed by different code of assess as they are.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compare two runs of a building, and show first what gets worse.

    Pieces are matched by the names of their items, routes by theirs. Written are compare.html, compare.pdf and
    compare.xlsx, and always compare.json, which lists them: a later comparison into the folder replaces these alone.
    Nothing is assessed again; for runs by different code of assess the error names the commands that do it. Chances
    that were simulated are not set against chances by formula.
    """
    wanted = read_formats(formats, FORMATS)
    code = find_language(language) if language else ""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out: {out} is a file; name a folder")
    from assess.compare.changes import compare
    from assess.compare.comparison_files import check_out, describe, dump, write_comparison
    from assess.compare.past_run import read_run
    from assess.report.report_options import ReportOptions

    check_out(out, wanted)
    with show_progress() as progress:
        runs = [progress.wait_for(partial(read_run, path)) for path in (before, after)]
        if not as_is:
            _check_code(*runs)
        found = compare(*runs)
        with contextlib.suppress(InputError):  # the workbook may name one that is not known
            code = code or find_language(str(found.after.building.get("language") or LANGUAGES[0]))
        options = ReportOptions(language=code or LANGUAGES[0])
        written = write_comparison(found, out, wanted, options, progress=progress)
    if as_json:
        say(dump(describe(found)), nl=False)
    else:
        for line in describe_comparison(found):
            say(line)
    say_written(written.values(), written.removed)


def _check_code(before: "PastRun", after: "PastRun") -> None:
    """Raise InputError where two runs were computed by different code, with the commands that make them comparable."""
    if before.code == after.code:
        return
    lines = [
        f"{before.path.parent} and {after.path.parent} were computed by different code of assess: what differs between "
        "them may come from the program, not from the furniture."
    ]
    for name, run in (("BEFORE", before), ("AFTER", after)):
        if run.code == find_code():
            continue
        folder, workbook = run.path.parent, Path(run.workbook).name  # a name alone: results.json may come from anybody
        found = None
        for path in (folder / workbook, folder.parent / workbook, Path(workbook)):
            with contextlib.suppress(OSError, ValueError):
                if hashlib.sha256(read_input(path, MOST_BYTES)).hexdigest() == run.workbook_sha256:
                    found = path
                    break
        own = {option: value for option, value in run.settings.items() if value not in _FILLED}
        parts = ["assess", "run", str(found or workbook), "--out", f"{folder.resolve().name}-again"]
        command_line = shlex.join([*parts, *spell_options(own, OPTIONS)])
        lines.append(f"Assess {name} again, and compare that: {command_line}")
        if found is None and (folder / PDF).is_file():
            lines.append(f"{workbook} is attached to {folder / PDF}: save it from there.")
    raise InputError("\n".join((*lines, "To compare them as they are: --as-is.")))


def describe_comparison(found: "Comparison") -> Iterator[str]:
    """Yield what stands in the way of a comparison, what gets worse, and the counts before and after."""
    from assess.compare.comparison_document import View
    from assess.report.blocks import Cell, plain_words

    view = View(found)
    yield from view.list_warnings()
    yield from view.list_status()
    yield view.headline
    yield from (f"  {text}" for text in (*view.list_worse(), *view.list_others()))
    for row in (*view.list_counts(), *view.list_route_counts()):
        label, before, after, change = (plain_words(one.words if isinstance(one, Cell) else one) for one in row.cells)
        yield f"{label}: {before} -> {after}  {change}"
    if view.conditions:
        yield f"{view.conditions}."
    yield view.footer
