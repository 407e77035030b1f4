"""Static criterion: rocking starts where PFA exceeds g B/H."""

import math

import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.static import METHOD
from assess.settings import Settings
from assess.units import GRAVITY


def evaluate(**given: ArrayLike) -> Outcome:
    return METHOD.evaluate(Cases.of(**given), Settings())


def test_the_threshold_must_be_exceeded_and_is_known_where_the_motion_is_not():
    # a worked case: 47 by 117 cm starts to rock at 0.40 g
    detail = evaluate(breadth=0.47, height=1.17, pfa=1.0).detail
    assert detail["threshold_pfa_g"][0] == pytest.approx(0.40, abs=0.005)
    pfa = [0.2499 * GRAVITY, 0.25 * GRAVITY, 0.2501 * GRAVITY]
    assert evaluate(breadth=0.5, height=2.0, pfa=pfa).value.tolist() == [0, 0, 1]
    outcome = evaluate(breadth=0.5, height=2.0)
    assert math.isnan(outcome.value[0])
    assert outcome.detail["threshold_pfa_g"][0] == pytest.approx(0.25)
    assert METHOD.words == ("rocking can start", "rocking cannot start")
