"""A report as a document: its cover, which on a screen is short as the answer follows at once, and its sections."""

from dataclasses import replace

from assess.i18n import gettext as _, ngettext
from assess.report import words
from assess.report.blocks import Block, Contents, Document, Image, Paragraph, Runs, Section, Span, Title, Words, strong
from assess.report.embedded import embed_logo
from assess.report.say.ground import say_ground_source
from assess.report.say.simulation import list_conditions
from assess.report.sections.methods import list_facts, list_signing
from assess.report.view import View

MOST_PRINTED, MOST = 12, 40
"""Floors that the contents name, in print and on a screen."""


def build_document(view: View) -> Document:
    """Return the report in the language in use; raises CancelledError, also while figures are drawn."""
    content, building, sections = view.content, view.run.building, list[Section]()
    for part in view.progress.checked(view.parts):
        built = part.build(view)
        first, *others = [built] if isinstance(built, Section) else built
        sections += [replace(first, id=part.key, heading=_(part.heading)), *others]
    named = words.cut(content.title, 80)
    title = (_("Furniture in earthquakes: {building}, annex", building=named) if view.edition == "annex"
             else _("Furniture in earthquakes: {building}, work orders", building=named) if view.edition == "work"
             else _("Furniture in earthquakes: {building}", building=named))  # fmt: skip
    return Document(
        title=title, cover=_build_cover(view), sections=sections,
        author=", ".join(filter(None, (building.prepared_by, building.organisation))),
        description=_("Overturning of furniture in an earthquake: assessment"),
        keywords=_("earthquake, furniture, overturning, rocking, floor acceleration"),
        conditions=" · ".join(list_conditions(view.run)), kind=view.edition,
        contents=None if view.for_print else build_contents(view),
    )  # fmt: skip


def _build_cover(view: View) -> list[Block]:
    content, building = view.content, view.run.building
    footer, conditions = content.verified.footer, " · ".join(list_conditions(view.run))
    if view.edition == "annex":
        title = _("{building}: annex", building=words.cut(content.title, 110))
        short = _("{building}, annex", building=words.cut(content.title, 50))
        text = _("Every piece, the comparison of the methods, the simulation and its motions, the equations, the log "
                 "of the input and the references. The summary, what to fix and the plans are in the report of the "
                 "same date: {date}.", date=content.date)  # fmt: skip
        kind = Paragraph(_("Overturning of furniture in an earthquake: annex to the assessment"), "kind")
        return [kind, Title(title, short, footer, conditions), Paragraph(text), build_contents(view)]
    if view.edition == "work":
        short = _("{building}, work orders", building=words.cut(content.title, 50))
        kind = Paragraph(_("Fixing furniture against earthquakes: work orders of {date}", date=content.date), "kind")
        return [kind, Title(words.cut(content.title, 110), short, footer, conditions)]
    blocks: list[Block] = []
    if logo := embed_logo(view.run):
        named = (_("Logo of {organisation}", organisation=building.organisation) if building.organisation
                 else _("Logo of the organisation"))  # fmt: skip
        blocks.append(Paragraph(Image(logo, named, "logo"), "mark"))
    blocks.append(Paragraph(_("Overturning of furniture in an earthquake: assessment"), "kind"))
    blocks.append(Title(words.cut(content.title, 120), words.cut(content.title, 60), footer, conditions))
    if building.scenario:
        blocks.append(Paragraph(_("Scenario: {scenario}", scenario=words.clip(building.scenario, 300)), "scenario"))
    if shaking := say_ground_source(view.run):
        blocks.append(Paragraph(shaking, "shaking caution"))
    if building.revision:
        revision = words.cut(building.revision, 40)
        blocks.append(Paragraph(_("Revision {revision} of {date}", revision=revision, date=content.date), "revision"))
    if view.for_print:
        return [*blocks, list_facts(view), build_contents(view), *list_signing(view)]
    status, why = content.verified.status
    links: Runs = [Span(_("Contents"), href="#contents"), " · ", Span(_("About this report"), href="#about")]
    return [*blocks, Paragraph([*links, f" · {content.date} · ", strong(status), f": {why}"], "small")]


def build_contents(view: View) -> Contents:
    """Return the contents; of floors without room for their names, how many pages they have."""
    floors, most = view.content.shown_floors, MOST_PRINTED if view.for_print else MOST
    named = floors[:most] if not view.for_print or len(floors) <= most else ()
    pages: list[Words] = [Span(page.title, href=f"#floor-{at}") for at, page in enumerate(named, start=1)]
    if left := len(floors) - len(named):
        pages.append(ngettext("{n:,} more floor has a page of its own.", "{n:,} more floors have pages of their own.",
                              left))  # fmt: skip
    lines = [(Span(_(part.heading), href=f"#{part.key}"), pages if part.key == "floors" else ()) for part in view.parts]
    annex = view.list_parts("annex") if view.edition == "client" else ()
    parts = "; ".join(_(part.heading) for part in annex)
    return Contents(_("Contents"), lines, _("Annex, on request: {parts}.", parts=parts) if annex else "")
