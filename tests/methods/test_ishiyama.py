"""Ishiyama's criterion: PFA and PFV must both exceed their limits."""

import math

import numpy as np
import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.ishiyama import METHOD
from assess.settings import Settings
from assess.units import GRAVITY

PIECE: dict[str, ArrayLike] = {"breadth": 0.4, "height": 1.6}  # limits: 0.25 g and 10·40/√160 = 31.62 cm/s


def evaluate(**given: ArrayLike) -> Outcome:
    return METHOD.evaluate(Cases.of(**{**PIECE, **given}), Settings())


def raised(outcome: Outcome) -> set[str]:
    return {name for name, flag in outcome.flags.items() if flag[0]}


def test_limits():
    detail = evaluate().detail
    assert detail["threshold_pfa_g"][0] == pytest.approx(0.25)
    assert detail["threshold_pfv_cm_s"][0] == pytest.approx(31.6228, abs=1e-4)


def test_both_must_be_exceeded():
    for pfa_g, pfv, met in ((0.26, 0.32, 1), (0.26, 0.31, 0), (0.24, 0.32, 0), (0.24, 0.31, 0), (0.25, 0.32, 0)):
        outcome = evaluate(pfa=pfa_g * GRAVITY, pfv=pfv)
        assert outcome.value[0] == met, (pfa_g, pfv)
        assert raised(outcome) == set()


def test_without_the_velocity_it_is_evaluated_only_where_the_acceleration_is_too_low():
    outcome = evaluate(pfa=0.26 * GRAVITY)
    assert math.isnan(outcome.value[0])
    assert raised(outcome) == {"pfv_unknown"}
    outcome = evaluate(pfa=0.24 * GRAVITY)
    assert outcome.value[0] == 0
    assert raised(outcome) == set()


@pytest.mark.parametrize("breadth_to_height", [0.05, 0.1, 0.15, 0.2])
def test_the_rounded_velocity_limit_is_that_of_an_impulse(breadth_to_height):
    # 0.4 √[(8 g r/3)(1 - cos α)/cos² α] of a slender piece, in m and m/s
    height, alpha = 1.8, math.atan(breadth_to_height)
    radius = 0.5 * height * math.hypot(1, breadth_to_height)
    impulse = 0.4 * math.sqrt(8 / 3 * GRAVITY * radius * (1 - math.cos(alpha)) / math.cos(alpha) ** 2)
    limit = evaluate(breadth=breadth_to_height * height, height=height).detail["threshold_pfv_cm_s"]
    assert np.allclose(limit, impulse * 100, rtol=0.05)
