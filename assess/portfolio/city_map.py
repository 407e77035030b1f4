"""The map of a city as SVG: a mark for each building over a coastline, with scale bar, north arrow and graticule.

The projection is equirectangular about the middle latitude: x = R cos(φ0) λ, y = R φ, true to scale along the middle
parallel and along all meridians. Source: Snyder JP (1987). Map projections: a working manual. U.S. Geological Survey
Professional Paper 1395, p. 90-91. doi:10.3133/pp1395
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any, cast

import numpy as np

from assess.errors import InputError
from assess.i18n import fill, gettext as _, number
from assess.motion.site_ground import GroundField
from assess.portfolio.background import Background, Place
from assess.portfolio.city import City, Row
from assess.portfolio.table_schemas import CLASS_COLUMNS, STATE_COLUMNS
from assess.report.words import ANCHORED, ANCHORED_FILL, APART_FILL, BY_FORMULA, INK, UNCONFIRMED, class_name
from assess.risk import LIMITS, RiskClass, classify
from assess.route_results import RouteState
from assess.units import GRAVITY

CIRCLE = "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0-5 0Z"
DIAMOND = "M0-6.5 6.5 0 0 6.5-6.5 0Z"
TRIANGLE = "M0-6.5 6.5 5.2-6.5 5.2Z"
SQUARE = "M-5.4-5.4H5.4V5.4H-5.4Z"
CROSS = "M-5-5 5 5M5-5-5 5"
TICK = "M-5 0-1.5 4 5-5"


@dataclass(frozen=True, slots=True)
class Sign:
    """How a building is marked: `key` in styles and filters, `symbol` in texts, that of the reports, `label` in words.

    `path` is its outline round its centre, as an SVG path [px]; the highest `severity` is drawn last and lies on top.
    One that `is_open` is strokes alone, the outline of one that `is_dashed` stands outside the classes.
    """

    key: str
    symbol: str
    fill: str
    path: str
    severity: int
    label: str
    is_open: bool = False
    is_dashed: bool = False

    @property
    def ink(self) -> str:
        """Colour of its outline, or of its strokes."""
        return self.fill if self.is_open else INK


_SHAPES = {
    RiskClass.LOW: CIRCLE, RiskClass.MEDIUM: DIAMOND, RiskClass.HIGH: TRIANGLE, RiskClass.VERY_HIGH: SQUARE,
}  # fmt: skip
BY_CLASS: Mapping[str, Sign] = {
    "skipped": Sign("skipped", "×", "#3a4045", CROSS, 0, fill("not assessed"), is_open=True),
    "none": Sign("none", "–", "#ffffff", "M-5-1.5H5V1.5H-5Z", 1, fill("no pieces")),
    "anchored": Sign("anchored", ANCHORED, ANCHORED_FILL, CIRCLE, 2, fill("all pieces anchored")),
    "by-formula": Sign("by-formula", BY_FORMULA, APART_FILL, DIAMOND, 3, fill("by formula only"), is_dashed=True),
    "unconfirmed": Sign("unconfirmed", UNCONFIRMED, APART_FILL, CIRCLE, 4, fill("unconfirmed"), is_dashed=True),
} | {
    class_name(risk): Sign(class_name(risk), risk.symbol, risk.fill, _SHAPES[risk], 5 + risk, risk.word)
    for risk in RiskClass
}  # fmt: skip
"""Signs by the worst class of the pieces, in the order in which they are drawn."""
_LOW, _MEDIUM, _HIGH = (f"{100 * limit:g}" for limit in LIMITS)
_BANDS = {
    RiskClass.LOW: fill("below {high} % of its pieces expected to fall", high=_LOW),
    RiskClass.MEDIUM: fill("{low} to {high} % of its pieces expected to fall", low=_LOW, high=_MEDIUM),
    RiskClass.HIGH: fill("{low} to {high} % of its pieces expected to fall", low=_MEDIUM, high=_HIGH),
    RiskClass.VERY_HIGH: fill("{low} % or more of its pieces expected to fall", low=_HIGH),
}
BY_SHARE: Mapping[str, Sign] = {key: BY_CLASS[key] for key in BY_CLASS if key not in map(class_name, RiskClass)} | {
    f"share-{class_name(risk)}": replace(BY_CLASS[class_name(risk)], key=f"share-{class_name(risk)}", label=label)
    for risk, label in _BANDS.items()
}
"""Signs by the share of the pieces that is expected to fall, likewise: its bands have the limits of the classes."""
_ROUTE_SHAPES = {
    RouteState.OPEN: TICK, RouteState.DOUBTFUL: DIAMOND, RouteState.NOT_KNOWN: CIRCLE, RouteState.BLOCKED: SQUARE,
}  # fmt: skip
BY_ROUTES: Mapping[str, Sign] = {
    "skipped": BY_CLASS["skipped"],
    "no-routes": replace(BY_CLASS["none"], key="no-routes", label=fill("no routes")),
} | {
    state.replace(" ", "-"): Sign(
        state.replace(" ", "-"), state.symbol, "#2e7d5b" if state is RouteState.OPEN else state.fill,
        _ROUTE_SHAPES[state], 2 + state.severity, state, is_open=state is RouteState.OPEN,
    )
    for state in sorted(RouteState, key=lambda one: one.severity)
}  # fmt: skip
"""Signs by the worst state of the routes, likewise."""


def find_share(row: Row) -> float | None:
    """Return the share of a building's pieces in the classes that is expected to fall [-]; None where it has none.

    It is rounded to 1e-9: three chances of 0.3 sum up to a hair below 0.9, and belong to the band from 0.3.
    """
    counted = sum(row[column] or 0 for column in CLASS_COLUMNS.values())
    return round(row["expected_falls"] / counted, 9) if counted and row["status"] == "assessed" else None


def sign_of_share(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the share of its pieces that is expected to fall."""
    share = find_share(row)
    risk = None if share is None else classify(share)
    return _sign_without_class(row) if risk is None else BY_SHARE[f"share-{class_name(risk)}"]


def sign_of_class(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the highest class that any of its pieces has."""
    found = next((risk for risk, column in reversed([*CLASS_COLUMNS.items()]) if row[column]), None)
    return _sign_without_class(row) if found is None else BY_CLASS[class_name(found)]


def _sign_without_class(row: Row) -> Sign:
    if row["status"] != "assessed":
        return BY_CLASS["skipped"]
    found = next((column for column in ("unconfirmed", "by_formula", "anchored") if row[column]), "none")
    return BY_CLASS[found.replace("_", "-")]


def sign_of_routes(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the worst state that any of its routes has."""
    if row["status"] != "assessed":
        return BY_ROUTES["skipped"]
    worst_first = sorted(RouteState, key=lambda one: -one.severity)
    found = next((state for state in worst_first if row[STATE_COLUMNS[state]]), "no-routes")
    return BY_ROUTES[found.replace(" ", "-")]


EARTH = 6371.0  # mean radius of the Earth [km]
SEA, GROUND = "#e3ebf1", "#f3f3f0"
"""Colour behind a map with a background, which is water where that has no area, and without one."""
WIDE, LOWEST, HIGHEST = 1000.0, 560.0, 1000.0
"""Width of the drawing, and the least and the most height of it [px]."""
TALLEST = 46.0  # height on a screen at most [rem]
MARGIN, LEAST = 0.07, 1.0  # free space round the buildings: share of their extent, and at least [km]
_STEPS = (1, 2, 5)
_DEGREES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
FINE = 0.4  # detail of the background that is drawn [px]
LEVELS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0)
"""PGA of the lines [g]."""
STEPS = 48
"""Points along each side of the map at which the ground is asked: about the grid of a ShakeMap for a city."""
_EDGE = "#5d6b75"
_THIN = 'stroke="#c3ccd3" stroke-width="0.7" fill="none"'
_SMALL = 'class="degree" fill="#454b51" font-size="11"'
_ISOLINE = 'class="isoline" fill="none" stroke="#7a4fa3" stroke-width="1.2" stroke-dasharray="6 3"'


@dataclass(frozen=True, slots=True)
class MapPoint:
    """One building: its number in the list of buildings, its name, place [deg], sign, and factor on the mark's size."""

    at: int
    name: str
    latitude: float
    longitude: float
    sign: Sign
    size: float = 1.0


@dataclass(frozen=True, slots=True)
class Isoline:
    """A line of equal PGA: what is written on it, and its longitudes and latitudes [deg]."""

    label: str
    line: tuple[Place, ...]


@dataclass(frozen=True, slots=True)
class Frame:
    """What is shown: longitude of the left edge, latitude of the upper one [deg], scale [px/km], size [px]."""

    west: float
    north: float
    middle: float
    scale: float
    wide: float
    high: float

    @property
    def per_degree(self) -> tuple[float, float]:
        """Pixels a degree of longitude and of latitude."""
        degree = math.radians(1) * EARTH * self.scale
        return degree * _shorten(self.middle), degree

    def place(self, longitude: float, latitude: float) -> tuple[float, float]:
        """Return where a place lies in the drawing [px]; longitudes count from the left edge round the globe."""
        across, down = self.per_degree
        east = (longitude - self.west + 180) % 360 - 180
        return east * across, (self.north - latitude) * down


def build_frame(places: Sequence[Place]) -> Frame:
    """Return what to show so that all places are in it; those on both sides of the date line stay together."""
    longitudes, latitudes = [place[0] for place in places], [place[1] for place in places]
    if max(longitudes) - min(longitudes) > 180:
        longitudes = [one + 360 if one < 0 else one for one in longitudes]  # west of the date line: a turn further
    south, north = min(latitudes), max(latitudes)
    middle = (south + north) / 2
    degree = math.radians(1) * EARTH
    along = degree * _shorten(middle)
    sizes = [(max(longitudes) - min(longitudes)) * along, (north - south) * degree]
    wide, high = (max(size * (1 + 2 * MARGIN), size + 2 * LEAST) for size in sizes)
    wide = max(wide, high * WIDE / HIGHEST)
    high = max(high, wide * LOWEST / WIDE)
    west = (min(longitudes) + max(longitudes)) / 2 - wide / along / 2
    return Frame((west + 180) % 360 - 180, middle + high / degree / 2, middle, WIDE / wide, WIDE, high * WIDE / wide)


def _shorten(latitude: float) -> float:
    """Return the length of a degree of longitude over one of latitude; near a pole that of 85 deg, for a finite map."""
    return math.cos(math.radians(min(abs(latitude), 85.0)))


def draw_map(
    points: Sequence[MapPoint], background: Background | None, *, title: str, isolines: Sequence[Isoline] = (),
    is_live: bool = False,
) -> str:  # fmt: skip
    """Return the map as an SVG element, the worst of the points on top; "" where no building has a place.

    `title` is the text alternative; where `is_live`, marks carry their place and number for the page's script.
    """
    if not points:
        return ""
    frame = build_frame([(one.longitude, one.latitude) for one in points])
    name, colour = ("sea", SEA) if background else ("ground", GROUND)  # without a background nothing is known of water
    parts = [
        f'<rect class="{name}" width="{frame.wide:g}" height="{frame.high:.1f}" fill="{colour}"/>',
        *(_draw_background(background, frame) if background else ()),
        *_draw_graticule(frame),
    ]
    for isoline in isolines:
        line = [frame.place(*place) for place in isoline.line]
        path = " ".join(f"{x:.1f} {y:.1f}" for x, y in line)
        parts.append(f'<path {_ISOLINE} d="M{path}"/>')
        inside = [(x, y) for x, y in line if 40 < x < frame.wide - 60 and 30 < y < frame.high - 50]
        if len(inside) > 6:
            x, y = inside[len(inside) // 2]
            said = escape(isoline.label)
            at = f'x="{x:.1f}" y="{y:.1f}" text-anchor="middle" font-weight="bold" font-size="11"'
            # a white copy behind, as not every program draws the outline of letters behind them
            halo = f'<text class="halo" {at} stroke="#ffffff" stroke-width="3" aria-hidden="true">{said}</text>'
            parts.append(f'{halo}<text class="isoline" {at} fill="#5c3a80">{said}</text>')
    parts.append('<g class="marks">')
    for one in sorted(points, key=lambda point: (point.sign.severity, -point.size, point.at)):
        x, y = frame.place(one.longitude, one.latitude)
        size = f" scale({one.size:g})" if one.size != 1 else ""
        live = f' data-at="{one.at}" data-x="{x:.1f}" data-y="{y:.1f}" data-size="{one.size:g}"' if is_live else ""
        said = "" if is_live else f"<title>{escape(one.name)}</title>"
        parts.append(f'<g transform="translate({x:.1f} {y:.1f}){size}"{live}>{draw_sign(one.sign)}{said}</g>')
    length, x, said = find_bar(frame), frame.wide - 28, _("N")
    long, y = length * frame.scale, frame.high - 18
    scale = (
        _("{length} km", length=number(length, "g")) if length >= 1 else _("{length} m", length=f"{1000 * length:g}")
    )
    parts += [
        "</g>",
        f'<g class="scale-bar" data-km="{length:g}">'
        f'<rect x="10" y="{y - 22:.1f}" width="{long + 24:.1f}" height="32" fill="#ffffff" fill-opacity="0.85"/>'
        f'<path d="M22 {y - 5:.1f}V{y:.1f}H{22 + long:.1f}V{y - 5:.1f}" fill="none" stroke="#1c1c1c" stroke-width="2"/>'
        f'<text x="{22 + long / 2:.1f}" y="{y - 8:.1f}" text-anchor="middle" fill="#1c1c1c">{scale}</text></g>',
        f'<g class="north"><rect x="{x - 16:g}" y="8" width="32" height="48" fill="#ffffff" fill-opacity="0.85"/>'
        f'<path d="M{x:g} 12L{x + 8:g} 34L{x:g} 29L{x - 8:g} 34Z" fill="#1c1c1c"/>'
        f'<text x="{x:g}" y="51" text-anchor="middle" font-weight="bold" fill="#1c1c1c">{said}</text></g>',
    ]
    role = "group" if is_live else "img"
    widest = f"max-width: {TALLEST * frame.wide / frame.high:.1f}rem"
    return (
        f'<svg class="city-map" role="{role}" aria-label="{escape(title)}" style="{widest}; background: {colour}" '
        f'viewBox="0 0 {frame.wide:g} {frame.high:.1f}" font-family="Report, sans-serif" font-size="13">'
        f"{''.join(parts)}</svg>"
    )


def _draw_background(background: Background, frame: Frame) -> Iterable[str]:
    import shapely

    box = shapely.box(-4, -4, frame.wide + 4, frame.high + 4)

    def fit(shape: "shapely.Geometry") -> "shapely.Geometry":
        cut = shapely.intersection(shapely.make_valid(shape), box)
        return shapely.simplify(cut, FINE)

    areas = []
    for area in background.areas:
        outer, *holes = ([frame.place(*one) for one in ring] for ring in area)
        areas.append(fit(shapely.Polygon(outer, holes)))
    outline = "".join(_write_path(shape, "Polygon") for shape in areas)
    if outline:
        yield f'<path class="land" d="{outline}" fill="#fbfaf7" stroke="{_EDGE}" stroke-width="1" fill-rule="evenodd"/>'
    drawn = [fit(shapely.LineString([frame.place(*one) for one in line])) for line in background.lines]
    lines = "".join(_write_path(shape, "LineString") for shape in drawn)
    if lines:
        yield f'<path class="lines" d="{lines}" fill="none" stroke="{_EDGE}" stroke-width="1"/>'


def _write_path(shape: "shapely.Geometry", kind: str) -> str:  # type: ignore[name-defined]  # noqa: F821
    import shapely

    found = [one for one in shapely.get_parts(shape) if one.geom_type == kind and not one.is_empty]
    rings = [ring for one in found for ring in ((one.exterior, *one.interiors) if kind == "Polygon" else (one,))]
    end = "Z" if kind == "Polygon" else ""
    return "".join(f"M{' '.join(f'{x:.1f} {y:.1f}' for x, y in ring.coords)}{end}" for ring in rings)


def _draw_graticule(frame: Frame) -> Iterable[str]:
    step = next((one for one in _DEGREES if frame.wide / frame.per_degree[0] / one >= 3), _DEGREES[-1])
    decimals = max(0, 1 - math.floor(math.log10(step))) if step < 1 else 0
    across, down = frame.per_degree
    first = math.ceil(frame.west / step)
    for at in range(first, first + math.floor(frame.wide / across / step) + 1):
        x = (at * step - frame.west) * across
        if 30 < x < frame.wide - 60:
            said = _say_degree((at * step + 180) % 360 - 180, decimals, "EW")
            yield f'<path d="M{x:.1f} 0V{frame.high:.1f}" {_THIN}/><text x="{x + 3:.1f}" y="13" {_SMALL}>{said}</text>'
    first = math.ceil((frame.north - frame.high / down) / step)
    for at in range(first, first + math.floor(frame.high / down / step) + 1):
        y = (frame.north - at * step) * down
        if 24 < y < frame.high - 24:
            said = _say_degree(at * step, decimals, "NS")
            yield f'<path d="M0 {y:.1f}H{frame.wide:g}" {_THIN}/><text x="4" y="{y - 3:.1f}" {_SMALL}>{said}</text>'


def _say_degree(value: float, decimals: int, sides: str) -> str:
    side = "" if abs(value) < 1e-9 else sides[value < 0]
    return f"{number(abs(value), f'.{decimals}f')}° {side}".strip()


def draw_sign(sign: Sign) -> str:
    """Return the mark of a building round its centre, with a light edge so that marks beside it stay apart."""
    if sign.is_open:
        return (
            f'<path d="{sign.path}" fill="none" stroke="#ffffff" stroke-width="6"/>'
            f'<path d="{sign.path}" fill="none" stroke="{sign.ink}" stroke-width="3"/>'
        )
    dash = ' stroke-dasharray="2.5 1.8"' if sign.is_dashed else ""
    return f'<path d="{sign.path}" fill="{sign.fill}" stroke="{sign.ink}" stroke-width="1.2"{dash}/>'


def find_bar(frame: Frame) -> float:
    """Return the length of the scale bar [km]: 1, 2 or 5 times a power of ten, a quarter of the width at most."""
    most = frame.wide / frame.scale / 4
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in _STEPS if step * power <= most)


def list_isolines(city: City, ground: GroundField | None) -> tuple[Isoline, ...]:
    """Return lines of equal PGA over the map of a city, where a ShakeMap covers it; none without one."""
    placed = city.buildings[["longitude", "latitude"]].dropna().astype("float64")
    if ground is None or city.ground is None or city.ground.kind != "shakemap" or placed.empty:
        return ()
    from contourpy import contour_generator

    frame = build_frame([(longitude, latitude) for longitude, latitude in placed.to_numpy().tolist()])
    across, down = frame.per_degree
    longitudes = frame.west + np.linspace(0, frame.wide / across, STEPS)
    latitudes = frame.north - np.linspace(0, frame.high / down, STEPS)

    def find_pga(latitude: float, longitude: float) -> float:
        try:
            return ground.at(latitude, (longitude + 180) % 360 - 180).pga / GRAVITY
        except InputError:  # it is not known there
            return math.nan

    values = [[find_pga(float(latitude), float(longitude)) for longitude in longitudes] for latitude in latitudes]
    lines = contour_generator(longitudes, latitudes, np.ma.masked_invalid(np.array(values)))
    return tuple(
        Isoline(_("{pga} g", pga=number(level, "g")), tuple((float(x), float(y)) for x, y in line))
        for level in LEVELS
        for line in cast(list[Any], lines.lines(level))
        if len(line) > 1
    )
