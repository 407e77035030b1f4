"""Chances of what fallen pieces cause: gone through or drawn, in any order, and never less with one piece more."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from hypothesis.extra.numpy import arrays

from assess.route_results import Chance
from assess.routes import chances as module
from assess.routes.chances import Draws, build_couplings, find_chances, to_array, to_sets, union
from assess.routes.obstructions import find_obstructions
from assess.routes.scene import Scene
from tests.routes.buildings import building, evaluated, make_falls, piece, place, stretch

QUICK = settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
PLACES = [place("Room", "room"), place("Hall"), place("West", "exit"), place("East", "exit")]
SEGMENTS = [stretch("in", "Room", "Hall"), stretch("west", "Hall", "West"), stretch("east", "Hall", "East")]
RUNS = 20


@st.composite
def pieces(draw, most=5):
    """Draw pieces beside the segments: of what height, how they fall, and whether they are anchored."""
    found = []
    for _ in range(draw(st.integers(1, most))):
        item = piece(
            draw(st.sampled_from([0.4, 0.6, 1.2])), 0.0, route="Way",
            segment=draw(st.sampled_from(["in", "west", "east", ""])),
        )  # fmt: skip
        count = draw(st.integers(0, RUNS))
        fell = np.random.default_rng(draw(st.integers(0, 99))).permutation(RUNS) < count
        is_simulated = draw(st.sampled_from([False, True, True]))
        quantity, anchored = draw(st.sampled_from([1, 1, 2])), draw(st.sampled_from([False, False, True]))
        found.append((item, fell, is_simulated, quantity, anchored))
    return found


def falls_of(rows):
    return make_falls(
        [fell.mean() for _, fell, *_ in rows],
        fell={at: fell for at, (_, fell, is_simulated, *_) in enumerate(rows) if is_simulated},
        quantity=[quantity for *_, quantity, _ in rows],
        anchored=[anchored for *_, anchored in rows],
    )


def found(rows, **more):
    """Return the routes of the building and all chances in it, in one order."""
    routes = evaluated(falls_of(rows), [one[0] for one in rows], SEGMENTS, PLACES, **more)
    chances = [
        *(getattr(one, name) for one in (*routes.segments, *routes.routes)
          for name in ("blocked", "blocked_or_reduced", "blocked_if_anchors_fail")),
        *(one for room in routes.rooms for one in (room.loses_every_exit, room.loses_if_anchors_fail)),
        *(floor.any_room_cut_off for floor in routes.floors),
    ]  # fmt: skip
    return routes, chances


def same(one, other, within=1e-12):
    for mine, theirs in zip(one, other, strict=True):
        assert (mine is None) == (theirs is None)
        for field in fields(Chance) if mine is not None else ():
            assert getattr(mine, field.name) == pytest.approx(getattr(theirs, field.name), abs=within), field.name


@QUICK
@given(pieces(), st.randoms())
@pytest.mark.slow
def test_the_order_of_the_items_changes_no_chance(rows, random):
    shuffled = list(rows)
    random.shuffle(shuffled)
    same(found(rows)[1], found(shuffled)[1])


@QUICK
@given(pieces(most=4), pieces(most=1))
@pytest.mark.slow
def test_one_piece_more_never_lowers_a_chance(rows, more):
    without, with_it = found(rows)[1], found([*rows, *more])[1]
    for less, more_ in zip(without, with_it, strict=True):
        if less is not None and more_ is not None:
            for name in ("joint", "independent", "correlated"):
                assert getattr(more_, name) >= getattr(less, name) - 1e-12, name


@QUICK
@given(pieces())
@pytest.mark.slow
def test_chances_and_their_ends(rows):
    """In order, and as told: the joint one where all fell under one source, else the largest; blocked <= taken."""
    routes, chances = found(rows)
    for one in chances:
        if one is not None:
            assert 0 <= one.low <= one.probability <= one.high <= 1 + 1e-12
            assert one.probability == (one.joint if one.is_joint else max(one.joint, one.independent, one.correlated))
    for one in (one for one in (*routes.segments, *routes.routes) if one.blocked):
        assert one.blocked.probability <= one.blocked_or_reduced.probability + 1e-12
        if one.blocked_if_anchors_fail:
            assert one.blocked_if_anchors_fail.joint >= one.blocked.joint - 1e-12


@QUICK
@given(pieces())
@pytest.mark.slow
def test_drawn_chances_are_near_those_gone_through(rows):
    exact = found(rows)[1]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "EXACT", 1)
        drawn = found(rows)[1]
    for mine, theirs in zip(drawn, exact, strict=True):
        for name in ("joint", "independent", "correlated") if mine is not None else ():
            assert getattr(mine, name) == pytest.approx(getattr(theirs, name), abs=0.03), name


def test_the_same_seed_gives_the_same_numbers():
    """16 pieces of which none was verified have more outcomes than are gone through: another seed, other draws."""
    items = [piece(0.5, 0.0, route="Way", segment=f"{at % 4}") for at in range(16)]
    segments = [stretch(str(at), clear_width=1.6) for at in range(4)]
    falls = make_falls([0.1 + 0.02 * at for at in range(16)])
    first, again, other = (evaluated(falls, items, segments, seed=seed).routes for seed in (7, 7, 8))
    assert first == again
    assert first[0].blocked.joint != other[0].blocked.joint
    assert first[0].blocked.joint == pytest.approx(other[0].blocked.joint, abs=0.03)
    assert first[0].blocked.high > first[0].blocked.probability  # the interval of the draws


@QUICK
@given(st.lists(st.tuples(st.floats(0, 1), st.integers(1, 4)), min_size=1, max_size=4))
def test_rows_against_every_outcome_of_every_piece(rows):
    """Any and two or more of a row's pieces, from all 2^n outcomes of single pieces."""
    falls = make_falls([p for p, _ in rows], quantity=[q for _, q in rows])
    keys = [(at, number) for at, (_, q) in enumerate(rows) for number in range(min(q, 2))]

    def happens(draws):
        fallen = [draws.fallen[key] for key in keys]
        return [union(fallen), *fallen]

    chances = find_chances(build_couplings(falls, keys, 1), happens, 1.96)
    none = np.prod([(1 - p) ** q for p, q in rows])
    assert chances[0].independent == pytest.approx(1 - none)
    for (at, number), chance in zip(keys, chances[1:], strict=True):
        p, q = rows[at]
        expected = 1 - (1 - p) ** q - (q * p * (1 - p) ** (q - 1) if number else 0)
        assert chance.joint == pytest.approx(expected, abs=1e-12)
        assert chance.correlated == pytest.approx(p, abs=1e-12)


def test_what_depends_on_pieces_of_different_runs_is_no_less_than_each_alone():
    """The first is integrated under 1,000 motions and falls in 50 of them, none of the first 200; the second under 200.

    The segment of the first is blocked at 0.05. The route of both cannot be blocked less often than that.
    """
    fell = {0: [False] * 200 + [True] * 50 + [False] * 750, 1: [True] * 2 + [False] * 198}
    segments = [stretch("a"), stretch("b")]
    items = [piece(1.5, 0.0, route="Way", segment=one) for one in "ab"]
    routes = evaluated(make_falls([0.05, 0.01], fell=fell), items, segments)
    assert [one.blocked.probability for one in routes.segments] == pytest.approx([0.05, 0.01])
    both = routes.routes[0].blocked
    assert both.probability >= 0.05 - 1e-12
    assert (both.is_joint, both.runs, both.unverified) == (False, 200, 0), "draws that only one had are not joint"
    assert both.probability == max(both.joint, both.independent, both.correlated)


@pytest.mark.parametrize("first", [True, False])
def test_who_asks_first_changes_nothing(first):
    """Segment a has a free-standing piece and an anchored one, b the first alone, whether anchors fail or not.

    Asked of b as if anchors fail, then of a as if they hold: the anchored piece, which alone blocks a, does not count.
    """
    items = [piece(0.5, 0.0, route="Way", segment=""), piece(1.5, 0.0, route="Way", segment="a")]
    segments = [stretch("a"), stretch("b")]
    falls = make_falls([0.4, 0.9], anchored=[False, True])
    inventory = building(items, segments)
    scene = Scene(inventory, find_obstructions(inventory), falls, 0.03, 1, 1.96)
    scene.couplings([1], anchors_fail=first)
    (chance,), _ = scene.bounds([0], lambda draws: list(scene.blocked(draws, [0]).values()))
    assert (chance.joint, chance.independent, chance.correlated, chance.high) == (0, 0, 0, 0)
    fails = scene.judge([0], lambda draws: list(scene.blocked(draws, [0]).values())).if_anchors_fail
    assert fails.probability == pytest.approx(0.9)


@QUICK
@given(pieces())
@pytest.mark.slow
def test_sharing_what_is_known_of_all_pieces_changes_nothing(rows):
    """Each segment alone, and of the whole building: where every outcome is gone through, the chances are the same."""
    falls = falls_of(rows)
    whole = found(rows)[0].segments
    for at, one in enumerate(SEGMENTS):
        (alone,) = evaluated(falls, [item for item, *_ in rows], [one], PLACES).segments
        same([alone.blocked, alone.blocked_or_reduced], [whole[at].blocked, whole[at].blocked_or_reduced])


# --- sets of draws ---


@given(st.tuples(st.integers(1, 70), st.integers(0, 4)).flatmap(lambda shape: arrays(np.bool_, shape)))
def test_sets(happens):
    sets, m = to_sets(happens), len(happens)
    for one, row in zip(sets, happens.T, strict=True):
        assert (to_array(one, m) == row).all()
        assert one.bit_count() == row.sum()
    assert (to_array(union(sets), m) == happens.any(axis=1)).all()


@given(st.integers(1, 70).flatmap(lambda m: arrays(np.bool_, (m, 1))), st.booleans())
def test_what_a_set_of_draws_weighs(fell, is_even):
    m = len(fell)
    weight = np.ones(m) if is_even else np.arange(1.0, m + 1)
    draws = Draws.of([(0, 0)], fell, weight / weight.sum())
    assert draws.share(draws.fallen[0, 0]) == pytest.approx(weight[fell[:, 0]].sum() / weight.sum(), abs=1e-12)
