"""CSMIP volume 2: corrected accelerations, velocities and displacements, several channels to a file.

Only the accelerations are read: each treatment integrates them in the same way. The velocities printed in files before
about 1995 were filtered again after that, so that their peaks differ by up to 4 % from the integral's.

Source: see _csmip.py.
"""

import re

from assess.errors import RecordError
from assess.motion.formats._csmip import printed_peak, read_text
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
from assess.motion.record import Record, peak
from assess.units import ACCELERATION

TITLE = "CSMIP V2"

TEXT = 25
"""Lines of text."""
PLAIN = Columns(8, 10)

_RECOGNISED = re.compile(
    r"\s*(?:corrected accelerogram\b[^\n]*\n\s*uncorrected accelerogram data\b|(?P<spectra>response and fourier))",
    re.IGNORECASE,
)
_START = re.compile(r"\s*corrected accelerogram\b", re.IGNORECASE)
_PEAK = re.compile(r"peak\s+acceleration\s*=\s*([-+.\dE]+)", re.IGNORECASE)
_DATA = re.compile(
    r"\s*(?P<count>\d{1,9})\s+points of accel data equally spaced at\s+(?P<step>[\d.]+)\s*sec", re.IGNORECASE
)
_UNIT = re.compile(r"(?:units:|,\s*in)\s*(cm/sec/sec|cm/sec2|g)\b", re.IGNORECASE)


def recognises(head: bytes) -> bool:
    """Tell whether a file that starts with `head` is a volume 2 of CSMIP, or a volume 3, which is refused."""
    return _RECOGNISED.match(head[:400].decode("latin-1").replace("\r", "\n")) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the accelerations of every channel of a volume 2.

    Raises
    ------
    RecordError
        If no channel can be read, or the file is a volume 3.
    """
    first = _RECOGNISED.match(data[:400].decode("latin-1").replace("\r", "\n"))
    if first and first["spectra"]:
        raise RecordError(
            "it holds response spectra (volume 3), not accelerations. Give volume 2 or 1 of the same channels"
        )
    sections = split_sections(split_lines(data), lambda line: _START.match(line) is not None)
    if not sections:
        raise RecordError('no line says "Corrected accelerogram". Get the file again')
    return read_sections(sections, lambda section: _read_channel(section, file))


def _read_channel(section: Section, file: str) -> Record:
    place = next((place for place in range(TEXT, len(section.lines)) if _DATA.match(section.lines[place])), None)
    if place is None:
        raise RecordError('no line says "points of accel data equally spaced at". Get the file again')
    title = section.text(place)
    found, unit = _DATA.match(title), _UNIT.search(title)
    factor = read_acceleration_unit(unit[1]) if unit else None
    step = read_finite(found["step"]) if found else None
    if found is None or step is None or factor is None:
        raise RecordError(f"line {section.number(place)}: the time step or the unit cannot be read. Get the file again")
    own = scaled(read_columns(section, place + 1, int(found["count"]), read_format(title, PLAIN)), factor)
    series = even_series(own, step)
    text = read_text(section, 1)
    header_pfa = printed_peak(_PEAK, section, range(TEXT), ACCELERATION["cm/s2"])
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
        corrected=True,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=peak(own),
        header_pfa=header_pfa,
        notes=note_peak(header_pfa, peak(own)),
    )


FORMAT = Format(key="csmip_v2", title=TITLE, recognises=recognises, read=read)
