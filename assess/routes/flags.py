"""What must be said of a segment, or of a piece beside it."""

from collections.abc import Mapping

FLAGS: Mapping[str, str] = {
    "segment_assumed": "the workbook names no segment: it counts beside every segment of its route on its floor",
    "edge_assumed": "no Edge distance is given: it is taken to stand at the edge of the route",
    "side_unknown": "named by its Edge distance alone: on which side it stands is not known, so it may face any other",
    "direction_unknown": "neither Axis nor Angle is given: it is taken to fall any way",
    "width_assumed": "no Width is given: its Breadth is taken",
    "nearer_than_plan": "its Edge distance is nearer than its position on the plan says: the distance counts",
    "standing_inside": "it stands in the route with nothing fallen",
    "clear_assumed": "no Clear width is given: it is taken as the required width, so whatever reaches in blocks it",
    "required_assumed": "no Required width is given: 0.9 m is taken",
    "walls_unknown": "no Room is given: placed pieces behind a wall count as well",
    "own_rooms": "placed pieces of other rooms than its own do not count, unless they name it",
    "no_plan": "its places have no positions: only pieces that name it count",
    "between_floors": "its places lie on different floors: only pieces that name it count",
}
"""Cautions on a piece beside a segment and on a segment, by flag."""

BLIND = frozenset(("no_plan", "between_floors"))
"""Flags of segments that the plan tells nothing of."""
