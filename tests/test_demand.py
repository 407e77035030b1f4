import math

import numpy as np
import pytest

import assess
from assess.demand import Demand, build_demands
from assess.inventory.model import Building, Floor, FloorRecord, Inventory
from assess.motion.formats import read_records
from assess.motion.record import treat
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
        ("as filled", Floor(row=7, floor="1"), r"Floors!A7: floor '1' has no record and no PFA"),
    ],
)
def test_a_floor_without_motion_is_named(tmp_path, scenario, floor, message):
    with pytest.raises(assess.WorkbookError, match=message):
        build_demands(_inventory(tmp_path, floor), scenario)
