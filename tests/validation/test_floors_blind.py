"""Recorded floors against medians that know nothing of them but the ground's peaks and the building's height or T1.

575 Market Street in the Loma Prieta earthquake (1989, magnitude 6.9) and Berkeley, station 1103 (magnitude 4.4); and
the three buildings of the paper's Table 2, whose PFA is not printed but follows from its printed OR, equation (9), with
B/H 0.28.
"""

from statistics import median

import numpy as np
import pytest

import assess
from assess.arrays import Single
from assess.intensity import RATIO
from assess.methods import Cases, all_methods
from assess.motion.assumed import UNKNOWN, Building, FloorTarget, Ground, estimate_period
from assess.motion.beam import Beams, open_floor
from assess.motion.drawn_ground import build_beam_grid, draw_ground
from assess.motion.floor_medians import find_medians
from assess.motion.formats import read_records
from assess.motion.noise import Phases
from assess.motion.record import treat
from assess.motion.target_fit import measure_peaks
from assess.progress import SILENT
from assess.settings import Settings
from assess.studies.study import read_facts
from assess.studies.table1 import read_stations
from assess.units import GRAVITY
from docs.motions import BLIND, RECORDS

NEAR = 1.8
"""Ratio within which the median of a building's floors has to lie."""


def read_peaks(name: str) -> tuple[float, float]:
    motion = treat(read_records(RECORDS[name][0])[0])
    return motion.pfa, motion.pfv


@pytest.mark.parametrize("building", ["575 Market Street", "Berkeley"])
@pytest.mark.parametrize("by", ["T1", "height"])
@pytest.mark.slow
def test_peaks_of_recorded_floors(building, by):
    """PFA/PGA, and PFV/PFA, of eight and of seven floors."""
    amplified, velocity = [], []
    for name, (ground, place) in BLIND.items():
        if name.startswith(building):
            (pfa, pfv), (pga, pgv), (_, period, height) = read_peaks(name), read_peaks(ground), RECORDS[name]
            known = period if by == "T1" else estimate_period(height)
            by_pga, by_pgv = find_medians(known, place, UNKNOWN, pgv / pga)
            amplified.append(pga * by_pga / pfa)
            velocity.append(pgv * by_pgv / (pga * by_pga) / (pfv / pfa))
    assert len(amplified) == (8 if building.startswith("575") else 7)
    for found in (amplified, velocity):
        assert 1 / NEAR < median(found) < NEAR


def invert_or(chance: float) -> float:
    """Return the PFA [g] at which equation (9) gives a chance to a piece of B/H 0.28."""
    formula = next(one for one in all_methods() if one.key == "proposed_or")
    pfa = np.linspace(0.01, 0.8, 800)
    found = formula.evaluate(Cases.of(breadth=0.28, height=1.0, pfa=pfa * GRAVITY), Settings()).value
    return float(np.interp(chance, found, pfa))


@pytest.mark.parametrize("number", ["003", "004", "005"])
def test_pfa_of_the_papers_buildings(number):
    station = next(one for one in read_stations() if one.number == number)
    rows = [row for row in read_facts("table2_methods") if row["building"] == number]
    base = median(station.pga.values()) / GRAVITY
    ratios = []
    for row in rows:
        if row["storey"] != "1":
            place = (int(row["storey"]) - 1) / station.storeys
            by_pga, _ = find_medians(estimate_period(station.height), place, UNKNOWN, RATIO)
            ratios.append(base * by_pga / invert_or(float(row["proposed_or"])))
    assert len(ratios) >= 5
    assert 1 / NEAR < median(ratios) < NEAR


def test_the_velocity_at_the_top_of_a_tower():
    """42nd floor of 575 Market Street, recorded 40 cm/s: with T1 6 s, and by height, from the ground's PGA and PGV."""
    pga, pgv = read_peaks("575 Market Street, ground, 315°")
    for period in (6.0, estimate_period(175.0)):
        _, by_pgv = find_medians(period, 0.976, UNKNOWN, pgv / pga)
        assert 40 / 1.6 < 100 * pgv * by_pgv < 40 * 1.6


def test_the_velocity_at_the_top_of_a_tower_is_among_those_drawn_where_nothing_is_known():
    """Of the draws of a floor of unknown height in an unknown building, by the ground's PGA and PGV."""
    pga, pgv = read_peaks("575 Market Street, ground, 315°")
    ground, building = Ground(pga=pga, pgv=pgv), Building()
    by_pga, by_pgv = find_medians(None, None, UNKNOWN, pgv / pga)
    grid = build_beam_grid(building.longest)

    def draw(group: int) -> Single:
        return draw_ground(ground, Phases(grid, 1, "X"), group, SILENT)

    target = FloorTarget(place=None, pfa=pga * by_pga, pfv=pgv * by_pgv, meets="medians")
    opened = open_floor(Beams(building, grid, 1, "tower", draw), target, 1, SILENT)
    found = 100 * measure_peaks(opened.realise(0, 200, 1, SILENT), grid.time_step)[:, 1]
    low, high = np.percentile(found, (5, 95))
    assert low < 40 < high


@pytest.mark.slow
def test_the_furniture_of_a_tower_blind():
    """575 Market Street from its ground's PGA and its height: recorded motions give 10 to 11 falls of 177 pieces."""
    inventory = assess.read_inventory("inventories/market-street.xlsx")
    floors = [{"floor": one.floor, "elevation": one.elevation} for one in inventory.floors]
    items = [
        {
            "item": one.item, "floor": one.floor, "breadth": 100 * one.breadth, "height": 100 * one.height,
            "width": 100 * (one.width or one.breadth), "axis": one.axis, "quantity": one.quantity,
            "anchored": one.anchored, "centre_of_gravity": 100 * one.centre_of_gravity,
        }
        for one in inventory.items
    ]  # fmt: skip
    building = {"building": "Tower", "height": 175, "ground_pga": inventory.building.ground_pga / GRAVITY}
    blind = assess.read_inventory({"Building": [building], "Floors": floors, "Items": items})
    results = assess.run(blind, assess.Settings(verify="all"), figures=False)
    falls = sum(one.adopted.probability * one.item.quantity for one in results if not one.is_anchored)
    assert 5 < falls < 20
