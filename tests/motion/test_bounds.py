"""Files made to take time or memory: bounded, whatever the format."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from assess.errors import RecordError
from assess.motion.formats import _format, parse_records, plain_csv, read_records
from assess.motion.formats._format import MOST_CHANNELS, MOST_VALUES
from assess.motion.formats._text import MOST_LINES
from assess.motion.formats.miniseed import MOST_PARTS
from assess.motion.record import MOST_SAMPLES
from tests.apart import run_apart
from tests.motion.writers import EAST, Signal, at2, csmip_v1, csmip_v2, mseed, sac, wave, zipped
from tests.waiting import PATIENCE

OWN_MEMORY, MOST_MEMORY = 90, 400
"""MB at the peak: what Python, the libraries and a block of a file take, and all in all."""
LARGE = 63_900_000
"""Bytes: the largest file that is read has 64 MB."""
SIZES = [pytest.param(8, marks=pytest.mark.slow), pytest.param(1, marks=pytest.mark.long)]
"""An eighth of the size, of every limit and of the memory; and the whole."""

_CHILD = """
import sys
from pathlib import Path
from assess.motion.formats import _text, miniseed, plain_csv, read_records
from assess.errors import RecordError
for module in [module for name, module in sys.modules.items() if name.startswith("assess.motion.")]:
    for limit in ("LARGEST_FILE", "MOST_SAMPLES", "MOST_VALUES", "MOST_LINES", "MOST_PARTS"):
        if hasattr(module, limit):
            setattr(module, limit, getattr(module, limit) // SMALLER)
try:
    print(sum(record.acceleration.size for record in read_records(Path(sys.argv[1]))), "samples")
except RecordError as error:
    print(error)
"""


def read_apart(folder: Path, data: bytes, smaller: int) -> str:
    """Read a file in a process of its own; return what it says, having checked how much memory it took.

    There the limits of a file are `smaller` times as small, and so is what may be taken for it.
    """
    (folder / "large").write_bytes(data)
    most = OWN_MEMORY + (MOST_MEMORY - OWN_MEMORY) / smaller
    try:
        return run_apart(f"SMALLER = {smaller}{_CHILD}", folder / "large", most_memory=most, seconds=2 * PATIENCE)
    finally:
        (folder / "large").unlink()


Build = Callable[[int], bytes]
"""Builds a file, so many times smaller than the largest."""


# --- plain CSV ---


def many_rows(smaller: int, channels: int, cell: str = "-0.12345", end: str = "\n") -> bytes:
    head = "time [s]," + ",".join(f"c{number} [cm/s2]" for number in range(channels)) + end
    # Two values, or every sample would be alike.
    rows = ["," + ",".join([cell] * channels) + end, "," + ",".join(["0.12345"[: len(cell)]] * channels) + end]
    count = min((LARGE // smaller - len(head)) // (len(rows[0]) + 8), MOST_SAMPLES // smaller)
    return (head + "".join(f"{row * 0.005:.3f}{rows[row % 2]}" for row in range(count))).encode()


def quoted_rows(smaller: int) -> bytes:
    quoted = many_rows(smaller, 3).replace(b",", b'","').replace(b"\n", b'"\n"')
    return quoted[: LARGE // smaller].rpartition(b"\n")[0]


TABLES: dict[str, tuple[Build, str]] = {
    "a channel": (lambda smaller: many_rows(smaller, 1), "samples"),
    "empty columns": (lambda smaller: many_rows(smaller, 3, end=",,,\r\n"), "samples"),
    "most channels": (lambda smaller: many_rows(smaller, MOST_CHANNELS), "samples"),
    "quoted": (quoted_rows, "samples"),
    "samples": (lambda smaller: many_rows(smaller, MOST_CHANNELS, "1"), "the file has more than {:,} samples"),
    "rows": (lambda smaller: b"time [s],a [g]\n" + b"1,2\n" * (LARGE // smaller // 4 - 10),
             "the file has more than {:,} rows"),
    "a line": (lambda smaller: b"time [s],a [g]\n" + b"#" * (LARGE // smaller - 100),
               "line 2 has more than 500 channels, or the end"),
    "no table": (lambda smaller: b"#" * (LARGE // smaller - 100), "the file format is not supported"),
}  # fmt: skip
LIMITS = {"samples": MOST_VALUES, "rows": MOST_SAMPLES}
"""What is named where a file goes beyond it."""


@pytest.mark.parametrize("smaller", SIZES)
@pytest.mark.parametrize("name", TABLES)
def test_the_largest_csv(tmp_path: Path, name: str, smaller: int) -> None:
    build, said = TABLES[name]
    assert said.format(LIMITS.get(name, 0) // smaller) in read_apart(tmp_path, build(smaller), smaller)


def test_a_million_channels_are_refused_at_the_headings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_csv, "_take_unit", pytest.fail)  # no heading is looked at
    for count in (MOST_CHANNELS + 1, 40_000):
        head = "time [s]," + ",".join(["c [g]"] * count) + "\n"
        with pytest.raises(RecordError, match=r"the file has more than 500 channels: give a file with those that are"):
            parse_records(head.encode(), "wide.csv")
    head = "time [s]," + ",".join(["c [g]"] * 1_000_000) + "\n"
    with pytest.raises(RecordError) as caught:
        parse_records(head.encode(), "wide.csv")
    assert str(caught.value) == (
        "wide.csv: line 1 has more than 500 channels, or the end of the line is missing: give a file with the channels "
        "that are needed, one row to a line"
    )


def test_blocks_are_joined_without_a_seam(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [f"{row / 100:.2f},{row % 7}" for row in range(500)]
    for end in ("\n", "\r\n", "\r"):
        text = end.join(["# station: Süd", "time [s],a [g]", *rows[:200], "", "# between", *rows[200:]])
        monkeypatch.undo()
        (whole,) = parse_records(text.encode(), "a.csv")
        assert (whole.acceleration.size, whole.station) == (500, "Süd")
        for block in (40, 41, 42, 43, 97):
            monkeypatch.setattr(plain_csv, "BLOCK", block)
            (one,) = parse_records(text.encode(), "a.csv")
            assert (one.acceleration == whole.acceleration).all()
            with pytest.raises(RecordError, match=r"line 505: '1x' is not a number"):
                parse_records(f"{text}{end}9.99,1x".encode(), "a.csv")


def test_no_more_than_a_block_is_taken_apart_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes, real = [], plain_csv._read_block

    def measured(block: bytes, *more: Any) -> Any:
        sizes.append(len(block))
        return real(block, *more)

    monkeypatch.setattr(plain_csv, "BLOCK", 1000)
    monkeypatch.setattr(plain_csv, "_read_block", measured)
    text = "time [s],a [g]\n" + "\n".join(f"{row / 100:.2f},{row % 7}" for row in range(5000))
    parse_records(text.encode(), "a.csv")
    assert max(sizes) <= 1000
    assert len(sizes) >= len(text) // 1000


def test_a_row_that_is_wrong_in_an_even_block_is_named_also_where_two_make_up_for_each_other() -> None:
    rows = [f"{at / 100:.2f},{at % 7}" for at in range(50)]
    for row in ("1.0", "1.0,2,3", "1.0,nan", "1.0,1_0", "1.0,", "1.0,2;3", "1.0,--2", ",2"):
        with pytest.raises(RecordError, match=r"line 3: "):
            parse_records("\n".join(["time [s],a [g]", rows[0], row, *rows[1:]]).encode(), "a.csv")
    rows = [f"{row},1" for row in rows]
    with pytest.raises(RecordError, match=r"line 4: the number of cells is 2, but there are 3 headings"):
        parse_records("\n".join(["time [s],a [g],b [g]", *rows[:2], "1,2", "1,2,3,4", *rows]).encode(), "a.csv")


# --- other formats ---


def tiny_words(smaller: int) -> bytes:
    head = at2().split(b"\r\n")[:3]
    count = MOST_SAMPLES // smaller
    return b"\n".join([*head, b"NPTS= %7d, DT= .01000 SEC" % count, b"0\n1\n" * (count // 2)])


def short_records() -> bytes:
    """Return a record of miniSEED of 128 bytes, with 15 samples."""
    record = bytearray(mseed(Signal(wave(15)))[:128])
    record[54] = 7  # the length is 2 to the power of 7
    return bytes(record)


UNCORRECTED = b"\r\nUNCORRECTED ACCELEROGRAM DATA\n"
OTHERS: dict[str, tuple[Build, str, int]] = {
    "words": (tiny_words, "{} samples", MOST_SAMPLES),
    "columns": (lambda smaller: csmip_v1(Signal(wave(MOST_SAMPLES // smaller))), "{} samples", MOST_SAMPLES),
    "short lines": (lambda smaller: csmip_v2(EAST)[:60] + UNCORRECTED + b"01234\n" * (9_900_000 // smaller),
                    "no line says", 0),
    "lines beyond count": (lambda smaller: at2() + b"\n" * (LARGE // smaller), "the file has more than {:,} lines",
                           MOST_LINES),
    "channels": (lambda smaller: (csmip_v2(EAST)[:2700] + b"\n") * (20_000 // smaller),
                 "the file has more than 500 channels", 0),
    "a line": (lambda smaller: at2() + b"1 " * (LARGE // smaller // 2 - 10_000),
               "the file has more data values than the 400", 0),
    "miniSEED": (lambda smaller: mseed(EAST) * (LARGE // smaller // len(mseed(EAST)) - 1), "the number of samples is",
                 0),
    "short records": (lambda smaller: short_records() * (LARGE // smaller // 128),
                      "the file has more than {:,} records of miniSEED", MOST_PARTS),
    "stations": (lambda _: b"".join(mseed(EAST, station=f"{n:04}") for n in range(600)), "more than 500 channels", 0),
    "SAC": (lambda smaller: sac(Signal(wave(15_000_000 // smaller)), unit="g"),
            "the number of samples is {:,}, expected at most", 15_000_000),
    "the largest SAC": (lambda smaller: sac(Signal(wave(MOST_SAMPLES // smaller)), unit="g"), "{} samples",
                        MOST_SAMPLES),
}  # fmt: skip
"""What is read, what is said of it, and the number in that for the whole size."""


@pytest.mark.parametrize("smaller", SIZES)
@pytest.mark.parametrize("name", OTHERS)
def test_the_largest_files_of_other_formats(tmp_path: Path, name: str, smaller: int) -> None:
    build, said, number = OTHERS[name]
    assert said.format(number // smaller) in read_apart(tmp_path, build(smaller), smaller)


def test_samples_of_an_archive_count_together(monkeypatch: pytest.MonkeyPatch) -> None:
    from assess.motion.formats import _archive

    monkeypatch.setattr(_archive, "MOST_VALUES", 1000)
    data = zipped({f"{number}.at2": at2() for number in range(3)})
    with pytest.raises(RecordError, match=r"the file has more than 20,000,000 samples: give the channels"):
        parse_records(data, "set.zip")
    assert _format.MOST_VALUES == 20_000_000


# --- SAC: fields that other readers trust ---


def test_a_longitude_without_end_is_not_waited_for(tmp_path: Path) -> None:
    """LCALDA says that distances follow from the coordinates, and a longitude of 1e30 never comes below 180."""
    data = bytearray(sac(unit="m/s2"))
    struct.pack_into("<f", data, 4 * 32, 1e30)  # STLO
    struct.pack_into("<i", data, 4 * 108, 1)  # LCALDA
    (tmp_path / "r.sac").write_bytes(data)
    (record,) = read_records(tmp_path / "r.sac")
    assert record.acceleration.size == EAST.acceleration.size
