"""Japanese rule (key ``japan_rule``): pieces slender for their height must be fixed, whatever the shaking.

Reference
---------
Consumer Affairs Agency of Japan (2010). The limit is assumed: it is as Japanese safety guidance quotes it.

Equations
---------
Must be fixed where B/√H ≤ 4, B and H in cm, B the shorter plan side.

Validity
--------
Furniture at home and at work in Japan; it looks at no motion. It is Ishiyama's velocity limit at a PFV of 40 cm/s.

Departures
----------
A piece within rounding of the limit (1e-9) is on it, and must be fixed.
"""

from typing import Any

import numpy as np

from assess.i18n import Text, fill
from assess.methods.cases import Cases
from assess.methods.expression import number, show
from assess.methods.method import Column, Example, Method, Outcome, Reference
from assess.settings import Settings
from assess.units import LENGTH, ROUNDING

LIMIT = 4.0
"""B/√H [cm^0.5] up to which a piece must be fixed."""


def _breadth_over_root_height(B: Any, H: Any) -> Any:
    return B / np.sqrt(H)


def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Tell which pieces must be fixed."""
    ratio = _breadth_over_root_height(cases.breadth / LENGTH["cm"], cases.height / LENGTH["cm"])
    value = np.where(np.isnan(ratio), np.nan, ratio <= LIMIT * (1 + ROUNDING))
    return Outcome(value, {"breadth_over_root_height": ratio})


def steps(example: Example) -> list[Text]:
    """Work B/√H against its limit."""
    ratio = _breadth_over_root_height(number(example.breadth, ".6g"), number(example.height, ".6g"))
    numbers = {"ratio": float(ratio.value), "limit": LIMIT}
    return [
        show("B/√H", ratio, ".4f", "(cm)"),
        fill("{ratio:.4f} is not above {limit:g}.", **numbers)
        if example.value
        else fill("{ratio:.4f} is above {limit:g}.", **numbers),
    ]


METHOD = Method(
    key="japan_rule",
    title="Japanese rule",
    short_title="Japanese rule",
    kind="criterion",
    order=50,
    predicts="Whether a piece is so slender for its height that Japanese practice wants it fixed, whatever the "
    "earthquake.",
    reference=Reference(
        authors="Consumer Affairs Agency (Japan)",
        year="2010",
        title="Hondana tō no tentō bōshisaku ni tsuite (On measures against the overturning of bookshelves)",
        remark="Assumed: the limit is as Japanese safety guidance quotes it, not compared with the publication.",
    ),
    needs=frozenset({"breadth", "height"}),
    evaluate=evaluate,
    steps=steps,
    columns=(Column("breadth_over_root_height", "B/√H", "cm^0.5", ".2f"),),
    equations=("Must be fixed where B/√H ≤ 4 (cm)",),
    assumptions=(
        "B is the shorter plan side.",
        "No motion enters: the rule screens pieces, it does not say what happens in this scenario.",
    ),
    words=("must be fixed", "need not be fixed"),
)
