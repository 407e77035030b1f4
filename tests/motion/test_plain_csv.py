"""Plain CSV: what it may look like, and what is said of mistakes."""

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.formats import plain_csv
from assess.motion.record import Record
from assess.units import ACCELERATION, GRAVITY
from tests.refusals import check_refusals

ROWS = 20


def csv_text(heading: str = "time [s],north [g]", *, comments: str = "", last: str = "") -> str:
    channels = heading.count(",")
    rows = [",".join([f"{0.01 * row:.2f}", *[f"{0.001 * (row % 7 - 3):.4f}"] * channels]) for row in range(ROWS)]
    return comments + "\n".join([heading, *rows, last])


def read_csv(text: str) -> tuple[Record, ...]:
    return plain_csv.FORMAT.read(text.encode(), "made.csv")


@pytest.mark.parametrize("unit", ACCELERATION)
def test_csv_round_trip(unit: str) -> None:
    wanted = 2 * np.sin(np.arange(500) / 9)
    rows = "\n".join(f"{0.02 * row:.2f},{value / ACCELERATION[unit]!r}" for row, value in enumerate(wanted.tolist()))
    (record,) = read_csv(f"time [s],roof [{unit}]\n{rows}\n")
    np.testing.assert_allclose(record.acceleration, wanted, rtol=1e-12)
    assert (record.time_step, record.channel, record.notes) == (0.02, "roof", ())


def test_csv_comments_of_which_unknown_ones_are_noted() -> None:
    keys = "# station: Town hall\n# event: Test: one\n# start: 2020-01-01\n# location: roof\n# just words\n"
    azimuth = '"# azimuth: north=0, East=90 deg, z=up",,\n# corrected: Yes\n'
    north, east, top = read_csv(csv_text("time [s],North [g],east [gal],z [m/s²]", comments="\n" + keys + azimuth))
    assert (north.station, north.event, north.start, north.location) == ("Town hall", "Test: one", "2020-01-01", "roof")
    assert (north.azimuth_deg, east.azimuth_deg, top.azimuth_deg) == (0.0, 90.0, None)
    assert (top.vertical, north.vertical, north.corrected, north.notes) == (True, False, True, ())
    assert north.file_pfa == pytest.approx(0.003 * GRAVITY)
    (record,) = read_csv(csv_text(comments="# colour: red\n# azimuth: 45\n"))
    assert record.notes[0].startswith("comments that are not used: 'colour' (known: station, event, start, location")
    assert (record.azimuth_deg, record.corrected) == (45.0, False)


@pytest.mark.parametrize(
    ("name", "azimuth", "vertical"),
    [("A 45 deg", 45.0, False), ("B 315°", 315.0, False), ("CH3 Up", None, True), ("U-D", None, True),
     ("zone", None, None)],
)  # fmt: skip
def test_csv_direction_from_the_name(name: str, azimuth: float | None, vertical: bool | None) -> None:
    (record,) = read_csv(csv_text(f"time [s],{name} [g]"))
    assert (record.channel, record.azimuth_deg, record.vertical) == (name, azimuth, vertical)


@pytest.mark.parametrize("separator", [";", "\t"])
def test_csv_decimal_comma(separator: str) -> None:
    text = csv_text().replace(",", separator).replace(".", ",")
    (record,) = read_csv(text)
    np.testing.assert_allclose(record.acceleration, read_csv(csv_text())[0].acceleration)


def test_csv_as_spreadsheets_write_it() -> None:
    text = csv_text(" Time [S] , Süd [ CM/S2 ]").replace("\n", ",,\r\n")
    for encoding in ("utf-8", "utf-8-sig", "latin-1"):
        data = text.encode(encoding)
        assert plain_csv.FORMAT.recognises(data)
        assert plain_csv.FORMAT.read(data, "made.csv")[0].channel == "Süd"


def test_csv_is_recognised() -> None:
    for heading in ("time,north [g]", "TIME [s];a [g]", '"time [s]",a [g]', "# note\n\ntime [s]\ta [g]"):
        assert plain_csv.FORMAT.recognises(heading.encode()), heading


def test_csv_uneven_times_are_resampled() -> None:
    rows = "\n".join(f"{time:.4f},{time % 0.3:.4f}" for time in np.linspace(0, 1, 200) ** 1.1)
    (record,) = read_csv("time [s],a [g]\n" + rows)
    assert record.time_step == 0.005
    assert any("unevenly sampled" in note for note in record.notes)


UNKNOWN_UNIT = (
    r"line 1: 'north{}' has no known unit of acceleration \(known: g, m/s2, cm/s2, gal\)\. Write it .*: north \[cm/s2\]"
)


def test_csv_mistakes() -> None:
    check_refusals(RecordError, read_csv, [
        (csv_text("time [s],north"), UNKNOWN_UNIT.format("")),
        (csv_text("time [s],north [cm/s]"), UNKNOWN_UNIT.format(r" \[cm/s\]")),
        (csv_text("time,north [g]"), r"line 1: 'time' needs its unit, seconds: time \[s\]"),
        (csv_text("time [ms],north [g]"), r"line 1: 'time \[ms\]' needs its unit, seconds"),
        ("time [s]\n0.0\n", r"line 1: there is no channel next to time\. Add one, such as: north \[cm/s2\]"),
        (csv_text("time [s],a [g],A [gal]"), r"line 1: two channels are called 'a'\. Give each its own name"),
        (csv_text(last="1.0,1x2"), r"line 22: '1x2' is not a number"),
        (csv_text(last="1.0,nan"), r"line 22: 'nan' is not a number"),
        (csv_text(last="1.0,1_0"), r"line 22: '1_0' is not a number"),
        (csv_text(last="1.0;1,2x").replace(",", ";").replace("1;2x", "1,2x"), r"line 22: '1,2x' is not a number"),
        (csv_text(last="1.0"), r"line 22: the number of cells is 1, but there are 2 headings"),
        (csv_text(last="1.0,2,3"), r"line 22: the number of cells is 3, but there are 2 headings"),
        (csv_text(last="1.0,1e300"), r"channel 'north': the peak is 1e\+300 g, expected at most 50 g"),
        (csv_text(last="1.0,1e308"), r"channel 'north': sample 21 is not a number"),
        (csv_text(comments="# azimuth: west=270\n"), r"an azimuth is given for 'west', but the channels are: north"),
        (csv_text(comments="# azimuth: 400\n"),
         r"the azimuth is '400', expected 0 to 360 degrees clockwise from north, or up"),
        (csv_text(comments="# azimuth: 22,5\n"),
         r"several azimuths need the names of their channels, such as: # azimuth"),
        (csv_text(comments="# corrected: maybe\n"), r"corrected is 'maybe', expected yes or no"),
        ("time [s],north [g]\n\n", r"there are no rows below the headings"),
        ("# only: comments\n", r"there is no row of headings\. Add one, such as: time \[s\], north \[cm/s2\]"),
        ("time [s],north [g]\n0,1\n0.01,2\n", r"channel 'north': the number of samples is 2, expected at least 10"),
    ])  # fmt: skip
