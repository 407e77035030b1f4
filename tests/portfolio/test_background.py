"""A background of a map: what is drawn of a GeoJSON file, and what is said of one that cannot be drawn."""

import json
from pathlib import Path

import pytest

from assess.errors import InputError
from assess.portfolio import background as module
from assess.portfolio.background import read_background
from tests.refusals import check_refusals

BAY = Path(__file__).parents[2] / "samples" / "backgrounds" / "san-francisco-bay.geojson"
SQUARE = [[-122.0, 37.0], [-121.0, 37.0], [-121.0, 38.0], [-122.0, 37.0]]


def _write(folder, text):
    path = folder / "back.geojson"
    path.write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
    return path


def _of(kind, coordinates):
    return {"type": kind, "coordinates": coordinates}


def test_the_coast_of_the_sample_has_the_bay_in_it():
    import shapely

    found = read_background(BAY)
    land = shapely.union_all([shapely.Polygon(one[0], one[1:]) for one in found.areas])
    for name, place, is_land in (
        ("San Francisco City Hall", (-122.4193, 37.7793), True),
        ("Oakland City Hall", (-122.2727, 37.8053), True),
        ("middle of the bay", (-122.33, 37.70), False),
        ("Pacific", (-123.2, 37.5), False),
    ):
        assert land.contains(shapely.Point(place)) == is_land, name


def test_all_kinds_of_geometry_are_drawn_and_points_are_left_out(tmp_path):
    features = [
        _of("Polygon", [SQUARE]), _of("MultiPolygon", [[SQUARE], [SQUARE]]), _of("LineString", SQUARE[:2]),
        _of("MultiLineString", [SQUARE[:2], SQUARE[1:3]]), _of("Point", SQUARE[0]),
        {"type": "GeometryCollection", "geometries": [_of("LineString", [[0, 0, 12.5], [1, 1, 13]])]},
    ]  # fmt: skip
    members = [{"type": "Feature", "geometry": one} for one in (*features, None)]
    found = read_background(_write(tmp_path, {"type": "FeatureCollection", "features": members}))
    assert len(found.areas) == 3
    assert found.lines[-1] == ((0.0, 0.0), (1.0, 1.0))
    assert len(found.lines) == 4


def test_what_cannot_be_drawn_is_refused_with_its_place(tmp_path):
    cases = [
        ('{"type": "FeatureCollection", "features": [', r"column 44: it is not GeoJSON, or the file is cut off"),
        ('{"type": "LineString", "coordinates": [[0, 0], [NaN, 1]]}', r"which is not a JSON number\. Remove"),
        (_of("LineString", [[0, 0], [545000, 4180000]]), r"\[545000, 4.18e\+06\] is not \[longitude, latitude\]"),
        (_of("LineString", [[37.7, -122.4], [37.8, -122.5]]), r"projected metres, or is the order swapped\?"),
        (_of("LineString", [[0, 0]]), r"has 1 points, expected at least 2"),
        (_of("LineString", [[0, 0], ["x", 1]]), r'\["x", 1\] is not a point'),
        (_of("LineString", [[0, 0], [10**400, 1]]), r"is not a point"),
        (_of("Polygon", [[1, 2], [3, 4]]), r"1 is not a point"),
        (_of("Polygon", 5), r"not lists of points as a Polygon has them"),
        (_of("Point", [0, 0]), r"it holds no Polygon"),
        ({"type": "FeatureCollection"}, r"features is missing, or not a list"),
        ({"type": "FeatureCollection", "features": [{"type": "Circle"}]}, r"features\[0\]: 'Circle' is not a type"),
        ([1, 2], r"FeatureCollection, Feature or geometry is expected"),
        ("path,building\na,b\n", r"it is not GeoJSON"),
        (_of("LineString", SQUARE) | {"crs": {"properties": {"name": "EPSG:26910"}}}, r"another system than WGS 84"),
        ("[" * 200_000, r"nested too deep|cut off"),
    ]  # fmt: skip
    placed = [(text, rf"(?s)^background back\.geojson: .*({message})") for text, message in cases]
    check_refusals(InputError, lambda text: read_background(_write(tmp_path, text)), placed)


def test_binary_missing_and_too_large_files_are_told(tmp_path, monkeypatch):
    (tmp_path / "a.shp").write_bytes(b"\x00\x00\x27\x0a\xff\xfe")
    with pytest.raises(InputError, match=r"not UTF-8 text, so it is not GeoJSON.*exported as GeoJSON"):
        read_background(tmp_path / "a.shp")
    with pytest.raises(InputError, match=r"background no\.geojson: it cannot be read \(No such file"):
        read_background(tmp_path / "no.geojson")
    monkeypatch.setattr(module, "MOST_POINTS", 3)
    with pytest.raises(InputError, match="more than 3 points"):
        read_background(_write(tmp_path, _of("Polygon", [SQUARE])))
    monkeypatch.setattr(module, "MOST_BYTES", 1_000)
    with pytest.raises(InputError, match="more than 0 MB"):
        read_background(_write(tmp_path, _of("Polygon", [SQUARE * 100])))
