"""``assess new``: a workbook to start from, empty or filled with an example whose live columns hold their results."""

import tempfile
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.errors import InputError, OutputError

if TYPE_CHECKING:
    from assess.workbook.template import Units

ORDER = 1
EXAMPLES = (
    "assess new building.xlsx",
    "assess new example.xlsx --example",
    "assess new edificio.xlsx --language it --units si",
)


class UnitSystem(str, Enum):
    """Units of a new workbook."""

    SI = "si"
    IMPERIAL = "imperial"


def command(
    path: Annotated[Path, typer.Argument(help="The workbook to write, .xlsx.", show_default=False)],
    units: Annotated[UnitSystem, typer.Option(help="Units of the headers: cm or in.")] = UnitSystem.SI,
    language: Annotated[str, typer.Option(help="Language of the workbook: en, it.")] = "en",
    example: Annotated[bool, typer.Option("--example", help="Fill in an example.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Write a workbook to fill in, empty or with an example.

    It has drop-downs, units and help, and its risk classes update while you type.
    """
    from assess.i18n import find_language

    write_new_workbook(path, units.value, language=find_language(language), example=example, replace=force)
    name = f'"{path}"' if " " in str(path) else path
    if example:
        typer.echo(f"wrote {path}. Open it to see its classes. Assess it with: assess run {name}", err=True)
    else:
        typer.echo(f"wrote {path}. Fill in its sheets Floors and Items, then run: assess check {name}", err=True)


def write_new_workbook(
    path: Path, units: "Units", *, language: str = "en", example: bool = False, replace: bool = False
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
    example : bool
        Whether to fill in a small office.
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
    from assess.i18n import ENGLISH, load_catalogue, speaking
    from assess.pipeline.live_values import with_live
    from assess.workbook.example import example_content
    from assess.workbook.template import Content, write_workbook

    catalogue = ENGLISH if language == ENGLISH.code else load_catalogue(language)
    try:
        folder = tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=path.parent)
        with speaking(catalogue), folder as stage:
            part = Path(stage) / path.name
            content = with_live(example_content(units), units) if example else Content()
            write_workbook(part, content, units)
            part.replace(path)
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}.") from None
