"""Motions of floors without a record: what they meet, what they depend on, and what is kept of them."""

from collections.abc import Hashable, Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from assess.arrays import FloatArray, Single
from assess.motion import beam
from assess.motion.assumed import Building, FloorTarget, Ground, Meets
from assess.motion.beam import Beams, FloorMotions, open_floor
from assess.motion.drawn_ground import build_beam_grid, draw_ground
from assess.motion.floor_medians import find_medians
from assess.motion.noise import Phases
from assess.motion.rows import GROUP
from assess.motion.target_fit import measure_peaks
from assess.progress import SILENT

GROUND, BUILDING, DRAWS = Ground(pga=3.0, pgv=0.32), Building(period=1.0, structure="frame"), 200
GRID = build_beam_grid(BUILDING.longest)


@pytest.fixture(autouse=True)
def nothing_left() -> Iterator[None]:
    """Let go of the modes after each test."""
    yield
    beam.KEPT.forget()


def make_beams(building: Building = BUILDING, seed: int = 1, axis: str = "X") -> Beams:
    def draw(group: int) -> Single:
        return draw_ground(GROUND, Phases(GRID, seed, axis), group, SILENT)

    key: Hashable = (GROUND, axis)
    return Beams(building, GRID, seed, key, draw)


BEAMS = make_beams()


def open_(target: FloorTarget, beams: Beams = BEAMS, threads: int = 1) -> FloorMotions:
    return open_floor(beams, target, threads, SILENT)


def realise(target: FloorTarget, first: int = 0, count: int = DRAWS, threads: int = 1) -> Single:
    return open_(target, threads=threads).realise(first, count, threads, SILENT)


def target(place: float | None = 0.5, meets: Meets = "medians", pfa: float = 4.0, pfv: float = 0.5) -> FloorTarget:
    return FloorTarget(place=place, pfa=pfa, pfv=pfv, meets=meets)


def peaks(one: FloorTarget) -> FloatArray:
    """Return peaks over those of the target [-], (k, 2)."""
    return measure_peaks(realise(one), GRID.time_step) / (one.pfa, one.pfv)


# --- what they meet ---


@pytest.mark.parametrize("place", [0.3, 1.0, None])
def test_what_is_known_is_met_in_every_draw_and_else_by_medians(place: float | None) -> None:
    both, one, none = (peaks(target(place, meets)) for meets in ("peaks", "pfa", "medians"))
    assert np.abs(both[:, 0] - 1).max() < 1e-6
    assert np.quantile(np.abs(both[:, 1] - 1), 0.9) < 0.01
    assert np.abs(one[:, 0] - 1).max() < 1e-6
    for found in (both, one, none):
        np.testing.assert_allclose(np.median(found, axis=0), 1.0, rtol=0.01)
    assert np.log(one[:, 1]).std() > 0.1
    assert (np.log(none).std(axis=0) > 0.1).all()


@pytest.mark.parametrize("place", [0.3, 0.6, 1.0, None])
def test_beams_themselves_have_the_medians_of_the_table(place: float | None) -> None:
    """So that what brings draws to it is little more than one."""
    ratio = GROUND.ratio
    by_pfa, by_pfv = find_medians(1.0, place, "frame", ratio)
    wanted = target(place, "nothing", 3.0 * by_pfa, 0.32 * by_pfv)
    np.testing.assert_allclose(np.median(peaks(wanted), axis=0), 1.0, atol=0.1)
    found = open_(target(place, "medians", wanted.pfa, wanted.pfv))
    assert (found.high, found.low) == pytest.approx((1.0, 1.0), abs=0.15)


def test_a_floor_at_grade_is_the_ground() -> None:
    ground = draw_ground(GROUND, Phases(GRID, 1, "X"), 2, SILENT)
    for place in (0.0, -0.1):
        found = realise(FloorTarget(place=place, pfa=3.0, pfv=0.32, meets="nothing", factor=2.5), 2 * GROUP, GROUP)
        np.testing.assert_array_equal(found, np.float32(2.5) * ground)


def test_floors_of_one_draw_move_as_one_building() -> None:
    """The roof as the floor below it, the first floor as the ground; axes and buildings have nothing in common."""
    ground, low, high, roof = (realise(target(place, "nothing"), 0, GROUP) for place in (0.0, 0.1, 0.95, 1.0))

    def alike(one: Single, other: Single) -> float:
        return float(np.diag(np.corrcoef(one, other)[:GROUP, GROUP:]).mean())

    assert alike(high, roof) > 0.9
    assert alike(low, ground) > 0.85
    assert alike(ground, roof) < 0.7
    across = open_(target(1.0, "nothing"), make_beams(axis="Y")).realise(0, GROUP, 1, SILENT)
    assert abs(alike(roof, across)) < 0.1


# --- what they depend on ---


@pytest.mark.slow
def test_draws_depend_on_neither_number_nor_order_nor_threads() -> None:
    every = realise(target(), 0, 260)
    beam.KEPT.forget()
    for first, count, threads in ((255, 5, 2), (0, 1, 1), (37, 50, 3), (190, 30, 1)):
        np.testing.assert_array_equal(realise(target(), first, count, threads), every[first : first + count])
    for beams in (make_beams(Building(period=1.0, structure="frame", number=9)), make_beams(seed=2)):
        assert not np.array_equal(open_(target(), beams).realise(0, 5, 1, SILENT), every[:5])


def test_two_floors_of_one_height_move_alike() -> None:
    one, other = (realise(target(0.7), 0, 20) for _ in range(2))
    np.testing.assert_array_equal(one, other)
    twice = realise(FloorTarget(place=0.7, pfa=8.0, pfv=1.0, meets="medians", factor=2.0), 0, 20)
    np.testing.assert_allclose(twice, 2 * one, rtol=1e-3, atol=1e-3)


# --- between floors of which PFA is known ---

ANCHORS = ((0.4, 5.0), (0.8, 9.0))


def find_factors(place: float, *, is_ground_known: bool = True) -> FloatArray:
    one = FloorTarget(place=place, pfa=6.0, pfv=0.6, meets="medians", anchors=ANCHORS, is_ground_known=is_ground_known)
    return beam._find_height_factor(BEAMS, one, place, 0)


def test_the_factor_in_height_is_straight_between_known_floors_and_down_to_the_ground() -> None:
    low, high = find_factors(0.4), find_factors(0.8)
    for (place, pfa), found in zip(ANCHORS, (low, high), strict=True):
        motions = np.exp(found).astype(np.float32)[:, None] * BEAMS.shake(0, place)
        np.testing.assert_allclose(np.abs(motions).max(axis=1), pfa, rtol=1e-5)
    assert low.std() > 0.1
    np.testing.assert_allclose(find_factors(0.1), low / 4)
    np.testing.assert_allclose(find_factors(0.5), low + (high - low) / 4)
    np.testing.assert_array_equal(find_factors(1.0), high)
    np.testing.assert_array_equal(find_factors(0.1, is_ground_known=False), low)


# --- what is kept ---


@pytest.mark.slow
def test_no_more_is_kept_than_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = realise(target())
    one = beam.KEPT.nbytes // (DRAWS // GROUP)
    assert 0 < one <= beam.KEPT.most
    for kept in (3 * one, one - 1):
        beam.KEPT.forget()
        monkeypatch.setattr(beam.KEPT, "most", kept)
        np.testing.assert_array_equal(realise(target(), threads=2), whole)
        assert beam.KEPT.nbytes == kept // one * one
    assert not beam.KEPT._busy


def test_modes_are_made_once_for_all_floors_and_threads() -> None:
    made: list[int] = []

    def draw(group: int) -> Single:
        made.append(group)
        return draw_ground(GROUND, Phases(GRID, 1, "X"), group, SILENT)

    beams = Beams(BUILDING, GRID, 1, "counted", draw)
    with ThreadPoolExecutor(3) as pool:
        list(pool.map(lambda place: open_(target(place), beams).realise(0, DRAWS, 1, SILENT), (0.3, 0.6, 1.0)))
    assert sorted(made) == list(range(DRAWS // GROUP))
