"""Furniture and routes: which row names which segment, and which rows a route knows nothing of."""

from collections.abc import Iterable, Mapping

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.names import check_named
from assess.inventory.tables import Row, Table
from assess.language import fill, nfill

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
    _check_positions(tables)
    _check_plan(tables)


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


def _is_placed(table: Table, row: Row) -> bool:
    return table.sound("x", row) is not None and table.sound("y", row) is not None


def _is_unplaced(table: Table, row: Row) -> bool:
    """Tell whether a row says nothing of a position, be it right or wrong."""
    return not any(row.values.get(name) is not None or table.spoilt(name, row.number) for name in ("x", "y"))


def _lacks(table: Table, row: Row) -> bool:
    """Tell whether a position is blank, or half blank."""
    return any(row.values.get(name) is None and not table.spoilt(name, row.number) for name in ("x", "y"))


def _ends(tables: Mapping[str, Table]) -> list[tuple[Row, dict[str, Row], str]]:
    """Return the segments whose places are known and lie on one floor: the row, its places by end, and the floor."""
    routes, places = tables["Routes"], tables["Places"]
    known = {key(row.values["place"]): row for row in reversed(places.with_all("place"))}
    found = []
    for row in routes.rows:
        names = {name: key(routes.sound(name, row) or "") for name in ("start", "end")}
        own = {name: known[place] for name, place in names.items() if place in known}
        floors = {places.sound("floor", place) for place in own.values()}
        if len(own) == 2 and len(floors) == 1 and (floor := floors.pop()) is not None:
            found.append((row, own, floor))
    return found


def _check_positions(tables: Mapping[str, Table]) -> None:
    """Warn, once a floor that has a segment on the plan, of rows of which no route knows anything."""
    items, places = tables["Items"], tables["Places"]
    measured = (floor for _, own, floor in _ends(tables) if all(_is_placed(places, one) for one in own.values()))
    for floor in dict.fromkeys(measured):
        rows = [row for row in items.rows if items.sound("floor", row) == floor]
        lost = [row for row in rows if _is_unplaced(items, row) and not row.values.get("route")]
        lost = [row for row in lost if not items.spoilt("route", row.number)]
        if lost:
            message = nfill(
                "{n} of {total} rows of floor {floor} has neither a position nor a Route: whether it falls onto a "
                "route is not known, and it is not counted.",
                "{n} of {total} rows of floor {floor} have neither a position nor a Route: whether they fall onto a "
                "route is not known, and they are not counted.",
                len(lost),
                total=len(rows),
                floor=shorten(floor),
            )
            mend = fill("Fill in X, Y and Angle, or name the Route.")
            items.report(items.cell("x", lost[0].number), message, mend, "warning")


def _check_plan(tables: Mapping[str, Table]) -> None:
    """Note the segments that cannot be drawn, on floors where furniture can."""
    items, routes, places = (tables[name] for name in ("Items", "Routes", "Places"))
    drawn = {items.sound("floor", row) for row in items.rows if _is_placed(items, row)}
    for row, own, floor in _ends(tables):
        lack = [name for name, place in own.items() if _lacks(places, place)]
        if lack and floor in drawn:
            message = fill(
                "{place} has no position in Places: pieces count beside this segment only where they name it.",
                place=shorten(own[lack[0]].values["place"]),
            )
            routes.report(routes.cell(lack[0], row.number), message, fill("Fill in its X and Y."), "note")
