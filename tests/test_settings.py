import math

import pytest

import assess


@pytest.mark.parametrize("zeta", [0.0, -1.0, math.nan, math.inf])
def test_a_zeta_that_is_no_positive_number_is_refused(zeta):
    with pytest.raises(ValueError, match="must be finite and above 0"):
        assess.Settings(zeta_velocity=zeta)


def test_the_package_offers_its_names_before_they_are_loaded():
    assert {"run", "Settings", "read_inventory", "write_reports"} <= set(dir(assess))
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        assess.nonsense  # noqa: B018
