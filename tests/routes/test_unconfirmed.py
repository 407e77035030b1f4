"""Pieces whose chance is not confirmed: each counts as standing and as fallen, and what differs is not known."""

import pytest
from hypothesis import given, settings, strategies as st

from assess.route_results import RouteState
from tests.routes.buildings import evaluated, make_falls, one_segment, piece, place, stretch, told

WIDE, NARROW = stretch(), stretch(clear_width=1.6)
HALF, WHOLE = piece(0.5, 0.0), piece(1.5, 0.0)
"""Alone a half leaves 1.1 m of the narrow one, two 0.6 m; a whole leaves 0.3 m of the wide one."""
PERIOD = ("unconfirmed_building",)


def whats(one):
    """Return what is missing, by its keys."""
    return tuple(row.what for row in one.missing)


def test_a_segment_that_it_would_block_is_not_known():
    found = one_segment(make_falls([0.9], unconfirmed=[0]), [WHOLE])
    assert (found.state, whats(found), found.missing[0].names) == (RouteState.NOT_KNOWN, PERIOD, ("P0",))
    standing, fallen = found.blocked, found.blocked_if_unconfirmed_fall
    assert (standing.probability, standing.high, standing.pieces, standing.unconfirmed) == (0, 0, 0, 1)
    assert (fallen.probability, fallen.low, fallen.high) == (1, 1, 1)
    assert found.most_likely_piece is None
    (near,) = found.pieces
    assert (near.falls_while_blocked, near.flags[-1]) == (None, "unconfirmed_building")


def test_one_that_does_not_matter_leaves_the_state_known():
    """Its 0.5 m leaves enough of the wide segment, whose other piece blocks in 1 of 4 draws.

    Standing 1 of 4, and fallen the same: the chance is that of the other piece alone.
    """
    found = one_segment(told("1000", "1111", unconfirmed=[1]), [WHOLE, HALF])
    assert (found.state, found.missing) == (RouteState.DOUBTFUL, ())
    assert found.blocked.probability == found.blocked_if_unconfirmed_fall.probability == pytest.approx(1 / 4)
    assert (found.blocked.pieces, found.blocked.runs, found.blocked.is_joint) == (1, 4, True)
    held = one_segment(make_falls([0.9], unconfirmed=[0], anchored=[True]), [WHOLE])
    assert (held.state, held.missing, held.blocked_if_unconfirmed_fall) == (RouteState.OPEN, (), None)
    assert held.blocked_if_anchors_fail.probability == 1, "on the safe side"


def test_blocked_wins_over_not_known_and_doubtful_or_blocked_is_not_known():
    """It is blocked in 2 of 4 draws with the other piece standing; with it fallen, always."""
    found = one_segment(told("1100", "0000", unconfirmed=[1]), [WHOLE, WHOLE])
    assert (found.state, found.missing) == (RouteState.BLOCKED, ())
    assert [found.blocked.probability, found.blocked_if_unconfirmed_fall.probability] == pytest.approx([1 / 2, 1])
    # in 1 of 4 draws with the other piece standing, which is below 0.3; with it fallen, always
    found = one_segment(told("1000", "0000", unconfirmed=[1]), [WHOLE, WHOLE])
    assert (found.state, whats(found)) == (RouteState.NOT_KNOWN, PERIOD)


def test_one_that_only_narrows_it_leaves_it_open_but_it_may_face_one_that_falls():
    found = one_segment(make_falls([0.9], unconfirmed=[0]), [HALF])
    assert (found.state, found.missing) == (RouteState.OPEN, ())
    assert found.blocked.probability == found.blocked_if_unconfirmed_fall.probability == 0
    # 1100 alone only narrows the narrow segment; with an unconfirmed piece fallen opposite it blocks, in 2 of 4
    found = one_segment(told("1100", "0000", unconfirmed=[1]), [HALF, HALF], NARROW)
    assert found.state is RouteState.NOT_KNOWN
    assert [found.blocked.probability, found.blocked_if_unconfirmed_fall.probability] == pytest.approx([0, 1 / 2])


def test_under_the_record_it_does_as_it_did():
    """What happened under the record itself is known, whatever its chance is: blocked, so blocked wins."""
    found = one_segment(make_falls([0.9], unconfirmed=[0], in_record=[1]), [WHOLE])
    assert (found.under_record, found.state, found.missing) == (RouteState.BLOCKED, RouteState.BLOCKED, ())


PLACES = [place("Room", "room"), place("Hall"), place("West", "exit"), place("East", "exit")]
SEGMENTS = [stretch("in", "Room", "Hall"), stretch("west", "Hall", "West"), stretch("east", "Hall", "East")]


def beside(segment):
    return piece(1.5, 0.0, route="Way", segment=segment)


def test_a_route_with_another_way_is_known():
    """West may be blocked by an unconfirmed piece; East stays open, so that nothing is cut off either way."""
    found = evaluated(make_falls([0.9], unconfirmed=[0]), [beside("west")], SEGMENTS, PLACES)
    assert [one.state for one in found.segments] == [
        RouteState.OPEN, RouteState.NOT_KNOWN, RouteState.OPEN,
    ]  # fmt: skip
    (room,), (floor,) = found.rooms, found.floors
    assert (room.state, room.missing, room.loses_every_exit.probability) == (RouteState.OPEN, (), 0)
    assert room.loses_if_unconfirmed_fall.probability == 0
    first, second = room.ways
    assert (first.end, first.state, first.blocked_if_unconfirmed_fall) == ("East", RouteState.OPEN, None)
    assert (second.end, second.state) == ("West", RouteState.NOT_KNOWN)
    assert second.blocked_if_unconfirmed_fall.probability == 1
    assert (floor.unknown_segments, floor.unknown_rooms, found.unknown_rooms) == (1, 0, 0)


def test_sums_are_of_what_is_known():
    """East is blocked in 1 of 4 draws; with West's unconfirmed piece fallen the room is cut off in those."""
    falls = told("1000", "0000", unconfirmed=[1])
    other = stretch("gap", route="Other")
    items = [beside("east"), beside("west"), piece(1.5, 0.0, route="Other", segment="gap")]
    falls = make_falls([0.25, 0.9, 0.2], fell={0: falls.fell[0]}, unconfirmed=[1])
    found = evaluated(falls, items, [*SEGMENTS, other], PLACES)
    (room,), (floor,), (way, gap) = found.rooms, found.floors, found.routes
    assert (room.is_known, whats(room)) == (False, PERIOD)
    assert [room.loses_every_exit.probability, room.loses_if_unconfirmed_fall.probability] == pytest.approx([0, 1 / 4])
    assert (way.state, gap.state) == (RouteState.NOT_KNOWN, RouteState.DOUBTFUL)
    assert [found.blocked_routes_expected, found.cut_off_rooms_expected] == pytest.approx([0.2, 0])
    assert (found.unknown_routes, found.unknown_rooms) == (1, 1)
    assert [floor.blocked_segments_expected, floor.blocked_routes_expected] == pytest.approx([0.25 + 0.2, 0.2])
    assert (floor.unknown_segments, floor.unknown_routes, floor.unknown_rooms) == (1, 1, 1)
    assert (floor.any_room_cut_off, floor.cut_off_rooms_expected) == (None, 0)


def test_what_to_fix_counts_it_as_fallen():
    """Fixing the unconfirmed piece leaves the other's 0.1; fixing both, nothing."""
    route = evaluated(make_falls([0.1, 0.2], unconfirmed=[1]), [WHOLE, WHOLE]).routes[0]
    assert [fix.item_index for fix in route.fixes] == [1, 0]
    assert [fix.gain for fix in route.fixes] == pytest.approx([0.9, 0.1])
    assert [fix.left for fix in route.fixes] == pytest.approx([0.1, 0])
    assert route.is_fixed


def test_too_narrow_for_occupants_is_not_known():
    found = one_segment(make_falls([0.9], unconfirmed=[0]), [HALF], stretch(clear_width=1.6, occupants=250))
    assert found.needed_width_m == pytest.approx(1.27)
    assert found.insufficient_after_falls is None


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.sampled_from([0.4, 0.6, 1.2]), st.integers(0, 8), st.sampled_from("cfu")), min_size=1,
                max_size=5))  # fmt: skip
def test_standing_and_fallen_enclose_every_chance_that_the_piece_could_have(rows):
    """Whatever chance an unconfirmed piece is given, the result lies between the two; and a known state stays."""
    items = [piece(height, 0.0) for height, *_ in rows]
    fell = {at: [run < count for run in range(8)] for at, (_, count, kind) in enumerate(rows) if kind == "c"}
    chances = [count / 8 for _, count, _ in rows]
    doubted = [at for at, (*_, kind) in enumerate(rows) if kind == "u"]
    found = one_segment(make_falls(chances, fell=fell, unconfirmed=doubted), items, NARROW)
    settled = one_segment(make_falls(chances, fell=fell), items, NARROW)
    at_most = found.blocked_if_unconfirmed_fall or found.blocked
    for name in ("joint", "independent", "correlated"):
        low, high = getattr(found.blocked, name), getattr(at_most, name)
        assert low - 1e-9 <= getattr(settled.blocked, name) <= high + 1e-9, name
    assert (found.blocked_if_unconfirmed_fall is None) == (not doubted)
    if found.state != RouteState.NOT_KNOWN and not fell:
        assert settled.state is found.state
