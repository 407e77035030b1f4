"""Ways out do not climb above both the room and the exits, where the floors' elevations tell, unless they must."""

from dataclasses import replace

from assess.model import Floor
from assess.routes.evaluate import evaluate_routes
from assess.routes.obstructions import find_obstructions
from assess.settings import Settings
from tests.routes.buildings import building, make_falls, place, stretch

PLACES = [place("Lobby", "room"), place("Street", "exit"), place("Yard", "exit"), place("Top", "stair", floor="9")]
OUT, UP, DOWN = (
    stretch("out", "Lobby", "Street"),
    stretch("up", "Lobby", "Top", floor=""),
    stretch("down", "Top", "Yard"),
)


def _ways(segments, elevations):
    held = building([], segments, PLACES)
    floors = tuple(Floor(row=2, floor=name, elevation=height) for name, height in elevations.items())
    held = replace(held, floors=floors)
    found = evaluate_routes(held, find_obstructions(held), make_falls([]), Settings(runs=200))
    return [[segments[at].segment for at in way.segment_indices] for way in found.rooms[0].ways]


def test_up_one_stair_and_down_the_other_is_no_way_out_where_there_is_another_and_heights_are_known():
    assert _ways([OUT, UP, replace(DOWN, floor="")], {"1": 0.0, "9": 30.0}) == [["out"]]
    assert _ways([UP, replace(DOWN, floor="")], {"1": 0.0, "9": 30.0}) == [["up", "down"]]
    either = _ways([OUT, UP, replace(DOWN, floor="")], {"1": None, "9": None})
    assert sorted(either) == [["out"], ["up", "down"]]
    assert _ways([UP, replace(DOWN, floor="")], {"1": 0.0, "9": -3.0}) == [["up", "down"]], "a basement climbs"
