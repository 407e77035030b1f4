"""The section Verification: what was simulated under which motions, and how well these meet their targets."""

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.report import words
from assess.report.findings.earthquake_draws import list_draw_assumptions, say_draws
from assess.report.findings.motions import describe_suite, say_signs
from assess.report.findings.uncertain import count_scanned, say_source
from assess.report.findings.verified import Verified, name_some
from assess.report.row_order import by_chance
from assess.results import EnsembleRow, ItemResult, MotionRow, Results, SuiteInfo
from assess.settings import AUTO

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


def list_assumptions(results: Results, verified: Verified) -> list[tuple[str, str]]:
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
