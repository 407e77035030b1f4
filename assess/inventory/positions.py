"""Positions on the plan: which pieces a route knows nothing of, and which segments cannot be drawn."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.tables import Row, Table
from assess.language import fill, nfill


@dataclass(frozen=True, slots=True)
class _Segment:
    """A segment with those of its places that are known, by end, and the floor that it is on.

    `may_be_drawn` also where what would tell that has been reported as wrong.
    """

    row: Row
    places: Mapping[str, Row]
    floor: str
    may_be_drawn: bool


def check_positions(tables: Mapping[str, Table]) -> None:
    """Warn, once a floor that has segments, of pieces that cannot count, and note the segments that cannot be drawn."""
    items, segments = tables["Items"], list(_segments(tables))
    for floor in dict.fromkeys(one.floor for one in segments):
        rows = [row for row in items.rows if items.sound("floor", row) == floor]
        free = [row for row in rows if not row.values.get("route") and not items.spoilt("route", row.number)]
        _warn_unplaced(items, floor, rows, [row for row in free if _is_unplaced(items, row)])
        if not any(one.may_be_drawn for one in segments if one.floor == floor):
            _warn_no_plan(items, floor, [row for row in free if _is_placed(items, row)])
    _note_undrawn(tables, segments)


def _segments(tables: Mapping[str, Table]) -> Iterator[_Segment]:
    """Yield the segments that lie on one floor, which is that of their places where they name none."""
    routes, places = tables["Routes"], tables["Places"]
    known = {key(row.values["place"]): row for row in reversed(places.with_all("place"))}
    for row in routes.rows:
        names = {name: key(routes.sound(name, row) or "") for name in ("start", "end")}
        own = {name: known[place] for name, place in names.items() if place in known}
        on = {floor for place in own.values() if (floor := places.sound("floor", place)) is not None}
        floor = routes.sound("floor", row) or (min(on) if len(on) == 1 else None)
        if floor is not None and len(on) <= 1 and not routes.spoilt("floor", row.number):
            wrong = {name for name in names if routes.spoilt(name, row.number)}
            drawn = {name for name, place in own.items() if not _lacks(places, place)}
            yield _Segment(row, own, floor, len(wrong | drawn) == len(names))


def _warn_unplaced(items: Table, floor: str, rows: Sequence[Row], lost: Sequence[Row]) -> None:
    if lost:
        message = nfill(
            "{n} of {total} pieces of floor {floor} has neither a position nor a Route: whether it falls onto a route "
            "is not known, and it is not counted.",
            "{n} of {total} pieces of floor {floor} have neither a position nor a Route: whether they fall onto a "
            "route is not known, and they are not counted.",
            count_pieces(lost),
            total=count_pieces(rows),
            floor=shorten(floor),
        )
        mend = fill("Fill in X, Y and Angle, or name the Route.")
        items.report(items.cell("x", lost[0].number), message, mend, "warning")


def _warn_no_plan(items: Table, floor: str, lost: Sequence[Row]) -> None:
    if lost:
        message = nfill(
            "{n} piece of floor {floor} has a position, but no segment of that floor has both its places placed, and "
            "it names no Route: it is not counted.",
            "{n} pieces of floor {floor} have a position, but no segment of that floor has both its places placed, "
            "and they name no Route: they are not counted.",
            count_pieces(lost),
            floor=shorten(floor),
        )
        mend = fill("Fill in X and Y of the places, or name the Route.")
        items.report(items.cell("x", lost[0].number), message, mend, "warning")


def _note_undrawn(tables: Mapping[str, Table], segments: Sequence[_Segment]) -> None:
    """Note the segments that cannot be drawn, on floors where furniture can."""
    items, routes, places = (tables[name] for name in ("Items", "Routes", "Places"))
    drawn = {items.sound("floor", row) for row in items.rows if _is_placed(items, row)}
    for one in segments:
        lack = [name for name, place in one.places.items() if _lacks(places, place)]
        if lack and len(one.places) == 2 and one.floor in drawn:
            message = fill(
                "{place} has no position in Places: pieces count beside this segment only where they name it.",
                place=shorten(one.places[lack[0]].values["place"]),
            )
            routes.report(routes.cell(lack[0], one.row.number), message, fill("Fill in its X and Y."), "note")


def count_pieces(rows: Sequence[Row]) -> int:
    """Return how many pieces rows of Items stand for; one each where the quantity is blank or wrong."""
    return sum(row.values.get("quantity") or 1 for row in rows)


def _is_placed(table: Table, row: Row) -> bool:
    return table.sound("x", row) is not None and table.sound("y", row) is not None


def _is_unplaced(table: Table, row: Row) -> bool:
    """Tell whether a row says nothing of a position, be it right or wrong."""
    return not any(row.values.get(name) is not None or table.spoilt(name, row.number) for name in ("x", "y"))


def _lacks(table: Table, row: Row) -> bool:
    """Tell whether a position is blank, or half blank."""
    return any(row.values.get(name) is None and not table.spoilt(name, row.number) for name in ("x", "y"))
