"""Annual chances of a workbook with a hazard file, held against integrals of their own and against the run itself."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from assess.fragility import lognormal_chance
from assess.motion.suite import read_suite
from assess.pipeline.annual import evaluate_annual
from assess.pipeline.run import build_results, compute
from assess.pipeline.verify import Sweep
from assess.progress import SILENT
from assess.rates import integrate_lognormal
from assess.settings import Settings
from assess.units import GRAVITY
from tests.hazards import K_0, K, read_hazard, write_hazard
from tests.pipeline.rows import read_sheets
from tests.shaking import write_records

RUNS = 60
SETTINGS = Settings(runs=RUNS, seed=3)
BUILDING = {"period": 0.8, "ground_pga": 0.15, "motion_uncertainty": 0.4, "hazard": "hazard.csv"}
FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfa_y": 0.3}]
CABINET = {"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180, "axis": "X"}
CORRIDOR = {"route": "A", "segment": "corridor", "floor": "1", "start": "Room", "end": "Street", "clear_width": 1.5,
            "required_width": 0.9}  # fmt: skip
PLACES = [{"place": "Room", "floor": "1", "kind": "room"}, {"place": "Street", "floor": "1", "kind": "exit"}]
BLOCKS = {"route": "A", "edge_distance": 0}


def assessed(
    folder: Path,
    *items: dict[str, Any],
    settings: Settings = SETTINGS,
    routes: bool = False,
    floors: Any = FLOORS,
    suite: Any = None,
    **building: Any,
):
    rows: dict[str, Any] = {"Building": [BUILDING | building], "Floors": floors, "Items": list(items) or [CABINET]}
    rows |= {"Places": PLACES, "Routes": [CORRIDOR]} if routes else {}
    if not (folder / "hazard.csv").exists():
        write_hazard(folder)
    return compute(read_sheets(folder, **rows), settings, suite=suite)


def rows_of(assessment):
    results = build_results(assessment, figures=False)
    return results, [one.item.annual for one in results]


@pytest.fixture(scope="module")
def several(tmp_path_factory):
    """Pieces of several kinds on one floor, with a route that the first of them blocks."""
    items = (
        {**CABINET, **BLOCKS, "importance": "life safety"},
        {**CABINET, "item": "b", "breadth": 50, "importance": "life safety"},
        {**CABINET, "item": "c", "quantity": 3},
        {**CABINET, "item": "d", "anchored": "yes", "importance": "life safety"},
        {**CABINET, "item": "e", "breadth": 160, "width": 160, "height": 110, "quantity": 2},
    )
    return assessed(tmp_path_factory.mktemp("several"), *items, routes=True)


# --- pieces


@pytest.mark.slow
def test_a_piece_falls_as_often_as_its_lognormal_says(tmp_path):
    """Cornell et al. (2002): k0 theta^-k exp(k^2 beta^2 / 2), physics.md G; the ends of the curve are far away."""
    assessment = assessed(tmp_path, settings=Settings(seed=3))
    (row,) = rows_of(assessment)[1]
    assert row.fit == "lognormal"
    assert row.misfit <= 0.05
    closed = K_0 * row.median_g**-K * np.exp(K**2 * row.dispersion**2 / 2)
    assert row.rate == pytest.approx(closed, rel=0.03)
    exact = integrate_lognormal(
        read_hazard(tmp_path / "hazard.csv"), median=row.median_g * GRAVITY, dispersion=row.dispersion
    )
    assert row.rate == pytest.approx(exact.rate, rel=1e-9)
    assert row.chance_a_year == pytest.approx(1 - np.exp(-row.rate))
    assert row.chance_in_50_years == pytest.approx(1 - np.exp(-50 * row.rate))
    assert row.low < row.rate < row.high
    assert not row.ends_matter


def test_at_the_scenarios_own_ground_pga_it_is_what_the_run_finds(several):
    """The motions of a factor of 1 are those of the run, draw by draw."""
    cases, (joint,) = several.cases, several.joints.values()
    sweep = Sweep(
        assessment=several, cases=cases, peaks=np.ones(cases.breadth.size), settings=SETTINGS,
        dispersion=cases.dispersion,
    )  # fmt: skip
    (found,) = sweep.rock(np.array([0.5, 1.0]))
    np.testing.assert_array_equal(found.own, joint.cases)
    np.testing.assert_array_equal(found.fell[1], joint.fell)
    assert found.fell[0].sum() < joint.fell.sum()


@pytest.mark.slow
def test_ideal_changes_no_rate_and_a_factor_on_the_motion_hardly_any(tmp_path):
    """The factor is one on the earthquake: floors and ground grow alike."""
    rates = [
        rows_of(assessed(tmp_path, settings=settings))[1][0].rate
        for settings in (SETTINGS, Settings(runs=RUNS, seed=3, ideal=True), Settings(runs=RUNS, seed=3, scale=1.5))
    ]
    assert rates[1] == rates[0]
    assert rates[2] == pytest.approx(rates[0], rel=0.15)


@pytest.mark.slow
def test_the_dispersion_of_a_record_is_always_in_it(tmp_path):
    """Also where the scenario is taken as exact; a rate without it is about 2.2 times too low (physics.md G)."""
    write_records(tmp_path, "slow")
    exact = {"floors": [{"floor": "1", "record_x": "slow.csv"}], "piece_uncertainty": "no"}
    without, given = (assessed(tmp_path, motion_uncertainty=beta, **exact) for beta in (0, 0.4))
    assert without.annual.tables.motion_dispersion == 0.4
    assert rows_of(without)[1] == rows_of(given)[1]
    small = assessed(tmp_path, motion_uncertainty=0.01, **exact)
    ratio = rows_of(given)[1][0].rate / rows_of(small)[1][0].rate
    assert ratio == pytest.approx(np.exp(K**2 * (0.4**2 - 0.01**2) / 2), rel=0.15)


@pytest.mark.slow
def test_the_users_own_motions_have_to_be_scaled_to_the_floors(tmp_path):
    (tmp_path / "own").mkdir()
    write_records(tmp_path / "own", "fast", "slow", "pulse")
    suite = read_suite(tmp_path / "own")
    results, rows = rows_of(assessed(tmp_path, suite=suite))
    assert "are not scaled to the floors" in results.annual.missing
    assert rows == [None]
    scaled = assessed(tmp_path, suite=suite, settings=Settings(scale_motions=True))
    assert rows_of(scaled)[1][0].rate > 0
    assert scaled.annual.tables.runs == 3


# --- the building


def test_the_building_its_route_and_its_room_add_up_free_standing_pieces(several):
    results, rows = rows_of(several)
    found = results.annual
    assert rows[4] is None, "it cannot rock: it was not simulated"
    assert (found.pieces, found.not_evaluated, found.cannot_rock) == (5, 0, 2)
    assert (found.at_least, found.life_safety_pieces) == (0, 2)
    assert not found.is_lower_bound
    assert found.expected_falls == pytest.approx(rows[0].rate + rows[1].rate + 3 * rows[2].rate)
    assert found.expected_low < found.expected_falls < found.expected_high
    one, other = rows[0].rate, rows[1].rate
    alone = results.route_tables.routes[0].annual.rate
    assert alone <= found.life_safety.rate < one + other, (
        "of the first in its own draws; the anchored one does not count"
    )
    assert rows[3].rate == pytest.approx(rows[2].rate, rel=0.2), "an anchored piece has that of a free-standing one"
    assert found.ground_pga_g == pytest.approx(0.15)
    assert np.diff(found.factors).min() > 0
    assert found.factors[-1] == pytest.approx(3.0 / 0.15 * np.exp(3 * 0.4)), (
        "beyond the end of the curve, as it scatters"
    )
    (route,), (room,) = results.route_tables.routes, results.route_tables.rooms
    assert route.annual.rate == pytest.approx(rows[0].rate, rel=0.3), "in its own 60 draws; its chance is by all alike"
    assert room.annual == route.annual
    assert route.annual_if_anchors_fail is None


def test_pieces_that_were_not_simulated_make_sums_lower_bounds(tmp_path):
    first, floors = {**CABINET, "importance": "life safety"}, [*FLOORS, {"floor": "2", "pfa_x": 0.12, "pfa_y": 0.12}]
    still = {**first, "item": "b", "floor": "2", "breadth": 60}
    settings = Settings(runs=20, verify="high")
    results, rows = rows_of(assessed(tmp_path, first, still, floors=floors, settings=settings))
    assert [row is None for row in rows] == [False, True]
    assert results.annual.not_evaluated == 1
    assert results.annual.is_lower_bound
    assert results.annual.life_safety.at_least


def test_rates_are_lower_bounds_where_the_motions_may_be_too_weak(tmp_path):
    results, (row,) = rows_of(assessed(tmp_path, {**CABINET, **BLOCKS}, routes=True, period=None))
    assert row.at_least
    assert results.annual.at_least == 1
    assert results.route_tables.routes[0].annual.at_least


@pytest.mark.parametrize(("first", "last", "word"), [(0.2, 3.0, "begins at 0.2 g"), (0.01, 0.3, "ends at 0.3 g")])
def test_it_is_remarked_on_where_the_ends_of_the_curve_matter(tmp_path, first, last, word):
    write_hazard(tmp_path, first, last)
    results, (row,) = rows_of(assessed(tmp_path))
    assert any(word in one for one in results.annual.remarks)
    assert row.ends_matter
    assert results.annual.remarks[-1].startswith("for 1 piece more than 5 % of the annual rate comes")


# --- what is missing


@pytest.mark.parametrize(
    ("building", "settings", "why"),
    [
        ({"ground_pga": None}, SETTINGS, "fill in Ground PGA in Building"),
        ({}, Settings(verify="none"), "no piece was simulated"),
        ({"hazard": None}, SETTINGS, None),
    ],
)
def test_what_is_missing_is_named(tmp_path, building, settings, why):
    results, rows = rows_of(assessed(tmp_path, settings=settings, **building))
    assert rows == [None]
    if why is None:
        assert results.annual is None
    else:
        assert why in results.annual.missing
        assert not results.annual.is_evaluated


def test_drawn_motions_scatter_by_themselves(tmp_path):
    """They need no dispersion to differ; a typed one is averaged over, but for what a fitted lognormal changes."""
    blank, given = (assessed(tmp_path, motion_uncertainty=beta, piece_uncertainty="no") for beta in (None, 0.4))
    assert [one.annual.tables.motion_dispersion for one in (blank, given)] == [0, 0.4]
    ratio = rows_of(given)[1][0].rate / rows_of(blank)[1][0].rate
    assert ratio == pytest.approx(np.exp(K**2 * 0.4**2 / 2), rel=0.25)


@pytest.mark.slow
def test_a_square_piece_falls_along_either_axis(tmp_path):
    square = {**CABINET, "width": 45, "axis": None}
    x, y, either = (
        rows_of(assessed(tmp_path, one))[1][0].rate for one in (square | {"axis": "X"}, square | {"axis": "Y"}, square)
    )
    assert 1.02 * max(x, y) < either < x + y


@pytest.mark.slow
def test_where_motions_serve_slip_alone_nothing_is_rocked(tmp_path):
    """A floor whose only piece is too stocky to rock, but slides."""
    floors = [*FLOORS, {"floor": "2", "pfa_x": 0.5, "pfa_y": 0.5}]
    block = {"item": "z", "floor": "2", "breadth": 145, "width": 145, "height": 100, "friction": 0.2}
    results, rows = rows_of(assessed(tmp_path, CABINET, block, floors=floors))
    assert rows[0].rate == pytest.approx(rows_of(assessed(tmp_path, CABINET))[1][0].rate, rel=0.15)
    assert rows[1] is None
    assert (results.annual.pieces, results.annual.cannot_rock) == (1, 1)


def test_no_level_cuts_off_motions_that_are_stronger_than_the_floor(tmp_path):
    """Where pieces fall at the lowest level, lower ones follow until none does."""
    assessment = assessed(tmp_path, motion_uncertainty=None)
    weak = replace(assessment.cases, pfa=assessment.cases.pfa / 5)
    shifted = evaluate_annual(replace(assessment, cases=weak), jobs=1, progress=SILENT)
    (row,) = rows_of(assessment)[1]
    assert shifted.items[0].rate == pytest.approx(row.rate, rel=0.2), "the levels begin five times too high"


def test_where_all_pieces_are_anchored_nothing_is_counted(tmp_path):
    write_hazard(tmp_path, 0.01, 0.3)
    results, (row,) = rows_of(assessed(tmp_path, {**CABINET, "anchored": "yes", "importance": "life safety"}))
    found = results.annual
    assert row.rate > 0
    assert (found.pieces, found.expected_falls, found.expected_low, found.life_safety) == (0, 0, None, None)
    assert found.remarks == ()


def test_a_route_that_anchored_pieces_reach_has_a_rate_if_they_fail(tmp_path):
    items = {**CABINET, **BLOCKS}, {**CABINET, **BLOCKS, "item": "b", "breadth": 35, "anchored": "yes"}
    results, rows = rows_of(assessed(tmp_path, *items, routes=True))
    (route,) = results.route_tables.routes
    assert route.annual.rate == pytest.approx(rows[0].rate)
    assert route.annual_if_anchors_fail.rate > rows[1].rate * 0.999


def test_what_cannot_fall_within_the_curve_has_a_rate_of_0(tmp_path):
    write_hazard(tmp_path, 0.001, 0.004, 5)
    results, (row,) = rows_of(assessed(tmp_path))
    assert (row.rate, row.low, row.high, row.fit) == (0, None, None, "table")
    assert row.at_least, "beyond the end of the curve it may fall"
    assert results.annual.expected_falls == 0
    assert results.annual.expected_high is None


def test_pieces_of_one_row_fall_together_so_that_any_of_them_is_a_lower_bound(tmp_path):
    row = {**CABINET, **BLOCKS, "quantity": 5, "importance": "life safety"}
    results, (one,) = rows_of(assessed(tmp_path, row, routes=True))
    assert not one.at_least
    assert results.annual.life_safety.at_least
    assert results.route_tables.routes[0].annual.at_least


@pytest.mark.slow
def test_sds_stands_in_for_the_ground_pga_only_where_floors_follow_a_profile(tmp_path):
    """A floor with a PFA of its own may be of another earthquake than the code's."""
    assert "fill in Ground PGA" in rows_of(assessed(tmp_path, ground_pga=None, sds=0.375))[0].annual.missing
    profile = [{"floor": "1", "elevation": 6}]
    by_sds = rows_of(assessed(tmp_path, floors=profile, ground_pga=None, sds=0.375, height=12))
    by_pga = rows_of(assessed(tmp_path, floors=profile, height=12))
    assert by_sds[0].annual.ground_pga_g == pytest.approx(0.15)
    assert by_sds[1][0].rate == pytest.approx(by_pga[1][0].rate)


@pytest.mark.slow
def test_scatter_of_the_motion_is_averaged_over_as_if_it_were_drawn(tmp_path):
    """The share at the ground PGA of the scenario is the chance that the run finds by drawing the scale."""
    runs = 400
    assessment = assessed(tmp_path, settings=Settings(seed=3, runs=runs))
    (row,) = rows_of(assessment)[1]
    by_curve = lognormal_chance(0.15, row.median_g, row.dispersion)
    chance = assessment.adoption.probability[0]
    assert by_curve == pytest.approx(chance, abs=0.02 + 2 * np.sqrt(chance * (1 - chance) / runs))
