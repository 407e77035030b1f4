"""SAC: the rule of the unit, and what is said of files that do not say it."""

import io
import struct
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import sac
from assess.units import GRAVITY
from tests.motion.damage import read_only
from tests.motion.writers import EAST, UP, sac as write
from tests.refusals import check_refusals

read_one = partial(read_only, sac.FORMAT)


def test_header() -> None:
    record = read_one(write(unit="m/s2"))
    assert (record.channel, record.azimuth_deg, record.vertical) == ("HNE", 90.0, False)
    assert (record.station, record.event, record.start) == ("CJ.TOWN", "Made-up", "2019-07-06 03:19:52.000 UTC")
    assert record.notes == ("the unit is that of the header's field KUSER0: m/s2",)
    assert read_one(write(UP, unit="m/s2")).vertical


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("g", 1 / GRAVITY), ("m/s2", 1.0), ("m/s**2", 1.0), ("cm/s2", 100.0), ("gal", 100.0), ("GAL", 100.0)],
)
def test_the_unit_of_kuser0(unit: str, factor: float) -> None:
    record = read_one(write(unit=unit, factor=factor, meaning=8))
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=1e-6)


@pytest.mark.parametrize("order", ["<", ">"])
def test_nanometres_of_either_order_of_bytes(order: str) -> None:
    record = read_one(write(meaning=8, factor=1e9, order=order))
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=1e-6)
    assert record.notes == ("the unit is nm/s2, what the type of the samples (IDEP) means",)


def test_an_offset_is_not_part_of_the_peak() -> None:
    record = read_one(write(replace(UP, acceleration=UP.acceleration + GRAVITY), unit="m/s2"))
    assert record.file_pfa < 0.5


MEND = r"Write the unit into the header's field KUSER0 \(g, m/s2, cm/s2; in ObsPy: .*\), or save .* as plain CSV"


def test_damage() -> None:
    check_refusals(RecordError, read_one, [
        (write(), rf"the file does not give its unit\. {MEND}"),
        (write(unit="furlong"), r"the file does not give its unit"),
        (write(meaning=8, factor=1 / GRAVITY),
         rf"unit is nm/s2, but the peak would then be \S+ cm/s2: the unit must be a different one\. {MEND}"),
        (write(meaning=7, unit="g"),
         r"the file holds velocities, not accelerations\. Give the acceleration file of the same channel"),
        (write(meaning=6), r"the file holds displacements, not accelerations"),
        (write(kind=2), r"the file holds no evenly sampled time series\. Give the record itself"),
        (write(even=0), r"the file holds no evenly sampled time series"),
        (write(count=500_000_000),
         r"the number of data values is 400, but 500000000 in the header\. Get the file again"),
        (write(count=-5), r"but -5 in the header"),
        (write()[:1000], r"the number of data values is 92, but 400 in the header"),
        (write(unit="g", count=399), r"the number of data values is 400, but 399 in the header\. Get the file again"),
        (write()[:600], r"the header is not that of a SAC file\. Get the file again"),
        (write(unit="g", factor=float("nan")), r"sample 1 is not a number"),
        (write(unit="g", factor=1e30), r"the peak is .* g, expected at most 50 g"),
    ])  # fmt: skip


def test_obspy_writes_what_is_read() -> None:
    obspy = pytest.importorskip("obspy")
    (trace,) = obspy.read(io.BytesIO(write()))
    trace.stats.sac.kuser0 = "m/s2"
    trace.stats.sac.kevnm = "A longer name"
    trace.stats.starttime += 2.5
    target = io.BytesIO()
    trace.write(target, format="SAC")
    record = read_one(target.getvalue())
    np.testing.assert_array_equal(record.acceleration, trace.data)
    assert (record.event, record.start) == ("A longer name", "2019-07-06 03:19:54.500 UTC")


def test_a_header_without_a_date_or_an_event() -> None:
    data = bytearray(write(unit="g"))
    data[280:284] = struct.pack("<i", -12345)
    assert read_one(bytes(data)).start == ""
    data[448:464] = b"-12345  -12345  "
    assert read_one(bytes(data)).event == ""
