"""Pieces that are nearly square on plan and may topple along both axes."""

import numpy as np
import pytest

import assess
from assess.pipeline.adopt import is_square, unite_axes
from assess.pipeline.run import compute
from assess.risk import wilson_interval
from assess.settings import Settings
from tests.pipeline import rows as rows_in_code

SIZES = {"breadth": 30, "height": 180}
FLOORS = [{"floor": "1", "pfa_x": 0.21, "pfa_y": 0.2}]
SETTINGS = Settings(runs=80)


def read(*items, **building):
    rows = [{"floor": "1", **SIZES, **item} for item in items]
    return rows_in_code.read(rows, FLOORS, **({"period": 0.8} | building))


@pytest.fixture(scope="module")
def done():
    items = {"item": "square", "width": 35}, {"item": "long", "width": 40}, {"item": "along", "width": 35, "axis": "X"}
    return compute(read(*items, {"item": "unknown"}, motion_uncertainty=0.1), SETTINGS)


def cases_of(assessment, index):
    return np.flatnonzero(assessment.case_item == index).tolist()


def verdicts(assessment, case):
    joint = next(joint for joint in assessment.joints.values() if case in joint.cases)
    return joint.fell[joint.cases.tolist().index(case)]


def test_only_a_square_piece_of_unknown_axis_is_united(done):
    assert [is_square(item) for item in done.inventory.items] == [True, False, False, False]
    assert list(done.either_axis) == [0]
    assert done.adoption.either_axis.tolist() == [at in cases_of(done, 0) for at in range(len(done.case_item))]


def test_it_falls_in_a_draw_if_it_falls_along_either_axis(done):
    along_x, along_y = (verdicts(done, case) for case in cases_of(done, 0))
    np.testing.assert_array_equal(done.either_axis[0], along_x | along_y)
    share = (along_x | along_y).mean()
    assert share > max(along_x.mean(), along_y.mean()) > 0, "neither axis alone tells it"
    low, high = wilson_interval((along_x | along_y).sum(), 80)
    for case in cases_of(done, 0):
        assert done.adoption.probability[case] == share
        assert (done.adoption.low[case], done.adoption.high[case]) == (low, high)
    assert done.governing[0] == cases_of(done, 0)[0], "of equal chances the larger PFA governs"


def test_other_pieces_keep_what_they_and_those_alike_have(done):
    """All four are of one size: along an axis they have one chance, from the draws of each."""
    for index in (1, 3):
        for case in cases_of(done, index):
            alike = np.flatnonzero(done.cases.alike == done.cases.alike[case])
            assert len(alike) >= 3
            shares = [verdicts(done, one).mean() for one in alike]
            assert done.adoption.probability[case] == pytest.approx(np.mean(shares))


@pytest.mark.slow
def test_without_any_uncertainty_it_is_nearly_the_product():
    """Phases of the two axes are independent: 1 - (1 - P_X)(1 - P_Y), where nothing is drawn."""
    inventory = read({"item": "a", "width": 35}, motion_uncertainty=0, piece_uncertainty="no")
    found = compute(inventory, Settings(runs=400))
    p_x, p_y = (verdicts(found, case).mean() for case in cases_of(found, 0))
    expected = 1 - (1 - p_x) * (1 - p_y)
    assert 0.05 < p_x < 0.95
    assert found.adoption.probability[0] == pytest.approx(expected, abs=3 * np.sqrt(expected * (1 - expected) / 400))


def test_an_unconfirmed_axis_is_not_united(done):
    adoption = done.adoption
    unconfirmed = np.array([2 if at == 0 else one for at, one in enumerate(adoption.basis)], dtype=np.int8)
    object.__setattr__(adoption, "basis", unconfirmed)
    _, united = unite_axes(
        adoption, done.outcomes, done.cases, done.inventory, done.case_item, done.case_demand, SETTINGS
    )
    assert united == {}


def test_results_say_so():
    results = assess.run(read({"item": "square", "width": 35}), SETTINGS, figures=False)
    assert "either_axis" in results["square"].adopted.flags


def test_two_alike_have_one_chance_of_a_fall_along_either_axis():
    found = compute(read({"item": "a", "width": 35}, {"item": "b", "width": 35, "quantity": 3}), SETTINGS)
    assert list(found.either_axis) == [0, 1]
    shares = [found.either_axis[at].mean() for at in (0, 1)]
    assert shares[0] != shares[1], "which of them fall together is each one's own"
    chances = found.adoption.probability[found.governing]
    assert chances == pytest.approx([np.average(shares, weights=[1, 3])] * 2)
