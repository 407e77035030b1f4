"""``assess fragility``: the chance that pieces overturn, against the PFA or PFV of their floor, and a fit to it."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from assess.cli import options
from assess.cli.console import print_warnings, say, show_progress

ORDER = 4
EXAMPLES = (
    "assess fragility building.xlsx",
    "assess fragility building.xlsx --by type --im pfv --plot types.png",
    "assess fragility building.xlsx --levels 0.1:1.5:0.1 --formats csv --out curves",
    "assess fragility building.xlsx --ideal --runs 400 --json",
    "assess fragility building.xlsx --by type --formats csv,pelicun,nrml",
)
DEFAULT, KNOWN = "csv,json", ("csv", "json", "pelicun", "nrml")


SPANS = {
    "pfa": options.Span("--levels", "g", step="0.05", most=20, examples="0.1:1.0 or 0.1:1.0:0.05"),
    "pfv": options.Span("--levels", "cm/s", step="5", most=5000, examples="10:200 or 10:200:10"),
}


def command(
    path: options.Workbook,
    by: Annotated[
        Literal["item", "type"],
        typer.Option(help="One curve for each row of Items, or for all rows of a Type (without one: of a size)."),
    ] = "item",
    im: Annotated[Literal["pfa", "pfv"], typer.Option(help="Intensity measure: PFA or PFV of the floor.")] = "pfa",
    levels: Annotated[
        str | None,
        typer.Option(
            metavar="LOW:HIGH[:STEP]",
            help="Levels [g], steps of 0.05, or [cm/s], steps of 5.",
            show_default="from where about nothing falls to where about everything does",
        ),
    ] = None,
    formats: Annotated[
        str | None,
        typer.Option(
            help="Files to write, separated by commas: csv, json, pelicun, nrml.",
            show_default=DEFAULT,
            autocompletion=options.list_of(KNOWN),
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the files; with --json none are written by default.", show_default="NAME-fragility"
        ),
    ] = None,
    runs: options.Draws = None,
    seed: options.Seed = None,
    scenario: options.Scenario = None,
    ideal: Annotated[
        bool, typer.Option("--ideal", help="Every piece exactly as filled in, whatever Piece uncertainty says.")
    ] = False,
    jobs: options.Jobs = None,
    as_json: options.AsJson = False,
    plot: Annotated[Path | None, options.plot_of("the curves")] = None,
) -> None:
    """Fit the chance that a piece overturns to the PFA or PFV of its floor.

    Each piece is rocked under the motions of its floor, all multiplied by one factor, so that the floor's PFA or PFV
    takes each level. The result is a table and the lognormal fitted to it: median and beta, with the largest misfit.

    It is conditional on the floor's PFA or PFV: the uncertainty of the motion is not in it, as whoever applies it to
    a demand brings that of the demand. The uncertainty of the pieces is in it (Piece uncertainty in the sheet
    Building). The spectrum keeps its shape, so that a curve holds for motions of the PFV/PFA stated beside it.

    The formats pelicun and nrml are for pelicun and OpenQuake. Curves that they cannot hold are named, with exit
    status 1.
    """
    span = None if levels is None else SPANS[im].read(levels)
    settings = options.read_draw_settings("level", runs=runs, seed=seed, scenario=scenario, ideal=ideal)
    from assess.cli.curve_figures import draw_curves
    from assess.cli.fragility_output import FORMATS, Curves, say_left_out
    from assess.pipeline.piece_fragility import UNITS, find_piece_fragilities
    from assess.pipeline.run import compute
    from assess.report.interchange.nrml import find_ground_pga
    from assess.workbook.read import read_inventory

    is_written = not as_json or formats is not None or out is not None
    wanted = list(dict.fromkeys(options.read_formats(formats or DEFAULT, FORMATS))) if is_written else []
    folder = out or Path(f"{path.stem}-fragility")
    if wanted:
        options.check_out(folder)
    options.check_file(plot, "figure")
    with show_progress() as progress:
        inventory = replace(read_inventory(path, progress=progress), routes=())  # they play no part
        assessment = compute(inventory, settings, progress=progress)
        print_warnings(assessment.problems)
        if "nrml" in wanted:
            find_ground_pga(assessment, im)
        points = None if span is None else [one * UNITS[im] for one in span]
        found = find_piece_fragilities(assessment, by=by, im=im, levels=points, jobs=jobs, progress=progress)
    curves = Curves(assessment, found)
    written = [FORMATS[one](curves) for one in wanted]
    say(curves.to_json() if as_json else curves.to_text())
    files = {folder / name: data for one in written for name, data in one.files.items()}
    options.write_files(files, plot, partial(draw_curves, curves), "curve")
    lines = [line for one in written for line in say_left_out(one)]
    for line in lines:
        say(line, err=True)
    if lines:
        raise typer.Exit(1)
