"""miniSEED: channels of a data centre, read by ObsPy.

The format has no field for a unit. Whole numbers are counts of the digitiser and are refused. Real numbers of an
accelerometer (second letter N of the channel's code, as in HNE) are taken as m/s2: what ObsPy's
``remove_response(output="ACC")`` leaves. A gap within a channel is bridged by a straight line and noted.

Source: International Federation of Digital Seismograph Networks (2012). SEED reference manual, version 2.4.
"""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from assess.errors import RecordError
from assess.language import fill
from assess.motion.formats._format import Format
from assess.motion.formats._obspy import read_traces, start_of
from assess.motion.formats._text import direction_of_code, even_series, keep_readable
from assess.motion.record import FloatArray, Record, Series, build_series, peak

TITLE = "miniSEED"

_START = re.compile(rb"[\d \0]{6}[DRQM][ \0]", re.ASCII)
_FIXED_HEADER = 48
_TAKEN = fill('the file does not say its unit: taken as m/s2, which ObsPy\'s remove_response(output="ACC") leaves')


def recognises(head: bytes) -> bool:
    """Tell whether `head` begins with the number and quality of a record of SEED, and a day of a year."""
    if len(head) < _FIXED_HEADER or not _START.match(head):
        return False
    big, little = (
        (int.from_bytes(head[20:22], order), int.from_bytes(head[22:24], order)) for order in ("big", "little")
    )
    return any(1900 <= year <= 2100 and 1 <= day <= 366 for year, day in (big, little))


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read every channel of a miniSEED file.

    Raises
    ------
    RecordError
        If no channel holds accelerations, the file is damaged, or ObsPy is not installed.
    """
    traces, notes = read_traces(data, "MSEED")
    channels: dict[str, list[Any]] = {}
    for trace in traces:
        channels.setdefault(str(trace.id), []).append(trace)
    codes = [str(parts[0].stats.channel) for parts in channels.values()]
    return keep_readable(
        channels.items(), lambda parts: _read_channel(file, parts, notes, codes.count(str(parts[0].stats.channel)) > 1)
    )


def _read_channel(file: str, parts: Sequence[Any], notes: Sequence[str], whole_name: bool) -> Record:
    """Read one channel from its traces; `whole_name` where other channels have the same code."""
    stats = parts[0].stats
    code = str(stats.channel)
    _check_samples_type(code, parts)
    series, own = _join(parts, notes)
    azimuth, vertical = direction_of_code(code)
    return Record(
        file=file,
        format=TITLE,
        channel=str(parts[0].id) if whole_name else code or "1",
        location=str(stats.location),
        azimuth_deg=azimuth,
        vertical=vertical,
        station=".".join(filter(None, (str(stats.network), str(stats.station)))),
        event="",
        start=start_of(parts[0]),
        corrected=False,
        time_step=series.time_step,
        acceleration=series.values,
        file_pfa=peak(own - own.mean()),
        header_pfa=None,
        notes=(*series.notes, _TAKEN),
    )


def _check_samples_type(code: str, parts: Sequence[Any]) -> None:
    kinds = {part.data.dtype.kind for part in parts}
    if "i" in kinds or "u" in kinds:
        raise RecordError(
            "it holds raw counts, not accelerations. Remove the instrument's response with ObsPy "
            '(stream.remove_response(inventory, output="ACC")) and save that as miniSEED, or as plain CSV in m/s2'
        )
    if kinds != {"f"}:
        raise RecordError("it holds no numbers. Give a channel of an accelerometer")
    if code[1:2] != "N":
        raise RecordError(
            f"the channel's code {code!r} is not that of an accelerometer (such as HNE). "
            "Save the accelerations as plain CSV in m/s2"
        )


def _join(parts: Sequence[Any], notes: Sequence[str]) -> tuple[Series, FloatArray]:
    """Return the channel's samples [m/s2] evenly spaced, and as they are in the file."""
    with np.errstate(invalid="ignore"):  # what is not a number is refused further on
        own = np.concatenate([np.asarray(part.data, dtype=np.float64) for part in parts])
    if len(parts) == 1:
        return even_series(own, float(parts[0].stats.delta), notes), own
    start = parts[0].stats.starttime
    times = [
        float(part.stats.starttime - start) + np.arange(part.data.size) * float(part.stats.delta) for part in parts
    ]
    series = build_series(np.concatenate(times), own)
    return Series(series.time_step, series.values, (*notes, *series.notes)), own


FORMAT = Format(key="miniseed", title=TITLE, recognises=recognises, read=read)
