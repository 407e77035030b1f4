"""Drafted routes in use: the workbook of a building model with them is checked, run and reported."""

from dataclasses import replace
from pathlib import Path

import pytest

import assess
from assess.bim.building_model import BuildingModel
from assess.bim.import_workbook import build_workbook
from assess.bim.model_rows import list_building
from assess.model import Inventory
from assess.results import Results
from assess.route_results import RouteState
from assess.workbook.read import read_inventory
from tests.bim.office_models import build_office
from tests.workbooks import UNVERIFIED

SHAKEN = {"shaking": "MMI VIII, severe"}


def build(model: BuildingModel, folder: Path) -> Inventory:
    """Write the workbook of a model with its plans, and read it."""
    found = list_building(model, "draft")
    found = replace(found, building={**found.building, **SHAKEN})
    for name, data in found.files.items():
        (folder / name).write_bytes(data)
    (folder / "book.xlsx").write_bytes(build_workbook(found))
    return read_inventory(folder / "book.xlsx")


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


def test_every_segment_on_a_storey_is_on_the_plan_and_no_piece_stands_in_it(results):
    segments = results.route_tables.segments
    flights = [one for one in segments if one.floor is None]
    assert len(flights) == 2
    for one in segments:
        assert (one.length_m is None) == (one in flights), one.segment
        assert one in flights or 0 < one.length_m < 12
        assert not one.is_blocked_standing
    assert not any("with nothing fallen" in one for one in results.problems["message"])
    assert any(one.pieces for one in segments)


def test_rooms_of_both_storeys_have_a_way_to_an_exit(results):
    rooms = {one.room: one for one in results.route_tables.rooms}
    assert not any(one.by_stairs for one in rooms.values())
    assert all(one.exits for one in rooms.values())
    upstairs = next(one for name, one in rooms.items() if "A203" in name)
    assert upstairs.exits == ("Exit A101",)
    assert results.route_tables.unjoined_rooms == ("R301 Roof",)
    assert len(results.route_tables.routes) == 6
    assert all(one.route.endswith(" (draft)") for one in results.route_tables.routes)
    assert {one.state for one in results.route_tables.routes} <= set(RouteState)


@pytest.mark.slow
def test_rooms_upstairs_are_not_known_until_the_width_of_the_stair_is_filled_in(tmp_path):
    """The model does not tell it; all else of their ways is."""
    inventory = build(build_office(1, 3, storeys=2), tmp_path)
    upstairs = [one.place for one in inventory.places if one.kind == "room" and one.floor == "Level 1"]
    assert len(upstairs) == 7

    def find_unknown(inventory: Inventory) -> set[str]:
        rooms = assess.run(inventory, UNVERIFIED).route_tables.rooms
        return {one.room for one in rooms if "clear_width" in {lack.what for lack in one.missing}}

    assert find_unknown(inventory) >= set(upstairs)
    filled = tuple(one if one.floor else replace(one, clear_width=1.2) for one in inventory.routes)
    assert find_unknown(replace(inventory, routes=filled)) == set()
