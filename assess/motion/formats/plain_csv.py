"""Plain CSV: what anyone can write from a spreadsheet.

    # station: Town hall
    # azimuth: north=0, east=90
    time [s], north [cm/s2], east [cm/s2], up [cm/s2]
    0.000, 0.12, -0.31, 0.05

Comments come first, then the row of headings. The bracket is the unit; what stands before it is the channel's name.
Cells are separated by commas, semicolons or tabs; with the last two, numbers may have a decimal comma.
"""

import io
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import (
    MOST_CHANNELS,
    MOST_VALUES,
    UNKNOWN,
    Direction,
    Format,
    build_record,
    check_channels,
    read_direction,
    too_many_values,
)
from assess.motion.record import MOST_SAMPLES, Record, build_series
from assess.progress import check_waits
from assess.text import split_text
from assess.units import ACCELERATION, TIME, read_unit

KEYS = ("station", "event", "start", "location", "azimuth", "corrected")
BLOCK = 2**20
"""Bytes that are read at once."""
CHECKED_EVERY = 10_000  # lines
MOST_HEAD = 2**19
"""Bytes of the comments and headings: a thousand for each channel."""

_ANSWERS = {"yes": True, "true": True, "no": False, "false": False, "": False}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)
_PLAIN = b'0123456789+-.eE,; \t\n"'
"""With no other signs than these, numpy takes what _NUMBER takes."""
_LINE_END = re.compile(rb"\r\n?|\n")


@dataclass(frozen=True, slots=True)
class _Table:
    """What a file says of its samples, and where they begin: the byte, and the line [-], counted from 1.

    `columns` are the factors to m/s2 by the names of the channels.
    """

    comments: Mapping[str, str]
    columns: Mapping[str, float]
    separator: str
    start: int
    first: int


def recognises(head: bytes) -> bool:
    """Return whether the first line of `head` that is no comment starts with a heading for time."""
    # UTF-16 and binary files have zeros; text has none.
    if b"\0" in head:
        return False
    lines = (line for line in split_text(decode(head)) if not (is_comment(line) or _is_blank(line)))
    first = re.split(r"[,;\t]", next(lines, ""), maxsplit=1)[0].strip(' \t"').lower()
    return first.startswith("time") and first[4:].lstrip()[:1] in {"", "["}


def parse(data: bytes) -> tuple[Record, ...]:
    """Read every channel; a RecordError names the line of a heading without a unit, or of a cell that is no number."""
    table = _read_head(data)
    values = _read_values(data, table)
    directions, comments = _read_directions(table), table.comments
    answer = comments.get("corrected", "").lower()
    unknown = ", ".join(repr(key[:40]) for key in comments if key not in KEYS)
    note = fill("comments that are not used: {names} (known: {known})", names=unknown, known=", ".join(KEYS))
    times, records = values.pop(0), []
    for name, factor in table.columns.items():
        with np.errstate(over="ignore"):  # what becomes infinite is refused further on
            own = values.pop(0) * factor
        try:
            series = build_series(times, own)
        except RecordError as error:
            raise RecordError.about("channel {name!r}: {why}", name=name, why=error.message) from None
        if answer not in _ANSWERS:
            raise RecordError.about("corrected is {text!r}, expected yes or no", text=answer[:40])
        record = build_record(
            replace(series, notes=(*((note,) if unknown else ()), *series.notes)), own=own,
            corrected=_ANSWERS[answer], channel=name, direction=directions[name],
            location=comments.get("location", ""), station=comments.get("station", ""),
            event=comments.get("event", ""), start=comments.get("start", ""),
        )  # fmt: skip
        records.append(record)
    return tuple(records)


def decode(data: bytes) -> str:
    """Return the text of a file in UTF-8, with or without a mark, else in Latin-1."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def is_comment(line: str) -> bool:
    """Whether a line is a comment."""
    # A spreadsheet puts a comment that holds commas into quotes.
    return line.lstrip(' \t"').startswith("#")


def _is_blank(line: str) -> bool:
    return all(mark in ',;"' or mark.isspace() for mark in line)


def _read_head(data: bytes) -> _Table:
    head, start, number = data[:MOST_HEAD], 0, 1
    for end in _LINE_END.finditer(head if len(data) > MOST_HEAD else head + b"\n"):
        own = decode(head[start : end.start()])
        start = end.end()
        if not (is_comment(own) or _is_blank(own)):
            break
        number += 1
    else:
        if len(data) > MOST_HEAD:
            raise _too_long(number)
        raise RecordError.about("there is no row of headings. Add one, such as: time [s], north [cm/s2]")
    lines = split_text(decode(head[: end.start()]))
    separator = next((mark for mark in "\t;" if mark in lines[-1]), ",")
    headings, line = _cells(lines[-1], separator), len(lines)
    check_channels(len(headings) - 1)
    if _take_unit(headings[0])[1] not in TIME:
        raise RecordError.about(
            "line {line}: {heading!r} needs its unit, seconds: time [s]", line=line, heading=headings[0][:80]
        )
    found = []
    for heading in headings[1:]:
        name, unit = _take_unit(heading)
        if unit not in ACCELERATION:
            raise RecordError.about(
                "line {line}: {heading!r} has no known unit of acceleration (known: {units}). Write it in brackets: "
                "{name} [cm/s2]",
                line=line, heading=heading[:80], units=", ".join(ACCELERATION), name=name[:60],
            )  # fmt: skip
        found.append((name or "acceleration", ACCELERATION[unit]))
    names = [name.casefold() for name, _ in found]
    twice = next((name for name, _ in found if names.count(name.casefold()) > 1), None)
    if twice is not None:
        raise RecordError.about(
            "line {line}: two channels are called {name!r}. Give each its own name", line=line, name=twice[:80]
        )
    if not found:
        raise RecordError.about(
            "line {line}: there is no channel next to time. Add one, such as: north [cm/s2]", line=line
        )
    comments = {}
    for text in lines[:-1]:
        key, colon, value = text.strip(' \t"').lstrip("#").partition(":")
        if colon:
            comments[key.strip().lower()] = value.strip(' \t,;"')
    return _Table(comments, dict(found), separator, start, line + 1)


def _too_long(line: int) -> RecordError:
    return RecordError.about(
        "line {line} has more than {most} channels, or the end of the line is missing: give a file with the "
        "channels that are needed, one row to a line",
        line=line,
        most=MOST_CHANNELS,
    )


def _cells(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without the empty ones that spreadsheets leave at its end."""
    cells = [cell.strip().strip('"').strip() for cell in line.split(separator)]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _take_unit(heading: str) -> tuple[str, str]:
    """Split ``name [unit]``; the unit is "" where there are no brackets."""
    name, bracket, unit = heading.rpartition("[")
    if not bracket or not unit.endswith("]"):
        return heading, ""
    return name.strip(), read_unit(unit.removesuffix("]"))


def _read_values(data: bytes, table: _Table) -> list[FloatArray]:
    """Return the numbers below the headings, (n,) for time and for each channel; read block by block."""
    columns: list[list[FloatArray]] = [[] for _ in range(1 + len(table.columns))]
    rows, start, line = 0, table.start, table.first
    while start < len(data):
        end = min(start + BLOCK, len(data))
        if end < len(data):
            # A carriage return at the very end may belong to a line feed.
            end = data.rfind(b"\n", start, end) + 1 or data.rfind(b"\r", start, end - 1) + 1
        if not end:
            raise _too_long(line)
        block = data[start:end].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        numbers = _read_block(block, table, line)
        start, line = end, line + block.count(b"\n")
        rows += len(numbers)
        if rows > MOST_SAMPLES:
            raise RecordError.about("the file has more than {most:,} rows: cut it to the shaking", most=MOST_SAMPLES)
        if rows * len(columns) > MOST_VALUES:
            raise too_many_values()
        for column, own in zip(columns, numbers.T, strict=True):
            column.append(own.copy())
    if not rows:
        raise RecordError.about("there are no rows below the headings. Add the samples")
    whole = []
    while columns:  # each is let go as it is joined
        whole.append(np.concatenate(columns.pop(0)))
    return whole


def _read_block(block: bytes, table: _Table, first: int) -> FloatArray:
    """Return the numbers of some lines (n, columns), of which `first` is the number of the first."""
    check_waits()
    separator, width = table.separator, 1 + len(table.columns)
    if not block.translate(None, _PLAIN):
        marked = block if separator == "," else block.replace(b",", b".")
        whole = re.sub(rb"[ \t%s]+(?=\n|\Z)" % separator.encode(), b"", marked)  # spreadsheets leave cells at the end
        try:
            if whole.strip():
                found = np.loadtxt(io.BytesIO(whole), delimiter=separator, comments=None, quotechar='"', ndmin=2)
                if found.shape[1] == width:
                    return np.asarray(found, np.float64)
        except ValueError:
            pass
    numbers: list[float] = []
    for line, text in enumerate(map(decode, block.removesuffix(b"\n").split(b"\n")), start=first):
        if line % CHECKED_EVERY == 0:
            check_waits()
        if is_comment(text) or _is_blank(text):
            continue
        cells = _cells(text, separator)
        if len(cells) != width:
            raise RecordError.about(
                "line {line}: the number of cells is {cells}, but there are {headings} headings",
                line=line, cells=len(cells), headings=width,
            )  # fmt: skip
        for cell in cells:
            number = cell if separator == "," else cell.replace(",", ".")
            if not _NUMBER.fullmatch(number):
                raise RecordError.about("line {line}: {text!r} is not a number", line=line, text=cell[:40])
            numbers.append(float(number))
    return np.array(numbers).reshape(-1, width)


def _read_directions(table: _Table) -> dict[str, Direction]:
    """Return for each channel its direction: that of the comments, else what its name tells."""
    given = {name.casefold(): name for name in table.columns}
    directions = {name: read_direction(name, bare_degrees=False) for name in table.columns}
    parts = [part for part in re.split("[,;]", table.comments.get("azimuth", "")) if part.strip()]
    for part in parts:
        name, equals, value = part.rpartition("=")
        if len(parts) > 1 and not equals:
            raise RecordError.about(
                "several azimuths need the names of their channels, such as: # azimuth: north=0, east=90"
            )
        if equals and name.strip().casefold() not in given:
            raise RecordError.about(
                "an azimuth is given for {name!r}, but the channels are: {names}",
                name=name.strip()[:80],
                names=", ".join(directions),
            )
        text = value.strip()
        number = text.lower().removesuffix("deg").removesuffix("°").strip()
        if _NUMBER.fullmatch(number) and 0 <= float(number) <= 360:
            found: Direction = float(number), False
        else:
            found = read_direction(text, bare_degrees=False)
        if found == UNKNOWN:
            raise RecordError.about(
                "the azimuth is {text!r}, expected 0 to 360 degrees clockwise from north, or up", text=text[:40]
            )
        directions |= dict.fromkeys([given[name.strip().casefold()]] if equals else directions, found)
    return directions


FORMAT = Format("csv", "plain CSV", recognises=recognises, parse=parse)
