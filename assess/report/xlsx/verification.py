"""The sheet Verification: the motions under which pieces were integrated, and how they meet their target."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from assess.adoption import VERIFICATION
from assess.demand import Demand
from assess.methods._method import Joint
from assess.report import words
from assess.report.content import Content
from assess.report.data import ensemble_record
from assess.report.motions import describe_source
from assess.report.xlsx.pen import Pen
from assess.results import Assessment

_HEADS = {
    "Floor": (9, ""),
    "Axis": (6, ""),
    "Source": (34, ""),
    "Record": (30, ""),
    "Spectrum": (14, ""),
    "Motions": (9, "#,##0"),
    "Seed": (8, "0"),
    "Matched from 0.05 s to [s]": (10, "0.00"),
    "Mean deviation": (10, "0.0%"),
    "Worst deviation": (10, "+0.0%;-0.0%"),
    "at period [s]": (9, "0.000"),
    "PFA over the target's": (10, "0.000"),
    "Scatter of PFA": (9, "0.0%"),
    "PFV over the target's": (10, "0.000"),
    "Scatter of PFV": (9, "0.0%"),
    "Scatter of the spectrum": (10, "0.0%"),
    "Rows": (8, "#,##0"),
    "Rows that overturn under the record": (18, "#,##0"),
}
"""Heading, width and number format of every column."""

_FIT = ("matched_to_s", "mean_deviation", "worst_deviation", "worst_period_s", "pfa_ratio", "pfa_scatter", "pfv_ratio",
        "pfv_scatter", "spectrum_scatter")  # fmt: skip
"""What is shown of `assess.report.data.fit_record`, in the order of the columns."""


def write_verification(pen: Pen, page: Any, content: Content) -> None:
    """Write the motions of every floor and axis on which pieces were integrated, and how they meet their target."""
    joints = content.assessment.joints
    rows = [
        _row(content.assessment, demand, joints[demand])
        for floor_page in content.floors
        for demand in floor_page.demands
        if demand in joints
    ]
    widths = [width for width, _ in _HEADS.values()]
    formats = {at: code for at, (_, code) in enumerate(_HEADS.values()) if code}
    pen.listing(page, tuple(_HEADS), widths, rows, formats)


def _row(assessment: Assessment, demand: Demand, joint: Joint) -> list[Any]:
    ensemble = ensemble_record(assessment, demand) or {}
    fit: Mapping[str, float | None] = ensemble["fit"] or {}
    suite, fell = assessment.suite, assessment.outcomes[VERIFICATION].detail["record_overturned"][joint.cases]
    kind = "generic" if ensemble["generic_spectrum"] else "recorded"
    if suite:
        kind = f"suite {words.clip(suite.folder, 60)}" + (", scaled" if assessment.settings.scale_motions else "")
    known = fell[~np.isnan(fell)]
    return [
        demand.floor.floor, demand.axis, describe_source(demand), demand.name,
        kind, ensemble["motions"],
        None if suite else assessment.settings.seed, *(fit.get(name) for name in _FIT),
        joint.cases.size, int(known.sum()) if known.size else None,
    ]  # fmt: skip
