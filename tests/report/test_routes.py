"""The pages on evacuation routes: every number that was found, in words, bounded, and escaped."""

import html as entities
import re
from dataclasses import replace

import pytest

import assess
from assess.report import words
from assess.report.findings import route_page
from assess.report.findings import route_words as said
from assess.report.findings.route_page import MOST_LINES
from assess.report.pages.context import LIMITS
from assess.route_results import RouteState
from assess.workbook.template import Content, write_workbook
from tests.report.reading import render
from tests.workbooks import UNVERIFIED

FLOORS = [
    {"floor": "1", "name": "First", "pfa_x": 0.25, "pfv_x": 40.0, "pfa_y": 0.25, "pfv_y": 40.0},
    {"floor": "G", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.3, "pfv_y": 30.0},
]
PLACES = [
    {"place": "Office <1>", "floor": "1", "x": 0.0, "y": 0.0, "kind": "room"},
    {"place": "Archive", "floor": "1", "x": -10.0, "y": 8.0, "kind": "room"},
    {"place": "Landing", "floor": "1", "x": 10.0, "y": 0.0, "kind": "stair"},
    {"place": "Balcony", "floor": "1", "x": -10.0, "y": 0.0, "kind": "exit"},
    {"place": "Foot", "floor": "G", "kind": "stair"},
    {"place": "Street", "floor": "G", "kind": "exit"},
]
ROUTES = [
    {"route": "<b>West</b>", "segment": "aisle", "floor": "1", "start": "Office <1>", "end": "Landing",
     "clear_width": 1.2, "required_width": 0.85, "occupants": 30, "notes": "<i>wet</i>"},
    {"route": "<b>West</b>", "segment": "flight", "start": "Landing", "end": "Foot", "clear_width": 1.2,
     "required_width": 0.95, "occupants": 200},
    {"route": "<b>West</b>", "segment": "hall", "floor": "G", "start": "Foot", "end": "Street", "clear_width": 2.15},
    {"route": "Balcony", "segment": "gallery", "floor": "1", "start": "Office <1>", "end": "Balcony",
     "clear_width": 3.0},
    {"route": "Back", "segment": "gap", "floor": "1", "start": "Archive", "end": "Balcony", "clear_width": 0.7},
    {"route": "Yard", "segment": "lane", "floor": "G", "clear_width": 1.5, "room": "Lane"},
]  # fmt: skip
ITEMS = [
    {"item": "tall & thin", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 5.0, "y": 0.9, "axis": "Y",
     "angle_deg": 90, "anchored": "no"},
    {"item": "low", "floor": "1", "breadth": 20, "width": 50, "height": 100, "quantity": 2, "anchored": "no",
     "route": "Balcony", "segment": "gallery", "edge_distance": 0.1},
    {"item": "held", "floor": "G", "breadth": 30, "width": 80, "height": 200, "anchored": "yes", "route": "Yard",
     "segment": "lane", "edge_distance": 0.05},
    {"item": "away", "floor": "G", "breadth": 30, "width": 80, "height": 200, "x": 90.0, "y": 90.0,
     "room": "Far"},
]  # fmt: skip


def _assess(path, settings=UNVERIFIED, **sheets):
    rows = {"Building": [{}], "Floors": FLOORS, "Items": ITEMS, "Places": PLACES, "Routes": ROUTES} | sheets
    write_workbook(path, Content(rows=rows), "si")
    return assess.run(assess.read_inventory(path), settings)


@pytest.fixture(scope="module")
def assessment(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("routes") / "w.xlsx")


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("routes") / "w.xlsx", assess.Settings(runs=20), Building=[{"period": 1.0}])


@pytest.fixture(scope="module")
def unconfirmed(tmp_path_factory):
    """Neither T1 nor height is known: lower simulated classes are not confirmed."""
    return _assess(tmp_path_factory.mktemp("routes") / "w.xlsx", assess.Settings(runs=20, seed=3))


@pytest.fixture(scope="module")
def html(assessment):
    return render(assessment)


def _text(markup):
    return " ".join(entities.unescape(re.sub(r"<[^>]*>", " ", markup)).replace(words.NO_BREAK, " ").split())


def _section(html):
    """The page on routes, and its details, which stand apart."""
    return "".join(re.findall(r'<section id="routes.*?(?=<section id="(?:floors|verification)")', html, re.S))


def _rows(html, table):
    """The cells of every row of a table, as texts."""
    (body,) = re.findall(rf'<table class="{table}[^"]*">.*?<tbody>(.*?)</tbody>', _section(html), re.S)
    return [
        [_text(cell) for cell in re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.S)]
        for row in re.findall(r"<tr[^>]*>(.*?)</tr>", body, re.S)
    ]














def test_what_is_not_known_says_what_settles_it(unconfirmed):
    west, *_others = unconfirmed.route_tables.routes
    assert west.state == RouteState.NOT_KNOWN
    html = render(unconfirmed)
    (row, *_more) = _rows(html, "routes")
    assert row[2:5] == ["? not known", "not known (0.0 to 100.0 %)", "–"]
    assert row[5] == (
        "fill in X and Y of Foot, Street (Places!C6, Places!C7); enter Storeys or the Period T1 in the sheet Building"
    )
    assert row[7] == "–", "no piece of a known chance blocks it"
    text, unknown = _text(_section(html)), [one for one in unconfirmed.route_tables.routes if one.missing]
    assert f"4 evacuation routes: 1 blocked, {len(unknown)} not known" in text
    assert "count as fallen in these chances, which is on the safe side." in text
    assert "A piece whose class is not confirmed counts as standing and as fallen." in text
    (office, *_rooms) = _rows(html, "rooms")
    assert unconfirmed.route_tables.rooms[0].is_known == ("not known" not in office[4])
    assert sum(one.unknown_routes for one in unconfirmed.route_tables.floors) >= 1


def test_long_lists_are_bounded_and_what_is_left_out_is_least_likely(tmp_path):
    count = 180
    places = [{"place": f"Room {at}", "floor": "1", "kind": "room"} for at in range(count)]
    routes = [
        {"route": f"Route {at}", "segment": "s", "floor": "1", "start": f"Room {at}", "end": "Exit", "clear_width": 1.5}
        for at in range(count)
    ]
    items = [{"item": f"A{at}", "floor": "1", "breadth": 30, "height": 200, "route": f"Route {at}", "segment": "s",
              "edge_distance": 0.1} for at in range(count - 20, count)]  # fmt: skip
    settings = replace(UNVERIFIED, route_risk=0.02)
    places.append({"place": "Exit", "floor": "1", "kind": "exit"})
    html = render(_assess(tmp_path / "w.xlsx", settings, Places=places, Routes=routes, Items=items))
    text = _text(_section(html))
    assert len(_rows(html, "routes")) == LIMITS["most_routes"]
    assert len(_rows(html, "segments")) == LIMITS["most_segments"]
    assert len(_rows(html, "rooms")) == LIMITS["most_rooms"]
    assert len(_rows(html, "beside")) == len(_rows(html, "steps")) == 20
    assert [row[0] for row in _rows(html, "routes")[:20]] == [f"Route {at}" for at in range(count - 20, count)]
    assert "80 more routes, less likely to be blocked, are in the Excel report." in text
    assert "30 more segments, less likely to be blocked, are in the Excel report." in text
    assert "30 more rooms, less likely to be cut off, are in the Excel report." in text
    assert "160 routes are open as they are: Route 0, " in text, "all pieces of the floor name other routes"
    assert len(_ways(html)) == 2 * MOST_LINES, "rooms and routes"
    assert "9 more lines are in the Excel report, sheet Routes." in text


@pytest.fixture(scope="module")
def unknown(tmp_path_factory):
    """Two routes of which without furniture, one with a piece in another room, pieces not placed."""
    routes = [
        {"route": "Dark", "segment": "flight", "start": "Landing", "end": "Foot", "clear_width": 1.2},
        {"route": "Blind", "segment": "lane", "floor": "G", "clear_width": 1.5},
        {"route": "Hall", "segment": "aisle", "floor": "1", "start": "Office <1>", "end": "Landing",
         "clear_width": 1.2, "room": "Hall"},
        {"route": "Hall", "segment": "gallery", "floor": "1", "start": "Office <1>", "end": "Balcony",
         "clear_width": 3.0, "required_width": 0.9, "room": "Hall"},
    ]  # fmt: skip
    items = [ITEMS[0] | {"room": "<Store>"}, {"item": "lost", "floor": "1", "breadth": 30, "height": 200,
                                              "quantity": 3}]  # fmt: skip
    return _assess(tmp_path_factory.mktemp("unknown") / "w.xlsx", Items=items, Routes=routes)


def test_what_is_not_evaluated_is_neither_open_nor_has_a_chance(unknown):
    html = render(unknown)
    dark, blind, hall = _rows(html, "routes")
    assert dark[2] == "✓ open", "a stair of known width that no piece names"
    assert (blind[2:5], blind[6:7]) == (["? not known", "–", "–"], ["–"])
    assert blind[5] == "fill in From, To and Floor of Blind: lane (Routes!D3)"
    assert hall[2] == "? not known"
    assert hall[5] == "fill in X and Y, or the Route, of lost (Items!N3)"
    flight, lane, aisle, _gallery = _rows(html, "segments")
    assert (flight[7], lane[6:11]) == ("✓ open", ["–", "? not known", "–", "–", "–"])
    assert aisle[7] == "? not known"
    assert 'class="way-state not-known"' in html
    assert "3 evacuation routes: 2 not known, 1 open." in _text(_section(html))


def _ways(html):
    """Return the rows of both tables of the page on routes by their first cell."""
    bodies = re.findall(r'<table class="way-page">.*?<tbody>(.*?)</tbody>', _section(html), re.S)
    rows = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.S)
            for body in bodies for row in re.findall(r"<tr>(.*?)</tr>", body, re.S)]  # fmt: skip
    return {_text(row[0]).replace(" :", ":"): [_text(cell) for cell in row] for row in rows}


def test_rooms_that_are_alike_stand_in_one_line(assessment):
    routes = assessment.route_tables
    twin = replace(routes.rooms[0], room="Twin")
    lines = route_page.list_room_lines(replace(routes, rooms=(*routes.rooms, twin)))
    assert [one.names for one in lines if "Twin" in one.names] == ["Office <1>, Twin"]
    assert len(lines) == len(route_page.list_room_lines(routes))


def test_what_more_draws_would_settle_says_so(assessment):
    (yard,) = (one for one in assessment.route_tables.routes if one.route == "Yard")
    doubtful = replace(yard, missing=(), state=RouteState.DOUBTFUL, fixes=())
    assert route_page.say_advice(doubtful) == "no draw blocks it: simulate more draws to settle it"
    assert route_page.say_advice(yard) == ""


def test_print_leaves_out_segments_that_nothing_reaches(unknown):
    html = render(unknown, for_print=True)
    assert [row[0] for row in _rows(html, "segments")] == ["Dark: flight", "Blind: lane", "Hall: aisle"]
    assert "1 segment that no piece reaches is left out; the Excel report has all." in _text(_section(html))
    assert "is left out" not in _text(_section(render(unknown)))
