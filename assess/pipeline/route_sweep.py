"""How likely each route is blocked, against the PFA on its floors.

At each value every floor of a route shakes with that PFA along both axes: by its own motions (those compatible with its
record, or drawn where it has none), each scaled by the value over the floor's PFA, as in `assess.pipeline.verify`. The
uncertainty is that of the workbook; with `settings.ideal` there is none. A piece that is too stocky to rock falls by
the formula's chance at that PFA. A blank axis takes the worse one at each value.

Unlike in an assessment, the formula never stands in for what rocking gives: it gives chances with no shaking at all.
Where the motions may be too weak, the chances are lower bounds, and those pieces are counted.

Where the chance of a route jumps from one value to the next, further values are inserted halfway, until it no longer
does, the step is small, or a number of them is reached. The same draws serve there too, so that a chance at one value
does not depend on which others are evaluated.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from assess.errors import InputError
from assess.methods import Ensemble
from assess.model import AXES
from assess.pipeline.adopt import Assessment
from assess.pipeline.ensembles import DrawnEnsemble, GeneratedEnsemble
from assess.pipeline.verify import RockedLevels, Sweep, choose_motions
from assess.progress import SILENT, Progress
from assess.rocking.draws import Uncertainty
from assess.route_results import Chance, PieceRef
from assess.routes.evaluate import count_unplaced
from assess.routes.fixes import find_fixes
from assess.routes.obstructions import Obstructions, find_obstructions
from assess.routes.scene import Judgement, Scene
from assess.settings import AUTO
from assess.units import ROUNDING

JUMP = 0.2
"""A chance that rises or falls by more than this between two values is not interpolated [-]; values are inserted."""
FINEST = 0.02
"""Step under which no value is inserted, as a share of the larger of its two values [-]."""
MOST_INSERTED = 24
"""Values that `assess routes` inserts at most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteFragility:
    """One route.

    * `blocked`: of its being blocked at each value, if all anchors hold.
    * `if_anchors_fail`: the same with anchored pieces taken as free-standing; None where there are none.
    * `is_evaluated`: whether it is known of any of its segments what can reach it.
    * `unevaluated`: names of the segments of which that is not known, at the largest value: the chances are without
      them, so lower bounds.
    * `doubtful`: pieces that reach it whose motions may be too weak; anchored ones count.
    * `scenario_pfa`: the least and the largest PFA of the scenario on its floors [m/s2]; None where its segments name
      no floor.
    * `causes`: the smallest set found of pieces without which it stays below the limit at the first value at which it
      does not; none where it stays below at every value, or where it is blocked with nothing fallen.
    """

    route: str
    floors: tuple[str, ...]
    blocked: tuple[Chance, ...]
    if_anchors_fail: tuple[Chance, ...] | None
    is_evaluated: bool
    unevaluated: tuple[str, ...]
    doubtful: int
    scenario_pfa: tuple[float, float] | None
    causes: tuple[PieceRef, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fragility:
    """How likely each route is blocked at each of `values` of PFA on its floors [m/s2].

    `inserted` are those of them that were not asked for. `limit` is the chosen risk [-], by which `causes` are found.
    `runs` is the number of draws, from `seed`; `uncertainty` is that of each, None where motions and pieces were taken
    as they are. `generic` names the floors for which ground motion and building are drawn, `unshaped` those of them for
    which nothing is known of the building, `weak` those whose motions are weaker than the floor's, as far as
    pieces on them were rocked; `stocky` counts the pieces that are too stocky to rock, `unplaced` those on the floors
    of the routes that have neither a usable position nor a Route: they are left out.
    """

    values: tuple[float, ...]
    inserted: frozenset[float]
    limit: float
    runs: int
    seed: int
    uncertainty: Uncertainty | None
    routes: tuple[RouteFragility, ...]
    generic: tuple[str, ...]
    unshaped: tuple[str, ...]
    weak: tuple[str, ...]
    stocky: int
    unplaced: int


def find_fragility(
    assessment: Assessment, values: Sequence[float], *, most_inserted: int = 0, jobs: int | None = None,
    progress: Progress = SILENT,
) -> Fragility:  # fmt: skip
    """Find how likely each route is blocked at each PFA.

    * `assessment`: of a building with routes, simulated or not; its settings give the number of the motions and their
      seed.
    * `values`: PFA on the floors of the routes [m/s2], above 0 and rising.
    * `most_inserted`: how many values are inserted at most, where a chance jumps.
    * `jobs`, `progress`: as in `find_piece_fragilities`.

    Raises InputError if the number of motions is "auto", if they are the user's own, or if the results may exceed the
    available memory.
    """
    if assessment.settings.runs == AUTO or assessment.suite is not None:
        raise InputError.about(
            'runs: the sweep over PFA needs a fixed number of generated motions, not "auto" or a suite'
        )

    def find() -> Fragility:
        inventory, settings, demands = assessment.inventory, assessment.settings, assessment.case_demand
        obstructions = find_obstructions(inventory, progress)
        beside = np.array(sorted({one.item_index for segment in obstructions for one in segment.pieces}), dtype=np.intp)
        chosen = np.isin(assessment.case_item, beside) & ~assessment.cases.is_stocky
        own = np.array([one.own_dispersion for one in demands], dtype=np.float64)  # without that of PGA
        drawn = replace(assessment.cases.earthquakes, given=())  # nor are there scenarios of it
        cases = replace(assessment.cases, dispersion=own, earthquakes=drawn)
        cases = choose_motions(cases, chosen, demands, assessment.demands, inventory, settings, None)
        sweep = Sweep(
            assessment=assessment, cases=cases, peaks=np.array([one.pfa for one in demands], dtype=np.float64),
            settings=settings, dispersion=None if settings.ideal else cases.dispersion, jobs=jobs,
            opened={} if most_inserted else None, progress=progress,
        )  # fmt: skip
        study = _Study(sweep, obstructions, beside, tuple(dict.fromkeys(one.segment.route for one in obstructions)))
        study.add(values)
        while new := study.halve(most_inserted + len(values) - len(study.levels)):
            study.add(new)
        return study.describe(values)

    return progress.wait_for(find)


def find_jumps(chances: Sequence[float]) -> list[int]:
    """Return after which values a chance jumps to the next by more than `JUMP`."""
    return [at for at, (one, other) in enumerate(pairwise(chances)) if abs(other - one) > JUMP + ROUNDING]


def find_passing(values: Sequence[float], chances: Sequence[float], level: float) -> tuple[float, float]:
    """Return between which PFA a chance first reaches a level: the same one twice, on straight lines, unless it jumps.

    Twice minus infinity where it is above the level at the first value already, infinity where it never reaches it.
    """
    at = next((at for at, chance in enumerate(chances) if chance >= level), None)
    if at is None:
        return math.inf, math.inf
    if at == 0:
        return (values[0],) * 2 if chances[0] == level else (-math.inf, -math.inf)
    if at - 1 in find_jumps(chances):
        return values[at - 1], values[at]
    share = (level - chances[at - 1]) / (chances[at] - chances[at - 1])
    return (values[at - 1] + share * (values[at] - values[at - 1]),) * 2


_Level = tuple[Scene, Mapping[str, Judgement]]
"""The building at one value of PFA: its segments with how pieces fall, and the chances of each route there."""


@dataclass(frozen=True, slots=True, eq=False)
class _Study:
    """The routes `names` at several values of PFA [m/s2], and the pieces `beside` them (indices)."""

    sweep: Sweep
    obstructions: tuple[Obstructions, ...]
    beside: NDArray[np.intp]
    names: tuple[str, ...]
    levels: dict[float, _Level] = field(default_factory=dict)
    rocked: list[RockedLevels] = field(default_factory=list)
    """Of the values that were added last."""

    @property
    def values(self) -> list[float]:
        """The values evaluated so far, the least first."""
        return sorted(self.levels)

    def add(self, values: Sequence[float]) -> None:
        """Evaluate further values; what was evaluated before stays as it is."""
        sweep, settings = self.sweep, self.sweep.settings
        self.rocked[:] = sweep.rock(np.array(values, dtype=np.float64))
        for at, value in enumerate(values):
            falls = sweep.find_falls(np.full(sweep.cases.pfa.size, value), self.rocked, at)
            scene = Scene.of(sweep.assessment.inventory, self.obstructions, falls, settings, sweep.progress)
            judged = {}
            for name in self.names:
                segments = scene.segments_of(name)
                judged[name] = scene.judge(segments, scene.when_blocked(segments, scene.course(segments)))
            self.levels[value] = scene, judged

    def halve(self, most: int) -> list[float]:
        """Return values halfway between two at which the chance of any route jumps, the largest jumps first."""
        values, largest = self.values, dict[int, float]()
        levels = [self.levels[value] for value in values]
        for name in self.names:  # if anchors hold, and if they fail where there are any
            judged = [routes[name] for _, routes in levels]
            fail = [one.if_anchors_fail for one in judged if one.if_anchors_fail]
            for ways in ([one.chances[0] for one in judged], fail if len(fail) == len(judged) else []):
                chances = [one.probability for one in ways]
                for at in find_jumps(chances):
                    largest[at] = max(largest.get(at, 0.0), abs(chances[at + 1] - chances[at]))
        wide = [at for at in largest if values[at + 1] - values[at] >= FINEST * values[at + 1]]
        chosen = sorted(wide, key=lambda at: (-largest[at], at))[: max(most, 0)]
        return [(values[at] + values[at + 1]) / 2 for at in sorted(chosen)]

    def describe(self, given: Sequence[float]) -> Fragility:
        """Return what was found; `given` are the values that were asked for."""
        assessment, settings, cases = self.sweep.assessment, self.sweep.settings, self.sweep.cases
        inventory, (scene, _) = assessment.inventory, self.levels[self.values[0]]
        ensembles = list(zip(cases.ensembles, self.rocked, strict=True))
        doubtful = [assessment.case_item[one.own] for made, one in ensembles if made.is_unknown or one.is_weak]
        items = frozenset(np.concatenate(doubtful).tolist() if doubtful else ())

        def name_floors(chosen: Iterable[Ensemble]) -> tuple[str, ...]:
            names = {one.demand.floor.floor for one in chosen if isinstance(one, GeneratedEnsemble | DrawnEnsemble)}
            return tuple(floor.floor for floor in inventory.floors if floor.floor in names)

        too_stocky = np.intersect1d(self.beside, assessment.case_item[assessment.cases.is_stocky])
        uncertainty = replace(cases.uncertainty, motion=float(cases.dispersion.max(initial=0.0)))
        return Fragility(
            values=tuple(self.values), inserted=frozenset(self.values) - set(given), limit=settings.route_risk,
            runs=int(settings.runs), seed=settings.seed, uncertainty=None if settings.ideal else uncertainty,
            routes=tuple(self._describe_route(name, items) for name in self.names),
            generic=name_floors(made for made, _ in ensembles if made.is_assumed),
            unshaped=name_floors(made for made, _ in ensembles if made.is_unknown),
            weak=name_floors(made for made, one in ensembles if one.is_weak),
            stocky=sum(inventory.items[at].quantity for at in too_stocky),
            unplaced=sum(count_unplaced(scene, floor.floor) for floor in inventory.floors),
        )  # fmt: skip

    def _describe_route(self, name: str, doubtful: frozenset[int]) -> RouteFragility:
        assessment, levels = self.sweep.assessment, [self.levels[value] for value in self.values]
        (first, _), (last, _), judged = levels[0], levels[-1], [routes[name] for _, routes in levels]
        segments, risk = first.segments_of(name), self.sweep.settings.route_risk
        causes: tuple[PieceRef, ...] = ()
        reached = (scene for scene, routes in levels if routes[name].chances[0].probability >= risk)
        if (scene := next(reached, None)) is not None:  # at the first value that is not below the limit
            lanes, is_blocked = {at: self.obstructions[at] for at in segments}, first.course(segments)
            steps, _ = find_fixes(scene.couplings(segments), lanes, is_blocked, risk, progress=self.sweep.progress)
            causes = tuple(scene.piece(item) for item, _, _ in steps)
        floors = tuple(dict.fromkeys(one.floor for one in segments.values() if one.floor))
        peaks = [demand.pfa for floor in floors for axis in AXES for demand in assessment.demands[floor, axis]]
        unknown = [at for at in segments if last.is_unknown(at) or not last.is_evaluated(at)]
        reaching = {item for item, _ in first.keys(segments, anchors_fail=True)}
        return RouteFragility(
            route=name, floors=floors,
            blocked=tuple(one.chances[0] for one in judged),
            if_anchors_fail=tuple(one.if_anchors_fail for one in judged if one.if_anchors_fail) or None,
            is_evaluated=len(unknown) < len(segments),
            unevaluated=tuple(segments[at].segment for at in unknown),
            doubtful=sum(assessment.inventory.items[item].quantity for item in reaching & doubtful),
            scenario_pfa=(min(peaks), max(peaks)) if peaks else None, causes=causes,
        )  # fmt: skip
