"""Units: factors against their exact definitions, and the reading of a unit."""

from fractions import Fraction

from assess import units

EXACT = {
    "LENGTH": {"mm": "1/1000", "cm": "1/100", "m": "1", "in": "254/10000", "ft": "3048/10000"},
    "ACCELERATION": {"g": "980665/100000", "m/s2": "1", "cm/s2": "1/100", "gal": "1/100"},
    "VELOCITY": {"cm/s": "1/100", "m/s": "1", "in/s": "254/10000"},
    "ANGLE": {"deg": "1"},
    "TIME": {"s": "1"},
}


def test_factors_are_exact():
    assert units.GRAVITY == 9.80665
    found = {name: {unit: getattr(units, name)[unit] for unit in table} for name, table in EXACT.items()}
    assert found == {name: {unit: float(Fraction(one)) for unit, one in table.items()} for name, table in EXACT.items()}


def test_units_are_read_as_people_write_them():
    for table in units.QUANTITIES.values():
        assert [units.read_unit(unit) for unit in table] == list(table)
    written = {" CM ": "cm", "m/s²": "m/s2", "m/s^2": "m/s2", "M / S2": "m/s2", "Gal": "gal", "in / s": "in/s"}
    assert {text: units.read_unit(text) for text in written} == written
    assert units.read_unit("furlong") == "furlong"


def test_to_edge_gives_back_what_was_typed():
    for typed, factor in (
        *((one, units.LENGTH["cm"]) for one in (5, 28, 29, 32.1, 56, 57, 58, 110, 180.3, 206.4, 600)),
        *((one, units.GRAVITY) for one in (0.1, 0.14, 0.35, 0.57, 0.9)),
    ):
        assert units.to_edge(typed * factor, factor) == typed
