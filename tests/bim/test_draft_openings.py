"""Openings without doors: where two rooms are next to each other with no wall between."""

from dataclasses import replace

from assess.bim.building_model import BuildingModel, Space, Storey
from assess.bim.draft_floor import build_plan, find_openings
from tests.bim.office_models import door, piece, rectangle, room

FAR_WALL = rectangle(-1, -1, -0.9, 5)
"""A storey has walls, at least somewhere."""


TWO = room("a", 0, 0, 4, 4), room("b", 4.2, 0, 8, 4)


def model(*walls, spaces=TWO, **more) -> BuildingModel:
    return BuildingModel(source="a.ifc", schema="IFC4", storeys=(Storey("0", "Level 0", 0.0, 0.0),), spaces=spaces,
                         walls={"0": (FAR_WALL, *walls)}, **more)  # fmt: skip


def find(found: BuildingModel) -> list[tuple[set[str], float, float, float]]:
    """Return the rooms of each opening, its centre and its width [m], to 10 cm."""
    links = find_openings(build_plan(found, found.storeys[0]), found.doors)
    return [(set(one.spaces), round(one.at[0], 1), round(one.at[1], 1), round(one.width, 1)) for one in links]


def walls_but(low: float, high: float, x: float = 4.0) -> list[object]:
    return [rectangle(x, -0.1, x + 0.2, low), rectangle(x, high, x + 0.2, 4.1)]


def test_a_gap_that_a_person_can_pass_is_an_opening_and_rooms_that_touch_are_open_to_each_other():
    for low, high, found in (
        (0.0, 4.0, [({"a", "b"}, 4.1, 2.0, 4.0)]), (1.0, 2.0, [({"a", "b"}, 4.1, 1.5, 1.0)]),
        (1.0, 1.7, [({"a", "b"}, 4.1, 1.4, 0.7)]), (1.0, 1.4, []), (4.0, 4.0, []),
    ):  # fmt: skip
        assert find(model(*walls_but(low, high))) == found, (low, high)
    to_the_middle = room("a", 0, 0, 4.1, 4), room("b", 4.1, 0, 8, 4)
    thin_wall, gap = rectangle(4.08, -0.1, 4.12, 4.1), walls_but(1.05, 1.95)
    assert find(model(rectangle(4.0, -0.1, 4.2, 4.1), spaces=to_the_middle)) == []
    assert find(model(thin_wall)) == []
    assert find(model(*walls_but(1.0, 2.0), windows={"0": (rectangle(4.05, 1.0, 4.15, 2.0),)})) == []
    assert find(model(*gap, doors=(door("d", 4.1, 1.5, 0.0),))) == []
    assert find(model(spaces=(room("a", 0, 0, 4, 4), room("b", 4.8, 0, 8, 4)))) == []
    assert find(replace(model(), walls={})) == [], "without walls nothing is known"
    touching = room("a", 0, 0, 4, 4), room("b", 4, 0, 8, 4)
    overlapping = room("a", 0, 0, 4.3, 4), room("b", 4, 0, 8, 4)
    assert find(model(spaces=touching)) == [({"a", "b"}, 4.0, 2.0, 4.0)]
    assert [one[0] for one in find(model(spaces=overlapping))] == [{"a", "b"}]
    hall = Space("a", "0", "a", "", (((0, 0), (8, 0), (8, 4), (4, 4), (4, 2), (0, 2)),), 0.0, 3.0)
    found = find(model(spaces=(hall, room("b", 0, 2, 4, 4))))
    assert {one[1:3] for one in found} == {(2.0, 2.0), (4.0, 3.0)}
    for y, width, part in ((1.2, 2.4, (3.2, 1.6)), (2.0, 4.2, (2.0, 4.0))):
        counter = piece("counter", 4.1, y, breadth=0.6, width=width, height=0.9, angle_deg=0.0)
        assert find(model(pieces=(counter,))) == [({"a", "b"}, 4.1, *part)]
