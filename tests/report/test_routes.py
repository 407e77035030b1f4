"""The pages on evacuation routes: every number that was found, in words, bounded, and escaped."""

import html as entities
import re
from dataclasses import replace

import pytest

import assess
from assess.report import words
from assess.report.findings import at_risk, route_page, route_rows
from assess.report.findings import route_words as said
from assess.report.findings.route_page import MOST_LINES
from assess.report.pages.context import LIMITS
from assess.route_results import FLAGS, RouteState
from assess.routes.widths import RULES
from assess.workbook.template import Content, write_workbook
from tests.report.reading import lay_out, render
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


def _chance(chance):
    return "–" if chance is None else said.say_chance(chance).replace(words.NO_BREAK, " ")


def _flat(text):
    return text.replace(words.NO_BREAK, " ")


def _bounds(chance):
    return said.say_bounds(chance).replace(words.NO_BREAK, " ")


def _item(piece):
    return "–" if piece is None else piece.item


def test_the_building_has_every_state(assessment):
    west, balcony, back, yard = assessment.route_tables.routes
    assert west.state == RouteState.BLOCKED
    assert balcony.state == RouteState.OPEN
    assert not back.is_fixed
    assert yard.state == RouteState.OPEN
    assert yard.blocked_if_anchors_fail.probability > 0.1


EACH = pytest.mark.parametrize("name", ["assessment", "verified", "unconfirmed"])


@EACH
def test_every_number_of_a_route_is_shown(name, request):
    assessment = request.getfixturevalue(name)
    rows = _rows(render(assessment), "routes")
    assert len(rows) == len(assessment.route_tables.routes) == 4
    for row, one in zip(rows, assessment.route_tables.routes, strict=True):
        route, _floors, state, *numbers, rests, unanchored, piece = row
        assert route == one.route
        assert said.say_route_state(one, assessment.route_tables.risk) in state
        assert numbers == [_flat(said.say_blocked(one)), _flat(said.say_taken(one))]
        is_known = one.state != RouteState.NOT_KNOWN
        assert not is_known or numbers == [_chance(one.blocked), _chance(one.blocked_or_reduced)]
        bounds = f"{_bounds(one.blocked)} " if one.blocked.pieces and is_known else ""
        left_out = f"; {said.say_left_out(one.unevaluated_segments)}" if one.unevaluated_segments else ""
        assert rests == (said.say_missing(one.missing) or f"{bounds}{said.say_basis(one.blocked)}{left_out}")
        assert unanchored == _chance(one.blocked_if_anchors_fail)
        assert piece == _item(one.most_likely_piece)


WEST = "20 draws, all together; 1 segment not evaluated"


def test_a_verified_route_rests_on_its_motions(verified):
    (row, *_others) = _rows(render(verified), "routes")
    assert row[5] == f"{_bounds(verified.route_tables.routes[0].blocked)} {WEST}"
    assert re.fullmatch(r"[\d.]+ % \([\d.]+ to [\d.]+ %\)", row[3])
    assert verified.route_tables.routes[0].blocked.is_joint


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


def test_what_is_blocked_as_it_stands_is_told_from_what_may_be(html, assessment):
    states = {row[0]: row[2] for row in _rows(html, "routes")}
    assert states == {
        "<b>West</b>": "✕ blocked",
        "Balcony": "✓ open",
        "Back": "✕ blocked as it stands",
        "Yard": "✓ open if the anchors hold ⚓",
    }
    assert "widen them, or move what stands inside; check the Clear width. Back: gap" in _text(_section(html))
    certain = replace(assessment.route_tables.routes[2], is_fixed=True)
    assert said.say_route_state(certain, 0.03) == "✕ blocked"


@EACH
def test_every_number_of_a_segment_is_shown(name, request):
    assessment = request.getfixturevalue(name)
    rows = _rows(render(assessment), "segments")
    assert len(rows) == len(ROUTES)
    for row, one in zip(rows, assessment.route_tables.segments, strict=True):
        assert row[0] == f"{one.route}: {one.segment}"
        assert row[1] == (one.floor or "–")
        assert row[2] == f"{one.from_place or ''} – {one.to_place or ''}".strip()
        assert row[3:6] == [
            words.in_m(width) for width in (one.clear_width_used_m, one.required_width_used_m, one.standing_width_m)
        ]
        assert said.say_segment_state(one, assessment.route_tables.risk) in row[7]
        if not one.evaluated:
            assert row[6:11] == ["–", "? not known", "–", "–", "–"]
            continue
        assert row[6] == words.in_m(one.least_width_m)
        bounds = "–" if one.state == RouteState.NOT_KNOWN else _bounds(one.blocked)
        assert row[8:11] == [_flat(said.say_blocked(one)), bounds, _flat(said.say_taken(one))]
        for flag in one.flags:
            assert flag.replace("_", " ") in row[11]
        if one.blocked_if_anchors_fail:
            assert f"if anchors fail: blocked in {_chance(one.blocked_if_anchors_fail)}" in row[11]


def test_a_segment_that_is_too_narrow_for_its_occupants_says_so(html, assessment):
    aisle, flight = _rows(html, "segments")[:2]
    first, second = assessment.route_tables.segments[:2]
    assert second.insufficient_for_occupants
    assert "1.52 m: insufficient for occupants" in flight[11]
    assert f"0.15 m: less in {_chance(first.insufficient_after_falls)}" in aisle[11]
    assert "<i>wet</i>" in aisle[11]


@EACH
def test_every_piece_beside_a_segment_is_shown(name, request):
    assessment = request.getfixturevalue(name)
    found = [(one, near) for one, near in route_rows.list_beside(assessment.route_tables) if near]
    rows = [row for row in _rows(render(assessment), "beside") if "no piece reaches it" not in row]
    assert {assessment.item_rows[near.item_index].item for _one, near in found} == {"tall & thin", "low", "held"}
    assert len(rows) == len(found) == sum(len(one.pieces) for one in assessment.route_tables.segments)
    for row, (one, near) in zip(rows, found, strict=True):
        result = assessment.result(near.item_index)
        assert row[0] == f"{one.route}: {one.segment}"
        assert row[2].startswith(result.item.item)
        assert row[3] == ("the plan" if near.by_plan else "Edge distance")
        assert row[4:7] == [words.in_m(value) for value in (near.distance_m, near.reach_m, near.left_m)]
        assert row[7] == ("yes" if near.blocks_alone else "no")
        assert row[8] == words.percent(near.falls_while_blocked)
        assert row[9].startswith(words.chance(result).replace(words.NO_BREAK, " "))
        assert ("⚓ anchored" in row[10]) == result.is_anchored
        assert all(flag.replace("_", " ") in row[10] for flag in near.flags)


def test_segments_with_nothing_beside_them_are_listed_where_they_are_too_narrow(html):
    alone = [row[0] for row in _rows(html, "beside") if "no piece reaches it" in row]
    assert alone == ["Back: gap", "<b>West</b>: flight"]


def test_marks_are_explained_where_they_occur(html, assessment):
    text = _text(_section(html))
    told = route_rows.list_flags(assessment.route_tables)
    assert {"side_unknown", "no_plan", "required_assumed"} <= told.keys() < FLAGS.keys()
    for flag, meaning in FLAGS.items():
        assert (f"{flag.replace('_', ' ')} {meaning}" in text) == (flag in told)


def test_floors_say_what_is_to_be_expected(html, assessment):
    for row, one in zip(_rows(html, "route-floors"), assessment.route_tables.floors, strict=True):
        counted = (
            (one.segments, one.blocked_segments_expected, one.unknown_segments),
            (one.routes, one.blocked_routes_expected, one.unknown_routes),
            (one.rooms, one.cut_off_rooms_expected, one.unknown_rooms),
        )
        shown = [[str(every), f"{expected:.2f}", str(unknown)] for every, expected, unknown in counted]
        assert row[1:10] == [cell for cells in shown for cell in cells]
        assert row[10:] == [_chance(one.any_room_cut_off), str(one.uncounted_pieces)]


def test_the_lead_counts_routes_and_rooms(html, assessment):
    text, routes = _text(_section(html)), assessment.route_tables
    assert "4 evacuation routes: 2 blocked, 2 open." in text
    blocked, rooms = routes.blocked_routes_expected, routes.cut_off_rooms_expected
    assert f"On average {blocked:.2f} routes would be blocked and {rooms:.2f} rooms would lose all exits." in text
    assert "in this scenario, not per year" in text
    for sentence in said.list_cautions(routes):
        assert sentence in text
    assert "not evaluated by this version" not in text


@EACH
def test_every_step_of_what_to_fix_is_shown(name, request):
    assessment = request.getfixturevalue(name)
    steps = route_rows.list_steps(assessment.route_tables)
    assert steps
    rows = _rows(render(assessment), "steps")
    assert len(rows) == len(steps)
    for row, (one, number, step) in zip(rows, steps, strict=True):
        assert row[:3] == [one.route, str(number), at_risk.say_row(assessment.result(step.item_index))]
        assert row[3:5] == [words.percent(step.gain), words.percent(step.left)]
        assert row[5] == ((said.say_missing_after(one) or "open") if number == len(one.fixes) else "")
        assert not one.is_fixed or one.fixes[-1].left < assessment.route_tables.risk


def test_routes_that_need_nothing_are_named(html):
    assert "2 routes are open as they are: Balcony, Yard." in _text(_section(html))


def test_widths_are_given_with_their_publications(html):
    text = _text(_section(html))
    for rule in RULES:
        assert f"{rule.width:g} m: {rule.holds}" in text
        assert rule.reference.title in text
        assert rule.reference.remark in text
    assert "Where the workbook gives no Required width, 0.9 m is taken." in text


def test_names_with_markup_stay_text(html):
    assert "<b>West" not in html
    assert "<i>wet" not in html
    assert "Office <1>" not in html
    assert "&lt;b&gt;West&lt;/b&gt;" in html


def test_links_lead_somewhere(html):
    ids = re.findall(r'\bid="([^"]+)"', html)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'href="#([^"]+)"', html)) <= set(ids)
    assert {"segment-1", "segment-6", "way-1"} <= set(ids)


def test_a_workbook_without_routes_says_so(tmp_path):
    html = render(_assess(tmp_path / "w.xlsx", Routes=[], Items=ITEMS[3:]))
    section = _section(html)
    assert _text(section) == "Evacuation routes The workbook names no routes."
    assert "<table" not in section


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


@pytest.mark.slow
def test_the_section_prints_on_the_page(verified):
    boxes = pytest.importorskip("weasyprint.formatting_structure.boxes")

    def walk(box):
        yield box
        for child in getattr(box, "children", ()):
            yield from walk(child)

    tables = 0
    for page in lay_out(render(verified, for_print=True)):
        for table in (one for one in walk(page) if isinstance(one, boxes.TableBox)):
            tables += table.element.get("class", "") in ("routes", "segments", "beside", "rooms", "steps")
            assert table.position_x + table.margin_width() <= page.content_box_x() + page.width + 1
            for cell in (one for one in walk(table) if isinstance(one, boxes.TableCellBox)):
                for text in (one for one in walk(cell) if isinstance(one, boxes.TextBox)):
                    if table.element.get("class") != "short":
                        assert text.position_x + text.width <= cell.content_box_x() + cell.width + 0.5, text.text
    assert tables >= 5


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


def test_the_page_says_for_every_route_what_to_fix_or_fill_in(html, assessment, unknown):
    """Of the buildings: one route is blocked by a piece, one as it stands, and two open; one lacks positions."""
    rows = _ways(html)
    assert rows["Back: Archive → Balcony"][1:] == [
        "✕ blocked as it stands", "100.0 %", "Back: gap", "widen it, or move what stands inside; check the Clear width",
    ]  # fmt: skip
    west = rows["<b>West</b>: Office <1> → Street"]
    assert west[1:] == ["✕ blocked", _chance(assessment.route_tables.routes[0].blocked), "<b>West</b>: aisle",
                        "tall & thin ; not known then; to settle it: fill in X and Y of Foot, Street (Places!C6, "
                        "Places!C7)"]  # fmt: skip
    assert rows["Balcony"][1] == "✓ open"
    assert rows["Yard"][1] == "✓ open if the anchors hold ⚓"
    other = _ways(render(unknown))
    said_of_hall = next(row for name, row in other.items() if name.startswith("Hall: "))
    assert (said_of_hall[1], said_of_hall[4]) == ("? not known", "fill in X and Y, or the Route, of lost (Items!N3)")


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


def test_pieces_in_other_rooms_are_named_with_their_room(unknown):
    html = render(unknown)
    (aisle,) = (row for row in _rows(html, "segments") if row[0] == "Hall: aisle")
    assert "not counted, in another room: tall & thin (<Store>)" in aisle[11]
    assert "<Store>" not in html


def test_pieces_that_are_left_out_are_counted(unknown, tmp_path):
    sentence = "3 pieces have no usable position or route and are left out."
    html = render(unknown)
    assert sentence in _text(_section(html))
    assert {row[0]: row[-1] for row in _rows(html, "route-floors")} == {"1 – First": "3", "Floor G": "0"}
    alone = _assess(tmp_path / "w.xlsx", Items=ITEMS[:3])
    assert route_rows.say_uncounted(alone.route_tables) == ""


def test_print_leaves_out_segments_that_nothing_reaches(unknown):
    html = render(unknown, for_print=True)
    assert [row[0] for row in _rows(html, "segments")] == ["Dark: flight", "Blind: lane", "Hall: aisle"]
    assert "1 segment that no piece reaches is left out; the Excel report has all." in _text(_section(html))
    assert "is left out" not in _text(_section(render(unknown)))


def test_a_way_says_what_it_shares_with_the_first(assessment):
    way = assessment.route_tables.rooms[0].ways[0]
    name = assessment.route_tables.segments[way.segment_indices[0]].segment
    ways = (way, replace(way, shared=(name,)))
    said_alone, said_shared = (said.say_way(one, assessment.route_tables) for one in ways)
    assert said_shared == f"{said_alone}; shares {name} with the first"
