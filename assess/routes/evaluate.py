"""The evacuation routes of a building: what may be blocked, by what, and how likely."""

from collections.abc import Sequence, Set
from dataclasses import replace

import numpy as np

from assess.inventory.model import Inventory
from assess.methods.housner_monte_carlo import interval_width
from assess.routes.couplings import DRAWS
from assess.routes.falls import Falls
from assess.routes.fixes import find_fixes
from assess.routes.model import Beside, Chance, RouteResult, Routes, SegmentResult
from assess.routes.network import build_course
from assess.routes.reach import Reached
from assess.routes.rooms import evaluate_floors, evaluate_rooms, list_rooms
from assess.routes.scene import Scene
from assess.routes.widths import NARROWER, kinds_of, needed_width
from assess.settings import Settings


def evaluate_routes(
    inventory: Inventory, reached: Sequence[Reached], falls: Falls, settings: Settings
) -> Routes | None:
    """Evaluate the routes of an inventory.

    Parameters
    ----------
    inventory : Inventory
        The building.
    reached : sequence of Reached
        Its segments, from `assess.routes.reach.find_reached`.
    falls : Falls
        How its pieces fall.
    settings : Settings
        The chosen risk, the seed of draws where pieces are too many to go through all that may fall together, and the
        runs, by which the width of intervals goes.

    Returns
    -------
    Routes or None
        None where the inventory has no routes.
    """
    if not reached:
        return None
    scene = Scene(inventory, reached, falls, settings.route_risk, settings.seed, interval_width(settings))
    segments = tuple(_segment(scene, at) for at in range(len(reached)))
    chance = {at: one.outlook.blocked.probability for at, one in enumerate(segments)}
    blind = frozenset(at for at, one in enumerate(segments) if not one.is_evaluated)
    routes = tuple(_route(scene, name, blind) for name in dict.fromkeys(one.segment.route for one in reached))
    parts = list_rooms(scene)
    rooms = evaluate_rooms(scene, parts, chance, blind)
    return Routes(
        risk=settings.route_risk,
        segments=segments,
        routes=routes,
        rooms=rooms,
        floors=evaluate_floors(scene, parts, chance, rooms),
        blocked_routes=sum(one.outlook.blocked.probability for one in routes),
        cut_off_rooms=sum(one.loses.probability for one in rooms),
        draws=DRAWS,
    )


def _segment(scene: Scene, at: int) -> SegmentResult:
    one = scene.reached[at]
    needed = needed_width(one.segment, kinds_of(scene.inventory.places))
    standing = one.standing
    return SegmentResult(
        segment=one.segment,
        outlook=scene.outlook([at], lambda blocked, _every: blocked[at]),
        clear=one.clear,
        required=one.required,
        standing=standing,
        least=_least(scene, at),
        needed=needed,
        is_short=needed is not None and standing < needed - NARROWER,
        crowded=None if needed is None else _crowded(scene, at, needed),
        length=one.band.length if one.band else None,
        beside=tuple(_beside(scene, at)),
        flags=one.flags,
        is_evaluated=one.is_evaluated,
        other_rooms=one.other_rooms,
    )


def _least(scene: Scene, at: int) -> float:
    """Return the width that is left with every free-standing piece fallen [m]."""
    one = scene.reached[at]
    free = np.array([not scene.falls.anchored[item] for item, _ in one.gaps.keys], dtype=np.bool_)
    return one.gaps.residual(free)


def _crowded(scene: Scene, at: int, needed: float) -> Chance:
    return scene.chances([at], lambda draws: [scene.narrower(draws, at, needed)])[0]


def _beside(scene: Scene, at: int) -> list[Beside]:
    """Return the pieces beside a segment with the chance that each falls while it is blocked, the likeliest first.

    That of an anchored piece is the one with anchored pieces taken as free-standing.
    """
    found: dict[int, float] = {}
    for fail in (True, False):
        together = scene.together([at], lambda draws: list(scene.blocked(draws, [at]).values()), anchors_fail=fail)
        found |= {item: together.get(item, 0.0) for item, _ in scene.keys([at], anchors_fail=fail)}
    beside = [replace(one, together=found.get(one.item, 0.0)) for one in scene.reached[at].beside]
    falls = scene.falls
    return sorted(
        beside,
        key=lambda one: (
            bool(falls.anchored[one.item]),
            -one.together,
            one.left,
            -falls.probability[one.item],
            one.item,
        ),
    )


def _route(scene: Scene, name: str, blind: Set[int]) -> RouteResult:
    segments = scene.segments_of(name)
    course = build_course(segments, kinds_of(scene.inventory.places))
    lanes = {at: scene.reached[at] for at in segments}
    fixes, is_mended = find_fixes(scene.couplings(segments), lanes, course.is_blocked, scene.risk)
    return RouteResult(
        route=name,
        outlook=scene.outlook(tuple(segments), course.is_blocked),
        segments=tuple(segments),
        floors=tuple(dict.fromkeys(one.floor for one in segments.values() if one.floor)),
        fixes=tuple(fixes),
        is_mended=is_mended,
        unevaluated=tuple(at for at in segments if at in blind),
    )
