"""The ground's peaks as the workbook has them, next to those that are used: one number, and where it comes from."""

from assess.i18n import gettext as _
from assess.report import words
from assess.report.findings.motions import describe_source
from assess.results import MotionRow, Results

PEAKS = ("ground_pga", "sds")
"""Fields of the building that serve floors without a record, chances a year, and the code's force on anchors."""


def say_ground(results: Results, name: str, given: str) -> str:
    """Return a peak of the ground in words: as given, or what is used in its place, and why.

    Parameters
    ----------
    results : Results
        Of the run.
    name : str
        Field of the building, one of `PEAKS`.
    given : str
        Its value in the workbook, with its unit.
    """
    reason = _find_reason(results, name)
    if not reason:
        return given
    used = _find_used(results) if name == "ground_pga" else None
    of_anchors = name == ("sds" if results.building.sds is not None else "ground_pga")
    if used is None:
        if of_anchors:
            return _("{given}, used for the code's force on anchors only: {reason}", given=given, reason=reason)
        return _("{given} in the workbook, not used: {reason}", given=given, reason=reason)
    names = {"used": words.in_g(used.pfa_g), "floor": words.cut(used.floor, 20), "source": describe_source(used)}
    if of_anchors:
        return _(
            "{used} g on floor {floor}, {source}; {given} of the workbook is used for the code's force on anchors "
            "only: {reason}", **names, given=given, reason=reason,
        )  # fmt: skip
    return _("{used} g on floor {floor}, {source}; {given} of the workbook is not used: {reason}", **names, given=given,
             reason=reason)  # fmt: skip


def _find_reason(results: Results, name: str) -> str:
    """Return why no floor's motion follows a peak, "" where one does."""
    building = results.building
    if name == "ground_pga" and building.hazard:
        return ""
    if all(one.source == "record" or one.between for one in results.motions):
        return _("every floor has a record")
    levels = {one.floor: one.elevation_m for one in results.floor_rows}
    at_grade = [one for one in results.motions if (level := levels.get(one.floor)) is not None and level <= 0]
    if any(one.source in ("record", "given") for one in at_grade):
        return _("the motion at grade is known")
    if name == "sds" and building.ground_pga is not None:
        return _("Ground PGA is given")
    return ""


def _find_used(results: Results) -> MotionRow | None:
    """Return the strongest motion on the ground; of the same ones, that of the axis which it is known along."""
    levels = {one.floor: one.elevation_m for one in results.floor_rows}
    ground = [one for one in results.motions if levels.get(one.floor) == 0]
    return max(ground, key=lambda one: (one.pfa_g, not one.is_borrowed), default=None)
