"""USGS SMC: one channel to a file, in columns of fixed width, accelerations in cm/s2.

Layout: 11 lines of text, 48 whole numbers (8I10), 50 real numbers (5E15.7), lines of comment that start with "|",
and the data (8E10.4, no blanks between the numbers). Numbers stand for "unknown" where they equal the first of their
block. Where the sampling rate is unknown, the data are pairs of time [s] and acceleration.

Source: U.S. Geological Survey, National Strong-Motion Project, the SMC format; checked against 29 of its files.
"""

import math
import re
from dataclasses import replace

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import NUMBER, Direction, build_record, even_series, read_direction, read_peak
from assess.motion.formats._text import (
    Columns,
    Lines,
    compare_counts,
    convert,
    decode,
    fields,
    has_text,
    read_fields,
    text_format,
)
from assess.motion.record import Record, build_series
from assess.units import ACCELERATION

CM_S2 = ACCELERATION["cm/s2"]

# Lines, counted from 0, at which the blocks start, and the columns of the numbers in each.
INTEGERS, REALS, COMMENTS = 11, 17, 27
INTEGER, REAL, DATA = Columns(8, 10), Columns(5, 15), Columns(8, 10)
LINE = 80

# Places in the two blocks of numbers, counted from 0; the format's description counts from 1.
RECORDER, VERTICAL_ANGLE, AZIMUTH, COMMENT_LINES, DATA_COUNT, PROBLEM, FLOOR = 7, 12, 13, 15, 16, 17, 24
SAMPLING_RATE = 1

HEADER = fields(
    (0, r"(?P<title>.*)"),
    (3, r"^(?P<year>\d{4})\s+(?P<month>\d{1,2})\s+(?P<day>\d{1,2})\s+(?P<hour>\d\d)(?P<minute>\d\d)\b(?P<event>.*)"),
    (3, r"(?P<earthquake>.*)"),
    (5, r"^station\s*=(?P<station>.*?)component\s*=(?P<component>.*)"),
    (5, r"(?P<bare_station>.*)"),
    (6, rf"\bpk\b[^=]*=\s*(?P<peak>[-+]?{NUMBER})"),
)
_KIND = re.compile(r"[ \t]*([1-6])[ \t]+(?:UNCORRECTED|CORRECTED|VELOCITY|DISPLACEMENT|FOURIER|RESPONSE)")
_REFUSED = {
    "3": fill("velocities"), "4": fill("displacements"), "5": fill("a spectrum"), "6": fill("a spectrum"),
}  # fmt: skip
_LOCATION = re.compile(r"<loclbl=>(.*?)<end>")


def _read_channel(lines: Lines) -> Record:
    found = _KIND.match(lines[0])
    if not found:
        raise RecordError.about("the first line names no type of SMC file. Get the file again")
    kind, header = found[1], read_fields(lines, HEADER)
    if len(lines) <= COMMENTS:
        raise RecordError.about(
            "the file is cut short: its header takes {header} lines, the file has {lines}. Get the file again",
            header=COMMENTS,
            lines=len(lines),
        )
    if kind in _REFUSED:
        raise RecordError.about(
            "the file holds {kind} ({title}), not accelerations. Give the acceleration file of the same channel "
            "(type 1 or 2)",
            kind=_REFUSED[kind],
            title=header["title"][:40],
        )
    integers, comments, rate = _read_header(lines)
    numbers, notes = _read_data(lines, integers[DATA_COUNT] or 0, COMMENTS + len(comments))
    if rate is not None:
        own = numbers * CM_S2
        series = even_series(own, 1 / rate, notes)
    elif numbers.size % 2:
        raise RecordError.about(
            "the number of data values is {count}, which is odd: they cannot be pairs of time and acceleration. "
            "Get the file again",
            count=numbers.size,
        )
    else:
        own = numbers[1::2] * CM_S2
        series = build_series(numbers[0::2], own)
        series = replace(series, notes=(*notes, *series.notes))
    direction, notes = _orientation(header["component"], integers[VERTICAL_ANGLE], integers[AZIMUTH])
    place, floor, number = _LOCATION.search("\n".join(comments)), integers[FLOOR], integers[RECORDER]
    start = ""
    if header["year"]:  # the earthquake's time, UTC as the format has it
        date = f"{header['year']}-{int(header['month']):02d}-{int(header['day']):02d}"
        start = f"{date} {header['hour']}:{header['minute']} UTC"
    record = build_record(
        series, own=own, corrected=kind == "2", channel=header["component"], direction=direction,
        location=place[1].strip() if place else "" if floor is None else f"floor {floor}",
        station=header["station"] or header["bare_station"].strip(" *"),
        event=header["event"] if header["year"] else header["earthquake"].strip(" *"), start=start,
        header_pfa=read_peak(header["peak"], CM_S2), notes=notes, recorder="" if number is None else str(number),
    )  # fmt: skip
    if integers[PROBLEM] != 1:
        return record
    return replace(record, notes=(*record.notes, fill("the header flags a problem with the data: read its comments")))


def _read_header(lines: Lines) -> tuple[list[int | None], list[str], float | None]:
    """Return the whole numbers, the comments, and the sampling rate [Hz], None where the data are pairs."""
    integers = []
    block = next(lines.part(INTEGERS, REALS).cut(INTEGER, is_whole=True))
    for place, text in enumerate(decode(block)):
        try:
            integers.append(int(text))
        except ValueError:
            raise RecordError.about(
                "line {line}: {text!r} is not a whole number. Get the file again",
                line=lines.number(INTEGERS + place // INTEGER.per_line),
                text=text.strip(),
            ) from None
    known = [None if number == integers[0] else number for number in integers]
    found = next((place for place, line in enumerate(lines.part(COMMENTS)) if not line.startswith("|")), None)
    if found is None:
        raise RecordError.about("there are no data below the header. Get the file again")
    if found != (known[COMMENT_LINES] or 0):
        raise RecordError.about(
            "the number of comment lines is {there}, but {announced} in the header. Get the file again",
            announced=known[COMMENT_LINES] or 0,
            there=found,
        )
    comments = [line[: 2 * LINE] for line in lines.part(COMMENTS, COMMENTS + found)]
    own = lines.part(REALS, REALS + 1)
    unknown, rate = map(float, convert(own.cut(REAL, is_whole=True), SAMPLING_RATE + 1, own, REAL.per_line))
    if rate == unknown:
        return known, comments, None
    if not (math.isfinite(rate) and rate > 0):
        raise RecordError.about(
            "line {line}: the sampling rate is {rate:g} Hz, expected above 0. Get the file again",
            line=lines.number(REALS),
            rate=rate,
        )
    return known, comments, rate


def _read_data(lines: Lines, announced: int, first: int) -> tuple[FloatArray, tuple[str, ...]]:
    """Return as many numbers as the header announces, from a line on, and a note on those beyond."""
    if announced <= 0:
        raise RecordError.about(
            "the number of data values is {announced} in the header. Get the file again", announced=announced
        )
    rows = lines.part(first)
    wide = next((place for place in np.flatnonzero(rows.lengths > LINE).tolist() if rows[place][LINE:].strip()), None)
    if wide is not None:
        raise RecordError.about(
            "line {line} is longer than {most} characters. Get the file again", line=rows.number(wide), most=LINE
        )
    there = sum(int(has_text(cells).sum()) for cells in rows.cut(DATA, is_whole=True))
    notes = compare_counts(announced, there)
    return convert(rows.cut(DATA, is_whole=True), announced, rows, DATA.per_line), notes


def _orientation(component: str, upright: int | None, number: int | None) -> tuple[Direction, tuple[str, ...]]:
    """Return the direction of a component, and a note where text and numbers disagree."""
    text, vertical = read_direction(component)
    if vertical or (not component and upright in {0, 180}):
        return (None, True), ()
    known = [azimuth for azimuth in (text, number) if azimuth is not None and 0 <= azimuth <= 360]
    if len(known) == 2 and (known[0] - known[1]) % 360:
        note = fill(
            "the header gives two azimuths, {first:g} and {other:g} deg: the first is used",
            first=known[0],
            other=known[1],
        )
        return (float(known[0]), False), (note,)
    return ((float(known[0]), False) if known else (None, vertical)), ()


FORMAT = text_format("smc", "USGS SMC", recognised=_KIND, read_channel=_read_channel)
