"""Rooms and floors: which rooms lose every exit, the ways that are left, and what is to be expected floor by floor."""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import replace

from assess.inventory.model import Place
from assess.routes.bits import union
from assess.routes.draws import Draws
from assess.routes.model import Chance, FloorRoutes, RoomResult, Way
from assess.routes.network import Part, build_course, build_graph, find_parts, find_rooms, find_ways
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of

UNKNOWN = 0.5
"""What the choice of the safest way takes for the chance of a segment of which nothing is known [-]."""


def list_rooms(scene: Scene) -> list[tuple[Place, Part]]:
    """Return every room that the network joins to a way out, and the part of it that lies on the room's ways out."""
    segments = {at: one.segment for at, one in enumerate(scene.reached)}
    places = scene.inventory.places
    parts = list(find_parts(build_graph(segments), kinds_of(places)))
    floors = {floor.floor: floor.elevation for floor in scene.inventory.floors}
    heights = {place.place: z for place in places if (z := floors.get(place.floor)) is not None}
    return list(find_rooms(places, parts, heights))


def evaluate_rooms(
    scene: Scene, parts: Sequence[tuple[Place, Part]], chance: Mapping[int, float], blind: Set[int]
) -> tuple[RoomResult, ...]:
    """Return what becomes of the rooms of `list_rooms`.

    `chance` is that of a blockage by segment; `blind` are the segments that are not evaluated.
    """
    unknown = dict.fromkeys(blind, UNKNOWN)
    return tuple(_room(scene, place, part, {**chance, **unknown}, blind) for place, part in parts)


def _room(scene: Scene, place: Place, part: Part, chance: Mapping[int, float], blind: Set[int]) -> RoomResult:
    def happens(draws: Draws) -> Sequence[int]:
        return part.cut_off(scene.blocked(draws, part.segments), [place.place], draws.every)

    loses = scene.chances(part.segments, happens)[0]
    unanchored = scene.chances_unanchored(part.segments, happens)
    together = scene.together(part.segments, happens)
    return RoomResult(
        place=place,
        exits=tuple(sorted({end for edge in part.edges for end in edge[:2]} & part.targets)),
        by_stairs=part.by_stairs,
        loses=loses,
        if_anchors_fail=unanchored[0] if unanchored else None,
        blocker=max(together, key=lambda item: (together[item], -item), default=None),
        ways=tuple(_ways(scene, place, part, chance)),
        unevaluated=tuple(at for at in part.segments if at in blind),
    )


def _ways(scene: Scene, place: Place, part: Part, chance: Mapping[int, float]) -> Iterator[Way]:
    ways = find_ways(part, place.place, chance)
    found = [Way(segments=segments, end=end, blocked=any_blocked(scene, segments)) for segments, end in ways]
    found.sort(key=lambda way: way.blocked.probability)
    for way in found:
        yield replace(way, shared=tuple(at for at in way.segments if way is not found[0] and at in found[0].segments))


def any_blocked(scene: Scene, segments: Sequence[int]) -> Chance:
    """Return the chance that any of some segments is blocked."""
    return scene.chances(segments, lambda draws: [union(scene.blocked(draws, segments).values())])[0]


def evaluate_floors(
    scene: Scene, parts: Sequence[tuple[Place, Part]], chance: Mapping[int, float], rooms: Sequence[RoomResult]
) -> tuple[FloorRoutes, ...]:
    """Return what is to be expected on every floor that has segments or rooms; `rooms` are those of `parts`."""
    found = []
    for floor in scene.inventory.floors:
        segments = [at for at, one in enumerate(scene.reached) if one.segment.floor == floor.floor]
        here = [(place, part) for place, part in parts if place.floor == floor.floor]
        if segments or here:
            routes = sorted({scene.reached[at].segment.route for at in segments})
            own = [room for room in rooms if room.place.floor == floor.floor]
            found.append(
                FloorRoutes(
                    floor=floor.floor,
                    segments=len(segments),
                    blocked_segments=sum(chance[at] for at in segments),
                    routes=len(routes),
                    blocked_routes=sum(_blocked_here(scene, route, segments) for route in routes),
                    rooms=len(own),
                    cut_off_rooms=sum(room.loses.probability for room in own),
                    any_room=_any_room(scene, here) if here else None,
                    uncounted=_count_unknown(scene, floor.floor, segments),
                )
            )
    return tuple(found)


def _count_unknown(scene: Scene, floor: str, segments: Sequence[int]) -> int:
    """Count the pieces of a floor of which nothing tells whether they fall onto one of its segments."""
    has_plan = any(scene.reached[at].band for at in segments)
    items = [item for item in scene.inventory.items if item.floor == floor and not item.route] if segments else []
    return sum(item.quantity for item in items if item.x is None or item.y is None or not has_plan)


def _blocked_here(scene: Scene, route: str, segments: Sequence[int]) -> float:
    """Return the chance that a route is blocked by its segments on one floor."""
    own = {at: one for at, one in scene.segments_of(route).items() if at in segments}
    course = build_course(own, kinds_of(scene.inventory.places))

    return scene.chances(own, lambda draws: [course.is_blocked(scene.blocked(draws, own), draws.every)])[0].probability


def _any_room(scene: Scene, rooms: Sequence[tuple[Place, Part]]) -> Chance:
    segments = sorted({at for _, part in rooms for at in part.segments})

    def happens(draws: Draws) -> Sequence[int]:
        blocked = scene.blocked(draws, segments)
        return [union(part.cut_off(blocked, [place.place], draws.every)[0] for place, part in rooms)]

    return scene.chances(segments, happens)[0]
