"""Furniture and routes: which row names which segment."""

from collections.abc import Iterable, Mapping

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.names import check_named
from assess.inventory.positions import check_positions
from assess.inventory.rooms import check_room_names
from assess.inventory.tables import Row, Table
from assess.language import fill

Segments = Mapping[str, Mapping[str, Row]]
"""Rows of Routes by the names of route and segment, as they are compared."""


def check_beside(tables: Mapping[str, Table]) -> None:
    """Check what Items says of routes, after the routes have been read; segments are spelt as in Routes."""
    items, routes = tables["Items"], tables["Routes"]
    check_named(items, "route", routes, "route")
    segments: dict[str, dict[str, Row]] = {}
    for row in routes.with_all("route", "segment"):
        segments.setdefault(key(row.values["route"]), {}).setdefault(key(row.values["segment"]), row)
    for row in items.rows:
        _check_distance(items, row)
        _check_segment(items, row, routes, segments)
    check_positions(tables)
    check_room_names(tables)


def _check_distance(items: Table, row: Row) -> None:
    """Warn of a distance to no route; a segment without its route is an error of its own."""
    named = any(row.values.get(name) or items.spoilt(name, row.number) for name in ("route", "segment"))
    if row.values.get("edge_distance") is not None and not named:
        message = fill("Edge distance is filled in without a Route: it is not used.")
        mend = fill("Fill in the Route, or clear the cell.")
        items.report(items.cell("edge_distance", row.number), message, mend, "warning")


def _check_segment(items: Table, row: Row, routes: Table, segments: Segments) -> None:
    route, segment = items.sound("route", row), items.sound("segment", row)
    cell = items.cell("segment", row.number)
    if segment and not row.values.get("route") and not items.spoilt("route", row.number):
        part, whole = items.label("segment"), items.label("route")
        items.report(cell, f"a {part} is named without its {whole}.", f"Fill in {whole}.")
    elif route and segment and key(route) in segments:
        found = segments[key(route)].get(key(segment))
        if found is not None:
            row.values["segment"] = found.values["segment"]
            _check_floor(items, row, "segment", {routes.sound("floor", found)})
        elif not _has_unnamed(routes, route):
            message = f"{items.label('route')} {shorten(route)} has no segment {shorten(segment)}."
            items.report(cell, message, f"Add it to {routes.sheet.name}, or clear the cell.")
    elif route and key(route) in segments and not items.spoilt("segment", row.number):
        _check_floor(items, row, "route", {routes.sound("floor", one) for one in segments[key(route)].values()})


def _has_unnamed(routes: Table, route: str) -> bool:
    """Tell whether a route has a segment whose name is wrong or blank, which has been reported: it may be the one."""
    own = (row for row in routes.rows if row.values.get("route") and key(row.values["route"]) == key(route))
    return any(row.values.get("segment") is None for row in own)


def _check_floor(items: Table, row: Row, name: str, floors: Iterable[str | None]) -> None:
    """Report a route, or a segment, that is on other floors than the item; one without a floor is on any."""
    own, floors = items.sound("floor", row), set(floors)
    if own is None or None in floors or own in floors:
        return
    what = f"{items.label(name)} {shorten(row.values[name])}"
    where = ", ".join(sorted(shorten(floor) for floor in floors))
    mend = f"Choose one of the item's floor, or correct the {items.label('floor')}."
    items.report(items.cell(name, row.number), f"{what} is not on floor {shorten(own)} but on {where}.", mend)
