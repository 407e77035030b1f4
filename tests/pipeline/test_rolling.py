"""Pieces on castors: they roll, are in no class and no sum, and may stand in the way."""

import numpy as np
import pytest

import assess
from assess.i18n import load_catalogue
from assess.report.counts import count
from assess.rocking.block import ROLLS_FROM
from assess.route_results import RouteState
from assess.settings import Settings
from tests.pipeline.rows import read_sheets
from tests.workbooks import UNVERIFIED

FLOORS = [{"floor": "1", "pfa_x": 0.6, "pfa_y": 0.6}]
CART = {"floor": "1", "breadth": 60, "width": 60, "height": 160, "mobile": "yes"}
LAMP = {"floor": "1", "breadth": 40, "width": 45, "height": 170, "mobile": "yes"}
CASE = {"floor": "1", "breadth": 40, "width": 90, "height": 190}
PLACES = [
    {"place": "Office", "kind": "room", "floor": "1", "x": 0, "y": 0},
    {"place": "Street", "kind": "exit", "floor": "1", "x": 9, "y": 0},
]
WAY = {"route": "Way", "segment": "hall", "floor": "1", "start": "Office", "end": "Street", "clear_width": 1.2}


def run(items, settings=UNVERIFIED, building=None, **sheets):
    rows = [{"item": name, "room": name} | one for name, one in items.items()]
    inventory = read_sheets(Building=[building or {}], Floors=FLOORS, Items=rows, **sheets)
    return assess.run(inventory, settings, figures=False)


def test_what_rolls_is_in_no_class_and_no_sum_and_what_is_slender_keeps_its_class():
    found = run({"cart": CART | {"quantity": 3}, "lamp": LAMP, "case": CASE})
    assert {one.item.item: (one.adopted.basis, one.apart) for one in found} == {
        "cart": ("rolls", "rolls"), "lamp": ("formula", ""), "case": ("formula", ""),
    }  # fmt: skip
    assert ["rolls" in one.adopted.flags for one in found] == [False, True, False]
    free = run({"cart": CART | {"mobile": "no"}})["cart"].adopted
    assert found["cart"].adopted.probability == free.probability > 0
    assert found["cart"].adopted.risk == free.risk
    counts = count("", tuple(found))
    assert (counts.free, counts.rolls, counts.total) == (2, 3, 5)
    assert counts.expected == found["lamp"].adopted.probability + found["case"].adopted.probability
    assert found.schedule.before.falls == pytest.approx(counts.expected)
    assert (found.schedule.before.apart, sum(found.schedule.before.classes)) == (3, 2)


@pytest.mark.parametrize(
    ("breadth", "centre", "basis"), [(35, 50, "rolls"), (34.9, 50, "formula"), (40, 60, "formula")]
)
def test_from_which_slenderness_on_it_rolls(breadth, centre, basis):
    """Half the breadth over the height of the centre of gravity: 0.35, 0.349, and 0.333 of the top-heavy one."""
    piece = CART | {"breadth": breadth, "height": 100, "centre_of_gravity": centre}
    assert ROLLS_FROM == 0.35
    assert run({"cart": piece})["cart"].adopted.basis == basis


@pytest.mark.parametrize("language", ["en", "it"])
def test_a_built_in_type_says_so_in_every_language_and_a_row_or_the_catalogue_may_say_otherwise(language):
    name = load_catalogue(language).find("Linen trolley on castors")
    sizes = {"floor": "1", "breadth": 60, "width": 60, "height": 150}
    items = {
        "by name": sizes | {"type": name},
        "by row": sizes | {"type": name, "mobile": "no"},
        "own": sizes | {"type": "Barrow"},
        "fixed": sizes | {"type": "Box"},
    }
    catalogue = [{"type": name}, {"type": "Barrow", "mobile": "yes"}, {"type": "Box"}]
    found = run(items, Catalogue=catalogue)
    assert [one.adopted.basis for one in found] == ["rolls", "formula", "rolls", "formula"]
    assert [one.item.mobile for one in found] == [True, False, True, None]


def test_simulated_it_keeps_its_chance_and_falls_in_no_draw_of_the_building():
    settings = Settings(runs=50, verify="all")
    found = run({"cart": CART, "case": CASE}, settings, {"period": 0.5})
    free = run({"cart": CART | {"mobile": "no"}, "case": CASE}, settings, {"period": 0.5})
    assert found["cart"].adopted.basis == "rolls"
    assert found["cart"].adopted.method == "housner_monte_carlo"
    assert found["cart"].adopted.probability == free["cart"].adopted.probability
    assert found["cart"].fell is None
    assert np.array_equal(found["case"].fell, free["case"].fell)
    assert count("", tuple(found)).expected == found["case"].adopted.probability


def test_it_may_stand_in_the_way_so_that_a_way_that_it_would_block_is_not_known():
    beside = {"route": "Way", "edge_distance": 0}
    found = run({"cart": CART | beside}, Places=PLACES, Routes=[WAY])
    (route,) = found.route_tables.routes
    assert route.state == RouteState.NOT_KNOWN
    assert [(one.what, one.names) for one in route.missing] == [("rolls", ("cart",))]
    assert route.blocked.probability == 0
    assert route.blocked_if_unconfirmed_fall.probability == 1
    assert found.route_tables.segments[0].pieces[0].flags[-1] == "rolls"
    wide = run({"cart": CART | beside}, Places=PLACES, Routes=[WAY | {"clear_width": 5}])
    assert wide.route_tables.routes[0].state == RouteState.OPEN
    held = run({"cart": CART | beside | {"anchored": "yes"}}, Places=PLACES, Routes=[WAY])
    assert held.route_tables.routes[0].state == RouteState.OPEN


def test_it_is_to_be_parked_first_where_it_may_block_a_way_and_never_fixed_to_a_wall():
    items = {"far": CART, "near": CART | {"route": "Way"}, "lamp": LAMP}
    found = run(items, Places=PLACES, Routes=[WAY])
    assert [found.item_rows[row.item_indices[0]].item for row in found.schedule.rows] == ["lamp"]
    checks = found.schedule.checks
    assert [(row.phase, row.works[0].items, row.works[0].detail) for row in checks] == [
        ("A", ("near",), "castors"), ("B", ("far",), "castors"),
    ]  # fmt: skip
    assert checks[0].falls_at_most == pytest.approx(found["near"].adopted.probability)
    assert {work.detail for row in found.schedule.rows for work in row.works} == {"castors"}
    assert (checks[0].falls_avoided, checks[0].works[0].pull_kn, checks[0].works[0].all_fixings) == (0, None, 0)
