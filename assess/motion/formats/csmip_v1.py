"""CSMIP volume 1: uncorrected accelerations, several channels to a file.

The data are evenly spaced (a line of their own says the rate, the unit and the format), or, in files from film, pairs
of time [s] and acceleration [g/10] in 10F7.3. RENADIC of the Universidad de Chile writes the same.

Source: see _csmip.py.
"""

import re

import numpy as np

from assess.errors import RecordError
from assess.motion.formats._csmip import Text, printed_peak, read_text
from assess.motion.formats._format import Format
from assess.motion.formats._text import (
    Columns,
    Section,
    even_series,
    note_peak,
    read_acceleration_unit,
    read_columns,
    read_finite,
    read_format,
    read_sections,
    scaled,
    split_lines,
    split_sections,
)
from assess.motion.record import FloatArray, Record, Series, build_series, peak
from assess.units import GRAVITY

TITLE = "CSMIP V1"

HEADER = 27
"""Lines before the data: 13 of text, 7 of whole numbers, 7 of real numbers."""
PAIRS = Columns(10, 7)

_START = re.compile(r"\s*uncorrected accelerogram data\b", re.IGNORECASE)
_COUNT = re.compile(r"no\.\s*of points\s*=\s*(\d{1,9})\b", re.IGNORECASE)
_UNIT = re.compile(r"\bare\s+sec\s+and\s+(g(?:\s*/\s*10)?)\b", re.IGNORECASE)
_PEAK = re.compile(r"max\s*=\s*([-+.\dE]+)\s*g\b", re.IGNORECASE)
_EVEN = re.compile(
    r"\s*(?P<count>\d{1,9})\s+accel\w*\s+points\s+at\s+(?P<rate>[\d.]+)\s*pts/sec\s+in\s+units\s+of\s+(?P<unit>[\w/]+)",
    re.IGNORECASE,
)


def recognises(head: bytes) -> bool:
    """Tell whether a file that starts with `head` is a volume 1 of CSMIP."""
    return _START.match(head[:200].decode("latin-1")) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read every channel of a volume 1.

    Raises
    ------
    RecordError
        If no channel can be read.
    """
    sections = split_sections(split_lines(data), lambda line: _START.match(line) is not None)
    if not sections:
        raise RecordError('no line says "Uncorrected accelerogram data". Get the file again')
    return read_sections(sections, lambda section: _read_channel(section, file))


def _read_channel(section: Section, file: str) -> Record:
    own, series = _read_data(section)
    text, header_pfa = read_text(section, 0), printed_peak(_PEAK, section, range(9, 13), GRAVITY)
    return _build_record(file, text, own, series, header_pfa)


def _read_data(section: Section) -> tuple[FloatArray, Series]:
    """Return the file's own samples [m/s2], and the same evenly spaced."""
    even = _EVEN.match(section.text(HEADER))
    if even:
        count, rate, factor = int(even["count"]), read_finite(even["rate"]), read_acceleration_unit(even["unit"])
        if not rate or factor is None:
            place = section.number(HEADER)
            raise RecordError(f"line {place}: the rate or the unit cannot be read. Get the file again")
        columns = read_format(section.text(HEADER), Columns(8, 9))
        own = scaled(read_columns(section, HEADER + 1, count, columns), factor)
        return own, even_series(own, 1 / rate)
    return _read_pairs(section)


def _read_pairs(section: Section) -> tuple[FloatArray, Series]:
    header = "\n".join(section.lines[:13])
    points, unit = _COUNT.search(header), _UNIT.search(header)
    if not points or not unit:
        raise RecordError("the header does not say the number of points, or their unit. Get the file again")
    numbers = read_columns(section, HEADER, 2 * int(points[1]), PAIRS)
    factor = read_acceleration_unit(unit[1]) or np.nan
    own = scaled(numbers[1::2], factor)
    return own, build_series(numbers[0::2], own)


def _build_record(file: str, text: Text, own: FloatArray, series: Series, header_pfa: float | None) -> Record:
    return Record(
        file=file,
        format=TITLE,
        channel=text.channel,
        location=text.location,
        azimuth_deg=text.azimuth_deg,
        vertical=text.vertical,
        station=text.station,
        event=text.event,
        start=text.start,
        corrected=False,
        time_step=series.time_step,
        acceleration=series.values,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=(*series.notes, *note_peak(header_pfa, peak(own))),
    )


FORMAT = Format(key="csmip_v1", title=TITLE, recognises=recognises, read=read)
