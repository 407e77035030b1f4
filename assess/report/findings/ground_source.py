"""The ground motion of a ShakeMap or of computed scenarios, in the words of reports."""

from collections.abc import Iterator

from assess.i18n import gettext as _
from assess.i18n import number
from assess.report import words
from assess.report.findings.assumed_intensity import say_factor, say_shaking, say_shaking_shortly, uses_scatter
from assess.results import Results, SiteGroundInfo


def say_ground_source(results: Results) -> str:
    """Return on which map, scenarios or assumed intensity the ground motion rests, in a paragraph; "" for none."""
    found = results.provenance.site_ground
    return say_shaking(results) if found is None else " ".join(_say(found, results))


def say_ground_source_shortly(results: Results) -> str:
    """Return the same in a sentence; "" where it rests on none of these."""
    found = results.provenance.site_ground
    if found is None:
        return say_shaking_shortly(results)
    return " ".join((_say_median(found), *say_factor(results)))


def name_source(found: SiteGroundInfo) -> str:
    """Return what kind of ground motion it is, with its file, for a line."""
    file = words.cut(found.file, 60)
    return _("ShakeMap {file}", file=file) if found.kind == "shakemap" else _("scenarios {file}", file=file)


def say_dispersion(found: SiteGroundInfo) -> str:
    """Return what the dispersion of the motions is made of."""
    return _(
        "the root of {own}² + {sigma}²: Motion uncertainty, and the standard deviation of ln PGA at the building",
        own=number(found.own_dispersion, ".3g"), sigma=number(found.dispersion, ".3g"),
    )  # fmt: skip


def _say(found: SiteGroundInfo, results: Results) -> Iterator[str]:
    yield _say_median(found)
    yield from say_factor(results)
    yield _say_scatter(found, results)
    yield _("Over the height the motion follows the design profile of {code}.", code=found.profile)
    yield from (f"{_(text)[:1].upper()}{_(text)[1:]}." for text in found.cautions)


def _say_median(found: SiteGroundInfo) -> str:
    source = name_source(found)
    if found.kind == "shakemap" and found.facts:
        event = words.cut(_(found.facts[0].value), 120)
        source = _("{source} of the earthquake {event}", source=source, event=event)
    values = {"source": source, "pga": words.in_g(found.pga_g)}
    if found.pgv_cm_s is None:
        return _("Ground motion: {source}, with a median PGA of {pga} g at the building.", **values)
    return _(
        "Ground motion: {source}, with a median PGA of {pga} g and PGV of {pgv} cm/s at the building.",
        pgv=words.fixed(found.pgv_cm_s, 1), **values,
    )  # fmt: skip


def _say_scatter(found: SiteGroundInfo, results: Results) -> str:
    values = {"sigma": number(found.dispersion, ".3g"), "source": _(found.dispersion_source)}
    if uses_scatter(results):
        return _(
            "The standard deviation of ln PGA there is {sigma} ({source}); with {own} of the building's own motion the "
            "dispersion of the motions is {motion}, the root of the sum of their squares.",
            own=number(found.own_dispersion, ".3g"),
            motion=number(results.provenance.uncertainty.motion, ".3g"), **values,
        )  # fmt: skip
    return _(
        "The standard deviation of ln PGA there is {sigma} ({source}); the chances hold for the median alone and leave "
        "it out.", **values,
    )  # fmt: skip


def list_assumptions(results: Results) -> list[tuple[str, str]]:
    """Return what the ground motion of a ShakeMap or of scenarios rests on."""
    found = results.provenance.site_ground
    if found is None:
        return []
    lines = [(_("Ground motion"), say_ground_source(results))]
    lines.append((_("File of the ground motion"), _("{file}, SHA-256 {sha256}", file=found.file, sha256=found.sha256)))
    lines += [(_(one.label), _(one.value)) for one in found.facts]
    if found.psa:
        values = ", ".join(
            _("{psa} g at {period} s", psa=words.in_g(one.psa_g), period=number(one.period_s, "g"))
            for one in found.psa
        )  # fmt: skip
        text = _("{values}; for information: the motion of the floors follows from PGA", values=values)
        lines.append((_("Spectral acceleration at the building, 5 %"), text))
    if found.shared is not None:
        share = _("{share} % of the variance of ln PGA", share=words.fixed(100 * found.shared, 0))
        lines.append((_("Common to all places of the earthquake"), share))
    return lines
