"""Facts of the building and of the report, and who answers for it: on a screen at the end, in print on the cover."""

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Cell, Column, Paragraph, Section, Words, head, list_columns, strong, table
from assess.report.view import Part, View

ON_COVER = frozenset((
    "address", "client", "use", "organisation", "storeys", "height", "scenario_kind", "ground_pga", "sds", "hazard",
))  # fmt: skip
"""What the workbook says of the building that a cover has room for."""
ELSEWHERE = frozenset((
    "building", "scenario", "prepared_by", "checked_by", "approved_by", "report_date", "language", "revision",
    "azimuth_deg",
))  # fmt: skip
"""What stands elsewhere in the report."""


def build(view: View) -> Section:
    """Return the facts and who answers for the report."""
    return Section([*list_facts(view), *list_signing(view)])


def list_facts(view: View) -> list[Block]:
    """Return what the workbook says of the building, and the state of the report."""
    content, is_client = view.content, view.edition == "client"
    left_out = set(ELSEWHERE)
    if view.run.provenance.scenario == "as filled" and view.run.building.scenario_kind in ("", "as filled"):
        left_out.add("scenario_kind")
    lines = [
        (label, words.cut(value, 150) if is_client else value)
        for name, (label, value) in content.building.items()
        if (name in ON_COVER or not is_client) and name not in left_out
    ]
    pieces = _(
        "{pieces} in {rows} on {floors}", pieces=words.plural(content.total.total, "piece"),
        rows=words.plural(len(content.results), "row"), floors=words.plural(len(content.floors), "floor"),
    )  # fmt: skip
    status, why = content.verified.status
    rows: list[tuple[Cell, Words]] = [
        *((head(label), value) for label, value in lines),
        (head(_("Date")), content.date),
        (head(_("Pieces")), pieces),
        (head(_("Status")), [strong(status), f": {why}"]),
    ]
    return [table([Column(), Column()], rows, "facts")]


def list_signing(view: View) -> list[Block]:
    """Return who answers for the report; on paper with room to sign."""
    building = view.run.building
    heads = [(_("Role"), "w18"), (_("Name"), "")]
    heads += [(_("Signature"), "w36"), (_("Date"), "w18")] if view.for_print else []
    names = (
        (_("Prepared by"), building.prepared_by), (_("Checked by"), building.checked_by),
        (_("Approved by"), building.approved_by),
    )  # fmt: skip
    made = _(
        "Made with assess {version} from {workbook}; versions and hashes are in the data-quality log.",
        version=view.content.version, workbook=words.cut(view.run.provenance.workbook, 80),
    )  # fmt: skip
    room = ("", "") if view.for_print else ()
    return [
        table(list_columns(*heads), [(head(role), words.cut(name, 60), *room) for role, name in names], "signing"),
        Paragraph(made, "small"),
    ]


PART = Part(key="about", heading=fill("About this report"), places={"all": 200}, build=build)
