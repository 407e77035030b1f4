"""``assess new``: a workbook to start from, empty, for a use, or filled with an example.

The live columns of example rows hold their results.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from assess.cli.console import say
from assess.cli.options import check_new, force, language_of, quote
from assess.errors import InputError, OutputError
from assess.i18n import ENGLISH, find_language, load_catalogue, speaking

if TYPE_CHECKING:
    from assess.workbook.template import Units

ORDER = 1
EXAMPLES = (
    "assess new building.xlsx",
    "assess new hospital.xlsx --for hospital",
    "assess new example.xlsx --example --force",
    "assess new edificio.xlsx --language it --units si",
)


USES = Literal["office", "hospital", "school", "laboratory", "library", "home", "shop"]
"""`assess.workbook.schema.USES` in small letters."""


def command(
    path: Annotated[Path, typer.Argument(help="The workbook to write, .xlsx.", show_default=False)],
    units: Annotated[Literal["si", "imperial"], typer.Option(help="Units of the headers: cm or in.")] = "si",
    language: Annotated[str, language_of("the workbook")] = "en",
    use: Annotated[
        USES | None,
        typer.Option(
            "--for",
            help="List only the furniture of this use, and fill in an example room of it. "
            "Without it every type is listed.",
            show_default=False,
        ),
    ] = None,
    example: Annotated[
        bool,
        typer.Option("--example", help="Fill in an example that can be run: a small office, or with --for its room."),
    ] = False,
    replaces: Annotated[bool, force("an existing file")] = False,
) -> None:
    """Write a workbook to fill in: empty, for one use of a building, or with an example.

    It has drop-downs, units and help, and its risk classes update while you type.
    """
    code, purpose = find_language(language), use.capitalize() if use else ""
    write_new_workbook(path, units, language=code, use=purpose, example=example, replace=replaces)
    then = "Fill in its sheets Floors and Items, then run: assess check"
    if example:
        then = "Open it to see its classes. Assess it with: assess run"
    elif use:
        then = (
            "Put your furniture in place of the example room in Items, fill in how the floor shakes in Floors or "
            "choose Shaking in Building, then run: assess check"
        )
    say(f"wrote {path}. {then} {quote(path)}", err=True)


def write_new_workbook(
    path: Path, units: "Units", *, language: str = "en", use: str = "", example: bool = False, replace: bool = False
) -> None:
    """Write a workbook to fill in; it appears whole or not at all.

    `use` is one of `schema.USES`, for its types of furniture alone and an example room; `example` fills in what can be
    run. Raises InputError if the name does not end in .xlsx; OutputError if the file cannot be written, or is not to be
    replaced.
    """
    if path.suffix.lower() != ".xlsx":
        raise InputError(f"{path} does not end in .xlsx: name it {path.stem or 'inventory'}.xlsx.")
    check_new(path, replaces=replace)
    from assess.delivery.deliver import saving
    from assess.pipeline.live_values import fill_content
    from assess.workbook.template import write_workbook

    catalogue = ENGLISH if language == ENGLISH.code else load_catalogue(language)
    try:
        with speaking(catalogue), saving(path) as part:
            write_workbook(part, fill_content(units, use, is_example=example), units)
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}.") from None
