"""Intensity to the motion of the ground: the published check values, and what must hold of every class."""

import math
from itertools import pairwise
from pathlib import Path

import pytest

from assess.intensity import MIDORIKAWA, RATIO, SHAKINGS, WORDEN, WORDEN_PGA, WORDEN_PGV, invert_jma, name_mmi
from assess.units import GRAVITY

LEGEND = {
    "MMI IV": (2.76, 1.4), "MMI V": (6.2, 4.7), "MMI VI": (11.5, 9.6), "MMI VII": (21.5, 20), "MMI VIII": (40.1, 41),
    "MMI IX": (74.7, 86), "MMI X": (139, 178),
}  # fmt: skip
"""PGA [% g] and PGV [cm/s] as the legend of USGS ShakeMap prints them with Worden et al. (2012)."""
CLASSES = {"JMA 4": (3.5, 4.5), "JMA 5-": (4.5, 5.0), "JMA 5+": (5.0, 5.5), "JMA 6-": (5.5, 6.0), "JMA 6+": (6.0, 6.5)}
"""Limits of instrumental intensity: JMA notice of 1996."""
LIMITS = {3.5: 3.0, 4.5: 11.4, 5.0: 22.3, 5.5: 43.6, 6.0: 85.2, 6.5: 166}
"""PGV [cm/s] at the limits, by the equation of Midorikawa et al. (1999)."""
BY_NAME = {one.name: one for one in SHAKINGS.values()}


def test_mmi_classes_are_those_of_the_legend_of_shakemap():
    for name, (pga, pgv) in LEGEND.items():
        shaking = BY_NAME[name]
        assert 100 * shaking.pga / GRAVITY == pytest.approx(pga, rel=0.01), name
        assert 100 * shaking.pgv == pytest.approx(pgv, rel=0.012), name
        assert (shaking.is_derived, shaking.references) == (False, (WORDEN,))
        for speed in (pgv / 100, None):
            assert name_mmi(pga / 100 * GRAVITY, speed) == shaking.choice


@pytest.mark.parametrize("relation", [WORDEN_PGA, WORDEN_PGV])
def test_a_relation_and_its_inverse_agree(relation):
    for tenths in range(40, 110):
        mmi = tenths / 10
        if abs(mmi - relation.t2) > 0.1:  # the printed breaks in log Y and in MMI differ in the second decimal
            log = math.log10(relation.invert(mmi))
            c_1, c_2 = (relation.c1, relation.c2) if log <= relation.t1 else (relation.c3, relation.c4)
            assert c_1 + c_2 * log == pytest.approx(mmi)


def test_jma_classes_stand_for_their_middle():
    """The limits are those of Midorikawa."""
    assert {one: invert_jma(one) for one in LIMITS} == pytest.approx(LIMITS, rel=0.01)
    for name, (low, high) in CLASSES.items():
        shaking = BY_NAME[name]
        assert shaking.intensity == (low + high) / 2
        assert invert_jma(low) < 100 * shaking.pgv < invert_jma(high)
        assert shaking.references == (MIDORIKAWA,)


def test_pga_of_a_jma_class_follows_from_pgv():
    """5 upper by hand: PGV 31.2 cm/s over 105 cm/s per g is 0.297 g."""
    shaking = BY_NAME["JMA 5+"]
    assert 100 * shaking.pgv == pytest.approx(31.2, rel=0.002)
    assert shaking.pga / GRAVITY == pytest.approx(0.297, rel=0.003)
    assert [one.name for one in SHAKINGS.values() if one.is_derived] == [one for one in BY_NAME if "JMA" in one]
    # The ratio is that between soil and rock of Newmark and Hall: the geometric mean of 122 and 91 cm/s per g.
    assert pytest.approx(math.sqrt(122 * 91), rel=0.005) == 100 * RATIO * GRAVITY


def test_an_open_class_does_not_stand_for_its_lower_limit():
    """JMA 7 begins at 6.5, where PGV is 166 cm/s; MMI X at 9.5."""
    seven, ten = BY_NAME["JMA 7"], BY_NAME["MMI X"]
    assert (seven.is_open, seven.intensity, ten.is_open, ten.intensity) == (True, 7.0, True, 10.0)
    assert 100 * seven.pgv > 1.9 * LIMITS[6.5]
    assert [one.name for one in SHAKINGS.values() if one.is_open] == ["MMI X", "JMA 7"]


def test_pgv_decides_on_the_class_and_what_is_weak_or_beyond_has_the_nearest_word():
    """New York: 0.547 g would be MMI VIII or more; 13.6 cm/s is VI."""
    assert name_mmi(0.547 * GRAVITY, 0.136) == "MMI VI, strong"
    assert name_mmi(0.547 * GRAVITY, None) == "MMI VIII, severe"
    assert name_mmi(0.005 * GRAVITY, 0.005) == ""
    assert name_mmi(3 * GRAVITY, 6.0) == "MMI X, extreme"


def test_the_scatter_is_the_published_one_of_pgv_and_that_of_a_jma_class_has_its_width_and_that_of_the_equation():
    """0.38 log10 units given MMI, rounded up; JMA 5 upper by hand: sqrt(0.144^2 + 0.21^2)/1.72 = 0.148 log10 units of
    PGV; 4 is twice as wide."""
    for shaking in SHAKINGS.values():
        if not shaking.is_derived:
            assert 0 <= shaking.scatter - 0.38 * math.log(10) < 0.01, shaking.name
    assert BY_NAME["JMA 5+"].scatter == pytest.approx(0.148 * math.log(10), abs=0.011)
    assert BY_NAME["JMA 4"].scatter > BY_NAME["JMA 5+"].scatter >= 0.21 / 1.72 * math.log(10)


def test_a_stronger_class_shakes_more():
    for scale, number in (("MMI", 7), ("JMA", 6)):
        own = [one for one in SHAKINGS.values() if one.name.startswith(scale)]
        assert len(own) == number
        assert all(one.pga < next_.pga and one.pgv < next_.pgv for one, next_ in pairwise(own))


def test_the_table_of_the_documentation_is_that_of_the_code():
    text = (Path(__file__).parents[1] / "docs" / "limits.md").read_text(encoding="utf-8")
    for one in SHAKINGS.values():
        values = f"{one.intensity:g} | {one.pga / GRAVITY:.3f} | {100 * one.pgv:.1f} | {one.scatter:.2f}"
        assert f"| {one.choice} | {values} |" in text
