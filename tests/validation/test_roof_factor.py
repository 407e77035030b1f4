"""The cap of an estimated PFV by Ground PGV against recorded floors and shear beams: the numbers of docs/limits.md."""

import numpy as np
import pytest

from assess.methods import Cases
from assess.methods.kaneko_hayashi import METHOD
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.motion.scenario import ROOF_FACTOR, cap_pfv, estimate_pfv
from assess.risk import classify_all
from assess.settings import Settings
from assess.studies.buildings import all_buildings
from assess.studies.calibration.floor_motions import GROUND, list_beams
from assess.workbook.schema import BUILDING


def _ground(building):
    """The largest PGV along each axis [m/s]."""
    found: dict[str, float] = {}
    for one in building.channels:
        if one.level in GROUND:
            found[one.axis] = max(found.get(one.axis, 0.0), one.read().pfv)
    return found


def _recorded():
    """The PFV of each channel above the ground over PGV along its axis, or along the other where that is not known."""
    for building in all_buildings():
        ground = _ground(building)
        for one in building.channels if ground else ():
            if one.level not in GROUND:
                yield building.name, one, one.read().pfv / ground.get(one.axis, max(ground.values()))


def test_the_factor_is_the_ground_and_the_first_mode_of_the_roof():
    assert ROOF_FACTOR == 3.93
    assert pytest.approx(1 + 2.30 * 4 / np.pi, abs=0.005) == ROOF_FACTOR
    assert f"{ROOF_FACTOR:.2f} times" in BUILDING.column("ground_pgv").help


def test_no_recorded_floor_exceeds_it():
    ratios = [(name, ratio) for name, _channel, ratio in _recorded()]
    assert [sum(name == one for one, _ratio in ratios) for name in ("575 Market Street", "Great Western Savings")] == [
        8,
        7,
    ]
    assert (min(ratios, key=lambda one: one[1])[1], max(ratios, key=lambda one: one[1])[1]) == pytest.approx(
        (0.91, 2.14), abs=0.005
    )


def test_the_42nd_floor_of_575_market_street():
    (floor,) = [one for _name, one, _ratio in _recorded() if one.name == "a"]
    (building,) = [one for one in all_buildings() if one.name == floor.building]
    motion = floor.read()
    found = (estimate_pfv(motion.pfa, 6.0), cap_pfv(max(_ground(building).values())), motion.pfv)
    assert [100 * one for one in found] == pytest.approx([208.3, 90.5, 40.4], abs=0.1)


def test_shear_beams_on_the_ground_motions_of_the_package():
    ratios: dict[float, list[float]] = {0.5: [], 1.0: []}
    for one in list_beams():
        ratios[one.beam.place].append(one.read().pfv / treat(read_records(one.file)[0]).pfv)
    middle, roof = (np.array(one) for one in ratios.values())
    assert (middle.size, roof.size) == (28, 28)
    assert ((middle > ROOF_FACTOR).sum(), (roof > ROOF_FACTOR).sum()) == (0, 2)
    assert roof.max() == pytest.approx(4.47, abs=0.01)


def test_what_the_cap_does_to_kaneko_hayashi():
    """The formula jumps between PFA and PFV: a lower PFV may give a higher class."""
    grids = (
        np.linspace(0.2, 0.9, 15), np.linspace(0.8, 2.2, 8), np.linspace(0.5, 9, 18), [0.5, 1, 2, 4, 6],
        [0.05, 0.1, 0.2, 0.4],
    )  # fmt: skip
    breadth, height, pfa, period, pgv = (one.ravel() for one in np.meshgrid(*grids, indexing="ij"))
    estimate = np.array([estimate_pfv(*one) for one in zip(pfa, period, strict=True)])
    at = (breadth < height) & (cap_pfv(pgv) < estimate)
    larger, capped = (
        classify_all(
            METHOD.evaluate(Cases.of(breadth=breadth[at], height=height[at], pfa=pfa[at], pfv=pfv), Settings()).value
        )
        for pfv in (estimate[at], cap_pfv(pgv[at]))
    )
    assert at.sum() == 30537
    assert ((capped > larger).mean(), (capped < larger).mean()) == pytest.approx((0.02, 0.44), abs=0.005)
