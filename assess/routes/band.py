"""Segments as bands on the plan: straight, as wide as they are clear, in coordinates of their own."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.inventory.model import Inventory, Segment
from assess.routes.footprint import Point

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


@dataclass(frozen=True, slots=True)
class Band:
    """A straight band.

    Parameters
    ----------
    start, end : (2,) floats
        Where its centre line begins and ends [m].
    before, behind : float
        How far it goes on beyond them [m], round a bend.
    width : float
        [m]
    """

    start: Point
    end: Point
    before: float
    behind: float
    width: float

    @property
    def length(self) -> float:
        """From start to end [m]."""
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))

    def outline(self) -> "BaseGeometry":
        """Return the band in its own coordinates: along it from its start, and across it from its centre line."""
        from shapely import box

        return box(-self.before, -self.width / 2, self.length + self.behind, self.width / 2)

    def ground(self) -> "BaseGeometry":
        """Return the ground on the plan that holds the band."""
        from shapely import LineString

        return LineString([self.start, self.end]).buffer(
            self.width / 2 + max(self.before, self.behind), cap_style="square"
        )

    def turn_in(self, shape: "BaseGeometry") -> "BaseGeometry":
        """Return a shape of the plan in the band's own coordinates."""
        import shapely

        along = (np.array(self.end) - self.start) / self.length

        def local(points: NDArray[np.float64]) -> NDArray[np.float64]:
            away = points - self.start
            return np.column_stack((away @ along, away @ (-along[1], along[0])))

        return shapely.transform(shape, local)


def build_bands(inventory: Inventory, clear: Mapping[int, float]) -> dict[int, Band]:
    """Return the bands of the segments (by their index) whose places both have a position on the segment's floor.

    Where just two segments meet at a place, each goes on by half the other's width, so that the bend belongs to both.
    `clear` are the clear widths of all segments [m].
    """
    places = {place.place: place for place in inventory.places if place.x is not None and place.y is not None}

    def placed(segment: Segment) -> bool:
        ends = (places.get(segment.start), places.get(segment.end))
        return all(end is not None and end.floor == segment.floor for end in ends)

    found = {at: one for at, one in enumerate(inventory.routes) if placed(one)}
    meet = Counter(place for one in found.values() for place in (one.start, one.end))

    def beyond(at: int, place: str) -> float:
        others = _others(found, at, place) if meet[place] == 2 else ()
        return max((clear[other] / 2 for other in others), default=0.0)

    def point(name: str) -> Point:
        place = places[name]
        return float(place.x or 0.0), float(place.y or 0.0)

    return {
        at: Band(point(one.start), point(one.end), beyond(at, one.start), beyond(at, one.end), clear[at])
        for at, one in found.items()
    }


def _others(found: Mapping[int, Segment], at: int, place: str) -> Sequence[int]:
    return [other for other, one in found.items() if other != at and place in (one.start, one.end)]
