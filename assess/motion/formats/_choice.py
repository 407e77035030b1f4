"""Which channel of a file is meant: the part after # where a user writes ``file#channel``."""

from collections import Counter
from collections.abc import Sequence
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
