from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

import assess
from assess.model import AXES, Building, Floor, FloorRecord, Inventory
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.pipeline.demand import Demand, _interpolate, build_demands
from tests.workbooks import RECORDS

G = 9.80665
SMC = RECORDS / "0165a_u.smc"
CORRECTED = RECORDS / "np01002p_4225a_a.smc"


def _inventory(*floors, **building):
    return Inventory(source=Path("w.xlsx"), sha256="0" * 64, building=Building(**building), floors=floors, items=())


def _record(path):
    (record,) = read_records(path)
    return FloorRecord(name=path.name, record=record)


def _one(demands, floor, axis):
    (demand,) = demands[floor, axis]
    assert isinstance(demand, Demand)
    return demand


def test_given_peaks_are_used_as_they_are_and_a_record_comes_before_them():
    given = {"pfa": {"X": 3.0, "Y": 2.0}, "pfv": {"X": 0.4, "Y": 0.3}}
    demands = build_demands(_inventory(Floor(row=2, floor="1", elevation=3.0, **given)), "as filled")
    assert [(_one(demands, "1", axis).pfa, _one(demands, "1", axis).pfv) for axis in "XY"] == [(3.0, 0.4), (2.0, 0.3)]
    assert _one(demands, "1", "X").flags == ()
    demands = build_demands(_inventory(Floor(row=2, floor="1", records={"X": (_record(SMC),)}, **given)), "as filled")
    recorded = _one(demands, "1", "X")
    assert (recorded.source, recorded.name) == ("record", SMC.name)
    assert recorded.pfa == treat(recorded.record).pfa
    assert _one(demands, "1", "Y").source == "given"


@pytest.mark.parametrize(("scenario", "source"), [("recorded", "record"), ("given", "given"), ("as filled", "record")])
def test_the_scenario_chooses_the_source(scenario, source):
    floor = Floor(row=2, floor="1", pfa={"X": 3.0}, records={"X": (_record(SMC),)})
    demands = build_demands(_inventory(floor), scenario)
    assert _one(demands, "1", "X").source == source


def test_one_axis_serves_both_and_says_so_and_parallel_records_all_stand():
    floor = Floor(row=2, floor="1", elevation=3.0, pfa={"Y": 2.0}, pfv={"Y": 0.3})
    demands = build_demands(_inventory(floor), "as filled")
    borrowed = _one(demands, "1", "X")
    assert (borrowed.axis, borrowed.pfa, borrowed.pfv, borrowed.flags) == ("X", 2.0, 0.3, ("one_axis_only",))
    assert _one(demands, "1", "Y").flags == ()
    floor = Floor(row=2, floor="1", records={"X": (_record(SMC), _record(CORRECTED))})
    demands = build_demands(_inventory(floor), "as filled")
    assert [demand.name for demand in demands["1", "X"]] == [SMC.name, CORRECTED.name]
    assert [demand.flags for demand in demands["1", "Y"]] == [("one_axis_only",)] * 2


def test_a_corrected_record_loses_nothing():
    floor = Floor(row=2, floor="1", records={"X": (_record(CORRECTED),)})
    demand = _one(build_demands(_inventory(floor), "as filled"), "1", "X")
    assert demand.loss == pytest.approx(0, abs=1e-12)
    assert np.array_equal(demand.motion.acceleration, demand.record.acceleration)


@pytest.mark.parametrize(
    ("scenario", "given", "message"),
    [
        ("recorded", {"pfa": {"X": 3.0}}, "has no record, which .*'recorded'"),
        ("recorded", {}, "has no record, which .* as its Elevation is blank"),
        ("given", {"records": {}}, "has no PFA, which .*'given'"),
        ("given", {"elevation": 3.0}, "has no PFA, which .* as it does not lie between two floors that"),
        ("as filled", {}, "has neither a record nor a PFA"),
        ("as filled", {"elevation": 3.0}, "has neither a record nor a PFA.* Ground PGA"),
        ("EN 1998-1", {}, "has no Elevation, which the scenario 'EN 1998-1'"),
        ("EN 1998-1", {"elevation": 3.0}, None),
    ],
)
def test_a_floor_without_motion_is_named(scenario, given, message):
    place = rf"Floors!A7: floor '1' {message}"
    expected = place if message else r"Building: Ground PGA, SDS, ShakeMap file and Shaking are blank; the"
    with pytest.raises(assess.WorkbookError, match=expected):
        build_demands(_inventory(Floor(row=7, floor="1", **given)), scenario)


# ------------------------------------------------------------------ floors between known ones

LOWER = Floor(row=2, floor="A", elevation=0.0, records={"X": (_record(SMC),), "Y": (_record(CORRECTED),)})
UPPER = Floor(row=4, floor="C", elevation=10.0, records={"X": (_record(CORRECTED),)})
BETWEEN = Floor(row=3, floor="B", elevation=4.0)


def _peaks(one):
    return np.array([one.pfa, one.pfv])


@pytest.mark.parametrize("scenario", ["as filled", "recorded"])
def test_a_floor_between_two_records_is_interpolated_over_elevation(scenario):
    """By 4 of 10 m; the upper floor's X serves its Y."""
    demands = build_demands(_inventory(LOWER, BETWEEN, UPPER, ground_pga=3.0), scenario)
    x, y = _one(demands, "B", "X"), _one(demands, "B", "Y")
    assert (x.source, x.between, x.flags) == ("interpolated", ("A", "C"), ("interpolated",))
    assert y.flags == ("one_axis_only", "interpolated")
    for one in (x, y):
        low, high = (_peaks(_one(demands, name, one.axis)) for name in "AC")
        assert _peaks(one) == pytest.approx(low + 0.4 * (high - low))
    assert (x.label, y.is_borrowed) == ("interpolated between A and C", False)
    assert (x.drawn.target.meets, x.dispersion) == ("peaks", 0.4), "met in every draw, which scatter as records do"


def test_the_nearest_known_floors_serve_and_the_order_of_rows_does_not_matter():
    far = Floor(row=5, floor="D", elevation=30.0, pfa={"X": 9.0})
    unplaced = Floor(row=6, floor="E", pfa={"X": 9.0})
    demands = build_demands(_inventory(far, UPPER, unplaced, BETWEEN, LOWER), "as filled")
    assert _one(demands, "B", "X").between == ("A", "C")


def test_of_floors_at_one_height_the_worse_serves():
    """A floor at the very height of others takes the larger of theirs, records or not."""
    low = Floor(row=8, floor="a", elevation=0.0, records={"X": (_record(CORRECTED),)})
    high = Floor(row=8, floor="c", elevation=10.0, pfa={"X": 50.0})
    beside = Floor(row=9, floor="c2", elevation=10.0)
    demands = build_demands(_inventory(LOWER, low, BETWEEN, UPPER, beside), "as filled")
    worse = max((_one(demands, name, "X") for name in ("A", "a")), key=lambda one: one.pfa)
    assert _one(demands, "B", "X").between == (worse.floor.floor, "C")
    assert _one(demands, "c2", "X").between == ("C", "C")
    demands = build_demands(_inventory(UPPER, high, beside), "as filled")
    assert (_one(demands, "c2", "X").pfa, _one(demands, "c2", "X").between) == (50.0, ("c", "c"))


def test_the_worst_of_parallel_records_is_interpolated():
    recorded = Floor(row=2, floor="A", elevation=0.0, records={"X": (_record(CORRECTED), _record(SMC))})
    demands = build_demands(_inventory(recorded, BETWEEN, UPPER), "as filled")
    worst = np.max([_peaks(one) for one in demands["A", "X"]], axis=0)
    high = _peaks(_one(demands, "C", "X"))
    assert _peaks(_one(demands, "B", "X")) == pytest.approx(worst + 0.4 * (high - worst))


def test_recorded_interpolates_between_records_alone():
    low, high = (
        Floor(row=row, floor=name, elevation=z, records={"X": (_record(SMC),)})
        for row, name, z in [(2, "a", 0.0), (3, "b", 9.0)]
    )
    given = Floor(row=4, floor="g", elevation=3.0, pfa={"X": 30.0})
    demands = build_demands(_inventory(low, given, high), "recorded")
    one = _one(demands, "g", "X")
    assert (one.source, one.between) == ("interpolated", ("a", "b"))
    assert one.pfa == pytest.approx(_one(demands, "a", "X").pfa)


def test_beside_a_floor_of_peaks_alone_a_beam_serves():
    upper = Floor(row=4, floor="C", elevation=10.0, pfa={"X": 4.0})
    one = _one(build_demands(_inventory(LOWER, BETWEEN, upper), "as filled"), "B", "X")
    assert (one.source, one.between, one.flags) == ("beam", (), ("drawn_building",))


# ------------------------------------------------------------------ floors by a code's profile

ROOF = Floor(row=5, floor="R", elevation=40.0)


@pytest.mark.parametrize(
    ("scenario", "amplification"), [("ASCE 7-22", 2.25), ("ASCE 7-16", 2.0), ("EN 1998-1", 1.75), ("NTC 2018", 1.5)]
)
def test_by_a_code_a_floor_follows_from_the_ground(scenario, amplification):
    """z/h = 20/40 = 0.5: 1 + 2.5 x 0.5, 1 + 2 x 0.5, 1 + 1.5 x 0.5, 1 + 0.5."""
    floor = Floor(row=2, floor="5", elevation=20.0)
    demands = build_demands(_inventory(floor, height=40.0, ground_pga=3.0), scenario)
    for axis in "XY":
        one = _one(demands, "5", axis)
        assert (one.source, one.axis, one.flags, one.height_ratio) == ("profile", axis, ("code_profile",), 0.5)
        assert (one.amplification, one.pfa) == pytest.approx((amplification, 3.0 * amplification))
        assert one.label == one.profile.key == scenario
        assert one.drawn.target.meets == "pfa", "in every draw, as a typed one"


def test_a_given_period_changes_the_profile():
    """T1 = 1 s at the roof: H_f = 1 + 1 + 0.84 = 2.84. T1 by height is not one that the code asks for."""
    given, assumed = (
        _one(build_demands(_inventory(ROOF, period=period, ground_pga=2.0), "ASCE 7-22"), "R", "X")
        for period in (1.0, None)
    )
    assert (given.pfa, given.clause) == (pytest.approx(5.68), "13.3.1.1, Eq. 13.3-4")
    assert assumed.pfa == pytest.approx(7.0)


def test_by_a_code_pfv_is_pfa_times_the_beams_ratio_of_the_two():
    ground = {"period": 1.0, "ground_pga": 2.0, "ground_pgv": 0.3}
    by_code, by_beam = (
        _one(build_demands(_inventory(ROOF, **ground), scenario), "R", "X") for scenario in ("ASCE 7-22", "as filled")
    )
    assert by_code.pfv / by_code.pfa == pytest.approx(by_beam.pfv / by_beam.pfa)


def test_a_profile_serves_every_floor():
    floor = Floor(row=2, floor="1", elevation=0.0, pfa={"X": 9.0}, records={"Y": (_record(SMC),)})
    demands = build_demands(_inventory(floor, ROOF, ground_pga=2.0), "ASCE 7-16")
    assert {one.source for ones in demands.values() for one in ones} == {"profile"}
    assert (_one(demands, "1", "X").pfa, _one(demands, "R", "Y").pfa) == pytest.approx((2.0, 6.0))


@pytest.mark.parametrize(
    ("z", "height", "ratio"),
    [(10.0, None, 0.25), (40.0, None, 1.0), (10.0, 50.0, 0.2), (-3.0, 50.0, 0.0), (40.0, 30.0, 1.0), (0.0, 30.0, 0.0)],
)
def test_height_ratio(z, height, ratio):
    """The roof is Height, else the highest floor, here 40 m; below the ground 0, above the roof 1."""
    inventory = _inventory(Floor(row=2, floor="1", elevation=z), ROOF, height=height, ground_pga=1.0)
    assert _one(build_demands(inventory, "ASCE 7-16"), "1", "X").height_ratio == pytest.approx(ratio)


def test_a_building_of_the_ground_floor_alone_and_ductility_which_reduces_asce_7_22_alone():
    inventory = _inventory(Floor(row=2, floor="G", elevation=0.0), ground_pga=2.0)
    assert _one(build_demands(inventory, "as filled"), "G", "X").pfa == 2.0
    inventory = _inventory(ROOF, ground_pga=1.0)
    found = [
        _one(build_demands(inventory, scenario, ductility_reduction=1.4), "R", "X").pfa
        for scenario in ("ASCE 7-22", "ASCE 7-16")
    ]
    assert found == pytest.approx([2.5, 3.0])


def test_every_floor_that_nothing_serves_is_named():
    floors = [Floor(row=row, floor=f"F{row}", cells={"pfa_x": f"D{row}", "elevation": f"C{row}"}) for row in (2, 3)]
    assert build_demands(_inventory(*floors, ground_pga=1.0), "as filled")
    with pytest.raises(assess.WorkbookError, match=r"Floors!D2: floor 'F2'(.|\n)*Floors!D3: floor 'F3'"):
        build_demands(_inventory(*floors), "as filled")
    with pytest.raises(assess.WorkbookError, match=r"Floors!C2: floor 'F2'(.|\n)*Floors!C3: floor 'F3'"):
        build_demands(_inventory(*floors, ground_pga=1.0), "NTC 2018")


@given(
    heights=st.lists(st.floats(-10, 200), min_size=2, max_size=6, unique=True),
    pga=st.floats(0.1, 10),
    more=st.floats(1, 3),
    period=st.none() | st.floats(0.05, 10),
    scenario=st.sampled_from(["ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"]),
)
def test_by_a_code_pfa_never_falls_with_height_nor_with_the_ground(heights, pga, more, period, scenario):
    floors = [Floor(row=row, floor=str(row), elevation=z) for row, z in enumerate(sorted(heights))]

    def peaks(ground):
        inventory = _inventory(*floors, ground_pga=ground, period=period)
        demands = build_demands(inventory, scenario)
        return [_one(demands, floor.floor, "X").pfa for floor in floors]

    found = peaks(pga)
    assert found == sorted(found)
    assert found[0] >= pga
    assert all(high >= low for low, high in zip(found, peaks(pga * more), strict=True))


@given(lower=st.floats(0.1, 10), upper=st.floats(0.1, 10), share=st.floats(0, 1))
def test_an_interpolated_floor_lies_between_its_neighbours(lower, upper, share):
    places = (0.0, 7 * share, 7.0)
    floors = [Floor(row=row, floor=name, elevation=z) for row, (name, z) in enumerate(zip("ABC", places, strict=True))]

    def record(floor, axis, pfa):
        return (Demand(floor=floor, axis=axis, source="record", pfa=pfa, pfv=pfa / 9),)

    peaks = ((floors[0], lower), (floors[2], upper))
    known = [{axis: record(floor, axis, pfa) for axis in AXES} for floor, pfa in peaks]
    found = _interpolate(floors[1], known)["X"][0]
    assert min(lower, upper) - 1e-12 <= found.pfa <= max(lower, upper) + 1e-12
    assert found.pfv == pytest.approx(found.pfa / 9)
