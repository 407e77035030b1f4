"""COSMOS: one channel after the other, each with a header of text, whole and real numbers, and comments.

A line before each block of data says how many there are, their unit with its code, and their Fortran format.
Accelerations of volume 1 and 2 are read. Volume 0 is what the digitiser counted.

Source: Consortium of Organizations for Strong-Motion Observation Systems (2001). COSMOS strong motion data format,
version 1.20.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._direction import Direction, read_direction
from assess.motion.formats._format import build_record, even_series
from assess.motion.formats._text import (
    LONGEST_TEXT,
    Columns,
    Section,
    fields,
    read_columns,
    read_fields,
    read_format,
    text_format,
)
from assess.motion.formats._values import NUMBER, read_acceleration_unit, read_peak
from assess.motion.record import Record, Series
from assess.units import ACCELERATION, GRAVITY

TITLE = "COSMOS"

TEXT = 13
"""Lines of text."""
UNITS = {2: GRAVITY, 4: 0.01, 7: 0.0254, 10: ACCELERATION["gal"], 11: GRAVITY / 1000}
"""Factor of each code of a unit of acceleration to m/s2."""
HEADER = fields(
    (1, r"(?P<event>.*)"),
    (4, r"^statn\s+no:\s*(?P<number>\S+)\s+code:\s*(?P<code>\S*)\s*(?P<station>.*)"),
    (7, r"^rcrd start time:\s*(?P<start>\S+,?\s*[\d:.]+(?:\s+[A-Z]+\b)?)"),
    (
        8,
        r"^sta\s+cha\w*:?\s*(?P<channel>\w+)\s*:\s*(?P<direction>.*?)\s*\(.*?\)\s*(?:location:\s*(?P<location>.*))?",
    ),
    (10, rf"\bmax\s*=\s*(?P<peak>[-+]?{NUMBER})\s*(?P<peak_unit>[^\s,]+)"),
)

# Places in the blocks of numbers, counted from 0; the format's description counts from 1.
STAGE, AZIMUTH = 0, 53
RAW_STEP, STEP = 33, 61
CORRECTED = 2
BLOCKS = {"integer": Columns(10, 8), "real": Columns(5, 15)}
"""How the numbers of the header stand where no format is printed."""

_START = re.compile(r"(?P<kind>[^\n(]*)\(format v", re.IGNORECASE)
_WANTED = re.compile(r"^(?!.*spectr).*accel", re.IGNORECASE)
_BLOCK = re.compile(r"\s*(?P<count>\d{1,6})\s+(?P<what>integer|real)[- ]header values", re.IGNORECASE)
_DATA = re.compile(r"\s*(?P<count>\d{1,9})\s+\D.*\bunits\s*=\s*(?P<unit>[^,(]*)\((?P<code>\d{1,4})\)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class _Numbers:
    """The numbers of one channel's header; `data` is the place [-] of the line before its data, None without one."""

    integers: Sequence[float]
    reals: Sequence[float]
    data: int | None


def _choose(sections: list[Section]) -> list[Section]:
    found = [_START.match(section.lines[0]) for section in sections]
    kinds = [hit["kind"].strip() if hit else "" for hit in found]
    wanted = [section for section, kind in zip(sections, kinds, strict=True) if _WANTED.search(kind)]
    if not wanted:
        raise RecordError.about(
            "the file holds {kind}, not accelerations. Give the acceleration file of the same channel",
            kind=kinds[0][:40].lower() or fill("unnamed data"),
        )
    return wanted


def _read_numbers(section: Section) -> _Numbers:
    numbers: dict[str, Sequence[float]] = {"integer": (), "real": ()}
    for place, line in enumerate(section.lines[: 10 * TEXT]):
        found = _BLOCK.match(line)
        if found:
            what = found["what"].lower()
            columns = read_format(line, BLOCKS[what])
            numbers[what] = list(read_columns(section, place + 1, int(found["count"]), columns))
    # Comments may hold any text, but start with "|" and not with a number.
    after = enumerate(section.lines[TEXT:], start=TEXT)
    data = next((place for place, line in after if _DATA.match(line[:LONGEST_TEXT].strip())), None)
    return _Numbers(numbers["integer"], numbers["real"], data)


def _read_data(section: Section, header: _Numbers) -> Series:
    title = section.text(header.data or 0)
    found = _DATA.match(title)
    if header.data is None or found is None or len(header.integers) <= AZIMUTH or len(header.reals) <= STEP:
        raise RecordError.about("the header is incomplete. Get the file again")
    factor = _factor(found["unit"].strip(), int(found["code"]))
    columns = read_format(title, Columns(8, 10))
    values = read_columns(section, header.data + 1, int(found["count"]), columns, factor)
    # The second is that of the data [ms], the first that of the recorder [s]: they differ where data are resampled.
    step = header.reals[STEP] / 1000 if header.reals[STEP] > 0 else header.reals[RAW_STEP]
    return even_series(values, step)


def _read_channel(section: Section, file: str) -> Record:
    numbers = _read_numbers(section)
    series = _read_data(section, numbers)
    header = read_fields(section, HEADER)
    code = header["code"] or header["number"]
    return build_record(
        TITLE,
        file,
        series,
        corrected=numbers.integers[STAGE] == CORRECTED,
        channel=header["channel"] and (header["channel"].lstrip("0") or "0"),
        direction=_read_direction(header, numbers.integers[AZIMUTH]),
        location=header["location"],
        station=f"{header['station']} ({code})" if code else "",
        event=" ".join(header["event"].split()),
        start=header["start"],
        header_pfa=read_peak(header["peak"], read_acceleration_unit(header["peak_unit"])),
    )


def _factor(unit: str, code: int) -> float:
    if unit.lower() in {"counts", "count", "volts", "volt", "mvolts"}:
        raise RecordError.about(
            "the file holds raw data in {unit} (volume 0), not accelerations. Give volume 1 or 2 of the same "
            "channel, or convert it to m/s2 and save it as plain CSV",
            unit=unit,
        )
    factor = UNITS.get(code)
    named = read_acceleration_unit(unit)
    if factor is None or (named is not None and abs(named / factor - 1) > 1e-9):
        raise RecordError.about(
            "the unit {unit!r} with the code {code} is not a known unit of acceleration. Get the file again",
            unit=unit[:20],
            code=code,
        )
    return factor


def _read_direction(header: Mapping[str, str], code: float) -> Direction:
    azimuth, vertical = read_direction(header["direction"])
    if vertical is None and 400 <= code <= 402:
        return None, True
    if azimuth is None and not vertical and 1 <= code <= 360:
        return code, False
    return azimuth, vertical


FORMAT = text_format(
    "cosmos",
    TITLE,
    recognised=_START,
    starts=_START,
    missing=fill("no line names a version of the COSMOS format"),
    choose=_choose,
    read_channel=_read_channel,
)
