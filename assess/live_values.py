"""What the live columns of a workbook show, from an assessment.

They are stored in a workbook beside the formulas, so that a viewer that does not calculate shows them too.
"""

import os
import tempfile
from dataclasses import replace
from pathlib import Path

from assess.adoption import FORMULA
from assess.assessment import run
from assess.inventory.blank import Content, Units, write_workbook
from assess.inventory.lists import RUN_ASSESS
from assess.inventory.live import OUTSIDE, say_class
from assess.inventory.workbook import read_inventory
from assess.language import gettext
from assess.results import Assessment, ItemResult
from assess.risk import classify
from assess.settings import Settings
from assess.units import GRAVITY


def stored_live(assessment: Assessment) -> list[list[float | str]]:
    """Return what the columns `assess.inventory.columns.LIVE` show in the language in use, five values an item.

    They equal what the formulas compute where the assessment was made with the workbook's own scenario and the default
    settings, which are all that the formulas know.
    """
    return [_live_row(one) for one in assessment]


def _live_row(one: ItemResult) -> list[float | str]:
    breadth_to_height = one.item.breadth / one.item.height
    if any(case.demand.source != "given" for case in one.cases):
        return [breadth_to_height, *[gettext(RUN_ASSESS)] * 4]
    methods = one.by_formula.methods
    risks = [methods[key].value for key in (FORMULA, "kaneko_hayashi")]
    outside = OUTSIDE if "extrapolated" in methods[FORMULA].flags else ""
    risk = None if risks[0] is None else classify(risks[0])
    label = (say_class(risk) if risk is not None else "") + outside
    pfa_g = one.by_formula.demand.pfa / GRAVITY
    return [breadth_to_height, pfa_g, *("" if risk is None else risk for risk in risks), label]


def with_live(content: Content, units: Units = "si", folder: Path | None = None) -> Content:
    """Return a content with the results of its live columns, worked out by assessing a temporary workbook.

    Parameters
    ----------
    content : Content
        The rows; a `live` that it has is replaced.
    units : "si" or "imperial"
        Of its values.
    folder : Path, optional
        Where the files lie that it names, such as records; the temporary workbook stands there for a moment.

    Raises
    ------
    WorkbookError
        If the rows do not make an inventory.
    """
    handle, name = tempfile.mkstemp(suffix=".xlsx", dir=folder)
    os.close(handle)
    path = Path(name)
    try:
        write_workbook(path, replace(content, live=()), units)
        return replace(content, live=stored_live(run(read_inventory(path), Settings(verify="none"))))
    finally:
        path.unlink()
