"""Housner Monte Carlo (key ``housner_monte_carlo``): the rocking of each piece, integrated under many motions.

Reference
---------
Sections 2.1 and 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas", equations (1) to (4); the block
is Housner's (1963), of any height of the centre of gravity.

Equations
---------
theta'' = -p2 [sin(alpha sgn theta - theta) + (a_g/g) cos(alpha sgn theta - theta)], p2 = m g R / I0; risk =
overturned / N, with its Wilson interval.

Validity
--------
Rigid, free-standing pieces that neither slide nor bounce, with B/H below 1.41 (of a uniform block), in plane motion.

Departures
----------
N is 200 by default; the paper's is 100, of which none fallen cannot show "low". With N "auto", the interval is that of
six checks. What the piece does under the recorded motion itself is found too. The paper's Monte Carlo takes the floor's
motion and the piece as exactly known; that is found as well (`ideal`), but adopted is the chance in an earthquake like
this one, of a piece like this one: see `assess.rocking.draws`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods._alike import Alike
from assess.methods._beside import (
    Beside,
    BesideFound,
    find_branch,
    find_extended,
    find_walled,
    name_branch,
)
from assess.methods._housner_steps import steps
from assess.methods._method import (
    BoolArray,
    Cases,
    Column,
    Ensemble,
    FloatArray,
    Joint,
    Method,
    Motions,
    Outcome,
    Reason,
    Reference,
)  # fmt: skip
from assess.methods._simulate import LOOKS, interval_width, make_batches, rock_cases, rock_draws, run_side_by_side
from assess.progress import SILENT, Progress, Stage
from assess.risk import classify_all, wilson_interval
from assess.rocking.draws import TRIED
from assess.settings import AUTO, Settings

BATCH = 500
"""Motions made at once."""
MOST_PAIRS = 400_000
"""Pairs of case and motion that are rocked at once; they take some 800 bytes each, for all dispersions together."""
SHOWN = 3
"""Motions kept for reports."""


def evaluate(cases: Cases, settings: Settings, *, threads: int = 1, stage: Stage | None = None) -> Outcome:
    """Integrate the cases that have an ensemble, each of which is one part of `stage`; the others have no value."""
    known = (cases.ensemble >= 0) & ~cases.is_stocky & ~np.isnan(cases.threshold)
    found = _Found.empty(cases.breadth.size)
    owns = [(number, np.flatnonzero(known & (cases.ensemble == number))) for number in range(len(cases.ensembles))]
    owns = [(number, own) for number, own in owns if own.size or (cases.slides_under == number).any()]
    side_by_side = min(threads, len(owns))
    stage = stage or Stage(SILENT, "verification", "", len(cases.ensembles))

    def work(number: int, own: NDArray[np.intp]) -> "_Rocked":
        return _Run(cases, own, number, settings, max(1, threads // side_by_side), stage).integrate()

    joints = []
    for rocked in run_side_by_side(work, owns, side_by_side):
        found.take(rocked, cases.ensembles[rocked.joint.ensemble])
        joints += [rocked.joint] if rocked.joint.cases.size else []
    return _summarise(found, cases, settings, joints)


def _summarise(found: "_Found", cases: Cases, settings: Settings, joints: list[Joint]) -> Outcome:
    done = found.runs > 0
    drawn = _count(found.overturned, found.runs, found.draws, settings)
    exact = found.runs if settings.ideal else np.where(found.assumed, 0, found.runs)  # what is drawn cannot recur
    ideal = _count(found.ideal, exact, exact, settings)
    open_low, open_high = (ideal if settings.ideal else drawn)[2:]
    detail = {
        **{name: np.where(done, one, np.nan) for name, one in (("runs", found.runs), ("draws", found.draws))},
        **dict(zip(("overturned", "low", "high"), (drawn[0], *drawn[2:]), strict=True)),
        **dict(zip(("ideal_overturned", "ideal", "ideal_low", "ideal_high"), ideal, strict=True)),
        **{
            f"dispersion_{one:g}": np.where(found.assumed, np.nan, _count(fallen, found.runs, found.draws, settings)[1])
            for one, fallen in zip(TRIED, found.tried, strict=True)
        },
        "if_slower": found.if_slower,
        "if_faster": found.if_faster,
        "record_overturned": found.record_fell,
        "record_rotation": found.record_rotation,
        "sliding_branch": name_branch(find_branch(cases)),
        "slip_median_cm": found.slip_median,
        "slip_84_cm": found.slip_high,
        "one_sided": found.one_sided,
    }
    undecided = done & (settings.runs == AUTO) & (classify_all(open_low) != classify_all(open_high))
    return Outcome(drawn[1], detail, _list_flags(found, cases) | {"undecided": undecided}, tuple(joints))


def _list_flags(found: "_Found", cases: Cases) -> dict[str, BoolArray]:
    return {
        "fell_in_record": found.record_fell == 1,
        "shenton_extended": find_extended(cases),
        "wall_higher": found.wall_higher,
        "assumed_motion": found.assumed,
        "unknown_building": found.unknown,
        "weak_motions": found.weak,
        "does_not_rock": cases.is_stocky,
    }


def _count(
    fallen: NDArray[np.int64], runs: NDArray[np.int64], draws: NDArray[np.int64], settings: Settings
) -> tuple[FloatArray, ...]:
    """Return how many of the draws overturn each case, their share, and its interval; NaN where there are none.

    `draws` are those of all pieces alike, which have their earthquakes in common: the interval is that of `runs`.
    """
    done, some = runs > 0, np.maximum(runs, 1)
    share = fallen / np.maximum(draws, 1)
    ends = wilson_interval(share * some, some, interval_width(settings))
    return tuple(np.where(done, one, np.nan) for one in (fallen, share, *ends))


@dataclass(frozen=True, slots=True, eq=False)
class _Rocked:
    """What the cases of one ensemble did.

    `tried` (d, m) counts falls at each of `TRIED`, `record` is what they do under the record itself, `thirds` the
    chance in the slower and in the faster third of drawn motions, (m,) each.
    """

    alike: Alike
    joint: Joint
    tried: NDArray[np.int64]
    record: tuple[FloatArray, FloatArray]
    thirds: tuple[FloatArray, FloatArray]
    beside: BesideFound

    def find_one_sided(self) -> tuple[FloatArray, BoolArray]:
        """Return the chance of each walled case, and whether it is above that without the wall in the same draws."""
        has_wall = np.isin(self.joint.cases, self.beside.walled)
        free = self.joint.ideal if self.beside.is_ideal else self.joint.fell
        one_sided = np.zeros(has_wall.size)
        one_sided[has_wall] = self.beside.one_sided
        alone = self.alike.average(free[:, : self.beside.draws].mean(axis=1))[has_wall]
        chance = self.alike.average(one_sided)[has_wall]
        return chance, np.asarray(chance > alone)


@dataclass(slots=True)
class _Found:
    """What was found, case by case."""

    runs: NDArray[np.int64]
    draws: NDArray[np.int64]
    overturned: NDArray[np.int64]
    ideal: NDArray[np.int64]
    tried: NDArray[np.int64]
    record_fell: FloatArray
    record_rotation: FloatArray
    slip_median: FloatArray
    slip_high: FloatArray
    one_sided: FloatArray
    if_slower: FloatArray
    if_faster: FloatArray
    assumed: BoolArray
    unknown: BoolArray
    weak: BoolArray
    wall_higher: BoolArray

    @classmethod
    def empty(cls, count: int) -> "_Found":
        runs, draws, overturned, ideal = (np.zeros(count, dtype=np.int64) for _ in range(4))
        unknown = (np.full(count, np.nan) for _ in range(7))
        no = (np.zeros(count, dtype=np.bool_) for _ in range(4))
        tried = np.zeros((len(TRIED), count), dtype=np.int64)
        return cls(runs, draws, overturned, ideal, tried, *unknown, *no)

    def take(self, rocked: _Rocked, ensemble: Ensemble) -> None:
        joint, alike = rocked.joint, rocked.alike
        own = joint.cases
        self.runs[own], self.draws[own] = joint.runs, joint.runs * alike.total
        self.overturned[own], self.ideal[own] = alike.add_up(joint.fell.sum(axis=1)), joint.ideal.sum(axis=1)
        self.tried[:, own] = alike.add_up(rocked.tried)
        self.record_fell[own], self.record_rotation[own] = rocked.record
        beside = rocked.beside
        self.slip_median[beside.sliders], self.slip_high[beside.sliders] = beside.slip_median_cm, beside.slip_high_cm
        self.one_sided[beside.walled], self.wall_higher[beside.walled] = rocked.find_one_sided()
        self.if_slower[own], self.if_faster[own] = rocked.thirds
        self.assumed[own], self.unknown[own] = ensemble.is_assumed, ensemble.is_unknown
        self.weak[own] = joint.is_weak


@dataclass(frozen=True, slots=True)
class _Run:
    """The cases `own` under ensemble `number`."""

    cases: Cases
    own: NDArray[np.intp]
    number: int
    settings: Settings
    threads: int
    stage: Stage

    @property
    def ensemble(self) -> Ensemble:
        return self.cases.ensembles[self.number]

    @property
    def progress(self) -> Progress:
        return self.stage.progress

    def integrate(self) -> _Rocked:
        """Integrate the cases, check by check with runs="auto"; those that are decided leave."""
        motions = self.ensemble.open(self.threads, self.progress)
        checks = LOOKS if self.settings.runs == AUTO else (int(self.settings.runs),)
        count, runs = self.own.size, np.zeros(self.own.size, dtype=np.int64)
        fell, ideal = np.zeros((count, 0), np.bool_), np.zeros((count, 0), np.bool_)
        rotation, tried = np.zeros((count, 0), np.float32), np.zeros((len(TRIED), count), dtype=np.int64)
        size, going, beside = min(BATCH, MOST_PAIRS // max(1, count) + 1), np.arange(count), self._beside()
        alike, speeds = Alike.of(self.cases.alike[self.own], self.cases.quantity[self.own]), list[FloatArray]()
        for first, last in zip((0, *checks), checks, strict=False):
            wider = ((0, 0), (0, last - first))
            fell, ideal, rotation = np.pad(fell, wider), np.pad(ideal, wider), np.pad(rotation, wider)
            for at, batch, time_step in make_batches(motions, first, last, size):
                here = slice(at, at + len(batch))
                if going.size:
                    drawn, turned = self._rock_draws(self.own[going], batch, time_step, at)
                    fell[going, here], rotation[going, here] = drawn[0], turned[0]
                    tried[:, going] += 0 if self.ensemble.is_assumed else drawn[1:].sum(axis=2)
                    speeds += [_find_speeds(batch, time_step)] if self.ensemble.is_assumed else []
                    if self.settings.ideal or not self.ensemble.is_assumed:
                        ideal[going, here], _ = self._rock(self.own[going], batch, time_step)
                if first == 0:
                    beside.add(batch, time_step, at, self.threads, self.progress)
                self.stage.at(here.stop / checks[-1], self.number)
            runs[going] = last
            counted = ideal if self.settings.ideal else fell
            going = going[_is_open(alike.average(counted.sum(axis=1))[going], last, self.settings)]
            if not going.size:
                break
        self.stage.at(1.0, self.number)
        joint, thirds = self._join(motions, runs, fell, ideal, rotation), _find_thirds(counted, runs, speeds, alike)
        return _Rocked(alike, joint, tried, self._rock_under_record(), thirds, beside.finish())

    def _join(
        self, motions: Motions, runs: NDArray[np.int64], fell: BoolArray, ideal: BoolArray,
        rotation: NDArray[np.float32],
    ) -> Joint:  # fmt: skip
        count = fell.shape[1]
        return Joint(
            ensemble=self.number, cases=self.own, runs=runs, fell=fell, ideal=ideal, rotation=rotation,
            examples=_examples(motions, count), fit=motions.fit,
            spectra=motions.spectra and motions.spectra.first(count), is_weak=motions.is_weak, bands=motions.bands,
        )  # fmt: skip

    def _beside(self) -> Beside:
        sliders = np.flatnonzero(self.cases.slides_under == self.number)
        return Beside(self.cases, self.settings, sliders, self.own[find_walled(self.cases)[self.own]])

    def _rock_under_record(self) -> tuple[FloatArray, FloatArray]:
        """Return whether each case overturns under the record itself, and how far it turns; NaN without a record."""
        if self.ensemble.record is None or not self.own.size:
            return np.full(self.own.size, np.nan), np.full(self.own.size, np.nan)
        motion, time_step = self.ensemble.record
        fell, rotation = self._rock(self.own, motion[np.newaxis], time_step)
        return fell[:, 0].astype(np.float64), rotation[:, 0]

    def _rock(self, own: NDArray[np.intp], motions: FloatArray, time_step: float) -> tuple[BoolArray, FloatArray]:
        return rock_cases(self.cases, own, motions, time_step, self.threads, self.progress)

    def _rock_draws(
        self, own: NDArray[np.intp], motions: FloatArray, time_step: float, first: int
    ) -> tuple[BoolArray, FloatArray]:
        """Return what the cases did at the floor's dispersion and, with a record, at each of `TRIED`, (1 + d, m, k)."""
        others = () if self.ensemble.is_assumed else TRIED
        return rock_draws(
            self.cases, own, motions, time_step, first=first, dispersions=(self.cases.dispersion[own], *others),
            seed=self.settings.seed, threads=self.threads, progress=self.progress,
        )  # fmt: skip


def _find_speeds(motions: FloatArray, time_step: float) -> FloatArray:
    """Return PFV over PFA of motions (k, n) [s]."""
    from assess.motion.target_fit import measure_peaks

    pfa, pfv = measure_peaks(motions, time_step).T
    return np.asarray(pfv / pfa)


def _find_thirds(
    fell: BoolArray, runs: NDArray[np.int64], speeds: Sequence[FloatArray], alike: Alike
) -> tuple[FloatArray, FloatArray]:
    """Return the chances (m,) in the third of the draws with the least PFV/PFA and in that with the most; else NaN."""
    found = np.full((2, len(runs)), np.nan)
    every = np.concatenate(speeds) if speeds else np.zeros(0)
    for count in np.unique(runs[runs > 0]).tolist() if every.size else ():
        order = np.argsort(every[:count], kind="stable")
        own, third = runs == count, max(1, count // 3)
        for row, draws in zip(found, (order[:third], order[-third:]), strict=True):
            row[own] = fell[:, draws].mean(axis=1)[own]
    slower, faster = (alike.average(row) for row in found)
    return slower, faster


def _examples(motions: Motions, count: int) -> list[tuple[NDArray[np.float32], float]]:
    batches = motions.realise(0, min(SHOWN, count))
    return [(one.astype(np.float32), time_step) for batch, time_step in batches for one in batch]


def _is_open(fallen: FloatArray, runs: int, settings: Settings) -> BoolArray:
    """Return which cases' intervals reach over more than one class, by how often they fell in so many draws."""
    low, high = wilson_interval(fallen, runs, interval_width(settings))
    return np.asarray(classify_all(low) != classify_all(high), dtype=np.bool_)


METHOD = Method(
    key="housner_monte_carlo",
    title="Housner Monte Carlo",
    short_title="Housner Monte Carlo",
    role="simulation",
    kind="probability",
    order=70,
    predicts="The chance that a free-standing piece overturns, from its rocking integrated under many motions that are "
    "compatible with the floor's record or drawn for its building, in an earthquake like this one.",
    reference=Reference(
        authors="Housner G",
        year="1963",
        title="The behavior of inverted pendulum structures during earthquakes",
        source="Bulletin of the Seismological Society of America 53(2):403-417",
        remark='The Monte Carlo is section 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas".',
    ),
    needs=frozenset({"breadth", "height", "ensemble"}),
    evaluate=evaluate,
    steps=steps,
    columns=(
        Column("runs", "Draws", kind="count", format=",.0f"),
        Column("draws", "Draws of all pieces alike", kind="count", format=",.0f"),
        Column("overturned", "Overturned", kind="count", format=",.0f"),
        Column("low", "Lower end of the interval"),
        Column("high", "Upper end of the interval"),
        Column("ideal_overturned", "Overturned, if exactly this motion recurred", kind="count", format=",.0f"),
        Column("ideal", "Chance if exactly this motion recurred"),
        Column("ideal_low", "Lower end of its interval"),
        Column("ideal_high", "Upper end of its interval"),
        Column("dispersion_0.2", "Chance with a dispersion of the motion of 0.2"),
        Column("dispersion_0.6", "Chance with a dispersion of the motion of 0.6"),
        Column("if_slower", "Chance in the third of the draws with the least PFV/PFA"),
        Column("if_faster", "Chance in the third of the draws with the most PFV/PFA"),
        Column("record_overturned", "Overturns under the record", kind="truth", format=".0f"),
        Column("record_rotation", "Largest rotation under the record over the critical angle", format=".2f"),
        Column("sliding_branch", "How it starts to move", kind="text", format=""),
        Column("slip_median_cm", "Peak slip, median", "cm", ".1f"),
        Column("slip_84_cm", "Peak slip, 84 %", "cm", ".1f"),
        Column("one_sided", "Chance with a wall at its back"),
    ),
    reasons=(
        Reason(
            "Direct integration follows each piece through whole motions of the floor, with its size. Draws that "
            "overturn it: {overturned} of {draws}.",
        ),
        Reason(
            "PFA {pfa_g} g is {pfa_to_start} times g·B/H, above which a uniform block can start to rock; the draws "
            "that overturn the piece have higher peaks, or a more slender or top-heavy body.",
            side="above",
            can_rock=False,
        ),
        Reason(
            "PFA is {pfa_to_start} times g·B/H: rocking can start, but a short peak need not overturn the piece, and "
            "under most of the integrated motions it comes back to rest.",
            side="below",
            can_rock=True,
        ),
        Reason(
            "No record of this floor is known: the integrated motions are those of drawn earthquakes in drawn "
            "buildings.",
            flag="assumed_motion",
        ),
        Reason("The motions that were integrated are weaker than the floor's.", flag="weak_motions"),
    ),
    equations=(
        "I₀·θ″ + m·g·r·sin(-α - θ) = -m·a_g·r·cos(-α - θ), θ < 0   (1)",
        "I₀·θ″ + m·g·r·sin(α - θ) = -m·a_g·r·cos(α - θ), θ > 0   (2), I₀ = (4/3)·m·r², tan α = B/H, r = ½·√(B² + H²)",
        "θ″ = -p²·[sin(α·sgn θ - θ) + (a_g/g)·cos(α·sgn θ - θ)]   (3)",
        "p = √(3g/4r)   (4)",
        "Rocking starts where |a_g|/g > B/H",
        "After an impact: θ′ = (1 - 1.5·sin²α) · θ′ before; overturned: |θ| ≥ π/2",
        "Centre of gravity at z_c, not H/2: tan α = b/z_c, b = B/2, R² = b² + z_c², I₀ = m·(B² + H²)/12 + m·R², "
        "p² = m·g·R/I₀",
        "There rocking starts where |a_g|/g > b/z_c; after an impact: θ′ = (1 - 2·m·R²·sin²α/I₀) · θ′ before",
        "Draw k: motion k · exp(β·ε_k), ε_k = N(0, 1) for the whole building; base B·N(0.97, 0.05), height H·N(1, "
        "0.02), z_c/H = N(as given, 0.05), restitution = N(as given or as above, 0.04)",
        "Risk = overturned / N; interval: (R + z²/2N ± z·√(R(1 - R)/N + z²/4N²)) / (1 + z²/N)",
    ),
    assumptions=(
        "The piece is rigid and free-standing; its centre of gravity is at mid-height, or where the workbook gives it; "
        "it neither slides nor bounces, and moves in one plane; vertical motion is left out.",
        "An earthquake like this one: on floors with a record, or driven by one, β is 0.4, assumed, unless the "
        "workbook gives another. Elsewhere drawn motions scatter by themselves, and β is that of what gives the ground "
        "motion: of a ShakeMap, a field or an intensity; 0 of a typed peak or a code. ε is normal, and correlated from "
        "place to place in a city; scenarios of the ground bring their own numbers. Base, height, centre of gravity "
        "and restitution of each piece are drawn; their means and dispersions are assumed. Normal numbers are cut at 3 "
        "standard deviations.",
        "Sizes that were measured by a scan are less certain: base and height are drawn with standard deviations of "
        "0.1 and 0.05 of the given ones, also assumed.",
        "Draw k has one scale for the whole building, and its motions have the same random phases on every floor along "
        "an axis. Between floors that have records of one earthquake on one clock the sign of each octave is that of "
        "the records; elsewhere the signs of modes are not known.",
        "Motions are linear between samples. A block at rest can start again. After the end of a motion it is followed "
        "until it can no longer fall.",
        "The factors exp(β·ε_k) are stratified: each 25 draws have one ε in each 25th of its distribution, 200 one in "
        "each 200th. Pieces that are exactly alike on a floor have one chance, from the draws of all of them; which of "
        "them fall together in a draw is kept.",
        "The interval is Wilson's, 95 % (z = 1.96), of N independent draws: it covers the number of draws only, not "
        "the model of the block, how well the floor's motion is known, or the assumed dispersions. As the draws are "
        "stratified, it is wider than it has to be.",
        "The chance is that of a piece that does not slide. How it starts to move at the floor's PFA is shown beside, "
        "by Shenton's limits (1996), resting and sliding friction being equal. So is the peak slip of a block that "
        "slides and does not rock (Newmark 1965), under the same draws: it depends on the friction and the floor "
        "alone, and is 0 in draws in which the piece, by its size, does not slide. Neither lowers a chance or a class.",
        "With a wall at its back, a piece turns away from it alone and rebounds as by Sorrentino et al. (2011); this "
        "rebound is assumed, not compared with the printed paper. The wall moves with the floor and does not pound. "
        "Where the side of the wall is not known, the larger chance of the two directions counts. It is shown beside, "
        "and lowers nothing.",
        'With N "auto", motions are added at 125, 250, 500, 1,000, 2,500 and 5,000, and a piece is done once its '
        "interval (z = 2.64: 95 % for all six checks together) lies within one class. Slip and what a wall changes are "
        "found under the first 125.",
    ),
    departures=(
        'N is 200 by default; the paper\'s is 100. None of 100 fallen cannot show "low": the interval then reaches to '
        "0.037.",
        "What the piece does under the recorded motion itself is found as well: one that overturns there is at least "
        "high.",
        "The paper takes the floor's motion and the piece as exactly known. That chance is shown next to the adopted "
        "one, as that if exactly this motion recurred, and is adopted where a run asks for it.",
        "The paper's block is uniform; here the centre of gravity may be at any height.",
    ),
    flags={
        "fell_in_record": "it overturns under the recorded motion itself, so its class is at least high",
        "assumed_motion": "no record of this floor is known: ground motion and building are drawn",
        "unknown_building": "neither T1, Height, Storeys nor an Elevation is known: buildings of every period and "
        "floors of every height are drawn, and its class is that of the faster third of them where that is higher",
        "weak_motions": "the motions are weaker than the floor's: simulation may raise a class, never lower it",
        "shenton_extended": "Shenton's limits hold for a centre of gravity at mid-height: how this piece starts to "
        "move is derived in the same way for its own",
        "wall_higher": "with a wall at its back it falls in more draws than without one; its class is that without",
        "undecided": "after 5,000 motions its interval still reaches over more than one class",
        "does_not_rock": "B/H is 1.41 or more: too stocky to rock, direct integration and FEMA P-58 do not apply",
    },
)
