"""``assess import``: an inventory workbook out of a handover file of a building."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli.console import count, show_progress
from assess.cli.options import save_file
from assess.errors import InputError, OutputError

if TYPE_CHECKING:
    from assess.bim.import_workbook import ImportedBuilding

ORDER = 2
EXAMPLES = (
    "assess import handover-cobie.xlsx --out building.xlsx",
    "assess import handover-cobie.xlsx --out building.xlsx --force",
)
COBIE = (".xlsx", ".xlsm")


def command(
    source: Annotated[Path, typer.Argument(metavar="FILE", help="A COBie spreadsheet (.xlsx).", show_default=False)],
    out: Annotated[Path, typer.Option("--out", "-o", help="The workbook to write, an .xlsx.", show_default=False)],
    force: Annotated[bool, typer.Option("--force", help="Replace an existing workbook.")] = False,
) -> None:
    """Make an inventory workbook from a COBie handover file.

    Moveable types with sizes become pieces, one row a component, with room, floor and the identifier of the file. What
    is left out is listed by type with the reason. The workbook lacks only how the floors shake: choose Shaking in
    Building, or fill in Floors. The exit status is 1 where furniture was left out, or none was found.
    """
    _check_names(source, out, replaces=force)
    from assess.bim.cobie import read_cobie
    from assess.bim.import_workbook import build_workbook

    with show_progress() as progress, progress.stage("reading", source.name):
        found = progress.wait_for(lambda: read_cobie(source, source.name, progress))
        data = progress.wait_for(lambda: build_workbook(found))
    save_file(data, out)
    for line in describe_import(found):
        typer.echo(line)
    typer.echo(
        f"wrote {out}. Choose Shaking in Building or fill in Floors, then run: assess check {_quote(out)}", err=True
    )
    if not found.is_complete:
        raise typer.Exit(1)


def _quote(path: Path) -> str:
    return f'"{path}"' if " " in str(path) else str(path)


def _check_names(source: Path, out: Path, *, replaces: bool) -> None:
    """Raise unless a file of this kind is read and the workbook may be written, as far as is known before the work.

    Raises
    ------
    InputError
        If the file is of a kind that is not read, or the workbook is the file itself or does not end in .xlsx.
    OutputError
        If the workbook exists, and it was not asked for that it be replaced.
    """
    if source.suffix.lower() not in COBIE:
        raise InputError(f"{source} is of a kind that is not imported: name a COBie spreadsheet, which ends in .xlsx.")
    if out.suffix.lower() != ".xlsx":
        raise InputError(f"--out: {out} does not end in .xlsx: name it {out.stem or 'building'}.xlsx.")
    if out.resolve() == source.resolve() or (out.exists() and source.exists() and out.samefile(source)):
        raise InputError(f"--out: {out} is the file to import: name another file, so that the original stays as it is.")
    if out.exists() and not replaces:
        raise OutputError(f"{out} already exists: add --force to replace it, or choose another name.")


def describe_import(found: "ImportedBuilding") -> Iterator[str]:
    """Yield what was taken, what was left out by reason and type, and what has to be checked."""
    from assess.bim.import_workbook import MOST_NAMED, group_skipped, say_skipped

    kinds = {row["type"] for row in found.items}
    taken = f"{count(len(found.items), 'piece')} of {count(len(kinds), 'type')} on {count(len(found.floors), 'floor')}"
    yield f"{found.source}: {taken} taken."
    if not found.items:
        yield "No furniture was found: fill in Items by hand."
    yield from (say_skipped(group, MOST_NAMED) for _, group in group_skipped(found.skipped))
    yield from (f"Check: {text}" for text in (*found.warnings, *found.remarks))
