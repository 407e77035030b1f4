"""COSMOS: volumes, units and directions, and what is said of damaged files."""

from functools import partial

import pytest

from assess.errors import RecordError
from assess.motion.formats import cosmos
from assess.units import GRAVITY
from tests.motion.damage import changed, read_only
from tests.motion.writers import EAST, NORTH, THREE, UP, cosmos as write
from tests.refusals import check_refusals

DATA = write(EAST)
read_one = partial(read_only, cosmos.FORMAT)


def test_text() -> None:
    record = read_one(DATA)
    assert (record.channel, record.location) == ("1", "Roof NW corner")
    assert record.station == "USGS  AK:Anchorage;Town Hall (NP-8040)"
    assert record.event == "Record of Made-up Earthquake of Fri Nov 30, 2018 17:29 UTC"
    assert record.start == "2018/11/30 17:29:06.332 UTC"
    assert record.header_pfa == pytest.approx(record.file_pfa, abs=1e-5)
    assert record.notes == ()


def test_stage_decides_what_is_corrected() -> None:
    assert [read_one(write(EAST, stage=stage)).corrected for stage in (1, 2)] == [False, True]


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("cm/sec2(04)", 0.01), ("g(02)", GRAVITY), ("gal(10)", 0.01), ("mg(11)", GRAVITY / 1000), ("in/sec2(07)", 0.0254)],
)
def test_units(unit: str, factor: float) -> None:
    record = read_one(write(EAST, unit=unit, factor=factor))
    assert record.acceleration == pytest.approx(EAST.acceleration, abs=factor * 1e-5)
    assert record.header_pfa == pytest.approx(record.file_pfa, rel=0.001)


def test_directions_by_number_the_recorder_s_step_and_velocities_beside_accelerations() -> None:
    records = cosmos.FORMAT.read(write(*THREE, text_direction=False), "made")
    assert [(record.azimuth_deg, record.vertical) for record in records] == [(90, False), (360, False), (None, True)]
    assert read_one(changed(DATA, b"    10.000000", b"  -999.000000")).time_step == 0.005
    both = write(EAST) + write(UP, kind="Corrected velocity", unit="cm/sec(05)") + write(NORTH)
    assert [record.channel for record in cosmos.FORMAT.read(both, "made")] == ["1", "2"]


def test_damage() -> None:
    check_refusals(RecordError, read_one, [
        (b"hello", r"no line names a version of the COSMOS format\. Get the file again"),
        (write(EAST, kind="Corrected velocity"), r"the file holds corrected velocity, not accelerations\. Give"),
        (write(EAST, unit="counts(50)", factor=1e-5),
         r"the file holds raw data in counts \(volume 0\), not acc.*Give volume 1 or 2 .*or convert it to m/s2"),
        (write(EAST, unit="furlong(99)"), r"the unit 'furlong' with the code 99 is not a known unit of acceleration"),
        (write(EAST, unit="g(04)"), r"the unit 'g' with the code 4 is not a known unit"),
        (DATA[:1500], r"the header is incomplete\. Get the file again|cut short"),
        (DATA[:6000], r"cut short: it has \d+ of the 400 data values that its header announces"),
        (changed(DATA, b"400  accel", b"999999999  accel"), r"announces 999999999 data values"),
        (changed(DATA, b" 100 Integer", b" 100 Inteeer"), r"the header is incomplete"),
        (DATA.replace(b"    10.000000", b"     0.000000").replace(b"     0.005000", b"     0.000000"), r"step is 0 s"),
        (write(EAST, kind="Response spectra of acceleration"), r"the file holds response spectra of acceleration, not"),
    ])  # fmt: skip
