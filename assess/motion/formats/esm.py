"""ESM and ITACA ASCII: one channel to a file, lines "KEY: value" and then one number a line, in cm/s2.

Source: Engineering Strong-Motion database and Italian accelerometric archive, header format DYNA 1.2; checked against
three of its files.
"""

import re
from collections import defaultdict

from assess.errors import RecordError
from assess.motion.formats._format import (
    build_record,
    even_series,
    name_quantity,
    read_direction,
    read_finite,
    read_peak,
    require_unit,
)
from assess.motion.formats._text import Lines, read_words, text_format
from assess.motion.record import Record
from assess.units import ACCELERATION

_KEY = re.compile(r"([A-Z][A-Z0-9_/^ ]*):(.*)")
_DATE = re.compile(r"(\d{4})(\d\d)(\d\d)_(\d\d)(\d\d)([\d.]+)")
_RAW = re.compile(r"(none|no\b.*|not\b.*|un.*|raw.*|)", re.IGNORECASE)


def _read_channel(lines: Lines) -> Record:
    header: dict[str, str] = defaultdict(str)  # "" for keys that it has not
    for first in range(min(len(lines), 200)):  # version 1.2 has 64
        found = _KEY.match(lines.text(first))
        if not found:
            break
        header[found[1]] = found[2].strip()
    else:
        raise RecordError.about("there are no data below the header. Get the file again")
    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise RecordError.about(
            "the file holds {kind}, not accelerations. Give the .ACC. file of the same channel",
            kind=name_quantity(kind[:40]),
        )
    factor = require_unit(header["UNITS"])
    count, step = read_finite(header["NDATA"]), read_finite(header["SAMPLING_INTERVAL_S"])
    if count is None or step is None:
        raise RecordError.about("the header does not give NDATA and SAMPLING_INTERVAL_S. Get the file again")
    values, notes = read_words(lines, first, count, factor)
    name, code = header["STATION_NAME"], header["STATION_CODE"]
    return build_record(
        even_series(values, step, notes),
        # Only filtered data need no further filter; a baseline alone may have been removed from raw data, too.
        corrected=not (_RAW.fullmatch(header["PROCESSING"]) or _RAW.fullmatch(header["FILTER_TYPE"])),
        channel=header["STREAM"],
        direction=read_direction(header["STREAM"], bare_degrees=False),
        location=header["LOCATION"],
        station=f"{name} ({code})" if name and code else name or code,
        event=" ".join(filter(None, (header["EVENT_NAME"], header["EVENT_DATE_YYYYMMDD"]))),
        start=_DATE.sub(r"\1-\2-\3 \4:\5:\6 UTC", header["DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"]),
        header_pfa=read_peak(header["PGA_CM/S^2"], ACCELERATION["cm/s2"]),
    )


FORMAT = text_format(
    "esm",
    "ESM",
    recognised=re.compile(r"EVENT_NAME:(?=.*\nSTATION_CODE:)(?=.*\nUNITS:)", re.DOTALL),
    read_channel=_read_channel,
)
