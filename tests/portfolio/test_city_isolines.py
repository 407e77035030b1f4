"""Lines of equal PGA: they run where the ShakeMap has that value, and end where it ends."""

from dataclasses import replace

import pytest

from assess.errors import InputError
from assess.i18n import fill
from assess.motion.shakemap import read_shakemap
from assess.motion.site_ground import SiteGround
from assess.portfolio.city_isolines import build_isolines, list_isolines
from assess.resources import city_file
from assess.units import GRAVITY
from tests.portfolio.city_samples import make_view

PLACES = [(-122.45, 37.3), (-121.9, 37.9)]


class Slope:
    """A ground motion that grows to the north, known south of a latitude."""

    file, sha256 = "slope", ""

    def at(self, latitude, longitude):
        if latitude > 37.7:
            raise InputError(fill("outside"))
        pga = (0.1 + 0.5 * (latitude - 37.3)) * GRAVITY
        return SiteGround(kind="shakemap", file="", sha256="", pga=pga, dispersion=0.3, dispersion_source=fill("x"))


def test_a_line_runs_where_the_ground_has_its_value_and_ends_where_it_is_not_known():
    found = build_isolines(Slope(), PLACES)
    assert {one.label for one in found} >= {"0.1 g", "0.2 g"}
    for one in found:
        pga = float(one.label.removesuffix(" g"))
        assert all(y == pytest.approx(37.3 + (pga - 0.1) / 0.5, abs=1e-6) for _x, y in one.line)
    assert max(y for one in found for _x, y in one.line) <= 37.7


@pytest.mark.slow
def test_lines_of_the_loma_prieta_map_agree_with_it():
    ground = read_shakemap(city_file("grid.xml"))
    found = build_isolines(ground, PLACES)
    assert len({one.label for one in found}) >= 3
    for one in found:
        longitude, latitude = one.line[len(one.line) // 2]
        assert ground.at(latitude, longitude).pga / GRAVITY == pytest.approx(float(one.label[:-2]), rel=0.1)


def test_without_places_or_a_shakemap_there_are_no_lines():
    assert build_isolines(Slope(), []) == ()
    view = make_view(12, draws=5)
    assert list_isolines(view, Slope())
    assert list_isolines(view, None) == ()
    assert list_isolines(replace(view, ground=None), Slope()) == ()
