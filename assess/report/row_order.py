"""The order of floors and of rows in the reports; the data files keep that of the workbook."""

from collections.abc import Sequence

from assess.natural import natural_key
from assess.results import FloorRow, ItemResult


def order_floors(floors: Sequence[FloorRow]) -> list[FloorRow]:
    """Return floors by elevation where all have one, from the top or from the ground as the workbook begins.

    Where an elevation is missing, they stay in the order of the workbook.
    """
    heights = [floor.elevation_m for floor in floors if floor.elevation_m is not None]
    if len(heights) < len(floors) or not heights:
        return list(floors)
    return sorted(floors, key=lambda floor: floor.elevation_m or 0.0, reverse=heights[0] > heights[-1])


def order_rows(rows: Sequence[ItemResult], floors: Sequence[str]) -> list[ItemResult]:
    """Return the rows of Items floor by floor in natural order of their names, with identical rows together.

    Identical rows have the same floor, description, type, sizes and class; they stand where the first of them does.

    Parameters
    ----------
    rows : sequence of ItemResult
        In any order.
    floors : sequence of str
        Names of the floors in their order.
    """
    rank = {floor: at for at, floor in enumerate(floors)}
    groups: dict[tuple[object, ...], list[ItemResult]] = {}
    for one in rows:
        groups.setdefault(find_kind(one), []).append(one)
    for own in groups.values():
        own.sort(key=_by_name)
    ordered = sorted(groups.values(), key=lambda own: (rank[own[0].item.floor], _by_name(own[0])))
    return [one for own in ordered for one in own]


def by_chance(one: ItemResult) -> tuple[object, ...]:
    """Return what sorts rows by their class and chance, the worst first, then by name."""
    return -one.adopted.upper, -one.adopted.probability, natural_key(one.item.item)


def find_kind(one: ItemResult) -> tuple[object, ...]:
    """Return what identical rows share: floor, description, type, sizes, anchoring and class."""
    item, adopted = one.item, one.adopted
    sizes = (item.breadth_cm, item.width_cm, item.height_cm)
    return item.floor, item.description, item.type, sizes, one.is_anchored, one.apart, adopted.risk, adopted.upper


def _by_name(one: ItemResult) -> tuple[object, ...]:
    return natural_key(one.item.item)
