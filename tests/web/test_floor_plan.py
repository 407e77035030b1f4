"""A floor as the plan view draws it: the geometry of the reports, whatever errors the rows have."""

import io
import json
import re
from xml.etree import ElementTree

import pytest
from PIL import Image
from shapely import Polygon, union_all

import assess
from assess.report.content import Content
from assess.report.figures.plan import BORDER
from assess.routes.geometry import rectangle
from assess.web.floor_plan import describe_plan, find_picture
from tests.pictures import picture
from tests.plans.drawings import PLAN_SVG
from tests.report.reading import plans_of
from tests.web.opened import edit, hold, write_template
from tests.workbooks import UNVERIFIED

FLOORS = [
    {"floor": "1", "name": "Ground", "pfa_x": 0.6, "plan": "p.png", "plan_left": 0, "plan_bottom": 0, "plan_width": 16},
    {"floor": "2", "pfa_x": 0.6, "plan": "p.svg"},
    {"floor": "3", "pfa_x": 0.6},
]
SIZE = {"breadth": 30, "width": 80, "height": 200}
ITEMS = [
    {"item": "A1", "floor": "1", **SIZE, "x": 1.0, "y": 1.0, "angle_deg": 30},
    {"item": "A2", "floor": "1", **SIZE, "x": 7.6, "y": 6.0, "axis": "X", "against_wall": "yes"},
    {"item": "A3", "floor": "1", **SIZE, "x": 12.0, "y": 11.0, "axis": "Y"},
    {"item": "A4", "floor": "1", **SIZE},
    {"item": "A5", "floor": "2", "type": "Bookcase 5 shelves", "x": 3.0, "y": 3.0},
]
PLACES = [
    {"place": "West", "floor": "1", "kind": "room", "outline": "0 0; 7.8 0; 7.8 12; 0 12", "x": 4, "y": 6},
    {"place": "East", "floor": "1", "kind": "room", "outline": "8 0; 8 12; 16 12; 16 0"},
    {"place": "Door", "floor": "1", "kind": "exit", "x": 4, "y": 0},
]
ROUTES = [{"route": "R", "segment": "a", "start": "West", "end": "Door", "clear_width": 1.2}]


@pytest.fixture
def path(tmp_path):
    (tmp_path / "p.png").write_bytes(picture("PNG", size=(1600, 1200)))
    (tmp_path / "p.svg").write_bytes(PLAN_SVG)
    rows = {"Floors": FLOORS, "Items": ITEMS, "Places": PLACES, "Routes": ROUTES}
    return write_template(tmp_path / "w.xlsx", rows)


def _plan(book, floor=None):
    return json.loads(json.dumps(describe_plan(book.snapshot(), floor)))


def _area(rings):
    return union_all([Polygon(ring) for ring in rings])


def test_falls_end_at_the_walls_as_in_the_report(path):
    book, results, falls = hold(path), assess.run(assess.read_inventory(path), UNVERIFIED), 0
    for page, expected in zip(Content(results).floors, plans_of(results), strict=True):
        if expected is None:
            continue
        plan = _plan(book, page.floor.floor)
        by_row = {one["row"]: one for one in plan["pieces"]}
        rows = [results.item_rows[one.number - 1].row for one in expected.pieces]
        assert sorted(by_row) == sorted(rows)
        for row, one in zip(rows, expected.pieces, strict=True):
            piece, half = by_row[row], by_row[row]["breadth"] / 2
            shape = Polygon(rectangle((piece["x"], piece["y"]), piece["angle"], (-half, half), piece["width"]))
            assert shape.symmetric_difference(Polygon(one.corners)).area < 1e-3
            if one.fallen:
                falls += 1
                assert _area(piece["fallen"]).symmetric_difference(_area(one.fallen)).area < 1e-2
        outlines = {tuple(map(tuple, one["outline"])) for one in plan["places"] if one["outline"]}
        assert outlines == {room.outline for room in expected.rooms}
        ways = sorted(_area([one.corners]).area for one in expected.ways)
        assert sorted(_area([one["outline"]]).area for one in plan["segments"] if one["outline"]) == pytest.approx(
            ways, abs=1e-2
        )
    assert falls == 4
    found = {one["item"]: one for one in _plan(hold(path))["pieces"]}
    assert len(found["A2"]["fallen"]) == 1, "it falls away from its wall"
    assert max(x for ring in found["A2"]["fallen"] for x, _ in ring) < 7.6


def test_pieces_with_errors_are_still_drawn_and_without_floors_or_pictures_there_is_a_frame(path):
    book = hold(path)
    edit(book, ("Items", 2, "height", "tall"), ("Items", 3, "breadth", None), ("Items", 4, "quantity", "x"))
    edit(book, *(("Items", 8, name, value) for name, value in (("item", "new"), ("floor", "1"), ("x", 3), ("y", 3))))
    found = {one["item"]: one for one in _plan(book)["pieces"]}
    missing = {name: one["missing"] for name, one in found.items()}
    assert missing == {"A1": ["height"], "A2": ["breadth"], "A3": [], "new": ["breadth", "width", "height"]}
    assert (found["new"]["breadth"], found["new"]["width"], found["new"]["fallen"]) == (0.4, 0.4, [])
    assert (found["A2"]["breadth"], found["A2"]["width"]) == (0.4, 0.8)
    assert len(found["A3"]["fallen"]) == 2
    # It is drawn as Breadth, as the routes assume it; nobody may take that for what the piece covers.
    book = hold(path)
    edit(book, ("Items", 2, "width", None))
    (shelves,) = _plan(book, "2")["pieces"]
    assert (shelves["missing"], shelves["width"]) == (["width"], shelves["breadth"])
    piece = _plan(book, "1")["pieces"][0]
    assert (piece["missing"], piece["width"], len(piece["fallen"])) == (["width"], 0.3, 2)
    edit(book, *(("Floors", row, "floor", None) for row in (2, 3, 4)))
    plan = _plan(book)
    assert (plan["floor"], plan["floor_row"], plan["pieces"]) == ("", None, [])
    assert plan["frame"] == [-BORDER, -BORDER, 12 + BORDER, 8 + BORDER]
    book = hold(path)
    (path.parent / "p.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
    (path.parent / "p.svg").unlink()
    edit(book, ("Floors", 2, "plan_turn", 5))
    for floor in ("1", "2", "3", "none"):
        assert find_picture(book.snapshot(), floor) is None
        assert _plan(book, floor)["picture"] is None


def test_a_picture_is_drawn_anew_and_a_drawing_shown_before_it_is_placed(path):
    """Nothing of a user's file reaches the page as it is."""
    book = hold(path)
    given = _plan(book, "1")["picture"]
    assert {name: given[name] for name in ("left", "bottom", "width", "height", "turn", "placed", "aspect")} == {
        "left": 0, "bottom": 0, "width": 16, "height": 12, "turn": 0, "placed": True, "aspect": 0.75,
    }  # fmt: skip
    data, kind = find_picture(book.snapshot(), "1") or (b"", "")
    shown = Image.open(io.BytesIO(data))
    assert (kind, shown.format, shown.mode, shown.size) == ("image/jpeg", "JPEG", "L", (1600, 1200))
    assert given["url"].startswith("/api/picture?floor=1&v=")
    book = hold(path)
    plan = _plan(book, "2")
    given = plan["picture"]
    assert (given["placed"], given["left"], given["width"], given["height"]) == (False, None, None, None)
    data, kind = find_picture(book.snapshot(), "2") or (b"", "")
    root = ElementTree.fromstring(data)
    assert (kind, {child.tag.rpartition("}")[2] for child in root}) == ("image/svg+xml", {"path"})
    _, _, wide, tall = map(float, root.get("viewBox").split())
    assert tall / wide == pytest.approx(given["aspect"], abs=1e-4)
    numbers = [float(one) for one in re.findall(r"-?[\d.]+", root[0].get("d"))]
    assert numbers
    assert all(0 <= x <= wide and 0 <= y <= tall for x, y in zip(numbers[::2], numbers[1::2], strict=True))
    edit(book, ("Floors", 3, "plan_left", -2), ("Floors", 3, "plan_bottom", 1), ("Floors", 3, "plan_width", 10))
    placed = _plan(book, "2")["picture"]
    assert (placed["placed"], placed["left"], placed["width"]) == (True, -2, 10)
    assert placed["height"] == pytest.approx(10 * given["aspect"])
    assert placed["url"] == given["url"], "the same drawing, wherever it lies"
    edit(book, ("Floors", 4, "plan", "p.png"))
    plan = _plan(book, "3")  # an empty floor has room for it
    assert plan["picture"]["aspect"] == 0.75
    assert plan["frame"] == pytest.approx([-BORDER, -BORDER, 20 + BORDER, 15 + BORDER])
