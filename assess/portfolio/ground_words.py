"""What a reader of a city has to know of its ground motion before the numbers: what makes it less certain."""

from collections.abc import Iterator

from assess.hazard import FAR
from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.motion.ground_scenarios import FAR_CAUTION
from assess.portfolio.city_totals import CityView


def list_ground_cautions(view: CityView) -> Iterator[str]:
    """Yield what holds for the ground motion of all buildings, and how many are far from the sites of its scenarios."""
    common = view.ground.cautions if view.ground else ()
    for text in (_(caution) for caution in common if caution.template != FAR_CAUTION):  # counted below
        yield f"{text[:1].upper()}{text[1:]}."
    distances = view.buildings["ground_distance_km"].dropna().astype("float64")
    far = distances[distances > FAR / 1000]
    if len(far):
        yield ngettext(
            "{n:,} building is farther than {limit} km from the nearest site of the scenarios, {most} km: its ground "
            "motion is that of another place.",
            "{n:,} buildings are farther than {limit} km from the nearest site of the scenarios, {most} km at most: "
            "their ground motion is that of another place.",
            len(far), limit=number(FAR / 1000, "g"), most=number(float(far.max()), ".0f"),
        )  # fmt: skip
