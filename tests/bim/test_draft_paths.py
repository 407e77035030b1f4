"""Ways inside one room: round walls and furniture, along the middle of corridors."""

import networkx as nx
import pytest
from shapely import LineString, MultiPolygon, Polygon, box

from assess.bim.building_model import Space, Storey
from assess.bim.draft_floor import FloorPlan, Link, Room, build_rooms
from assess.bim.draft_paths import Ways, find_ways, is_corridor, measure_width
from assess.bim.plan_shapes import find_width

STOREY = Storey("0", "Level 0", 0.0, 0.0)


def link(name: str, x: float, y: float, normal: tuple[float, float] = (0.0, 1.0)) -> Link:
    return Link(name, (x, y), normal, 0.9, 0.8, ("a",), 0.9)


def build(area: Polygon, *links: Link, solids: tuple[Polygon, ...] = (), pieces: tuple[Polygon, ...] = ()) -> Room:
    plan = FloorPlan(STOREY, (Space("a", "0", "a", "", (), 0.0, 3.0),), (area,), solids, pieces)
    return build_rooms(plan, links)["a"]


def follow(ways: Ways, start: str, end: str) -> LineString:
    """Return the cheapest way between two nodes."""
    graph = nx.Graph(ways.found)
    return LineString([ways.at(name) for name in nx.dijkstra_path(graph, start, end, weight="cost")])


def test_a_way_goes_round_walls_and_furniture_or_through_it_where_it_must():
    for pieces, least, most in (
        ((box(0, 2, 2.6, 3), box(3.4, 2, 6, 3)), 0.35, 0.45),  # 0.8 m between them
        ((box(0, 2, 6, 3),), 0.0, 0.01),  # no other way: what stands in it is for the assessment to find
    ):
        room = build(box(0, 0, 6, 5), link("one", 3.0, -0.05), link("two", 3.0, 5.05), pieces=pieces)
        way = follow(find_ways(room, "room a", (1.0, 1.0)), "one", "two")
        assert least <= way.distance(MultiPolygon(pieces)) < most, (pieces, least)
    room = build(box(0, 0, 8, 5), link("one", 0.6, -0.2), link("two", 7.4, -0.2))
    way = follow(find_ways(room, "room a", (4.0, 2.5)), "one", "two")
    openings = [box(x - 0.45, -0.4, x + 0.45, 0) for x in (0.6, 7.4)]
    assert MultiPolygon([box(0, 0, 8, 5), *openings]).buffer(0.01).covers(way)
    wall = box(0, 2.4, 4.5, 2.6)
    room = build(box(0, 0, 6, 5), link("one", 1.0, -0.05), link("two", 1.0, 5.05), solids=(wall,))
    way = follow(find_ways(room, "room a", (3.0, 1.0)), "one", "two")
    assert way.distance(wall) >= 0.45
    table = box(1.5, 2, 4.5, 3)
    room = build(box(0, 0, 6, 5), link("one", 3.0, -0.05), link("two", 3.0, 5.05), pieces=(table,))
    way = follow(find_ways(room, "room a", (0.8, 1.0)), "one", "two")
    assert way.distance(table) >= 0.45
    assert 5.1 < way.length < 8
    room = build(box(0, 0, 6, 5), link("one", 1.0, -0.05), link("two", 1.0, 5.05), solids=(box(-1, 2.4, 7, 2.6),))
    ways = find_ways(room, "room a", (3.0, 1.0))
    graph = nx.Graph(ways.found)
    assert nx.has_path(graph, "one", "room a")
    assert "two" not in graph or not nx.has_path(graph, "one", "two")


BAR, ELL = box(0, 0, 20, 1.8), box(0, 0, 20, 1.8).union(box(18.2, 0, 20, 12))
TEE = box(0, 0, 20, 1.8).union(box(9.1, 1.8, 10.9, 12))
RING = box(0, 0, 20, 16).difference(box(1.8, 1.8, 18.2, 14.2))


def test_corridors_are_long_and_narrow_and_columns_and_niches_change_their_free_width():
    for area, width in (
        (BAR, 1.8), (ELL, 1.8), (TEE, 1.8), (box(0, 0, 30, 4), 4.0), (box(0, 0, 60, 2).union(box(30, 2, 31, 2.4)), 2.0),
        (box(0, 0, 6, 4), 0.0), (box(0, 0, 9, 4), 0.0), (box(0, 0, 12, 6), 0.0), (box(0, 0, 12, 0.4), 0.0),
        (box(0, 0, 90, 8), 0.0),
    ):  # fmt: skip
        assert find_width(area) == pytest.approx(width, abs=0.12), (area, width)
        one, other = link("one", area.bounds[0] + 1.0, -0.05), link("two", area.bounds[2] - 1.0, -0.05)
        assert not is_corridor(build(area, one)), "a store"
        assert is_corridor(build(area, one, other)) == (width > 0), (area, width)
    column = box(9.8, 0, 10.2, 0.3)
    floor = BAR.difference(column).union(box(4, 1.8, 5, 2.4))
    assert measure_width(1.8, ((8.0, 0.9), (12.0, 0.9)), floor) == pytest.approx(1.2, abs=0.01)
    assert measure_width(1.8, ((2.0, 0.9), (8.0, 0.9)), floor) == pytest.approx(1.8, abs=0.01)


@pytest.mark.parametrize("area", [BAR, ELL, TEE, RING], ids=["straight", "bent", "branching", "round"])
def test_ways_in_a_corridor_run_in_its_middle(area):
    doors = [link(f"door {x}", x, -0.05) for x in (2.0, 5.0, 8.0, 13.0, 16.0)]
    ways = find_ways(build(area, *doors), "room a", (10.0, 0.9))
    way = follow(ways, "door 2.0", "door 16.0")
    assert {round(y, 2) for _, y in way.coords} == {-0.05, 0.9}
    assert any(way["width"] == pytest.approx(1.8) for *_, way in ways.found)
