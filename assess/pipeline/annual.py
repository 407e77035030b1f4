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
from collections.abc import Collection, Mapping, Sequence
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
from assess.pipeline.adopt import ROLLS, Assessment
from assess.pipeline.known_ground import Ground, find_ground
from assess.pipeline.verify import MOST_PAIRS, RockedLevels, Sweep
from assess.progress import Progress
from assess.rates import evaluate_rate, integrate_table, list_remarks
from assess.risk import NORMAL_95
from assess.rocking.draws import CUT, MOTION
from assess.routes.chances import find_chances, to_array
from assess.routes.evaluate import list_rooms
from assess.routes.network import IsBlocked
from assess.routes.scene import Scene
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
            rate=found.rate, low=None if spread is None else max(0.0, found.rate * (1 - spread)),
            high=None if spread is None else found.rate * (1 + spread), chance_a_year=found.chance_within(1),
            chance_in_50_years=found.chance_within(YEARS), fit="lognormal" if is_fitted else "table",
            median_g=fitted.median / GRAVITY if has_half else None, dispersion=fitted.dispersion if has_half else None,
            misfit=fitted.misfit if is_fitted else None, at_least=at_least or is_cut, ends_matter=found.ends_matter,
        )  # fmt: skip

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


def _evaluate_ways(scenes: Sequence[Scene], integral: Integral, doubtful: frozenset[int]) -> AnnualWays:
    """Evaluate the routes of which any segment is evaluated, and the rooms of the network, at each level.

    What rests on `doubtful` pieces (indices), which fall too seldom, is a bound.
    """
    first = scenes[0]

    def find(segments: Collection[int], is_blocked: IsBlocked, *, anchors_fail: bool = False) -> AnnualRow:
        every = [
            (scene.when_blocked(segments, is_blocked), scene.couplings(segments, anchors_fail=anchors_fail))
            for scene in scenes
        ]
        happens, own = every[-1]
        if not happens(own.ends)[0]:
            return NEVER
        shares = np.array([find_chances(own, happens, first.z)[0].probability for happens, own in every])
        spread, runs = None, {own.joint.weight.size for _, own in every}
        if len(runs) == 1 and all(own.is_joint for _, own in every):
            (count,) = runs
            spread = integral.find_spread(np.array([to_array(happens(own.joint)[0], count) for happens, own in every]))
        reaching = {item for item, _ in every[0][1].keys}
        return integral.of_shares(shares, spread, at_least=bool(reaching & doubtful))

    routes, fail = dict[str, AnnualRow](), dict[str, AnnualRow]()
    for name in dict.fromkeys(one.segment.route for one in first.obstructions if one.is_evaluated):
        segments = first.segments_of(name)
        is_blocked = first.course(segments)
        if any(first.falls.anchored[item] for item, _ in first.keys(segments, anchors_fail=True)):
            fail[name] = find(segments, is_blocked, anchors_fail=True)
        routes[name] = find(segments, is_blocked)
    rooms = {one.place: find(part.segments, part.when_cut_off(one.place)) for one, part in list_rooms(first)}
    return AnnualWays(routes, fail, rooms)


LOWER = 6
"""Levels that are added below at a time."""
MOST_RUNS, LEAST_RUNS = 1000, 50
"""Draws at a level: those of the run, but at most so many, and fewer where the results would need too much memory."""


def evaluate_annual(assessment: Assessment, *, jobs: int | None, progress: Progress) -> Annual | None:
    """Evaluate annual chances; None where the workbook names no hazard file. CancelledError if it is stopped.

    Every piece is rocked at every level of ground PGA. Levels reach from where about nothing rocks to beyond the end of
    the curve. Where some fall at the lowest one, lower ones are added, down to that of scattered motions of the first
    point of the curve.
    """
    curve, ground = assessment.inventory.hazard, find_ground(assessment.inventory)
    if curve is None:
        return None
    tables = AnnualTables(
        file=curve.file, latitude=curve.latitude, longitude=curve.longitude,
        distance_km=None if curve.distance is None else curve.distance / 1000,
        curve_pga_g=tuple((curve.pga / GRAVITY).tolist()), curve_rate=tuple(curve.rate.tolist()),
        remarks=tuple(curve.remarks),
    )  # fmt: skip
    missing = _find_missing(assessment, ground)
    if missing or ground.pga is None:
        return Annual(replace(tables, missing=missing), {}, AnnualWays({}, {}, {}))
    settings, pga = assessment.settings, assessment.settings.scale * ground.pga  # to which the floors' motions belong
    own = assessment.cases.ensemble >= 0
    pairs, runs = MOST_LEVELS * int(own.sum()), RUNS if settings.runs == AUTO else int(settings.runs)
    settings = replace(settings, runs=min(runs, MOST_RUNS, max(LEAST_RUNS, MOST_PAIRS // pairs)))
    # of the floors' motions at a ground PGA: on floors with a record never none; drawn motions scatter by themselves
    spread = [one.own_dispersion or (MOTION if one.motion is not None else 0.0) for one in assessment.case_demand]
    cases = replace(assessment.cases, dispersion=np.array(spread, dtype=np.float64))
    sweep = Sweep(
        assessment=assessment, cases=cases, peaks=np.full(len(spread), pga), settings=settings,
        dispersion=np.zeros(len(spread)), jobs=jobs, progress=progress,
    )  # fmt: skip
    largest = math.exp(CUT * float(cases.dispersion.max(initial=0.0)))  # no factor at a ground PGA exceeds it
    floor, last = float(curve.pga[0]) / largest, float(curve.pga[-1]) * largest
    start = cases.still[own] * GRAVITY * cases.threshold[own] / cases.pfa[own]
    levels = space(float(np.clip(pga * start.min(), floor, last / STEP)), last)
    rocked = sweep.rock(levels)
    while levels[0] > floor * (1 + ROUNDING) and any(one.fell[0].any() for one in rocked):
        lower = space(max(levels[0] / STEP**LOWER, floor), levels[0])[:-1]
        levels = np.concatenate([lower, levels])
        rocked = [
            replace(one, fell=np.concatenate([below.fell, one.fell]))
            for below, one in zip(sweep.rock(lower), rocked, strict=True)
        ]
    return progress.wait_for(lambda: _integrate(sweep, curve, pga, tables, levels, rocked))


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


def _integrate(
    sweep: Sweep, curve: HazardCurve, pga: float, tables: AnnualTables, levels: FloatArray,
    rocked: Sequence[RockedLevels],
) -> Annual:  # fmt: skip
    """Return the annual chances of pieces, routes and rooms, `pga` being the ground PGA of the motions as they are."""
    assessment, cases, settings = sweep.assessment, sweep.cases, sweep.settings
    case_item, inventory = assessment.case_item, assessment.inventory
    falls = [
        sweep.find_falls(assessment.cases.pfa * (level / pga), rocked, at) for at, level in enumerate(levels.tolist())
    ]
    integrals = {one: Integral(curve, levels, one, int(settings.runs)) for one in set(cases.dispersion.tolist())}
    integral = integrals[max(integrals)]  # of the whole building: the largest dispersion
    ensembles = zip(cases.ensembles, rocked, strict=True)
    own = [one.own for made, one in ensembles if made.is_unknown or one.is_weak]
    doubtful = frozenset(case_item[np.concatenate(own)].tolist() if own else ())
    fell = {item: np.array([one.fell[item] for one in falls]) for item in sorted(falls[0].fell)}
    # of a piece that has others exactly like it, the share of all of them that falls counts
    alike: dict[int, list[int]] = {}
    for item, kind in zip(case_item.tolist(), cases.alike.tolist(), strict=True):
        alike.setdefault(item, []).append(kind)
    groups: dict[tuple[int, ...], list[int]] = {}
    for item in fell:
        groups.setdefault(tuple(alike[item]), []).append(item)
    items = {}
    for group in groups.values():
        quantity = [inventory.items[item].quantity for item in group]
        share = np.asarray(sum(n * fell[item] for n, item in zip(quantity, group, strict=True)) / sum(quantity))
        for item in group:
            own_integral = integrals[float(cases.dispersion[case_item == item].max())]
            items[item] = own_integral.of_draws(share, at_least=item in doubtful)
    items = {item: items[item] for item in fell}
    ways = AnnualWays({}, {}, {})
    if assessment.obstructions:
        several = {at for at, item in enumerate(inventory.items) if item.quantity > 1}
        scenes = [Scene.of(inventory, assessment.obstructions, one, settings, sweep.progress) for one in falls]
        ways = _evaluate_ways(scenes, integral, doubtful | several)
    found = replace(
        tables,
        ground_pga_g=pga / GRAVITY, motion_dispersion=integral.dispersion, runs=integral.runs,
        factors=tuple((levels / pga).tolist()),
    )  # fmt: skip
    return Annual(_sum_up(found, sweep, integral, items, fell, doubtful), items, ways)


def _sum_up(
    found: AnnualTables, sweep: Sweep, integral: Integral, items: Mapping[int, AnnualRow],
    fell: Mapping[int, BoolArray], doubtful: Collection[int],
) -> AnnualTables:  # fmt: skip
    """Return the tables with the sums of the building; of `doubtful` pieces the motions may be too weak.

    The number of pieces that fall is that of their own rates, its interval and its ends those of their falls, by the
    table.
    """
    every, held = sweep.assessment.inventory.items, sweep.assessment.held
    quantity = {item: every[item].quantity for item in items if not held[item]}
    rolls = sweep.assessment.adoption.basis[sweep.assessment.governing] == ROLLS  # not covered
    free = np.flatnonzero(~held & ~rolls).tolist()
    too_stocky = set(sweep.assessment.case_item[sweep.cases.is_stocky].tolist())
    pieces = sum(quantity.values())
    stocky = sum(every[at].quantity for at in too_stocky.intersection(free))
    unknown = sum(every[at].quantity for at in free) - pieces - stocky
    weak = sum(count for item, count in quantity.items() if item in doubtful)
    safety = [item for item in quantity if every[item].importance == "life safety"]
    wanted = {at for at in free if every[at].importance == "life safety"} - too_stocky
    # a lower bound where pieces of a row fall together, where some were not simulated, and where one of them is
    at_least = any(quantity[item] > 1 or items[item].at_least for item in safety) or bool(wanted - {*safety})
    any_fell = [fell[item] for item in safety]
    found = replace(
        found,
        pieces=pieces, not_evaluated=unknown, cannot_rock=stocky, at_least=weak, is_lower_bound=bool(weak or unknown),
        life_safety_pieces=sum(quantity[item] for item in safety),
        life_safety=integral.of_draws(np.any(any_fell, axis=0), at_least=at_least) if safety else None,
    )  # fmt: skip
    if not quantity:
        return found
    none = np.zeros((integral.levels.size, integral.runs))
    falls = sum((count * fell[item] for item, count in quantity.items()), none)
    shares = np.clip(integral.average @ falls.mean(axis=1) / pieces, 0, 1)
    total = integrate_table(integral.curve, integral.points, shares)
    total = replace(total, rate=pieces * total.rate, most=pieces * total.most)
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
