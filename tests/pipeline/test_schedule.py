"""The schedule: its entries, their order, what they cost, and what they change."""

import pytest

import assess
from assess.report.say.work import list_changes
from tests.pipeline.rows import read_sheets
from tests.workbooks import UNVERIFIED

FLOORS = [{"floor": "1", "pfa_x": 0.5, "pfa_y": 0.5}, {"floor": "G", "pfa_x": 0.2, "pfa_y": 0.2}]
TALL = {"floor": "1", "breadth": 30, "width": 90, "height": 190, "weight": 120}
SQUAT = {"floor": "G", "breadth": 90, "width": 90, "height": 90, "weight": 60}


def schedule_of(items, costs=(), **more):
    sheets = {"Building": [{}], "Floors": FLOORS, "Items": items, "Costs": list(costs), **more}
    results = assess.run(read_sheets(**sheets), UNVERIFIED, figures=False)
    names = [tuple(results.item_rows[at].item for at in row.item_indices) for row in results.schedule.rows]
    return results, results.schedule, names


def test_alike_pieces_of_a_room_are_one_entry():
    items = [
        TALL | {"item": "a1", "room": "A"},
        TALL | {"item": "b1", "room": "B"},
        TALL | {"item": "a2", "room": "A", "quantity": 3},
        TALL | {"item": "n1"},
        TALL | {"item": "n2"},
        SQUAT | {"item": "low", "room": "A"},
        TALL | {"item": "held", "room": "A", "anchored": "yes"},
    ]
    _, schedule, names = schedule_of(items)
    assert sorted(names) == [("a2", "a1"), ("b1",), ("n1",), ("n2",)]
    first = schedule.rows[names.index(("a2", "a1"))]
    assert (first.place, first.room, first.pieces, first.is_together) == (1, "A", 4, False)


@pytest.mark.parametrize("order", [("wall", "free"), ("free", "wall")])
def test_pieces_that_are_fixed_in_different_ways_are_not_alike(order):
    given = {"wall": "yes", "free": "no"}
    items = [TALL | {"item": name, "room": "A", "against_wall": given[name]} for name in order]
    results, schedule, _ = schedule_of(items)
    works = {one.items: one for row in schedule.rows for one in row.works}
    details = {items: one.detail for items, one in works.items()}
    assert details == {("wall",): "bracket", ("free",): "base_angle"}
    tension = results["free"].item.anchor.tension_kn
    assert works["wall",].tension_kn == pytest.approx(tension)
    assert works["free",].tension_kn == pytest.approx(tension * 0.9 * 190 / 30)


def test_what_is_left_adds_up():
    items = [TALL | {"item": f"{room}1", "room": room, "quantity": n} for room, n in (("A", 1), ("B", 4), ("C", 2))]
    results, schedule, names = schedule_of(items)
    assert names == [("B1",), ("C1",), ("A1",)]
    chance = results["A1"].adopted.probability
    assert [one.falls_avoided for one in schedule.rows] == pytest.approx([4 * chance, 2 * chance, chance])
    assert [one.falls_left for one in schedule.rows] == pytest.approx([3 * chance, chance, 0])
    assert schedule.before.falls == pytest.approx(7 * chance)
    assert (schedule.after.falls, schedule.after.anchored, schedule.before.anchored) == (0, 7, 0)
    assert sum(schedule.before.classes) == 7
    assert schedule.after.classes == (0, 0, 0, 0)


def test_costs_by_detail_in_any_language():
    items = [
        TALL | {"item": "wall", "room": "A", "quantity": 2},
        TALL | {"item": "file", "room": "A", "description": "Lateral file"},
        TALL | {"item": "free", "room": "B", "against_wall": "no"},
    ]
    costs = [{"detail": "L-bracket to studs", "unit_cost": 40, "source": "offer of 2026"}]
    _, schedule, names = schedule_of(items, costs)
    works = [one for row in schedule.rows for one in row.works]
    assert [one.items for one in works] == names
    found = {one.items[0]: (one.detail, one.unit_cost, one.cost, one.cost_source) for one in works}
    assert found["wall"] == ("bracket", 40, 80, "offer of 2026")
    assert found["file"] == ("base_angle", None, None, "")
    assert found["free"] == ("base_angle", None, None, "")
    assert (schedule.cost, schedule.uncosted) == (80, 2)


def test_a_cost_for_nothing_that_is_done_is_a_warning():
    results, schedule, _ = schedule_of([TALL | {"item": "a"}], [{"detail": "glue", "unit_cost": 1}])
    (warning,) = (one for one in results.problem_rows if one.sheet == "Costs")
    assert warning.severity == "warning"
    assert "'glue'" in warning.message
    assert "L-bracket to studs" in warning.fix
    assert schedule.cost is None


BY_HAND = {
    # Bookcase, bracket at 0.9 of its height: W = 1.2 kN, B = 0.30 m, z = 0.95 m, h = 1.71 m.
    # At PFA, k = 0.5: T = 1.2 (0.5 x 0.95 - 0.15) / 1.71 = 0.2281 kN; shear 0.5 x 1.2 - 0.2281 = 0.3719 kN.
    # At 84 %, k = 0.5 exp(0.4) = 0.745912: T = 1.2 (0.708617 - 0.15) / 1.71 = 0.3920 kN.
    # By the code, F_p/W = 0.4 x 1.0 x (3.5 / 1.3) (1 / 1.5) = 0.717949, k_v = 0.2:
    # T = 1.2 (0.682051 - 0.8 x 0.15) / 1.71 = 0.3944 kN, more than at 84 %: 0.3944 / 0.854 is 1, so the least, 2.
    "wall": ({"weight": 1200 / 9.80665}, ("bracket", 0.2281, 0.3920, 0.3944, 0.3719, 2)),
    # The same of 9.6 kN with its bracket at 1.00 m: forces are 8 x 1.71 = 13.68 times as large, shear 9.6 x 0.5 - T.
    # T = 9.6 (0.475 - 0.15) / 1.00 = 3.1200 kN; at 84 % 9.6 x 0.558617 = 5.3627 kN; by the code 9.6 x 0.562051 =
    # 5.3957 kN; shear 4.8 - 3.12 = 1.6800 kN; 5.3957 / 0.8541 = 6.32, so 7 screws.
    "heavy": ({"weight": 9600 / 9.80665, "bracket_height": 100}, ("bracket", 3.1200, 5.3627, 5.3957, 1.6800, 7)),
    # A lateral file of 1.2 kN, fixed at its base: the moment acts on B = 0.30 m. T = 1.2 (0.475 - 0.15) / 0.30 =
    # 1.3000 kN; at 84 % 1.2 x 0.558617 / 0.30 = 2.2345 kN; by the code 1.2 x 0.562051 / 0.30 = 2.2482 kN; the base
    # carries the whole of 0.5 x 1.2 = 0.6000 kN.
    "base": (
        {"weight": 1200 / 9.80665, "description": "Lateral file"}, ("base_angle", 1.3000, 2.2345, 2.2482, 0.6000, 2),
    ),
    # The same: a height of a bracket, below z - B/(2 k) = 0.65 m, changes nothing at the base.
    "low": (
        {"weight": 1200 / 9.80665, "description": "Lateral file", "bracket_height": 30},
        ("base_angle", 1.3000, 2.2345, 2.2482, 0.6000, 2),
    ),
    # The bookcase with its bracket at 0.30 m: T as at the base, of B = 0.30 m; shear 1.3000 - 0.6000 = 0.7000 kN;
    # 2.2482 / 0.8541 = 2.63, so 3 screws.
    "under": (
        {"weight": 1200 / 9.80665, "bracket_height": 30}, ("bracket", 1.3000, 2.2345, 2.2482, 0.7000, 3),
    ),
}  # fmt: skip
"""Pieces by hand: what is given besides `TALL`; detail, T at PFA, at 84 %, by the code, shear, fixings."""


def test_the_forces_of_pieces_by_hand():
    items = [TALL | {"item": name, "room": name} | given for name, (given, _) in BY_HAND.items()]
    building = {"sds": 1.0, "motion_uncertainty": 0.4}
    _, schedule, _ = schedule_of(items, Building=[building])
    works = {one.items[0]: one for row in schedule.rows for one in row.works}
    for name, (_given, (detail, *forces, fixings)) in BY_HAND.items():
        one = works[name]
        found = (one.tension_kn, one.tension_high_kn, one.tension_code_kn, one.shear_kn)
        assert (one.detail, one.fixings) == (detail, fixings), name
        assert found == pytest.approx(forces, abs=6e-5), name


def test_routes_and_rooms_that_averages_leave_out_are_counted():
    """The hall is blocked; once its cabinet is held, the one without a position leaves it not known."""
    tall = {"floor": "1", "breadth": 30, "width": 90, "height": 190, "weight": 120}
    items = [tall | {"item": "near", "route": "Way", "edge_distance": 0}, tall | {"item": "loose"}]
    places = [
        {"place": "Office", "kind": "room", "floor": "1", "x": 0, "y": 0},
        {"place": "Street", "kind": "exit", "floor": "1", "x": 9, "y": 0},
    ]
    way = {"route": "Way", "segment": "hall", "floor": "1", "start": "Office", "end": "Street", "clear_width": 1.8}
    found, schedule, _ = schedule_of(items, Places=places, Routes=[way])
    assert [str(one.state) for one in found.route_tables.routes] == ["blocked"]
    held = [tall | {"item": "near", "route": "Way", "edge_distance": 0, "anchored": "yes"}, items[1]]
    found, schedule, _ = schedule_of(held, Places=places, Routes=[way])
    assert [str(one.state) for one in found.route_tables.routes] == ["not known"]
    left_out = [(one.unknown_routes, one.unknown_rooms) for one in (schedule.before, schedule.after)]
    assert left_out == [(1, 1), (0, 0)]
    labels = {one.label: (one.before, one.after) for one in list_changes(schedule)[1]}
    shown = [labels[f"Left out of these averages: {what} not known"] for what in ("routes", "rooms")]
    assert shown == [(1, 0), (1, 0)]


def rows_of(results):
    return [(row.phase, results.item_rows[row.item_indices[0]].item) for row in results.schedule.rows]


def test_what_avoids_most_and_what_saves_lives_is_done_now_and_high_pieces_are_never_only_listed():
    """Of 117 like falls: 100 are more than 80 %, so that 16 and 1 are for later; another 1 is of life safety."""
    few = {"a": 100, "b": 16, "c": 1, "d": 1}
    items = [TALL | {"item": name, "room": name, "quantity": n} for name, n in few.items()]
    items[3]["importance"] = "life safety"
    found, schedule, _ = schedule_of(items)
    assert rows_of(found) == [("A", "d"), ("A", "a"), ("B", "b"), ("B", "c")]
    assert [row.place for row in schedule.rows] == [1, 2, 3, 4]
    chance = found["a"].adopted.probability
    phases = [(one.phase, one.entries, one.pieces, one.places) for one in schedule.phases]
    assert phases == [("A", 1 + 1, 101, 2), ("B", 1 + 1, 17, 2)]
    assert [one.falls_avoided for one in schedule.phases] == pytest.approx([101 * chance, 17 * chance])
    assert [one.falls_left for one in schedule.phases] == pytest.approx([17 * chance, 0.0])
    assert [one.after.falls for one in schedule.phases] == pytest.approx([17 * chance, 0.0])
    assert schedule.after == schedule.phases[-1].after
    assert schedule.phases[0].hours == pytest.approx(101 * 0.75)
    held = assess.run(read_sheets(Floors=FLOORS, Items=items), UNVERIFIED, figures=False, anchor=2)
    assert held.schedule.before.falls == pytest.approx(17 * chance)
    assert held.schedule.checks == (), "what the run holds is not to be checked"


def test_what_opens_a_blocked_way_is_done_now_however_little_it_avoids():
    items = [
        TALL | {"item": "many", "room": "A", "quantity": 200},
        TALL | {"item": "near", "room": "B", "route": "Way"},
    ]
    places = [
        {"place": "Office", "kind": "room", "floor": "1", "x": 0, "y": 0},
        {"place": "Street", "kind": "exit", "floor": "1", "x": 9, "y": 0},
    ]
    way = {"route": "Way", "segment": "hall", "floor": "1", "start": "Office", "end": "Street", "clear_width": 1.8}
    found, schedule, _ = schedule_of(items, Places=places, Routes=[way])
    assert dict(schedule.before.routes) == {"blocked": 1}
    assert rows_of(found) == [("A", "many"), ("A", "near")]
    assert dict(schedule.phases[0].after.routes) == {"open": 1}
    found, _, _ = schedule_of([items[0], {**items[1], "route": None}])
    assert rows_of(found) == [("A", "many"), ("B", "near")]


def test_anchors_are_checked_or_completed_with_the_fixings_of_the_piece_and_trusted_ones_stand_in_no_sum():
    items = [
        TALL | {"item": "unknown", "room": "A", "anchored": "yes", "quantity": 2},
        TALL | {"item": "strong", "room": "B", "anchored": "yes", "bracket_capacity": 50},
        TALL | {"item": "weak", "room": "C", "anchored": "yes", "bracket_capacity": 0.02},
        TALL | {"item": "partly", "room": "D", "anchored": "partly"},
        TALL | {"item": "file", "room": "E", "anchored": "partly", "description": "Lateral file"},
        TALL | {"item": "bare", "room": "F"},
        SQUAT | {"item": "still", "room": "G", "anchored": "yes"},
    ]
    found, schedule, _ = schedule_of(items)
    works = {one.items[0]: one for row in schedule.rows for one in row.works}
    assert {name: (one.detail, one.like) for name, one in works.items()} == {
        "weak": ("complete", "bracket"), "partly": ("complete", "bracket"), "file": ("complete", "base_angle"),
        "bare": ("bracket", "bracket"),
    }  # fmt: skip
    assert works["partly"].pull_kn == works["bare"].pull_kn == works["bare"].tension_high_kn / works["bare"].fixings
    assert (works["file"].tension_kn, works["file"].is_least) == (pytest.approx(works["bare"].tension_kn * 5.7), True)
    (check,) = schedule.checks
    assert (check.phase, check.works[0].items, check.works[0].detail) == ("A", ("unknown",), "check")
    assert (check.falls_avoided, check.falls_at_most) == (0, 2 * found["unknown"].adopted.probability)
    assert check.place == len(schedule.rows) + 1


@pytest.mark.parametrize(
    ("given", "detail"),
    [
        ({"type": "Gas cylinder"}, "chain"), ({"type": "Fume cupboard"}, "maker"),
        ({"type": "Server rack 42U"}, "rack"),
        ({"type": "Refrigerator side by side"}, "strap"), ({"type": "Mobile shelving carriage"}, "ceiling"),
        ({"type": "Coat stand"}, "clear"), ({"type": "IV stand on castors"}, "castors"),
        ({"type": "Gas cylinder trolley"}, "chain"), ({"type": "Bookcase 5 shelves"}, "bracket"),
        ({"type": "Bookcase 5 shelves", "against_wall": "no"}, "base_angle"),
        ({"type": "Refrigerator side by side", "against_wall": "no"}, "base_angle"),
        ({"type": "Bookcase 5 shelves", "mobile": "yes"}, "castors"), ({"notes": "stands on castors"}, "bracket"),
        ({"description": "Filing cabinet"}, "base_angle"),
        ({"type": "Own, to the ceiling"}, "ceiling"), ({"type": "Own, not said"}, "bracket"),
    ],
)  # fmt: skip
def test_each_piece_gets_a_fix_that_it_can_have(given, detail):
    types = [{"type": "Own, to the ceiling", "fix_by": "ceiling"}, {"type": "Own, not said"}]
    types += [{"type": one} for one in {given.get("type")} - {None, *(one["type"] for one in types)}]
    piece = {"floor": "1", "breadth": 30, "width": 60, "height": 190, "item": "a", "room": "A"}
    _, schedule, _ = schedule_of([piece | given], Catalogue=types)
    assert [work.detail for row in schedule.rows for work in row.works] == [detail]


def test_what_is_kept_out_of_the_way_blocks_nothing_but_may_still_fall():
    stand = {"floor": "1", "breadth": 30, "width": 30, "height": 175, "type": "Coat stand", "route": "Way"}
    places = [
        {"place": "Office", "kind": "room", "floor": "1", "x": 0, "y": 0},
        {"place": "Street", "kind": "exit", "floor": "1", "x": 9, "y": 0},
    ]
    way = {"route": "Way", "segment": "hall", "floor": "1", "start": "Office", "end": "Street", "clear_width": 1.8}
    found, schedule, _ = schedule_of(
        [stand | {"item": "stand", "room": "A"}], Places=places, Routes=[way], Catalogue=[{"type": "Coat stand"}]
    )
    (row,) = schedule.rows
    assert (row.phase, row.works[0].detail, row.falls_avoided) == ("A", "clear", 0)
    assert [dict(one.routes) for one in (schedule.before, schedule.after)] == [{"blocked": 1}, {"open": 1}]
    assert schedule.after.falls == schedule.before.falls == found["stand"].adopted.probability > 0
    assert schedule.after.anchored == 0


def test_of_a_blocked_way_those_steps_are_done_now_that_end_that_and_later_those_that_open_it():
    """Each piece falls with a chance of 0.16, and blocks alone: any of three in 0.41, of two in 0.297."""
    lone = {"floor": "G", "breadth": 35, "width": 60, "height": 180, "route": "Way"}
    items = [lone | {"item": name, "room": name} for name in "abc"]
    places = [
        {"place": "Office", "kind": "room", "floor": "G", "x": 0, "y": 0},
        {"place": "Street", "kind": "exit", "floor": "G", "x": 9, "y": 0},
    ]
    way = {"route": "Way", "segment": "hall", "floor": "G", "start": "Office", "end": "Street", "clear_width": 1.8}
    many = TALL | {"item": "many", "room": "M", "quantity": 200}
    found, schedule, _ = schedule_of([*items, many], Places=places, Routes=[way])
    (route,) = found.route_tables.routes
    assert [fix.left + fix.gain for fix in route.fixes] == pytest.approx([0.411, 0.297, 0.162], abs=5e-4)
    assert rows_of(found) == [("A", "many"), ("A", "a"), ("B", "b"), ("B", "c")]
    assert [dict(one.after.routes) for one in schedule.phases] == [{"doubtful": 1}, {"open": 1}]


def test_in_a_large_building_where_no_entry_is_a_large_share_what_avoids_most_is_done_now():
    """A hundred and fifty rooms with a like bookcase each: none avoids a hundredth, and none is left to be listed."""
    items = [TALL | {"item": f"B{at}", "room": f"R{at}"} for at in range(150)]
    found, schedule, _ = schedule_of(items)
    phases = [row.phase for row in schedule.rows]
    assert (phases.count("A"), phases.count("B"), phases.count("C")) == (120, 30, 0)
    assert schedule.phases[0].falls_avoided == pytest.approx(0.8 * schedule.before.falls)
    assert found["B0"].adopted.probability > 0
