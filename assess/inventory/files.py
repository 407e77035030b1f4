"""Files that the workbook names: records, the logo, plans. Only files inside the workbook's own folder are touched.

A name is judged as text first, by the rules of both Windows and POSIX, before the file system sees it: resolving a
network path would already talk to another machine.
"""

import unicodedata
from pathlib import Path, PurePosixPath, PureWindowsPath

from assess.inventory.cells import CellError, shorten

MAX_PICTURE = 10 * 2**20
_PICTURES = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff")


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
    try:
        path = (root / PureWindowsPath(text).as_posix()).resolve()
        is_file = path.is_file()
    except (OSError, RuntimeError):  # a name that is too long; links that lead in a circle
        raise CellError(f"the file {shorten(text)} cannot be looked up.", "Give it a shorter, simpler name.") from None
    if not path.is_relative_to(root):
        raise CellError(
            f"the file {shorten(text)} leads outside the workbook's folder.", "Copy it beside the workbook."
        )
    if not is_file:
        raise CellError(
            f"the file {shorten(text)} is not beside the workbook.", "Check the name, or copy the file there."
        )
    return path


def find_picture(text: str, folder: Path) -> Path:
    """Return the picture that `text` names inside `folder`.

    Raises
    ------
    CellError
        As `find_file`; or if it is no PNG or JPEG, or is too large.
    """
    path = find_file(text, folder)
    try:
        size, head = path.stat().st_size, _head(path)
    except OSError as error:
        message = f"the file {shorten(text)} cannot be opened: {error.strerror}."
        raise CellError(message, "Check who may read it.") from None
    if size > MAX_PICTURE:
        raise CellError(f"{shorten(text)} is larger than {MAX_PICTURE >> 20} MB.", "Save a smaller picture.")
    if not head.startswith(_PICTURES):
        raise CellError(f"{shorten(text)} is no PNG or JPEG picture.", "Save it as PNG or JPEG.")
    return path


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(8)


def _is_inside(text: str) -> bool:
    windows, posix = PureWindowsPath(text), PurePosixPath(text)
    odd = any(unicodedata.category(character) in ("Cc", "Cf", "Cs") for character in text)
    absolute = windows.drive or windows.root or posix.is_absolute() or ":" in text
    reserved = any(part.split(".")[0].upper() in _RESERVED for part in windows.parts)
    return not (odd or absolute or reserved or ".." in windows.parts or ".." in posix.parts or len(text) > 500)


_RESERVED = frozenset(
    {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}
)
