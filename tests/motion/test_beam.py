"""The beam that stands for a building: periods and shapes against formulas, its modes against exact oscillators."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.signal import StateSpace, lsim

from assess.arrays import FloatArray
from assess.motion.assumed import Building
from assess.motion.beam import DAMPING, MODES, find_shares, shake_record, solve_beam, swing_modes
from tests.motion.motions import make_motion

STEP = 0.005
SHEAR = 100.0
GROUND = np.random.default_rng(1).standard_normal(2000) * np.hanning(2000)


def find_exact(alpha: float, count: int) -> FloatArray:
    """Return T_m/T_1 of u'''' - alpha^2 u'' = lambda u, fixed at 0, with neither moment nor shear at 1."""

    def determinant(g: float) -> float:
        b = math.hypot(alpha, g)
        sin, cos, cosh, sinh = math.sin(g), math.cos(g), (1 + math.exp(-2 * b)) / 2, (1 - math.exp(-2 * b)) / 2
        scale = math.exp(-b)  # cosh and sinh are scaled by it
        moment = -(g**2) * cos * scale - b**2 * cosh, -(g**2) * sin * scale - g * b * sinh
        shear = g * b**2 * sin * scale - b * g**2 * sinh, -g * b**2 * cos * scale - g**3 * cosh
        return moment[0] * shear[1] - moment[1] * shear[0]

    places = np.linspace(0.5, math.pi * (count + 1), 2000)
    signs = np.sign([determinant(one) for one in places.tolist()])
    roots = [brentq(determinant, places[at], places[at + 1]) for at in np.flatnonzero(np.diff(signs))][:count]
    values = np.array([g**2 * (g**2 + alpha**2) for g in roots])
    return np.asarray(np.sqrt(values[0] / values))


def test_periods_of_a_shear_beam_are_as_1_to_3_to_5_and_of_one_that_bends_by_formula() -> None:
    np.testing.assert_allclose(1 / solve_beam(SHEAR)[0][:4], [1, 3, 5, 7], rtol=0.01)
    assert 1 / solve_beam(30.0)[0][1] == pytest.approx(3.0, rel=0.01)
    np.testing.assert_allclose(1 / solve_beam(0.0)[0][:3], [1, 6.27, 17.55], rtol=0.02)


@pytest.mark.parametrize("alpha", [0.7, 3.0, 10.0, 20.0, 30.0])
def test_periods_between_are_those_of_the_characteristic_equation(alpha: float) -> None:
    np.testing.assert_allclose(solve_beam(alpha)[0][:4], find_exact(alpha, 4), rtol=0.01)


def test_shares_by_formula_which_are_none_at_the_base_and_hold_beyond_the_roof() -> None:
    """A shear beam's are 4/(pi n) sin(n pi z/2), n = 1, 3, 5."""
    z = np.array([0.25, 0.5, 0.8, 1.0])
    found = find_shares(np.full(4, SHEAR), z)
    for mode, n in enumerate((1, 3, 5)):
        np.testing.assert_allclose(found[:, mode], 4 / (np.pi * n) * np.sin(n * np.pi * z / 2), atol=0.025)
    assert found[-1, 0] == pytest.approx(4 / np.pi, rel=0.005)
    np.testing.assert_allclose(find_shares(np.zeros(1), np.ones(1))[0, :3], [1.566, -0.868, 0.509], rtol=0.005)
    base, roof, above = find_shares(np.full(3, 5.0), np.array([0.0, 1.0, 1.2]))
    assert not base.any()
    np.testing.assert_array_equal(roof, above)
    assert 0.85 < roof.sum() < 1.0, "eight modes have almost all of the motion"


def test_each_mode_is_an_exact_oscillator_on_the_ground() -> None:
    alphas, periods = np.array([5.0, 0.7]), np.array([1.0, 2.5])
    ground = np.stack([GROUND, GROUND[::-1]]).astype(np.float32)
    found = swing_modes(ground, STEP, periods, alphas)
    assert found.shape == (2, 1 + MODES, 2000)
    np.testing.assert_array_equal(found[:, 0], ground)
    time = np.arange(2000) * STEP
    for k in range(2):
        every = periods[k] * solve_beam(float(alphas[k]))[0]
        for m, period in enumerate(every[every > 0.03].tolist()):
            w = 2 * np.pi / period
            system = StateSpace(
                [[0, 1], [-(w**2), -2 * DAMPING * w]], [[0], [-1]], [[-(w**2), -2 * DAMPING * w]], [[-1]]
            )
            expected = lsim(system, ground[k], time)[1]  # of the mass relative to the ground, along straight lines
            np.testing.assert_allclose(found[k, 1 + m], expected, atol=1e-4 * np.abs(expected).max())


def test_modes_of_a_short_period_move_with_the_ground() -> None:
    found = swing_modes(GROUND[None].astype(np.float32), STEP, np.array([0.1]), np.array([SHEAR]))
    assert found[0, 1:3].any(axis=1).all(), "0.1 and 0.033 s"
    assert not found[0, 3:].any(), "0.02 s and less"


def test_a_record_passed_through_beams() -> None:
    motion = make_motion(np.sin(2 * np.pi * np.arange(2000) * STEP), STEP)
    rigid, tuned = (
        shake_record(motion.acceleration, STEP, Building(period=period, scatter=0.0), 1.0) for period in (0.02, 1.0)
    )
    assert rigid == pytest.approx((motion.pfa, motion.pfv), rel=1e-4)
    assert tuned[0] > 6 * motion.pfa
    building = Building(period=1.0)
    assert shake_record(motion.acceleration, STEP, building, 0.0) == pytest.approx((motion.pfa, motion.pfv), rel=1e-4)
    unknown = shake_record(motion.acceleration, STEP, building, None)
    assert rigid[0] < unknown[0] < tuned[0]
