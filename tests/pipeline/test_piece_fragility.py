"""The fragility of pieces: blocks rocked one by one, pooled types, PFA against PFV, and what cannot be had."""

import math
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

import assess
from assess.pipeline.adopt import Assessment
from assess.pipeline.piece_fragility import find_piece_fragilities
from assess.pipeline.run import compute
from assess.pipeline.verify import choose_motions
from assess.progress import Progress, Report
from assess.settings import Settings
from assess.units import GRAVITY
from tests.pipeline.alone import rocked
from tests.pipeline.rows import read_sheets
from tests.shaking import write_records

RUNS = 20
SETTINGS = Settings(verify="none", runs=RUNS, seed=4)
CABINET = {"item": "a1", "floor": "1", "breadth": 40, "width": 80, "height": 180, "axis": "X"}
EXACT = {"piece_uncertainty": "no"}
SLOW = {"record_x": "slow.csv"}
PEAKS = {"pfa_x": 0.3, "pfa_y": 0.2}
LEVELS = (0.2, 0.3, 0.5, 0.9)


def assessed(
    folder: Path,
    *items: dict[str, Any],
    settings: Settings = SETTINGS,
    floors: list[dict[str, Any]] | None = None,
    building: dict[str, Any] | None = None,
) -> Assessment:
    catalogue = [{"type": one, "breadth": 40, "width": 80, "height": 180} for one in ("Cabinet", "Shelf")]
    write_records(folder, "pulse", "slow")
    inventory = read_sheets(
        folder, Catalogue=catalogue, Building=[building or {}], Floors=floors or [{"floor": "1", **SLOW}],
        Items=list(items) or [CABINET],
    )  # fmt: skip
    return compute(inventory, settings)


def found(assessment: Assessment, *pfa_g: float, **named: Any):
    levels = [one * GRAVITY for one in pfa_g] or None
    return find_piece_fragilities(assessment, levels=levels, **named)


def counts(assessment: Assessment, *pfa_g: float, **named: Any) -> list[list[float]]:
    return [one.curve.fallen.tolist() for one in found(assessment, *pfa_g, **named).curves]


# --- one piece ---


@pytest.mark.parametrize(("building", "ideal"), [(EXACT, False), ({}, False), ({}, True)])
def test_one_piece_falls_as_often_as_it_does_alone(tmp_path, building, ideal):
    """Neither the uncertainty of the motion, 0.4 where blank, nor the floor's own PFA plays a part."""
    settings = replace(SETTINGS, ideal=ideal)
    assessment = assessed(tmp_path, building=building, settings=settings, floors=[{"floor": "1", **PEAKS}])
    result = found(assessment, *LEVELS)
    (one,) = result.curves
    assert one.curve.fallen.tolist() == [rocked(assessment, pfa)[0].sum() for pfa in LEVELS]
    assert one.curve.trials.tolist() == [RUNS] * len(LEVELS)
    assert 0 < one.curve.fallen.sum() < RUNS * len(LEVELS)
    assert result.has_drawn_pieces == (building == {} and not ideal)
    assert one.thresholds == (pytest.approx(40 / 180 * GRAVITY),) * 2


@pytest.mark.parametrize(("axis", "floor"), [(None, SLOW), ("X", {"record_x": "slow.csv; pulse.csv"})])
def test_a_blank_axis_and_parallel_records_take_the_worse_at_each_level(tmp_path, axis, floor):
    assessment = assessed(tmp_path, {**CABINET, "axis": axis}, building=EXACT, floors=[{"floor": "1", **floor}])
    along = [[one.sum() for one in rocked(assessment, pfa)] for pfa in LEVELS]
    (one,) = found(assessment, *LEVELS).curves
    assert one.curve.fallen.tolist() == [max(both) for both in along]
    assert len(one.motions) == 2
    assert any(x != y for x, y in along)


def test_a_square_piece_falls_along_either_axis(tmp_path):
    assessment = assessed(tmp_path, {**CABINET, "axis": None, "width": 50}, building=EXACT)
    verdicts = [rocked(assessment, pfa) for pfa in LEVELS]
    either = [int((x | y).sum()) for x, y in verdicts]
    assert counts(assessment, *LEVELS) == [either]
    assert any(int(max(x.sum(), y.sum())) < both for (x, y), both in zip(verdicts, either, strict=True))


def test_it_is_what_a_run_finds_at_the_floors_own_pfa_without_uncertain_motions(tmp_path):
    settings = Settings(runs=RUNS, seed=4)
    ran = assessed(tmp_path, building={"motion_uncertainty": 0}, settings=settings)
    (pfa,) = {demand.pfa for demand in ran.case_demand}
    (one,) = find_piece_fragilities(ran, levels=[0.5 * pfa, pfa]).curves
    assert one.curve.shares[1] == ran.adoption.probability[0]
    assert 0 < one.curve.shares[1] < 1


# --- levels ---


def test_levels_reach_from_about_none_to_about_all(tmp_path):
    """Also of pieces of very different size; they are preferred numbers in g, 12 % apart."""
    thin, stout = {**CABINET, "item": "thin", "breadth": 15}, {**CABINET, "item": "stout", "breadth": 75, "height": 75}
    result = found(assessed(tmp_path, thin, CABINET, stout))
    for one in result.curves:
        assert (one.curve.shares[0], one.curve.kind) == (0, "fitted"), one.name
        assert one.curve.shares[-1] >= 0.98, one.name
        assert one.curve.levels[0] / GRAVITY <= 0.5 * one.thresholds[0] / GRAVITY * 1.12
        assert np.diff(np.log(one.curve.levels)) == pytest.approx(math.log(10) / 20, abs=0.02)
        assert [float(f"{level / GRAVITY:.3g}") for level in one.curve.levels] == pytest.approx(
            (one.curve.levels / GRAVITY).tolist(), rel=1e-12
        )
    medians = [one.curve.median for one in result.curves]
    assert medians == sorted(medians)


def test_levels_are_added_where_a_short_motion_fells_late(tmp_path):
    """A record of 8 Hz starts pieces rocking long before it can overturn them."""
    write_records(tmp_path, "fast")
    assessment = assessed(tmp_path, building=EXACT, floors=[{"floor": "1", "record_x": "fast.csv"}])
    (one,) = found(assessment).curves
    at = [float(level) for level in one.curve.levels]
    assert at[-1] > 4.6 * one.thresholds[0], "more than the first levels"
    assert one.curve.shares[-1] >= 0.98 or at[-1] >= 15.9 * one.thresholds[0]
    again = find_piece_fragilities(assessment, levels=at).curves[0].curve
    assert again.fallen.tolist() == one.curve.fallen.tolist(), "no level is rocked otherwise for being added"


@pytest.mark.slow
def test_levels_and_threads_change_nothing(tmp_path):
    items = [CABINET, {**CABINET, "item": "a2", "breadth": 30, "axis": None}]
    floors = [{"floor": "1", **SLOW}, {"floor": "2", "pfa_x": 0.4}]
    assessment = assessed(tmp_path, *items, {**CABINET, "item": "b", "floor": "2"}, floors=floors)
    several = counts(assessment, *LEVELS, jobs=1)
    assert counts(assessment, *LEVELS, jobs=3) == several
    assert counts(assessment, 0.3, 0.9) == [[one[1], one[3]] for one in several]
    assert counts(assessment, jobs=1) == counts(assessment, jobs=2)


# --- PFV ---


def test_levels_of_pfv_are_those_of_pfa_by_the_floors_ratio(tmp_path):
    floors = [{"floor": "1", **SLOW}, {"floor": "2", "pfa_x": 0.4, "pfv_x": 50}]
    assessment = assessed(tmp_path, CABINET, {**CABINET, "item": "b", "floor": "2"}, floors=floors)
    for demand, at in zip(assessment.case_demand, (0, 1), strict=True):
        by_pfa = find_piece_fragilities(assessment, levels=[factor * demand.pfa for factor in (0.5, 1, 2)])
        by_pfv = find_piece_fragilities(assessment, levels=[factor * demand.pfv for factor in (0.5, 1, 2)], im="pfv")
        one, other = by_pfa.curves[at].curve, by_pfv.curves[at].curve
        assert other.fallen == pytest.approx(one.fallen, abs=1), "but for the last digit of a factor"
        assert other.levels / one.levels == pytest.approx(demand.pfv / demand.pfa)
        assert 0 < one.fallen.sum() < 3 * RUNS


def test_the_ratio_of_the_motions(tmp_path):
    floors = [{"floor": "1", **SLOW}, {"floor": "2", "pfa_x": 0.4, "pfv_x": 50}]
    assessment = assessed(tmp_path, CABINET, {**CABINET, "item": "b", "floor": "2"}, floors=floors)
    recorded, generic = (one.motions[0] for one in found(assessment, 0.3, 0.5).curves)
    every = np.ones(2, dtype=np.bool_)
    cases = choose_motions(
        assessment.cases, every, assessment.case_demand, assessment.demands, assessment.inventory, SETTINGS,
        None,
    )  # fmt: skip
    for one, ensemble in zip((recorded, generic), cases.ensembles, strict=True):
        ((motions, step),) = ensemble.open(1).realise(0, RUNS)
        velocity = np.cumsum((motions[:, 1:] + motions[:, :-1]) * (step / 2), axis=1, dtype=np.float64)
        assert one.mean_pfa == pytest.approx(np.abs(motions).max(axis=1).mean(), rel=1e-6)
        assert one.mean_pfv == pytest.approx(np.abs(velocity).max(axis=1).mean(), rel=1e-4)
        assert one.pfv_per_pfa == one.mean_pfv / one.mean_pfa
    assert (recorded.spectrum, recorded.demand.label) == ("that of the record", "slow.csv")
    assert generic.spectrum == "drawn, nothing known of the building"
    assert (generic.mean_pfa, generic.mean_pfv) == pytest.approx((0.4 * GRAVITY, 0.5), rel=0.02), "in every draw"
    assert [(one.is_assumed, one.is_unknown) for one in (recorded, generic)] == [(False, False), (True, True)]


# --- types ---


def test_a_type_is_the_sum_of_its_rows_by_quantity(tmp_path):
    floors = [{"floor": "1", **SLOW}, {"floor": "2", "pfa_x": 0.4, "pfv_x": 50}]
    items = [
        {**CABINET, "item": "a", "type": "Cabinet", "quantity": 3},
        {**CABINET, "item": "b", "type": "Shelf", "breadth": 30},
        {**CABINET, "item": "c", "type": "cabinet", "breadth": 45, "floor": "2"},
        {**CABINET, "item": "d"},
        {**CABINET, "item": "e", "floor": "2", "quantity": 2},
        {**CABINET, "item": "f", "centre_of_gravity": 30},
    ]
    assessment = assessed(tmp_path, *items, floors=floors)
    own = {one.name: one.curve.fallen for one in found(assessment, *LEVELS).curves}
    result = found(assessment, *LEVELS, by="type")
    assert [(one.name, one.type, [item.item for item in one.items], one.pieces) for one in result.curves] == [
        ("Cabinet", "Cabinet", ["a", "c"], 4),
        ("Shelf", "Shelf", ["b"], 1),
        ("40 x 180 cm", "", ["d", "e"], 3),
        ("40 x 180 cm", "", ["f"], 1),
    ]
    cabinet, shelf, sized, low = (one.curve for one in result.curves)
    assert cabinet.fallen.tolist() == (3 * own["a"] + own["c"]).tolist()
    assert cabinet.trials.tolist() == [4 * RUNS] * len(LEVELS)
    assert shelf.fallen.tolist() == own["b"].tolist()
    assert sized.fallen.tolist() == (own["d"] + 2 * own["e"]).tolist()
    assert low.fallen.tolist() == own["f"].tolist()
    assert result.curves[0].floors == ("1", "2")
    low_ratio, high_ratio = result.curves[0].pfv_per_pfa
    assert low_ratio < high_ratio
    assert {one.pfv_per_pfa for one in result.curves[0].motions} == {low_ratio, high_ratio}


# --- what is flagged, left out, or cannot be had ---


@pytest.mark.slow
def test_motions_that_may_be_too_weak_are_flagged(tmp_path):
    floors = [{"floor": "1", **SLOW}, {"floor": "2", "record_x": "pulse.csv"}, {"floor": "3", "pfa_x": 0.4}]
    items = [{**CABINET, "item": one, "floor": one} for one in "123"]
    for building, unknown in (({}, True), ({"height": 20}, False)):
        result = found(assessed(tmp_path, *items, floors=floors, building=building), 0.3, 0.6)
        assert [one.may_be_too_low for one in result.curves] == [False, True, unknown]
        flags = [(one.is_assumed, one.is_unknown, one.is_weak) for (one,) in (curve.motions for curve in result.curves)]
        assert flags == [(False, False, False), (False, False, True), (True, unknown, False)]
    assert result.curves[2].motions[0].spectrum == "drawn for T1 0.646 s", "1.4 x 0.0488 x 20^0.75"


def test_stocky_pieces_are_left_out(tmp_path):
    stout = {**CABINET, "item": "stout", "breadth": 160, "width": 160, "height": 110, "quantity": 2}
    result = found(assessed(tmp_path, CABINET, stout), 0.3, 0.6)
    assert ([one.name for one in result.curves], [one.item for one in result.stocky]) == (["a1"], ["stout"])
    with pytest.raises(assess.InputError, match=r"^no piece can rock: all are too stocky"):
        found(assessed(tmp_path, stout), 0.3)


def test_progress_is_reported_and_a_cancel_ends_it(tmp_path):
    assessment = assessed(tmp_path)
    reports: list[Report] = []
    found(assessment, 0.3, jobs=1, progress=Progress(reports.append))
    own = [one for one in reports if one.stage == "rocking"]
    assert {one.detail for one in own} == {"1 row on 1 floor"}
    assert (own[0].share, own[-1].share) == (0, 1)
    cancel = Event()

    def listen(_: Report) -> None:
        cancel.set()

    with pytest.raises(assess.CancelledError):
        found(assessment, 0.3, progress=Progress(listen, cancel))


def test_what_cannot_be_used(tmp_path):
    assessment = assessed(tmp_path)
    expected = "^levels: expected one or more finite numbers above 0, each larger than the one before$"
    for levels in ([], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0], [1.0, math.inf], [math.nan]):
        with pytest.raises(assess.InputError, match=expected):
            find_piece_fragilities(assessment, levels=levels)
    with pytest.raises(assess.InputError, match=r"^by is 'room', expected one of: item, type$"):
        find_piece_fragilities(assessment, by="room")
    with pytest.raises(assess.InputError, match=r"^im is 'psa', expected one of: pfa, pfv$"):
        find_piece_fragilities(assessment, im="psa")
    with pytest.raises(assess.InputError, match="a fixed number of generated motions"):
        found(assessed(tmp_path, settings=replace(SETTINGS, runs="auto")))
