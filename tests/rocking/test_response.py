"""The path of one block: the verdict is that of many blocks to the bit, and the path is that of the block."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.rocking import ensemble
from assess.rocking.ensemble import follow_block, rock_blocks
from assess.units import GRAVITY
from tests.refusals import check_refusals

ROOT = Path(__file__).parents[2]
RECORDS = [
    *sorted((ROOT / "inventories" / "records" / "575-market").glob("*0210[a-d]*.smc")),
    ROOT / "samples" / "records" / "0165a_u.smc",
    ROOT / "samples" / "records" / "np01002p_4225a_a.smc",
]
STEP = 0.005


@pytest.fixture(scope="module")
def motions():
    return [treat(read_records(path)[0]) for path in RECORDS]


def draw(motions, count, seed):
    """Blocks of all kinds, under whole records and pieces of them."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        motion = motions[rng.integers(len(motions))]
        height = rng.uniform(0.1, 2.2)
        breadth = height * rng.uniform(0.08, 1.3)
        first = int(rng.integers(0, motion.acceleration.size - 400)) * int(rng.integers(0, 2))
        piece = motion.acceleration[first : first + int(rng.integers(300, motion.acceleration.size))]
        values = piece * rng.uniform(0.8, 5) * breadth / height * GRAVITY / np.abs(piece).max()
        yield breadth, height, values, motion.time_step, (math.nan, rng.uniform(0, 1), 0.95, 1.0, 0.0)[rng.integers(5)]


def both(breadth, height, values, step, eta=math.nan):
    one = follow_block(breadth, height, values, step, restitution=eta)
    many = rock_blocks([breadth], [height], values[np.newaxis], step, restitution=eta)
    return one, many


@pytest.mark.slow
def test_the_verdict_is_that_of_many_blocks_to_the_bit(motions):
    fell = 0
    for case in draw(motions, 400, 1):
        one, many = both(*case)
        assert (one.overturned, one.rotation, one.impacts) == (
            many.overturned[0, 0], many.rotation[0, 0], many.impacts[0, 0],
        )  # fmt: skip
        np.testing.assert_array_equal(one.fall_time, many.fall_time[0, 0])
        fell += one.overturned
    assert 50 < fell < 350


def test_among_many_blocks_a_block_does_the_same(motions):
    motion = motions[0]
    heights = np.linspace(0.3, 2.0, 40)
    values = motion.acceleration * 2.5
    many = rock_blocks(0.25 * heights, heights, values[np.newaxis], motion.time_step)
    for at, height in enumerate(heights):
        one = follow_block(0.25 * height, height, values, motion.time_step)
        assert (one.overturned, one.rotation, one.impacts) == (
            many.overturned[at, 0], many.rotation[at, 0], many.impacts[at, 0],
        )  # fmt: skip


def test_the_path_runs_forwards_from_rest_and_holds_every_impact(motions):
    for breadth, height, values, step, eta in draw(motions, 400, 2):
        one = follow_block(breadth, height, values, step, restitution=eta)
        assert one.times[0] == one.theta[0] == 0
        assert (np.diff(one.times) >= 0).all()
        assert one.times.shape == one.theta.shape
        assert one.impact_times.size == one.impacts
        assert (np.diff(one.impact_times) >= 0).all()
        at_impacts = np.interp(one.impact_times, one.times, one.theta)
        assert np.abs(at_impacts).max(initial=0) < 1e-6 * one.critical_angle
        assert np.abs(one.theta).max() <= one.rotation * one.critical_angle * (1 + 1e-12)
        if one.overturned:
            assert one.times[-1] == one.fall_time
            assert abs(one.theta[-1]) == math.pi / 2
            assert one.theta[-1] * one.theta[-2] > 0
        else:
            assert math.isnan(one.fall_time)
            assert one.times[-1] >= (values.size - 3) * step


def test_the_path_solves_the_equation(motions):
    """Second differences of theta against eq. 3, where the block rocks on one edge."""
    motion = motions[2]
    values = motion.acceleration * 2.5
    one = follow_block(0.45, 1.8, values, motion.time_step)
    assert not one.overturned
    at = np.rint(one.times / motion.time_step).astype(int)
    whole = np.abs(one.times / motion.time_step - at) < 1e-6
    checked = 0
    for k in range(1, one.times.size - 1):
        angles = one.theta[k - 1 : k + 2]
        if not (whole[k - 1 : k + 2].all() and (np.diff(at[k - 1 : k + 2]) == 1).all() and abs(angles).min() > 1e-3):
            continue
        if len({*np.sign(angles)}) > 1:
            continue
        found = (angles[2] - 2 * angles[1] + angles[0]) / motion.time_step**2
        left = one.critical_angle - abs(angles[1])
        ground = values[at[k] - 1 : at[k] + 2] @ np.array([1, 4, 1]) / 6 / GRAVITY
        side = np.sign(angles[1])
        wanted = -(one.frequency_parameter**2) * (side * math.sin(left) + ground * math.cos(left))
        assert found == pytest.approx(wanted, abs=0.002)
        checked += 1
    assert checked > 100


def test_a_block_at_rest_is_drawn_at_rest():
    """Two pulses: between them, before and after, the path is zero."""
    values = np.zeros(4000)
    values[400:440] = values[2000:2040] = 0.3 * GRAVITY
    one = follow_block(0.4, 1.8, values, STEP)
    assert not one.overturned
    assert one.rotation > 0.05
    assert one.times[-1] == pytest.approx(3999 * STEP)
    quiet = np.interp([0, 1, 1.99, 9, 9.98, 15, 19.9], one.times, one.theta)
    np.testing.assert_array_equal(quiet, 0)
    first = one.impact_times[one.impact_times < 9.9]
    assert 0 < first.size < one.impacts
    assert first[-1] < 8
    rocking = np.interp(np.array([2.2, 10.2]), one.times, one.theta)
    assert (rocking < 0).all()
    assert rocking[0] == pytest.approx(rocking[1], rel=1e-9)


def test_a_block_that_never_starts():
    one = follow_block(0.9, 1.8, np.sin(np.arange(500) / 10), STEP)
    assert (one.overturned, one.rotation, one.impacts, one.impact_times.size) == (False, 0, 0, 0)
    np.testing.assert_array_equal(one.times, [0, 499 * STEP])
    np.testing.assert_array_equal(one.theta, 0)


def test_a_block_that_falls_after_the_end_of_the_motion():
    values = np.zeros(200)
    values[20:] = 0.3 * GRAVITY
    one, many = both(0.4, 1.8, values, STEP)
    longer, _ = both(0.4, 1.8, np.append(values, np.zeros(2000)), STEP)
    assert one.overturned
    assert one.fall_time == many.fall_time[0, 0] == pytest.approx(longer.fall_time, rel=1e-12)
    assert one.fall_time > 200 * STEP
    assert (np.diff(one.times) > 0).all()
    assert one.theta[-1] == -math.pi / 2


def test_a_motion_that_starts_above_the_threshold():
    one = follow_block(0.4, 1.8, np.append(np.full(40, -0.3 * GRAVITY), np.zeros(800)), STEP)
    assert (one.times[0], one.theta[0]) == (0, 0)
    assert one.theta[1] > 0
    assert one.times[1] == STEP


def test_long_steps_are_divided():
    """A small block under a coarse motion: the path has points between the samples."""
    values = 0.6 * GRAVITY * np.sin(np.arange(60) * 0.5)
    one, many = both(0.05, 0.2, values, 0.05)
    assert one.rotation == many.rotation[0, 0]
    moving = one.times[np.abs(one.theta) > 0]
    assert np.diff(moving).max() < 0.03


def test_a_path_that_is_too_long_is_cut(monkeypatch, motions):
    motion = motions[0]
    whole = follow_block(0.4, 1.8, motion.acceleration * 1.57, motion.time_step)
    monkeypatch.setattr(ensemble, "MOST_TRACED", 100)
    one = follow_block(0.4, 1.8, motion.acceleration * 1.57, motion.time_step)
    assert (one.overturned, one.fall_time, one.impacts) == (True, whole.fall_time, whole.impacts)
    assert 100 < one.times.size < 110
    np.testing.assert_array_equal(one.times, whole.times[: one.times.size])
    np.testing.assert_array_equal(one.theta, whole.theta[: one.times.size])


def test_what_the_block_is():
    one = follow_block(0.4, 1.8, np.sin(np.arange(500) / 10), STEP)
    assert one.critical_angle == pytest.approx(math.atan(0.4 / 1.8))
    assert one.frequency_parameter == pytest.approx(math.sqrt(3 * GRAVITY / (2 * math.hypot(0.4, 1.8))))
    assert one.restitution == pytest.approx(1 - 1.5 * math.sin(math.atan(0.4 / 1.8)) ** 2)
    assert follow_block(0.4, 1.8, np.ones(5), STEP, restitution=0.9).restitution == 0.9


def test_what_cannot_be_rocked():
    still = np.zeros(50)
    usual: dict[str, Any] = {"breadth": 0.4, "height": 1.8, "acceleration": still, "time_step": STEP}
    usual["restitution"] = math.nan
    check_refusals(ValueError, lambda given: follow_block(**usual | given), [
        ({"breadth": 3.0}, r"a block with B/H of 1\.67 does not rock: expected below 1\.41"),
        ({"height": 0.0}, "breadth and height must be lists of finite numbers above 0 m"),
        ({"restitution": 1.1}, "restitution must be 0 to 1"),
        ({"acceleration": np.array([0.0, math.nan])}, "expected \\(k, n\\) finite samples"),
        ({"acceleration": np.zeros((2, 9))}, "expected \\(k, n\\) finite samples"),
        ({"time_step": 0.0}, r"time_step is 0\.0 s, expected above 0"),
    ])  # fmt: skip
