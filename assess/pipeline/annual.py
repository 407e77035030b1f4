"""How often a year pieces fall, routes are blocked and rooms lose every exit: the hazard curve, integrated.

Every piece is rocked at several levels of ground PGA, the motions of all floors growing in proportion to it from those
of the scenario. The shares that fall are integrated over the hazard curve of the site, by the lognormal fitted to them
where it is near enough. At a given ground PGA the floors' motions still scatter: without that a rate comes out too low
by a factor of about two, so that the dispersion of the workbook is always in it, also where a run leaves it out. It is
one scale for the whole building, as the level is: so it is not drawn, but the share at a ground PGA is the mean of the
shares at levels about it, weighted by the normal distribution of ln scale, cut at 3 standard deviations as in a run.
That is the same as to draw the scale, without the error of drawing it, of which rare strong scales would make the most.

What is not simulated has no annual chance. Under motions that may be too weak, a rate is a lower bound.
"""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import YEARS, Annual, AnnualRow, AnnualTables, AnnualWays
from assess.arrays import BoolArray, FloatArray
from assess.fragility import fit_fragility
from assess.hazard import HazardCurve
from assess.i18n import Text, fill, nfill
from assess.methods.simulate import interval_width
from assess.pipeline.assessment import Assessment
from assess.pipeline.floor_demand import Demand
from assess.pipeline.known_ground import Ground, find_ground
from assess.pipeline.levels import RockedLevels, Sweep
from assess.pipeline.verify import MOST_PAIRS
from assess.progress import Progress
from assess.rates import evaluate_rate, integrate_table, list_remarks
from assess.risk import NORMAL_95
from assess.rocking.draws import CUT, MOTION
from assess.routes.chances import Couplings, Draws, find_chances, to_array
from assess.routes.network import build_course
from assess.routes.rooms import list_rooms
from assess.routes.scene import Scene
from assess.routes.widths import kinds_of
from assess.settings import AUTO, RUNS
from assess.units import GRAVITY, ROUNDING

STEP = 1.25
"""Each level is about so many times the one before [-]."""
MOST_LEVELS = 30
NODES = 61
"""Scales over which a share is averaged."""


def space(first: float, last: float) -> FloatArray:
    """Return levels from a first to a last, each about `STEP` times the one before."""
    return np.geomspace(first, last, min(MOST_LEVELS, math.ceil(math.log(last / first) / math.log(STEP)) + 1))


@dataclass(frozen=True)
class Integral:
    """A hazard curve, and levels at which shares are known.

    * `curve`: of the site.
    * `levels` (n,): rising levels, as ground PGA [m/s2].
    * `dispersion`: standard deviation of ln scale at a ground PGA [-], above 0.
    * `runs`: draws that a share comes from.
    """

    curve: HazardCurve
    levels: FloatArray
    dispersion: float
    runs: int

    @cached_property
    def points(self) -> FloatArray:
        """Ground PGA at which shares are integrated [m/s2], (m,)."""
        first, last = self.curve.pga[[0, -1]].tolist()
        return space(min(max(first, self.levels[0] * math.exp(-CUT * self.dispersion)), last / STEP), last)

    @cached_property
    def average(self) -> FloatArray:
        """The shares at `points` are this, (m, n), times those at the levels: below the first of them it is 0."""
        scales = np.linspace(-CUT, CUT, NODES)
        weight = np.exp(-(scales**2) / 2)
        known = np.log(np.concatenate([self.levels[:1] / STEP, self.levels]))
        at = np.log(self.points)[:, np.newaxis] + self.dispersion * scales
        shares = [np.interp(at, known, one) for one in np.eye(known.size)[1:]]
        return np.stack([one @ weight / weight.sum() for one in shares], axis=1)

    @cached_property
    def weights(self) -> FloatArray:
        """What a share of 1 at each level alone adds to an annual rate [1/year], (n,)."""
        at_points = [integrate_table(self.curve, self.points, one).rate for one in np.eye(self.points.size)]
        return np.asarray(np.array(at_points) @ self.average)

    def of_draws(self, happened: BoolArray | FloatArray, *, at_least: bool) -> AnnualRow:
        """Return the annual row of what happened, or its share, at each level and draw, (levels, draws)."""
        return self.of_shares(happened.mean(axis=1), self.find_spread(happened), at_least=at_least)

    def of_shares(self, shares: FloatArray, spread: float | None, *, at_least: bool) -> AnnualRow:
        """Return the annual row of shares (levels,); `spread` is the half width of the interval over the rate.

        Where the curve does not reach far enough it is a lower bound, without an interval.
        """
        at_points = np.clip(self.average @ shares, 0, 1)
        fitted = fit_fragility(self.points, at_points * self.runs, np.full(self.points.size, self.runs))
        found = evaluate_rate(self.curve, fitted)
        is_fitted, is_cut = fitted.is_lognormal, found.is_cut
        has_half = is_fitted and at_points.min() <= 0.5 <= at_points.max()
        spread = None if is_cut else spread
        return AnnualRow(
            rate=found.rate,
            low=None if spread is None else max(0.0, found.rate * (1 - spread)),
            high=None if spread is None else found.rate * (1 + spread),
            chance_a_year=found.chance_within(1),
            chance_in_50_years=found.chance_within(YEARS),
            fit="lognormal" if is_fitted else "table",
            median_g=fitted.median / GRAVITY if has_half else None,
            dispersion=fitted.dispersion if has_half else None,
            misfit=fitted.misfit if is_fitted else None,
            at_least=at_least or is_cut,
            ends_matter=found.ends_matter,
        )

    def find_spread(self, happened: NDArray[Any]) -> float | None:
        """Return the half width of the 95 % sampling interval of a rate, over the rate; None where nothing happened.

        By the table the rate is a mean over the draws, each with a rate of its own.
        """
        rates = self.weights @ happened
        mean = float(rates.mean())
        if mean <= 0 or rates.size <= 1:
            return None
        return NORMAL_95 * float(rates.std(ddof=1)) / math.sqrt(rates.size) / mean


NEVER = AnnualRow(
    rate=0.0, low=None, high=None, chance_a_year=0.0, chance_in_50_years=0.0, fit="table", median_g=None,
    dispersion=None, misfit=None, at_least=False, ends_matter=False,
)  # fmt: skip
"""The annual row of what cannot happen."""

# ---------------------------------------------------------------- routes and rooms

Happens = Callable[[Scene, Draws], int]
"""Returns of a scene and some draws the set of those in which something happens."""


@dataclass(frozen=True, slots=True)
class _Ways:
    """The segments at each level; what rests on `doubtful` pieces (indices), which fall too seldom, is a bound."""

    scenes: Sequence[Scene]
    integral: Integral
    doubtful: frozenset[int]

    def evaluate(self) -> AnnualWays:
        """Evaluate the routes of which any segment is evaluated, and the rooms of the network."""
        names = dict.fromkeys(one.segment.route for one in self.scenes[0].obstructions if one.is_evaluated)
        found = {name: self._evaluate_route(name) for name in names}
        return AnnualWays(
            routes={name: row for name, (row, _) in found.items()},
            routes_if_anchors_fail={name: row for name, (_, row) in found.items() if row is not None},
            rooms={
                place.place: self._find(
                    part.segments,
                    lambda scene, draws, part=part, name=place.place: part.cut_off(  # type: ignore[misc]
                        scene.blocked(draws, part.segments), [name], draws.every
                    )[0],
                )
                for place, part in list_rooms(self.scenes[0])
            },
        )

    def _evaluate_route(self, name: str) -> tuple[AnnualRow, AnnualRow | None]:
        """Return the rows of a route if all anchors hold, and if they fail; None where it has no anchored pieces."""
        first = self.scenes[0]
        segments = first.segments_of(name)
        course = build_course(segments, kinds_of(first.inventory.places))

        def happens(scene: Scene, draws: Draws) -> int:
            return course.is_blocked(scene.blocked(draws, segments), draws.every)

        anchored = any(first.falls.anchored[item] for item, _ in first.keys(segments, anchors_fail=True))
        fails = self._find(segments, happens, anchors_fail=True) if anchored else None
        return self._find(segments, happens), fails

    def _find(self, segments: Collection[int], happens: Happens, *, anchors_fail: bool = False) -> AnnualRow:
        every = [(scene, scene.couplings(segments, anchors_fail=anchors_fail)) for scene in self.scenes]
        last, own = every[-1]
        if not happens(last, own.ends):
            return NEVER

        def find_share(scene: Scene, own: Couplings) -> float:
            return find_chances(own, lambda draws: [happens(scene, draws)], scene.z)[0].probability

        shares, spread = np.array([find_share(scene, own) for scene, own in every]), None
        runs = {own.joint.weight.size for _, own in every} if all(own.is_joint for _, own in every) else set()
        if len(runs) == 1:
            (count,) = runs
            happened = [to_array(happens(scene, own.joint), count) for scene, own in every]
            spread = self.integral.find_spread(np.array(happened))
        reaching = {item for item, _ in every[0][1].keys}
        return self.integral.of_shares(shares, spread, at_least=bool(reaching & self.doubtful))


# ---------------------------------------------------------------- the building

LOWER = 6
"""Levels that are added below at a time."""
MOST_RUNS, LEAST_RUNS = 1000, 50
"""Draws at a level: those of the run, but at most so many, and fewer where the results would need too much memory."""


def evaluate_annual(assessment: Assessment, *, jobs: int | None, progress: Progress) -> Annual | None:
    """Evaluate annual chances; None where the workbook names no hazard file. CancelledError if it is stopped."""
    curve, ground = assessment.inventory.hazard, find_ground(assessment.inventory)
    if curve is None:
        return None
    tables = AnnualTables(
        file=curve.file,
        latitude=curve.latitude,
        longitude=curve.longitude,
        distance_km=None if curve.distance is None else curve.distance / 1000,
        curve_pga_g=tuple((curve.pga / GRAVITY).tolist()),
        curve_rate=tuple(curve.rate.tolist()),
        remarks=tuple(curve.remarks),
    )
    missing = _find_missing(assessment, ground)
    if missing or ground.pga is None:
        return Annual(replace(tables, missing=missing), {}, AnnualWays({}, {}, {}))
    settings, cases, own = assessment.settings, assessment.cases, assessment.settings.scale * ground.pga
    pairs, runs = MOST_LEVELS * int((cases.ensemble >= 0).sum()), RUNS if settings.runs == AUTO else int(settings.runs)
    settings = replace(settings, runs=min(runs, MOST_RUNS, max(LEAST_RUNS, MOST_PAIRS // pairs)))
    found = [_find_dispersion(one) for one in assessment.case_demand]
    sweep = Sweep(
        assessment=assessment, cases=replace(cases, dispersion=np.array(found, dtype=np.float64)),
        peaks=np.full(len(found), own), settings=settings, dispersion=np.zeros(len(found)), jobs=jobs,
        progress=progress,
    )  # fmt: skip
    return _Annual(sweep, curve, own, tables).evaluate()


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
    """Return the standard deviation of ln of a floor's amplitude at a ground PGA [-].

    On floors with a record it is never none; drawn motions scatter by themselves.
    """
    return demand.own_dispersion if demand.own_dispersion or demand.motion is None else MOTION


@dataclass(frozen=True)
class _Annual:
    """The annual chances of one building.

    * `sweep`: its cases, with the dispersion of the floors' motions at a ground PGA.
    * `curve`: the hazard.
    * `ground`: the ground PGA to which its floors' motions belong [m/s2].
    * `tables`: what the curve tells.
    """

    sweep: Sweep
    curve: HazardCurve
    ground: float
    tables: AnnualTables

    @property
    def assessment(self) -> Assessment:
        """The building."""
        return self.sweep.assessment

    def evaluate(self) -> Annual:
        """Rock every piece at every level of ground PGA, and integrate.

        Levels reach from where about nothing rocks to beyond the end of the curve. Where some fall at the lowest one,
        lower ones are added, down to that of scattered motions of the first point of the curve.
        """
        cases = self.sweep.cases
        largest = math.exp(CUT * float(cases.dispersion.max(initial=0.0)))  # no factor at a ground PGA exceeds it
        floor, last = float(self.curve.pga[0]) / largest, float(self.curve.pga[-1]) * largest
        own = cases.ensemble >= 0
        start = cases.still[own] * GRAVITY * cases.threshold[own] / cases.pfa[own]
        levels = space(float(np.clip(self.ground * start.min(), floor, last / STEP)), last)
        rocked = self.sweep.rock(levels)
        while levels[0] > floor * (1 + ROUNDING) and any(one.fell[0].any() for one in rocked):
            lower = space(max(levels[0] / STEP**LOWER, floor), levels[0])[:-1]
            levels = np.concatenate([lower, levels])
            rocked = [
                replace(one, fell=np.concatenate([below.fell, one.fell]))
                for below, one in zip(self.sweep.rock(lower), rocked, strict=True)
            ]
        return self.sweep.progress.wait_for(lambda: self._integrate(levels, rocked))

    def _integrate(self, levels: FloatArray, rocked: Sequence[RockedLevels]) -> Annual:
        assessment, sweep, case_item = self.assessment, self.sweep, self.assessment.case_item
        cases, settings, inventory = sweep.cases, sweep.settings, assessment.inventory
        falls = [
            sweep.find_falls(assessment.cases.pfa * (level / self.ground), rocked, at)
            for at, level in enumerate(levels.tolist())
        ]
        integrals = {
            one: Integral(self.curve, levels, one, int(settings.runs)) for one in set(cases.dispersion.tolist())
        }
        integral = integrals[max(integrals)]  # of the whole building: the largest dispersion
        ensembles = zip(cases.ensembles, rocked, strict=True)
        own = [one.own for made, one in ensembles if made.is_unknown or one.is_weak]
        doubtful = frozenset(case_item[np.concatenate(own)].tolist() if own else ())
        fell = {item: np.array([one.fell[item] for one in falls]) for item in sorted(falls[0].fell)}
        shares = self._average(fell)
        items = {
            item: integrals[float(cases.dispersion[case_item == item].max())].of_draws(
                shares[item], at_least=item in doubtful
            )
            for item in fell
        }
        several = {at for at, item in enumerate(inventory.items) if item.quantity > 1}
        ways = AnnualWays({}, {}, {})
        if assessment.obstructions:
            z, lanes = interval_width(settings), tuple(assessment.obstructions)
            scenes = [
                Scene(inventory, lanes, one, settings.route_risk, settings.seed, z, sweep.progress) for one in falls
            ]
            ways = _Ways(scenes, integral, doubtful | several).evaluate()
        return Annual(self._describe(levels, integral, items, fell, doubtful), items, ways)

    def _average(self, fell: Mapping[int, BoolArray]) -> dict[int, FloatArray]:
        """Return for each piece the share of it and those exactly like it that fall, by level and draw."""
        owns: dict[int, list[int]] = {}
        for item, kind in zip(self.assessment.case_item.tolist(), self.sweep.cases.alike.tolist(), strict=True):
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

    def _describe(
        self,
        levels: FloatArray,
        integral: Integral,
        items: Mapping[int, AnnualRow],
        fell: Mapping[int, BoolArray],
        doubtful: Collection[int],
    ) -> AnnualTables:
        """Return what stands for the building; of `doubtful` pieces the motions may be too weak."""
        every, held = self.assessment.inventory.items, self.assessment.held
        quantity = {item: every[item].quantity for item in items if not held[item]}
        free = np.flatnonzero(~held).tolist()
        too_stocky = set(self.assessment.case_item[self.sweep.cases.is_stocky].tolist())
        everything = sum(quantity.values())
        stocky = sum(every[at].quantity for at in too_stocky.intersection(free))
        unknown = sum(every[at].quantity for at in free) - everything - stocky
        weak = sum(count for item, count in quantity.items() if item in doubtful)
        safety = [item for item in quantity if every[item].importance == "life safety"]
        wanted = {at for at in free if every[at].importance == "life safety"} - too_stocky
        # a lower bound where pieces of a row fall together, where some were not simulated, and where one of them is
        at_least = any(quantity[item] > 1 or items[item].at_least for item in safety) or bool(wanted - {*safety})
        any_fell = [fell[item] for item in safety]
        found = replace(
            self.tables,
            ground_pga_g=self.ground / GRAVITY,
            motion_dispersion=integral.dispersion,
            runs=integral.runs,
            factors=tuple((levels / self.ground).tolist()),
            pieces=everything,
            not_evaluated=unknown,
            cannot_rock=stocky,
            at_least=weak,
            is_lower_bound=bool(weak or unknown),
            life_safety_pieces=sum(quantity[item] for item in safety),
            life_safety=integral.of_draws(np.any(any_fell, axis=0), at_least=at_least) if safety else None,
        )
        return _add_falls(found, integral, quantity, items, fell) if quantity else found


def _add_falls(
    found: AnnualTables,
    integral: Integral,
    quantity: Mapping[int, int],
    items: Mapping[int, AnnualRow],
    fell: Mapping[int, BoolArray],
) -> AnnualTables:
    """Return the tables with how many of the pieces in `quantity` fall a year, and what the ends of the curve do.

    The number is that of the pieces' own rates, its interval and its ends those of their falls, by the table.
    """
    falls = np.zeros((integral.levels.size, integral.runs))
    for item, count in quantity.items():
        falls += count * fell[item]
    shares = np.clip(integral.average @ falls.mean(axis=1) / found.pieces, 0, 1)
    total = integrate_table(integral.curve, integral.points, shares)
    total = replace(total, rate=found.pieces * total.rate, most=found.pieces * total.most)
    spread = integral.find_spread(falls)
    expected = sum(count * items[item].rate for item, count in quantity.items())
    beyond = sum(count for item, count in quantity.items() if items[item].ends_matter)
    remark = nfill(
        "for {n:,} piece more than 5 % of the annual rate comes, or could come, from outside the curve",
        "for {n:,} pieces more than 5 % of the annual rate comes, or could come, from outside the curve",
        beyond,
    )
    return replace(
        found,
        is_lower_bound=found.is_lower_bound or total.is_cut,
        expected_falls=expected,
        expected_low=None if spread is None else max(0.0, expected * (1 - spread)),
        expected_high=None if spread is None else expected * (1 + spread),
        remarks=(*list_remarks(integral.curve, total), *([remark] if beyond else ())),
    )
