"""``assess check``: every problem of a workbook, by sheet and cell."""

import typer

from assess.cli.console import count, print_problems, show_progress
from assess.cli.options import Workbook
from assess.settings import Settings

ORDER = 2
EXAMPLES = ("assess check building.xlsx",)


def command(path: Workbook) -> None:
    """Check a workbook and name every problem by sheet and cell.

    Nothing is written.
    """
    from assess.pipeline.run import compute
    from assess.workbook.read import read_inventory

    with show_progress() as progress:
        inventory = read_inventory(path, progress=progress)
        assessment = compute(inventory, Settings(verify="none"), progress=progress)
    print_problems(assessment.problems)
    rows, floors = count(len(inventory.items), "row"), count(len(inventory.floors), "floor")
    segments = count(len(inventory.routes), "route segment")
    typer.echo(f"{path.name}: no errors. {rows} of furniture on {floors}, {segments}.")
