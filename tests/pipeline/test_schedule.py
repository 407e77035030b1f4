"""The schedule: its entries, their order, what they cost, and what they change."""

import pytest

import assess
from assess.details import DETAILS, SCREW, count_fixings
from assess.settings import Settings
from assess.workbook.template import Content, write_workbook

FLOORS = [{"floor": "1", "pfa_x": 0.5, "pfa_y": 0.5}]
TALL = {"floor": "1", "breadth": 30, "width": 90, "height": 190, "weight": 120}
SQUAT = {"floor": "1", "breadth": 80, "width": 90, "height": 70, "weight": 60}


def schedule_of(folder, items, costs=(), **more):
    path = folder / "w.xlsx"
    rows = {"Building": [{}], "Floors": FLOORS, "Items": items, "Costs": list(costs), **more}
    write_workbook(path, Content(rows=rows))
    results = assess.run(assess.read_inventory(path), Settings(verify="none"))
    names = [tuple(results.item_rows[at].item for at in row.item_indices) for row in results.schedule.rows]
    return results, results.schedule, names


def test_alike_pieces_of_a_room_are_one_entry(tmp_path):
    items = [
        TALL | {"item": "a1", "room": "A"},
        TALL | {"item": "b1", "room": "B"},
        TALL | {"item": "a2", "room": "A", "quantity": 3},
        TALL | {"item": "n1"},
        TALL | {"item": "n2"},
        SQUAT | {"item": "low", "room": "A"},
        TALL | {"item": "held", "room": "A", "anchored": "yes"},
    ]
    _, schedule, names = schedule_of(tmp_path, items)
    assert sorted(names) == [("a2", "a1"), ("b1",), ("n1",), ("n2",)]
    first = schedule.rows[names.index(("a2", "a1"))]
    assert (first.place, first.room, first.pieces, first.is_together) == (1, "A", 4, False)


def test_what_is_left_adds_up(tmp_path):
    items = [TALL | {"item": f"{room}1", "room": room, "quantity": n} for room, n in (("A", 1), ("B", 4), ("C", 2))]
    results, schedule, names = schedule_of(tmp_path, items)
    assert names == [("B1",), ("C1",), ("A1",)]
    chance = results["A1"].adopted.probability
    assert [one.falls_avoided for one in schedule.rows] == pytest.approx([4 * chance, 2 * chance, chance])
    assert [one.falls_left for one in schedule.rows] == pytest.approx([3 * chance, chance, 0])
    assert schedule.before.falls == pytest.approx(7 * chance)
    assert (schedule.after.falls, schedule.after.anchored, schedule.before.anchored) == (0, 7, 0)
    assert sum(schedule.before.classes) == 7
    assert schedule.after.classes == (0, 0, 0, 0)


def test_costs_by_detail_in_any_language(tmp_path):
    items = [
        TALL | {"item": "wall", "room": "A", "quantity": 2},
        TALL | {"item": "file", "room": "A", "description": "Lateral file"},
        TALL | {"item": "free", "room": "B", "against_wall": "no"},
    ]
    costs = [{"detail": "L-bracket to studs", "unit_cost": 40, "source": "offer of 2026"}]
    _, schedule, names = schedule_of(tmp_path, items, costs)
    found = {name: (one.detail, one.unit_cost, one.cost, one.cost_source) for (name,), one in
             zip(names, schedule.rows, strict=True)}  # fmt: skip
    assert found["wall"] == ("bracket", 40, 80, "offer of 2026")
    assert found["file"] == ("base_angle", None, None, "")
    assert found["free"] == ("base_angle", None, None, "")
    assert schedule.cost == 80


def test_no_costs_no_sum(tmp_path):
    _, schedule, _ = schedule_of(tmp_path, [TALL | {"item": "a"}])
    assert schedule.cost is None


def test_a_cost_for_nothing_that_is_done_is_a_warning(tmp_path):
    results, schedule, _ = schedule_of(tmp_path, [TALL | {"item": "a"}], [{"detail": "glue", "unit_cost": 1}])
    (warning,) = (one for one in results.problem_rows if one.sheet == "Costs")
    assert (warning.severity, warning.cell) == ("warning", "A2")
    assert "'glue'" in warning.message
    assert "L-bracket to studs" in warning.fix
    assert schedule.cost is None


def test_the_demand_is_the_larger_of_the_scenario_and_the_code(tmp_path):
    results, schedule, _ = schedule_of(tmp_path, [TALL | {"item": "a"}], Building=[{"sds": 3.0}])
    anchor = results["a"].item.anchor
    assert anchor.tension_code_kn > anchor.tension_high_kn
    assert schedule.rows[0].tension_kn == anchor.tension_code_kn


def test_fixings_follow_from_the_printed_capacity():
    bracket = DETAILS["bracket"]
    assert pytest.approx(854, abs=1) == SCREW
    assert [count_fixings(bracket, force) for force in (0, 2 * SCREW, 2 * SCREW + 1, 5 * SCREW)] == [2, 2, 3, 5]
    assert count_fixings(DETAILS["base_angle"], 1e6) == 2


def test_a_building_without_anything_to_fix(tmp_path):
    _, schedule, _ = schedule_of(tmp_path, [SQUAT | {"item": "a"}])
    assert schedule.rows == ()
    assert schedule.before == schedule.after
