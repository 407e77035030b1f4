"""``assess portfolio``: many buildings under one earthquake."""

import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli import options
from assess.cli.console import InterruptedWorkError, print_error, say, say_written, show_progress
from assess.errors import CancelledError, InputError
from assess.i18n import LANGUAGES, count, find_language
from assess.settings import ROUTE_RISK, Settings
from assess.text import plain_line

if TYPE_CHECKING:
    from assess.portfolio.run_portfolio import PortfolioResult

ORDER = 3.5
EXAMPLES = (
    "assess portfolio buildings --shakemap grid.xml",
    "assess portfolio bay --example --verify none",
    "assess portfolio index.csv --ground-motions oq-export --out city --background coast.geojson",
    "assess portfolio buildings --formats parquet,html --language it --scale 1.2 --ideal --route-risk 0.01",
    "assess portfolio /share/buildings --out /share/city --scheduler tcp://10.0.0.5:8786",
    'assess portfolio buildings --verify none --class-by "proposed OR" --jobs 4',
)
FORMATS = ("parquet", "xlsx", "html", "pdf")
"""Those of `assess.portfolio.run_portfolio`, which takes long to import."""
REPEATED = ("verify", "runs", "seed", "scenario", "scale", "route_risk", "class_by", "ideal")
"""Settings of the run that the command for one building has an option for."""
MOST_SKIPPED = 10  # buildings that were skipped that are named at the end
EXAMPLE_MAP, EXAMPLE_COAST, EXAMPLE_INDEX = "grid.xml", "coast.geojson", "index.csv"
"""Files of the worked city that are used where no others are named."""


def command(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER|INDEX.csv",
            help="A folder of workbooks, searched with the folders in it, or an index that lists them.",
            show_default=False,
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder of the results.", show_default="NAME-portfolio")] = None,
    shakemap: options.ShakeMapFile = None,
    ground_motions: options.GroundMotions = None,
    verify: options.Verify = "all",
    runs: options.Runs = None,
    seed: options.Seed = None,
    scenario: options.Scenario = None,
    class_by: options.ClassBy = None,
    scale: options.Scale = 1.0,
    ideal: options.Ideal = False,
    route_risk: Annotated[
        float, typer.Option(help="Limit on the chance that an evacuation route is blocked, above 0 and below 1.")
    ] = ROUTE_RISK,
    background: Annotated[
        Path | None,
        typer.Option(help="Coastline, streets or the like of the map, as GeoJSON.", show_default=False),
    ] = None,
    formats: Annotated[
        str,
        typer.Option(
            help="Results to write, separated by commas: parquet are the tables, xlsx the ranking, html the page with "
            "a map, pdf the summary.",
            autocompletion=options.list_of(FORMATS),
        ),
    ] = ",".join(FORMATS),
    jobs: Annotated[
        int | None,
        typer.Option(min=1, help="Processes on this machine; they do not change a result.", show_default="one per CPU"),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Have the workers of this dask scheduler do the work; only in a network that you trust.",
            show_default=False,
        ),
    ] = None,
    language: Annotated[str, options.language_of("the reports")] = LANGUAGES[0],
    example: Annotated[
        bool,
        typer.Option(
            "--example",
            help="First write a made-up city around San Francisco Bay to FOLDER: new, empty, or that city.",
        ),
    ] = False,
) -> None:
    """Assess many buildings under one earthquake, with tables, a ranking, a map and a summary.

    What is done is kept: a run that was interrupted goes on when the same command is given again. A building that
    cannot be assessed is named and skipped.
    """
    wanted = options.read_formats(formats, FORMATS)
    code = find_language(language)
    if scheduler is not None and jobs is not None:
        raise InputError("--jobs: the workers of --scheduler do the work; leave out one of them.")
    settings = options.read_run_settings(
        verify=verify, runs=runs, seed=seed, scenario=scenario, scale=scale, ideal=ideal, route_risk=route_risk,
        class_by=class_by,
    )  # fmt: skip
    folder = out or Path(f"{source.resolve().stem}-portfolio")
    if example:
        from assess.portfolio.run_portfolio import check_extras

        check_extras(wanted, scheduler)
        if folder.resolve().is_relative_to(source.resolve()):
            raise InputError(f"--out: {folder} lies in the folder of the example; name another one")
        from assess.portfolio.example_city import write_example_city

        if write_example_city(source):
            say(f"wrote {source}", err=True)
        shakemap = shakemap if shakemap or ground_motions else source / EXAMPLE_MAP
        source, background = source / EXAMPLE_INDEX, background or source / EXAMPLE_COAST
    ground = options.read_ground(shakemap, ground_motions)
    if runs is None:
        settings = options.fit_runs(settings, getattr(ground, "event_count", 0))
    with show_progress() as progress:
        try:
            from assess.portfolio.background import read_background
            from assess.portfolio.run_portfolio import run_portfolio

            result = run_portfolio(
                source, folder, settings, ground=ground, jobs=jobs, scheduler=scheduler, formats=wanted,
                background=read_background(background) if background else None, language=code,
                repeat=_say_repeat(source, settings, shakemap, ground_motions), progress=progress,
            )  # fmt: skip
        except (KeyboardInterrupt, CancelledError):
            kept = f"the buildings that are done are kept in {plain_line(str(folder))}; the same command goes on"
            raise InterruptedWorkError(kept) from None
    from assess.portfolio.city_words import name_skipped

    for line in describe_city(result):
        say(line)
    say_written(result.files, result.removed)
    names = {row["path"]: row["building"] for row in result.city.skipped}
    for path, why in result.skipped[:MOST_SKIPPED]:
        print_error(f"{plain_line(name_skipped(names.get(path), path))}: skipped. {plain_line(why)}")
    if len(result.skipped) > MOST_SKIPPED:
        more = count(len(result.skipped) - MOST_SKIPPED, "more building")
        say(f"... and {more} skipped: see the table problems.", err=True)
    if result.skipped:
        raise typer.Exit(1)


def _say_repeat(source: Path, settings: Settings, shakemap: Path | None, ground_motions: Path | None) -> str:
    """Return the command that assesses one building alone, {path} being its workbook; "" where a name holds {path}."""
    folder = f"{_quote(source if source.is_dir() else source.parent)}/"
    files = {"--shakemap": shakemap, "--ground-motions": ground_motions}
    given = [f"{option} {_quote(file)}" for option, file in files.items() if file]
    given += map(shlex.quote, options.spell_options(settings.as_record(), REPEATED))
    if any("{path}" in one for one in (folder, *given)):
        return ""
    return " ".join([f"assess run {folder}{{path}} --city", *given])


def _quote(path: Path) -> str:
    """Return a path for a shell; one that begins with a dash would be taken for an option."""
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text).rstrip("/")


def describe_city(result: "PortfolioResult") -> Iterator[str]:
    """Yield what was assessed and skipped, what to know before, and what is expected, apart by inventory and basis."""
    from assess.portfolio.city_words import list_cautions, list_group_lines, name_group, say_ground

    earlier = f" ({result.kept:,} of them by an earlier run)" if result.kept else ""
    city = result.city
    skipped = len(city.skipped)
    yield f"{count(len(city.ranked) - skipped, 'building')} assessed{earlier}, {skipped:,} skipped."
    yield say_ground(city)
    yield from list_cautions(city)
    for group in city.groups:
        yield f"{name_group(group)}: {count(group.pieces, 'piece')}, {group.anchored:,} anchored."
        yield from (f"  {line}" for line in list_group_lines(group))
    if city.groups:
        yield "Falls and people are expected numbers in this scenario, not per year."
