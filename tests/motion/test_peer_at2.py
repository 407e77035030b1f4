"""PEER AT2: both kinds of header, and what is said of other files."""

from functools import partial

from assess.errors import RecordError
from assess.motion.formats import peer_at2
from tests.motion.damage import read_only
from tests.motion.writers import UP, Signal, at2, wave
from tests.refusals import check_refusals

DATA = at2()
read_one = partial(read_only, peer_at2.FORMAT)


def test_both_headers() -> None:
    new, old = read_one(DATA), read_one(at2(old=True))
    names = [(one.event, one.station, one.channel, one.azimuth_deg) for one in (new, old)]
    assert names[0] == ("Made-up, 10/18/1989", "Town Hall, roof", "090", 90.0)
    assert names[1] == ("MADE-UP 5/19/40 0439", "TOWN HALL", "090", 90.0)
    assert (new.acceleration == old.acceleration).all()
    assert new.corrected
    assert new.header_pfa is None


def test_the_last_line_may_be_partial_and_a_few_numbers_beyond_are_left_out() -> None:
    assert read_one(at2(Signal(wave(count=398)))).acceleration.size == 398
    assert read_one(DATA + b" 0.1").notes == ("1 number beyond the 400 that the header announces: left out",)


def test_vertical_and_titles_that_say_little() -> None:
    assert (read_one(at2(UP)).vertical, read_one(at2(UP)).channel) == (True, "UP")
    bare = read_one(DATA.replace(b"Made-up, 10/18/1989, Town Hall, roof, 090", b""))
    assert (bare.event, bare.station, bare.channel, bare.azimuth_deg) == ("", "", "1", None)


def test_damage() -> None:
    check_refusals(RecordError, read_one, [
        (at2(kind="VELOCITY", unit="CM/S"), r"the file holds velocities, not accelerations\. Give the \.AT2 file"),
        (at2(kind="DISPLACEMENT", unit="CM"), r"the file holds displacements, not accelerations"),
        (at2(unit="FURLONGS"), r"'FURLONGS' is not a known unit of acceleration\. Get the file again"),
        (b"hello", r"the header does not name what the file holds\. Get the file again"),
        (DATA.replace(b"NPTS=", b"NUTS="), r"line 4 does not give the number of points and their time step"),
        (DATA.replace(b"0.0100", b"0.0.00"), r"line 4 does not give the number of points and their time step"),
        (DATA.replace(b"0.0100", b"0.0000"), r"the time step is 0 s"),
        (DATA.replace(b"NPTS=   400", b"NPTS=   0"), r"announces 0 data values"),
        (DATA.replace(b"NPTS=   400", b"NPTS= 999999999"), r"announces 999999999 data values, expected 1 to 8,0"),
        (DATA.replace(b"NPTS=   400", b"NPTS=   300"), r"more data values than the 300 that its header announces"),
        (DATA[:-10] + b"x.x", r"number 400 of the data: '\S+x\.x' is not a number\. Get the file again"),
        (DATA[:3000], r"cut short: it has \d+ of the 400 data values that its header announces"),
    ])  # fmt: skip
