"""The table of floor medians: what comes out of it, at its entries, between them and beyond them."""

import itertools
import math

import numpy as np
import pytest

from assess.intensity import RATIO
from assess.model import STRUCTURES as MODELLED
from assess.motion.floor_medians import (
    ALIKE,
    PERIODS,
    PLACES,
    RATIOS,
    SCATTER,
    STRUCTURES,
    find_medians,
    is_within,
    read_table,
)

EVERY = list(itertools.product(STRUCTURES, (*PERIODS, None), (*PLACES, None), RATIOS))


@pytest.mark.parametrize("place", [0.0, -0.2])
def test_the_ground_moves_as_it_does(place: float) -> None:
    for structure, period, _, ratio in EVERY:
        assert find_medians(period, place, structure, ratio) == (1.0, 1.0)
        assert find_medians(period, 1e-6, structure, ratio) == pytest.approx((1.0, 1.0), abs=1e-4)


def test_its_entries_come_out_and_are_those_of_floors() -> None:
    table = read_table()
    periods, places = (*PERIODS, None), (*PLACES, None)
    for structure, period, place, ratio in EVERY:
        own = table[structure][periods.index(period), RATIOS.index(ratio), places.index(place)]
        assert find_medians(period, place, structure, ratio) == pytest.approx(tuple(own), rel=1e-9)
    assert {one.shape for one in table.values()} == {(len(PERIODS) + 1, len(RATIOS), len(PLACES) + 1, 2)}
    for values in table.values():
        assert np.isfinite(values).all()
        assert 0.1 < values.min() < values.max() < 4.0
        usual = values[:, [ratio > 0.06 for ratio in RATIOS]]
        assert usual.min() > 0.4, "a tall building is spared much of the fastest ground motions alone"
    assert set(ALIKE) | set(STRUCTURES) == set(MODELLED)


@pytest.mark.parametrize("structure", STRUCTURES)
def test_between_entries_it_is_straight_in_logarithms_and_in_height(structure: str) -> None:
    def check(middle: tuple[float, float, float], *ends: tuple[float, float, float]) -> None:
        """Each is T1, z/h and PGV/PGA."""
        found, *others = (find_medians(period, place, structure, ratio) for period, place, ratio in (middle, *ends))
        assert found == pytest.approx(tuple(np.mean(others, axis=0)), rel=1e-9)

    for place, ratio in itertools.product(PLACES, RATIOS):
        check((math.sqrt(1.6), place, ratio), (1.0, place, ratio), (1.6, place, ratio))
    check((1.0, 0.5, math.sqrt(RATIOS[2] * RATIOS[3])), (1.0, 0.5, RATIOS[2]), (1.0, 0.5, RATIOS[3]))
    check((1.0, 0.525, RATIO), (1.0, 0.45, RATIO), (1.0, 0.6, RATIO))
    check((1.0, 0.075, RATIO), (1.0, 0.0, RATIO), (1.0, 0.15, RATIO))


@pytest.mark.parametrize(("beyond", "edge"), [(0.01, PERIODS[0]), (30.0, PERIODS[-1])])
def test_beyond_them_the_nearest_holds(beyond: float, edge: float) -> None:
    for place in (0.5, None):
        assert find_medians(beyond, place, "frame", RATIO) == find_medians(edge, place, "frame", RATIO)
    for ratio, nearest in ((1e-3, RATIOS[0]), (2.0, RATIOS[-1])):
        assert find_medians(1.0, 0.5, "walls", ratio) == find_medians(1.0, 0.5, "walls", nearest)
    assert find_medians(1.0, 1.3, "dual", RATIO) == find_medians(1.0, 1.0, "dual", RATIO)
    assert is_within(1.0, RATIO)
    assert is_within(None, RATIO)
    for period, ratio in ((0.05, RATIO), (7.0, RATIO), (1.0, 0.5), (None, 0.01)):
        assert not is_within(period, ratio)


def test_structures_that_are_as_another() -> None:
    assert find_medians(1.0, 0.5, "timber", RATIO) == find_medians(1.0, 0.5, "frame", RATIO)
    assert find_medians(1.0, 0.5, "masonry", RATIO) == find_medians(1.0, 0.5, "dual", RATIO)
    assert find_medians(1.0, 0.5, "walls", RATIO) != find_medians(1.0, 0.5, "frame", RATIO)


@pytest.mark.parametrize("structure", STRUCTURES)
def test_how_it_goes_with_period_and_height(structure: str) -> None:
    """Half-way up a longer T1 spares the floor its peak; upwards floors move more, to a roof that is shaken most."""
    half = [find_medians(period, 0.5, structure, RATIO)[0] for period in np.geomspace(0.5, 4.0, 12)]
    assert (np.diff(half) < 0).all()
    for period in (0.1, 0.25, 0.63):
        rising = [find_medians(period, place, structure, RATIO) for place in (0.0, *PLACES)]
        assert (np.diff(rising, axis=0) > 0).all()
    stiff, roof = find_medians(PERIODS[0], 1.0, structure, RATIO), find_medians(1.0, 1.0, structure, RATIO)
    assert stiff[1] == pytest.approx(1.0, abs=0.1), "a stiff building has the velocity of its ground"
    assert roof[1] > 1.5
    assert 0.3 <= SCATTER <= 0.4
