"""The sheets Motions and Routes."""

from collections import defaultdict
from typing import Any

from assess.inventory.live import say_class
from assess.language import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.data import edge
from assess.report.findings.motions import describe_origin, describe_source, describe_treatment
from assess.report.xlsx.pen import Pen, with_unit
from assess.report.xlsx.said import ANCHORED
from assess.results import ItemResult


def write_motions(pen: Pen, page: Any, content: Content) -> None:
    """Write every motion, with what was done to it."""
    rows = [
        (floor_page.floor.floor, demand.axis, describe_source(demand), demand.name,
         "" if demand.record else describe_origin(demand), demand.height_ratio, demand.amplification,
         edge(demand.pfa, "g"), edge(demand.pfv, "cm/s"), edge(demand.record.file_pfa, "g") if demand.record else None,
         demand.record.station if demand.record else "", demand.record.event if demand.record else "",
         demand.record.azimuth_deg if demand.record else None, describe_treatment(demand))
        for floor_page in content.floors
        for demand in floor_page.demands
    ]  # fmt: skip
    heads = (_("Floor"), _("Axis"), _("Source"), _("Record"), _("Worked out"), _("z/h"), _("Amplification"),
             with_unit(_("PFA"), "g"), with_unit(_("PFV"), "cm/s"), with_unit(_("PFA in the file"), "g"), _("Station"),
             _("Event"), with_unit(_("Azimuth"), "deg"), _("Treatment"))  # fmt: skip
    widths = (9, 6, 30, 30, 36, 8, 13, 10, 11, 12, 24, 24, 10, 60)
    formats = dict.fromkeys((5, 6, 7, 9), "0.000") | {8: "0.0"}
    pen.listing(page, heads, widths, rows, formats)


def write_routes(pen: Pen, page: Any, content: Content) -> None:
    """Write a row for every piece beside a segment of a route, with its class; segments without one have a row too."""
    beside: dict[tuple[str, str], list[ItemResult]] = defaultdict(list)
    for one in content.results:
        if one.item.route:
            beside[one.item.route, one.item.segment].append(one)
    rows: list[tuple[Any, ...]] = []
    for segment in content.assessment.inventory.routes:
        whole, own = ((segment.route, name) for name in ("", segment.segment))
        pieces = [one for key in dict.fromkeys((own, whole)) for one in beside.get(key, [])]
        told = (segment.route, segment.segment, segment.floor, segment.start, segment.end, segment.clear_width,
                segment.required_width, segment.occupants)  # fmt: skip
        rows += [(*told, *_piece(one), segment.notes) for one in pieces]
        if not pieces:
            rows.append((*told, _("none"), "", None, "", None, segment.notes))
    heads = (_("Route"), _("Segment"), _("Floor"), _("From"), _("To"), with_unit(_("Clear width"), "m"),
             with_unit(_("Required width"), "m"), _("Occupants"), _("Piece beside it"), _("Description"), _("Pieces"),
             _("Class (as run)"), _("Chance"), _("Notes"))  # fmt: skip
    widths = (14, 12, 9, 16, 16, 10, 10, 10, 14, 28, 8, 34, 9, 40)
    if not rows:
        rows.append((_("The workbook names no routes."), *[None] * (len(heads) - 1)))
    pen.listing(page, heads, widths, rows, {5: "0.00", 6: "0.00", 12: "0.0%"})
    said = _(
        "Routes are listed as the workbook gives them, with the pieces that it ties to each. Whether fallen furniture "
        "would block them is not evaluated by this version."
    )
    page.write_string(len(rows) + 2, 0, said)


def _piece(one: ItemResult) -> tuple[Any, ...]:
    said = ", ".join([say_class(one.adopted.risk), *words.risk_notes(one)])
    shown = f"{ANCHORED}{words.risk_words(one)}" if one.is_anchored else said
    return (one.item.item, one.item.description or one.item.type, one.item.quantity, shown, one.adopted.probability)
