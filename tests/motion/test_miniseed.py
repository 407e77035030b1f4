"""MiniSEED: counts, units, gaps, and what is said of other files."""

import importlib.util
import io
import sys

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import miniseed
from assess.motion.formats._obspy import read_traces
from tests.motion.writers import EAST, THREE, Signal
from tests.motion.writers import mseed as write

if importlib.util.find_spec("obspy") is None:
    pytest.skip("ObsPy is not installed", allow_module_level=True)


def test_channels() -> None:
    records = miniseed.read(write(*THREE), "made")
    assert [record.channel for record in records] == ["HNE", "HNN", "HNZ"]
    assert [(record.azimuth_deg, record.vertical) for record in records] == [(90.0, False), (0.0, False), (None, True)]
    record = records[0]
    assert (record.station, record.start, record.corrected) == ("NP.TOWN", "2018-11-30 17:28:10 UTC", False)
    assert record.notes == (
        'the file does not say its unit: taken as m/s2, which ObsPy\'s remove_response(output="ACC") leaves',
    )


def test_two_stations_of_one_code() -> None:
    records = miniseed.read(write(EAST) + write(EAST, station="HILL"), "made")
    assert {record.channel for record in records} == {"NP.TOWN..HNE", "NP.HILL..HNE"}


def test_a_gap_is_bridged_and_noted() -> None:
    (record,) = miniseed.read(write(EAST, gap_after=200), "made")
    assert any("a gap of 1.01 s at 1.99 s is bridged by a straight line" in note for note in record.notes)
    # 199 samples of 0.01 s, resampled to 0.005 s.
    assert record.acceleration[:398:2] == pytest.approx(EAST.acceleration[:199], abs=1e-6)


def test_a_channel_that_is_not_read_does_not_lose_the_others() -> None:
    (record,) = miniseed.read(write(EAST) + write(EAST, code="BHE"), "made")
    assert any(note.startswith("NP.TOWN..BHE of the file is left out: the channel's code") for note in record.notes)


COUNTS = Signal(np.rint(1e5 * EAST.acceleration))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (write(COUNTS, whole=True), r"it holds raw counts, not accelerations\. Remove the instrument's response with "
         r'ObsPy \(stream\.remove_response\(inventory, output="ACC"\)\) and save that as miniSEED, or as plain CSV'),
        (write(COUNTS), r"the peak is .* g, expected at most 50 g: is the unit right"),
        (write(EAST, code="BHE"), r"code 'BHE' is not that of an accelerometer \(such as HNE\)\. Save .* as plain CSV"),
        (write(EAST)[:100], r"ObsPy (cannot read it|finds no channel)"),
        (write(Signal(EAST.acceleration * np.nan)), r"sample 1 is not a number"),
    ],
)  # fmt: skip
def test_damage(data: bytes, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        miniseed.read(data, "made")


def test_obspy_writes_what_is_read() -> None:
    (trace,), _ = read_traces(write(COUNTS, whole=True), "MSEED")
    trace.data = trace.data / 1e5
    target = io.BytesIO()
    trace.write(target, format="MSEED", encoding="FLOAT64")
    (record,) = miniseed.read(target.getvalue(), "made")
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=1e-5)


def test_text_is_refused() -> None:
    # Encoding 0: characters, as of the log of a recorder.
    data = write(EAST)
    at = data.index(b"\x03\xe8\x00\x00\x04") + 4
    text = bytearray(data[:512])
    text[at] = 0
    with pytest.raises(RecordError, match=r"it holds no numbers\. Give a channel of an accelerometer|ObsPy cannot"):
        miniseed.read(bytes(text), "made")


def test_cut_off() -> None:
    (record,) = miniseed.read(write(EAST)[:-300], "made")
    assert record.acceleration.size == 300
    assert record.notes[0].startswith("ObsPy warns: ")


def test_names_that_are_no_text() -> None:
    # The library in C quotes the name in its message: that fails where only a callback could tell.
    data = write(EAST)[:512].replace(b"TOWN", b"\xff\xfe\xff\xfe")
    unpacked_wrongly = data.replace(b"\x03\xe8\x00\x00\x04", b"\x03\xe8\x00\x00\x0b")
    with pytest.raises(RecordError, match=r"ObsPy cannot read it \(.*codec can't decode.*\)\. Get the file again"):
        miniseed.read(unpacked_wrongly, "made")


def test_without_obspy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "obspy", None)
    assert miniseed.recognises(write(EAST))
    with pytest.raises(RecordError, match=r'needs the package ObsPy: install it with: pip install "assess\[obspy\]"'):
        miniseed.read(write(EAST), "made")
