"""ESM: its header, what counts as corrected, and what is said of other files."""

from functools import partial

import pytest

from assess.errors import RecordError
from assess.motion.formats import esm
from tests.motion.damage import read_only
from tests.motion.writers import UP, esm as write
from tests.refusals import check_refusals

read_one = partial(read_only, esm.FORMAT)


def test_header_also_one_that_says_little() -> None:
    record = read_one(write())
    assert (record.channel, record.azimuth_deg, record.location) == ("HNE", 90.0, "00")
    assert (record.station, record.event) == ("Town Hall (ARS1)", "MADE-UP 20190728")
    assert record.start == "2019-07-28 16:09:19.870 UTC"
    assert record.header_pfa == pytest.approx(record.file_pfa, rel=1e-6)
    assert (read_one(write(UP)).channel, read_one(write(UP)).vertical) == ("HNZ", True)
    assert read_one(write(STATION_NAME="")).station == "ARS1"
    record = read_one(write(STREAM="", **{"PGA_CM__S^2": ""}))
    assert (record.channel, record.azimuth_deg, record.header_pfa) == ("1", None, None)


def test_corrected_is_what_was_filtered() -> None:
    for processing, filtered, corrected in (
        ("manual (Paolucci et al., 2011)", "BUTTERWORTH", True), ("automatic", "BUTTERWORTH", True),
        ("none", "", False), ("", "", False), ("unprocessed", "", False), ("manual", "", False),
    ):  # fmt: skip
        assert read_one(write(PROCESSING=processing, FILTER_TYPE=filtered)).corrected == corrected, processing


def test_damage() -> None:
    check_refusals(RecordError, read_one, [
        (write(DATA_TYPE="VELOCITY"),
         r"the file holds velocities, not accelerations\. Give the \.ACC\. file of the same"),
        (write(DATA_TYPE="ACCELERATION RESPONSE SPECTRUM"), r"the file holds acceleration response spectrum, not"),
        (write(UNITS="furlong"), r"'furlong' is not a known unit of acceleration\. Get the file again"),
        (write(NDATA=""), r"the header does not give NDATA and SAMPLING_INTERVAL_S\. Get the file again"),
        (write(NDATA="2000000000"), r"announces 2000000000 data values, expected 1 to 8,000,000"),
        (write(NDATA="1e300"), r"announces 1e\+300 data values"),
        (write(SAMPLING_INTERVAL_S="0"), r"the time step is 0 s"),
        (b"EVENT_NAME: A\n" * 300, r"there are no data below the header\. Get the file again"),
        (write()[:1500], r"cut short"),
    ])  # fmt: skip
