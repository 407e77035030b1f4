"""miniSEED 2: channels of a data centre, in records of some hundred bytes, each with a header of its own.

The format has no field for a unit. Whole numbers, packed or not, are counts of the digitiser and are refused, so that
only real numbers have to be unpacked. Those of an accelerometer (second letter N of the channel's code, as in HNE) are
taken as m/s2: what ObsPy's ``remove_response(output="ACC")`` leaves. A gap within a channel is bridged by a straight
line and noted.

Source: International Federation of Digital Seismograph Networks (2012). SEED reference manual, version 2.4.
"""

import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill, nfill
from assess.motion.formats._format import (
    Format,
    build_record,
    check_channels,
    even_series,
    keep_readable,
    read_direction,
)
from assess.motion.record import Record, Series, build_series, check_count

REALS = {4: "f4", 5: "f8"}
"""Encodings of real numbers."""
TEXT = 0
"""Encoding of characters, as in the log of a recorder; all others are of whole numbers."""
ENCODING, RATE, MICROSECONDS = 1000, 100, 1001
"""Types of blockettes: encoding, order of bytes and length of the record; the exact rate; microseconds of its start."""
CORRECTED_TIME = 0x02
"""Flag of a header to whose time the correction was applied."""
SHORTEST = 128
"""Bytes of the shortest record; where none starts, the next place that is tried is as far on."""
MOST_PARTS = 250_000
"""Records of a file; the largest file has half as many of the usual 512 bytes."""
JOINED = 0.5
"""Records that follow each other within this many steps [-] are without a gap."""

_START = re.compile(rb"[\d \0]{6}[DRQM][ \0]", re.ASCII)
_HEADER = "HHBBBBHHhhBBBBiHH"
_HEADER_FROM, _HEADER_TO = 20, 48
_TAKEN = fill('the file does not give its unit: taken as m/s2, which ObsPy\'s remove_response(output="ACC") leaves')


@dataclass(frozen=True, slots=True)
class _Part:
    """The samples of one record of a channel, named by network, station, location and code; none where not real."""

    names: tuple[str, ...]
    start: datetime
    rate: float
    encoding: int
    samples: FloatArray


def parse(data: bytes) -> tuple[Record, ...]:
    """Read every channel of a miniSEED file; RecordError if no channel holds accelerations, or the file is damaged."""
    channels: dict[tuple[str, ...], list[_Part]] = {}
    at, count, skipped = 0, 0, 0
    names: dict[bytes, tuple[str, ...]] = {}  # of many parts, once
    while at < len(data):
        order = _byte_order(data, at)
        found = _read_part(data, at, order, names) if order else None
        if found is None:
            skipped, at = skipped + min(SHORTEST, len(data) - at), at + SHORTEST
            continue
        part, length = found
        at += length
        if part is not None:
            channels.setdefault(part.names, []).append(part)
            check_channels(len(channels))
            count += 1
            if count > MOST_PARTS:
                raise RecordError.about(
                    "the file has more than {most:,} records of miniSEED: cut it to the shaking", most=MOST_PARTS
                )
    if not channels:
        raise RecordError.about("the file has no complete miniSEED record. Get the file again")
    codes = [own[-1] for own in channels]
    note = nfill(
        "{n} byte that is no whole record of miniSEED was left out",
        "{n} bytes that are no whole records of miniSEED were left out",
        skipped,
    )
    notes = (note,) if skipped else ()
    return keep_readable(
        ((".".join(own), parts) for own, parts in channels.items()),
        lambda parts: _read_channel(parts, notes, codes.count(parts[0].names[-1]) > 1),
    )


def _byte_order(data: bytes, at: int) -> str | None:
    """Return "<" or ">" of the record that starts at a place [bytes], with its number, quality and day; else None."""
    if len(data) < at + _HEADER_TO or not _START.match(data, at):
        return None
    for order in "><":
        year, day = struct.unpack_from(f"{order}HH", data, at + _HEADER_FROM)
        if 1900 <= year <= 2100 and 1 <= day <= 366:
            return order
    return None


def _read_part(
    data: bytes, at: int, order: str, names: dict[bytes, tuple[str, ...]]
) -> tuple[_Part | None, int] | None:
    """Return the part whose record is at a place, None if it has no samples, and the record's length [bytes].

    None where the record is damaged, cut short, or does not name how its samples are encoded.
    """
    year, day, hour, minute, second, _, ticks, count, factor, multiplier, flags, _, _, _, correction, begin, place = (
        struct.unpack_from(f"{order}{_HEADER}", data, at + _HEADER_FROM)
    )
    blockettes: dict[int, int] = {}  # where what follows the header of each is
    while place >= _HEADER_TO and at + place + 4 <= len(data):
        kind, following = struct.unpack_from(f"{order}HH", data, at + place)
        blockettes[kind] = at + place + 4
        if following <= place:
            break
        place = following
    try:
        encoding, big, power = struct.unpack_from("BBB", data, blockettes[ENCODING])
        length = 1 << power if power < 32 else 0
        exact = struct.unpack_from(f"{order}f", data, blockettes[RATE])[0] if RATE in blockettes else 0.0
        late = struct.unpack_from("xb", data, blockettes[MICROSECONDS])[0] if MICROSECONDS in blockettes else 0
        start = datetime(year, 1, 1, hour, minute) + timedelta(
            days=day - 1,
            seconds=second,
            microseconds=100 * (ticks + (0 if flags & CORRECTED_TIME else correction)) + late,
        )
    except (KeyError, struct.error, ValueError, OverflowError):
        return None
    if length < SHORTEST or at + length > len(data):
        return None
    rate = exact
    if not rate > 0 and factor and multiplier:  # below 0 each of the two divides
        rate = float(factor) if factor > 0 else -1.0 / factor
        rate = rate * multiplier if multiplier > 0 else -rate / multiplier
    if not count or not rate > 0:
        return None, length
    form, samples = REALS.get(encoding), np.zeros(0)
    if form is not None:
        if not _HEADER_TO <= begin <= length - count * int(form[1]):
            return None
        samples = np.frombuffer(data, f"{'>' if big else '<'}{form}", count, at + begin)
    text = data[at + 8 : at + 20]
    if text not in names:
        own = text.decode("latin-1").replace("\0", " ")
        names[text] = tuple(own[part].strip() for part in (slice(10, 12), slice(5), slice(5, 7), slice(7, 10)))
    return _Part(names[text], start, rate, encoding, samples), length


def _read_channel(parts: Sequence[_Part], notes: Sequence[str], whole_name: bool) -> Record:
    network, station, location, code = parts[0].names
    encodings = {part.encoding for part in parts}
    if encodings - {TEXT, *REALS}:
        raise RecordError.about(
            "the channel holds raw counts, not accelerations. Remove the instrument's response with ObsPy "
            '(stream.remove_response(inventory, output="ACC")) and save the result as miniSEED, or as plain CSV in '
            "m/s2"
        )
    if TEXT in encodings:
        raise RecordError.about("the channel holds no numbers. Give a channel of an accelerometer")
    if code[1:2] != "N":
        raise RecordError.about(
            "the channel's code {code!r} is not that of an accelerometer (such as HNE). Save the accelerations as "
            "plain CSV in m/s2",
            code=code,
        )
    series, own = _join(parts)
    return build_record(
        replace(series, notes=(*notes, *series.notes)), own=own, corrected=False,
        channel=".".join(parts[0].names) if whole_name else code, direction=read_direction(code, bare_degrees=False),
        location=location, station=".".join(filter(None, (network, station))),
        start=f"{parts[0].start.isoformat(sep=' ', timespec='milliseconds')} UTC", has_offset=True, notes=(_TAKEN,),
    )  # fmt: skip


def _join(parts: Sequence[_Part]) -> tuple[Series, FloatArray]:
    """Return the channel's samples [m/s2] evenly spaced, and as they are in the file."""
    runs: list[list[_Part]] = []
    for part in parts:
        last = runs[-1][-1] if runs else None
        passed = 0.0 if last is None else (part.start - last.start).total_seconds()
        if last and part.rate == last.rate and abs(passed * part.rate - last.samples.size) <= JOINED:
            runs[-1].append(part)
        else:
            runs.append([part])
    with np.errstate(invalid="ignore"):  # what is not a number is refused further on
        values = [np.concatenate([part.samples for part in run], dtype=np.float64) for run in runs]
    check_count(sum(run.size for run in values))
    own, steps = np.concatenate(values), [1 / run[0].rate for run in runs]
    if len(runs) == 1:
        return even_series(own, steps[0]), own
    starts = [(run[0].start - parts[0].start).total_seconds() for run in runs]
    times = [start + np.arange(run.size) * step for start, run, step in zip(starts, values, steps, strict=True)]
    return build_series(np.concatenate(times), own), own


FORMAT = Format("miniseed", "miniSEED", recognises=lambda head: _byte_order(head, 0) is not None, parse=parse)
