"""GeoNet V1A and V2A: their headers, and what is said of damaged files."""

import numpy as np
import pytest

from assess.errors import RecordError
from assess.i18n import gettext, load_catalogue, speaking
from assess.motion.formats import geonet
from tests.motion.writers import EAST, THREE, Signal, geonet as write, wave
from tests.refusals import check_refusals


@pytest.mark.parametrize("corrected", [False, True])
def test_header(corrected: bool) -> None:
    record, _, up = geonet.FORMAT.read(write(*THREE, corrected=corrected), "made")
    assert (record.channel, record.azimuth_deg, record.corrected) == ("N90E", 90.0, corrected)
    assert (up.channel, up.azimuth_deg, up.vertical) == ("Up", None, True)
    assert (record.station, record.event) == ("Town Hall (WTMC)", "5 km south-west of Waiau")
    assert record.start == "2016 November 13 11:02:56 UT"
    assert (record.time_step, record.notes) == (0.01, ())
    assert record.header_pfa == pytest.approx(record.file_pfa, abs=1e-4)
    (record,) = geonet.FORMAT.read(write(Signal(wave(), 242.0)), "made")
    assert (record.channel, record.azimuth_deg) == ("S62W", 242.0), "by quadrants"


def test_a_dead_component_does_not_lose_the_others() -> None:
    records = geonet.FORMAT.read(write(EAST, Signal(np.zeros(400), 360.0)), "made")
    assert len(records) == 1
    (note,) = records[0].notes
    assert note == "channel 2 of the file is left out: every sample is 0 m/s2: the channel holds no motion"
    with speaking(load_catalogue("it")):
        assert gettext(note).startswith("canale 2 del file è escluso: tutti i campioni valgono 0 m/s2")


DATA, RAW = write(EAST), write(EAST, corrected=False)


def test_damage() -> None:
    check_refusals(RecordError, lambda data: geonet.FORMAT.read(data, "made"), [
        (b"hello", r'no line says "accelerogram"\. Get the file again'),
        (DATA[:600], r"line \d+: number \d is missing\. Get the file again"),
        (DATA.replace(b"     400", b"     x00", 1), r"line 20: number 4 is missing"),
        (DATA.replace(b"     400", b"   1e300", 1), r"announces 1e\+300 data values"),
        (DATA.replace(b"  0.0100", b"  0.0000", 1), r"the time step is 0 s"),
        (DATA.replace(b"mm/s/s at", b"miles  at", 1), r"line 14: the peak and its unit cannot be read"),
        (RAW.replace(b"in units of 1.00", b"in units of 0.00", 1), r"line 11: the unit cannot be read"),
        (DATA[:4000], r"cut short: it has \d+ of the 400 data values that its header announces"),
        (DATA.replace(b"\r\n     0.0", b"\r\n    13x8", 1), r"line 27: '13x8' is not a number\. Get the file again"),
    ])  # fmt: skip
