"""Bodies in general: as the kernel where both apply, published and closed-form limits, and scipy with both motions."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from assess.errors import CancelledError
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.rocking import planar as kernel
from assess.rocking.ensemble import follow_block, rock_blocks
from assess.rocking.planar import Body, follow_body, rock_bodies, wall_restitution
from assess.units import GRAVITY as G
from tests.refusals import check_refusals
from tests.stopping import StopsAt

RECORD = Path(__file__).parents[2] / "samples" / "records" / "0165a_u.smc"


@pytest.fixture(scope="module")
def motion():
    return treat(read_records(RECORD)[0])


# --- bodies ---


@pytest.mark.parametrize(
    ("centre", "alpha", "p", "eta", "threshold"),
    [
        (0.4, 0.25732, 2.87596, 0.91414, 0.2632),
        (0.5, 0.20750, 2.75246, 0.93634, 0.2105),
        (0.6, 0.17367, 2.61979, 0.95163, 0.1754),
    ],
)
def test_bodies_whose_centre_of_gravity_is_not_in_the_middle(centre, alpha, p, eta, threshold):
    """0.40 x 1.90 m; from R2 = b2 + z2, I_0 = m (B2 + H2)/12 + m R2, by two independent calculations."""
    body = Body.rectangular(0.40, 1.90, centre=centre)
    assert float(body.critical_angle) == pytest.approx(alpha, abs=5.1e-6)
    assert float(body.frequency_parameter) == pytest.approx(p, abs=5.1e-6)
    assert float(body.restitution) == pytest.approx(eta, abs=5.1e-6)
    assert math.tan(body.critical_angle) == pytest.approx(threshold, abs=5.1e-5)


def test_a_rectangle_is_housner_s_block_and_stocky_ones_do_not_rebound():
    alpha = math.atan(0.4 / 1.8)
    body = Body.rectangular(0.4, 1.8)
    assert float(body.frequency_parameter) == pytest.approx(math.sqrt(3 * G / (2 * math.hypot(0.4, 1.8))), rel=1e-14)
    assert float(body.restitution) == pytest.approx(1 - 1.5 * math.sin(alpha) ** 2, rel=1e-14)
    assert float(Body.rectangular(0.4, 1.8, restitution=0.8).restitution) == 0.8
    assert float(Body.rectangular(0.70, 1.0).rebound) > 0  # from B/H 1/sqrt 2 on, cos2(alpha) is below 2/3
    assert float(Body.rectangular(0.71, 1.0).rebound) == 0


@pytest.mark.parametrize(("ratio", "e"), [(0.15, -0.4367), (0.2222, -0.3709), (0.30, -0.2887), (0.40, -0.1844)])
def test_sorrentino_2011_restitution(ratio, e):
    alpha = math.atan(ratio)
    assert wall_restitution(alpha, 1 - 1.5 * math.sin(alpha) ** 2) == pytest.approx(e, abs=5.1e-5)
    assert float(Body.rectangular(ratio * 1.8, 1.8).rebound) == pytest.approx(-e, abs=5.1e-5)


def test_bodies_that_cannot_be():
    usual = {"half_base": 0.2, "centre_height": 0.9, "frequency_parameter": 2.8}
    check_refusals(ValueError, lambda change: Body.of(**{**usual, **change}), [
        ({"half_base": 0}, "half_base must"),
        ({"centre_height": math.nan}, "centre_height must"),
        ({"frequency_parameter": -1}, "frequency_parameter must"),
        ({"restitution": 1.1}, "restitution must"),
        ({"half_base": 2.0}, "restitution must"),
    ])  # fmt: skip


# --- agreement with the kernel ---


@pytest.mark.slow
def test_it_agrees_with_the_kernel(motion):
    rng, fell = np.random.default_rng(1), 0
    for _ in range(150):
        height = rng.uniform(0.1, 2.2)
        breadth = height * rng.uniform(0.08, 1.2)
        values = motion.acceleration[None] * rng.uniform(0.8, 5) * breadth / height * G / motion.pfa
        eta = (math.nan, 0.95, 0.5)[rng.integers(3)]
        many = rock_blocks([breadth], [height], values, motion.time_step, restitution=eta)
        one = rock_bodies(Body.rectangular([[breadth]], [[height]], restitution=eta), values, motion.time_step)
        assert one.overturned[0, 0] == many.overturned[0, 0]
        assert abs(one.impacts[0, 0] - many.impacts[0, 0]) <= 2  # the last hops before rest are lost in rounding
        assert one.rotation[0, 0] == pytest.approx(many.rotation[0, 0], rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(one.fall_time, many.fall_time, rtol=1e-5)
        fell += int(one.overturned[0, 0])
    assert 20 < fell < 130


def test_coarse_steps_are_divided(motion):
    """A small body under the same straight lines, given by all or by every tenth of their points."""
    coarse = motion.acceleration[::10] * 1.8
    at = np.arange((coarse.size - 1) * 10 + 1) / 10
    fine = np.interp(at, np.arange(coarse.size), coarse)
    # The fall to zero takes one step: let both have it done at the same place.
    coarse, fine = np.append(coarse, 0.0), np.append(fine, coarse[-1] * (1 - np.arange(1, 11) / 10))
    body, step = Body.rectangular([[0.03]], [[0.1]]), 10 * motion.time_step
    one, other = rock_bodies(body, coarse[None], step), rock_bodies(body, fine[None], motion.time_step)
    assert one.rotation[0, 0] == pytest.approx(other.rotation[0, 0], rel=1e-6)
    assert abs(one.impacts[0, 0] - other.impacts[0, 0]) <= 2
    assert one.impacts[0, 0] > 10


def test_many_do_as_each_alone(motion):
    body = Body.rectangular(np.array([[0.3], [0.45]]), 1.8, restitution=np.array([0.95, 0.9, 0.85]))
    values = motion.acceleration[None] * np.array([[1.5], [2.0], [2.5]])
    scale = np.array([1.0, 1.1, 1.2])
    many = rock_bodies(body, values, motion.time_step, vertical=values / 3, away=1, scale=scale, threads=2)
    assert many.overturned.shape == (2, 3)
    for row in range(2):
        for at in range(3):
            own = Body.rectangular([[0.3], [0.45]][row], 1.8, restitution=(0.95, 0.9, 0.85)[at])
            alone = rock_bodies(
                own, scale[at] * values[at : at + 1], motion.time_step, vertical=scale[at] * values[at : at + 1] / 3,
                away=1,
            )  # fmt: skip
            assert alone.rotation[0, 0] == pytest.approx(many.rotation[row, at], rel=1e-9)
            assert alone.overturned[0, 0] == many.overturned[row, at]


def test_the_path_is_that_of_the_kernel(motion):
    for factor in (1.5, 3.0, 0.5):
        values = motion.acceleration * factor
        one = follow_body(Body.rectangular(0.4, 1.8), values, motion.time_step)
        other = follow_block(0.4, 1.8, values, motion.time_step)
        assert one.overturned == other.overturned
        assert abs(one.impacts - other.impacts) <= 2
        assert one.rotation == pytest.approx(other.rotation, rel=1e-6, abs=1e-9)
        assert one.times[0] == one.theta[0] == 0
        assert (np.diff(one.times) >= 0).all()
        at = np.linspace(0, min(one.times[-1], other.times[-1]), 4000)
        expected = np.interp(at, other.times, other.theta)
        np.testing.assert_allclose(np.interp(at, one.times, one.theta), expected, atol=2e-4)
        assert one.impact_times.size == one.impacts
        if one.overturned:
            assert one.times[-1] == one.fall_time
            assert abs(one.theta[-1]) == math.pi / 2
        else:
            assert one.times[-1] >= (values.size - 1) * motion.time_step


# --- vertical motion ---


@pytest.mark.parametrize(("up", "limit"), [(0.0, 1.8007), (-0.3, 1.3948), (0.3, 2.1850)])
def test_constant_vertical_acceleration_moves_the_limit_of_a_half_sine(up, limit):
    """Limits of the linear equation in alpha g, omega/p = 2; eq. 3 of a slender body in tan(alpha) g."""
    alpha, p = 0.005, 2.0
    body = Body.of(half_base=math.tan(alpha), centre_height=1.0, frequency_parameter=p, restitution=0.9)

    def falls(times):
        start = math.asin((1 + up) / times)  # from the uplift on
        step = (math.pi - start) / (2 * p) / 2000
        values = np.zeros(22_000)
        values[:2001] = times * math.tan(alpha) * np.sin(np.linspace(start, math.pi, 2001))
        return follow_body(body, values * G, step, vertical=np.full(values.size, up * G)).overturned

    assert not falls(limit - 0.0003)
    assert falls(limit + 0.0003)


def test_constant_vertical_acceleration_is_other_gravity(motion):
    """(1 + v) sin + h cos = (1 + v) [sin + h/(1 + v) cos]: the same body with p2 (1 + v) under a_h / (1 + v)."""
    values, v = np.append(motion.acceleration * 2.2, np.zeros(8000)), 0.25
    usual = Body.rectangular(0.4, 1.8)
    other = Body(
        critical_angle=usual.critical_angle, frequency_parameter=usual.frequency_parameter * math.sqrt(1 + v),
        restitution=usual.restitution, rebound=usual.rebound,
    )  # fmt: skip
    for away in (0, 1, -1):
        one = follow_body(usual, values, motion.time_step, vertical=np.full(values.size, v * G), away=away)
        two = follow_body(other, values / (1 + v), motion.time_step, away=away)
        assert one.overturned == two.overturned
        assert one.rotation == pytest.approx(two.rotation, rel=1e-6)
        assert one.rotation > 0.005


def test_a_body_lifts_where_the_floor_falls_away():
    values, up = np.full((1, 200), 0.2 * G), np.zeros((1, 200))
    body = Body.rectangular([[0.4]], [[1.8]])
    assert rock_bodies(body, values, 0.01).rotation[0, 0] == 0
    up[:] = -0.09 * G  # 0.2222 (1 - 0.09) = 0.2022 g
    assert rock_bodies(body, values, 0.01, vertical=up).rotation[0, 0] == 0
    up[:] = -0.11 * G
    assert rock_bodies(body, values, 0.01, vertical=up).rotation[0, 0] > 0


# --- a wall ---


@pytest.mark.parametrize(("ratio", "peak"), [(0.15, 0.0743), (0.2222, 0.0530), (0.30, 0.0318), (0.40, 0.0128)])
def test_sorrentino_2011_released_beside_a_wall(ratio, peak):
    """Linear, from theta/alpha 0.5: strikes at p t = arccosh 2, and turns back at 1 - sqrt(1 - 0.75 e2)."""
    alpha, p, step = 1e-4, 2.0, 1e-3
    rebound = float(Body.rectangular(ratio, 1.0).rebound)
    state = np.array([alpha / 2, 0, 1, alpha / 2, 0, 0, 0, -1, 0])
    still, trace = np.zeros(4002), np.zeros((6000, 3))
    kernel.rock(np.array([alpha, p, 0.9, rebound]), still, still, step, 1, state, trace)
    trace = trace[: int(state[kernel.ROWS])]
    first = trace[trace[:, 2] == 1]
    assert p * first[0, 0] == pytest.approx(math.acosh(2), abs=1e-6)
    assert p * first[0, 0] == pytest.approx(1.3170, abs=5.1e-5)
    assert first[:, 1].max() / alpha == pytest.approx(peak, abs=5.1e-5)
    assert first[:, 1].max() / alpha == pytest.approx(1 - math.sqrt(1 - 0.75 * rebound**2), abs=1e-5)
    assert state[kernel.IMPACTS] > 2
    assert state[kernel.RESTS] == 1


def test_beside_a_wall_a_body_turns_to_one_side_only(motion):
    values = motion.acceleration * 1.6
    body = Body.rectangular(0.4, 1.8)
    right, left = (follow_body(body, values, motion.time_step, away=away) for away in (1, -1))
    assert right.theta.min() == 0 < right.theta.max()
    assert left.theta.max() == 0 > left.theta.min()
    mirrored = follow_body(body, -values, motion.time_step, away=-1)
    np.testing.assert_array_equal(mirrored.theta, -right.theta)
    np.testing.assert_array_equal(mirrored.times, right.times)


def test_pushed_against_the_wall_a_body_stands():
    body, push = Body.rectangular([[0.4]], [[1.8]]), np.full((1, 300), 1.0 * G)
    assert rock_bodies(body, push, 0.01, away=1).rotation[0, 0] == 0
    assert rock_bodies(body, push, 0.01, away=-1).overturned[0, 0]
    assert rock_bodies(body, -push, 0.01, away=1).overturned[0, 0]


# --- scipy, with both motions ---


class Strikes:
    terminal, direction = True, -1.0

    def __call__(self, _, y):
        return y[0]


class Fell:
    terminal, direction = True, 1.0

    def __call__(self, _, y):
        return y[0] - math.pi / 2


def fly(alpha, p, edge, h, v, span, state):
    """One flight within a sample by scipy: time and state at its end, and the event that ended it."""

    def rates(t, y):
        share = (t, t)
        ground, up = (np.interp(s, (0.0, h[2]), line[:2]) for s, line in zip(share, (h, v), strict=True))
        pull = (1 + up) * math.sin(alpha - y[0]) + edge * ground * math.cos(alpha - y[0])
        return [y[1], -(p**2) * pull]

    longest = (span[1] - span[0]) / 10
    done = solve_ivp(
        rates, span, state, method="DOP853", events=(Strikes(), Fell()), rtol=1e-10, atol=1e-13, max_step=longest
    )
    which = next((at for at, times in enumerate(done.t_events) if times.size), None)
    return done.t[-1], done.y[:, -1], which, done.y[0].max()


def reference(body, across, up, step, away):
    """Overturned, largest |theta|/alpha and impacts of a body under motions [g] that end in rest."""
    alpha, p = float(body.critical_angle), float(body.frequency_parameter)
    factor = float(body.restitution if away == 0 else body.rebound)
    tan, rests, edge, state, peak, impacts = math.tan(alpha), True, 1.0, [0.0, 0.0], 0.0, 0
    for h, v in zip(pairwise([*across, 0.0]), pairwise([*up, 0.0]), strict=True):
        t = 0.0
        while t < step * (1 - 1e-9):
            if rests:
                grid = np.linspace(t, step, 2001)
                excess = [
                    -side * np.interp(grid, (0, step), h) - tan * (1 + np.interp(grid, (0, step), v))
                    for side in (-1, 1)
                ]
                ways = [(int(np.argmax(one > 0)), side) for one, side in zip(excess, (-1.0, 1.0), strict=True)
                        if (one > 0).any() and away in (0, side)]  # fmt: skip
                if not ways:
                    break
                place, edge = min(ways)
                t, rests, state = grid[place], False, [0.0, 0.0]
                if place == 2000:
                    rests = True
                    break
            t, state, which, highest = fly(alpha, p, edge, (*h, step), (*v, step), (t, step), state)
            peak = max(peak, highest)
            if which == 1:
                return True, math.pi / 2 / alpha, impacts
            if which == 0:
                impacts += 1
                state, edge = [0.0, factor * max(0.0, -state[1])], -edge if away == 0 else edge
                ground, rise = (np.interp(t, (0, step), line) for line in (h, v))
                back = p**2 * ((1 + rise) * math.sin(alpha) + edge * ground * math.cos(alpha))
                rests = state[1] ** 2 < 2 * back * 1e-7 * alpha
    return False, peak / alpha, impacts


@pytest.mark.parametrize("away", [0, 1, -1])
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.slow
def test_it_agrees_with_scipy(motion, seed, away):
    rng = np.random.default_rng(seed)
    first, size = int(rng.integers(550, 650)), 300
    across = motion.acceleration[first : first + size] / G * rng.uniform(1.3, 1.8)
    up = 0.8 * rng.permutation(motion.acceleration[first : first + size : 10] / G).repeat(10)
    body = Body.rectangular(0.35, 1.7, centre=rng.uniform(0.45, 0.55))
    found = follow_body(body, across * G, motion.time_step, vertical=up * G, away=away)
    overturned, rotation, impacts = reference(body, across, up, motion.time_step, away)
    assert found.rotation > 0.003
    assert found.overturned == overturned
    assert abs(found.impacts - impacts) <= 2  # those after the end of the motion are not followed there
    assert found.rotation == pytest.approx(rotation, rel=5e-4)


# --- what cannot be integrated ---


def test_motions_that_cannot_be_used_and_a_cancel():
    body, usual = Body.rectangular(0.4, 1.8), {"motions": np.ones((1, 5)), "time_step": 0.01}
    check_refusals(ValueError, lambda change: rock_bodies(body, **{**usual, **change}), [
        ({"motions": np.zeros(5)}, "motions have shape"),
        ({"motions": np.full((1, 5), math.nan)}, "motions have shape"),
        ({"vertical": np.zeros((1, 4))}, "vertical motions have shape"),
        ({"vertical": np.full((1, 5), -1.01 * G)}, "vertical acceleration is -1.01 g, expected above -1 g"),
        ({"vertical": np.full((1, 5), -0.6 * G), "scale": 2}, "vertical acceleration is -1.2 g"),
        ({"time_step": 0}, "time_step is 0 s"),
        ({"scale": math.inf}, "scale must"),
    ])  # fmt: skip
    with pytest.raises(CancelledError):
        rock_bodies(Body.rectangular(0.4, 1.8), np.ones((5, 10)), 0.01, progress=StopsAt(3))
