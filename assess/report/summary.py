"""The summary: one page that a manager can act on."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.counts import Counts
from assess.report.findings.at_risk import RouteAtRisk, list_routes_at_risk, say_routes
from assess.report.ranking import Fix, list_fixes
from assess.results import ItemResult, Results
from assess.risk import RiskClass

WORST, FIXES, FLOORS, ROUTES, CAUTIONS = 6, 4, 6, 4, 3
"""Pieces, fixes, floors, routes and cautions that the page has room for."""
LEAST = 12
"""Characters of a description that are kept next to "partly anchored"."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A paragraph in plain words, the worst pieces, what to fix first, and the routes at risk.

    `of_routes` are sentences on the routes, none where the workbook names none.
    """

    plainly: Sequence[str]
    worst: Sequence[ItemResult]
    fixes: Sequence[Fix]
    routes: Sequence[RouteAtRisk]
    of_routes: Sequence[str]


def build_summary(results: Results, rows: Sequence[ItemResult], total: Counts) -> Summary:
    """Gather the summary."""
    worst, fixes = list_worst(rows), list_fixes(results, rows, total.expected)
    could_be = sum(one.item.quantity for one in list_risky(rows) if one.adopted.risk < RiskClass.HIGH)
    plainly = say_plainly(total, could_be, worst, fixes)
    return Summary(plainly, worst, fixes, list_routes_at_risk(results), say_routes(results))


def list_worst(results: Sequence[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces that are most likely to fall."""
    return sorted((one for one in results if not one.is_anchored), key=_worst_first)[:WORST]


def list_risky(results: Sequence[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces that reach high by the upper estimate, the worst first."""
    risky = [one for one in results if not one.is_anchored and one.adopted.upper >= RiskClass.HIGH]
    return sorted(risky, key=_worst_first)


def _worst_first(one: ItemResult) -> tuple[float, float, str]:
    return -one.adopted.upper, -one.adopted.probability, one.item.item


def say_plainly(total: Counts, could_be: int, worst: Sequence[ItemResult], fixes: Sequence[Fix]) -> list[str]:
    """Return the first paragraph of the summary; `could_be` pieces reach high by the upper estimate only."""
    texts = [_say_counts(total)]
    if could_be and total.risky:
        texts.append(ngettext("{n:,} more could be either.", "{n:,} more could be either.", could_be))
    elif could_be:
        texts.append(ngettext("{n:,} could be high or very high.", "{n:,} could be high or very high.", could_be))
    if total.anchored:
        texts.append(ngettext("{n:,} further piece is anchored and not classified: it depends on its anchors.",
                              "{n:,} further pieces are anchored and not classified: they depend on their anchors.",
                              total.anchored))  # fmt: skip
    if worst and worst[0].adopted.risk > RiskClass.LOW:
        one = worst[0]
        texts.append(_("The worst is {item} ({what}, floor {floor}) with a chance of {chance}.",
                       item=words.cut(one.item.item, 40), what=describe(one, 60),
                       floor=words.cut(one.item.floor, 20), chance=words.chance(one)))  # fmt: skip
    if total.expected >= 0.05 and fixes:
        first = fixes[:FIXES]
        texts.append(ngettext(
            "About {expected:.1f} pieces are expected to fall; fixing the first row of the list below avoids "
            "{share:.0f} % of these falls.",
            "About {expected:.1f} pieces are expected to fall; fixing the first {n} rows of the list below avoids "
            "{share:.0f} % of these falls.",
            len(first), expected=total.expected, share=100 * first[-1].together,
        ))  # fmt: skip
    return texts


def _say_counts(total: Counts) -> str:
    if not total.free:
        return _("There are no free-standing pieces.")
    if not total.risky:
        return ngettext(
            "The {n:,} free-standing piece has no high or very high chance of overturning in this scenario.",
            "None of {n:,} free-standing pieces has a high or very high chance of overturning in this scenario.",
            total.free,
        )
    if total.free == 1:
        return (
            _("The one free-standing piece has a very high chance of overturning in this scenario.")
            if total.by_class[RiskClass.VERY_HIGH]
            else _("The one free-standing piece has a high chance of overturning in this scenario.")
        )
    return _(
        "Of {free:,} free-standing pieces, the chance of overturning in this scenario is very high for {very_high:,} "
        "and high for {high:,}.",
        free=total.free, very_high=total.by_class[RiskClass.VERY_HIGH], high=total.by_class[RiskClass.HIGH],
    )  # fmt: skip


def describe(one: ItemResult, longest: int = 80) -> str:
    """Return the piece in the workbook's words, and that it is partly anchored, which its class leaves out."""
    text = one.item.description or one.item.type or _("no description")
    if one.item.anchored != "partly":
        return words.cut(text, longest)
    note = _("partly anchored")
    return f"{words.cut(text, max(LEAST, longest - len(note) - 2))}, {note}"
