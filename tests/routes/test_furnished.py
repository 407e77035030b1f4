"""In which rooms furniture is listed, and what a building in which none is says of its routes."""

from dataclasses import replace

import pytest

from assess.report.say.route import say_reservations
from assess.route_results import RouteState
from assess.routes.evaluate import find_unfurnished, list_unfurnished
from tests.routes.buildings import CORRIDOR, building, corridor, evaluated, make_falls, piece, place, stretch

ROOMS = (place("101 Office", "room", (0, 0)), place("102 Store", "room", (5, 0)), place("Hall", "corridor", (9, 0)),
         place("Door", "door", (2, 0)), place("Street", "exit", (12, 0)))  # fmt: skip
SQUARE = ((4.0, -1.0), (6.0, -1.0), (6.0, 1.0), (4.0, 1.0))


def names(items, places=ROOMS, segments=()):
    return [one.place for one in list_unfurnished(building(items, segments, places))]


def test_by_the_name_of_the_room_its_segments_or_its_outline():
    assert names([piece(1.0, room="101 office", x=0.0, y=0.0)]) == ["102 Store", "Hall"]
    elsewhere = piece(1.0, room="101 Office", floor="2", x=0.0, y=0.0)
    assert names([elsewhere]) == ["101 Office", "102 Store", "Hall"], "of another floor"
    # places may have names of their own: the Room of Routes joins them to those of Items
    segments = [stretch("a", "101 Office", "Door", room="Office"), stretch("b", "102 Store", "Door", room="102 Store")]
    items = [piece(1.0, room="Office", x=0.0, y=0.0)]
    assert names(items, segments=segments) == ["102 Store", "Hall"]
    outlined = (ROOMS[0], replace(ROOMS[1], outline=SQUARE), *ROOMS[2:])
    assert names([piece(1.0, x=5.0, y=0.5)], outlined) == ["101 Office", "Hall"]
    assert names([piece(1.0, x=5.0, y=0.5, floor="2")], outlined) == ["101 Office", "102 Store", "Hall"]


def test_a_row_of_which_nothing_tells_the_room_may_stand_in_any_and_a_warning_comes_once_a_workbook():
    assert names([piece(1.0, 0.5)]) == ["102 Store", "Hall"]
    assert names([piece(1.0, 0.5)] * 3) == []
    (problem,) = find_unfurnished(building([piece(1.0, room="101 Office", x=0.0, y=0.0)], [], ROOMS))
    assert (problem.severity, problem.sheet, problem.cell) == ("warning", "Places", "A2")
    assert "in 1 of 3 rooms and corridors of Places, not in 102 Store" in str(problem.message)
    assert not list(find_unfurnished(building([piece(1.0, 0.5)] * 3, [], ROOMS)))


@pytest.mark.parametrize(("name", "said"), [("Way", 0), ("Way (draft)", 1), ("Via (bozza)", 1)])
def test_drafts_and_rooms_without_furniture_are_in_words(name, said):
    own = [stretch("a", "West", "East", route=name), stretch("b", "West", "East", route="Walked")]
    found = evaluated(make_falls([0.0]), [piece(1.0, x=50.0, y=50.0, room="Attic")], own, CORRIDOR)
    *drafts, furniture = say_reservations(found)
    assert drafts == ["1 of 2 routes is a draft from a building model that nobody has walked yet."] * said
    said_of_rooms = "No furniture is listed in the only room or corridor: ways through it count as free of furniture."
    assert furniture == said_of_rooms


def test_where_all_rooms_have_furniture_nothing_is_said():
    assert say_reservations(evaluated(make_falls([0.0]), [piece(1.0, room="West", x=9.0, y=9.0)], [corridor()],
                                      CORRIDOR)) == []  # fmt: skip


def test_without_any_furniture_no_way_through_a_room_is_known_but_stairs_and_what_is_blocked_as_it_stands():
    found = evaluated(make_falls([]), [], [corridor()], CORRIDOR)
    assert [one.state for one in (found.segments[0], found.routes[0], found.rooms[0])] == [RouteState.NOT_KNOWN] * 3
    assert [(row.what, row.cells) for row in found.routes[0].missing] == [("furniture", ("Items!A2",))]
    assert not found.segments[0].evaluated
    said = "No furniture is listed, so whether ways through rooms stay open is not known."
    assert say_reservations(found) == [said]
    flight = stretch("flight", "Up", "Down", floor="", clear_width=1.2)
    ends = (place("Up", "stair", floor="2"), place("Down", "stair"))
    assert evaluated(make_falls([]), [], [flight], ends).routes[0].state is RouteState.OPEN
    assert evaluated(make_falls([]), [], [corridor(0.8)], CORRIDOR).routes[0].state is RouteState.BLOCKED
