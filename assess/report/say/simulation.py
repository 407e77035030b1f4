"""What is said of the simulation: what it rests on, what was drawn, what it changed, and chances a year."""

import math
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from assess.annual_results import YEARS, AnnualRow, AnnualTables
from assess.i18n import fill, ngettext, number
from assess.i18n import gettext as _
from assess.model import SCANNED
from assess.natural import natural_key
from assess.report import words
from assess.report.row_order import by_chance
from assess.report.say.ground import describe_suite, list_narrowing, name_source, say_dispersion, say_signs
from assess.report.summary import describe
from assess.results import EarthquakeDraws, EnsembleRow, ItemResult, MotionRow, Results, Simulation, SuiteInfo
from assess.risk import RiskClass, classify
from assess.settings import AUTO

NAMED = 12
"""Pieces that a sentence names; the rest are counted."""
SCENARIO = fill("Chance of overturning in this scenario, not per year.")
WITH_ANNUAL = fill("Chance of overturning in this scenario, unless it is called a chance a year.")
INTERVAL = fill("the sampling interval covers the number of draws only")
ASSUMED = fill("the range is what is not known of the ground and of the building")
WILSON = (
    "Wilson EB (1927). Probable inference, the law of succession, and statistical inference. Journal of the American "
    "Statistical Association 22(158):209-212. doi:10.1080/01621459.1927.10502953"
)
"""The interval of a simulated chance."""


def say_range(results: Results) -> str:
    """Return what the range behind a simulated chance is, without a full stop."""
    assumed = {one.ensemble.assumed_motion for one in results.motions if one.ensemble is not None}
    if assumed == {True}:
        return _(ASSUMED)
    if True in assumed:
        return _("{interval}; on assumed motion {range}", interval=_(INTERVAL), range=_(ASSUMED))
    return _(INTERVAL)


def say_scenario(results: Results) -> str:
    """Return what the chances of a report are, for the foot of every page."""
    has_annual = results.annual is not None and results.annual.is_evaluated
    return _(WITH_ANNUAL if has_annual else SCENARIO)


@dataclass(frozen=True, slots=True)
class Verified:
    """The rows of a report by what simulation found.

    `done` were simulated, `left` were not and can rock. Of those done, `unconfirmed` have a class that cannot be relied
    on: nothing is known of their building, or they keep the formula's, as the motions are weak. Of the others,
    `lowered` and `raised` have another class than the formula's; `may_be` have a range that reaches into a higher
    class; `undecided` are not resolved after the last check of "auto"; `fell` overturn under a recorded motion itself;
    `ideal_higher` would have a higher class if exactly this motion recurred.
    """

    run: Results
    left: Sequence[ItemResult]
    done: Sequence[ItemResult]
    lowered: Sequence[ItemResult]
    raised: Sequence[ItemResult]
    unconfirmed: Sequence[ItemResult]
    may_be: Sequence[ItemResult]
    undecided: Sequence[ItemResult]
    fell: Sequence[ItemResult]
    ideal_higher: Sequence[ItemResult]

    @property
    def is_all(self) -> bool:
        """Whether every row was simulated."""
        return bool(self.done) and not self.left

    @property
    def motions(self) -> str:
        """Number and kind of the motions."""
        if suite := self.run.provenance.suite:
            return ngettext("{n:,} motion of the user's own", "{n:,} motions of the user's own", len(suite))
        return _("{motions} on each floor and axis", motions=count_motions(self.run))

    @property
    def status(self) -> tuple[str, str]:
        """The state of the report in one or two words, and what it means."""
        if not self.done:
            return _("Not simulated"), _("classes come from a published formula; no rocking has been simulated")
        texts = [
            ngettext(
                "rocking of {done:,} of {n:,} row simulated, {motions}",
                "rocking of {done:,} of {n:,} rows simulated, {motions}",
                len(self.run), done=len(self.done), motions=self.motions,
            )
        ]  # fmt: skip
        if self.unconfirmed:
            texts.append(
                ngettext(
                    "{n:,} row is unconfirmed and counted apart",
                    "{n:,} rows are unconfirmed and counted apart",
                    len(self.unconfirmed),
                )
            )
        if self.left:
            texts.append(_("the other rows have a class by a published formula, and are counted apart"))
        return _("Simulated") if self.is_all else _("Partly simulated"), "; ".join(texts)

    @property
    def footer(self) -> str:
        """The foot of every page, but for what `list_conditions` adds."""
        if not self.done:
            return f"{say_scenario(self.run)} {self.sentence}"
        extent = ngettext(
            "Simulated: {done:,} of {n:,} row; {interval}.", "Simulated: {done:,} of {n:,} rows; {interval}.",
            len(self.run), done=len(self.done), interval=say_range(self.run),
        )  # fmt: skip
        return f"{say_scenario(self.run)} {extent}"

    @property
    def conditions(self) -> str:
        """What the head of every page says of the run: "" of a run with both uncertainties and the motions as given."""
        return " · ".join(list_conditions(self.run))

    @property
    def interval(self) -> str:
        """What the range covers, what would narrow it, and which percentages have none; without a full stop."""
        if not self.done:
            return _("there are no intervals, as no rocking has been simulated in this run")
        texts = [say_range(self.run)]
        if ways := list_narrowing(self.run):
            most = ways[0] if len(ways) == 1 else _("{first}, else {second}", first=ways[0], second=ways[1])
            texts.append(_("what would narrow it most: {ways}", ways=most))
        if self.left or not all(one.adopted.has_simulated for one in self.unconfirmed):
            texts.append(_("percentages without a range come from the formula only"))
        return "; ".join(texts)

    @property
    def adopted(self) -> str:
        """Which method the adopted chances come from."""
        titles = {"formula": _(self.run.formula.title), "simulation": _(self.run.simulation.title)}
        if not self.done:
            text = _("Adopted risk: {formula}. The other methods are shown for comparison.", **titles)
        else:
            text = _(
                "Adopted risk: {simulation} (direct integration) where a piece was simulated, otherwise {formula}, "
                "counted apart. The other methods are shown for comparison.", **titles,
            )  # fmt: skip
        if any(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _(
                "Where nothing is known of the building, the class is at least that of the faster third of the draws, "
                "unconfirmed."
            )
        if not all(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _(
                "Where simulation gave a lower class under motions weaker than the floor's, the class is that of "
                "{formula}, unconfirmed.", **titles,
            )  # fmt: skip
        return text

    @property
    def sentence(self) -> str:
        """How much was simulated, and what that changed, in one sentence."""
        if not self.done:
            return _("Not simulated.")
        extent = ngettext(
            "Simulated by direct integration: {done:,} of {n:,} row, {motions} each",
            "Simulated by direct integration: {done:,} of {n:,} rows, {motions} each",
            len(self.run), done=len(self.done), motions=count_motions(self.run),
        )  # fmt: skip
        return "; ".join([extent, *self._list_changes()]) + "."

    def _list_changes(self) -> Iterator[str]:
        if self.lowered:
            yield _("class lowered: {pieces}", pieces=count_rows(self.lowered))
        if self.raised:
            yield _("class raised: {pieces}", pieces=count_rows(self.raised))
        if self.may_be:
            yield _("could be of a higher class: {pieces}", pieces=count_rows(self.may_be))
        if self.unconfirmed:
            yield _("unconfirmed: {pieces}", pieces=count_rows(self.unconfirmed))
        if n := len(self.fell):
            yield ngettext(
                "{n:,} row overturns under the record itself", "{n:,} rows overturn under the record itself", n
            )
        if n := len(self.undecided):
            yield ngettext("{n:,} row still undecided", "{n:,} rows still undecided", n)

    @property
    def summary(self) -> list[str]:
        """What simulation changed, and what is open, line by line."""
        if not self.done:
            return []
        most = self.run.provenance.looks[-1]
        lines = [
            (_("Class lowered by simulation"), self.lowered,
             ", ".join(_("{n:,} from {risk}", n=n, risk=risk)
                       for n, risk in _by_class(self.lowered, lambda one: one.adopted.lowered_from))),
            (_("Class raised by simulation"), self.raised,
             ", ".join(_("{n:,} to {risk}", n=n, risk=risk)
                       for n, risk in _by_class(self.raised, lambda one: one.adopted.risk))),
            (_("Unconfirmed, as nothing is known of the building, or the formula's class although simulation gave a "
               "lower one, as the motions are weaker than the floor's"),
             self.unconfirmed, name_some(self.unconfirmed)),
            (_("Could be of a higher class: the range reaches into it"), self.may_be, ""),
            (_("Would be of a higher class if exactly this motion recurred and the piece were exactly as given"),
             self.ideal_higher, name_some(self.ideal_higher)),
            (_("Undecided: the interval still covers more than one class after {most:,} motions", most=most),
             self.undecided, name_some(self.undecided)),
            (_("Overturn under the recorded motion itself, and so are at least high"), self.fell, name_some(self.fell)),
            (_("Not simulated: chance and class come from the formula"), self.left, ""),
        ]  # fmt: skip
        return [
            f"{label}: {count_rows(results)}{': ' if more else ''}{more}." for label, results, more in lines if results
        ]


def build_verified(run: Results, results: Sequence[ItemResult]) -> Verified:
    """Sort the rows by what simulation found."""

    def of(test: Callable[[ItemResult], bool]) -> tuple[ItemResult, ...]:
        return tuple(one for one in done if not one.apart and test(one))

    done = tuple(one for one in results if one.is_simulated)
    return Verified(
        run=run,
        left=tuple(one for one in results if not one.is_simulated and one.adopted.can_rock),
        done=done,
        unconfirmed=tuple(one for one in done if one.adopted.is_unconfirmed),
        lowered=of(lambda one: one.adopted.lowered_from is not None),
        raised=of(lambda one: one.adopted.risk > one.formula_class),
        may_be=of(lambda one: words.find_highest(one) > one.adopted.risk),
        undecided=of(lambda one: "undecided" in one.adopted.flags),
        fell=of(lambda one: one.fell_in_record),
        ideal_higher=of(lambda one: "ideal_higher" in one.adopted.flags),
    )


def describe_verification(results: Results) -> str:
    """Return how much was simulated, and what that changed, in one sentence."""
    return build_verified(results, tuple(results)).sentence


def count_motions(results: Results) -> str:
    """Return how many motions each piece was simulated under."""
    runs, looks = results.settings.runs, results.provenance.looks
    if runs == AUTO:
        return _("{least:,} to {most:,} motions", least=looks[0], most=looks[-1])
    return words.plural(int(runs), "motion")


def _by_class(
    results: Sequence[ItemResult], risk_of: Callable[[ItemResult], RiskClass | None]
) -> Iterator[tuple[int, str]]:
    """Yield the number of pieces and the class, the highest first."""
    for risk in reversed(RiskClass):
        if count := _pieces(one for one in results if risk_of(one) == risk):
            yield count, words.risk_word(risk)


def _pieces(results: Iterable[ItemResult]) -> int:
    return sum(one.item.quantity for one in results)


def count_rows(results: Sequence[ItemResult]) -> str:
    """Return ``5 pieces in 3 rows``, with the number of anchored pieces, which have no class."""
    anchored = _pieces(one for one in results if one.is_anchored)
    pieces, rows = words.plural(_pieces(results), "piece"), words.plural(len(results), "row")
    if not anchored:
        return _("{pieces} in {rows}", pieces=pieces, rows=rows)
    return _("{pieces} in {rows} ({anchored:,} of them anchored)", pieces=pieces, rows=rows, anchored=anchored)


def name_some(results: Sequence[ItemResult]) -> str:
    """Return the names of the first rows, and how many more there are."""
    return words.name_pieces([one.item.item for one in results], NAMED, 40)


# ---------------------------------------------------------------- what was simulated

LARGE_MISFIT = 0.10
"""Mean deviation of a spectrum from its target above which a sentence says so [-]."""
LISTED = 20
"""Rows of the lists of changes and of falls under the record."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorMotions:
    """The motions of one floor along one axis as the table shows them."""

    floor: str
    axis: str
    source: str
    kind: str
    motions: str
    rows: int
    spectrum: str
    pfa: str
    pfv: str


@dataclass(frozen=True, slots=True)
class Trials:
    """What the section shows."""

    paragraphs: Sequence[str]
    motions: Sequence[FloorMotions]
    misfits: Sequence[str]
    changed: Sequence[ItemResult]
    fell: Sequence[ItemResult]


def build_trials(results: Results, verified: Verified) -> Trials:
    """Gather the section; empty where nothing was simulated."""
    made = [(one, one.ensemble) for one in results.motions if one.ensemble is not None]
    return Trials(
        paragraphs=tuple(_describe(results, verified)) if verified.done else (),
        motions=tuple(_floor_motions(results, motion, ensemble) for motion, ensemble in made),
        misfits=tuple(_misfits(made)),
        changed=(*sorted(verified.raised, key=_by_change), *sorted(verified.lowered, key=_by_change)),
        fell=sorted(verified.fell, key=by_chance),
    )


def _by_change(one: ItemResult) -> tuple[object, ...]:
    return -abs(one.adopted.risk - one.formula_class), *by_chance(one)


# ---------------------------------------------------------------- paragraphs


def _describe(results: Results, verified: Verified) -> Iterator[str]:
    yield f"{_extent(verified)} {_selection(results)}"
    yield _describe_motions(results)
    yield f"{_describe_draws(results)} {_restitution(results)} {_interval(results)}"
    if results.settings.runs == AUTO:
        yield _stopping(results, verified)


def _extent(verified: Verified) -> str:
    n = sum(one.does_not_rock for one in verified.run)
    text = _(
        "The rocking of {done:,} of {rows} was integrated step by step (Housner's equations of a rigid block, see "
        "Methods). The chance is the share of draws in which the piece overturns, each of one motion.",
        done=len(verified.done), rows=words.plural(len(verified.run), "row"),
    )  # fmt: skip
    stocky = ngettext(
        "{n:,} row is too stocky to rock (B/H of {limit:.2f} or more).",
        "{n:,} rows are too stocky to rock (B/H of {limit:.2f} or more).",
        n, limit=1.41,
    )  # fmt: skip
    return f"{text} {stocky}" if n else text


def _selection(results: Results) -> str:
    if results.settings.verify == "all":
        return _("All rows were chosen.")
    return _(
        "Chosen were the rows of high or very high class by any of these under any of their motions: {methods}; those "
        "outside the range in which one of these was checked: {formulas}; and those on a route.",
        methods=", ".join(_(one.title) for one in results.methods if one.selects),
        formulas=", ".join(_(one.title) for one in results.methods if one.selecting_flags),
    )  # fmt: skip


def _describe_motions(results: Results) -> str:
    if results.provenance.suite:
        return _(
            "The motions are the user's own: {motions}. Motion k serves every floor and axis.",
            motions=describe_suite(results),
        )
    runs = results.settings.runs
    made = _(
        "On each floor and axis {motions} were generated (seed {seed}). Their mean 5 % response spectrum matches that "
        "of the floor's recorded motion, or of drawn earthquakes in drawn buildings where no record is known. The "
        "former differ by their random phases alone, which is less than earthquakes differ.",
        motions=_("as many motions as are needed") if runs == AUTO else words.plural(int(runs), "motion"),
        seed=results.settings.seed,
    )
    return f"{made} {say_signs(results)}"


def _describe_draws(results: Results) -> str:
    uncertainty = results.provenance.uncertainty
    if results.settings.ideal:
        return _("The adopted chance is the one if exactly this motion recurred and every piece were exactly as given.")
    parts = []
    if uncertainty.motion:
        parts.append(_(
            "In draw k, motion k is scaled by exp({dispersion} ε), with one normal number ε for the whole building "
            "({source}).",
            dispersion=number(uncertainty.motion, ".3g"), source=say_source(results),
        ))  # fmt: skip
    parts += filter(None, [say_draws(results)])
    if uncertainty.piece:
        parts.append(_(
            "Each piece draws its base × N({mean}, {base}), its height × N(1, {height}), its centre of gravity N(as "
            "given, {centre}) of its height and its restitution N(as given or Housner's, {restitution}), as assumed.",
            mean=number(uncertainty.base[0]), base=number(uncertainty.base[1]), height=number(uncertainty.height),
            centre=number(uncertainty.centre), restitution=number(uncertainty.restitution),
        ))  # fmt: skip
        parts += _describe_scanned(results)
    if parts:
        parts.append(_("Normal numbers are cut at {cut:g} standard deviations.", cut=uncertainty.cut))
    return " ".join([*parts, _("“If exactly this motion recurred” is the chance without either uncertainty.")])


def _describe_scanned(results: Results) -> list[str]:
    uncertainty = results.provenance.uncertainty
    if not count_scanned(results):
        return []
    return [_(
        "A piece whose sizes were measured by a scan draws its base × N({mean}, {base}) and its height × N(1, "
        "{height}), as assumed: no accuracy of such sizes is published.",
        mean=number(uncertainty.scanned_base[0]), base=number(uncertainty.scanned_base[1]),
        height=number(uncertainty.scanned_height),
    )]  # fmt: skip


def _restitution(results: Results) -> str:
    own = results.building.restitution
    if own is None:
        return _("At each impact a piece keeps 1 - 1.5 sin²α of its angular velocity (Housner 1963).")
    return _("At each impact a piece keeps {share:g} of its angular velocity, as set in the workbook.", share=own)


def _interval(results: Results) -> str:
    return _(
        "The sampling interval is Wilson's with z = {z:.2f}; it covers the number of draws only: not the model of the "
        "block, not how well the floor's motion is known, not the assumed dispersions.",
        z=results.provenance.interval_z,
    )


def _stopping(results: Results, verified: Verified) -> str:
    looks = results.provenance.looks
    text = _(
        "Motions were added until every class was statistically resolved, each piece's interval lying within one "
        "class. This was checked after {looks} and {last:,} motions, with an interval (z = {z:g}) that holds with 95 % "
        "for all {checks} checks together.",
        looks=", ".join(number(look, ",") for look in looks[:-1]), last=looks[-1], z=results.provenance.interval_z,
        checks=len(looks),
    )  # fmt: skip
    left = _("No piece is left undecided.")
    if verified.undecided:
        left = _("Undecided after {last:,}: {pieces}.", last=looks[-1], pieces=name_some(verified.undecided))
    return f"{text} {left}"


# ---------------------------------------------------------------- motions of each floor


def _floor_motions(results: Results, motion: MotionRow, ensemble: EnsembleRow) -> FloorMotions:
    fit, suite = ensemble.fit, results.provenance.suite
    pfa = pfv = spectrum = words.DASH
    if suite is not None:
        factors = [motion.pfa_g / pfa if suite.is_scaled else 1.0 for pfa in suite.pfa_g]
        pfa = _peak_ratio(suite.pfa_g, factors, motion.pfa_g)
        pfv = _peak_ratio(suite.pfv_cm_s, factors, motion.pfv_cm_s)
    elif fit is not None:
        pfa, pfv = _ratio(fit.pfa_ratio, fit.pfa_scatter), _ratio(fit.pfv_ratio, fit.pfv_scatter)
        mean = words.deviation(fit.mean_deviation)
        spectrum = _("{mean}; {most:+.1f} % at {period:.2f} s", mean=mean, most=100 * fit.worst_deviation,
                     period=fit.worst_period_s)  # fmt: skip
    least, most = ensemble.least_motions, ensemble.motions
    return FloorMotions(
        floor=words.cut(motion.floor, 20),
        axis=motion.axis,
        source=words.cut(_(motion.label).rsplit("/", 1)[-1], 60),
        kind=_kind(suite, ensemble),
        motions=number(most, ",") if least == most else _("{least:,} to {most:,}", least=least, most=most),
        rows=ensemble.cases,
        spectrum=spectrum,
        pfa=pfa,
        pfv=pfv,
    )


def _kind(suite: SuiteInfo | None, ensemble: EnsembleRow) -> str:
    if suite is not None:
        return _("own, scaled to PFA") if suite.is_scaled else _("own, not scaled")
    if ensemble.unknown_building:
        return _("assumed motion, nothing known of the building")
    return _("assumed motion") if ensemble.assumed_motion else _("recorded motion")


def _ratio(ratio: float | None, scatter: float) -> str:
    """Return a ratio of peaks with its scatter, a coefficient of variation."""
    return words.DASH if ratio is None else f"{number(ratio, '.2f')} ± {number(ratio * scatter, '.2f')}"


def _peak_ratio(peaks: Sequence[float], factors: Sequence[float], floor: float | None) -> str:
    if not floor:
        return words.DASH
    ratios = [peak * factor / floor for peak, factor in zip(peaks, factors, strict=True)]
    mean = statistics.fmean(ratios)
    return _ratio(mean, statistics.pstdev(ratios) / mean)


def _misfits(made: Sequence[tuple[MotionRow, EnsembleRow]]) -> Iterator[str]:
    for motion, ensemble in made:
        fit = ensemble.fit
        if fit is not None and fit.mean_deviation > LARGE_MISFIT:
            yield _(
                "Floor {floor} {axis}: PFA and the spectrum cannot both be matched. PFA takes precedence; the mean "
                "spectrum deviates by {mean} on average, and by {most} at {period:.2f} s, where it is worst.",
                floor=words.cut(motion.floor, 20), axis=motion.axis, mean=words.deviation(fit.mean_deviation),
                most=words.deviation(abs(fit.worst_deviation)), period=fit.worst_period_s,
            )  # fmt: skip


def list_assumed_draws(results: Results, verified: Verified) -> list[tuple[str, str]]:
    """Return the assumptions of the simulation; nothing where none ran."""
    if not verified.done:
        return []
    own, z = results.building.restitution, results.provenance.interval_z
    restitution = _("1 - 1.5 sin²α (Housner 1963), as the workbook leaves it blank")
    if own is not None:
        restitution = _("{ratio:g}, the workbook's", ratio=own)
    motions = verified.motions
    if results.provenance.suite is None:
        motions = _("{motions}, generated with seed {seed}", motions=motions, seed=results.settings.seed)
    interval = _("Wilson's, z = {z:.2f}: 95 %", z=z)
    if results.settings.runs == AUTO:
        checks = len(results.provenance.looks)
        interval = _("Wilson's, z = {z:.2f}: 95 % for all {checks} checks together", z=z, checks=checks)
    return [
        *_list_uncertainties(results),
        (_("Restitution (angular velocity after an impact over that before)"), restitution),
        (_("Motions of the simulation"), motions),
        (_("Interval of a simulated chance"), interval),
    ]


def _list_uncertainties(results: Results) -> list[tuple[str, str]]:
    uncertainty = results.provenance.uncertainty
    motion = _("{dispersion}, {source}", dispersion=number(uncertainty.motion, ".3g"), source=say_source(results))
    piece = _("base, height, centre of gravity and restitution are drawn, with assumed dispersions")
    if not uncertainty.piece:
        piece = _("none: every piece is exactly as given")
    if results.settings.ideal:
        motion, piece = (_("{text}; left out in this run", text=text) for text in (motion, piece))
    return [
        (_("Motion uncertainty (standard deviation of ln amplitude, one draw for the whole building)"), motion),
        *list_draw_assumptions(results),
        (_("Piece uncertainty"), piece),
    ]


# ---------------------------------------------------------------- what was assumed uncertain

NAMED_WANTED = 4
"""Pieces that are named on every page."""


def list_conditions(results: Results) -> list[str]:
    """Return what every page of a report says: source of the ground motion, nothing varied, motions times a factor."""
    texts = []
    if shaking := results.provenance.shaking:
        texts.append(_("Assumed shaking: {intensity}", intensity=_(shaking.choice)))
    if site := results.provenance.site_ground:
        texts.append(_("Ground motion: {source}", source=name_source(site)))
    if results.settings.ideal and results.has_simulated:
        texts.append(_("Assumed: exactly this motion, and every piece exactly as given"))
    if results.settings.scale != 1:
        texts.append(_("Every floor's motion times {scale}", scale=number(results.settings.scale, "g")))
    if results.settings.anchor:
        texts.append(_say_anchored(results))
    return texts


def _say_anchored(results: Results) -> str:
    wanted = results.settings.anchor
    if isinstance(wanted, int):
        return ngettext(
            "Taken as anchored and holding: the first entry of what to fix",
            "Taken as anchored and holding: the first {n:,} entries of what to fix",
            wanted,
        )
    return _("Taken as anchored and holding: {items}", items=words.name_pieces(wanted, NAMED_WANTED, 40))


def say_assumed(results: Results) -> str:
    """Return what was assumed uncertain, in a sentence or two; "" where nothing was simulated."""
    if not results.has_simulated:
        return ""
    if results.settings.ideal:
        return _(
            "It is assumed that exactly this motion recurs and that every piece is exactly as given: nothing is varied."
        )
    return f"{_say_motion(results)} {_say_piece(results)}"


def say_condition(results: Results) -> str:
    """Return for which earthquake and pieces a chance holds, as a part of a sentence, ``for an earthquake like``."""
    if not results.has_simulated:
        return _("by a published formula, as no rocking has been simulated")
    if results.settings.ideal:
        return _("if exactly this motion recurs and every piece is exactly as given")
    dispersion = results.provenance.uncertainty.motion
    motion = _("if exactly this motion recurs")
    if not dispersion and has_drawn(results):
        motion = _("for earthquakes with the given peaks")
    if dispersion:
        motion = _(
            "for an earthquake like this one (dispersion {dispersion}, {source})",
            dispersion=number(dispersion, ".3g"), source=say_source(results),
        )  # fmt: skip
    if not results.provenance.uncertainty.piece:
        return _("{motion} and pieces exactly as given", motion=motion)
    return _("{motion} and pieces that vary in size, centre of gravity and restitution", motion=motion)


def _say_motion(results: Results) -> str:
    dispersion = results.provenance.uncertainty.motion
    if not dispersion and not has_drawn(results):
        return _("The motions are not scaled, as Motion uncertainty is 0 in the workbook: exactly this motion recurs.")
    if not dispersion:
        return _("Chances hold for earthquakes with the given peaks: ground motions and buildings are drawn.")
    return _(
        "Chances hold for an earthquake like this one: each draw scales the motions of the whole building by one "
        "factor, with a dispersion of {dispersion} (standard deviation of ln amplitude; {source}).",
        dispersion=number(dispersion, ".3g"), source=say_source(results),
    )  # fmt: skip


def say_source(results: Results) -> str:
    """Return where the dispersion of the motions comes from."""
    shaking, given = results.provenance.shaking, results.building.motion_uncertainty
    if shaking and shaking.scatter == results.provenance.uncertainty.motion != given:
        return _("scatter of ln PGV given the intensity, {sources}", sources=", ".join(shaking.sources))
    if site := results.provenance.site_ground:
        return say_dispersion(site)
    return _("assumed") if results.building.motion_uncertainty is None else _("as filled in")


def has_drawn(results: Results) -> bool:
    """Return whether pieces were simulated under drawn motions: ground motion and building are assumed."""
    return any(one.ensemble is not None and one.ensemble.assumed_motion for one in results.motions)


def _say_piece(results: Results) -> str:
    scanned = count_scanned(results)
    if not results.provenance.uncertainty.piece:
        given = _("Sizes, centre of gravity and restitution are exactly as given.")
        return given if not scanned else f"{given} {_say_scanned_as_given(scanned)}"
    varied = _("Sizes, centre of gravity and restitution of each piece are varied.")
    return varied if not scanned else f"{varied} {_say_scanned(scanned)}"


def count_scanned(results: Results) -> int:
    """Return how many pieces have sizes that were measured by a scan."""
    return sum(one.item.quantity for one in results if one.item.sizes_from == SCANNED)


def _say_scanned(scanned: int) -> str:
    return ngettext(
        "Those of {n:,} piece were measured by a scan, which is less accurate: its sizes are varied more.",
        "Those of {n:,} pieces were measured by a scan, which is less accurate: their sizes are varied more.",
        scanned,
    )


def _say_scanned_as_given(scanned: int) -> str:
    return ngettext(
        "Those of {n:,} piece were measured by a scan, which is less accurate: its chance may be higher or lower.",
        "Those of {n:,} pieces were measured by a scan, which is less accurate: their chances may be higher or lower.",
        scanned,
    )


def say_sensitivity(results: Results, rows: Sequence[ItemResult]) -> str:
    """Return how many simulated pieces would have another class under other assumptions; "" where none was simulated.

    Compared are the classes by the chance under the governing motion: with each other dispersion of the motions that
    was tried; where uncertainty was left out (`Settings.ideal`), with it.
    """
    counted = [one for one in rows if not one.is_anchored and one.adopted.is_simulated]
    simulated = [(one, found) for one in counted if (found := one.governing.simulation) is not None]
    if not results.settings.ideal:
        simulated = [(one, found) for one, found in simulated if found.tried]  # what is drawn scatters by itself
    if not simulated:
        return ""
    if results.settings.ideal:
        changes = _count((one, found.ideal.probability, found.probability) for one, found in simulated if found.ideal)
        return _(
            "In an earthquake like this one (dispersion {dispersion}), {changes}.",
            dispersion=number(results.provenance.uncertainty.motion, ".3g"), changes=_say_changes(*changes),
        )  # fmt: skip
    return " ".join(_list_tried(results, simulated))


def _list_tried(results: Results, simulated: Sequence[tuple[ItemResult, Simulation]]) -> Iterator[str]:
    """Yield what other dispersions would change; none below the scatter that a published relation gives."""
    assumed, site = results.provenance.shaking, results.provenance.site_ground
    least = assumed.scatter if assumed else site.dispersion if site else 0.0
    for dispersion in simulated[0][1].tried:
        if dispersion >= least and dispersion != results.provenance.uncertainty.motion:
            changes = _count((one, found.probability, found.tried[dispersion]) for one, found in simulated)
            yield _("With a dispersion of {dispersion}, {changes}.", dispersion=number(dispersion, ".3g"),
                    changes=_say_changes(*changes))  # fmt: skip


def _count(changes: Iterable[tuple[ItemResult, float, float]]) -> tuple[int, int]:
    """Return how many pieces would be of a higher and of a lower class, of rows with their chance now and then."""
    up = down = 0
    for one, now, then in changes:
        least = RiskClass.HIGH if one.fell_in_record else RiskClass.LOW
        change = max(_class(then), least) - max(_class(now), least)
        up += one.item.quantity * (change > 0)
        down += one.item.quantity * (change < 0)
    return up, down


def _class(probability: float) -> RiskClass:
    return classify(probability) or RiskClass.LOW


def _say_changes(up: int, down: int) -> str:
    if not up and not down:
        return _("no piece would change class")
    higher = ngettext("{n:,} piece would be in a higher class", "{n:,} pieces would be in a higher class", up)
    lower = ngettext("{n:,} piece would be in a lower class", "{n:,} pieces would be in a lower class", down)
    if up and down:
        return _("{higher} and {lower}", higher=higher, lower=lower)
    return higher if up else lower


# ---------------------------------------------------------------- draws by place and scenarios

BOORE = (
    "Boore D, Stewart J, Seyhan E, Atkinson G (2014). NGA-West2 equations for predicting PGA, PGV, and 5 % damped PSA "
    "for shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M"
)
JAYARAM = (
    "Jayaram N, Baker J (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake "
    "Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922"
)


def find_draws(results: Results) -> EarthquakeDraws | None:
    """Return how earthquakes were drawn; None where one factor for the building alone was, or none."""
    is_drawn = results.has_simulated and not results.settings.ideal and results.provenance.uncertainty.motion > 0
    return results.provenance.earthquakes if is_drawn else None


def say_draws(results: Results) -> str:
    """Return how the number of a draw depends on the place and on scenarios, in sentences; "" where it does not."""
    draws = find_draws(results)
    return "" if draws is None else " ".join(_list_sentences(draws, has_suite=results.provenance.suite is not None))


def _list_sentences(draws: EarthquakeDraws, *, has_suite: bool) -> Iterator[str]:
    if draws.scenarios:
        yield ngettext(
            "A share of {share} of the variance of ε is that of {n:,} scenario of the ground; the rest is drawn.",
            "A share of {share} of the variance of ε is that of {n:,} scenarios of the ground, draw by draw in their "
            "order; the rest is drawn.",
            draws.scenarios, share=number(draws.scenario_share, ".2f"),
        )  # fmt: skip
    if not draws.is_city:
        return
    if draws.is_placed:
        yield _say_place(draws)
    else:
        yield _(
            "The draws are those of a city, but the building's Latitude and Longitude are not filled in: ε is the "
            "number that all places have in common, so that buildings without a place are fully correlated."
        )
    if not has_suite:
        yield _(
            "Motion k has the same random phases in every building, so that sums over buildings vary more than they "
            "should, not less."
        )


def _say_place(draws: EarthquakeDraws) -> str:
    source = _("as the ShakeMap gives it") if draws.is_shared_given else _("Boore et al. 2014")
    return _(
        "The draws are those of a city: what is drawn, of ln {measure}, has a part that is common to all places, a "
        "share of {shared} of its variance ({source}), and one that is correlated with that of a place at a distance h "
        "by exp(-3h/{range} km) (Jayaram and Baker 2009).",
        measure=draws.measure, shared=number(draws.shared, ".3f"), source=source, range=number(draws.range_km, "g"),
    )  # fmt: skip


def list_references(results: Results) -> list[str]:
    """Return the publications that the draws rest on; none where they do not depend on the place."""
    draws = find_draws(results)
    if draws is None or not draws.is_placed:
        return []
    return [JAYARAM] if draws.is_shared_given else [BOORE, JAYARAM]


def list_draw_assumptions(results: Results) -> list[tuple[str, str]]:
    """Return the assumption on the draws of an earthquake; none where they depend neither on place nor scenarios."""
    text = say_draws(results)
    return [(_("Draws of an earthquake (ε is the number by which draw k scales the motions)"), text)] if text else []


# ---------------------------------------------------------------- chances a year

LEAST, MOST = 1e-5, 0.999
"""Chances beyond which no digits are shown [-]."""


@dataclass(frozen=True, slots=True)
class AnnualLine:
    """One line of a table: its name, what and where it is, and its chances; `row` has the numbers.

    `fail` are those with anchored pieces taken as free-standing, of a route that they reach.
    """

    name: str
    what: str
    where: str
    row: AnnualRow
    fail: AnnualRow | None = None

    @property
    def a_year(self) -> str:
        """The chance a year."""
        return say_share(self.row.chance_a_year, self.row)

    @property
    def in_50_years(self) -> str:
        """The chance in 50 years."""
        return say_share(self.row.chance_in_50_years, self.row)

    @property
    def once_in(self) -> str:
        """The mean time between two of them [years]."""
        return say_years(self.row)

    @property
    def interval(self) -> str:
        """The 95 % sampling interval of the chance in 50 years."""
        return say_interval(self.row)

    @property
    def if_anchors_fail(self) -> str:
        """The chance in 50 years with anchored pieces taken as free-standing; a dash where there are none."""
        return words.DASH if self.fail is None else say_share(self.fail.chance_in_50_years, self.fail)

    @property
    def median(self) -> str:
        """Ground PGA at which it happens in half of the draws [g], with the dispersion; a dash without a lognormal."""
        if self.row.median_g is None or self.row.dispersion is None:
            return words.DASH
        return f"{number(self.row.median_g, '.2f')} ({number(self.row.dispersion, '.2f')})"


@dataclass(frozen=True, slots=True)
class AnnualChances:
    """What the section shows; every list is sorted, the likeliest first.

    The first of `paragraphs` is what the summary says: the building's own, or why nothing was evaluated.
    """

    is_evaluated: bool
    paragraphs: Sequence[str]
    remarks: Sequence[str]
    pieces: Sequence[AnnualLine]
    routes: Sequence[AnnualLine]
    rooms: Sequence[AnnualLine]


def build_annual(results: Results, rows: Sequence[ItemResult]) -> AnnualChances | None:
    """Gather the section; None where the workbook names no hazard file."""
    found = results.annual
    if found is None:
        return None
    if not found.is_evaluated:
        missing = _("Chances a year were not evaluated: {why}.", why=_(found.missing))
        return AnnualChances(False, (missing,), tuple(map(_, found.remarks)), (), (), ())
    ways = results.route_tables
    routes = (
        AnnualLine(one.route, "", ", ".join(one.floors), one.annual, one.annual_if_anchors_fail)
        for one in ways.routes
        if one.annual
    )
    return AnnualChances(
        is_evaluated=True,
        paragraphs=(
            " ".join(_say_building(found)),
            " ".join(_say_basis(found, results)),
            " ".join(_say_counted(found)),
        ),
        remarks=tuple(map(_, found.remarks)),
        pieces=_sort(_list_pieces(rows)),
        routes=_sort(routes),
        rooms=_sort(AnnualLine(one.room, "", one.floor, one.annual) for one in ways.rooms if one.annual),
    )


def _list_pieces(rows: Sequence[ItemResult]) -> Iterator[AnnualLine]:
    for one in rows:
        if one.item.annual is not None and not one.is_anchored:
            where = ", ".join(filter(None, (one.item.floor, one.item.room)))
            yield AnnualLine(one.item.item, describe(one), where, one.item.annual)


def _sort(lines: Iterable[AnnualLine]) -> tuple[AnnualLine, ...]:
    return tuple(sorted(lines, key=lambda one: (-one.row.rate, natural_key(one.name))))


# ---------------------------------------------------------------- sentences


def _say_building(found: AnnualTables) -> Iterator[str]:
    yield from _say_falls(found)
    yield from _say_life_safety(found)
    if found.is_lower_bound or (found.life_safety and found.life_safety.at_least):
        yield _("Why these are lower bounds is said in the chapter on chances a year.")


def _say_falls(found: AnnualTables) -> Iterator[str]:
    if not found.pieces:
        yield _("There is no free-standing piece that was simulated and can rock.")
        return
    low, high, falls = found.expected_low, found.expected_high, _say_number(found.expected_falls)
    if found.is_lower_bound:
        yield _(
            "Over all earthquakes that the hazard curve counts, at least {falls} free-standing pieces are expected to "
            "fall a year.",
            falls=falls,
        )
        return
    text = _(
        "Over all earthquakes that the hazard curve counts, {falls} free-standing pieces are expected to fall a year",
        falls=falls,
    )
    if low is not None and high is not None:
        interval = _("95 % sampling interval {low} to {high}", low=_say_number(low), high=_say_number(high))
        text = f"{text} ({interval})"
    yield f"{text}."


def _say_life_safety(found: AnnualTables) -> Iterator[str]:
    row = found.life_safety
    if row is None:
        yield _("No simulated free-standing piece has the Importance life safety.")
        return
    yield _(
        "The chance that any piece of the Importance life safety falls is {year} a year, and {years} in 50 years.",
        year=say_share(row.chance_a_year, row),
        years=say_share(row.chance_in_50_years, row),
    )


def _say_annual_scatter(found: AnnualTables, results: Results) -> str:
    given = results.building.motion_uncertainty
    if given:
        return _(
            "At a given ground PGA the motions of the floors scatter, with the logarithmic standard deviation of "
            "{beta:.2g} of the workbook.",
            beta=found.motion_dispersion,
        )
    return _(
        "At a given ground PGA the motions of the floors scatter, with a logarithmic standard deviation of {beta:.2g}, "
        "which is assumed, also where the scenario is taken as exactly known.",
        beta=found.motion_dispersion,
    )


def _say_basis(found: AnnualTables, results: Results) -> Iterator[str]:
    yield _(
        "The hazard curve is that of the file {file}, from {first} to {last} g.", file=found.file,
        first=number(found.curve_pga_g[0], ".3g"), last=number(found.curve_pga_g[-1], ".3g"),
    )  # fmt: skip
    if found.latitude is not None and found.longitude is not None:
        place = _("Its site is at {lat:.3f} north, {lon:.3f} east", lat=found.latitude, lon=found.longitude)
        if found.distance_km is not None:
            far = _("{km:.1f} km from the building", km=found.distance_km)
            place = f"{place}, {far}"
        yield f"{place}."
    yield ngettext(
        "Every piece that can rock was rocked in {n:,} draw under the motions of the simulation times each of "
        "{levels} factors, from {first} to {last}: the motions of all floors were taken to grow in proportion to the "
        "ground PGA, which is {ground:.3g} g in this scenario. Damage to the building, which changes how its floors "
        "move, is left out.",
        "Every piece that can rock was rocked in {n:,} draws under the motions of the simulation times each of "
        "{levels} factors, from {first} to {last}: the motions of all floors were taken to grow in proportion to the "
        "ground PGA, which is {ground:.3g} g in this scenario. Damage to the building, which changes how its floors "
        "move, is left out.",
        found.runs, levels=len(found.factors), first=_say_number(found.factors[0]),
        last=_say_number(found.factors[-1]), ground=found.ground_pga_g or 0.0,
    )  # fmt: skip
    yield _say_annual_scatter(found, results)
    yield _(
        "The shares that fall were integrated over the curve by the lognormal that fits them, or as a table where that "
        "misses a share by more than 0.05."
    )


def _say_counted(found: AnnualTables) -> Iterator[str]:
    yield ngettext("{n:,} free-standing piece is counted.", "{n:,} free-standing pieces are counted.", found.pieces)
    if found.not_evaluated:
        yield ngettext(
            "{n:,} more was not simulated and is not counted.", "{n:,} more were not simulated and are not counted.",
            found.not_evaluated,
        )  # fmt: skip
    if found.cannot_rock:
        yield ngettext(
            "{n:,} more is too stocky to rock and has no chance here; beside a route it falls by the formula.",
            "{n:,} more are too stocky to rock and have no chance here; beside a route they fall by the formula.",
            found.cannot_rock,
        )  # fmt: skip
    yield _("Anchored pieces are not counted.")
    yield _(
        "≥ marks a lower bound: the motions may be too weak, the hazard curve does not reach far enough, pieces of one "
        "row (Quantity) were taken to fall together, or some were not simulated."
    )
    yield _("The intervals cover the number of draws only, not what is not known of the hazard.")


# ---------------------------------------------------------------- numbers


def say_share(value: float, row: AnnualRow) -> str:
    """Return a chance with two significant digits; lower bounds are marked."""
    mark = "≥ " if row.at_least else ""
    if value < LEAST and row.at_least:
        return _("not known")
    if value == 0:
        return "0 %"
    if value < LEAST:
        return f"< {number(100 * LEAST, '.3f')} %"
    if value > MOST:
        return f"> {number(100 * MOST, '.1f')} %"
    decimals = 1 if value >= 0.01 else 2 if value >= 0.001 else 3
    return f"{mark}{number(100 * value, f'.{decimals}f')} %"


def say_years(row: AnnualRow) -> str:
    """Return the mean time between two events [years]; a dash where none was found."""
    if row.rate <= 0:
        return words.DASH
    years = 1 / row.rate
    return number(years, ".1f") if years < 10 else number(float(f"{years:.2g}"), ",.0f")


def say_interval(row: AnnualRow) -> str:
    """Return the 95 % sampling interval of the chance in 50 years; a dash where it is not known."""
    if row.low is None or row.high is None:
        return words.DASH
    low, high = (-math.expm1(-YEARS * rate) for rate in (row.low, row.high))
    plain = replace(row, at_least=False)
    return _("{low} to {high}", low=say_share(low, plain), high=say_share(high, plain))


def _say_number(value: float) -> str:
    """Return a number with two significant digits, without an exponent."""
    rounded = float(f"{value:.2g}")
    if rounded == 0 or rounded >= 10:
        return number(rounded, ",.0f")
    return number(rounded, f".{1 - math.floor(math.log10(rounded))}f")
