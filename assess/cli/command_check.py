"""``assess check``: every problem of a workbook, by sheet and cell."""

from collections.abc import Sequence
from pathlib import Path
from typing import Never

import typer

from assess.cli.console import count, print_problems, print_ways, show_progress
from assess.cli.options import Workbook
from assess.errors import Gap, Problem, WorkbookError
from assess.settings import Settings

ORDER = 2
EXAMPLES = ("assess check building.xlsx",)


def command(path: Workbook) -> None:
    """Check a workbook and name every problem by sheet and cell.

    Nothing is written. A workbook that lacks only the shaking or the furniture is incomplete: what completes it is
    printed, and the exit status is 1.
    """
    from assess.pipeline.run import compute
    from assess.workbook.read import read_inventory

    try:
        with show_progress() as progress:
            inventory = read_inventory(path, progress=progress)
            assessment = compute(inventory, Settings(verify="none"), progress=progress)
    except WorkbookError as error:
        if not error.is_incomplete:
            raise
        _end_incomplete(path, error.problems)
    if any(isinstance(one, Gap) for one in assessment.problems):
        _end_incomplete(path, assessment.problems)
    print_problems(assessment.problems)
    rows, floors = count(len(inventory.items), "row"), count(len(inventory.floors), "floor")
    segments = count(len(inventory.routes), "route segment")
    typer.echo(f"{path.name}: no errors. {rows} of furniture on {floors}, {segments}.")


def _end_incomplete(path: Path, problems: Sequence[Problem]) -> Never:
    """Print what a workbook lacks and what completes it."""
    print_problems(problems)
    typer.echo(f"{path.name} is incomplete: what is filled in can be used; still to be filled in:", err=True)
    print_ways(problems)
    raise typer.Exit(1)
