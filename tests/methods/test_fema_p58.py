"""FEMA P-58 contents: lognormal in PFV about a median inferred from nine published ones."""

import math

import numpy as np
import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.fema_p58 import BETA, METHOD, median_pfv
from assess.rocking.block import STOCKY
from assess.settings import Settings

PIECE: dict[str, ArrayLike] = {"breadth": 0.4, "height": 1.8}
MEDIAN = median_pfv(np.array([0.4]), np.array([1.8]))[0]


def evaluate(**given: ArrayLike) -> Outcome:
    return METHOD.evaluate(Cases.of(**{**PIECE, **given}), Settings())


def raised(outcome: Outcome) -> set[str]:
    return {name for name, flag in outcome.flags.items() if flag[0]}


def test_lognormal_about_the_median():
    outcome = evaluate(pfv=MEDIAN * np.exp(BETA * np.array([-1, 0, 1])))
    assert outcome.value == pytest.approx([0.158655254, 0.5, 0.841344746])
    assert outcome.detail["median_pfv_cm_s"] == pytest.approx(MEDIAN * 100)
    assert raised(outcome) == set()
    assert evaluate(pfv=0.0).value[0] == 0
    assert evaluate(pfv=0.5, pfa=0.0).value[0] == evaluate(pfv=0.5, pfa=20.0).value[0]


def test_unknown_velocity():
    outcome = evaluate(pfa=3.0)
    assert math.isnan(outcome.value[0])
    assert raised(outcome) == {"pfv_unknown"}
    assert outcome.detail["median_pfv_cm_s"][0] == pytest.approx(MEDIAN * 100)


def test_a_stocky_piece_does_not_rock():
    outcome = evaluate(breadth=[STOCKY - 0.001, STOCKY, 1.5, 3.0], height=1.0, pfv=5.0)
    assert np.isnan(outcome.value).tolist() == [False, True, True, True]
    assert outcome.flags["does_not_rock"].tolist() == [False, True, True, True]
    assert outcome.flags["extrapolated"].tolist() == [True, False, False, False]


def test_outside_the_published_medians():
    ratios = [0.154, 0.155, 0.4, 0.625, 0.626]
    outcome = evaluate(breadth=[ratio * 1.7 for ratio in ratios], height=1.7, pfv=0.5)
    assert outcome.flags["extrapolated"].tolist() == [True, False, False, False, True]
    assert "inferred" in METHOD.departures[0]
    assert "nine" in METHOD.departures[0]


def test_the_median_grows_with_breadth_and_with_size():
    breadth_to_height = np.linspace(0.02, 1.4, 500)
    assert np.all(np.diff(median_pfv(breadth_to_height, np.ones(500))) > 0)
    height = np.linspace(0.2, 3.0, 100)
    assert np.all(np.diff(median_pfv(0.25 * height, height)) > 0)
