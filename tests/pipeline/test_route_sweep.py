"""The chances of blockage against PFA: the same motions scaled, held against blocks rocked one by one, and a run."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import assess
from assess.pipeline import verify
from assess.pipeline.adopt import Assessment
from assess.pipeline.route_sweep import FINEST, JUMP, MOST_INSERTED, find_fragility, find_jumps, find_passing
from assess.pipeline.run import build_results, compute
from assess.settings import Settings
from assess.units import GRAVITY
from tests.pipeline.alone import rocked
from tests.pipeline.rows import read_sheets
from tests.shaking import write_records

RUNS = 20
SETTINGS = Settings(verify="none", runs=RUNS, seed=4)
CORRIDOR = {"route": "A", "segment": "corridor", "floor": "1", "clear_width": 1.5, "required_width": 0.9}
CABINET = {
    "item": "a1", "floor": "1", "breadth": 40, "width": 80, "height": 180, "axis": "X", "route": "A", "edge_distance": 0
}  # fmt: skip
"""It leaves nothing of the corridor once it has fallen."""
EXACT = {"motion_uncertainty": 0, "piece_uncertainty": "no"}
"""Nothing is uncertain but the phases of the motions."""
SLOW = {"record_x": "slow.csv"}
"""A record that motions made for its spectrum match: its simulated classes are confirmed."""


def assessed(
    folder: Path,
    *items: dict[str, Any],
    settings: Settings = SETTINGS,
    floor: dict[str, Any] | None = None,
    building: dict[str, Any] | None = None,
) -> Assessment:
    write_records(folder, "pulse", "slow")
    inventory = read_sheets(
        folder, Building=[building or {}], Floors=[{"floor": "1", **(floor or {"record_x": "pulse.csv"})}],
        Items=list(items) or [CABINET], Routes=[CORRIDOR, {**CORRIDOR, "route": "B"}],
    )  # fmt: skip
    return compute(inventory, settings)


def fragility(assessment: Assessment, *pfa_g: float, **named: Any):
    return find_fragility(assessment, [one * GRAVITY for one in pfa_g], **named)


def chances(found, route: str = "A") -> list[float]:
    (own,) = (one for one in found.routes if one.route == route)
    return [chance.probability for chance in own.blocked]


def share(assessment: Assessment, pfa_g: float) -> list[float]:
    """Return the share of draws in which each piece falls, alone."""
    return [float(one.mean()) for one in rocked(assessment, pfa_g)]


# --- one piece ---


def test_one_piece_falls_as_often_as_it_does_alone(tmp_path):
    assessment = assessed(tmp_path, floor={"pfa_x": 0.3, "pfa_y": 0.2}, building=EXACT)
    found = fragility(assessment, 0.2, 0.3, 0.9)
    assert chances(found) == [pytest.approx(share(assessment, pfa)[0]) for pfa in (0.2, 0.3, 0.9)]
    assert 0 < chances(found)[1] < 1
    one = found.routes[0].blocked[0]
    assert (one.pieces, one.unverified, one.runs, one.is_joint) == (1, 0, RUNS, True)
    assert chances(found, "B") == [0, 0, 0]
    assert (found.generic, found.unshaped, found.weak) == (("1",), ("1",), ())
    assert [one.doubtful for one in found.routes] == [1, 0]
    assert found.routes[0].scenario_pfa == (pytest.approx(0.2 * GRAVITY), pytest.approx(0.3 * GRAVITY))
    assert found.routes[0].floors == ("1",)


def test_below_the_threshold_of_every_piece_nothing_falls(tmp_path):
    """It rocks above B/H = 0.22 g; the peaks of the motions scatter, by less than 2, and so does the earthquake."""
    found = fragility(assessed(tmp_path), 0.02, 0.03)
    assert chances(found) == [0, 0]
    assert found.routes[0].blocked[0].high > 0, "as only so many motions were tried"
    none = fragility(assessed(tmp_path, {**CABINET, "route": None}), 0.5)
    assert chances(none) == chances(none, "B") == [0]


def test_a_blank_axis_takes_the_worse_at_each_value(tmp_path):
    assessment = assessed(tmp_path, {**CABINET, "axis": None}, building=EXACT)
    values = (0.3, 0.4, 0.5, 0.6)
    along = [share(assessment, pfa) for pfa in values]
    assert chances(fragility(assessment, *values)) == [pytest.approx(max(both)) for both in along]
    assert any(one != other for one, other in along)


def test_a_square_piece_blocks_in_draws_in_which_it_falls_along_either_axis(tmp_path):
    """The route is blocked as often as the piece falls, at the scenario's own PFA and in a run."""
    square = {**CABINET, "axis": None, "width": 50, "breadth": 40}
    assessment = assessed(tmp_path, square, floor=SLOW | {"record_y": "slow.csv"}, settings=Settings(runs=60))
    chance = assessment.adoption.probability[0]
    (joint,) = {float(one.fell.mean()) for one in assessment.joints.values() if 0 in one.cases}
    assert 0 < joint < chance < 1, "one axis alone falls less often"
    rows = build_results(assessment, figures=False).route_tables.routes
    assert [one.blocked.probability if one.blocked else 0 for one in rows] == [pytest.approx(chance), 0]
    pfa = assessment.demands["1", "X"][0].pfa / GRAVITY
    assert assessment.demands["1", "Y"][0].pfa / GRAVITY == pytest.approx(pfa)
    assert chances(fragility(assessment, pfa)) == [pytest.approx(chance)]


def test_a_piece_too_stocky_to_rock_blocks_nothing(tmp_path):
    assessment = assessed(tmp_path, {**CABINET, "breadth": 160, "width": 160, "height": 110, "quantity": 2})
    found = fragility(assessment, 0.3, 0.9)
    first = found.routes[0].blocked
    assert [(one.probability, one.high, one.unverified, one.runs) for one in first] == [(0, 0, 2, 0)] * 2
    assert (found.stocky, found.generic) == (2, ())


def test_anchored_pieces_stand_beside(tmp_path):
    found = fragility(assessed(tmp_path, {**CABINET, "anchored": "yes"}), 0.6).routes[0]
    assert (found.blocked[0].probability, found.blocked[0].pieces) == (0, 0)
    assert found.if_anchors_fail is not None
    assert found.if_anchors_fail[0].probability == chances(fragility(assessed(tmp_path), 0.6))[0] > 0


# --- beside a run ---


ITEMS = [
    CABINET,
    {**CABINET, "item": "a2", "breadth": 30, "height": 170, "edge_distance": 0.4, "axis": None},
    {**CABINET, "item": "a3", "breadth": 35, "height": 170, "edge_distance": 0.2, "anchored": "yes"},
    {**CABINET, "item": "a4", "breadth": 45, "height": 180, "edge_distance": 1.0, "quantity": 3, "axis": "Y"},
]


@pytest.mark.parametrize(
    ("building", "ideal"), [({}, False), ({}, True), ({"motion_uncertainty": 0.6, "piece_uncertainty": "no"}, False)]
)
def test_at_the_workbooks_own_pfa_it_is_what_a_run_finds(tmp_path, building, ideal):
    settings = replace(SETTINGS, verify="all", ideal=ideal)
    ran = assessed(tmp_path, *ITEMS, settings=settings, floor=SLOW, building=building)
    (pfa,) = {demand.pfa for demand in ran.case_demand}
    found = find_fragility(ran, [pfa])
    routes = build_results(ran).route_tables.routes
    for one, other in zip(found.routes, routes, strict=True):
        assert one.blocked == (other.blocked,) or not other.evaluated
        assert (one.if_anchors_fail or (None,)) == (other.blocked_if_anchors_fail,)
        assert other.blocked is None or other.blocked.unconfirmed == one.doubtful == 0
    assert 0 < chances(found)[0] < 1
    assert (found.generic, found.unshaped, found.weak) == ((), (), ())
    assert found.uncertainty == (None if ideal else ran.cases.uncertainty)
    blind = assessed(tmp_path, *ITEMS, settings=replace(SETTINGS, ideal=ideal), floor=SLOW, building=building)
    assert found == find_fragility(blind, [pfa]), "simulated or not"


def test_where_the_motions_may_be_too_weak_a_run_does_not_know(tmp_path):
    """Motions made for one long pulse are weaker than it: the sweep gives what they do and counts the pieces."""
    ran = assessed(tmp_path, *ITEMS, settings=replace(SETTINGS, verify="all"))
    (pfa,) = {demand.pfa for demand in ran.case_demand}
    found = find_fragility(ran, [pfa])
    assert (found.weak, found.unshaped, [one.doubtful for one in found.routes]) == (("1",), (), [6, 0])
    run = build_results(ran).route_tables.routes[0].blocked
    assert run is not None
    assert run.unconfirmed > 0
    assert run.pieces < found.routes[0].blocked[0].pieces


def test_the_uncertainty_of_the_workbook_counts(tmp_path):
    """At a PFA at which no motion fells the piece as given, it falls where the earthquake is stronger or it thinner."""
    exact, uncertain = (fragility(assessed(tmp_path, building=one, floor=SLOW), 0.15) for one in (EXACT, {}))
    assert chances(exact)[0] <= 0.05
    assert chances(uncertain)[0] > chances(exact)[0] + 0.05
    assert exact.uncertainty is not None
    assert (exact.uncertainty.motion, exact.uncertainty.piece) == (0, False)


def test_values_are_inserted_at_a_jump_and_change_nothing_else(tmp_path, monkeypatch):
    """Nothing is uncertain but the phases: the chance rises steeply. No case is rocked twice at one value."""
    assessment, asked = assessed(tmp_path, *ITEMS, building=EXACT), (0.1, 0.2, 0.6, 0.9)
    plain = fragility(assessment, *asked)
    assert find_jumps(chances(plain))
    done: list[tuple[int, float]] = []
    rock, made = verify.Sweep._rock, []

    def note(sweep, own, motions, factors, *rest):
        done.extend((int(own[0]), factor) for factor in factors)
        made.append(id(motions))
        return rock(sweep, own, motions, factors, *rest)

    monkeypatch.setattr(verify.Sweep, "_rock", note)
    fine = fragility(assessment, *asked, most_inserted=MOST_INSERTED)
    assert len(set(done)) == len(done)
    assert len(set(made)) == len({number for number, _ in done}) < len(made), "motions are made ready once"
    assert 0 < len(fine.inserted) <= MOST_INSERTED
    assert fine.inserted == set(fine.values) - set(plain.values)
    at = [fine.values.index(value) for value in plain.values]
    for one, other in zip(plain.routes, fine.routes, strict=True):
        assert tuple(other.blocked[number] for number in at) == one.blocked
        assert other.if_anchors_fail is None or tuple(other.if_anchors_fail[number] for number in at) == (
            one.if_anchors_fail
        )
    step = [high / low - 1 for low, high in pairwise(fine.values)]
    for one in fine.routes:
        for way in (one.blocked, one.if_anchors_fail or ()):
            assert all(step[jump] < 2.1 * FINEST for jump in find_jumps([chance.probability for chance in way]))


def test_no_more_values_are_inserted_than_wanted(tmp_path):
    found = fragility(assessed(tmp_path, building=EXACT), 0.1, 0.9, most_inserted=2)
    assert len(found.inserted) == 2
    assert 0.5 in [round(value / GRAVITY, 6) for value in found.inserted]
    assert chances(found, "B") == [0, 0, 0, 0]
    assert not fragility(assessed(tmp_path), 0.02, 0.03, most_inserted=9).inserted, "no chance jumps by over 0.2"
    assert JUMP == 0.2


def test_the_pieces_to_blame_are_those_without_which_it_stays_below(tmp_path):
    """a1 leaves nothing of the corridor; a2, a small one far from it, cannot block it."""
    far = {**CABINET, "item": "a2", "breadth": 20, "height": 60, "edge_distance": 0.2}
    found = fragility(assessed(tmp_path, CABINET, far), 0.02, 0.6)
    assert [[piece.item for piece in one.causes] for one in found.routes] == [["a1"], []]
    assert found.limit == SETTINGS.route_risk
    assert fragility(assessed(tmp_path, CABINET, far), 0.02).routes[0].causes == ()


def test_what_it_cannot_do(tmp_path):
    assessment = assessed(tmp_path, settings=replace(SETTINGS, runs="auto"))
    with pytest.raises(assess.InputError, match="a fixed number of generated motions"):
        fragility(assessment, 0.3)
    many = assessed(tmp_path, settings=replace(SETTINGS, runs=100_000))
    with pytest.raises(assess.InputError, match=r"^runs is 100,000: 500,000,000 results .* fewer levels of shaking"):
        fragility(many, *np.linspace(0.1, 1, 5000))


# --- where it passes a level ---


@pytest.mark.parametrize(
    ("chances", "level", "between"),
    [
        ([0.0, 0.2, 0.4], 0.1, (0.15, 0.15)),
        ([0.0, 0.2, 0.4], 0.2, (0.2, 0.2)),
        ([0.0, 0.2, 0.4], 0.35, (0.275, 0.275)),
        ([0.7, 0.7, 0.9], 0.8, (0.25, 0.25)),
        ([0.0, 0.2, 0.6], 0.7, (math.inf, math.inf)),
        ([0.3, 0.2, 0.6], 0.25, (-math.inf, -math.inf)),
        ([0.3, 0.2, 0.6], 0.3, (0.1, 0.1)),
        ([0.0, 0.16, 0.1], 0.12, (0.175, 0.175)),
        ([0.0, 1.0, 1.0], 0.03, (0.1, 0.2)),  # nothing is read off a jump
        ([0.0, 1.0, 1.0], 1.0, (0.1, 0.2)),
        ([0.0, 0.2, 0.41], 0.3, (0.2, 0.3)),
        ([0.0, 0.4, 0.2], 0.3, (0.1, 0.2)),
    ],
)
def test_where_a_chance_reaches_a_level(chances, level, between):
    assert find_passing([0.1, 0.2, 0.3], chances, level) == pytest.approx(between)
    assert find_jumps([0.0, 0.3, 0.5, 0.7, 0.9, 0.6]) == [0, 4], "20 percentage points are none"
    assert find_jumps([0.5]) == []


def test_a_stair_without_a_clear_width_is_named(tmp_path):
    """As in the report, where that route is not known; with a width it is evaluated."""
    flight = {"route": "A", "segment": "flight", "start": "Up", "end": "Down", "required_width": 0.9}
    places = [{"place": "Up", "floor": "2", "kind": "stair"}, {"place": "Down", "floor": "1", "kind": "stair"}]
    write_records(tmp_path, "pulse", "slow")
    for width, named in ((None, ("flight",)), (1.2, ())):
        rows = {
            "Building": [{}], "Floors": [{"floor": name, "record_x": "pulse.csv"} for name in "12"],
            "Items": [CABINET], "Places": places, "Routes": [CORRIDOR, {**flight, "clear_width": width}],
        }  # fmt: skip
        assessment = compute(read_sheets(tmp_path, **rows), SETTINGS)
        (route,) = fragility(assessment, 0.01).routes
        assert (route.is_evaluated, route.unevaluated) == (True, named)
        (row,) = build_results(assessment, figures=False).route_tables.routes
        assert row.unevaluated_segments == named
