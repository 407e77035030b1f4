"""The command line. Each command imports what it needs when it runs, so that ``--help`` answers at once.

Exit status: 0 done; 1 done, but something could not be assessed or written (named); 2 bad input or usage, nothing
written. Messages go to standard error, what was asked for to standard output.
"""

from collections.abc import Sequence
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli_motion import record, rock
from assess.cli_study import study
from assess.console import exits, print_problems, print_result
from assess.errors import InputError
from assess.options import (
    check_run,
    read_fixed_settings,
    read_formats,
    read_look,
    read_methods,
    read_pfa,
    read_settings,
)
from assess.settings import ROUTE_RISK, SCENARIOS, Settings
from assess.units import GRAVITY
from assess.version import __version__

if TYPE_CHECKING:
    from assess.methods import Method
    from assess.progress import Progress
    from assess.results import Assessment
    from assess.verification import Work

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
Seed = Annotated[int | None, typer.Option(min=0, help="Of the generated motions.", show_default="1")]
Scenario = Annotated[
    str | None,
    typer.Option(help=f"Source of the floor motion: {', '.join(SCENARIOS)}.", show_default="the workbook's"),
]
Jobs = Annotated[int | None, typer.Option(min=1, help="Threads.", show_default="one a processor")]


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
    language: Annotated[str, typer.Option(help="Language of the workbook: en, it.")] = "en",
    example: Annotated[bool, typer.Option("--example", help="Fill in an example.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there already.")] = False,
) -> None:
    """Write an empty workbook to fill in: drop-downs, units, help, and classes that show as one types."""
    from assess.language import find_language
    from assess.start import start_workbook

    with exits():
        start_workbook(path, units.value, language=find_language(language), example=example, replace=force)
    typer.echo(f"Wrote {path}. Fill it in, then: assess check {path}", err=True)


@app.command()
def check(path: Workbook) -> None:
    """Read and check a workbook; name every problem by sheet and cell; write nothing."""
    with exits():
        assessment = _assess(path, Settings(verify="none"))
    print_problems(assessment.problems)
    inventory = assessment.inventory
    typer.echo(
        f"{path.name}: no errors. {len(inventory.items):,} rows of furniture on {len(inventory.floors):,} floors, "
        f"{len(inventory.routes):,} route segments."
    )


@app.command()
def run(
    path: Workbook,
    out: Annotated[Path | None, typer.Option(help="Folder of the reports.", show_default="NAME-report")] = None,
    verify: Annotated[
        str,
        typer.Option(help="Pieces to verify by direct integration: none, high (high risk, doubtful, on routes), all."),
    ] = "high",
    runs: Annotated[
        str | None,
        typer.Option(help="Motions of each floor and axis; auto: until each class is sure.", show_default="200"),
    ] = None,
    seed: Seed = None,
    motions: Annotated[
        Path | None,
        typer.Option(help="Folder of your own floor records, in place of generated ones.", show_default=False),
    ] = None,
    scale_motions: Annotated[bool, typer.Option("--scale-motions", help="Scale them to each floor's PFA.")] = False,
    scenario: Scenario = None,
    method: Annotated[
        list[Path] | None,
        typer.Option(help="A fitted model (.toml) to show beside the methods; may be repeated.", show_default=False),
    ] = None,
    route_risk: Annotated[
        float, typer.Option(help="Chance under which every evacuation route is to be brought, above 0 and below 1.")
    ] = ROUTE_RISK,
    formats: Annotated[
        str, typer.Option(help="Files to write, split by commas; also npz, the outcome of every motion.")
    ] = "pdf,xlsx,html,json,csv",
    jobs: Jobs = None,
    language: Annotated[
        str | None, typer.Option(help="Language of the reports: en, it.", show_default="the workbook's")
    ] = None,
    template: Annotated[
        Path | None,
        typer.Option(help="Folder of your own templates, styles and texts: trusted code.", show_default=False),
    ] = None,
    accessible: Annotated[
        bool, typer.Option("--accessible", help="PDF/UA-1 for screen readers, instead of PDF/A-3u for archives.")
    ] = False,
) -> None:
    """Assess a workbook and write the reports."""
    from assess.report import check_folder, write_reports

    wanted = read_formats(formats, verify)
    folder = out or Path(f"{path.stem}-report")
    check_run(folder, verify, runs, seed, motions, scale_motions)
    settings = read_settings(verify, runs, seed, scenario, scale_motions=scale_motions, route_risk=route_risk)
    with exits():
        check_folder(folder)
        look = read_look(language, template, accessible)
        assessment = _assess(path, settings, motions, read_methods(method), jobs)
        print_problems([one for one in assessment.problems if one.severity == "warning"])
        if "pdf" in wanted:
            from assess.report.pages.pdf import list_problems

            print_problems([one for one in list_problems(assessment) if one.severity == "warning"])
        written = write_reports(assessment, folder, wanted, look(assessment.inventory))
    print_result(assessment, list(written.values()))


@app.command()
def routes(
    path: Workbook,
    pfa: Annotated[
        str, typer.Option(metavar="LOW:HIGH[:STEP]", help="PFA on the routes' floors [g]: both ends, steps of 0.05.")
    ] = "0.1:1.0",
    runs: Annotated[str | None, typer.Option(help="Motions of each floor and axis.", show_default="200")] = None,
    seed: Seed = None,
    scenario: Scenario = None,
    jobs: Jobs = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON document instead.")] = False,
    csv: Annotated[Path | None, typer.Option(help="Write the table to this .csv, a line a route and PFA.")] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the chances to this .png, .svg or .pdf.")] = None,
) -> None:
    """Tell how likely each evacuation route is blocked, against the peak acceleration (PFA) of its floors.

    At each value every floor of a route shakes with that PFA along both axes: by the floor's own motions, each scaled
    by value / the floor's PFA. The same motions serve at every value; the spectrum keeps its shape, PFV scales along.

    Rocking is not monotone: a stronger motion may spare a piece that a weaker one overturns, so a chance may fall.
    """
    values, settings = read_pfa(pfa), read_fixed_settings(runs, seed, scenario)
    from assess.report.commands.routes import Sweep, check_files, write_files

    with exits():
        check_files(csv, plot)
        assessment = _assess(path, settings)
        if not assessment.inventory.routes:
            sheet = assessment.inventory.sheets.get("Routes", "Routes")
            raise InputError(f"{path.name} names no routes: fill in the sheet {sheet}.")
        print_problems([one for one in assessment.problems if one.severity == "warning"])
        from assess.routes.fragility import find_fragility

        fragility = find_fragility(
            assessment, [one * GRAVITY for one in values], jobs=jobs, progress=partial(_progress, doing="Rocking")
        )
        sweep = Sweep(assessment, fragility)
        typer.echo(sweep.to_json() if as_json else sweep.to_text())
        for told in write_files(sweep, csv, plot):
            typer.echo(told, err=True)


app.command()(record)
app.command()(study)
app.command()(rock)


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


def _assess(
    path: Path,
    settings: Settings,
    motions: Path | None = None,
    methods: "Sequence[Method]" = (),
    jobs: int | None = None,
) -> "Assessment":
    from assess.assessment import run as run_assessment
    from assess.inventory.workbook import read_inventory

    inventory = read_inventory(path)
    suite = None
    if motions is not None:
        from assess.motion.suite import read_suite

        suite = read_suite(motions)
    return run_assessment(inventory, settings, suite=suite, methods=methods, jobs=jobs, progress=_progress)


def _progress(work: "Work", doing: str = "Verifying") -> "Progress":
    from assess.progress import Progress

    return Progress(work, doing=doing)
