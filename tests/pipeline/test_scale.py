"""A stronger earthquake is never safer: the same building with every floor's motion multiplied by 0.5 to 2."""

import itertools

import numpy as np
import pytest

from assess.methods import all_methods, simulation
from assess.pipeline.run import compute
from assess.risk import classify_all
from assess.settings import Settings
from tests.motion.motions import MARKET
from tests.pipeline.rows import read

CHANNEL = "891018_1.cra-1.0210a.smc"
SCALES = (0.5, 0.7, 1.0, 1.4, 2.0)
RUNS = 200
NOT_MONOTONE = 0.06
"""What a chance may fall when the motion grows: rocking is not monotone."""


@pytest.fixture(scope="module")
def found():
    """The assessments by scale: one recorded floor, and one of which peaks are given; blocks of many sizes."""
    sizes = [
        (round(ratio * height), height) for height in (90, 130, 180, 210) for ratio in (0.12, 0.16, 0.2, 0.26, 0.34)
    ]
    items = [
        {"item": f"{floor} {at}", "floor": floor, "axis": "X", "breadth": breadth, "height": height}
        for floor in ("recorded", "given")
        for at, (breadth, height) in enumerate(sizes)
    ]
    floors = [{"floor": "recorded", "record_x": CHANNEL}, {"floor": "given", "pfa_x": 0.3, "pfv_x": 40}]
    inventory = read(items, floors, MARKET, period=1.2)
    return {scale: compute(inventory, Settings(runs=RUNS, scale=scale)) for scale in SCALES}


def test_no_class_by_formula_rises_in_a_weaker_earthquake(found):
    for method in all_methods():
        if method.tier != "screening":
            continue
        for weaker, stronger in itertools.pairwise(found.values()):
            values = weaker.outcomes[method.key].value, stronger.outcomes[method.key].value
            one, other = values if method.kind == "criterion" else map(classify_all, values)
            assert not (one > other).any(), method.key


def test_neither_chances_nor_expected_falls_are_much_higher_in_a_weaker_earthquake(found):
    """Falls beyond sampling error: those of a draw go together, so that a building counts as one sample a draw."""
    for weaker, stronger in itertools.pairwise(found.values()):
        one, other = weaker.outcomes[simulation().key].value, stronger.outcomes[simulation().key].value
        assert (one - other).max() <= NOT_MONOTONE
        falls = [
            sum(joint.fell.sum(axis=0).astype(float) for joint in one.outcomes[simulation().key].joints)
            for one in (weaker, stronger)
        ]
        difference = falls[0] - falls[1]
        assert difference.mean() <= 2 * difference.std() / np.sqrt(RUNS)


def test_peaks_are_multiplied_and_most_of_the_range_is_covered(found):
    for scale, one in found.items():
        np.testing.assert_allclose(one.cases.pfa, scale * found[1.0].cases.pfa, rtol=1e-12)
        np.testing.assert_allclose(one.cases.pfv, scale * found[1.0].cases.pfv, rtol=1e-12)
    shares = [one.outcomes[simulation().key].value.mean() for one in found.values()]
    assert shares == sorted(shares)
    assert shares[0] < 0.15
    assert shares[-1] > 0.5
