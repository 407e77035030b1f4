"""What if pieces were anchored: the same numbers as of a workbook that says so, and as the schedule promises."""

from dataclasses import replace

import pytest

import assess
from assess.errors import SettingsError
from assess.pipeline.anchors import anchor_named, spell_names
from assess.settings import Settings
from tests.pipeline.rows import read_sheets
from tests.refusals import check_refusals
from tests.report import routed

SETTINGS = Settings(runs=60)


@pytest.fixture(scope="module")
def inventory():
    rows = {"Building": [{"period": 0.8}], "Floors": routed.FLOORS, "Places": routed.PLACES, "Routes": routed.ROUTES}
    return read_sheets(**rows, Items=[*routed.ITEMS, {"item": "thin", "floor": "1", "breadth": 20, "height": 180}])


@pytest.fixture(scope="module")
def plain(inventory):
    return assess.run(inventory, SETTINGS, figures=False)


def test_before_and_after_are_those_of_a_second_run_with_the_pieces_anchored(inventory, plain):
    held = [plain.item_rows[at].item for row in plain.schedule.rows for at in row.item_indices]
    anchored = {one.item for one in inventory.items} & set(held)
    items = tuple(replace(one, anchored="yes") if one.item in anchored else one for one in inventory.items)
    second = assess.run(replace(inventory, items=items), SETTINGS, figures=False)
    assert second.schedule.before == plain.schedule.after
    assert plain.schedule.after != plain.schedule.before
    assert second.schedule.rows == ()


def test_the_first_entries(inventory, plain):
    found = assess.run(inventory, SETTINGS, anchor="first:2", figures=False)
    rows = plain.schedule.rows
    names = [plain.item_rows[at].item for row in rows[:2] for at in row.item_indices]
    by_name = assess.run(inventory, SETTINGS, anchor=",".join(names), figures=False)
    assert by_name.schedule == found.schedule
    assert by_name.route_tables == found.route_tables
    assert [one.is_held for one in by_name.item_rows] == [one.is_held for one in found.item_rows]
    assert found.schedule.before.falls == pytest.approx(rows[1].falls_left, abs=1e-9)
    assert [one.item_indices for one in found.schedule.rows] == [one.item_indices for one in rows[2:]] != []


def test_names_are_kept_as_the_workbook_spells_them_and_once(inventory):
    spelled = replace(inventory, items=(replace(inventory.items[0], item="Big-A"), *inventory.items[1:]))
    assert spell_names(spelled, ["big-a", " BIG-A ", "Big-A"]) == ("Big-A",)
    results = assess.run(spelled, Settings(verify="none"), anchor=[" big-a"], figures=False)
    assert [one.item.item for one in results if one.is_anchored] == ["Big-A", "held"]


def test_an_item_that_is_anchored_already_gets_a_note_and_a_weak_bracket_is_taken_to_hold(inventory):
    held = replace(inventory, items=(replace(inventory.items[0], anchored="yes"), *inventory.items[1:]))
    name, other = (one.item for one in inventory.items[:2])
    noted = anchor_named(held, [name, other]).problems[len(held.problems) :]
    assert [str(one) for one in noted] == [f"Items: Item {name!r} is anchored already: its anchor is taken to hold."]
    weak = replace(inventory, items=(replace(inventory.items[0], bracket_capacity=1.0), *inventory.items[1:]))
    assert anchor_named(weak, [name]).items[0].bracket_capacity is None


def test_what_cannot_be(inventory):
    cases = (
        ("clam", r"anchor: there is no item 'clam' in Items\. Did you mean 'calm'\?"),
        ("first:0", r"anchor is 'first:0', expected names of items"),
        ("first:9999", r"anchor: first:9,999 is more than the \d+ entries"),
        ("first:x", r"anchor is 'first:x', expected first:N with a whole number N of at least 1"),
        ("first:-1", r"anchor is 'first:-1', expected first:N"),
        (" First ", r"anchor is 'First', expected first:N"),
        ("first:2,calm", r"anchor is 'first:2', expected first:N .* alone"),
        ("", r"anchor is '', expected names of items"),
        ("calm,,tall", r"anchor is 'calm,,tall', expected"),
        (1.5, r"anchor is 1\.5, expected"),
    )
    verify = Settings(verify="none")
    check_refusals(SettingsError, lambda anchor: assess.run(inventory, verify, anchor=anchor, figures=False), cases)
