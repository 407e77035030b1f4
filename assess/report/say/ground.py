"""What is said of the motion of the ground and the floors: where it comes from, how strong it is, what to beware of."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from assess.i18n import fill, ngettext, number
from assess.i18n import gettext as _
from assess.intensity import RATIO, name_mmi
from assess.model import AXES
from assess.report import words
from assess.results import (
    MAY_BE_LOWER,
    MOTION_FLAGS,
    AssumedShaking,
    FloorRow,
    MotionRow,
    ProfileInfo,
    Results,
    SiteGroundInfo,
    SuiteInfo,
)
from assess.units import GRAVITY
from assess.workbook.schema import BUILDING

ENVELOPES = fill(
    "Profiles of building codes are design envelopes, not expected values: they mostly lie above what is recorded, but "
    "not at mid-height of tall buildings: ASCE 7-22 gives 0.148 g at z/h 0.55 of 575 Market Street, where 0.165 and "
    "0.223 g were recorded. As long as T1 is unknown, the profiles of EN 1998-1 and NTC 2018 for rigid pieces are the "
    "lowest of the four; a long T1 lowers that of ASCE 7-22."
)
"""The caution that goes with a code's profile."""
DRAWN = fill(
    "assumed: drawn earthquakes through drawn buildings, beams that bend and shear with eight modes of 5 % damping "
    "(Miranda and Taghavi 2005), on ground motions with the spectrum of Newmark and Hall (1982)"
)
"""What is assumed of floors without a record."""
MOST_ELASTIC = 1.0
"""PFA [g] above which a floor of a drawn building is said to hold if the building stays elastic."""
MOST_PLACES = 20
"""Floors and axes of a source that are named."""

_OWN = {
    "one_axis_only": MOTION_FLAGS["one_axis_only"],
    "assumed_shaking": fill("assumed shaking"),
    "shakemap": fill("ShakeMap"),
    "scenarios": fill("scenarios"),
    "assumed_elevation": fill("assumed elevation"),
    "unknown_height": fill("height unknown"),
    "unknown_building": fill("building unknown"),
    "beyond_table": fill("beyond the table"),
}
_CARRIED = _OWN | {"one_axis_only": fill("one axis only")}
"""Flags next to a source: of the floor itself, and of a neighbouring floor."""


def describe_source(motion: MotionRow) -> str:
    """Return the source of a motion, with its flags."""
    source = _("recorded motion")
    if motion.profile:
        source = _("design profile of {code}", code=motion.profile.key)
    elif motion.between:
        source = _describe_between(motion)
    elif motion.source == "beam":
        source = _("drawn buildings on the ground motion")
        if motion.pfa_g > MOST_ELASTIC:
            source = _("{source}, if the building stays elastic", source=source)
    elif motion.source == "given":
        source = _("given PFA") if motion.pfv_follows else _("given PFA and PFV")
    texts = _CARRIED if motion.between else _OWN
    flags = [_(texts[flag]) for flag in motion.flags if flag in texts]
    return source + (f" ({'; '.join(flags)})" if flags else "")


def _describe_between(motion: MotionRow) -> str:
    lower, upper = (words.cut(name, 40) for name in motion.between)
    if motion.is_level:
        return _("the same as floor {floor}, at the same height", floor=lower)
    return _("interpolated between floors {lower} and {upper}", lower=lower, upper=upper)


def describe_origin(motion: MotionRow) -> str:
    """Return the record of a motion, or how the motion was computed."""
    if motion.profile and motion.height_ratio is not None and motion.amplification is not None:
        return _(
            "{code}, {clause}: {factors} of ground PGA {pga} g",
            code=motion.profile.key, clause=_with_status(motion.clause, motion.profile), factors=factors(motion),
            pga=words.in_g(motion.pfa_g / motion.amplification),
        )  # fmt: skip
    if motion.source == "beam":
        values = {"place": words.fixed(motion.height_ratio, 3), "factor": words.fixed(motion.amplification, 3)}
        return _("{ground}: z/h {place}, PFA over the ground's {factor}", ground=_(motion.label), **values)
    if motion.is_level:
        return _describe_between(motion)
    if motion.between:
        return _("linear over elevation, PFA and PFV each: {source}", source=_describe_between(motion))
    if not motion.has_record:
        return words.DASH
    azimuth = "" if motion.azimuth_deg is None else f", {number(motion.azimuth_deg, 'g')}°"
    return f"{words.cut(motion.record, 60)}: {words.cut(motion.station, 60)}{azimuth}"


def say_signs(results: Results) -> str:
    """Return what the motions of a draw have in common from floor to floor."""
    floors = _signed_floors(results)
    if not floors:
        return _(
            "The motions of a draw have the same random phases on all floors along an axis; the signs of modes from "
            "floor to floor are not known. What falls together on several floors is therefore an estimate."
        )
    return _(
        "The motions of a draw have the same random phases on all floors along an axis. Between floors that have "
        "records of one earthquake on one clock ({floors}), the sign of each octave is that of the records. Elsewhere "
        "the signs of modes are not known, and what falls together on several floors is an estimate.",
        floors=words.name_first(floors, MOST_PLACES),
    )


def _signed_floors(results: Results) -> list[str]:
    """Return the floors and axes whose signs are known, along each axis where that is of two floors at least."""
    found = []
    for axis in AXES:
        motions = [one for one in results.motions if one.axis == axis and one.ensemble and one.ensemble.signs]
        floors = list(dict.fromkeys(words.cut(one.floor, 20) for one in motions))
        found += [f"{floor} {axis}" for floor in floors] if len(floors) > 1 else []
    return found


def factors(motion: MotionRow) -> str:
    """Return the relative height of a floor and the amplification of a code's profile there."""
    ratio, amplification = words.fixed(motion.height_ratio, 3), words.fixed(motion.amplification, 3)
    return _("z/h {ratio}, amplification {amplification}", ratio=ratio, amplification=amplification)


def describe_treatment(motion: MotionRow) -> str:
    """Return what was done to a record."""
    if not motion.has_record:
        return ""
    return "; ".join(_(part).rstrip(".") for part in (motion.treatment, *motion.notes)) + "."


def list_sources(motions: Iterable[MotionRow]) -> list[str]:
    """Return the floors and axes of each source."""
    kinds: dict[str, dict[str, None]] = {}
    for motion in motions:
        kinds.setdefault(describe_source(motion), {})[f"{words.cut(motion.floor, 20)} {motion.axis}"] = None
    return [f"{source}: {words.name_first(list(places), MOST_PLACES)}" for source, places in kinds.items()]


def list_floors(motions: Iterable[MotionRow], source: str) -> list[str]:
    """Return the names of the floors with a source along any axis."""
    return list(dict.fromkeys(one.floor for one in motions if one.source == source))


def describe_suite(results: Results) -> str:
    """Return the user's own motions: their number, folder and names, and whether they are scaled."""
    suite = results.provenance.suite
    if suite is None:
        return _("no motions of the user's own")
    return ngettext(
        "{n:,} motion of the folder {folder}, {scaled}: {names}",
        "{n:,} motions of the folder {folder}, {scaled}: {names}",
        len(suite),
        folder=words.cut(suite.folder, 60),
        scaled=_("scaled to each floor's PFA") if suite.is_scaled else _("as they are, not scaled"),
        names=words.clip(", ".join(words.cut(name, 60) for name in suite.names), 400),
    )


# ---------------------------------------------------------------- codes' profiles


def used_profiles(results: Results) -> list[ProfileInfo]:
    """Return the codes' profiles that serve a floor."""
    used = {one.profile.key for one in results.motions if one.profile}
    return [profile for profile in results.provenance.profiles if profile.key in used]


def with_status(profile: ProfileInfo) -> str:
    """Return the name of a profile, and that it was not checked against its source where that is so."""
    return _with_status(profile.key, profile)


def _with_status(text: str, profile: ProfileInfo) -> str:
    return text if profile.verified else f"{text} ({_(profile.status)})"


def list_clauses(profile: ProfileInfo) -> str:
    """Return every clause of a profile, and when each applies."""
    if not profile.clause_without_period:
        return profile.clause
    return _("{known} (T1 known); {unknown} (T1 unknown)", known=profile.clause, unknown=profile.clause_without_period)


def profile_status(profile: ProfileInfo) -> str:
    """Return whether a profile was checked against its source, and what was left out of it."""
    status = _(profile.status)
    return f"{status[0].upper()}{status[1:]}. {_(profile.remark)}"


def list_assumed_motions(results: Results) -> list[tuple[str, str]]:
    """Return the assumptions about the floors that a code's profile serves."""
    used, served = used_profiles(results), [one for one in results.motions if one.profile and one.amplification]
    if not used or not served:
        return []
    building, floors = results.building, ", ".join(list_floors(results.motions, "profile"))
    chosen = _("design profile of {code}, the scenario", code=with_status(used[0]))
    is_from_sds = building.ground_pga is None and building.sds is not None
    pga = served[0].pfa_g / (served[0].amplification or 1.0)
    source = _("0.4 SDS, as Ground PGA is blank") if is_from_sds else _("Ground PGA")
    if shaking := results.provenance.shaking:
        source = _("assumed: the median of {intensity}, as Ground PGA and SDS are blank", intensity=_(shaking.choice))
    if site := results.provenance.site_ground:
        source = _("{source} at the building, as the median", source=name_source(site))
    lines = [
        (_("Motion of floors {floors}", floors=words.clip(floors, 300)), chosen),
        (_("Ground motion of the profile"),
         _("{pga} g, {source}; it stands for 0.4 SDS and for αS", pga=words.in_g(pga), source=source)),
        (_("Roof height h of the profile"), _describe_roof(results)),
    ]  # fmt: skip
    return lines + (_list_reduction(results) if any(profile.reduced for profile in used) else [])


def list_drawn_assumptions(results: Results) -> list[tuple[str, str]]:
    """Return what is assumed of the ground motion and of the building where floors have no record."""
    made = [one for one in results.motions if one.ensemble is not None and one.ensemble.assumed_motion]
    floors = ", ".join(
        dict.fromkeys(one.floor for one in [*made, *results.motions] if one in made or one.source == "beam")
    )
    if not floors:
        return []
    building, origin = results.building, results.provenance
    ratio = _("as filled in")
    if building.ground_pgv is None:
        ratio = _(
            "drawn: median {ratio} cm/s per g, deviation of ln 0.40, as in earthquakes of magnitude 6.5 to 7.5",
            ratio=number(100 * RATIO * GRAVITY, ".0f"),
        )
        if origin.shaking or (origin.site_ground and origin.site_ground.pgv_cm_s):
            ratio = _("as the source of the ground motion has it")
    period = _("1.4 times ASCE 7-22 Eq. 12.8-7 for the height of the roof, standard deviation of ln 0.35")
    if building.period is not None:
        period = _("{period} s, standard deviation of ln 0.10", period=number(building.period, "g"))
    elif any("unknown_building" in one.flags for one in results.motions):
        period = _("drawn from 0.15 to 3 s, as nothing is known of the building")
    return [
        (_("Motion of floors {floors}", floors=words.clip(floors, 300)), _(DRAWN)),
        (_("PGV over PGA of the ground"), ratio),
        (_("Period T1 of the drawn buildings"), period),
        (_("Structure of the drawn buildings"), _(building.structure or "unknown")),
    ]


def _describe_roof(results: Results) -> str:
    if results.building.height is not None:
        return _("{height} m, Height", height=words.in_m(results.building.height))
    highest = max((one.elevation_m for one in results.floor_rows if one.elevation_m is not None), default=0.0)
    if highest > 0:
        return _("{height} m, the highest floor, as Height is blank", height=words.in_m(highest))
    return _("{height} m, no floor above the ground, Height is blank", height=words.in_m(0.0))


def _list_reduction(results: Results) -> list[tuple[str, str]]:
    period, reduction = results.building.period, results.settings.ductility_reduction
    known = _("unknown: Eq. 13.3-5, which is never below Eq. 13.3-4")
    if period:
        known = f"{number(period, 'g')} s"
    factor = number(reduction, "g")
    if reduction == 1:
        factor = _("{factor}: no reduction for the building's ductility", factor=factor)
    return [(_("Period T1 in the profile"), known), (_("R_μ of ASCE 7-22"), factor)]


# ---------------------------------------------------------------- peaks of the ground

PEAKS = ("ground_pga", "sds")
"""Fields of the building that serve floors without a record, chances a year, and the code's force on anchors."""


def say_peak(results: Results, name: str, given: str) -> str:
    """Return a peak of the ground in words: as given, or what is used in its place, and why.

    Parameters
    ----------
    results : Results
        Of the run.
    name : str
        Field of the building, one of `PEAKS`.
    given : str
        Its value in the workbook, with its unit.
    """
    reason = _find_reason(results, name)
    if not reason:
        return given
    used = _find_used(results) if name == "ground_pga" else None
    of_anchors = name == ("sds" if results.building.sds is not None else "ground_pga")
    if used is None:
        if of_anchors:
            return _("{given}, used for the code's force on anchors only: {reason}", given=given, reason=reason)
        return _("{given} in the workbook, not used: {reason}", given=given, reason=reason)
    names = {"used": words.in_g(used.pfa_g), "floor": words.cut(used.floor, 20), "source": describe_source(used)}
    if of_anchors:
        return _(
            "{used} g on floor {floor}, {source}; {given} of the workbook is used for the code's force on anchors "
            "only: {reason}", **names, given=given, reason=reason,
        )  # fmt: skip
    return _("{used} g on floor {floor}, {source}; {given} of the workbook is not used: {reason}", **names, given=given,
             reason=reason)  # fmt: skip


def _find_reason(results: Results, name: str) -> str:
    """Return why no floor's motion follows a peak, "" where one does."""
    building = results.building
    if name == "ground_pga" and building.hazard:
        return ""
    if all(one.source == "record" or one.between for one in results.motions):
        return _("every floor has a record")
    levels = {one.floor: one.elevation_m for one in results.floor_rows}
    at_grade = [one for one in results.motions if (level := levels.get(one.floor)) is not None and level <= 0]
    if any(one.source in ("record", "given") for one in at_grade):
        return _("the motion at grade is known")
    if name == "sds" and building.ground_pga is not None:
        return _("Ground PGA is given")
    return ""


def _find_used(results: Results) -> MotionRow | None:
    """Return the strongest motion on the ground; of the same ones, that of the axis which it is known along."""
    levels = {one.floor: one.elevation_m for one in results.floor_rows}
    ground = [one for one in results.motions if levels.get(one.floor) == 0]
    return max(ground, key=lambda one: (one.pfa_g, not one.is_borrowed), default=None)


# ---------------------------------------------------------------- the ground motion


def say_ground_source(results: Results) -> str:
    """Return on which map, scenarios or assumed intensity the ground motion rests, in a paragraph; "" for none."""
    found = results.provenance.site_ground
    if found is None:
        return say_shaking(results)
    texts = [_say_median(found), *_say_strength(found.pga_g, found.pgv_cm_s, results), *say_factor(results)]
    texts += [_say_scatter_of_map(found, results), *(f"{_(text)[:1].upper()}{_(text)[1:]}." for text in found.cautions)]
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


def _say_scatter_of_map(found: SiteGroundInfo, results: Results) -> str:
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


def list_assumed_ground(results: Results) -> list[tuple[str, str]]:
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


# ---------------------------------------------------------------- assumed shaking


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
    yield _say_scatter_of_intensity(found, results)


def say_factor(results: Results) -> Iterator[str]:
    """Yield by which factor the settings multiply the medians, where they do."""
    if results.settings.scale != 1:
        factor = number(results.settings.scale, "g")
        yield _("The results are for these medians times {factor}.", factor=factor)


def _say_scatter_of_intensity(found: AssumedShaking, results: Results) -> str:
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


def list_assumed_shaking(results: Results) -> list[tuple[str, str]]:
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


# ---------------------------------------------------------------- cautions

UNLIKE = 0.10
"""Difference between the median PFA of the user's own motions and the PFA of a floor above which it is reported [-]."""
MOST_WARNINGS = 5
"""Warnings that are given in full."""
MOST_TIMES = 8
"""Floors and axes that a sentence names."""
MOST_FLOORS, LONGEST_FLOOR = 6, 10
"""Floors that a short caution names, and the characters of each."""


@dataclass(frozen=True, slots=True)
class Caution:
    """A caution: the whole `text`, and `short`, what a summary has room for."""

    text: str
    short: str


def build_cautions(results: Results) -> list[Caution]:
    """Return what a reader must know about the floors' motion before trusting a class."""
    cautions = [*_profiled(results), *_interpolated(results.motions), *_underestimates(results)]
    if len({motion.source for motion in results.motions}) > 1:
        text = _("The floors' motion comes from mixed sources: compare floors with care.")
        cautions.append(Caution(text, text))
    if results.has_simulated:
        suite = results.provenance.suite
        cautions += _generic(results) if suite is None else _own_motions(results, suite)
    return cautions


def _profiled(results: Results) -> Iterator[Caution]:
    floors = list_floors(results.motions, "profile")
    if floors:
        names = ", ".join(map(with_status, used_profiles(results)))
        text = _("{floors}: the motion is that of {profile}.", floors=_name(floors), profile=names)
        short = _("{floors}: the motion is a code's design profile, an envelope.", floors=_name_some(floors))
        yield Caution(f"{text} {_(ENVELOPES)}", short)


def _interpolated(motions: Sequence[MotionRow]) -> Iterator[Caution]:
    """Name the floors that are interpolated, and those with the motion of another floor at their height."""
    between = list(dict.fromkeys(one.floor for one in motions if one.between and not one.is_level))
    level = list(dict.fromkeys(one.floor for one in motions if one.is_level))
    if between:
        text = _(
            "{floors}: no motion is known there; it is interpolated between the floors above and below. This "
            "{caution}.",
            floors=_name(between), caution=MAY_BE_LOWER,
        )  # fmt: skip
        short = _("{floors}: interpolated between floors; it may be lower than the truth.", floors=_name_some(between))
        yield Caution(text, short)
    if level:
        text = _("{floors}: no motion is known there; it is that of a known floor at the same height.",
                 floors=_name(level))  # fmt: skip
        yield Caution(text, _("{floors}: the same as a known floor at the same height.", floors=_name_some(level)))


def _underestimates(results: Results) -> Iterator[Caution]:
    """Give the first warnings that more shaking is known than is used, and the number of the others."""
    warnings = list(dict.fromkeys(map(_, results.underestimates)))
    short = ngettext(
        "More is known than is used: {n:,} warning, see the data-quality log.",
        "More is known than is used: {n:,} warnings, see the data-quality log.",
        len(warnings),
    )
    for warning in warnings[:MOST_WARNINGS]:
        yield Caution(_("More is known than is used: {warning}", warning=words.clip(warning, 400)), short)
    if len(warnings) > MOST_WARNINGS:
        text = ngettext(
            "More is known than is used: {n:,} further warning of this kind, see the data-quality log.",
            "More is known than is used: {n:,} further warnings of this kind, see the data-quality log.",
            len(warnings) - MOST_WARNINGS,
        )
        yield Caution(text, short)


def list_narrowing(results: Results) -> list[str]:
    """Return what would narrow the chances on assumed motion, the most useful first; nothing where there is none."""
    building, motions = results.building, results.motions
    assumed = [one for one in motions if one.ensemble is not None and one.ensemble.assumed_motion]
    if not assumed:
        return []
    at_grade = {one.source for one in motions if one.height_ratio == 0}
    if all(one.source == "given" and not one.pfv_follows for one in assumed):  # met in every draw, whatever the ground
        ways, is_ground_known = [_("records of the floors")], True
    else:
        ways = [] if "record" in at_grade else [_("a record of the ground on a floor of Elevation 0")]
        is_ground_known = not at_grade.isdisjoint(("record", "given"))
    known = {"ground_pgv": is_ground_known, "storeys": building.height or building.period}
    for name in ("ground_pgv", "storeys", "period", "structure"):
        if not (getattr(building, name) or known.get(name)):
            ways.append(_(BUILDING.column(name).label))
    return ways


def _generic(results: Results) -> Iterator[Caution]:
    """Name the floors whose pieces were simulated under assumed motions, and those with weaker ones."""
    made = [(one.floor, one.ensemble) for one in results.motions if one.ensemble is not None]
    unknown = list(dict.fromkeys(floor for floor, one in made if one.unknown_building))
    assumed = list(dict.fromkeys(floor for floor, one in made if one.assumed_motion and not one.unknown_building))
    weak = list(dict.fromkeys(floor for floor, one in made if one.weak_motions))
    if unknown:
        text = _("{floors}: assumed motion, and neither T1, Height, Storeys nor an Elevation is known; buildings of "
                 "every period were drawn, and no class is confirmed.", floors=_name(unknown))  # fmt: skip
        short = _("{floors}: assumed motion, nothing known of the building; no class is confirmed.",
                  floors=_name_some(unknown))  # fmt: skip
        yield Caution(text, short)
    if assumed:
        text = _("{floors}: assumed motion: earthquakes with the known peaks of the ground and buildings of about this "
                 "period were drawn.", floors=_name(assumed))  # fmt: skip
        if ways := list_narrowing(results):
            text += " " + _("What would narrow it: {ways}.", ways=", ".join(ways))
        yield Caution(text, _("{floors}: assumed motion (ground and building drawn).", floors=_name_some(assumed)))
    if weak:
        text = _("{floors}: the generated motions have a smaller PFV than the floor's; simulation may raise a class "
                 "there, never lower it.", floors=_name(weak))  # fmt: skip
        short = _("{floors}: weaker motions than the floor's; simulation may raise a class there, never lower it.",
                  floors=_name_some(weak))  # fmt: skip
        yield Caution(text, short)


def _own_motions(results: Results, suite: SuiteInfo) -> Iterator[Caution]:
    """Say that pieces were simulated under the user's own motions, and where these differ from the floor's."""
    text = _("Simulation uses {motions}.", motions=describe_suite(results))
    yield Caution(text, _("Simulation uses the user's own motions."))
    median = suite.median_pfa_g
    off = {one: median / one.pfa_g - 1 for one in results.motions if one.ensemble and one.pfa_g > 0}
    places = [_off(motion, ratio) for motion, ratio in off.items() if abs(ratio) > UNLIKE]
    if places and not suite.is_scaled:
        text = _(
            "The median PFA of these motions, {pfa} g, differs from that of {places}. Where it is below, chances come "
            "out too low; they lower no class.",
            pfa=words.in_g(median), places=words.name_first(places, MOST_TIMES, "; "),
        )  # fmt: skip
        short = _("The user's own motions are not as strong as the floors': where weaker, chances come out too low.")
        yield Caution(text, short)


def _off(motion: MotionRow, ratio: float) -> str:
    """Return by how much the user's own motions are above or below a floor's."""
    place = {"floor": words.cut(motion.floor, 20), "axis": motion.axis, "pfa": words.in_g(motion.pfa_g)}
    if ratio > 0:
        return _("floor {floor} {axis} ({pfa} g), {off:.0f} % above", **place, off=100 * ratio)
    return _("floor {floor} {axis} ({pfa} g), {off:.0f} % below", **place, off=-100 * ratio)


def _name(floors: Sequence[str]) -> str:
    return words.clip(ngettext("Floor {floors}", "Floors {floors}", len(floors), floors=", ".join(floors)), 300)


def _name_some(floors: Sequence[str]) -> str:
    named = words.name_first([words.cut(floor, LONGEST_FLOOR) for floor in floors], MOST_FLOORS)
    return ngettext("Floor {floors}", "Floors {floors}", len(floors), floors=named)


# ---------------------------------------------------------------- a floor in two lines

SOURCES = 3
"""Sources that a line names."""


def say_motions(floor: FloorRow, motions: Sequence[MotionRow]) -> str:
    """Return the motion of a floor: elevation, peaks along both axes, and where they come from."""
    peaks = [
        *(_say_peak(axis, [one for one in motions if one.axis == axis]) for axis in AXES),
        *(_say_speed(axis, [one for one in motions if one.axis == axis]) for axis in AXES),
    ]
    sources = list(dict.fromkeys(map(describe_source, motions)))
    parts = ["; ".join(text for text in peaks if text), words.name_first(sources, SOURCES, "; ")]
    text = ": ".join(part for part in parts if part)
    if floor.elevation_m is None:
        return f"{text}."
    return _("{elevation} m above ground. {motion}.", elevation=words.in_m(floor.elevation_m), motion=text)


def _say_peak(axis: str, motions: Sequence[MotionRow]) -> str:
    if not motions:
        return ""
    largest = max(one.pfa_g for one in motions)
    text = _("PFA {axis} {pfa} g", axis=axis, pfa=words.in_g(largest))
    if len({one.pfa_g for one in motions}) < 2:
        return text
    return _("{peak} (the largest of {n})", peak=text, n=len(motions))


def _say_speed(axis: str, motions: Sequence[MotionRow]) -> str:
    known = [one.pfv_cm_s for one in motions if one.pfv_cm_s is not None]
    return _("PFV {axis} {pfv} cm/s", axis=axis, pfv=words.in_cm_s(max(known))) if known else ""
