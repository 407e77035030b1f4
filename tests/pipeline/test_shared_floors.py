"""Floors and buildings that share their motions: the same results as each alone."""

import shutil

import numpy as np
import pytest

import assess
from assess.methods import simulation
from assess.motion import shared_motions
from assess.motion.generate import build_generator
from assess.pipeline.run import compute
from assess.settings import Settings
from tests.motion.motions import MARKET
from tests.workbooks import write

CHANNEL = "891018_1.cra-1.0210a.smc"
RUNS = 20


@pytest.fixture
def built(monkeypatch):
    """Start from nothing that is kept; return the list that grows with every generator."""
    monkeypatch.setattr(shared_motions, "_STORE", shared_motions._Store())
    found = []

    def count(*given, **named):
        found.append(named["axis"])
        return build_generator(*given, **named)

    monkeypatch.setattr(shared_motions, "build_generator", count)
    return found


def read(folder, *floors, **building):
    items = [
        {"item": f"{row['floor']} {height}", "floor": row["floor"], "breadth": 35, "height": height}
        for row in floors
        for height in (120, 200)
    ]
    return assess.read_inventory(write(folder / "w.xlsx", items, list(floors), **{"period": 0.5, **building}))


def chances(inventory, **settings):
    found = compute(inventory, Settings(runs=RUNS, verify="all", **settings))
    return found.outcomes[simulation().key].value


def test_floors_of_peaks_alone_share_and_each_is_as_alone(built, tmp_path):
    lower, upper = ({"floor": name, "pfa_x": pfa} for name, pfa in (("1", 0.3), ("2", 0.55)))
    alone = []
    for floor in (lower, upper):
        shared_motions.forget()
        alone.append(chances(read(tmp_path, floor)))
    built.clear()
    shared_motions.forget()
    both = chances(read(tmp_path, lower, upper))
    assert sorted(built) == ["X", "Y"]
    np.testing.assert_array_equal(both, np.concatenate(alone))
    assert 0 < both.mean() < 1


def test_another_building_before_changes_nothing(built, tmp_path):
    first = chances(read(tmp_path, {"floor": "1", "pfa_x": 0.4}))
    shared_motions.forget()
    chances(read(tmp_path, {"floor": "9", "pfa_x": 0.8}))
    np.testing.assert_array_equal(chances(read(tmp_path, {"floor": "1", "pfa_x": 0.4})), first)


def test_t1_and_height_are_not_rounded_into_one(built, tmp_path):
    chances(read(tmp_path, {"floor": "1", "pfa_x": 0.4}))
    chances(read(tmp_path, {"floor": "1", "pfa_x": 0.4}, period=0.5001))
    assert len(built) == 4


def test_pfv_shares_where_it_is_in_proportion(built, tmp_path):
    floors = [{"floor": name, "pfa_x": 0.1 * at, "pfv_x": 7 * at} for at, name in enumerate("123", 1)]
    chances(read(tmp_path, *floors))
    assert sorted(built) == ["X", "Y"]
    chances(read(tmp_path, {"floor": "1", "pfa_x": 0.1, "pfv_x": 8}))
    assert len(built) == 4


def test_a_scaled_record_has_the_motions_of_the_record(built, tmp_path):
    shutil.copy(MARKET / CHANNEL, tmp_path)
    inventory = read(tmp_path, {"floor": "1", "record_x": CHANNEL})
    for scale in (1.0, 1.3, 0.7):
        compute(inventory, Settings(runs=RUNS, verify="all", scale=scale))
    assert sorted(built) == ["X", "Y"]
    scaled = compute(inventory, Settings(runs=RUNS, verify="all", scale=1.3)).cases.ensembles[0].open(1)
    plain = compute(inventory, Settings(runs=RUNS, verify="all")).cases.ensembles[0].open(1)
    np.testing.assert_array_equal(scaled.realise(0, 3)[0][0], np.float32(1.3) * plain.realise(0, 3)[0][0])
