"""The evacuation routes of a building: which segments, routes and rooms could be lost, by what, and how likely.

Ways through rooms in which no furniture is listed count as free of it: `find_unfurnished` warns of them.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from operator import itemgetter
from typing import Any

import numpy as np

from assess.arrays import BoolArray
from assess.errors import Problem
from assess.i18n import count, fill, nfill
from assess.model import Inventory, Place
from assess.progress import SILENT, Progress
from assess.route_results import (
    BLOCKED_FROM,
    BesideRow,
    FloorRoutesRow,
    MissingRow,
    RoomRow,
    RouteFixRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    WayRow,
)
from assess.routes.chances import DRAWS, Draws, Falls, to_array, union
from assess.routes.fixes import find_fixes
from assess.routes.network import Blocked, IsBlocked, Part, build_graph, find_ends, find_parts, find_rooms, find_ways
from assess.routes.obstructions import Obstructions
from assess.routes.scene import Scene, Verdict, combine
from assess.routes.widths import NARROWER, kinds_of, needed_width
from assess.settings import Settings
from assess.text import natural_key
from assess.workbook.names import key

ROOMS = ("room", "corridor")
"""Kinds of places in which furniture may stand."""
UNKNOWN = 0.5
"""Chance of a segment that is not evaluated or not known, for the choice of the safest way only [-]."""


class KeptRoutes:
    """The rows of segments, routes and rooms of an evaluation, for the next one of the same network.

    A row is the same as long as its segments are, and what reaches them or may reach them falls as it did.
    """

    def __init__(self) -> None:
        self._of: Hashable = None
        self._rows: dict[Hashable, Any] = {}
        self._now: dict[Hashable, Any] = {}

    def copy(self) -> "KeptRoutes":
        """Return one that knows the same rows, for an evaluation besides the next one."""
        found = KeptRoutes()
        found._of, found._now = self._of, {**self._now}
        return found

    def begin(self, of: Hashable) -> None:
        """Begin an evaluation; `of` is what all rows rest on. What the last one did not ask for is forgotten."""
        self._rows, self._now, self._of = self._now if of == self._of else {}, {}, of

    def keep(self, scene: Scene, kind: str, name: Hashable, segments: Iterable[int], make: Callable[[], Any]) -> Any:
        """Return the row of some segments, made where it is not known."""
        own = tuple(segments)
        print_ = tuple((scene.obstructions[at], scene.is_unknown(at), scene.left_out(at)) for at in own)
        items = {item for item, _ in scene.keys(own, anchors_fail=True)} | {at for *_, left in print_ for at in left}
        items |= {one.item_index for at in own for one in scene.obstructions[at].pieces}
        place = kind, name, print_, tuple((at, _fingerprint(scene, at)) for at in sorted(items))
        if place not in self._now:
            self._now[place] = self._rows[place] if place in self._rows else make()
        return self._now[place]


def _fingerprint(scene: Scene, item: int) -> tuple[Hashable, ...]:
    """Return all of a piece on which the rows of segments rest that it may reach."""
    falls, one = scene.falls, scene.inventory.items[item]
    fell = falls.fell.get(item)
    numbers = (falls.probability, falls.high, falls.in_record, falls.stands, falls.anchored, falls.quantity)
    return (
        one.item, one.row, one.x is None or one.y is None, falls.unconfirmed.get(item),
        None if fell is None else fell.tobytes(), *(of[item].tobytes() for of in numbers),
    )  # fmt: skip


def evaluate_routes(
    inventory: Inventory, obstructions: Sequence[Obstructions], falls: Falls, settings: Settings, *,
    progress: Progress = SILENT, kept: KeptRoutes | None = None,
) -> RouteTables:  # fmt: skip
    """Return what is to be expected of the routes of an inventory; nothing where it has none.

    `obstructions`: its segments, from `assess.routes.obstructions.find_obstructions`. `falls`: how its pieces fall.
    `settings`: the chosen risk, the seed of draws where combinations of pieces are too many, and the runs, which decide
    the width of intervals. `progress` receives the stage "routes". `kept` holds the rows of the evaluation before.
    """
    if not obstructions:
        return RouteTables(risk=settings.route_risk)
    scene = Scene.of(inventory, obstructions, falls, settings, progress)
    names = list(dict.fromkeys(one.segment.route for one in obstructions))
    if kept is not None:
        network = inventory.places, inventory.routes, inventory.floors
        kept.begin((*network, bool(inventory.items), settings.route_risk, settings.seed, settings.runs))
    parts = kept.keep(scene, "parts", "", (), partial(list_rooms, scene)) if kept else list_rooms(scene)
    floors = [one.floor for one in inventory.floors]
    steps = len(obstructions) + len(names) + len(parts) + len(floors)
    with progress.stage("routes", f"{count(len(obstructions), 'segment')} of {count(len(names), 'route')}") as stage:
        done = iter(range(1, steps + 1))

        def step(row: Any) -> Any:
            stage.at(next(done) / steps)
            return row

        def keep(kind: str, name: Hashable, own: Iterable[int], make: Callable[[], Any]) -> Any:
            return step(make() if kept is None else kept.keep(scene, kind, name, own, make))

        segments = tuple(keep("segment", at, [at], partial(_segment, scene, at)) for at in range(len(obstructions)))
        routes = tuple(
            keep("route", name, scene.segments_of(name), partial(_route, scene, name, segments)) for name in names
        )
        rooms = tuple(
            keep("room", place.place, part.segments, partial(evaluate_room, scene, place, part, segments))
            for place, part in parts
        )
        by_floor = [step(evaluate_floor(scene, floor, parts, segments, rooms)) for floor in floors]
    by_floor = [one for one in by_floor if one.segments or one.rooms]  # the others have nothing to tell
    known = [one for one in routes if one.state != RouteState.NOT_KNOWN]
    joined = {place.place for place, _part in parts}  # to a way out
    others = (one.place for one in inventory.places if one.kind == "room" and one.place not in joined)
    unjoined, counted = tuple(sorted(others, key=natural_key)), sum(one.kind in ROOMS for one in inventory.places)
    return RouteTables(
        risk=settings.route_risk,
        blocked_routes_expected=sum(one.blocked.probability for one in known if one.blocked),
        cut_off_rooms_expected=sum(one.loses_every_exit.probability for one in rooms if one.is_known),
        unknown_routes=len(routes) - len(known),
        unknown_rooms=sum(not one.is_known for one in rooms) + len(unjoined),
        draws=DRAWS,
        uncounted_pieces=sum(one.uncounted_pieces for one in by_floor),
        unjoined_rooms=unjoined, segments=segments, routes=routes, rooms=rooms, floors=tuple(by_floor),
        furnished_rooms=counted - len(list_unfurnished(inventory)), counted_rooms=counted,
    )  # fmt: skip


def _segment(scene: Scene, at: int) -> SegmentRow:
    one = scene.obstructions[at]
    segment, band, is_evaluated, standing = one.segment, one.band, scene.is_evaluated(at), one.standing
    needed, crowded = needed_width(segment, kinds_of(scene.inventory.places)), None
    is_short = needed is not None and standing < needed - NARROWER
    if needed is not None and (is_evaluated or is_short):
        (stands,), (fallen,) = scene.bounds([at], lambda draws: [scene.narrower(draws, at, needed)])
        crowded = stands if scene.is_known(stands, fallen) else None
    free = np.array([not scene.falls.anchored[item] for item, _ in one.gaps.keys], dtype=np.bool_)
    return SegmentRow(
        route=segment.route, segment=segment.segment, floor=segment.floor or None, from_place=segment.start or None,
        to_place=segment.end or None, room=segment.room or None, clear_width_m=segment.clear_width,
        required_width_m=segment.required_width, occupants=segment.occupants, notes=segment.notes,
        workbook_row=segment.row, length_m=band.length if band else None, start_x_m=band.start[0] if band else None,
        start_y_m=band.start[1] if band else None, end_x_m=band.end[0] if band else None,
        end_y_m=band.end[1] if band else None, extends_start_m=band.extends_start if band else 0.0,
        extends_end_m=band.extends_end if band else 0.0,
        **scene.outlook([at], lambda blocked, _every: blocked[at], is_evaluated=is_evaluated),
        evaluated=is_evaluated, clear_width_used_m=one.clear, required_width_used_m=one.required,
        standing_width_m=standing,
        # with every free-standing piece fallen
        least_width_m=one.gaps.residual(free) if is_evaluated else None, needed_width_m=needed,
        is_blocked_standing=one.is_blocked_standing, insufficient_for_occupants=is_short,
        insufficient_after_falls=crowded, pieces=tuple(_describe_pieces(scene, at)),
        other_rooms=tuple(scene.piece(item) for item in one.other_rooms),
        flags=one.flags,
    )  # fmt: skip


def _describe_pieces(scene: Scene, at: int) -> list[BesideRow]:
    """Return the pieces beside a segment with the chance that each falls while it is blocked, the likeliest first.

    That of an anchored piece is the one with anchored pieces taken as free-standing.
    """
    found: dict[int, float | None] = {}
    for fail in (True, False):
        together = scene.together([at], lambda draws: [scene.blocked(draws, [at])[at]], anchors_fail=fail)
        found |= {item: together.get(item, 0.0) for item, _ in scene.keys([at], anchors_fail=fail)}
    falls, rows = scene.falls, []
    found |= dict.fromkeys(falls.unconfirmed)
    for one in scene.obstructions[at].pieces:
        index = one.item_index
        chance, flags = found.get(index, 0.0), (*one.flags, *falls.unconfirmed.get(index, ()))
        place = bool(falls.anchored[index]), -(chance or 0.0), one.left_m, -falls.probability[index], index
        rows.append((place, replace(one, falls_while_blocked=chance, flags=flags)))
    return [row for _, row in sorted(rows, key=itemgetter(0))]


def _route(scene: Scene, name: str, rows: Sequence[SegmentRow]) -> RouteRow:
    segments = scene.segments_of(name)
    course = scene.course(segments)
    served, led = find_ends(segments, kinds_of(scene.inventory.places))
    unevaluated = tuple(one.segment for at, one in segments.items() if not scene.is_evaluated(at))
    is_evaluated = len(unevaluated) < len(segments)
    outlook = scene.outlook(segments, course, is_evaluated=is_evaluated)
    fixes, is_fixed = list_fixes(scene, segments, course)
    chances = {at: (rows[at].state, rows[at].blocked) for at in segments}
    missing_after: tuple[MissingRow, ...] = ()
    if fixes and any(scene.missing(at) for at in segments):  # fixes count unconfirmed pieces already
        held = scene.with_held(fix.item_index for fix in fixes)
        after = held.settle(segments, lambda draws: held.at_best_and_worst(draws, segments, course))
        missing_after = held.list_missing(after.verdict, segments)
    return RouteRow(
        route=name,
        floors=tuple(dict.fromkeys(one.floor for one in segments.values() if one.floor)),
        from_places=served, to_places=led, segment_indices=tuple(segments), evaluated=is_evaluated,
        unevaluated_segments=unevaluated,
        **outlook,
        decisive_segment=scene.find_decisive(chances, is_known=outlook["state"] != RouteState.NOT_KNOWN), fixes=fixes,
        is_fixed=is_fixed, missing_after=missing_after,
    )  # fmt: skip


def find_joint_draws(
    inventory: Inventory, obstructions: Sequence[Obstructions], falls: Falls, settings: Settings, runs: int, *,
    progress: Progress = SILENT,
) -> dict[str, BoolArray]:  # fmt: skip
    """Return of each route with joint outcomes in which of `runs` draws it is blocked, (runs,), if all anchors hold.

    A route has none where one of the pieces that reach it was not simulated, is not confirmed, or was simulated in
    another number of draws.
    """
    scene, found = Scene.of(inventory, obstructions, falls, settings, progress), {}
    for name in dict.fromkeys(one.segment.route for one in obstructions):
        segments = scene.segments_of(name)
        couplings = scene.couplings(segments)
        if not couplings.is_joint or couplings.unconfirmed or couplings.runs not in (0, runs):
            continue
        draws, course = couplings.joint, scene.course(segments)
        blocked = course(scene.blocked(draws, segments), draws.every)
        # where no piece reaches it, it is open in every draw, or in none
        found[name] = to_array(blocked, runs).astype(np.bool_) if couplings.runs else np.full(runs, bool(blocked))
    return found


# ---------------------------------------------------------------- rooms and floors


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
        room=place.place, floor=place.floor, exits=exits, by_stairs=part.by_stairs, loses_every_exit=found.chances[0],
        loses_if_unconfirmed_fall=settled.if_unconfirmed_fall, loses_if_anchors_fail=found.if_anchors_fail,
        state=verdict.state, missing=list_missing(scene, verdict), most_likely_piece=found.most_likely_piece,
        decisive_segment=None if telling is None else scene.find_decisive(telling, is_known=is_known), fixes=fixes,
        is_fixed=is_fixed, missing_after=missing_after,
        unevaluated_segments=tuple(scene.obstructions[at].segment.segment for at in unevaluated),
        unevaluated_indices=unevaluated, ways=tuple(ways),
    )  # fmt: skip


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
        is_blocked = scene.course(lanes)
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
        floor=floor, segments=len(segments),
        blocked_segments_expected=sum(one.blocked.probability for one in known if one.blocked),
        unknown_segments=len(segments) - len(known), routes=len(routes), blocked_routes_expected=sum(blocked),
        unknown_routes=len(routes) - len(blocked), rooms=len(own),
        cut_off_rooms_expected=sum(room.loses_every_exit.probability for room in own if room.is_known),
        unknown_rooms=sum(not room.is_known for room in own),
        any_room_cut_off=any_cut_off, uncounted_pieces=count_unplaced(scene, floor),
    )  # fmt: skip


def count_unplaced(scene: Scene, floor: str) -> int:
    """Count the pieces of a floor of which it is not known whether they fall onto one of its segments."""
    segments = [one for one in scene.obstructions if one.segment.floor == floor]
    has_plan = any(one.band for one in segments)
    items = [item for item in scene.inventory.items if item.floor == floor and not item.route] if segments else []
    return sum(item.quantity for item in items if item.x is None or item.y is None or not has_plan)


def list_unfurnished(inventory: Inventory) -> tuple[Place, ...]:
    """Return the rooms and corridors of Places in which no furniture is listed.

    A room has the pieces of its name, else those of the Room of the segments that begin or end there, and those that
    stand inside its outline. A row of furniture whose room is not known counts as the only one of a room: so
    the first of each floor are left out, as many as there are such rows.
    """
    named: dict[str, set[str]] = defaultdict(set)
    for segment in inventory.routes:
        for place in (segment.start, segment.end):
            named[place].update(key(room) for room in segment.rooms)
    taken = {(item.floor, key(item.room)) for item in inventory.items if item.room}
    left = []
    for one in (one for one in inventory.places if one.kind in ROOMS):
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
    found, count = list_unfurnished(inventory), sum(one.kind in ROOMS for one in inventory.places)
    if found and inventory.items:
        message = nfill(
            "No furniture is listed in {room}, the only room or corridor of Places: ways through it count as free of "
            "furniture.",
            "Furniture is listed in {listed:,} of {n:,} rooms and corridors of Places, not in {room}: ways through the "
            "others count as free of furniture.",
            count,
            listed=count - len(found), room=found[0].place,
        )  # fmt: skip
        cell = inventory.locate("Places", found[0].row, "place")
        yield Problem("warning", "Places", cell, message, fill("List the furniture of every room on the way."))
