"""CSMIP volumes 1 and 2: what their headers say, and what is said of damaged ones."""

import re
from dataclasses import replace

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import csmip
from assess.motion.record import Record
from assess.units import GRAVITY
from tests.motion.damage import changed
from tests.motion.writers import (
    EAST,
    NORTH,
    THREE,
    Signal,
    csmip_v1 as write_v1,
    csmip_v1_pairs as write_pairs,
    csmip_v2 as write_v2,
    wave,
)
from tests.refusals import check_refusals

DEAD = Signal(np.zeros(400), 90.0, 2)
V1, PAIRS, V2 = write_v1(EAST), write_pairs(EAST), write_v2(EAST)


def with_number(data: bytes, line: int, at: int, text: bytes) -> bytes:
    """Replace what stands from column `at` on in a line, counted from 1, by `text` of the same width."""
    lines = data.split(b"\r\n")
    lines[line - 1] = lines[line - 1][:at] + text + lines[line - 1][at + len(text) :]
    return b"\r\n".join(lines)


def read_one(data: bytes) -> Record:
    (record,) = (
        csmip.VOLUME_2.read(data, "made") if csmip.VOLUME_2.recognises(data) else csmip.VOLUME_1.read(data, "made")
    )
    return record


@pytest.mark.parametrize("data", [V1, PAIRS, V2], ids=["v1", "pairs", "v2"])
def test_text(data: bytes) -> None:
    record = read_one(data)
    assert (record.channel, record.location) == ("11", "ROOF: EAST WALL")
    assert (record.station, record.event) == ("TOWN HALL (14403)", "MADE-UP EARTHQUAKE")
    assert record.start == "01/17/94, 12:31:04.1 UTC"
    assert (record.azimuth_deg, record.vertical, record.notes) == (90.0, False, ())


def test_text_that_says_little() -> None:
    bare = changed(changed(V1, b"CHAN  1:  90 DEG", b"CHANNEL"), b"TRIGGER TIME", b"            ")
    record = read_one(changed(bare, b"STATION NO. 14403", b"STATION          "))
    assert (record.channel, record.location, record.azimuth_deg, record.vertical) == ("1", "", None, None)
    assert (record.station, record.start) == ("TOWN HALL", "JANUARY 17, 1994 04:31 PST")
    record = read_one(re.sub(rb"  \(STA CHN: 11\)", b"", V2))
    assert (record.channel, record.location) == ("1", "ROOF: EAST WALL")


@pytest.mark.parametrize(
    ("direction", "azimuth", "vertical"),
    [
        (b"360 DEG", 360.0, False), (b"  2 DEG", 2.0, False), (b"UP", None, True), (b"V", None, True),
        (b"EW", 90.0, False), (b"NS", 0.0, False), (b"N08W", 352.0, False), (b"S62W", 242.0, False),
        (b"S45E", 135.0, False), (b"400 DEG", None, None), (b"RADIAL", None, False),
    ],
)  # fmt: skip
def test_directions(direction: bytes, azimuth: float | None, vertical: bool | None) -> None:
    record = read_one(changed(V2, b"1:  90 DEG  (STA", b"1: " + direction + b"  (STA"))
    assert (record.azimuth_deg, record.vertical) == (azimuth, vertical)


def test_uneven_pairs_are_resampled() -> None:
    data = PAIRS
    for millisecond in (50, 60, 110, 150):
        data = changed(data, b"  0.%03d" % millisecond, b"  0.%03d" % (millisecond + 4))
    record = read_one(data)
    assert (record.time_step, record.acceleration.size) == (0.005, 799)
    assert "unevenly sampled" in record.notes[0]
    assert record.file_pfa == pytest.approx(np.abs(EAST.acceleration).max(), abs=1e-3)


def test_columns_are_those_of_the_format_in_the_title() -> None:
    numbers = b"\r\n".join(
        b"".join(b"%12.5f" % (100 * value) for value in EAST.acceleration[first : first + 4])
        for first in range(0, 400, 4)
    )
    head, title, rest = V2.partition(b"(UNITS: CM/SEC/SEC)")
    record = read_one(head + b", in cm/sec2. (4f12.5)\r\n" + numbers + b"\r\n" + rest[rest.index(b"  400 POINTS") :])
    assert title
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=1e-6)


def test_old_and_new_line_ends() -> None:
    unix = read_one(V2.replace(b"\r\n", b"\n"))
    assert (unix.acceleration == read_one(V2).acceleration).all()
    assert (read_one(V2.replace(b"\r\n", b"\r")).acceleration == unix.acceleration).all()


def test_a_dead_channel_or_one_that_is_cut_off_does_not_lose_the_others() -> None:
    for read, write in ((csmip.VOLUME_1.read, write_v1), (csmip.VOLUME_2.read, write_v2)):
        records = read(write(EAST, DEAD, NORTH), "made")
        assert len(records) == 2
        for record in records:
            assert record.notes == (
                "channel 2 of the file is left out: every sample is 0 m/s2: the channel holds no motion",
            )
    whole = write_v2(*THREE)
    records = csmip.VOLUME_2.read(whole[: whole.rindex(b"POINTS OF ACCEL") + 1000], "made")
    assert [record.channel for record in records] == ["11", "12"]
    assert re.search(r"channel 3 .*cut short: it has \d+ of the 400 data values", records[0].notes[0])
    with pytest.raises(RecordError, match=r"^none of its 6 channels can be read: channel 1: every sample is 0 m/s2"):
        csmip.VOLUME_1.read(write_v1(*[DEAD] * 6), "made")
    many = csmip.VOLUME_1.read(write_v1(EAST, *[DEAD] * 6), "made")[0].notes
    assert (len(many), many[-1]) == (5, "2 more channels of the file are left out")


def test_spectra_are_refused() -> None:
    data = b"RESPONSE AND FOURIER AMPLITUDE SPECTRA (79 PERIODS,  .04 -  6.5 SEC)   FOR\r\n" + V2
    assert csmip.VOLUME_2.recognises(data)
    message = r"the file holds response spectra \(volume 3\), not accel.*\. Give volume 2 or 1"
    with pytest.raises(RecordError, match=message):
        csmip.VOLUME_2.read(data, "made")


def test_v1_damage() -> None:
    check_refusals(RecordError, lambda data: csmip.VOLUME_1.read(data, "made"), [
        (b"hello", r'no line says "Uncorrected accelerogram data"\. Get the file again'),
        (V1[:1000], r"the header does not give the number of points, or their unit|cut short"),
        (V1[:4000], r"cut short: it has \d+ of the 400 data values that its header announces\. Get the file again"),
        (changed(V1, b"  400 Accel", b"99999999 Accel"), r"announces 99999999 data values, expected 1 to 8,000,000"),
        (changed(V1, b"at 100 pts/sec", b"at 0 pts/sec"), r"line 28: the sampling rate or the unit cannot be read"),
        (changed(V1, b"  400 Accel", b" 7000000 Accel"), r"cut short: it has 4\d\d of the 7000000 data values"),
        (with_number(V1, 29, 9, b"   1.E308"), r"sample 2 is not a number"),
        (changed(V1, b"in units of g", b"in units of q"), r"line 28: the sampling rate or the unit cannot be read"),
        (changed(V1, b"at 100 pts/sec", b"at 1 pts/sec"), r"the time step is 1 s"),
        (with_number(V1, 29, 9, b"  0.14x54"), r"line 29: '0\.14x54' is not a number\. Get the file again"),
        (with_number(V1, 29, 9, b"         "), r"line 29: a number is missing"),
        (with_number(V1, 29, 9, b"      NaN"), r"sample 2 is not a number"),
        (changed(PAIRS, b"SEC AND G/10", b"SEC AND CM/S"), r"does not give the number of points, or their unit"),
        (changed(PAIRS, b"NO. OF POINTS =    400", b"NO. OF POINTS =      0"), r"announces 0 data values"),
        (changed(PAIRS, b"NO. OF POINTS =    400", b"NO. OF POINTS = 999999"), r"1999998 data values"),
    ])  # fmt: skip


def test_v2_damage() -> None:
    check_refusals(RecordError, lambda data: csmip.VOLUME_2.read(data, "made"), [
        (b"hello", r'no line says "Corrected accelerogram"\. Get the file again'),
        (V2[:1500], r'no line says "points of accel data equally spaced at"\. Get the file again'),
        (V2[:5000], r"cut short: it has \d+ of the 400 data values that its header announces\. Get the file again"),
        (changed(V2, b"  400 POINTS OF ACCEL", b"  999999999 POINTS OF ACCEL"), r"announces 999999999 data values"),
        (changed(V2, b"AT 0.010 SEC.", b"AT 0.000 SEC."), r"the time step is 0 s, expected"),
        (changed(V2, b"AT 0.010 SEC.", b"AT 0.0.0 SEC."), r"line 46: the time step or the unit cannot be read"),
        (changed(V2, b"UNITS: CM/SEC/SEC", b"UNITS: FURLONGS!!"), r"line 46: the time step or the unit cannot be read"),
        (with_number(V2, 47, 10, b"**********"), r"line 47: '\*+' is not a number\. Get the file again"),
    ])  # fmt: skip


def test_a_peak_that_is_not_the_header_s_is_noted_and_one_of_1_g_is_read() -> None:
    record = read_one(changed(V2, b"PEAK ACCELERATION =   138", b"PEAK ACCELERATION =   238"))
    assert record.notes == ("the header prints a peak of 238.2 cm/s2, the data have 138.2 cm/s2",)
    assert read_one(changed(V1, b"Max", b"Mix")).header_pfa is None
    large = replace(EAST, acceleration=wave(peak=GRAVITY))
    assert read_one(write_v1(large)).file_pfa == pytest.approx(np.abs(large.acceleration).max(), abs=1e-5)
