"""Rooms and floors: which rooms lose every exit, the ways that are left, and what is expected floor by floor.

Ways through rooms in which no furniture is listed count as free of it: `find_unfurnished` warns of them.
"""

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

from assess.errors import Problem
from assess.i18n import fill, nfill
from assess.model import Inventory, Place
from assess.route_results import (
    BLOCKED_FROM,
    FloorRoutesRow,
    MissingRow,
    RoomRow,
    RouteFixRow,
    RouteState,
    SegmentRow,
    WayRow,
)
from assess.routes.chances import Draws, union
from assess.routes.fixes import find_fixes
from assess.routes.network import Blocked, IsBlocked, Part, build_graph, find_parts, find_rooms, find_ways
from assess.routes.scene import Scene, Verdict, combine
from assess.routes.widths import kinds_of
from assess.text import natural_key
from assess.workbook.names import key

ROOMS = ("room", "corridor")
"""Kinds of places in which furniture may stand."""
UNKNOWN = 0.5
"""Chance of a segment that is not evaluated or not known, for the choice of the safest way only [-]."""


def list_fixes(scene: Scene, segments: Collection[int], is_blocked: IsBlocked) -> tuple[tuple[RouteFixRow, ...], bool]:
    """Return what to fix so that some segments are open together, and whether anything opens them."""
    lanes = {at: scene.obstructions[at] for at in segments}
    couplings, risk = scene.couplings(segments, unconfirmed_fall=True), min(scene.risk, BLOCKED_FROM)
    steps, is_fixed = find_fixes(couplings, lanes, is_blocked, risk, scene.z, scene.progress)
    items = scene.inventory.items
    found = (
        RouteFixRow(item=items[at].item, row=items[at].row, item_index=at, gain=gain, left=left)
        for at, gain, left in steps
    )
    return tuple(found), is_fixed


def find_missing_after(
    scene: Scene, segments: Collection[int], fixes: Sequence[RouteFixRow], is_blocked: IsBlocked
) -> tuple[MissingRow, ...]:
    """Return what is to be filled in once fixes are done so that it is known whether some segments are open."""
    if not fixes or not any(scene.missing(at) for at in segments):  # fixes count unconfirmed pieces already
        return ()
    held = scene.with_held(fix.item_index for fix in fixes)
    found = held.settle(segments, lambda draws: held.at_best_and_worst(draws, segments, is_blocked))
    return held.list_missing(found.verdict, segments)


def list_rooms(scene: Scene) -> list[tuple[Place, Part]]:
    """Return every room that the network joins to a way out, and the part of it that lies on the room's ways out."""
    places = scene.inventory.places
    graph = build_graph({at: one.segment for at, one in enumerate(scene.obstructions)})
    floors = {floor.floor: floor.elevation for floor in scene.inventory.floors}
    heights = {place.place: z for place in places if (z := floors.get(place.floor)) is not None}
    found = []
    for room in find_rooms(places, list(find_parts(graph, kinds_of(places))), heights):
        scene.progress.check()
        found.append(room)
    return found


def list_unjoined(scene: Scene, found: Iterable[tuple[Place, Part]]) -> tuple[str, ...]:
    """Return the rooms that are not among those `found`: no segment joins them to a way out."""
    joined = {place.place for place, _part in found}
    rooms = (one.place for one in scene.inventory.places if one.kind == "room" and one.place not in joined)
    return tuple(sorted(rooms, key=natural_key))


def evaluate_room(scene: Scene, place: Place, part: Part, rows: Sequence[SegmentRow]) -> RoomRow:
    """Return one room; `rows` are all segments."""
    exits = tuple(sorted(part.places & part.targets, key=natural_key))
    is_cut_off = part.when_cut_off(place.place)

    def lose(scene: Scene, draws: Draws) -> tuple[int, int, int]:
        """Return the sets of the draws in which it loses every exit, as `Scene.at_best_and_worst` does."""
        lost, known, at_most = scene.at_best_and_worst(draws, part.segments, is_cut_off)
        return (lost, draws.every, draws.every) if part.by_stairs else (lost, known, at_most)

    def list_missing(scene: Scene, verdict: Verdict) -> tuple[MissingRow, ...]:
        """Return what is to be filled in: of the safest way that needs any, as one known way may be enough."""
        if verdict.state != RouteState.NOT_KNOWN:
            return ()
        of_ways = (scene.list_missing(verdict, way.segment_indices) for way in ways)
        found = next(filter(None, of_ways), ()) or scene.list_missing(verdict, part.segments)
        return (*found, MissingRow(what="beyond_stairs", names=exits)) if part.by_stairs else found

    found = scene.judge(part.segments, partial(lose, scene))
    settled = scene.settle(part.segments, partial(lose, scene), found)
    verdict, ways = settled.verdict, _ways(scene, place, part, rows)
    is_known = verdict.state != RouteState.NOT_KNOWN
    # the decisive segment is that of the safest way out; where that does not tell, of the first that is not known
    of_ways = ({at: (rows[at].state, rows[at].blocked) for at in way.segment_indices} for way in ways)
    telling = next(
        (one for one in of_ways if is_known or RouteState.NOT_KNOWN in {state for state, _ in one.values()}), None
    )
    seeks_fixes = verdict.state in (RouteState.DOUBTFUL, RouteState.BLOCKED)
    fixes, is_fixed = list_fixes(scene, part.segments, is_cut_off) if seeks_fixes else ((), True)
    missing_after: tuple[MissingRow, ...] = ()
    if fixes and (part.by_stairs or any(scene.missing(at) for at in part.segments)):
        held = scene.with_held(fix.item_index for fix in fixes)
        missing_after = list_missing(held, held.settle(part.segments, partial(lose, held)).verdict)
    unevaluated = tuple(at for at in part.segments if not scene.is_evaluated(at))
    return RoomRow(
        room=place.place,
        floor=place.floor,
        exits=exits,
        by_stairs=part.by_stairs,
        loses_every_exit=found.chances[0],
        loses_if_unconfirmed_fall=settled.if_unconfirmed_fall,
        loses_if_anchors_fail=found.if_anchors_fail,
        state=verdict.state,
        missing=list_missing(scene, verdict),
        most_likely_piece=found.most_likely_piece,
        decisive_segment=None if telling is None else scene.find_decisive(telling, is_known=is_known),
        fixes=fixes,
        is_fixed=is_fixed,
        missing_after=missing_after,
        unevaluated_segments=tuple(scene.obstructions[at].segment.segment for at in unevaluated),
        unevaluated_indices=unevaluated,
        ways=tuple(ways),
    )


def _ways(scene: Scene, place: Place, part: Part, rows: Sequence[SegmentRow]) -> list[WayRow]:
    known = {at: rows[at].blocked for at in part.segments if rows[at].state != RouteState.NOT_KNOWN}
    chance = {at: UNKNOWN if (one := known.get(at)) is None else one.probability for at in part.segments}
    ways = []
    for segments, end in find_ways(part, place.place, chance):
        is_blocked = lambda blocked, _every: union(blocked.values())  # noqa: E731
        found = scene.settle(segments, partial(scene.at_best_and_worst, segments=segments, is_blocked=is_blocked))
        way = WayRow(
            segment_indices=segments, end=end, state=found.verdict.state, blocked=found.standing[0],
            blocked_if_unconfirmed_fall=found.if_unconfirmed_fall,
        )  # fmt: skip
        ways.append(way)
    ways.sort(key=lambda way: (way.state.severity, (way.blocked_if_unconfirmed_fall or way.blocked).probability))
    for number, way in enumerate(ways[1:], start=1):
        shared = (at for at in way.segment_indices if at in ways[0].segment_indices)
        ways[number] = replace(way, shared=tuple(scene.obstructions[at].segment.segment for at in shared))
    return ways


def evaluate_floor(
    scene: Scene, floor: str, parts: Sequence[tuple[Place, Part]], every: Sequence[SegmentRow], rooms: Sequence[RoomRow]
) -> FloorRoutesRow:
    """Return what is to be expected on one floor; `every` are all segments, `rooms` those of `parts`."""
    segments = [at for at, one in enumerate(scene.obstructions) if one.segment.floor == floor]
    routes = sorted({scene.obstructions[at].segment.route for at in segments}, key=natural_key)
    here = [(place, part) for place, part in parts if place.floor == floor]
    own = [room for room in rooms if room.floor == floor]
    known = [every[at] for at in segments if every[at].state != RouteState.NOT_KNOWN]
    blocked = []
    for route in routes:  # by their segments on this floor
        lanes = {at: scene.obstructions[at].segment for at in segments if scene.obstructions[at].segment.route == route}
        is_blocked = scene.course(lanes).is_blocked
        found = scene.settle(lanes, partial(scene.at_best_and_worst, segments=lanes, is_blocked=is_blocked))
        if found.verdict.state != RouteState.NOT_KNOWN:
            blocked.append(found.standing[0].probability)
    any_cut_off = None
    if here:
        ways = sorted({at for _, part in here for at in part.segments})

        def is_any_lost(blocked: Blocked, every: int) -> int:
            return union(part.cut_off(blocked, [place.place], every)[0] for place, part in here)

        standing, fallen = scene.bounds(ways, lambda draws: scene.at_best_and_worst(draws, ways, is_any_lost))
        worst = combine(fallen[1], fallen[2], scene.any_left_out_falls(ways))
        any_cut_off = standing[0] if scene.is_known(standing[0], worst) else None
    return FloorRoutesRow(
        floor=floor,
        segments=len(segments),
        blocked_segments_expected=sum(one.blocked.probability for one in known if one.blocked),
        unknown_segments=len(segments) - len(known),
        routes=len(routes),
        blocked_routes_expected=sum(blocked),
        unknown_routes=len(routes) - len(blocked),
        rooms=len(own),
        cut_off_rooms_expected=sum(room.loses_every_exit.probability for room in own if room.is_known),
        unknown_rooms=sum(not room.is_known for room in own),
        any_room_cut_off=any_cut_off,
        uncounted_pieces=count_unplaced(scene, floor, segments),
    )


def count_unplaced(scene: Scene, floor: str, segments: Sequence[int]) -> int:
    """Count the pieces of a floor of which it is not known whether they fall onto one of its segments."""
    has_plan = any(scene.obstructions[at].band for at in segments)
    items = [item for item in scene.inventory.items if item.floor == floor and not item.route] if segments else []
    return sum(item.quantity for item in items if item.x is None or item.y is None or not has_plan)


def list_rooms_to_furnish(inventory: Inventory) -> tuple[Place, ...]:
    """Return the rooms and corridors of Places."""
    return tuple(one for one in inventory.places if one.kind in ROOMS)


def list_unfurnished(inventory: Inventory) -> tuple[Place, ...]:
    """Return the rooms and corridors of Places in which no furniture is listed.

    A room has the pieces of its name, else those of the Room of the segments that begin or end there, and those that
    stand inside its outline. A row of furniture of which nothing tells the room counts as the only one of a room: so
    the first of each floor are left out, as many as there are such rows.
    """
    named: dict[str, set[str]] = defaultdict(set)
    for segment in inventory.routes:
        for place in (segment.start, segment.end):
            named[place].update(key(room) for room in segment.rooms)
    taken = {(item.floor, key(item.room)) for item in inventory.items if item.room}
    left = []
    for one in list_rooms_to_furnish(inventory):
        names = {key(one.place)} if key(one.place) in named[one.place] else {key(one.place), *named[one.place]}
        if not any((one.floor, name) in taken for name in names):
            left.append(one)
    outlined = [at for at, one in enumerate(left) if one.outline]
    placed = [(one.floor, (one.x, one.y)) for one in inventory.items if one.x is not None and one.y is not None]
    inside = set()
    if outlined and placed:
        from shapely import Point, Polygon, STRtree

        tree = STRtree([Point(at) for _floor, at in placed])
        pairs = tree.query([Polygon(left[at].outline) for at in outlined], predicate="covers").T.tolist()
        inside = {outlined[at] for at, piece in pairs if left[outlined[at]].floor == placed[piece][0]}
    loose = Counter(item.floor for item in inventory.items if not item.room and (item.x is None or item.y is None))
    found = []
    for one in (one for at, one in enumerate(left) if at not in inside):
        if loose[one.floor] > 0:
            loose[one.floor] -= 1
        else:
            found.append(one)
    return tuple(found)


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
        cell = inventory.locate("Places", found[0].row, "place")
        yield Problem("warning", "Places", cell, message, fill("List the furniture of every room on the way."))
