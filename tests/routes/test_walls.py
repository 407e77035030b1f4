"""Pieces against a wall: on which side it is, which way they fall, and which routes they then reach."""

from dataclasses import replace

import pytest

from assess.routes.obstructions import find_obstructions
from assess.routes.walls import (
    BOTH,
    CONTRARY,
    GAP,
    NO_OUTLINE,
    NO_WALL_NEAR,
    OUTSIDE,
    UNPLACED,
    find_walls,
    remark_on_walls,
)  # fmt: skip
from tests.routes.buildings import CORRIDOR, building, corridor, evaluated, make_falls, piece, place

OFFICE = ((0.0, 1.1), (8.0, 1.1), (8.0, 6.0), (0.0, 6.0))
"""A room on one side of the corridor of `CORRIDOR`: its wall to the corridor runs along X at y = 1.1."""


def room(outline=OFFICE, name="Office"):
    return replace(place(name, "room"), outline=outline)


def against(x, y, **more):
    """A cabinet, 0.4 m deep and 0.8 m wide, its Breadth along Y unless told otherwise."""
    given = {"angle_deg": 90, "width": 0.8, "against_wall": True, "room": "Office"} | more
    return piece(2.0, x=x, y=y, **given)


def wall(item, *places):
    return find_walls(building([item], [], places or (room(),)))[0]


def test_it_falls_away_from_the_side_of_its_room_that_it_stands_at():
    for x, y, angle, toward in (
        (4, 1.3, 90, 90),  # at the wall to the corridor: it falls into the office
        (4, 5.8, 90, 270), (0.2, 3, 0, 0), (7.8, 3, 0, 180),
        (4, 1.3, 270, 90),  # the same piece, its Breadth named the other way round
        (4, 1.3, 95, 95),  # not quite along the wall
        (4, 1.3 + GAP - 0.01, 90, 90),
    ):  # fmt: skip
        assert wall(against(x, y, angle_deg=angle)).falls_toward == pytest.approx(toward), (x, y, angle)
    by_axis = wall(against(4, 1.3, angle_deg=None, axis="Y"))
    assert by_axis.falls_toward == pytest.approx(90), "an axis gives the direction as well"


def test_where_the_side_is_not_known():
    narrow = room(((0, 1.1), (8, 1.1), (8, 1.9), (0, 1.9)))
    bent = room(((0, 1.1), (3.9, 1.1), (3.9, 0.5), (8, 0.5), (8, 6), (0, 6)))
    for item, own, reason in (
        (against(4, 3.5), (), NO_WALL_NEAR),
        (against(4, 1.3 + GAP + 0.01), (), NO_WALL_NEAR),
        (against(4, 1.3, angle_deg=0), (), NO_WALL_NEAR),  # its short side is at the wall
        (against(4, 1.3, angle_deg=60), (), NO_WALL_NEAR),
        (against(4, 0.8), (), OUTSIDE),
        (against(None, None), (), UNPLACED),
        (against(4, 1.3, angle_deg=None), (), UNPLACED),
        (against(4, 1.3, axis="X"), (), CONTRARY),
        (against(4, 1.5), (narrow,), BOTH),
        (against(4, 1.3), (bent,), NO_WALL_NEAR),  # a wall that is behind less than half of it
    ):
        found = wall(item, *own)
        assert (found.falls_toward, found.reason) == (None, reason), item
    assert wall(against(3.7, 1.3), bent).falls_toward == pytest.approx(90)


def test_pieces_that_are_not_against_a_wall_have_none_nor_is_one_known_without_any_outline():
    items = [against(4, 1.3, against_wall=one) for one in (False, None)]
    assert find_walls(building(items, [], [room()])) == {}
    assert wall(against(4, 1.3), place("Office", "room", (1, 1))).reason == NO_OUTLINE
    assert wall(against(4, 1.3), replace(room(), floor="2")).reason == NO_OUTLINE


def test_a_piece_without_a_room_takes_the_outline_round_it():
    other = room(((0, 6), (8, 6), (8, 9), (0, 9)), "Store")
    assert wall(against(4, 1.3, room=""), room(), other).falls_toward == pytest.approx(90)
    assert wall(against(4, 6.2, room="somewhere"), room(), other).falls_toward == pytest.approx(90)


def test_a_room_without_an_outline_takes_the_buildings_edge():
    """Outlines on both sides of a hall that has none: sides on the hull are outer walls, those inside it are not."""
    west, east = room(((0, 0), (4, 0), (4, 6), (0, 6)), "West"), room(((10, 0), (14, 0), (14, 6), (10, 6)), "East")
    hall = room(((4, 0), (10, 0), (10, 0.05), (4, 0.05)), "Plinth")
    assert wall(against(7, 0.3, room="Hall"), west, east).reason == NO_WALL_NEAR
    assert wall(against(7, 0.3, room="Hall"), west, east, hall).falls_toward == pytest.approx(90)
    assert wall(against(4.3, 3, angle_deg=0, room="Hall"), west, east).reason == NO_WALL_NEAR
    assert wall(against(7, -0.3, room="Hall"), west, east, hall).reason == OUTSIDE


def test_the_sense_along_an_axis():
    for toward, x, y in ((0, 1, 0), (180, -1, 0), (90, 0, 1), (265, 0, -1), (45, 1, 1), (135, -1, 1)):
        found = replace(wall(against(4, 1.3)), falls_toward=float(toward))
        assert (found.sense("X"), found.sense("Y")) == (x, y), toward
        assert replace(found, falls_toward=None).sense("X") == 0


# --- routes ---


def test_otherwise_it_does():
    """Not against a wall, on a side that is not known, or with the wall behind it and the corridor ahead."""
    for item, places, flag in (
        (against(4, 1.3), (), "wall_side_unknown"),
        (against(4, 1.3, against_wall=False), (room(),), None),
        (against(4, 1.3, against_wall=None), (room(),), None),
        (against(4, 1.3), (room(((0, 0.5), (8, 0.5), (8, 1.6), (0, 1.6))),), "falls_from_wall"),
    ):
        (one,) = find_obstructions(building([item], [corridor()], (*CORRIDOR, *places)))[0].pieces
        assert one.reach_m == pytest.approx(0.9 + 0.9)
        assert {"falls_from_wall", "wall_side_unknown"} & {*one.flags} == ({flag} if flag else set()), item


def test_the_chance_of_a_blocked_corridor():
    """What a wall tells is the way of the fall alone: where it leads into the corridor, the chance is the piece's."""
    into, away, free = against(4, 1.3), against(4, 1.3), against(4, 1.3, against_wall=None)
    ahead = room(((0, 0.5), (8, 0.5), (8, 1.6), (0, 1.6)))
    found = [
        evaluated(make_falls([0.4]), [one], [corridor()], (*CORRIDOR, *places)).segments[0].blocked.probability
        for one, places in ((into, (ahead,)), (away, (room(),)), (free, (room(),)))
    ]
    assert found == [0.4, 0.0, 0.4]


def test_a_piece_placed_by_its_edge_distance_reaches_it_all_the_same():
    named = piece(2.0, 0.3, against_wall=True)
    assert find_obstructions(building([named], [corridor()], CORRIDOR))[0].pieces


# --- problems ---


def test_unknown_sides_are_noted_once_a_reason():
    items = [against(4, 1.3), against(4, 3.5), against(3, 3.5), against(None, None)]
    inventory = replace(building(items, [], [room()]), letters={"Items": {"against_wall": "R"}})
    one, many = sorted(remark_on_walls(inventory), key=lambda problem: "rows" in problem.message)
    assert {one.severity, many.severity} == {"note"}
    assert (one.sheet, one.cell, many.cell) == ("Items", "R2", "R2")
    assert one.message.startswith("'P3' stands against a wall, but which way it falls is not known, as its position")
    assert many.message.startswith("2 rows stand against a wall")
    assert "P1, P2" in many.message
    assert "within 0.30 m" in many.message
    assert "Outline of the room in Places" in one.fix
