"""Names in the inventory of what a building model holds: floors, places, items, types; each its own."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from assess.bim.building_model import BuildingModel, Door, Piece, Space, Stair, Storey
from assess.bim.door_sides import find_kinds, find_sides
from assess.bim.import_workbook import name_apart
from assess.i18n import fill, gettext
from assess.natural import natural_key
from assess.workbook.names import key

Names = Mapping[str, str]
"""Names by key."""


def name_floors(storeys: Sequence[Storey]) -> dict[str, str]:
    """Return the names of floors by the keys of their storeys."""
    return dict(zip((one.key for one in storeys), name_apart(one.name for one in storeys), strict=True))


def name_places(model: BuildingModel, floors: Names) -> dict[str, str]:
    """Return the names of rooms, doors and ends of stairs: of `floors` alone.

    Keys are those of rooms and doors, and of stairs with their end: ``KEY foot``.
    """
    spaces = [one for one in model.spaces if one.storey in floors]
    doors = [one for one in model.doors if one.storey in floors]
    stairs = [one for one in model.stairs if one.storey in floors]
    keys = [*(one.key for one in spaces), *(one.key for one in doors), *(f"{one.key} {one.end}" for one in stairs)]
    short = {one.key: label for one, label in zip(spaces, _label(spaces, floors), strict=True)}
    rooms = [f"{short[one.key]} {one.title}".strip() for one in spaces]
    names = [*rooms, *_name_doors(model, doors, short, floors), *_name_stairs(stairs, floors)]
    return dict(zip(keys, name_apart(names), strict=True))


def _label(spaces: Iterable[Space], floors: Names) -> list[str]:
    """Return the short name of each room; with its floor where other floors have a room of that name."""
    listed = list(spaces)
    counts = Counter(key(one.name) for one in listed)
    return [
        one.name if one.name and counts[key(one.name)] == 1 else f"{floors[one.storey]} {one.name}".strip()
        for one in listed
    ]


def _name_doors(model: BuildingModel, doors: Iterable[Door], short: Names, floors: Names) -> Iterator[str]:
    sides, kinds = find_sides(model), find_kinds(model)
    for one in doors:
        rooms = " / ".join(sorted({short[side] for side in sides[one.key] if side in short}, key=natural_key))
        rooms = rooms or floors[one.storey]
        is_exit = kinds[one.key] == "exit"
        yield gettext("Exit {room}", room=rooms) if is_exit else gettext("Door {rooms}", rooms=rooms)


def _name_stairs(stairs: Iterable[Stair], floors: Names) -> Iterator[str]:
    ends = {"foot": fill("foot"), "head": fill("head")}
    for one in stairs:
        yield gettext("Stair {floor}, {end}", floor=floors[one.storey], end=gettext(ends[one.end]))


def sort_pieces(pieces: Iterable[Piece], storeys: Sequence[Storey], places: Names) -> list[Piece]:
    """Return pieces by storey, room and type, as people look for them; those in no room last."""
    order = {one.key: at for at, one in enumerate(storeys)}

    def place(one: Piece) -> tuple[Any, ...]:
        room = not one.space, natural_key(places.get(one.space, ""))
        return order[one.storey], *room, natural_key(one.type), one.x, one.y

    return sorted(pieces, key=place)


def name_items(pieces: Sequence[Piece], spaces: Mapping[str, Space], floors: Names) -> list[str]:
    """Return names such as ``A203-02``: the room, or else the floor, and a number in it."""
    numbers: Counter[str] = Counter()
    found = []
    rooms = Counter(key(one.name) for one in spaces.values())
    for one in pieces:
        room = spaces.get(one.space)
        at = room.name if room is not None and room.name and rooms[key(room.name)] == 1 else floors[one.storey]
        numbers[key(at)] += 1
        found.append(f"{at}-{numbers[key(at)]:02}")
    return name_apart(found)
