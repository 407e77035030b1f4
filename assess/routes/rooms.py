"""Rooms and floors: which rooms lose every exit, the ways that are left, and what is expected floor by floor."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from assess.model import Place
from assess.natural import natural_key
from assess.route_results import Chance, FloorRoutesRow, RoomRow, RouteState, SegmentRow, WayRow
from assess.routes.chances import Draws, union
from assess.routes.network import Part, build_course, build_graph, find_parts, find_rooms, find_ways
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of

UNKNOWN = 0.5
"""Chance of a segment that is not evaluated or not known, for the choice of the safest way only [-]."""


def name_unevaluated(scene: Scene, segments: Iterable[int]) -> tuple[str, ...]:
    """Return the names of those of some segments that are not evaluated."""
    every = (scene.obstructions[at] for at in segments)
    return tuple(one.segment.segment for one in every if not one.is_evaluated)


# ---------------------------------------------------------------- rooms


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


def evaluate_room(scene: Scene, place: Place, part: Part, chance: Mapping[int, float]) -> RoomRow:
    """Return one room; `chance` is that of a blockage by segment, as far as it is known."""

    def happens(draws: Draws) -> Sequence[int]:
        return part.cut_off(scene.blocked(draws, part.segments), [place.place], draws.every)

    found = scene.judge(part.segments, happens)
    is_known = scene.is_known(found.chances[0], found.at_most[0])
    return RoomRow(
        room=place.place,
        floor=place.floor,
        exits=tuple(sorted({end for edge in part.edges for end in edge[:2]} & part.targets, key=natural_key)),
        by_stairs=part.by_stairs,
        loses_every_exit=found.chances[0],
        loses_if_unconfirmed_fall=found.at_most[0] if found.chances[0].unconfirmed else None,
        loses_if_anchors_fail=found.if_anchors_fail,
        is_known=is_known,
        doubts=() if is_known else scene.find_doubts(part.segments),
        most_likely_piece=found.most_likely_piece,
        unevaluated_segments=name_unevaluated(scene, part.segments),
        unevaluated_indices=tuple(at for at in part.segments if not scene.obstructions[at].is_evaluated),
        ways=tuple(_ways(scene, place, part, {at: chance.get(at, UNKNOWN) for at in part.segments})),
    )


def _ways(scene: Scene, place: Place, part: Part, chance: Mapping[int, float]) -> list[WayRow]:
    ways = [_way(scene, segments, end) for segments, end in find_ways(part, place.place, chance)]
    ways.sort(key=lambda way: (way.blocked_if_unconfirmed_fall or way.blocked).probability)
    for number, way in enumerate(ways[1:], start=1):
        shared = (at for at in way.segment_indices if at in ways[0].segment_indices)
        ways[number] = replace(way, shared=tuple(scene.obstructions[at].segment.segment for at in shared))
    return ways


def _way(scene: Scene, segments: tuple[int, ...], end: str) -> WayRow:
    (standing,), (fallen,) = scene.bounds(segments, lambda draws: [union(scene.blocked(draws, segments).values())])
    return WayRow(
        segment_indices=segments,
        end=end,
        blocked=standing,
        blocked_if_unconfirmed_fall=fallen if standing.unconfirmed else None,
        is_known=scene.is_known(standing, fallen),
    )


# ---------------------------------------------------------------- floors


def evaluate_floor(
    scene: Scene,
    floor: str,
    parts: Sequence[tuple[Place, Part]],
    every: Sequence[SegmentRow],
    rooms: Sequence[RoomRow],
) -> FloorRoutesRow:
    """Return what is to be expected on one floor; `every` are all segments, `rooms` those of `parts`."""
    segments = [at for at, one in enumerate(scene.obstructions) if one.segment.floor == floor]
    routes = sorted({scene.obstructions[at].segment.route for at in segments}, key=natural_key)
    here = [(place, part) for place, part in parts if place.floor == floor]
    own = [room for room in rooms if room.floor == floor]
    known = [every[at] for at in segments if every[at].state != RouteState.NOT_KNOWN]
    blocked = [_blocked_here(scene, route, segments) for route in routes]
    return FloorRoutesRow(
        floor=floor,
        segments=len(segments),
        blocked_segments_expected=sum(one.blocked.probability for one in known if one.blocked),
        unknown_segments=len(segments) - len(known),
        routes=len(routes),
        blocked_routes_expected=sum(one for one in blocked if one is not None),
        unknown_routes=blocked.count(None),
        rooms=len(own),
        cut_off_rooms_expected=sum(room.loses_every_exit.probability for room in own if room.is_known),
        unknown_rooms=sum(not room.is_known for room in own),
        any_room_cut_off=_find_any_cut_off(scene, here) if here else None,
        uncounted_pieces=count_unplaced(scene, floor, segments),
    )


def count_unplaced(scene: Scene, floor: str, segments: Sequence[int]) -> int:
    """Count the pieces of a floor of which it is not known whether they fall onto one of its segments."""
    has_plan = any(scene.obstructions[at].band for at in segments)
    items = [item for item in scene.inventory.items if item.floor == floor and not item.route] if segments else []
    return sum(item.quantity for item in items if item.x is None or item.y is None or not has_plan)


def _blocked_here(scene: Scene, route: str, segments: Sequence[int]) -> float | None:
    """Return the chance that a route is blocked by its segments on one floor; None where its state is not known."""
    own = {at: one for at, one in scene.segments_of(route).items() if at in segments}
    course = build_course(own, kinds_of(scene.inventory.places))

    def happens(draws: Draws) -> Sequence[int]:
        blocked = course.is_blocked(scene.blocked(draws, own), draws.every)
        return blocked, blocked | scene.narrowed(draws, own)

    standing, fallen = scene.bounds(own, happens)
    return None if scene.settle(standing, fallen) == RouteState.NOT_KNOWN else standing[0].probability


def _find_any_cut_off(scene: Scene, rooms: Sequence[tuple[Place, Part]]) -> Chance | None:
    segments = sorted({at for _, part in rooms for at in part.segments})

    def happens(draws: Draws) -> Sequence[int]:
        blocked = scene.blocked(draws, segments)
        return [union(part.cut_off(blocked, [place.place], draws.every)[0] for place, part in rooms)]

    (standing,), (fallen,) = scene.bounds(segments, happens)
    return standing if scene.is_known(standing, fallen) else None
