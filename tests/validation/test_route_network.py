"""Routes, rooms and exits, by hand: every piece is 1.5 m high at the edge of 1.8 m clear, and blocks that alone."""

import pytest

from assess.route_results import RouteState
from tests.routes.buildings import corridor, evaluated, make_falls, one_segment, piece, place, stretch, told, values

LOOP = (place("Room", "room"), place("West exit", "exit"), place("East exit", "exit"))
SIDES = (stretch("west", "Room", "West exit"), stretch("east", "Room", "East exit"))


def beside(*segments, **more):
    """Return a piece beside each of these segments."""
    return [piece(1.5, 0.0, route="Way", segment=one, **more) for one in segments]


def test_a_loop_with_two_exits():
    """West is blocked in motions 1, 2, 3 of ten, east in 3 and 4: both in one of ten. East is the safer way out.

    Independently 0.3 x 0.2 = 0.06, fully tied 0.2. The route serves the room by either, so it is blocked like it.
    """
    found = evaluated(told("1110000000", "0011000000"), beside("west", "east"), SIDES, LOOP)
    (room,), (route,) = found.rooms, found.routes
    assert [one.blocked.probability for one in found.segments] == pytest.approx([0.3, 0.2])
    for chance in (room.loses_every_exit, route.blocked):
        assert values(chance) == pytest.approx((0.1, 0.06, 0.2))
        assert chance.probability == pytest.approx(0.1)
        assert (chance.is_joint, chance.runs) == (True, 10)
    assert (room.exits, room.by_stairs) == (("East exit", "West exit"), False)
    assert [(way.segment_indices, way.end) for way in room.ways] == [((1,), "East exit"), ((0,), "West exit")]
    assert [way.blocked.probability for way in room.ways] == pytest.approx([0.2, 0.3])
    assert [found.cut_off_rooms_expected, found.blocked_routes_expected] == pytest.approx([0.1, 0.1])
    (floor,) = found.floors
    assert (floor.segments, floor.routes, floor.rooms) == (2, 1, 1)
    assert (
        floor.blocked_segments_expected,
        floor.blocked_routes_expected,
        floor.cut_off_rooms_expected,
    ) == pytest.approx((0.5, 0.1, 0.1))
    assert floor.any_room_cut_off.probability == pytest.approx(0.1)


@pytest.mark.parametrize(("west", "east", "lost"), [("1100", "0011", 0), ("1100", "1100", 0.5), ("1100", "0000", 0)])
def test_one_exit_is_kept_while_the_other_side_is_blocked(west, east, lost):
    """Never in the same motion: an exit is always left. Always in the same: both are lost as often as one."""
    (room,) = evaluated(told(west, east), beside("west", "east"), SIDES, LOOP).rooms
    assert room.loses_every_exit.probability == pytest.approx(lost)


def test_two_exits_that_are_not_verified():
    """0.3 and 0.2: both independently 0.06, tied 0.2: the largest is told, from 0.06."""
    (room,) = evaluated(make_falls([0.3, 0.2]), beside("west", "east"), SIDES, LOOP).rooms
    assert (room.loses_every_exit.probability, room.loses_every_exit.low, room.loses_every_exit.high) == pytest.approx(
        (0.2, 0.06, 0.2)
    )


def test_a_ring_with_a_rung():
    """Room-A-Exit 1 on the left, Room-B-Exit 2 on the right, and a rung from A to B.

    Motion 1: both exits' segments (a2, b2): lost. 2: a2 and b1 are blocked, out by A, the rung and B: kept. 3: a1 and
    b1: lost. 4: a2, b1 and the rung: lost. 5 to 8: nothing. So 3 of 8. Each piece: a1 1, a2 3, b1 3, b2 1, rung 1 of 8.
    Ways: a1, a2 and b1, b2 are 1 - 5/8 x 7/8 = 0.453 taken independently; a1, rung, b2 is 1 - (7/8)^3 = 0.33, safer.
    """
    places = [place("Room", "room"), place("A"), place("B"), place("Exit 1", "exit"), place("Exit 2", "exit")]
    segments = [stretch("a1", "Room", "A"), stretch("a2", "A", "Exit 1"), stretch("b1", "Room", "B"),
                stretch("b2", "B", "Exit 2"), stretch("rung", "A", "B")]  # fmt: skip
    falls = told("00100000", "11010000", "01110000", "10000000", "00010000")
    found = evaluated(falls, beside("a1", "a2", "b1", "b2", "rung"), segments, places)
    (room,) = found.rooms
    assert room.loses_every_exit.joint == pytest.approx(3 / 8)
    assert room.exits == ("Exit 1", "Exit 2")
    assert room.ways[0].segment_indices == (0, 4, 3)
    assert room.ways[0].end == "Exit 2"
    assert room.ways[0].blocked.probability == pytest.approx(3 / 8)  # motions 1, 3 and 4


def test_the_safest_way_is_the_first():
    """Left: two segments whose pieces fall together, in 1 and 2 of ten: 0.2 in all. Right: one segment, 3 of ten: 0.3.

    Taken independently the left would be 1 - 0.8 x 0.8 = 0.36; the motions tell that it is the safer.
    """
    places = [place("Room", "room"), place("Bend"), place("Left", "exit"), place("Right", "exit")]
    segments = [stretch("l1", "Room", "Bend"), stretch("l2", "Bend", "Left"), stretch("r", "Room", "Right")]
    falls = told("1100000000", "1100000000", "0011100000")
    (room,) = evaluated(falls, beside("l1", "l2", "r"), segments, places).rooms
    assert sorted(way.blocked.probability for way in room.ways) == pytest.approx([0.2, 0.3])
    assert [way.end for way in room.ways] == ["Left", "Right"]


def test_without_an_exit_the_stairs_count():
    """A floor whose routes end at its stairs: they count as exits, and it is said that they are stairs."""
    places = [place("Room", "room"), place("Stair 1", "stair"), place("Stair 2", "stair")]
    segments = [stretch("west", "Room", "Stair 1"), stretch("east", "Room", "Stair 2")]
    (room,) = evaluated(told("1100", "1010"), beside("west", "east"), segments, places).rooms
    assert (room.exits, room.by_stairs) == (("Stair 1", "Stair 2"), True)
    assert room.loses_every_exit.probability == pytest.approx(1 / 4)


def test_over_the_stairs_to_the_ground():
    """Room on 2, two stairs, but one flight each to the hall on 1 and its one exit: the hall's door decides alone.

    West is blocked in motion 1 and 2, east in 1 and 3, the hall's door in 4 of eight: lost in 1 and 4: 2/8.
    """
    places = [place("Room", "room", floor="2"), place("U1", "stair", floor="2"), place("U2", "stair", floor="2"),
              place("L1", "stair"), place("L2", "stair"), place("Hall"), place("Door", "exit")]  # fmt: skip
    segments = [
        stretch("west", "Room", "U1", floor="2"), stretch("east", "Room", "U2", floor="2"),
        stretch("flight 1", "U1", "L1", floor=""), stretch("flight 2", "U2", "L2", floor=""),
        stretch("hall 1", "L1", "Hall"), stretch("hall 2", "L2", "Hall"), stretch("door", "Hall", "Door"),
    ]  # fmt: skip
    items = [*beside("west", "east", floor="2"), *beside("door")]
    found = evaluated(told("11000000", "10100000", "00010000"), items, segments, places)
    (room,) = found.rooms
    assert (room.exits, room.by_stairs) == (("Door",), False)
    assert room.loses_every_exit.probability == pytest.approx(2 / 8)
    assert [len(way.segment_indices) for way in room.ways] == [4, 4]
    assert [way.shared for way in room.ways] == [(), ("door",)], "both go out by the door"
    assert found.routes[0].blocked.probability == pytest.approx(2 / 8)
    assert found.routes[0].floors == ("2", "1")
    upper, lower = found.floors
    assert (upper.segments, upper.rooms, lower.segments, lower.rooms) == (2, 1, 3, 0)
    assert (upper.blocked_segments_expected, upper.blocked_routes_expected) == pytest.approx((4 / 8, 1 / 8))
    assert (lower.blocked_segments_expected, lower.blocked_routes_expected) == pytest.approx((1 / 8, 1 / 8))
    assert upper.any_room_cut_off.probability == pytest.approx(2 / 8)
    assert lower.any_room_cut_off is None


def test_two_rooms_of_a_floor():
    """Each has a door of its own and both the corridor. Doors: motions 1 and 2 of ten, corridor: 3. Any room: 0.3."""
    places = [place("One", "room"), place("Two", "room"), place("Hall"), place("Exit", "exit")]
    segments = [stretch("one", "One", "Hall"), stretch("two", "Two", "Hall"), stretch("out", "Hall", "Exit")]
    falls = told("1000000000", "0100000000", "0010000000")
    found = evaluated(falls, beside("one", "two", "out"), segments, places)
    assert [room.loses_every_exit.probability for room in found.rooms] == pytest.approx([0.2, 0.2])
    assert found.cut_off_rooms_expected == pytest.approx(0.4)
    assert found.floors[0].any_room_cut_off.probability == pytest.approx(0.3)
    assert [room.most_likely_piece.item_index for room in found.rooms] == [0, 1]


@pytest.mark.parametrize("named", [True, False])
def test_a_chain_is_blocked_by_any_of_its_segments(named):
    """A in motion 1, B in 2 of four, C never: 2/4; independently 1 - 3/4 x 3/4 = 7/16. Places may be blank."""
    ends = [("Room", "a"), ("a", "b"), ("b", "Exit")] if named else [("", "")] * 3
    segments = [stretch(name, *pair) for name, pair in zip("ABC", ends, strict=True)]
    places = [place("Room", "room"), place("a"), place("b"), place("Exit", "exit")] if named else []
    (route,) = evaluated(told("1000", "0100", "0000"), beside(*"ABC"), segments, places).routes
    assert values(route.blocked) == pytest.approx((1 / 2, 7 / 16, 1 / 4))
    assert route.segment_indices == (0, 1, 2)


def test_two_branches_are_blocked_only_together():
    """Start to exit by either of two branches: 1100 and 1010, both in one of four; taken whenever either falls: 3/4."""
    places = [place("Start", "room"), place("Exit", "exit")]
    segments = [stretch(name, "Start", "Exit") for name in ("left", "right")]
    found = evaluated(told("1100", "1010"), beside("left", "right"), segments, places)
    (route,), (room,) = found.routes, found.rooms
    assert route.blocked.probability == room.loses_every_exit.probability == pytest.approx(1 / 4)
    assert route.blocked_or_reduced.probability == pytest.approx(3 / 4)
    assert len(room.ways) == 2


@pytest.mark.parametrize("kinds", [("room", "exit"), ("stair", "exit"), ("door", "door"), ("", ""), ("exit", "exit")])
def test_a_route_of_one_segment_is_blocked_like_it(kinds):
    """Whatever its two places are, be they two exits: there is no other way along it."""
    places = [place("One", kinds[0]), place("Other", kinds[1])]
    found = evaluated(told("1100"), beside("a"), [stretch("a", "One", "Other")], places)
    assert found.segments[0].blocked.probability == pytest.approx(1 / 2)
    assert found.routes[0].blocked.probability == pytest.approx(1 / 2)
    assert found.routes[0].state is RouteState.BLOCKED


def test_a_piece_of_a_whole_route():
    """A blank Segment: every segment of that route on the piece's floor. It falls on all of them at once, so 0.2."""
    segments = [stretch("a"), stretch("b"), stretch("c", floor="2"), stretch("a", route="Other")]
    found = evaluated(make_falls([0.2]), [piece(1.5, 0.0, route="Way", segment="")], segments)
    assert [one.blocked and one.blocked.probability for one in found.segments] == [0.2, 0.2, None, 0.0]
    assert [one.blocked and one.blocked.probability for one in found.routes] == [0.2, 0.0]
    assert "segment_assumed" in found.segments[0].pieces[0].flags


@pytest.mark.parametrize(
    ("own", "counts"), [("Hall", True), ("hall ", True), ("Archive", True), ("Office", False), ("", True)]
)
@pytest.mark.parametrize("named", [True, False])
def test_walls_keep_pieces_of_other_rooms_away(own, counts, named):
    """Through the hall and the archive: a placed piece of the office counts only where it names the segment."""
    item = piece(1.5, x=5.0, y=1.1, width=0.8, axis="Y", room=own, route="Way" if named else "")
    found = one_segment(told("1100"), [item], corridor(room="Hall; Archive"))
    assert found.blocked.probability == pytest.approx(0.5 if counts or named else 0)
    assert found.flags == ("own_rooms",)


def test_a_corridor_goes_on_round_a_bend():
    """Along X to (10, 0), then along Y: both 2 m wide, so each goes on by 1 m, and the square of the bend is of both.

    A piece at (10.5, 1.7), 0.4 m deep along X, stands from x = 10.3 to 10.7 and y = 1.3 to 2.1: in the second alone.
    One at (10.5, 0.5) stands in both: of the first (y from -1 to 1) it covers y = 0.1 to 0.9, 1.1 m and 0.1 m are left;
    of the second (x from 9 to 11) x = 10.3 to 10.7: 1.3 m and 0.3 m.
    """
    places = [place("A", "room", (0, 0)), place("B", "", (10, 0)), place("C", "exit", (10, 8))]
    segments = [stretch("one", "A", "B", clear_width=2.0), stretch("two", "B", "C", clear_width=2.0)]
    for y, left in ((1.7, [2.0, 1.3]), (0.5, [1.1, 1.3])):
        item = piece(0.1, x=10.5, y=y, width=0.8, axis="X")
        found = evaluated(make_falls([0.0]), [item], segments, places)
        assert [one.standing_width_m for one in found.segments] == pytest.approx(left)
