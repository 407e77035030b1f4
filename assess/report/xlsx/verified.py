"""What a row of the sheet Items holds of its verification."""

from assess.adoption import FORMULA, VERIFICATION
from assess.cases import CaseResult
from assess.inventory.live import say_class
from assess.language import gettext as _
from assess.results import ItemResult

LEAST = 0.01
"""Least share of the critical angle that is told [-]."""


def adopted_chance(one: ItemResult) -> float | None:
    """Return the adopted chance where it is that of the verification."""
    return one.adopted.probability if one.adopted.method == VERIFICATION else None


def count_runs(one: ItemResult) -> int | None:
    """Return under how many motions it was integrated."""
    return one.governing.verification.runs if one.governing.verification else None


def chance_behind(one: ItemResult) -> float | None:
    """Return the chance by which it is classed, whatever the limits: None where it was not verified.

    Its largest under any of its motions. Where the verification may not lower a class, a chance of the formula's counts
    that is larger, so that it does not do so by other limits either.
    """
    return max(map(_chance, one.cases)) if one.is_verified else None


def _chance(case: CaseResult) -> float:
    formula, verified = case.methods[FORMULA].value or 0.0, case.methods[VERIFICATION].value or 0.0
    return max(formula, verified) if case.adopted.is_doubtful else verified


def upper_end(one: ItemResult) -> float | None:
    """Return the highest upper end of its intervals, whether or not the chance is adopted."""
    return max((case.verification.high for case in one.cases if case.verification), default=None)


def under_record(one: ItemResult) -> str:
    """Say what it does under the recorded motion itself, the worst of several; nothing where no record is known."""
    known = [case for case in one.cases if case.verification and case.verification.record_overturned is not None]
    if not known:
        return ""
    worst = max(known, key=_severity)
    text = _movement(*_severity(worst))
    if worst.demand.axis == one.governing.demand.axis:
        return text
    return _("{what} (along {axis})", what=text, axis=worst.demand.axis)


def _movement(fell: bool, rotation: float) -> str:
    if fell:
        return _("overturns")
    if rotation <= 0:
        return _("stays still")
    if rotation < LEAST:
        return _("rotates to below {least} of critical", least=LEAST)
    return _("rotates to {share:.2f} of critical", share=rotation)


def _severity(case: CaseResult) -> tuple[bool, float]:
    found = case.verification
    return (bool(found and found.record_overturned), (found and found.record_rotation) or 0.0)


def class_verified(one: ItemResult) -> str:
    """Return its class by the verification, with what must be said beside it."""
    if not one.is_verified:
        return _("not verified")
    adopted, told = one.adopted, [say_class(one.adopted.risk)]
    if adopted.upper > adopted.risk:
        told.append(_("may be {risk}", risk=say_class(adopted.upper)))
    if adopted.lowered_from is not None:
        told.append(_("lowered by verification (formula: {risk})", risk=say_class(adopted.lowered_from)))
    return ", ".join(told)
