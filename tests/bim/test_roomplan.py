"""Scans of RoomPlan, made by hand after its Swift types: pieces, rooms, doors and walls, and what is not taken."""

import copy
import json
import math
import re
from typing import Any

import pytest
import shapely

import assess
from assess.bim import roomplan
from assess.bim.model_rows import list_building
from assess.bim.plan_shapes import to_polygon
from assess.bim.read_source import read_source
from assess.bim.roomplan import EXITS, EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, read_roomplan
from assess.errors import ModelError
from tests.bim.ifc_files import write_import
from tests.bim.scan_files import element, identify, lie, office, place, wall, write

NAME = "office.json"


def read(document):
    return read_roomplan(write(document), NAME)


def pieces_of(model):
    return {one.key: one for one in model.pieces}


def test_pieces_have_sizes_positions_and_directions_also_in_files_of_ios_16():
    model = read(office())
    assert (model.source, model.schema, model.sizes_from) == (NAME, "RoomPlan", "scan")
    assert [one.type for one in model.pieces] == ["Storage", "Storage", "Table", "Chair"]
    bookcase, cabinet = pieces_of(model)[identify("bookcase")], pieces_of(model)[identify("cabinet")]
    assert (bookcase.breadth, bookcase.width, bookcase.height) == (0.3, 0.9, 2.0)
    assert (bookcase.x, bookcase.y) == pytest.approx((0.5, 1.85))
    assert abs(bookcase.angle_deg) == pytest.approx(90), "its depth runs along Y"
    assert (cabinet.x, cabinet.y, cabinet.breadth) == pytest.approx((2.275, -0.6, 0.45))
    assert cabinet.angle_deg == pytest.approx(0, abs=1e-6)
    assert pieces_of(model)[identify("chair")].angle_deg in (pytest.approx(30), pytest.approx(-60)), "it is square"
    assert [one.bottom for one in model.pieces] == pytest.approx([0] * len(model.pieces), abs=1e-9)
    assert {one.space for one in model.pieces} == {identify("floor")}
    other = office()
    for kind in ("objects", "walls", "doors", "windows", "floors"):
        for one in other[kind]:
            one["category"], one["confidence"] = next(iter(one["category"])), "high"
            one["transform"] = [one["transform"][at : at + 4] for at in range(0, 16, 4)]
    assert read(other) == read(office())
    old = office()
    del old["floors"], old["sections"], old["story"]
    for kind in ("objects", "walls", "doors", "windows"):
        for one in old[kind]:
            del one["story"]
    model, new = read(old), read(office())
    assert pieces_of(model).keys() == pieces_of(new).keys()
    (room,) = model.spaces
    assert room.name == "Room 1"
    assert to_polygon(room.area).area == pytest.approx(20, abs=0.01)
    assert [one.level for one in model.storeys] == [pytest.approx(0)]


def test_a_scan_that_began_askew_is_turned_along_its_walls():
    """All of it turned about the vertical axis: the plan comes out as before, or a quarter turn from it."""
    for turn in (17.0, -31.0, 44.0):
        askew, c, s = office(), math.cos(math.radians(turn)), math.sin(math.radians(turn))
        for one in (one for kind in ("objects", "walls", "doors", "windows", "floors") for one in askew[kind]):
            columns = [one["transform"][at : at + 3] for at in range(0, 16, 4)]
            turned = [(c * x + s * z, y, -s * x + c * z) for x, y, z in columns]
            one["transform"] = [value for own, last in zip(turned, (0, 0, 0, 1), strict=True) for value in (*own, last)]
        model = read(askew)
        for one in read(office()).pieces:
            found = pieces_of(model)[one.key]
            assert (found.x, found.y) == pytest.approx((one.x, one.y), abs=1e-9)
            assert math.cos(math.radians(2 * (found.angle_deg - one.angle_deg))) == pytest.approx(1)
        walls = shapely.union_all([to_polygon(one) for one in model.walls["0"]])
        assert walls.bounds == pytest.approx((-2.55, -2.05, 2.55, 2.05), abs=2e-3)


def test_what_is_no_piece_is_listed_with_its_reason_and_a_free_standing_oven_taken():
    scan = office()
    cabinet = scan["objects"][1]["identifier"]
    scan["objects"] += [
        *(element(one, one, (0.6, 0.8, 0.6), place(-2, 0.4, 1)) for one in ("sink", "toilet", "bathtub", "fireplace")),
        element("oven", "oven", (0.6, 0.6, 0.55), place(2, 0.3, 1), parentIdentifier=cabinet),
        element("television", "television", (1.2, 0.7, 0.1), place(0, 1.1, 1.9)),
        element("bed", "tilted", (1, 2, 0.5), lie(0, 0.2, 0)),
        element("stairs", "stairs", (1, 2.8, 4), place(1, 1.4, 1)),
    ]
    model = read(scan)
    assert pieces_of(model).keys() == pieces_of(read(office())).keys()
    found = {
        (one.type.removeprefix("RoomPlan "), str(one.reason), one.count, one.is_furniture) for one in model.skipped
    }
    hanging = "not on the floor: its lowest point is more than 15 cm above it"
    assert found == {
        *((kind, "fixed to the building", 1, False) for kind in ("Sink", "Toilet", "Bathtub", "Fireplace", "Stairs")),
        ("Oven", "built into a cabinet, which is imported", 1, False), ("Bed", "not upright", 1, True),
        ("Storage", hanging, 1, True), ("Television", hanging, 1, True),
    }  # fmt: skip
    assert [(one.storey, one.end) for one in model.stairs] == [("0", "foot")]
    scan = office()
    scan["objects"] += [element("oven", "oven", (0.6, 0.9, 0.6), place(-2, 0.45, 1)),
                        element("washerDryer", "washer", (0.6, 0.85, 0.6), place(-2, 0.43, 0)),
                        element("plantPot2D", "pot", (0.4, 0.6, 0.4), place(2, 0.3, 1.5))]  # fmt: skip
    model = read(scan)
    assert {one.type: one.is_fitted for one in model.pieces[-3:]} == {
        "Oven": True, "Washer dryer": False, "Plant pot2d": False,
    }  # fmt: skip


def test_remarks_say_what_a_scan_does_not_know_and_rooms_have_outlines_and_the_names_of_all_their_uses():
    assert read(office()).warnings == (EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, EXITS)
    assert EXITS not in read(office(doors=[])).warnings
    assert read(office()).remarks == ()
    scan = office()
    scan["objects"][0]["confidence"] = scan["objects"][3]["confidence"] = {"low": {}}
    assert [str(one) for one in read(scan).remarks] == [
        "2 pieces were recognised with low confidence: check what they are: Storage (1), Chair (1)."
    ]
    for bare in (office(objects=[]), office(objects=None)):
        model = read(bare)
        assert (len(model.pieces), len(model.spaces)) == (0, 1)
        assert [str(one) for one in model.remarks] == ["The scan holds no objects: fill in Items by hand."]
    labels = [{"label": {"kitchen": {}}, "center": [-1, 0, 0]}, {"label": "diningRoom", "center": [1, 0, 0]},
              {"label": "unidentified", "center": [1, 0, 1]}]  # fmt: skip
    assert [one.name for one in read(office(sections=labels)).spaces] == ["Kitchen / Dining room"]
    (room,) = read(office()).spaces
    assert (room.key, room.storey, room.name) == (identify("floor"), "0", "Living room")
    assert to_polygon(room.area).bounds == pytest.approx((-2.5, -2, 2.5, 2))
    for sizes, at in (((5, 4, 0), lie(0, 0, 0)), ((5, 0, 4), place(0, 0, 0))):  # without an outline
        (room,) = read(office(floors=[element("floor", "floor", sizes, at)])).spaces
        assert to_polygon(room.area).bounds == pytest.approx((-2.5, -2, 2.5, 2))


def test_walls_that_close_no_room_their_gaps_at_doors_and_windows_and_low_openings_as_doors():
    scan = office(floors=[])
    assert len(read(scan).spaces) == 1
    del scan["walls"][0]
    model = read(scan)
    assert not model.spaces
    assert {one.space for one in model.pieces} == {""}
    model = read(office())
    walls = shapely.union_all([to_polygon(one) for one in model.walls["0"]])
    assert not walls.intersects(shapely.Point(-1.5, -2)), "the door"
    assert not walls.intersects(shapely.Point(1, 2)), "the window"
    assert walls.covers(shapely.Point(0, -2))
    (window,) = model.windows["0"]
    assert to_polygon(window).bounds == pytest.approx((0.4, 1.95, 1.6, 2.05))
    scan = office()
    scan["walls"].append(wall("bay", 0, -3, 4, curve={"radius": 2.0}))
    curved = read(scan)
    assert curved.walls == model.walls
    assert [str(one) for one in curved.remarks] == ["1 curved wall is not drawn."]
    scan = office()
    scan["openings"] = [element("opening", "way", (1.2, 2.1, 0), place(2.5, 1.05, -1, 90)),
                        element("opening", "hatch", (0.8, 0.8, 0), place(2.5, 1.4, 1, 90))]  # fmt: skip
    door, way = read(scan).doors
    assert (door.key, door.x, door.y, door.width, door.overall) == (identify("door"), -1.5, -2, 0.9, 0.9)
    assert math.cos(math.radians(2 * door.normal_deg)) == pytest.approx(-1), "along Y"
    assert (way.key, way.x, way.y, way.width, way.overall) == (identify("way"), 2.5, 1, 1.2, 0)
    assert math.cos(math.radians(2 * way.normal_deg)) == pytest.approx(1), "along X"


def structure():
    """Two rooms side by side below, one above at 2.8 m with a stair, merged; its rooms lie in axes of their own."""
    below, beside, above = (office(identifier=identify(name)) for name in ("a", "b", "c"))
    merged: dict[str, Any] = {"identifier": identify("structure"), "version": 2, "rooms": [below, beside, above]}
    for number, (room, (x, y, story)) in enumerate(
        zip((below, beside, above), ((0, 0, 0), (5.1, 0, 0), (0, 2.8, 1)), strict=True)
    ):
        for kind in ("walls", "doors", "windows", "openings", "floors", "objects"):
            moved = copy.deepcopy(room[kind])
            for one in moved:
                one["identifier"], one["story"], one["parentIdentifier"] = f"{one['identifier']} {number}", story, None
                one["transform"][12] += x
                one["transform"][13] += y
            merged.setdefault(kind, []).extend(moved)
    merged["sections"] = [
        {"label": "livingRoom", "center": [0, 0, 0], "story": 0}, {"label": "kitchen", "center": [5, 0, 0], "story": 0},
        {"label": "bedroom", "center": [0, 2.8, 0], "story": 1},
    ]  # fmt: skip
    merged["objects"].append(element("stairs", "stairs", (1, 2.8, 3), place(1.9, 1.4, 0)))
    return merged


def test_a_structure_has_storeys_and_named_rooms_and_becomes_a_workbook_that_is_read(tmp_path):
    model = read(structure())
    assert [(one.key, one.name, one.elevation) for one in model.storeys] == [
        ("0", "Storey 0", 0), ("1", "Storey 1", pytest.approx(2.8)),
    ]  # fmt: skip
    assert [(one.storey, one.name) for one in model.spaces] == [
        ("0", "Living room"), ("0", "Kitchen"), ("1", "Bedroom"),
    ]  # fmt: skip
    rooms = {one.key: one.name for one in model.spaces}
    assert [rooms[one.space] for one in model.pieces if one.type == "Table"] == ["Living room", "Kitchen", "Bedroom"]
    assert [one.bottom for one in model.pieces] == pytest.approx([0] * len(model.pieces), abs=1e-9)
    assert [(one.storey, one.end) for one in model.stairs] == [("0", "foot"), ("1", "head")]
    both = [office(), office(identifier=identify("b"))]
    for one in both[1]["objects"]:
        one["identifier"] += " b"
    listed, named = read(both), read({"rooms": both})
    assert listed == named
    assert len(listed.pieces) == 8
    assert any("The 2 rooms were scanned one by one" in str(one) for one in listed.warnings)
    assert not any("one by one" in str(one) for one in read(structure()).warnings)
    found = list_building(read(structure()))
    assert {row["sizes_from"] for row in found.items} == {"scan"}
    assert [row["floor"] for row in found.floors] == ["Storey 0", "Storey 1"]
    assert set(found.files) == {row["plan"] for row in found.floors}
    assert "height" not in found.building, "a ceiling is no roof"
    inventory = assess.read_inventory(write_import(found, tmp_path), building={"ground_pga": 0.3})
    assert [one.is_scanned for one in inventory.items] == [True] * len(found.items)
    assert {one.room for one in inventory.items} <= {one.place for one in inventory.places}
    assert all(floor.plan for floor in inventory.floors)
    path = tmp_path / "scan.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(office(), indent=1).encode())
    assert len(read_source(path, "scan.json").items) == 4


def refused(data: bytes) -> str:
    with pytest.raises(ModelError) as raised:
        read_roomplan(data, "s.json")
    return str(raised.value)


def test_what_is_no_scan_is_refused_and_a_fault_names_its_place():
    for data, said in (
        (b"", "s.json is not complete JSON: line 1, column 1."),
        (b"{", "s.json is not complete JSON: line 1, column 2."),
        (write(office())[:-200], "s.json is not complete JSON: line 1, column"),
        (b'{"objects": [}', "s.json is not complete JSON: line 1, column 14."),
        (b'{"objects": "\xff\xfe"}', "s.json cannot be read as JSON."),
        (b"[" * 100_000, "s.json cannot be read as JSON."),
        (b'{"objects": [' + b"9" * 5000 + b"]}", "s.json cannot be read as JSON."),
        (b"[1, 2]", "s.json is not a scan of RoomPlan: it has none of the lists objects, walls,"),
        (b'"text"', "is not a scan of RoomPlan"),
        (b"{}", "is not a scan of RoomPlan"),
        (b'{"type": "FeatureCollection", "features": []}', "is not a scan of RoomPlan"),
        (b'{"rooms": [{"name": "Kitchen", "area": 12}]}', "is not a scan of RoomPlan"),
        (b'{"rooms": {}, "objects": {}}', "is not a scan of RoomPlan"),
    ):
        found = refused(data)
        assert said in found, (data, said)
        assert re.search(r"(Export|scan again)", found), (data, said)
    for change, said in (
        (lambda one: one.update(dimensions=[0.5, 0.9]), "objects[3].dimensions: expected three numbers in metres"),
        (lambda one: one.update(dimensions={"x": 1, "y": 1, "z": 1}), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[0.5, 0.9, float("nan")]), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[0.5, float("inf"), 0.5]), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[0.5, 10**400, 0.5]), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[0.5, "0.9", 0.5]), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[True, 0.9, 0.5]), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.update(dimensions=[0.5, 0, 0.5]), "objects[3].dimensions: a size of 0 m is not above 0."),
        (lambda one: one.update(dimensions=[-0.5, 0.9, 0.5]), "objects[3].dimensions: a size of -0.5 m is not above"),
        (lambda one: one.pop("dimensions"), "objects[3].dimensions: expected three numbers"),
        (lambda one: one.pop("transform"), "objects[3].transform: expected 16 numbers, or 4 lists of 4"),
        (lambda one: one.update(transform=one["transform"][:12]), "objects[3].transform: expected 16 numbers"),
        (lambda one: one.update(transform=[[1, 0, 0, 0]] * 3), "objects[3].transform: expected 16 numbers"),
        (lambda one: one["transform"].__setitem__(12, float("nan")), "objects[3].transform: expected 16 numbers"),
        (lambda one: one["transform"].__setitem__(12, 2e4), "objects[3].transform: expected 16 numbers"),
        (lambda one: one.update(transform=[0] * 16), "transform: it does not hold a rotation and"),
        (lambda one: one.update(transform=[1, 0, 0, 3, 0, 1, 0, 2, 0, 0, 1, 1, 0, 0, 0, 1]), "not hold a rotation"),
        (lambda one: one.update(transform=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]), "not hold a rotation"),
        (lambda one: one.update(polygonCorners=[[0, 0]]), "objects[3].polygonCorners: expected points of three"),
        (lambda one: one.update(polygonCorners="none"), "objects[3].polygonCorners: expected points of three numbers"),
        (lambda one: one.pop("identifier"), "objects[3].identifier: it is missing."),
        (lambda one: one.update(identifier=office()["objects"][1]["identifier"]),
         "objects[3].identifier: objects[1] has the same one."),
    ):  # fmt: skip
        found = broken(change)
        assert found.startswith("s.json, "), (change, said)
        assert said in found, (change, said)
        assert found.endswith("Export the scan again."), (change, said)
    assert "walls[2].transform:" in broken(lambda one: one.update(transform=[]), "walls", 2)
    assert "doors[0].dimensions:" in broken(lambda one: one.update(dimensions=[1, -2, 0]), "doors", 0)
    assert "sections[0].center:" in broken(lambda one: one.update(center=[1]), "sections", 0)
    room = office()
    room["objects"][0]["dimensions"] = None
    assert "rooms[1].objects[0].dimensions:" in refused(write({"rooms": [office(objects=[]), room]}))
    assert "objects: expected a list." in refused(write(office(objects={"a": 1})))
    assert "objects[1]: expected an object in braces." in refused(write(office(objects=[office()["objects"][0], 3])))
    # A category, a label or a story of any kind is taken as text without control characters, or not at all.
    scan = office(sections=[{"label": "\u202ekit\x00chen", "center": None}])
    scan["objects"][0] |= {"category": "\ud800=cmd()", "confidence": 3, "story": "two", "parentIdentifier": 5}
    scan["objects"][1] |= {"category": {}, "story": 10**30}
    model = read_roomplan(write(scan), "s.json")
    assert [one.type for one in model.pieces] == ["=cmd()", "Object", "Table", "Chair"]
    assert [one.name for one in model.spaces] == ["Kitchen"]
    assert [one.key for one in model.storeys] == ["0"]
    bow = [[-2, 0, -2], [2, 0, 2], [2, 0, -2], [-2, 0, 2]]
    floor = element("floor", "f", (5, 4, 0), place(0, 0, 0), polygonCorners=bow)
    assert len(read_roomplan(write(office(floors=[floor])), "s.json").spaces) == 1, "an outline that crosses itself"


def broken(change, kind="objects", at=3):
    scan = office()
    change(scan[kind][at])
    return refused(write(scan))


def test_a_million_objects_deep_nesting_and_a_large_file_are_refused(monkeypatch):
    walls = [wall(f"w{at}", 0, at, 5) for at in range(roomplan.MOST_SURFACES + 1)]
    assert "holds more than 500 walls" in refused(write(office(walls=walls)))
    many = b'{"objects": [' + b",".join([b'{"a": [0, 0, 0]}'] * 1_000_000) + b"]}"
    assert "holds more than 4,000,000 values" in refused(many)
    few = b'{"objects": [' + b",".join([b"{}"] * 500_000) + b"]}"
    assert "holds more than 5,000 objects, the most that is read of a scan. Scan fewer rooms at a time." in refused(few)
    deep = json.dumps(office()).removesuffix("}") + ', "coreModel": ' + "[" * 200_000 + "]" * 200_000 + "}"
    assert "cannot be read as JSON" in refused(deep.encode())
    monkeypatch.setattr(roomplan, "MOST_BYTES", 100_000)
    read_roomplan(write(office(coreModel="A" * 60_000)), "s.json")
    assert "larger than 0 MB" in refused(write(office(coreModel="A" * 100_000)))
