"""Floors and buildings that share their motions: the same results as each alone."""

import numpy as np
import pytest

from assess.methods import simulation
from assess.motion import beam, shared_motions
from assess.motion.beam import swing_modes
from assess.motion.generate import build_generator
from assess.motion.kept import Kept
from assess.pipeline.run import compute
from assess.settings import Settings
from tests.motion.motions import MARKET
from tests.pipeline import rows

CHANNEL = "891018_1.cra-1.0210a.smc"
RUNS = 20


@pytest.fixture
def built(monkeypatch):
    """Start from nothing that is kept; return the list that grows with every generator."""
    monkeypatch.setattr(shared_motions, "KEPT", Kept(shared_motions.KEPT.most))
    found = []

    def count(*given, **named):
        found.append(named["axis"])
        return build_generator(*given, **named)

    monkeypatch.setattr(shared_motions, "build_generator", count)
    return found


@pytest.fixture
def swung(monkeypatch):
    """Start from nothing that is kept; return the list that grows with every group of beams that swing."""
    monkeypatch.setattr(beam, "KEPT", Kept(beam.KEPT.most))
    found = []

    def count(*given):
        found.append(given)
        return swing_modes(*given)

    monkeypatch.setattr(beam, "swing_modes", count)
    return found


def read(*floors, **building):
    items = [
        {"item": f"{row['floor']} {height}", "floor": row["floor"], "breadth": 35, "height": height}
        for row in floors
        for height in (120, 200)
    ]
    return rows.read(items, list(floors), MARKET, **{"period": 0.5, **building})


def chances(inventory, **settings):
    found = compute(inventory, Settings(runs=RUNS, verify="all", **settings))
    return found.outcomes[simulation().key].value


@pytest.mark.slow
def test_floors_without_a_record_share_their_beams_and_each_is_as_alone(swung):
    lower, upper = ({"floor": name, "elevation": z, "pfa_x": pfa} for name, z, pfa in (("1", 3, 0.3), ("2", 9, 0.55)))
    building = {"height": 9}
    alone, made = [], []
    for floor in (lower, upper):
        swung.clear()
        beam.KEPT.forget()
        alone.append(chances(read(floor, **building)))
        made.append(len(swung))
    swung.clear()
    beam.KEPT.forget()
    both = chances(read(lower, upper, **building))
    assert len(swung) == made[0] == made[1] > 0
    np.testing.assert_array_equal(both, np.concatenate(alone))
    assert 0 < both.mean() < 1


@pytest.mark.slow
def test_another_building_before_changes_nothing_and_t1_is_not_rounded_into_one(swung):
    first = chances(read({"floor": "1", "pfa_x": 0.4}))
    beam.KEPT.forget()
    chances(read({"floor": "9", "pfa_x": 0.8}, period=1.0))
    np.testing.assert_array_equal(chances(read({"floor": "1", "pfa_x": 0.4})), first)
    swung.clear()
    beam.KEPT.forget()
    chances(read({"floor": "1", "pfa_x": 0.4}))
    once = len(swung)
    chances(read({"floor": "1", "pfa_x": 0.8}))
    assert len(swung) == once
    chances(read({"floor": "1", "pfa_x": 0.4}, period=0.5001))
    assert len(swung) == 2 * once


@pytest.mark.slow
def test_a_scaled_record_has_the_motions_of_the_record(built):
    inventory = read({"floor": "1", "record_x": CHANNEL})
    for scale in (1.0, 1.3, 0.7):
        compute(inventory, Settings(runs=RUNS, verify="all", scale=scale))
    assert sorted(built) == ["X", "Y"]
    scaled = compute(inventory, Settings(runs=RUNS, verify="all", scale=1.3)).cases.ensembles[0].open(1)
    plain = compute(inventory, Settings(runs=RUNS, verify="all")).cases.ensembles[0].open(1)
    np.testing.assert_array_equal(scaled.realise(0, 3)[0][0], np.float32(1.3) * plain.realise(0, 3)[0][0])
