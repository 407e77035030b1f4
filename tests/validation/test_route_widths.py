"""Width left beside fallen pieces of one segment, by hand.

Where nothing else is said a corridor has 1.8 m clear and 0.9 m required, and a piece is verified under 20 motions.
"""

import math

import pytest

from assess.risk import RiskClass
from assess.route_results import RouteState
from tests.routes.buildings import CORRIDOR, corridor, evaluated, make_falls, one_segment, piece, place, stretch

THREE_OF_20 = make_falls([0.15], fell={0: [True] * 3 + [False] * 17})


@pytest.mark.parametrize(("height", "left", "state"), [
    (1.1, 1.0, RouteState.OPEN), (1.2, 0.9, RouteState.OPEN), (1.201, 0.899, RouteState.DOUBTFUL),
    (1.3, 0.8, RouteState.DOUBTFUL), (2.5, 0.0, RouteState.DOUBTFUL),
])  # fmt: skip
def test_one_piece_by_its_edge_distance(height, left, state):
    """1.8 m clear, piece 0.3 m from the edge: it lies Height - 0.3 m in, and 1.8 - (Height - 0.3) m are left.

    Height 1.1: 1.0 m left; 1.2: 0.9 m, just the required width, so open; 1.3: 0.8 m, blocked; 2.5 m would lie 2.2 m
    in, which is beyond the other wall: nothing is left. It falls in 3 of 20 motions, so the chance is 0.15 of whichever
    holds.

    Wilson, z = 1.96, z2 = 3.8415: centre (0.15 + 3.8415/40) / (1 + 3.8415/20) = 0.2064, half width
    1.96 sqrt(0.15 x 0.85/20 + 3.8415/1600) / 1.1921 = 0.1540: from 0.0524 to 0.3604.
    """
    found = one_segment(THREE_OF_20, [piece(height, 0.3)])
    assert found.pieces[0].left_m == pytest.approx(left)
    assert found.pieces[0].reach_m == pytest.approx(1.8 - left)
    assert found.least_width_m == pytest.approx(left)
    assert found.standing_width_m == 1.8
    assert found.state is state
    hit = found.blocked if state is RouteState.DOUBTFUL else found.blocked_or_reduced
    assert hit.probability == pytest.approx(0.15)
    assert (hit.low, hit.high) == pytest.approx((0.0524, 0.3604), abs=1e-4)
    assert (hit.runs, hit.pieces, hit.unverified, hit.is_joint) == (20, 1, 0, True)
    assert found.blocked_or_reduced.probability == pytest.approx(0.15)
    if state is RouteState.OPEN:
        blocked = found.blocked
        assert (blocked.probability, blocked.low, blocked.high) == (0, 0, 0)


@pytest.mark.parametrize("clear", [1.0 + 0.1 * at for at in range(15)])
@pytest.mark.parametrize("edge", [0.0, 0.1, 0.2, 0.3, 0.7])
def test_what_leaves_just_the_required_width_never_blocks(clear, edge):
    """Height = clear + edge - 0.9 leaves 0.9 m; 1 mm more leaves 0.899 m: decimals that are no binary numbers."""
    height = clear + edge - 0.9
    items = ([piece(one, edge)] for one in (height, height + 1e-3))
    just, more = (one_segment(THREE_OF_20, one, stretch(clear_width=clear)) for one in items)
    assert just.state is RouteState.OPEN
    assert not just.pieces[0].blocks_alone
    assert more.state is RouteState.DOUBTFUL
    assert more.pieces[0].blocks_alone


@pytest.mark.parametrize("height", [0.5, 1.2, 1.8])
def test_a_piece_that_cannot_reach_has_no_effect(height):
    """1.8 m from the edge, 1.8 m high or less: it lies at most at the edge. On the plan, chances are 0.

    They need no interval. Without a plan the same holds, as no piece of the floor is left out.
    """
    falls = make_falls([1.0], fell={0: [True] * 20})
    found = one_segment(falls, [piece(height, 1.8)], corridor())
    for chance in (found.blocked, found.blocked_or_reduced):
        assert (chance.probability, chance.low, chance.high, chance.pieces) == (0, 0, 0, 0)
    assert found.state is RouteState.OPEN
    assert found.least_width_m == 1.8
    without_plan = one_segment(falls, [piece(height, 1.8)])
    assert (without_plan.state, without_plan.blocked.high, without_plan.least_width_m) == (RouteState.OPEN, 0, 1.8)
    for one in (found, without_plan):
        assert (one.pieces, one.most_likely_piece) == ((), None)


@pytest.mark.parametrize("turned", [{"axis": "Y"}, {"angle_deg": 90.0}, {"angle_deg": -90.0}])
@pytest.mark.parametrize(("height", "left"), [(0.8, 1.0), (0.9, 0.9), (1.0, 0.8), (2.0, 0.0)])
def test_one_piece_by_the_plan(turned, height, left):
    """Corridor along X from (0, 0) to (10, 0): it lies between y = -0.9 and 0.9.

    A piece 0.4 m deep at (5, 1.1) stands between y = 0.9 and 1.3, against the edge. Fallen it reaches from 0.9 down to
    0.9 - Height: 1.8 - Height is left to the other wall (0.8 -> 1.0, 0.9 -> 0.9, 1.0 -> 0.8, 2.0 -> 0).
    """
    found = one_segment(THREE_OF_20, [piece(height, x=5.0, y=1.1, width=0.8, **turned)], corridor())
    (beside,) = found.pieces
    assert beside.by_plan
    assert beside.distance_m == pytest.approx(0, abs=1e-9)
    assert beside.left_m == pytest.approx(left, abs=1e-9)
    assert beside.flags == ()
    assert found.state is (RouteState.DOUBTFUL if left < 0.9 - 1e-6 else RouteState.OPEN)
    assert found.blocked.probability == pytest.approx(0.15 if left < 0.9 - 1e-6 else 0)
    assert found.length_m == 10


@pytest.mark.parametrize(("height", "reaches"), [(1.2, False), (1.25, True)])
def test_reach_by_the_plan(height, reaches):
    """At (5, 2.3) it stands from y = 2.1, 1.2 m from the edge at 0.9: 1.2 m high it touches that, 1.25 m is 0.05 in."""
    found = one_segment(THREE_OF_20, [piece(height, x=5.0, y=2.3, width=0.8, axis="Y")], corridor())
    assert [round(one.distance_m, 9) for one in found.pieces] == ([1.2] if reaches else [])
    assert found.least_width_m == pytest.approx(1.75 if reaches else 1.8)
    assert found.blocked_or_reduced.probability == pytest.approx(0.15 if reaches else 0)


def test_a_piece_that_falls_along_the_corridor_stays_out_of_it():
    """Beside the edge with Breadth along X: fallen it covers y = 0.9 to 1.3, all of it beside the corridor."""
    found = one_segment(THREE_OF_20, [piece(2.0, x=5.0, y=1.1, width=0.4, axis="X")], corridor())
    assert found.pieces == ()
    assert found.blocked_or_reduced.high == 0


def test_a_piece_of_unknown_direction_falls_any_way():
    """Neither Axis nor Angle: 0.4 m square, it may fall along Y, 1.0 m in: 0.8 m are left."""
    found = one_segment(THREE_OF_20, [piece(1.0, x=5.0, y=1.1)], corridor())
    assert found.pieces[0].flags == ("direction_unknown", "width_assumed")
    assert found.pieces[0].left_m == pytest.approx(0.8)
    assert found.blocked.probability == pytest.approx(0.15)


def test_a_piece_between_two_corridors_counts_in_both():
    """Two corridors along X, 1.2 m wide, with their centre lines at y = 1.5 and -1.5: inner edges at 0.9 and -0.9.

    A piece at (5, 0) stands between y = -0.2 and 0.2; 1.5 m high it reaches 1.7 either way, 0.8 m in: 0.4 m are left.
    Whichever way it falls is not known, so both are blocked in every motion in which it falls: 0.15 each, and the room
    that leaves by either loses both at 0.15.
    """
    places = [place("Room", "room", (0, 0))]
    for name, y in (("N", 1.5), ("S", -1.5)):
        places += [place(f"{name}0", "door", (0, y)), place(f"{name}1", "exit", (10, y))]
    segments = [
        *(stretch(name, f"{name}0", f"{name}1", clear_width=1.2) for name in "NS"),
        *(stretch(f"to {name}", "Room", f"{name}0", clear_width=1.2) for name in "NS"),
    ]
    found = evaluated(THREE_OF_20, [piece(1.5, x=5.0, y=0.0, width=0.8, axis="Y")], segments, places)
    assert [one.pieces[0].left_m for one in found.segments[:2]] == pytest.approx([0.4, 0.4])
    assert [one.blocked.probability for one in found.segments] == pytest.approx([0.15, 0.15, 0, 0])
    assert found.rooms[0].loses_every_exit.probability == pytest.approx(0.15)


@pytest.mark.parametrize(("aside", "left"), [(0.0, 0.25), (0.1, 0.35), (-0.1, 0.35), (0.4, 0.65), (0.25, 0.5)])
def test_a_door_with_a_piece_on_its_axis(aside, left):
    """A door 1.0 m wide and 0.3 m deep along X, from x = 0 to 0.3: it lies between y = -0.5 and 0.5.

    A piece 0.5 m wide and 0.4 m deep before it, centre at x = -0.5: it stands from x = -0.7 to -0.3 and falls to
    x = 0.7, through the door. On the axis 0.25 m are left on either side, too little for 0.6 m; moved by 0.1 m, 0.15 m
    and 0.35 m: what counts is the wider. Moved by 0.4 m it covers y = 0.15 to 0.5 of the door: 0.65 m are left.
    """
    door = stretch("door", "In", "Out", clear_width=1.0, required_width=0.6)
    places = [place("In", "room", (0, 0)), place("Out", "exit", (0.3, 0))]
    found = evaluated(THREE_OF_20, [piece(1.0, x=-0.5, y=aside, width=0.5, axis="X")], [door], places).segments[0]
    assert found.pieces[0].left_m == pytest.approx(left)
    assert found.state is (RouteState.DOUBTFUL if left < 0.6 else RouteState.OPEN)
    assert found.standing_width_m == 1.0


def test_a_blank_edge_distance_is_the_edge():
    """With no Edge distance the piece lies its whole Height in: 1.8 - 1.0 = 0.8 m left."""
    found = one_segment(THREE_OF_20, [piece(1.0)])
    assert found.pieces[0].flags == ("edge_assumed", "side_unknown")
    assert (found.pieces[0].distance_m, found.pieces[0].left_m) == pytest.approx((0, 0.8))
    assert found.blocked.probability == pytest.approx(0.15)


def test_widths_that_are_not_given():
    """Required width 0.9 m where it is blank, and the clear width as required: 5 cm into it is enough to block it."""
    found = one_segment(THREE_OF_20, [piece(0.55, 0.5)], stretch(clear_width=None, required_width=None))
    assert (found.clear_width_used_m, found.required_width_used_m, found.least_width_m) == pytest.approx(
        (0.9, 0.9, 0.85)
    )
    assert found.flags == ("clear_assumed", "required_assumed", "no_plan")
    assert found.blocked.probability == pytest.approx(0.15)


@pytest.mark.parametrize("positions", [False, True])
def test_a_piece_that_stands_inside(positions):
    """1.2 m clear. Standing 0.4 m inside leaves 0.8 m of the 0.9 m required: blocked as it stands, for certain.

    By the plan: corridor from y = -0.6 to 0.6, a piece 0.4 m deep at (5, 0.4) stands from y = 0.2 to 0.6.
    """
    item = piece(0.5, x=5.0, y=0.4, width=0.8, axis="Y") if positions else piece(0.5, -0.4)
    found = evaluated(THREE_OF_20, [item], [corridor(1.2)], CORRIDOR)
    segment, (route,), (room,) = found.segments[0], found.routes, found.rooms
    assert segment.standing_width_m == pytest.approx(0.8)
    assert segment.is_blocked_standing
    assert "standing_inside" in segment.pieces[0].flags
    assert segment.pieces[0].distance_m == pytest.approx(-0.4)
    for chance in (segment.blocked, route.blocked, room.loses_every_exit, room.ways[0].blocked):
        assert (chance.probability, chance.low, chance.high) == pytest.approx((1, 1, 1))
    assert segment.state is RouteState.BLOCKED
    assert (route.fixes, route.is_fixed) == ((), False)


def test_standing_inside_with_just_enough_left():
    """1.2 m clear, 0.3 m inside: 0.9 m are left standing, as required. 0.5 m high, fallen it lies 0.8 m in: 0.4 m."""
    found = one_segment(THREE_OF_20, [piece(0.5, -0.3)], stretch(clear_width=1.2))
    assert found.standing_width_m == pytest.approx(0.9)
    assert found.blocked.probability == pytest.approx(0.15)
    assert found.blocked_or_reduced.probability == pytest.approx(0.15)
    assert not found.is_blocked_standing


@pytest.mark.parametrize("runs", [1, 3, 49, 98, 103, 200, 1000])
def test_what_is_certain_is_exactly_one(runs):
    """A segment that is blocked as it stands is so in every motion, however many of them there are."""
    falls = make_falls([0.0], fell={0: [False] * runs})
    blocked = one_segment(falls, [piece(0.5, -0.4)], stretch(clear_width=1.2)).blocked
    assert (blocked.probability, blocked.low, blocked.high) == (1, 1, 1)


@pytest.mark.parametrize("runs", [100, 200, 300, 400, 1000, 2000, 3000, 5000])
def test_the_chosen_risk_itself_is_not_open(runs):
    """3 of 100 motions are 0.03, where the class medium begins: doubtful from there on, and to be fixed below it."""
    fell = [at < 3 * runs // 100 for at in range(runs)]
    found = evaluated(make_falls([0.03], fell={0: fell}), [piece(1.5, 0.0)], risk=0.03)
    (route,) = found.routes
    assert found.segments[0].blocked.risk is RiskClass.MEDIUM
    assert found.segments[0].state is route.state is RouteState.DOUBTFUL
    assert [one.item_index for one in route.fixes] == [0]


def test_too_narrow_for_those_who_leave_by_it():
    """IBC: 0.2 in = 5.08 mm a person: 200 need 1.016 m. 1.0 m is short with nothing fallen, 1.016 m is not.

    1.2 m clear with a piece that lies 0.3 m in: 0.9 m as required, so never blocked, but under 1.016 m once it falls.
    """
    short, just = (one_segment(THREE_OF_20, [], stretch(clear_width=one, occupants=200)) for one in (1.0, 1.016))
    assert short.needed_width_m == pytest.approx(1.016)
    assert (short.insufficient_for_occupants, just.insufficient_for_occupants) == (True, False)
    assert short.insufficient_after_falls.probability == 1
    assert just.insufficient_after_falls is None, "not evaluated: neither a plan nor a piece"
    found = one_segment(THREE_OF_20, [piece(0.4, 0.1)], stretch(clear_width=1.2, occupants=200))
    assert [found.blocked.probability, found.insufficient_after_falls.probability] == pytest.approx([0, 0.15])
    assert not found.insufficient_for_occupants
    assert one_segment(THREE_OF_20, [], stretch()).needed_width_m is None


def test_stairs_need_more():
    """0.3 in = 7.62 mm a person: 200 need 1.524 m on a flight, whose two ends are stairs."""
    places = [place("Upper", "stair", floor="2"), place("Lower", "stair"), place("Door", "exit")]
    segments = [stretch("flight", "Upper", "Lower", floor="", clear_width=1.5, occupants=200),
                stretch("hall", "Lower", "Door", clear_width=1.5, occupants=200)]  # fmt: skip
    flight, hall = evaluated(make_falls([]), [], segments, places).segments
    assert [flight.needed_width_m, hall.needed_width_m] == pytest.approx([1.524, 1.016])
    assert (flight.insufficient_for_occupants, hall.insufficient_for_occupants) == (True, False)


def test_turned_pieces_are_measured_where_they_lie():
    """A piece at 45 degrees, as wide as it is deep (0.4 m), centre at (5, 1.9), 1.6 m high.

    Its far edge is 0.2 + 1.6 = 1.8 m from the centre along the diagonal, and its corner 0.2 m aside of that:
    (1.8 + 0.2) / sqrt 2 = 1.4142 m down from y = 1.9, so 0.9 - 0.4858 = 0.4142 m in, and 1.3858 m are left.
    """
    found = one_segment(THREE_OF_20, [piece(1.6, x=5.0, y=1.9, width=0.4, angle_deg=45.0)], corridor())
    assert found.pieces[0].left_m == pytest.approx(1.8 - (0.9 - 1.9 + 2.0 / math.sqrt(2)))
