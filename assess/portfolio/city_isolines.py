"""Lines of equal PGA of the ground, for the map of a city under a ShakeMap."""

import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from assess.errors import InputError
from assess.i18n import gettext as _
from assess.i18n import number
from assess.motion.site_ground import GroundField
from assess.portfolio.background import Place
from assess.portfolio.city import City
from assess.portfolio.city_map import Isoline, build_frame
from assess.units import GRAVITY

LEVELS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0)
"""PGA of the lines [g]."""
STEPS = 48
"""Points along each side of the map at which the ground is asked: about the grid of a ShakeMap for a city."""


def list_isolines(city: City, ground: GroundField | None) -> tuple[Isoline, ...]:
    """Return the lines for the map of a city; none without a ShakeMap."""
    if ground is None or city.ground is None or city.ground.kind != "shakemap":
        return ()
    placed = city.buildings[["longitude", "latitude"]].dropna().astype("float64")
    return build_isolines(ground, [(longitude, latitude) for longitude, latitude in placed.to_numpy().tolist()])


def build_isolines(ground: GroundField, places: Sequence[Place]) -> tuple[Isoline, ...]:
    """Return lines of equal PGA over what a map of these places shows, where the ground motion covers it.

    Parameters
    ----------
    ground : GroundField
        What gives the PGA at a place.
    places : sequence of places
        Longitudes and latitudes of the buildings [deg].
    """
    if not places:
        return ()
    from contourpy import contour_generator

    frame = build_frame(places)
    across, down = frame.per_degree
    longitudes = frame.west + np.linspace(0, frame.wide / across, STEPS)
    latitudes = frame.north - np.linspace(0, frame.high / down, STEPS)
    values = [
        [_find_pga(ground, float(latitude), float(longitude)) for longitude in longitudes] for latitude in latitudes
    ]
    lines = contour_generator(longitudes, latitudes, np.ma.masked_invalid(np.array(values)))
    return tuple(
        Isoline(_("{pga} g", pga=number(level, "g")), tuple((float(x), float(y)) for x, y in line))
        for level in LEVELS
        for line in cast(list[Any], lines.lines(level))
        if len(line) > 1
    )


def _find_pga(ground: GroundField, latitude: float, longitude: float) -> float:
    """Return the PGA at a place [g], NaN where it is not known."""
    try:
        return ground.at(latitude, (longitude + 180) % 360 - 180).pga / GRAVITY
    except InputError:
        return math.nan
