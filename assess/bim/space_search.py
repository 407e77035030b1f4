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

        `points`: in plan [m].
        `reach`: how far a space may be from a point that it holds [m].
        """
        found: list[list[int]] = [[] for _ in points]
        places = [shapely.Point(one) for one in points]
        hits = self._tree.query(places, predicate="dwithin", distance=reach)
        for at, space in zip(*hits.tolist(), strict=True):
            found[at].append(space)
        return [[self.spaces[at] for at in sorted(own, key=lambda one: (self._sizes[one], one))] for own in found]


def find_rooms_at(places: Sequence[tuple[str, Point]], spaces: Sequence[Space]) -> list[Space | None]:
    """Return the smallest space that holds each place, None where there is none.

    `places`: key of the storey, and point in plan [m].
    `spaces`: those of all storeys.
    """
    found: list[Space | None] = [None] * len(places)
    for storey in {key for key, _ in places}:
        own = [at for at, (key, _) in enumerate(places) if key == storey]
        search = SpaceSearch([one for one in spaces if one.storey == storey])
        for at, rooms in zip(own, search.find_all([places[one][1] for one in own]), strict=True):
            found[at] = rooms[0] if rooms else None
    return found
