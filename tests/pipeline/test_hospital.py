"""A hospital of which only peak floor accelerations are known: what simulation may say of its pieces, and what not."""

import pytest

from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.pipeline.rows import assessed

PFA = {"1": 0.04, "2": 0.15, "3": 0.3}
SIZES = {"cart": (45, 90), "cabinet": (40, 180), "rack": (30, 190), "fridge": (70, 180), "desk": (75, 75)}
SETTINGS = Settings(runs=60)


def hospital(**building):
    floors = [{"floor": floor, "pfa_x": pfa} for floor, pfa in PFA.items()]
    items = [
        {"item": f"{floor} {name}", "floor": floor, "axis": "X", "breadth": breadth, "height": height}
        for floor in PFA
        for name, (breadth, height) in SIZES.items()
    ]
    return assessed(items, floors, settings=SETTINGS, **building)


def test_of_an_unknown_building_the_simulated_chance_stands_unconfirmed():
    """The class is that of the faster third of the draws, where that is higher; what cannot rock in any draw is low.

    Each draw has the floor's PFA: what is drawn besides is the base and the height of the piece.
    """
    unknown = list(hospital())
    for one in unknown:
        found = one.governing.simulation
        assert one.adopted.basis in ("unconfirmed", "cannot rock")
        if one.adopted.is_unconfirmed:
            assert one.adopted.probability == found.probability
            assert one.adopted.risk == classify(max(found.probability, found.if_faster)), one.item.item
            assert "unknown_building" in one.adopted.flags
    assert sum(one.adopted.is_unconfirmed for one in unknown) >= 4
    still = [one for one in unknown if PFA[one.item.floor] * 1.41 < 0.65 * one.item.breadth_to_height]
    assert len(still) >= 3
    assert {(one.adopted.risk, one.adopted.basis) for one in still} == {(RiskClass.LOW, "cannot rock")}
    assert not any(one.adopted.can_rock for one in still)


@pytest.mark.parametrize("known", [{"period": 0.5}, {"height": 14}])
def test_with_the_period_or_the_height_every_class_is_the_simulated_one(known):
    for one in hospital(**known):
        assert one.adopted.basis in ("simulated", "cannot rock")
        assert one.adopted.risk == classify(one.governing.simulation.probability)
        assert "unknown_building" not in one.adopted.flags
