"""Check values of physics.md F: the tension in a bracket, the friction that its base needs, and the code's demand."""

import numpy as np
import pytest

from assess.bracket import (
    find_code_demand,
    find_european_demand,
    find_needed_friction,
    find_tension,
    find_tension_without_weight,
)

PIECE = {"weight": 1.2, "centre": 0.90, "height": 1.70}
"""A cabinet of 1.2 kN, 0.40 m deep, held at 1.70 m."""


def test_tension_and_friction_that_the_base_needs_of_physics_f():
    for vertical, tensions in ((0.0, [0.0494, 0.2400, 0.4941]), (0.2, [0.0776, 0.2682, 0.5224])):
        found = find_tension(**PIECE, acceleration=[0.3, 0.6, 1.0], breadth=0.40, vertical=vertical)
        assert found == pytest.approx(tensions, abs=5e-5), vertical
    found = find_tension_without_weight(**PIECE, acceleration=[0.3, 0.6, 1.0])
    assert found == pytest.approx([0.1906, 0.3812, 0.6353], abs=5e-5), "without the weight"
    tension = find_tension(**PIECE, acceleration=0.6, breadth=0.40, vertical=0.2)
    found = find_needed_friction(weight=1.2, acceleration=0.6, tension=tension, vertical=0.2)
    assert found == pytest.approx(0.471, abs=5e-4)


def test_a_low_bracket_takes_more_than_the_force_and_the_base_slides_to_the_wall():
    """Below z - B/(2 k), 0.567 m: T = 1.2 (0.6 x 0.9 - 0.2) / 0.4 = 1.02, more than k W = 0.72; 0.30 / 1.2 is left."""
    low = PIECE | {"height": np.array([0.40, 0.90 - 0.40 / 1.2])}
    tension = find_tension(**low, acceleration=0.6, breadth=0.40)
    assert tension == pytest.approx([1.02, 0.72])
    found = find_needed_friction(weight=1.2, acceleration=0.6, tension=tension)
    assert found == pytest.approx([0.25, 0], abs=1e-12)


def test_demand_of_the_code_of_physics_f():
    """With the period of the building, and where it is not known."""
    known = {"period": 0.8, "ductility": 1.3, "resonance": 1}
    unknown = {"importance": 1.5, "resonance": 1.4}
    for given, shares, within in ((known, (0.300, 0.3335, 0.6154), 5e-5), (unknown, (0.560, 0.969, 1.508), 5e-4)):
        found = [find_code_demand(sds=1, height_ratio=one, strength=1.5, **given) for one in (0, 0.5, 1)]
        assert found == pytest.approx(shares, abs=within)
    low, high = (find_code_demand(sds=1, height_ratio=1, resonance=one, strength=1.5) for one in (0.1, 20))
    assert [low, high] == pytest.approx([0.3, 1.6]), "it has a least and a most"


def test_demand_of_en_1998_1():
    """On the roof 2.5 alpha S of a rigid piece and 5.5 alpha S at resonance; never less than alpha S."""
    roof = {"ground": 0.2, "height_ratio": 1, "behaviour": 1}
    assert find_european_demand(**roof) == pytest.approx(2.5 * 0.2)
    assert find_european_demand(**roof, element_period=0.8, period=0.8) == pytest.approx(5.5 * 0.2)
    assert find_european_demand(**roof, element_period=0.8) == pytest.approx(5.5 * 0.2), "T_1 is not known"
    assert find_european_demand(**roof | {"behaviour": 2}, importance=1.5) == pytest.approx(2.5 * 0.2 * 1.5 / 2)
    low = find_european_demand(ground=0.2, height_ratio=0, behaviour=1, element_period=4, period=0.5)
    assert low == pytest.approx(0.2)


def test_what_cannot_be():
    for height in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="above 0"):
            find_tension(weight=1, acceleration=1, breadth=0.4, centre=0.9, height=height)
    with pytest.raises(ValueError, match="expected 0 to 1"):
        find_code_demand(sds=1, height_ratio=1.2, resonance=1, strength=1.5)
    with pytest.raises(ValueError, match="expected 0 to 1"):
        find_european_demand(ground=1, height_ratio=1.2, behaviour=2)
