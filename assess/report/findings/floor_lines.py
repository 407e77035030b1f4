"""The motion of a floor and its pieces, each in one line."""

from collections.abc import Sequence

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.model import AXES
from assess.report import words
from assess.report.counts import Counts
from assess.report.findings.motions import describe_source
from assess.results import FloorRow, MotionRow
from assess.risk import RiskClass

SOURCES = 3
"""Sources that a line names."""


def say_motions(floor: FloorRow, motions: Sequence[MotionRow]) -> str:
    """Return the motion of a floor: elevation, peaks along both axes, and where they come from."""
    peaks = [
        *(_say_peak(axis, [one for one in motions if one.axis == axis]) for axis in AXES),
        *(_say_speed(axis, [one for one in motions if one.axis == axis]) for axis in AXES),
    ]
    sources = list(dict.fromkeys(map(describe_source, motions)))
    parts = ["; ".join(text for text in peaks if text), words.name_first(sources, SOURCES, "; ")]
    text = ": ".join(part for part in parts if part)
    if floor.elevation_m is None:
        return f"{text}."
    return _("{elevation} m above ground. {motion}.", elevation=words.in_m(floor.elevation_m), motion=text)


def _say_peak(axis: str, motions: Sequence[MotionRow]) -> str:
    if not motions:
        return ""
    largest = max(one.pfa_g for one in motions)
    text = _("PFA {axis} {pfa} g", axis=axis, pfa=words.in_g(largest))
    if len({one.pfa_g for one in motions}) < 2:
        return text
    return _("{peak} (the largest of {n})", peak=text, n=len(motions))


def _say_speed(axis: str, motions: Sequence[MotionRow]) -> str:
    known = [one.pfv_cm_s for one in motions if one.pfv_cm_s is not None]
    return _("PFV {axis} {pfv} cm/s", axis=axis, pfv=words.in_cm_s(max(known))) if known else ""


def say_counts(counts: Counts) -> str:
    """Return the pieces of a floor by class, with what stands apart, and the expected falls."""
    parts = [f"{words.risk_label(risk)} {counts.say(risk)}" for risk in reversed(RiskClass)]
    apart = (
        (words.UNCONFIRMED, _("unconfirmed"), counts.unconfirmed),
        (words.BY_FORMULA, _("by formula only"), counts.by_formula),
        (words.ANCHORED, _("anchored"), counts.anchored),
    )
    parts += [f"{sign} {name} {pieces:,}" for sign, name, pieces in apart if pieces]
    pieces = ngettext("{n:,} piece", "{n:,} pieces", counts.total)
    return _("{pieces}: {classes}; expected falls {falls}.", pieces=pieces, classes=", ".join(parts),
             falls=counts.falls)  # fmt: skip
