"""What is drawn of an earthquake and of a piece: its distribution, its independence, and what its intervals cover."""

import math
import subprocess
import sys

import numpy as np
import pytest
from scipy.stats import kstest, truncnorm

from assess.risk import wilson_interval
from assess.rocking import block
from assess.rocking.draws import (
    BASE,
    CENTRE,
    CUT,
    HEIGHT,
    RESTITUTION,
    Uncertainty,
    draw_bodies,
    draw_earthquakes,
    name_number,
)

COUNT = 20_000
RACK = [np.array([one]) for one in (0.40, 1.90, 0.5, math.nan)]


def draw(count=COUNT, first=0, seed=1, name=7, **changes):
    breadth, height, centre, restitution = RACK
    given = {"breadth": breadth, "height": height, "centre": centre, "restitution": restitution} | changes
    return draw_bodies(**given, names=[name], seed=seed, first=first, count=count)


def arrays(bodies):
    return bodies.breadth, bodies.height, bodies.centre, bodies.restitution


# --- distributions ---


def cut_normal():
    return truncnorm(-CUT, CUT)


def test_earthquakes_are_normal_numbers_cut_at_three():
    found = draw_earthquakes(1, 0, COUNT)
    assert np.abs(found).max() <= CUT
    assert kstest(found, cut_normal().cdf).pvalue > 0.01


def test_sizes_scatter_about_what_is_given():
    drawn = draw()
    for found, mean, deviation in (
        (drawn.breadth[0] / 0.40, *BASE),
        (drawn.height[0] / 1.90, 1.0, HEIGHT),
        (drawn.centre[0], 0.5, CENTRE),
    ):
        assert np.abs(found - mean).max() <= CUT * deviation * (1 + 1e-12)
        assert kstest((found - mean) / deviation, cut_normal().cdf).pvalue > 0.01


def test_restitution_scatters_about_that_of_the_drawn_body():
    """A stout one, whose restitution stays far from 0 and 1; that of a slender one is cut at 1."""
    drawn = draw(breadth=np.array([0.90]))
    own = block.restitution(drawn.breadth[0], drawn.height[0], drawn.centre[0])
    assert kstest((drawn.restitution[0] - own) / RESTITUTION, cut_normal().cdf).pvalue > 0.01
    assert 0.99 < draw().restitution.max() < 1


def test_a_given_restitution_is_the_mean():
    drawn = draw(restitution=np.array([0.8]))
    assert drawn.restitution.mean() == pytest.approx(0.8, abs=0.002)
    assert drawn.restitution.std() == pytest.approx(RESTITUTION, rel=0.03)


@pytest.mark.parametrize("given", [0.0, 1.0])
def test_a_restitution_stays_between_0_and_1(given):
    drawn = draw(restitution=np.array([given]))
    assert 0 < drawn.restitution.min() <= drawn.restitution.max() < 1
    assert np.abs(drawn.restitution - given).max() <= CUT * RESTITUTION


def test_the_parts_of_a_piece_are_independent():
    drawn = draw(breadth=np.array([0.90]))
    own = block.restitution(drawn.breadth[0], drawn.height[0], drawn.centre[0])
    parts = [*(one[0] for one in arrays(drawn)[:3]), drawn.restitution[0] - own, draw_earthquakes(1, 0, COUNT)]
    assert np.abs(np.corrcoef(parts) - np.eye(5)).max() < 4 / math.sqrt(COUNT)


def test_a_stocky_body_has_hardly_any_restitution_left():
    drawn = draw(breadth=np.array([1.40]), height=np.array([1.0]))
    assert (drawn.restitution > 0).all()
    assert np.median(drawn.restitution) < 0.1


# --- what a draw depends on ---


def test_draws_depend_on_the_seed_the_piece_and_their_number_alone():
    every = draw(600)
    for one, other in zip(arrays(draw(37, first=300)), arrays(every), strict=True):
        np.testing.assert_array_equal(one, other[:, 300:337])
    np.testing.assert_array_equal(draw_earthquakes(1, 500, 20), draw_earthquakes(1, 0, 600)[500:520])
    assert not np.array_equal(draw(20, name=8).breadth, draw(20).breadth)
    assert not np.array_equal(draw(20, seed=2).breadth, draw(20).breadth)
    assert not np.array_equal(draw_earthquakes(2, 0, 20), draw_earthquakes(1, 0, 20))


def test_pieces_of_one_name_draw_alike_in_any_order():
    sizes = [np.repeat(one, 3) for one in RACK]
    sizes[0] = np.array([0.4, 0.5, 0.4])
    breadth, height, centre, restitution = sizes
    together = draw_bodies(breadth, height, centre, restitution, [7, 9, 7], seed=1, first=0, count=5)
    np.testing.assert_array_equal(together.breadth[0], together.breadth[2])
    np.testing.assert_array_equal(together.breadth[0], draw(5).breadth[0])


def test_a_name_has_the_same_number_in_every_process():
    code = "from assess.rocking.draws import name_number; print(name_number('42-01'), name_number('Schrank é'))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert [int(one) for one in found] == [name_number("42-01"), name_number("Schrank é")]
    assert len({name_number(f"42-{number}") for number in range(2000)}) == 2000


def test_no_motion_is_scaled_beyond_the_largest_factor():
    uncertainty = Uncertainty(motion=0.5)
    assert uncertainty.largest == pytest.approx(math.exp(1.5))
    assert np.exp(uncertainty.motion * draw_earthquakes(3, 0, 50_000)).max() <= uncertainty.largest


# --- what the intervals cover ---


@pytest.mark.parametrize("chance", [0.03, 0.1, 0.3, 0.7])
def test_intervals_of_200_draws_cover_a_known_chance_in_93_to_97_percent(chance):
    """A piece that falls in a draw where the earthquake's factor exceeds a limit: its chance is known exactly."""
    limit = cut_normal().ppf(1 - chance)
    fallen = np.array([(draw_earthquakes(seed, 0, 200) > limit).sum() for seed in range(4000)])
    low, high = wilson_interval(fallen, 200)
    covered = ((low <= chance) & (chance <= high)).mean()
    assert 0.93 <= covered <= 0.97, covered
