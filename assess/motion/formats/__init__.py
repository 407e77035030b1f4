"""Files of recorded motion. The formats are found by looking into this folder: a file with a FORMAT is a format."""

import importlib
import pkgutil
from functools import cache
from pathlib import Path

from assess.errors import RecordError
from assess.motion.formats._archive import is_archive, read_archive
from assess.motion.formats._choice import list_addresses, select, tell_apart
from assess.motion.formats._format import Format
from assess.motion.record import Record

__all__ = ["Format", "all_formats", "list_addresses", "read_records", "select"]

LARGEST_FILE = 64_000_000
"""Bytes; the largest records of single buildings have a few million."""
HEAD = 65_536
"""Bytes by which a format is recognised."""

_FOREIGN = {
    b"\xff\xfe": "It is saved as UTF-16: save it as CSV UTF-8.",
    b"\xfe\xff": "It is saved as UTF-16: save it as CSV UTF-8.",
    b"%PDF": "It is a PDF.",
    b"\x1f\x8b": "It is a gzip archive: unpack it.",
    b"7z\xbc\xaf": "It is a 7z archive: unpack it.",
    b"Rar!": "It is a RAR archive: unpack it.",
}
_PLAIN_CSV = (
    "Other records can be given as plain CSV, whose first row names time and each channel with its unit: "
    "time [s], north [cm/s2], east [cm/s2]"
)


@cache
def all_formats() -> tuple[Format, ...]:
    """Return every format of this folder, by key."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    return tuple(sorted((module.FORMAT for module in modules), key=lambda found: found.key))


def read_records(path: Path) -> tuple[Record, ...]:
    """Read every channel of a file of recorded motion, whatever its format, or of all those in a zip archive.

    Raises
    ------
    RecordError
        If the file cannot be read or used; the message names the file, what is the matter, and the mend.
    """
    try:
        data = _read_bytes(path)
        read = read_archive(data, path.name, _read_member) if is_archive(data) else _read(data, path.name)
        return tell_apart(read)
    except RecordError as error:
        raise RecordError(f"{path.name or path}: {error}") from error


def _read_bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise RecordError("there is no such file. Check the name and the folder") from None
    except IsADirectoryError:
        raise RecordError("this is a folder. Name one of the files in it") from None
    except PermissionError:
        # Windows says this of folders, too.
        raise RecordError("it is a folder, is open in another program, or you have no right to read it") from None
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        raise RecordError(f"the file cannot be read ({error})") from None
    if not data:
        raise RecordError("the file is empty. Get it again")
    if len(data) > LARGEST_FILE:
        raise RecordError(
            f"the file is larger than {LARGEST_FILE / 1e6:.0f} MB. Cut it to the shaking, or split its channels"
        )
    return data


def _read(data: bytes, file: str) -> tuple[Record, ...]:
    found = _find_format(data[:HEAD])
    if found is None:
        why = next((reason for start, reason in _FOREIGN.items() if data.startswith(start)), _PLAIN_CSV)
        known = ", ".join(candidate.title for candidate in all_formats())
        raise RecordError(f"the content is of no known format (known: {known}; also in zip archives). {why}")
    return found.read(data, file)


def _read_member(data: bytes, file: str) -> tuple[Record, ...]:
    """Read a file of an archive: there may be many of no known format, and they are left out."""
    found = _find_format(data[:HEAD])
    if found is None:
        raise RecordError("of no known format")
    return found.read(data, file)


def _find_format(head: bytes) -> Format | None:
    return next((candidate for candidate in all_formats() if candidate.recognises(head)), None)
