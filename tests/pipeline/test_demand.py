import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import assess
from assess.model import Building, Floor, FloorRecord, Inventory
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.motion.scenario import ROOF_FACTOR
from assess.pipeline.demand import Demand, build_demands, find_ground, scale_demands
from tests.workbooks import RECORDS

G = 9.80665
SMC = RECORDS / "0165a_u.smc"
CORRECTED = RECORDS / "np01002p_4225a_a.smc"


def _inventory(tmp_path, *floors, **building):
    return Inventory(
        source=tmp_path / "w.xlsx", sha256="0" * 64, building=Building(**building), floors=floors, items=()
    )


def _record(path):
    (record,) = read_records(path)
    return FloorRecord(name=path.name, record=record)


def _one(demands, floor, axis):
    (demand,) = demands[floor, axis]
    assert isinstance(demand, Demand)
    return demand


def test_given_peaks_are_used_as_they_are(tmp_path):
    floor = Floor(row=2, floor="1", pfa={"X": 3.0, "Y": 2.0}, pfv={"X": 0.4, "Y": 0.3})
    demands = build_demands(_inventory(tmp_path, floor), "as filled")
    assert [(_one(demands, "1", axis).pfa, _one(demands, "1", axis).pfv) for axis in "XY"] == [(3.0, 0.4), (2.0, 0.3)]
    assert _one(demands, "1", "X").flags == ()


def test_a_record_comes_before_a_given_pfa(tmp_path):
    floor = Floor(row=2, floor="1", pfa={"X": 30.0, "Y": 2.0}, records={"X": (_record(SMC),)})
    demands = build_demands(_inventory(tmp_path, floor), "as filled")
    recorded = _one(demands, "1", "X")
    assert (recorded.source, recorded.name) == ("record", SMC.name)
    assert recorded.pfa == treat(recorded.record).pfa
    assert _one(demands, "1", "Y").source == "given"


@pytest.mark.parametrize(("scenario", "source"), [("recorded", "record"), ("given", "given"), ("as filled", "record")])
def test_the_scenario_chooses_the_source(tmp_path, scenario, source):
    floor = Floor(row=2, floor="1", pfa={"X": 3.0}, records={"X": (_record(SMC),)})
    demands = build_demands(_inventory(tmp_path, floor), scenario)
    assert _one(demands, "1", "X").source == source


def test_one_axis_serves_both_and_says_so(tmp_path):
    floor = Floor(row=2, floor="1", pfa={"Y": 2.0}, pfv={"Y": 0.3})
    demands = build_demands(_inventory(tmp_path, floor), "as filled")
    borrowed = _one(demands, "1", "X")
    assert (borrowed.axis, borrowed.pfa, borrowed.pfv, borrowed.flags) == ("X", 2.0, 0.3, ("one_axis_only",))
    assert _one(demands, "1", "Y").flags == ()


@pytest.mark.parametrize(("period", "frequency"), [(2.0, 0.5), (1.0, 1.0), (1 / 1.3, 1.3), (0.3, 1.3)])
def test_pfv_is_estimated_from_the_period(tmp_path, period, frequency):
    """PFV = PFA/(2 pi f), f = min(1/T1, 1.3 Hz)."""
    demands = build_demands(_inventory(tmp_path, Floor(row=2, floor="1", pfa={"X": 3.0}), period=period), "as filled")
    demand = _one(demands, "1", "X")
    assert demand.flags == ("pfv_estimated",)
    assert demand.pfv == pytest.approx(3.0 / (2 * math.pi * frequency), rel=1e-12)


def test_pfv_is_unknown_without_a_period(tmp_path):
    demand = _one(build_demands(_inventory(tmp_path, Floor(row=2, floor="1", pfa={"X": 3.0})), "as filled"), "1", "X")
    assert math.isnan(demand.pfv)
    assert demand.flags == ()


def test_an_estimate_is_capped_by_the_ground(tmp_path):
    """575 Market Street: T1 6 s and 218.1 cm/s2 give 208 cm/s where 40.4 were recorded, 3.93 x 23.03 cm/s 90.5."""
    floor, building = Floor(row=2, floor="42", pfa={"X": 2.181, "Y": 0.5}), {"period": 6.0, "ground_pgv": 0.2303}
    bare = build_demands(_inventory(tmp_path, floor, period=6.0), "as filled")
    capped = build_demands(_inventory(tmp_path, floor, **building), "as filled")
    assert 100 * _one(bare, "42", "X").pfv == pytest.approx(208.3, abs=0.1)
    assert 100 * _one(capped, "42", "X").pfv == pytest.approx(90.5, abs=0.05)
    assert _one(capped, "42", "X").flags == ("pfv_estimated", "pfv_capped")
    below = _one(capped, "42", "Y")
    assert (below.pfv, below.flags) == (_one(bare, "42", "Y").pfv, ("pfv_estimated",))
    for pga, flags in ((6.0, ("pfv_estimated", "pfv_capped")), (0.3, ("pfv_estimated",))):
        profiled = build_demands(_inventory(tmp_path, ROOF, ground_pga=pga, **building), "as filled")
        assert _one(profiled, "R", "X").flags == ("code_profile", *flags)
        assert _one(profiled, "R", "X").pfv <= 3.93 * 0.2303


def test_a_given_and_a_recorded_pfv_are_not_capped(tmp_path):
    floors = (
        Floor(row=2, floor="1", pfa={"X": 3.0}, pfv={"X": 0.4}),
        Floor(row=3, floor="2", records={"X": (_record(SMC),)}),
    )
    for floor in floors:
        bare, capped = (
            build_demands(_inventory(tmp_path, floor, period=2.0, ground_pgv=pgv), "as filled") for pgv in (None, 0.01)
        )
        one, other = _one(bare, floor.floor, "X"), _one(capped, floor.floor, "X")
        assert (one.pfv, one.flags) == (other.pfv, other.flags)


def test_the_cap_scales_with_the_motion_and_is_carried_between_floors(tmp_path):
    floors = [
        Floor(row=at, floor=str(at), elevation=4.0 * at, pfa={"X": 3.0 + at} if at != 3 else {}) for at in (2, 3, 4)
    ]
    demands = build_demands(_inventory(tmp_path, *floors, period=6.0, ground_pgv=0.2), "as filled")
    twice = scale_demands(demands, 2.0)
    assert _one(demands, "3", "X").flags == ("interpolated", "pfv_estimated", "pfv_capped")
    assert [_one(demands, at, "X").pfv for at in "234"] == pytest.approx([3.93 * 0.2] * 3, rel=1e-12)
    assert [_one(twice, at, "X").pfv for at in "234"] == pytest.approx([3.93 * 0.4] * 3, rel=1e-12)


@given(pfa=st.floats(0, 30), period=st.floats(0.02, 20), pgv=st.floats(1e-4, 10))
def test_a_cap_never_raises_an_estimate(tmp_path_factory, pfa, period, pgv):
    inventory = _inventory(tmp_path_factory.getbasetemp(), Floor(row=2, floor="1", pfa={"X": pfa}), period=period)
    bare = _one(build_demands(inventory, "as filled"), "1", "X")
    inventory = replace(inventory, building=replace(inventory.building, ground_pgv=pgv))
    capped = _one(build_demands(inventory, "as filled"), "1", "X")
    assert capped.pfv == min(bare.pfv, ROOF_FACTOR * pgv)
    assert ("pfv_capped" in capped.flags) == (capped.pfv < bare.pfv)


def test_parallel_records_all_stand(tmp_path):
    floor = Floor(row=2, floor="1", records={"X": (_record(SMC), _record(CORRECTED))})
    demands = build_demands(_inventory(tmp_path, floor), "as filled")
    assert [demand.name for demand in demands["1", "X"]] == [SMC.name, CORRECTED.name]
    assert [demand.flags for demand in demands["1", "Y"]] == [("one_axis_only",)] * 2


def test_a_corrected_record_loses_nothing(tmp_path):
    floor = Floor(row=2, floor="1", records={"X": (_record(CORRECTED),)})
    demand = _one(build_demands(_inventory(tmp_path, floor), "as filled"), "1", "X")
    assert demand.loss == pytest.approx(0, abs=1e-12)
    assert np.array_equal(demand.motion.acceleration, demand.record.acceleration)


@pytest.mark.parametrize(
    ("scenario", "floor", "message"),
    [
        (
            "recorded",
            Floor(row=7, floor="1", pfa={"X": 3.0}),
            r"Floors!A7: floor '1' has no record, which .*'recorded'",
        ),
        ("given", Floor(row=7, floor="1", records={}), r"Floors!A7: floor '1' has no PFA, which .*'given'"),
        ("as filled", Floor(row=7, floor="1"), r"Floors!A7: floor '1' has neither a record nor a PFA, and no Elev"),
        ("as filled", Floor(row=7, floor="1", elevation=3.0), r"lies between no two floors .* neither Ground PGA"),
        (
            "given",
            Floor(row=7, floor="1", elevation=3.0),
            r"no PFA, which .* as it does not lie between two floors that",
        ),
        ("recorded", Floor(row=7, floor="1"), r"no record, which .* as its Elevation is blank"),
        (
            "EN 1998-1",
            Floor(row=7, floor="1"),
            r"Floors!A7: floor '1' has no Elevation, which the scenario 'EN 1998-1'",
        ),
        (
            "EN 1998-1",
            Floor(row=7, floor="1", elevation=3.0),
            r"Building: Ground PGA, SDS, ShakeMap file and Shaking are blank; the",
        ),
    ],
)
def test_a_floor_without_motion_is_named(tmp_path, scenario, floor, message):
    with pytest.raises(assess.WorkbookError, match=message):
        build_demands(_inventory(tmp_path, floor), scenario)


# ------------------------------------------------------------------ floors between known ones

LOWER = Floor(row=2, floor="A", elevation=0.0, pfa={"X": 2.0, "Y": 1.0}, pfv={"X": 0.2, "Y": 0.3})
UPPER = Floor(row=4, floor="C", elevation=10.0, pfa={"X": 4.0}, pfv={"X": 0.5})
BETWEEN = Floor(row=3, floor="B", elevation=4.0)


@pytest.mark.parametrize("scenario", ["as filled", "given"])
def test_a_floor_between_two_is_interpolated_over_elevation(tmp_path, scenario):
    """X: 2 + 0.4 x (4 - 2) = 2.8 m/s2, 0.2 + 0.4 x 0.3 = 0.32 m/s. Y: the upper floor's X serves its Y:
    1 + 0.4 x (4 - 1) = 2.2 m/s2, 0.3 + 0.4 x 0.2 = 0.38 m/s."""
    demands = build_demands(_inventory(tmp_path, LOWER, BETWEEN, UPPER, ground_pga=3.0), scenario)
    x, y = _one(demands, "B", "X"), _one(demands, "B", "Y")
    assert (x.source, x.between, x.flags) == ("interpolated", ("A", "C"), ("interpolated",))
    assert (x.pfa, x.pfv) == pytest.approx((2.8, 0.32))
    assert y.flags == ("one_axis_only", "interpolated")
    assert (y.pfa, y.pfv) == pytest.approx((2.2, 0.38))
    assert (x.label, y.is_borrowed) == ("interpolated between A and C", False)


def test_the_nearest_known_floors_serve_and_the_order_of_rows_does_not_matter(tmp_path):
    far = Floor(row=5, floor="D", elevation=30.0, pfa={"X": 9.0})
    unplaced = Floor(row=6, floor="E", pfa={"X": 9.0})
    demands = build_demands(_inventory(tmp_path, far, UPPER, unplaced, BETWEEN, LOWER), "as filled")
    assert _one(demands, "B", "X").between == ("A", "C")


def test_of_floors_at_one_height_the_worse_serves(tmp_path):
    """3.0 m/s2 at 0 m and 5.0 m/s2 at 10 m: 3 + 0.4 x 2 = 3.8 m/s2; a floor at their very height takes the larger."""
    low, high = (
        Floor(row=8, floor=name, elevation=z, pfa={"X": pfa}) for name, z, pfa in [("a", 0.0, 3.0), ("c", 10.0, 5.0)]
    )
    beside = Floor(row=9, floor="c2", elevation=10.0)
    demands = build_demands(_inventory(tmp_path, LOWER, low, BETWEEN, UPPER, high, beside), "as filled")
    assert _one(demands, "B", "X").pfa == pytest.approx(3.8)
    assert (_one(demands, "c2", "X").pfa, _one(demands, "c2", "X").between) == (5.0, ("c", "c"))


def test_the_worst_of_parallel_records_is_interpolated(tmp_path):
    recorded = Floor(row=2, floor="A", elevation=0.0, records={"X": (_record(CORRECTED), _record(SMC))})
    demands = build_demands(_inventory(tmp_path, recorded, BETWEEN, UPPER), "as filled")
    known = demands["A", "X"]
    worst = max(one.pfa for one in known), max(one.pfv for one in known)
    one = _one(demands, "B", "X")
    assert one.pfa == pytest.approx(worst[0] + 0.4 * (4.0 - worst[0]))
    assert one.pfv == pytest.approx(worst[1] + 0.4 * (0.5 - worst[1]))


def test_recorded_interpolates_between_records_alone(tmp_path):
    low, high = (
        Floor(row=row, floor=name, elevation=z, records={"X": (_record(SMC),)})
        for row, name, z in [(2, "a", 0.0), (3, "b", 9.0)]
    )
    given = Floor(row=4, floor="g", elevation=3.0, pfa={"X": 30.0})
    demands = build_demands(_inventory(tmp_path, low, given, high), "recorded")
    one = _one(demands, "g", "X")
    assert (one.source, one.between) == ("interpolated", ("a", "b"))
    assert one.pfa == pytest.approx(_one(demands, "a", "X").pfa)


def test_an_unknown_pfv_stays_unknown_between_floors_and_an_estimate_is_carried(tmp_path):
    bare = Floor(row=4, floor="C", elevation=10.0, pfa={"X": 4.0})
    unknown = _one(build_demands(_inventory(tmp_path, LOWER, BETWEEN, bare), "as filled"), "B", "X")
    assert math.isnan(unknown.pfv)
    estimated = _one(build_demands(_inventory(tmp_path, LOWER, BETWEEN, bare, period=1.0), "as filled"), "B", "X")
    assert estimated.flags == ("interpolated", "pfv_estimated")
    assert estimated.pfv == pytest.approx(0.2 + 0.4 * (4.0 / (2 * math.pi) - 0.2))


# ------------------------------------------------------------------ floors by a code's profile

ROOF = Floor(row=5, floor="R", elevation=40.0)


@pytest.mark.parametrize(
    ("scenario", "amplification"),
    [("as filled", 2.25), ("ASCE 7-22", 2.25), ("ASCE 7-16", 2.0), ("EN 1998-1", 1.75), ("NTC 2018", 1.5)],
)
def test_a_floor_of_which_nothing_is_known_follows_from_the_ground(tmp_path, scenario, amplification):
    """z/h = 20/40 = 0.5: 1 + 2.5 x 0.5, 1 + 2 x 0.5, 1 + 1.5 x 0.5, 1 + 0.5."""
    floor = Floor(row=2, floor="5", elevation=20.0)
    demands = build_demands(_inventory(tmp_path, floor, height=40.0, ground_pga=3.0), scenario)
    for axis in "XY":
        one = _one(demands, "5", axis)
        assert (one.source, one.axis, one.flags, one.height_ratio) == ("profile", axis, ("code_profile",), 0.5)
        assert (one.amplification, one.pfa) == pytest.approx((amplification, 3.0 * amplification))
        assert math.isnan(one.pfv)
        assert one.label == one.profile.key == (scenario if scenario != "as filled" else "ASCE 7-22")


def test_a_known_period_changes_the_profile_and_gives_a_pfv(tmp_path):
    """T1 = 1 s at the roof: H_f = 1 + 1 + 0.84 = 2.84; PFV = PFA/(2 pi x 1 Hz)."""
    one = _one(build_demands(_inventory(tmp_path, ROOF, period=1.0, ground_pga=2.0), "as filled"), "R", "X")
    assert one.pfa == pytest.approx(5.68)
    assert one.pfv == pytest.approx(5.68 / (2 * math.pi))
    assert one.flags == ("code_profile", "pfv_estimated")
    assert one.clause == "13.3.1.1, Eq. 13.3-4"


def test_a_profile_serves_every_floor(tmp_path):
    floor = Floor(row=2, floor="1", elevation=0.0, pfa={"X": 9.0}, records={"Y": (_record(SMC),)})
    demands = build_demands(_inventory(tmp_path, floor, ROOF, ground_pga=2.0), "ASCE 7-16")
    assert {one.source for ones in demands.values() for one in ones} == {"profile"}
    assert (_one(demands, "1", "X").pfa, _one(demands, "R", "Y").pfa) == pytest.approx((2.0, 6.0))


def test_above_the_known_floors_a_profile_serves_not_an_extrapolation(tmp_path):
    demands = build_demands(_inventory(tmp_path, LOWER, BETWEEN, UPPER, ROOF, ground_pga=2.0), "as filled")
    assert [_one(demands, name, "X").source for name in "ABCR"] == ["given", "interpolated", "given", "profile"]


@pytest.mark.parametrize(
    ("building", "pga", "by_sds"),
    [({"ground_pga": 3.0}, 3.0, False), ({"sds": 10.0}, 4.0, True), ({"ground_pga": 3.0, "sds": 10.0}, 3.0, False)],
)
def test_ground_motion_from_pga_else_from_sds(tmp_path, building, pga, by_sds):
    inventory = _inventory(tmp_path, Floor(row=2, floor="1", elevation=0.0), **building)
    assert _one(build_demands(inventory, "as filled"), "1", "X").pfa == pytest.approx(pga)
    ground = find_ground(inventory)
    assert ground.pga == pytest.approx(pga)
    assert ground.is_from_sds == by_sds


@pytest.mark.parametrize(
    ("z", "height", "ratio"),
    [(10.0, None, 0.25), (40.0, None, 1.0), (10.0, 50.0, 0.2), (-3.0, 50.0, 0.0), (40.0, 30.0, 1.0), (0.0, 30.0, 0.0)],
)
def test_height_ratio(tmp_path, z, height, ratio):
    """The roof is Height, else the highest floor, here 40 m; below the ground 0, above the roof 1."""
    inventory = _inventory(tmp_path, Floor(row=2, floor="1", elevation=z), ROOF, height=height, ground_pga=1.0)
    assert _one(build_demands(inventory, "ASCE 7-16"), "1", "X").height_ratio == pytest.approx(ratio)


def test_a_building_of_the_ground_floor_alone(tmp_path):
    inventory = _inventory(tmp_path, Floor(row=2, floor="G", elevation=0.0), ground_pga=2.0)
    assert _one(build_demands(inventory, "as filled"), "G", "X").pfa == 2.0


def test_ductility_reduces_asce_7_22_alone(tmp_path):
    inventory = _inventory(tmp_path, ROOF, ground_pga=1.0)
    found = [
        _one(build_demands(inventory, scenario, ductility_reduction=1.4), "R", "X").pfa
        for scenario in ("ASCE 7-22", "ASCE 7-16")
    ]
    assert found == pytest.approx([2.5, 3.0])


def test_every_floor_that_nothing_serves_is_named(tmp_path):
    floors = [Floor(row=row, floor=f"F{row}", cells={"pfa_x": f"D{row}", "elevation": f"C{row}"}) for row in (2, 3)]
    with pytest.raises(assess.WorkbookError, match=r"Floors!D2: floor 'F2'(.|\n)*Floors!D3: floor 'F3'"):
        build_demands(_inventory(tmp_path, *floors), "as filled")
    with pytest.raises(assess.WorkbookError, match=r"Floors!C2: floor 'F2'(.|\n)*Floors!C3: floor 'F3'"):
        build_demands(_inventory(tmp_path, *floors, ground_pga=1.0), "as filled")


@given(
    heights=st.lists(st.floats(-10, 200), min_size=2, max_size=6, unique=True),
    pga=st.floats(0.1, 10),
    more=st.floats(1, 3),
    period=st.none() | st.floats(0.05, 10),
    scenario=st.sampled_from(["as filled", "ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"]),
)
def test_pfa_never_falls_with_height_nor_with_the_ground(heights, pga, more, period, scenario):
    floors = [Floor(row=row, floor=str(row), elevation=z) for row, z in enumerate(sorted(heights))]

    def peaks(ground):
        inventory = _inventory(Path("/"), *floors, ground_pga=ground, period=period)
        demands = build_demands(inventory, scenario)
        return [_one(demands, floor.floor, "X").pfa for floor in floors]

    found = peaks(pga)
    assert found == sorted(found)
    assert found[0] >= pga
    assert all(high >= low for low, high in zip(found, peaks(pga * more), strict=True))


@given(st.floats(0, 10), st.floats(0, 10), st.floats(0, 1))
def test_an_interpolated_floor_lies_between_its_neighbours(lower, upper, share):
    floors = [
        Floor(row=row, floor=name, elevation=z, pfa=pfa)
        for row, (name, z, pfa) in enumerate([("A", 0.0, {"X": lower}), ("B", 7 * share, {}), ("C", 7.0, {"X": upper})])
    ]
    found = _one(build_demands(_inventory(Path("/"), *floors), "as filled"), "B", "X").pfa
    assert min(lower, upper) - 1e-12 <= found <= max(lower, upper) + 1e-12
