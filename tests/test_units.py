"""Units: factors against their exact definitions, and the reading of a unit."""

from fractions import Fraction

import pytest

from assess import units


def test_gravity_is_the_standard_one():
    assert units.GRAVITY == 9.80665


@pytest.mark.parametrize(
    ("table", "unit", "exact"),
    [
        (units.LENGTH, "mm", Fraction(1, 1000)),
        (units.LENGTH, "cm", Fraction(1, 100)),
        (units.LENGTH, "m", Fraction(1)),
        (units.LENGTH, "in", Fraction(254, 10000)),
        (units.LENGTH, "ft", 12 * Fraction(254, 10000)),
        (units.ACCELERATION, "g", Fraction(980665, 100000)),
        (units.ACCELERATION, "m/s2", Fraction(1)),
        (units.ACCELERATION, "cm/s2", Fraction(1, 100)),
        (units.ACCELERATION, "gal", Fraction(1, 100)),
        (units.VELOCITY, "cm/s", Fraction(1, 100)),
        (units.VELOCITY, "m/s", Fraction(1)),
        (units.VELOCITY, "in/s", Fraction(254, 10000)),
        (units.ANGLE, "deg", Fraction(1)),
        (units.TIME, "s", Fraction(1)),
    ],
)
def test_factors_are_exact(table, unit, exact):
    assert table[unit] == float(exact)


def test_every_unit_is_spelt_as_it_is_read():
    for table in units.QUANTITIES.values():
        assert all(units.read_unit(unit) == unit for unit in table)


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("cm", "cm"),
        (" CM ", "cm"),
        ("m/s²", "m/s2"),
        ("m/s^2", "m/s2"),
        ("M / S2", "m/s2"),
        ("Gal", "gal"),
        ("in / s", "in/s"),
        ("furlong", "furlong"),
    ],
)
def test_read_unit(text, unit):
    assert units.read_unit(text) == unit


@pytest.mark.parametrize("centimetres", [5, 28, 29, 32.1, 56, 57, 58, 110, 180.3, 206.4, 600])
def test_to_edge_gives_back_what_was_typed(centimetres):
    assert units.to_edge(centimetres * units.LENGTH["cm"], units.LENGTH["cm"]) == centimetres


@pytest.mark.parametrize("in_g", [0.1, 0.14, 0.35, 0.57, 0.9])
def test_to_edge_of_accelerations(in_g):
    assert units.to_edge(in_g * units.GRAVITY, units.ACCELERATION["g"]) == in_g
