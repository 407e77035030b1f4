"""USGS SMC: real files, the same files damaged, and what is said of them."""

from functools import partial
from pathlib import Path

import pytest

from assess.errors import RecordError
from assess.motion.formats import read_records, smc
from tests.motion.damage import read_only
from tests.refusals import check_refusals

RECORDS = Path(__file__).parents[2] / "samples" / "records"
UNEVEN = RECORDS.parents[1] / "inventories" / "records" / "575-market" / "891018_1.cra-1.0210k.smc"
ROOF = (RECORDS / "1103.HN2.NP.RE_a.smc").read_bytes()
UNCORRECTED = (RECORDS / "0165a_u.smc").read_bytes()
read_smc = partial(read_only, smc.FORMAT)


def with_line(data: bytes, number: int, content: bytes) -> bytes:
    lines = data.splitlines()
    lines[number - 1] = content
    return b"\r\n".join(lines)


def header_line(data: bytes, number: int, place: int, value: str, width: int) -> bytes:
    """Return `data` with the number at `place` (from 0) of the header's line `number` replaced."""
    line = data.splitlines()[number - 1]
    return with_line(data, number, line[: place * width] + value.rjust(width).encode() + line[(place + 1) * width :])


def test_smc_corrected() -> None:
    record = read_smc(ROOF)
    assert (record.channel, record.azimuth_deg, record.vertical, record.corrected) == ("171", 171.0, False, True)
    assert (record.station, record.location) == ("CA:Berkeley;Great Western Sav", "Roof, east core")
    assert (record.event, record.start) == ("22 KM SE OF BERKELEY, CA", "2018-01-04 10:39 UTC")
    assert (record.time_step, record.acceleration.size, record.notes) == (0.005, 8200, ())
    assert record.recorder == "164"
    assert record.header_pfa == pytest.approx(0.514)
    assert record.acceleration[:3] == pytest.approx([6.4470e-5, -1.34e-4, -6.0292e-4])


def test_smc_uncorrected_and_even_and_an_older_wording_of_the_peak() -> None:
    record = read_smc(UNCORRECTED)
    assert (record.corrected, record.time_step, record.acceleration.size) == (False, 0.005, 6012)
    assert record.location == "floor 12"
    assert record.file_pfa == pytest.approx(2.6349)
    assert record.header_pfa == pytest.approx(2.635)
    (record,) = read_records(RECORDS / "np01002p_4225a_a.smc")
    assert record.header_pfa == pytest.approx(2.225)


def test_smc_vertical() -> None:
    (record,) = read_records(RECORDS / "1103.HNZ.NP.BE_a.smc")
    assert (record.channel, record.azimuth_deg, record.vertical) == ("UP", None, True)
    by_angle = read_smc(with_line(header_line(UNCORRECTED, 13, 4, "0", 10), 6, b"station = A component="))
    assert (by_angle.vertical, by_angle.channel) == (True, "1")


def test_smc_velocity_is_refused() -> None:
    message = r"RE_v\.smc: the file holds velocities \(3 VELOCITY\), not accelerations\. Give the acc"
    with pytest.raises(RecordError, match=message):
        read_records(RECORDS / "1103.HN2.NP.RE_v.smc")
    with pytest.raises(RecordError, match=r"the file holds displacements \(4 DISPLACEMENT\)"):
        read_smc(with_line(ROOF, 1, b"4 DISPLACEMENT"))


def test_smc_damage() -> None:
    check_refusals(RecordError, read_smc, [
        (b"hello", r"the first line names no type of SMC file"),
        (ROOF[:500], r"the file is cut short: its header takes 27 lines, the file has \d+\. Get the file again"),
        (ROOF[:50_000],
         r"cut short: it has \d{4} of the 8200 data values that its header announces\. Get the file again"),
        (ROOF + b"\r\n 1.0000E+0" * 100,
         r"the file has more data values than the 8200 that its header announces\. Get"),
        (with_line(ROOF, 40, b" 1.0x00E+0" * 8), r"line 40: '1\.0x00E\+0' is not a number"),
        (with_line(ROOF, 40, b" 1.0000E+0" * 7) + b"\r\n 1.0000E+0", r"line 40: a number is missing"),
        (with_line(ROOF, 40, b"       nan" * 8), r"sample 25 is not a number"),
        (with_line(ROOF, 40, b" 1.0000E+9" * 8), r"the peak is 1\.02e\+06 g, expected at most 50 g"),
        (with_line(ROOF, 40, b" 1.0000E+0" * 9), r"line 40 is longer than 80 characters"),
        (with_line(ROOF, 12, b"    -32768      20x8"), r"line 12: '20x8' is not a whole number"),
        (header_line(ROOF, 13, 7, "8", 10), r"the number of comment lines is 9, but 8 in the header"),
        (b"\n".join(ROOF.splitlines()[:30]), r"there are no data below the header"),
        (header_line(ROOF, 14, 0, "9999999999", 10),
         r"cut short: it has 8200 of the 9999999999 data values that its header announces"),
        (header_line(ROOF, 14, 0, "0", 10), r"the number of data values is 0 in the header\."),
        (header_line(ROOF, 14, 0, "-32768", 10), r"the number of data values is 0 in the header\."),
        (header_line(ROOF, 18, 1, "0.0", 15), r"line 18: the sampling rate is 0 Hz, expected above 0"),
        (header_line(ROOF, 18, 1, "-200.0", 15), r"line 18: the sampling rate is -200 Hz, expected above 0"),
        (header_line(ROOF, 18, 1, "NaN", 15), r"line 18: the sampling rate is nan Hz, expected above 0"),
        (header_line(ROOF, 18, 1, "fast", 15), r"line 18: 'fast' is not a number"),
        (header_line(ROOF, 18, 1, "1.0E+09", 15), r"the time step is 1e-09 s"),
        (header_line(ROOF, 18, 1, "1.7000000E+38", 15), r"samples are no later than one before them"),
        (header_line(header_line(ROOF, 18, 1, "1.7E+38", 15), 14, 0, "8199", 10),
         r"the number of data values is 8199, which is odd: they cannot be pairs"),
    ])  # fmt: skip


def test_smc_notes() -> None:
    for data, note in (
        (ROOF + b"\r\n 1.0000E+0", "1 number beyond the 8200 that the header announces: left out"),
        (header_line(ROOF, 13, 5, "17", 10), "the header gives two azimuths, 171 and 17 deg: the first is used"),
        (header_line(ROOF, 14, 1, "1", 10), "the header flags a problem with the data: read its comments"),
        (ROOF.replace(b"-5.14E+1", b"-4.14E+1"), "the header prints a peak of 41.4 cm/s2, the data have 51.4 cm/s2"),
    ):
        assert read_smc(data).notes == (note,)


def test_smc_headers_that_say_little() -> None:
    bare = with_line(with_line(with_line(ROOF, 4, b"*"), 6, b"*"), 7, b"pk acc = E")
    record = read_smc(header_line(bare, 13, 5, "-32768", 10))
    assert (record.station, record.event, record.start, record.header_pfa) == ("", "", "", None)
    assert (record.azimuth_deg, record.vertical, record.channel) == (None, None, "1")


def test_smc_pairs_in_time() -> None:
    (record,) = read_records(UNEVEN)
    assert (record.channel, record.azimuth_deg, record.location) == ("315", 315.0, "floor 1")
    assert record.acceleration.size == 9708
    # The first pair in the file is (0 s, -7.4... cm/s2); resampling keeps it.
    first = UNEVEN.read_bytes().splitlines()[35]
    assert record.acceleration[0] == pytest.approx(float(first[10:20]) / 100)
