"""A report as a document: the band that names it, below which the answer follows at once, and its sections.

A firm that wants a cover page has it in its own cover.html.j2.
"""

from collections.abc import Sequence
from dataclasses import replace

from assess.i18n import gettext as _, ngettext
from assess.report import words
from assess.report.blocks import Block, Contents, Document, Image, Paragraph, Section, Span, Title, Words
from assess.report.embedded import embed_logo
from assess.report.say.simulation import list_conditions
from assess.report.view import View

MOST_PRINTED, MOST = 12, 40
"""Floors that the contents name, in print and on a screen."""
OPEN = ("summary", "certainty", "schedule", "routes", "floors")
"""Sections that a screen shows at once; the others are folded."""
BAND = (
    ("client", "prepared_by", "organisation", "licence", "project_number"), ("address", "use", "storeys", "revision"),
)  # fmt: skip
"""Fields of the sheet Building in the band at the head of the report, line by line."""


def build_document(view: View) -> Document:
    """Return the report in the language in use; raises CancelledError, also while figures are drawn."""
    content, building, sections = view.content, view.run.building, list[Section]()
    for part in view.progress.checked(view.parts):
        built = part.build(view)
        first, *others = [built] if isinstance(built, Section) else built
        kind = first.kind if view.for_print or part.key in OPEN else f"{first.kind} fold".strip()
        if kind != first.kind:  # what follows without a heading of its own goes into the same fold
            first, others = replace(first, blocks=[block for one in (first, *others) for block in one.blocks]), []
        sections += [replace(first, id=part.key, heading=_(part.heading), kind=kind), *others]
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
    conditions = " · ".join(list_conditions(view.run))
    if view.edition == "annex":
        title = _("{building}: annex", building=words.cut(content.title, 110))
        short = _("{building}, annex", building=words.cut(content.title, 50))
        text = _("Every piece, the comparison of the methods, the simulation and its motions, the equations, the log "
                 "of the input and the references. The summary, what to fix and the plans are in the report of the "
                 "same date: {date}.", date=content.date)  # fmt: skip
        kind = Paragraph(_("Overturning of furniture in an earthquake: annex to the assessment"), "kind")
        return [kind, Title(title, short, _say_foot(view), conditions), Paragraph(text), build_contents(view)]
    if view.edition == "work":
        short = _("{building}, work orders", building=words.cut(content.title, 50))
        kind = Paragraph(_("Fixing furniture against earthquakes: work orders of {date}", date=content.date), "kind")
        return [kind, Title(words.cut(content.title, 110), short, _say_foot(view), conditions)]
    blocks: list[Block] = []
    if logo := embed_logo(view.run):
        named = (_("Logo of {organisation}", organisation=building.organisation) if building.organisation
                 else _("Logo of the organisation"))  # fmt: skip
        blocks.append(Paragraph(Image(logo, named, "logo"), "mark"))
    blocks.append(Paragraph(_("Overturning of furniture in an earthquake: assessment"), "kind"))
    blocks.append(Title(words.cut(content.title, 120), words.cut(content.title, 60), _say_foot(view), conditions))
    if building.scenario:
        blocks.append(Paragraph(_("Scenario: {scenario}", scenario=words.clip(building.scenario, 300)), "scenario"))
    lines: list[Words] = [_say_named(view, one) for one in BAND]
    return [*blocks, *(Paragraph(line, "band") for line in lines if line)]


def _say_named(view: View, names: Sequence[str]) -> str:
    """Return lines of the sheet Building as one, with the date of the report where its revision stands."""
    found = [f"{label}: {words.cut(text, 90)}" for label, text in view.list_facts(names) if text]
    if "revision" in names:
        found.append(_("Date: {date}", date=view.content.date))
    return " · ".join(found)


def _say_foot(view: View) -> str:
    """Return what stands at the foot of every page: revision, date and status."""
    revision = words.cut(view.run.building.revision, 30)
    parts = [_("Revision {revision}", revision=revision) if revision else "", view.content.date,
             view.content.verified.status[0]]  # fmt: skip
    return " · ".join(filter(None, parts))


def build_contents(view: View) -> Contents:
    """Return the contents; of floors without room for their names, how many pages they have."""
    floors = [page for page in view.content.shown_floors if view.plans.get(page.floor.floor)]
    most = MOST_PRINTED if view.for_print else MOST
    named = floors[:most] if not view.for_print or len(floors) <= most else ()
    pages: list[Words] = [Span(page.title, href=f"#floor-{at}") for at, page in enumerate(named, start=1)]
    if left := len(floors) - len(named):
        pages.append(ngettext("{n:,} more floor has a page of its own.", "{n:,} more floors have pages of their own.",
                              left))  # fmt: skip
    lines = [(Span(_(part.heading), href=f"#{part.key}"), pages if part.key == "floors" else ()) for part in view.parts]
    annex = view.list_parts("annex") if view.edition == "client" else ()
    parts = "; ".join(_(part.heading) for part in annex)
    return Contents(_("Contents"), lines, _("Annex, on request: {parts}.", parts=parts) if annex else "")
