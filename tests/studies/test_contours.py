"""Risk over breadth and PFA: which channel is drawn, and where a surface is irregular."""

from pathlib import Path

import numpy as np
import pytest

from assess.methods import Cases, all_methods
from assess.settings import Settings
from assess.studies.agreement import PRINTED
from assess.studies.buildings import LEVELS, RECORDED
from assess.studies.contours import DIRECT, HEIGHT, PANELS, choose_contours
from assess.studies.study import Options
from assess.units import GRAVITY
from tests.studies.made_up import make_compared

OPTIONS = Options(out=Path("unused"))


@pytest.mark.slow
def test_the_channel_of_the_highest_risk_as_recorded_is_drawn():
    """Where the chance grows with PFV, it is the channel with the largest recorded PFV."""
    judged = make_compared(lambda _b, _h, _a, pfv: pfv / 10, OPTIONS)
    for one in choose_contours(judged):
        own = [other.trials for other in judged if other.building == one.compared.building]
        assert one.compared.trials is max(own, key=lambda other: other.pfv[RECORDED])
        assert one.risk[DIRECT].shape == (len(LEVELS), one.breadth.size) == (17, 17)
        assert one.find_irregular(DIRECT)[0].size == one.find_irregular(DIRECT)[1].size == 0
    judged = make_compared(lambda b, _h, _a, _v: 0 * b, OPTIONS)  # nothing falls: that of the largest PFA
    for one in choose_contours(judged):
        own = [other.trials for other in judged if other.building == one.compared.building]
        assert one.compared.trials.pfa[RECORDED] == max(other.pfa[RECORDED] for other in own)


def test_irregular_steps_are_measured():
    """A chance that falls by 0.3 at one PFA for all breadths, and rises once by 0.1 with breadth."""

    def chance(breadth, _height, pfa, _pfv):
        return np.where((pfa > 4.9) & (pfa < 5.3), 0.2, 0.5) + np.where(breadth > 0.6, 0.1, 0.0)

    for one in choose_contours(make_compared(chance, OPTIONS)):
        assert one.find_irregular(DIRECT)[0] == pytest.approx(np.full(one.breadth.size, 0.3))
        assert one.find_irregular(DIRECT)[1] == pytest.approx(np.full(one.pfa.size, 0.1))


def test_equation_9_is_irregular_where_its_coefficients_say():
    """Past PFA* = (c + f/(B/H))/(-2e) it falls, where it is below 1; what is used never does."""
    one = choose_contours(make_compared(lambda b, _h, _a, _v: 0 * b, OPTIONS))[0]
    x, y = one.breadth / HEIGHT, one.pfa / GRAVITY * 980.665
    grid = (
        -0.97758451 + 0.30856415 / x + 0.0032112873 * y[:, None] - 0.018590461 / x**2
        - 0.000001941 * y[:, None] ** 2 - 0.00010152672 * y[:, None] / x
    )  # fmt: skip
    steps = np.diff(np.clip(grid, 0, 1), axis=0)
    assert one.find_irregular(PRINTED)[0] == pytest.approx(-steps[steps < 0])
    assert one.find_irregular(PRINTED)[0].size > 0
    assert one.find_irregular("proposed_or")[0].size == one.find_irregular("proposed_or")[1].size == 0
    breadth, pfa, risk = one.refine("kaneko_hayashi")  # what is drawn between is the formula itself
    method = next(method for method in all_methods() if method.key == "kaneko_hayashi")
    at, block = 40, 90
    cases = Cases.of(breadth=breadth[block], height=HEIGHT, pfa=pfa[at], pfv=one.compared.ratio * pfa[at])
    assert risk[at, block] == pytest.approx(method.evaluate(cases, Settings()).value[0])
    assert set(one.risk) == set(PANELS)
