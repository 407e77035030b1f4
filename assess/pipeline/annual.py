"""How often a year pieces fall, routes are blocked and rooms lose every exit: the hazard curve, integrated.

Every piece is rocked at several levels of ground PGA, the motions of all floors growing in proportion to it from those
of the scenario. The shares that fall are integrated over the hazard curve of the site, by the lognormal fitted to them
where it is near enough. At a given ground PGA the floors' motions still scatter: without that a rate comes out too low
by a factor of about two, so that the dispersion of the workbook is always in it, also where a run leaves it out. It is
one scale for the whole building, as the level is: so it is not drawn, but shares are averaged over it (`Integral`).

What is not simulated has no annual chance. Under motions that may be too weak, a rate is a lower bound.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.annual_results import Annual, AnnualRow, AnnualTables, AnnualWays
from assess.hazard import HazardCurve
from assess.i18n import Text, fill, nfill
from assess.methods import Cases
from assess.methods._method import BoolArray, FloatArray
from assess.pipeline.annual_integral import STEP, Integral, space
from assess.pipeline.annual_ways import evaluate_ways
from assess.pipeline.assessment import Assessment
from assess.pipeline.demand import find_ground
from assess.pipeline.level_falls import find_falls
from assess.pipeline.levels import RockedLevels, rock_levels
from assess.progress import Progress
from assess.rocking.draws import MOTION, STILL, Uncertainty
from assess.routes.chances import Falls
from assess.settings import AUTO, RUNS, Settings
from assess.units import GRAVITY


def evaluate_annual(assessment: Assessment, *, jobs: int | None, progress: Progress) -> Annual | None:
    """Evaluate annual chances; None where the workbook names no hazard file.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    InputError
        If the results would need too much memory.
    """
    curve, ground = assessment.inventory.hazard, find_ground(assessment.inventory).pga
    if curve is None:
        return None
    missing = _find_missing(assessment, ground)
    if missing or ground is None:
        tables = replace(_describe_curve(curve), missing=missing)
        return Annual(tables, {}, AnnualWays({}, {}, {}))
    return _Annual(assessment, curve, assessment.settings.scale * ground).evaluate(jobs, progress)


def _find_missing(assessment: Assessment, ground: float | None) -> Text | str:
    """Return what an annual chance needs and does not have, and how to give it; "" where all is there."""
    if ground is None:
        return fill(
            "the peak ground acceleration of this scenario is not known: fill in Ground PGA in Building, that of the "
            "same earthquake as the floors' motions"
        )
    if not (assessment.cases.ensemble >= 0).any():
        return fill("no piece was simulated, which annual chances need: simulate them")
    return ""


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
        """The cases, with the dispersion of the floors' motions at a ground PGA, which is never none."""
        own = self.assessment.cases.uncertainty
        return replace(self.assessment.cases, uncertainty=Uncertainty(motion=own.motion or MOTION, piece=own.piece))

    @property
    def settings(self) -> Settings:
        """The settings, with a number of draws."""
        settings = self.assessment.settings
        return replace(settings, runs=RUNS) if settings.runs == AUTO else settings

    def find_levels(self) -> FloatArray:
        """Return rising levels, as ground PGA [m/s2]: from where nothing can rock to beyond the end of the curve."""
        cases = self.cases
        rocked = cases.ensemble >= 0
        start = STILL * GRAVITY * cases.threshold[rocked] / cases.pfa[rocked]
        largest = cases.uncertainty.largest
        last = float(self.curve.pga[-1]) * largest
        first = float(np.clip(self.ground * start.min(), self.curve.pga[0] / largest, last / STEP))
        return space(first, last)

    def evaluate(self, jobs: int | None, progress: Progress) -> Annual:
        """Rock every piece at every level, and integrate."""
        levels, cases, assessment = self.find_levels(), self.cases, self.assessment
        factors = np.repeat((levels / self.ground)[np.newaxis], len(cases.ensembles), axis=0)
        rocked = rock_levels(
            cases, assessment.case_item, assessment.case_demand, factors, self.settings,
            dispersion=0.0, jobs=jobs, progress=progress,
        )  # fmt: skip
        return progress.wait_for(lambda: self._integrate(levels, rocked, progress))

    def _integrate(self, levels: FloatArray, rocked: Sequence[RockedLevels], progress: Progress) -> Annual:
        assessment, cases = self.assessment, self.cases
        falls = [self._find_falls(at, float(level), rocked) for at, level in enumerate(levels)]
        integrate = Integral(self.curve, levels, cases.uncertainty.motion, int(self.settings.runs))
        doubtful = self._list_doubtful(rocked)
        fell = {item: np.array([one.fell[item] for one in falls]) for item in sorted(falls[0].fell)}
        items = {item: integrate.of_draws(own, at_least=item in doubtful) for item, own in fell.items()}
        counted = [item for item in items if assessment.inventory.items[item].anchored != "yes"]
        ways = evaluate_ways(assessment, falls, integrate, doubtful, self.settings, progress)
        return Annual(self._describe(levels, integrate, items, fell, counted), items, ways)

    def _find_falls(self, at: int, level: float, rocked: Sequence[RockedLevels]) -> Falls:
        pfa = self.assessment.cases.pfa * (level / self.ground)
        every = [(one.own, one.fell[at]) for one in rocked]
        return find_falls(self.assessment, self.cases, pfa, every, self.settings)

    def _list_doubtful(self, rocked: Sequence[RockedLevels]) -> frozenset[int]:
        """Return the pieces whose motions may be too weak, by their index."""
        ensembles = zip(self.cases.ensembles, rocked, strict=True)
        own = [one.own for made, one in ensembles if made.is_unshaped or one.is_weak]
        return frozenset(self.assessment.case_item[np.concatenate(own)].tolist() if own else ())

    def _describe(
        self,
        levels: FloatArray,
        integrate: Integral,
        items: Mapping[int, AnnualRow],
        fell: Mapping[int, BoolArray],
        counted: Sequence[int],
    ) -> AnnualTables:
        """Return what stands for the building: `counted` are its free-standing pieces that were simulated."""
        inventory = self.assessment.inventory
        quantity = {item: inventory.items[item].quantity for item in counted}
        falls = np.zeros((levels.size, integrate.runs))
        for item in counted:
            falls += quantity[item] * fell[item]
        expected = sum(quantity[item] * items[item].rate for item in counted)
        spread = integrate.find_spread(falls) if counted else None
        safety = [item for item in counted if inventory.items[item].importance == "life safety"]
        at_least = [item for item in counted if items[item].at_least]
        standing = sum(one.quantity for one in inventory.items if one.anchored != "yes")
        everything = sum(quantity.values())
        return replace(
            _describe_curve(self.curve),
            ground_pga_g=self.ground / GRAVITY,
            motion_dispersion=self.cases.uncertainty.motion,
            runs=integrate.runs,
            factors=tuple((levels / self.ground).tolist()),
            pieces=everything,
            not_evaluated=standing - everything,
            at_least=sum(quantity[item] for item in at_least),
            expected_falls=expected,
            expected_low=None if spread is None else max(0.0, expected * (1 - spread)),
            expected_high=None if spread is None else expected * (1 + spread),
            life_safety_pieces=sum(quantity[item] for item in safety),
            life_safety=_join([fell[item] for item in safety], [items[item] for item in safety], integrate),
            remarks=(*integrate.list_remarks(falls, everything), *_remark_on_ends(quantity, items)),
        )


def _join(fell: Sequence[BoolArray], rows: Sequence[AnnualRow], integrate: Integral) -> AnnualRow | None:
    """Return the annual row of any of some pieces falling; None where there are none."""
    if not rows:
        return None
    return integrate.of_draws(np.any(fell, axis=0), at_least=any(one.at_least for one in rows))


def _remark_on_ends(quantity: Mapping[int, int], items: Mapping[int, AnnualRow]) -> Iterator[Text]:
    """Say for how many of the counted pieces the ends of the curve matter."""
    found = sum(count for item, count in quantity.items() if items[item].ends_matter)
    if found:
        yield nfill(
            "for {n:,} piece more than 5 % of the annual rate comes, or could come, from outside the curve",
            "for {n:,} pieces more than 5 % of the annual rate comes, or could come, from outside the curve",
            found,
        )
