"""Rows to problems: evacuation routes, the places that they join, and the furniture next to them."""

from collections.abc import Iterable, Iterator
from math import hypot

from assess.errors import Problem
from assess.i18n import Text, fill, nfill
from assess.model import split_names
from assess.text import natural_key
from assess.workbook.check import check_references, check_unique, duplicates
from assess.workbook.habits import shorten
from assess.workbook.names import find_near_name, key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import defined, list_segments, places_by_name
from assess.workbook.schema import DEFAULT_WIDTH

SAME_POINT, SAME_WIDTH = 0.01, 1e-6
"""Up to these distances [m] two places are at one point, and two widths are the same."""
OUT = ("exit", "stair")
"""Kinds of places at which a way out of a floor ends."""
MOST_NAMED = 3
"""So many rooms are named in one sentence."""


def check_names(tables: Tables) -> Iterator[Problem]:
    """Check that places and segments name what is there, and that none is there twice."""
    table = tables["Routes"]
    yield from check_unique(tables["Places"])
    yield from check_references(tables["Places"], tables)
    yield from check_references(table, tables)
    for row, before in duplicates(table, "route", "segment"):
        message = fill("duplicate {label} {segment} of {other} {route}, also in {cell}.", label=table.label("segment"),
                       segment=row.quote("segment"), other=table.label("route"), route=row.quote("route"),
                       cell=table.cell("segment", before.number))  # fmt: skip
        yield table.problem("segment", row, message, fill("Give each its own name."))


def check_segments(tables: Tables) -> Iterator[Problem]:
    """Check each segment by itself: its widths, its ends, its length and its floor."""
    table, places = tables["Routes"], tables["Places"]
    known = places_by_name(places)
    yield from _check_clear_width(table, places)
    for row in table.rows:
        lone_start = fill("From is filled in without To: the segment is evaluated, but joins nothing in the network.")
        lone_end = fill("To is filled in without From: the segment is evaluated, but joins nothing in the network.")
        for given, blank, message in (("start", "end", lone_start), ("end", "start", lone_end)):
            if table.lacks(row, blank) and row.get(given) is not None:
                yield table.problem(blank, row, message, fill("Fill in the other, or clear both."), "warning")
        clear, required = row.get("clear_width"), row.get("required_width")
        is_wide = clear is None or (required or DEFAULT_WIDTH) <= clear + SAME_WIDTH
        if not is_wide and not table.spoilt("required_width", row):
            message, fix = fill(
                "Required width {required:.4g} m is wider than Clear width {clear:.4g} m: the segment is blocked with "
                "nothing fallen.", required=required or DEFAULT_WIDTH, clear=clear,
            ), fill("Are the two exchanged?")  # fmt: skip
            if required is None:
                message, fix = fill(
                    "Required width is blank and taken as {default:.4g} m, which is wider than Clear width {clear:.4g} "
                    "m: the segment is blocked with nothing fallen.", default=DEFAULT_WIDTH, clear=clear,
                ), fill("Fill in the width that must stay free.")  # fmt: skip
            yield table.problem("required_width", row, message, fix, "warning")
        start, end = (known.get(key(table.sound(name, row) or "")) for name in ("start", "end"))
        if start and end:
            yield from _check_ends(table, row, places, start, end)


def _check_ends(table: Table, row: Row, places: Table, start: Row, end: Row) -> Iterator[Problem]:
    """Check that a segment has a length, and the floor of one of its ends."""
    labels = {"one": table.label("start"), "other": table.label("end")}
    ends = [(start.get(name), end.get(name)) for name in ("x", "y")]
    is_placed = start.get("floor") == end.get("floor") and all(None not in pair for pair in ends)
    if start is end:
        message = fill("{one} and {other} are the same place: the segment has no length.", **labels)
        yield table.problem("end", row, message, fill("Choose another place, or delete the row."))
    elif is_placed and hypot(*(other - one for one, other in ends)) <= SAME_POINT:
        message = fill("{one} and {other} are at the same point of the plan: the segment has no length.", **labels)
        yield table.problem("end", row, message, fill("Correct their positions in Places, or choose another place."))
    own, floors = table.sound("floor", row), [places.sound("floor", one) for one in (start, end)]
    if own is not None and not {None, own} & {*floors}:
        one, other = map(shorten, floors)
        message = fill(
            "{label} {floor} is that of neither {one} nor {other}, which lie on {floors}.",
            label=table.label("floor"), floor=shorten(own), **labels,
            floors=fill("{one} and {two}", one=one, two=other) if floors[0] != floors[1] else one,
        )  # fmt: skip
        yield table.problem("floor", row, message, fill("Correct it, or clear the cell."))


def _check_clear_width(table: Table, places: Table) -> Iterator[Problem]:
    """Warn of segments whose clear width is blank: once for stairs and once for others if the column is not there."""
    of_stair = fill(
        "Clear width of a stair is blank: whether the stair is open is not known, unless pieces that name it block the "
        "required width."
    )
    of_level = fill(
        "Clear width is blank: it is taken as the required width, so anything that reaches into it blocks it."
    )
    fix, known = fill("Fill in Clear width."), places_by_name(places)
    messages: dict[Text, None] = {}
    for row in table.rows:
        if table.lacks(row, "clear_width"):
            ends = [known.get(key(table.sound(name, row) or "")) for name in ("start", "end")]
            floors = {places.sound("floor", one) for one in ends if one is not None}
            message = of_stair if table.lacks(row, "floor") and len(floors) > 1 else of_level
            messages[message] = None
            if "clear_width" in table.places:
                yield table.habit("clear_width", row, message, fix, "warning")
    if "clear_width" not in table.places:
        yield from (table.problem_at_top(message, fix, "warning") for message in messages)
        return
    wide: dict[frozenset[str], list[Row]] = {}
    for row in table.with_all("route", "start", "end", "clear_width"):
        wide.setdefault(_ends_of(row), []).append(row)
    for row in table.with_all("route", "start", "end"):
        others = (one for one in wide.get(_ends_of(row), ()) if key(one.get("route")) != key(row.get("route")))
        twin = next(others, None) if table.lacks(row, "clear_width") else None
        if twin is not None:
            message = fill("{cell} joins the same places and gives a Clear width; here it is blank.",
                           cell=table.cell("clear_width", twin.number))  # fmt: skip
            fix = fill("If both are the same way, fill in the same width.")
            yield table.problem("clear_width", row, message, fix, "warning")


def _ends_of(row: Row) -> frozenset[str]:
    return frozenset(key(row.get(name)) for name in ("start", "end"))


def check_network(tables: Tables) -> Iterator[Problem]:
    """Warn of rooms on no route, and of routes without an exit, unless a place is named that is not known."""
    table, places = tables["Routes"], tables["Places"]
    wrong = any(table.spoilt(name, row) for row in table.rows for name in ("start", "end"))
    if not table.rows or not places.rows or wrong:
        return
    known = places.with_all("place")
    ends = {key(row.get(name) or "") for row in table.rows for name in ("start", "end")}
    rooms = [row for row in known if row.get("kind") == "room" and key(row.get("place")) not in ends]
    if rooms:
        message = nfill("the room {rooms} is not on any route: whether it keeps an exit is not evaluated.",
                        "{n} rooms are not on any route, such as {rooms}: whether they keep an exit is not evaluated.",
                        len(rooms), rooms=", ".join(row.quote("place") for row in rooms[:MOST_NAMED]))  # fmt: skip
        fix = fill("Let a segment begin or end at every room, or leave it out of Places.")
        yield places.problem("place", rooms[0], message, fix, "warning")
    joined = table.with_all("start", "end")
    ends = {key(row.get(name)) for row in joined for name in ("start", "end")}
    own = [row for row in known if key(row.get("place")) in ends]
    if joined and not any(places.spoilt("kind", row) or row.get("kind") in OUT for row in own):
        message = fill("no place of Kind exit or stair is joined by any segment, so no room is evaluated.")
        yield table.problem("end", joined[0], message, fill("Fill in the Kind of the places that lead out."), "warning")


def check_next_to_routes(tables: Tables) -> Iterator[Problem]:
    """Check what Items says of routes."""
    items, routes = tables["Items"], tables["Routes"]
    segments = list_segments(routes)
    for row in items.rows:
        if row.get("edge_distance") is not None and not items.says(row, "route", "segment"):
            message = fill("Edge distance is filled in without a Route: it is not used.")
            fix = fill("Fill in the Route, or clear the cell.")
            yield items.problem("edge_distance", row, message, fix, "warning")
        route, segment = items.sound("route", row), items.sound("segment", row)
        own, name = segments.get(key(route or ""), {}), "segment" if segment else "route"
        if segment and items.lacks(row, "route"):
            part, whole = items.label("segment"), items.label("route")
            message = fill("a {part} is named without its {whole}.", part=part, whole=whole)
            yield items.problem("segment", row, message, fill("Fill in {whole}.", whole=whole))
        elif not own or items.spoilt("segment", row):
            continue
        elif not segment or key(segment) in own:
            used = [own[key(segment)]] if segment else own.values()
            floor, floors = items.sound("floor", row), {routes.sound("floor", one) for one in used}
            if floor is not None and not {None, floor} & floors:
                message = fill("{label} {name} is not on floor {floor} but on {others}.", label=items.label(name),
                               name=row.quote(name), floor=shorten(floor),
                               others=", ".join(map(shorten, sorted(floors, key=natural_key))))  # fmt: skip
                fix = fill("Choose one of the item's floor, or correct the {label}.", label=items.label("floor"))
                yield items.problem(name, row, message, fix)
        elif all(one.get("segment") for one in routes.with_all("route") if key(one.get("route")) == key(route)):
            values = {"label": items.label("route"), "route": shorten(route), "segment": shorten(segment)}
            message = fill("{label} {route} has no segment {segment}.", **values)
            fix = fill("Add it to {sheet}, or clear the cell.", sheet=routes.sheet.name)
            yield items.problem("segment", row, message, fix)


def check_positions(tables: Tables) -> Iterator[Problem]:
    """Warn, once a floor that has segments, of pieces that cannot count, and note the segments that cannot be drawn."""
    items, routes, places = (tables[name] for name in ("Items", "Routes", "Places"))
    segments = list(_list_on_plan(routes, places))
    drawable = {floor for _, _, floor, may_be_drawn in segments if may_be_drawn}
    placed_rows = [row for row in items.rows if None not in (items.sound("x", row), items.sound("y", row))]
    for floor in dict.fromkeys(floor for _, _, floor, _ in segments):
        rows = [row for row in items.rows if items.sound("floor", row) == floor]
        free = [row for row in rows if items.lacks(row, "route")]
        if lost := [row for row in free if not items.says(row, "x", "y")]:
            message = nfill(
                "{n} of {total} pieces of floor {floor} has neither a position nor a Route: whether it falls onto a "
                "route is not known, and it is not counted.",
                "{n} of {total} pieces of floor {floor} have neither a position nor a Route: whether they fall onto a "
                "route is not known, and they are not counted.",
                _count_pieces(lost), total=_count_pieces(rows), floor=shorten(floor),
            )  # fmt: skip
            yield items.problem("x", lost[0], message, fill("Fill in X, Y and Angle, or name the Route."), "warning")
        placed = [row for row in placed_rows if items.sound("floor", row) == floor and items.lacks(row, "route")]
        if placed and floor not in drawable:
            message = nfill(
                "{n} piece of floor {floor} has a position, but no segment of that floor has both its places placed, "
                "and it names no Route: it is not counted.",
                "{n} pieces of floor {floor} have a position, but no segment of that floor has both its places "
                "placed, and they name no Route: they are not counted.",
                _count_pieces(placed), floor=shorten(floor),
            )  # fmt: skip
            fix = fill("Fill in X and Y of the places, or name the Route.")
            yield items.problem("x", placed[0], message, fix, "warning")
    drawn = {items.sound("floor", row) for row in placed_rows}
    for segment, ends, floor, _ in segments:
        lack = [name for name, place in ends.items() if not (places.says(place, "x") and places.says(place, "y"))]
        if lack and len(ends) == 2 and floor in drawn:
            message = fill(
                "{place} has no position in Places: pieces count beside this segment only where they name it.",
                place=shorten(ends[lack[0]].get("place")),
            )
            yield routes.problem(lack[0], segment, message, fill("Fill in its X and Y."), "note")


def _list_on_plan(routes: Table, places: Table) -> Iterator[tuple[Row, dict[str, Row], str, bool]]:
    """Yield the segments that lie on one floor, with their known places by end, and that floor.

    The floor is that of the places where a segment names none. The last value is whether the segment may be drawn,
    also where what that depends on has been reported as wrong.
    """
    known = places_by_name(places)
    for row in routes.rows:
        names = {name: key(routes.sound(name, row) or "") for name in ("start", "end")}
        own = {name: known[place] for name, place in names.items() if place in known}
        on = {floor for place in own.values() if (floor := places.sound("floor", place)) is not None}
        floor = routes.sound("floor", row) or (min(on) if len(on) == 1 else None)
        if floor is not None and len(on) <= 1 and not routes.spoilt("floor", row):
            wrong = {name for name in names if routes.spoilt(name, row)}
            drawn = {name for name, place in own.items() if places.says(place, "x") and places.says(place, "y")}
            yield row, own, floor, len(wrong | drawn) == len(names)


def _count_pieces(rows: Iterable[Row]) -> int:
    return sum(row.get("quantity") or 1 for row in rows)


def check_segment_rooms(tables: Tables) -> Iterator[Problem]:
    """Warn of a room that neither a piece nor a place has: a slip there would leave out the pieces of the right one."""
    table = tables["Routes"]
    known = defined(tables["Places"]) | defined(tables["Items"], "room")
    for row in table.rows:
        for room in split_names(row.get("room")):
            near = None if key(room) in known else find_near_name(key(room), known)
            if near:
                message = fill("no piece is in room {room}, so none counts beside this segment unless it names it.",
                               room=shorten(room))  # fmt: skip
                yield table.problem("room", row, message, fill("Did you mean {room}?", room=known[near]), "warning")


def check_item_rooms(tables: Tables) -> Iterator[Problem]:
    """Warn of rooms of pieces that are nearly one of a segment of their floor, unless the slip is reported there."""
    items, routes = tables["Items"], tables["Routes"]
    known = defined(tables["Places"])
    stood_in = known.keys() | defined(items, "room").keys()
    every: dict[str, dict[str, str]] = {}
    for row in routes.rows:
        for name in split_names(row.get("room")):
            every.setdefault(routes.sound("floor", row) or "", {}).setdefault(key(name), name)
    used = {room for rooms in every.values() for room in rooms} | known.keys()
    rows: dict[str, dict[str, list[Row]]] = {}
    for row in items.with_all("room", "floor"):
        room, floor = key(row.get("room")), row.get("floor")
        if floor in every and room not in used:
            rows.setdefault(room, {}).setdefault(floor, []).append(row)
    for room, floors in rows.items():
        near = {floor: find_near_name(room, [one for one in every[floor] if one in stood_in]) for floor in floors}
        meant = next((every[floor][one] for floor, one in near.items() if one), None)
        if meant is not None:
            wrong = [row for floor, own in floors.items() if near[floor] for row in own]
            message = nfill(
                "Room {room} is not that of any segment, so the piece does not count beside those of {meant} unless it "
                "names them.",
                "Room {room} is not that of any segment, so its {n} pieces do not count beside those of {meant} unless "
                "they name them.",
                _count_pieces(wrong), room=wrong[0].quote("room"), meant=shorten(meant),
            )  # fmt: skip
            yield items.problem("room", wrong[0], message, fill("Did you mean {room}?", room=meant), "warning")
