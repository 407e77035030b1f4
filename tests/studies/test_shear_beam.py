"""The shear beam: against an integration of its modes, a chain of masses, and what is known of its ends."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import StateSpace, lsim

from assess.studies.calibration import DAMPING, HIGHEST, count_modes, find_shares, shake_beam

STEP = 0.005
TIMES = np.arange(2001) * STEP


@pytest.fixture(scope="module")
def ground():
    """Rises from rest, with two frequencies [m/s2]."""
    rise = np.clip(TIMES / 2, 0, 1) * np.clip((8 - TIMES) / 2, 0, 1)
    return rise * (1.5 * np.sin(2 * np.pi * 1.1 * TIMES) + 0.8 * np.sin(2 * np.pi * 3.7 * TIMES))


@pytest.mark.slow
def test_two_modes_are_those_of_the_equation_of_motion(ground):
    """T1 of 1 s, mid-height: shares 4/pi sin(45 deg) and 4/(3 pi) sin(135 deg), the rest moves with the ground."""
    omega = 2 * np.pi * np.array([1.0, 3.0])
    shares = np.array([4 / np.pi, 4 / (3 * np.pi)]) * np.sqrt(0.5)

    def move(time, state):
        u, v = state[:2], state[2:]
        return np.concatenate([v, -np.interp(time, TIMES, ground) - 2 * DAMPING * omega * v - omega**2 * u])

    done = solve_ivp(move, (0, TIMES[-1]), np.zeros(4), t_eval=TIMES, max_step=STEP, rtol=1e-9, atol=1e-12)
    u, v = done.y[:2], done.y[2:]
    expected = (1 - shares.sum()) * ground - shares @ (2 * DAMPING * omega[:, None] * v + omega[:, None] ** 2 * u)
    found = shake_beam(ground, STEP, 1.0, 0.5, modes=2)
    assert found == pytest.approx(expected, abs=1e-5)  # of 5 m/s2 and more: what the integrator keeps to anywhere
    assert np.abs(found).max() > 2 * np.abs(ground).max()


@pytest.mark.parametrize("place", [0.5, 1.0])
def test_it_is_a_chain_of_many_masses(ground, place):
    """100 equal masses and springs, its modes found numerically, integrated by scipy: T1 of 1 s within 1 %."""
    count = 100
    stiffness = 2 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    stiffness[-1, -1] = 1
    squared, shapes = np.linalg.eigh(stiffness)
    omega = np.sqrt(squared / squared[0]) * 2 * np.pi
    weights = shapes.sum(axis=0) * shapes[round(place * count) - 1]
    low = omega <= 2 * np.pi * HIGHEST
    expected = (1 - weights[low].sum()) * ground
    for own, weight in zip(omega[low], weights[low], strict=True):
        system = StateSpace(
            [[0, 1], [-(own**2), -2 * DAMPING * own]], [[0], [-1]], [[-(own**2), -2 * DAMPING * own]], [[0]]
        )
        expected = expected + weight * lsim(system, ground, TIMES)[1]
    found = shake_beam(ground, STEP, 1.0, place)
    assert np.abs(found - expected).max() < 0.02 * np.abs(expected).max()


def test_at_its_foot_and_where_it_is_rigid_it_is_the_ground(ground):
    assert shake_beam(ground, STEP, 2.0, 0.0) == pytest.approx(ground)
    assert np.abs(shake_beam(ground, STEP, 0.01, 1.0) - ground).max() < 0.02 * np.abs(ground).max()


def test_resonance_is_that_of_one_mode():
    """A long sine at T1: the first mode answers 1/(2 zeta) times as strongly, next to which the others are small."""
    times = np.arange(12001) * STEP
    floor = shake_beam(np.sin(2 * np.pi * times), STEP, 1.0, 1.0)
    steady = np.abs(floor[-2000:]).max()
    assert steady == pytest.approx(4 / np.pi / (2 * DAMPING), rel=0.05)


def test_shares_of_all_modes_are_one_and_modes_are_counted_up_to_the_highest_frequency():
    assert find_shares(100_000, 1.0).sum() == pytest.approx(1, abs=1e-5)
    assert find_shares(100_000, 0.5).sum() == pytest.approx(1, abs=1e-5)
    assert find_shares(3, 0.0) == pytest.approx(0)
    # mode n has the frequency (2n - 1)/T1, up to 25 Hz
    assert [count_modes(period) for period in (0.01, 0.5, 1.0, 4.0)] == [1, 6, 13, 50]


def test_what_is_no_floor_of_a_beam_is_refused(ground):
    for period, place in ((0.0, 0.5), (-1.0, 0.5), (np.inf, 0.5), (1.0, -0.1), (1.0, 1.1)):
        with pytest.raises(ValueError, match="expected above 0 and 0 to 1"):
            shake_beam(ground, STEP, period, place)
