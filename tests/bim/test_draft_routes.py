"""Routes drafted from building models: every room is joined to a way out, through doors and not through walls."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from hypothesis import given, settings, strategies as st
from shapely import LineString, Point, union_all

import assess
from assess.bim.building_model import BuildingModel, Door, Piece, Space, Stair, Storey
from assess.bim.draft_floor import FAR, build_plan, find_kinds, find_room_points, find_sides, link_door
from assess.bim.draft_routes import DraftRoutes, draft_routes, measure_gap
from assess.bim.model_rows import list_building
from assess.bim.plan_shapes import box_at, direction_of, to_polygon
from assess.model import Inventory
from assess.results import Results
from assess.workbook.draft_names import is_draft
from assess.workbook.names import key
from assess.workbook.read import read_inventory
from assess.workbook.schema import DEFAULT_WIDTH
from tests.bim.ifc_files import write_import
from tests.bim.office_models import build_office, door, name_all, piece, rectangle
from tests.workbooks import UNVERIFIED

BESIDE = 0.05
"""By so much a segment may leave rooms and doors [m]."""


OFFICES = {
    "one storey": build_office(2, 4),
    "two storeys": build_office(1, 4, storeys=2),
    "bare": build_office(1, 5, storeys=3, furnished=False),
}


def draft(model: BuildingModel, names: Mapping[str, str] | None = None) -> DraftRoutes:
    return draft_routes(model, names or name_all(model), find_sides(model), find_room_points(model))


@pytest.fixture(scope="module", params=["duplex", "large", *OFFICES])
def drafted(request) -> tuple[BuildingModel, DraftRoutes]:
    model = OFFICES[request.param] if request.param in OFFICES else request.getfixturevalue(request.param)
    return model, draft(model)


@pytest.fixture(scope="module")
def of_duplex(duplex) -> DraftRoutes:
    return draft(duplex)


# ---------------------------------------------------------------- what is looked at


def list_lines(model: BuildingModel, draft: DraftRoutes) -> Iterator[tuple[Mapping[str, Any], LineString, str]]:
    """Yield the segments on storeys with their lines and the keys of their storeys."""
    names, rooms, storeys = name_all(model), find_room_points(model), {one.name: one.key for one in model.storeys}
    places = {names[one.key]: rooms[one.key] for one in model.spaces}
    places |= {names[one.key]: (one.x, one.y) for one in model.doors}
    places |= {names[f"{one.key} {one.end}"]: (one.x, one.y) for one in model.stairs}
    places |= {one["place"]: (one["x"], one["y"]) for one in draft.places}
    for row in draft.routes:
        if "floor" in row:
            yield row, LineString([places[row["start"]], places[row["end"]]]), storeys[row["floor"]]


# ---------------------------------------------------------------- geometry


def test_every_segment_lies_in_its_rooms_crosses_no_wall_and_joins_every_room_to_an_exit(drafted):
    model, found = drafted
    names = name_all(model)
    rooms = {names[one.key]: to_polygon(one.area) for one in model.spaces}
    stairs = {names[f"{one.key} {one.end}"] for one in model.stairs}
    plans = {one.key: build_plan(model, one) for one in model.storeys}
    for row, line, storey in list_lines(model, found):
        assert line.length > 0.02
        assert line.intersection(plans[storey].solids_near(line)).length <= BESIDE, row
        doors = [box_at((one.x, one.y), direction_of(one.normal_deg), one.thickness / 2 + BESIDE, one.width / 2)
                 for one in model.doors if one.storey == storey]  # fmt: skip
        area = union_all([*(rooms[name] for name in row["room"].split("; ")), *doors]).buffer(BESIDE)
        outside = line.difference(area)
        if {row["start"], row["end"]} & stairs:  # a stair may stand in a void next to its room
            assert outside.length < FAR, row
        else:
            assert outside.is_empty, (row, outside.wkt)
    # Over stairs, too: a row of the route to a stair is its flight.
    model, found = drafted
    names, kinds = name_all(model), find_kinds(model, find_sides(model))
    graph = nx.Graph([(row["start"], row["end"]) for row in found.routes])
    exits = {names[one] for one, kind in kinds.items() if kind == "exit"}
    lost = {names[one.key] for one in model.spaces if one.title == "Roof"}
    for space in model.spaces:
        name = names[space.key]
        is_out = name in graph and not exits.isdisjoint(nx.node_connected_component(graph, name))
        assert is_out != (name in lost), name
    assert set(found.unreached) == lost


# ---------------------------------------------------------------- routes


def test_rooms_of_a_basement_go_up_the_nearest_exit_is_taken_and_each_step_leads_on_to_the_next():
    office = build_office(1, 3, storeys=3)
    lowered = replace(office, storeys=tuple(replace(one, elevation=one.elevation - 3.5) for one in office.storeys))
    out = [door("way out", -0.05, 6.1, 0.0, "1")]
    walls = {key: tuple(one for one in own if one[0][0] != (-0.1, 0.0) or one[0][1][0] > 0.1) for key, own in
             lowered.walls.items()}  # fmt: skip
    model = replace(
        lowered, doors=tuple(one for one in lowered.doors if "exit" not in one.key) + tuple(out), walls=walls
    )
    found = draft(model)
    assert found.unreached == ()
    flights = {(row["start"], row["end"]) for row in found.routes if "floor" not in row}
    assert flights == {("Stair 1 s0, foot", "Stair 1 s0, head"), ("Stair 2 s0, head", "Stair 2 s0, foot")}
    routes = draft(build_office(1, 8, storeys=2)).routes
    route = {row["start"]: row["route"] for row in routes}
    assert len(route) == len(routes)
    assert route["Room 0 c0 r00"] == "To Door 0 c0 exit0 (draft)"
    assert route["Room 0 c0 r07"] == "To Door 0 c0 exit1 (draft)"
    assert {row["end"] for row in routes} - route.keys() == {"Door 0 c0 exit0", "Door 0 c0 exit1"}


# ---------------------------------------------------------------- widths, rooms, names


def test_widths_are_known_at_doors_and_in_corridors_alone_and_names_are_each_their_own():
    for row in draft(build_office(1, 4)).routes:
        is_door = any(row[end].startswith("Door") for end in ("start", "end"))
        if is_door:
            assert (row["clear_width"], row["required_width"]) == (0.8, 0.8)
            assert row["notes"] == (
                "Clear width: the door's 0.90 m in the model less 0.1 m for frame and leaf, assumed. "
                "Required width: the same, as that is less than 0.9 m."
            )
        elif row["room"] == "Room 0 c0":
            assert (row["clear_width"], row.get("required_width")) == (2.0, None)
            assert row["notes"] == "Clear width: between the walls of the model."
        else:
            assert row.keys().isdisjoint({"clear_width", "required_width", "notes"})
    # It would split the name in two.
    office = build_office(1, 3)
    names = {one: name.replace("r00", "r;0") for one, name in name_all(office).items()}
    names |= {"0": "Ground", "0 c0 r01": "Ground POINT 1"}
    found = draft(office, names)
    added = [one["place"] for one in found.places]
    assert len({key(name) for name in (*names.values(), *added)}) == len(names) + len(added)
    assert "Ground point 2" in added
    assert {row["floor"] for row in (*found.places, *found.routes)} == {"Ground"}
    assert [row.get("room") for row in found.routes if row["start"] == "Room 0 c0 r;0"] == [None]


def test_a_room_open_to_another_names_both_and_remarks_tell_what_is_assumed(duplex, of_duplex):
    """Furniture of either may fall into the segment."""
    names = name_all(duplex)
    by_name = {one.name: names[one.key] for one in duplex.spaces}
    kitchen = next(row for row in of_duplex.routes if row["start"] == by_name["A103"])
    assert set(kitchen["room"].split("; ")) >= {by_name["A103"], by_name["A102"]}
    bath = next(row for row in of_duplex.routes if row["start"] == by_name["A104"])
    assert bath["room"] == by_name["A104"]
    assert draft(duplex) == of_duplex, "the same each time"
    said = say(of_duplex)
    assert said[:2] == [
        "6 evacuation routes were drafted from the rooms and doors of the model: walk them, correct them, and take "
        "'(draft)' off their names.",
        "Level 1 is taken as the ground storey: doors there with a room on one side only count as exits.",
    ]
    assert "are narrower than 0.9 m: their Required width is their Clear width." in said[2]
    roof = name_all(duplex)[next(one.key for one in duplex.spaces if one.title == "Roof")]
    assert said[3] == f"No way out of 1 room was found in the model: {roof}."


# ---------------------------------------------------------------- remarks


def say(found: DraftRoutes) -> list[str]:
    return [str(one) for one in found.remarks]


def test_without_rooms_or_ways_out_there_is_no_draft_balconies_are_no_exits_and_missing_walls_are_named():
    for change, said in (
        ({"spaces": ()}, "the model has no rooms."),
        ({"storeys": ()}, "the model has no rooms."),
        ({"doors": ()}, "the model has no doors and no stairs."),
        ({"doors": (door("inside", 2.0, 5.05),)}, "no way leads from a room to a door with a room on one side only, or "
                                                  "to a stair."),
    ):  # fmt: skip
        found = draft(replace(build_office(1, 2), **change))
        assert (found.places, found.routes) == ([], [])
        assert say(found)[0] == f"No evacuation routes were drafted: {said}"
    office = build_office(1, 3, storeys=2)
    upstairs = replace(office, doors=(*office.doors, door("balcony", 16.0, 18.0, 0.0, "1"),
                                      door("terrace", -0.05, 6.1, 0.0, "1")))  # fmt: skip
    assert "1 door of other storeys has a room on one side only: it does not count as an exit." in say(draft(upstairs))
    office = replace(build_office(1, 3), walls={})
    found = draft(office)
    assert found.unreached == ()
    assert "No walls on Level 0: openings without doors, of 0.6 m and more, are not found there." in say(found)


# ---------------------------------------------------------------- any model

NUMBER = st.floats(-10, 10).map(lambda x: round(x, 1))
POINT = st.tuples(NUMBER, NUMBER)
RING = st.lists(POINT, min_size=3, max_size=7).map(tuple)
SIDE = st.sampled_from([0.1, 1.0, 2.0, 5.0])
BOX = st.builds(lambda x, y, u, v: rectangle(x, y, x + u, y + v), NUMBER, NUMBER, SIDE, SIDE)
AREA = st.one_of(BOX, BOX, st.builds(lambda outer, hole: (outer, hole), RING, RING), RING.map(lambda ring: (ring,)))
SIZE = st.sampled_from([0.0, 0.001, 0.1, 0.9, 3.0])
TURN = st.floats(-360, 360)
STOREY = st.sampled_from(["0", "1"])
SIZES = st.fixed_dictionaries({"storey": STOREY, "breadth": SIZE, "width": SIZE, "height": SIZE})
STOREYS = (Storey("0", "Level 0", 0.0, 0.0), Storey("1", "Level 1", 3.0, 3.0))


@st.composite
def hostile_models(draw) -> BuildingModel:
    """Rooms that cross themselves and each other, doors anywhere, furniture of no size, walls through all."""
    spaces = [Space(f"r{at}", draw(STOREY), "", "", draw(AREA), 0.0, 3.0) for at in range(draw(st.integers(0, 6)))]
    doors = [
        Door(f"d{at}", draw(STOREY), "", draw(NUMBER), draw(NUMBER), draw(TURN), draw(SIZE), draw(SIZE), draw(SIZE))
        for at in range(draw(st.integers(0, 8)))
    ]
    stairs = [
        Stair(f"s{at % 2}", draw(STOREY), "", end, *draw(POINT))
        for at, end in enumerate(draw(st.permutations(["foot", "head", "foot", "head"])))
    ]
    pieces: list[Piece] = [
        piece(f"p{at}", draw(NUMBER), draw(NUMBER), **draw(SIZES)) for at in range(draw(st.integers(0, 4)))
    ]
    walls = {"0": tuple(draw(st.lists(AREA, max_size=4))), "1": tuple(draw(st.lists(BOX, max_size=2)))}
    return BuildingModel(source="any.ifc", schema="IFC4", storeys=STOREYS, spaces=tuple(spaces), doors=tuple(doors),
                         stairs=tuple({(one.key, one.end): one for one in stairs}.values()), pieces=tuple(pieces),
                         walls=walls)  # fmt: skip


@settings(max_examples=50 if settings().derandomize else 100, deadline=None)
@given(hostile_models())
@pytest.mark.slow
def test_any_model_gives_a_draft_that_holds_together(model):
    names, found = name_all(model), draft(model)
    known = {*names.values(), *(one["place"] for one in found.places)}
    assert len(known) == len(names) + len(found.places)
    rooms = {names[one.key] for one in model.spaces}
    joined = {row["start"] for row in found.routes}
    assert joined | {row["end"] for row in found.routes} <= known
    assert rooms - joined == set(found.unreached)
    for row in found.routes:
        assert is_draft(row["route"])
        assert row.get("clear_width", 1.0) >= 0.1
        assert row.get("required_width", 0.1) < DEFAULT_WIDTH
    for _, line, _ in list_lines(model, found):
        assert line.length > 0.01


@pytest.mark.slow
def test_rooms_that_lie_in_each_other_are_bounded_and_a_route_to_a_stair_ends_with_its_flight():
    count = 60
    spaces = tuple(Space(f"r{at}", "0", "", "", rectangle(0, 0, 20 + at * 0.01, 20), 0.0, 3.0) for at in range(count))
    doors = tuple(door(f"d{at}", 20.0, at * 20 / count, 0.0) for at in range(count))
    model = BuildingModel(source="many.ifc", schema="IFC4", storeys=STOREYS, spaces=spaces, doors=doors,
                          walls={"0": (rectangle(-1, -1, -0.9, 5),)})  # fmt: skip
    assert len(draft(model).routes) <= 10 * count
    found = draft(build_office(1, 3, storeys=2))
    (flight,) = [row for row in found.routes if "floor" not in row]
    assert (flight["route"], flight["start"], flight["end"]) == (
        "To Stair 1 s0, head (draft)", "Stair 1 s0, head", "Stair 1 s0, foot",
    )  # fmt: skip
    assert flight["notes"] == "Stair: fill in Clear width."
    assert "clear_width" not in flight
    starts = {row["start"] for row in found.routes if row["route"].startswith("To Door")}
    assert "Stair 1 s0, foot" in starts  # from where the route of the ground storey goes on


def test_a_room_with_many_corners_is_bounded():
    teeth = [(x / 10, y) for at, x in enumerate(range(1500)) for y in ([0.0, 4.0] if at % 2 else [4.0, 0.0])]
    comb = Space("r", "0", "", "", ((*teeth, (150.0, 9.0), (0.0, 9.0)),), 0.0, 3.0)
    model = BuildingModel(source="comb.ifc", schema="IFC4", storeys=STOREYS, spaces=(comb,),
                          doors=(door("d", 75.0, 9.05), door("e", 149.0, 9.05)))  # fmt: skip
    assert draft(model).unreached == ()
    at = find_room_points(model)["r"]
    assert to_polygon(comb.area).buffer(0.02).covers(Point(at))


# ---------------------------------------------------------------- clear widths of drafted segments


LEVEL = Storey("0", "Level 0", 0.0, 0.0)
HALL = Space("h", "0", "Hall", "", rectangle(0, 0, 10, 6), 0.0, 3.0)
EXIT = replace(door("out", 10.05, 3.0, 0.0, overall=1.3), width=1.3)
WALLS = (
    rectangle(10, 0, 10.1, 2.35), rectangle(10, 3.65, 10.1, 6), rectangle(-0.1, 0, 0, 6), rectangle(0, -0.1, 10, 0),
    rectangle(0, 6, 10, 6.1),
)  # fmt: skip


def column(x: float, y: float, half: float = 0.2):
    return rectangle(x - half, y - half, x + half, y + half)


def hall(*columns, **more: object) -> BuildingModel:
    values = {"doors": (EXIT,), "walls": {"0": (*WALLS, *columns)}} | more
    return BuildingModel(source="a.ifc", schema="IFC4", storeys=(LEVEL,), spaces=(HALL,), **values)


def measure_in(model: BuildingModel, *ends: tuple[float, float]) -> float | None:
    at = (model.doors[0].x, model.doors[0].y)
    links = [link_door(model.doors[0], ("h", ""))] if at in ends else []
    return measure_gap(build_plan(model, LEVEL), "h", ends, links)


@pytest.mark.parametrize(
    ("stated", "drawn", "clear"),
    [(1.8, 0.9, 0.8), (0.9, 1.8, 0.8), (0.0, 1.2, 1.1), (1.2, 0.0, 1.1), (0.9, 0.898, 0.8), (0.0, 0.0, 0.0)],
)
def test_of_the_stated_width_of_a_door_and_its_opening_the_smaller_counts(stated, drawn, clear):
    link = link_door(replace(EXIT, overall=stated, width=drawn), ("h", ""))
    assert link.clear == pytest.approx(clear)


def test_columns_before_an_exit_and_its_door_bound_the_segment_to_it_and_a_wall_beside_it_does_not():
    """The exit is 1.3 m wide, the columns stand 0.8 m apart."""
    for x in (6.0, 9.0, 9.7):
        assert measure_in(hall(column(x, 2.4), column(x, 3.6)), (4.0, 3.0), (10.05, 3.0)) == pytest.approx(0.8)
    model = hall(column(9.0, 2.4), column(9.0, 3.6))  # people walk between them: they begin in the widest part
    last = next(row for row in draft(model).routes if row["end"] == "Door out")
    assert last["clear_width"] == pytest.approx(0.8, abs=0.011)
    assert "Clear width: between the walls of the model." in last["notes"]
    for leaf, clear, words in (
        (EXIT, 1.2, "the door's 1.30 m"),
        (replace(EXIT, width=0.9, overall=1.8), 0.8, "the door's 0.90 m in the model less 0.1 m"),
    ):
        (row,) = draft(hall(doors=(leaf,))).routes
        assert row["clear_width"] == pytest.approx(clear)
        assert row["notes"].startswith(f"Clear width: {words}")
    assert row["required_width"] == 0.8
    assert measure_in(hall(), (4.0, 3.0), (10.05, 3.0)) == pytest.approx(1.3)
    # A room of 0.85 m is narrow wherever one walks in it; a hall of 6 m is not.
    slim = replace(HALL, area=rectangle(0, 0, 10, 0.85))
    plan = build_plan(replace(hall(), spaces=(slim,), walls={}), LEVEL)
    assert measure_gap(plan, "h", ((1.0, 0.3), (8.0, 0.3)), ()) == pytest.approx(0.85)
    assert measure_in(hall(), (1.0, 0.3), (8.0, 0.3)) is None


def test_a_door_and_columns_that_are_passed_at_an_angle_are_as_wide_apart_as_they_are():
    for turn in (-60.0, -40.0, 0.0, 40.0, 60.0):
        ends = (10.05 - 4 * math.cos(math.radians(turn)), 3.0 - 2.5 * math.sin(math.radians(turn))), (10.05, 3.0)
        whole = hall(walls={"0": (rectangle(10, 0, 10.1, 6),)})  # a wall that is not cut at the door does not close it
        for found in (measure_in(hall(), *ends), measure_in(whole, *ends)):
            assert found is None or found >= 1.2, turn
    for turn in (0.0, 25.0, -25.0):
        x, y = 3 * math.cos(math.radians(turn)), 3 * math.sin(math.radians(turn))
        model = hall(column(5.0, 2.4), column(5.0, 3.6))
        assert measure_in(model, (5.0 - x, 3.0 - y), (5.0 + x, 3.0 + y)) == pytest.approx(0.8), turn


# ---------------------------------------------------------------- drafted routes in use


SHAKEN = {"shaking": "MMI VIII, severe"}


def build(model: BuildingModel, folder: Path) -> Inventory:
    found = list_building(model, "draft")
    found = replace(found, building={**found.building, **SHAKEN})
    return read_inventory(write_import(found, folder))


@pytest.fixture(scope="module")
def results(duplex, tmp_path_factory) -> Results:
    return assess.run(build(duplex, tmp_path_factory.mktemp("duplex")), UNVERIFIED)


@pytest.mark.slow
def test_a_draft_is_a_workbook_without_errors(published, tmp_path):
    inventory = build(published, tmp_path)
    assert inventory.errors == ()
    assert len(inventory.routes) > 0
    drafted = [one for one in inventory.problems if "drafted from a building model" in one.message]
    assert [one.severity for one in drafted] == ["warning"]
