"""The sheet Motions."""

from typing import Any

from assess.language import gettext as _
from assess.report.content import Content
from assess.report.data import edge
from assess.report.findings.motions import describe_origin, describe_source, describe_treatment
from assess.report.xlsx.pen import Pen, with_unit


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
