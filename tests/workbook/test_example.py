"""The example of `assess new --example`: it stands alone, and its live columns tell what the program does."""

from typing import Any

import openpyxl
import pytest

from assess.pipeline.live_values import live_values, with_live
from assess.pipeline.run import run
from assess.workbook.example import SCENARIO, example_content
from assess.workbook.lists import PLACES
from assess.workbook.read import read_inventory
from assess.workbook.schema import LIVE, SHEETS
from assess.workbook.template import write_workbook
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module", params=["si", "imperial"])
def units(request):
    return request.param


@pytest.fixture(scope="module")
def path(tmp_path_factory, units):
    path = tmp_path_factory.mktemp(units) / "example.xlsx"
    write_workbook(path, with_live(example_content(units), units), units)
    return path


@pytest.fixture(scope="module")
def inventory(path):
    return read_inventory(path)


@pytest.fixture(scope="module")
def results(inventory):
    return run(inventory, UNVERIFIED)


def same(one: Any, other: Any) -> bool:
    return bool(one == other if isinstance(other, str) else one == pytest.approx(other, abs=1e-9, rel=0))


def test_it_warns_only_of_pieces_that_stand_nowhere(results):
    warned = [problem for problem in results.problem_rows if problem.severity != "note"]
    rows = {item.row: item.item for item in results.item_rows}
    assert {rows[int(problem.cell[1:])] for problem in warned} == {"1-5", "2-6"}
    assert all(" neither a position nor a Route" in problem.message for problem in warned)


def test_its_routes_lead_down_a_flight_of_stairs(inventory):
    """And it says that it is an example, and names no file."""
    assert [(one.segment, one.floor) for one in inventory.routes] == [("aisle", "2"), ("flight", ""), ("hall", "1")]
    steps = [(one.start, one.end) for one in inventory.routes]
    assert [end for _, end in steps[:-1]] == [start for start, _ in steps[1:]]
    assert inventory.building.scenario == SCENARIO == "Example values, not a real building"
    assert inventory.files == {}
    assert {item.anchored for item in inventory.items} >= {"no", "yes", "partly", "unknown"}


@pytest.mark.parametrize("sheet", SHEETS[:5], ids=lambda sheet: sheet.name)
def test_imperial_rows_are_the_si_rows_converted(sheet):
    rows = zip(*(example_content(units).rows[sheet.name] for units in ("si", "imperial")), strict=True)
    for si, imperial in rows:
        assert si.keys() == imperial.keys()
        for name, value in si.items():
            if isinstance(value, str) or sheet.column(name).imperial == sheet.column(name).unit:
                assert imperial[name] == value
            else:
                factor = {"in": 1 / 2.54, "ft": 1 / 0.3048, "in/s": 1 / 2.54}[sheet.column(name).imperial]
                assert imperial[name] == pytest.approx(value * factor, abs=0.051)


def test_route_items_stand_where_they_say(inventory):
    y = {place.place: place.y for place in inventory.places}
    for item in (item for item in inventory.items if item.route):
        segment = next(one for one in inventory.routes if one.segment == item.segment)
        assert item.floor == segment.floor
        assert item.angle_deg == 90, "Breadth lies across the route, which runs along X"
        edge = y[segment.start] - segment.clear_width / 2 - (item.y + item.breadth / 2)
        assert item.edge_distance == pytest.approx(edge, abs=0.01)


def test_stored_live_values_are_the_programs_and_those_of_a_spreadsheet_engine(path):
    formualizer = pytest.importorskip("formualizer")
    page = openpyxl.load_workbook(path, data_only=True)["Items"]
    book = formualizer.load_workbook(str(path))
    book.evaluate_all()
    for row, values in enumerate(live_values(read_inventory(path)), 2):
        for label, value in zip(LIVE, values, strict=True):
            at = PLACES["Items", label] + 1
            assert same(page.cell(row, at).value, value), (row, label)
            assert same(book.get_value("Items", row, at), value), (row, label)
