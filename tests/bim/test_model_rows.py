"""Rows of an inventory out of a building model: names, sizes with which a piece rocks, places, plans."""

import math
import re
from dataclasses import replace

import pytest

from assess.bim.building_model import BuildingModel, Door, Piece, Space, Storey
from assess.bim.floor_drawing import name_plan, name_plans
from assess.bim.model_rows import find_kind, find_sizes, list_building
from assess.plans import read_plan
from assess.workbook.values import parse_outline

STOREY = Storey("s", "Level 1", 0.0, 0.0)
ROOM = ((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))
SPACE = Space("r", "s", "101", "Office", (ROOM,), 0.0, 3.0)
PIECE = Piece("p", "s", "r", "IfcFurniture", "Shelf", "Shelf", 2.0, 1.0, 0.4, 0.8, 1.9, 30.0, 0.4, 0.8, 0.0)


def model(**more: object) -> BuildingModel:
    values = {"source": "a.ifc", "schema": "IFC4", "storeys": (STOREY,), "spaces": (SPACE,), "pieces": (PIECE,)}
    return BuildingModel(**{**values, **more})


def test_breadth_is_the_shortest_distance_between_outer_supports_of_which_those_off_the_middle_are_told():
    for supports, sizes, angle, is_inset in (
        ((0.4, 0.8), (40.0, 80.0), 30.0, False), ((0.397, 0.8), (40.0, 80.0), 30.0, False),
        ((0.3, 0.8), (30.0, 80.0), 30.0, True), ((0.3, 0.35), (30.0, 80.0), 30.0, True),
        ((0.4, 0.25), (25.0, 40.0), -60.0, True), ((0.38, 0.25), (25.0, 40.0), -60.0, True),
    ):  # fmt: skip
        found = find_sizes(replace(PIECE, support_breadth=supports[0], support_width=supports[1]))
        assert ((found.breadth, found.width), found.height) == (sizes, 190.0), (supports, sizes)
        assert (found.angle_deg, found.is_inset) == (angle, is_inset), (supports, sizes)
        assert found.breadth <= found.width, (supports, sizes)
    front = replace(PIECE, breadth=0.6, support_breadth=0.5, support_reach=0.2, support_angle_deg=30.0)
    found = find_sizes(front)
    assert (found.breadth, found.width, found.angle_deg, found.safe) == (50.0, 80.0, 30.0, 40.0)
    assert (found.is_inset, found.is_off_middle, found.is_oblique) == (True, True, False)
    side = find_sizes(replace(front, support_reach=0.15, support_angle_deg=-60.0))
    assert (side.breadth, side.width, side.angle_deg, side.safe) == (50.0, 80.0, 30.0, 30.0)
    building = list_building(model(pieces=(front,)))
    (row,) = building.items
    assert row["notes"] == (
        "body 60.0 x 80.0 x 190.0 cm, 50 cm between the outer supports, which are off the middle: to one side it tips "
        "as with a Breadth of 40 cm"
    )
    assert any("1 piece stands off the middle of its supports" in text for text in building.warnings)
    chair = replace(PIECE, breadth=0.7, width=0.7, support_breadth=0.7, support_width=0.7, support_reach=0.265,
                    support_angle_deg=75.0, support_across=0.8)  # fmt: skip
    found = find_sizes(chair)
    assert (found.breadth, found.width, found.angle_deg) == (53.0, 80.0, 75.0)
    (row,) = list_building(model(pieces=(chair,))).items
    assert row["notes"].endswith(
        " between the outer supports: Breadth is twice the distance from the middle to the nearest edge between them"
    )
    for piece in (PIECE, replace(PIECE, support_breadth=0.3), replace(PIECE, support_breadth=0.4, support_width=0.25)):
        reach = min(piece.support_breadth, piece.support_width) / 2
        angle = 30.0 if piece.support_breadth < piece.support_width else -60.0
        assert find_sizes(replace(piece, support_reach=reach, support_angle_deg=angle)) == replace(
            find_sizes(piece), piece=replace(piece, support_reach=reach, support_angle_deg=angle)
        )


def test_pieces_that_cannot_be_taken_are_left_out_and_others_told_apart_by_their_names():
    beside = replace(PIECE, key="r", type="Easel", support_reach=0.0)
    tall = replace(PIECE, key="q", type="Mast", height=9.0)
    thin = replace(PIECE, key="t", type="Leg", support_breadth=0.02)
    found = list_building(model(pieces=(PIECE, beside, tall, thin)))
    assert [row["source_id"] for row in found.items] == ["p"]
    assert {(one.type, str(one.reason)) for one in found.skipped} == {
        ("Easel", "the middle of its body is not above its base in the model"),
        ("Mast", "a size outside 5 to 600 cm"), ("Leg", "a size outside 5 to 600 cm"),
    }  # fmt: skip
    assert not found.is_complete
    pieces = tuple(replace(PIECE, key=f"p{n}", x=float(n)) for n in range(3))
    found = list_building(model(pieces=(*pieces, replace(PIECE, key="q", space=""))))
    assert [(row["item"], row.get("room")) for row in found.items] == [
        ("101-01", "101 Office"), ("101-02", "101 Office"), ("101-03", "101 Office"), ("Level 1-01", None),
    ]  # fmt: skip
    upper = Storey("u", "Level 2", 3.0, 3.0)
    above = replace(SPACE, key="r2", storey="u", bottom=3.0, top=6.0)
    pieces = (PIECE, replace(PIECE, key="q", storey="u", space="r2"))
    found = list_building(model(storeys=(STOREY, upper), spaces=(SPACE, above), pieces=pieces))
    assert [row["place"] for row in found.places] == ["Level 1 101 Office", "Level 2 101 Office"]
    assert [(row["item"], row["room"]) for row in found.items] == [
        ("Level 1-01", "Level 1 101 Office"), ("Level 2-01", "Level 2 101 Office"),
    ]  # fmt: skip
    found = list_building(model(pieces=(PIECE, replace(PIECE, key="q", height=1.0))))
    assert [(row["type"], row["height"]) for row in found.types] == [("Shelf", 190.0), ("Shelf (2)", 100.0)]
    heights = {row["type"]: row["height"] for row in found.types}
    assert all(heights[row["type"]] == row["height"] for row in found.items)


LONG = ((0.0, 0.0), (12.0, 0.0), (12.0, 2.0), (0.0, 2.0))
ANGLED = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (7.5, 9.0), (7.5, 1.5), (0.0, 1.5))


CORRIDORS = "Corridor", "Flur EG", "Corridor1/Lobby", "Hallway"
ROOMS = "Office", "Eingangshalle", "Lecture hall", "Dining hall", "Town hall office", "Gangster room", "Hall", "Stair 2"
STAIRS = "Scala A", "Treppenhaus", "Stair 2", "S-101 STAIR"


def test_corridors_and_stairs_have_a_word_for_it_and_are_slender_or_hold_an_end_of_a_stair():
    for title in (*CORRIDORS, *ROOMS, "Passages archive"):
        kind = "corridor" if title in CORRIDORS else "room"
        for area in (LONG, ANGLED):
            assert find_kind(replace(SPACE, title=title, area=(area,))) == kind, title
        assert find_kind(replace(SPACE, title=title), doors=2) == "room"
        assert find_kind(replace(SPACE, title=title), doors=3) == kind
    for title in (*STAIRS, "Upstairs office", "Scaleworks", "Office"):
        assert find_kind(replace(SPACE, title=title), holds_stair=True) == ("stair" if title in STAIRS else "room")
        assert find_kind(replace(SPACE, title=title)) == "room"


def test_an_outline_is_simplified_to_what_a_cell_takes_and_names_of_plans_are_plain_and_each_its_own():
    (row,) = list_building(model()).places
    assert set(parse_outline(row["outline"], 1.0)) == set(ROOM)
    ring = tuple((5 + 4 * math.cos(at / 100), 5 + 4 * math.sin(at / 100)) for at in range(628))
    (row,) = list_building(model(spaces=(replace(SPACE, area=(ring,)),), pieces=())).places
    assert len(parse_outline(row["outline"], 1.0)) <= 200
    for source, storey, name in (
        ("duplex.ifc", "Level 1", "duplex-Level-1.svg"), ("a b.ifc", "Erdgeschoß / Süd", "a-b-Erdgescho-Sud.svg"),
        ("模型.ifc", "一階", "plan.svg"), ("x" * 200, "y", "x" * 60 + ".svg"), ("../../a.ifc", "..", "a.svg"),
    ):  # fmt: skip
        assert name_plan(source, storey) == name
    assert name_plans("a.ifc", ["一层", "二层", "Level-1", "level 1"]) == [
        "a.svg", "a-2.svg", "a-Level-1.svg", "a-level-1-2.svg"
    ]  # fmt: skip


def test_plans_of_published_models_are_read_as_reports_read_them(published):
    found = list_building(published)
    floors = [row for row in found.floors if "plan" in row]
    assert {row["plan"] for row in floors} == set(found.files)
    for row in floors:
        data = found.files[row["plan"]]
        assert len(data) < 20_000
        plan = read_plan(data, row["plan_width"])
        assert plan.is_lines
        assert plan.left_out == ()
        box = [float(one) for one in re.search(rb'viewBox="0 0 ([\d.]+) ([\d.]+)"', data).groups()]
        assert box[0] == pytest.approx(row["plan_width"])
        assert plan.aspect == pytest.approx(box[1] / box[0], abs=1e-3)
        for item in (one for one in found.items if one["floor"] == row["floor"]):
            assert row["plan_left"] < item["x"] < row["plan_left"] + box[0]
            assert row["plan_bottom"] < item["y"] < row["plan_bottom"] + box[1]


def test_roof_and_storeys_fitted_furniture_and_doors_become_rows():
    assert list_building(model()).building["height"] == 3.0
    roof = Storey("t", "Roof", 7.5, 7.5)
    assert list_building(model(storeys=(STOREY, roof))).building["height"] == 7.5
    upper = Storey("u", "Level 2", 3.0, 3.0)
    found = list_building(model(storeys=(STOREY, upper), spaces=(), pieces=(), walls={"s": ((ROOM,),)}))
    assert [row["floor"] for row in found.floors] == ["Level 1", "Level 2"]
    assert not found.is_complete
    found = list_building(model(pieces=(replace(PIECE, is_fitted=True),)))
    (row,) = found.items
    assert row["anchored"] == "unknown"
    assert "fitted furniture, usually fixed: look at it, and fill in Anchored" in row["notes"]
    assert "anchored" not in list_building(model()).items[0]
    inner = Door("d1", "s", "", 6.0, 2.0, 0.0, 0.9, 0.2, 0.9)
    outer = Door("d2", "s", "", 0.0, 2.0, 0.0, 1.0, 0.2, 1.0)
    other = replace(SPACE, key="r2", name="102", area=(tuple((x + 6.2, y) for x, y in ROOM),))
    found = list_building(model(spaces=(SPACE, other), doors=(replace(inner, x=6.1), replace(outer, x=-0.1))))
    rows = {row["place"]: row for row in found.places}
    assert set(rows) == {"101 Office", "102 Office", "Door 101 / 102", "Exit 101"}
    assert (rows["Exit 101"]["kind"], rows["Door 101 / 102"]["kind"]) == ("exit", "door")
    assert "Doors that lead out of the ground storey (a room on one side only): 1 of 2." in found.remarks
