"""GeoNet V1A and V2A: three components to a file, each with its own header of 26 lines.

Layout: 16 lines of text, 4 of whole and 6 of real numbers (10 to a line), the accelerations in 10F8.1, and in V2A the
velocities and displacements after them. V1A is uncorrected, V2A corrected.

Source: GNS Science, New Zealand, GeoNet strong-motion data, formats V1A and V2A; checked against a file of each.
"""

import re

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.formats._text import (
    Columns,
    Section,
    even_series,
    note_peak,
    read_acceleration_unit,
    read_columns,
    read_direction,
    read_finite,
    read_sections,
    scaled,
    split_lines,
    split_sections,
)
from assess.motion.record import Record, peak

TITLE = "GeoNet"

TEXT, HEADER = 16, 26
"""Lines of text, and of text and numbers together."""
COLUMNS = Columns(10, 8)

# Places in the block of numbers, counted from 0: line and column.
RAW_COUNT, COUNT, STEP = (3, 0), (3, 3), (6, 5)

_RECOGNISED = re.compile(r"(?:un)?corrected accelerogram [^\n]*\n+site [^\n]*\n", re.IGNORECASE)
_START = re.compile(r"(un)?corrected accelerogram ", re.IGNORECASE)
_PEAK = re.compile(r"acceleration:\s*peak\s+([-+.\d]+)\s*(\S+)", re.IGNORECASE)
_RAW_UNIT = re.compile(r"raw readings in units of\s+([\d.]+)\s+(\S+)", re.IGNORECASE)


def recognises(head: bytes) -> bool:
    """Tell whether `head` begins with an accelerogram and its site."""
    return _RECOGNISED.match(head[:400].decode("latin-1").replace("\r", "\n")) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read every component of a GeoNet file.

    Raises
    ------
    RecordError
        If no component can be read.
    """
    sections = split_sections(split_lines(data), lambda line: _START.match(line) is not None)
    if not sections:
        raise RecordError('no line says "accelerogram". Get the file again')
    return read_sections(sections, lambda section: _read_channel(section, file))


def _read_channel(section: Section, file: str) -> Record:
    corrected = not section.text(0).lower().startswith("un")
    count = _read_number(section, *(COUNT if corrected else RAW_COUNT))
    factor, header_pfa = _read_units(section, corrected)
    own = scaled(read_columns(section, HEADER, int(count), COLUMNS), factor)
    series = even_series(own, _read_number(section, *STEP))
    component = section.text(12).removeprefix("Component").split()
    azimuth, vertical = read_direction(component[0]) if component else (None, False)
    site = section.text(1).split()
    return Record(
        file=file,
        format=TITLE,
        channel=component[0] if component else "1",
        location="",
        azimuth_deg=azimuth,
        vertical=vertical,
        station=f"{section.text(2)} ({site[1]})" if len(site) > 1 else section.text(2),
        event=section.text(6),
        start=" ".join(section.text(7).split()),
        corrected=corrected,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=note_peak(header_pfa, peak(own)),
    )


def _read_number(section: Section, line: int, column: int) -> float:
    """Return a number of the header; they have blanks between them."""
    words = section.text(TEXT + line).split()
    number = read_finite(words[column]) if column < len(words) else None
    if number is None:
        raise RecordError(f"line {section.number(TEXT + line)}: number {column + 1} is missing. Get the file again")
    return number


def _read_units(section: Section, corrected: bool) -> tuple[float, float | None]:
    """Return the factor to m/s2, and the peak printed in the header [m/s2]."""
    found, raw = _PEAK.search(section.text(13)), _RAW_UNIT.search(section.text(10))
    factor = read_acceleration_unit(found[2]) if found else None
    number = read_finite(found[1]) if found else None
    if factor is None or number is None:
        raise RecordError(f"line {section.number(13)}: the peak and its unit cannot be read. Get the file again")
    if corrected:
        return factor, abs(number) * factor
    multiple = read_finite(raw[1]) if raw else None
    unit = read_acceleration_unit(raw[2]) if raw else None
    if not multiple or unit is None:
        raise RecordError(f"line {section.number(10)}: the unit cannot be read. Get the file again")
    return multiple * unit, abs(number) * factor


FORMAT = Format(key="geonet", title=TITLE, recognises=recognises, read=read)
