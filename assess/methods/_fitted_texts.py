"""A fitted model as a method, and what reports say of it."""

import string
from collections.abc import Sequence

from assess.language import Text, fill, join
from assess.methods._fitted_model import Fitted, Polynomial, Probit, write_sum
from assess.methods._method import FittedOn, Method, Range, Reference

LAST = 1000
"""Place in the order of reports: after all published methods."""
LONGEST = 40
"""Characters of what a model was fitted on in its title, which heads columns."""


def build_method(model: Fitted, source: str) -> Method:
    """Return a model as a method; `source` says where it comes from."""
    is_probit = isinstance(model.formula, Probit)
    fitted = FittedOn(data=model.fitted_on, error=model.error, spread=model.error_spread, constant=model.error_constant)
    return Method(
        key=model.key,
        title=fill("{name} (fitted on {data})", name=model.title, data=_shorten(fitted.data)),
        kind="probability",
        order=LAST,
        predicts=PREDICTS_BY_SIZE if is_probit else PREDICTS,
        reference=Reference(authors="", year="", title=model.title, source=source, remark=_describe(fitted)),
        needs=frozenset({"breadth", "height", "pfa", *(("pfv",) if is_probit else ())}),
        valid=_find_ranges(model),
        evaluate=model.evaluate,
        equations=_write_equations(model.formula),
        assumptions=(
            _judge(fitted),
            COMPARED,
            *((RANGES, BY_SIZE) if is_probit else (RANGES_OR_UNKNOWN, SURFACE)),
            BLOCK,
        ),
        flags={
            "extrapolated": OUTSIDE if is_probit else MAYBE_OUTSIDE,
            "clipped": "the formula gave less than 0 or more than 1, and was set to 0 or 1",
        }
        | (_OF_PFV if is_probit else {}),
        fitted=fitted,
    )


# ---------------------------------------------------------------- texts

PREDICTS = (
    "The chance that a free-standing piece overturns, from its breadth-to-height ratio and the peak floor "
    "acceleration alone."
)
PREDICTS_BY_SIZE = (
    "The chance that a free-standing piece overturns, from its size and the peak acceleration and velocity "
    "of the floor."
)
BLOCK = (
    "The piece is free-standing, rigid and homogeneous, its centroid at mid-height; it does not slide; vertical motion "
    "is left out."
)
"""Texts that published methods have as well."""
COMPARED = fill("A model of the user's own, no published method: shown for comparison, it counts for no adopted risk.")
RANGES = fill(
    "The ranges given are those of the data that it was fitted to; outside them it is marked as extrapolated."
)
RANGES_OR_UNKNOWN = fill(
    "The ranges given are those of the data that it was fitted to; outside them it is marked as extrapolated, and "
    "where PFV is unknown as well: whether PFV/PFA lies inside cannot be told then."
)
OUTSIDE = fill("outside the data that it was fitted to")
MAYBE_OUTSIDE = fill("outside the data that it was fitted to, or PFV is unknown, so that it may be outside")
SURFACE = fill("A surface, not a law: it knows no size, and may fall where the motion grows or the piece gets thinner.")
BY_SIZE = fill(
    "The chance never falls as PFA or PFV grows; of two pieces of one B/H, the larger is never the easier to overturn."
)
_OF_PFV = {
    "pfv_unknown": "not evaluated: it needs the peak floor velocity, which is unknown here",
    "pfv_estimated": "peak floor velocity estimated from PFA and the building's period",
}


def _shorten(data: str) -> str:
    """Return the first part of what a model was fitted on, which heads a column: the buildings."""
    first = data.partition(", ")[0]
    return first if len(first) <= LONGEST else f"{first[: LONGEST - 1]}…"


def _find_ranges(model: Fitted) -> dict[str, Range]:
    return {
        "breadth_to_height": _round(model.breadth_to_height),
        "pfa": _round(model.pfa),
        "height": _round(model.height),
        "pfv": _round(model.pfv),
        "PFV/PFA": _round(model.pfv_to_pfa),
    }


def _round(one: Range) -> Range:
    """Return a range as it is shown, to three digits."""
    return Range(float(f"{one.low:.3g}"), float(f"{one.high:.3g}"), one.unit)


def _describe(fitted: FittedOn) -> Text:
    errors = fill(
        "Fitted to computed chances on {data}; where a building is left out of the fit, the error for it is "
        "{error:.3f} (root mean square, standard error {spread:.3f}); a constant, the mean chance of the other "
        "buildings, has {constant:.3f}.",
        data=fitted.data, error=fitted.error, spread=fitted.spread, constant=fitted.constant,
    )  # fmt: skip
    return join(" ", (errors, _judge(fitted)))


def _judge(fitted: FittedOn) -> Text:
    """Return in words how a model does beside a constant."""
    if fitted.is_no_better:
        return fill(
            "Beware: for a building that it was not fitted to, it is no better than a constant, that is, one chance "
            "for every piece and motion."
        )
    if fitted.constant - fitted.error < fitted.spread:
        return fill(
            "Beware: for a building that it was not fitted to, it is hardly better than a constant, that is, one "
            "chance for every piece and motion: the two errors differ by less than the standard error."
        )
    return fill(
        "For a building that it was not fitted to, it is better than a constant, that is, one chance for every piece "
        "and motion."
    )


def _write_equations(formula: Polynomial | Probit) -> tuple[str, ...]:
    if isinstance(formula, Probit):
        lines = ("R = Φ(b_0 + b_1 ln[PFA/(g·B/H)] + b_2 ln[p·PFV/(g·B/H)])", "p = √(3g/(4r)), r = ½·√(B² + H²)")
        return (*lines, _write_numbers(("b_0", "b_1", "b_2"), (formula.b0, formula.b1, formula.b2)))
    total = write_sum(formula.base, formula.powers, "(B/H)", "PFA")
    letters, numbers = string.ascii_lowercase[: len(formula.terms)], [c for _, _, c in formula.terms]
    starts = range(0, len(numbers), 3)
    return (
        fill("R = {total}, PFA in cm/s²", total=total),
        *(_write_numbers(letters[at : at + 3], numbers[at : at + 3]) for at in starts),
    )


def _write_numbers(names: Sequence[str], values: Sequence[float]) -> Text:
    """Return ``a = 1.5; b = 2``, which a report writes with its own decimal sign."""
    return join(
        "; ", [fill("{name} = {value:.9g}", name=one, value=value) for one, value in zip(names, values, strict=True)]
    )
