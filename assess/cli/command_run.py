"""``assess run``: the main job, a workbook in, reports out."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from assess.cli import options
from assess.cli.console import open_file, print_warnings, say, say_written, show_progress
from assess.errors import InputError
from assess.i18n import find_language
from assess.progress import Progress
from assess.report_formats import ALL, DEFAULT, FILES
from assess.settings import ROUTE_RISK

if TYPE_CHECKING:
    from assess.results import Results

ORDER = 3
EXAMPLES = (
    "assess run building.xlsx",
    "assess run building.xlsx --runs auto --out report --open",
    'assess run building.xlsx --verify none --scenario "ASCE 7-22" --formats xlsx,csv',
    "assess run building.xlsx --anchor 25-07,25-08 --out anchored",
    "assess run building.xlsx --motions my-records --scale-motions",
    "assess run building.xlsx --scale 0.9 --ideal --seed 7 --jobs 2 --out weaker",
    "assess run building.xlsx --language it --accessible --route-risk 0.01",
    "assess run building.xlsx --method own.toml --template my-templates",
    "assess run building.xlsx --city",
    'assess run building.xlsx --verify none --class-by "proposed OR"',
    "assess run building.xlsx --shakemap grid.xml",
    "assess run building.xlsx --ground-motions oq-export --out scenarios",
)

MOST_METHODS = 4  # fitted models that a report shows next to the published methods: a column each
PLAIN = frozenset(("json", "csv", "xlsx"))  # formats that need no series of figures
OPENED = ("html", "pdf", "xlsx")  # reports that --open opens: the first of these that was written
UNCONFIRMED = "nothing is known of the building, or the motions may be too weak for a lower class to rest on."
"""What the count of unconfirmed pieces means."""


def command(
    path: options.Workbook,
    out: Annotated[Path | None, typer.Option(help="Folder of the reports.", show_default="NAME-report")] = None,
    verify: options.Verify = "all",
    runs: options.Runs = None,
    seed: options.Seed = None,
    motions: Annotated[
        Path | None,
        typer.Option(help="Folder of your own floor records, in place of generated motions.", show_default=False),
    ] = None,
    scale_motions: Annotated[
        bool, typer.Option("--scale-motions", help="Scale the records of --motions to each floor's PFA.")
    ] = False,
    shakemap: options.ShakeMapFile = None,
    ground_motions: options.GroundMotions = None,
    scenario: options.Scenario = None,
    class_by: options.ClassBy = None,
    scale: options.Scale = 1.0,
    anchor: Annotated[
        str | None,
        typer.Option(
            help="What if these items were anchored and their anchors held: names separated by commas, or first:N for "
            "the first N entries of what to fix.",
            show_default=False,
        ),
    ] = None,
    ideal: options.Ideal = False,
    city: Annotated[
        bool,
        typer.Option(
            "--city",
            help="Draw earthquakes by the building's place, as assess portfolio does: repeats a building of a "
            "portfolio to the same numbers.",
        ),
    ] = False,
    methods: Annotated[
        list[Path] | None,
        typer.Option(
            "--method", help="A fitted model (.toml) to show next to the methods; may be repeated.", show_default=False
        ),
    ] = None,
    route_risk: Annotated[
        float,
        typer.Option(
            help="Limit on the chance that an evacuation route is blocked, above 0 and below 1: fixes are listed until "
            "every route is below it."
        ),
    ] = ROUTE_RISK,
    formats: Annotated[
        str,
        typer.Option(
            help="Files to write, comma-separated: pdf is the report for the client; also annex, its details, work, "
            "work orders by room and stickers, docx, the report in Word, npz, the result of every motion, parquet, the "
            "items typed; or all.",
            autocompletion=options.list_of((*FILES, ALL)),
        ),
    ] = ",".join(DEFAULT),
    jobs: options.Jobs = None,
    language: Annotated[str | None, options.language_of("the reports", "the workbook's")] = None,
    templates: Annotated[
        Path | None,
        typer.Option(
            "--template",
            help="Folder of your own templates, styles and texts. They run as code: use only your own.",
            show_default=False,
        ),
    ] = None,
    accessible: Annotated[
        bool, typer.Option("--accessible", help="PDF/UA-1 for screen readers, instead of PDF/A-3u for archives.")
    ] = False,
    open_report: Annotated[
        bool, typer.Option("--open", help="Open the report in the browser when it is written.")
    ] = False,
) -> None:
    """Assess a workbook and write the reports."""
    from assess.report import list_formats, write_reports
    from assess.report.report_options import ReportOptions

    folder = out or Path(f"{path.stem}-report")
    named = options.read_formats(formats, (*FILES, ALL))
    wanted = [one for one in list_formats(named) if one != "npz" or verify != "none" or "npz" in named]
    if "npz" in named and verify == "none":
        raise InputError("--formats: npz holds results of the simulation: leave out npz or --verify none.")
    if open_report and not set(wanted) & set(OPENED):
        raise InputError(f"--open opens a report: write one of {', '.join(OPENED)} with --formats.")
    if motions is not None and (verify == "none" or runs is not None or seed is not None):
        raise InputError(
            "--motions: the simulation uses each of your own motions once; leave out --verify none, --runs and --seed"
        )
    if scale_motions and motions is None:
        raise InputError("--scale-motions: there are no motions to scale; name their folder with --motions")
    settings = options.read_run_settings(
        verify=verify, runs=runs, seed=seed, scenario=scenario, scale=scale, ideal=ideal, scale_motions=scale_motions,
        route_risk=route_risk, anchor=anchor, city=city, class_by=class_by,
    )  # fmt: skip
    options.check_out(folder, wanted)
    code = find_language(language) if language else ""
    style = ReportOptions(language=code, templates=templates, accessible=accessible)
    if templates is not None:
        from assess.report.templates import check_templates

        check_templates(style)
    with show_progress() as progress:
        from assess.pipeline.run import run
        from assess.workbook.read import read_inventory

        ground = options.read_ground(shakemap, ground_motions)
        inventory = read_inventory(path, ground=ground, progress=progress)
        if not (runs or motions or inventory.site_ground is None):
            settings = options.fit_runs(settings, len(inventory.site_ground.scenarios))
        own, figures = _read_methods(methods or (), motions, progress), not set(wanted) <= PLAIN
        results = run(inventory, settings, **own, jobs=jobs, figures=figures, progress=progress)
        print_warnings(results.problem_rows)
        if {"pdf", "annex", "work"} & set(wanted):
            from assess.report.pages.pdf import list_problems

            print_warnings(list_problems(results))
        written = write_reports(results, folder, wanted, style, progress=progress)
    for line in describe_result(results):
        say(line)
    say_written(written.values(), written.removed)
    if open_report and (message := open_file(next(written[name] for name in OPENED if name in written))):
        say(message, err=True)


def _read_methods(models: Sequence[Path], motions: Path | None, progress: Progress) -> dict[str, Any]:
    """Return the fitted models and the motions of the user's own."""
    if len(models) > MOST_METHODS:
        raise InputError(f"--method names {len(models)} files; a report has room for {MOST_METHODS}. Leave some out.")
    found: dict[str, Any] = {}
    if models:
        from assess.methods.fitted import read_model

        found["methods"] = [read_model(file) for file in models]
    if motions is not None:
        from assess.motion.suite import read_suite

        found["suite"] = read_suite(motions, progress=progress)
    return found


def describe_result(results: "Results") -> Iterator[str]:
    """Yield the pieces of each class and those apart, what settles these, the routes at risk, and what was assumed."""
    from assess.report.counts import count
    from assess.report.say import route as say_route
    from assess.report.say.piece import list_apart, list_ways_to_settle
    from assess.report.say.simulation import Verified, list_conditions, say_assumed, say_effects
    from assess.risk import RiskClass

    rows = tuple(results)
    counts = count("", rows)

    def line(label: str, number: int, text: str) -> str:
        return f"{label:<13} {number:>6,}{text}"

    for risk in reversed(RiskClass):
        span = counts.say(risk)
        unit = "piece" if counts.by_class[risk] == 1 else "pieces"
        note = f" ({span} by the sampling intervals)" if "–" in span else ""
        yield line(risk.label, counts.by_class[risk], f" {unit}{note}")
    if counts.cannot_rock:
        yield line("  cannot rock", counts.cannot_rock, " of the low ones: too stocky, or no motion can start them")
    if counts.unconfirmed:
        ways = [*list_ways_to_settle(list_apart(rows, "unconfirmed")), "Records of your own: --motions."]
        yield line("  unconfirmed", counts.unconfirmed, f", not counted above: {' '.join([UNCONFIRMED, *ways])}")
    if counts.by_formula:
        yield line("  by formula", counts.by_formula, ", not counted above: not simulated")
    if counts.rolls:
        yield line("  rolls", counts.rolls, ", not counted above: on castors, which no method covers")
    if counts.anchored:
        depends = "it depends on its anchors" if counts.anchored == 1 else "they depend on their anchors"
        yield line("  anchored", counts.anchored, f", not classified: {depends}")
    if results.has_routes:
        routes = results.route_tables
        held = sum(say_route.is_held(one, routes.risk) for one in routes.routes)
        worse = [f"If anchors fail, {held:,} would be worse."] if held else []
        yield " ".join((*say_route.count_all(routes), *worse, *say_route.say_to_fill_in(routes)))
    verified = Verified(results, rows).sentence if results.has_simulated else "Not simulated."
    yield f"Chance of overturning in an earthquake like this one, not per year. {verified}"
    yield from (f"{text}." for text in list_conditions(results))
    if assumed := " ".join(filter(None, (say_assumed(results), say_effects(results, rows)))):
        yield assumed
