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
from assess.i18n import fill

MOST_BYTES = 20_000_000
MOST_POINTS = 400_000  # points of a file that are read: a map of a city needs no more
Place = tuple[float, float]  # longitude and latitude [deg]
_DEEPEST = 8  # depth to which collections may hold collections
_WORLD = ("CRS84", "4326")
_DIMENSIONS = {"LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
_MEMBERS = {"FeatureCollection": "features", "GeometryCollection": "geometries"}
_NO_DRAWING = ("Point", "MultiPoint")


@dataclass(frozen=True, slots=True)
class Background:
    """What lies behind the points of a map: polygons, each its outline, then its holes, and lines."""

    file: str
    areas: tuple[tuple[tuple[Place, ...], ...], ...] = ()
    lines: tuple[tuple[Place, ...], ...] = ()


def read_background(path: Path) -> Background:
    """Read a GeoJSON file with polygons or lines; InputError, with the place in the file, if it cannot be used."""
    try:
        found = _parse(path)
        drawn = list(_list_shapes(found, str(found["type"]), 0))
        areas = tuple(shape for kind, shapes in drawn if "Polygon" in kind for shape in shapes)
        lines = tuple(line for kind, shapes in drawn if "Line" in kind for shape in shapes for line in shape)
        if sum(map(len, lines)) + sum(len(ring) for area in areas for ring in area) > MOST_POINTS:
            raise InputError(
                fill("it has more than {most:,} points. Cut it to the area of the map, or simplify it",
                     most=MOST_POINTS)
            )  # fmt: skip
        if not areas and not lines:
            raise InputError(fill("it holds no Polygon, MultiPolygon, LineString or MultiLineString to draw"))
    except InputError as error:
        raise InputError(fill("background {name}: {what}", name=path.name, what=error.message)) from None
    return Background(path.name, areas, lines)


def _parse(path: Path) -> Mapping[str, Any]:
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise InputError(fill("it cannot be read ({reason})", reason=error.strerror or error)) from None
    if len(data) > MOST_BYTES:
        raise InputError(fill("it has more than {most} MB. Cut it to the area of the map, or simplify it",
                              most=MOST_BYTES // 1_000_000))  # fmt: skip
    try:
        found = json.loads(data.decode("utf-8-sig"), parse_constant=_refuse_constant)
    except UnicodeDecodeError:
        what = fill("it is not UTF-8 text, so it is not GeoJSON. A shapefile or GeoPackage has to be exported as "
                    "GeoJSON first")  # fmt: skip
    except json.JSONDecodeError as error:
        what = fill("line {line}, column {column}: it is not GeoJSON, or the file is cut off ({reason})",
                    line=error.lineno, column=error.colno, reason=error.msg)  # fmt: skip
    except RecursionError:
        what = fill("its brackets are nested too deep for GeoJSON")
    else:
        if not isinstance(found, dict) or not isinstance(found.get("type"), str):
            raise InputError(fill("it is not GeoJSON: a FeatureCollection, Feature or geometry is expected at its top"))
        named = found.get("crs")
        if named is not None and not any(one in json.dumps(named) for one in _WORLD):
            raise InputError(fill("its member crs names another system than WGS 84. Export it in longitude and "
                                  "latitude (EPSG:4326)"))  # fmt: skip
        return found
    raise InputError(what)


def _refuse_constant(constant: str) -> NoReturn:
    raise InputError(fill("it holds {constant}, which is not a JSON number. Remove that point", constant=constant))


def _list_shapes(found: Any, where: str, depth: int) -> Iterator[tuple[str, list[Any]]]:
    """Yield each geometry as its kind and its polygons, or its lines as polygons of one ring each."""
    named = found.get("type") if isinstance(found, dict) else None
    kind = named if isinstance(named, str) else ""
    if depth > _DEEPEST:
        raise InputError(fill("{where}: collections are nested too deep", where=where))
    if kind in _MEMBERS:
        name = _MEMBERS[kind]
        if not isinstance(found.get(name), list):
            raise InputError(fill("{where}: {name} is missing, or not a list", where=where, name=name))
        for at, member in enumerate(found[name]):
            yield from _list_shapes(member, f"{name}[{at}]" if depth == 0 else f"{where}.{name}[{at}]", depth + 1)
    elif kind == "Feature":
        if found.get("geometry") is not None:
            yield from _list_shapes(found["geometry"], where, depth + 1)
    elif kind in _DIMENSIONS:
        shapes = found.get("coordinates")
        for _level in range(3 - _DIMENSIONS[kind]):
            shapes = [shapes]
        least, drawn = 4 if "Polygon" in kind else 2, []
        try:
            for shape in filter(None, shapes):
                lines = []
                for given in shape:
                    line = tuple(_read_point(point, where) for point in given)
                    if len(line) < least:
                        raise InputError(fill("{where}: a ring or line has {count} points, expected at least {least}",
                                              where=where, count=len(line), least=least))  # fmt: skip
                    lines.append(line)
                drawn.append(tuple(lines))
        except TypeError:
            raise InputError(
                fill("{where}: the coordinates are not lists of points as a {kind} has them", where=where, kind=kind)
            ) from None
        yield kind, drawn
    elif kind not in _NO_DRAWING:
        raise InputError(fill("{where}: {kind} is not a type of GeoJSON", where=where, kind=repr(named)))


def _read_point(given: Any, where: str) -> Place:
    try:
        longitude, latitude = (float(one) for one in given[:2] if type(one) in (int, float))
        is_point = isinstance(given, list) and math.isfinite(longitude) and math.isfinite(latitude)
    except (TypeError, ValueError, OverflowError):  # JSON allows numbers of any length
        is_point = False
    if not is_point:
        raise InputError(fill("{where}: {point} is not a point, expected [longitude, latitude]",
                              where=where, point=json.dumps(given)[:60]))  # fmt: skip
    if not (abs(longitude) <= 180 and abs(latitude) <= 90):
        raise InputError(
            fill("{where}: [{longitude:g}, {latitude:g}] is not [longitude, latitude], -180 to 180 and -90 to 90. Are "
                 "these projected metres, or is the order swapped? Export the file in WGS 84 (EPSG:4326)",
                 where=where, longitude=longitude, latitude=latitude)
        )  # fmt: skip
    return longitude, latitude
