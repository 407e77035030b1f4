"""Files of recorded motion. The formats are found by looking into this folder: a file with a FORMAT is a format."""

import importlib
import pkgutil
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.record import Record

__all__ = ["Format", "all_formats", "read_records", "select"]

LARGEST_FILE = 64_000_000
"""Bytes; the largest records of single buildings have a few million."""
HEAD = 65_536
"""Bytes by which a format is recognised."""

_FOREIGN = {
    b"PK\x03\x04": "It is a zip archive or a workbook: unpack it, or save the sheet as CSV.",
    b"\xff\xfe": "It is saved as UTF-16: save it as CSV UTF-8.",
    b"\xfe\xff": "It is saved as UTF-16: save it as CSV UTF-8.",
    b"%PDF": "It is a PDF.",
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
    """Read every channel of a file of recorded motion, whatever its format.

    Raises
    ------
    RecordError
        If the file cannot be read or used; the message names the file, what is the matter, and the mend.
    """
    try:
        data = _read_bytes(path)
        return _find_format(data[:HEAD]).read(data, path.name)
    except RecordError as error:
        raise RecordError(f"{path.name or path}: {error}") from error


def select(records: Sequence[Record], channel: str | None = None) -> Record:
    """Return the one record that `channel` names: the part after # where a user writes ``file#channel``.

    Parameters
    ----------
    records : sequence of Record
        All channels of one file.
    channel : str, optional
        A channel's name in any letter case, or its number in the file from 1 on; None where there is only one.

    Raises
    ------
    RecordError
        If no channel, or more than one, is meant; the message lists them.
    """
    file, names = records[0].file, ", ".join(record.channel for record in records)
    if channel is None or not channel.strip():
        if len(records) == 1:
            return records[0]
        raise RecordError(f"{file} holds {len(records)} channels: {names}. Write which, as {file}#{records[0].channel}")
    wanted = channel.strip().casefold()
    # Names come first: a channel may be called by its azimuth, "45".
    named = [record for record in records if record.channel.casefold() == wanted]
    numbered = [record for number, record in enumerate(records, start=1) if str(number) == wanted]
    if named or numbered:
        return (named or numbered)[0]
    raise RecordError(f"{file} has no channel {channel.strip()!r}. It holds: {names}")


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


def _find_format(head: bytes) -> Format:
    for candidate in all_formats():
        if candidate.recognises(head):
            return candidate
    why = next((reason for start, reason in _FOREIGN.items() if head.startswith(start)), _PLAIN_CSV)
    known = ", ".join(candidate.title for candidate in all_formats())
    raise RecordError(f"the content is of no known format (known: {known}). {why}")
