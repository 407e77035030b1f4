"""What the readers of text files share: lines, numbers in columns, units, directions, channels that are left out."""

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from typing import TypeVar

import numpy as np

from assess.errors import RecordError
from assess.language import Text, fill, nfill
from assess.motion.record import MOST_SAMPLES, FloatArray, Record, Series, check_samples, check_time_step
from assess.units import ACCELERATION, GRAVITY, read_unit

T = TypeVar("T")

LONGEST_TEXT = 160
"""Characters kept of a line of a header."""
MOST_LINES = 10_000_000
"""Lines of a file; with one sample to a line there are no more than MOST_SAMPLES of them, and two marks end each."""
MOST_NOTES = 4
"""Notes on single channels that are left out."""
MOST_BEYOND = 0.01
"""Share of the data that may stand beyond the count in the header [-]."""
HEADER_PEAK_WITHIN = 0.02
"""Headers print two to four digits of the peak; a larger difference [-] is noted."""

_MORE_UNITS = {"mm/s2": 0.001, "g/10": GRAVITY / 10, "mg": GRAVITY / 1000, "in/s2": 0.0254}
_FORMAT = re.compile(r"\(\s*(\d{1,3})\s*[EFGI]\s*(\d{1,2})(?:\.\d+)?\s*\)", re.IGNORECASE)
_WORD = re.compile(r"\S+")
_UP = re.compile(r"(up|down|dn|dwn|ver|vert|vertical|v|z|ud|u-d|u)", re.IGNORECASE)
_DEGREES = re.compile(r"(\d{1,3}(?:\.\d*)?)\s*(?:deg\w*\.?|°)?", re.IGNORECASE | re.ASCII)
_QUADRANT = re.compile(r"([NS])\s*(\d{1,2}(?:\.\d*)?)\s*(?:deg\w*\.?|°)?\s*([EW])", re.IGNORECASE | re.ASCII)
_POINTS = {"n": 0.0, "north": 0.0, "ns": 0.0, "n-s": 0.0, "s": 180.0, "south": 180.0,
           "e": 90.0, "east": 90.0, "ew": 90.0, "e-w": 90.0, "w": 270.0, "west": 270.0}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Section:
    """Some lines of a file that belong together; `first` is the place [-] of the first in the file, from 0 on."""

    lines: Sequence[str]
    first: int = 0

    def text(self, place: int) -> str:
        """Return the text of the line at `place`, "" beyond the end."""
        return self.lines[place][:LONGEST_TEXT].strip() if place < len(self.lines) else ""

    def number(self, place: int) -> int:
        """Return the number by which people know the line at `place`, from 1 on."""
        return self.first + place + 1


@dataclass(frozen=True, slots=True)
class Columns:
    """How numbers stand on lines: `per_line` of them, each `width` characters wide."""

    per_line: int
    width: int


def split_lines(data: bytes) -> list[str]:
    """Return the lines of a text file, whichever system it comes from.

    Raises
    ------
    RecordError
        If there are more than any record has.
    """
    if data.count(b"\n") + data.count(b"\r") > MOST_LINES:
        raise RecordError(f"the file has more than {MOST_LINES} lines: cut it to the shaking")
    # Not str.splitlines, which also splits at characters that may stand inside a name.
    return data.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")


def split_sections(lines: Sequence[str], starts: Callable[[str], bool]) -> list[Section]:
    """Cut a file at every line that starts a channel; what stands before the first is left out."""
    places = [place for place, line in enumerate(lines) if starts(line[:LONGEST_TEXT])]
    return [Section(lines[place:end], place) for place, end in pairwise([*places, len(lines)])]


def read_format(text: str, default: Columns) -> Columns:
    """Return the columns that a Fortran format such as (8F10.3) in `text` describes, or else `default`."""
    found = _FORMAT.search(text)
    if not found or not int(found[1]) or not int(found[2]):
        return default
    return Columns(int(found[1]), int(found[2]))


def read_columns(section: Section, start: int, count: int, columns: Columns) -> FloatArray:
    """Return `count` numbers in `columns`, from the section's line at `start` on.

    Raises
    ------
    RecordError
        If there are fewer, or one cannot be read; the message names the line.
    """
    _check_count(count)
    whole = columns.per_line * columns.width
    rows = section.lines[start : start + math.ceil(count / columns.per_line)]
    fields = [row[at : at + columns.width] for row in rows for at in range(0, min(whole, len(row)), columns.width)]
    fields = _trim(fields, count)
    if len(fields) < count:
        raise _cut_short(count, len(fields))
    return _convert(fields, section, start, columns.per_line)


def read_words(section: Section, start: int, count: float) -> tuple[FloatArray, tuple[str, ...]]:
    """Return `count` numbers with blanks between them, and a note on those beyond; see `read_columns`."""
    _check_count(count)
    count = round(count)
    most = count + int(MOST_BEYOND * count)
    # No more than can be used are ever taken: a line may be as long as the file.
    found = (word[0] for line in islice(section.lines, start, None) for word in _WORD.finditer(line))
    words = list(islice(found, most + 1))
    if len(words) < count:
        raise _cut_short(count, len(words))
    if len(words) > most:
        raise RecordError(f"the header announces {count} numbers of data, there are more. Get the file again")
    beyond = len(words) - count
    return _convert(words[:count], section, start, None), note_beyond(beyond, count)


def note_beyond(beyond: int, count: int) -> tuple[Text, ...]:
    """Return a note where there are numbers `beyond` the `count` that the header announces."""
    note = nfill(
        "{n} number beyond the {count} that the header announces: left out",
        "{n} numbers beyond the {count} that the header announces: left out",
        beyond,
        count=count,
    )
    return (note,) if beyond else ()


def scaled(values: FloatArray, factor: float) -> FloatArray:
    """Return `values` times `factor`; what becomes infinite is refused where samples are checked."""
    with np.errstate(over="ignore"):
        return values * factor


def _check_count(count: float) -> None:
    if not 1 <= count <= 2 * MOST_SAMPLES:  # twice: pairs of time and acceleration
        raise RecordError(
            f"the header announces {count:.10g} numbers of data, expected 1 to {2 * MOST_SAMPLES}. Get the file again"
        )


def _trim(fields: list[str], count: int) -> list[str]:
    """Return the first `count` fields, without those at the end that are blank."""
    fields = fields[:count]
    while fields and not fields[-1].strip():
        fields.pop()
    return fields


def _cut_short(announced: int, there: int) -> RecordError:
    return RecordError(
        f"the header announces {announced} numbers of data, there are {there}: cut short. Get the file again"
    )


def _convert(fields: Sequence[str], section: Section, start: int, per_line: int | None) -> FloatArray:
    try:
        return np.array(fields, dtype=np.float64)
    except ValueError:
        place = next((place for place, text in enumerate(fields) if read_real(text) is None), 0)
        text = fields[place].strip()
        what = f"{text[:40]!r} is not a number" if text else "a number is missing"
        where = f"number {place + 1} of the data" if per_line is None else ""
        where = where or f"line {section.number(start + place // (per_line or 1))}"
        raise RecordError(f"{where}: {what}. Get the file again") from None


def read_real(text: str) -> float | None:
    """Return the number that `text` is, None where it is none."""
    try:
        return float(text)
    except ValueError:
        return None


def read_finite(text: str | None) -> float | None:
    """Return the finite number that `text` is, None where it is none."""
    number = read_real(text or "")
    return number if number is not None and math.isfinite(number) else None


def read_acceleration_unit(text: str) -> float | None:
    """Return the factor from the unit that `text` names to m/s2, None where it is no unit of acceleration."""
    spelt = read_unit(text.replace("**", "").replace("^", "")).replace("sec", "s").replace("/s/s", "/s2").strip(".")
    return ACCELERATION.get(spelt, _MORE_UNITS.get(spelt))


def read_direction(text: str) -> tuple[float | None, bool]:
    """Return the azimuth [deg] that `text` names, None where it names none, and whether it names the vertical."""
    text = text.strip()
    if _UP.fullmatch(text):
        return None, True
    quadrant = _QUADRANT.fullmatch(text)
    if quadrant:
        off = float(quadrant[2]) * (1 if quadrant[3].upper() == "E" else -1)
        return (off if quadrant[1].upper() == "N" else 180 - off) % 360, False
    degrees = _DEGREES.fullmatch(text)
    if degrees:
        return (float(degrees[1]) if float(degrees[1]) <= 360 else None), False
    return _POINTS.get(text.lower()), False


def direction_of_code(code: str) -> tuple[float | None, bool]:
    """Return azimuth [deg] and vertical of a SEED channel code (HNE): its last letter."""
    return read_direction(code[-1:]) if code[-1:] in {"N", "E", "Z"} else (None, False)


def even_series(values: FloatArray, time_step: float, notes: Sequence[str] = ()) -> Series:
    """Return samples that the file says are evenly spaced, checked."""
    check_samples(values)
    check_time_step(time_step)
    return Series(float(f"{time_step:.12g}"), values, tuple(notes))


def note_peak(header_pfa: float | None, file_pfa: float) -> tuple[str, ...]:
    """Return a note where the peak printed in the header [m/s2] is not that of the data [m/s2]."""
    if header_pfa is None or abs(header_pfa - file_pfa) <= HEADER_PEAK_WITHIN * file_pfa:
        return ()
    note = fill(
        "the header prints a peak of {printed:.4g} cm/s2, the data have {found:.4g} cm/s2",
        printed=100 * header_pfa,
        found=100 * file_pfa,
    )
    return (note,)


def read_sections(sections: Iterable[Section], read: Callable[[Section], Record]) -> tuple[Record, ...]:
    """Read every channel that can be read, each from its section of the file; see `keep_readable`."""
    return keep_readable(
        ((fill("channel {number}", number=number), section) for number, section in enumerate(sections, start=1)), read
    )


def keep_readable(parts: Iterable[tuple[str, T]], read: Callable[[T], Record]) -> tuple[Record, ...]:
    """Read every named part that can be read; what is the matter with the others is noted on those.

    Raises
    ------
    RecordError
        If none can be read.
    """
    records, reasons = [], []
    for name, part in parts:
        try:
            records.append(read(part))
        except RecordError as error:
            reasons.append((name, str(error)))
    if not records and len(reasons) == 1:
        raise RecordError(reasons[0][1])
    if not records:
        listed = "; ".join(f"{name}: {reason}" for name, reason in reasons[:MOST_NOTES])
        raise RecordError(f"none of its {len(reasons)} channels can be read: {listed}")
    notes = [
        fill("{part} of the file is left out: {reason}", part=name, reason=reason)
        for name, reason in reasons[:MOST_NOTES]
    ]
    if len(reasons) > MOST_NOTES:
        notes.append(fill("{count} more channels of the file are left out", count=len(reasons) - MOST_NOTES))
    return tuple(replace(record, notes=(*record.notes, *notes)) for record in records)
