"""Evacuation routes in reports: what the summary says of them, what to fix, and the pages on them."""

import re
from dataclasses import replace
from html import unescape

import pypdfium2
import pytest

import assess
from assess.cli.command_run import describe_result
from assess.i18n import gettext, load_catalogue, speaking
from assess.pipeline.schedule import fix_first
from assess.report import statements, words
from assess.report.content import Content
from assess.report.report_options import ReportOptions
from assess.report.say import route
from assess.report.say.work import list_steps, say_effect
from assess.report.sections import routes as pages
from assess.report.sections.summary import FIXES
from assess.report.view import MOST_SEGMENTS
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.settings import Settings
from tests.report.reading import render
from tests.report.routed import DOUBTED, FLOORS, ITEMS, KNOWN, PLACES, ROUTES, assess_routed
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def routed(tmp_path_factory):
    return assess_routed(tmp_path_factory.mktemp("at_risk") / "w.xlsx")


def test_states_are_counted_the_worst_first(routed):
    routes, states = routed.route_tables, (RouteState.DOUBTFUL, RouteState.BLOCKED, RouteState.DOUBTFUL)
    changed = tuple(replace(one, state=state) for one, state in zip(routes.routes, states, strict=True))
    results = replace(routed, route_tables=replace(routes, routes=changed))
    assert route.say_routes(results)[0] == "3 evacuation routes: 1 blocked, 2 doubtful."
    assert [one.state for one in route.list_at_risk(results.route_tables)] == sorted(
        states, key=lambda state: -state.severity
    )


def test_a_route_of_which_nothing_is_known_is_not_said_to_be_safe(tmp_path):
    """No piece of the ground floor is listed, and the lane has no position."""
    results = assess_routed(tmp_path / "w.xlsx", Items=ITEMS[3:])
    assert [one.evaluated for one in results.route_tables.routes] == [True, True, False]
    assert results.route_tables.routes[2].state == RouteState.NOT_KNOWN
    assert [text for text in route.say_routes(results) if "fill in From, To and Floor of Yard: lane" in text]


def test_where_all_are_open_none_is_listed(tmp_path):
    results = assess_routed(tmp_path / "w.xlsx", Items=[ITEMS[0] | {"anchored": "yes"}, ITEMS[2]])
    assert route.list_at_risk(results.route_tables) == []
    first, second, *_ = route.say_routes(results)
    assert first == "3 evacuation routes: 3 open."
    assert second == "Best way from each of 2 rooms to the street: 2 open."


def test_a_piece_that_reaches_a_route_by_the_plan_is_urgent(routed):
    found = {one.item.item: one for one in routed}
    assert (found["tall"].item.route, found["tall"].routes) == ("", ("West",))
    assert {name for name, one in found.items() if one.is_urgent} == {"tall", "calm", "held"}
    assert found["held"].routes == ("Yard",)


@pytest.fixture(scope="module")
def many(tmp_path_factory):
    """Four pieces of low class that together bring a route over the risk, and one of medium class away from it."""
    low = {"floor": "1", "breadth": 46, "height": 80, "anchored": "no", "route": "Back", "edge_distance": 0.0}
    items = [low | {"item": f"low {at}"} for at in range(4)]
    items.append({"item": "far", "floor": "1", "breadth": 50, "height": 110, "anchored": "no"})
    items.append({"item": "vital", "floor": "1", "breadth": 50, "height": 110, "anchored": "no",
                  "importance": "life safety"})  # fmt: skip
    return assess_routed(tmp_path_factory.mktemp("many") / "w.xlsx", Items=items)


def test_pieces_of_low_class_that_a_route_needs_fixed_are_in_the_list(many):
    classes = {one.item.item: one.adopted.upper for one in many}
    assert classes["low 0"] is RiskClass.LOW
    steps = list_steps(many.route_tables)
    assert {step.route for step in steps} == {"Back"}
    fixes = Content(many).fixes
    names = [[one.item.item for one in fix.results] for fix in fixes]
    assert len(steps) == 3
    fixed = [many.item_rows[step.item_index].item for step in steps]
    assert names[0] == ["vital"]
    assert names[-1] == ["far"]
    assert sorted(name for own in names[1:-1] for name in own) == sorted(fixed)
    for fix in fixes[1:-1]:
        assert fix.steps
        assert fix.reason == say_effect(fix.steps)
        assert fix.reason.startswith("route Back: ")
    last = next(fix for fix in fixes if fix.steps and fix.steps[-1].place == len(steps))
    assert last.reason.endswith(f"of {len(steps)})")
    assert steps[-1].after < many.route_tables.risk <= steps[-1].before


def test_without_a_need_low_class_stays_out(many):
    assert [one.item.item for one in fix_first(iter(many))] == ["vital", "far"]


def test_a_step_that_gains_with_the_others_alone_says_so(many):
    step = list_steps(many.route_tables)[0]._replace(before=0.155, after=0.155, at_last=0.0, place=1, steps=3)
    assert say_effect([step]) == "route Back: 15.5 % → 0.0 % (with all 3 steps)"


@pytest.mark.slow
def test_one_earthquake_shakes_all_floors_whatever_is_known_of_each(tmp_path):
    """Pieces stand by motions that are given and by ones that are interpolated: they fall draw by draw all the same."""
    floors = [
        FLOORS[0] | {"elevation": 8.0},
        {"floor": "M", "elevation": 4.0},
        FLOORS[1] | {"pfa_x": 0.3, "pfa_y": 0.3},
    ]
    routes = [*ROUTES, {"route": "West", "segment": "mid", "floor": "M", "clear_width": 1.2}]
    middle = {"item": "mid", "floor": "M", "breadth": 28, "height": 210, "anchored": "no", "route": "West",
              "segment": "mid", "edge_distance": 0.0}  # fmt: skip
    sheets = {"Floors": floors, "Routes": routes, "Items": [*ITEMS, middle], **KNOWN}
    results = assess_routed(tmp_path / "w.xlsx", Settings(verify="all", runs=10), **sheets)
    west = results.route_tables.routes[0].blocked
    assert west is not None
    assert (west.is_joint, west.pieces, west.unverified, west.runs) == (True, 2, 0, 10)
    assert not any("numbers of draws" in where for where, _ in statements.list_assumptions(results))
    apart = replace(results.route_tables.routes[0], blocked=replace(west, is_joint=False))
    changed = replace(results, route_tables=replace(results.route_tables, routes=(apart,)))
    assert any("numbers of draws" in where for where, _ in statements.list_assumptions(changed))


@pytest.fixture(scope="module")
def unconfirmed(tmp_path_factory):
    return assess_routed(tmp_path_factory.mktemp("unconfirmed") / "w.xlsx", Settings(runs=20), **DOUBTED)


def test_what_is_not_known_is_counted_apart_with_what_settles_it(unconfirmed):
    """Neither T1 nor height is known: whether West and Back are blocked depends on the bookcase and the cabinets."""
    back, west, *others = route.list_at_risk(unconfirmed.route_tables)
    assert (west.route, route.say_state(west.state), route.say_blocked(west)) == (
        "West", "? not known", "not known (0.0 to 100.0 %)".replace(" ", words.NO_BREAK),
    )  # fmt: skip
    text = " ".join(route.say_routes(unconfirmed))
    assert (back.route, others) == ("Back", [])
    assert "3 evacuation routes: 2 not known, 1 open." in text
    assert "Best way from each of 2 rooms to the street: 2 not known." in text
    assert "enter Storeys or the Period T1 in the sheet Building" in text
    assert "Left out of these averages, as not known: routes 2, rooms 2." in text
    line = next(one for one in describe_result(unconfirmed) if "evacuation routes" in one)
    assert line.startswith("3 evacuation routes: 2 not known, 1 open.")
    assert line.endswith("enter Storeys or the Period T1 in the sheet Building.")


def test_steps_count_unconfirmed_pieces_as_fallen(unconfirmed):
    (step,) = (one for one in list_steps(unconfirmed.route_tables) if one.route == "West")
    assert step.is_bound
    assert say_effect([step]) == "route West: up to 100.0 % → 0.0 % (step 1 of 1)"


@pytest.fixture(scope="module")
def crowded(tmp_path_factory):
    """Twelve floors, each with a route that may be blocked, and every caution there is."""
    floors, items, routes = [], [], []
    for at in range(12):
        motion = {"pfa_x": 0.3 + 0.02 * at, "pfv_x": 40.0} if at % 3 != 1 else {}
        floors.append({"floor": f"F{at}", "name": f"Level {at} of the building", "elevation": 3.0 * at, **motion})
        route = {"route": f"Long name of route {at}", "segment": "aisle"}
        routes.append(route | {"floor": f"F{at}", "clear_width": 1.2, "required_width": 0.9, "occupants": 300})
        piece = {"floor": f"F{at}", "room": "Conference room", "description": "Bookcase of metal", "breadth": 30,
                 "width": 80, "height": 200, "anchored": "partly", "importance": "life safety",
                 "edge_distance": 0.1}  # fmt: skip
        items += [piece | route | {"item": f"Piece-{at}-{number}"} for number in range(3)]
    settings = assess.Settings(verify="high", runs=10)
    sheets = {"Floors": floors, "Items": items, "Routes": routes, "Places": PLACES[:0]}
    return assess_routed(tmp_path_factory.mktemp("crowded") / "w.xlsx", settings, **sheets)


@pytest.mark.slow
@pytest.mark.parametrize("language", [pytest.param("en", marks=pytest.mark.long), "it"])
def test_the_summary_stays_on_one_page(crowded, language, tmp_path):
    written = assess.write_reports(crowded, tmp_path, ("pdf",), ReportOptions(language=language))
    document = pypdfium2.PdfDocument(written["pdf"])
    pages = {mark.get_title(): mark.get_dest().get_index() for mark in document.get_toc()}
    with speaking(load_catalogue(language)):
        summary, following = gettext("Summary"), gettext("What to fix")
    assert pages[following] == pages[summary] + 1
    assert "Long name of route" in document[pages[summary]].get_textpage().get_text_range()
    assert len(Content(crowded).fixes) > FIXES


# ---------------------------------------------------------------- drafts, and rooms without furniture

LONG = "To the stair of the north wing, upper landing (draft)"


@pytest.fixture(scope="module")
def drafted(tmp_path_factory):
    """The same building with two of its routes marked as drafts, and furniture in one room alone."""
    names = {"West": LONG, "Back": "Back (draft)"}
    routes = [one | {"route": names.get(one["route"], one["route"])} for one in ROUTES]
    items = [one | {"room": "Office"} | ({"route": names["Back"]} if one.get("route") == "Back" else {})
             for one in ITEMS]  # fmt: skip
    return assess_routed(tmp_path_factory.mktemp("drafted") / "w.xlsx", Routes=routes, Items=items)


def test_a_long_draft_keeps_its_mark_in_every_list(drafted):
    (step, *_others) = [say_effect([one]) for one in list_steps(drafted.route_tables) if one.route == LONG]
    assert step.startswith("route To the stair of the n… (draft): ")
    assert "To the stair of the north wing,… (draft)" in _text(_section(render(drafted)))


# ---------------------------------------------------------------- the pages on routes


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
    assert "9 more are in the Excel report." in text


def test_rooms_that_are_alike_stand_in_one_line(routed):
    routes = routed.route_tables
    twin = replace(routes.rooms[0], room="Twin")
    rows = _rows(render(replace(routed, route_tables=replace(routes, rooms=(*routes.rooms, twin)))), "way-page")
    assert [row[0].partition(" →")[0] for row in rows if "Twin" in row[0]] == ["Office, Twin"]
    assert len(rows) == len(_rows(render(routed), "way-page"))
