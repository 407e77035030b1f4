"""The command line. Each command imports what it needs when it runs, so that ``--help`` answers at once.

Exit status: 0 done; 1 done, but something could not be assessed or written (named); 2 bad input or usage, nothing
written. Messages go to standard error, what was asked for to standard output.
"""

import json
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.console import exits, print_problems, print_result
from assess.errors import InputError
from assess.options import read_formats, read_look, read_settings
from assess.settings import SCENARIOS, Settings
from assess.version import __version__

if TYPE_CHECKING:
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
    seed: Annotated[int | None, typer.Option(min=0, help="Of the generated motions.", show_default="1")] = None,
    motions: Annotated[
        Path | None,
        typer.Option(help="Folder of your own floor records, in place of generated ones.", show_default=False),
    ] = None,
    scale_motions: Annotated[bool, typer.Option("--scale-motions", help="Scale them to each floor's PFA.")] = False,
    scenario: Annotated[
        str | None,
        typer.Option(help=f"Source of the floor motion: {', '.join(SCENARIOS)}.", show_default="the workbook's"),
    ] = None,
    formats: Annotated[
        str, typer.Option(help="Files to write, split by commas; also npz, the outcome of every motion.")
    ] = "pdf,xlsx,html,json,csv",
    jobs: Annotated[int | None, typer.Option(min=1, help="Threads.", show_default="one a processor")] = None,
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
    if folder.exists() and not folder.is_dir():
        raise typer.BadParameter(f"{folder} is a file; name a folder.", param_hint="--out")
    if motions is not None and (verify == "none" or runs is not None or seed is not None):
        message = "your own motions are all taken, in a verification: leave out --verify none, --runs and --seed."
        raise typer.BadParameter(message, param_hint="--motions")
    if scale_motions and motions is None:
        raise typer.BadParameter(
            "there are no motions to scale: name their folder by --motions.", param_hint="--scale-motions"
        )
    settings = read_settings(verify, runs, seed, scale_motions, scenario)
    with exits():
        check_folder(folder)
        look = read_look(language, template, accessible)
        assessment = _assess(path, settings, motions, jobs)
        print_problems([one for one in assessment.problems if one.severity == "warning"])
        if "pdf" in wanted:
            from assess.report.pages.pdf import list_problems

            print_problems([one for one in list_problems(assessment) if one.severity == "warning"])
        written = write_reports(assessment, folder, wanted, look(assessment.inventory))
    print_result(assessment, list(written.values()))


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
    from assess.report.commands.records import check_figure, describe, list_lines, read_channels, write_figure

    if plot is not None:
        with exits():
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
        with exits():
            channels = [channel for ones in found for channel in ones]
            drawn = write_figure(channels, plot)
        left = f"; {len(channels) - drawn} more channels are not drawn" if drawn < len(channels) else ""
        typer.echo(f"wrote {plot}{left}", err=True)
    if failed:
        raise typer.Exit(1)


@app.command()
def rock(
    breadth: Annotated[float, typer.Option(help="Side parallel to the motion [cm].", show_default=False)],
    height: Annotated[float, typer.Option(help="[cm]", show_default=False)],
    record: Annotated[str, typer.Option(help="The motion: FILE or FILE#channel.", show_default=False)],
    pfa: Annotated[float | None, typer.Option(help="Scale it to this peak [g].", show_default="not scaled")] = None,
    restitution: Annotated[
        float | None, typer.Option(help="Angular velocity after an impact over before.", show_default="Housner's")
    ] = None,
    baseline: Annotated[str, typer.Option(help="Treatment of an uncorrected record: standard, none.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON document instead.")] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw motion and rotation to this .png, .svg or .pdf.")] = None,
) -> None:
    """Rock one block under one record: whether it overturns, by direct integration of Housner's equation."""
    from assess.report.commands.records import check_figure
    from assess.report.commands.rocking import describe, list_lines, read_case, write_figure

    with exits():
        if plot is not None:
            check_figure(plot)
        case = read_case(breadth, height, record, pfa, restitution, baseline)
        from assess.rocking.response import follow_block

        try:
            response = follow_block(
                case.breadth, case.height, case.motion.acceleration, case.motion.time_step, restitution=case.restitution
            )
        except ValueError as error:  # how stocky a block may be, only the integration knows
            raise InputError(f"--breadth and --height: {error}") from None
        if as_json:
            typer.echo(json.dumps(describe(case, response), indent=1))
        else:
            typer.echo("\n".join(list_lines(case, response)))
        if plot is not None:
            write_figure(case, response, plot)
            typer.echo(f"wrote {plot}", err=True)


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


def _assess(path: Path, settings: Settings, motions: Path | None = None, jobs: int | None = None) -> "Assessment":
    from assess.assessment import run as run_assessment
    from assess.inventory.workbook import read_inventory

    inventory = read_inventory(path)
    suite = None
    if motions is not None:
        from assess.motion.suite import read_suite

        suite = read_suite(motions)
    return run_assessment(inventory, settings, suite=suite, jobs=jobs, progress=_progress)


def _progress(work: "Work") -> "Progress":
    from assess.progress import Progress

    return Progress(work)
