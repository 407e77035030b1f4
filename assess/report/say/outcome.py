"""The outcome in one sentence: ``About 10 of 177 free-standing pieces fall; 3 of 20 ways out are likely blocked.``."""

from collections import Counter
from collections.abc import Mapping

from assess.i18n import Text, fill, gettext as _, nfill, ngettext
from assess.report import words
from assess.report.counts import Counts
from assess.route_results import RouteState, RouteTables

FEW = 0.05
"""Expected falls below which none is expected."""
_WAYS: Mapping[RouteState, tuple[Text, Text]] = {
    RouteState.BLOCKED: (
        nfill("{n:,} of {all:,} ways out is likely blocked", "{n:,} of {all:,} ways out are likely blocked", 0, all=0),
        fill("the only way out is likely blocked"),
    ),
    RouteState.DOUBTFUL: (
        nfill("{n:,} of {all:,} ways out is doubtful", "{n:,} of {all:,} ways out are doubtful", 0, all=0),
        fill("the only way out is doubtful"),
    ),
    RouteState.NOT_KNOWN: (
        nfill("{n:,} of {all:,} ways out is not known", "{n:,} of {all:,} ways out are not known", 0, all=0),
        fill("it is not known whether the only way out is open"),
    ),
}
"""What is said of ways out in a state that is not open, the worst first."""


def say_outcome(total: Counts, routes: RouteTables, earthquake: str = "") -> str:
    """Return the sentence, which may name the earthquake; "" where there is neither a piece nor a route."""
    said = "; ".join([*_say_falls(total), *_say_ways(routes)])
    if said and earthquake:
        said = _("In an earthquake like this one ({earthquake}), {outcome}", earthquake=earthquake, outcome=said)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _say_falls(total: Counts) -> list[str]:
    """Return how many free-standing pieces fall; those that are not confirmed are counted apart."""
    unconfirmed = ngettext("{n:,} unconfirmed piece could fall", "{n:,} unconfirmed pieces could fall",
                           total.unconfirmed)  # fmt: skip
    apart = [unconfirmed] if total.unconfirmed else []
    if not total.free:
        return apart
    if total.expected < FEW:
        none = ngettext("the {n:,} free-standing piece is not expected to fall",
                        "none of {n:,} free-standing pieces is expected to fall", total.free)  # fmt: skip
        return [none, *apart]
    falls = words.round_falls(total.expected)
    said = ngettext("about {falls} of {n:,} free-standing piece falls",
                    "about {falls} of {n:,} free-standing pieces fall", total.free, falls=falls)  # fmt: skip
    if total.falls_low is None or total.falls_high is None:
        return [said, *apart]
    return [f"{said} ({words.say_span((round(total.falls_low), round(total.falls_high)))})", *apart]


def _say_ways(routes: RouteTables) -> list[str]:
    """Return how many ways out are blocked, or doubtful where none is, or that all are open."""
    states, every = Counter(one.state for one in routes.routes), len(routes.routes)
    for state, (some, only) in _WAYS.items():
        if n := states[state]:
            return [_(only) if every == 1 else ngettext(some.template, some.many, n, all=every)]
    if not every:
        return []
    return [ngettext("the only way out is open", "all {n:,} ways out are open", every)]
