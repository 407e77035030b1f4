"""What lies under a plan: the user's drawing, outlines of rooms, the building's edge; names that do not overlap."""

import itertools
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from shapely import Point, Polygon, box

import assess
from assess.report.embedded import Photos
from assess.report.figures.labels import overlap
from assess.report.figures.plan import Plan
from assess.report.figures.underlay import cut_falls, find_edge, list_rooms
from tests.pictures import picture
from tests.plans.drawings import PLAN_SVG
from tests.report.reading import plans_of, render
from tests.workbooks import UNVERIFIED, write_sheets

SVG = "{http://www.w3.org/2000/svg}"
PIECE = {"item": "A1", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1.0, "y": 1.0, "angle_deg": 0}
FRAME = {"plan_left": 0.0, "plan_bottom": 0.0, "plan_width": 16.0}
ROOMS = [
    {"place": "West", "floor": "1", "outline": "0 0; 7.8 0; 7.8 12; 0 12"},
    {"place": "East", "floor": "1", "outline": "8 0; 8 12; 16 12; 16 0"},  # the other way round
]


def _assess(folder: Path, pieces=(PIECE,), places=(), **floor):
    (folder / "p.png").write_bytes(picture("PNG", size=(1600, 1200)))
    (folder / "p.svg").write_bytes(PLAN_SVG)
    rows = {"Floors": [{"floor": "1", "pfa_x": 0.4, **floor}], "Items": pieces, "Places": places}
    return assess.run(assess.read_inventory(write_sheets(folder / "w.xlsx", rows)), UNVERIFIED)


def _drawing(results):
    (text,) = re.findall(r'<svg[^>]*class="floor-plan".*?</svg>', render(results), re.S)
    return ElementTree.fromstring(text)


def test_a_picture_and_a_drawing_lie_where_their_numbers_put_them_and_without_series_are_left_out(tmp_path):
    results = _assess(tmp_path, plan="p.png", **FRAME, plan_turn=30)
    (plan,) = plans_of(results)
    group = _drawing(results).find(f"{SVG}g[@class='underlay']")
    image = group.find(f"{SVG}image")
    assert image.get("href").startswith("data:image/jpeg;base64,")
    assert image.get("opacity") == "0.45"
    x, y, wide, tall = (float(image.get(name)) for name in ("x", "y", "width", "height"))
    assert (x, y + tall) == pytest.approx((plan.x(0), plan.y(0)), abs=0.02)  # the lower left corner
    assert (wide * plan.unit, tall * plan.unit) == pytest.approx((16, 12), abs=0.02)
    assert image.get("transform") == f"rotate(-30.0 {x} {plan.y(0)})"  # and no scaling, which the PDF cannot draw
    assert group.get("clip-path") == "url(#plan-1-view)"
    corners = plan.underlay.corners
    assert corners[1] == pytest.approx((16 * 3**0.5 / 2, 8))
    assert all(plan.low[0] < x < plan.high[0] and plan.low[1] < y < plan.high[1] for x, y in corners)
    results = _assess(tmp_path, plan="p.png", **FRAME)
    results.series.path.unlink()
    (plan,) = plans_of(results)
    assert plan.underlay is None
    results = _assess(tmp_path, plan="p.svg", **FRAME, plan_turn=90)
    (plan,) = plans_of(results)
    frame, wall = plan.underlay.lines
    np.testing.assert_allclose(wall, [(-12, 8), (-5, 8), (-5, 0)], atol=1e-5)
    np.testing.assert_allclose([frame.min(axis=0), frame.max(axis=0)], [(-12, 0), (0, 16)], atol=1e-5)
    (path,) = _drawing(results).find(f"{SVG}g[@class='underlay']")
    assert path.tag == f"{SVG}path"
    assert f"L{plan.x(-5):.1f} {plan.y(8):.1f}" in path.get("d")
    assert path.get("fill") == "none"


def _covered(plan: Plan):
    return [Polygon(ring) for piece in plan.pieces for ring in piece.fallen]


def test_falls_end_at_outlines_or_the_frame_of_a_plan_not_at_inner_walls_and_else_stay_whole(tmp_path):
    pieces = [{**PIECE, "y": 3.0}, {**PIECE, "item": "A2", "x": 7.0, "y": 8.0}]
    results = _assess(tmp_path, pieces, ROOMS)
    (plan,) = plans_of(results)
    floor = box(0, 0, 16, 12)
    assert plan.cut_at == "outlines"
    assert all(floor.buffer(1e-6).covers(one) for one in _covered(plan))
    areas = [one.area for one in _covered(plan)]
    assert areas == pytest.approx([1.6, 0.85 * 0.8, 1.6, 1.6])  # 0.85 m to the wall; through the wall at 7.8 m
    assert (plan.low, plan.high) == ((-0.4, -0.4), (16.4, 12.4))
    assert "Hatching ends at the outlines of the floor" in render(results)
    results = _assess(tmp_path, plan="p.png", **FRAME)
    (plan,) = plans_of(results)
    assert plan.cut_at == "frame"
    assert [one.area for one in _covered(plan)] == pytest.approx([1.6, 0.85 * 0.8])
    assert "Hatching ends at the frame of the plan." in render(results)
    (plan,) = plans_of(_assess(tmp_path, plan="p.png", **FRAME | {"plan_left": 5.0}))
    assert plan.cut_at == ""
    (plan,) = plans_of(_assess(tmp_path, [PIECE, {**PIECE, "item": "A2", "x": 12.0}], ROOMS[:1]))
    assert plan.cut_at == ""
    assert [one.area for one in _covered(plan)] == pytest.approx([1.6] * 4)


def test_a_hole_in_the_building_is_not_covered_and_rooms_are_outlined_and_named_inside(tmp_path):
    ring = Polygon([(0, 0), (10, 0), (10, 10), (0, 10)], [[(4, 4), (6, 4), (6, 6), (4, 6)]])
    outer, inner = cut_falls([((3, 3), (7, 3), (7, 7), (3, 7))], ring)
    assert Polygon(outer).area == pytest.approx(16)
    assert Polygon(inner).area == pytest.approx(4)
    assert Polygon(outer).exterior.is_ccw != Polygon(inner).exterior.is_ccw  # a hole by the rule of the path
    assert cut_falls([((20, 20), (21, 20), (21, 21))], ring) == ()
    assert find_edge((), (), [(1, 1)]) is None
    places = [*ROOMS, {"place": "Core", "floor": "1", "outline": "3 3; 5 3; 5 9; 3 9"},
              {"place": "Signed", "floor": "1", "x": 12, "y": 3, "kind": "room",
               "outline": "11 2; 13 2; 13 4; 11 4"}]  # fmt: skip
    results = _assess(tmp_path, [PIECE], places)
    (plan,) = plans_of(results)
    assert [room.name for room in plan.rooms] == ["East", "West", "Core", ""]
    west, core = Point(plan.rooms[1].centre), Point(plan.rooms[2].centre)
    assert box(0, 0, 7.8, 12).contains(west)
    assert not box(3, 3, 5, 9).contains(west)  # what lies inside of it has a name of its own
    assert core.equals(Point(4, 6))
    drawing = _drawing(results)
    assert len(drawing.find(f"{SVG}g[@class='rooms']")) == 4
    names = [text.text for text in drawing.find(f"{SVG}g[@class='room-names']").iter(f"{SVG}text")]
    assert names == ["East", "West", "Core"]
    assert [spot.name for spot in plan.places] == ["Signed"]
    assert list_rooms(()) == ()


def test_names_without_room_have_a_number_and_a_key(tmp_path):
    places = [
        {"place": f"Meeting room number {n}", "floor": "1", "x": 4 + 0.05 * n, "y": 4.0, "kind": "room"}
        for n in range(40)
    ]
    results = _assess(tmp_path, [PIECE], places)
    (plan,) = plans_of(results)
    assert not [1 for one, other in itertools.combinations(plan.boxes, 2) if overlap(one, other) > 0]
    numbered = [key.number for key in plan.keys if key.number is not None]
    assert numbered == list(range(1, len(numbered) + 1))
    assert numbered
    shown = {spot.name for spot in plan.places}
    assert {str(number) for number in numbered} < shown
    assert len(plan.keys) + len([name for name in shown if name.startswith("Meeting")]) == 40
    html = render(results)
    assert f"<strong>1</strong> {plan.keys[0].name} (" in html


def test_photos_by_item_and_no_more_than_a_report_holds(tmp_path):
    pieces = [{**PIECE, "item": f"A{n}", "x": n + 1.0, "photo": "p.png" if n else None} for n in range(3)]
    results = _assess(tmp_path, pieces)
    photos = Photos(results)
    found = [photos.photo_of(n) for n in range(3)]
    assert found[0] == ""
    assert found[1] == found[2]
    assert found[1].startswith("data:image/jpeg;base64,")
    page = render(results)
    assert page.count('class="photo"') == 2
    assert photos.first_photo(list(results)) == ("A1", found[1])
    assert photos.first_photo(list(results)[:1]) is None
    photos.left = 10
    assert photos.photo_of(1) == ""
    assert Photos(_assess(tmp_path, [PIECE])).photo_of(0) == ""
