"""Rooms of the furniture: a slip in one keeps a piece away from the segments of the right one."""

import difflib
import re
from collections.abc import Iterable, Mapping

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.names import defined_names
from assess.inventory.positions import count_pieces
from assess.inventory.tables import Row, Table
from assess.language import fill, nfill

NEAR, NEAR_WORD = 0.75, 0.8
"""From these ratios on a name may be a slip of another, and one word of several a slip of another [-]."""
MOST = 10
"""So many near names are gone through."""


def check_room_names(tables: Mapping[str, Table]) -> None:
    """Warn, once a name, of a room of no segment that is nearly one of a segment of the same floor.

    Rooms of Routes that have no pieces are left out: it is there that their slip has been told.
    """
    items, routes = tables["Items"], tables["Routes"]
    known = defined_names(tables["Places"], "place")
    stood_in = known.keys() | defined_names(items, "room").keys()
    every: dict[str, dict[str, str]] = {}
    for row in routes.rows:
        for name in split_rooms(row):
            every.setdefault(routes.sound("floor", row) or "", {}).setdefault(key(name), name)
    used = {room for rooms in every.values() for room in rooms} | known.keys()
    rows: dict[str, dict[str, list[Row]]] = {}
    for row in items.with_all("room", "floor"):
        room, floor = key(row.values["room"]), row.values["floor"]
        if floor in every and room not in used:
            rows.setdefault(room, {}).setdefault(floor, []).append(row)
    for room, floors in rows.items():
        near = {floor: find_near(room, [one for one in every[floor] if one in stood_in]) for floor in floors}
        meant = next((every[floor][one] for floor, one in near.items() if one), None)
        if meant is not None:
            _warn(items, [row for floor, own in floors.items() if near[floor] for row in own], meant)


def split_rooms(row: Row) -> list[str]:
    """Return the rooms that a row of Routes names."""
    return [room for part in (row.values.get("room") or "").split(";") if (room := part.strip())]


def _warn(items: Table, rows: list[Row], meant: str) -> None:
    message = nfill(
        "Room {room} is not that of any segment, so the piece does not count beside those of {meant} unless it names "
        "them.",
        "Room {room} is not that of any segment, so its {n} pieces do not count beside those of {meant} unless they "
        "name them.",
        count_pieces(rows),
        room=shorten(rows[0].values["room"]),
        meant=shorten(meant),
    )
    items.report(items.cell("room", rows[0].number), message, fill("Did you mean {room}?", room=meant), "warning")


def find_near(room: str, rooms: Iterable[str]) -> str | None:
    """Return the room of which a name is most likely a slip, all as names are compared."""
    near = difflib.get_close_matches(room, list(rooms), MOST, NEAR)
    return next((one for one in near if _may_be(room, one)), None)


def _may_be(room: str, other: str) -> bool:
    """Tell whether a name can be a slip of another: Room 12 is none of Room 11, nor South office of North office."""
    if re.findall(r"\d+", room) != re.findall(r"\d+", other):
        return False
    pairs = list(zip(room.split(), other.split(), strict=False))
    if len(pairs) < 2 or len(room.split()) != len(other.split()):
        return True
    return all(difflib.SequenceMatcher(None, one, two).ratio() >= NEAR_WORD for one, two in pairs)
