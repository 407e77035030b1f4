"""What cannot rock is low on every basis; and under no motion that may be drawn does any such piece overturn."""

from pathlib import Path

import numpy as np
import pytest

from assess.pipeline.adopt import find_can_rock
from assess.pipeline.run import compute
from assess.risk import RiskClass
from assess.rocking.block import stocky_limit
from assess.rocking.draws import MARGIN, Uncertainty
from assess.settings import Settings
from assess.units import GRAVITY
from tests.pipeline.rows import assessed, read
from tests.workbooks import UNVERIFIED

RECORDS = Path(__file__).parents[2] / "inventories" / "records" / "575-market"
DRAWS, FEW = 10_000, 500
NARROWER = 0.75
"""Breadth over the limit of the pieces of the few draws [-]: a weaker motion fells these than those at the limit."""
JUST_BELOW = 1 + 1e-6
"""Breadths are that much above the limit [-]."""
HEIGHTS, CENTRES = (40, 120, 250), (30, 50, 75)
FLOORS = {
    "a recorded roof": {"record_x": "891018_1.cra-1.0210k.smc"},
    "a stiff building": {"pfa_x": 0.1},
    "a tall building": {"pfa_x": 0.08},
    "a roof on a beam": {"elevation": 12},
    "any building": {},
}
BUILDINGS = {
    "a recorded roof": {"period": 1.0},
    "a stiff building": {"period": 0.2},
    "a tall building": {"period": 4.0},
    "a roof on a beam": {"height": 12, "ground_pga": 0.05},
    "any building": {"ground_pgv": 5},
}


def at_the_limit(pfa, dispersion, peak):
    """Yield pieces of every size, top-heavy or not, that the strongest motion for a PFA [g] just may not start."""
    for height in HEIGHTS:
        for centre in CENTRES:
            for source in ("", "scan"):
                known = (np.array(centre / 100), np.array(source == "scan"), dispersion, peak)
                start = float(Uncertainty().largest_start(*known)) / MARGIN
                breadth = JUST_BELOW * pfa * start * 2 * centre / 100 * height
                if breadth >= 5 and breadth / height < stocky_limit(centre / 100):
                    yield {"item": f"{height} {centre} {source or 'tape'}", "floor": "1", "axis": "X",
                           "breadth": breadth, "height": height, "centre_of_gravity": centre,
                           "sizes_from": source}  # fmt: skip


def pieces_and_building(floor, beta):
    """Return pieces that just cannot rock on a floor, that floor, and the building under that scatter."""
    building = {"motion_uncertainty": beta} | BUILDINGS[floor]
    one = {"floor": "1"} | FLOORS[floor]
    any_piece = {"item": "a", "floor": "1", "axis": "X", "breadth": 40, "height": 180}
    first = compute(read([any_piece], [one], RECORDS, **building), UNVERIFIED)
    pfa, spread, peak = (float(values[0]) for values in (first.cases.pfa, first.cases.dispersion, first.cases.peak))
    assert spread == beta
    items = list(at_the_limit(pfa / GRAVITY, np.array(spread), np.array(peak)))
    assert len(items) >= 4
    return items, one, building


def count_falls(items, floor, building, draws):
    found = compute(read(items, [floor], RECORDS, **building), Settings(verify="all", runs=draws))
    return found, {int(joint.fell.sum()) for joint in found.joints.values()}


@pytest.mark.long
@pytest.mark.parametrize("beta", [0.0, 0.4])
@pytest.mark.parametrize("floor", FLOORS)
def test_in_10_000_draws_no_piece_that_cannot_rock_overturns(floor, beta):
    items, one, building = pieces_and_building(floor, beta)
    found, falls = count_falls(items, one, building, DRAWS)
    assert not find_can_rock(found.cases, found.settings).any()
    assert falls == {0}


@pytest.mark.slow
@pytest.mark.parametrize("beta", [0.0, 0.4])
@pytest.mark.parametrize("floor", FLOORS)
def test_in_few_draws_none_overturns_that_is_narrower_still(floor, beta):
    """A twentieth of the draws, of pieces that motions three quarters as strong fell."""
    items, one, building = pieces_and_building(floor, beta)
    first = compute(read(items, [one], RECORDS, **building), UNVERIFIED)
    assert not find_can_rock(first.cases, first.settings).any()
    narrower = [piece | {"breadth": max(NARROWER * piece["breadth"], 5)} for piece in items]
    _, falls = count_falls(narrower, one, building, FEW)
    assert falls == {0}


def test_a_king_bed_and_a_coffee_table_are_low_with_formulas_only():
    """At 0.4 g the formula of the paper calls neither low; the bed is too stocky, and so is the table."""
    items = [
        {"item": "bed", "floor": "1", "breadth": 193, "width": 203, "height": 60},
        {"item": "table", "floor": "1", "breadth": 60, "width": 120, "height": 40},
        {"item": "bookcase", "floor": "1", "breadth": 30, "width": 80, "height": 180},
    ]
    results = assessed(items, [{"floor": "1", "pfa_x": 0.4, "pfa_y": 0.4}])
    for name in ("bed", "table"):
        adopted = results[name].adopted
        assert (adopted.basis, adopted.risk, adopted.upper, adopted.probability) == (
            "cannot rock", RiskClass.LOW, RiskClass.LOW, 0.0,
        )  # fmt: skip
        assert results[name].governing.methods["proposed_or"].value >= 0.03
        assert results[name].formula_class is results[name].paper_class is RiskClass.LOW
    assert results["bookcase"].adopted.risk >= RiskClass.HIGH
    assert [work.items for one in results.schedule.rows for work in one.works] == [("bookcase",)]
    assert results.schedule.before.count(RiskClass.LOW) == 2


def test_a_top_heavy_piece_too_broad_for_the_formula_is_low_with_a_mark():
    """At B/H 1.5 FEMA P-58, which is for pieces of uniform weight, has no value; at 80 % of its height it can rock."""
    items = [{"item": "a", "floor": "1", "breadth": 150, "width": 160, "height": 100, "centre_of_gravity": 80}]
    floors = [{"floor": "1", "pfa_x": 0.5, "pfv_x": 60.0}]
    one = assessed(items, floors)["a"]
    assert one.formula.value is None
    assert (one.adopted.basis, one.adopted.probability, one.adopted.risk) == ("formula", 0.0, RiskClass.LOW)
    assert "extrapolated" in one.formula.flags, "outside of what the formula was checked for"
    checked = assessed(items, floors, settings=Settings(verify="high", runs=20))["a"]
    assert checked.is_simulated
