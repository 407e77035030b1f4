"""PEER AT2: one channel to a file, in g, four lines of header and then numbers with blanks between them.

The fourth line says how many there are and their step: "NPTS= 4000, DT= .01000 SEC", or in older files
"4000 0.0100 NPTS, DT". All are corrected by PEER. Velocity (VT2) and displacement (DT2) look the same.

Source: Pacific Earthquake Engineering Research Center, NGA ground motion database; checked against a file of each kind.
"""

import re

from assess.errors import RecordError
from assess.motion.formats._format import (
    END,
    NUMBER,
    build_record,
    even_series,
    name_quantity,
    read_direction,
    read_finite,
    require_unit,
)
from assess.motion.formats._text import Lines, fields, read_fields, read_words, text_format
from assess.motion.record import Record

DATA = 4
"""Line at which the data begin."""
_KIND = r"\b(?P<kind>acceleration|velocity|displacement) time (?:series|history) in units of (?P<unit>[\w/*^]+)"
HEADER = fields(
    (range(DATA), _KIND),
    (1, r"(?P<title>.*)"),
    (3, rf"npts\s*=\s*(?P<count>\d{{1,9}})\s*,?\s*dt\s*=\s*(?P<step>{NUMBER})\s*(?:sec|{END})"),
    (3, rf"^(?P<old_count>\d{{1,9}})\s+(?P<old_step>{NUMBER})\s+npts\s*,\s*dt\b"),
)
_YEAR = re.compile(r"[\d/. -]+|\w+ \d+ ?,? ?\d{4}")


def _read_channel(lines: Lines) -> Record:
    header = read_fields(lines, HEADER)
    kind = header["kind"].lower()
    if not kind:
        raise RecordError.about("the header does not name what the file holds. Get the file again")
    if kind != "acceleration":
        raise RecordError.about(
            "the file holds {kind}, not accelerations. Give the .AT2 file of the same channel", kind=name_quantity(kind)
        )
    factor = require_unit(header["unit"])
    count, step = header["count"] or header["old_count"], read_finite(header["step"] or header["old_step"])
    if not count or step is None:
        raise RecordError.about(
            "line {line} does not give the number of points and their time step. Get the file again", line=DATA
        )
    values, notes = read_words(lines, DATA, int(count), factor)
    # "event, date, station, component"; older titles have the date within the event.
    event, *others = [part.strip() for part in header["title"].split(",")]
    if others and _YEAR.fullmatch(others[0]):
        event = f"{event}, {others.pop(0)}"
    component = others.pop().split("(")[0].strip() if others else ""
    return build_record(
        even_series(values, step, notes), corrected=True, channel=component, direction=read_direction(component),
        station=", ".join(others), event=event,
    )  # fmt: skip


FORMAT = text_format(
    "peer_at2",
    "PEER AT2",
    recognised=re.compile(rf"(?:[^\n]*\n){{0,{DATA - 1}}}[^\n]*{_KIND}", re.IGNORECASE),
    read_channel=_read_channel,
)
