"""Beside a simulated chance: slip, and falls away from a wall; what they are, and that they change nothing."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.methods import SIDE_UNKNOWN, Cases, simulation
from assess.methods.simulate import HIGH, find_branch, may_slide
from assess.rocking.draws import MOTION, Uncertainty, draw_bodies, draw_earthquakes
from assess.rocking.planar import Body, rock_bodies
from assess.rocking.sliding import Branch, branch, peak_slip
from assess.settings import Settings
from assess.units import GRAVITY
from tests.methods.ensembles import STEP, MadeUp, make_motion

RUNS = 40
SETTINGS = Settings(runs=RUNS, seed=3)
MOTIONS = np.stack([make_motion(0, number) for number in range(RUNS)])
CERTAIN = Uncertainty(motion=0.0, piece=False)


def cases(**given) -> Cases:
    defaults = {"breadth": [0.9, 0.5, 0.3], "height": 1.8, "pfa": 6.0, "ensemble": 0, "name": [1, 2, 3]}
    return Cases.of(**(defaults | {"ensembles": (MadeUp(0),)} | given))


def evaluate(batch, settings=SETTINGS):
    return simulation().evaluate(batch, settings)


@pytest.mark.parametrize("settings", [SETTINGS, dataclasses.replace(SETTINGS, ideal=True)], ids=["drawn", "ideal"])
def test_slip_is_newmarks_under_the_draws_of_the_run(settings):
    friction = np.array([0.15, 0.2, 0.15])
    found = evaluate(cases(friction=friction, slides_under=0), settings).detail
    scale = np.ones(RUNS) if settings.ideal else np.exp(MOTION * draw_earthquakes(3, 0, RUNS))
    slips = peak_slip(friction, MOTIONS, STEP, scale=scale)
    peaks = np.abs(MOTIONS).max(axis=1) * scale
    starts = branch(np.array([[0.9], [0.5], [0.3]]), 1.8, friction[:, None], peaks)
    slips[~np.isin(starts, [Branch.SLIDE, Branch.SLIDE_AND_ROCK])] = 0.0
    np.testing.assert_allclose(found["slip_median_cm"], 100 * np.median(slips, axis=1), rtol=1e-9)
    np.testing.assert_allclose(found["slip_84_cm"], 100 * np.quantile(slips, HIGH, axis=1), rtol=1e-9)
    assert found["slip_median_cm"][0] > 0.5, "a case that slides"


def test_slip_of_pieces_that_slide_depends_on_friction_alone():
    batch = cases(breadth=[0.9, 1.4, 2.6], height=[1.8, 0.7, 0.8], friction=0.2, slides_under=0)
    found = evaluate(batch).detail["slip_84_cm"]
    assert found[0] == found[1] == found[2] > 0, "the last is too stocky to rock"


def test_slip_is_found_for_those_that_ask_alone():
    found = evaluate(cases(friction=0.2, slides_under=[0, -1, -1]))
    assert np.isnan(found.detail["slip_median_cm"]).tolist() == [False, True, True]


def test_an_ensemble_under_which_pieces_slide_alone_makes_no_joint():
    found = evaluate(cases(friction=0.2, ensemble=-1, slides_under=0))
    assert not found.joints
    assert np.isnan(found.value).all()
    assert (found.detail["slip_84_cm"] > 0).any()
    auto = evaluate(cases(friction=0.2, ensemble=-1, slides_under=0), Settings(runs="auto"))
    assert (auto.detail["slip_84_cm"] > 0).any()


def test_batches_and_threads_change_nothing(monkeypatch):
    batch = cases(friction=[0.1, 0.2, 0.3], slides_under=0, wall=[1, -1, SIDE_UNKNOWN])
    whole = evaluate(batch).detail
    monkeypatch.setattr("assess.methods.housner_monte_carlo.BATCH", 7)
    parts = simulation().evaluate(batch, SETTINGS, threads=3).detail
    for name in ("slip_median_cm", "slip_84_cm", "one_sided"):
        np.testing.assert_array_equal(parts[name], whole[name])


@pytest.mark.parametrize("changes", [{"friction": 0.05, "slides_under": 0}, {"wall": SIDE_UNKNOWN}, {"wall": 1}])
def test_neither_friction_nor_a_wall_changes_what_was_simulated(changes):
    before, after = evaluate(cases()), evaluate(cases(**changes))
    np.testing.assert_array_equal(before.value, after.value)
    for name in ("overturned", "low", "high", "ideal_overturned", "ideal", "ideal_low", "ideal_high", "dispersion_0.6"):
        np.testing.assert_array_equal(before.detail[name], after.detail[name])
    np.testing.assert_array_equal(before.joints[0].fell, after.joints[0].fell)


# --- which may slide ---


def test_the_strongest_draw_tells_which_may_slide():
    """Friction 0.5 at 0.4 g: none at the floor's PFA, but in a draw of 3 standard deviations up to 1.56 g."""
    batch = cases(breadth=1.8, pfa=0.4 * GRAVITY, friction=[0.3, 0.5, 1.9])
    assert find_branch(batch).tolist() == [Branch.SLIDE, Branch.REST, Branch.REST]
    assert may_slide(batch, SETTINGS).tolist() == [True, True, False]
    assert may_slide(batch, dataclasses.replace(SETTINGS, ideal=True)).tolist() == [True, False, False]
    assert not may_slide(cases(), SETTINGS).any(), "no friction is given"


def test_flags_and_words():
    found = evaluate(cases(breadth=0.4, pfa=0.6 * GRAVITY, friction=[0.2, 0.22, math.nan], centre=[0.5, 0.6, 0.6]))
    assert found.detail["sliding_branch"].tolist() == ["slide", "slide and rock", ""]
    assert found.flags["shenton_extended"].tolist() == [False, True, False]


# --- a wall at the back ---


def one_sided(away, *, certain):
    batch, motions = cases(breadth=0.25), np.stack([make_motion(3, number) for number in range(RUNS)])
    if certain:
        body, scale = Body.rectangular(np.array([[0.25]]), np.array([[1.8]])), np.ones(RUNS)
    else:
        shape = (batch.breadth[:1], batch.height[:1], batch.centre[:1], batch.restitution[:1])
        drawn = draw_bodies(*shape, [1], seed=3, first=0, count=RUNS)
        body = Body.rectangular(drawn.breadth, drawn.height, centre=drawn.centre, restitution=drawn.restitution)
        scale = np.exp(MOTION * draw_earthquakes(3, 0, RUNS))
    return rock_bodies(body, motions, STEP, away=away, scale=scale).overturned.mean()


@pytest.mark.parametrize("certain", [True, False])
def test_the_one_sided_chance_is_that_of_the_planar_body_under_the_draws(certain):
    settings = dataclasses.replace(SETTINGS, ideal=certain)
    batch = cases(breadth=0.25, name=1, wall=[1, -1, SIDE_UNKNOWN], ensembles=(MadeUp(3),))
    found = evaluate(batch, settings).detail["one_sided"].tolist()
    expected = [one_sided(away, certain=certain) for away in (1, -1)]
    assert found == [*expected, max(expected)]
    assert max(expected) > 0
    assert expected[0] != expected[1]


def test_without_a_wall_or_motions_there_is_none():
    found = evaluate(cases(wall=[0, 1, 1], ensemble=[0, 0, -1])).detail["one_sided"]
    assert np.isnan(found).tolist() == [True, False, True]


@dataclass(frozen=True, slots=True, eq=False)
class TwoPushes(MadeUp):
    """One way, and then the other: a free body rocks back against the second push, one at a wall is caught by it."""

    def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
        """Return motions that are all alike."""
        parts = [np.zeros(1), np.full(10, 3.48), np.zeros(30), np.full(40, -3.48), np.zeros(5)]
        return [(np.tile(np.concatenate(parts), (count, 1)), STEP)]


def test_where_a_wall_makes_it_fall_it_says_so_and_no_class_changes():
    batch = cases(breadth=0.4, wall=[1, -1, 0], ensembles=(TwoPushes(0),), uncertainty=CERTAIN)
    found = evaluate(batch)
    assert found.value.tolist() == [0.0, 0.0, 0.0]
    assert found.detail["one_sided"][0] == 1.0
    assert found.flags["wall_higher"].tolist() == [True, False, False]
