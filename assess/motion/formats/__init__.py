"""Files of recorded motion. The formats are found by looking into this folder: each `Format` in a module is one."""

import importlib
import pkgutil
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

from assess.errors import RecordError
from assess.i18n import fill, join
from assess.motion.formats._archive import is_archive, read_archive
from assess.motion.formats._format import Format, settle_directions
from assess.motion.record import Baseline, Motion, Record, treat
from assess.progress import SILENT, Progress
from assess.resources import read_input

__all__ = [
    "Channel",
    "Format",
    "all_formats",
    "is_archive",
    "list_addresses",
    "parse_records",
    "read_bytes",
    "read_channel",
    "read_channels",
    "read_records",
    "select",
    "settle_directions",
]

LARGEST_FILE = 64_000_000
"""Bytes; the largest records of single buildings have a few million."""
HEAD = 65_536
"""Bytes by which a format is recognised."""
LISTED = 12
"""Names that an error lists."""

_NO_FILE = {
    FileNotFoundError: fill("there is no such file. Check the name and the folder"),
    IsADirectoryError: fill("this is a folder. Name one of the files in it"),
    # Windows reports folders like this, too.
    PermissionError: fill("it is a folder, is open in another program, or you have no right to read it"),
}
_UTF_16 = fill("It is saved as UTF-16: save it as CSV UTF-8")
_FOREIGN = {
    b"\xff\xfe": _UTF_16,
    b"\xfe\xff": _UTF_16,
    b"%PDF": fill("It is a PDF: give the record itself"),
    b"\x1f\x8b": fill("It is a gzip archive: unpack it"),
    b"7z\xbc\xaf": fill("It is a 7z archive: unpack it"),
    b"Rar!": fill("It is a RAR archive: unpack it"),
}
_PLAIN_CSV = fill(
    "Other records can be given as plain CSV, whose first row names time and each channel with its unit: "
    "time [s], north [cm/s2], east [cm/s2]"
)


@cache
def all_formats() -> tuple[Format, ...]:
    """Return every format of this folder, by key."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    found = {value.key: value for module in modules for value in vars(module).values() if isinstance(value, Format)}
    return tuple(found[key] for key in sorted(found))


def read_records(path: Path, *, progress: Progress = SILENT) -> tuple[Record, ...]:
    """Read every channel of a file of recorded motion of any format, or of all those in a zip archive.

    Raises RecordError if it cannot be read or used; the message names the file, the fault, and how to fix it.
    """
    return progress.wait_for(lambda: parse_records(read_bytes(path), path.name, progress=progress))


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a file, but no more than show that it is too large; RecordError if it cannot be read."""
    try:
        return read_input(path, LARGEST_FILE)
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = next((text for kind, text in _NO_FILE.items() if isinstance(error, kind)), None)
        why = why or fill("the file cannot be read ({why})", why=getattr(error, "strerror", None) or error)
        raise RecordError(join(": ", (path.name or path, why))) from None


def parse_records(data: bytes, name: str, *, progress: Progress = SILENT) -> tuple[Record, ...]:
    """Read every channel of a file from its bytes, as `read_records` does; `name` is how messages call the file."""
    try:
        if not data:
            raise RecordError.about("the file is empty. Get it again")
        if len(data) > LARGEST_FILE:
            raise RecordError.about(
                "the file is larger than {most:.0f} MB. Cut it to the shaking, or split its channels",
                most=LARGEST_FILE / 1e6,
            )
        found = read_archive(data, name, _read_file, progress) if is_archive(data) else _read_file(data, name)
        if found is None:
            why = next((reason for start, reason in _FOREIGN.items() if data.startswith(start)), _PLAIN_CSV)
            raise RecordError.about(
                "the file format is not supported (supported: {known}; also in zip archives). {why}",
                known=", ".join(candidate.title for candidate in all_formats()),
                why=why,
            )
        return settle_directions(rename_duplicates(found))
    except RecordError as error:
        raise RecordError(join(": ", (name, error.message))) from error


def _read_file(data: bytes, file: str) -> tuple[Record, ...] | None:
    """Return the channels of a file that is no archive; None where its format is not known."""
    found = next((candidate for candidate in all_formats() if candidate.recognises(data[:HEAD])), None)
    return found.read(data, file) if found else None


# ---------------------------------------------------------------- which channel is meant


class Channel(NamedTuple):
    """One channel: what to write into a workbook to name it, as its file has it, and as treated."""

    name: str
    record: Record
    motion: Motion


def read_channels(name: str) -> list[Channel]:
    """Return the channels of ``FILE``, or the one of ``FILE#channel``; RecordError as of `read_channel`."""
    path, channel = _split(name)
    if channel is not None:
        return [read_channel(name)]
    records = read_records(path)
    texts = [""] if len(records) == 1 else [f"#{text}" for text in list_addresses(records)]
    return [Channel(f"{path.name}{text}", record, treat(record)) for text, record in zip(texts, records, strict=True)]


def read_channel(name: str, baseline: Baseline = "standard") -> Channel:
    """Return the channel of ``FILE#channel``, or the only one of ``FILE``.

    Raises RecordError if the file cannot be read, or has no such channel, or several and none is named: listed then.
    """
    path, channel = _split(name)
    record = select(read_records(path), channel)
    return Channel(path.name if channel is None else f"{path.name}#{channel}", record, treat(record, baseline))


def _split(name: str) -> tuple[Path, str | None]:
    """Return the file and the channel that a name means: a file may have a # in its own name."""
    file, hash_sign, channel = name.partition("#")
    with suppress(OSError):  # a name that is too long
        if not hash_sign or Path(name).exists():
            return Path(name), None
    return Path(file), channel


def select(records: Sequence[Record], channel: str | None = None) -> Record:
    """Return the one record that `channel` names: the part after # where a user writes ``file#channel``.

    In a zip archive, channels of the same name are distinguished by the member they are in:
    ``set.zip#CHAN01.V2/1``, with as many folders and inner archives before it as it takes:
    ``set.zip#Free Field.zip/CHAN01.V2/1``. The member alone, ``set.zip#CHAN01.V2``, is enough where it has one channel.

    * `records`: all channels of one file.
    * `channel`: a channel's name in any letter case; or its number in the file from 1 on, but not in an archive, nor
      where a channel's name is a number, unless there is only one. None where there is only one.

    Raises RecordError if no channel, or more than one, is meant; the message lists them.
    """
    file, addresses = records[0].file.split("/")[0], list_addresses(records)
    if channel is None or not channel.strip():
        if len(records) == 1:
            return records[0]
        raise RecordError.about(
            "{file} holds {count} channels: {names}. Name one of them, such as {file}#{first}",
            file=file, count=len(records), names=_list(addresses), first=addresses[0],
        )  # fmt: skip
    channel = channel.strip()
    wanted = channel.casefold()
    # The whole path of a member comes first: the same file may lie in a folder, too.
    spelt = [(record, _list_ways(record)) for record in records]
    whole = [record for record, ways in spelt if "/" in record.file and wanted in _spell(ways[-1:], record)]
    named = whole or [record for record, ways in spelt if wanted in _spell(ways, record)]
    if len(named) > 1:
        raise RecordError.about(
            "{file} has {count} channels named {channel!r}. Name one of them: {names}",
            file=file, count=len(named), channel=channel,
            names=_list([own for own, record in zip(addresses, records, strict=True) if record in named]),
        )  # fmt: skip
    if named:
        return named[0]
    # Names come first: a channel may be called by its azimuth, "45". Where some are numbers, a number is a name.
    numbered = [record for number, record in enumerate(records, start=1) if str(number) == wanted]
    is_archive = any("/" in record.file for record in records)  # where a damaged member would shift the numbers
    if numbered and (len(records) == 1 or not (is_archive or any(one.channel.isdecimal() for one in records))):
        return numbered[0]
    raise RecordError.about(
        "{file} has no channel {channel!r}. It holds: {names}", file=file, channel=channel, names=_list(addresses)
    )


def rename_duplicates(records: Sequence[Record]) -> tuple[Record, ...]:
    """Give channels of one file that have the same name different ones: "HNE", "HNE (2)"."""
    seen: Counter[tuple[str, str]] = Counter()
    renamed = []
    for record in records:
        own = (record.file.casefold(), record.channel.casefold())
        seen[own] += 1
        renamed.append(replace(record, channel=f"{record.channel} ({seen[own]})") if seen[own] > 1 else record)
    return tuple(renamed)


def _list_ways(record: Record) -> list[str]:
    """Return how a record can be addressed, the shortest way first."""
    parts = record.file.split("/")[1:]
    return ["/".join([*parts[first:], record.channel]) for first in reversed(range(len(parts) + 1))]


def _spell(ways: Sequence[str], record: Record) -> set[str]:
    """Return ways in small letters, and each without the channel."""
    end = f"/{record.channel.casefold()}"
    return {spelt for way in ways for spelt in (way.casefold(), way.casefold().removesuffix(end))}


def list_addresses(records: Sequence[Record]) -> list[str]:
    """Return for each channel of one file the shortest text after # that means no other."""
    every = [(_list_ways(record), record) for record in records]
    meanings = Counter(spelling for ways, record in every for spelling in _spell(ways, record))
    return [next((way for way in ways if meanings[way.casefold()] == 1), ways[-1]) for ways, _ in every]


def _list(names: Sequence[str]) -> str:
    listed, more = ", ".join(names[:LISTED]), len(names) - LISTED
    return fill("{names} and {more} more", names=listed, more=more) if more > 0 else listed
