"""The summary: one page that a manager can act on."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.language import gettext as _
from assess.language import ngettext
from assess.ranking import RouteStep, fix_first, list_steps
from assess.report import words
from assess.report.counts import Counts
from assess.report.findings.at_risk import RouteAtRisk, list_routes_at_risk, say_routes, say_step
from assess.results import Assessment, ItemResult
from assess.risk import RiskClass

WORST, FIXES, FLOORS, ROUTES, CAUTIONS = 6, 4, 6, 4, 3
"""Pieces, fixes, floors, routes and cautions that the page has room for."""
NAMED = 2
"""Routes that a reason names; of more it is said how many there are."""


@dataclass(frozen=True, slots=True)
class Fix:
    """One line of what to fix first: its place in the list, what it saves, and what all up to it save together.

    `saved` are the falls that are expected of this row and no longer happen if the anchor holds; `together` is the
    share of all expected falls that this line and those above it save. `steps` are those of a route that it is.
    """

    place: int
    result: ItemResult
    saved: float
    together: float
    steps: Sequence[RouteStep] = ()

    @property
    def reason(self) -> str:
        """Why it comes first, as far as more than its chance tells: for a route with what that gains."""
        item, told = self.result.item, {one.route for one in self.steps}
        others = [words.cut(route, 30) for route in self.result.routes if route not in told]
        beside = ngettext("route {routes}", "routes {routes}", len(others), routes=words.name_first(others, NAMED))
        parts = [_(item.importance), *map(say_step, self.steps), beside if others and not told else ""]
        return ", ".join(part for part in parts if part) or words.DASH


@dataclass(frozen=True, slots=True)
class Summary:
    """What the page says: a paragraph in plain words, the worst pieces, what to fix first, and routes at risk.

    `of_routes` are sentences on the routes, none where the workbook names none.
    """

    plainly: Sequence[str]
    worst: Sequence[ItemResult]
    fixes: Sequence[Fix]
    routes: Sequence[RouteAtRisk]
    of_routes: Sequence[str]


def build_summary(assessment: Assessment, results: Sequence[ItemResult], total: Counts) -> Summary:
    """Gather the summary."""
    worst, fixes = list_worst(results), list_fixes(assessment, results, total)
    may_be = sum(one.item.quantity for one in list_risky(results) if one.adopted.risk < RiskClass.HIGH)
    plainly = say_plainly(total, may_be, worst, fixes)
    return Summary(plainly, worst, fixes, list_routes_at_risk(assessment), say_routes(assessment))


def list_fixes(assessment: Assessment, results: Sequence[ItemResult], total: Counts) -> list[Fix]:
    """Return the pieces of at least medium class and those that a route needs fixed, what first at the top."""
    steps: dict[str, list[RouteStep]] = {}
    for step in list_steps(assessment.routes):
        steps.setdefault(assessment.inventory.items[step.item].item, []).append(step)
    needed = {step.item for own in steps.values() for step in own}
    fixes, sum_saved = [], 0.0
    for place, one in enumerate(fix_first(results, needed), 1):
        saved = one.adopted.probability * one.item.quantity
        sum_saved += saved
        together = sum_saved / total.expected if total.expected else 0.0
        fixes.append(Fix(place, one, saved, together, tuple(steps.get(one.item.item, ()))))
    return fixes


def list_worst(results: Sequence[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces that are most likely to fall."""
    return sorted((one for one in results if not one.is_anchored), key=_worst_first)[:WORST]


def list_risky(results: Sequence[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces of high or very high class, or that may be, the worst first."""
    risky = [one for one in results if not one.is_anchored and one.adopted.upper >= RiskClass.HIGH]
    return sorted(risky, key=_worst_first)


def _worst_first(one: ItemResult) -> tuple[float, float, str]:
    return -one.adopted.upper, -one.adopted.probability, one.item.item


def say_plainly(total: Counts, may_be: int, worst: Sequence[ItemResult], fixes: Sequence[Fix]) -> list[str]:
    """Say in plain words what was found: the first paragraph of the summary."""
    texts = [_say_counts(total)]
    if may_be and total.risky:
        texts.append(ngettext("{n:,} more may have either.", "{n:,} more may have either.", may_be))
    elif may_be:
        texts.append(ngettext("{n:,} may have either.", "{n:,} may have either.", may_be))
    if total.anchored:
        texts.append(ngettext("{n:,} further piece is anchored, and only as safe as its anchor.",
                              "{n:,} further pieces are anchored, and only as safe as their anchors.",
                              total.anchored))  # fmt: skip
    if worst and worst[0].adopted.risk > RiskClass.LOW:
        one = worst[0]
        texts.append(_("The worst is {item} ({what}, floor {floor}) with a chance of {chance}.",
                       item=words.cut(one.item.item, 40), what=describe(one, 60),
                       floor=words.cut(one.item.floor, 20), chance=words.chance(one)))  # fmt: skip
    if total.expected >= 0.05 and fixes:
        first = fixes[:FIXES]
        texts.append(ngettext(
            "About {expected:.1f} pieces are expected to fall; fixing the first row of the list below takes away "
            "{share:.0f} % of that.",
            "About {expected:.1f} pieces are expected to fall; fixing the first {n} rows of the list below takes away "
            "{share:.0f} % of that.",
            len(first), expected=total.expected, share=100 * first[-1].together,
        ))  # fmt: skip
    return texts


def _say_counts(total: Counts) -> str:
    if not total.free:
        return _("There are no free-standing pieces.")
    if not total.risky:
        return ngettext(
            "The {n:,} free-standing piece has no high or very high chance of overturning in this scenario.",
            "Of {n:,} free-standing pieces, none has a high or very high chance of overturning in this scenario.",
            total.free,
        )
    if total.free == 1:
        return (
            _("The one free-standing piece has a very high chance of overturning in this scenario.")
            if total.by_class[RiskClass.VERY_HIGH]
            else _("The one free-standing piece has a high chance of overturning in this scenario.")
        )
    return _say_risky(total.free, total.by_class[RiskClass.VERY_HIGH], total.by_class[RiskClass.HIGH])


def _say_risky(free: int, very_high: int, high: int) -> str:
    """Say how many of several pieces are of very high and of high class."""
    if not very_high:
        return ngettext(
            "Of {free:,} free-standing pieces, {n:,} has a high chance of overturning in this scenario, none a very "
            "high one.",
            "Of {free:,} free-standing pieces, {n:,} have a high chance of overturning in this scenario, none a very "
            "high one.",
            high, free=free,
        )  # fmt: skip
    if not high:
        return ngettext(
            "Of {free:,} free-standing pieces, {n:,} has a very high chance of overturning in this scenario, none a "
            "high one.",
            "Of {free:,} free-standing pieces, {n:,} have a very high chance of overturning in this scenario, none a "
            "high one.",
            very_high, free=free,
        )  # fmt: skip
    return ngettext(
        "Of {free:,} free-standing pieces, {n:,} has a very high chance of overturning in this scenario and {high:,} "
        "a high one.",
        "Of {free:,} free-standing pieces, {n:,} have a very high chance of overturning in this scenario and {high:,} "
        "a high one.",
        very_high, free=free, high=high,
    )  # fmt: skip


LEAST = 12
"""Characters of a description that are kept beside what must be said with it."""


def describe(one: ItemResult, longest: int = 80) -> str:
    """Return what a piece is, in the workbook's words, and that it is partly anchored, which its class leaves out."""
    text = one.item.description or one.item.type or _("no description")
    if one.item.anchored != "partly":
        return words.cut(text, longest)
    told = _("partly anchored")
    return f"{words.cut(text, max(LEAST, longest - len(told) - 2))}, {told}"
