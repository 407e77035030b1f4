"""What placed pieces cover on the plan: standing, and fallen one way or another."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from assess.inventory.model import Item
from assess.routes.footprint import fallen, rectangle, turn

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One placed piece: what it covers standing, what each way of falling adds, and all of that together."""

    standing: "BaseGeometry"
    falls: tuple["BaseGeometry", ...]
    everything: "BaseGeometry"
    flags: tuple[str, ...]


def build_shapes(items: Sequence[Item], floors: Collection[str]) -> dict[int, Shape]:
    """Return the shapes of the pieces on some floors that have a position, by their index."""
    placed = ((at, item, item.x, item.y) for at, item in enumerate(items) if item.floor in floors)
    return {at: _shape(item, (x, y)) for at, item, x, y in placed if x is not None and y is not None}


def _shape(item: Item, at: tuple[float, float]) -> Shape:
    from shapely import Polygon, union_all

    across, turns = item.width or item.breadth, tuple(_turns(item))
    standing = union_all([Polygon(rectangle(at, a, (-item.breadth / 2, item.breadth / 2), across)) for a in turns])
    falls = [Polygon(one) for a in turns for one in fallen(at, a, item.breadth, across, item.height)]
    flags = (
        *(["direction_unknown"] if len(turns) > 1 else []),
        *(["width_assumed"] if item.width is None else []),
    )
    return Shape(standing, tuple(falls), union_all([standing, *falls]), flags)


def _turns(item: Item) -> Iterator[float]:
    """Yield the directions of Breadth that are possible: both axes where neither Axis nor Angle is given."""
    yield turn(item)
    if item.axis is None and item.angle_deg is None:
        yield turn(item) + 90.0
