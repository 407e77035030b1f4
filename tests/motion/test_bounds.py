"""Files made to take time or memory: bounded, whatever the format."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from assess.errors import RecordError
from assess.motion.formats import _format, parse_records, plain_csv, read_records
from assess.motion.formats._format import MOST_CHANNELS
from assess.motion.record import MOST_SAMPLES
from tests.apart import run_apart
from tests.motion.writers import EAST, Signal, at2, csmip_v1, csmip_v2, mseed, sac, wave, zipped

MOST_MEMORY = 400
"""MB at the peak, of which Python and the libraries take 60."""
LARGE = 63_900_000
"""Bytes: the largest file that is read has 64 MB."""

_CHILD = """
import sys
from pathlib import Path
from assess.motion.formats import read_records
from assess.errors import RecordError
try:
    print(sum(record.acceleration.size for record in read_records(Path(sys.argv[1]))), "samples")
except RecordError as error:
    print(error)
"""


def read_apart(folder: Path, data: bytes) -> str:
    """Read a file in a process of its own; return what it says, having checked how much memory it took."""
    (folder / "large").write_bytes(data)
    try:
        return run_apart(_CHILD, folder / "large", most_memory=MOST_MEMORY, seconds=300)
    finally:
        (folder / "large").unlink()


# --- plain CSV ---


def many_rows(channels: int, cell: str = "-0.12345", end: str = "\n") -> bytes:
    head = "time [s]," + ",".join(f"c{number} [cm/s2]" for number in range(channels)) + end
    # Two values, or every sample would be alike.
    rows = ["," + ",".join([cell] * channels) + end, "," + ",".join(["0.12345"[: len(cell)]] * channels) + end]
    count = min((LARGE - len(head)) // (len(rows[0]) + 8), MOST_SAMPLES)
    return (head + "".join(f"{row * 0.005:.3f}{rows[row % 2]}" for row in range(count))).encode()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("data", "said"),
    [
        (lambda: many_rows(1), "samples"),
        (lambda: many_rows(3, end=",,,\r\n"), "samples"),
        (lambda: many_rows(MOST_CHANNELS), "samples"),
        (lambda: many_rows(3).replace(b",", b'","').replace(b"\n", b'"\n"')[:LARGE].rpartition(b"\n")[0], "samples"),
        (lambda: many_rows(MOST_CHANNELS, "1"), "the file has more than 20,000,000 samples"),
        (lambda: b"time [s],a [g]\n" + b"1,2\n" * (LARGE // 4 - 10), "the file has more than 4,000,000 rows"),
        (lambda: b"time [s],a [g]\n" + b"#" * (LARGE - 100), "line 2 has more than 500 channels, or the end"),
        (lambda: b"#" * (LARGE - 100), "the file format is not supported"),
    ],
)
def test_the_largest_csv(tmp_path: Path, data: Callable[[], bytes], said: str) -> None:
    assert said in read_apart(tmp_path, data())


def test_a_million_channels_are_refused_at_the_headings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_csv, "_read_column", pytest.fail)  # no heading is looked at
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

    def measured(block: bytes, *more: Any) -> list[float]:
        sizes.append(len(block))
        return real(block, *more)

    monkeypatch.setattr(plain_csv, "BLOCK", 1000)
    monkeypatch.setattr(plain_csv, "_read_block", measured)
    text = "time [s],a [g]\n" + "\n".join(f"{row / 100:.2f},{row % 7}" for row in range(5000))
    parse_records(text.encode(), "a.csv")
    assert max(sizes) <= 1000
    assert len(sizes) >= len(text) // 1000


def test_a_row_that_is_wrong_in_an_even_block_is_named() -> None:
    rows = [f"{at / 100:.2f},{at % 7}" for at in range(50)]
    for row in ("1.0", "1.0,2,3", "1.0,nan", "1.0,1_0", "1.0,", "1.0,2;3", "1.0,--2", ",2"):
        with pytest.raises(RecordError, match=r"line 3: "):
            parse_records("\n".join(["time [s],a [g]", rows[0], row, *rows[1:]]).encode(), "a.csv")


def test_two_rows_that_make_up_for_each_other_are_not_taken_for_even() -> None:
    rows = [f"{at / 100:.2f},{at % 7},1" for at in range(50)]
    with pytest.raises(RecordError, match=r"line 4: the number of cells is 2, but there are 3 headings"):
        parse_records("\n".join(["time [s],a [g],b [g]", *rows[:2], "1,2", "1,2,3,4", *rows]).encode(), "a.csv")


# --- other formats ---


def tiny_words() -> bytes:
    head = at2().split(b"\r\n")[:3]
    return b"\n".join([*head, b"NPTS= 4000000, DT= .01000 SEC", b"0\n1\n" * 2_000_000])


TEXTS: dict[str, tuple[Callable[[], bytes], str]] = {
    "words": (tiny_words, "4000000 samples"),
    "columns": (lambda: csmip_v1(Signal(wave(4_000_000))), "4000000 samples"),
    "short lines": (lambda: csmip_v2(EAST)[:60] + b"\r\nUNCORRECTED ACCELEROGRAM DATA\n" + b"01234\n" * 9_900_000,
                    "no line says"),
    "lines beyond count": (lambda: at2() + b"\n" * LARGE, "the file has more than 10,000,000 lines"),
    "channels": (lambda: (csmip_v2(EAST)[:2700] + b"\n") * 20_000, "the file has more than 500 channels"),
    "a line": (lambda: at2() + b"1 " * (LARGE // 2 - 10_000), "the file has more data values than the 400"),
    "miniSEED": (lambda: mseed(EAST) * (LARGE // len(mseed(EAST)) - 1), "the number of samples is"),
    "short records": (lambda: short_records() * (LARGE // 128), "the file has more than 250,000 records of miniSEED"),
    "stations": (lambda: b"".join(mseed(EAST, station=f"{n:04}") for n in range(600)), "more than 500 channels"),
    "SAC": (lambda: sac(Signal(wave(15_000_000)), unit="g"), "the number of samples is 15,000,000, expected at most"),
    "the largest SAC": (lambda: sac(Signal(wave(4_000_000)), unit="g"), "4000000 samples"),
}  # fmt: skip


def short_records() -> bytes:
    """Return a record of miniSEED of 128 bytes, with 15 samples."""
    record = bytearray(mseed(Signal(wave(15)))[:128])
    record[54] = 7  # the length is 2 to the power of 7
    return bytes(record)


@pytest.mark.slow
@pytest.mark.parametrize("name", TEXTS)
def test_the_largest_files_of_other_formats(tmp_path: Path, name: str) -> None:
    build, said = TEXTS[name]
    assert said in read_apart(tmp_path, build())


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
