"""A workbook to start from: empty, or filled with an example whose live columns hold their results."""

import tempfile
from pathlib import Path
from typing import Literal

from assess.errors import OutputError
from assess.inventory.blank import Content, write_workbook
from assess.language import ENGLISH, load_catalogue, speaking

Units = Literal["si", "imperial"]


def start_workbook(
    path: Path, units: Units, *, language: str = "en", example: bool = False, replace: bool = False
) -> None:
    """Write a workbook to fill in.

    Parameters
    ----------
    path : Path
        An .xlsx; it appears whole or not at all.
    units : "si" or "imperial"
        Units of the headers.
    language : str
        Code of the language of the workbook, one of `assess.language.LANGUAGES`.
    example : bool
        Whether to fill in a small office.
    replace : bool
        Whether a file that is there already may be replaced.

    Raises
    ------
    OutputError
        If the file is there already, or cannot be written.
    """
    if path.suffix.lower() != ".xlsx":
        raise OutputError(f"{path} does not end in .xlsx: name it {path.stem or 'inventory'}.xlsx.")
    if path.exists() and not replace:
        raise OutputError(f"{path} is there already; add --force to replace it, or choose another name.")
    from assess.inventory.example import example_content
    from assess.live_values import with_live

    catalogue = ENGLISH if language == ENGLISH.code else load_catalogue(language)
    try:
        with speaking(catalogue), tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=path.parent) as stage:
            part = Path(stage) / path.name
            content = with_live(example_content(units), units) if example else Content()
            write_workbook(part, content, units)
            part.replace(path)
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}.") from None
