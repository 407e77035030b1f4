"""Which channel of a file is meant: the part after # where a user writes ``file#channel``."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.record import Record

LISTED = 12
"""Names that an error lists."""


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
    if channel is None or not channel.strip():
        if len(records) == 1:
            return records[0]
        raise _unnamed(records)
    wanted = channel.strip().casefold()
    # The whole path of a member comes first: the same file may lie in a folder, too.
    whole = [record for record in records if wanted in _whole(record)]
    named = whole or [record for record in records if wanted in _spellings(record)]
    if len(named) > 1:
        raise _ambiguous(records, channel, named)
    if named:
        return named[0]
    # Names come first: a channel may be called by its azimuth, "45". Where some are numbers, a number is a name.
    numbered = [record for number, record in enumerate(records, start=1) if str(number) == wanted]
    is_archive = any("/" in record.file for record in records)  # where a damaged member would shift the numbers
    if numbered and (len(records) == 1 or not (is_archive or any(one.channel.isdecimal() for one in records))):
        return numbered[0]
    names = _list(list_addresses(records))
    raise RecordError.about(
        "{file} has no channel {channel!r}. It holds: {names}",
        file=_name_file(records),
        channel=channel.strip(),
        names=names,
    )


def _unnamed(records: Sequence[Record]) -> RecordError:
    names = list_addresses(records)
    return RecordError.about(
        "{file} holds {count} channels: {names}. Name one of them, such as {file}#{first}",
        file=_name_file(records),
        count=len(records),
        names=_list(names),
        first=names[0],
    )


def _ambiguous(records: Sequence[Record], channel: str, named: Sequence[Record]) -> RecordError:
    addresses = zip(list_addresses(records), records, strict=True)
    return RecordError.about(
        "{file} has {count} channels named {channel!r}. Name one of them: {names}",
        file=_name_file(records),
        count=len(named),
        channel=channel.strip(),
        names=_list([address for address, record in addresses if record in named]),
    )


def _name_file(records: Sequence[Record]) -> str:
    return records[0].file.split("/")[0]


def rename_duplicates(records: Sequence[Record]) -> tuple[Record, ...]:
    """Give channels of one file that have the same name different ones: "HNE", "HNE (2)"."""
    seen: Counter[tuple[str, str]] = Counter()
    renamed = []
    for record in records:
        own = (record.file.casefold(), record.channel.casefold())
        seen[own] += 1
        renamed.append(replace(record, channel=f"{record.channel} ({seen[own]})") if seen[own] > 1 else record)
    return tuple(renamed)


def _ways(record: Record) -> Iterator[str]:
    yield record.channel
    parts = record.file.split("/")[1:]
    for first in reversed(range(len(parts))):
        yield "/".join([*parts[first:], record.channel])


def _spellings(record: Record) -> set[str]:
    return {spelling for way in _ways(record) for spelling in _short(way, record)}


def _whole(record: Record) -> set[str]:
    return _short(list(_ways(record))[-1], record) if "/" in record.file else set()


def _short(way: str, record: Record) -> set[str]:
    spelt, channel = way.casefold(), f"/{record.channel.casefold()}"
    return {spelt, spelt.removesuffix(channel)}


def list_addresses(records: Sequence[Record]) -> list[str]:
    """Return for each channel of one file the shortest text after # that means no other."""
    meanings = Counter(spelling for record in records for spelling in _spellings(record))
    return [
        next((way for way in _ways(record) if meanings[way.casefold()] == 1), list(_ways(record))[-1])
        for record in records
    ]


def _list(names: Sequence[str]) -> str:
    listed, more = ", ".join(names[:LISTED]), len(names) - LISTED
    return fill("{names} and {more} more", names=listed, more=more) if more > 0 else listed
