"""Walls: known only where Routes names the Room that a segment runs through."""

import pytest

from assess.routes.reach import find_reached
from tests.routes.buildings import CORRIDOR, building, corridor, piece

ROOMS = [("", True), ("Corridor", False), ("corridor; OFFICE", True), ("Office", True)]


@pytest.mark.parametrize(("room", "reaches"), ROOMS)
def test_placed_pieces_of_other_rooms_do_not_reach_a_segment(room, reaches):
    cabinet = piece(2.0, x=5.0, y=1.5, angle_deg=90, width=0.8, room="Office")
    found = find_reached(building([cabinet], [corridor(room=room)], CORRIDOR))[0]
    assert bool(found.beside) is reaches
    assert ("own_rooms" if room else "walls_unknown") in found.flags


@pytest.mark.parametrize("given", [{"room": "Office", "route": "Way"}, {"room": ""}])
def test_a_piece_that_names_the_route_or_whose_room_is_blank_counts_all_the_same(given):
    cabinet = piece(2.0, x=5.0, y=1.5, angle_deg=90, width=0.8, **given)
    found = find_reached(building([cabinet], [corridor(room="Corridor")], CORRIDOR))[0]
    assert [one.item for one in found.beside] == [0]
