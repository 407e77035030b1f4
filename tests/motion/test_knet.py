"""K-NET and KiK-net: the offset, the directions, and what is said of damaged files."""

from functools import partial

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import knet
from assess.motion.record import treat
from tests.motion.damage import read_only
from tests.motion.writers import EAST, SCALE, knet as write
from tests.refusals import check_refusals

read_one = partial(read_only, knet.FORMAT)


def test_header_also_one_that_says_little() -> None:
    record = read_one(write())
    assert (record.station, record.event) == ("AOM001", "2018/01/24 19:51:00 M6.2")
    assert record.start == "2018-01-24 19:51:28 JST"
    assert (record.corrected, record.notes) == (False, ())
    record = read_one(write(direction="", **{"Max._Acc._(gal)": "", "Record_Time": "yesterday"}))
    assert (record.channel, record.azimuth_deg, record.vertical) == ("1", None, None)
    assert (record.header_pfa, record.start) == (None, "yesterday")
    assert read_one(write(Record_Time="0001/01/01 00:00:00")).start == "0001/01/01 00:00:00"


def test_the_peak_is_about_the_mean() -> None:
    record = read_one(write(offset=-12085))
    assert record.acceleration.mean() == pytest.approx(-12085 * SCALE + EAST.acceleration.mean(), abs=1e-5)
    assert record.header_pfa == pytest.approx(record.file_pfa, abs=1e-5)
    own = record.acceleration - record.acceleration.mean()
    assert record.file_pfa == np.abs(own).max()
    assert treat(record, "none").pfa == pytest.approx(record.file_pfa)


@pytest.mark.parametrize(
    ("direction", "channel", "location", "azimuth"),
    [
        ("N-S", "NS", "", 0.0), ("E-W", "EW", "", 90.0), ("U-D", "UD", "", None),
        ("1", "NS1", "borehole", 0.0), ("2", "EW1", "borehole", 90.0), ("3", "UD1", "borehole", None),
        ("4", "NS2", "surface", 0.0), ("5", "EW2", "surface", 90.0), ("6", "UD2", "surface", None),
    ],
)  # fmt: skip
def test_directions(direction: str, channel: str, location: str, azimuth: float | None) -> None:
    record = read_one(write(direction=direction))
    assert (record.channel, record.location) == (channel, location)
    assert (record.azimuth_deg, record.vertical) == (azimuth, azimuth is None)


def test_damage() -> None:
    check_refusals(RecordError, read_one, [
        (b"hello", r"Sampling Freq\(Hz\) is '' in the header, expected a number above 0\. Get the file again"),
        (write(**{"Sampling_Freq(Hz)": "0Hz"}), r"Sampling Freq\(Hz\) is '0Hz' in the header"),
        (write(**{"Duration_Time(s)": "long"}), r"Duration Time\(s\) is 'long' in the header"),
        (write(**{"Duration_Time(s)": "99999999"}), r"announces 9999999900 data values, expected 1 to 8,000,000"),
        (write(**{"Sampling_Freq(Hz)": "99999999Hz"}), r"announces \d+ data values"),
        (write(**{"Sampling_Freq(Hz)": "9" * 155, "Duration_Time(s)": "9" * 155}), r"announces inf data values"),
        (write(Scale_Factor="3920/6182761"), r"the scale factor is '3920/6182761', expected a ratio such as"),
        (write(Scale_Factor="3920(gal)/0"), r"the scale factor is '3920\(gal\)/0'"),
        (write()[:2000], r"the file is cut short: .* its header announces\. Get the file again"),
        (write().replace(b"-12085", b"-12x85", 1), r"number 1 of the data: '-12x85' is not a number"),
    ])  # fmt: skip
