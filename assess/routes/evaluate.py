"""The evacuation routes of a building: which segments, routes and rooms could be lost, by what, and how likely."""

from collections.abc import Sequence
from dataclasses import replace
from operator import itemgetter
from typing import Any

import numpy as np

from assess.arrays import BoolArray
from assess.i18n import count
from assess.model import Inventory
from assess.progress import SILENT, Progress
from assess.route_results import BesideRow, RouteRow, RouteState, RouteTables, SegmentRow
from assess.routes.chances import DRAWS, Falls, to_array
from assess.routes.network import find_ends
from assess.routes.obstructions import Obstructions
from assess.routes.rooms import (
    evaluate_floor,
    evaluate_room,
    find_missing_after,
    list_fixes,
    list_rooms,
    list_rooms_to_furnish,
    list_unfurnished,
    list_unjoined,
)
from assess.routes.scene import Scene
from assess.routes.widths import NARROWER, kinds_of, needed_width
from assess.settings import Settings


def evaluate_routes(
    inventory: Inventory,
    obstructions: Sequence[Obstructions],
    falls: Falls,
    settings: Settings,
    *,
    progress: Progress = SILENT,
) -> RouteTables:
    """Return what is to be expected of the routes of an inventory; nothing where it has none.

    `obstructions`: its segments, from `assess.routes.obstructions.find_obstructions`. `falls`: how its pieces fall.
    `settings`: the chosen risk, the seed of draws where combinations of pieces are too many, and the runs, which decide
    the width of intervals. `progress` receives the stage "routes".
    """
    if not obstructions:
        return RouteTables(risk=settings.route_risk)
    scene = Scene.of(inventory, obstructions, falls, settings, progress)
    names = list(dict.fromkeys(one.segment.route for one in obstructions))
    parts = list_rooms(scene)
    floors = [one.floor for one in inventory.floors]
    steps = len(obstructions) + len(names) + len(parts) + len(floors)
    with progress.stage("routes", f"{count(len(obstructions), 'segment')} of {count(len(names), 'route')}") as stage:
        done = iter(range(1, steps + 1))

        def step(row: Any) -> Any:
            stage.at(next(done) / steps)
            return row

        segments = tuple(step(_segment(scene, at)) for at in range(len(obstructions)))
        routes = tuple(step(_route(scene, name, segments)) for name in names)
        rooms = tuple(step(evaluate_room(scene, place, part, segments)) for place, part in parts)
        by_floor = [step(evaluate_floor(scene, floor, parts, segments, rooms)) for floor in floors]
    by_floor = [one for one in by_floor if one.segments or one.rooms]  # the others have nothing to tell
    known, unjoined = [one for one in routes if one.state != RouteState.NOT_KNOWN], list_unjoined(scene, parts)
    counted = len(list_rooms_to_furnish(inventory))
    return RouteTables(
        risk=settings.route_risk,
        blocked_routes_expected=sum(one.blocked.probability for one in known if one.blocked),
        cut_off_rooms_expected=sum(one.loses_every_exit.probability for one in rooms if one.is_known),
        unknown_routes=len(routes) - len(known),
        unknown_rooms=sum(not one.is_known for one in rooms) + len(unjoined),
        draws=DRAWS,
        uncounted_pieces=sum(one.uncounted_pieces for one in by_floor),
        unjoined_rooms=unjoined,
        segments=segments,
        routes=routes,
        rooms=rooms,
        floors=tuple(by_floor),
        furnished_rooms=counted - len(list_unfurnished(inventory)),
        counted_rooms=counted,
    )


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
        route=segment.route,
        segment=segment.segment,
        floor=segment.floor or None,
        from_place=segment.start or None,
        to_place=segment.end or None,
        room=segment.room or None,
        clear_width_m=segment.clear_width,
        required_width_m=segment.required_width,
        occupants=segment.occupants,
        notes=segment.notes,
        workbook_row=segment.row,
        length_m=band.length if band else None,
        start_x_m=band.start[0] if band else None,
        start_y_m=band.start[1] if band else None,
        end_x_m=band.end[0] if band else None,
        end_y_m=band.end[1] if band else None,
        extends_start_m=band.extends_start if band else 0.0,
        extends_end_m=band.extends_end if band else 0.0,
        **scene.outlook([at], lambda blocked, _every: blocked[at], is_evaluated=is_evaluated),
        evaluated=is_evaluated,
        clear_width_used_m=one.clear,
        required_width_used_m=one.required,
        standing_width_m=standing,
        # with every free-standing piece fallen
        least_width_m=one.gaps.residual(free) if is_evaluated else None,
        needed_width_m=needed,
        is_blocked_standing=one.is_blocked_standing,
        insufficient_for_occupants=is_short,
        insufficient_after_falls=crowded,
        pieces=tuple(_beside(scene, at)),
        other_rooms=tuple(scene.piece(item) for item in one.other_rooms),
        flags=one.flags,
    )


def _beside(scene: Scene, at: int) -> list[BesideRow]:
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
    outlook = scene.outlook(segments, course.is_blocked, is_evaluated=is_evaluated)
    fixes, is_fixed = list_fixes(scene, segments, course.is_blocked)
    chances = {at: (rows[at].state, rows[at].blocked) for at in segments}
    return RouteRow(
        route=name,
        floors=tuple(dict.fromkeys(one.floor for one in segments.values() if one.floor)),
        from_places=served,
        to_places=led,
        segment_indices=tuple(segments),
        evaluated=is_evaluated,
        unevaluated_segments=unevaluated,
        **outlook,
        decisive_segment=scene.find_decisive(chances, is_known=outlook["state"] != RouteState.NOT_KNOWN),
        fixes=fixes,
        is_fixed=is_fixed,
        missing_after=find_missing_after(scene, segments, fixes, course.is_blocked),
    )


def find_joint_draws(
    inventory: Inventory,
    obstructions: Sequence[Obstructions],
    falls: Falls,
    settings: Settings,
    runs: int,
    *,
    progress: Progress = SILENT,
) -> dict[str, BoolArray]:
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
        blocked = course.is_blocked(scene.blocked(draws, segments), draws.every)
        # where no piece reaches it, it is open in every draw, or in none
        found[name] = to_array(blocked, runs).astype(np.bool_) if couplings.runs else np.full(runs, bool(blocked))
    return found
