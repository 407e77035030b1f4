"""The plan of a storey: where rooms are entered in it."""

import pytest
from shapely import MultiPoint, Point

from assess.bim.building_model import BuildingModel, Space, Storey
from assess.bim.draft_floor import APART, build_plan, build_rooms, find_room_points
from tests.bim.office_models import door, piece, rectangle

STOREY = Storey("0", "Level 0", 0.0, 0.0)


def model(*spaces: Space, **more: object) -> BuildingModel:
    return BuildingModel(source="a.ifc", schema="IFC4", storeys=(STOREY,), spaces=spaces, **more)


def test_each_room_is_entered_in_its_free_floor(published):
    points = find_room_points(published)
    assert points.keys() == {space.key for space in published.spaces}
    for storey in published.storeys:
        points_of = [(one.x, one.y) for one in published.doors if one.storey == storey.key]
        points_of += [(one.x, one.y) for one in published.stairs if one.storey == storey.key]
        taken = MultiPoint(points_of)
        for key, room in build_rooms(build_plan(published, storey), ()).items():
            at = Point(points[key])
            assert room.free.buffer(0.01).covers(at), room.space.name
            assert taken.is_empty or at.distance(taken) > APART - 0.02, room.space.name


def test_a_place_is_in_the_middle_of_the_widest_free_floor_off_doors_and_in_full_rooms_too():
    desk = piece("desk", 2.0, 2.0, breadth=4.0, width=4.0, height=0.75)
    lamp = piece("lamp", 6.0, 2.0, breadth=1.0, width=1.0, bottom=1.0)
    mat = piece("mat", 6.0, 2.0, breadth=3.0, width=3.0, height=0.05)
    (x, y) = find_room_points(
        model(Space("a", "0", "a", "", rectangle(0, 0, 8, 4), 0.0, 3.0), pieces=(desk, lamp, mat))
    )["a"]
    assert (x, y) == pytest.approx((6.0, 2.0), abs=0.1)
    # Half the width from either wall, though the middle is looked for less exactly than that.
    corridor = Space("a", "0", "a", "", rectangle(0, 0, 40, 1.7), 0.0, 3.0)
    assert find_room_points(model(corridor))["a"][1] == pytest.approx(0.85, abs=0.011)
    line = Space("line", "0", "", "", (((0.0, 0.0), (4.0, 0.0), (2.0, 0.0)),), 0.0, 3.0)
    full = Space("full", "0", "", "", rectangle(0, 0, 2, 2), 0.0, 3.0)
    points = find_room_points(model(line, full, pieces=(piece("p", 1.0, 1.0, breadth=3.0, width=3.0),)))
    assert points["line"] == (0.0, 0.0)
    assert points["full"] == pytest.approx((1.0, 1.0), abs=0.1)
    closet = Space("a", "0", "", "", rectangle(0, 0, 1, 1), 0.0, 3.0)
    x, y = find_room_points(model(closet, doors=(door("d", 0.5, 0.5),)))["a"]
    assert Point(x, y).distance(Point(0.5, 0.5)) >= APART - 0.02
