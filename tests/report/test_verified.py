"""What the reports say of runs that are simulated, partly simulated, or not."""

from dataclasses import replace

import numpy as np
import pytest

import assess
from assess.motion.record import Motion
from assess.motion.suite import Suite
from assess.pipeline import ensembles
from assess.report.content import Content
from assess.report.say.simulation import describe_trials, list_misfits
from assess.settings import Settings
from assess.units import GRAVITY
from tests.shaking import write_records
from tests.workbooks import write

SCRIPT = "<b>$x$</b>"
FLOORS = [{"floor": "1", "pfa_x": 0.2, "pfv_x": 40}, {"floor": "2", "pfa_x": 0.15, "pfv_x": 30}]
ITEMS = [
    {"item": SCRIPT, "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 1, "axis": "X"},
    {"item": "twin", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 3, "axis": "X",
     "quantity": 1},
    {"item": "fixed", "floor": "1", "breadth": 30, "width": 80, "height": 200, "anchored": "yes"},
    {"item": "stout", "floor": "2", "breadth": 60, "width": 60, "height": 200, "axis": "X", "quantity": 4},
    {"item": "cube", "floor": "2", "breadth": 90, "width": 90, "height": 60},
]  # fmt: skip
CERTAIN = {"motion_uncertainty": 0, "piece_uncertainty": "no"}
"""Of the building: nothing is drawn, so that it is known which of the pulses overturn a piece."""


def _pulses(*peaks):
    """Return a suite of five waves of 1 s each [g]."""
    times = np.arange(0, 8, 0.01)
    wave = np.where(times < 5, np.sin(2 * np.pi * times), 0.0)
    motions = []
    for at, peak in enumerate(peaks):
        acceleration = peak * GRAVITY * wave
        velocity = np.cumsum(acceleration) * 0.01
        motions.append((f"m{at}.csv", Motion(acceleration, velocity, np.cumsum(velocity) * 0.01, 0.01)))
    return Suite("ours", tuple(motions), {})


def _assess(folder, peaks, items=ITEMS, floors=FLOORS, building=(), **settings):
    inventory = assess.read_inventory(write(folder / "w.xlsx", items, floors, **CERTAIN | dict(building)))
    with pytest.MonkeyPatch.context() as patch:  # weak motions may lower classes here, to show how that looks
        patch.setattr(ensembles, "WEAK_PFA", 0.0)
        patch.setattr(ensembles, "WEAK_PFV", 0.0)
        return assess.run(inventory, Settings(**settings), suite=_pulses(*peaks), jobs=1)


@pytest.fixture(scope="module")
def some(tmp_path_factory):
    """All simulated; of 40 motions 10 overturn the slender pieces."""
    return _assess(tmp_path_factory.mktemp("some"), [1.0] * 10 + [0.1] * 30, ITEMS[:4], verify="all")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """One floor with a record, with generated motions."""
    folder = tmp_path_factory.mktemp("recorded")
    write_records(folder, "slow")
    path = write(folder / "w.xlsx", ITEMS[:1], [{"floor": "1", "record_x": "slow.csv"}])
    return assess.run(assess.read_inventory(path), Settings(verify="all", runs=20), jobs=1)


class TestChanges:
    def test_the_stopping_rule_names_the_undecided(self, some):
        table = some.cases_table
        found = table.outcomes[some.simulation.key]
        undecided = {**found.flags, "undecided": np.arange(len(table)) == 0}
        outcomes = {**table.outcomes, some.simulation.key: replace(found, flags=undecided)}
        auto = replace(
            some, settings=Settings(runs="auto"), cases_table=replace(table, outcomes=outcomes),
            provenance=replace(some.provenance, suite=None, interval_z=2.64),
        )  # fmt: skip
        content = Content(auto)
        text = " ".join(describe_trials(content.verified))
        assert "checked after 125, 250, 500, 1,000, 2,500 and 5,000 motions, with an interval (z = 2.64)" in text
        assert f"Undecided after 5,000: {SCRIPT}." in text
        assert "1 row still undecided" in content.verified.sentence
        decided = Content(replace(auto, cases_table=table))
        assert "No piece is left undecided." in " ".join(describe_trials(decided.verified))
        assert "125 to 5,000 motions each" in decided.verified.sentence


class TestMotions:
    def test_a_large_misfit_is_reported(self, recorded):
        def worsen(motion):
            if motion.ensemble is None:
                return motion
            fit = replace(motion.ensemble.fit, mean_deviation=0.15, worst_deviation=-0.4, worst_period_s=2.0)
            return replace(motion, ensemble=replace(motion.ensemble, fit=fit))

        assert list_misfits(recorded) == []
        (misfit,) = list_misfits(replace(recorded, motions=tuple(map(worsen, recorded.motions))))
        assert misfit == (
            "Floor 1 X: PFA and the spectrum cannot both be matched. PFA takes precedence; the mean spectrum deviates "
            "by 15.0 % on average, and by 40.0 % at 2.00 s, where it is worst."
        )
