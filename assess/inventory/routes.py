"""Evacuation routes and the places that they join: read, and what in them does not fit together."""

from collections.abc import Mapping
from math import hypot

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.model import Place, Segment
from assess.inventory.names import check_named, check_references, check_unique, spell_alike
from assess.inventory.network import check_network
from assess.inventory.rooms import find_near, split_rooms
from assess.inventory.tables import Row, Table
from assess.language import fill

DEFAULT_WIDTH = 0.9
"""Default required width [m]: 900 mm, as Italy's D.M. 3 August 2015 asks for up to 300 occupants."""

SAME_POINT, SAME_WIDTH = 0.01, 1e-6
"""Up to these distances [m] two places are at one point, and two widths are the same."""


def read_places(tables: Mapping[str, Table]) -> tuple[Place, ...]:
    """Return the places; problems are reported to their table."""
    table = tables["Places"]
    check_unique(table, "place")
    check_references(table, "floor", tables["Floors"], "floor")
    return tuple(Place(row=row.number, **row.filled()) for row in table.with_all("place", "floor"))


def read_routes(tables: Mapping[str, Table]) -> tuple[Segment, ...]:
    """Return the segments, after the places have been read; problems are reported to their table.

    A blank floor is filled in where both places lie on one.
    """
    table, places = tables["Routes"], tables["Places"]
    spell_alike(table, "route")
    check_references(table, "floor", tables["Floors"], "floor")
    for name in ("start", "end"):
        check_named(table, name, places, "place")
    _check_twice(table)
    _check_clear_width(table)
    known = {key(row.values["place"]): row for row in reversed(places.with_all("place"))}
    for row in table.rows:
        _check_joined(table, row)
        _check_widths(table, row)
        start, end = (known.get(key(table.sound(name, row) or "")) for name in ("start", "end"))
        if start and end:
            _check_length(table, row, start, end)
            _check_floor(table, row, (places.sound("floor", start), places.sound("floor", end)))
    _check_rooms(table, tables["Items"], places)
    check_network(table, places)
    return tuple(Segment(row=row.number, **row.filled()) for row in table.with_all("route", "segment"))


def _check_twice(table: Table) -> None:
    """Report every segment that a route names a second time."""
    first: dict[tuple[str, str], int] = {}
    for row in table.with_all("route", "segment"):
        route, segment = row.values["route"], row.values["segment"]
        cell = table.cell("segment", row.number)
        before = first.setdefault((key(route), key(segment)), row.number)
        if before != row.number:
            what = f"{table.label('segment')} {shorten(segment)} of {table.label('route')} {shorten(route)}"
            message = f"{what} is here twice, also in {table.cell('segment', before)}."
            table.report(cell, message, "Give each its own name.")


def _check_clear_width(table: Table) -> None:
    """Warn of segments whose clear width is blank: once where the sheet lacks the column."""
    message = fill(
        "Clear width is blank: it is taken as the required width, so anything that reaches into it blocks it."
    )
    lack = [row for row in table.rows if row.values.get("clear_width") is None]
    lack = [row for row in lack if not table.spoilt("clear_width", row.number)]
    cells = [table.cell("clear_width", row.number) for row in lack]
    for cell in cells if "clear_width" in table.letters else ["A1"] if cells else []:
        table.report(cell, message, fill("Fill in Clear width."), "warning")


def _check_joined(table: Table, row: Row) -> None:
    """Warn of a segment that has one end alone."""
    lone_start = fill("From is filled in without To: the segment is evaluated, but joins nothing in the network.")
    lone_end = fill("To is filled in without From: the segment is evaluated, but joins nothing in the network.")
    for given, blank, message in (("start", "end", lone_start), ("end", "start", lone_end)):
        lacks = row.values.get(blank) is None and not table.spoilt(blank, row.number)
        if lacks and row.values.get(given) is not None:
            cell = table.cell(blank, row.number)
            table.report(cell, message, fill("Fill in the other, or clear both."), "warning")


def _check_widths(table: Table, row: Row) -> None:
    """Warn of a segment that is narrower than it must be with nothing fallen."""
    clear, required = (row.values.get(name) for name in ("clear_width", "required_width"))
    if clear is None or table.spoilt("required_width", row.number):
        return
    if (required or DEFAULT_WIDTH) <= clear + SAME_WIDTH:
        return
    if required is None:
        message = fill(
            "Required width is blank and taken as {default:.4g} m, which is wider than Clear width {clear:.4g} m: the "
            "segment is blocked with nothing fallen.",
            default=DEFAULT_WIDTH,
            clear=clear,
        )
        mend = fill("Fill in the width that must stay free.")
    else:
        message = fill(
            "Required width {required:.4g} m is wider than Clear width {clear:.4g} m: the segment is blocked with "
            "nothing fallen.",
            required=required,
            clear=clear,
        )
        mend = fill("Are the two exchanged?")
    table.report(table.cell("required_width", row.number), message, mend, "warning")


def _check_length(table: Table, row: Row, start: Row, end: Row) -> None:
    """Report a segment that begins where it ends."""
    one, other = table.label("start"), table.label("end")
    cell, (x, y) = table.cell("end", row.number), (_apart(start, end, name) for name in ("x", "y"))
    if start is end:
        message = f"{one} and {other} are the same place: the segment has no length."
        table.report(cell, message, "Choose another place, or delete the row.")
    elif start.values.get("floor") == end.values.get("floor") and hypot(x, y) <= SAME_POINT:
        message = f"{one} and {other} are at the same point of the plan: the segment has no length."
        table.report(cell, message, "Correct their positions in Places, or choose another place.")


def _check_rooms(table: Table, items: Table, places: Table) -> None:
    """Warn of a room that neither a piece nor a place has: a slip there would leave out the pieces of the right one."""
    known = {
        key(value): value
        for source, name in ((places, "place"), (items, "room"))
        for row in source.rows
        if (value := row.values.get(name)) is not None
    }
    for row in table.rows:
        for room in split_rooms(row):
            near = None if key(room) in known else find_near(key(room), known)
            if near:
                message = fill(
                    "no piece is in room {room}, so none counts beside this segment unless it names it.",
                    room=shorten(room),
                )
                mend = fill("Did you mean {room}?", room=known[near])
                table.report(table.cell("room", row.number), message, mend, "warning")


def _apart(start: Row, end: Row, name: str) -> float:
    """Distance of two places along one axis [m]; endless where one has no position."""
    one, other = start.values.get(name), end.values.get(name)
    return float("inf") if one is None or other is None else float(other - one)


def _check_floor(table: Table, row: Row, floors: tuple[str | None, str | None]) -> None:
    """Fill a blank floor in from those of the places, and report one that neither of them lies on."""
    if None in floors or table.spoilt("floor", row.number):
        return
    own, (start, end) = row.values.get("floor"), floors
    if own is None and start == end:
        row.values["floor"] = start
    elif own is not None and own not in floors:
        label, one, other = (table.label(name) for name in ("floor", "start", "end"))
        where = shorten(start) if start == end else f"{shorten(start)} and {shorten(end)}"
        message = f"{label} {shorten(own)} is that of neither {one} nor {other}, which lie on {where}."
        table.report(table.cell("floor", row.number), message, "Correct it, or clear the cell.")
