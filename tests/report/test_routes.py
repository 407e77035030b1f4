"""Evacuation routes in reports: what the summary says of them, what to fix, and the pages on them."""

import re
from dataclasses import replace
from html import unescape

import pytest

from assess.report import words
from assess.report.content import Content
from assess.report.say import route
from assess.report.say.work import list_steps, say_effect
from assess.report.sections import routes as pages
from assess.report.view import MOST_SEGMENTS
from assess.risk import RiskClass
from assess.route_results import RouteState
from tests.report.reading import render
from tests.report.routed import ITEMS, assess_routed
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def routed(tmp_path_factory):
    return assess_routed(tmp_path_factory.mktemp("at_risk") / "w.xlsx")


def test_a_route_of_which_nothing_is_known_is_not_safe_and_a_piece_that_reaches_one_is_urgent(tmp_path, routed):
    """No piece of the ground floor is listed, and the lane has no position."""
    results = assess_routed(tmp_path / "w.xlsx", Items=ITEMS[3:])
    assert [one.evaluated for one in results.route_tables.routes] == [True, True, False]
    assert results.route_tables.routes[2].state == RouteState.NOT_KNOWN
    assert [text for text in route.say_routes(results) if "fill in From, To and Floor of Yard: lane" in text]
    found = {one.item.item: one for one in routed}
    assert (found["tall"].item.route, found["tall"].routes) == ("", ("West",))
    assert {name for name, one in found.items() if one.is_urgent} == {"tall", "calm", "held"}
    assert found["held"].routes == ("Yard",)


def test_pieces_of_low_class_that_a_route_needs_fixed_are_in_the_list(tmp_path):
    """Four pieces of low class together bring a route over the risk; one of medium class is away from it."""
    low = {"floor": "1", "breadth": 46, "height": 80, "anchored": "no", "route": "Back", "edge_distance": 0.0}
    items = [low | {"item": f"low {at}"} for at in range(4)]
    items.append({"item": "far", "floor": "1", "breadth": 50, "height": 110, "anchored": "no"})
    items.append({"item": "vital", "floor": "1", "breadth": 50, "height": 110, "anchored": "no",
                  "importance": "life safety"})  # fmt: skip
    many = assess_routed(tmp_path / "w.xlsx", Items=items)
    classes = {one.item.item: one.adopted.upper for one in many}
    assert classes["low 0"] is RiskClass.LOW
    steps = list_steps(many.route_tables)
    assert {step.route for step in steps} == {"Back"}
    fixes = Content(many).fixes
    names = [[one.item.item for one in fix.results] for fix in fixes]
    assert len(steps) == 3
    fixed = [many.item_rows[step.item_index].item for step in steps]
    assert names[0] == ["vital"]
    assert sorted(name for own in names for name in own) == sorted(["vital", "far", *fixed])
    assert [fix.row.phase for fix in fixes] == sorted(fix.row.phase for fix in fixes)
    for fix in (one for one in fixes if one.steps):
        assert fix.results[0].adopted.upper is RiskClass.LOW
        assert fix.reason == say_effect(fix.steps)
        assert fix.reason.startswith("route Back: ")
    last = next(fix for fix in fixes if fix.steps and fix.steps[-1].place == len(steps))
    assert last.reason.endswith(f"of {len(steps)})")
    assert steps[-1].after < many.route_tables.risk <= steps[-1].before


def _text(markup):
    return " ".join(unescape(re.sub(r"<[^>]*>", " ", markup)).replace(words.NO_BREAK, " ").split())


def _section(html):
    """The page on routes, and its details, which stand apart."""
    return "".join(re.findall(r'<section id="routes.*?(?=<section id="(?:floors|verification)")', html, re.DOTALL))


def _rows(html, table):
    """Return the cells of the rows of all tables of a class, as texts."""
    bodies = re.findall(rf'<table class="{table}[^"]*">.*?<tbody>(.*?)</tbody>', _section(html), re.DOTALL)
    return [
        [_text(cell) for cell in re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.DOTALL)]
        for body in bodies
        for row in re.findall(r"<tr[^>]*>(.*?)</tr>", body, re.DOTALL)
    ]


@pytest.mark.slow
def test_what_is_not_evaluated_is_neither_open_nor_has_a_chance(tmp_path):
    """A stair of known width that no piece names, a lane without positions, and a piece that has no position."""
    hall = {"route": "Hall", "floor": "1", "start": "Office", "clear_width": 1.2, "room": "Hall"}
    routes = [
        {"route": "Dark", "segment": "flight", "start": "Landing", "end": "Foot", "clear_width": 1.2},
        {"route": "Blind", "segment": "lane", "floor": "G", "clear_width": 1.5},
        hall | {"segment": "aisle", "end": "Landing"},
        hall | {"segment": "gallery", "end": "Archive", "clear_width": 3.0, "required_width": 0.9},
    ]
    items = [ITEMS[0] | {"room": "<Store>"}, {"item": "lost", "floor": "1", "breadth": 30, "height": 200}]
    results = assess_routed(tmp_path / "w.xlsx", Items=items, Routes=routes)
    html = render(results)
    dark, blind, hall = _rows(html, "routes")
    assert dark[2] == "✓ open"
    assert (blind[2:5], blind[6:7]) == (["? not known", "–", "–"], ["–"])
    assert blind[5] == "fill in From, To and Floor of Blind: lane (Routes!D3)"
    assert (hall[2], hall[5]) == ("? not known", "fill in X and Y, or the Route, of lost (Items!N3)")
    flight, lane, aisle, _gallery = _rows(html, "segments")
    assert (flight[7], lane[6:11], aisle[7]) == ("✓ open", ["–", "? not known", "–", "–", "–"], "? not known")
    assert 'class="way-state not-known"' in html
    printed = render(results, for_print=True)
    assert [row[0] for row in _rows(printed, "segments")] == ["Dark: flight", "Blind: lane", "Hall: aisle"]
    left_out = "1 segment that no piece reaches is left out; the Excel report has all."
    assert [left_out in _text(_section(one)) for one in (html, printed)] == [False, True]


@pytest.mark.slow
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
    html = render(assess_routed(tmp_path / "w.xlsx", settings, Places=places, Routes=routes, Items=items))
    text = _text(_section(html))
    most = {"routes": pages.MOST_ROUTES, "segments": MOST_SEGMENTS, "rooms": pages.MOST_ROOMS}
    assert {name: len(_rows(html, name)) for name in most} == most
    assert len(_rows(html, "beside")) == len(_rows(html, "steps")) == 20
    assert [row[0] for row in _rows(html, "routes")[:20]] == [f"Route {at}" for at in range(count - 20, count)]
    assert [f"{n} more, less likely, are in the Excel report." in text for n in (80, 30)] == [True, True]
    assert "160 routes are open as they are: Route 0, " in text, "all pieces of the floor name other routes"
    assert len(_rows(html, "way-page")) == 2 * pages.MOST_LINES, "rooms and routes"
    assert "11 more are in the Excel report." in text
