"""The summary: one page that a manager can act on."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.counts import Counts
from assess.report.row_order import by_chance
from assess.report.say.ground import say_ground
from assess.report.say.piece import say_apart
from assess.report.say.route import RouteAtRisk, list_routes_at_risk, say_routes
from assess.report.say.work import Entry, list_entries, say_doubtful_brackets
from assess.results import ItemResult, Results
from assess.risk import RiskClass

WORST, FIXES, FLOORS, ROUTES, CAUTIONS = 6, 4, 6, 4, 3
"""Pieces, fixes, floors, routes and cautions that the page has room for."""
FLOORS_BESIDE = 3
"""Floors that it has room for next to sentences on unconfirmed pieces."""
LEAST = 12
"""Characters of a description that are kept next to "partly anchored"."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A paragraph in plain words, the worst pieces, what to fix first, and the routes at risk.

    `apart` are sentences on the pieces that are counted apart, with what settles them; `shaking` is a sentence
    on a ShakeMap, scenarios or an assumed shaking, if any; `of_routes` are sentences on the routes, none where the
    workbook names none.
    """

    plainly: Sequence[str]
    apart: Sequence[str]
    shaking: Sequence[str]
    worst: Sequence[ItemResult]
    fixes: Sequence[Entry]
    routes: Sequence[RouteAtRisk]
    of_routes: Sequence[str]


def build_summary(results: Results, rows: Sequence[ItemResult], total: Counts) -> Summary:
    """Gather the summary."""
    worst, fixes = list_worst(rows), list_entries(results, rows)
    return Summary(
        plainly=say_plainly(total, worst, fixes, rows),
        apart=say_apart(rows),
        shaking=[text for text in (say_ground(results, shortly=True),) if text],
        worst=worst,
        fixes=fixes,
        routes=list_routes_at_risk(results),
        of_routes=say_routes(results),
    )


def list_worst(results: Sequence[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces that are most likely to fall, of the run's basis."""
    return sorted((one for one in results if not (one.is_anchored or one.apart)), key=by_chance)[:WORST]


def list_risky(results: Sequence[ItemResult], basis: str = "") -> list[ItemResult]:
    """Return the free-standing pieces that reach high by the upper estimate, the worst first.

    Those of the run's basis, or with `basis` those that stand apart with it.
    """
    found = [one for one in results if not one.is_anchored and one.apart == basis]
    return sorted((one for one in found if one.adopted.upper >= RiskClass.HIGH), key=by_chance)


def say_plainly(
    total: Counts, worst: Sequence[ItemResult], fixes: Sequence[Entry], rows: Sequence[ItemResult] = ()
) -> list[str]:
    """Return the first paragraph of the summary.

    `rows` are all pieces, of which the anchored ones are named whose brackets may fail.
    """
    texts = [_say_counts(total)]
    if total.anchored:
        texts.append(ngettext("{n:,} further piece is anchored and not classified: it depends on its anchors.",
                              "{n:,} further pieces are anchored and not classified: they depend on their anchors.",
                              total.anchored))  # fmt: skip
    texts += say_doubtful_brackets(rows)
    if worst and worst[0].adopted.risk > RiskClass.LOW:
        one = worst[0]
        texts.append(_("The worst is {item} ({what}, floor {floor}) with a chance of {chance}.",
                       item=words.cut(one.item.item, 40), what=describe(one, 60),
                       floor=words.cut(one.item.floor, 20), chance=words.chance(one)))  # fmt: skip
    return [*texts, *_say_falls(total, fixes)]


def _say_falls(total: Counts, fixes: Sequence[Entry]) -> list[str]:
    """Say how many pieces are expected to fall, how many may besides, and what the first fixes avoid."""
    texts = []
    if total.expected >= 0.05 or total.unconfirmed:
        expected = _("About {expected:.1f} pieces are expected to fall", expected=total.expected)
        if n := total.unconfirmed:
            expected += ", " + ngettext("and up to {n:,} unconfirmed piece", "and up to {n:,} unconfirmed pieces", n)
        if total.falls_low is not None and total.falls_high is not None:
            range_ = words.say_span((round(total.falls_low), round(total.falls_high)))
            expected += "; " + _("{range} in 90 % of such earthquakes", range=range_)
        texts.append(f"{expected}.")
    first = [one for one in fixes[:FIXES] if one.together is not None]
    if total.expected >= 0.05 and first:
        texts.append(ngettext(
            "Fixing the first entry of the list below avoids {share:.0f} % of the expected falls.",
            "Fixing the first {n} entries of the list below avoids {share:.0f} % of the expected falls.",
            len(first), share=100 * (first[-1].together or 0.0),
        ))  # fmt: skip
    return texts


def _say_counts(total: Counts) -> str:
    if not total.free:
        if total.unconfirmed or total.by_formula:
            return _("No free-standing piece has a class by simulation.")
        return _("There are no free-standing pieces.")
    if total.unconfirmed or total.by_formula:
        return _say_simulated(total)
    if not total.risky_span[1]:
        return ngettext(
            "The {n:,} free-standing piece has no high or very high chance of overturning in this scenario.",
            "None of {n:,} free-standing pieces has a high or very high chance of overturning in this scenario.",
            total.free,
        )
    if total.free == 1 and total.risky_span[0]:
        return (
            _("The one free-standing piece has a very high chance of overturning in this scenario.")
            if total.by_class[RiskClass.VERY_HIGH]
            else _("The one free-standing piece has a high chance of overturning in this scenario.")
        )
    return ngettext(
        "The {n:,} free-standing piece may have a high or very high chance of overturning: the limit lies within the "
        "interval of its chance.",
        "Of {n:,} free-standing pieces, {risky} have a high or very high chance of overturning, {very_high} a very "
        "high one.",
        total.free, risky=words.say_span(total.risky_span), very_high=words.say_span(total.span(RiskClass.VERY_HIGH)),
    )  # fmt: skip


def _say_simulated(total: Counts) -> str:
    if not total.risky_span[1]:
        return ngettext(
            "The {n:,} simulated free-standing piece has no high or very high chance of overturning in this scenario.",
            "None of {n:,} simulated free-standing pieces has a high or very high chance of overturning in this "
            "scenario.",
            total.free,
        )
    if total.free == 1 and total.risky_span[0]:
        return _("The one simulated free-standing piece has a high or very high chance of overturning.")
    return ngettext(
        "The {n:,} simulated free-standing piece may have a high or very high chance of overturning: the limit lies "
        "within the interval of its chance.",
        "Of {n:,} simulated free-standing pieces, {risky} have a high or very high chance of overturning, {very_high} "
        "a very high one.",
        total.free, risky=words.say_span(total.risky_span), very_high=words.say_span(total.span(RiskClass.VERY_HIGH)),
    )  # fmt: skip


def describe(one: ItemResult, longest: int = 80) -> str:
    """Return the piece in the workbook's words, and that it is partly anchored or its bracket fails."""
    text = one.item.description or one.item.type or _("no description")
    is_failing = one.item.anchored == "yes" and not one.is_anchored
    if one.item.anchored != "partly" and not is_failing:
        return words.cut(text, longest)
    note = _("bracket fails") if is_failing else _("partly anchored")
    return f"{words.cut(text, max(LEAST, longest - len(note) - 2))}, {note}"
