"""CSMIP volumes 1 (uncorrected) and 2 (corrected accelerations, velocities, displacements), several channels to a file.

Layout: lines of text (13 in volume 1; in volume 2 one more before them and eleven after), whole numbers (16I5, 100 of
them), real numbers (8F10, 50 or 100 of them), the data, and a line "/&". Then the next channel follows, with its own
header.

The data of volume 1 are evenly spaced (a line of their own says the rate, the unit and the format), or, in files from
film, pairs of time [s] and acceleration [g/10] in 10F7.3. RENADIC of the Universidad de Chile writes the same.

Of volume 2 only the accelerations are read: each treatment integrates them in the same way. The velocities printed in
files before about 1995 were filtered again after that, so that their peaks differ by up to 4 % from the integral's.

Source: California Strong Motion Instrumentation Program (1985). Standard tape format for CSMIP strong-motion data
tapes. Report OSMS 85-03; checked against files processed in 1983 to 2012.
"""

import re
from collections.abc import Mapping

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import (
    NUMBER,
    build_record,
    even_series,
    read_acceleration_unit,
    read_direction,
    read_finite,
    read_peak,
)
from assess.motion.formats._text import Columns, Lines, fields, read_columns, read_fields, read_format, text_format
from assess.motion.record import Record, Series, build_series
from assess.units import ACCELERATION, GRAVITY

TEXT_V1, TEXT_V2 = 13, 25
"""Lines of text."""
DATA_V1 = 27
"""Line at which the data of volume 1 begin: after the text, 7 lines of whole and 7 of real numbers."""
PAIRS, EVEN, CORRECTED = Columns(10, 7), Columns(8, 9), Columns(8, 10)
"""How the data stand where no format is printed: pairs and evenly spaced of volume 1, volume 2."""

# The right half of a line, after a wide gap, is about the processing.
TEXT = fields(
    (1, r"(?P<event>.*?)(?:\s{3,}|$)"),
    (2, r"(?P<date>.*?)(?:\s{3,}|$)"),
    (3, r"(?:trigger|start)\s+time:\s*(?P<start>[-\d/]+,?\s+[\d:.]+\s*\w*)"),
    (4, r"^station\s+no\.?\s*(?P<station_number>\d+)\s"),
    (5, r"(?P<station>.*?)(?:\s{3,}|$)"),
    (
        6,
        r"^chan\w*\s*(?P<number>\d+)\s*:\s*(?P<direction>.*?)\s*"
        r"(?:\(\s*sta\s*chn:\s*(?P<drawn_as>\w+)\s*\))?\s*(?:location:\s*(?P<location>.*))?$",
    ),
)
"""Counted from the line "Uncorrected accelerogram data", which both volumes have."""
PEAK_V1 = fields((range(9, TEXT_V1), rf"max\s*=\s*(?P<peak>[-+]?{NUMBER})\s*g\b"))
PEAK_V2 = fields((range(TEXT_V2), rf"peak\s+acceleration\s*=\s*(?P<peak>[-+]?{NUMBER})"))
TITLE_V1 = fields(
    (
        DATA_V1,
        rf"^(?P<count>\d{{1,9}})\s+accel\w*\s+points\s+at\s+(?P<rate>{NUMBER})\s*pts/sec\s+in\s+units\s+of\s+(?P<unit>[\w/]+)",
    )
)
TITLE_V2 = fields(
    (0, r"^(?P<count>\d{1,9})\s+points of accel data"),
    (0, rf"equally spaced at\s+(?P<step>{NUMBER})\s*sec"),
    (0, r"(?:units:|,\s*in)\s*(?P<unit>cm/sec/sec|cm/sec2|g)\b"),
)

_COUNT = re.compile(r"no\.\s*of points\s*=\s*(\d{1,9})\b", re.IGNORECASE)
_UNIT = re.compile(r"\bare\s+sec\s+and\s+(g(?:\s*/\s*10)?)\b", re.IGNORECASE)
_DATA_V2 = re.compile(r"\s*\d{1,9}\s+points of accel data equally spaced at\s+\S+\s*sec", re.IGNORECASE)
_START_V1 = re.compile(r"\s*uncorrected accelerogram data\b", re.IGNORECASE)
_SPECTRA = re.compile(r"\s*response and fourier", re.IGNORECASE)


def _read_v1(lines: Lines) -> Record:
    title = read_fields(lines, TITLE_V1)
    if title["count"]:
        rate, factor = read_finite(title["rate"]), read_acceleration_unit(title["unit"])
        if not rate or factor is None:
            line = lines.number(DATA_V1)
            raise RecordError.about(
                "line {line}: the sampling rate or the unit cannot be read. Get the file again", line=line
            )
        columns = read_format(lines.text(DATA_V1), EVEN)
        own = read_columns(lines, DATA_V1 + 1, int(title["count"]), columns, factor)
        series = even_series(own, 1 / rate)
    else:
        header = "\n".join(lines.part(0, TEXT_V1))
        points, unit = _COUNT.search(header), _UNIT.search(header)
        if not points or not unit:
            raise RecordError.about("the header does not give the number of points, or their unit. Get the file again")
        pairs = read_columns(lines, DATA_V1, 2 * int(points[1]), PAIRS)
        with np.errstate(over="ignore"):  # what becomes infinite is refused where samples are checked
            own = pairs[1::2] * (read_acceleration_unit(unit[1]) or np.nan)
        series = build_series(pairs[0::2], own)
    header_pfa = read_peak(read_fields(lines, PEAK_V1)["peak"], GRAVITY)
    return _build(read_fields(lines, TEXT), series, own, header_pfa, corrected=False)


def _read_v2(lines: Lines) -> Record:
    rows = enumerate(lines.part(TEXT_V2), start=TEXT_V2)
    place = next((place for place, line in rows if _DATA_V2.match(line)), None)
    if place is None:
        raise RecordError.about('no line says "points of accel data equally spaced at". Get the file again')
    title = read_fields(lines, TITLE_V2, place)
    factor, step = read_acceleration_unit(title["unit"]), read_finite(title["step"])
    if step is None or factor is None:
        raise RecordError.about(
            "line {line}: the time step or the unit cannot be read. Get the file again", line=lines.number(place)
        )
    columns = read_format(lines.text(place), CORRECTED)
    own = read_columns(lines, place + 1, int(title["count"]), columns, factor)
    header_pfa = read_peak(read_fields(lines, PEAK_V2)["peak"], ACCELERATION["cm/s2"])
    return _build(read_fields(lines, TEXT, first=1), even_series(own, step), own, header_pfa, corrected=True)


def _build(
    text: Mapping[str, str], series: Series, own: FloatArray, header_pfa: float | None, *, corrected: bool
) -> Record:
    number = text["drawn_as"] or text["number"]  # that on the drawings of the building, or else of the recorder
    return build_record(
        series, own=own, corrected=corrected, channel=number and (number.lstrip("0") or "0"),
        direction=read_direction(text["direction"]), location=text["location"],
        station=f"{text['station']} ({text['station_number']})" if text["station_number"] else text["station"],
        event=text["event"], start=text["start"] or text["date"], header_pfa=header_pfa,
    )  # fmt: skip


def _refuse_spectra(channels: list[Lines]) -> list[Lines]:
    if _SPECTRA.match(channels[0][0]):
        raise RecordError.about(
            "the file holds response spectra (volume 3), not accelerations. Give volume 2 or 1 of the same channels"
        )
    return [channel for channel in channels if not _SPECTRA.match(channel[0])]


VOLUME_1 = text_format(
    "csmip_v1",
    "CSMIP V1",
    recognised=_START_V1,
    starts=_START_V1,
    missing=fill('no line says "Uncorrected accelerogram data"'),
    read_channel=_read_v1,
)
VOLUME_2 = text_format(
    "csmip_v2",
    "CSMIP V2",
    recognised=re.compile(
        rf"\s*corrected accelerogram\b[^\n]*\n\s*uncorrected accelerogram data\b|{_SPECTRA.pattern}", re.IGNORECASE
    ),
    starts=re.compile(rf"\s*corrected accelerogram\b|{_SPECTRA.pattern}", re.IGNORECASE),
    missing=fill('no line says "Corrected accelerogram"'),
    choose=_refuse_spectra,
    read_channel=_read_v2,
)
