"""``assess import``: an inventory workbook out of a building model, a scan or a handover file of a building."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from assess.cli.console import say, show_progress
from assess.cli.options import force, is_same, quote, save_files
from assess.errors import InputError, OutputError
from assess.i18n import count, load_catalogue, speaking
from assess.progress import Progress

if TYPE_CHECKING:
    from assess.bim.import_workbook import ImportedBuilding

ORDER = 2
EXAMPLES = (
    "assess import model.ifc --out building.xlsx",
    "assess import model.ifc --out building.xlsx --routes draft",
    "assess import model.ifc --out building.xlsx --update",
    "assess import model.ifc --out building.xlsx --also IfcBuildingElementProxy",
    "assess import handover-cobie.xlsx --out building.xlsx --force",
)
MOST_CHANGES = 200  # changes that are listed one by one


def command(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="A building model (.ifc), a RoomPlan scan (.json), a Sweet Home 3D file (.sh3d) or a COBie "
            "spreadsheet (.xlsx).",
            show_default=False,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="The workbook to write, an .xlsx.", show_default=False)],
    routes: Annotated[
        Literal["none", "draft"],
        typer.Option("--routes", help="Draft evacuation routes from the rooms to stairs and exits."),
    ] = "none",
    also: Annotated[
        list[str] | None,
        typer.Option("--also", metavar="CLASS", help="A further class of the model whose elements are furniture, "
                     "such as IfcBuildingElementProxy; may be given several times.", show_default=False),
    ] = None,
    update: Annotated[
        bool,
        typer.Option("--update", help="Take new sizes, positions and pieces into the workbook; all else in it stays."),
    ] = False,
    replaces: Annotated[bool, force("an existing workbook")] = False,
) -> None:  # fmt: skip
    """Make an inventory workbook from a building model, a scan or a COBie handover file.

    Furniture becomes rows with sizes, floor, room, position and the identifier of the file; rooms and doors become
    Places, and a plan of each storey is written beside the workbook. What is left out is listed by type with the
    reason, on the screen and in a file beside the workbook, which lacks only how the floors shake: choose Shaking in
    Building, or fill in Floors. The exit status is 1 where furniture was left out, or none was found.
    """
    if update and replaces:
        raise InputError("--update keeps what is in the workbook, --force replaces it: give one of them.")
    if update and routes != "none":
        raise InputError(
            f"--update: --routes {routes}: routes are drafted into a new workbook only: leave out one of the two."
        )
    if out.suffix.lower() != ".xlsx":
        raise InputError(f"--out: {out} does not end in .xlsx: name it {out.stem or 'building'}.xlsx.")
    if is_same(out, source):
        raise InputError(f"--out: {out} is the file to import: name another file, so that the original stays as it is.")
    if update and not out.exists():
        raise InputError(f"--update: {out} does not exist: name the workbook of an earlier import, or leave it out.")
    if out.exists() and not (replaces or update):
        raise OutputError(
            f"{out} already exists: add --update to take the changes of the model into it, --force to replace it, or "
            "choose another name."
        )
    from assess.bim.import_workbook import build_workbook, describe
    from assess.bim.read_source import read_source

    choices: Mapping[str, Any] = {"routes": routes, "also": also or ()}
    with show_progress() as progress, progress.stage("reading", source.name):
        if update:
            made = _update(source, out, progress, choices)
        else:
            found = read_source(source, source.name, progress, **choices)
            plans = {out.parent / name: data for name, data in found.files.items()}
            there = next((path for path in plans if path.exists()), None)
            if there is not None and not replaces:
                raise OutputError(
                    f"{there} already exists: add --force to replace it, or write the workbook into another folder."
                )
            made = _Made(progress.wait_for(lambda: build_workbook(found)), plans, found, found.is_complete)
    save_files({**({out: made.data} if made.data is not None else {}), **made.plans})
    for line in (*describe(made.found), *made.lines):
        say(line)
    drawn = sum(path.suffix == ".svg" for path in made.plans)
    parts = [*([str(out)] if made.data is not None else ()), *([count(drawn, "plan")] if drawn else ())]
    written = f"{', '.join(parts)} and this list beside it" if parts else "this list beside it"
    then = "Now run" if update else "Choose Shaking in Building or fill in Floors, then run"
    start = "" if made.data is not None else f"{out} stays as it is; "
    say(f"{start}wrote {written}. {then}: assess check {quote(out)}", err=True)
    if not made.is_complete:
        raise typer.Exit(1)


@dataclass(frozen=True, slots=True)
class _Made:
    """A workbook (None where it stays), the plans beside it, what was found for it, and what else is to be said."""

    data: bytes | None
    plans: Mapping[Path, bytes]
    found: "ImportedBuilding"
    is_complete: bool
    lines: tuple[str, ...] = ()


def _update(source: Path, out: Path, progress: Progress, choices: Mapping[str, Any]) -> _Made:
    """Read the model in the workbook's language, for the names of places; OutputError if it was saved meanwhile."""
    from assess.bim.import_workbook import ENDING
    from assess.bim.read_source import read_source
    from assess.bim.update_workbook import describe, update_workbook
    from assess.workbook.open import read_file
    from assess.workbook.read import open_workbook

    data = read_file(out)
    with speaking(load_catalogue(open_workbook(data, out.name, progress).language)):
        found = read_source(source, source.name, progress, **choices)
        updated = progress.wait_for(lambda: update_workbook(data, found, out.name, progress, records=out.parent))
    is_whole = not updated.problems and not any(one.kind == "left_out" for one in updated.changes)
    lines, (x, y) = [], updated.moved
    if x or y:
        lines.append(
            f"Positions of the model were moved by {x:,.0f} m along X and {y:,.0f} m along Y, as in the workbook."
        )
    if not updated.changes:
        lines.append("The workbook is up to date with the model: nothing was changed.")
    lines += [str(describe(change)) for change in updated.changes[:MOST_CHANGES]]
    if len(updated.changes) > MOST_CHANGES:
        lines.append(f"and {len(updated.changes) - MOST_CHANGES:,} changes more.")
    lines += map(str, updated.problems)
    records = {name: text for name, text in found.files.items() if name.endswith(ENDING)}
    plans = {out.parent / name: one for name, one in {**updated.plans, **records}.items()}
    try:
        is_unchanged = out.read_bytes() == data
    except OSError:
        is_unchanged = False
    if not is_unchanged:
        raise OutputError(f"{out.name} was changed while the model was read: run the import again.")
    written = updated.data if updated.is_changed else None
    return _Made(written, plans, found, found.is_complete and is_whole, tuple(lines))
