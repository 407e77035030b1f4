"""How often a year pieces fall, routes are blocked and rooms lose every exit: the hazard curve, integrated.

Every piece is rocked at several levels of ground PGA, the motions of all floors growing in proportion to it from those
of the scenario. The shares that fall are integrated over the hazard curve of the site, by the lognormal fitted to them
where it is near enough. At a given ground PGA the floors' motions still scatter: without that a rate comes out too low
by a factor of about two, so that the dispersion of the workbook is always in it, also where a run leaves it out. It is
one scale for the whole building, as the level is: so it is not drawn, but shares are averaged over it (`Integral`).

What is not simulated has no annual chance. Under motions that may be too weak, a rate is a lower bound.
"""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.annual_results import Annual, AnnualRow, AnnualTables, AnnualWays
from assess.arrays import BoolArray, FloatArray
from assess.hazard import HazardCurve
from assess.i18n import Text, fill, nfill
from assess.methods import Cases
from assess.methods.simulate import interval_width
from assess.pipeline.annual_integral import MOST_LEVELS, STEP, Integral, space
from assess.pipeline.assessment import Assessment
from assess.pipeline.floor_demand import Demand
from assess.pipeline.known_ground import Ground, find_ground
from assess.pipeline.level_falls import find_falls
from assess.pipeline.levels import RockedLevels, rock_levels
from assess.pipeline.verify import MOST_PAIRS
from assess.progress import Progress
from assess.rates import list_remarks
from assess.rocking.draws import CUT, MOTION
from assess.routes.chances import Couplings, Draws, Falls, find_chances, to_array
from assess.routes.network import build_course
from assess.routes.rooms import list_rooms
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of
from assess.settings import AUTO, RUNS, Settings
from assess.units import GRAVITY, ROUNDING

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


LOWER = 6
"""Levels that are added below at a time."""
MOST_RUNS, LEAST_RUNS = 1000, 50
"""Draws at a level: those of the run, but at most so many, and fewer where the results would need too much memory."""


def evaluate_annual(assessment: Assessment, *, jobs: int | None, progress: Progress) -> Annual | None:
    """Evaluate annual chances; None where the workbook names no hazard file.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    """
    curve, ground = assessment.inventory.hazard, find_ground(assessment.inventory)
    if curve is None:
        return None
    missing = _find_missing(assessment, ground)
    if missing or ground.pga is None:
        tables = replace(_describe_curve(curve), missing=missing)
        return Annual(tables, {}, AnnualWays({}, {}, {}))
    return _Annual(assessment, curve, assessment.settings.scale * ground.pga).evaluate(jobs, progress)


def _find_missing(assessment: Assessment, ground: Ground) -> Text | str:
    """Return what an annual chance needs and does not have, and how to give it; "" where all is there."""
    cases, suite = assessment.cases, assessment.suite
    if assessment.settings.verify == "none":
        return fill("no piece was simulated, which chances a year need")
    if not (cases.ensemble >= 0).any():
        return fill("there is no piece that was simulated and can rock")
    if suite is not None and not assessment.settings.scale_motions:
        return fill("the user's own motions are not scaled to the floors, so that their ground PGA is not known")
    sources = {assessment.case_demand[case].source for case in np.flatnonzero(cases.ensemble >= 0)}
    if ground.find_pga(sources) is None:
        return fill(
            "the peak ground acceleration of this scenario is not known: fill in Ground PGA in Building, that of the "
            "same earthquake as the floors' motions"
        )
    return ""


def _find_dispersion(demand: Demand) -> float:
    """Return the standard deviation of ln of a floor's amplitude at a ground PGA [-]."""
    if demand.own_dispersion or demand.motion is None:
        return demand.own_dispersion
    return MOTION


def _describe_curve(curve: HazardCurve) -> AnnualTables:
    return AnnualTables(
        file=curve.file,
        latitude=curve.latitude,
        longitude=curve.longitude,
        distance_km=None if curve.distance is None else curve.distance / 1000,
        curve_pga_g=tuple((curve.pga / GRAVITY).tolist()),
        curve_rate=tuple(curve.rate.tolist()),
        remarks=tuple(curve.remarks),
    )


@dataclass(frozen=True)
class _Annual:
    """The annual chances of one building; `ground` is the ground PGA to which its floors' motions belong [m/s2]."""

    assessment: Assessment
    curve: HazardCurve
    ground: float

    @property
    def cases(self) -> Cases:
        """The cases, with the dispersion of the floors' motions at a ground PGA.

        On floors with a record it is never none; drawn motions scatter by themselves.
        """
        found = [_find_dispersion(one) for one in self.assessment.case_demand]
        return replace(self.assessment.cases, dispersion=np.array(found, dtype=np.float64))

    @property
    def largest(self) -> float:
        """The factor that no motion at a ground PGA exceeds [-]."""
        return math.exp(CUT * float(self.cases.dispersion.max(initial=0.0)))

    @property
    def settings(self) -> Settings:
        """The settings, with a number of draws."""
        settings, pairs = self.assessment.settings, MOST_LEVELS * int((self.assessment.cases.ensemble >= 0).sum())
        runs = RUNS if settings.runs == AUTO else int(settings.runs)
        return replace(settings, runs=min(runs, MOST_RUNS, max(LEAST_RUNS, MOST_PAIRS // pairs)))

    @property
    def floor(self) -> float:
        """The lowest level that matters, as ground PGA [m/s2]: scattered motions of the first point of the curve."""
        return float(self.curve.pga[0]) / self.largest

    def find_levels(self) -> FloatArray:
        """Return rising levels, as ground PGA [m/s2]: from where about nothing rocks to beyond the end of the curve."""
        cases = self.cases
        rocked = cases.ensemble >= 0
        start = cases.still[rocked] * GRAVITY * cases.threshold[rocked] / cases.pfa[rocked]
        last = float(self.curve.pga[-1]) * self.largest
        return space(float(np.clip(self.ground * start.min(), self.floor, last / STEP)), last)

    def evaluate(self, jobs: int | None, progress: Progress) -> Annual:
        """Rock every piece at every level, and integrate; where some fall at the lowest one, at lower ones too."""
        levels = self.find_levels()
        rocked = self._rock(levels, jobs, progress)
        while levels[0] > self.floor * (1 + ROUNDING) and any(one.fell[0].any() for one in rocked):
            lower = space(max(levels[0] / STEP**LOWER, self.floor), levels[0])[:-1]
            levels = np.concatenate([lower, levels])
            rocked = [
                replace(one, fell=np.concatenate([below.fell, one.fell]))
                for below, one in zip(self._rock(lower, jobs, progress), rocked, strict=True)
            ]
        return progress.wait_for(lambda: self._integrate(levels, rocked, progress))

    def _rock(self, levels: FloatArray, jobs: int | None, progress: Progress) -> list[RockedLevels]:
        cases, assessment = self.cases, self.assessment
        factors = np.repeat((levels / self.ground)[np.newaxis], len(cases.ensembles), axis=0)
        return rock_levels(
            cases, assessment.case_item, assessment.case_demand, factors, self.settings,
            dispersion=np.zeros(cases.breadth.size), jobs=jobs, progress=progress,
        )  # fmt: skip

    def _integrate(self, levels: FloatArray, rocked: Sequence[RockedLevels], progress: Progress) -> Annual:
        assessment, cases = self.assessment, self.cases
        falls = [self._find_falls(at, float(level), rocked) for at, level in enumerate(levels)]
        spreads = sorted({float(one) for one in cases.dispersion})
        integrals = {one: Integral(self.curve, levels, one, int(self.settings.runs)) for one in spreads}
        integrate = integrals[spreads[-1]]  # of the whole building: the largest
        of_item = {
            item: max(float(one) for one in cases.dispersion[assessment.case_item == item]) for item in falls[0].fell
        }
        ensembles = zip(self.cases.ensembles, rocked, strict=True)
        own = [one.own for made, one in ensembles if made.is_unknown or one.is_weak]
        doubtful = frozenset(self.assessment.case_item[np.concatenate(own)].tolist() if own else ())
        fell = {item: np.array([one.fell[item] for one in falls]) for item in sorted(falls[0].fell)}
        shares = self._average(fell)
        items = {item: integrals[of_item[item]].of_draws(shares[item], at_least=item in doubtful) for item in fell}
        counted = [item for item in items if not assessment.anchors.held[item]]
        several = {at for at, item in enumerate(assessment.inventory.items) if item.quantity > 1}
        ways = evaluate_ways(assessment, falls, integrate, doubtful | several, self.settings, progress)
        return Annual(self._describe(levels, integrate, items, fell, counted, doubtful), items, ways)

    def _average(self, fell: Mapping[int, BoolArray]) -> dict[int, FloatArray]:
        """Return for each piece the share of it and those exactly like it that fall, by level and draw."""
        owns: dict[int, list[int]] = {}
        for item, kind in zip(self.assessment.case_item.tolist(), self.cases.alike.tolist(), strict=True):
            owns.setdefault(item, []).append(kind)
        groups: dict[tuple[int, ...], list[int]] = {}
        for item in fell:
            groups.setdefault(tuple(owns[item]), []).append(item)
        quantity = [one.quantity for one in self.assessment.inventory.items]
        found: dict[int, FloatArray] = {}
        for group in groups.values():
            falls = sum(quantity[item] * fell[item] for item in group)
            found |= dict.fromkeys(group, np.asarray(falls / sum(quantity[item] for item in group)))
        return found

    def _find_falls(self, at: int, level: float, rocked: Sequence[RockedLevels]) -> Falls:
        pfa = self.assessment.cases.pfa * (level / self.ground)
        every = [(one.own, one.fell[at]) for one in rocked]
        return find_falls(self.assessment, self.cases, pfa, every, self.settings)

    def _describe(
        self,
        levels: FloatArray,
        integrate: Integral,
        items: Mapping[int, AnnualRow],
        fell: Mapping[int, BoolArray],
        counted: Sequence[int],
        doubtful: Collection[int],
    ) -> AnnualTables:
        """Return what stands for the building; `counted` were simulated, of `doubtful` the motions may be too weak."""
        inventory = self.assessment.inventory
        quantity = {item: inventory.items[item].quantity for item in counted}
        safety = {item: fell[item] for item in counted if inventory.items[item].importance == "life safety"}
        too_stocky = {int(item) for item in self.assessment.case_item[self.cases.is_stocky]}
        everything, free = sum(quantity.values()), self._list_free()
        stocky = sum(inventory.items[at].quantity for at in too_stocky.intersection(free))
        unknown = sum(inventory.items[at].quantity for at in free) - everything - stocky
        weak = sum(quantity[item] for item in counted if item in doubtful)
        found = replace(
            _describe_curve(self.curve),
            ground_pga_g=self.ground / GRAVITY,
            motion_dispersion=integrate.dispersion,
            runs=integrate.runs,
            factors=tuple((levels / self.ground).tolist()),
            pieces=everything,
            not_evaluated=unknown,
            cannot_rock=stocky,
            at_least=weak,
            is_lower_bound=bool(weak or unknown),
            life_safety_pieces=sum(quantity[item] for item in safety),
            life_safety=self._join(safety, items, integrate),
        )
        return _add_falls(found, integrate, quantity, items, fell) if counted else found

    def _list_free(self) -> list[int]:
        """Return the pieces that do not count as anchored, by their index."""
        free: list[int] = np.flatnonzero(~self.assessment.anchors.held).tolist()
        return free

    def _join(
        self, fell: Mapping[int, BoolArray], items: Mapping[int, AnnualRow], integrate: Integral
    ) -> AnnualRow | None:
        """Return the annual row of any life-safety piece falling; None where none was simulated.

        A lower bound where one of them is, where pieces of a row fall together, and where some were not simulated.
        """
        if not fell:
            return None
        stocky = set(self.assessment.case_item[self.cases.is_stocky].tolist())
        every = self.assessment.inventory.items
        wanted = {at for at in self._list_free() if every[at].importance == "life safety"} - stocky
        several = any(self.assessment.inventory.items[item].quantity > 1 for item in fell)
        at_least = several or bool(wanted - fell.keys()) or any(items[item].at_least for item in fell)
        return integrate.of_draws(np.any(list(fell.values()), axis=0), at_least=at_least)


def _add_falls(
    found: AnnualTables,
    integrate: Integral,
    quantity: Mapping[int, int],
    items: Mapping[int, AnnualRow],
    fell: Mapping[int, BoolArray],
) -> AnnualTables:
    """Return the tables with how many of the pieces in `quantity` fall a year, and what the ends of the curve do."""
    falls = np.zeros((integrate.levels.size, integrate.runs))
    for item, count in quantity.items():
        falls += count * fell[item]
    total, spread = integrate.add_up(falls, found.pieces), integrate.find_spread(falls)
    expected = sum(count * items[item].rate for item, count in quantity.items())
    return replace(
        found,
        is_lower_bound=found.is_lower_bound or total.is_cut,
        expected_falls=expected,
        expected_low=None if spread is None else max(0.0, expected * (1 - spread)),
        expected_high=None if spread is None else expected * (1 + spread),
        remarks=(*list_remarks(integrate.curve, total), *_remark_on_ends(quantity, items)),
    )


def _remark_on_ends(quantity: Mapping[int, int], items: Mapping[int, AnnualRow]) -> Iterator[Text]:
    """Say for how many of the counted pieces the ends of the curve matter."""
    found = sum(count for item, count in quantity.items() if items[item].ends_matter)
    if found:
        yield nfill(
            "for {n:,} piece more than 5 % of the annual rate comes, or could come, from outside the curve",
            "for {n:,} pieces more than 5 % of the annual rate comes, or could come, from outside the curve",
            found,
        )
