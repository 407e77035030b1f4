"""Rooms and exits: what of a building the routes leave out."""

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.tables import Row, Table
from assess.language import fill, nfill

OUT = ("exit", "stair")
"""Kinds of places at which a way out of a floor ends."""

MOST = 3
"""So many rooms are named in one sentence."""


def check_network(table: Table, places: Table) -> None:
    """Warn of rooms that are on no route, and of routes that lead to no exit.

    Neither where a place is named that is not known: it may be the very one that seems to be left out.
    """
    wrong = any(table.spoilt(name, row.number) for row in table.rows for name in ("start", "end"))
    if not table.rows or not places.rows or wrong:
        return
    known = places.with_all("place")
    _check_rooms(table, places, known)
    joined = table.with_all("start", "end")
    ends = {key(row.values[name]) for row in joined for name in ("start", "end")}
    kinds = {
        "exit" if places.spoilt("kind", row.number) else row.values.get("kind")
        for row in known
        if key(row.values["place"]) in ends
    }
    if joined and not kinds & {*OUT}:
        message = fill("no place of Kind exit or stair is joined by any segment, so no room is evaluated.")
        mend = fill("Fill in the Kind of the places that lead out.")
        table.report(table.cell("end", joined[0].number), message, mend, "warning")


def _check_rooms(table: Table, places: Table, known: list[Row]) -> None:
    ends = {key(row.values.get(name) or "") for row in table.rows for name in ("start", "end")}
    left = [row for row in known if row.values.get("kind") == "room" and key(row.values["place"]) not in ends]
    if left:
        named = ", ".join(shorten(row.values["place"]) for row in left[:MOST])
        message = nfill(
            "the room {rooms} is not on any route: whether it keeps an exit is not evaluated.",
            "{n} rooms are not on any route, such as {rooms}: whether they keep an exit is not evaluated.",
            len(left),
            rooms=named,
        )
        mend = fill("Let a segment begin or end at every room, or leave it out of Places.")
        places.report(places.cell("place", left[0].number), message, mend, "warning")
