"""ODE23s: a step worked by hand, its order, its stability, and what `solve_ivp` asks of a solver."""

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.integrate import solve_ivp

from assess.studies.solver.ode23s import E32, D, Ode23s


def swing(t, y):
    return [y[1], -y[0] + np.sin(3 * t)]


def swing_exactly(t):
    """Of y'' = -y + sin 3t from y = 1, y' = 0: cos t + 3/8 sin t - 1/8 sin 3t."""
    return np.array([
        np.cos(t) + 3 / 8 * np.sin(t) - np.sin(3 * t) / 8,
        -np.sin(t) + 3 / 8 * np.cos(t) - 3 / 8 * np.cos(3 * t),
    ])  # fmt: skip


def step_evenly(h, jac=None):
    loose = {"rtol": 1e6, "atol": 1e6, "first_step": h, "max_step": h}
    return solve_ivp(swing, (0, 2), [1.0, 0.0], method=Ode23s, jac=jac, dense_output=True, **loose)


def test_one_step_worked_by_hand():
    """Of y' = -y from 1 over h = 1/2: W = 1 + d/2, k1 = -1/W, F1 = -(1 + k1/4), k2 = (F1 - k1)/W + k1."""
    solver = Ode23s(
        lambda _t, y: -y, 0.0, np.array([1.0]), 1.0, rtol=1.0, atol=1.0, first_step=0.5, jac=lambda _t, _y: -np.eye(1)
    )
    solver.step()
    assert pytest.approx(0.2928932188134524) == D
    assert pytest.approx(7.414213562373095) == E32
    w = 1.1464466094067263
    k1 = -1 / w  # -0.872260...
    f1 = -(1 + k1 / 4)
    k2 = (f1 - k1) / w + k1
    assert k1 == pytest.approx(-0.8722604192)
    assert k2 == pytest.approx(-0.7934730, abs=1e-7)
    assert solver.y[0] == pytest.approx(1 + 0.5 * k2, rel=1e-12)
    assert solver.nfev == 3
    assert solver.njev == solver.nlu == 1


def test_order_two_and_the_path_within_a_step():
    off = [np.abs(step_evenly(h).y[:, -1] - swing_exactly(2.0)).max() for h in (0.1, 0.05, 0.025)]
    assert off[0] / off[1] == pytest.approx(4, rel=0.05)
    assert off[1] / off[2] == pytest.approx(4, rel=0.05)
    found = step_evenly(0.05)
    assert found.sol(found.t) == pytest.approx(found.y, abs=1e-14)
    times = np.linspace(0, 2, 201)
    assert found.sol(times) == pytest.approx(swing_exactly(times), abs=2e-3)
    assert found.sol(0.3).shape == (2,)
    given_jacobian = step_evenly(0.05, lambda _t, _y: np.array([[0.0, 1.0], [-1.0, 0.0]]))
    assert given_jacobian.y == pytest.approx(found.y, abs=1e-8)


@settings(deadline=None, max_examples=30)
@given(st.floats(-7, -2), st.floats(0.2, 5.0))
@pytest.mark.slow
def test_the_error_follows_the_tolerance(exponent, end):
    rtol = 10.0**exponent
    found = solve_ivp(swing, (0, end), [1.0, 0.0], method=Ode23s, rtol=rtol, atol=rtol / 100)
    assert found.success
    assert np.abs(found.y[:, -1] - swing_exactly(end)).max() < 100 * rtol ** (2 / 3)


@settings(deadline=None, max_examples=30)
@given(st.floats(1e3, 1e9))
@pytest.mark.slow
def test_stiff_decay_is_stable_at_long_steps(rate):
    """Of y' = -rate (y - cos t) - sin t, whose slow part is cos t; explicit steps would be 2 / rate at most."""
    found = solve_ivp(
        lambda t, y: -rate * (y - np.cos(t)) - np.sin(t), (0, 10), [2.0], method=Ode23s, rtol=1e-3, atol=1e-5
    )
    assert found.success
    assert found.t.size < 1500
    assert found.y[0, -1] == pytest.approx(math.cos(10), abs=1e-2)


def test_van_der_pol():
    def rates(_t, y):
        return [y[1], 1000 * (1 - y[0] ** 2) * y[1] - y[0]]

    stiff = solve_ivp(rates, (0, 2000), [2.0, 0.0], method=Ode23s, rtol=1e-4, atol=1e-6)
    assert stiff.y[0, -1] == pytest.approx(1.70617, abs=2e-3)  # by Radau at rtol 1e-8
    assert stiff.t.size < 2000


def test_backwards_and_events_and_a_solution_that_ends_is_reported():
    back = solve_ivp(swing, (2, 0), swing_exactly(2.0), method=Ode23s, rtol=1e-6, atol=1e-8)
    assert back.y[:, -1] == pytest.approx([1, 0], abs=1e-4)
    fall = solve_ivp(
        lambda _t, y: [y[1], -2.0], (0, 9), [0.0, 3.0], method=Ode23s, events=lambda _t, y: y[0], first_step=0.1
    )
    assert fall.t_events[0][-1] == pytest.approx(3.0, abs=1e-9)  # a parabola is followed exactly
    found = solve_ivp(lambda _t, y: y**2, (0, 2), [1.0], method=Ode23s)  # 1 / (1 - t)
    assert not found.success
    assert found.t[-1] == pytest.approx(1.0, abs=0.01)


def test_bad_options():
    for options, says in (({"rtol": 0}, "above 0"), ({"atol": -1}, "above 0"), ({"first_step": 0}, "above 0"),
                          ({"order": 3}, "no option order")):  # fmt: skip
        with pytest.raises(ValueError, match=says):
            Ode23s(swing, 0.0, np.array([1.0, 0.0]), 1.0, **options)
