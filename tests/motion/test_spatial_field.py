"""A field of normal numbers over the earth: as correlated as published, and each place's own whatever else is drawn."""

import math
import subprocess
import sys

import numpy as np
import pytest

from assess.motion.spatial_field import EARTH, SCATTERS, WAVES, draw_field

DRAWS = 16_384
"""As many as are kept ready at once."""
BAY = (37.79, -122.40)


def east_of(place, distance):
    """Return the place this far east on a straight line through the earth [km]."""
    latitude, longitude = place
    angle = 2 * math.asin(distance / 2 / (EARTH * math.cos(math.radians(latitude))))
    return latitude, longitude + math.degrees(angle)


def test_ranges_are_those_of_jayaram_and_baker():
    """Their eq. 20: b of PGA where soil conditions are clustered; PGV as spectral acceleration at 1 s."""
    assert SCATTERS["PGA"].range_km == pytest.approx(40.7)
    assert SCATTERS["PGV"].range_km == pytest.approx(22.0 + 3.7 * 1.0)


@pytest.mark.parametrize("range_km", [40.7, 25.7])
@pytest.mark.parametrize("distance", [1.0, 5.0, 15.0, 40.7, 150.0])
def test_numbers_of_two_places_are_correlated_by_their_distance(distance, range_km):
    places = BAY, east_of(BAY, distance)
    one, other = (draw_field(1, 0, DRAWS, place[0], place[1], range_km) for place in places)
    wanted = math.exp(-3 * distance / range_km)
    error = (1 - wanted**2 + 0.02) / math.sqrt(DRAWS)  # the kurtosis adds little
    assert np.corrcoef(one, other)[0, 1] == pytest.approx(wanted, abs=4 * error)


def test_correlation_is_alike_in_every_direction():
    latitude, longitude = BAY
    north = (latitude + math.degrees(2 * math.asin(10 / 2 / EARTH)), longitude)
    here = draw_field(1, 0, DRAWS, *BAY)
    found = [np.corrcoef(here, draw_field(1, 0, DRAWS, *there))[0, 1] for there in (north, east_of(BAY, 10))]
    assert found[0] == pytest.approx(found[1], abs=0.03)


def test_numbers_of_a_place_are_about_normal_and_draws_independent_of_each_other():
    found = draw_field(1, 0, DRAWS, *BAY)
    assert found.mean() == pytest.approx(0, abs=4 / math.sqrt(DRAWS))
    assert found.std() == pytest.approx(1, abs=4 / math.sqrt(2 * DRAWS))
    standard = (found - found.mean()) / found.std()
    assert (standard**3).mean() == pytest.approx(0, abs=4 * math.sqrt(6 / DRAWS))
    assert (standard**4).mean() - 3 == pytest.approx(-1.5 / WAVES, abs=4 * math.sqrt(24 / DRAWS))
    for lag in (1, 64, 256):
        assert np.corrcoef(found[lag:], found[:-lag])[0, 1] == pytest.approx(0, abs=4 / math.sqrt(DRAWS))


def test_a_number_is_that_of_its_seed_draw_and_place_whatever_else_is_drawn_also_in_another_process():
    every = draw_field(1, 0, 700, *BAY)
    draw_field(1, 0, 700, 10.0, 20.0)
    for first, count in ((0, 1), (255, 2), (256, 1), (500, 200)):
        assert np.array_equal(draw_field(1, first, count, *BAY), every[first : first + count])
    assert not np.array_equal(draw_field(2, 0, 700, *BAY), every)
    assert not np.array_equal(draw_field(1, 0, 700, 37.80, -122.40), every)
    call = "draw_field(1, 300, 5, 37.79, -122.4).tobytes().hex()"
    code = f"from assess.motion.spatial_field import draw_field; print({call})"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    assert found == draw_field(1, 300, 5, *BAY).tobytes().hex()


def test_the_date_line_and_the_poles_are_places_like_others():
    west, east = (draw_field(1, 0, 300, -17.0, longitude) for longitude in (-180.0, 180.0))
    assert west == pytest.approx(east, abs=1e-6)
    near = [draw_field(1, 0, DRAWS, -17.0, longitude) for longitude in (-179.99, 179.99)]
    distance = 2 * EARTH * math.cos(math.radians(17)) * math.sin(math.radians(0.01))
    assert np.asarray(np.corrcoef(near))[0, 1] == pytest.approx(math.exp(-3 * distance / 40.7), abs=0.01)
    for pole in (-90.0, 90.0):
        assert draw_field(1, 0, 300, pole, 0.0) == pytest.approx(draw_field(1, 0, 300, pole, 123.0), abs=1e-6)
