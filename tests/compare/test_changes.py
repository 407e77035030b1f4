"""What counts as worse, better or not comparable, and what lies within the sampling interval; see test_shown.py."""

import math

import pytest

from assess.compare.changes import Direction, compare, lies_within
from assess.compare.comparison_document import View, say_anchor
from assess.compare.comparison_files import describe
from assess.compare.past_run import PastChance, read_run
from assess.errors import InputError
from assess.risk import wilson_interval
from assess.settings import Settings
from tests.compare.past import item, read_changed, write_routed_run, write_run
from tests.report.routed import ITEMS, PLACES
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("changes")


@pytest.fixture(scope="module")
def source(folder):
    return write_run(folder / "a", UNVERIFIED)


@pytest.fixture(scope="module")
def routed(folder):
    return write_routed_run(folder / "r", UNVERIFIED)


def _adopt(record, name, **adopted):
    item(record, name)["adopted"].update(adopted)


def _directions(found):
    return {one.row.item: one.direction.value for one in found.pieces}


def test_a_run_against_itself_is_unchanged(source, routed, tmp_path):
    cellar = {"place": "Cellar", "floor": "G", "kind": "room"}
    for path in (source, routed, write_routed_run(tmp_path / "more", UNVERIFIED, Places=[*PLACES, cellar])):
        run = read_run(path)
        found = compare(run, run)
        assert {one.direction for rows in (found.pieces, found.routes, found.rooms) for one in rows} == {Direction.SAME}
        assert View(found).headline == "Nothing changed: BEFORE and AFTER are the same results."
        assert (View(found).list_worse(), View(found).tone) == ([], "same")
        assert all(was == now for was, now in found.moves)
    assert View(found).list_others() == [
        "In both runs, 1 room is joined to no exit or stair, so that its way out is not known: Cellar."
    ]


def test_pieces_go_worse_and_better_by_class_chance_and_anchor(source, tmp_path):
    def edit(record):
        _adopt(record, "A1", **{"class": "low", "probability": 0.01})
        _adopt(record, "A2", probability=0.21)
        _adopt(record, "A5", **{"class": "high", "probability": 0.5})
        item(record, "A4")["anchor"]["counts_as_anchored"] = False

    before, after = read_changed(source, tmp_path, edit), read_run(source)
    forth, back = compare(before, after), compare(after, before)
    assert _directions(forth) == {"A1": "worse", "A5": "worse", "A4": "better", "A2": "rises", "A3": "same"}
    assert _directions(back) == {"A4": "worse", "A2": "falls", "A1": "better", "A5": "better", "A3": "same"}
    assert {one.row.item for one in forth.pieces[:2]} == {"A1", "A5"}
    assert forth.count(Direction.WORSE) == 2
    assert View(forth).tone == View(back).tone == "worse"
    assert "2 pieces go to a higher class or are no longer anchored: A1, A5." in View(forth).list_worse()


def test_rows_and_columns_of_the_matrix_add_up_to_the_counts(source, tmp_path):
    def edit(record):
        item(record, "A3")["quantity"] = 5
        item(record, "A2")["item"] = "new"
        _adopt(record, "A1", **{"class": "medium"})

    before, after = read_run(source), read_changed(source, tmp_path, edit)
    found = compare(before, after)
    for at, run in enumerate((before, after)):
        for standing in found.standings():
            quantity = sum(one.quantity for one in run.pieces if run.standing(one) == standing)
            assert sum(count for move, count in found.moves.items() if move[at] == standing) == quantity
    assert found.moves[("", "high")] == 2
    assert (found.count(Direction.ADDED), found.count(Direction.REMOVED)) == (3, 1)
    assert _directions(found)["new"] == "added"
    assert _directions(found)["A2"] == "removed"
    texts = View(found).list_others()
    assert texts == ["3 pieces are only in AFTER: new, A3 (×\N{NO-BREAK SPACE}2).", "1 piece is only in BEFORE: A2."]
    both = found.falls_of_both
    assert both is not None
    counted = [one for one in before.pieces if one.item in ("A1", "A3", "A5")]
    assert both.before == pytest.approx(sum(one.quantity * one.chance.probability for one in counted))


def _chance(overturned, runs):
    low, high = wilson_interval(overturned, runs)
    return PastChance(overturned / runs, float(low), float(high))


def test_the_interval_of_a_difference_is_newcombes():
    """Newcombe (1998), Table II, method 10: 56/70 against 48/80 gives 0.0524 to 0.3339, 9/10 against 3/10 0.1705 to
    0.8090."""
    for one, other, low, high in (((56, 70), (48, 80), 0.0524, 0.3339), ((9, 10), (3, 10), 0.1705, 0.8090)):
        after, before = _chance(*one), _chance(*other)
        difference = after.probability - before.probability
        down = math.hypot(after.probability - after.low, before.high - before.probability)
        up = math.hypot(after.high - after.probability, before.probability - before.low)
        assert (difference - down, difference + up) == pytest.approx((low, high), abs=5e-5)
        assert lies_within(before, after) is lies_within(after, before) is False
    assert lies_within(_chance(10, 200), _chance(14, 200)) is True
    assert lies_within(_chance(10, 200), PastChance(0.9)) is None


def test_a_change_within_the_sampling_interval_is_said(source, tmp_path):
    def run(name, overturned, risk):
        def edit(record):
            chance = _chance(overturned, 200)
            for each in ("A1", "A2", "A3", "A5"):
                _adopt(record, each, basis="simulated", probability=chance.probability, low=chance.low,
                       high=chance.high, **{"class": risk})  # fmt: skip
            item(record, "A1")["verification"] = {"runs": 200}

        return read_changed(source, tmp_path / name, edit)

    low, medium, more, high = run("a", 5, "low"), run("b", 7, "medium"), run("c", 12, "medium"), run("d", 90, "high")
    found = compare(low, medium)
    assert found.count(Direction.WORSE) == 6
    assert View(found).list_worse()[0].endswith("For 6 of them the difference lies within the sampling interval.")
    assert set(_directions(compare(medium, more)).values()) == {"same"}
    assert View(compare(medium, more)).headline == "Nothing changed beyond the sampling interval."
    assert compare(more, high).count(Direction.WORSE) == 6
    assert not any(one.is_within for one in compare(more, high).pieces)


def test_states_of_routes_have_an_order_and_unknown_ones_have_none(routed, tmp_path):
    def block(record):
        for one in record["routes"]["routes"]:
            one["state"] = "blocked"

    before = read_changed(routed, tmp_path / "a", block)

    def edit(record):
        states = {"West": "open", "Back": "doubtful", "Yard": "not known"}
        for one in record["routes"]["routes"]:
            one["state"] = states[one["route"]]

    after = read_changed(routed, tmp_path / "b", edit)
    found = {one.row.name: one.direction.value for one in compare(before, after).routes}
    back = {one.row.name: one.direction.value for one in compare(after, before).routes}
    assert found == {"West": "better", "Back": "better", "Yard": "unclear"}
    assert back == {"West": "worse", "Back": "worse", "Yard": "unclear"}


def test_a_room_whose_way_out_is_not_known_is_not_safe(routed, tmp_path):
    """In the file its chance is below the limit: it leaves out a piece whose position is missing."""

    def edit(record):
        archive = next(one for one in record["routes"]["rooms"] if one["room"] == "Archive")
        assert archive["state"] == "not known"
        archive["loses_every_exit"].update(probability=0.0, low=0.0, high=0.0)

    unknown = read_changed(routed, tmp_path / "a", edit)
    known = read_run(write_routed_run(tmp_path / "b", Settings(verify="none", scale=0.05), Items=ITEMS[:3]))
    assert {one.name: one.state for one in unknown.rooms} == {"Office": "blocked", "Archive": "not known"}
    found = compare(unknown, known)
    assert {one.row.name: one.direction.value for one in found.rooms} == {"Office": "better", "Archive": "unclear"}
    assert "1 room cannot be compared: Archive (not known → open)." in View(found).list_others()
    assert describe(found)["counts"]["rooms"] == {
        "blocked": {"before": 1, "after": 0},
        "not known": {"before": 1, "after": 0},
        "open": {"before": 0, "after": 2},
    }


def test_what_is_taken_as_anchored_is_put_into_words():
    assert say_anchor("") == say_anchor(None) == "–"
    assert say_anchor("A1,B-2") == "A1, B-2"
    assert say_anchor("A1,A2,A3,A4,A5,A6,A7") == "A1, A2, A3, A4, A5 and 2 more"
    assert say_anchor("first:1") == "the first entry of what to fix"
    assert say_anchor("first:12") == "the first 12 entries of what to fix"


def test_runs_without_a_common_item_are_not_compared(source, routed, tmp_path):
    empty = read_changed(source, tmp_path, lambda record: record["items"].clear())
    found = compare(empty, empty)
    assert found.pieces == ()
    for one, other in ((read_run(source), read_run(routed)), (empty, read_run(source))):
        with pytest.raises(InputError, match=r"have no item in common: they cannot be compared"):
            compare(one, other)
