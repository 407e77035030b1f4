"""PEER AT2: one channel to a file, in g, four lines of header and then numbers with blanks between them.

The fourth line says how many there are and their step: "NPTS= 4000, DT= .01000 SEC", or in older files
"4000 0.0100 NPTS, DT". All are corrected by PEER. Velocity (VT2) and displacement (DT2) look the same.

Source: Pacific Earthquake Engineering Research Center, NGA ground motion database; checked against a file of each kind.
"""

import re

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.formats._text import (
    Section,
    even_series,
    read_acceleration_unit,
    read_direction,
    read_finite,
    read_words,
    scaled,
    split_lines,
)
from assess.motion.record import Record, peak

TITLE = "PEER AT2"

HEADER = 4
"""Lines before the data."""

_KIND = re.compile(
    r"\b(?P<kind>acceleration|velocity|displacement) time (?:series|history) in units of (?P<unit>[\w/*^]+)",
    re.IGNORECASE,
)
_NEW = re.compile(r"npts\s*=\s*(?P<count>\d{1,9})\s*,?\s*dt\s*=\s*(?P<step>[\d.]+)", re.IGNORECASE)
_OLD = re.compile(r"\s*(?P<count>\d{1,9})\s+(?P<step>[\d.]+)\s+npts\s*,\s*dt\b", re.IGNORECASE)
_YEAR = re.compile(r"[\d/. -]+|\w+ \d+ ?,? ?\d{4}")


def recognises(head: bytes) -> bool:
    """Tell whether one of the first four lines of `head` says "... time series in units of"."""
    section = Section(split_lines(head[:2000]))
    return any(_KIND.search(section.text(place)) for place in range(HEADER))


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the one channel of an AT2 file.

    Raises
    ------
    RecordError
        If the file holds anything but accelerations, or is damaged or cut short.
    """
    section = Section(split_lines(data))
    _check_kind(section)
    numbers = _NEW.search(section.text(HEADER - 1)) or _OLD.match(section.text(HEADER - 1))
    step = read_finite(numbers["step"]) if numbers else None
    if numbers is None or step is None:
        raise RecordError(f"line {HEADER} does not say the number of points and their step. Get the file again")
    values, notes = read_words(section, HEADER, int(numbers["count"]))
    own = scaled(values, _check_kind(section))
    series = even_series(own, step, notes)
    event, station, component = _read_title(section.text(1))
    azimuth, vertical = read_direction(component.split("(")[0])
    record = Record(
        file=file,
        format=TITLE,
        channel=component.split("(")[0].strip() or "1",
        location="",
        azimuth_deg=azimuth,
        vertical=vertical,
        station=station,
        event=event,
        start="",
        corrected=True,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=peak(own),
        header_pfa=None,
        notes=series.notes,
    )
    return (record,)


def _check_kind(section: Section) -> float:
    """Return the factor from the file's unit to m/s2; raise RecordError unless it holds accelerations."""
    found = next((hit for hit in (_KIND.search(section.text(place)) for place in range(HEADER)) if hit), None)
    if found is None:
        raise RecordError("the header does not say what the file holds. Get the file again")
    kind, factor = found["kind"].lower(), read_acceleration_unit(found["unit"])
    if kind != "acceleration":
        raise RecordError(f"it holds {kind}, not accelerations. Give the .AT2 file of the same channel")
    if factor is None:
        raise RecordError(f"{found['unit'][:20]!r} is no known unit of acceleration. Get the file again")
    return factor


def _read_title(line: str) -> tuple[str, str, str]:
    """Split "event, date, station, component"; older titles have the date within the event."""
    event, *others = [part.strip() for part in line.split(",")]
    if others and _YEAR.fullmatch(others[0]):
        event = f"{event}, {others.pop(0)}"
    component = others.pop() if others else ""
    return event, ", ".join(others), component


FORMAT = Format(key="peer_at2", title=TITLE, recognises=recognises, read=read)
