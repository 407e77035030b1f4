"""Pieces whose sizes were measured by a scan: drawn wider than others, which stay as they were, and reported so."""

import numpy as np
import pytest

import assess
from assess.pipeline.piece_fragility import find_piece_fragilities
from assess.pipeline.run import compute
from assess.report.say.simulation import count_scanned
from assess.settings import Settings
from assess.units import GRAVITY
from tests.pipeline import rows

SETTINGS = Settings(verify="all", runs=200, seed=2)
FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 45, "pfa_y": 0.3, "pfv_y": 45}]
NAMES = ("one", "two", "three", "four")
"""Four pieces of about one size: no two are alike, so that each has a chance of its own."""
LEVELS = [one * GRAVITY for one in (0.2, 0.25, 0.3, 0.4, 0.6, 0.9)]


def pieces(*scanned, **more):
    return [
        {"item": name, "floor": "1", "breadth": 45 + at / 100, "width": 90, "height": 180, "axis": "X", **more}
        | ({"sizes_from": "scan"} if name in scanned else {})
        for at, name in enumerate(NAMES)
    ]


def read(items, **building):
    return rows.read(items, FLOORS, **{"period": 0.8} | building)


def run(items, settings=SETTINGS, **building):
    return assess.run(read(items, **building), settings, figures=False)


@pytest.fixture(scope="module")
def measured():
    return run(pieces())


@pytest.fixture(scope="module")
def mixed():
    return run(pieces("two"))


def simulated(results):
    return {one.item.item: one.governing.simulation for one in results}


def test_the_draws_of_others_do_not_change_and_a_model_counts_as_measured(measured, mixed):
    before, after = simulated(measured), simulated(mixed)
    assert [name for name in NAMES if before[name] != after[name]] == ["two"]
    assert before["two"].ideal == after["two"].ideal, "as given it is the same piece"
    assert simulated(run(pieces(sizes_from="model"))) == simulated(measured)


def test_certain_pieces_do_not_vary_by_a_scan_either():
    every = [run(items, piece_uncertainty="no") for items in (pieces(), pieces(*NAMES))]
    assert simulated(every[0]) == simulated(every[1])


def curves(items, runs, **levels):
    return find_piece_fragilities(compute(read(items), Settings(verify="none", runs=runs, seed=2)), **levels).curves


@pytest.mark.slow
def test_the_curve_of_a_scanned_piece_is_wider():
    """More fall where few do, fewer where most do: under motions that differ by their phases alone."""
    usual, wide = (curves(items, 400, levels=LEVELS) for items in (pieces(), pieces(*NAMES)))
    before, after = (np.sum([one.curve.fallen for one in every], axis=0) for every in (usual, wide))
    low, high = int(np.argmax(before > 0)), -1
    assert after[low] > before[low] > 0
    assert after[high] < before[high]
    assert wide[0].curve.dispersion > usual[0].curve.dispersion


def test_a_weak_floor_may_rock_it_and_pieces_are_counted_by_quantity():
    """0.65 of B/H 0.25 is 0.1625 g; 0.0458 g times 3.48 is 0.159 g, times 3.60, as sizes are less certain, 0.165 g."""
    floors = [{"floor": "1", "pfa_x": 0.0458, "pfa_y": 0.0458}]
    found = rows.assessed(pieces("two"), floors, motion_uncertainty=0.4)
    assert [one.adopted.can_rock for one in found] == [False, True, False, False]
    assert count_scanned(run(pieces("two", "three", quantity=5), Settings(verify="none"))) == 10
