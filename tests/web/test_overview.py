"""The overview: its numbers are those of a run with the same settings, however little of the workbook is filled in."""

import json
from collections import Counter
from dataclasses import replace

import pytest

import assess
from assess.i18n import load_catalogue, speaking
from assess.report.counts import count
from assess.risk import RiskClass
from assess.web.evaluation import AS_RUN
from assess.web.overview import MOST, describe_overview
from tests.web.opened import MARKET, edit, hold, settle, write_template
from tests.web.test_route_states import HALL


def _answer(book):
    settle(book)
    return json.loads(json.dumps(describe_overview(book.snapshot())))


def _count(routes):
    return Counter({state: n for state, n in routes.items() if n})


def _count_states(results):
    return Counter(one.state.name.lower() for one in results.route_tables.routes)


@pytest.mark.slow
def test_its_numbers_are_those_of_the_run_also_once_entries_are_fixed():
    book = hold(MARKET)
    early = describe_overview(book.snapshot())
    assert early["basis"] == "formula", "until all is simulated it is not of both"
    assert {one["basis"] for one in early["worst"]} == {"formula"}
    answer, snapshot, settings = _answer(book), book.snapshot(), AS_RUN
    inventory = replace(snapshot.inventory, hazard=None)
    results = assess.run(inventory, settings, figures=False)
    total, rows = count("", tuple(results)), {one.item.row: one for one in results}
    assert answer["basis"] == results.main_basis
    assert [answer["counts"][one.name.lower()] for one in RiskClass] == [total.by_class[one] for one in RiskClass]
    assert answer["falls"] == [total.expected, total.falls_low, total.falls_high]
    assert f"of {total.free} free-standing pieces fall" in answer["outcome"]
    worst = max(one.adopted.probability for one in results if not one.is_anchored)
    assert rows[answer["worst"][0]["row"]].adopted.probability == worst
    assert _count(answer["ways"]["routes"]) == _count_states(results)
    assert (
        f"{_count_states(results)['blocked']} of {len(results.route_tables.routes)} ways out are" in answer["outcome"]
    )
    rooms = Counter((one.floor, one.state.name.lower()) for one in results.route_tables.rooms)
    found = Counter(
        {(one["floor"], state): n for one in answer["ways"]["floors"] for state, n in one["rooms"].items() if n}
    )
    assert found == rooms
    blocked = [one["rooms"]["blocked"] for one in answer["ways"]["floors"]]
    assert blocked == sorted(blocked, reverse=True)
    entries = results.schedule.rows
    assert [one["falls_left"] for one in answer["fixes"]] == [one.falls_left for one in entries[:MOST]]
    assert answer["entries"] == len(entries)
    for first in (2, MOST):
        fixed = assess.run(inventory, settings, figures=False, anchor=first)
        assert _count(answer["fixes"][first - 1]["ways_left"]) == _count_states(fixed), first
    everything = assess.run(inventory, settings, figures=False, anchor=len(entries))
    assert _count(answer["after"]["ways"]) == _count_states(everything)
    assert sorted(row for floor in answer["floors"] for row in floor["items"]) == sorted(rows)
    assert [one["floor"] for one in answer["floors"]] == ["42", "34", "25", "G"]
    edit(book, ("Items", answer["worst"][0]["row"], "anchored", "yes"))
    assert _answer(book)["counts"]["anchored"] == answer["counts"]["anchored"] + 1


def test_it_says_what_is_known_and_why_the_rest_is_not(tmp_path):
    book = hold(write_template(tmp_path / "hall.xlsx", HALL))
    answer = _answer(book)
    assert "of 2 free-standing pieces fall" in answer["outcome"]
    assert answer["outcome"].endswith("; 2 of 2 ways out are likely blocked.")
    assert [one["floor"] for one in answer["floors"]] == ["2", "1"], "from the top"
    with speaking(load_catalogue("it")):
        assert "vie d'uscita" in _answer(book)["outcome"]
    edit(book, ("Items", 2, "floor", "9"), ("Items", 3, "height", None))
    lost = _answer(book)
    assert lost["floors"][-1] == {"row": None, "floor": "", "name": "", "items": [2]}
    assert lost["floors"][0]["items"] == [3], "a row that is not filled in stands on its floor, too"
    edit(book, *(("Floors", row, name, None) for row in (2, 3) for name in ("pfa_x", "elevation")))
    nothing = _answer(book)
    assert "outcome" not in nothing
    assert nothing["error"]
    assert nothing["ways"]["routes"]["not_known"] == 2
