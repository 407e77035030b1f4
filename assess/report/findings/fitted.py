"""Fitted models beside the published methods: why one disagrees on a piece, and on how many it does.

What is said of one comes before all other reasons, and apart from what is said of the published methods.
"""

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from assess.language import gettext as _
from assess.language import ngettext, number
from assess.methods._method import DECIMALS
from assess.report.findings.facts import Facts, spans, values_of
from assess.report.findings.reasons import KINDS, Kind, find_kinds


def find_reasons(facts: Facts) -> tuple[str, ...]:
    """Return the names of the reasons that apply, the most telling first."""
    of_fitted = () if facts.model is None else tuple(name for name, kind in OF_FITTED.items() if kind.applies(facts))
    return (*of_fitted, *find_kinds(facts))


def say_reason(name: str, rows: Sequence[Facts]) -> str:
    """Return a reason in words."""
    return (OF_FITTED.get(name) or KINDS[name]).say(rows)


def summarise_fitted(fitted: str, pairs: Sequence[tuple[str, str]], rows: int) -> str:
    """Return in one sentence on how many of `rows` a fitted model disagrees with a published method.

    `pairs` are the titles of the higher and the lower one, for each row on which they do; `fitted` is the model's.
    """
    (highest, lowest), count = Counter(pairs).most_common(1)[0]
    return ngettext(
        "Counted apart: {model} differs by more than one class from a published method on {n:,} of {rows:,} rows; most "
        "often {highest} lies above {lowest} (on {count:,}).",
        "Counted apart: {model} differs by more than one class from a published method on {n:,} of {rows:,} rows; most "
        "often {highest} lies above {lowest} (on {count:,}).",
        len(pairs), rows=rows, model=fitted, highest=highest, lowest=lowest, count=count,
    )  # fmt: skip


def _say_fitted(rows: Sequence[Facts]) -> str:
    model, fitted = next((one.model, one.model.fitted) for one in rows if one.model and one.model.fitted)
    return _(
        "The fitted model gives {value} at B/H {ratio} and PFA {pfa} g: it approximates what was computed on the "
        "buildings that it was fitted to, with a root mean square error of {error} where a building is left out.",
        **spans(rows, "pfa", "ratio"),
        value=values_of(rows, model.key), error=number(fitted.error, f".{DECIMALS}f"),
    )  # fmt: skip


def _is_no_better(facts: Facts) -> bool:
    fitted = None if facts.model is None else facts.model.fitted
    return fitted is not None and fitted.is_no_better


def _say_no_better(rows: Sequence[Facts]) -> str:
    return _(
        "For a building that it was not fitted to, it is no better than a constant, one chance for every piece "
        "and motion."
    )


def _is_extrapolated(facts: Facts) -> bool:
    return facts.model is not None and facts.has(facts.model.key, "extrapolated")


def _say_extrapolated(rows: Sequence[Facts]) -> str:
    return _("The piece or its motion lies outside the data that the model was fitted to.")


def _say_maybe_extrapolated(rows: Sequence[Facts]) -> str:
    return _(
        "PFV is unknown: the piece and its motion cannot be shown to lie inside the data that the model was fitted to."
    )


OF_FITTED: Mapping[str, Kind] = {
    "fitted": Kind(lambda one: one.model is not None, _say_fitted),
    "fitted_no_better": Kind(_is_no_better, _say_no_better),
    "fitted_extrapolated": Kind(lambda one: _is_extrapolated(one) and not math.isnan(one.pfv), _say_extrapolated),
    "fitted_maybe_extrapolated": Kind(
        lambda one: _is_extrapolated(one) and math.isnan(one.pfv), _say_maybe_extrapolated
    ),
}
