"""The worked example: 575 Market Street with its own records, as committed and as its script builds it."""

import importlib.util
import itertools
import json
import re
import shutil
import sys
from collections import Counter
from dataclasses import replace
from html import unescape
from pathlib import Path

import jsonschema
import openpyxl
import pytest

from assess.model import Inventory, Item
from assess.pipeline.live_values import live_values
from assess.pipeline.run import run
from assess.report import write_reports
from assess.report.data import SCHEMA
from assess.report.findings.motions import ENVELOPES
from assess.results import MAY_BE_LOWER
from assess.risk import RiskClass
from assess.settings import Settings
from assess.units import GRAVITY
from assess.workbook.layout import PLACES
from assess.workbook.lists import RUN_ASSESS
from assess.workbook.live_row import IS_ANCHORED
from assess.workbook.read import read_inventory
from assess.workbook.schema import CLASS, CLASS_OR, LIVE
from assess.workbook.template import write_workbook
from tests.workbooks import UNVERIFIED

FOLDER = Path(__file__).parents[1] / "inventories"
WORKBOOK = FOLDER / "market-street.xlsx"
FLOORS = ("42", "34", "25", "G")
Box = tuple[float, float, float, float]

# Treated PFA [cm/s2] of each channel, as the README of the records has it.
PFA = {"a": 218.1, "b": 181.4, "c": 133.3, "d": 151.2, "e": 147.6, "g": 184.1, "h": 218.4, "i": 161.8, "k": 132.8}
CHANNELS = {
    ("42", "X"): "ab", ("42", "Y"): "c", ("34", "X"): "de", ("34", "Y"): "de",
    ("25", "X"): "gh", ("25", "Y"): "i", ("G", "X"): "k", ("G", "Y"): "k",
}  # fmt: skip
BORROWED = {("34", "Y"), ("G", "X")}


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("market_street", FOLDER / "market_street.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["market_street"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules["market_street"]


@pytest.fixture
def inventory(example_inventory):
    return example_inventory


@pytest.fixture
def results(example):
    return example


def box(item: Item) -> Box:
    """West, south, east and north edge of a placed piece."""
    assert item.x is not None
    assert item.y is not None
    assert item.width is not None
    assert item.angle_deg is not None
    x, y = (item.breadth, item.width) if item.angle_deg % 180 == 0 else (item.width, item.breadth)
    return item.x - x / 2, item.y - y / 2, item.x + x / 2, item.y + y / 2


def in_cm_s2(value_in_g: float) -> float:
    return value_in_g * GRAVITY * 100


def gaps(a: Box, b: Box) -> list[float]:
    """Clear distance of two boxes along X and along Y; negative where they overlap."""
    return [max(a[at] - b[at + 2], b[at] - a[at + 2]) for at in (0, 1)]


def placed(inventory: Inventory) -> list[Item]:
    return [item for item in inventory.items if item.x is not None]


def test_it_warns_only_of_desks_that_stand_nowhere(inventory):
    warned = [problem for problem in inventory.problems if problem.severity != "note"]
    rows = {item.row: item for item in inventory.items}
    assert [rows[int(problem.cell[1:])].floor for problem in warned] == ["42", "34", "25"]
    assert all("have neither a position nor a Route" in one.message or "has neither" in one.message for one in warned)
    lost = [item for item in inventory.items if item.x is None and not item.route]
    assert {item.description for item in lost} == {"Desks", "Tables", "Pedestals under the desks"}


def _cells(path):
    """Return every cell and formula of a workbook; its bytes depend on the version of XlsxWriter."""
    book = openpyxl.load_workbook(path)
    return {(page.title, cell.coordinate): cell.value for page in book for row in page for cell in row if cell.value}


def test_the_script_builds_the_workbook_and_nothing_else(tmp_path, script):
    shutil.copytree(FOLDER / "records", tmp_path / "records")
    script.build(tmp_path / "again.xlsx")
    assert _cells(tmp_path / "again.xlsx") == _cells(WORKBOOK), "run: make blank"
    assert {path.name for path in tmp_path.iterdir()} == {"records", "again.xlsx"}


def test_the_building_says_what_is_real_and_invents_nothing(inventory):
    building = inventory.building
    assert "The furniture is an example; the records are real." in building.scenario
    assert building.azimuth_deg == 45
    assert building.storeys is building.period is None
    assert (building.height, building.ground_pga) == (175, pytest.approx(0.139 * GRAVITY))


def test_floors_are_evenly_spread_by_their_number(inventory):
    """42 storey heights of 175/42 = 4.1667 m: the 42nd floor stands on 41 of them."""
    assert [floor.elevation for floor in inventory.floors] == [170.8, 137.5, 100, 0]


def test_about_120_pieces_with_something_of_everything(inventory):
    items = inventory.items
    assert 110 <= len(items) <= 130
    assert len(placed(inventory)) > 100
    assert all(item.quantity == 1 for item in placed(inventory))
    assert any(item.quantity > 1 for item in items)
    assert {item.anchored for item in items} == {"no", "yes", "partly", "unknown"}
    assert {item.importance for item in items} >= {"life safety", "function", "property"}
    assert {item.axis for item in placed(inventory)} == {"X", "Y"}
    assert len({item.type for item in items}) > 20


@pytest.mark.parametrize("floor", FLOORS)
def test_every_floor_has_pieces_and_a_route(inventory, floor):
    own = [item for item in inventory.items if item.floor == floor]
    assert len(own) >= 20
    segments = [one for one in inventory.routes if one.floor == floor]
    assert len(segments) > 10
    assert all(one.clear_width > one.required_width > 0.8 for one in segments)
    floors = {place.place: place.floor for place in inventory.places}
    assert all(floors[one.start] == floors[one.end] == floor for one in segments)
    assert sum(bool(item.route) for item in own) >= 3


def test_stairs_join_the_floors(inventory):
    places = {place.place: place for place in inventory.places}
    stairs = [one for one in inventory.routes if not one.floor]
    assert [(places[one.start].floor, places[one.end].floor) for one in stairs] == [
        ("42", "G"), ("42", "34"), ("34", "25"), ("25", "G"),
    ]  # fmt: skip
    assert {places[end].kind for one in stairs for end in (one.start, one.end)} == {"stair"}
    assert all(one.occupants * 0.00762 < one.clear_width for one in stairs), "0.3 in an occupant"


def reached(inventory: Inventory, without: str = "") -> set[str]:
    """Places from which a way leads out, if nothing passes the place `without`."""
    ways = [{one.start, one.end} for one in inventory.routes if without not in (one.start, one.end)]
    found = {place.place for place in inventory.places if place.kind == "exit"}
    while more := {place for way in ways if way & found for place in way} - found:
        found |= more
    return found


def test_every_room_keeps_a_way_out_and_the_offices_of_the_42nd_floor_two(inventory, script):
    rooms = {place.place for place in inventory.places if place.kind == "room"}
    assert rooms == {f"{floor} {name}" for floor, plan in script.ROOMS.items() for name in plan} - {
        f"{floor} Corridor" for floor in FLOORS
    }
    assert rooms <= reached(inventory)
    for stair in ("42 west stair", "42 east stair"):
        assert {room for room in rooms if room.startswith("42")} <= reached(inventory, stair)
    assert "34 North office" not in reached(inventory, "34 east stair")


def bands(inventory: Inventory) -> dict[tuple[str, str], tuple[str, Box]]:
    """Floor and box of every segment on a floor, all of which run along X or Y."""
    point = {place.place: (place.x or 0.0, place.y or 0.0) for place in inventory.places}
    found = {}
    for one in (one for one in inventory.routes if one.floor):
        (x0, y0), (x1, y1) = point[one.start], point[one.end]
        assert (x0 == x1) != (y0 == y1), (one.route, one.segment)
        half = (one.clear_width or 0.0) / 2
        dx, dy = (half, 0.0) if x0 == x1 else (0.0, half)
        found[one.route, one.segment] = (
            one.floor, (min(x0, x1) - dx, min(y0, y1) - dy, max(x0, x1) + dx, max(y0, y1) + dy)
        )  # fmt: skip
    return found


def test_doors_stand_in_the_walls_of_their_rooms(inventory, script):
    """From each of them a segment leads into the room, and another to the nearest end of the aisle."""
    doors = {f"{floor} {room.lower()} door": f"{floor} {name}" for floor in FLOORS[:3]
             for room, name in (("meeting", "Meeting room"), ("kitchen", "Kitchen"))}  # fmt: skip
    places = {place.place: place for place in inventory.places}
    for door, name in doors.items():
        west, _, east, _ = script.ROOMS[places[door].floor][name.split(maxsplit=1)[1]]
        assert places[door].x in (west, east)
        ways = {(one.start, one.end): one.rooms for one in inventory.routes if door in (one.start, one.end)}
        assert ways.pop((name, door)) == (name.split(maxsplit=1)[1],)
        (((_, beyond), rooms),) = ways.items()
        assert abs(places[beyond].x - places[door].x) < 2.5, "not along the aisle"
        assert rooms in (("South office",), ("North office",))


def test_the_photocopier_alone_stands_in_a_route(inventory):
    inside = {
        item.description
        for item in placed(inventory)
        for floor, band in bands(inventory).values()
        if item.floor == floor and max(gaps(box(item), band)) < -1e-9
    }
    assert inside == {"Photocopier in the corridor"}


def test_routes_pass_the_core_by_but_for_the_doors_of_its_stairs(inventory, script):
    through = {name for name, (_, band) in bands(inventory).items() if max(gaps(band, script.CORE)) < -1e-9}
    assert {segment for _, segment in through} == {"stair door"}


def test_two_bookcases_of_the_north_office_block_it_only_together(inventory):
    """On both sides of 3.8 m: each alone leaves more than 2 m, both less than the 1.118 m required."""
    (way,) = (one for one in inventory.routes if (one.route, one.segment) == ("42 north", "office"))
    pair = [item for item in inventory.items if item.segment == "office" and "Bookcase" in item.description]
    alone = [way.clear_width - (item.height - item.edge_distance) for item in pair]
    assert alone == pytest.approx([2.48, 2.18], abs=0.01)
    assert sum(alone) - way.clear_width == pytest.approx(0.86, abs=0.01)
    assert sum(alone) - way.clear_width < way.required_width < min(alone)
    assert gaps(*map(box, pair))[0] < 0, "they face each other"


def test_the_lockers_name_a_route_and_no_more(inventory):
    (lockers,) = (item for item in inventory.items if item.route and item.edge_distance is None)
    assert (lockers.description, lockers.x, lockers.segment) == ("Lockers of the cleaners", None, "")
    assert [one.segment for one in inventory.routes if one.route == lockers.route] == ["aisle"]


def test_no_piece_overlaps_sticks_out_or_stands_in_the_core(inventory, script):
    west, south, east, north = script.PLATE
    for item in placed(inventory):
        own = box(item)
        assert west < own[0] and south < own[1] and own[2] < east and own[3] < north, item.item  # noqa: PT018
        assert max(gaps(own, script.CORE)) > 0, item.item
        room = script.ROOMS[item.floor][item.room]
        assert own[0] > room[0] and own[1] > room[1] and own[2] < room[2] and own[3] < room[3], item.item  # noqa: PT018
    for one, other in itertools.combinations(placed(inventory), 2):
        assert one.floor != other.floor or max(gaps(box(one), box(other))) > 0, (one.item, other.item)


def test_edge_distances_follow_from_the_positions(inventory):
    point = {place.place: (place.x, place.y) for place in inventory.places}
    routes = {(one.route, one.segment): one for one in inventory.routes}
    beside = [item for item in placed(inventory) if item.route]
    for item in beside:
        segment = routes[item.route, item.segment]
        assert item.floor == segment.floor
        (x0, y0), (x1, y1) = point[segment.start], point[segment.end]
        line = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
        along, across = gaps(box(item), line) if y0 == y1 else reversed(gaps(box(item), line))
        assert along < 0
        edge = max(0, across) - segment.clear_width / 2
        assert item.edge_distance == pytest.approx(edge, abs=0.006)
        assert item.edge_distance < item.height
        assert item.importance == "life safety"
    assert [item.description for item in beside if item.edge_distance < 0] == ["Photocopier in the corridor"]


@pytest.mark.parametrize(("floor", "axis"), CHANNELS)
def test_each_floor_and_axis_has_the_motion_of_its_channels(results, floor, axis):
    motions = results.motions_of(floor, axis)
    assert [motion.record[-5] for motion in motions] == list(CHANNELS[floor, axis])
    for motion in motions:
        assert in_cm_s2(motion.pfa_g) == pytest.approx(PFA[motion.record[-5]], abs=0.051)
        assert ("one_axis_only" in motion.flags) == ((floor, axis) in BORROWED)


@pytest.mark.parametrize(("floor", "channels", "larger"), [("42", "ab", "a"), ("34", "de", "e"), ("25", "gh", "h")])
def test_of_parallel_channels_that_of_the_larger_velocity_governs(results, floor, channels, larger):
    along_x = [one for one in results if one.item.floor == floor and one.item.axis_given == "X"]
    assert along_x
    for one in along_x:
        assert [case.motion.record[-5] for case in one.cases] == list(channels)
        assert one.governing.motion.record[-5] == larger
        assert one.governing.motion.pfv_cm_s == max(case.motion.pfv_cm_s for case in one.cases)


def test_by_the_paper_that_of_the_larger_acceleration_governs(inventory):
    """Of the 34th floor PFA and PFV tell different channels."""
    found = run(inventory, replace(UNVERIFIED, class_by="proposed OR"))
    own = [one for one in found if one.item.floor == "34" and one.item.axis_given == "X"]
    assert {one.governing.motion.record[-5] for one in own} == {"d"}
    assert {one.by_formula.motion.record[-5] for one in own} == {"d"}


def test_vertical_channels_are_not_used(inventory):
    names = Counter(one.name[-5] for floor in inventory.floors for ones in floor.records.values() for one in ones)
    assert names == Counter("abcdeghik")


def test_every_class_is_there(results):
    assert {one.adopted.risk.word for one in results} == {"low", "medium", "high", "very high"}
    assert all(0 < one.governing.motion.pfa_g < 0.3 for one in results)


def test_stored_live_values_are_the_programs(inventory):
    page = openpyxl.load_workbook(WORKBOOK, data_only=True)["Items"]
    for row, (item, values) in enumerate(zip(inventory.items, live_values(inventory), strict=True), 2):
        stored = [page.cell(row, PLACES["Items", label] + 1).value for label in LIVE]
        assert stored[0] == pytest.approx(values[0], abs=1e-9, rel=0)
        words = dict.fromkeys(LIVE[1:], RUN_ASSESS)
        words |= dict.fromkeys((CLASS, CLASS_OR), IS_ANCHORED if item.anchored == "yes" else RUN_ASSESS)
        assert stored[1:] == values[1:] == list(words.values())


def test_a_spreadsheet_engine_computes_the_same(inventory):
    formualizer = pytest.importorskip("formualizer")
    book = formualizer.load_workbook(str(WORKBOOK))
    book.evaluate_all()
    for row, values in enumerate(live_values(inventory), 2):
        computed = [book.get_value("Items", row, PLACES["Items", label] + 1) for label in LIVE]
        assert computed[0] == pytest.approx(values[0], abs=1e-9, rel=0)
        assert computed[1:] == values[1:]


# ------------------------------------------------------------------ as a scenario without sensors

RATIOS = {"42": 170.8 / 175, "34": 137.5 / 175, "25": 100 / 175, "G": 0}


def _demands(written):
    found = json.loads(written["json"].read_text(encoding="utf-8"))
    return {(floor["floor"], one["axis"]): one for floor in found["floors"] for one in floor["demands"]}


TEXTS = ("html", "xlsx", "json")
"""The PDF is left out: it is made from the pages of the HTML, and takes half a minute."""


def _texts(written):
    """Return the words of the HTML and the Excel report, spaces made alike."""
    html = re.sub(
        r"<[^>]+>", " ", re.sub(r"<style>.*?</style>", "", written["html"].read_text(encoding="utf-8"), flags=re.S)
    )
    book = openpyxl.load_workbook(written["xlsx"])
    xlsx = " ".join(str(cell.value) for page in book for row in page.iter_rows() for cell in row if cell.value)
    return [" ".join(text.split()) for text in (unescape(html), xlsx)]


def _without_records(folder, script):
    content = script.content()
    floors = [{name: row[name] for name in ("floor", "name", "elevation")} for row in content.rows["Floors"]]
    write_workbook(folder / "no-records.xlsx", replace(content, rows={**content.rows, "Floors": floors}))
    return read_inventory(folder / "no-records.xlsx")


def test_without_its_records_it_runs_by_beams_on_its_ground_motion(tmp_path, script):
    inventory = _without_records(tmp_path, script)
    demands = _demands(write_reports(run(inventory, UNVERIFIED), tmp_path / "out", ("json",)))
    pga = 0.139
    for (floor, _), one in demands.items():
        assert (one["source"], one["profile"]) == ("beam", None)
        assert one["height_ratio"] == pytest.approx(RATIOS[floor])
        assert one["pfa_g"] == pytest.approx(pga * one["amplification"])
    assert demands["G", "X"]["pfa_g"] == pytest.approx(pga)
    assert demands["42", "X"]["pfa_g"] > pga


def test_without_its_records_it_runs_by_the_profile_of_a_code(tmp_path, script):
    inventory = _without_records(tmp_path, script)
    written = write_reports(run(inventory, replace(UNVERIFIED, scenario="ASCE 7-22")), tmp_path / "out", TEXTS)
    demands = _demands(written)
    for (floor, _), one in demands.items():
        amplification = 1 + 2.5 * RATIOS[floor]
        assert (one["source"], one["profile"]) == ("profile", "ASCE 7-22")
        assert (one["height_ratio"], one["amplification"]) == pytest.approx((RATIOS[floor], amplification))
        assert one["pfa_g"] == pytest.approx(0.139 * amplification)
    for text in _texts(written):
        assert "Floors 42, 34, 25, G: the motion is that of ASCE 7-22." in text
        assert ENVELOPES in text
        for factors in ("z/h 0.976, amplification 3.440", "z/h 0.786, amplification 2.964", "z/h 0.571"):
            assert factors in text


def test_as_a_scenario_of_a_code_it_sets_its_records_aside(inventory):
    found = run(inventory, Settings(scenario="ASCE 7-22", verify="none"))
    assert {one.source for one in found.motions} == {"profile"}
    aside = [str(one) for one in found.problem_rows if "Record" in one.message]
    assert len(aside) == 6
    warned = [one.sheet for one in found.problem_rows if one.severity == "warning"]
    assert set(warned) == {"Items", "Places"}, "every profile value is above the recorded one; a room has no furniture"


def test_recorded_it_says_which_record_serves(tmp_path, inventory, results):
    found = run(inventory, Settings(scenario="recorded", verify="none"))
    assert [one.governing.motion for one in found] == [one.governing.motion for one in results]
    written = write_reports(found, tmp_path / "out", TEXTS)
    assert {one["source"] for one in _demands(written).values()} == {"record"}
    for text in _texts(written):
        assert "recorded motion" in text
        assert "891018_1.cra-1.0210a.smc" in text
        assert "the motion is that of" not in text


def test_interpolation_left_out_as_a_test_gives_less_than_was_recorded(inventory):
    """On the 25th floor along X, from G and the 34th: 132.8 + 100/137.5 x (151.2 - 132.8) = 146.2 cm/s2 = 0.149 g."""
    floors = tuple(replace(floor, records={}) if floor.floor == "25" else floor for floor in inventory.floors)
    (one,) = run(replace(inventory, floors=floors), UNVERIFIED).motions_of("25", "X")
    recorded = max(motion.pfa_g for motion in run(inventory, UNVERIFIED).motions_of("25", "X"))
    assert one.between == ("G", "34")
    assert f"it gives {one.pfa_g:.3f} g where {recorded:.3f} g was recorded" in MAY_BE_LOWER


def test_a_floor_that_lost_its_record_is_interpolated(tmp_path, script):
    """The 34th floor lies (137.5 - 100)/(170.8 - 100) = 0.52966 of the way from the 25th to the 42nd."""
    content = script.content()
    floors = [row if row["floor"] != "34" else {"floor": "34", "elevation": 137.5} for row in content.rows["Floors"]]
    shutil.copytree(FOLDER / "records", tmp_path / "records")
    write_workbook(tmp_path / "lost.xlsx", replace(content, rows={**content.rows, "Floors": floors}))
    for scenario in ("as filled", "recorded"):
        found = run(read_inventory(tmp_path / "lost.xlsx"), Settings(scenario=scenario, verify="none"))
        (one,) = found.motions_of("34", "X")
        assert one.between == ("25", "42")
        assert in_cm_s2(one.pfa_g) == pytest.approx(218.4 + 0.52966 * (218.1 - 218.4), abs=0.06)
        (one,) = found.motions_of("34", "Y")
        assert in_cm_s2(one.pfa_g) == pytest.approx(161.8 + 0.52966 * (133.3 - 161.8), abs=0.06)
    for text in _texts(write_reports(found, tmp_path / "out", TEXTS)):
        assert "Floor 34: no motion is known there; it is interpolated" in text
        assert "interpolated between floors 25 and 42" in text


# ------------------------------------------------------------------ verified


@pytest.mark.slow
@pytest.mark.parametrize(("class_by", "most"), [(None, 12), ("proposed OR", 60)])
def test_verified_under_its_records_classes_are_lowered_and_say_so(tmp_path, inventory, class_by, most):
    """With 20 motions: weak long shaking, which overturns less than FEMA P-58 says, and far less than OR does."""
    results = run(inventory, replace(UNVERIFIED, class_by=class_by))
    found = run(inventory, Settings(runs=20, verify="high", class_by=class_by))
    for one, plain in zip(found, results, strict=True):
        by_formula = plain.adopted.risk
        wanted = one.item.route or by_formula >= RiskClass.HIGH or "extrapolated" in plain.adopted.flags
        assert one.is_simulated or not wanted or one.does_not_rock, one.item.item
        if not one.is_simulated:
            assert one.adopted == plain.adopted
        assert one.adopted.lowered_from == (by_formula if one.adopted.risk < by_formula else None)
        assert "assumed_motion" not in one.adopted.flags
    assert sum(one.adopted.lowered_from is not None for one in found) > most
    written = write_reports(found, tmp_path / "out", ("json", "npz"))
    jsonschema.validate(json.loads(written["json"].read_text(encoding="utf-8")), json.loads(SCHEMA.read_text("utf-8")))
