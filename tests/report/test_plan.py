"""The plan of a floor: geometry in metres, and the drawing made of it."""

import itertools
import re

import pytest

import assess
from assess.report.figures.labels import bounds, overlap
from assess.routes.geometry import fallen, rectangle
from tests.report.reading import plans_of, render
from tests.workbooks import FLOORS, UNVERIFIED, write_sheets

PIECES = [
    {"item": "A1", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 2.0, "y": 3.0, "angle_deg": 90},
    {"item": "A2", "floor": "1", "breadth": 40, "width": 90, "height": 180, "x": 5.0, "y": 3.0, "angle_deg": 30,
     "anchored": "yes"},
    {"item": "A3", "floor": "1", "breadth": 90, "width": 90, "height": 92, "x": 5.0, "y": 8.0, "axis": "Y"},
    {"item": "A4", "floor": "1", "breadth": 60, "width": 60, "height": 200},
    {"item": "<b>B1 & co</b>", "floor": "2", "description": "<script>", "breadth": 40, "height": 180, "x": 1.0,
     "y": 1.0, "axis": "Y"},
]  # fmt: skip
PLACES = [
    {"place": "Hall", "floor": "1", "x": 1.0, "y": 1.0},
    {"place": "Stair <2>", "floor": "1", "x": 6.0, "y": 1.0},
    {"place": "Roof", "floor": "2"},
]
ROUTES = [{"route": "R", "segment": "a", "floor": "1", "start": "Hall", "end": "Stair <2>", "clear_width": 1.2}]


def _assess(path, pieces=PIECES, places=PLACES, routes=ROUTES, **building):
    rows = {"Building": [building], "Floors": FLOORS, "Items": pieces, "Places": places, "Routes": routes}
    return assess.run(assess.read_inventory(write_sheets(path, rows)), UNVERIFIED)


@pytest.fixture(scope="module")
def assessment(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("plan") / "w.xlsx", azimuth_deg=45)


def _near(corners, expected):
    for one, other in zip(corners, expected, strict=True):
        assert one == pytest.approx(other)


def test_breadth_lies_along_the_angle_and_a_fallen_piece_touches_its_footprint():
    _near(rectangle((2, 3), 0, (-0.15, 0.15), 0.8), [(1.85, 2.6), (2.15, 2.6), (2.15, 3.4), (1.85, 3.4)])
    _near(rectangle((2, 3), 90, (-0.15, 0.15), 0.8), [(2.4, 2.85), (2.4, 3.15), (1.6, 3.15), (1.6, 2.85)])
    cos, sin = 3**0.5 / 2, 0.5
    _near(
        rectangle((0, 0), 30, (-1, 1), 4),
        [(-cos + 2 * sin, -sin - 2 * cos), (cos + 2 * sin, sin - 2 * cos),
         (cos - 2 * sin, sin + 2 * cos), (-cos - 2 * sin, -sin + 2 * cos)],
    )  # fmt: skip
    for angle in (0, 30, 90, 217):
        near_start, near_end, far_end, far_start = rectangle((1, 2), angle, (-0.2, 0.2), 0.7)
        ahead, behind = fallen((1, 2), angle, 0.4, 0.7, 1.9)
        _near((ahead[0], ahead[3]), (near_end, far_end))
        _near((behind[1], behind[2]), (near_start, far_start))
        for one in (ahead, behind):
            (x0, y0), (x1, y1), (x2, y2), _last = one
            assert ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5 == pytest.approx(1.9), angle
            assert ((x2 - x1) ** 2 + (y2 - y1) ** 2) ** 0.5 == pytest.approx(0.7), angle


def test_pieces_with_a_position_are_drawn_hatched_where_they_may_fall_and_links_lead_somewhere(assessment):
    plan, _second = plans_of(assessment)
    assert [one.number for one in plan.pieces] == [1, 2, 3]
    risky, anchored, low = plan.pieces
    _near(risky.corners, rectangle((2, 3), 90, (-0.15, 0.15), 0.8))
    assert len(risky.fallen) == 2
    assert not anchored.fallen
    assert (anchored.class_name, anchored.symbol) == ("anchored", "anchored")
    assert (low.class_name, low.fallen) == ("low", ())
    assert plan.north == 45
    assert plan.y(plan.high[1]) == 0
    assert plan.y(4.0) < plan.y(3.0) < plan.size[1]
    assert plan.x(3.0) - plan.x(2.0) == pytest.approx(1 / plan.unit, abs=0.02)
    assert plan.y(2.0) - plan.y(3.0) == pytest.approx(1 / plan.unit, abs=0.02)
    assert plan.outline([(plan.low[0], plan.high[1]), (plan.high[0], plan.high[1])]).startswith("M30 0L")
    for piece in plan.pieces:
        for corners in (piece.corners, *piece.fallen):
            assert all(plan.low[0] < x < plan.high[0] and plan.low[1] < y < plan.high[1] for x, y in corners)
    html = render(assessment)
    ids = re.findall(r'\bid="([^"]+)"', html)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'href="#([^"]+)"', html)) <= set(ids)
    assert {"piece-1", "piece-2", "piece-3", "piece-5", "row-1", "row-5"} <= set(ids)
    assert "piece-4" not in ids
    assert set(re.findall(r"url\(#([^)]+)\)", html)) <= set(ids)


def test_labels_lie_inside_on_no_piece_and_not_on_each_other(tmp_path):
    pieces = [
        {"item": f"Shelf-{at}", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 0.35 * (at % 10),
         "y": 2.0 + 2 * (at // 10)}
        for at in range(60)
    ]  # fmt: skip
    (plan, _second) = plans_of(_assess(tmp_path / "w.xlsx", pieces, PLACES, ()))
    boxes = [label.box for label in plan.labels]
    assert 10 <= len(boxes) <= 40
    assert all(overlap(one, other) == 0 for one, other in itertools.combinations(boxes, 2))
    for left, low, right, high in boxes:
        assert plan.low[0] <= left < right <= plan.high[0]
        assert plan.low[1] <= low < high <= plan.high[1]
    assert any(label.lead for label in plan.labels)


CORRIDOR = [
    {"place": "Office", "floor": "1", "x": 0.0, "y": 0.0, "kind": "room"},
    {"place": "Corner", "floor": "1", "x": 10.0, "y": 0.0, "kind": "door"},
    {"place": "Landing", "floor": "1", "x": 10.0, "y": 8.0, "kind": "stair"},
    {"place": "Balcony", "floor": "1", "x": 0.0, "y": 8.0, "kind": "exit"},
    {"place": "Foot", "floor": "2", "x": 10.0, "y": 8.0, "kind": "stair"},
    {"place": "Roof", "floor": "2", "x": 0.0, "y": 8.0, "kind": "exit"},
]
WAYS = [
    {"route": "R & S", "segment": "<i>aisle</i>", "floor": "1", "start": "Office", "end": "Corner", "clear_width": 1.2},
    {"route": "R & S", "segment": "hall", "floor": "1", "start": "Corner", "end": "Landing", "clear_width": 3.0},
    {"route": "R & S", "segment": "gap", "floor": "1", "start": "Landing", "end": "Balcony", "clear_width": 0.6},
    {"route": "R & S", "segment": "lane", "floor": "1", "start": "Office", "end": "Balcony", "clear_width": 1.5},
    {"route": "R & S", "segment": "flight", "start": "Landing", "end": "Foot"},
    {"route": "Up", "segment": "roof", "floor": "2", "start": "Foot", "end": "Roof", "clear_width": 1.0},
]
BESIDE = [
    {"item": "tall", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 5.0, "y": 0.9, "axis": "Y"},
    {"item": "low", "floor": "1", "breadth": 15, "width": 50, "height": 90, "x": 11.6, "y": 4.0, "axis": "X"},
    {"item": "loose", "floor": "2", "breadth": 30, "height": 200},
]


def test_segments_are_bands_that_go_on_round_a_bend_and_names_cover_nothing_where_places_are_many(tmp_path):
    plan, _second = plans_of(_assess(tmp_path / "w.xlsx", BESIDE, CORRIDOR, WAYS))
    ways = {one.name: one for one in plan.ways}
    assert set(ways) == {"<i>aisle</i>", "hall", "gap", "lane"}
    _near(ways["<i>aisle</i>"].corners, [(-0.75, -0.6), (11.5, -0.6), (11.5, 0.6), (-0.75, 0.6)])
    _near(ways["hall"].corners, [(11.5, -0.6), (11.5, 8.3), (8.5, 8.3), (8.5, -0.6)])
    for one in plan.ways:
        assert all(plan.low[0] < x < plan.high[0] and plan.low[1] < y < plan.high[1] for x, y in one.corners)
    # Points of routes keep their dots without names, and doors that have no room are in no list below the plan.
    walked = {"route": "Walked", "segment": "x", "floor": "1", "start": "door 0", "end": "point 0"}
    plan = plans_of(_assess(tmp_path / "w.xlsx", PIECES[:3], CROWD, [*DRAFTED, walked]))[0]
    named = {spot.name for spot in plan.places} | {key.name for key in plan.keys}
    assert not [name for name in named if name.startswith("point")]
    assert {f"room {at}" for at in range(14)} <= named
    assert len(plan.places) == len(CROWD)
    doors = [spot for spot in plan.places if spot.kind == "door" and spot.name]
    others = [spot.box for spot in plan.places if spot.name and spot.kind != "door"]
    assert not [1 for one, box in itertools.product(doors, others) if overlap(one.box, box)]
    assert not [key for key in plan.keys if key.name.startswith("door")]
    shapes = [bounds(one.corners) for one in plan.pieces]
    assert not [1 for box, shape in itertools.product(plan.boxes, shapes) if overlap(box, shape)]


CROWD = [
    {"place": f"{kind or 'point'} {at}", "floor": "1", "x": 1.0 + 2.0 * at, "y": 5.0 + 3.0 * row, "kind": kind}
    for row, kind in enumerate(("room", "door", ""))
    for at in range(14)
]
DRAFTED = [
    {"route": "To Exit 1 (draft)", "segment": str(at), "floor": "1", "start": f"room {at}", "end": f"door {at}",
     "clear_width": 0.9}
    for at in range(14)
]  # fmt: skip
