"""What if: the same as a run with the same settings, beside the present; the workbook stays as it is."""

import json
import math

import pytest

import assess
from assess.errors import InputError
from assess.report.counts import count
from assess.report.say.route import say_outlook, say_room_state
from assess.risk import RiskClass
from assess.web.what_if_answer import try_out
from tests.waiting import wait_until
from tests.web.opened import MARKET, edit, hold, settle
from tests.workbooks import write


def _try(book, **request):
    """Return the answer once everything is simulated."""
    settle(book)
    wait_until(lambda: try_out(book.snapshot(), request), lambda one: one["simulation"]["state"] == "done")
    return json.loads(json.dumps(try_out(book.snapshot(), request)))


def _items(side):
    items = side["items"]
    shown = zip(items["class"], items["word"], items["chance"], strict=True)
    return dict(zip(items["row"], shown, strict=True))


def _compare(side, results):
    """Hold classes, counts, routes and rooms of one side against a run."""
    expected = {
        one.item.row: ("", "anchored", one.adopted.probability)
        if one.is_anchored
        else (one.adopted.risk.name.lower(), "", one.adopted.probability)
        for one in results
    }
    assert _items(side) == expected
    counts = count("", tuple(results))
    assert side["counts"] == {one.name.lower(): counts.by_class[one] for one in RiskClass} | {"": counts.anchored}
    tables = results.route_tables
    words = {one.route: say_outlook(one, tables.risk) for one in tables.routes}
    assert {one["route"]: one["word"] for one in side["routes"]} == words
    rooms = {one.room: say_room_state(one) for one in tables.rooms}
    assert {one["room"]: one["word"] for one in side["rooms"]} == rooms


@pytest.fixture(scope="module")
def market():
    return hold(MARKET)


@pytest.mark.slow
def test_both_sides_are_those_of_runs_also_with_named_pieces_and_more_than_there_are(market):
    before, example = market.write(), assess.run(market.snapshot().inventory, figures=False)
    answer = _try(market, first=3, scale=1.4)
    results = assess.run(market.snapshot().inventory, figures=False, scale=1.4, anchor=3)
    _compare(answer["before"], example)
    _compare(answer["after"], results)
    held = {one.item.row for one in results if one.is_anchored} - {one.item.row for one in example if one.is_anchored}
    assert set(answer["anchored"]) == held
    assert answer["error"] == ""
    assert market.write() is before, "the very bytes"
    assert not market.state()["unsaved"]
    named, first, all_ = (_try(market, anchor=["42-04"], **more) for more in ({}, {"first": 1}, {"first": 10_000}))
    assert set(named["anchored"]) < set(first["anchored"])
    rows = assess.run(market.snapshot().inventory, figures=False, anchor=("42-04",)).schedule.rows
    assert first["entries"] == all_["first"] == len(rows)
    assert [all_["after"]["counts"][one] for one in ("medium", "high", "very_high")] == [0, 0, 0]


def test_scenarios_that_cannot_be_served_and_wrong_requests_say_why_and_a_faulty_row_stays_as_it_is(tmp_path):
    book = hold(write(tmp_path / "w.xlsx"))
    answer = _try(book, scenario="NTC 2018", scale=2)
    assert "Ground PGA, SDS, ShakeMap file and Shaking are blank" in answer["error"]
    assert {word for _, word, _ in _items(answer["after"]).values()} == {"needs shaking", "anchored"}
    answer = _try(book, scenario="recorded", anchor=["A1"])
    assert "'1' has no record" in answer["error"]
    assert _items(answer["after"])[2] == ("", "anchored", None)
    snapshot = hold(write(tmp_path / "w.xlsx")).snapshot()
    for request, match in WRONG:
        with pytest.raises(InputError, match=match):
            try_out(snapshot, request)
    book = hold(write(tmp_path / "w.xlsx"))
    edit(book, ("Items", 2, "height", "tall"))
    answer = _try(book, scale=2, first=1)
    assert _items(answer["before"])[2] == _items(answer["after"])[2] == ("", "check", None)
    with pytest.raises(InputError, match="'A1' cannot be anchored: its row 2 has an error"):
        _try(book, anchor=["A1"])


WRONG = [
    ({"scale": 0}, "scale is 0.0, expected above 0 and at most 10"), ({"scale": 10.5}, "scale is 10.5"),
    ({"scale": math.nan}, "scale is nan, expected a number"), ({"scale": 10**400}, "scale is 1000"),
    ({"scale": "2"}, "scale is '2', expected a number"), ({"scale": True}, "scale is True"),
    ({"first": -1}, "first is -1, expected a whole number, 0 or above"), ({"first": 1.5}, "first is 1.5"),
    ({"first": "3"}, "first is '3'"), ({"anchor": "A1"}, "anchor is 'A1', expected a list"),
    ({"anchor": [1]}, r"anchor is \[1\]"), ({"anchor": ["A9"]}, "there is no item 'A9' in Items"),
    ({"scenario": "strong"}, "scenario is 'strong', expected one of"), ({"scenario": 3}, "scenario is 3"),
    ({"verify": "all"}, "'verify' is not known, expected one of"), ([], "cannot be read"),
]  # fmt: skip
