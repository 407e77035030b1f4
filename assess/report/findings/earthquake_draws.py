"""How the draws of an earthquake depend on the building's place and on scenarios, in the words of reports."""

from collections.abc import Iterator

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.results import EarthquakeDraws, Results

BOORE = (
    "Boore D, Stewart J, Seyhan E, Atkinson G (2014). NGA-West2 equations for predicting PGA, PGV, and 5 % damped PSA "
    "for shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M"
)
JAYARAM = (
    "Jayaram N, Baker J (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake "
    "Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922"
)


def find_draws(results: Results) -> EarthquakeDraws | None:
    """Return how earthquakes were drawn; None where one factor for the building alone was, or none."""
    is_drawn = results.has_simulated and not results.settings.ideal and results.provenance.uncertainty.motion > 0
    return results.provenance.earthquakes if is_drawn else None


def say_draws(results: Results) -> str:
    """Return how the number of a draw depends on the place and on scenarios, in sentences; "" where it does not."""
    draws = find_draws(results)
    return "" if draws is None else " ".join(_list_sentences(draws, has_suite=results.provenance.suite is not None))


def _list_sentences(draws: EarthquakeDraws, *, has_suite: bool) -> Iterator[str]:
    if draws.scenarios:
        yield ngettext(
            "A share of {share} of the variance of ε is that of {n:,} scenario of the ground; the rest is drawn.",
            "A share of {share} of the variance of ε is that of {n:,} scenarios of the ground, draw by draw in their "
            "order; the rest is drawn.",
            draws.scenarios, share=number(draws.scenario_share, ".2f"),
        )  # fmt: skip
    if not draws.is_city:
        return
    if draws.is_placed:
        yield _say_place(draws)
    else:
        yield _(
            "The draws are those of a city, but the building's Latitude and Longitude are not filled in: ε is the "
            "number that all places have in common, so that buildings without a place are fully correlated."
        )
    if not has_suite:
        yield _(
            "Motion k has the same random phases in every building, so that sums over buildings vary more than they "
            "should, not less."
        )


def _say_place(draws: EarthquakeDraws) -> str:
    source = _("as the ShakeMap gives it") if draws.is_shared_given else _("Boore et al. 2014")
    return _(
        "The draws are those of a city: what is drawn, of ln {measure}, has a part that is common to all places, a "
        "share of {shared} of its variance ({source}), and one that is correlated with that of a place at a distance h "
        "by exp(-3h/{range} km) (Jayaram and Baker 2009).",
        measure=draws.measure, shared=number(draws.shared, ".3f"), source=source, range=number(draws.range_km, "g"),
    )  # fmt: skip


def list_references(results: Results) -> list[str]:
    """Return the publications that the draws rest on; none where they do not depend on the place."""
    draws = find_draws(results)
    if draws is None or not draws.is_placed:
        return []
    return [JAYARAM] if draws.is_shared_given else [BOORE, JAYARAM]


def list_draw_assumptions(results: Results) -> list[tuple[str, str]]:
    """Return the assumption on the draws of an earthquake; none where they depend neither on place nor scenarios."""
    text = say_draws(results)
    return [(_("Draws of an earthquake (ε is the number by which draw k scales the motions)"), text)] if text else []
