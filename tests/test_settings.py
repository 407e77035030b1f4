import math

import pytest

import assess
from assess.settings import SCENARIOS, match_choice


@pytest.mark.parametrize("zeta", [0.0, -1.0, math.nan, math.inf])
def test_a_zeta_that_is_no_positive_number_is_refused(zeta):
    with pytest.raises(ValueError, match="must be finite and above 0"):
        assess.Settings(zeta_velocity=zeta)


def test_the_package_offers_its_names_before_they_are_loaded():
    assert {"run", "Settings", "read_inventory", "write_reports"} <= set(dir(assess))
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        assess.nonsense  # noqa: B018


@pytest.mark.parametrize("reduction", [0.99, 0.0, -2.0, math.nan, math.inf])
def test_a_ductility_reduction_below_one_is_refused(reduction):
    with pytest.raises(ValueError, match=r"ductility_reduction is .*, expected at least 1, and finite"):
        assess.Settings(ductility_reduction=reduction)


@pytest.mark.parametrize(
    ("text", "choice"),
    [
        ("ASCE 7-22", "ASCE 7-22"),
        ("asce7-22", "ASCE 7-22"),
        ("ASCE 7\u201322", "ASCE 7-22"),
        ("en_1998_1", "EN 1998-1"),
        ("ntc2018", "NTC 2018"),
        ("As-Filled", "as filled"),
        (" RECORDED ", "recorded"),
        ("ASCE 7-10", None),
        ("", None),
    ],
)
def test_choices_are_matched_loosely(text, choice):
    assert match_choice(text, SCENARIOS) == choice


def test_by_default_what_is_high_or_doubtful_is_verified_under_200_motions():
    usual = assess.Settings()
    assert (usual.verify, usual.runs, usual.seed, usual.scale_motions) == ("high", 200, 1, False)


@pytest.mark.parametrize("runs", [0, -1, 100_001, 2.5, "x", "Auto", None])
def test_a_number_of_runs_that_cannot_be_is_refused(runs):
    with pytest.raises(ValueError, match=r"runs is .*, expected 1 to 100,000, or auto"):
        assess.Settings(runs=runs)


@pytest.mark.parametrize("runs", [1, 100_000, "auto"])
def test_runs_that_can_be(runs):
    assert assess.Settings(runs=runs).runs == runs


def test_a_seed_below_zero_is_refused():
    with pytest.raises(ValueError, match="seed is -1, expected 0 or above"):
        assess.Settings(seed=-1)
