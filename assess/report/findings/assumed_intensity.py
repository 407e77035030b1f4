"""Assumed shaking, in the words of reports: the intensity, what it stands for, whose relations say so."""

from collections.abc import Iterator

from assess.i18n import gettext as _
from assess.i18n import number
from assess.report import words
from assess.results import AssumedShaking, Results


def say_shaking(results: Results) -> str:
    """Return that the shaking is assumed, with all it rests on, in a paragraph; "" where it is not."""
    found = results.provenance.shaking
    return "" if found is None else " ".join(_say(found, results))


def say_shaking_shortly(results: Results) -> str:
    """Return the same in a sentence; "" where no shaking is assumed."""
    found = results.provenance.shaking
    if found is None:
        return ""
    values = {
        "intensity": _(found.choice), "pga": words.in_g(found.pga_g), "pgv": words.fixed(found.pgv_cm_s, 1),
        "sources": ", ".join(found.sources), "scatter": number(found.scatter, "g"),
    }  # fmt: skip
    if uses_scatter(results):
        text = _(
            "Assumed shaking: {intensity}, by its median PGV of {pgv} cm/s and PGA of {pga} g, scatter of ln PGV "
            "{scatter} ({sources}).",
            **values,
        )
    else:
        text = _(
            "Assumed shaking: {intensity}, by its median PGV of {pgv} cm/s and PGA of {pga} g ({sources}); scatter is "
            "not in the results.",
            **values,
        )
    return " ".join((text, *say_factor(results)))


def uses_scatter(results: Results) -> bool:
    """Return whether motions are drawn with the scatter of the intensity: the formulas take the median alone."""
    return results.has_simulated and not results.settings.ideal


def _say(found: AssumedShaking, results: Results) -> Iterator[str]:
    yield _(
        "Assumed shaking: no motion of the ground is known for this building. {intensity} is assumed, with its "
        "median PGV of {pgv} cm/s and PGA of {pga} g ({sources}).",
        intensity=_(found.choice), pga=words.in_g(found.pga_g), pgv=words.fixed(found.pgv_cm_s, 1),
        sources=", ".join(found.sources),
    )  # fmt: skip
    yield from say_factor(results)
    yield _say_scatter(found, results)


def say_factor(results: Results) -> Iterator[str]:
    """Yield by which factor the settings multiply the medians, where they do."""
    if results.settings.scale != 1:
        factor = number(results.settings.scale, "g")
        yield _("The results are for these medians times {factor}.", factor=factor)


def _say_scatter(found: AssumedShaking, results: Results) -> str:
    scatter = number(found.scatter, "g")
    if uses_scatter(results):
        return _(
            "PGV scatters about this median by {scatter} (standard deviation of ln PGV), which is drawn.",
            scatter=scatter,
        )
    if results.has_simulated:
        return _(
            "PGV scatters about this median by {scatter} (standard deviation of ln PGV); the simulation leaves this "
            "scatter out: its chances hold for the median alone.",
            scatter=scatter,
        )
    return _(
        "PGV scatters about this median by {scatter} (standard deviation of ln PGV). The formula takes the median; the "
        "scatter is not in it.",
        scatter=scatter,
    )


def list_assumptions(results: Results) -> list[tuple[str, str]]:
    """Return what an assumed intensity rests on."""
    found = results.provenance.shaking
    if found is None:
        return []
    lines = [(_("Shaking"), say_shaking(results))]
    if found.is_derived:
        text = _(
            "from PGV by the ratio that is drawn, as no published relation of the JMA class to PGA was found; the "
            "scatter is that of PGV, with the width of the class"
        )
        lines.append((_("PGA of the assumed shaking"), text))
    if found.is_open:
        text = _(
            "open above: taken as {intensity}, the middle of a class of one whole degree; the ground can shake more",
            intensity=number(found.intensity, "g"),
        )
        lines.append((_("Class of the assumed shaking"), text))
    return lines
