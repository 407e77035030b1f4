"""Chances of pieces that fall together or apart, by hand.

A corridor 1.6 m clear needs 0.9 m: one piece 0.5 m high at its edge leaves 1.1 m, two that face each other 0.6 m.
"""

import pytest

from assess.route_results import RouteState
from tests.routes.buildings import corridor, evaluated, make_falls, one_segment, piece, stretch, told, values

NARROW = stretch(clear_width=1.6)
PAIR = [piece(0.5, 0.0), piece(0.5, 0.0)]
FIRST = [True] + [False] * 9
LOW_TEN, HIGH_TEN = 0.0179, 0.4042
"""Wilson's interval of 1 of 10, z = 1.96: centre (0.1 + 0.19207) / 1.38415 = 0.2110, half width 0.1932."""


@pytest.mark.parametrize(("one", "other", "joint", "independent", "correlated", "taken"), [
    ("1100", "1010", 1 / 4, 1 / 4, 1 / 2, 3 / 4),
    ("1100", "1100", 1 / 2, 1 / 4, 1 / 2, 1 / 2),
    ("1100", "0011", 0, 1 / 4, 1 / 2, 1),
    ("1110", "1000", 1 / 4, 3 / 16, 1 / 4, 3 / 4),
    ("1110", "0001", 0, 3 / 16, 1 / 4, 1),
])  # fmt: skip
def test_two_that_block_only_together(one, other, joint, independent, correlated, taken):
    """Both in motion 1 alone: 1 of 4. Independently: the product. Fully tied: the less likely one.

    Taken (blocked or reduced) is every motion in which either falls: 1100 and 1010 make 1110, three of four.
    """
    found = one_segment(told(one, other), PAIR, NARROW)
    assert [beside.left_m for beside in found.pieces] == pytest.approx([1.1, 1.1])
    assert not any(beside.blocks_alone for beside in found.pieces)
    assert [found.standing_width_m, found.least_width_m] == pytest.approx([1.6, 0.6])
    blocked = found.blocked
    assert values(blocked) == pytest.approx((joint, independent, correlated))
    assert blocked.probability == pytest.approx(joint)
    assert (blocked.is_joint, blocked.runs, blocked.pieces) == (True, 4, 2)
    assert found.blocked_or_reduced.probability == pytest.approx(taken)


def test_either_is_named_with_its_chance_together():
    """1100 and 1010 block in motion 1, 1/4: each falls then. 1110 and 1000 with a third that stands out of it: 0001."""
    found = one_segment(told("1110", "1000", "0001"), [*PAIR, piece(0.5, 0.0)], NARROW)
    assert {one.item_index: one.falls_while_blocked for one in found.pieces} == pytest.approx(
        {0: 1 / 4, 1: 1 / 4, 2: 0}
    )
    assert found.most_likely_piece.item_index == 0


def test_facing_by_the_plan():
    """Corridor from y = -0.8 to 0.8; pieces at y = 1.0 and -1.0 stand against its edges, fall 0.5 m in: 0.6 m left."""
    items = [piece(0.5, x=5.0, y=y, width=0.8, axis="Y") for y in (1.0, -1.0)]
    found = one_segment(told("1100", "1010"), items, corridor(1.6))
    assert found.least_width_m == pytest.approx(0.6)
    assert found.blocked.probability == pytest.approx(1 / 4)


@pytest.mark.parametrize(("apart", "left"), [(5.0, 1.1), (1.6, 1.0), (1.25, 0.75), (0.8, 0.6)])
def test_how_far_apart_they_still_face(apart, left):
    """Each 0.8 m wide, 0.6 m between them across: `apart` - 0.8 along.

    5.0 m apart: each leaves 1.1 m and the way between them is 4.2 m wide, no blockage. 1.6 m apart: 0.8 along and 0.6
    across is 1.0 m, which a person of 0.9 m passes. 1.25: 0.45 and 0.6 is 0.75 m, blocked. 0.8: abreast, 0.6 m.
    """
    items = [piece(0.5, x=2.5, y=1.0, width=0.8, axis="Y"), piece(0.5, x=2.5 + apart, y=-1.0, width=0.8, axis="Y")]
    found = one_segment(told("1100", "1010"), items, corridor(1.6))
    assert found.least_width_m == pytest.approx(left)
    assert found.blocked.probability == pytest.approx(1 / 4 if left < 0.9 else 0)
    assert found.blocked_or_reduced.probability == pytest.approx(3 / 4)


@pytest.mark.parametrize("apart", [0.0, 0.4, 3.0])
def test_on_one_side_they_do_not_add(apart):
    """Both at y = 1.0: each lies 0.5 m in from the same wall, together too: 1.1 m left wherever they stand."""
    items = [piece(0.5, x=5.0 + at, y=1.0, width=0.8, axis="Y") for at in (0.0, apart)]
    found = one_segment(told("1111", "1111"), items, corridor(1.6))
    assert found.least_width_m == pytest.approx(1.1)
    assert (found.state, found.blocked.high) == (RouteState.OPEN, 0)


def test_one_on_the_plan_and_one_whose_side_is_not_known():
    """The second may face the first: 1.6 - 0.5 - 0.5 = 0.6 m."""
    items = [piece(0.5, x=5.0, y=1.0, width=0.8, axis="Y"), piece(0.5, 0.0)]
    found = one_segment(told("1100", "1010"), items, corridor(1.6))
    assert sorted(one.by_plan for one in found.pieces) == [False, True]
    assert found.least_width_m == pytest.approx(0.6)
    assert found.blocked.probability == pytest.approx(1 / 4)


def test_one_piece_is_not_on_both_sides_at_once():
    """3.0 m clear. A piece 0.5 m deep stands in its middle: 1.25 m on either side. One at an edge falls 1.0 m in.

    On whichever side that is, 0.25 m is left there and the other side keeps its 1.25 m: never under 0.9 m.
    """
    middle = piece(0.1, x=5.0, y=0.0, breadth=0.5, width=0.8, axis="Y", anchored="yes")
    found = one_segment(told("0000", "1100"), [middle, piece(1.0, 0.0)], corridor(3.0))
    assert found.standing_width_m == pytest.approx(1.25)
    assert found.blocked.probability == 0
    assert found.least_width_m == pytest.approx(1.15)  # the middle one fallen either way takes 0.1 m more


@pytest.mark.parametrize(("falls", "joint", "is_joint", "runs", "probability", "low", "high"), [
    (make_falls([0.1] * 3), 0.271, False, 0, 0.271, 0.1, 0.271),
    (told(*["1" + 9 * "0"] * 3), 0.1, True, 10, 0.1, LOW_TEN, HIGH_TEN),
    (told("1" + 9 * "0", "01" + 8 * "0", "001" + 7 * "0"), 0.3, True, 10, 0.3, 0.1078, 0.6032),
    (make_falls([0.1] * 3, fell=dict.fromkeys((0, 1), FIRST)), 0.19, False, 10, 0.271, LOW_TEN, 0.5772),
])  # fmt: skip
def test_three_alike_in_risk_each_blocking_alone(falls, joint, is_joint, runs, probability, low, high):
    """p = 0.1 each. Independent: 1 - 0.9^3 = 0.271. Fully tied: 0.1.

    Not verified: the largest, 0.271, from 0.1 to 0.271. Verified and falling in the same motion of ten: 0.1, Wilson's
    interval of 1 of 10. In three different motions: 0.3. Two of them in one motion, the third on its own (not
    verified): 1 - 0.9 x 0.9 = 0.19, and the largest of the three is told, 0.271, with the
    interval from the low end for 0.1 to the high end for 0.271 of 10: centre (0.271 + 0.19207) / 1.38415 = 0.3346,
    half width 1.96 sqrt(0.271 x 0.729/10 + 0.0096037) / 1.38415 = 0.2426.
    """
    blocked = one_segment(falls, [piece(1.5, 0.0)] * 3).blocked
    assert values(blocked) == pytest.approx((joint, 0.271, 0.1))
    assert blocked.probability == pytest.approx(probability)
    assert (blocked.low, blocked.high) == pytest.approx((low, high), abs=1e-4)
    assert (blocked.is_joint, blocked.runs, blocked.pieces) == (is_joint, runs, 3)


def test_how_many_are_not_verified():
    """A verified row of 2 and a row of 3 that is not: five pieces take part, three of them not verified."""
    falls = make_falls([0.1, 0.1], fell={0: FIRST}, quantity=[2, 3])
    items = [piece(1.5, 0.0, quantity=2), piece(1.5, 0.0, quantity=3)]
    blocked = one_segment(falls, items).blocked
    assert (blocked.pieces, blocked.unverified) == (5, 3)


def test_a_row_of_three_each_blocking_alone():
    """p = 0.2 each: at least one of three falls at 1 - 0.8^3 = 0.488; tied, they fall as one: 0.2."""
    falls = make_falls([0.2], quantity=[3])
    blocked = one_segment(falls, [piece(1.5, 0.0, quantity=3)]).blocked
    assert values(blocked) == pytest.approx((0.488, 0.488, 0.2))
    assert (blocked.probability, blocked.low, blocked.high) == pytest.approx((0.488, 0.2, 0.488))
    assert (blocked.pieces, blocked.unverified) == (3, 3)


def test_a_row_of_three_that_block_two_at_a_time():
    """Two or more of three: 1 - 0.512 - 3 x 0.2 x 0.64 = 0.104; tied, all of them: 0.2. Any: 0.488."""
    found = one_segment(make_falls([0.2], quantity=[3]), [piece(0.5, 0.0, quantity=3)], NARROW)
    assert values(found.blocked) == pytest.approx((0.104, 0.104, 0.2))
    assert found.blocked.probability == pytest.approx(0.2)
    assert values(found.blocked_or_reduced) == pytest.approx((0.488, 0.488, 0.2))
    assert found.pieces[0].left_m == pytest.approx(1.1)
    assert not found.pieces[0].blocks_alone
    assert found.least_width_m == pytest.approx(0.6)


def test_a_verified_row_falls_as_one():
    """Three alike under the same motions do the same: both sides in every motion in which they fall, 1 of 10."""
    falls = make_falls([0.1], fell={0: FIRST}, quantity=[3])
    found = one_segment(falls, [piece(0.5, 0.0, quantity=3)], NARROW)
    assert found.blocked.probability == pytest.approx(0.1)
    assert found.blocked.independent == pytest.approx(1 - 0.9**3 - 3 * 0.1 * 0.81)
    assert (found.blocked.pieces, found.blocked.is_joint) == (3, True)


def test_a_row_of_one_never_faces_itself():
    """The side of one piece is not known, but it lies on one of them: 1.1 m are left, and nothing is blocked."""
    found = one_segment(make_falls([0.9]), [piece(0.5, 0.0)], NARROW)
    assert [found.blocked.high, found.least_width_m] == pytest.approx([0, 1.1])


def test_anchored_pieces_stand_beside():
    """An anchored piece that blocks alone in 2 of 10 motions: 0 with the anchor, 0.2 if it fails.

    With a free-standing one that does so in another motion of the ten: 0.1, and 0.3 if the anchor fails.
    """
    fell = {0: [True, True] + [False] * 8, 1: [False, False, True] + [False] * 7}
    alone = one_segment(make_falls([0.2], fell={0: fell[0]}, anchored=[True]), [piece(1.5, 0.0, anchored="yes")])
    assert (alone.blocked.probability, alone.blocked.high, alone.blocked.pieces) == (0, 0, 0)
    assert alone.blocked_if_anchors_fail.probability == pytest.approx(0.2)
    assert alone.most_likely_piece is None
    assert [alone.pieces[0].falls_while_blocked, alone.least_width_m] == pytest.approx([0.2, 1.8])
    falls = make_falls([0.2, 0.1], fell=fell, anchored=[True, False])
    both = evaluated(falls, [piece(1.5, 0.0, anchored="yes"), piece(1.5, 0.0)])
    segment, (route,) = both.segments[0], both.routes
    for outlook in (segment, route):
        assert outlook.blocked.probability == pytest.approx(0.1)
        assert outlook.blocked_if_anchors_fail.probability == pytest.approx(0.3)
        assert outlook.most_likely_piece.item_index == 1
    assert [one.item_index for one in segment.pieces] == [1, 0]
    assert [one.item_index for one in route.fixes] == [1]
    assert one_segment(make_falls([0.2]), [piece(1.5, 0.0)]).blocked_if_anchors_fail is None


def test_an_anchored_piece_that_faces_a_free_one():
    """1100 anchored faces 1010: with the anchor only 1.1 m is left at worst; if it fails, blocked in 1 of 4."""
    falls = told("1100", "1010", anchored=[True, False])
    found = one_segment(falls, PAIR, NARROW)
    assert [found.blocked.probability, found.blocked_if_anchors_fail.probability] == pytest.approx([0, 1 / 4])
    assert [found.blocked_or_reduced.probability, found.least_width_m] == pytest.approx([1 / 2, 1.1])


@pytest.mark.parametrize(("record", "state"), [
    ([1, 1], RouteState.BLOCKED), ([1, 0], RouteState.OPEN), ([0, 0], RouteState.OPEN),
    ([float("nan"), 1], RouteState.OPEN), ([float("nan")] * 2, None),
])  # fmt: skip
def test_under_the_record_itself(record, state):
    """Both fallen block, one does not; what is not known of stands. Blocked then is blocked, whatever the chances."""
    never = [False] * 300
    found = one_segment(make_falls([0.0, 0.0], fell={0: never, 1: never}, in_record=record), PAIR, NARROW)
    assert found.under_record is state
    assert found.state is (state or RouteState.OPEN)
