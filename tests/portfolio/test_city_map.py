"""The map: where marks stand, what lies on top, scale, signs that read in grey, and a background cut to the frame."""

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest

from assess.errors import InputError
from assess.i18n import fill
from assess.motion.site_ground import SiteGround
from assess.portfolio.background import Background
from assess.portfolio.city_map import (
    BY_CLASS,
    BY_SHARE,
    GROUND,
    SEA,
    Isoline,
    MapPoint,
    build_frame,
    draw_map,
    find_bar,
    list_isolines,
    sign_of_class,
    sign_of_routes,
    sign_of_share,
)
from assess.units import GRAVITY
from tests.portfolio.city_samples import NASTY, make_view

SVG = "{http://www.w3.org/2000/svg}"
ROW = {"status": "assessed", "expected_falls": 0.0, "low": 0, "medium": 0, "high": 0, "very_high": 0, "unconfirmed": 0,
       "by_formula": 0, "rolls": 0, "anchored": 0, "routes_open": 0, "routes_doubtful": 0, "routes_blocked": 0,
       "routes_not_known": 0}  # fmt: skip


def _point(at, latitude, longitude, key="low", name="A"):
    return MapPoint(at, name, latitude, longitude, BY_CLASS[key])


def _draw(points, background=None, **more):
    text = draw_map(points, background, title="Map", **more)
    return ET.fromstring(text.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1))


def _places(svg):
    found = [one.get("transform") for one in svg.find(f"{SVG}g[@class='marks']")]
    return [tuple(map(float, re.match(r"translate\((\S+) (\S+)\)", one).groups())) for one in found]


def test_distances_on_the_map_are_those_on_the_ground():
    hall, oakland = (37.7793, -122.4193), (37.8053, -122.2727)
    frame = build_frame([(one[1], one[0]) for one in (hall, oakland)])
    (x1, y1), (x2, y2) = (frame.place(one[1], one[0]) for one in (hall, oakland))
    phi1, phi2, turn = math.radians(hall[0]), math.radians(oakland[0]), math.radians(oakland[1] - hall[1])
    ground = 6371 * math.acos(math.sin(phi1) * math.sin(phi2) + math.cos(phi1) * math.cos(phi2) * math.cos(turn))
    assert math.hypot(x2 - x1, y2 - y1) / frame.scale == pytest.approx(ground, rel=2e-4)
    assert x2 > x1
    assert y2 < y1  # Oakland lies north-east


def test_all_buildings_are_inside_and_the_worst_lie_on_top():
    points = [_point(0, 37.5, -122.0, "very-high"), _point(1, 37.9, -122.5), _point(2, 37.7, -122.2, "medium")]
    svg = _draw(points)
    wide, high = map(float, svg.get("viewBox").split()[2:])
    places = _places(svg)
    assert all(0 < x < wide and 0 < y < high for x, y in places)
    assert places[-1] == max(places)  # the very high one, the farthest east, is drawn last
    titles = [one.findtext(f"{SVG}title") for one in svg.find(f"{SVG}g[@class='marks']")]
    assert titles == ["A", "A", "A"]


def test_a_city_on_the_date_line_or_of_one_building_has_a_map_with_a_round_scale_and_none_gives_no_map():
    frame = build_frame([(179.9, -17.0), (-179.9, -17.1)])
    (x1, _), (x2, _) = frame.place(179.9, -17.0), frame.place(-179.9, -17.1)
    assert 0 < x1 < x2 < frame.wide
    assert frame.wide / frame.scale < 60
    for latitude in (89.99, -90.0, 0.0):
        frame = build_frame([(10.0, latitude)])
        assert find_bar(frame) in (0.5, 0.2, 1.0)
        assert len(_places(_draw([_point(0, latitude, 10.0)]))) == 1
    assert draw_map([], None, title="Map") == ""
    drawn = draw_map([_point(0, 37.8, -122.4)], None, title="Map")
    assert 'class="sea"' not in drawn, "without a background nothing looks like water"
    assert SEA not in drawn
    assert drawn.count(GROUND) == 2, "the map, and what lies beside it when it is moved"


def test_the_sign_of_a_building_is_that_of_its_worst_or_by_the_share_that_falls():
    for changes, share, kind, state in (
        ({"low": 99, "very_high": 1, "expected_falls": 1.5, "routes_open": 2}, "share-low", "very-high", "open"),
        ({"low": 97, "high": 3, "expected_falls": 3.0, "routes_doubtful": 1, "routes_open": 1},
         "share-medium", "high", "doubtful"),
        ({"high": 10, "expected_falls": sum([0.3] * 10), "routes_not_known": 1, "routes_doubtful": 1},
         "share-high", "high", "not-known"),
        ({"very_high": 2, "expected_falls": 2.0000000000000004, "routes_blocked": 1, "routes_not_known": 1},
         "share-very-high", "very-high", "blocked"),
        ({"unconfirmed": 1, "by_formula": 1}, "unconfirmed", "unconfirmed", "no-routes"),
        ({"by_formula": 1, "anchored": 3}, "by-formula", "by-formula", "no-routes"),
        ({"anchored": 4}, "anchored", "anchored", "no-routes"),
        ({}, "none", "none", "no-routes"),
        ({"status": "skipped", "very_high": None, "expected_falls": None}, "skipped", "skipped", "skipped"),
    ):  # fmt: skip
        found = [find(ROW | changes).key for find in (sign_of_share, sign_of_class, sign_of_routes)]
        assert found == [share, kind, state]
    assert BY_SHARE["share-high"].label == "30 to 70 % of its pieces expected to fall"


def test_the_background_is_cut_to_what_is_shown():
    square = ((-130.0, 30.0), (-110.0, 30.0), (-110.0, 45.0), (-130.0, 45.0), (-130.0, 30.0))
    hole = ((-122.1, 37.1), (-122.0, 37.1), (-122.0, 37.2), (-122.1, 37.1))
    far = (((10.0, 50.0), (11.0, 50.0), (11.0, 51.0), (10.0, 50.0)),)
    street = ((-122.5, 37.0), (-121.5, 37.5))
    back = Background("b.geojson", ((square, hole), far), (street,))
    svg = _draw([_point(0, 37.0, -122.3), _point(1, 37.4, -121.9)], back)
    land = svg.find(f"{SVG}path[@class='land']").get("d")
    numbers = [float(one) for one in re.findall(r"-?\d+\.\d", land)]
    assert max(map(abs, numbers)) < 1100
    assert land.count("M") == 2  # the square's part with its hole; nothing of what lies far away
    assert svg.find(f"{SVG}path[@class='lines']") is not None
    bow = ((-122.4, 37.0), (-122.0, 37.4), (-122.0, 37.0), (-122.4, 37.4), (-122.4, 37.0))  # it crosses itself
    svg = _draw([_point(0, 37.0, -122.3), _point(1, 37.4, -121.9)], Background("b", ((bow,),)))
    assert svg.find(f"{SVG}path[@class='land']").get("d").startswith("M")


def test_lines_of_equal_shaking_carry_their_value_and_names_are_escaped():
    line = Isoline("0.2 g", tuple((-122.4 + 0.02 * at, 37.2) for at in range(20)))
    svg = _draw([_point(0, 37.0, -122.3, name=NASTY), _point(1, 37.4, -121.9)], isolines=[line])
    assert [one.text for one in svg.iter(f"{SVG}text") if one.get("class") == "isoline"] == ["0.2 g"]
    assert NASTY in [one.text for one in svg.iter(f"{SVG}title")]


# ---------------------------------------------------------------- lines of equal PGA


class Slope:
    """A ground motion that grows to the north, known south of a latitude."""

    file, sha256 = "slope", ""

    def at(self, latitude, longitude):
        if latitude > 37.7:
            raise InputError(fill("outside"))
        pga = (0.1 + 0.5 * (latitude - 37.3)) * GRAVITY
        return SiteGround(kind="shakemap", file="", sha256="", pga=pga, dispersion=0.3, dispersion_source=fill("x"))


def test_a_line_runs_where_the_ground_has_its_value_and_ends_where_it_is_not_known():
    city = make_view(12, draws=5)
    found = list_isolines(city, Slope())
    assert {one.label for one in found} >= {"0.15 g", "0.2 g"}
    for one in found:
        pga = float(one.label.removesuffix(" g"))
        assert all(y == pytest.approx(37.3 + (pga - 0.1) / 0.5, abs=1e-6) for _x, y in one.line)
    assert max(y for one in found for _x, y in one.line) <= 37.7
    assert list_isolines(city, None) == ()
    assert list_isolines(replace(city, ground=None), Slope()) == ()
    assert list_isolines(replace(city, buildings=city.buildings[:0]), Slope()) == ()
