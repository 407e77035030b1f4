"""Draw k is one earthquake for the whole building: pieces on floors of different sources fall together."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from assess.methods import simulation
from assess.pipeline.adopt import build_falls
from assess.pipeline.run import build_results, compute
from assess.settings import Settings
from tests.pipeline.rows import read_sheets
from tests.shaking import write_records

RUNS = 100
SETTINGS = Settings(verify="all", runs=RUNS, seed=2, scale=1.2)
LANE = {"clear_width": 1.5, "required_width": 0.9}
PLACES = [
    {"place": "Room", "floor": "1", "kind": "room"},
    {"place": "West", "floor": "1", "kind": "exit"},
    {"place": "East", "floor": "2", "kind": "exit"},
]
ROUTES = [
    {"route": "A", "segment": "one", "floor": "1", "start": "Room", "end": "West", **LANE},
    {"route": "B", "segment": "two", "floor": "2", "start": "Room", "end": "East", **LANE},
]
CABINET = {"breadth": 40, "width": 80, "height": 180, "edge_distance": 0, "anchored": "no"}
ITEMS = [
    {"item": "west", "floor": "1", "axis": "X", "route": "A", **CABINET},
    {"item": "east", "floor": "2", "axis": "Y", "route": "B", **CABINET},
]
FLOORS = [{"floor": "1", "record_x": "slow.csv"}, {"floor": "2", "pfa_y": 0.2}]
"""One floor of which a record along X is known, and one of which a peak along Y is: each has motions of its own."""


def shaken(folder: Path, settings: Settings = SETTINGS, **building: Any):
    """Assess a room that two cabinets on two floors, shaken along different axes, can cut off together."""
    write_records(folder, "slow")
    given = {"period": 1.0, "piece_uncertainty": "no", **building}
    sheets = {"Building": [given], "Floors": FLOORS, "Items": ITEMS, "Places": PLACES, "Routes": ROUTES}
    return compute(read_sheets(folder, **sheets), settings)


def falls_of(assessment, settings: Settings | None = None):
    return build_falls(
        assessment.inventory, assessment.adoption, assessment.outcomes, assessment.governing,
        settings or assessment.settings, assessment.either_axis, assessment.held,
    )  # fmt: skip


@pytest.fixture(scope="module")
def strong(tmp_path_factory):
    return shaken(tmp_path_factory.mktemp("strong"), motion_uncertainty=0.4)


def test_a_common_scale_makes_falls_on_two_floors_go_together(strong, tmp_path):
    """The room loses both ways out far oftener than if each floor had an earthquake of its own."""
    (room,) = build_results(strong, figures=False).route_tables.rooms
    lost = room.loses_every_exit
    assert (lost.is_joint, lost.runs, lost.pieces, lost.unverified, lost.unconfirmed) == (True, RUNS, 2, 0, 0)
    assert lost.probability == lost.joint
    assert lost.joint > 1.5 * lost.independent > 0.02
    both = falls_of(strong).fell
    assert lost.joint == pytest.approx((both[0] & both[1]).mean())
    exact = shaken(tmp_path, motion_uncertainty=0)
    (alone,) = build_results(exact, figures=False).route_tables.rooms
    apart = alone.loses_every_exit
    assert abs(apart.joint - apart.independent) < lost.joint - lost.independent


def test_ideal_verdicts_are_those_of_the_motions_as_they_are(strong):
    ideal = falls_of(strong, replace(SETTINGS, ideal=True))
    rows = {int(case): joint.ideal[at] for joint in strong.outcomes[simulation().key].joints
            for at, case in enumerate(joint.cases)}  # fmt: skip
    for item, case in enumerate(strong.governing.tolist()):
        assert (ideal.fell[item] == rows[case]).all()
    assert any((ideal.fell[item] != falls_of(strong).fell[item]).any() for item in range(2))


def test_a_piece_whose_lower_class_is_not_adopted_says_why(tmp_path):
    """Without T1 and height buildings of every kind are drawn; the record's floor is confirmed."""
    assessment = shaken(tmp_path, replace(SETTINGS, scale=0.5), period=None)
    found = falls_of(assessment)
    assert dict(found.unconfirmed) == {1: ("unconfirmed_building",)}
    assert list(found.fell) == [0]
