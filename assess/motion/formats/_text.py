"""The reader that all text formats share.

A format states where the fields of its header stand (`fields`: lines, and a pattern with a named group for each field)
and how its data are laid out (`Columns`, or words with blanks between them); `text_format` makes the format of it.
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import Text, fill, nfill
from assess.motion.formats._format import MOST_CHANNELS, Format, check_channels, keep_readable, read_real
from assess.motion.record import MOST_SAMPLES, Record
from assess.progress import check_waits
from assess.text import with_line_feeds

LONGEST_TEXT = 160
"""Characters kept of a line of a header."""
MOST_LINES = 10_000_000
"""Lines of a file; with one sample to a line there are no more than MOST_SAMPLES of them, and two marks end each."""
AT_ONCE = 100_000
"""Numbers that are converted between two looks at whether to stop."""
BLOCK = 2**20
"""Bytes in which the ends of lines are looked for at once."""
MOST_BEYOND = 0.01
"""Share of the data that may stand beyond the count in the header [-]."""

_FORMAT = re.compile(r"\(\s*(\d{1,3})\s*[EFGI]\s*(\d{1,2})(?:\.\d+)?\s*\)", re.IGNORECASE)
_WORD = re.compile(r"\S+")


@dataclass(frozen=True, slots=True)
class Columns:
    """How numbers stand on lines: `per_line` of them, each `width` characters wide."""

    per_line: int
    width: int


class Lines:
    """Lines of a file that belong together, each decoded (Latin-1) when asked for: objects take ten times their bytes.

    * `data`: the text of the file, whose lines end with a line feed.
    * `ends` (n,): the place of the end of each line [bytes].
    * `first`: the place of the first line [bytes].
    * `before`: lines of the file before them [-].
    """

    def __init__(self, data: bytes, ends: NDArray[np.int32], first: int = 0, before: int = 0) -> None:
        self._data, self._ends, self._first, self._before = data, ends, first, before

    def __len__(self) -> int:
        return len(self._ends)

    def __iter__(self) -> Iterator[str]:
        start = self._first
        for at in range(0, len(self), AT_ONCE):
            for end in self._ends[at : at + AT_ONCE].tolist():
                yield self._data[start:end].decode("latin-1")
                start = end + 1

    def __getitem__(self, place: int) -> str:
        return self._data[self._start(place) : int(self._ends[place])].decode("latin-1")

    def part(self, start: int, stop: int | None = None) -> "Lines":
        """Return those from one place to before another, or to the end."""
        start = min(start, len(self))
        return Lines(self._data, self._ends[start:stop], self._start(start), self._before + start)

    def _start(self, at: int) -> int:
        return int(self._ends[at - 1]) + 1 if at else self._first

    def text(self, place: int) -> str:
        """Return the text of the line at `place`, "" beyond the end."""
        return self[place][:LONGEST_TEXT].strip() if place < len(self) else ""

    def number(self, place: int) -> int:
        """Return the number by which people know the line at `place`, from 1 on."""
        return self._before + place + 1

    @property
    def lengths(self) -> NDArray[np.int32]:
        """Characters of each line, (n,)."""
        return np.diff(self._ends, prepend=np.int32(self._first - 1)) - np.int32(1)

    def cut(self, columns: Columns, *, is_whole: bool = False) -> "Iterator[Cells]":
        """Yield the cells of all lines, a block at a time; those beyond the end of a line only if `is_whole`."""
        within = np.arange(columns.per_line * columns.width)
        whole = BLOCK // within.size + 1
        text = np.frombuffer(self._data, np.uint8)
        for at in range(0, len(self), whole):
            part = self.part(at, at + whole)
            lengths = part.lengths[:, None]
            places = (part._ends[:, None] - lengths) + within
            characters = np.where(within < lengths, text[np.minimum(places, text.size - 1)], np.uint8(ord(" ")))
            cells = characters.reshape(len(part), columns.per_line, columns.width)
            yield cells.reshape(-1, columns.width) if is_whole else cells[within[:: columns.width] < lengths]


Cells = NDArray[np.uint8]
"""The characters of cells (n, width), blanks beyond the end of a line."""
_IS_BLANK = np.array([chr(code).isspace() for code in range(256)])


def has_text(cells: Cells) -> NDArray[np.bool_]:
    """Return which cells hold more than blanks, (n,)."""
    return np.asarray(~_IS_BLANK[cells].all(axis=1))


def _split_lines(data: bytes) -> Lines:
    if data.count(b"\n") + data.count(b"\r") > MOST_LINES:
        raise RecordError.about("the file has more than {most:,} lines: cut it to the shaking", most=MOST_LINES)
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    signs = np.frombuffer(text, dtype=np.uint8)
    ends = [at + np.flatnonzero(signs[at : at + BLOCK] == ord("\n")) for at in range(0, len(text), BLOCK)]
    open_end = [np.array([len(text)])] if not text.endswith(b"\n") else []
    return Lines(text, np.concatenate([one.astype(np.int32) for one in (*ends, *open_end)]))


def text_format(
    key: str,
    title: str,
    *,
    recognised: re.Pattern[str],
    read_channel: Callable[[Lines], Record],
    starts: re.Pattern[str] | None = None,
    missing: str = "",
    choose: Callable[[list[Lines]], list[Lines]] = list,
) -> Format:
    """Return the format of a text file.

    * `recognised`: matches the beginning of a file, whose lines end with a line feed here.
    * `starts`: matches the first line of each channel; what stands before the first is left out. None where a file has
      one channel.
    * `missing`: what is wrong with a file that has no such line.
    * `choose`: returns the channels that are to be read; raises RecordError where there are none.
    """

    def parse(data: bytes) -> tuple[Record, ...]:
        lines = _split_lines(data)
        if starts is None:
            return (read_channel(lines),)
        found = (place for place, line in enumerate(lines) if starts.match(line[:LONGEST_TEXT]))
        places = list(islice(found, MOST_CHANNELS + 1))
        if not places:
            raise RecordError.about("{what}. Get the file again", what=missing)
        check_channels(len(places))
        channels = choose([lines.part(place, end) for place, end in pairwise([*places, len(lines)])])
        numbered = ((fill("channel {number}", number=number), one) for number, one in enumerate(channels, start=1))
        return keep_readable(numbered, read_channel)

    return Format(
        key=key, title=title,
        recognises=lambda head: recognised.match(with_line_feeds(head.decode("latin-1"))) is not None, parse=parse,
    )  # fmt: skip


Fields = Sequence[tuple[range, re.Pattern[str]]]
"""Lines of a header, counted from 0, and the pattern whose named groups are fields of it."""


def fields(*rows: tuple[int | range, str]) -> Fields:
    """Return a table of fields: the line, or the lines of which the first that matches counts, and the pattern."""
    return [
        (lines if isinstance(lines, range) else range(lines, lines + 1), re.compile(pattern, re.IGNORECASE))
        for lines, pattern in rows
    ]


def read_fields(lines: Lines, table: Fields, first: int = 0) -> dict[str, str]:
    """Return the fields of a header whose lines are counted from `first` on; "" for a field that is not there."""
    header: dict[str, str] = {}
    for places, pattern in table:
        hits = (pattern.search(lines.text(first + place)) for place in places)
        hit = next((hit for hit in hits if hit), None)
        header |= {name: ((hit[name] or "") if hit else "").strip() for name in pattern.groupindex}
    return header


def read_format(text: str, default: Columns) -> Columns:
    """Return the columns that a Fortran format such as (8F10.3) in `text` describes, or else `default`."""
    found = _FORMAT.search(text)
    if not found or not int(found[1]) or not int(found[2]):
        return default
    return Columns(int(found[1]), int(found[2]))


def read_columns(lines: Lines, start: int, count: int, columns: Columns, factor: float = 1.0) -> FloatArray:
    """Return `count` numbers in columns, from a line on, times `factor`; RecordError if one is missing or no number."""
    _check_count(count)
    rows = lines.part(start, start + math.ceil(count / columns.per_line))
    filled = [has_text(cells) for cells in rows.cut(columns)]
    there = int(np.flatnonzero(np.concatenate([*filled, [False]])[:count]).max(initial=-1)) + 1
    compare_counts(count, there)
    return convert(rows.cut(columns), count, rows, columns.per_line, factor)


def read_words(lines: Lines, start: int, count: float, factor: float) -> tuple[FloatArray, tuple[str, ...]]:
    """Return `count` numbers with blanks between them times `factor`, and a note on those beyond, as `read_columns`."""
    _check_count(count)
    count, rows = round(count), lines.part(start)
    # No more than can be used are ever taken: a line may be as long as the file.
    there = sum(1 for _ in islice(_find_words(rows), count + int(MOST_BEYOND * count) + 1))
    notes = compare_counts(count, there)
    words = iter(_find_words(rows))
    blocks = iter(lambda: list(islice(words, AT_ONCE)), [])
    return convert(blocks, count, rows, None, factor), notes


def _find_words(lines: Lines) -> Iterator[str]:
    return (word[0] for line in lines for word in _WORD.finditer(line))


def _check_count(count: float) -> None:
    if not 1 <= count <= 2 * MOST_SAMPLES:  # twice: pairs of time and acceleration
        raise RecordError.about(
            "the header announces {count:.10g} data values, expected 1 to {most:,}. Get the file again",
            count=count,
            most=2 * MOST_SAMPLES,
        )


def compare_counts(announced: int, there: int) -> tuple[Text, ...]:
    """Return a note where there are more numbers than the header announces; RecordError if fewer, or many more."""
    beyond = there - announced
    if beyond < 0:
        raise RecordError.about(
            "the file is cut short: it has {there} of the {announced} data values that its header announces. Get "
            "the file again",
            there=there,
            announced=announced,
        )
    if beyond > MOST_BEYOND * announced:
        raise RecordError.about(
            "the file has more data values than the {announced} that its header announces. Get the file again",
            announced=announced,
        )
    note = nfill(
        "{n} number beyond the {count} that the header announces: left out",
        "{n} numbers beyond the {count} that the header announces: left out",
        beyond,
        count=announced,
    )
    return (note,) if beyond else ()


def convert(
    blocks: Iterable[Cells | list[str]], count: int, lines: Lines, per_line: int | None, factor: float = 1.0
) -> FloatArray:
    """Return the first `count` cells or words of some lines as numbers times `factor`.

    `per_line` is None where lines do not count. A RecordError names the line or the place of what is no number.
    """
    values, done = np.empty(count), 0
    for block in blocks:
        here = block[: count - done]
        check_waits()  # numpy holds the interpreter's lock while it converts
        try:
            # numpy cuts zeros off bytes, and knows no blanks beyond ASCII
            if not isinstance(here, list) and here.all() and here.max(initial=0) < 128:
                texts: ArrayLike = np.ascontiguousarray(here).view(f"S{here.shape[1]}").ravel()
            else:
                texts = here if isinstance(here, list) else decode(here)
            values[done : done + len(here)] = np.asarray(texts, dtype=np.float64)
        except ValueError:
            words = here if isinstance(here, list) else decode(here)
            place = next((place for place, text in enumerate(words) if read_real(text) is None), 0)
            text, number = words[place].strip(), done + place
            what = fill("{text!r} is not a number", text=text[:40]) if text else fill("a number is missing")
            where = fill("number {number} of the data", number=number + 1)
            if per_line is not None:
                where = fill("line {line}", line=lines.number(number // per_line))
            raise RecordError.about("{where}: {what}. Get the file again", where=where, what=what) from None
        done += len(here)
        if done == count:
            break
    with np.errstate(over="ignore"):  # what becomes infinite is refused where samples are checked
        values *= factor
    return values


def decode(cells: Cells) -> list[str]:
    """Return the texts of cells."""
    return [cell.tobytes().decode("latin-1") for cell in cells]
