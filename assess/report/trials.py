"""The section Verification: what was integrated under which motions, and how these meet what was wanted."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from assess.demand import Demand
from assess.methods._method import Joint
from assess.methods.housner_monte_carlo import LOOKS, LOOKS_Z, interval_width
from assess.report import words
from assess.report.motions import describe_suite
from assess.report.verified import Verified, name_some
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
    text = (
        f"The rocking of {len(verified.done):,} of {words.plural(verified.rows, 'row')} was integrated step by step "
        "(Housner's equations of a rigid block, see Methods). The chance is the share of motions under which the piece "
        "overturns."
    )
    stocky = sum(one.does_not_rock for one in verified.left)
    return text + (
        f" {words.plural(stocky, 'row is', 'rows are')} too stocky to rock (B/H of 1.41 or more)." * bool(stocky)
    )


def _selection(assessment: Assessment) -> str:
    if assessment.settings.verify == "all":
        return "All rows were chosen."
    return (
        "Chosen were the rows that are of high or very high class by the proposed OR formula or by Kaneko-Hayashi "
        "under any of their motions, those outside the formula's checked range, and those on a route."
    )


def _describe_motions(assessment: Assessment) -> str:
    if assessment.suite is not None:
        return (
            f"The motions are the user's own: {describe_suite(assessment)}. Motion k is one earthquake, the same on "
            "every floor and axis."
        )
    count = "as many motions as are needed" if assessment.settings.runs == AUTO else _count(assessment)
    return (
        f"On each floor and axis {count} were generated (seed {assessment.settings.seed}). Their mean 5 % response "
        "spectrum meets that of the floor's recorded motion, or a generic one where only peaks are known; their peaks "
        "scatter about the floor's, as those of earthquakes do. Motion k has the same random phases on every floor "
        "along an axis: it is one earthquake of the whole building."
    )


def _count(assessment: Assessment) -> str:
    return words.plural(int(assessment.settings.runs), "motion")


def _restitution(assessment: Assessment) -> str:
    own = assessment.inventory.building.restitution
    if own is None:
        return "At each impact a piece keeps 1 - 1.5 sin²α of its angular velocity, as Housner has it."
    return f"At each impact a piece keeps {own:g} of its angular velocity, as the workbook sets."


def _interval(assessment: Assessment) -> str:
    return (
        f"The interval is Wilson's with z = {interval_width(assessment.settings):.2f}; it covers the number of records "
        "only: not the model of the block, not the motion of the floor, not the earthquake."
    )


def _stopping(verified: Verified) -> str:
    """Say by which rule motions were added, and which pieces remain open."""
    looks = ", ".join(f"{look:,}" for look in LOOKS[:-1])
    text = (
        f"Motions were added until each piece's interval lay within one class. That was looked at after {looks} and "
        f"{LOOKS[-1]:,} motions, with an interval (z = {LOOKS_Z:g}) that holds with 95 % for all six looks together."
    )
    if not verified.undecided:
        return f"{text} No piece is left undecided."
    return f"{text} Undecided after {LOOKS[-1]:,}: {name_some(verified.undecided)}."


def _floor_motions(assessment: Assessment, demand: Demand, joint: Joint) -> FloorMotions:
    least, most = int(joint.runs.min()), int(joint.runs.max())
    fit = joint.fit
    pfa, pfv = (
        ("–", "–") if fit is None else (_ratio(fit.pfa_ratio, fit.pfa_scatter), _ratio(fit.pfv_ratio, fit.pfv_scatter))
    )
    if assessment.suite is not None:
        pfa, pfv = _suite_ratios(assessment, demand)
    return FloorMotions(
        floor=words.clip(demand.floor.floor, 20),
        axis=demand.axis,
        source=words.clip(demand.label.rsplit("/", 1)[-1], 60),
        kind=_kind(assessment, joint),
        motions=f"{most:,}" if least == most else f"{least:,} to {most:,}",
        rows=len(joint.cases),
        spectrum=words.DASH
        if fit is None
        else f"{words.percent(fit.mean_deviation)}; {100 * fit.worst_deviation:+.1f} % at {fit.worst_period:.2f} s",
        pfa=pfa,
        pfv=pfv,
    )


def _kind(assessment: Assessment, joint: Joint) -> str:
    if assessment.suite is not None:
        return "own, scaled to PFA" if assessment.settings.scale_motions else "own, not scaled"
    return "generic spectrum" if assessment.cases.ensembles[joint.ensemble].is_generic else "recorded spectrum"


def _ratio(ratio: float, scatter: float) -> str:
    """Return a ratio of peaks with its scatter, which is a coefficient of variation."""
    return words.DASH if ratio != ratio else f"{ratio:.2f} ± {ratio * scatter:.2f}"


def _suite_ratios(assessment: Assessment, demand: Demand) -> tuple[str, str]:
    """Return PFA and PFV of the user's own motions, as used, over those of the floor."""
    if assessment.suite is None:
        return words.DASH, words.DASH
    motions = [motion for _, motion in assessment.suite.motions]
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
            yield (
                f"Floor {words.clip(demand.floor.floor, 20)} {demand.axis}: PFA and the spectrum cannot both be met. "
                f"PFA wins; the mean spectrum is met within {words.percent(fit.mean_deviation)} on average, and within "
                f"{words.percent(abs(fit.worst_deviation))} at {fit.worst_period:.2f} s, where it is worst."
            )


def list_assumptions(assessment: Assessment, verified: Verified) -> list[tuple[str, str]]:
    """Return what was assumed of the verification; nothing where none has run."""
    if not verified.done:
        return []
    own, z = assessment.inventory.building.restitution, interval_width(assessment.settings)
    restitution = (
        "Housner's, 1 - 1.5 sin²α, as the workbook leaves it blank" if own is None else f"{own:g}, the workbook's"
    )
    seed = "" if assessment.suite is not None else f", generated with seed {assessment.settings.seed}"
    auto = assessment.settings.runs == AUTO
    return [
        ("Restitution (angular velocity after an impact over that before)", restitution),
        ("Motions of the verification", f"{verified.motions}{seed}"),
        ("Interval of a verified chance",
         f"Wilson's, z = {z:.2f}: 95 %" + (" for all six looks together" if auto else "")),
    ]  # fmt: skip
