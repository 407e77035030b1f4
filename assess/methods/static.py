"""Static criterion of Milne and West (key ``static``): whether the piece can start to rock at all.

Reference
---------
Equilibrium of a block at rest, the condition on line 118 of "Overturning Risk of Furniture in Earthquake Affected
Areas" (section 2.1); known as the formula of Milne or West.

Equations
---------
Rocking starts where PFA/g > B/H.

Validity
--------
Any rigid block whose centroid is at mid-height and that does not slide.

Departures
----------
None.
"""

from typing import Any

import numpy as np

from assess.i18n import Text
from assess.methods.cases import Cases
from assess.methods.expression import G, compare, number, show, show_ratio
from assess.methods.method import Column, Example, Method, Outcome, Reference
from assess.settings import Settings
from assess.units import ACCELERATION


# Section 2.1: a_g / g > B/H
def _threshold(B_H: Any, g: Any) -> Any:
    return g * B_H


def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Tell where PFA exceeds the acceleration at which rocking starts."""
    threshold = _threshold(cases.breadth_to_height, ACCELERATION["g"])
    known = ~np.isnan(threshold) & ~np.isnan(cases.pfa)
    value = np.where(known, cases.pfa > threshold, np.nan)
    return Outcome(value, {"threshold_pfa_g": threshold / ACCELERATION["g"]})


def steps(example: Example) -> list[Text]:
    """Work PFA > g·B/H."""
    limit = _threshold(number(example.breadth / example.height, ".5f"), number(G, ".3f"))
    return [
        show_ratio(example),
        show("g·B/H", limit, ".6g", "cm/s²"),
        compare("PFA", example.pfa, limit, "cm/s²", is_above=bool(example.value)),
    ]


METHOD = Method(
    key="static",
    title="Static criterion (Milne, West)",
    short_title="Static",
    kind="criterion",
    order=30,
    predicts="Whether the floor shakes hard enough for a free-standing piece to start rocking; it need not overturn "
    "then.",
    reference=Reference(
        title="Overturning Risk of Furniture in Earthquake Affected Areas",
        remark="Section 2.1, the condition for the initiation of motion; known as the formula of Milne or West.",
    ),
    needs=frozenset({"breadth", "height", "pfa"}),
    evaluate=evaluate,
    steps=steps,
    tells_rocking=True,
    columns=(Column("threshold_pfa_g", "PFA at which rocking starts", "g"),),
    equations=("Rocking starts where PFA > g·(B/H)",),
    assumptions=(
        "The centroid is at mid-height, the piece is rigid and free-standing, and it does not slide.",
        "Necessary for overturning, not sufficient: a short peak may start a rocking that dies away.",
    ),
    words=("rocking can start", "rocking cannot start"),
)
