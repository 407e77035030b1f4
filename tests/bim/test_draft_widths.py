"""Clear widths of drafted segments: of doors at their ends, and between walls and columns beside them."""

import math
from dataclasses import replace

import pytest

from assess.bim.building_model import BuildingModel, Space, Storey
from assess.bim.draft_floor import build_plan, link_door
from assess.bim.draft_routes import draft_routes, measure_gap, set_widths
from tests.bim.office_models import door, name_all, rectangle

STOREY = Storey("0", "Level 0", 0.0, 0.0)
HALL = Space("h", "0", "Hall", "", rectangle(0, 0, 10, 6), 0.0, 3.0)
EXIT = replace(door("out", 10.05, 3.0, 0.0, overall=1.3), width=1.3)
WALLS = (
    rectangle(10, 0, 10.1, 2.35), rectangle(10, 3.65, 10.1, 6), rectangle(-0.1, 0, 0, 6), rectangle(0, -0.1, 10, 0),
    rectangle(0, 6, 10, 6.1),
)  # fmt: skip


def column(x: float, y: float, half: float = 0.2):
    return rectangle(x - half, y - half, x + half, y + half)


def hall(*columns, **more: object) -> BuildingModel:
    values = {"doors": (EXIT,), "walls": {"0": (*WALLS, *columns)}} | more
    return BuildingModel(source="a.ifc", schema="IFC4", storeys=(STOREY,), spaces=(HALL,), **values)


def measure(model: BuildingModel, *ends: tuple[float, float]) -> float | None:
    at = (model.doors[0].x, model.doors[0].y)
    links = [link_door(model.doors[0], ("h", ""))] if at in ends else []
    return measure_gap(build_plan(model, STOREY), "h", ends, links)


@pytest.mark.parametrize(
    ("stated", "drawn", "clear"),
    [(1.8, 0.9, 0.8), (0.9, 1.8, 0.8), (0.0, 1.2, 1.1), (1.2, 0.0, 1.1), (0.9, 0.898, 0.8), (0.0, 0.0, 0.0)],
)
def test_of_the_stated_width_of_a_door_and_its_opening_the_smaller_counts(stated, drawn, clear):
    link = link_door(replace(EXIT, overall=stated, width=drawn), ("h", ""))
    assert link.clear == pytest.approx(clear)


def test_the_door_bounds_its_segment():
    for given, clear, words in (
        (EXIT, 1.2, "the door's 1.30 m"),
        (replace(EXIT, width=0.9, overall=1.8), 0.8, "the door's 0.90 m in the model less 0.1 m"),
    ):
        (row,) = draft_routes(hall(doors=(given,)), name_all(hall())).routes
        assert row["clear_width"] == pytest.approx(clear)
        assert row["notes"].startswith(f"Clear width: {words}")
    assert row["required_width"] == 0.8
    assert measure(hall(), (4.0, 3.0), (10.05, 3.0)) == pytest.approx(1.3)


def test_two_columns_before_an_exit_bound_the_segment_to_it():
    """The exit is 1.3 m wide, the columns stand 0.8 m apart."""
    for x in (6.0, 9.0, 9.7):
        assert measure(hall(column(x, 2.4), column(x, 3.6)), (4.0, 3.0), (10.05, 3.0)) == pytest.approx(0.8)
    model = hall(column(9.0, 2.4), column(9.0, 3.6))  # people walk between them: they begin in the widest part
    last = next(row for row in draft_routes(model, name_all(model)).routes if row["end"] == "Door out")
    assert last["clear_width"] == pytest.approx(0.8, abs=0.011)
    assert "Clear width: between the walls of the model." in last["notes"]


@pytest.mark.parametrize("turn", [-60.0, -40.0, 0.0, 40.0, 60.0])
def test_a_door_that_is_reached_at_an_angle_is_as_wide_as_it_is(turn):
    ends = (10.05 - 4 * math.cos(math.radians(turn)), 3.0 - 2.5 * math.sin(math.radians(turn))), (10.05, 3.0)
    whole = hall(walls={"0": (rectangle(10, 0, 10.1, 6),)})  # a wall that is not cut at the door does not close it
    for found in (measure(hall(), *ends), measure(whole, *ends)):
        assert found is None or found >= 1.2


@pytest.mark.parametrize("turn", [0.0, 25.0, -25.0])
def test_columns_that_are_passed_at_an_angle_are_as_far_apart(turn):
    x, y = 3 * math.cos(math.radians(turn)), 3 * math.sin(math.radians(turn))
    model = hall(column(5.0, 2.4), column(5.0, 3.6))
    assert measure(model, (5.0 - x, 3.0 - y), (5.0 + x, 3.0 + y)) == pytest.approx(0.8)


def test_a_segment_near_one_wall_is_as_wide_as_to_the_other():
    """A room of 0.85 m is narrow wherever one walks in it; a hall of 6 m is not."""
    slim = replace(HALL, area=rectangle(0, 0, 10, 0.85))
    plan = build_plan(replace(hall(), spaces=(slim,), walls={}), STOREY)
    assert measure_gap(plan, "h", ((1.0, 0.3), (8.0, 0.3)), ()) == pytest.approx(0.85)
    assert measure(hall(), (1.0, 0.3), (8.0, 0.3)) is None


def test_a_gap_counts_where_it_is_narrow_or_something_else_is_known():
    leaf = link_door(EXIT, ("h", ""))
    assert set_widths([], None, 1.4) == {}
    assert set_widths([], None, None) == {}
    assert set_widths([], None, 0.7)["required_width"] == 0.7
    assert set_widths([leaf], None, 1.0)["clear_width"] == 1.0
    assert set_widths([leaf], None, 1.5)["clear_width"] == pytest.approx(1.2)
    assert set_widths([leaf], 1.1, 1.5)["clear_width"] == 1.1
    assert set_widths([], 1.8, 1.0)["clear_width"] == 1.0
