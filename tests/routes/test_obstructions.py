"""What reaches a segment: walls, which are known only where Routes names the Room, and what is not known at all."""

import pytest

from assess.routes.obstructions import find_obstructions
from tests.routes.buildings import CORRIDOR, building, corridor, evaluated, make_falls, piece, place, stretch

STAIRS = (place("Up", "stair", (0, 0), floor="2"), place("Down", "stair", (0, 0)))


def test_a_segment_that_neither_plan_nor_piece_tells_of_is_not_evaluated():
    flight = stretch("flight", "Up", "Down", floor="", route="Stair", clear_width=None)
    segments, items = [stretch("a"), stretch("b"), flight], [piece(1.5, 0.0), piece(1.5, x=5.0, y=5.0)]
    found = evaluated(make_falls([0.2, 0.2]), items, segments, STAIRS)
    assert [one.evaluated for one in found.segments] == [True, False, False]
    assert [one.flags for one in found.segments] == [
        ("no_plan",), ("no_plan",), ("stair_width_missing", "between_floors"),
    ]  # fmt: skip
    assert [(one.evaluated, one.unevaluated_segments) for one in found.routes] == [(True, ("b",)), (False, ("flight",))]


def test_a_plan_that_no_piece_reaches_is_evaluated_and_a_room_tells_which_segments_of_its_ways_are_not():
    found = evaluated(make_falls([0.5]), [piece(1.0, x=50.0, y=50.0)], [corridor()], CORRIDOR)
    assert found.segments[0].evaluated
    assert found.rooms[0].unevaluated_segments == ()
    places = [*STAIRS, place("Office", "room", floor="2"), place("Street", "exit")]
    flight = stretch("flight", "Up", "Down", floor="", clear_width=None)
    segments = [stretch("office", "Office", "Up", floor="2"), flight, stretch("hall", "Down", "Street")]
    found = evaluated(make_falls([0.2]), [piece(1.5, 0.0, segment="hall", route="Way")], segments, places)
    assert [room.unevaluated_segments for room in found.rooms] == [("office", "flight")]


def test_pieces_of_which_nothing_tells_are_counted_and_a_position_tells_nothing_without_a_plan():
    for items, uncounted in (
        ([piece(2.0, x=5.0, y=1.5, angle_deg=90)], 0),
        ([piece(2.0, 0.3)], 0),
        ([piece(2.0, x=None, y=None, quantity=6)], 6),
        ([piece(2.0, x=5.0, y=None), piece(2.0, x=5.0, y=8.0)], 1),
    ):
        found = evaluated(make_falls([0.5] * len(items)), items, [corridor()], CORRIDOR)
        assert [one.uncounted_pieces for one in found.floors] == [uncounted], items
    found = evaluated(make_falls([0.5]), [piece(2.0, x=5.0, y=1.5, quantity=1)], [stretch("a")])
    assert [one.uncounted_pieces for one in found.floors] == [1]


def test_a_piece_that_only_its_room_keeps_away_is_named():
    cabinet = piece(2.0, x=5.0, y=1.5, angle_deg=90, width=0.8, room="Coridor")
    far = piece(2.0, x=5.0, y=9.0, angle_deg=90, width=0.8, room="Office")
    found = find_obstructions(building([cabinet, far], [corridor(room="Corridor")], CORRIDOR))[0]
    assert (found.pieces, found.other_rooms) == ((), (0,))


def test_the_safest_way_is_not_the_one_of_which_nothing_is_known():
    places = [*CORRIDOR, place("Ladder", "exit")]
    found = evaluated(make_falls([]), [], [corridor(), stretch("rungs", "West", "Ladder")], places)
    assert [way.end for way in found.rooms[0].ways] == ["East", "Ladder"]


@pytest.mark.parametrize(
    ("room", "reaches"), [("", True), ("Corridor", False), ("corridor; OFFICE", True), ("Office", True)]
)
def test_placed_pieces_of_other_rooms_do_not_reach_a_segment(room, reaches):
    cabinet = piece(2.0, x=5.0, y=1.5, angle_deg=90, width=0.8, room="Office")
    found = find_obstructions(building([cabinet], [corridor(room=room)], CORRIDOR))[0]
    assert bool(found.pieces) is reaches
    assert ("own_rooms" if room else "walls_unknown") in found.flags


@pytest.mark.parametrize("given", [{"room": "Office", "route": "Way"}, {"room": ""}])
def test_a_piece_that_names_the_route_or_whose_room_is_blank_counts_all_the_same(given):
    cabinet = piece(2.0, x=5.0, y=1.5, angle_deg=90, width=0.8, **given)
    found = find_obstructions(building([cabinet], [corridor(room="Corridor")], CORRIDOR))[0]
    assert [one.item_index for one in found.pieces] == [0]
