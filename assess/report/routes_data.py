"""The evacuation routes in results.json: segments, routes, rooms and floors, with every chance and its bounds."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from assess.inventory.model import Item, Segment
from assess.results import Assessment
from assess.routes.model import (
    Beside,
    Chance,
    FloorRoutes,
    Outlook,
    RoomResult,
    RouteResult,
    Routes,
    RouteState,
    SegmentResult,
    Way,
)

UNKNOWN = "not evaluated"
"""State of a segment or route of which nothing tells which pieces can reach it."""


def routes_record(assessment: Assessment) -> dict[str, Any]:
    """Return what was found of the routes: empty lists where the workbook names none."""
    routes, items = assessment.routes, assessment.inventory.items
    return {
        "risk": assessment.settings.route_risk,
        "blocked_routes_expected": routes.blocked_routes if routes else 0.0,
        "cut_off_rooms_expected": routes.cut_off_rooms if routes else 0.0,
        "draws": routes.draws if routes else 0,
        "uncounted_pieces": sum(one.uncounted for one in routes.floors) if routes else 0,
        "segments": [segment_record(one, items) for one in routes.segments] if routes else [],
        "routes": [route_record(one, routes, items) for one in routes.routes] if routes else [],
        "rooms": [room_record(one, routes, items) for one in routes.rooms] if routes else [],
        "floors": [floor_routes_record(one) for one in routes.floors] if routes else [],
    }


def segment_record(one: SegmentResult, items: Sequence[Item]) -> dict[str, Any]:
    """Return one segment: as the workbook has it, the widths that were used, and what may become of it."""
    is_known = one.is_evaluated
    return {
        **_given(one.segment),
        "evaluated": is_known,
        "clear_width_used_m": one.clear,
        "required_width_used_m": one.required,
        "standing_width_m": one.standing,
        "least_width_m": one.least if is_known else None,
        "needed_width_m": one.needed,
        "length_m": one.length,
        **outlook_record(one.outlook, items, is_evaluated=is_known),
        "is_blocked_standing": one.is_blocked_standing,
        "insufficient_for_occupants": one.is_short,
        "insufficient_after_falls": chance_record(one.crowded if is_known or one.is_short else None),
        "pieces": [beside_record(near, items) for near in one.beside],
        "other_rooms": [items[at].item for at in one.other_rooms],
        "flags": list(one.flags),
    }


def _given(segment: Segment) -> dict[str, Any]:
    """Return what the workbook says of a segment."""
    return {
        "route": segment.route,
        "segment": segment.segment,
        "floor": segment.floor or None,
        "from": segment.start or None,
        "to": segment.end or None,
        "room": segment.room or None,
        "clear_width_m": segment.clear_width,
        "required_width_m": segment.required_width,
        "occupants": segment.occupants,
        "notes": segment.notes,
    }


def outlook_record(one: Outlook, items: Sequence[Item], *, is_evaluated: bool) -> dict[str, Any]:
    """Return what may become of a segment or of a route; without chances where it is not evaluated."""
    return {
        "state": one.state.word if is_evaluated else UNKNOWN,
        "state_upper": one.upper.word if is_evaluated else UNKNOWN,
        "blocked": chance_record(one.blocked if is_evaluated else None),
        "blocked_or_reduced": chance_record(one.taken if is_evaluated else None),
        "blocked_if_anchors_fail": chance_record(one.if_anchors_fail),
        "under_record": _word(one.in_record),
        "most_likely_piece": _named(one.blocker, items),
    }


def beside_record(one: Beside, items: Sequence[Item]) -> dict[str, Any]:
    """Return a piece beside a segment."""
    return {
        **piece_record(one.item, items),
        "by_plan": one.by_plan,
        "distance_m": one.distance,
        "reach_m": one.reach,
        "left_m": one.left,
        "blocks_alone": one.blocks_alone,
        "falls_while_blocked": one.together,
        "flags": list(one.flags),
    }


def route_record(one: RouteResult, routes: Routes, items: Sequence[Item]) -> dict[str, Any]:
    """Return one route with what is to be fixed for it."""
    return {
        "route": one.route,
        "floors": list(one.floors),
        "segments": list(one.segments),
        "evaluated": one.is_evaluated,
        "unevaluated_segments": name_segments(one.unevaluated, routes),
        **outlook_record(one.outlook, items, is_evaluated=one.is_evaluated),
        "fixes": [piece_record(fix.item, items) | {"gain": fix.gain, "left": fix.left} for fix in one.fixes],
        "is_mended": one.is_mended,
    }


def room_record(one: RoomResult, routes: Routes, items: Sequence[Item]) -> dict[str, Any]:
    """Return one room with its ways out."""
    return {
        "room": one.place.place,
        "floor": one.place.floor,
        "exits": list(one.exits),
        "by_stairs": one.by_stairs,
        "loses_every_exit": chance_record(one.loses),
        "loses_if_anchors_fail": chance_record(one.if_anchors_fail),
        "most_likely_piece": _named(one.blocker, items),
        "unevaluated_segments": name_segments(one.unevaluated, routes),
        "ways": [way_record(way, routes) for way in one.ways],
    }


def way_record(one: Way, routes: Routes) -> dict[str, Any]:
    """Return one way out."""
    return {
        "segments": list(one.segments),
        "end": one.end,
        "blocked": chance_record(one.blocked),
        "shared": name_segments(one.shared, routes),
    }


def floor_routes_record(one: FloorRoutes) -> dict[str, Any]:
    """Return what is to be expected on one floor."""
    return {
        "floor": one.floor,
        "segments": one.segments,
        "blocked_segments_expected": one.blocked_segments,
        "routes": one.routes,
        "blocked_routes_expected": one.blocked_routes,
        "rooms": one.rooms,
        "cut_off_rooms_expected": one.cut_off_rooms,
        "any_room_cut_off": chance_record(one.any_room),
        "uncounted_pieces": one.uncounted,
    }


def name_segments(places: Sequence[int], routes: Routes) -> list[str]:
    """Return the names of segments by their places."""
    return [routes.segments[at].segment.segment for at in places]


def chance_record(one: Chance | None) -> dict[str, Any] | None:
    """Return a chance with its interval and its bounds; None where there is none."""
    return None if one is None else asdict(one)


def piece_record(item: int, items: Sequence[Item]) -> dict[str, Any]:
    """Return what a piece is found by: its name and its row in the workbook."""
    return {"item": items[item].item, "row": items[item].row}


def _named(item: int | None, items: Sequence[Item]) -> dict[str, Any] | None:
    return None if item is None else piece_record(item, items)


def _word(state: RouteState | None) -> str | None:
    return None if state is None else state.word
