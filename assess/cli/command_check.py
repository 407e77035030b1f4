"""``assess check``: every problem of a workbook, by sheet and cell; what is only typed otherwise can be corrected."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Never

import typer

from assess.cli.console import count_errors, print_numbered, print_problems, print_ways, say, show_progress
from assess.cli.options import Workbook, check_file, check_new, force, is_same, save_files
from assess.errors import Gap, InputError, Problem, WorkbookError
from assess.i18n import count
from assess.settings import Settings

if TYPE_CHECKING:
    from assess.model import Inventory

ORDER = 2
EXAMPLES = (
    "assess check building.xlsx",
    "assess check building.xlsx --fix corrected.xlsx --force",
    "assess check building.xlsx 2> problems.txt",
)

MOST_SHOWN = 3  # cells of one kind of correction that are listed; the rest are counted


def command(
    path: Workbook,
    fix: Annotated[
        Path | None,
        typer.Option(help="Write a corrected copy: cells typed in another way as their column asks.", metavar="OUT"),
    ] = None,
    replaces: Annotated[bool, force("an existing OUT")] = False,
) -> None:
    """Check a workbook and name every problem by sheet and cell.

    A workbook that lacks only the shaking or the furniture is incomplete: what completes it is printed, and the exit
    status is 1. Nothing is written but the copy that --fix asks for. It changes the cells that were understood although
    they are typed in another way, such as "45 cm" in a column of cm, and nothing else; it is written even if errors
    remain, which the exit status still tells.
    """
    from assess.workbook.read import read_inventory

    try:
        if fix is not None:
            inventory = _write_corrected(path, fix, replaces=replaces)
            if inventory.errors:  # read again as without --fix: nothing is left out, and so nothing said of that
                read_inventory(inventory.data or b"", records=path.resolve().parent)
        else:
            with show_progress() as progress:
                inventory = read_inventory(path, progress=progress)
        from assess.pipeline.demand import find_shaking
        from assess.pipeline.run import compute
        from assess.workbook.habits import BETTER

        with show_progress() as progress:
            assessment = compute(inventory, Settings(verify="none"), progress=progress)
        if any(isinstance(one, Gap) for one in assessment.problems):
            _end_incomplete(path, assessment.problems)
        print_problems(assessment.problems)
        if find_shaking(assessment.demands) is not None:
            print_numbered("To know the shaking better:", BETTER)
        rows, floors = count(len(inventory.items), "row"), count(len(inventory.floors), "floor")
        segments = count(len(inventory.routes), "route segment")
        say(f"{path.name}: no errors. {rows} of furniture on {floors}, {segments}.")
    except WorkbookError as error:
        if error.is_incomplete:
            _end_incomplete(path, error.problems)
        if fix is None:
            raise
        print_problems(error.problems)
        print_ways(error.problems)
        say(f"{count_errors(error.problems)} to correct by hand.", err=True)
        raise typer.Exit(2) from None


def _end_incomplete(path: Path, problems: Sequence[Problem]) -> Never:
    print_problems(problems)
    say(f"{path.name} is incomplete: what is filled in can be used.", err=True)
    print_ways(problems)
    raise typer.Exit(1)


def _write_corrected(path: Path, out: Path, *, replaces: bool) -> "Inventory":
    """Write the corrected workbook, if there is anything to correct, and print what was changed."""
    from assess.pipeline.corrected import correct_workbook, group_corrections
    from assess.workbook.habits import shorten

    check_file(out, "copy", (path.suffix.lower() or ".xlsx",))
    if is_same(out, path):
        raise InputError(f"{out} is the workbook itself: name another file, so that the original stays as it is.")
    check_new(out, replaces=replaces)
    with show_progress() as progress:
        done = correct_workbook(path, progress)
    own = done.inventory
    if not done.changed:
        say(f"{path.name}: no cell to correct; {out} was not written.")
    else:
        save_files({out: own.data or b""})
        say(f"wrote {out}: {count(len(done.changed), 'cell')} corrected.")
    for group in group_corrections(done.changed):
        shown = []
        for one in group[:MOST_SHOWN]:
            now = f"{one.value:.12g}" if isinstance(one.value, int | float) else "blank"
            now = shorten(one.value) if isinstance(one.value, str) else now
            shown.append(f"{one.cell} {shorten(one.was)} -> {now}")
        first, more = group[0], len(group) - MOST_SHOWN
        listed = ", ".join(shown) + (f" and {more:,} more" if more > 0 else "")
        where = (
            f"{first.sheet}!{listed}" if len(group) == 1 else f"{first.sheet}, {count(len(group), 'cell')}: {listed}"
        )
        say(f"  {where}. {first.why}")
    for one in done.kept:
        say(f"{one.sheet}!{one.cell} holds a formula and is left as it is: {shorten(one.was)}")
    names_files = own.files or any(floor.plan for floor in own.floors) or own.building.logo
    if done.changed and names_files and path.resolve().parent != out.resolve().parent:
        say(f"The files that the workbook names lie next to {path.name}: copy them next to {out.name} as well.")
    return own
