"""Building models in IFC: what is read of two published ones, of small ones in each unit and schema, of bad ones."""

import math
from collections import Counter
from pathlib import Path

import pytest

from assess.bim.building_model import BuildingModel
from assess.bim.ifc_model import read_model
from assess.errors import ModelError
from tests.bim.ifc_files import ModelWriter, one_room, read

MODELS = Path(__file__).parents[2] / "samples" / "models"
SHELF = (0, 0, 0, 0.4, 0.8, 1.9)


def count(model: BuildingModel, what: str) -> dict[str, int]:
    names = {one.key: one.name for one in model.storeys}
    return dict(Counter(names[one.storey] for one in getattr(model, what)))


def test_duplex_of_which_47_of_61_pieces_stand_on_the_floor(duplex):
    assert (duplex.schema, duplex.name, duplex.azimuth_deg) == ("IFC2X3", "Duplex Apartment", None)
    assert [(one.name, round(one.elevation, 3)) for one in duplex.storeys] == [
        ("T/FDN", -1.25), ("Level 1", 0.0), ("Level 2", 3.1), ("Roof", 6.0),
    ]  # fmt: skip
    assert count(duplex, "spaces") == {"Level 1": 10, "Level 2": 10, "Roof": 1}
    assert count(duplex, "doors") == {"Level 1": 6, "Level 2": 8}
    assert Counter(one.end for one in duplex.stairs) == {"foot": 2, "head": 2}
    assert (duplex.latitude, duplex.longitude) == pytest.approx((41.8744, -87.6394), abs=1e-4)
    corners = [corner for area in duplex.walls[duplex.storeys[1].key] for corner in area[0]]
    assert min(x for x, _ in corners) == pytest.approx(0, abs=0.01)
    assert max(x for x, _ in corners) == pytest.approx(8.8, abs=0.1)
    assert duplex.windows[duplex.storeys[1].key]
    left = [one for one in duplex.skipped if one.is_furniture]
    assert (len(duplex.pieces), sum(one.count for one in left)) == (47, 14)
    assert {str(one.reason) for one in left} == {"not on the floor: its lowest point is more than 15 cm above it"}
    wardrobes = [one for one in duplex.pieces if one.type == "M_Tall Cabinet-Single Door(2) 800 mm"]
    assert len(wardrobes) == 8
    for one in wardrobes:
        sizes = (one.breadth, one.width, one.height, one.support_breadth, one.support_width)
        assert sizes == pytest.approx((0.545, 0.8, 2.0, 0.485, 0.8), abs=1e-3)
    assert {one.key for one in duplex.pieces if one.is_fitted} == {
        one.key for one in duplex.pieces if "Base Cabinet" in one.type or "Vanity" in one.type
    }


def test_large_building_in_millimetres(large):
    assert len(large.pieces) == 14
    for one in large.pieces:
        assert (one.breadth, one.width, one.height) == pytest.approx((0.819, 1.563, 0.762), abs=1e-3)
    assert (count(large, "spaces"), count(large, "doors")) == ({"Level 1": 8}, {"Level 1": 18})
    assert large.azimuth_deg == pytest.approx(90)
    assert {one.overall for one in large.doors} >= {0.915}
    proxies = [one for one in large.skipped if one.type.startswith("IfcBuildingElementProxy ")]
    assert {(one.count, one.is_furniture) for one in proxies} == {(11, False), (2, False)}


@pytest.mark.slow
def test_proxies_are_taken_by_name():
    path = MODELS / "LargeBuilding.ifc"
    found = read_model(path, "a.ifc", ("IfcBuildingElementProxy",))
    assert any(one.ifc_class == "IfcBuildingElementProxy" for one in found.pieces)
    message = r"IfcTable2 is not a class of IFC2X3\. Classes have names such as IfcBuilding"
    with pytest.raises(ModelError, match=message):
        read_model(path, "a.ifc", ("IfcTable2",))


@pytest.mark.parametrize(
    ("schema", "units", "scale"),
    [("IFC2X3", "FOOT", 1 / 0.3048), ("IFC4", "METRE", 1.0), ("IFC4", "MILLI", 1000.0), ("IFC4X3", "MILLI", 1000.0)],
)
def test_every_schema_and_unit_gives_metres(tmp_path, schema, units, scale):
    model, _, room = one_room(schema, units, scale)
    model.piece("Shelf", tuple(scale * one for one in SHELF), within=room, at=(2 * scale, scale, 0))
    found = read(model, tmp_path)
    (piece,) = found.pieces
    assert (piece.breadth, piece.width, piece.height) == pytest.approx((0.4, 0.8, 1.9), abs=1e-4)
    assert (piece.x, piece.y, piece.bottom) == pytest.approx((2, 1, 0), abs=1e-4)
    (space,) = found.spaces
    assert (space.key, space.name, space.title) == (piece.space, "101", "Office")
    assert space.top == pytest.approx(3, abs=1e-4)
    corners = sorted((round(x, 2), round(y, 2)) for x, y in space.area[0])
    assert corners == [(0, 0), (0, 4), (6, 0), (6, 4)]
    assert found.schema.startswith(schema)


def test_sizes_angles_and_supports_of_pieces_that_are_turned_askew_or_tilted(tmp_path):
    model, _, room = one_room()
    angles = [0, 30, 75, 90, 120, 200, 315]
    for angle in angles:
        turn = math.radians(angle)
        model.piece(f"Shelf {angle}", SHELF, within=room, at=(3, 2, 0), x=(math.cos(turn), math.sin(turn), 0))
    found = {one.name: one for one in read(model, tmp_path).pieces}
    for angle in angles:
        piece = found[f"Shelf {angle}"]
        assert (piece.breadth, piece.width) == pytest.approx((0.4, 0.8), abs=1e-4)
        assert -90 <= piece.angle_deg < 90
        assert math.cos(math.radians(2 * (piece.angle_deg - angle))) == pytest.approx(1, abs=1e-6)
    # A ladder of boxes along a diagonal: in its own axes it would be as deep as it is wide.
    model, _, room = one_room()
    boxes = [(at, at, 0, 0.1, 0.1, 1.0) for at in (0, 0.25, 0.5, 0.75, 1.0)]
    model.piece("Screen", *boxes, within=room, at=(2, 1, 0))
    model.piece("Board", (0, 0, 0, 2.0, 0.05, 1.0), within=room, at=(3, 2, 0), up=(0, 0.2, 1))
    found = {one.name: one for one in read(model, tmp_path).pieces}
    screen, board = found["Screen"], found["Board"]
    assert (screen.breadth, screen.width) == pytest.approx((math.sqrt(2) * 0.1, math.sqrt(2) * 1.1), abs=1e-3)
    assert screen.angle_deg == pytest.approx(-45, abs=0.1)
    assert board.width == pytest.approx(2.0, abs=1e-3)
    assert 0.2 < board.breadth < 0.3
    # A table on two feet: 40 cm apart along its breadth of 90 cm.
    model, _, room = one_room()
    top = (0, 0, 0.7, 0.9, 1.6, 0.03)
    feet = [(side * 0.17, end * 0.7, 0, 0.06, 0.06, 0.7) for side in (-1, 1) for end in (-1, 1)]
    model.piece("Table", top, *feet, within=room, at=(3, 2, 0))
    (piece,) = read(model, tmp_path).pieces
    assert (piece.breadth, piece.width, piece.height) == pytest.approx((0.9, 1.6, 0.73), abs=1e-4)
    assert (piece.support_breadth, piece.support_width) == pytest.approx((0.40, 1.46), abs=1e-4)


def test_a_piece_in_overlapping_spaces_stands_in_the_smallest_or_in_that_which_holds_it(tmp_path):
    """Some programs export the gross area of a storey as a space, too."""
    for gross_first in (True, False):
        model = ModelWriter()
        storey = model.storey()
        sizes = [(0, 0, 0, 20, 20, 3), (0, 0, 0, 6, 4, 3)]
        spaces = {size[3]: model.space(storey, size) for size in (sizes if gross_first else sizes[::-1])}
        model.piece("Shelf", SHELF, within=storey, at=(2, 1, 0))
        model.piece("Shelf 2", SHELF, within=storey, at=(8, 8, 0))
        model.piece("Held", SHELF, within=spaces[20], at=(2, 1, 0))
        found = {one.name: one.space for one in read(model, tmp_path).pieces}
        gross, room = spaces[20].GlobalId, spaces[6].GlobalId
        assert found == {"Shelf": room, "Shelf 2": gross, "Held": gross}, gross_first


@pytest.mark.parametrize("deep", [1.0, 0.2, None], ids=["thicker than wide", "thin", "no opening"])
def test_a_door_has_the_sizes_of_its_opening_else_of_its_leaf(tmp_path, deep):
    """The opening is 0.9 m wide; the leaf tells which way it leads."""
    model, storey, _ = one_room()
    leaf = model.element("IfcDoor", "D", (0, 0, 0, 0.9, 0.06, 2.1), within=storey, at=(3, 4, 0), OverallWidth=0.9)
    opening = deep and model.element("IfcOpeningElement", "O", (0, 0, 0, 0.9, deep, 2.1), at=(3, 4 + deep / 2, 0))
    model.root("IfcRelFillsElement", None, RelatingOpeningElement=opening, RelatedBuildingElement=leaf)
    (door,) = read(model, tmp_path).doors
    assert (door.width, door.thickness) == pytest.approx((0.9, deep or 0.06), abs=1e-4)
    assert abs(door.normal_deg) == pytest.approx(90)


def test_models_far_from_their_origin_without_rooms_or_storeys_and_of_no_use_at_all(tmp_path):
    model = ModelWriter(north=(-1.0, 0.0))
    storey = model.storey()
    room = model.space(storey, (412_003, 5_654_002, 0, 6, 4, 3))
    model.piece("Shelf", SHELF, within=room, at=(412_002, 5_654_001, 0))
    found = read(model, tmp_path)
    assert found.shift[0] == 412_000
    assert found.shift[1] % 100 == 0
    (piece,) = found.pieces
    assert (piece.x + found.shift[0], piece.y + found.shift[1]) == pytest.approx((412_002, 5_654_001), abs=1e-3)
    assert min(x for x, _ in found.spaces[0].area[0]) == pytest.approx(0, abs=1e-3)
    assert any("stands far from its origin" in text for text in found.remarks)
    assert found.azimuth_deg == pytest.approx(180), "true north along -X: X points south"
    model = ModelWriter()
    storey = model.storey("Level 3", 6.0)
    model.piece("Shelf", SHELF, within=storey, at=(2, 1, 6.0))
    found = read(model, tmp_path)
    assert (len(found.pieces), found.pieces[0].space) == (1, "")
    assert [str(text) for text in found.remarks] == [
        "The model has no rooms (IfcSpace): Room stays blank, and heights are taken from the storeys."
    ]
    model = ModelWriter()
    room = model.space(model.building, (3, 2, 0, 6, 4, 3))
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    found = read(model, tmp_path)
    assert [(one.key, one.name) for one in found.storeys] == [("", "1")]
    assert (len(found.pieces), len(found.spaces)) == (1, 1)
    assert [str(text) for text in found.warnings] == [
        "The model has no storeys: all of it was put on one floor, 1. Check Floor in Items."
    ]
    for message in ("has no unit of length", "holds neither storeys nor rooms, furniture or walls with a shape"):
        model = ModelWriter(units=None if "unit" in message else "METRE")
        with pytest.raises(ModelError, match=f"a.ifc {message}"):
            read(model, tmp_path)


def test_types_are_named_as_programs_show_them_and_what_is_no_piece_is_left_out_with_the_reason(tmp_path):
    model, _, room = one_room("IFC2X3")
    fridge = model.element("IfcFlowTerminal", "Fridge:1", SHELF, within=room, at=(2, 1, 0))
    model.element("IfcFlowTerminal", "Mirror", SHELF, within=room, at=(3, 1, 0))
    model.typed("IfcElectricApplianceType", "Fridge", fridge)
    found = read(model, tmp_path)
    assert [one.name for one in found.pieces] == ["Fridge:1"]
    assert [one.type for one in found.skipped] == ["IfcFlowTerminal Mirror"]
    model, _, room = one_room()
    plain = model.piece("Stuhl-017", SHELF, within=room, at=(1, 1, 0))
    model.typed("IfcFurnitureType", "Stuhl 4", plain)
    model.piece("M_Desk:1525 x 762mm:355965", SHELF, within=room, at=(2, 1, 0), Tag="355965")
    model.piece("M_Bed:Queen:Queen:99", SHELF, within=room, at=(3, 1, 0))
    model.piece("  Two\n lines ", SHELF, within=room, at=(4, 1, 0))
    found = read(model, tmp_path)
    assert {one.type for one in found.pieces} == {"Stuhl 4", "M_Desk 1525 x 762mm", "M_Bed Queen", "Two lines"}
    model, storey, room = one_room()
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    model.piece("Wall unit", SHELF, within=room, at=(3, 1, 1.2))
    model.piece("Idea", within=room)
    model.element("IfcBuildingElementProxy", "Tree", SHELF, within=storey, at=(9, 9, 0))
    model.element("IfcTransportElement", "Lift", SHELF, within=storey, at=(5, 1, 0))
    found = read(model, tmp_path)
    assert [one.name for one in found.pieces] == ["Shelf"]
    assert {(one.type, str(one.reason).split(":")[0].split(";")[0], one.is_furniture) for one in found.skipped} == {
        ("IfcFurniture Wall unit", "not on the floor", True), ("IfcFurniture Idea", "no geometry", True),
        ("IfcBuildingElementProxy Tree", "its class is not furniture", False),
        ("IfcTransportElement Lift", "its class is not furniture", False),
    }  # fmt: skip
    model, _, room = one_room()
    model.piece("Sheet", (0, 0, 0, 1e-9, 1.0, 1.0), within=room, at=(2, 1, 0))
    model.piece("Mountain", (0, 0, 0, 1e7, 1e7, 1e7), within=room, at=(2, 1, 0))
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    found = read(model, tmp_path)
    assert "Shelf" in {one.name for one in found.pieces}
    assert all(math.isfinite(one.x + one.y + one.breadth + one.width + one.height) for one in found.pieces)


def test_a_raised_floor_of_a_room_counts_and_a_piece_of_no_storey_stands_on_the_next_below(tmp_path):
    """A platform 60 cm above the storey: what stands on it stands on the floor."""
    model = ModelWriter()
    storey, upper = model.storey(), model.storey("Level 2", 5.0)
    room = model.space(storey, (3, 2, 0.6, 6, 4, 3))
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0.6))
    model.piece("Outside", SHELF, within=model.building, at=(30, 1, 5.0))
    found = {one.name: one for one in read(model, tmp_path).pieces}
    assert found["Shelf"].bottom == pytest.approx(0, abs=1e-6)
    assert (found["Outside"].storey, found["Outside"].space) == (upper.GlobalId, "")


def test_elevations_placements_and_furniture_tell_where_the_floor_of_a_storey_is(tmp_path):
    for storeys, elevations, warned in (
        ([("a", 0.0, 0.0), ("b", 3.0, 3.0), ("c", 6.0, 6.0)], [0, 3, 6], False),
        ([("a", 0.0, 100.0), ("b", 3.0, 103.0), ("c", None, 106.0)], [0, 3, 6], False),
        ([("a", 0.0, 0.0), ("b", 0.0, 3.0), ("c", 0.0, 6.0)], [0, 3, 6], True),
        ([("a", 0.0, 0.0), ("b", 3.0, 0.0), ("c", 6.0, 0.0)], [0, 3, 6], False),
        ([("a", None, -3.0), ("b", None, 0.0)], [-3, 0], False),
        ([("a", None, 3.5)], [3.5], False),
    ):
        model = ModelWriter()
        for name, elevation, z in storeys:
            model.storey(name, elevation, z)
        found = read(model, tmp_path)
        assert [one.name for one in found.storeys] == [name for name, _, _ in storeys], (storeys, elevations)
        assert [one.elevation for one in found.storeys] == pytest.approx(elevations), (storeys, elevations)
        told = "Elevation in the model differs from where these storeys are placed, which was taken: b, c."
        assert any(told in text for text in found.warnings) == warned, (storeys, elevations)
    for levels in ((3.0,), (0.0, 3.0)):
        model = ModelWriter()
        for number, level in enumerate(levels):
            storey = model.storey(f"L{number}", level, z=0.0)
            model.piece("Shelf", SHELF, within=storey, at=(2, 1, level))
        found = read(model, tmp_path)
        assert [round(one.bottom, 3) for one in found.pieces] == [0] * len(levels), levels
        assert [round(one.elevation, 3) for one in found.storeys] == [*levels], levels
    for heights, taken in (
        ((0.2, 0.2, 0.2), 3),  # a floor laid on the slab
        ((1.4, 1.4, 1.4, 1.4), 0),  # hung on walls
        ((0.2, 0.2), 0),  # too few to tell
        ((0.0, 0.0, 0.0, 0.75), 3),  # one stands on a table
    ):
        model = ModelWriter()
        storey = model.storey("L0", 0.0)
        for number, height in enumerate(heights):
            model.piece("Shelf", SHELF, within=storey, at=(2 * number, 1, height))
        found = read(model, tmp_path)
        assert len(found.pieces) == taken, (heights, taken)
        assert sum("stands 0.20 m above where the model has its floor" in str(one) for one in found.warnings) == (
            heights[0] == 0.2 and taken > 0
        )


@pytest.mark.parametrize("site", [0.0, 450.0])
@pytest.mark.parametrize("elevation", [0.0, None])
def test_one_storey_placed_above_zero_keeps_its_furniture(tmp_path, site, elevation):
    model = ModelWriter()
    storey = model.storey("L0", elevation, z=site)
    model.piece("Shelf", SHELF, within=storey, at=(2, 1, site))
    found = read(model, tmp_path)
    assert [(one.name, round(one.bottom, 3)) for one in found.pieces] == [("Shelf", 0)]
    assert not found.warnings


def test_the_parts_of_an_assembly_that_stand_on_each_other_are_one_piece(tmp_path):
    model, storey, room = one_room()
    desk = model.piece("Desk", within=room, at=(3, 3, 0))
    boxes = ((0, 0, 0.7, 0.8, 1.6, 0.04), (0, 0.7, 0, 0.7, 0.05, 0.7), (0, -0.7, 0, 0.7, 0.05, 0.7))
    model.aggregate(desk, *(model.piece(f"Part {number}", one, at=(3, 3, 0)) for number, one in enumerate(boxes)))
    parts = [model.piece(f"part {at}", (0, 0, 0, 0.4, 0.9, 0.5), at=(2, 1, 0.5 * at)) for at in range(4)]
    apart = [model.piece(f"bookcase {at}", SHELF, at=(4, at * 0.8, 0)) for at in range(2)]
    boards = [model.piece(f"side {at}", (0, 0, 0, 0.4, 0.02, 2.0), at=(6, at * 0.88, 0)) for at in range(2)]
    boards += [model.piece(f"shelf {at}", (0, 0, 0, 0.4, 0.86, 0.02), at=(6, 0.44, 0.4 * at)) for at in range(1, 5)]
    for name, own in (("Wardrobe", parts), ("Row", apart), ("Bookcase", boards)):
        whole = model.element("IfcElementAssembly", name, within=storey)
        model.aggregate(whole, *own)
    found = {one.name: one for one in read(model, tmp_path).pieces}
    assert found.keys() == {"Desk", "Wardrobe", "bookcase 0", "bookcase 1", "Bookcase"}
    desk = found["Desk"]
    assert (desk.breadth, desk.width, desk.height, desk.support_breadth) == pytest.approx((0.8, 1.6, 0.74, 0.7))
    for name in ("Wardrobe", "Bookcase"):
        one = found[name]
        assert (one.breadth, one.width, one.height, one.bottom) == pytest.approx((0.4, 0.9, 2, 0))


def test_what_stands_on_a_piece_is_warned_of_and_the_room_that_it_needs_is_not_its_body(tmp_path):
    model, storey, _ = one_room()
    base = model.piece("Base", (0, 0, 0, 0.4, 0.9, 0.5), within=storey, at=(2, 1, 0))
    model.piece("Top", (0, 0, 0, 0.4, 0.9, 1.5), within=storey, at=(2, 1, 0.5))
    clearance = model.solid((0, 0, 0, 2, 2, 2)).Representations[0]
    clearance.RepresentationIdentifier = "Clearance"
    base.Representation.Representations = [*base.Representation.Representations, clearance]
    found = read(model, tmp_path)
    (piece,) = found.pieces
    assert (piece.name, piece.breadth, piece.width, piece.height) == ("Base", *map(pytest.approx, (0.4, 0.9, 0.5)))
    assert "stands on 1 piece, whose height is then not the whole: Base" in str(found.warnings[0])
