"""``assess routes``: the chance that each evacuation route is blocked, against the PFA of its floors."""

import re
from collections.abc import Sequence
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli.console import count, print_warnings, show_progress
from assess.cli.options import AsJson, Jobs, Scenario, Seed, Workbook, check_file, figure_kind, read_settings, save_file
from assess.errors import InputError
from assess.settings import AUTO, RUNS
from assess.units import GRAVITY

if TYPE_CHECKING:
    from assess.cli.route_output import Sweep

ORDER = 4
EXAMPLES = (
    "assess routes building.xlsx",
    "assess routes building.xlsx --pfa 0.1:0.6:0.1 --plot routes.png --csv routes.csv",
)

MOST_PFA, STEP, MOST_VALUES = Decimal(5), "0.05", 50
"""Largest PFA [g], the default step [g], and the largest number of values."""
NUMBER = r"(\d{1,4}(?:\.\d{0,12})?|\.\d{1,12})"
PFA = re.compile(rf"{NUMBER}:{NUMBER}(?::{NUMBER})?", re.ASCII)


def command(
    path: Workbook,
    pfa: Annotated[
        str, typer.Option(metavar="LOW:HIGH[:STEP]", help="PFA on the routes' floors [g]: both ends, steps of 0.05.")
    ] = "0.1:1.0",
    runs: Annotated[
        str | None, typer.Option(help="Draws: motions of each floor and axis.", show_default=str(RUNS))
    ] = None,
    seed: Seed = None,
    scenario: Scenario = None,
    jobs: Jobs = None,
    as_json: AsJson = False,
    csv: Annotated[
        Path | None, typer.Option(help="Write a table to this .csv, one line for each route and PFA.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the chances to this .png, .svg or .pdf.")] = None,
) -> None:
    """Show the chance that each evacuation route is blocked.

    The chance is given against the peak floor acceleration (PFA): at each value every floor of a route shakes with that
    PFA along both axes, by the floor's own motions, each scaled by value / the floor's PFA. The same motions serve at
    every value; the spectrum keeps its shape, PFV scales along. As in a run, each draw is one earthquake, stronger or
    weaker by one factor on all floors, and each piece differs a little from what is filled in: Motion uncertainty and
    Piece uncertainty in the sheet Building.

    Rocking is not monotone: a piece may stand in a stronger motion and overturn in a weaker one, so a chance may fall.
    """
    values, settings = read_pfa(pfa), read_settings(verify="none", runs=runs, seed=seed, scenario=scenario)
    if settings.runs == AUTO:
        raise InputError(f"--runs: {AUTO} is for assess run, as every value uses the same motions. Give a number.")
    check_file(csv, "table", (".csv",))
    check_file(plot, "figure")
    from assess.cli.route_output import Sweep
    from assess.pipeline.route_sweep import find_fragility
    from assess.pipeline.run import compute
    from assess.workbook.read import read_inventory

    with show_progress() as progress:
        inventory = read_inventory(path, progress=progress)
        if not inventory.routes:
            sheet = inventory.sheets.get("Routes", "Routes")
            raise InputError(f"{path.name} has no routes: fill in the sheet {sheet}.")
        assessment = compute(inventory, settings, progress=progress)
        print_warnings(assessment.problems)
        peaks = [value * GRAVITY for value in values]
        fragility = find_fragility(assessment, peaks, jobs=jobs, progress=progress)
    sweep = Sweep(assessment, fragility)
    typer.echo(sweep.to_json() if as_json else sweep.to_text())
    if csv is not None:
        save_file(sweep.to_csv().encode("utf-8-sig"), csv)
        typer.echo(f"wrote {csv}", err=True)
    if plot is not None:
        left = _write_figure(sweep, plot)
        typer.echo(f"wrote {plot}" + (f"; {count(left, 'more route')} not drawn" if left else ""), err=True)


def read_pfa(text: str) -> Sequence[float]:
    """Return the values of PFA [g] that ``LOW:HIGH`` or ``LOW:HIGH:STEP`` means: both ends, and every step between."""
    found = PFA.fullmatch(text.strip())
    if found is None:
        raise InputError(f"--pfa: {text[:40]!r} is not LOW:HIGH or LOW:HIGH:STEP in g, as 0.1:1.0 or 0.1:1.0:0.05.")
    low, high, step = (Decimal(part) for part in (found[1], found[2], found[3] or STEP))
    if not 0 < low <= high <= MOST_PFA:
        raise InputError(f"--pfa is {low} to {high} g, expected above 0, LOW first, and at most {MOST_PFA} g.")
    if step == 0:
        raise InputError("--pfa: the step is 0 g, expected above 0.")
    steps = int((high - low) / step)
    values = [low + step * at for at in range(min(steps, MOST_VALUES) + 1)]
    values += [high] if values[-1] < high else []
    if len(values) > MOST_VALUES:
        raise InputError(f"--pfa: {text.strip()} gives over {MOST_VALUES} values. Take a larger step.")
    return [float(one) for one in values]


def _write_figure(sweep: "Sweep", path: Path) -> int:
    """Write the figure; return how many routes it has no room for."""
    from assess.cli.route_figure import choose_drawn, paint, size
    from assess.report.figures.draw import draw

    drawn, left = choose_drawn(sweep.fragility.routes)
    picture = draw(*size(drawn), partial(paint, sweep.fragility, drawn, sweep.pfa_g), figure_kind(path))
    save_file(picture, path)
    return len(left)
