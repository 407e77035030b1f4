"""Floors without a record: which ground rules, how peaks go in height, and by how much the draws scatter."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assess.intensity import RATIO, SHAKINGS
from assess.model import Building, Floor, FloorRecord, Inventory
from assess.motion.beam import shake_record
from assess.motion.floor_medians import find_medians
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.pipeline.demand import build_demands, scale_demands
from assess.pipeline.run import compute
from assess.settings import Settings
from tests.pipeline.rows import read
from tests.workbooks import RECORDS, UNVERIFIED

SEVEN = "MMI VII, very strong"
(RECORD,) = read_records(RECORDS / "0165a_u.smc")
BUILDING = {"period": 0.8, "height": 40.0}
ROOF = Floor(row=9, floor="R", elevation=40.0)
KNOWN = {"X": (FloorRecord(name="known", record=RECORD),)}


def _demands(*floors, scenario="as filled", **building):
    given = Building(**(BUILDING | building))
    inventory = Inventory(source=Path("w.xlsx"), sha256="0" * 64, building=given, floors=floors, items=())
    return build_demands(inventory, scenario)


def _x(demands, floor):
    (one,) = demands[floor, "X"]
    return one


def _at(z, name="", **given):
    return Floor(row=2, floor=name or f"{z:g}", elevation=z, **given)


def _find(place, ground, period=0.8):
    """Return the medians at z/h `place` of a ground with these peaks."""
    return np.array(ground) * find_medians(period, place, "unknown", ground[1] / ground[0])


def _peaks(one):
    return np.array([one.pfa, one.pfv])


# --- which ground rules


@pytest.mark.parametrize(
    ("building", "ground"),
    [
        ({"ground_pga": 3.0}, (3.0, 3.0 * RATIO)),
        ({"ground_pga": 3.0, "ground_pgv": 0.5, "sds": 20.0}, (3.0, 0.5)),
        ({"ground_pgv": 0.5}, (0.5 / RATIO, 0.5)),
        ({"sds": 10.0, "shaking": SEVEN}, (4.0, 4.0 * RATIO)),
        ({"shaking": SEVEN}, (SHAKINGS[SEVEN].pga, SHAKINGS[SEVEN].pgv)),
        ({"shaking": SEVEN, "ground_pgv": 0.5}, (SHAKINGS[SEVEN].pga, 0.5)),
    ],
    ids=["PGA", "PGA and PGV", "PGV", "SDS", "Shaking", "Shaking and PGV"],
)
def test_floors_follow_the_medians_of_the_ground(building, ground):
    demands = _demands(ROOF, _at(10.0), _at(0.0), _at(-4.0), **building)
    assert {one.source for parallel in demands.values() for one in parallel} == {"beam"}
    for name, place in (("R", 1.0), ("10", 0.25), ("0", 0.0), ("-4", 0.0)):
        assert _peaks(_x(demands, name)) == pytest.approx(_find(place, ground)), name
    assert _x(demands, "R").amplification == pytest.approx(_x(demands, "R").pfa / ground[0])


@pytest.mark.parametrize("z", [0.0, -3.0])
def test_typed_peaks_at_grade_come_before_the_ground_of_the_building(z):
    base = _at(z, "G", pfa={"X": 2.0}, pfv={"X": 0.4})
    one = _x(_demands(base, ROOF, ground_pga=9.0, ground_pgv=9.0), "R")
    assert _peaks(one) == pytest.approx(_find(1.0, (2.0, 0.4)))
    assert one.drawn.record is None


def test_a_record_at_grade_comes_first_and_passes_through_the_beam():
    demands = _demands(_at(0.0, "G", records=KNOWN), ROOF, ground_pga=9.0)
    one, motion = _x(demands, "R"), treat(RECORD)
    assert one.drawn.record.record is _x(demands, "G").record
    assert (one.label, one.source, one.flags) == ("known, beam", "beam", ("drawn_building",))
    wanted = shake_record(motion.acceleration, motion.time_step, one.drawn.building, 1.0)
    assert (one.pfa, one.pfv) == pytest.approx(wanted)


# --- in height


def _factor(demands, name, ground):
    one = _x(demands, name)
    return _peaks(one) / _find(one.height_ratio, ground)


def test_the_factor_of_typed_floors_goes_on_in_height_and_down_to_the_ground():
    ground = (3.0, 0.4)
    low, high = (_at(z, pfa={"X": pfa}, pfv={"X": pfv}) for z, pfa, pfv in ((16.0, 8.0, 1.5), (32.0, 4.0, 0.5)))
    demands = _demands(_at(0.0), _at(8.0), low, _at(24.0), high, ROOF, ground_pga=3.0, ground_pgv=0.4)
    first, second = (_factor(demands, name, ground) for name in ("16", "32"))
    assert (first > 1.01).all()
    assert (second < 0.99).all()
    assert _factor(demands, "0", ground) == pytest.approx([1, 1])
    assert _factor(demands, "8", ground) == pytest.approx(np.sqrt(first)), "half way up to the first"
    assert _factor(demands, "24", ground) == pytest.approx(np.sqrt(first * second)), "half way between both"
    assert _factor(demands, "R", ground) == pytest.approx(second), "above the highest it goes on"


def test_beyond_the_highest_record_its_factor_goes_on():
    """On a known ground; between floors with records it is interpolated as the peaks are."""
    low, high = (_at(z, name, records=KNOWN) for z, name in ((10.0, "A"), (20.0, "C")))
    demands = _demands(low, _at(15.0), high, ROOF, ground_pga=3.0, ground_pgv=0.4)
    assert (_x(demands, "15").source, _x(demands, "15").between) == ("interpolated", ("A", "C"))
    assert _peaks(_x(demands, "15")) == pytest.approx(_peaks(_x(demands, "A")))
    assert _factor(demands, "R", (3.0, 0.4)) == pytest.approx(_factor(demands, "C", (3.0, 0.4)))


def test_without_a_ground_a_floor_follows_from_another_by_the_beam_alone():
    known = _at(20.0, pfa={"X": 4.0})
    demands = _demands(known, _at(10.0), ROOF)
    for name, place in (("10", 0.25), ("R", 1.0)):
        times = _find(place, (1.0, RATIO)) / _find(0.5, (1.0, RATIO))
        assert _peaks(_x(demands, name)) == pytest.approx(_peaks(_x(demands, "20")) * times)
    assert _x(demands, "R").amplification is None


# --- typed peaks


def test_a_typed_pfv_is_kept_and_a_missing_one_follows_from_pfa():
    both, one = _at(20.0, "A", pfa={"X": 4.0}, pfv={"X": 0.123}), _at(20.0, "B", pfa={"X": 4.0})
    demands = _demands(both, one, ground_pga=3.0, ground_pgv=0.4)
    beam = _find(0.5, (3.0, 0.4))
    assert _peaks(_x(demands, "A")) == pytest.approx([4.0, 0.123])
    assert _peaks(_x(demands, "B")) == pytest.approx([4.0, 4.0 * beam[1] / beam[0]])
    assert [_x(demands, name).drawn.target.meets for name in "AB"] == ["peaks", "pfa"]


def test_scaled_demands_keep_their_proportions():
    floors = (_at(0.0, "G"), _at(20.0, "A", pfa={"X": 4.0}), ROOF)
    demands = _demands(*floors, ground_pga=3.0, ground_pgv=0.4)
    twice = scale_demands(demands, 2.0)
    scaled = _demands(*floors[::2], replace(floors[1], pfa={"X": 8.0}), ground_pga=6.0, ground_pgv=0.8)
    for name in "GAR":
        one, other = (_x(each, name) for each in (twice, scaled))
        assert _peaks(one) == pytest.approx(2 * _peaks(_x(demands, name)))
        assert _peaks(one) == pytest.approx(_peaks(other))
        assert one.drawn.target.factor == other.drawn.target.factor == 6.0
        assert (one.drawn.ground, one.drawn.target.anchors) == (other.drawn.ground, other.drawn.target.anchors)


# --- what is not known


def test_what_is_not_known_of_a_floor_or_its_building_is_drawn():
    one = _x(_demands(Floor(row=2, floor="A"), ground_pga=3.0), "A")
    assert (one.height_ratio, one.flags) == (None, ("drawn_building", "unknown_height"))
    assert one.pfa == pytest.approx(3.0 * find_medians(0.8, None, "unknown", RATIO)[0])
    assert not one.drawn.is_unknown
    bare = {"period": None, "height": None}
    one = _x(_demands(Floor(row=2, floor="A"), ground_pga=3.0, **bare), "A")
    assert one.flags == ("drawn_building", "unknown_building")
    assert one.pfa == pytest.approx(3.0 * find_medians(None, None, "unknown", RATIO)[0])
    assert one.drawn.is_unknown
    for known in ({"period": 1.0}, {"height": 9.0}, {"storeys": 3}):
        other = _x(_demands(Floor(row=2, floor="A"), ground_pga=3.0, **(bare | known)), "A")
        assert "unknown_building" not in other.flags


# --- dispersions


@pytest.mark.parametrize(
    ("floors", "building", "given", "used"),
    [
        ((_at(0.0, "R", records=KNOWN),), {}, None, 0.4),
        ((_at(0.0, "R", records=KNOWN),), {}, 0.2, 0.2),
        ((_at(0.0, "G", records=KNOWN), ROOF), {"shaking": SEVEN}, None, 0.4),
        ((_at(0.0, "G", records=KNOWN), ROOF), {"shaking": SEVEN}, 0.2, 0.2),
        ((ROOF,), {"shaking": SEVEN}, None, 0.88),
        ((ROOF,), {"shaking": SEVEN}, 0.2, 0.88),
        ((ROOF,), {"shaking": SEVEN}, 1.0, 1.0),
        *(((ROOF,), building, given, given or 0.0)
          for building in ({"ground_pga": 3.0}, {"sds": 9.0}, {"scenario": "NTC 2018", "ground_pga": 3.0})
          for given in (None, 0.2)),
        *(((_at(9.0, "R", pfa={"X": 3.0}),), {"shaking": SEVEN}, given, given or 0.0) for given in (None, 0.2)),
    ],
)  # fmt: skip
def test_by_how_much_a_floor_scatters(floors, building, given, used):
    """Drawn motions scatter by themselves; what gives the ground adds its own; a code adds none unless told."""
    assert _x(_demands(*floors, motion_uncertainty=given, **building), "R").dispersion == used


# --- what is said of the ground, and what comes of it

TALL = {"item": "tall", "floor": "1", "breadth": 60, "width": 60, "height": 250, "axis": "X"}


def _read(**building):
    return read([TALL], [{"floor": "1", "elevation": 9}], **({"height": 12, "period": 0.5} | building))


@pytest.mark.parametrize(
    ("building", "severity", "text"),
    [
        ({"ground_pga": 0.3}, "note", "Ground PGV is blank: PGV/PGA is drawn as in earthquakes of magnitude"),
        ({"ground_pgv": 21}, "warning", "Ground PGV is filled in without Ground PGA, which is drawn: 0.200 g in"),
        ({"ground_pga": 0.3, "ground_pgv": 2.9}, "warning", "the ground's PGA is 9.67 cm/s per g, outside 10 to 600"),
        ({"ground_pga": 0.1, "ground_pgv": 61}, "warning", "the ground's PGA is 610 cm/s per g, outside 10 to 600"),
        ({"ground_pga": 0.3, "ground_pgv": 30}, None, "Ground PGV"),
    ],
)  # fmt: skip
def test_what_is_said_of_ground_pgv(building, severity, text):
    found = compute(_read(**building), UNVERIFIED).problems
    said = [one.severity for one in found if text in one.message]
    assert said == ([severity] if severity else [])


def _simulate(inventory, runs):
    assessment = compute(inventory, Settings(runs=runs, verify="all"))
    (joint,) = assessment.joints.values()
    return joint


@pytest.mark.slow
def test_at_one_pga_a_faster_ground_topples_more_and_draw_k_is_the_same_however_many_there_are():
    slow, fast = (_simulate(_read(ground_pga=0.4, ground_pgv=pgv), 50).fell.mean() for pgv in (12, 120))
    assert slow + 0.2 < fast
    inventory = _read(ground_pga=0.4)
    few, many = (_simulate(inventory, runs) for runs in (30, 70))
    np.testing.assert_array_equal(few.rotation, many.rotation[:, :30])
    assert many.rotation.any()
