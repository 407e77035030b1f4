"""K-NET and KiK-net: one channel to a file, counts with a scale factor that makes them gal.

Layout: 17 lines of header, whose first 18 characters name what follows, then whole numbers with blanks between them.
The samples carry the instrument's offset; the peak in the header is that about their mean. KiK-net numbers its
directions: 1 to 3 (north-south, east-west, up-down) in the borehole, 4 to 6 at the surface.

Recorders start 15 s before what the header calls the record time.

Source: National Research Institute for Earth Science and Disaster Resilience (NIED), K-NET ASCII format; checked
against nine of its files.
"""

import re
from contextlib import suppress
from datetime import datetime, timedelta

from assess.errors import RecordError
from assess.motion.formats._format import NUMBER, build_record, even_series, read_direction, read_finite, read_peak
from assess.motion.formats._text import Lines, read_words, text_format
from assess.motion.record import Record
from assess.units import ACCELERATION

GAL = ACCELERATION["gal"]

HEADER, NAME = 17, 18
"""Lines before the data, and characters of the name on each."""
DELAY = timedelta(seconds=15)
"""From the first sample to the record time."""

_CHANNELS = {
    "n-s": "NS", "e-w": "EW", "u-d": "UD", "1": "NS1", "2": "EW1", "3": "UD1", "4": "NS2", "5": "EW2", "6": "UD2",
}  # fmt: skip
_SCALE = re.compile(rf"({NUMBER})\s*\(gal\)\s*/\s*({NUMBER})", re.IGNORECASE)
_NUMBER = re.compile(NUMBER, re.IGNORECASE)


def _read_channel(lines: Lines) -> Record:
    header = {line[:NAME].strip(): line[NAME : 10 * NAME].strip() for line in lines.part(0, HEADER)}
    numbers = []
    for key in ("Sampling Freq(Hz)", "Duration Time(s)"):
        text = header.get(key, "")  # such as "100Hz"
        found = _NUMBER.match(text)
        number = read_finite(found[0]) if found else None
        if not number:
            raise RecordError.about(
                "{key} is {text!r} in the header, expected a number above 0. Get the file again",
                key=key,
                text=text[:40],
            )
        numbers.append(number)
    rate, seconds = numbers
    text = header.get("Scale Factor", "")
    found = _SCALE.match(text)
    above, below = (read_finite(found[1]), read_finite(found[2])) if found else (None, None)
    if not above or not below:
        raise RecordError.about(
            "the scale factor is {text!r}, expected a ratio such as 3920(gal)/6182761. Get the file again",
            text=text[:40],
        )
    values, notes = read_words(lines, HEADER, rate * seconds, above / below * GAL)
    start, direction = header.get("Record Time", ""), header.get("Dir.", "")
    with suppress(ValueError, OverflowError):
        time = datetime.strptime(start, "%Y/%m/%d %H:%M:%S") - DELAY  # Japan's time, as printed
        start = f"{time:%Y-%m-%d %H:%M:%S} JST"
    channel = _CHANNELS.get(direction.lower(), direction)
    return build_record(
        even_series(values, 1 / rate, notes), corrected=False, channel=channel, direction=read_direction(channel),
        location={"1": "borehole", "2": "surface"}.get(channel[2:], ""), station=header.get("Station Code", ""),
        event=f"{header.get('Origin Time', '')} M{header.get('Mag.', '')}", start=start,
        header_pfa=read_peak(header.get("Max. Acc. (gal)", ""), GAL), has_offset=True,
    )  # fmt: skip


FORMAT = text_format(
    "knet",
    "K-NET/KiK-net",
    recognised=re.compile(r"Origin Time[^\n]*\nLat\.[^\n]*\nLong\."),
    read_channel=_read_channel,
)
