"""What is computed of 25 workbooks is what it was."""

from dataclasses import replace

import numpy as np
import pytest

from tests.nets.make import make_workbooks
from tests.nets.nets import BY_FORMULA, NAMES, assess_workbook, read_stored

CHANCE, MEAN = 0.08, 0.015
"""How far a chance of 100 draws, and the mean of all, may be off on another processor: last digits of motions are."""
LONGEST = {"market-street": pytest.mark.slow, "everything": pytest.mark.slow, "everything-it": pytest.mark.long}
"""Half of the time."""
pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    make_workbooks(folder)
    return folder


@pytest.mark.parametrize("name", [pytest.param(name, marks=LONGEST.get(name, ())) for name in NAMES])
def test_what_is_computed_is_what_it_was(name, made, tmp_path):
    """Formulas are equal, chances that are simulated nearly so; texts are not compared."""
    now, then = assess_workbook(name, made), read_stored(name, tmp_path)
    alike = [[replace(one.item, annual=None, governing=0) for one in results] for results in (now, then)]
    assert alike[0] == alike[1]
    chances = then.cases_table.adopted["probability"]
    for one, other in zip(now, then, strict=True):  # of two motions of a piece of nearly one chance either may govern
        assert abs(chances[one.item.governing] - chances[other.item.governing]) < CHANCE
    for key, outcome in then.cases_table.outcomes.items():
        if key != now.simulation.key:
            np.testing.assert_allclose(now.cases_table.outcomes[key].value, outcome.value, rtol=1e-9)
    assert name not in BY_FORMULA or not now.has_simulated
    for one, other in zip(list_chances(now), list_chances(then), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=CHANCE)
        assert abs(np.nanmean([0, *(one - other)])) < MEAN


def list_chances(results):
    """Yield what rests on draws: chances of pieces with their intervals, in 50 years, and of routes."""
    yield results.cases_table.outcomes[results.simulation.key].value
    yield from (results.cases_table.adopted[one] for one in ("probability", "low", "high"))
    yield np.array([one.item.annual and one.item.annual.chance_in_50_years for one in results], dtype=float)
    yield np.array([one.blocked and one.blocked.probability for one in results.route_tables.routes], dtype=float)
