"""``assess new``: a workbook to start from, empty, for a use, or filled with an example.

The live columns of example rows hold their results.
"""

from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli.completion import one_of
from assess.cli.console import say
from assess.errors import InputError, OutputError
from assess.i18n import LANGUAGES

if TYPE_CHECKING:
    from assess.workbook.template import Units

ORDER = 1
EXAMPLES = (
    "assess new building.xlsx",
    "assess new hospital.xlsx --for hospital",
    "assess new example.xlsx --example --force",
    "assess new edificio.xlsx --language it --units si",
)


class UnitSystem(str, Enum):
    """Units of a new workbook."""

    SI = "si"
    IMPERIAL = "imperial"


class Use(str, Enum):
    """Uses of a building: `assess.workbook.schema.USES` in small letters."""

    OFFICE = "office"
    HOSPITAL = "hospital"
    SCHOOL = "school"
    LABORATORY = "laboratory"
    LIBRARY = "library"
    HOME = "home"
    SHOP = "shop"


def command(
    path: Annotated[Path, typer.Argument(help="The workbook to write, .xlsx.", show_default=False)],
    units: Annotated[UnitSystem, typer.Option(help="Units of the headers: cm or in.")] = UnitSystem.SI,
    language: Annotated[
        str, typer.Option(help="Language of the workbook: en, it.", autocompletion=one_of(LANGUAGES))
    ] = "en",
    use: Annotated[
        Use | None,
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
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Write a workbook to fill in: empty, for one use of a building, or with an example.

    It has drop-downs, units and help, and its risk classes update while you type.
    """
    from assess.i18n import find_language

    purpose = use.value.capitalize() if use else ""
    write_new_workbook(path, units.value, language=find_language(language), use=purpose, example=example, replace=force)
    name = f'"{path}"' if " " in str(path) else path
    if example:
        say(f"wrote {path}. Open it to see its classes. Assess it with: assess run {name}", err=True)
    elif use:
        steps = "Put your furniture in place of the example room in Items, fill in how the floor shakes in Floors or "
        steps += "choose Shaking in Building"
        say(f"wrote {path}. {steps}, then run: assess check {name}", err=True)
    else:
        say(f"wrote {path}. Fill in its sheets Floors and Items, then run: assess check {name}", err=True)


def write_new_workbook(
    path: Path, units: "Units", *, language: str = "en", use: str = "", example: bool = False, replace: bool = False
) -> None:
    """Write a workbook to fill in; it appears whole or not at all.

    Parameters
    ----------
    path : Path
        An .xlsx.
    units : "si" or "imperial"
        Units of the headers.
    language : str
        Code of the language of the workbook, one of `assess.i18n.LANGUAGES`.
    use : str
        One of `assess.workbook.schema.USES`, for its types of furniture alone and an example room; blank: every type.
    example : bool
        Whether to fill in an example that can be run: a small office, or the room of `use`.
    replace : bool
        Whether an existing file may be replaced.

    Raises
    ------
    InputError
        If the name does not end in .xlsx.
    OutputError
        If the file exists, or cannot be written.
    """
    if path.suffix.lower() != ".xlsx":
        raise InputError(f"{path} does not end in .xlsx: name it {path.stem or 'inventory'}.xlsx.")
    if path.exists() and not replace:
        raise OutputError(f"{path} already exists: add --force to replace it, or choose another name.")
    from assess.delivery.deliver import saving
    from assess.i18n import ENGLISH, load_catalogue, speaking
    from assess.pipeline.live_values import fill_content
    from assess.workbook.template import write_workbook

    catalogue = ENGLISH if language == ENGLISH.code else load_catalogue(language)
    try:
        with speaking(catalogue), saving(path) as part:
            write_workbook(part, fill_content(units, use, is_example=example), units)
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}.") from None
