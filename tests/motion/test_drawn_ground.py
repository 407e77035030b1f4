"""Drawn ground motions: peaks that are met, ratios that are drawn, a spectrum that is Newmark and Hall's."""

from functools import cache

import numpy as np
import pytest

from assess.arrays import Single
from assess.intensity import RATIO
from assess.motion.assumed import ALONG, CUT, RATIO_SCATTER, Building, Ground, draw_places, estimate_period
from assess.motion.drawn_ground import AMPLIFIED, build_beam_grid, draw_ground, find_shape
from assess.motion.noise import Phases
from assess.motion.rows import GROUP
from assess.motion.sweep import Sweep
from assess.motion.target_fit import measure_peaks
from assess.progress import SILENT

GRID = build_beam_grid(None)
DRAWS = 200
KNOWN = [Ground(pga=3.0), Ground(pgv=0.3), Ground(pga=3.0, pgv=0.2), Ground(pga=3.0, pgv=0.6)]
EACH = pytest.mark.parametrize("ground", KNOWN, ids=["PGA", "PGV", "both, fast", "both, slow"])


@cache
def make(ground: Ground, axis: str = "X", seed: int = 1) -> Single:
    groups = range(DRAWS // GROUP)
    made = [draw_ground(ground, Phases(GRID, seed, axis), group, SILENT) for group in groups]
    return np.concatenate(made)


@EACH
def test_every_draw_has_its_peaks_and_starts_and_ends_almost_at_rest(ground: Ground) -> None:
    pga, pgv = measure_peaks(make(ground), GRID.time_step).T
    ratios = ground.draw_ratios(1, "X", 0, DRAWS)
    wanted = np.full(DRAWS, ground.pga) if ground.pga else np.full(DRAWS, ground.pgv) / ratios
    assert np.abs(pga / wanted - 1).max() < 1e-6
    by_pgv = np.abs(pgv / (wanted * ratios) - 1)
    assert np.quantile(by_pgv, 0.9) < 0.01
    assert by_pgv.max() < 0.1
    if ground.pgv:
        assert np.abs(pgv / ground.pgv - 1).max() < 0.1, "a known PGV is that of every draw"
    motions = make(ground)
    first = np.abs(motions[:, 0]) / np.abs(motions).max(axis=1)
    assert first.max() < 0.03
    speeds = np.cumsum((motions[:, 1:] + motions[:, :-1]) * (GRID.time_step / 2), axis=1, dtype=np.float64)
    left = np.abs(speeds[:, -1]) / np.abs(speeds).max(axis=1)
    assert np.median(left) < 0.05
    assert left.max() < 0.15


def test_the_median_spectrum_is_newmark_and_halls() -> None:
    periods = np.geomspace(0.1, 2.5, 25)
    motions = make(KNOWN[0])
    spectra = Sweep.of(periods, GRID.time_step, GRID.count).spectra(motions)
    ratios = np.asarray(np.median(spectra / np.abs(motions).max(axis=1, keepdims=True), axis=0), np.float64)
    np.testing.assert_allclose(ratios, find_shape(periods, RATIO), rtol=0.15)


def test_the_shape_by_hand() -> None:
    a, v, d = AMPLIFIED
    found = find_shape(np.array([0.02, 1 / 33, 0.125, 0.3, 1.0, 9.0]), 0.1)
    velocity, displacement = 2 * np.pi * v * 0.1, 4 * np.pi**2 * d * 6 * 0.1**2
    np.testing.assert_allclose(found, [1, 1, a, a, velocity, displacement / 81], rtol=1e-9)


def test_draws_depend_on_seed_axis_and_number_alone() -> None:
    ground = KNOWN[0]
    afresh = draw_ground(ground, Phases(GRID, 1, "X"), 3, SILENT)
    np.testing.assert_array_equal(afresh, make(ground)[3 * GROUP : 4 * GROUP])
    for axis, seed in (("Y", 1), ("X", 2)):
        other = draw_ground(ground, Phases(GRID, seed, axis), 3, SILENT)
        assert np.abs(np.diag(np.corrcoef(afresh, other)[:GROUP, GROUP:])).mean() < 0.1
    np.testing.assert_allclose(make(Ground(pga=6.0))[:GROUP], 2 * make(ground)[:GROUP], rtol=1e-4, atol=1e-4)


def test_ratios_where_one_peak_is_known() -> None:
    one, other = (np.log(KNOWN[0].draw_ratios(1, axis, 0, 4000)) for axis in "XY")
    for found in (one, other):
        assert np.median(np.exp(found)) == pytest.approx(RATIO, rel=0.03)
        assert found.std() == pytest.approx(RATIO_SCATTER, rel=0.06)
        assert np.abs(found - np.log(RATIO)).max() < CUT * RATIO_SCATTER * (1 + ALONG)
    assert np.corrcoef(one, other)[0, 1] == pytest.approx(ALONG, abs=0.03)
    np.testing.assert_array_equal(np.log(KNOWN[0].draw_ratios(1, "Y", 700, 30)), other[700:730])
    assert set(KNOWN[2].draw_ratios(1, "X", 0, 50)) == {0.2 / 3.0}
    assert Ground(pgv=0.3).peaks == (0.3 / RATIO, 0.3)


def test_buildings_are_drawn_about_what_is_known() -> None:
    given, by_height, unknown = Building(period=1.0), Building(period=1.0, scatter=0.35), Building()
    for building, scatter in ((given, 0.10), (by_height, 0.35)):
        logs = np.log(building.draw_periods(1, 0, 2000))
        assert (np.median(logs), logs.std()) == pytest.approx((0.0, 0.955 * scatter), abs=0.01)
        assert np.exp(logs).max() <= building.longest
    drawn = unknown.draw_periods(1, 0, 2000)
    assert (drawn.min(), np.median(drawn), drawn.max()) == pytest.approx((0.15, (0.15 * 3.0) ** 0.5, 3.0), rel=0.01)
    assert len(set(unknown.draw_alphas(1, 0, 400))) == 8
    assert (Building(structure="walls").draw_alphas(1, 0, 400) < 2.0).all()
    places = draw_places(1, 0, 400)
    assert (places.min(), places.max()) == pytest.approx((0.25, 1.0), abs=0.01)
    assert estimate_period(16.0) == pytest.approx(1.4 * 0.3904, abs=1e-3)
    assert estimate_period(None) is None


def test_a_long_period_has_time_to_come_to_rest() -> None:
    assert GRID.duration == pytest.approx(37.3)
    assert build_beam_grid(4.0) == GRID
    assert build_beam_grid(6.0).duration == pytest.approx(GRID.duration + 8.0)
