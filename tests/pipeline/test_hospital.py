"""A hospital of which only peak floor accelerations are known: what simulation may say of its pieces, and what not."""

import math

import pytest

import assess
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.workbooks import write

PFA = {"1": 0.04, "2": 0.15, "3": 0.3}
SIZES = {"cart": (45, 90), "cabinet": (40, 180), "rack": (30, 190), "fridge": (70, 180), "desk": (75, 75)}
SETTINGS = Settings(runs=60)


def hospital(folder, **building):
    floors = [{"floor": floor, "pfa_x": pfa} for floor, pfa in PFA.items()]
    items = [
        {"item": f"{floor} {name}", "floor": floor, "axis": "X", "breadth": breadth, "height": height}
        for floor in PFA
        for name, (breadth, height) in SIZES.items()
    ]
    return assess.run(write(folder / "w.xlsx", items, floors, **building), SETTINGS, figures=False)


@pytest.fixture(scope="module")
def unknown(tmp_path_factory):
    """Neither T1 nor the height is known."""
    return hospital(tmp_path_factory.mktemp("unknown"))


def test_a_class_above_the_simulated_one_is_unconfirmed_and_nothing_else(unknown):
    for one in unknown:
        simulated = classify(one.governing.simulation.probability)
        assert one.adopted.basis in ("simulated", "unconfirmed")
        assert one.adopted.is_unconfirmed == (one.adopted.risk > simulated), one.item.item
    assert sum(one.adopted.is_unconfirmed for one in unknown) >= 4
    assert all("unknown_period" in one.adopted.flags for one in unknown if one.adopted.is_unconfirmed)


def test_what_cannot_rock_at_three_dispersions_is_low(unknown):
    still = [one for one in unknown if PFA[one.item.floor] * math.exp(3 * 0.4) < 0.85 * one.item.breadth_to_height]
    assert len(still) >= 4
    assert any(one.formula_class > RiskClass.LOW for one in still), "the formula gives some a higher class"
    assert {(one.adopted.risk, one.adopted.basis) for one in still} == {(RiskClass.LOW, "simulated")}
    assert not any(one.adopted.can_rock for one in still)


@pytest.mark.parametrize("known", [{"period": 0.5}, {"height": 14}])
def test_with_the_period_or_the_height_every_class_is_the_simulated_one(tmp_path, known):
    for one in hospital(tmp_path, **known):
        assert one.adopted.basis == "simulated"
        assert one.adopted.risk == classify(one.governing.simulation.probability)
        assert "unknown_period" not in one.adopted.flags
