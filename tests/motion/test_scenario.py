"""The profiles of codes: what holds of all of them."""

import pytest
from hypothesis import given, strategies as st

from assess.motion.scenario import PROFILES, UNVERIFIED
from assess.settings import SCENARIOS

KEYS = st.sampled_from(sorted(PROFILES))
RATIOS = st.floats(-0.5, 1.5)
PERIODS = st.none() | st.floats(0.02, 20)
REDUCTIONS = st.floats(1, 5)


def test_every_profile_is_a_scenario_and_cites_the_equation_that_applies():
    assert list(SCENARIOS) == ["as filled", "recorded", "given", *PROFILES]
    assert PROFILES["ASCE 7-22"].cite(None) == "13.3.1.1, Eq. 13.3-5"
    assert PROFILES["ASCE 7-22"].cite(1.0) == "13.3.1.1, Eq. 13.3-4"
    assert PROFILES["EN 1998-1"].cite(None) == PROFILES["EN 1998-1"].cite(1.0) == "4.3.5.2, Eq. (4.25)"


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_every_profile_says_where_it_comes_from(profile):
    assert profile.title
    assert profile.clause
    assert profile.equation.count("PFA") == 1
    assert profile.reference
    assert profile.remark
    assert profile.verified == profile.key.startswith("ASCE")
    assert "not" in UNVERIFIED


@given(KEYS, RATIOS, RATIOS, PERIODS, REDUCTIONS)
def test_pfa_never_falls_with_height_nor_below_the_ground(key, one, other, period, reduction):
    lower, upper = (
        PROFILES[key].amplification(ratio, period, ductility_reduction=reduction) for ratio in sorted((one, other))
    )
    assert 1 <= lower <= upper


@given(RATIOS, PERIODS)
def test_an_unknown_period_never_gives_less(ratio, period):
    profile = PROFILES["ASCE 7-22"]
    assert profile.amplification(ratio, None) >= profile.amplification(ratio, period) - 1e-12


@given(KEYS, PERIODS, st.floats(-10, 0), st.floats(1, 10))
def test_below_the_ground_and_above_the_roof_it_is_held(key, period, below, above):
    profile = PROFILES[key]
    assert profile.amplification(below, period) == profile.amplification(0, period) == 1
    assert profile.amplification(above, period) == profile.amplification(1, period)
