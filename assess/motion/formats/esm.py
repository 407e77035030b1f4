"""ESM and ITACA ASCII: one channel to a file, lines "KEY: value" and then one number a line, in cm/s2.

Source: Engineering Strong-Motion database and Italian accelerometric archive, header format DYNA 1.2; checked against
three of its files.
"""

import re

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.formats._text import (
    Section,
    direction_of_code,
    even_series,
    note_peak,
    read_acceleration_unit,
    read_finite,
    read_words,
    scaled,
    split_lines,
)
from assess.motion.record import FloatArray, Record, peak
from assess.units import ACCELERATION

TITLE = "ESM"

LONGEST_HEADER = 200
"""Lines; version 1.2 has 64."""

_KEY = re.compile(r"([A-Z][A-Z0-9_/^ ]*):(.*)")
_DATE = re.compile(r"(\d{4})(\d\d)(\d\d)_(\d\d)(\d\d)([\d.]+)")
_RAW = re.compile(r"(none|no\b.*|not\b.*|un.*|raw.*|)", re.IGNORECASE)


def recognises(head: bytes) -> bool:
    """Tell whether `head` begins with the name of the event, and also names a station and what the data are."""
    return head.startswith(b"EVENT_NAME:") and all(key in head for key in (b"\nSTATION_CODE:", b"\nUNITS:"))


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the one channel of an ESM file.

    Raises
    ------
    RecordError
        If the file holds anything but accelerations, or is damaged or cut short.
    """
    section = Section(split_lines(data))
    header, first = _read_header(section)
    factor = _read_factor(header)
    count, step = read_finite(header.get("NDATA")), read_finite(header.get("SAMPLING_INTERVAL_S"))
    if count is None or step is None:
        raise RecordError("the header does not say NDATA and SAMPLING_INTERVAL_S. Get the file again")
    values, notes = read_words(section, first, count)
    own = scaled(values, factor)
    series = even_series(own, step, notes)
    return (_build_record(file, header, series.values, series.time_step, series.notes),)


def _read_header(section: Section) -> tuple[dict[str, str], int]:
    """Return the header, and the place of the first line of data."""
    header: dict[str, str] = {}
    for place in range(min(len(section.lines), LONGEST_HEADER)):
        found = _KEY.match(section.text(place))
        if not found:
            return header, place
        header[found[1]] = found[2].strip()
    raise RecordError("there are no data below the header. Get the file again")


def _read_factor(header: dict[str, str]) -> float:
    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise RecordError(f"it holds {kind.lower()[:40]}, not accelerations. Give the .ACC. file of the same channel")
    factor = read_acceleration_unit(header.get("UNITS", ""))
    if factor is None:
        raise RecordError(f"{header.get('UNITS', '')[:20]!r} is no known unit of acceleration. Get the file again")
    return factor


def _build_record(file: str, header: dict[str, str], own: FloatArray, step: float, notes: tuple[str, ...]) -> Record:
    channel = header.get("STREAM", "")
    azimuth, vertical = direction_of_code(channel)
    number = read_finite(header.get("PGA_CM/S^2"))
    header_pfa = None if number is None else abs(number) * ACCELERATION["cm/s2"]
    return Record(
        file=file,
        format=TITLE,
        channel=channel or "1",
        location=header.get("LOCATION", ""),
        azimuth_deg=azimuth,
        vertical=vertical,
        station=_join(header.get("STATION_NAME", ""), header.get("STATION_CODE", "")),
        event=" ".join(filter(None, (header.get("EVENT_NAME"), header.get("EVENT_DATE_YYYYMMDD")))),
        start=_DATE.sub(r"\1-\2-\3 \4:\5:\6 UTC", header.get("DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", "")),
        # Only what was filtered needs no filter of ours; a baseline alone may have been removed from raw data, too.
        corrected=not _RAW.fullmatch(header.get("PROCESSING", ""))
        and not _RAW.fullmatch(header.get("FILTER_TYPE", "")),
        time_step=step,
        acceleration=own,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=(*notes, *note_peak(header_pfa, peak(own))),
    )


def _join(name: str, code: str) -> str:
    return f"{name} ({code})" if name and code else name or code


FORMAT = Format(key="esm", title=TITLE, recognises=recognises, read=read)
