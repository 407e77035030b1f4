"""Which room holds a point of a plan: of rooms that overlap, the smallest.

Some programs export the gross area of a storey, or a zone, as a space beside its rooms, and before them.
"""

from collections.abc import Sequence

import shapely

from assess.bim.building_model import Point, Space
from assess.bim.plan_shapes import to_polygon


class SpaceSearch:
    """Finds the spaces that hold points, among `spaces` in their order."""

    def __init__(self, spaces: Sequence[Space]) -> None:
        self.spaces = spaces
        polygons = [to_polygon(one.area) for one in spaces]
        self._tree = shapely.STRtree(polygons)
        self._sizes = [one.area for one in polygons]

    def find_all(self, points: Sequence[Point], reach: float = 0.0) -> list[list[Space]]:
        """Return the spaces that hold each point, the smallest first; of those that are as large the first.

        Parameters
        ----------
        points : sequence of Point
            In plan [m].
        reach : float
            How far a space may be from a point that it holds [m].
        """
        found: list[list[int]] = [[] for _ in points]
        places = [shapely.Point(one) for one in points]
        hits = self._tree.query(places, predicate="dwithin", distance=reach)
        for at, space in zip(*hits.tolist(), strict=True):
            found[at].append(space)
        return [[self.spaces[at] for at in sorted(own, key=lambda one: (self._sizes[one], one))] for own in found]
