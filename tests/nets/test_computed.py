"""What is computed of 25 workbooks is what it was."""

from dataclasses import replace

import numpy as np
import pytest

from assess.results import known
from tests.nets.make import make_workbooks
from tests.nets.nets import BY_FORMULA, NAMES, assess_workbook, read_stored

CHANCE = 0.02
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
    """Formulas are equal, chances that are simulated within 0.02, in 50 years 0.04; texts are not compared."""
    now, then = assess_workbook(name, made), read_stored(name, tmp_path)
    assert [replace(one.item, annual=None) for one in now] == [replace(one.item, annual=None) for one in then]
    in_50_years = [[one.item.annual and one.item.annual.chance_in_50_years for one in each] for each in (now, then)]
    assert [one is None for one in in_50_years[0]] == [one is None for one in in_50_years[1]]
    assert known(np.array(in_50_years[0], float)) == pytest.approx(known(np.array(in_50_years[1], float)), abs=2 * CHANCE)
    for key, outcome in then.cases_table.outcomes.items():
        tolerance = CHANCE if key == now.simulation.key else 1e-9
        np.testing.assert_allclose(now.cases_table.outcomes[key].value, outcome.value, rtol=1e-9, atol=tolerance)
    for one in ("probability", "low", "high"):
        np.testing.assert_allclose(now.cases_table.adopted[one], then.cases_table.adopted[one], atol=CHANCE)
    assert name not in BY_FORMULA or not now.has_simulated
    routes = [[one.blocked and one.blocked.probability for one in each.route_tables.routes] for each in (now, then)]
    assert known(np.array(routes[0], dtype=float)) == pytest.approx(known(np.array(routes[1], dtype=float)), abs=CHANCE)
