"""What CSMIP volumes 1 and 2 share: the lines of text before the numbers.

Layout: lines of text (13 in volume 1; in volume 2 one more before them and eleven after), whole numbers (16I5, 100 of
them), real numbers (8F10, 50 or 100 of them), the data, and a line "/&". Then the next channel follows, with its own
header.

Source: California Strong Motion Instrumentation Program (1985). Standard tape format for CSMIP strong-motion data
tapes. Report OSMS 85-03; checked against files processed in 1983 to 2012.
"""

import re
from dataclasses import dataclass

from assess.motion.formats._text import Section, read_direction, read_finite

_CHANNEL = re.compile(
    r"chan\w*\s*(?P<number>\d+)\s*:\s*(?P<direction>.*?)\s*"
    r"(?:\(\s*sta\s*chn:\s*(?P<station>\w+)\s*\))?\s*(?:location:\s*(?P<location>.*))?$",
    re.IGNORECASE,
)
_STATION_NUMBER = re.compile(r"station\s+no\.?\s*(\d+)\s", re.IGNORECASE)
_START = re.compile(r"(?:trigger|start)\s+time:\s*([-\d/]+,?\s+[\d:.]+\s*\w*)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Text:
    """What the lines of text tell of a channel."""

    channel: str
    location: str
    azimuth_deg: float | None
    vertical: bool
    station: str
    event: str
    start: str


def read_text(section: Section, first: int) -> Text:
    """Read the lines of text that begin at the section's line `first`, "Uncorrected accelerogram data".

    A channel goes by its number in the building, as on the drawings of the station, where the file tells that and not
    only the recorder's.
    """
    channel = _CHANNEL.match(section.text(first + 6))
    azimuth, vertical = read_direction(channel["direction"] if channel else "")
    name = _first_part(section.text(first + 5))
    number = _STATION_NUMBER.match(section.text(first + 4))
    start = _START.search(section.text(first + 3))
    return Text(
        channel=(channel["station"] or channel["number"]).lstrip("0") or "0" if channel else "1",
        location=(channel["location"] or "").strip() if channel else "",
        azimuth_deg=azimuth,
        vertical=vertical,
        station=f"{name} ({number[1]})" if number else name,
        event=_first_part(section.text(first + 1)),
        start=start[1] if start else _first_part(section.text(first + 2)),
    )


def printed_peak(pattern: re.Pattern[str], section: Section, lines: range, unit: float) -> float | None:
    """Return the peak [m/s2] that `pattern` finds in some of the section's lines, printed in `unit` [m/s2]."""
    found = next((hit for hit in (pattern.search(section.text(place)) for place in lines) if hit), None)
    number = read_finite(found[1]) if found else None
    return None if number is None else abs(number) * unit


def _first_part(text: str) -> str:
    """Return what stands before a wide gap: the right half of a line is about the processing."""
    return re.split(r"\s{3,}", text, maxsplit=1)[0]
