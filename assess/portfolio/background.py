"""A coastline, a border or streets behind the map of a city: a GeoJSON file of the user.

Reference: RFC 7946, The GeoJSON format: longitude before latitude, WGS 84.
"""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from assess.errors import InputError
from assess.i18n import Text, fill

MOST_BYTES = 20_000_000
MOST_POINTS = 400_000
"""Size of the file and points in it that are read: a map of a city needs no more."""
Place = tuple[float, float]
"""Longitude and latitude [deg]."""
_DEEPEST = 8
"""Depth to which collections may hold collections."""
_WORLD = ("CRS84", "4326")
_DIMENSIONS = {"LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
_NO_DRAWING = ("Point", "MultiPoint")


@dataclass(frozen=True, slots=True)
class Background:
    """What lies behind the points of a map.

    Parameters
    ----------
    file : str
        Name of its file.
    areas : tuple of tuple of rings
        Polygons: each its outline, then its holes; a ring is a tuple of longitudes and latitudes [deg].
    lines : tuple of lines
        Each a tuple of longitudes and latitudes [deg].
    """

    file: str
    areas: tuple[tuple[tuple[Place, ...], ...], ...] = ()
    lines: tuple[tuple[Place, ...], ...] = ()


def read_background(path: Path) -> Background:
    """Read a GeoJSON file with Polygon, MultiPolygon, LineString or MultiLineString; points are left out.

    Raises
    ------
    InputError
        If it cannot be read, is not GeoJSON, is too large, or a coordinate is not longitude and latitude: the message
        names the place in the file.
    """
    return _Reader(path).read()


class _Reader:
    """Reads one file; counts its points."""

    def __init__(self, path: Path) -> None:
        self.path, self.points = path, 0

    def read(self) -> Background:
        found = self._parse()
        if not isinstance(found, dict) or not isinstance(found.get("type"), str):
            self._refuse(fill("it is not GeoJSON: a FeatureCollection, Feature or geometry is expected at its top"))
        self._check_system(found)
        drawn = list(self._list_shapes(found, str(found["type"]), 0))
        areas = tuple(shape for kind, shapes in drawn if "Polygon" in kind for shape in shapes)
        lines = tuple(line for kind, shapes in drawn if "Line" in kind for shape in shapes for line in shape)
        if not areas and not lines:
            self._refuse(fill("it holds no Polygon, MultiPolygon, LineString or MultiLineString to draw"))
        return Background(self.path.name, areas, lines)

    def _refuse(self, what: Text) -> NoReturn:
        raise InputError(fill("background {name}: {what}", name=self.path.name, what=what))

    def _parse(self) -> Any:
        try:
            with self.path.open("rb") as file:
                data = file.read(MOST_BYTES + 1)
        except OSError as error:
            self._refuse(fill("it cannot be read ({reason})", reason=error.strerror or error))
        if len(data) > MOST_BYTES:
            self._refuse(fill("it has more than {most} MB. Cut it to the area of the map, or simplify it",
                              most=MOST_BYTES // 1_000_000))  # fmt: skip
        try:
            return json.loads(data.decode("utf-8-sig"), parse_constant=self._refuse_constant)
        except UnicodeDecodeError:
            self._refuse(fill("it is not UTF-8 text, so it is not GeoJSON. A shapefile or GeoPackage has to be "
                              "exported as GeoJSON first"))  # fmt: skip
        except json.JSONDecodeError as error:
            self._refuse(fill("line {line}, column {column}: it is not GeoJSON, or the file is cut off ({reason})",
                              line=error.lineno, column=error.colno, reason=error.msg))  # fmt: skip
        except RecursionError:
            self._refuse(fill("its brackets are nested too deep for GeoJSON"))

    def _refuse_constant(self, constant: str) -> NoReturn:
        self._refuse(fill("it holds {constant}, which is not a JSON number. Remove that point", constant=constant))

    def _check_system(self, found: Mapping[str, Any]) -> None:
        """Refuse a file that says that its coordinates are not longitude and latitude."""
        named = found.get("crs")
        if named is not None and not any(one in json.dumps(named) for one in _WORLD):
            self._refuse(fill("its member crs names another system than WGS 84. Export it in longitude and latitude "
                              "(EPSG:4326)"))  # fmt: skip

    def _list_shapes(self, found: Any, where: str, depth: int) -> Iterator[tuple[str, list[Any]]]:
        """Yield each geometry as its kind and its polygons, or its lines as polygons of one ring each."""
        kind = found.get("type") if isinstance(found, dict) else None
        if depth > _DEEPEST:
            self._refuse(fill("{where}: collections are nested too deep", where=where))
        if kind == "FeatureCollection":
            yield from self._list_members(found, "features", where, depth)
        elif kind == "GeometryCollection":
            yield from self._list_members(found, "geometries", where, depth)
        elif kind == "Feature":
            if found.get("geometry") is not None:
                yield from self._list_shapes(found["geometry"], where, depth + 1)
        elif kind in _DIMENSIONS:
            yield str(kind), self._read_shapes(str(kind), found.get("coordinates"), where)
        elif kind not in _NO_DRAWING:
            self._refuse(fill("{where}: {kind} is not a type of GeoJSON", where=where, kind=repr(kind)))

    def _list_members(
        self, found: Mapping[str, Any], name: str, where: str, depth: int
    ) -> Iterator[tuple[str, list[Any]]]:
        members = found.get(name)
        if not isinstance(members, list):
            self._refuse(fill("{where}: {name} is missing, or not a list", where=where, name=name))
        for at, member in enumerate(members):
            yield from self._list_shapes(member, f"{name}[{at}]" if depth == 0 else f"{where}.{name}[{at}]", depth + 1)

    def _read_shapes(self, kind: str, given: Any, where: str) -> list[Any]:
        shapes = given
        for _level in range(3 - _DIMENSIONS[kind]):
            shapes = [shapes]
        least = 4 if "Polygon" in kind else 2
        try:
            return [tuple(self._read_line(line, least, where) for line in shape) for shape in shapes if shape]
        except TypeError:
            self._refuse(fill("{where}: the coordinates are not lists of points as a {kind} has them",
                              where=where, kind=kind))  # fmt: skip

    def _read_line(self, given: Any, least: int, where: str) -> tuple[Place, ...]:
        line = tuple(self._read_point(point, where) for point in given)
        self.points += len(line)
        if self.points > MOST_POINTS:
            self._refuse(fill("it has more than {most:,} points. Cut it to the area of the map, or simplify it",
                              most=MOST_POINTS))  # fmt: skip
        if len(line) < least:
            self._refuse(fill("{where}: a ring or line has {count} points, expected at least {least}",
                              where=where, count=len(line), least=least))  # fmt: skip
        return line

    def _read_point(self, given: Any, where: str) -> Place:
        if not isinstance(given, list) or len(given) < 2 or not all(map(_is_number, given[:2])):
            self._refuse(fill("{where}: {point} is not a point, expected [longitude, latitude]",
                              where=where, point=json.dumps(given)[:60]))  # fmt: skip
        longitude, latitude = float(given[0]), float(given[1])
        if not (abs(longitude) <= 180 and abs(latitude) <= 90):
            self._refuse(fill("{where}: [{longitude:g}, {latitude:g}] is not [longitude, latitude], -180 to 180 and "
                              "-90 to 90. Are these projected metres, or is the order swapped? Export the file in "
                              "WGS 84 (EPSG:4326)", where=where, longitude=longitude, latitude=latitude))  # fmt: skip
        return longitude, latitude


def _is_number(value: Any) -> bool:
    """Tell a number that is finite as a float: JSON allows numbers of any length."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False
