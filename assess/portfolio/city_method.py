"""How the numbers of a city were made: settings, methods and draws in words, and what they are cited by."""

from collections.abc import Iterator

from assess.i18n import gettext as _
from assess.i18n import number
from assess.methods import adopted_formula
from assess.motion.spatial_field import SCATTERS, Measure
from assess.portfolio.city import PEOPLE_RULE, City
from assess.portfolio.city_spread import Spread
from assess.portfolio.city_words import list_facts, say_interval, say_range, say_whole
from assess.report import words
from assess.report.provenance import say_reference
from assess.risk import LIMITS
from assess.route_results import BLOCKED_FROM
from assess.version import __version__

REFERENCES = (
    "Jayaram N, Baker JW (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake "
    "Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922",
    "Boore DM, Stewart JP, Seyhan E, Atkinson GM (2014). NGA-West2 equations for predicting PGA, PGV, and 5% damped "
    "PSA for shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M",
)
"""Sources of the draws of an earthquake that differ from place to place; named where anything was drawn."""
P58 = (
    "FEMA (2018). Seismic performance assessment of buildings, FEMA P-58, second edition, volume 1: normative "
    "quantities of components by occupancy. Federal Emergency Management Agency"
)
"""Source of assumed inventories."""


def list_basis(city: City) -> list[tuple[str, str]]:
    """Return what the numbers rest on, as label and value: the ground motion, then the settings of the run."""
    settings, found = city.settings, list_facts(city)
    if city.ground is not None:
        found.append((_("SHA-256 of {file}", file=city.ground.file), city.ground.sha256))
    simulated = {"all": _("all pieces"), "high": _("pieces of high risk, doubtful, or on routes"), "none": _("none")}
    found.append((_("Simulated"), simulated[settings.verify]))
    if settings.verify != "none":
        found.append((_("Draws, seed"), f"{say_whole(int(settings.runs))}, {settings.seed}"))
    if settings.scenario:
        found.append((_("Motion of the floors"), settings.scenario))
    if settings.class_by:
        found.append((_("Class by"), _(settings.class_by)))
    if settings.scale != 1:
        found.append((_("Factor on all motions"), number(settings.scale, "g")))
    found.append((_("Limit on the chance that a route is blocked"), words.percent(settings.route_risk)))
    found.append((_("Program"), f"assess {__version__}"))
    return found


def list_method(city: City) -> list[str]:
    """Return how the numbers were made, in short paragraphs."""
    return list(_list_method(city))


def _list_method(city: City) -> Iterator[str]:
    yield _("Every percentage and every expected number is for this scenario, not per year. Classes by the chance of "
            "overturning: low below {low}, medium below {medium}, high below {high}, very high above.",
            low=_share(LIMITS[0]), medium=_share(LIMITS[1]), high=_share(LIMITS[2]))  # fmt: skip
    group = next((group for group in city.groups if group.falls.draws), None)
    if group is not None:
        drawn = group.falls
        yield _say_draws(city, drawn)
        alone, together = say_range(drawn.independent_low, drawn.independent_high), say_range(drawn.low, drawn.high)
        if group.buildings > 1 and alone != together:
            yield _("If every building had an earthquake of its own, the range would be {alone} in place of {together}"
                    ": that is not so, and the difference shows why ranges of buildings must not be added up.",
                    alone=alone, together=together)  # fmt: skip
        yield _("The expected number itself is known within the sampling interval, by the number of draws alone "
                "(95 %): {interval}.", interval=say_interval(drawn.sampling_low, drawn.sampling_high))  # fmt: skip
    yield from _say_dispersion(city)
    yield from _say_routes(city)
    if any(group.basis == "formula" for group in city.groups):
        formula = adopted_formula(city.settings.class_by)
        yield _("Results by formula only are chances by {formula}, under the median of the ground motion; nothing was "
                "simulated, so that no range is given.", formula=_(formula.title))  # fmt: skip
    if any(group.inventory == "assumed" for group in city.groups):
        yield _("Assumed inventories: pieces by use and floor area from the normative quantities of FEMA P-58; low, "
                "median and high are its 10, 50 and 90 % quantities. No piece of them has been seen.")  # fmt: skip


def _say_dispersion(city: City) -> Iterator[str]:
    """Yield how the dispersion of the drawn motions is made up, with its range over the buildings."""
    drawn = city.buildings["motion_uncertainty"].dropna().astype("float64")
    if city.ground is None or drawn.empty:
        return
    low, high = (number(float(end), ".2f") for end in (drawn.min(), drawn.max()))
    yield _("The standard deviation of ln amplitude that is drawn is √(β² + σ²): β the Motion uncertainty of the "
            "workbook, 0 where that is blank, σ that of the ground motion at the building. It is {low} to {high}.",
            low=low, high=high)  # fmt: skip


def _say_routes(city: City) -> Iterator[str]:
    if not any(sum(group.routes.values()) for group in city.groups):
        return
    yield _("A route is open where the upper end of its chance of being blocked is below {limit} and every piece that "
            "matters is known, doubtful below {blocked}, blocked from {blocked} on, and not known where something "
            "missing could change its state.",
            limit=words.percent(city.settings.route_risk), blocked=_share(BLOCKED_FROM))  # fmt: skip
    if any(group.occupants for group in city.groups):
        yield _(PEOPLE_RULE)


def _say_draws(city: City, drawn: Spread) -> str:
    """Return what the draws of a city have in common."""
    ends = _("The range from 5 to 95 % of the draws is that of the sum over buildings, draw by draw.")
    if city.settings.ideal:
        start = _("Each of the {draws:,} draws is one motion of each floor, without the uncertainty of the earthquake.",
                  draws=drawn.draws)  # fmt: skip
    elif city.ground is not None and city.ground.is_known:
        start = _("The motion of the ground is taken as known. Each of the {draws:,} draws varies the buildings' own "
                  "motions alone.", draws=drawn.draws)  # fmt: skip
    elif city.ground is not None and city.ground.kind == "scenarios":
        start = _("Each of the {draws:,} draws takes one of the computed scenarios, the same for all buildings. The "
                  "uncertainty of the buildings' own motions is drawn besides.", draws=drawn.draws)  # fmt: skip
    else:
        start = _("Each of the {draws:,} draws is one earthquake for all buildings.", draws=drawn.draws)
    return f"{start} {ends}" if city.settings.ideal else f"{start} {_say_places(city)} {ends}"


def _say_places(city: City) -> str:
    """Return what draws have in common from place to place."""
    measure: Measure = "PGV" if city.buildings["ground_pgv_cm_s"].notna().any() else "PGA"
    return _("Of the variance of ln {measure} that is drawn, {shared} is common to all buildings (Boore et al. 2014) "
             "unless the ShakeMap gives that share itself; the rest differs from place to place, with the correlation "
             "exp(-3 h / {range:g} km) at the distance h (Jayaram and Baker 2009).", measure=measure,
             shared=_share(SCATTERS[measure].shared), range=SCATTERS[measure].range_km)  # fmt: skip


def _share(value: float) -> str:
    return f"{number(100 * value, '.0f')} %"


def list_references(city: City) -> list[str]:
    """Return the publications that the numbers rest on."""
    drawn = any(group.falls.draws for group in city.groups) and not city.settings.ideal
    by_formula = any(group.basis == "formula" or group.by_formula for group in city.groups)
    assumed = any(group.inventory == "assumed" for group in city.groups)
    formula = say_reference(adopted_formula(city.settings.class_by).reference)
    return [*((formula,) if by_formula else ()), *(REFERENCES if drawn else ()), *((P58,) if assumed else ())]
