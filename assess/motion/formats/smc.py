"""USGS SMC: one channel to a file, in columns of fixed width, accelerations in cm/s2.

Layout: 11 lines of text, 48 whole numbers (8I10), 50 real numbers (5E15.7), lines of comment that start with "|",
and the data (8E10.4, no blanks between the numbers). Numbers stand for "unknown" where they equal the first of their
block. Where the sampling rate is unknown, the data are pairs of time [s] and acceleration.

Source: U.S. Geological Survey, National Strong-Motion Project, the SMC format; checked against 29 of its files.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from assess.errors import RecordError
from assess.language import fill
from assess.motion.formats._format import Format
from assess.motion.formats._text import note_beyond, note_peak
from assess.motion.record import FloatArray, Record, Series, build_series, check_samples, check_time_step, peak
from assess.units import ACCELERATION

TITLE = "USGS SMC"
CM_S2 = ACCELERATION["cm/s2"]

# Lines, counted from 0, at which the blocks start, and the columns of a number in each.
INTEGERS, REALS, COMMENTS = 11, 17, 27
INTEGER_WIDTH, REAL_WIDTH, DATA_WIDTH = 10, 15, 10
LINE = 80

# Places in the two blocks of numbers, counted from 0; the format's description counts from 1.
VERTICAL_ANGLE, AZIMUTH, COMMENT_LINES, DATA_COUNT, PROBLEM, FLOOR = 12, 13, 15, 16, 17, 24
SAMPLING_RATE = 1

MOST_BEYOND = 0.01
"""Share of the data that may stand beyond the count in the header [-]; those of 575 Market Street have 8 numbers."""

_KIND = re.compile(rb"[ \t]*([1-6])[ \t]+(?:UNCORRECTED|CORRECTED|VELOCITY|DISPLACEMENT|FOURIER|RESPONSE)")
_REFUSED = {"3": "velocity", "4": "displacement", "5": "a spectrum", "6": "a spectrum"}
_EARTHQUAKE = re.compile(r"\s*(\d{4})\s+(\d{1,2})\s+(\d{1,2})\s+(\d\d)(\d\d)\b(.*)")
_STATION = re.compile(r"\s*station\s*=(.*?)component\s*=(.*)", re.IGNORECASE)
_PEAK = re.compile(r"\bpk\b[^=]*=\s*([-+.\dE]+)", re.IGNORECASE)
_LOCATION = re.compile(r"<loclbl=>(.*?)<end>")


@dataclass(frozen=True, slots=True)
class _Header:
    """The blocks before the data; None where a number is unknown."""

    corrected: bool
    text: Sequence[str]
    integers: Sequence[int | None]
    sampling_rate: float | None
    comments: Sequence[str]


def recognises(head: bytes) -> bool:
    """Tell whether a file that starts with `head` is an SMC file, of whichever type."""
    return _KIND.match(head) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the one channel of an SMC file of type 1 (uncorrected) or 2 (corrected).

    Raises
    ------
    RecordError
        If the file holds anything but accelerations, or is damaged or cut short.
    """
    kind = _KIND.match(data)
    if not kind:
        raise RecordError("the first line names no type of SMC file. Get the file again")
    lines = [line.decode("latin-1") for line in data.splitlines()]
    header = _read_header(kind[1].decode(), lines)
    numbers, notes = _read_data(lines, header)
    if header.sampling_rate is None:
        times, own = _pairs(numbers)
        series = build_series(times, own)
    else:
        own = numbers * CM_S2
        series = _even_series(own, header.sampling_rate)
    return (_build_record(file, header, own, Series(series.time_step, series.values, (*notes, *series.notes))),)


def _read_header(kind: str, lines: Sequence[str]) -> _Header:
    if len(lines) <= COMMENTS:
        raise RecordError(
            f"the header has {COMMENTS} lines, but the file has {len(lines)}: it is cut short. Get it again"
        )
    if kind in _REFUSED:
        raise RecordError(
            f"it holds {_REFUSED[kind]} ({lines[0].strip()[:40]}), not accelerations. "
            "Give the acceleration file of the same channel (type 1 or 2)"
        )
    integers = _read_integers(lines)
    comments = _read_comments(lines, integers[COMMENT_LINES])
    text = [line[: 2 * LINE] for line in lines[:INTEGERS]]
    return _Header(kind == "2", text, integers, _read_sampling_rate(lines), comments)


def _fields(lines: Sequence[str], first: int, last: int, width: int) -> list[str]:
    """Return the fields of lines `first` to `last` - 1, each `width` columns wide."""
    whole = LINE // width * width
    return [line.ljust(whole)[at : at + width] for line in lines[first:last] for at in range(0, whole, width)]


def _read_integers(lines: Sequence[str]) -> list[int | None]:
    numbers = []
    for place, text in enumerate(_fields(lines, INTEGERS, REALS, INTEGER_WIDTH)):
        try:
            numbers.append(int(text))
        except ValueError:
            line = INTEGERS + place // (LINE // INTEGER_WIDTH) + 1
            raise RecordError(f"line {line}: {text.strip()!r} is not a whole number. Get the file again") from None
    return [None if number == numbers[0] else number for number in numbers]


def _read_comments(lines: Sequence[str], count: int | None) -> Sequence[str]:
    found = next((place for place, line in enumerate(lines[COMMENTS:]) if not line.startswith("|")), None)
    if found is None or found != (count or 0):
        there = "no data" if found is None else f"{found}"
        raise RecordError(f"the header announces {count or 0} lines of comment, there are {there}. Get the file again")
    return [line[: 2 * LINE] for line in lines[COMMENTS : COMMENTS + found]]


def _read_sampling_rate(lines: Sequence[str]) -> float | None:
    """Samples per second; None where the data are pairs of time and acceleration."""
    unknown, rate = (_read_real(text) for text in _fields(lines, REALS, REALS + 1, REAL_WIDTH)[: SAMPLING_RATE + 1])
    if rate == unknown:
        return None
    if not (math.isfinite(rate) and rate > 0):
        raise RecordError(f"line {REALS + 1}: the sampling rate is {rate:g} per second. Get the file again")
    return rate


def _read_real(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise RecordError(f"line {REALS + 1}: {text.strip()!r} is not a number. Get the file again") from None


def _read_data(lines: Sequence[str], header: _Header) -> tuple[FloatArray, tuple[str, ...]]:
    """Return as many numbers as the header announces, and a note on those beyond."""
    announced, first = header.integers[DATA_COUNT] or 0, COMMENTS + len(header.comments)
    if announced <= 0:
        raise RecordError(f"the header announces {announced} numbers of data. Get the file again")
    wide = next((place for place, line in enumerate(lines[first:]) if line[LINE:].strip()), None)
    if wide is not None:
        raise RecordError(f"line {first + wide + 1} is longer than {LINE} columns. Get the file again")
    fields = _fields(lines, first, len(lines), DATA_WIDTH)
    there = sum(1 for text in fields if text.strip())
    if there < announced:
        raise RecordError(
            f"the header announces {announced} numbers of data, there are {there}: cut short. Get the file again"
        )
    beyond = there - announced
    if beyond > MOST_BEYOND * announced:
        raise RecordError(f"the header announces {announced} numbers of data, there are {there}. Get the file again")
    return _convert(fields[:announced], first), note_beyond(beyond, announced)


def _convert(fields: list[str], first: int) -> FloatArray:
    try:
        return np.array(fields, dtype=np.float64)
    except ValueError:
        place = next((place for place, text in enumerate(fields) if not _is_number(text)), 0)
        line, text = first + place // (LINE // DATA_WIDTH) + 1, fields[place].strip()
        what = f"{text!r} is not a number" if text else "a number is missing"
        raise RecordError(f"line {line}: {what}. Get the file again") from None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _pairs(numbers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Split into times [s] and accelerations [m/s2]."""
    if numbers.size % 2:
        raise RecordError(f"{numbers.size} numbers cannot be pairs of time and acceleration. Get the file again")
    return numbers[0::2], numbers[1::2] * CM_S2


def _even_series(values: FloatArray, sampling_rate: float) -> Series:
    check_samples(values)
    check_time_step(1 / sampling_rate)
    return Series(float(f"{1 / sampling_rate:.12g}"), values)


def _build_record(file: str, header: _Header, own: FloatArray, series: Series) -> Record:
    station, component = _read_station(header.text[5])
    vertical, azimuth, orientation_notes = _orientation(component, header)
    start, event = _read_earthquake(header.text[3])
    header_pfa = _read_peak(header.text[6])
    return Record(
        file=file,
        format=TITLE,
        channel=component or "1",
        location=_location(header),
        azimuth_deg=azimuth,
        vertical=vertical,
        station=station,
        event=event,
        start=start,
        corrected=header.corrected,
        time_step=series.time_step,
        acceleration=series.values,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=(*series.notes, *orientation_notes, *note_peak(header_pfa, peak(own)), *_note_problem(header)),
    )


def _read_station(line: str) -> tuple[str, str]:
    found = _STATION.match(line)
    return (found[1].strip(), found[2].strip()) if found else (line.strip(" *"), "")


def _read_earthquake(line: str) -> tuple[str, str]:
    """Return the earthquake's time (UTC, as the format has it) and name."""
    found = _EARTHQUAKE.match(line)
    if not found:
        return "", line.strip(" *")
    year, month, day, hour, minute, name = found.groups()
    return f"{year}-{int(month):02d}-{int(day):02d} {hour}:{minute} UTC", name.strip()


def _read_peak(line: str) -> float | None:
    """Return the printed peak [m/s2]; None where there is none that can be read."""
    found = _PEAK.search(line)
    if not found or not _is_number(found[1]) or not math.isfinite(float(found[1])):
        return None
    return abs(float(found[1])) * CM_S2


def _location(header: _Header) -> str:
    found = _LOCATION.search("\n".join(header.comments))
    if found:
        return found[1].strip()
    floor = header.integers[FLOOR]
    return "" if floor is None else f"floor {floor}"


def _orientation(component: str, header: _Header) -> tuple[bool, float | None, tuple[str, ...]]:
    """Return whether it is vertical, else its azimuth [deg], and a note where text and numbers disagree."""
    upright, number = header.integers[VERTICAL_ANGLE], header.integers[AZIMUTH]
    if component.lower().startswith(("up", "down", "vert")) or (not component and upright in {0, 180}):
        return True, None, ()
    text = float(component) if re.fullmatch(r"\d{1,3}(\.\d*)?", component) else None
    known = [azimuth for azimuth in (text, number) if azimuth is not None and 0 <= azimuth <= 360]
    if len(known) == 2 and (known[0] - known[1]) % 360:
        note = fill(
            "the header gives two azimuths, {first:g} and {other:g} deg: the first is used",
            first=known[0],
            other=known[1],
        )
        return False, float(known[0]), (note,)
    return False, float(known[0]) if known else None, ()


def _note_problem(header: _Header) -> tuple[str, ...]:
    note = fill("the header flags a problem with the data: read its comments")
    return (note,) if header.integers[PROBLEM] == 1 else ()


FORMAT = Format(key="smc", title=TITLE, recognises=recognises, read=read)
