"""How the chances were computed, in a page that a client can read: what the annex gives in full."""

from typing import TYPE_CHECKING

from assess.i18n import gettext as _
from assess.report import words
from assess.report.findings.route_words import say_risk
from assess.report.findings.uncertain import say_assumed, say_sensitivity
from assess.report.findings.verified import WILSON
from assess.report.provenance import say_reference

if TYPE_CHECKING:
    from assess.report.content import Content
    from assess.results import Results

Lines = list[tuple[str, list[str]]]


def list_approach(content: "Content") -> Lines:
    """Return paragraphs by heading: motion of the floors, chances and classes, what was assumed uncertain, routes."""
    run, verified = content.run, content.verified
    sources = "; ".join(content.sources)
    classes = "; ".join(f"{words.risk_label(risk)} {limits}" for risk, limits in content.class_limits)
    limits = _("Classes by the chance of overturning: {classes}.", classes=classes)
    lines: Lines = [
        (_("Motion of the floors"), [_("Where the motion comes from: {sources}.", sources=sources) if sources else ""]),
        (_("Chance and class"), [verified.adopted, verified.sentence, limits]),
    ]
    if verified.done:
        interval = _(
            "A range is the 95 % sampling interval of Wilson (1927). It covers the number of draws only, not what is "
            "unknown about the earthquake or the furniture. On assumed motion it is the chance in the slower and in "
            "the faster third of the drawn motions: what is not known of the ground and of the building."
        )
        assumed = [say_assumed(run), say_sensitivity(run, content.results), interval]
        lines.append((_("What was assumed uncertain"), [text for text in assumed if text]))
    if run.has_routes:
        lines.append((_("Evacuation routes"), [_say_routes(run)]))
    return lines


def list_sources(content: "Content") -> list[str]:
    """Return the publications of the methods that classes rest on, in full."""
    keys = {content.run.formula.key, *({content.run.simulation.key} if content.verified.done else ())}
    found = [say_reference(one.reference) for one in content.methods if one.key in keys]
    return list(dict.fromkeys([*found, *([WILSON] if content.verified.done else [])]))


def _say_routes(run: "Results") -> str:
    return _(
        "A route is evaluated by the chance that fallen pieces leave less than the required clear width on one of its "
        "segments; pieces that fall in the same draw count together. The limit on that chance is {risk}. No published "
        "rule exists; the rule used here is described in the annex.",
        risk=say_risk(run.route_tables.risk),
    )  # fmt: skip
