"""Files that are no scan, damaged ones and hostile ones: each refused with the place in the file and how to fix it."""

import json
import re

import pytest

from assess.bim import scan_values
from assess.bim.roomplan import read_roomplan
from assess.errors import ModelError
from tests.bim.scan_files import element, office, place, wall, write


def refused(data: bytes) -> str:
    with pytest.raises(ModelError) as raised:
        read_roomplan(data, "s.json")
    return str(raised.value)


@pytest.mark.parametrize(
    ("data", "said"),
    [
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
    ],
)
def test_what_is_no_scan_is_refused(data, said):
    found = refused(data)
    assert said in found
    assert re.search(r"(Export|scan again)", found)


def broken(change, kind="objects", at=3):
    scan = office()
    change(scan[kind][at])
    return refused(write(scan))


@pytest.mark.parametrize(
    ("change", "said"),
    [
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
    ],
)  # fmt: skip
def test_a_fault_names_its_place(change, said):
    found = broken(change)
    assert found.startswith("s.json, ")
    assert said in found
    assert found.endswith("Export the scan again.")


def test_faults_of_surfaces_and_of_rooms_name_theirs():
    assert "walls[2].transform:" in broken(lambda one: one.update(transform=[]), "walls", 2)
    assert "doors[0].dimensions:" in broken(lambda one: one.update(dimensions=[1, -2, 0]), "doors", 0)
    assert "sections[0].center:" in broken(lambda one: one.update(center=[1]), "sections", 0)
    room = office()
    room["objects"][0]["dimensions"] = None
    assert "rooms[1].objects[0].dimensions:" in refused(write({"rooms": [office(objects=[]), room]}))
    assert "objects: expected a list." in refused(write(office(objects={"a": 1})))
    assert "objects[1]: expected an object in braces." in refused(write(office(objects=[office()["objects"][0], 3])))


def test_odd_words_and_numbers_do_no_harm():
    """A category, a label or a story of any kind is taken as text without control characters, or not at all."""
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


def test_a_million_objects_are_refused_before_they_are_read():
    walls = [wall(f"w{at}", 0, at, 5) for at in range(scan_values.MOST_SURFACES + 1)]
    assert "holds more than 500 walls" in refused(write(office(walls=walls)))
    many = b'{"objects": [' + b",".join([b'{"a": [0, 0, 0]}'] * 1_000_000) + b"]}"
    assert "holds more than 4,000,000 values" in refused(many)
    few = b'{"objects": [' + b",".join([b"{}"] * 500_000) + b"]}"
    assert "holds more than 5,000 objects, the most that is read of a scan. Scan fewer rooms at a time." in refused(few)


def test_a_large_file_is_refused_unless_its_bulk_is_one_text(monkeypatch):
    monkeypatch.setattr(scan_values, "MOST_BYTES", 100_000)
    read_roomplan(write(office(coreModel="A" * 60_000)), "s.json")
    assert "larger than 0 MB" in refused(write(office(coreModel="A" * 100_000)))


def test_deep_nesting_of_what_is_not_read_is_refused():
    deep = json.dumps(office()).removesuffix("}") + ', "coreModel": ' + "[" * 200_000 + "]" * 200_000 + "}"
    assert "cannot be read as JSON" in refused(deep.encode())
