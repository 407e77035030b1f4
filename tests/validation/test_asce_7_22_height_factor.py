"""Amplification with height, worked by hand from the equations of each code.

ASCE/SEI 7-22, 13.3.1.1: H_f = 1 + a1 (z/h) + a2 (z/h)^10 (Eq. 13.3-4), a1 = 1/T_a <= 2.5, a2 = 1 - (0.4/T_a)^2 >= 0;
T_a unknown: H_f = 1 + 2.5 (z/h) (Eq. 13.3-5). The powers that the table needs:
0.25^10 = 0.00000095367, 0.5^10 = 1/1024 = 0.0009765625, 0.75^10 = 0.0563135147, 0.9^10 = 0.3486784401.
"""

import pytest

from assess.motion.scenario import PROFILES

HEIGHTS = (0.0, 0.25, 0.5, 0.75, 0.9, 1.0)

ASCE_7_22 = {
    # 1 + 2.5 x 0.25 = 1.625, 1 + 2.5 x 0.5 = 2.25, 1 + 2.5 x 0.75 = 2.875, 1 + 2.5 x 0.9 = 3.25, 1 + 2.5 = 3.5
    None: (1.0, 1.625, 2.25, 2.875, 3.25, 3.5),
    # a1 = min(5, 2.5) = 2.5; a2 = max(1 - 2^2, 0) = max(-3, 0) = 0: as above
    0.2: (1.0, 1.625, 2.25, 2.875, 3.25, 3.5),
    # a1 = min(2.5, 2.5) = 2.5; a2 = 1 - 1^2 = 0: as above
    0.4: (1.0, 1.625, 2.25, 2.875, 3.25, 3.5),
    # a1 = 2; a2 = 1 - 0.8^2 = 0.36. 0.5: 1 + 1 + 0.36/1024 = 2.0003515625; 0.75: 1 + 1.5 + 0.0202728653;
    # 0.9: 1 + 1.8 + 0.1255242384; 1: 1 + 2 + 0.36
    0.5: (1.0, 1.5000003433, 2.0003515625, 2.5202728653, 2.9255242384, 3.36),
    # a1 = 1; a2 = 1 - 0.16 = 0.84. 0.5: 1 + 0.5 + 0.0008203125; 0.75: 1 + 0.75 + 0.0473033524;
    # 0.9: 1 + 0.9 + 0.2928898897; 1: 1 + 1 + 0.84
    1.0: (1.0, 1.2500008011, 1.5008203125, 1.7973033524, 2.1928898897, 2.84),
    # a1 = 0.5; a2 = 1 - 0.04 = 0.96. 0.5: 1 + 0.25 + 0.0009375; 0.75: 1 + 0.375 + 0.0540609741;
    # 0.9: 1 + 0.45 + 0.3347313025; 1: 1 + 0.5 + 0.96
    2.0: (1.0, 1.1250009155, 1.2509375, 1.4290609741, 1.7847313025, 2.46),
    # a1 = 0.25; a2 = 1 - 0.01 = 0.99. 0.5: 1 + 0.125 + 0.0009667969; 0.75: 1 + 0.1875 + 0.0557503796;
    # 0.9: 1 + 0.225 + 0.3451916557; 1: 1 + 0.25 + 0.99
    4.0: (1.0, 1.0625009441, 1.1259667969, 1.2432503796, 1.5701916557, 2.24),
}

OTHERS = {
    # 1 + 2 z/h
    "ASCE 7-16": (1.0, 1.5, 2.0, 2.5, 2.8, 3.0),
    # 3 (1 + z/H)/2 - 0.5: 3 x 1.25/2 - 0.5 = 1.375, 3 x 1.5/2 - 0.5 = 1.75, 2.625 - 0.5, 2.85 - 0.5, 3 - 0.5
    "EN 1998-1": (1.0, 1.375, 1.75, 2.125, 2.35, 2.5),
    # 1 + z/H
    "NTC 2018": (1.0, 1.25, 1.5, 1.75, 1.9, 2.0),
}


@pytest.mark.parametrize("period", ASCE_7_22)
def test_asce_7_22(period):
    profile = PROFILES["ASCE 7-22"]
    found = [profile.amplification(z_h, period) for z_h in HEIGHTS]
    assert found == pytest.approx(ASCE_7_22[period], abs=1e-10)


@pytest.mark.parametrize("period", [None, 0.2, 1.0, 4.0])
@pytest.mark.parametrize("key", OTHERS)
def test_profiles_without_a_period(key, period):
    found = [PROFILES[key].amplification(z_h, period) for z_h in HEIGHTS]
    assert found == pytest.approx(OTHERS[key], abs=1e-12)


@pytest.mark.parametrize(("reduction", "roof", "ground"), [(1.0, 3.5, 1.0), (1.4, 2.5, 1.0), (7.0, 1.0, 1.0)])
def test_ductility_reduces_the_profile_but_never_below_the_ground(reduction, roof, ground):
    """R_mu = 1.4: 3.5/1.4 = 2.5; R_mu = 7: 0.5, held at 1. Another code's profile has no R_mu."""
    profile = PROFILES["ASCE 7-22"]
    assert profile.amplification(1.0, ductility_reduction=reduction) == pytest.approx(roof)
    assert profile.amplification(0.0, ductility_reduction=reduction) == pytest.approx(ground)
    assert PROFILES["ASCE 7-16"].amplification(1.0, ductility_reduction=reduction) == pytest.approx(3.0)
