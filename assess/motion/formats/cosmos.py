"""COSMOS: one channel after the other, each with a header of text, whole and real numbers, and comments.

A line before each block of data says how many there are, their unit with its code, and their Fortran format.
Accelerations of volume 1 and 2 are read. Volume 0 is what the digitiser counted.

Source: Consortium of Organizations for Strong-Motion Observation Systems (2001). COSMOS strong motion data format,
version 1.20.
"""

import re
from collections.abc import Sequence

from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import (
    NUMBER,
    build_record,
    even_series,
    read_acceleration_unit,
    read_direction,
    read_peak,
)
from assess.motion.formats._text import (
    LONGEST_TEXT,
    Columns,
    Lines,
    fields,
    read_columns,
    read_fields,
    read_format,
    text_format,
)
from assess.motion.record import Record
from assess.units import ACCELERATION, GRAVITY

TEXT = 13
"""Lines of text."""
UNITS = {2: GRAVITY, 4: 0.01, 7: 0.0254, 10: ACCELERATION["gal"], 11: GRAVITY / 1000}
"""Factor of each code of a unit of acceleration to m/s2."""
HEADER = fields(
    (1, r"(?P<event>.*)"),
    (4, r"^statn\s+no:\s*(?P<number>\S+)\s+code:\s*(?P<code>\S*)\s*(?P<station>.*)"),
    (7, r"^rcrd start time:\s*(?P<start>\S+,?\s*[\d:.]+(?:\s+[A-Z]+\b)?)"),
    (8, r"^sta\s+cha\w*:?\s*(?P<channel>\w+)\s*:\s*(?P<direction>.*?)\s*\(.*?\)\s*(?:location:\s*(?P<location>.*))?"),
    (10, rf"\bmax\s*=\s*(?P<peak>[-+]?{NUMBER})\s*(?P<peak_unit>[^\s,]+)"),
)

# Places in the blocks of numbers, counted from 0; the format's description counts from 1.
STAGE, AZIMUTH = 0, 53
RAW_STEP, STEP = 33, 61
BLOCKS = {"integer": Columns(10, 8), "real": Columns(5, 15)}
"""How the numbers of the header stand where no format is printed."""

_START = re.compile(r"(?P<kind>[^\n(]*)\(format v", re.IGNORECASE)
_WANTED = re.compile(r"^(?!.*spectr).*accel", re.IGNORECASE)
_BLOCK = re.compile(r"\s*(?P<count>\d{1,6})\s+(?P<what>integer|real)[- ]header values", re.IGNORECASE)
_DATA = re.compile(r"\s*(?P<count>\d{1,9})\s+\D.*\bunits\s*=\s*(?P<unit>[^,(]*)\((?P<code>\d{1,4})\)", re.IGNORECASE)


def _choose(channels: list[Lines]) -> list[Lines]:
    found = [_START.match(channel[0]) for channel in channels]
    kinds = [hit["kind"].strip() if hit else "" for hit in found]
    wanted = [channel for channel, kind in zip(channels, kinds, strict=True) if _WANTED.search(kind)]
    if not wanted:
        raise RecordError.about(
            "the file holds {kind}, not accelerations. Give the acceleration file of the same channel",
            kind=kinds[0][:40].lower() or fill("unnamed data"),
        )
    return wanted


def _read_channel(lines: Lines) -> Record:
    numbers: dict[str, Sequence[float]] = {"integer": (), "real": ()}
    for place, line in enumerate(lines.part(0, 10 * TEXT)):
        if found := _BLOCK.match(line):
            what = found["what"].lower()
            numbers[what] = list(read_columns(lines, place + 1, int(found["count"]), read_format(line, BLOCKS[what])))
    integers, reals = numbers["integer"], numbers["real"]
    # Comments may hold any text, but start with "|" and not with a number.
    after = enumerate(lines.part(TEXT), start=TEXT)
    titles = ((place, found) for place, line in after if (found := _DATA.match(line[:LONGEST_TEXT].strip())))
    at, title = next(titles, (0, None))
    if title is None or len(integers) <= AZIMUTH or len(reals) <= STEP:
        raise RecordError.about("the header is incomplete. Get the file again")
    unit, code = title["unit"].strip(), int(title["code"])
    if unit.lower() in {"counts", "count", "volts", "volt", "mvolts"}:
        raise RecordError.about(
            "the file holds raw data in {unit} (volume 0), not accelerations. Give volume 1 or 2 of the same "
            "channel, or convert it to m/s2 and save it as plain CSV",
            unit=unit,
        )
    factor, named = UNITS.get(code), read_acceleration_unit(unit)
    if factor is None or (named is not None and abs(named / factor - 1) > 1e-9):
        raise RecordError.about(
            "the unit {unit!r} with the code {code} is not a known unit of acceleration. Get the file again",
            unit=unit[:20],
            code=code,
        )
    values = read_columns(lines, at + 1, int(title["count"]), read_format(lines.text(at), Columns(8, 10)), factor)
    # The second is that of the data [ms], the first that of the recorder [s]: they differ where data are resampled.
    step = reals[STEP] / 1000 if reals[STEP] > 0 else reals[RAW_STEP]
    header = read_fields(lines, HEADER)
    azimuth, vertical = read_direction(header["direction"])
    if vertical is None and 400 <= integers[AZIMUTH] <= 402:
        azimuth, vertical = None, True
    elif azimuth is None and not vertical and 1 <= integers[AZIMUTH] <= 360:
        azimuth, vertical = integers[AZIMUTH], False
    station = header["code"] or header["number"]
    return build_record(
        even_series(values, step), corrected=integers[STAGE] == 2,
        channel=header["channel"] and (header["channel"].lstrip("0") or "0"), direction=(azimuth, vertical),
        location=header["location"], station=f"{header['station']} ({station})" if station else "",
        event=" ".join(header["event"].split()), start=header["start"],
        header_pfa=read_peak(header["peak"], read_acceleration_unit(header["peak_unit"])),
    )  # fmt: skip


FORMAT = text_format(
    "cosmos",
    "COSMOS",
    recognised=_START,
    starts=_START,
    missing=fill("no line names a version of the COSMOS format"),
    choose=_choose,
    read_channel=_read_channel,
)
