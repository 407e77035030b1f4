"""Values of the ground motion that are unlikely: warned of at their cell, and used as they stand."""

from pathlib import Path
from typing import Any

import pytest

import assess
from assess.settings import Settings
from assess.units import VELOCITY
from tests.workbook.books import ITEMS, Sheet, write

FLOORS: Sheet = [["Floor", "Elevation [m]"], ["1", 0], ["2", 8]]
FURNITURE: Sheet = [*ITEMS[:1], ["A1", "2", 30, 180]]
PAIR = "Check Ground PGV, Ground PGA and their units."


@pytest.mark.parametrize(
    ("ground", "warning"),
    [
        ([["Ground PGV [cm/s]", 30]],
         "B1: Ground PGV is filled in without Ground PGA, which is drawn: 0.286 g in the median. Fill in Ground PGA."),
        ([["Ground PGA [g]", 0.2], ["Ground PGV [cm/s]", 1.9]],
         f"B2: Ground PGV over the ground's PGA is 9.5 cm/s per g, outside 10 to 600. {PAIR}"),
        ([["Ground PGA [g]", 0.2], ["Ground PGV [cm/s]", 2.1]], None),
        ([["SDS [g]", 0.5], ["Ground PGV [cm/s]", 119]], None),
        ([["SDS [g]", 0.5], ["Ground PGV [cm/s]", 122]],
         f"B2: Ground PGV over the ground's PGA is 610 cm/s per g, outside 10 to 600. {PAIR}"),
        ([["Shaking", "MMI VIII, severe"], ["Ground PGV [cm/s]", 280]],
         f"B2: Ground PGV over the ground's PGA is 698 cm/s per g, outside 10 to 600. {PAIR}"),
    ],
)  # fmt: skip
def test_an_unlikely_ground_motion_is_warned_of_and_used(
    tmp_path: Path, ground: list[list[Any]], warning: str | None
) -> None:
    results = assess.run(write(tmp_path, FURNITURE, FLOORS, Building=ground), Settings(verify="none"))
    found = {str(one) for one in results.problem_rows if one.sheet == "Building" and one.severity == "warning"}
    assert {one for one in found if "assumed" not in one} == ({f"Building!{warning}"} if warning else set())
    assert results.building.ground_pgv == pytest.approx(ground[-1][1] * VELOCITY["cm/s"])
    at_grade = next(one for one in results.motions if one.floor == "1")
    assert at_grade.pfv_cm_s == pytest.approx(ground[-1][1]), "it is used as it stands"
