"""Homes of Sweet Home 3D: a file that the program itself wrote, and damaged ones made of it."""

import re
import struct
from pathlib import Path

import pytest
import shapely
import shapely.affinity

import assess
from assess.bim import sweet_home
from assess.bim.model_rows import list_building
from assess.bim.plan_shapes import to_polygon
from assess.bim.read_source import read_source
from assess.bim.sweet_home import DRAWN_SIZES, read_sweet_home
from assess.errors import ModelError
from tests.bim.ifc_files import write_import
from tests.motion.writers import zipped
from tests.workbooks import parts_of

FILE = Path(__file__).parents[1] / "data" / "scans" / "two-floors.sh3d"
CORNERS = {
    "Bookcase A": [[50.0, 3.75], [150.0, 3.75], [150.0, 43.75], [50.0, 43.75]],
    "Bookcase B": [[38.75, 207.5], [38.75, 292.5], [3.75, 292.5], [3.75, 207.5]],
    "Glass door cabinet": [[279.3641, 265.7424], [339.9859, 300.7424], [320.6359, 334.2576], [260.0141, 299.2576]],
    "Desk": [[330.0, 366.1], [470.0, 366.1], [470.0, 433.9], [330.0, 433.9]],
    "Floor uplight": [[453.5, 13.5], [486.5, 13.5], [486.5, 46.5], [453.5, 46.5]],
    "Wardrobe": [[400.0, 7.25], [500.0, 7.25], [500.0, 61.25], [400.0, 61.25]],
    "Bed 140x190": [[570.5994, 282.32236], [682.3223, 170.59946], [829.4006, 317.67764], [717.6777, 429.40054]],
    "Toilet unit": [[120.0, 490.0], [80.0, 490.0], [80.0, 410.0], [120.0, 410.0]],
}
"""Of pieces, as the program gives them [cm], Y downwards."""
DOOR_CORNERS = {
    "Front door": [[750.75, 511.5], [649.25, 511.5], [649.25, 488.5], [750.75, 488.5]],
    "Door": [[507.25, 204.25], [507.25, 295.75], [492.75, 295.75], [492.75, 204.25]],
}


@pytest.fixture(scope="module")
def home():
    return read_sweet_home(FILE.read_bytes(), FILE.name)


def lay(x, y, across, along, angle_deg):
    """Return a rectangle by its centre and its sides: `across` lies in the direction of the angle."""
    box = shapely.box(x - across / 2, y - along / 2, x + across / 2, y + along / 2)
    return shapely.affinity.rotate(box, angle_deg)


def share_alike(one, other):
    return one.intersection(other).area / one.union(other).area


def test_pieces_cover_what_the_program_says(home):
    found = {one.name: one for one in home.pieces}
    assert found.keys() == CORNERS.keys() | {"Kitchen cabinet", "Fridge & Freezer"}
    for name, corners in CORNERS.items():
        one = found[name]
        plan = lay(one.x, one.y, one.breadth, one.width, one.angle_deg)
        assert share_alike(plan, shapely.Polygon([(x / 100, -y / 100) for x, y in corners])) > 0.999, name
        assert one.breadth <= one.width
        assert (one.support_breadth, one.support_width) == (one.breadth, one.width)
    assert (found["Bookcase A"].height, found["Wardrobe"].height) == pytest.approx((2.11, 1.65))
    assert home.sizes_from == "model"
    assert home.warnings == (DRAWN_SIZES,)
    hall = next(one.key for one in home.spaces if one.name == "Hall")
    group = {name: (found[name].space, found[name].is_fitted) for name in ("Kitchen cabinet", "Fridge & Freezer")}
    assert group == {"Kitchen cabinet": (hall, True), "Fridge & Freezer": (hall, False)}


def test_what_is_no_piece_is_listed_with_its_reason(home):
    raised = "not on the floor: its lowest point is more than 15 cm above it"
    found = {
        (one.type.removeprefix("Sweet Home 3D "), str(one.reason), one.count, one.is_furniture) for one in home.skipped
    }
    assert found == {
        ("Laptop", raised, 1, True), ("Pendant lamp", raised, 1, True), ("Kitchen upper cabinet", raised, 1, True),
        ("Chair", "hidden in the plan", 1, True), ("Chest", "not upright", 1, True),
        ("Staircase", "a stair, listed in Places", 1, False),
    }  # fmt: skip


def test_levels_rooms_stairs_doors_windows_and_north(home):
    assert [one.name for one in home.storeys] == ["Ground floor", "Upper floor"]
    assert [one.elevation for one in home.storeys] == pytest.approx([0, 2.62])
    ground, upper = (one.key for one in home.storeys)
    assert [(one.storey, one.name, to_polygon(one.area).bounds) for one in home.spaces] == [
        (ground, "Office", (0.04, -4.96, 4.96, -0.04)), (ground, "Hall", (5.04, -4.96, 8.96, -0.04)),
        (upper, "Room 3", (0.04, -4.96, 8.96, -0.04)),
    ]  # fmt: skip
    assert [(one.storey, one.end, one.x, one.y) for one in home.stairs] == [
        (ground, "foot", 8, -1.5), (upper, "head", 8, -1.5),
    ]  # fmt: skip
    assert {one.name: one.storey for one in home.pieces}["Wardrobe"] == upper
    for one in home.doors:
        plan = lay(one.x, one.y, one.thickness, one.width, one.normal_deg)
        assert share_alike(plan, shapely.Polygon([(x / 100, -y / 100) for x, y in DOOR_CORNERS[one.name]])) > 0.999
    assert [one.name for one in home.doors] == list(DOOR_CORNERS)
    ground, upper = (one.key for one in home.storeys)
    (window,) = home.windows[ground]
    assert to_polygon(window).bounds == pytest.approx((1.545, -0.17, 2.455, 0.17))
    assert home.windows[upper] == ()
    walls = shapely.union_all([to_polygon(one) for one in home.walls[ground]])
    assert walls.bounds == pytest.approx((-0.0375, -5.0375, 9.0375, 0.0375), abs=2e-3)
    for x, y in ((7, -5), (5, -2.5), (2, 0)):
        assert not walls.intersects(shapely.Point(x, y)), "a gap"
    assert walls.covers(shapely.Point(5, -4))
    # 30 degrees clockwise from up the plan: X, to the right, points 60 degrees clockwise from north.
    assert home.azimuth_deg == 60
    assert read(change(b"northDirection='0.5235988'", b"northDirection='0.0'")).azimuth_deg is None


@pytest.mark.slow
def test_a_home_becomes_a_workbook_that_is_read(tmp_path):
    found = read_source(FILE, FILE.name, routes="draft")
    assert {row["sizes_from"] for row in found.items} == {"model"}
    assert found.building == {"azimuth_deg": 60}
    assert found.routes
    with pytest.raises(assess.WorkbookError) as raised:
        assess.read_inventory(write_import(found, tmp_path))
    errors = [one for one in raised.value.problems if one.severity == "error"]
    assert {one.sheet for one in errors} == {"Floors"}, "shaking alone is missing"


def read(data):
    return read_sweet_home(data, "h.sh3d")


def home_xml():
    return parts_of(FILE)["Home.xml"]


def pack(xml, part="Home.xml"):
    return zipped({part: xml})


def change(old, new, count=1):
    xml = home_xml()
    assert old in xml
    return pack(xml.replace(old, new, count))


def refused(data):
    with pytest.raises(ModelError) as raised:
        read(data)
    return str(raised.value)


def test_homes_without_levels_with_a_hidden_group_with_a_round_wall_and_with_nothing():
    xml = re.sub(rb"<level [^>]*/>", b"", home_xml())
    xml = re.sub(rb" level='[^']*'", b"", xml)
    model = read(pack(xml))
    assert [(one.key, one.level) for one in model.storeys] == [("", 0)]
    assert len(model.pieces) == 10
    assert len(list_building(model).items) == 10
    model = read(change(b"name='Kitchen' x=", b"name='Kitchen' visible='false' x="))
    assert "Fridge & Freezer" not in {one.name for one in model.pieces}
    hidden = {
        one.type.removeprefix("Sweet Home 3D ") for one in model.skipped if str(one.reason) == "hidden in the plan"
    }
    assert hidden == {"Chair", "Kitchen cabinet", "Kitchen upper cabinet", "Fridge & Freezer"}
    (remark,) = read(change(b"<wall id=", b"<wall arcExtent='1.5' id=")).remarks
    assert str(remark) == "1 round wall is not drawn."
    model = read(pack(b"<home version='7000'/>"))
    assert (model.pieces, model.spaces, len(model.storeys)) == ((), (), 1)


def test_what_cannot_be_read_or_is_too_much_is_refused(monkeypatch):
    bomb = b"<!DOCTYPE home [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;'>]><home name='&b;'/>"
    for data, said in (
        (b"", "h.sh3d is damaged"),
        (b"PK\x03\x04 no zip", "h.sh3d is damaged"),
        (FILE.read_bytes()[:3000], "h.sh3d is damaged"),
        (pack(b"<home>", "Home"), "saved by an old version of Sweet Home 3D: it lacks Home.xml. Open it with version"),
        (pack(b"<home/>", "other.xml"), "h.sh3d is not a file of Sweet Home 3D: it lacks Home.xml."),
        (pack(b"<house/>"), "h.sh3d is not a file of Sweet Home 3D"),
        (pack(home_xml()[:-400]), "its Home.xml cannot be read. Open it with Sweet Home 3D, and save it again."),
        (pack(b"\xff\xfe\x00"), "its Home.xml cannot be read"),
        (pack(bomb), "its Home.xml cannot be read"),
        (change(b"x='100.0'", b"x='abc'"), "h.sh3d, pieceOfFurniture[0]: x is 'abc', not a number."),
        (change(b"x='100.0'", b"x='NaN'"), "x is 'NaN', not a number."),
        (change(b"x='100.0'", b"x='1e9'"), "x is '1e9', not a number."),
        (change(b"thickness='7.5'", b""), "h.sh3d, wall[0]: thickness is '', not a number."),
    ):
        assert said in refused(data), (data, said)
    assert "holds more than 100,000 elements" in refused(pack(b"<home>" + b"<property/>" * 100_001 + b"</home>"))
    assert "too many inside each other" in refused(pack(b"<home>" + b"<a>" * 200 + b"</a>" * 200 + b"</home>"))
    wall = b"<wall xStart='0' yStart='0' xEnd='9' yEnd='9' thickness='1'/>"
    assert "holds more than 1,000 pieces, walls, rooms or levels" in refused(pack(b"<home>" + wall * 1001 + b"</home>"))
    # The mark of encryption in both headers of the part.
    data = bytearray(pack(b"<home/>"))
    for at in (6, data.index(b"PK\x01\x02") + 8):
        struct.pack_into("<H", data, at, 1)
    assert "h.sh3d is damaged" in refused(bytes(data))
    monkeypatch.setattr(sweet_home, "MOST_HOME", 20_000)
    assert "is too large: at most" in refused(pack(home_xml() + b" " * 10_000_000))
    monkeypatch.setattr(sweet_home, "MOST_BYTES", 5_000)
    assert "is too large: at most" in refused(FILE.read_bytes())


HUTCH = b"""<furnitureGroup name='Dresser with hutch' x='300' y='900' width='110' depth='60' height='200'>
<pieceOfFurniture id='d1' name='Dresser' x='300' y='900' width='100' depth='50' height='90'/>
<pieceOfFurniture id='d2' name='Hutch' x='300' y='905' elevation='90' width='100' depth='40' height='110'/>{more}
</furnitureGroup>"""


def test_parts_of_a_group_that_stand_on_each_other_are_one_piece_and_what_is_left_out_is_told():
    for more, names, height in (
        (b"", {"Dresser with hutch"}, 2.0),
        (b"<pieceOfFurniture id='d3' name='Chair' x='380' y='900' width='60' depth='50' height='90'/>",
         {"Dresser", "Chair"}, 2.0),  # stands beside: it stays apart
        (b"<pieceOfFurniture id='d3' name='Lamp' x='300' y='900' elevation='200' width='20' depth='20' height='40'/>",
         {"Dresser"}, 2.0),  # covers little of what it stands on
    ):  # fmt: skip
        group = HUTCH.replace(b"{more}", more)
        before = {one.name for one in read(FILE.read_bytes()).pieces}
        model = read(change(b"</home>", group + b"</home>"))
        new = {one.name: one for one in model.pieces if one.name not in before}
        assert new.keys() == names, (more, names)
        piece = next(one for name, one in new.items() if "Dresser" in name)
        assert (piece.breadth, piece.width, piece.height) == pytest.approx((0.5, 1.0, height)), (more, names)
        assert (piece.support_breadth, piece.support_width) == pytest.approx((0.5, 1.0)), (more, names)
    top = b"<pieceOfFurniture id='t' name='Top box' x='300' y='900' elevation='90' width='90' depth='50' height='80'/>"
    base = b"<pieceOfFurniture id='b' name='Base box' x='300' y='900' width='100' depth='50' height='90'/>"
    (warning,) = read(change(b"</home>", base + top + b"</home>")).warnings[1:]
    assert str(warning).startswith(
        "Something that was left out stands on 1 piece, whose height is then not the whole: Base box. Check its Height"
    )
