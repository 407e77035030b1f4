"""How a body starts to move, and how far it slides: published limits, closed forms, and scipy's integrator."""

import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from assess.errors import CancelledError
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.results import BRANCHES
from assess.rocking.sliding import UNKNOWN, Branch, branch, critical_friction, is_outside_shenton, peak_slip
from assess.units import GRAVITY as G
from tests.refusals import check_refusals
from tests.stopping import StopsAt

RECORD = Path(__file__).parents[2] / "samples" / "records" / "0165a_u.smc"

# --- how it starts ---


def test_shenton_1996_critical_friction_and_as_printed():
    for ratio, a, friction in (
        (0.2222, 0.3, 0.2414), (0.2222, 0.6, 0.3113), (0.2222, 1.0, 0.3953), (0.15, 0.4, 0.2108), (0.30, 0.6, 0.3706),
        (0.40, 0.8, 0.4906),
    ):  # fmt: skip
        assert critical_friction(ratio * 1.8, 1.8, a * G) == pytest.approx(friction, abs=5.1e-5), (ratio, a)
        assert critical_friction(ratio * 1.8, 1.8, -a * G) == critical_friction(ratio * 1.8, 1.8, a * G), (ratio, a)
    B, H = np.meshgrid(np.linspace(0.1, 1.0, 19), np.linspace(0.4, 2.5, 19))
    gamma, high = H / B, B / H * np.linspace(1.0, 9.0, 19)
    printed = (high * (4 + gamma**2) + 3 * gamma) / (1 + 4 * gamma**2 + 3 * high * gamma)
    np.testing.assert_allclose(critical_friction(B, H, high * G), printed, rtol=1e-13)


def test_critical_friction_at_uplift_and_far_above():
    ratio = np.array([0.1, 0.2222, 0.4, 0.9])
    np.testing.assert_allclose(critical_friction(ratio, 1.0, ratio * G), ratio, rtol=1e-12)
    limit = (4 + ratio**-2) / (3 / ratio)
    np.testing.assert_allclose(critical_friction(ratio, 1.0, 1e12 * G), limit, rtol=1e-9)
    assert np.isnan(critical_friction(ratio, 1.0, 0.99 * ratio * G)).all()


@pytest.mark.parametrize("centre", [0.3, 0.5, 0.62])
@pytest.mark.parametrize("a", [0.5, 0.9])
def test_critical_friction_is_what_the_edge_has_to_bear(centre, a):
    """The forces of a body that turns about its edge, from its acceleration at the first instant, by differences."""
    B, H, mass, dt = 0.35, 1.7, 40.0, 1e-5
    b, z = B / 2, centre * H
    inertia = mass * (B**2 + H**2) / 12 + mass * (b**2 + z**2)

    def rates(_, y):  # about the edge at the origin, behind which the centre lies: (-b, z), turned by y[0] clockwise
        x = -b * math.cos(y[0]) + z * math.sin(y[0])
        up = b * math.sin(y[0]) + z * math.cos(y[0])
        return [y[1], (mass * G * x + mass * a * G * up) / inertia]

    path = solve_ivp(rates, (0, 2 * dt), [0, 0], t_eval=[0, dt, 2 * dt], rtol=1e-12, atol=1e-20).y[0]
    x, up = -b * np.cos(path) + z * np.sin(path), b * np.sin(path) + z * np.cos(path)
    # The floor accelerates to the left, so in the room's frame the body is pushed to the right by a g.
    horizontal = a * G - np.diff(x, 2)[0] / dt**2
    vertical = G + np.diff(up, 2)[0] / dt**2
    assert critical_friction(B, H, a * G, centre=centre) == pytest.approx(horizontal / vertical, rel=1e-4)


def test_branches():
    for friction, a, expected in (
        (0.10, 0.09, Branch.REST), (0.50, 0.22, Branch.REST), (0.10, 0.11, Branch.SLIDE), (0.21, 2.00, Branch.SLIDE),
        (0.50, 0.23, Branch.ROCK), (0.3114, 0.60, Branch.ROCK), (0.3112, 0.60, Branch.SLIDE_AND_ROCK),
        (0.23, 0.60, Branch.SLIDE_AND_ROCK), (0.22, 0.60, Branch.SLIDE), (math.nan, 0.60, UNKNOWN),
        (0.5, math.nan, UNKNOWN),
    ):  # fmt: skip
        for sign in (1, -1):
            assert branch(0.4, 1.8, friction, sign * a * G) == expected, (friction, a)
    assert tuple(one.word for one in Branch) == BRANCHES, "results name the same"


def test_branches_at_their_limits():
    """On a limit a body stays at rest, or rocks where friction is just enough."""
    ratio = 0.4 / 1.8
    assert branch(0.4, 1.8, 0.5, ratio * G) == Branch.REST
    assert branch(0.4, 1.8, 0.1, 0.1 * G) == Branch.REST
    assert branch(0.4, 1.8, critical_friction(0.4, 1.8, 0.6 * G), 0.6 * G) == Branch.ROCK
    assert branch(0.4, 1.8, ratio, 0.6 * G) == Branch.SLIDE_AND_ROCK


def test_branches_of_many_bodies_with_their_words_and_of_a_high_centre_of_gravity():
    found = branch([0.4, 0.4, 0.9], 1.8, [0.1, 0.5, 0.3], 0.4 * G)
    assert [Branch(one).word for one in found] == ["slide", "rock", "slide"]
    assert Branch.REST.word == "rest"
    assert Branch.SLIDE_AND_ROCK.word == "slide and rock"
    assert found.shape == (3,)
    assert branch(0.4, 1.8, 0.4, 0.2 * G) == Branch.REST
    assert branch(0.4, 1.8, 0.4, 0.2 * G, centre=0.6) == Branch.ROCK
    assert branch(0.4, 1.8, 0.2, 0.3 * G) == Branch.SLIDE
    assert branch(0.4, 1.8, 0.2, 0.3 * G, centre=0.6) == Branch.SLIDE_AND_ROCK
    np.testing.assert_array_equal(is_outside_shenton([0.5, 0.45, 0.6, 0.5 + 1e-12]), [False, True, True, False])


# --- how far it slides ---


class Stops:
    """The event of a body that slides to one side."""

    terminal, direction = True, -1.0

    def __init__(self, side):
        self.side = side

    def __call__(self, _, state):
        return self.side * state[1]


def slide_on(state, span, here, slope, side, resistance):
    """Return time and state at the end of `span` or at a stop, by scipy, and whether the body stopped."""

    def rates(t, y):
        return [y[1], -(here + slope * (t - span[0])) - side * resistance]

    longest = (span[1] - span[0]) / 40  # between two looks for a stop
    done = solve_ivp(rates, span, state, events=Stops(side), rtol=1e-11, atol=1e-15, max_step=longest)
    return done.t[-1], done.y[:, -1], done.status == 1


def reference_slip(friction, motion, time_step):
    """Largest |slip| by scipy, sample by sample, starts and stops located as events."""
    resistance = friction * G
    x = v = peak = 0.0
    for first, last in pairwise([*map(float, motion), 0.0]):
        slope, t = (last - first) / time_step, 0.0
        while t < time_step * (1 - 1e-12):
            here = first + slope * t
            if v == 0.0 and abs(here) <= resistance * (1 + 1e-13):
                if abs(last) <= resistance:
                    break
                t = max(t, (math.copysign(resistance, last) - first) / slope)
                here = first + slope * t
            side = math.copysign(1, v) if v else -math.copysign(1, here)
            t, (x, v), stopped = slide_on([x, v], (t, time_step), here, slope, side, resistance)
            v = 0.0 if stopped else v
            peak = max(peak, abs(x))
    return max(peak, abs(x + math.copysign(v * v / (2 * resistance), v)))


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.slow
def test_newmark_1965_rectangular_pulse(sign):
    """A 0.5 g, mu 0.2, 0.2 s: (A - mu) g t2 A / 2 mu = 0.1471 m."""
    step, A, mu, t1 = 1e-6, 0.5, 0.2, 0.2
    pulse = np.full((1, round(t1 / step)), sign * A * G)
    exact = (A - mu) * G * t1**2 * A / (2 * mu)
    assert exact == pytest.approx(0.1471, abs=5e-5)
    assert peak_slip(mu, pulse, step)[0, 0] == pytest.approx(exact, rel=1e-5)


def test_a_body_that_stops_within_the_motion():
    """The same pulse followed by rest of one second: it stops after 0.5 s, and where it stopped is the peak."""
    step, A, mu, t1 = 1e-4, 0.5, 0.2, 0.2
    pulse = np.zeros((1, 12_000))
    pulse[0, : round(t1 / step)] = A * G
    assert peak_slip(mu, pulse, step)[0, 0] == pytest.approx(0.1471, rel=1e-3)
    assert peak_slip(mu, pulse, step)[0, 0] == pytest.approx(peak_slip(mu, pulse[:, :2000], step)[0, 0], rel=1e-12)


def test_a_triangular_pulse_in_closed_form():
    """From mu g on, a rises evenly to a peak and falls to zero within one step: three samples, all of it exact."""
    mu, A, step = 0.2, 0.6, 0.3
    motion = np.array([[0.0, A * G]])
    start = step * mu / A
    rise, fall = A * G / step, -A * G / step
    t1 = step - start
    v1, x1 = rise * t1**2 / 2, rise * t1**3 / 6
    push = (A - mu) * G
    v2, x2 = v1 + push * step + fall * step**2 / 2, x1 + v1 * step + push * step**2 / 2 + fall * step**3 / 6
    assert v2 > 0
    assert peak_slip(mu, motion, step)[0, 0] == pytest.approx(x2 + v2**2 / (2 * mu * G), rel=1e-13)


@pytest.mark.parametrize("friction", [0.02, 0.1, 0.25])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_newmark_1965_by_scipy(friction, seed):
    """Coarse random motions, whose samples hold several starts and stops each."""
    rng = np.random.default_rng(seed)
    motion = rng.normal(0, 0.2 * G, 60)
    found = peak_slip(friction, motion[None], 0.05)[0, 0]
    assert found == pytest.approx(reference_slip(friction, motion, 0.05), rel=1e-6, abs=1e-9)


@pytest.mark.slow
def test_newmark_1965_by_scipy_under_a_record():
    motion = treat(read_records(RECORD)[0])
    strong = slice(400, 1400)
    values = motion.acceleration[strong]
    found = peak_slip([0.1, 0.2], values[None], motion.time_step)[:, 0]
    assert found[0] > found[1] > 1e-4
    for one, friction in zip(found, (0.1, 0.2), strict=True):
        assert one == pytest.approx(reference_slip(friction, values, motion.time_step), rel=1e-6)


def test_slip_is_none_below_friction_and_with_hardly_any_friction_the_body_stays_behind():
    motion = 0.3 * G * np.sin(2 * np.pi * np.arange(2001) * 0.005)[None]
    assert peak_slip(0.3001, motion, 0.005)[0, 0] == 0
    assert peak_slip(0.29, motion, 0.005)[0, 0] > 0
    motion = 0.3 * G * np.sin(2 * np.pi * np.arange(2001) * 0.0005)[None]
    # one period of a sine of 1 s moves the ground by A / 2 pi, and leaves it at rest
    assert peak_slip(1e-7, motion, 0.0005)[0, 0] == pytest.approx(0.3 * G / (2 * np.pi), rel=1e-5)


def test_slip_scales_with_the_motion_and_friction():
    motion = treat(read_records(RECORD)[0])
    values = motion.acceleration[None]
    usual = peak_slip(0.1, values, motion.time_step)
    np.testing.assert_allclose(peak_slip(0.2, values, motion.time_step, scale=2.0), 2 * usual, rtol=1e-9)
    np.testing.assert_allclose(peak_slip(0.2, 2 * values, motion.time_step), 2 * usual, rtol=1e-9)
    np.testing.assert_allclose(peak_slip(0.1, -values, motion.time_step), usual, rtol=1e-12)


def test_slips_of_many_do_not_depend_on_each_other():
    motion = treat(read_records(RECORD)[0])
    values = motion.acceleration[None, :2000] * np.linspace(0.5, 3, 7)[:, None]
    mu, scale = np.array([0.05, 0.2, 0.4]), np.linspace(1, 2, 7)
    many = peak_slip(mu, values, motion.time_step, scale=scale, threads=3)
    assert many.shape == (3, 7)
    for row, friction in enumerate(mu):
        for at in range(7):
            own = peak_slip(friction, values[at : at + 1], motion.time_step, scale=scale[at])
            assert own[0, 0] == many[row, at]
    assert (np.diff(many[:, -1]) < 0).all()


def test_what_cannot_slide_and_a_cancel():
    usual: dict[str, Any] = {"friction": 0.2, "motions": np.zeros((1, 5)), "time_step": 0.01}
    check_refusals(ValueError, lambda change: peak_slip(**usual | change), [
        ({"friction": 0}, "friction must be"),
        ({"friction": math.nan}, "friction must be"),
        ({"motions": np.zeros(5)}, "motions have shape"),
        ({"motions": np.full((1, 5), np.inf)}, "motions have shape"),
        ({"time_step": 0.0}, "time_step is 0.0 s"),
        ({"scale": np.nan}, "scale must be"),
    ])  # fmt: skip
    with pytest.raises(CancelledError):
        peak_slip(0.1, np.ones((5, 10)), 0.01, progress=StopsAt(3))


def test_how_it_starts_needs_no_compiler():
    code = "import sys, assess.rocking.sliding; print([one for one in ('numba', 'scipy') if one in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.strip() == "[]"
