"""In which draws routes are blocked, where all that could block them was simulated in the same draws."""

from collections.abc import Sequence

import numpy as np

from assess.arrays import BoolArray
from assess.methods.simulate import interval_width
from assess.model import Inventory
from assess.progress import SILENT, Progress
from assess.routes.chances import Falls, to_array
from assess.routes.network import build_course
from assess.routes.obstructions import Obstructions
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of
from assess.settings import Settings


def find_joint_draws(
    inventory: Inventory,
    obstructions: Sequence[Obstructions],
    falls: Falls,
    settings: Settings,
    runs: int,
    *,
    progress: Progress = SILENT,
) -> dict[str, BoolArray]:
    """Return of each route that has joint outcomes in which of `runs` draws it is blocked, (runs,).

    If all anchors hold. A route has none where one of the pieces that reach it was not simulated, is not confirmed, or
    was simulated in another number of draws.

    Raises
    ------
    CancelledError
        If `progress` is cancelled.
    """
    z = interval_width(settings)
    scene = Scene(inventory, tuple(obstructions), falls, settings.route_risk, settings.seed, z, progress)
    names = list(dict.fromkeys(one.segment.route for one in obstructions))
    found = {name: _find_blocked(scene, name, runs) for name in names}
    return {name: blocked for name, blocked in found.items() if blocked is not None}


def _find_blocked(scene: Scene, name: str, runs: int) -> BoolArray | None:
    segments = scene.segments_of(name)
    couplings = scene.couplings(segments)
    if not couplings.is_joint or couplings.unconfirmed:
        return None
    draws, course = couplings.joint, build_course(segments, kinds_of(scene.inventory.places))
    blocked = course.is_blocked(scene.blocked(draws, segments), draws.every)
    if not couplings.runs:  # no piece reaches it: it is open in every draw, or in none
        return np.full(runs, bool(blocked))
    return to_array(blocked, runs).astype(np.bool_) if couplings.runs == runs else None
