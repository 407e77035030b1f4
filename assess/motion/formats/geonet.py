"""GeoNet V1A and V2A: three components to a file, each with its own header of 26 lines.

Layout: 16 lines of text, 4 of whole and 6 of real numbers (10 to a line), the accelerations in 10F8.1, and in V2A the
velocities and displacements after them. V1A is uncorrected, V2A corrected.

Source: GNS Science, New Zealand, GeoNet strong-motion data, formats V1A and V2A; checked against a file of each.
"""

import re

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
from assess.motion.formats._text import Columns, Lines, fields, read_columns, read_fields, text_format
from assess.motion.record import Record

TEXT, DATA = 16, 26
"""Lines at which the numbers of the header, and the data, begin."""
RAW_COUNT, COUNT, STEP = (3, 0), (3, 3), (6, 5)
"""Places in the numbers of the header, counted from 0: line and column."""
COLUMNS = Columns(10, 8)
HEADER = fields(
    (0, r"^(?P<raw>un)?"),
    (1, r"^\S+\s+(?P<site>\S+)"),
    (2, r"(?P<station>.*)"),
    (6, r"(?P<event>.*)"),
    (7, r"(?P<start>.*)"),
    (10, rf"raw readings in units of\s+(?P<multiple>{NUMBER})\s+(?P<raw_unit>\S+)"),
    (12, r"^(?:component)?\s*(?P<component>\S*)"),
    (13, rf"acceleration:\s*peak\s+(?P<peak>[-+]?{NUMBER})\s*(?P<unit>\S+)"),
)


def _read_channel(lines: Lines) -> Record:
    header = read_fields(lines, HEADER)
    corrected = not header["raw"]
    count = _read_number(lines, *(COUNT if corrected else RAW_COUNT))
    factor = read_acceleration_unit(header["unit"])
    header_pfa = read_peak(header["peak"], factor)
    if factor is None or header_pfa is None:
        line = lines.number(13)
        raise RecordError.about("line {line}: the peak and its unit cannot be read. Get the file again", line=line)
    if not corrected:
        multiple, unit = read_finite(header["multiple"]), read_acceleration_unit(header["raw_unit"])
        if not multiple or unit is None:
            line = lines.number(10)
            raise RecordError.about("line {line}: the unit cannot be read. Get the file again", line=line)
        factor = multiple * unit
    own = read_columns(lines, DATA, int(count), COLUMNS, factor)
    return build_record(
        even_series(own, _read_number(lines, *STEP)), corrected=corrected, channel=header["component"],
        direction=read_direction(header["component"]),
        station=f"{header['station']} ({header['site']})" if header["site"] else header["station"],
        event=header["event"], start=" ".join(header["start"].split()), header_pfa=header_pfa,
    )  # fmt: skip


def _read_number(lines: Lines, line: int, column: int) -> float:
    words = lines.text(TEXT + line).split()
    number = read_finite(words[column]) if column < len(words) else None
    if number is None:
        raise RecordError.about(
            "line {line}: number {number} is missing. Get the file again",
            line=lines.number(TEXT + line),
            number=column + 1,
        )
    return number


FORMAT = text_format(
    "geonet",
    "GeoNet",
    recognised=re.compile(r"(?:un)?corrected accelerogram [^\n]*\n+site [^\n]*\n", re.IGNORECASE),
    starts=re.compile(r"(un)?corrected accelerogram ", re.IGNORECASE),
    missing=fill('no line says "accelerogram"'),
    read_channel=_read_channel,
)
