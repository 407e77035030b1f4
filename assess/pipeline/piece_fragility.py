"""How likely each piece, or a piece of each type, overturns, against the PFA or the PFV of its floor.

Each piece is rocked under the motions of its floor (those compatible with its record, or drawn where it has none),
all multiplied by one factor, so that the floor's PFA or PFV takes each level. The same motions serve at every level;
the shape of the spectrum stays, and with it the ratio of PFV to PFA: a fragility against PFA holds for motions of that
ratio only. A blank axis takes the worse one at each level; a piece that is nearly square on plan falls in a draw if it
falls along either.

The uncertainty of the motion is not part of it: whoever applies it to a PFA or PFV brings that of the demand. The
phases of the motions scatter, and each piece differs from what is filled in as the workbook says; with `settings.ideal`
it does not. No class or formula of an assessment enters.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal, get_args

import numpy as np

from assess.arrays import BoolArray, FloatArray
from assess.errors import InputError
from assess.fragility import Fragility, fit_fragility
from assess.i18n import Text, fill
from assess.model import AXES, Axis, Item
from assess.pipeline.adopt import Assessment, is_square
from assess.pipeline.demand import Demand
from assess.pipeline.verify import RockedLevels, Sweep, choose_motions
from assess.progress import SILENT, Progress
from assess.rocking.block import threshold
from assess.rocking.draws import STILL
from assess.settings import AUTO
from assess.units import GRAVITY
from assess.workbook.names import key

By = Literal["item", "type"]
Measure = Literal["pfa", "pfv"]
BY: tuple[str, ...] = get_args(By)
"""What has one curve: a row of Items, or the rows of one Type; rows without a Type go by their sizes."""
MEASURES: tuple[str, ...] = get_args(Measure)
"""Intensity measures."""
UNITS: Mapping[str, float] = {"pfa": GRAVITY, "pfv": 0.01}
"""Of the levels: g and cm/s, in m/s2 and m/s."""

LOWEST, HIGHEST = 0.5, 4.0
"""First levels of a curve over the PFA at which its most and its least slender piece start to rock [-]."""
NEARLY_ALL, FARTHEST = 0.98, 16.0
"""Levels are added until this share falls [-], or to so many times the PFA at which rocking starts [-]."""
RUNGS = (
    "1.00", "1.12", "1.25", "1.40", "1.60", "1.80", "2.00", "2.24", "2.50", "2.80",
    "3.15", "3.55", "4.00", "4.50", "5.00", "5.60", "6.30", "7.10", "8.00", "9.00",
)  # fmt: skip
"""Levels of a decade: the preferred numbers R20 of ISO 3, 12 % apart."""
MORE_RUNGS = 6
"""Rungs that are added at a time: a factor of two."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorMotions:
    """The motions of one floor along one axis, before any factor.

    * `mean_pfa`, `mean_pfv`: means over the motions [m/s2], [m/s].
    * `is_assumed`, `is_unknown`, `is_weak`: whether ground motion and building are drawn, whether nothing is known of
      the building, and whether the motions are weaker than the floor's. Under the latter two a fragility may be too
      low.
    """

    demand: Demand
    mean_pfa: float
    mean_pfv: float
    is_assumed: bool
    is_unknown: bool
    is_weak: bool

    @property
    def floor(self) -> str:
        """Name of the floor."""
        return self.demand.floor.floor

    @property
    def spectrum(self) -> Text:
        """What their spectrum follows, in words."""
        drawn = self.demand.drawn
        if drawn is None:
            return fill("that of the record")
        if drawn.building.period is None:
            return fill("drawn, nothing known of the building")
        return fill("drawn for T1 {period:.3g} s", period=drawn.building.period)

    @property
    def pfv_per_pfa(self) -> float:
        """Mean PFV over mean PFA of the motions [s]; a factor does not change it."""
        return self.mean_pfv / self.mean_pfa


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceFragility:
    """One curve.

    * `name`: the item, the type, or the sizes of rows without a type.
    * `items`: its rows, in the order of the workbook.
    * `curve`: how many fell at each level [m/s2] or [m/s], and the lognormal fitted to it. Of an item the trials are
      draws; of a type each row counts by its Quantity, as all pieces of a row fall alike.
    """

    name: str
    type: str
    items: tuple[Item, ...]
    curve: Fragility
    motions: tuple[FloorMotions, ...]

    @property
    def floors(self) -> tuple[str, ...]:
        """Floors of its pieces."""
        return tuple(dict.fromkeys(one.floor for one in self.motions))

    @property
    def pieces(self) -> int:
        """Number of its pieces, by Quantity."""
        return sum(one.quantity for one in self.items)

    @property
    def thresholds(self) -> tuple[float, float]:
        """The least and the largest acceleration at which its pieces start to rock [m/s2]."""
        every = [GRAVITY * float(threshold(one.breadth, one.height, one.centre_of_gravity)) for one in self.items]
        return min(every), max(every)

    @property
    def pfv_per_pfa(self) -> tuple[float, float]:
        """The least and the largest ratio of mean PFV to mean PFA of its motions [s]."""
        every = [one.pfv_per_pfa for one in self.motions]
        return min(every), max(every)

    @property
    def may_be_too_low(self) -> bool:
        """Whether any of its motions may be too weak, so that pieces may fall at lower levels than it says."""
        return any(one.is_unknown or one.is_weak for one in self.motions)


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceFragilities:
    """The curves of a workbook.

    * `by`, `im`: what has one curve, of `BY`; the intensity measure of the levels, of `MEASURES`.
    * `has_drawn_pieces`: whether each draw has a base, height, centre of gravity and restitution of its own; else
      pieces are as given.
    * `stocky`: rows that are too stocky to rock, and left out.
    """

    by: By
    im: Measure
    runs: int
    seed: int
    has_drawn_pieces: bool
    curves: tuple[PieceFragility, ...]
    stocky: tuple[Item, ...]


def find_piece_fragilities(
    assessment: Assessment, *, by: By = "item", im: Measure = "pfa", levels: Sequence[float] | None = None,
    jobs: int | None = None, progress: Progress = SILENT,
) -> PieceFragilities:  # fmt: skip
    """Find how likely pieces overturn at each level of their floor's PFA or PFV, and fit lognormals to it.

    * `assessment`: from `assess.pipeline.run.compute`, simulated or not; its settings give the number of draws and
      their seed.
    * `by`, `im`: what has one curve, of `BY`; the intensity measure, of `MEASURES`.
    * `levels`: rising levels [m/s2] or [m/s], above 0. By default each curve takes preferred numbers, in g or cm/s,
      from where about nothing falls to where about everything does.
    * `jobs`: threads; as many as there are processors by default. They do not change a result.
    * `progress`: receives the stage "rocking", more than once where levels are added; obeys a cancel.

    Raises InputError if `by`, `im` or `levels` cannot be used, the number of motions is "auto", they are the user's
    own, no piece can rock, or the results may exceed the available memory.
    """
    settings = assessment.settings
    if settings.runs == AUTO or assessment.suite is not None:
        raise InputError.about('runs: a fragility needs a fixed number of generated motions, not "auto" or a suite')
    for name, text, choices in (("by", by, BY), ("im", im, MEASURES)):
        if text not in choices:
            known = ", ".join(choices)
            raise InputError.about(
                "{name} is {text!r}, expected one of: {known}", name=name, text=str(text), known=known
            )
    if levels is not None:
        levels = [float(one) for one in levels]
        is_rising = all(one < other for one, other in pairwise(levels))
        if not levels or not is_rising or not all(0 < one < math.inf for one in levels):
            raise InputError.about(
                "levels: expected one or more finite numbers above 0, each larger than the one before"
            )
    rocked = np.unique(assessment.case_item[~assessment.cases.is_stocky])
    if not rocked.size:
        raise InputError.about("no piece can rock: all are too stocky, or there are none.")

    def find() -> PieceFragilities:
        inventory, demands, case_item = assessment.inventory, assessment.case_demand, assessment.case_item
        groups: dict[object, list[int]] = {}  # which items have one curve, in the order of the workbook
        for at in rocked.tolist():
            item = inventory.items[at]
            shape = (item.breadth, item.height, item.centre_of_gravity)
            mark: object = at if by == "item" else key(item.type) if item.type else shape
            groups.setdefault(mark, []).append(at)
        sweep = Sweep(
            assessment=assessment,
            cases=choose_motions(
                assessment.cases, np.isin(case_item, rocked), demands, assessment.demands, inventory, settings, None
            ),
            peaks=np.array([one.pfa if im == "pfa" else one.pfv for one in demands]), settings=settings,
            dispersion=None if settings.ideal else np.zeros(case_item.size), jobs=jobs, progress=progress,
        )  # fmt: skip
        study = _Study(sweep, list(groups.values()), UNITS[im])
        every, fallen = study.rock(levels)
        stocky = np.unique(case_item[assessment.cases.is_stocky])
        return PieceFragilities(
            by=by, im=im, runs=int(settings.runs), seed=settings.seed,
            has_drawn_pieces=assessment.cases.uncertainty.piece and not settings.ideal,
            curves=tuple(study.build_curve(group, every, fallen[group], by) for group in study.groups),
            stocky=tuple(inventory.items[at] for at in stocky),
        )  # fmt: skip

    return progress.wait_for(find)


@dataclass(frozen=True, slots=True, eq=False)
class _Study:
    """How often items of `groups` fall at levels in a `unit`; `motions`, by ensemble, fills while they are rocked."""

    sweep: Sweep
    groups: Sequence[Sequence[int]]
    unit: float
    motions: dict[int, FloorMotions] = field(default_factory=dict)

    def rock(self, given: Sequence[float] | None) -> tuple[FloatArray, FloatArray]:
        """Return levels (l,) and how often each item fell at each, (items, l); NaN where it was not rocked.

        The levels are those given, else preferred numbers: more of them until about everything fell, as far as it goes.
        """
        if given is not None:
            levels, last = np.array(given), len(given) - 1
            spans = [(0, last, last) for _ in self.groups]
        else:
            rungs, cases = [], self.sweep.cases
            for group in self.groups:  # the rungs, counted from 1, at or just below three levels
                own = np.isin(self.sweep.assessment.case_item, group)
                begin = cases.threshold[own] * GRAVITY * self.sweep.peaks[own] / cases.pfa[own] / self.unit
                ends = LOWEST * (begin * cases.still[own] / STILL).min(), HIGHEST * begin.max(), FARTHEST * begin.max()
                low, top, end = (math.floor(len(RUNGS) * math.log10(one)) for one in ends)
                rungs.append((low, top + 1, end + 1))
            first, end = min(low for low, _, _ in rungs), max(end for _, _, end in rungs)
            decades = (divmod(rung, len(RUNGS)) for rung in range(first, end + 1))
            levels = np.array([float(f"{RUNGS[at]}e{decade}") * self.unit for decade, at in decades])
            spans = [(low - first, top - first, end - first) for low, top, end in rungs]
        fallen = np.full((len(self.sweep.assessment.inventory.items), levels.size), np.nan)
        ranges = [(low, top) for low, top, _ in spans]
        while any(start <= stop for start, stop in ranges):
            wanted = np.zeros(fallen.shape, dtype=np.bool_)
            for group, (start, stop) in zip(self.groups, ranges, strict=True):
                wanted[group, start : stop + 1] = True
            used = np.flatnonzero(wanted.any(axis=0))
            rocked = self.sweep.rock(levels[used], wanted[self.sweep.assessment.case_item][:, used])
            for number, one in enumerate(rocked):
                if one.own.size and number not in self.motions:
                    made, demand = self.sweep.cases.ensembles[number], self.sweep.assessment.case_demand[one.own[0]]
                    self.motions[number] = FloorMotions(
                        demand=demand, mean_pfa=one.pfa, mean_pfv=one.pfv, is_assumed=made.is_assumed,
                        is_unknown=made.is_unknown, is_weak=one.is_weak,
                    )  # fmt: skip
            rows, columns = np.nonzero(wanted[:, used])
            fallen[rows, used[columns]] = self._count(rocked, used.size)[rows, columns]
            for number, (group, (_, _, end)) in enumerate(zip(self.groups, spans, strict=True)):
                top = ranges[number][1]
                is_enough = float(fallen[group, top].mean()) / int(self.sweep.settings.runs) >= NEARLY_ALL
                ranges[number] = (top + 1, top if is_enough else min(top + MORE_RUNGS, end))
        return levels, fallen

    def _count(self, rocked: Sequence[RockedLevels], levels: int) -> FloatArray:
        """Return in how many draws each item falls at each level, (items, levels)."""
        assessment = self.sweep.assessment
        verdicts = {int(case): one.fell[:, row] for one in rocked for row, case in enumerate(one.own)}
        axes: dict[int, dict[Axis, list[BoolArray]]] = {}
        for case, fell in sorted(verdicts.items()):
            by_axis = axes.setdefault(int(assessment.case_item[case]), {})
            by_axis.setdefault(assessment.case_demand[case].axis, []).append(fell)
        items = assessment.inventory.items
        counts = np.zeros((len(items), levels))
        for at, by_axis in axes.items():
            worst = [_take_worst(by_axis[axis]) for axis in AXES if axis in by_axis]
            fell = np.any(worst, axis=0) if is_square(items[at]) else _take_worst(worst)
            counts[at] = fell.sum(axis=1)
        return counts

    def build_curve(self, group: Sequence[int], levels: FloatArray, fallen: FloatArray, by: By) -> PieceFragility:
        """Return the curve of a group whose items fell so often at the levels, (m, l); NaN where they were not."""
        assessment = self.sweep.assessment
        items = tuple(assessment.inventory.items[at] for at in group)
        own = dict.fromkeys(self.sweep.cases.ensemble[np.isin(assessment.case_item, group)].tolist())
        kept = ~np.isnan(fallen[0])
        counts = np.array([one.quantity if by == "type" else 1 for one in items], dtype=np.float64)
        trials = np.full(int(kept.sum()), int(assessment.settings.runs) * counts.sum())
        first = items[0]
        sizes = f"{round(100 * first.breadth, 6):g} x {round(100 * first.height, 6):g} cm"
        return PieceFragility(
            name=first.item if by == "item" else first.type or sizes, type=first.type, items=items,
            curve=fit_fragility(levels[kept], counts @ fallen[:, kept], trials),
            motions=tuple(self.motions[number] for number in own),
        )  # fmt: skip


def _take_worst(every: Sequence[BoolArray]) -> BoolArray:
    """Return of verdicts (levels, runs) those with the most falls at each level, of equal ones the first."""
    stacked = np.stack(every)
    worst = stacked.sum(axis=2).argmax(axis=0)
    return np.asarray(stacked[worst, np.arange(worst.size)])
