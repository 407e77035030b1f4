"""K-NET and KiK-net: one channel to a file, counts with a scale factor that makes them gal.

Layout: 17 lines of header, whose first 18 characters name what follows, then whole numbers with blanks between them.
The samples carry the instrument's offset; the peak in the header is that about their mean. KiK-net numbers its
directions: 1 to 3 (north-south, east-west, up-down) in the borehole, 4 to 6 at the surface.

Recorders start 15 s before what the header calls the record time.

Source: National Research Institute for Earth Science and Disaster Resilience (NIED), K-NET ASCII format; checked
against nine of its files.
"""

import re
from datetime import datetime, timedelta

from assess.errors import RecordError
from assess.motion.formats._format import Format
from assess.motion.formats._text import Section, even_series, note_peak, read_finite, read_words, scaled, split_lines
from assess.motion.record import FloatArray, Record, peak
from assess.units import ACCELERATION

TITLE = "K-NET/KiK-net"
GAL = ACCELERATION["gal"]

HEADER, NAME = 17, 18
"""Lines before the data, and characters of the name on each."""
DELAY = timedelta(seconds=15)
"""From the first sample to the record time."""

_KEYS = ("Origin Time", "Lat.", "Long.")
_DIRECTIONS = {"n-s": ("NS", 0.0), "e-w": ("EW", 90.0), "u-d": ("UD", None),
               "1": ("NS1", 0.0), "2": ("EW1", 90.0), "3": ("UD1", None),
               "4": ("NS2", 0.0), "5": ("EW2", 90.0), "6": ("UD2", None)}  # fmt: skip
_SCALE = re.compile(r"([\d.]+)\s*\(gal\)\s*/\s*([\d.]+)", re.IGNORECASE)
_NUMBER = re.compile(r"[\d.]+")


def recognises(head: bytes) -> bool:
    """Tell whether the first three lines of `head` are named as in K-NET."""
    lines = split_lines(head[:500])
    return len(lines) >= len(_KEYS) and all(line.startswith(key) for line, key in zip(lines, _KEYS, strict=False))


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the one channel of a K-NET or KiK-net file.

    Raises
    ------
    RecordError
        If the file is damaged or cut short.
    """
    section = Section(split_lines(data))
    header = {line[:NAME].strip(): line[NAME : 10 * NAME].strip() for line in section.lines[:HEADER]}
    rate, seconds = _number(header, "Sampling Freq(Hz)"), _number(header, "Duration Time(s)")
    counts, notes = read_words(section, HEADER, rate * seconds)
    own = scaled(counts, _read_scale(header))
    series = even_series(own, 1 / rate, notes)
    header_pfa = read_finite(header.get("Max. Acc. (gal)"))
    direction = header.get("Dir.", "")
    channel, azimuth = _DIRECTIONS.get(direction.lower(), (direction or "1", None))
    record = Record(
        file=file,
        format=TITLE,
        channel=channel,
        location={"1": "borehole", "2": "surface"}.get(channel[2:], ""),
        azimuth_deg=azimuth,
        vertical=channel.startswith("UD"),
        station=header.get("Station Code", ""),
        event=f"{header.get('Origin Time', '')} M{header.get('Mag.', '')}",
        start=_read_start(header.get("Record Time", "")),
        corrected=False,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=_peak_about_mean(own),
        header_pfa=None if header_pfa is None else header_pfa * GAL,
        notes=(*series.notes, *note_peak(None if header_pfa is None else header_pfa * GAL, _peak_about_mean(own))),
    )
    return (record,)


def _peak_about_mean(values: FloatArray) -> float:
    return peak(values - values.mean())


def _number(header: dict[str, str], key: str) -> float:
    """Return the positive number that `key` begins with: "100Hz"."""
    found = _NUMBER.match(header.get(key, ""))
    number = read_finite(found[0]) if found else None
    if not number:
        raise RecordError(f"the header has no number for {key}, but {header.get(key, '')[:40]!r}. Get the file again")
    return number


def _read_scale(header: dict[str, str]) -> float:
    """Return what one count is [m/s2]."""
    text = header.get("Scale Factor", "")
    found = _SCALE.match(text)
    above, below = (read_finite(found[1]), read_finite(found[2])) if found else (None, None)
    if not above or not below:
        raise RecordError(f"the scale factor is {text[:40]!r}, expected such as 3920(gal)/6182761. Get the file again")
    return above / below * GAL


def _read_start(text: str) -> str:
    try:
        time = datetime.strptime(text, "%Y/%m/%d %H:%M:%S") - DELAY  # Japan's time, as printed
    except (ValueError, OverflowError):
        return text
    return f"{time:%Y-%m-%d %H:%M:%S} JST"


FORMAT = Format(key="knet", title=TITLE, recognises=recognises, read=read)
