"""The sheet Verification: the motions under which pieces were integrated, and how they meet their target."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from assess.adoption import VERIFICATION
from assess.demand import Demand
from assess.language import gettext as _
from assess.methods._method import Joint
from assess.report import words
from assess.report.content import Content
from assess.report.data import ensemble_record
from assess.report.findings.motions import describe_source
from assess.report.xlsx.pen import Pen, with_unit
from assess.results import Assessment

_FIT = ("matched_to_s", "mean_deviation", "worst_deviation", "worst_period_s", "pfa_ratio", "pfa_scatter", "pfv_ratio",
        "pfv_scatter", "spectrum_scatter")  # fmt: skip
"""What is shown of `assess.report.data.fit_record`, in the order of the columns."""


def _heads() -> dict[str, tuple[int, str]]:
    """Return heading, width and number format of every column."""
    return {
        _("Floor"): (9, ""),
        _("Axis"): (6, ""),
        _("Source"): (34, ""),
        _("Record"): (30, ""),
        _("Spectrum"): (14, ""),
        _("Motions"): (9, "#,##0"),
        _("Seed"): (8, "0"),
        with_unit(_("Matched from 0.05 s to"), "s"): (10, "0.00"),
        _("Mean deviation"): (10, "0.0%"),
        _("Worst deviation"): (10, "+0.0%;-0.0%"),
        with_unit(_("at period"), "s"): (9, "0.000"),
        _("PFA over the target's"): (10, "0.000"),
        _("Scatter of PFA"): (9, "0.0%"),
        _("PFV over the target's"): (10, "0.000"),
        _("Scatter of PFV"): (9, "0.0%"),
        _("Scatter of the spectrum"): (10, "0.0%"),
        _("Rows"): (8, "#,##0"),
        _("Rows that overturn under the record"): (18, "#,##0"),
    }


def write_verification(pen: Pen, page: Any, content: Content) -> None:
    """Write the motions of every floor and axis on which pieces were integrated, and how they meet their target."""
    joints = content.assessment.joints
    rows = [
        _row(content.assessment, demand, joints[demand])
        for floor_page in content.floors
        for demand in floor_page.demands
        if demand in joints
    ]
    heads = _heads()
    widths = [width for width, _code in heads.values()]
    formats = {at: code for at, (_width, code) in enumerate(heads.values()) if code}
    pen.listing(page, tuple(heads), widths, rows, formats)


def _row(assessment: Assessment, demand: Demand, joint: Joint) -> list[Any]:
    ensemble = ensemble_record(assessment, demand) or {}
    fit: Mapping[str, float | None] = ensemble["fit"] or {}
    suite, fell = assessment.suite, assessment.outcomes[VERIFICATION].detail["record_overturned"][joint.cases]
    known = fell[~np.isnan(fell)]
    return [
        demand.floor.floor, demand.axis, describe_source(demand), demand.name,
        _kind(assessment, ensemble), ensemble["motions"],
        None if suite else assessment.settings.seed, *(fit.get(name) for name in _FIT),
        joint.cases.size, int(known.sum()) if known.size else None,
    ]  # fmt: skip


def _kind(assessment: Assessment, ensemble: Mapping[str, Any]) -> str:
    if assessment.suite:
        folder = words.cut(assessment.suite.folder, 60)
        is_scaled = assessment.settings.scale_motions
        return _("suite {folder}, scaled", folder=folder) if is_scaled else _("suite {folder}", folder=folder)
    return _("generic") if ensemble["generic_spectrum"] else _("recorded")
