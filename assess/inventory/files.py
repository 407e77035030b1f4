"""Files that the workbook names: records, the logo, plans. Only files inside the workbook's own folder are touched.

A name is judged as text first, by the rules of both Windows and POSIX, before the file system sees it: resolving a
network path would already talk to another machine.
"""

import unicodedata
from pathlib import Path, PurePosixPath, PureWindowsPath

from assess.inventory.cells import CellError, shorten


def find_file(text: str, folder: Path) -> Path:
    """Return the file that `text` names inside `folder`.

    Raises
    ------
    CellError
        If the name leads outside the folder, or no such file is there.
    """
    if not _is_inside(text):
        raise CellError(
            f"the file {shorten(text)} lies outside the workbook's folder.",
            "Copy it beside the workbook and write its name alone.",
        )
    root = folder.resolve()
    path = (root / PureWindowsPath(text).as_posix()).resolve()
    if not path.is_relative_to(root):
        raise CellError(
            f"the file {shorten(text)} leads outside the workbook's folder.", "Copy it beside the workbook."
        )
    if not path.is_file():
        raise CellError(
            f"the file {shorten(text)} is not beside the workbook.", "Check the name, or copy the file there."
        )
    return path


def _is_inside(text: str) -> bool:
    windows, posix = PureWindowsPath(text), PurePosixPath(text)
    odd = any(unicodedata.category(character) in ("Cc", "Cf", "Cs") for character in text)
    absolute = windows.drive or windows.root or posix.is_absolute() or ":" in text
    reserved = any(part.split(".")[0].upper() in _RESERVED for part in windows.parts)
    return not (odd or absolute or reserved or ".." in windows.parts or ".." in posix.parts or len(text) > 500)


_RESERVED = frozenset(
    {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}
)
