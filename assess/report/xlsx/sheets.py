"""The sheets Motions, Routes, Methods, Assumptions and Notes."""

from typing import Any

from assess.motion.scenario import PROFILES
from assess.report.content import Content
from assess.report.data import edge
from assess.report.motions import (
    ENVELOPES,
    describe_origin,
    describe_source,
    describe_treatment,
    list_clauses,
    profile_status,
)
from assess.report.xlsx.pen import Pen
from assess.risk import LIMITS

NAMES = {
    "limit_medium": "Lower limit of medium",
    "limit_high": "Lower limit of high",
    "limit_very_high": "Lower limit of very high",
    "zeta_a": "Kaneko-Hayashi ζ_A",
    "zeta_v": "Kaneko-Hayashi ζ_V",
    "slide_alpha": "Kaneko-Hayashi slide coefficient α",
}
"""Cells that formulas refer to by name, in the order of the sheet Assumptions."""


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
    heads = ("Floor", "Axis", "Source", "Record", "Worked out", "z/h", "Amplification", "PFA [g]", "PFV [cm/s]",
             "PFA in the file [g]", "Station", "Event", "Azimuth [deg]", "Treatment")  # fmt: skip
    widths = (9, 6, 34, 40, 44, 8, 13, 10, 11, 12, 34, 34, 10, 80)
    formats = dict.fromkeys((5, 6, 7, 9), "0.000") | {8: "0.0"}
    pen.listing(page, heads, widths, rows, formats)


def write_routes(pen: Pen, page: Any, content: Content) -> None:
    """Write the segments of routes as the workbook has them."""
    segments = content.assessment.inventory.routes
    rows = [
        (one.route, one.segment, one.floor, one.start, one.end, one.clear_width, one.required_width, one.occupants,
         ", ".join(piece.item.item for piece in content.results
                   if piece.item.route == one.route and piece.item.segment in ("", one.segment)), one.notes)
        for one in segments
    ]  # fmt: skip
    heads = ("Route", "Segment", "Floor", "From", "To", "Clear width [m]", "Required width [m]", "Occupants",
             "Pieces beside it (blockage is not evaluated by this version)", "Notes")  # fmt: skip
    pen.listing(page, heads, (14, 12, 9, 20, 20, 10, 10, 10, 60, 40), rows)


def write_methods(pen: Pen, page: Any, content: Content) -> None:
    """Write what the methods are, assume and change, what was verified how, what the marks mean, and the limits."""
    rows = []
    for method in content.methods:
        parts = (
            ("Predicts", (method.predicts,)),
            ("Equation", method.equations),
            ("Assumption", method.assumptions),
            ("Departure from the source", method.departures),
            ("Source", (str(method.reference),)),
        )
        rows += [(method.title, what, text) for what, texts in parts for text in texts]
    for profile in PROFILES.values():
        rows.append((profile.title, "Clause", list_clauses(profile)))
        rows.append((profile.title, "Equation", profile.equation))
        rows.append((profile.title, "Status", profile_status(profile)))
        rows.append((profile.title, "Source", profile.reference))
    rows.append(("Floor motion by a code's profile", "Beware", ENVELOPES))
    rows += [("Verification", "What was done", text) for text in content.trials.paragraphs]
    rows += [("Verification", "Beware", text) for text in content.trials.misfits]
    rows += [("Marks", flag.replace("_", " "), meaning) for flag, meaning in content.flags.items()]
    rows += [("Limits", "", text) for text in content.limits]
    pen.listing(page, ("Method", "What", "Text"), (28, 26, 130), rows)


def write_assumptions(pen: Pen, page: Any, content: Content) -> None:
    """Write the values that formulas refer to, and what else was assumed."""
    settings = content.assessment.settings
    values = (*LIMITS, settings.zeta_acceleration, settings.zeta_velocity, settings.slide_coefficient)
    pen.listing(page, ("Assumption", "Value"), (70, 60), ())
    for row, ((name, label), value) in enumerate(zip(NAMES.items(), values, strict=True), 1):
        page.write_string(row, 0, f"{label} (edit the value: {_follows(name)})")
        page.write_number(row, 1, value, pen.input)
    for row, (where, what) in enumerate(content.assumptions, len(NAMES) + 2):
        pen.put(page, row, 0, where)
        pen.put(page, row, 1, what, pen.wrap)


def _follows(name: str) -> str:
    return "classes and counts follow" if name.startswith("limit") else "the column Kaneko-Hayashi follows"


def write_notes(pen: Pen, page: Any, content: Content) -> None:
    """Write the data-quality log, the inputs and what the report was made with."""
    rows: list[tuple[str, str, str]] = [
        (one.severity, one.place, f"{one.message} {one.mend}".strip()) for one in content.problems
    ]
    inventory, platform = content.assessment.inventory, content.platform
    rows.append(("input", inventory.source.name, f"SHA-256 {inventory.sha256}"))
    rows += [("input", name, f"SHA-256 {digest}") for name, digest in inventory.files.items()]
    rows.append(
        (
            "made with",
            f"assess {content.version}",
            ", ".join(f"{name} {value}" for name, value in platform.items()),
        )
    )
    pen.listing(page, ("Kind", "Place", "What"), (12, 40, 120), rows)
