"""The command line. Each command imports what it needs when it runs, so that ``--help`` answers at once.

Exit status: 0 done; 1 done, but something could not be assessed or written (named); 2 bad input or usage, nothing
written. Messages go to standard error, what was asked for to standard output.
"""

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.errors import InputError, OutputError, Problem, WorkbookError
from assess.settings import SCENARIOS, match_choice
from assess.version import __version__

if TYPE_CHECKING:
    from assess.results import Assessment

MOST_PRINTED = 200
"""Problems printed in one run; the rest are counted."""

app = typer.Typer(
    help="Which furniture falls in an earthquake, and what to fix first.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


class UnitSystem(str, Enum):
    """Units of a new workbook."""

    SI = "si"
    IMPERIAL = "imperial"


Workbook = Annotated[Path, typer.Argument(help="The inventory, an .xlsx workbook.", show_default=False)]


def main() -> None:
    """Run the command line."""
    app()


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"assess {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Which furniture falls in an earthquake, and what to fix first."""


@app.command()
def new(
    path: Annotated[Path, typer.Argument(help="The workbook to write, .xlsx.", show_default=False)],
    units: Annotated[UnitSystem, typer.Option(help="Units of the headers: cm or in.")] = UnitSystem.SI,
    example: Annotated[bool, typer.Option("--example", help="Fill in an example.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there already.")] = False,
) -> None:
    """Write an empty workbook to fill in: drop-downs, units, help, and classes that show as one types."""
    from assess.start import start_workbook

    with _exits():
        start_workbook(path, units.value, example=example, replace=force)
    typer.echo(f"Wrote {path}. Fill it in, then: assess check {path}", err=True)


@app.command()
def check(path: Workbook) -> None:
    """Read and check a workbook; name every problem by sheet and cell; write nothing."""
    with _exits():
        assessment = _assess(path)
    _print_problems(assessment.problems)
    inventory = assessment.inventory
    typer.echo(
        f"{path.name}: no errors. {len(inventory.items):,} rows of furniture on {len(inventory.floors):,} floors, "
        f"{len(inventory.routes):,} route segments."
    )


@app.command()
def run(
    path: Workbook,
    out: Annotated[Path | None, typer.Option(help="Folder of the reports.", show_default="NAME-report")] = None,
    verify: Annotated[str, typer.Option(help="Which pieces to verify by direct integration: none.")] = "none",
    scenario: Annotated[
        str | None,
        typer.Option(help=f"Source of the floor motion: {', '.join(SCENARIOS)}.", show_default="the workbook's"),
    ] = None,
    formats: Annotated[str, typer.Option(help="Files to write, split by commas.")] = "pdf,xlsx,html,json,csv",
) -> None:
    """Assess a workbook and write the reports."""
    from assess.report import FORMATS, write_reports

    wanted = [name.strip().lower() for name in formats.split(",") if name.strip()]
    unknown = [name for name in wanted if name not in FORMATS]
    if unknown or not wanted:
        raise typer.BadParameter(f"{formats!r} is not a list of: {', '.join(FORMATS)}.", param_hint="--formats")
    folder = out or Path(f"{path.stem}-report")
    if folder.exists() and not folder.is_dir():
        raise typer.BadParameter(f"{folder} is a file; name a folder.", param_hint="--out")
    with _exits():
        assessment = _assess(path, verify, scenario)
        _print_problems([one for one in assessment.problems if one.severity == "warning"])
        written = write_reports(assessment, folder, wanted)
    _print_result(assessment, list(written.values()))


@app.command()
def record(
    files: Annotated[list[str], typer.Argument(help="Records: FILE or FILE#channel.", show_default=False)],
    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print one JSON document instead: an object for one file, a list for several."),
    ] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the channels to this .png, .svg or .pdf.")] = None,
) -> None:
    """Tell what records hold: channels, time step, PFA, PFV, displacement and 5 % spectrum, as assess treats them."""
    from assess.report.records import check_figure, describe, list_lines, read_channels, write_figure

    if plot is not None:
        with _exits():
            check_figure(plot)
    found, failed = [], 0
    for name in files:
        try:
            found.append(read_channels(name))
        except InputError as error:
            typer.echo(f"error  {error}", err=True)
            failed += 1
    if not found:
        raise typer.Exit(2)
    documents = [describe(channels) for channels in found]
    if as_json:
        typer.echo(json.dumps(documents[0] if len(files) == 1 else documents, ensure_ascii=False, indent=1))
    else:
        typer.echo("\n\n".join("\n".join(list_lines(document)) for document in documents))
    if plot is not None:
        with _exits():
            channels = [channel for ones in found for channel in ones]
            drawn = write_figure(channels, plot)
        left = f"; {len(channels) - drawn} more channels are not drawn" if drawn < len(channels) else ""
        typer.echo(f"wrote {plot}{left}", err=True)
    if failed:
        raise typer.Exit(1)


@app.command()
def methods() -> None:
    """List the methods: what they need, where they have been checked, where they come from."""
    from assess.methods import all_methods

    for method in all_methods():
        typer.echo(f"{method.key}: {method.title} ({method.kind})")
        typer.echo(f"  {method.predicts}")
        typer.echo(f"  needs: {', '.join(sorted(method.needs))}")
        for name, limits in method.valid.items():
            typer.echo(f"  checked for {name} {limits.low:g} to {limits.high:g} {limits.unit}".rstrip())
        typer.echo(f"  {method.reference}\n")


@app.command()
def doctor() -> None:
    """Tell versions, native libraries and fonts: what works here, what does not, and the mend."""
    from assess.doctor import examine

    findings = examine()
    for finding in findings:
        typer.echo(f"{'ok     ' if finding.works else 'missing'}  {finding.what}: {finding.detail}")
    if not all(finding.works for finding in findings):
        raise typer.Exit(1)


def _assess(path: Path, verify: str = "none", scenario: str | None = None) -> "Assessment":
    from assess.assessment import run as run_assessment
    from assess.inventory.workbook import read_inventory
    from assess.settings import VERIFY, Settings

    if verify not in VERIFY:
        raise typer.BadParameter(f"{verify!r} is not one of: {', '.join(VERIFY)}.", param_hint="--verify")
    kind = None if scenario is None else match_choice(scenario, SCENARIOS)
    if scenario is not None and kind is None:
        raise typer.BadParameter(f"{scenario!r} is not one of: {', '.join(SCENARIOS)}.", param_hint="--scenario")
    settings = Settings(verify=verify, scenario=kind)  # type: ignore[arg-type]
    return run_assessment(read_inventory(path), settings)


@contextmanager
def _exits() -> Iterator[None]:
    """Turn what is raised on purpose into a message and an exit status."""
    try:
        yield
    except WorkbookError as error:
        _print_problems(error.problems)
        errors = sum(problem.severity == "error" for problem in error.problems)
        typer.echo(f"{errors} error{'s' if errors != 1 else ''}; nothing was written.", err=True)
        raise typer.Exit(2) from None
    except InputError as error:
        typer.echo(f"error  {error}", err=True)
        raise typer.Exit(2) from None
    except OutputError as error:
        typer.echo(f"error  {error}", err=True)
        raise typer.Exit(1) from None


def _print_problems(problems: Sequence[Problem]) -> None:
    for problem in problems[:MOST_PRINTED]:
        typer.echo(f"{problem.severity:<7}  {problem}", err=True)
    if len(problems) > MOST_PRINTED:
        typer.echo(f"... and {len(problems) - MOST_PRINTED:,} more.", err=True)


def _print_result(assessment: "Assessment", files: Sequence[Path]) -> None:
    from assess.results import count_pieces
    from assess.risk import RiskClass

    counts, anchored = count_pieces(assessment)
    for risk in reversed(RiskClass):
        typer.echo(f"{risk.label:<13} {counts[risk]:>6,} {'piece' if counts[risk] == 1 else 'pieces'}")
    if anchored:
        typer.echo(f"{'  anchored':<13} {anchored:>6,}, only as safe as the anchors")
    typer.echo("Chance of overturning in this scenario, not per year. Not verified.")
    for file in files:
        typer.echo(f"wrote {file}", err=True)
