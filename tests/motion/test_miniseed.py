"""MiniSEED: counts, units, gaps, and what is said of other files."""

import io

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import miniseed
from tests.motion.writers import EAST, THREE, Signal, mseed as write
from tests.refusals import check_refusals


def test_channels() -> None:
    records = miniseed.FORMAT.read(write(*THREE), "made")
    assert [record.channel for record in records] == ["HNE", "HNN", "HNZ"]
    assert [(record.azimuth_deg, record.vertical) for record in records] == [(90.0, False), (0.0, False), (None, True)]
    record = records[0]
    assert (record.station, record.start, record.corrected) == ("NP.TOWN", "2018-11-30 17:28:10.000 UTC", False)
    assert record.notes == (
        'the file does not give its unit: taken as m/s2, which ObsPy\'s remove_response(output="ACC") leaves',
    )


def test_two_stations_of_one_code_gaps_and_channels_that_are_not_read() -> None:
    records = miniseed.FORMAT.read(write(EAST) + write(EAST, station="HILL"), "made")
    assert {record.channel for record in records} == {"NP.TOWN..HNE", "NP.HILL..HNE"}
    (record,) = miniseed.FORMAT.read(write(EAST, gap_after=200), "made")
    assert any("a gap of 1.01 s at 1.99 s is bridged by a straight line" in note for note in record.notes)
    # 199 samples of 0.01 s, resampled to 0.005 s.
    assert record.acceleration[:398:2] == pytest.approx(EAST.acceleration[:199], abs=1e-6)
    (record,) = miniseed.FORMAT.read(write(EAST) + write(EAST, code="BHE"), "made")
    assert any(note.startswith("NP.TOWN..BHE of the file is left out: the channel's code") for note in record.notes)


COUNTS = Signal(np.rint(1e5 * EAST.acceleration))


def test_damage() -> None:
    check_refusals(RecordError, lambda data: miniseed.FORMAT.read(data, "made"), [
        (write(COUNTS, whole=True), r"the channel holds raw counts, not accelerations\. Remove the instrument's "
         r'response with ObsPy \(stream\.remove_response\(inventory, output="ACC"\)\) and save .* as plain CSV'),
        (write(COUNTS), r"the peak is .* g, expected at most 50 g: is the unit right"),
        (write(EAST, code="BHE"), r"code 'BHE' is not that of an accelerometer \(such as HNE\)\. Save .* as plain CSV"),
        (write(EAST)[:100], r"the file has no complete miniSEED record\. Get the file again"),
        (write(Signal(EAST.acceleration * np.nan)), r"sample 1 is not a number"),
    ])  # fmt: skip


@pytest.mark.parametrize(("encoding", "order"), [("FLOAT64", ">"), ("FLOAT32", "<"), ("FLOAT64", "<")])
def test_obspy_writes_what_is_read(encoding: str, order: str) -> None:
    obspy = pytest.importorskip("obspy")
    (trace,) = obspy.read(io.BytesIO(write(EAST)))
    trace.data = trace.data.astype({"FLOAT64": "f8", "FLOAT32": "f4"}[encoding])
    trace.stats.starttime += 0.000123  # a blockette of its own
    target = io.BytesIO()
    trace.write(target, format="MSEED", encoding=encoding, byteorder=order, reclen=256)
    (record,) = miniseed.FORMAT.read(target.getvalue(), "made")
    (own,) = obspy.read(io.BytesIO(target.getvalue()))
    np.testing.assert_array_equal(record.acceleration, own.data)
    assert (record.time_step, record.start) == (own.stats.delta, "2018-11-30 17:28:10.000 UTC")


@pytest.mark.parametrize("encoding", ["STEIM1", "STEIM2", "INT32"])
def test_packed_counts_are_refused(encoding: str) -> None:
    obspy = pytest.importorskip("obspy")
    (trace,) = obspy.read(io.BytesIO(write(COUNTS, whole=True)))
    target = io.BytesIO()
    trace.write(target, format="MSEED", encoding=encoding)
    with pytest.raises(RecordError, match="the channel holds raw counts"):
        miniseed.FORMAT.read(target.getvalue(), "made")


def test_rates_below_one_and_exact_rates() -> None:
    data = write(EAST)
    rate = data.index(b"\x00\x64\x00\x01", 30)  # 100 samples a second, times 1
    (record,) = miniseed.FORMAT.read(data[:rate] + b"\x00\x32\x00\x02" + data[rate + 4 :], "made")
    assert record.time_step == 0.01
    data = write(Signal(EAST.acceleration[:100]))  # in one record
    (record,) = miniseed.FORMAT.read(data[:rate] + b"\x00\x64\xff\xfc" + data[rate + 4 :], "made")  # 100, -4
    assert record.time_step == 1 / 25
    with pytest.raises(RecordError, match=r"the time step is 10 s"):
        miniseed.FORMAT.read(data[:rate] + b"\xff\xf6\x00\x01" + data[rate + 4 :], "made")  # -10, 1
    with pytest.raises(RecordError, match="the file has no complete miniSEED record"):
        miniseed.FORMAT.read(data[:rate] + b"\x00\x00\x00\x01" + data[rate + 4 :], "made")  # no rate


def test_text_is_refused() -> None:
    # Encoding 0: characters, as of the log of a recorder.
    text = bytearray(write(EAST)[:512])
    text[text.index(b"\x03\xe8\x00\x00\x04") + 4] = 0
    with pytest.raises(RecordError, match=r"the channel holds no numbers\. Give a channel of an accelerometer"):
        miniseed.FORMAT.read(bytes(text), "made")


def test_what_is_cut_off_no_record_or_no_text_loses_nothing_else() -> None:
    (record,) = miniseed.FORMAT.read(write(EAST)[:-300], "made")
    assert record.acceleration.size == 300
    assert record.notes[0] == "212 bytes that are no whole records of miniSEED were left out"
    (record,) = miniseed.FORMAT.read(write(EAST)[:1024] + bytes(256) + write(EAST)[1024:], "made")
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=1e-6)
    assert record.notes[0].startswith("256 bytes that are no whole records")
    (record,) = miniseed.FORMAT.read(write(EAST).replace(b"TOWN", b"\xff\xfe\xff\xfe"), "made")
    assert record.station == "NP.ÿþÿþ"
