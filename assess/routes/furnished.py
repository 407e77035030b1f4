"""In which rooms of a building furniture is listed: ways through the others count as free of it."""

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Sequence

from assess.errors import Problem
from assess.i18n import fill, nfill
from assess.model import Inventory, Item, Place
from assess.workbook.names import key

ROOMS = ("room", "corridor")
"""Kinds of places in which furniture may stand."""


def list_rooms_to_furnish(inventory: Inventory) -> tuple[Place, ...]:
    """Return the rooms and corridors of Places."""
    return tuple(one for one in inventory.places if one.kind in ROOMS)


def list_unfurnished(inventory: Inventory) -> tuple[Place, ...]:
    """Return the rooms and corridors of Places in which no furniture is listed.

    A room has the pieces of its name, else those of the Room of the segments that begin or end there, and those that
    stand inside its outline. A row of furniture of which nothing tells the room counts as the only one of a room.
    """
    taken = {(item.floor, key(item.room)) for item in inventory.items if item.room}
    names = _list_names(inventory)
    left = [
        one
        for one in list_rooms_to_furnish(inventory)
        if not any((one.floor, name) in taken for name in names[one.place])
    ]
    inside = _find_inside(left, inventory.items)
    loose = Counter(item.floor for item in inventory.items if not item.room and (item.x is None or item.y is None))
    return tuple(_leave_out(loose, [one for at, one in enumerate(left) if at not in inside]))


def find_unfurnished(inventory: Inventory) -> Iterator[Problem]:
    """Warn, once a workbook, of rooms in which no furniture is listed; without any, all routes are not known."""
    found, count = list_unfurnished(inventory), len(list_rooms_to_furnish(inventory))
    if found and inventory.items:
        message = nfill(
            "No furniture is listed in {room}, the only room or corridor of Places: ways through it count as free of "
            "furniture.",
            "Furniture is listed in {listed:,} of {n:,} rooms and corridors of Places, not in {room}: ways through the "
            "others count as free of furniture.",
            count,
            listed=count - len(found),
            room=found[0].place,
        )
        cell = f"{inventory.letters.get('Places', {}).get('place', 'A')}{found[0].row}"
        yield Problem("warning", "Places", cell, message, fill("List the furniture of every room on the way."))


def _leave_out(loose: Counter[str], rooms: Sequence[Place]) -> Iterator[Place]:
    """Yield rooms but for the first of each floor, as many as there are rows of unknown room."""
    left = loose.copy()
    for one in rooms:
        if left[one.floor] > 0:
            left[one.floor] -= 1
        else:
            yield one


def _list_names(inventory: Inventory) -> dict[str, Collection[str]]:
    """Return by place the names that pieces may give as its room."""
    named: dict[str, set[str]] = defaultdict(set)
    for segment in inventory.routes:
        for place in (segment.start, segment.end):
            named[place].update(key(room) for room in segment.rooms)
    own = {one.place: key(one.place) for one in inventory.places}
    return {place: {name} if name in named[place] else {name, *named[place]} for place, name in own.items()}


def _find_inside(rooms: Sequence[Place], items: Sequence[Item]) -> set[int]:
    """Return the rooms (indices) in whose outline a piece stands."""
    outlined = [at for at, one in enumerate(rooms) if one.outline]
    placed = [(one.floor, (one.x, one.y)) for one in items if one.x is not None and one.y is not None]
    if not outlined or not placed:
        return set()
    from shapely import Point, Polygon, STRtree

    tree = STRtree([Point(at) for _floor, at in placed])
    pairs = tree.query([Polygon(rooms[at].outline) for at in outlined], predicate="covers").T.tolist()
    return {outlined[at] for at, piece in pairs if rooms[outlined[at]].floor == placed[piece][0]}
