"""What the page says of fits: tables and sentences of study `fit`."""

from collections.abc import Iterator

from assess.methods._fitted_model import Probit
from assess.methods.proposed_or import COEFFICIENTS
from assess.studies._fits import Alternative, Fits
from assess.studies._formulas import FORMULAS, percent
from assess.studies._study import table_lines
from assess.studies._surfaces import CONSTANT, EQUATION_8, NEGLIGIBLE, LeftOut
from assess.studies._trials import LEVELS, RATIOS

SHOWN = 4
"""Candidates that the page lists, beside equation (8), the constant and that of the smallest error."""
LETTERS = {"a": (0, 0), "b": (1, 0), "c": (0, 1), "d": (2, 0), "e": (0, 2), "f": (1, 1)}
"""Of the coefficients of equation (8): the powers of their terms."""
KANEKO = FORMULAS["kaneko_hayashi"]


def summarise(fits: Fits) -> str:
    """Return one sentence on what carries over to a building that was left out."""
    published = ", ".join(f"{title} by {_points(left_out)}" for title, left_out in fits.published.items())
    return (
        f"For a building that was left out of the fit, the best of {len(fits.ranked) - 1} surfaces errs by "
        f"{_points(fits.best.surface.left_out)} points (root mean square), equation (8) fitted again by "
        f"{_points(fits.equation_8.surface.left_out)}, a constant by {_points(fits.constant.surface.left_out)}; a "
        f"probit in PFA, PFV and size, bounded and monotone, by {_points(fits.probit.left_out)}. Of the published "
        f"formulas, which were fitted to none of them, {published}."
    )


def say_failures(fits: Fits) -> Iterator[str]:
    """Yield what no surface in B/H and PFA can do."""
    surface, pfa_alone = fits.best.surface.left_out, fits.probit_without_pfv.left_out
    yield (
        "**No surface in B/H and PFA alone carries over to another building.** Fitted to two buildings, the best of "
        f"{len(fits.ranked) - 1} errs by {_points(surface)} points in the third, where a constant errs by "
        f"{_points(fits.constant.surface.left_out)}; a bounded probit in PFA/(g·B/H) alone by {_points(pfa_alone)}, "
        f"with PFV in it by {_points(fits.probit.left_out)}. More terms do not help here, PFV does; three buildings, "
        "whose PFV/PFA do not overlap, cannot tell what else differs between them."
    )


def describe(fits: Fits) -> Iterator[str]:
    """Yield the section."""
    yield from _describe_ranking(fits)
    yield from _describe_coefficients(fits)
    yield from _describe_probit(fits)
    yield from _describe_errors(fits)


def _describe_ranking(fits: Fits) -> Iterator[str]:
    level = sum(one.is_level for one in fits.ranked)
    yield (
        f"A constant and {len(fits.ranked) - 1} polynomials in x = B/H, or in 1/x (the paper's Taylor series), and y = "
        f"PFA, to orders 1 to 3, full and reduced, fitted by ordinary least squares to {fits.points.z.size:,} chances "
        f"by direct integration (study `table2`: B/H {RATIOS[0]:g} to {RATIOS[-1]:g}, {LEVELS[0]:g} to {LEVELS[-1]:g} "
        "g). They rank by the error for a building left out of the fit. Those above the smallest by no more than its "
        f"standard error over the buildings ({100 * fits.best.surface.left_out.spread:.1f} points), or "
        f"{100 * NEGLIGIBLE:g} points, count as level, {level} of {len(fits.ranked)} here; of these the one with "
        "fewest coefficients comes first. Adjusted R² and AIC take every case for independent, and favour many "
        "coefficients."
    )
    yield ""
    named = {CONSTANT: "", EQUATION_8: " (eq. 8)", fits.best.surface.candidate: " (smallest error)"}
    shown = [one for one in fits.ranked if one.place <= SHOWN or one.surface.candidate in named]
    yield from table_lines(
        ("place", "surface", "coefficients", "error left out", "adjusted R²", "by adjusted R²", "by AIC"),
        [
            (
                one.place, one.surface.candidate.name + named.get(one.surface.candidate, ""),
                len(one.surface.coefficients), _points(one.surface.left_out), f"{max(one.surface.adjusted_r2, 0):.3f}",
                one.place_adjusted_r2, one.place_aic,
            )
            for one in shown
        ],
    )  # fmt: skip
    yield ""


def _describe_coefficients(fits: Fits) -> Iterator[str]:
    values = dict(zip(EQUATION_8.powers, fits.equation_8.surface.coefficients, strict=True))
    yield "Equation (8), z = a + b/x + c·y + d/x² + e·y² + f·y/x, y in cm/s², beside the paper's coefficients:"
    yield ""
    rows = [
        ("the paper, eq. (9)", *(f"{getattr(COEFFICIENTS, name):.4g}" for name in LETTERS)),
        ("fitted here", *(f"{values[powers]:.4g}" for powers in LETTERS.values())),
    ]
    yield from table_lines(("", *LETTERS), rows)
    yield ""


def _describe_probit(fits: Fits) -> Iterator[str]:
    yield (
        "A bounded, monotone alternative with size in it, fitted by maximum likelihood: R = Φ(b₀ + b₁ ln[PFA/(g·B/H)] "
        f"+ b₂ ln[p·PFV/(g·B/H)]), p = √(3g/4r), b₁ and b₂ not below 0: {_tell(fits.probit)} It has no threshold: of "
        f"the cases with PFA below g·B/H it puts {percent(fits.said_at_rest)} into class medium or higher."
    )
    yield ""


def _tell(fitted: Alternative) -> str:
    """Return the coefficients, and their range over the fits that leave a building out."""
    told = []
    for name, letter in (("b0", "b₀"), ("b1", "b₁"), ("b2", "b₂")):
        spread = [_value(one, name) for one in fitted.without]
        value = _value(fitted.probit, name)
        bound = ", at its bound" if name != "b0" and value == 0 else ""
        told.append(f"{letter} = {value:.2f}{bound} ({min(spread):.2f} to {max(spread):.2f} without one building)")
    return f"{'; '.join(told)}."


def _value(probit: Probit, name: str) -> float:
    return float(getattr(probit, name))


def _describe_errors(fits: Fits) -> Iterator[str]:
    yield "Root mean square error for each building, by what never saw it (percentage points):"
    yield ""
    rows = [(name, count or "", *_errors(left_out)) for name, count, left_out in _list(fits)]
    yield from table_lines(("model", "coefficients fitted", *fits.buildings, "all"), rows)
    yield ""
    yield (
        "Equation (8) fitted again and the probit are saved as files: `assess run WORKBOOK --method "
        "fitted_probit.toml` shows one beside the published formulas, marked where a piece or its motion is outside "
        "the data that it was fitted to. Neither counts for an adopted risk."
    )


def _list(fits: Fits) -> Iterator[tuple[str, int, LeftOut]]:
    for title, left_out in fits.published.items():
        yield f"{title} (not fitted)", 0, left_out
    named = {CONSTANT: "", EQUATION_8: " (equation (8) fitted again)", fits.best.surface.candidate: " (smallest error)"}
    for candidate, name in named.items():
        yield f"{candidate.name}{name}", len(candidate.powers), fits.find(candidate).surface.left_out
    yield "probit without PFV (b₀, b₁)", 2, fits.probit_without_pfv.left_out
    yield "probit (b₀, b₁, b₂)", 3, fits.probit.left_out


def _errors(left_out: LeftOut) -> list[str]:
    return [f"{100 * one**0.5:.1f}" for one in left_out.squares] + [_points(left_out)]


def _points(left_out: LeftOut) -> str:
    return f"{100 * left_out.error:.1f}"
