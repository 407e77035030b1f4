"""How the chances were computed, in a page that a client can read: what the annex gives in full."""

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Bullets, Heading, Paragraph, Section
from assess.report.provenance import say_reference
from assess.report.say.route import say_risk
from assess.report.say.simulation import WILSON, say_assumed, say_sensitivity
from assess.report.view import Part, View


def build(view: View) -> Section:
    """Return paragraphs on the motion of the floors, chances and classes, what was assumed uncertain, and routes."""
    content, run, verified = view.content, view.run, view.content.verified
    sources = "; ".join(content.sources)
    blocks: list[Block] = [Heading(_("Motion of the floors"))]
    blocks += [Paragraph(_("Where the motion comes from: {sources}.", sources=sources))] if sources else []
    blocks += [] if view.shows("motions") else [Paragraph(text, "caution") for text in content.cautions]
    classes = "; ".join(f"{words.risk_label(risk)} {limits}" for risk, limits in content.class_limits)
    limits = _("Classes by the chance of overturning: {classes}.", classes=classes)
    blocks += _paragraphs(_("Chance and class"), verified.adopted, verified.sentence, limits)
    if verified.done:
        interval = _(
            "A range is the 95 % sampling interval of Wilson (1927). It covers the number of draws only, not what is "
            "unknown about the earthquake or the furniture. On assumed motion it is the chance in the slower and in "
            "the faster third of the drawn motions: what is not known of the ground and of the building."
        )
        sensitivity = say_sensitivity(run, content.results)
        blocks += _paragraphs(_("What was assumed uncertain"), say_assumed(run), sensitivity, interval)
    if run.has_routes:
        evaluated = _(
            "A route is evaluated by the chance that fallen pieces leave less than the required clear width on one of "
            "its segments; pieces that fall in the same draw count together. The limit on that chance is {risk}. No "
            "published rule exists; the rule used here is described in the annex.",
            risk=say_risk(run.route_tables.risk),
        )
        blocks += _paragraphs(_("Evacuation routes"), evaluated)
    keys = {run.formula.key, *({run.simulation.key} if verified.done else ())}
    named = [say_reference(one.reference) for one in content.methods if one.key in keys]
    named += [WILSON] if verified.done else []
    blocks += [Heading(_("Sources")), Bullets(list(dict.fromkeys(named)), "references")] if named else []
    return Section(blocks)


def _paragraphs(heading: str, *texts: str) -> list[Block]:
    return [Heading(heading), *(Paragraph(text) for text in texts if text)]


PART = Part(
    key="approach", heading=fill("How the chances were computed"), places={"client": 60, "all": 80}, build=build
)
