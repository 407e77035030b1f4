"""What the reports say of runs that are simulated, partly simulated, or not."""

from dataclasses import replace

import numpy as np
import pytest

import assess
from assess.report import words
from assess.report.content import Content
from assess.report.say.simulation import describe_trials, list_misfits
from assess.settings import Settings
from tests.shaking import write_records
from tests.workbooks import write

SCRIPT = "<b>$x$</b>"
ITEMS = [{"item": SCRIPT, "floor": "1", "breadth": 30, "width": 80, "height": 200, "axis": "X"}]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """One floor with a record, with generated motions."""
    folder = tmp_path_factory.mktemp("recorded")
    write_records(folder, "slow")
    path = write(folder / "w.xlsx", ITEMS, [{"floor": "1", "record_x": "slow.csv"}])
    return assess.run(assess.read_inventory(path), Settings(verify="all", runs=20), jobs=1)


def test_the_stopping_rule_names_the_undecided_and_a_large_misfit_is_reported(recorded):
    some, table = recorded, recorded.cases_table
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

    def worsen(motion):
        if motion.ensemble is None:
            return motion
        fit = replace(motion.ensemble.fit, mean_deviation=0.15, worst_deviation=-0.4, worst_period=2.0)
        return replace(motion, ensemble=replace(motion.ensemble, fit=fit))

    assert list_misfits(recorded) == []
    (misfit,) = list_misfits(replace(recorded, motions=tuple(map(worsen, recorded.motions))))
    assert misfit == (
        "Floor 1 X: PFA and the spectrum cannot both be matched. PFA takes precedence; the mean spectrum deviates "
        "by 15.0 % on average, and by 40.0 % at 2.00 s, where it is worst."
    )


def test_a_range_on_assumed_motion_holds_the_chance():
    """The slower, the middle and the faster third of few draws may come in any order."""
    floors = [{"floor": "0", "elevation": 0}, {"floor": "1", "elevation": 4}]
    items = [
        {"item": f"{floor}{b}", "floor": floor, "breadth": b, "height": 180} for floor in "01" for b in (28, 33, 40)
    ]
    building = {"building": "House", "storeys": 2, "ground_pga": 0.3}
    inventory = assess.read_inventory({"Building": [building], "Floors": floors, "Items": items})
    results = assess.run(inventory, verify="all", runs=12, figures=False)
    ranges = [(one.adopted.probability, words.find_thirds(one)) for one in results if one.adopted.is_simulated]
    assert ranges
    assert all(found is not None and found[0] <= chance <= found[1] for chance, found in ranges)
