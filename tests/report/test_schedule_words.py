"""The schedule in words: names, work by room, forces, marks, costs, before and after, on the page and in the sheet."""

import pytest

import assess
from assess.report.say import work as say
from assess.report.words import say_bracket
from assess.settings import Settings
from tests.workbooks import write_sheets

FLOORS = [
    {"floor": "2", "pfa_x": 0.5, "pfa_y": 0.5, "elevation": 4},
    {"floor": "1", "pfa_x": 0.2, "pfv_x": 32, "pfa_y": 0.2, "pfv_y": 32, "elevation": 0},
]
TALL = {"floor": "2", "breadth": 30, "width": 90, "height": 190, "weight": 120, "bracket_height": 170}
ITEMS = [
    *(TALL | {"item": f"b{at}", "room": "Beta", "description": "Bookcase"} for at in range(1, 6)),
    TALL | {"item": "low", "room": "Alpha", "floor": "1", "breadth": 50, "height": 150, "bracket_height": 140},
    TALL | {"item": "file", "room": "Alpha", "description": "Lateral file", "weight": None, "bracket_height": None},
    TALL | {"item": "guess", "room": "Alpha", "weight": None, "width": None, "bracket_height": None, "quantity": 2},
    TALL | {"item": "weak", "room": "Gamma", "anchored": "yes", "bracket_capacity": 0.05},
    TALL | {"item": "part", "room": "Gamma", "anchored": "partly", "bracket_capacity": 0.05},
    TALL | {"item": "firm", "room": "Gamma", "anchored": "partly", "bracket_capacity": 5},
]


def assess_these(folder, items=ITEMS, **building):
    building = {"motion_uncertainty": 0.4} | building
    rows = {"Building": [building], "Floors": FLOORS, "Items": items}
    path = write_sheets(folder / "w.xlsx", rows)
    return assess.run(assess.read_inventory(path), Settings(verify="none"))


def test_names_are_shortened():
    for names, short in (
        (["25-09", "25-07", "25-08"], "25-07 to 25-09"),
        (["a10", "a9", "a8", "a7"], "a7 to a10"),
        (["25-07", "25-08", "25-09", "25-10", "25-12"], "25-07 to 25-10 and 25-12"),
        (["a1", "b2", "c3", "d4"], "a1, b2, c3 and d4"),
        (["desk"], "desk"),
        ([f"x{at}y" for at in range(10)], "x0y, x1y, x2y, x3y, x4y, x5y, x6y, x7y and 2 more"),
    ):
        assert say.join_names(say.shorten_names(names)) == short, (names, short)


@pytest.mark.parametrize(("anchored", "counts"), [("yes", "anchored"), ("partly", "free-standing")])
def test_a_bracket_of_a_piece_of_unknown_width_is_named(tmp_path, anchored, counts):
    bare = TALL | {"weight": None, "width": None, "bracket_capacity": 50, "anchored": anchored}
    results = assess_these(tmp_path, [bare | {"item": "bare"}, bare | {"item": "blank", "bracket_capacity": None}])
    assert results["bare"].is_anchored is (anchored == "yes")
    words = f"width not known, so whether its bracket holds is not known: counts as {counts}"
    assert [say_bracket(results[name]) for name in ("bare", "blank")] == [words, ""]


def test_an_anchored_piece_whose_bracket_may_fail_is_named(tmp_path):
    for anchored, capacity, words in (
        ("yes", "high", ""),
        ("yes", "middle", "bracket holds at PFA, fails at 84 % of PFA: counts as anchored"),
        ("yes", "code", "bracket holds at PFA, fails at 84 % of PFA and by the code: counts as anchored"),
        ("partly", "code", "bracket holds at 84 % of PFA, fails by the code: counts as anchored"),
    ):
        named = TALL | {"item": "firm", "anchored": anchored}
        plain = assess_these(tmp_path, [named])["firm"].item.anchor
        between = (plain.tension_kn + plain.tension_high_kn) / 2
        chosen = plain.tension_high_kn * 1.01 if capacity == "high" or anchored == "partly" else between
        sds = 3.0 if capacity == "code" else None
        results = assess_these(tmp_path, [named | {"bracket_capacity": chosen}], sds=sds)
        assert results["firm"].is_anchored, (anchored, capacity)
        assert say_bracket(results["firm"]) == words, (anchored, capacity)
        said = "1 anchored piece has a bracket that fails at 84 % of PFA or by the code: firm."
        assert (say.say_doubtful_brackets(results) == [said]) is bool(words), (anchored, capacity)
