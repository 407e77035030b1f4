"""``assess routes``: the chance that each evacuation route is blocked, against the PFA of its floors."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from assess.cli import options
from assess.cli.console import print_warnings, say, show_progress
from assess.errors import InputError
from assess.units import GRAVITY

ORDER = 4
EXAMPLES = (
    "assess routes building.xlsx",
    "assess routes building.xlsx --pfa 0.1:0.6:0.1 --plot routes.png --csv routes.csv",
    "assess routes building.xlsx --scenario recorded --runs 400 --json",
    "assess routes building.xlsx --pfa 0.02:0.4:0.02",
)

PFA = options.Span("--pfa", "g", step="0.05", most=5, examples="0.1:1.0 or 0.1:1.0:0.05")


def command(
    path: options.Workbook,
    pfa: Annotated[
        str, typer.Option(metavar="LOW:HIGH[:STEP]", help="PFA on the routes' floors [g]: both ends, steps of 0.05.")
    ] = "0.1:1.0",
    runs: options.Draws = None,
    seed: options.Seed = None,
    scenario: options.Scenario = None,
    jobs: options.Jobs = None,
    as_json: options.AsJson = False,
    csv: Annotated[
        Path | None, typer.Option(help="Write a table to this .csv, one line for each route and PFA.")
    ] = None,
    plot: Annotated[Path | None, options.plot_of("the chances")] = None,
) -> None:
    """Show the chance that each evacuation route is blocked.

    The output begins with the verdict: up to which PFA every route stays below 3 %, which one first does not, and
    because of which pieces. Where the chance of any route differs by more than 20 percentage points between two values,
    further values are inserted halfway, up to 24 of them and down to steps of 2 % of the PFA; they are marked.

    The chance is given against the peak floor acceleration (PFA): at each value every floor of a route shakes with that
    PFA along both axes, by the floor's own motions, each scaled by value / the floor's PFA. The same motions serve at
    every value; the spectrum keeps its shape, PFV scales along. As in a run, each draw is one earthquake, stronger or
    weaker by one factor on all floors, and each piece differs a little from what is filled in: Motion uncertainty and
    Piece uncertainty in the sheet Building.

    Rocking is not monotone: a piece may stand in a stronger motion and overturn in a weaker one, so a chance may fall.
    Ranges are 95 % sampling intervals, for the number of draws only.
    """
    values, settings = PFA.read(pfa), options.read_draw_settings("value", runs=runs, seed=seed, scenario=scenario)
    options.check_file(csv, "table", (".csv",))
    options.check_file(plot, "figure")
    from assess.cli.curve_figures import draw_routes
    from assess.cli.route_output import Sweep
    from assess.pipeline.route_sweep import MOST_INSERTED, find_fragility
    from assess.pipeline.run import compute
    from assess.workbook.read import read_inventory

    with show_progress() as progress:
        inventory = read_inventory(path, progress=progress)
        if not inventory.routes:
            sheet = inventory.sheets.get("Routes", "Routes")
            raise InputError(f"{path.name} has no routes: fill in the sheet {sheet}.")
        assessment = compute(inventory, settings, progress=progress)
        peaks = [value * GRAVITY for value in values]
        fragility = find_fragility(assessment, peaks, most_inserted=MOST_INSERTED, jobs=jobs, progress=progress)
    sweep = Sweep(assessment, fragility)
    say(sweep.to_json() if as_json else sweep.to_text())
    print_warnings(assessment.problems)
    files = {} if csv is None else {csv: sweep.to_csv().encode("utf-8-sig")}
    options.write_files(files, plot, partial(draw_routes, sweep), "route")
