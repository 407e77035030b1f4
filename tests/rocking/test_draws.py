"""What is drawn of an earthquake and of a piece: its distribution, its independence, and what its intervals cover."""

import math
import subprocess
import sys

import numpy as np
import pytest
from scipy.stats import kstest, truncnorm

from assess.motion.spatial_field import SCATTERS
from assess.risk import wilson_interval
from assess.rocking import block
from assess.rocking.draws import (
    BASE,
    CENTRE,
    CUT,
    HEIGHT,
    RESTITUTION,
    SCANNED_BASE,
    SCANNED_HEIGHT,
    STILL,
    STILL_SCANNED,
    Earthquakes,
    Uncertainty,
    draw_bodies,
    draw_earthquakes,
    name_number,
)  # fmt: skip

COUNT = 20_000
RACK = [np.array([one]) for one in (0.40, 1.90, 0.5, math.nan)]
CUT_NORMAL = truncnorm(-CUT, CUT)


def draw(count=COUNT, first=0, seed=1, name=7, **changes):
    breadth, height, centre, restitution = RACK
    given = {"breadth": breadth, "height": height, "centre": centre, "restitution": restitution} | changes
    return draw_bodies(**given, names=[name], seed=seed, first=first, count=count)


def arrays(bodies):
    return bodies.breadth, bodies.height, bodies.centre, bodies.restitution


# --- distributions ---


def test_earthquakes_are_normal_numbers_cut_at_three():
    found = draw_earthquakes(1, 0, COUNT)
    assert np.abs(found).max() <= CUT
    assert kstest(found, CUT_NORMAL.cdf).pvalue > 0.01


def test_sizes_scatter_about_what_is_given():
    drawn = draw()
    for found, mean, deviation in (
        (drawn.breadth[0] / 0.40, *BASE),
        (drawn.height[0] / 1.90, 1.0, HEIGHT),
        (drawn.centre[0], 0.5, CENTRE),
    ):
        assert np.abs(found - mean).max() <= CUT * deviation * (1 + 1e-12)
        assert kstest((found - mean) / deviation, CUT_NORMAL.cdf).pvalue > 0.01


def test_sizes_by_a_scan_scatter_more_and_the_rest_alike():
    drawn, usual = draw(scanned=np.array([True])), draw(scanned=np.array([False]))
    for found, mean, deviation in (
        (drawn.breadth[0] / 0.40, *SCANNED_BASE),
        (drawn.height[0] / 1.90, 1.0, SCANNED_HEIGHT),
    ):
        assert np.abs(found - mean).max() <= CUT * deviation * (1 + 1e-12)
        assert kstest((found - mean) / deviation, CUT_NORMAL.cdf).pvalue > 0.01
    np.testing.assert_array_equal(drawn.centre, usual.centre)


def test_no_draw_depends_on_which_others_were_scanned():
    breadth, height, centre, restitution = (np.repeat(one, 3) for one in RACK)
    bodies = (breadth, height, centre, restitution, [7, 8, 9])
    mixed = draw_bodies(*bodies, seed=1, first=0, count=50, scanned=np.array([False, True, False]))
    plain = draw_bodies(*bodies, seed=1, first=0, count=50)
    for one, other in zip(arrays(mixed), arrays(plain), strict=True):
        np.testing.assert_array_equal(one[[0, 2]], other[[0, 2]])
    assert not np.array_equal(mixed.breadth[1], plain.breadth[1])


def test_a_scanned_piece_is_taken_not_to_start_at_as_low_a_motion_as_its_draws_ask_for():
    """Its slenderest draw against the slenderest of another: by that much earlier may it start."""

    def slenderest(base, height):
        return (base[0] - CUT * base[1]) / (1 + CUT * height)

    earlier = slenderest(SCANNED_BASE, SCANNED_HEIGHT) / slenderest(BASE, HEIGHT)
    assert 0.99 * STILL * earlier < STILL_SCANNED <= STILL * earlier


def test_restitution_scatters_about_that_of_the_drawn_body():
    """A stout one, whose restitution stays far from 0 and 1; that of a slender one is cut at 1."""
    drawn = draw(breadth=np.array([0.90]))
    own = block.restitution(drawn.breadth[0], drawn.height[0], drawn.centre[0])
    assert kstest((drawn.restitution[0] - own) / RESTITUTION, CUT_NORMAL.cdf).pvalue > 0.01
    assert 0.99 < draw().restitution.max() < 1


def test_a_given_restitution_is_the_mean_and_stays_between_0_and_1():
    drawn = draw(restitution=np.array([0.8]))
    assert drawn.restitution.mean() == pytest.approx(0.8, abs=0.002)
    assert drawn.restitution.std() == pytest.approx(RESTITUTION, rel=0.03)
    for given in (0.0, 1.0):
        drawn = draw(restitution=np.array([given]))
        assert 0 < drawn.restitution.min() <= drawn.restitution.max() < 1
        assert np.abs(drawn.restitution - given).max() <= CUT * RESTITUTION
    stocky = draw(breadth=np.array([1.40]), height=np.array([1.0]))
    assert (stocky.restitution > 0).all()
    assert np.median(stocky.restitution) < 0.1, "hardly any is left"


def test_the_parts_of_a_piece_are_independent():
    drawn = draw(breadth=np.array([0.90]))
    own = block.restitution(drawn.breadth[0], drawn.height[0], drawn.centre[0])
    parts = [*(one[0] for one in arrays(drawn)[:3]), drawn.restitution[0] - own, draw_earthquakes(1, 0, COUNT)]
    assert np.abs(np.corrcoef(parts) - np.eye(5)).max() < 4 / math.sqrt(COUNT)


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


def test_hardly_a_draw_starts_a_piece_beyond_the_largest_start():
    """At once earthquake, peak, base, height and centre of gravity, at three dispersions of a floor's motion."""
    uncertainty, centre, scanned = Uncertainty(), np.full(3, 0.5), np.array([False, False, True])
    dispersion, peak = np.array([0.0, 0.6, 0.4]), np.array([0.35, 0.25, 0.25])
    largest = uncertainty.largest_start(centre, scanned, dispersion, peak)
    breadth, height, _, restitution = (np.repeat(one, 3) for one in RACK)
    drawn = draw_bodies(breadth, height, centre, restitution, [7, 8, 9], seed=1, first=0, count=COUNT, scanned=scanned)
    numbers, own = draw_earthquakes(1, 0, COUNT), np.random.default_rng(1).standard_normal(COUNT)
    factor = np.exp(dispersion[:, None] * numbers + peak[:, None] * own)
    start = (drawn.breadth / drawn.height / drawn.centre) / (0.40 / 1.90 / 0.5)
    share = (factor / start > largest[:, None]).mean(axis=1)
    assert (share < 0.003).all()
    assert (share > 0).any(), "nor is it far beyond them all"
    assert largest[1] > largest[0]


# --- what the intervals cover ---


@pytest.mark.parametrize("chance", [0.03, 0.1, 0.3, 0.7])
@pytest.mark.slow
def test_intervals_of_200_draws_cover_a_known_chance(chance):
    """A piece that falls in a draw where the earthquake's factor exceeds a limit: its chance is known exactly.

    Draws are stratified, so that the interval of independent ones is wider than it has to be: the share that falls is
    within a 200th of the chance.
    """
    limit = CUT_NORMAL.ppf(1 - chance)
    fallen = np.array([(draw_earthquakes(seed, 0, 200) > limit).sum() for seed in range(4000)])
    low, high = wilson_interval(fallen, 200)
    assert ((low <= chance) & (chance <= high)).all()
    assert np.abs(fallen / 200 - chance).max() <= 1 / 200 + 1e-12


# --- one earthquake for many places ---

MARKET_STREET, OAKLAND, SAN_JOSE = (37.7893, -122.4008), (37.8044, -122.2712), (37.3382, -121.8863)
MANY = 16_384
"""Draws whose waves are all kept at once."""


def test_without_a_place_or_scenarios_a_building_takes_the_common_number():
    assert np.array_equal(Earthquakes().draw(1, 0, 300), draw_earthquakes(1, 0, 300))
    assert np.array_equal(Earthquakes(shared=0.1).draw(1, 0, 300), draw_earthquakes(1, 0, 300))


@pytest.mark.parametrize(("measure", "tau", "phi"), [("PGA", 0.348, 0.495), ("PGV", 0.346, 0.552)])
def test_the_share_of_the_variance_that_places_have_in_common_is_that_of_boore_2014(measure, tau, phi):
    assert SCATTERS[measure].shared == pytest.approx(tau**2 / (tau**2 + phi**2))


@pytest.mark.parametrize("measure", ["PGA", "PGV"])
@pytest.mark.parametrize(("place", "distance"), [(OAKLAND, 11.51), (SAN_JOSE, 67.4)])
def test_numbers_of_two_places_have_a_common_part_and_one_by_distance(place, distance, measure):
    shared = SCATTERS[measure].shared
    one, other = (
        Earthquakes(place=at, shared=shared, measure=measure).draw(1, 0, MANY) for at in (MARKET_STREET, place)
    )
    wanted = shared + (1 - shared) * math.exp(-3 * distance / SCATTERS[measure].range_km)
    assert np.corrcoef(one, other)[0, 1] == pytest.approx(wanted, abs=4 / math.sqrt(MANY))


def test_each_place_has_a_normal_number_cut_at_three_by_seed_draw_and_place_alone():
    found = Earthquakes(place=OAKLAND).draw(1, 0, MANY)
    assert found.mean() == pytest.approx(0, abs=4 / math.sqrt(MANY))
    assert found.std() == pytest.approx(1, abs=0.03)
    assert np.abs(found).max() == CUT
    alone = Earthquakes(place=OAKLAND).draw(1, 0, 600)
    for other in (MARKET_STREET, SAN_JOSE):
        Earthquakes(place=other).draw(1, 0, 600)
    assert np.array_equal(Earthquakes(place=OAKLAND).draw(1, 300, 37), alone[300:337])
    assert not np.array_equal(Earthquakes(place=OAKLAND).draw(2, 0, 600), alone)


def test_scenarios_come_in_their_order_again_and_again_and_are_cut_beyond_three_standard_deviations():
    given = (-1.2, 0.3, 0.9)
    found = Earthquakes(given=given, given_share=1.0).draw(1, 0, 7)
    assert found.tolist() == [*given, *given, -1.2]
    assert Earthquakes(given=given, given_share=1.0).draw(1, 5, 2).tolist() == [0.9, -1.2]
    assert Earthquakes(given=(5.0, -4.0), given_share=1.0).draw(1, 0, 2).tolist() == [CUT, -CUT]


def test_scenarios_carry_their_share_of_the_variance_and_the_rest_is_drawn():
    given = tuple(draw_earthquakes(9, 0, 500).tolist())
    found = Earthquakes(given=given, given_share=0.6).draw(1, 0, MANY)
    scenario = np.resize(given, MANY)
    assert np.corrcoef(found, scenario)[0, 1] == pytest.approx(math.sqrt(0.6), abs=0.02)
    assert found.std() == pytest.approx(1, abs=0.05)
