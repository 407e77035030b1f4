"""The section Verification: what was integrated under which motions, and how these meet what was wanted."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from assess.demand import Demand
from assess.language import gettext as _
from assess.language import ngettext, number
from assess.methods._method import Joint
from assess.methods.housner_monte_carlo import LOOKS, LOOKS_Z, interval_width
from assess.report import words
from assess.report.findings.motions import describe_suite
from assess.report.findings.verified import Verified, name_some
from assess.results import Assessment, ItemResult
from assess.settings import AUTO

LARGE_MISFIT = 0.10
"""Mean deviation of a spectrum from the one wanted above which a sentence says so [-]."""
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


def build_trials(assessment: Assessment, verified: Verified) -> Trials:
    """Gather the section; empty where nothing was verified."""
    order = [floor.floor for floor in assessment.inventory.floors]
    joints = sorted(assessment.joints.items(), key=lambda pair: (order.index(pair[0].floor.floor), pair[0].axis))
    return Trials(
        paragraphs=tuple(_describe(assessment, verified)) if verified.done else (),
        motions=tuple(_floor_motions(assessment, demand, joint) for demand, joint in joints),
        misfits=tuple(_misfits(assessment)),
        changed=(*sorted(verified.raised, key=_by_change), *sorted(verified.lowered, key=_by_change)),
        fell=sorted(verified.fell, key=lambda one: (-one.adopted.upper, -one.adopted.probability)),
    )


def _by_change(one: ItemResult) -> tuple[float, ...]:
    return -abs(one.adopted.risk - one.formula_class), -one.adopted.upper, -one.adopted.probability


def _describe(assessment: Assessment, verified: Verified) -> Iterator[str]:
    """Say what was done, in paragraphs."""
    yield f"{_extent(assessment, verified)} {_selection(assessment)}"
    yield _describe_motions(assessment)
    yield f"{_restitution(assessment)} {_interval(assessment)}"
    if assessment.settings.runs == AUTO:
        yield _stopping(verified)


def _extent(assessment: Assessment, verified: Verified) -> str:
    text = _(
        "The rocking of {done:,} of {rows} was integrated step by step (Housner's equations of a rigid block, see "
        "Methods). The chance is the share of motions under which the piece overturns.",
        done=len(verified.done),
        rows=words.plural(verified.rows, "row"),
    )
    stocky = sum(one.does_not_rock for one in verified.left)
    told = ngettext(
        "{n:,} row is too stocky to rock (B/H of {limit:.2f} or more).",
        "{n:,} rows are too stocky to rock (B/H of {limit:.2f} or more).",
        stocky,
        limit=1.41,
    )
    return f"{text} {told}" if stocky else text


def _selection(assessment: Assessment) -> str:
    if assessment.settings.verify == "all":
        return _("All rows were chosen.")
    return _(
        "Chosen were the rows that are of high or very high class by the proposed OR formula or by Kaneko-Hayashi "
        "under any of their motions, those outside the formula's checked range, and those on a route."
    )


def _describe_motions(assessment: Assessment) -> str:
    if assessment.suite is not None:
        return _(
            "The motions are the user's own: {motions}. Motion k is one earthquake, the same on every floor and axis.",
            motions=describe_suite(assessment),
        )
    is_auto = assessment.settings.runs == AUTO
    return _(
        "On each floor and axis {motions} were generated (seed {seed}). Their mean 5 % response spectrum meets that of "
        "the floor's recorded motion, or a generic one where only peaks are known; their peaks scatter about the "
        "floor's, as those of earthquakes do. Motion k has the same random phases on every floor along an axis: it is "
        "one earthquake of the whole building.",
        motions=_("as many motions as are needed") if is_auto else _count(assessment),
        seed=assessment.settings.seed,
    )


def _count(assessment: Assessment) -> str:
    return words.plural(int(assessment.settings.runs), "motion")


def _restitution(assessment: Assessment) -> str:
    own = assessment.inventory.building.restitution
    if own is None:
        return _("At each impact a piece keeps 1 - 1.5 sin²α of its angular velocity, as Housner has it.")
    return _("At each impact a piece keeps {share:g} of its angular velocity, as the workbook sets.", share=own)


def _interval(assessment: Assessment) -> str:
    return _(
        "The interval is Wilson's with z = {z:.2f}; it covers the number of records only: not the model of the block, "
        "not the motion of the floor, not the earthquake.",
        z=interval_width(assessment.settings),
    )


def _stopping(verified: Verified) -> str:
    """Say by which rule motions were added, and which pieces remain open."""
    text = _(
        "Motions were added until each piece's interval lay within one class. That was looked at after {looks} and "
        "{last:,} motions, with an interval (z = {z:g}) that holds with 95 % for all six looks together.",
        looks=", ".join(number(look, ",") for look in LOOKS[:-1]),
        last=LOOKS[-1],
        z=LOOKS_Z,
    )
    left = _("No piece is left undecided.")
    if verified.undecided:
        left = _("Undecided after {last:,}: {pieces}.", last=LOOKS[-1], pieces=name_some(verified.undecided))
    return f"{text} {left}"


def _floor_motions(assessment: Assessment, demand: Demand, joint: Joint) -> FloorMotions:
    least, most = int(joint.runs.min()), int(joint.runs.max())
    fit = joint.fit
    pfa, pfv = (
        ("–", "–") if fit is None else (_ratio(fit.pfa_ratio, fit.pfa_scatter), _ratio(fit.pfv_ratio, fit.pfv_scatter))
    )
    if assessment.suite is not None:
        pfa, pfv = _suite_ratios(assessment, demand)
    return FloorMotions(
        floor=words.cut(demand.floor.floor, 20),
        axis=demand.axis,
        source=words.cut(_(demand.label).rsplit("/", 1)[-1], 60),
        kind=_kind(assessment, joint),
        motions=number(most, ",") if least == most else _("{least:,} to {most:,}", least=least, most=most),
        rows=len(joint.cases),
        spectrum=words.DASH
        if fit is None
        else _(
            "{mean}; {most:+.1f} % at {period:.2f} s",
            mean=words.deviation(fit.mean_deviation),
            most=100 * fit.worst_deviation,
            period=fit.worst_period,
        ),
        pfa=pfa,
        pfv=pfv,
    )


def _kind(assessment: Assessment, joint: Joint) -> str:
    if assessment.suite is not None:
        return _("own, scaled to PFA") if assessment.settings.scale_motions else _("own, not scaled")
    is_generic = assessment.cases.ensembles[joint.ensemble].is_generic
    return _("generic spectrum") if is_generic else _("recorded spectrum")


def _ratio(ratio: float, scatter: float) -> str:
    """Return a ratio of peaks with its scatter, which is a coefficient of variation."""
    return words.DASH if ratio != ratio else f"{number(ratio, '.2f')} ± {number(ratio * scatter, '.2f')}"


def _suite_ratios(assessment: Assessment, demand: Demand) -> tuple[str, str]:
    """Return PFA and PFV of the user's own motions, as used, over those of the floor."""
    if assessment.suite is None:
        return words.DASH, words.DASH
    motions = [motion for __, motion in assessment.suite.motions]
    peaks = np.array([(motion.pfa, motion.pfv) for motion in motions])
    if assessment.settings.scale_motions:
        peaks *= demand.pfa / peaks[:, :1]
    ratios = peaks / (demand.pfa, demand.pfv)
    pfa, pfv = (_ratio(float(one.mean()), float(one.std() / one.mean())) for one in ratios.T)
    return pfa, pfv


def _misfits(assessment: Assessment) -> Iterator[str]:
    """Say where the motions miss the spectrum by much."""
    for demand, joint in assessment.joints.items():
        fit = joint.fit
        if fit is not None and fit.mean_deviation > LARGE_MISFIT:
            yield _(
                "Floor {floor} {axis}: PFA and the spectrum cannot both be met. PFA wins; the mean spectrum is met "
                "within {mean} on average, and within {most} at {period:.2f} s, where it is worst.",
                floor=words.cut(demand.floor.floor, 20),
                axis=demand.axis,
                mean=words.deviation(fit.mean_deviation),
                most=words.deviation(abs(fit.worst_deviation)),
                period=fit.worst_period,
            )


def list_assumptions(assessment: Assessment, verified: Verified) -> list[tuple[str, str]]:
    """Return what was assumed of the verification; nothing where none has run."""
    if not verified.done:
        return []
    own, z = assessment.inventory.building.restitution, interval_width(assessment.settings)
    restitution = _("Housner's, 1 - 1.5 sin²α, as the workbook leaves it blank")
    if own is not None:
        restitution = _("{ratio:g}, the workbook's", ratio=own)
    motions, seed = verified.motions, assessment.settings.seed
    if assessment.suite is None:
        motions = _("{motions}, generated with seed {seed}", motions=motions, seed=seed)
    is_auto = assessment.settings.runs == AUTO
    return [
        (_("Restitution (angular velocity after an impact over that before)"), restitution),
        (_("Motions of the verification"), motions),
        (_("Interval of a verified chance"),
         _("Wilson's, z = {z:.2f}: 95 % for all six looks together", z=z) if is_auto
         else _("Wilson's, z = {z:.2f}: 95 %", z=z)),
    ]  # fmt: skip
