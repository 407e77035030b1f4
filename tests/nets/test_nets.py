"""Every output of 25 workbooks says what it said, and what is computed of them is what it was."""

import numpy as np
import pytest

from assess.results import known
from tests.nets.lines import PDFS
from tests.nets.make import make_workbooks
from tests.nets.nets import (
    BY_FORMULA,
    NAMES,
    PRINTED,
    SHOWN,
    STORED,
    assess_workbook,
    compare,
    find_shown,
    read_stored,
    show,
)

ANEW = "where that is meant, write them anew: python -m tests.nets.nets"
CHANCE = 0.02
pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    make_workbooks(folder)
    return folder


def test_there_are_25_workbooks_and_nothing_is_kept_of_others():
    assert len(set(NAMES)) == len(NAMES) == 25
    assert {path.stem for path in STORED.iterdir()} == set(NAMES)
    assert {path.name.split(".")[0] for path in SHOWN.iterdir()} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_outputs_say_what_they_said(name, tmp_path):
    found = show(name, read_stored(name, tmp_path), tmp_path / "out")
    differences = {
        kind: difference for kind, lines in found.items() if (difference := list(compare(name, kind, lines)))
    }
    assert differences == {}, ANEW
    kept = {path.name for path in SHOWN.glob(f"{name}.*")} - {find_shown(name, kind).name for kind in PDFS}
    assert {find_shown(name, kind).name for kind in found} == kept


@pytest.mark.slow
@pytest.mark.parametrize("name", PRINTED)
def test_pdfs_say_what_they_said(name, tmp_path):
    found = show(name, read_stored(name, tmp_path), tmp_path / "out", PDFS)
    assert {kind: difference for kind in PDFS if (difference := list(compare(name, kind, found[kind])))} == {}, ANEW


@pytest.mark.parametrize("name", NAMES)
def test_what_is_computed_is_what_it_was(name, made, tmp_path):
    """Formulas are equal, chances that are simulated within 0.02; texts are not compared."""
    now, then = assess_workbook(name, made), read_stored(name, tmp_path)
    assert [one.item for one in now] == [one.item for one in then]
    for key, outcome in then.cases_table.outcomes.items():
        tolerance = CHANCE if key == now.simulation.key else 1e-9
        np.testing.assert_allclose(now.cases_table.outcomes[key].value, outcome.value, rtol=1e-9, atol=tolerance)
    for one in ("probability", "low", "high"):
        np.testing.assert_allclose(now.cases_table.adopted[one], then.cases_table.adopted[one], atol=CHANCE)
    assert name not in BY_FORMULA or not now.has_simulated
    routes = [[one.blocked and one.blocked.probability for one in each.route_tables.routes] for each in (now, then)]
    assert known(np.array(routes[0], dtype=float)) == pytest.approx(known(np.array(routes[1], dtype=float)), abs=CHANCE)


def test_a_number_a_sentence_and_a_column_that_change_are_named(tmp_path):
    """The nets hold: what is changed on purpose turns red, and the difference shows the line before and after."""
    name = "one-piece"
    results = read_stored(name, tmp_path)
    text = "No free-standing piece has"
    shown = show(name, results, tmp_path / "out")
    for kind, before, after in (
        ("html", text, "Not one piece has"),
        ("json", "breadth_cm 30", "breadth_cm 31"),
        ("csv", "item,", ""),
    ):
        changed = [line.replace(before, after) for line in shown[kind]]
        difference = list(compare(name, kind, changed))
        assert any(line.startswith("-") and before in line for line in difference), kind
        assert any(line.startswith("+") and before not in line for line in difference), kind
