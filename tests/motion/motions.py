"""Motions for the tests of spectra and ensembles: of the records in the repository, and made up."""

from functools import cache
from pathlib import Path

from assess.arrays import FloatArray
from assess.motion.formats import read_records
from assess.motion.record import Motion, treat
from tests.motion.test_record import make_record

ROOT = Path(__file__).parents[2]
MARKET = ROOT / "inventories" / "records" / "575-market"
SAMPLES = ROOT / "samples" / "records"
ROOF, TWELFTH, GROUND = "1103.HN2.NP.RE_a", "0165a_u", "np01002p_4225a_a"
"""Berkeley, roof (T1 of 0.8 s); Alhambra, 12th floor (2 s); a free-field record."""


@cache
def read_motion(name: str) -> Motion:
    """Return a treated motion: a letter is a channel of 575 Market Street, all else a file of samples/records."""
    path = MARKET / f"891018_1.cra-1.0210{name}.smc" if len(name) == 1 else SAMPLES / f"{name}.smc"
    (record,) = read_records(path)
    return treat(record)


def make_motion(acceleration: FloatArray, time_step: float) -> Motion:
    """Return a motion of these samples [m/s2], untreated."""
    return treat(make_record(acceleration, time_step, corrected=True))


def cut(name: str, start: float, end: float) -> Motion:
    """Return part of a motion, between two times [s]."""
    motion = read_motion(name)
    first, last = round(start / motion.time_step), round(end / motion.time_step)
    return make_motion(motion.acceleration[first : last + 1].copy(), motion.time_step)
