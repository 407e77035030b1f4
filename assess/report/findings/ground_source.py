"""The ground motion in the words of reports: what it comes from, how strong and how rare it is."""

import math
from collections.abc import Iterator

import numpy as np

from assess.i18n import gettext as _
from assess.i18n import number
from assess.intensity import name_mmi
from assess.report import words
from assess.report.findings.assumed_intensity import say_factor, say_shaking, say_shaking_shortly, uses_scatter
from assess.results import Results, SiteGroundInfo
from assess.units import GRAVITY


def say_ground_source(results: Results) -> str:
    """Return on which map, scenarios or assumed intensity the ground motion rests, in a paragraph; "" for none."""
    found = results.provenance.site_ground
    if found is None:
        return say_shaking(results)
    texts = [_say_median(found), *_say_strength(found.pga_g, found.pgv_cm_s, results), *say_factor(results)]
    texts += [_say_scatter(found, results), *(f"{_(text)[:1].upper()}{_(text)[1:]}." for text in found.cautions)]
    return " ".join(texts)


def say_ground(results: Results, *, shortly: bool = False) -> str:
    """Return the same, and where it rests on none of these the peaks that are filled in or recorded; "" for none."""
    found = results.provenance.site_ground
    if not shortly or (found is None and results.provenance.shaking is None):
        return say_ground_source(results) or " ".join(_say_given(results))
    if found is None:
        return say_shaking_shortly(results)
    return " ".join((_say_median(found), *_say_strength(found.pga_g, found.pgv_cm_s, results), *say_factor(results)))


def name_source(found: SiteGroundInfo) -> str:
    """Return what kind of ground motion it is, with its file, for a line."""
    file = words.cut(found.file, 60)
    return _("ShakeMap {file}", file=file) if found.kind == "shakemap" else _("scenarios {file}", file=file)


def say_dispersion(found: SiteGroundInfo) -> str:
    """Return what the dispersion of the motions is made of."""
    if not found.own_dispersion:
        return _("the standard deviation of ln {measure} at the building", measure=_name_measure(found))
    return _(
        "the root of {own}² + {sigma}²: Motion uncertainty, and the standard deviation of ln {measure} at the building",
        own=number(found.own_dispersion, ".3g"), sigma=number(found.dispersion, ".3g"), measure=_name_measure(found),
    )  # fmt: skip


def _name_measure(found: SiteGroundInfo) -> str:
    return "PGA" if found.pgv_cm_s is None else "PGV"


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


def _say_given(results: Results) -> Iterator[str]:
    """Yield the peaks of the ground by a record of it, or as the workbook gives them."""
    at_grade = {one.floor for one in results.floor_rows if one.elevation_m is not None and one.elevation_m <= 0}
    own = [one for one in results.motions if one.floor in at_grade and one.source == "record"]
    building, assumed = results.building, any(one.source != "record" for one in results.motions)
    pgv: float | None
    if own:
        pga_g, pgv = max(one.pfa_g for one in own), max(one.pfv_cm_s or 0.0 for one in own)
    elif building.known_pga is None:
        return
    else:
        pga_g, pgv = building.known_pga / GRAVITY, None if building.ground_pgv is None else 100 * building.ground_pgv
    values = {"pga": words.in_g(pga_g), "pgv": words.fixed(pgv, 1)}
    if own:
        yield _("Ground motion: recorded, with a PGA of {pga} g and a PGV of {pgv} cm/s.", **values)
    elif pgv is not None:
        yield _("Ground motion: PGA {pga} g and PGV {pgv} cm/s as filled in.", **values)
    elif assumed:
        yield _("Ground motion: PGA {pga} g as filled in, taken as from an earthquake of magnitude 6.5 to 7.5.",
                **values)  # fmt: skip
    else:
        yield _("Ground motion: PGA {pga} g as filled in.", **values)
    yield from _say_strength(pga_g, pgv, results)
    yield from () if own else say_factor(results)


def _say_strength(pga_g: float, pgv_cm_s: float | None, results: Results) -> Iterator[str]:
    """Yield how strong such a ground motion is as an intensity, and how rare where there is a hazard curve."""
    intensity = name_mmi(pga_g * GRAVITY, None if pgv_cm_s is None else pgv_cm_s / 100)
    by = "PGA" if pgv_cm_s is None else "PGV"
    if intensity:
        yield _("By its {peak} that is about {intensity} (Worden et al. 2012).", peak=by, intensity=_(intensity))
    else:
        yield _("By its {peak} that is weaker than MMI IV (Worden et al. 2012).", peak=by)
    curve = results.annual
    if curve and curve.curve_pga_g and curve.curve_pga_g[0] <= pga_g <= curve.curve_pga_g[-1]:
        rate = math.exp(np.interp(math.log(pga_g), np.log(curve.curve_pga_g), np.log(curve.curve_rate)))
        yield _("Its PGA is exceeded about once in {years:,.0f} years, by the hazard curve.", years=1 / rate)


def _say_scatter(found: SiteGroundInfo, results: Results) -> str:
    values = {
        "sigma": number(found.dispersion, ".3g"), "source": _(found.dispersion_source), "measure": _name_measure(found),
    }  # fmt: skip
    if uses_scatter(results) and not found.own_dispersion:
        return _("The standard deviation of ln {measure} there is {sigma} ({source}), which is drawn.", **values)
    if uses_scatter(results):
        return _(
            "The standard deviation of ln {measure} there is {sigma} ({source}); with {own}, Motion uncertainty, the "
            "dispersion of the motions is {motion}, the root of the sum of their squares.",
            own=number(found.own_dispersion, ".3g"),
            motion=number(results.provenance.uncertainty.motion, ".3g"), **values,
        )  # fmt: skip
    return _(
        "The standard deviation of ln {measure} there is {sigma} ({source}); the chances hold for the median alone and "
        "leave it out.", **values,
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
        text = _("{values}; for information: the motion of the floors follows from PGA and PGV", values=values)
        lines.append((_("Spectral acceleration at the building, 5 %"), text))
    if found.shared is not None:
        share = _("{share} % of the variance of ln {measure}", share=words.fixed(100 * found.shared, 0),
                  measure=_name_measure(found))  # fmt: skip
        lines.append((_("Common to all places of the earthquake"), share))
    return lines
