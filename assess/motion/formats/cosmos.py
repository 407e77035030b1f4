"""COSMOS: one channel after the other, each with a header of text, whole and real numbers, and comments.

A line before each block of data says how many there are, their unit with its code, and their Fortran format.
Accelerations of volume 1 and 2 are read. Volume 0 is what the digitiser counted.

Source: Consortium of Organizations for Strong-Motion Observation Systems (2001). COSMOS strong motion data format,
version 1.20.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.formats._text import (
    LONGEST_TEXT,
    Columns,
    Section,
    even_series,
    note_peak,
    read_acceleration_unit,
    read_columns,
    read_direction,
    read_finite,
    read_format,
    read_sections,
    scaled,
    split_lines,
    split_sections,
)
from assess.motion.record import Record, Series, peak
from assess.units import ACCELERATION, GRAVITY

TITLE = "COSMOS"

TEXT = 13
"""Lines of text."""
UNITS = {2: GRAVITY, 4: 0.01, 7: 0.0254, 10: ACCELERATION["gal"], 11: GRAVITY / 1000}
"""Factor of each code of a unit of acceleration to m/s2."""

# Places in the blocks of numbers, counted from 0; the format's description counts from 1.
STAGE, AZIMUTH = 0, 53
RAW_STEP, STEP = 33, 61
CORRECTED = 2

_WANTED = re.compile(r"^(?!.*spectr).*accel", re.IGNORECASE)
_HEADER = re.compile(r"\s*(?P<count>\d{1,6})\s+(?P<what>integer|real)[- ]header values", re.IGNORECASE)
_DATA = re.compile(r"\s*(?P<count>\d{1,9})\s+\D.*\bunits\s*=\s*(?P<unit>[^,(]*)\((?P<code>\d{1,4})\)", re.IGNORECASE)
_STATION = re.compile(r"statn\s+no:\s*(\S+)\s+code:\s*(\S*)\s*(.*)", re.IGNORECASE)
_RECORD_START = re.compile(r"rcrd start time:\s*(\S+,?\s*[\d:.]+(?:\s+[A-Z]+\b)?)", re.IGNORECASE)
_CHANNEL = re.compile(
    r"sta\s+cha\w*:?\s*(?P<number>\w+)\s*:\s*(?P<direction>.*?)\s*\(.*?\)\s*(?:location:\s*(?P<location>.*))?",
    re.IGNORECASE,
)
_PEAK = re.compile(r"\bmax\s*=\s*([-+.\dE]+)\s*([^\s,]+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class _Header:
    """One channel's header; `data` is the place [-] of the line before its data, None where there is none."""

    integers: Sequence[float]
    reals: Sequence[float]
    data: int | None


def recognises(head: bytes) -> bool:
    """Tell whether the first line of `head` names a version of the COSMOS format."""
    return _kind(split_lines(head[:LONGEST_TEXT])[0]) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the accelerations of a COSMOS file of volume 1 or 2.

    Raises
    ------
    RecordError
        If there are none, or none can be read.
    """
    sections = split_sections(split_lines(data), lambda line: _kind(line) is not None)
    kinds = [_kind(section.lines[0]) or "" for section in sections]
    wanted = [section for section, kind in zip(sections, kinds, strict=True) if _WANTED.search(kind)]
    if not sections:
        raise RecordError("no line names a version of the COSMOS format. Get the file again")
    if not wanted:
        raise RecordError(
            f"it holds no accelerations, but: {kinds[0][:40] or 'nothing named'}. "
            "Give the acceleration file of the same channel"
        )
    return read_sections(wanted, lambda section: _read_channel(section, file))


def _kind(line: str) -> str | None:
    """Return what the first line of a header says that it holds, None if `line` is none."""
    kind, _, version = line[:LONGEST_TEXT].partition("(")
    return kind.strip() if version.lower().startswith("format v") else None


def _read_header(section: Section) -> _Header:
    numbers: dict[str, Sequence[float]] = {"integer": (), "real": ()}
    for place, line in enumerate(section.lines[: 10 * TEXT]):
        found = _HEADER.match(line)
        if found:
            columns = read_format(line, Columns(10, 8) if found["what"].lower() == "integer" else Columns(5, 15))
            numbers[found["what"].lower()] = list(read_columns(section, place + 1, int(found["count"]), columns))
    # Comments may hold any text, but start with "|" and not with a number.
    after = range(TEXT, len(section.lines))
    data = next((place for place in after if _DATA.match(section.text(place))), None)
    return _Header(numbers["integer"], numbers["real"], data)


def _read_data(section: Section, header: _Header) -> Series:
    title = section.text(header.data or 0)
    found = _DATA.match(title)
    if header.data is None or found is None or len(header.integers) <= AZIMUTH or len(header.reals) <= STEP:
        raise RecordError("the header is not whole. Get the file again")
    factor = _factor(found["unit"].strip(), int(found["code"]))
    numbers = read_columns(section, header.data + 1, int(found["count"]), read_format(title, Columns(8, 10)))
    # The second is that of the data [ms], the first that of the recorder [s]: they differ where data are resampled.
    step = header.reals[STEP] / 1000 if header.reals[STEP] > 0 else header.reals[RAW_STEP]
    return even_series(scaled(numbers, factor), step)


def _read_channel(section: Section, file: str) -> Record:
    header = _read_header(section)
    series = _read_data(section, header)
    own = series.values
    azimuth, vertical, channel, location = _read_orientation(section, header)
    station, header_pfa = _STATION.match(section.text(4)), _read_peak(section)
    start = _RECORD_START.match(section.text(7))
    return Record(
        file=file,
        format=TITLE,
        channel=channel,
        location=location,
        azimuth_deg=azimuth,
        vertical=vertical,
        station=f"{station[3].strip()} ({station[2] or station[1]})" if station else "",
        event=" ".join(section.text(1).split()),
        start=start[1] if start else "",
        corrected=header.integers[STAGE] == CORRECTED,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=note_peak(header_pfa, peak(own)),
    )


def _factor(unit: str, code: int) -> float:
    if unit.lower() in {"counts", "count", "volts", "volt", "mvolts"}:
        raise RecordError(
            f"it holds raw {unit} (volume 0), not accelerations. "
            "Give volume 1 or 2 of the same channel, or convert it to m/s2 and save it as plain CSV"
        )
    factor = UNITS.get(code)
    named = read_acceleration_unit(unit)
    if factor is None or (named is not None and abs(named / factor - 1) > 1e-9):
        raise RecordError(f"the unit {unit[:20]!r} with the code {code} is no known unit of acceleration")
    return factor


def _read_orientation(section: Section, header: _Header) -> tuple[float | None, bool, str, str]:
    """Return azimuth [deg], vertical, the channel's name and its location."""
    found = _CHANNEL.match(section.text(8))
    azimuth, vertical = read_direction(found["direction"]) if found else (None, False)
    code = header.integers[AZIMUTH]
    if azimuth is None and not vertical:
        azimuth, vertical = (code if 1 <= code <= 360 else None), 400 <= code <= 402
    name = found["number"] if found else "1"
    return azimuth, vertical, name.lstrip("0") or "0", (found["location"] or "").strip() if found else ""


def _read_peak(section: Section) -> float | None:
    found = _PEAK.search(section.text(10))
    number, factor = (read_finite(found[1]), read_acceleration_unit(found[2])) if found else (None, None)
    return abs(number) * factor if number is not None and factor is not None else None


FORMAT = Format(key="cosmos", title=TITLE, recognises=recognises, read=read)
