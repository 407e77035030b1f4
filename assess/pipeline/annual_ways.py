"""How often a year routes are blocked and rooms lose every exit, from how pieces fall at each level of shaking."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from assess.annual_results import AnnualRow, AnnualWays
from assess.methods import interval_width
from assess.pipeline.annual_integral import Integral
from assess.pipeline.assessment import Assessment
from assess.progress import Progress
from assess.routes.chances import Couplings, Draws, Falls, find_chances, to_array
from assess.routes.network import build_course
from assess.routes.rooms import list_rooms
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of
from assess.settings import Settings

Happens = Callable[[Scene, Draws], int]
"""Returns of a scene and some draws the set of those in which something happens."""


def evaluate_ways(
    assessment: Assessment,
    falls: Sequence[Falls],
    integral: Integral,
    doubtful: Collection[int],
    settings: Settings,
    progress: Progress,
) -> AnnualWays:
    """Evaluate the routes of which any segment is evaluated, and the rooms of the network.

    Parameters
    ----------
    assessment : Assessment
        Of the building.
    falls : sequence of Falls
        How its pieces fall at each level.
    integral : Integral
        Over the hazard curve, at the same levels.
    doubtful : collection of int
        Pieces (by index) whose falls are rather too few: what rests on them is a lower bound.
    settings : Settings
        Of the draws.
    progress : Progress
        Checked for a cancel.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    """
    if not assessment.obstructions:
        return AnnualWays({}, {}, {})
    z, lanes = interval_width(settings), tuple(assessment.obstructions)
    scenes = [Scene(assessment.inventory, lanes, one, settings.route_risk, settings.seed, z, progress) for one in falls]
    ways = _Ways(scenes, integral, frozenset(doubtful))
    names = dict.fromkeys(one.segment.route for one in lanes if one.is_evaluated)
    found = {name: ways.route(name) for name in names}
    return AnnualWays(
        routes={name: row for name, (row, _) in found.items()},
        routes_if_anchors_fail={name: row for name, (_, row) in found.items() if row is not None},
        rooms={
            place.place: ways.find(
                part.segments,
                lambda scene, draws, part=part, name=place.place: part.cut_off(  # type: ignore[misc]
                    scene.blocked(draws, part.segments), [name], draws.every
                )[0],
            )
            for place, part in list_rooms(scenes[0])
        },
    )


@dataclass(frozen=True, slots=True)
class _Ways:
    """The segments at each level."""

    scenes: Sequence[Scene]
    integral: Integral
    doubtful: frozenset[int]

    def route(self, name: str) -> tuple[AnnualRow, AnnualRow | None]:
        """Return the rows of a route if all anchors hold, and if they fail; None where it has no anchored pieces."""
        first = self.scenes[0]
        segments = first.segments_of(name)
        course = build_course(segments, kinds_of(first.inventory.places))

        def happens(scene: Scene, draws: Draws) -> int:
            return course.is_blocked(scene.blocked(draws, segments), draws.every)

        anchored = any(first.falls.anchored[item] for item, _ in first.keys(segments, anchors_fail=True))
        fails = self.find(segments, happens, anchors_fail=True) if anchored else None
        return self.find(segments, happens), fails

    def find(self, segments: Collection[int], happens: Happens, *, anchors_fail: bool = False) -> AnnualRow:
        """Return the annual row of what happens on some segments."""
        every = [(scene, scene.couplings(segments, anchors_fail=anchors_fail)) for scene in self.scenes]
        last, own = every[-1]
        if not happens(last, own.ends):
            return self.integral.never
        shares = np.array([_share(scene, own, happens) for scene, own in every])
        spread = None
        if all(own.is_joint for _, own in every):
            runs = [own.joint.weight.size for _, own in every]
            spread = (
                self.integral.find_spread(
                    np.array([to_array(happens(scene, own.joint), runs[0]) for scene, own in every])
                )
                if len(set(runs)) == 1
                else None
            )
        reaching = {item for item, _ in every[0][1].keys}
        return self.integral.of_shares(shares, spread, at_least=bool(reaching & self.doubtful))


def _share(scene: Scene, couplings: Couplings, happens: Happens) -> float:
    return find_chances(couplings, lambda draws: [happens(scene, draws)], scene.z)[0].probability
