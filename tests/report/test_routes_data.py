"""The evacuation routes in results.json: every number is that of the assessment, and the schema holds."""

import json
from dataclasses import asdict

import jsonschema
import pytest

from assess.report.data import SCHEMA, write_json
from assess.report.routes_data import chance_record, routes_record
from assess.settings import Settings
from tests.report.routed import ROUTES, assess_routed
from tests.workbooks import assessed

VERIFIED = Settings(verify="all", runs=20, route_risk=0.1)


@pytest.fixture(scope="module", params=["formulas", "verified"])
def written(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("routes")
    more = {"settings": VERIFIED} if request.param == "verified" else {}
    assessment = assess_routed(folder / "w.xlsx", **more)
    write_json(assessment, folder / "r.json")
    text = (folder / "r.json").read_text(encoding="utf-8")
    return assessment, json.loads(text, parse_constant=pytest.fail)


def _schema():
    return json.loads(SCHEMA.read_text(encoding="utf-8"))


def test_the_schema_holds(written):
    jsonschema.validate(written[1], _schema())


@pytest.mark.parametrize(
    ("path", "wrong"),
    [
        (("risk",), 0),
        (("segments", 0, "state"), "shut"),
        (("segments", 0, "blocked", "probability"), 1.1),
        (("segments", 0, "blocked"), None),
        (("routes", 0, "fixes", 0, "row"), 0),
        (("routes", 0, "segments"), [-1]),
        (("rooms", 0, "ways", 0, "more"), 1),
        (("floors", 0, "blocked_routes_expected"), -0.1),
    ],
)
def test_the_schema_refuses(written, path, wrong):
    found = json.loads(json.dumps(written[1]))
    at = found["routes"]
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = wrong
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(found, _schema())


def test_segments_keep_what_the_workbook_says_beside_the_widths_used(written):
    segments = written[1]["routes"]["segments"]
    assert [one["segment"] for one in segments] == [one["segment"] for one in ROUTES]
    names = {"from": "start", "to": "end", "clear_width_m": "clear_width", "required_width_m": "required_width"}
    for one, given in zip(segments, ROUTES, strict=True):
        for name in ("route", "floor", "from", "to", "room", "clear_width_m", "required_width_m", "occupants"):
            assert one[name] == given.get(names.get(name, name)), name
        assert one["notes"] == given.get("notes", "")
    back = segments[3]
    assert (back["clear_width_used_m"], back["required_width_used_m"]) == (0.9, 0.9)
    assert {"clear_assumed", "required_assumed"} <= set(back["flags"])
    assert (segments[1]["needed_width_m"], segments[1]["insufficient_for_occupants"]) == (pytest.approx(1.524), True)
    assert segments[1]["insufficient_after_falls"]["probability"] == 1
    assert segments[2]["insufficient_after_falls"] is None
    assert segments[2]["needed_width_m"] is None


def test_every_chance_is_that_of_the_assessment(written):
    assessment, found = written
    items, routes = assessment.inventory.items, assessment.routes
    assert found["routes"]["risk"] == routes.risk == assessment.settings.route_risk
    assert found["routes"]["blocked_routes_expected"] == routes.blocked_routes
    assert found["routes"]["cut_off_rooms_expected"] == routes.cut_off_rooms
    assert found["routes"]["draws"] == routes.draws
    pairs = [*zip(found["routes"]["segments"], routes.segments, strict=True),
             *zip(found["routes"]["routes"], routes.routes, strict=True)]  # fmt: skip
    for told, one in pairs:
        assert (told["state"], told["state_upper"]) == (one.outlook.state.word, one.outlook.upper.word)
        assert told["blocked"] == asdict(one.outlook.blocked)
        assert told["blocked_or_reduced"] == asdict(one.outlook.taken)
        assert told["blocked_if_anchors_fail"] == chance_record(one.outlook.if_anchors_fail)
        blocker = one.outlook.blocker
        expected = None if blocker is None else {"item": items[blocker].item, "row": items[blocker].row}
        assert told["most_likely_piece"] == expected
    assert set(found["routes"]["segments"][0]["blocked"]) == {
        "probability", "low", "high", "joint", "independent", "correlated", "runs", "is_joint", "pieces", "unverified",
    }  # fmt: skip


def test_what_is_blocked_by_what_is_told(written):
    assessment, found = written
    rows = {one.item: one.row for one in assessment.inventory.items}
    segments, routes = found["routes"]["segments"], found["routes"]["routes"]
    (tall,) = segments[0]["pieces"]
    assert (tall["item"], tall["row"], tall["by_plan"], tall["blocks_alone"]) == ("tall", rows["tall"], True, True)
    assert tall["distance_m"] == pytest.approx(0.15)
    assert tall["falls_while_blocked"] == pytest.approx(segments[0]["blocked"]["probability"])
    assert segments[0]["state"] == "blocked"
    (held,) = segments[4]["pieces"]
    assert (held["item"], segments[4]["state"], segments[4]["blocked"]["pieces"]) == ("held", "open", 0)
    assert segments[4]["blocked_if_anchors_fail"]["pieces"] == 1
    assert [one["route"] for one in routes] == ["West", "Back", "Yard"]
    assert [one["segments"] for one in routes] == [[0, 1, 2], [3], [4]]
    assert [fix["item"] for fix in routes[0]["fixes"]] == ["tall"]
    assert routes[0]["fixes"][0]["left"] == 0
    assert routes[0]["fixes"][0]["gain"] == pytest.approx(routes[0]["blocked"]["probability"])
    assert all(one["is_mended"] for one in routes)


def test_rooms_and_floors(written):
    assessment, found = written
    rooms, floors = found["routes"]["rooms"], found["routes"]["floors"]
    assert [(one["room"], one["floor"], one["exits"]) for one in rooms] == [
        ("Office", "1", ["Street"]), ("Archive", "1", ["Street"]),
    ]  # fmt: skip
    assert [one["loses_every_exit"] for one in rooms] == [asdict(one.loses) for one in assessment.routes.rooms]
    assert rooms[0]["ways"][0]["segments"] == [0, 1, 2]
    assert rooms[0]["ways"][0]["end"] == "Street"
    for told, one in zip(floors, assessment.routes.floors, strict=True):
        assert (told["floor"], told["segments"], told["rooms"]) == (one.floor, one.segments, one.rooms)
        assert told["blocked_segments_expected"] == one.blocked_segments
        assert told["blocked_routes_expected"] == one.blocked_routes
        assert told["any_room_cut_off"] == chance_record(one.any_room)


def test_without_routes_lists_are_empty(tmp_path):
    assessment = assessed(tmp_path / "w.xlsx")
    assert routes_record(assessment) == {
        "risk": 0.03, "blocked_routes_expected": 0.0, "cut_off_rooms_expected": 0.0, "draws": 0, "segments": [],
        "routes": [], "rooms": [], "floors": [],
    }  # fmt: skip
    write_json(assessment, tmp_path / "r.json")
    found = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert found["routes"] == routes_record(assessment)
    assert found["assess"]["settings"]["route_risk"] == 0.03
