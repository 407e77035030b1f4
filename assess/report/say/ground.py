"""What is said of the motion of the ground and the floors: where it comes from, how strong it is, what to beware of."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from assess.i18n import fill, gettext as _, ngettext, number
from assess.intensity import RATIO, Shaking, name_mmi
from assess.model import AXES
from assess.report import measures, words
from assess.results import MAY_BE_LOWER, MOTION_FLAGS, FloorRow, MotionRow, Results, SuiteInfo
from assess.units import GRAVITY
from assess.workbook.schema import BUILDING

if TYPE_CHECKING:
    from assess.motion.scenario import Profile
    from assess.motion.site_ground import SiteGround

ENVELOPES = fill("Profiles of building codes are design envelopes, not expected values: they mostly lie above what is "
                 "recorded, but not at mid-height of tall buildings: ASCE 7-22 gives 0.148 g at z/h 0.55 of 575 Market "
                 "Street, where 0.165 and 0.223 g were recorded. As long as T1 is unknown, the profiles of EN 1998-1 "
                 "and NTC 2018 for rigid pieces are the lowest of the four; a long T1 lowers that of ASCE "
                 "7-22.")  # fmt: skip
"""The caution that goes with a code's profile."""
DRAWN = fill("assumed: drawn earthquakes through drawn buildings, beams that bend and shear with eight modes of 5 % "
             "damping (Miranda and Taghavi 2005), on ground motions with the spectrum of Newmark and Hall "
             "(1982)")  # fmt: skip
"""What is assumed of floors without a record."""

MOST_PLACES = 20
"""Floors and axes of a source that are named."""

_FLAGS = {
    "one_axis_only": MOTION_FLAGS["one_axis_only"],
    "assumed_shaking": fill("assumed shaking"),
    "shakemap": fill("ShakeMap"),
    "scenarios": fill("scenarios"),
    "assumed_elevation": fill("assumed elevation"),
    "unknown_height": fill("height unknown"),
    "unknown_building": fill("building unknown"),
    "beyond_table": fill("beyond the table"),
}
"""Flags next to a source."""


def describe_source(motion: MotionRow) -> str:
    """Return the source of a motion, with its flags."""
    source = _("recorded motion")
    if motion.profile:
        source = _("design profile of {code}", code=motion.profile.key)
    elif motion.between:
        source = _describe_between(motion)
    elif motion.source == "beam":
        source = _("drawn buildings on the ground motion")
        if motion.pfa_g > 1.0:
            source = _("{source}, if the building stays elastic", source=source)
    elif motion.source == "given":
        source = _("given PFA") if motion.pfv_follows else _("given PFA and PFV")
    texts = _FLAGS | ({"one_axis_only": fill("one axis only")} if motion.between else {})  # of a neighbouring floor
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
        return _("{code}, {clause}: {factors} of ground PGA {pga} g", code=motion.profile.key,
                 clause=_with_status(motion.clause, motion.profile), factors=factors(motion),
                 pga=words.in_g(motion.pfa_g / motion.amplification))  # fmt: skip
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
    found = []
    for axis in AXES:
        motions = [one for one in results.motions if one.axis == axis and one.ensemble and one.ensemble.signs]
        floors = list(dict.fromkeys(words.cut(one.floor, 20) for one in motions))
        found += [f"{floor} {axis}" for floor in floors] if len(floors) > 1 else []
    if not found:
        return _("The motions of a draw have the same random phases on all floors along an axis; the signs of modes "
                 "from floor to floor are not known. What falls together on several floors is therefore an "
                 "estimate.")  # fmt: skip
    return _("The motions of a draw have the same random phases on all floors along an axis. Between floors that have "
             "records of one earthquake on one clock ({floors}), the sign of each octave is that of the records. "
             "Elsewhere the signs of modes are not known, and what falls together on several floors is an estimate.",
             floors=words.name_first(found, MOST_PLACES))  # fmt: skip


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


def describe_suite(results: Results) -> str:
    """Return the user's own motions: their number, folder and names, and whether they are scaled."""
    suite = results.provenance.suite
    if suite is None:
        return _("no motions of the user's own")
    return ngettext("{n:,} motion of the folder {folder}, {scaled}: {names}",
                    "{n:,} motions of the folder {folder}, {scaled}: {names}", len(suite),
                    folder=words.cut(suite.folder, 60),
                    scaled=_("scaled to each floor's PFA") if suite.is_scaled else _("as they are, not scaled"),
                    names=words.clip(", ".join(words.cut(name, 60) for name in suite.names), 400))  # fmt: skip


def used_profiles(results: Results) -> "list[Profile]":
    """Return the codes' profiles that serve a floor."""
    used = {one.profile.key for one in results.motions if one.profile}
    return [profile for profile in results.provenance.profiles if profile.key in used]


def _with_status(text: str, profile: "Profile") -> str:
    """Return a text on a profile, and that this was not checked against its source where that is so."""
    return text if profile.verified else f"{text} ({_(profile.status)})"


def list_clauses(profile: "Profile") -> str:
    """Return every clause of a profile, and when each applies."""
    if not profile.clause_without_period:
        return profile.clause
    return _("{known} (T1 known); {unknown} (T1 unknown)", known=profile.clause, unknown=profile.clause_without_period)


def profile_status(profile: "Profile") -> str:
    """Return whether a profile was checked against its source, and what was left out of it."""
    status = _(profile.status)
    return f"{status[0].upper()}{status[1:]}. {_(profile.remark)}"


def list_assumed(results: Results) -> list[tuple[str, str]]:
    """Return what the motion of the ground and the floors rests on, where it is assumed."""
    shaking, site, lines = results.provenance.shaking, results.provenance.site_ground, list[tuple[str, str]]()
    if shaking:
        lines.append((_("Shaking"), _say_shaking(shaking, results)))
    if shaking and shaking.is_derived:
        lines.append((_("PGA of the assumed shaking"), _(
            "from PGV by the ratio that is drawn, as no published relation of the JMA class to PGA was found; the "
            "scatter is that of PGV, with the width of the class"
        )))  # fmt: skip
    if shaking and shaking.is_open:
        lines.append((_("Class of the assumed shaking"), _(
            "open above: taken as {intensity}, the middle of a class of one whole degree; the ground can shake more",
            intensity=number(shaking.intensity, "g"),
        )))  # fmt: skip
    if site:
        lines += [
            (_("Ground motion"), say_ground_source(results)),
            (_("File of the ground motion"), _("{file}, SHA-256 {sha256}", file=site.file, sha256=site.sha256)),
            *((_(label), _(value)) for label, value in site.facts),
        ]
    if site and site.psa_g:
        values = ", ".join(
            _("{psa} g at {period} s", psa=words.in_g(psa), period=number(period, "g")) for period, psa in site.psa_g
        )
        text = _("{values}; for information: the motion of the floors follows from PGA and PGV", values=values)
        lines.append((_("Spectral acceleration at the building, 5 %"), text))
    if site and site.shared is not None:
        share = _("{share} % of the variance of ln {measure}", share=words.fixed(100 * site.shared, 0),
                  measure=site.measure)  # fmt: skip
        lines.append((_("Common to all places of the earthquake"), share))
    return [*lines, *_list_profiled(results), *_list_drawn(results)]


def _list_profiled(results: Results) -> list[tuple[str, str]]:
    used, served = used_profiles(results), [one for one in results.motions if one.profile and one.amplification]
    if not used or not served:
        return []
    building = results.building
    pga = served[0].pfa_g / (served[0].amplification or 1.0)
    is_from_sds = building.ground_pga is None and building.sds is not None
    source = _("0.4 SDS, as Ground PGA is blank") if is_from_sds else _("Ground PGA")
    if shaking := results.provenance.shaking:
        source = _("assumed: the median of {intensity}, as Ground PGA and SDS are blank", intensity=_(shaking.choice))
    if site := results.provenance.site_ground:
        source = _("{source} at the building, as the median", source=name_source(site))
    highest = max((one.elevation_m for one in results.floor_rows if one.elevation_m is not None), default=0.0)
    if building.height is not None:
        roof = _("{height}, Height", height=measures.say(building.height, "m"))
    elif highest > 0:
        roof = _("{height}, the highest floor, as Height is blank", height=measures.say(highest, "m"))
    else:
        roof = _("{height}, no floor above the ground, Height is blank", height=measures.say(0.0, "m"))
    lines = [
        (_name_served(one.floor for one in results.motions if one.source == "profile"),
         _("design profile of {code}, the scenario", code=_with_status(used[0].key, used[0]))),
        (_("Ground motion of the profile"),
         _("{pga} g, {source}; it stands for 0.4 SDS and for αS", pga=words.in_g(pga), source=source)),
        (_("Roof height h of the profile"), roof),
    ]  # fmt: skip
    if any(profile.reduced for profile in used):
        factor = number(results.settings.ductility_reduction, "g")
        if results.settings.ductility_reduction == 1:
            factor = _("{factor}: no reduction for the building's ductility", factor=factor)
        period = (f"{number(building.period, 'g')} s" if building.period
                  else _("unknown: Eq. 13.3-5, which is never below Eq. 13.3-4"))  # fmt: skip
        lines += [(_("Period T1 in the profile"), period), (_("R_μ of ASCE 7-22"), factor)]
    return lines


def _name_served(floors: Iterable[str]) -> str:
    return _("Motion of floors {floors}", floors=words.clip(", ".join(dict.fromkeys(floors)), 300))


def _list_drawn(results: Results) -> list[tuple[str, str]]:
    made = [one for one in results.motions if one.ensemble is not None and one.ensemble.assumed_motion]
    floors = [one.floor for one in [*made, *results.motions] if one in made or one.source == "beam"]
    if not floors:
        return []
    building, origin = results.building, results.provenance
    ratio = _("as filled in")
    if building.ground_pgv is None:
        ratio = _("drawn: median {ratio} per g, deviation of ln 0.40, as in earthquakes of magnitude 6.5 to 7.5",
                  ratio=measures.say(round(100 * RATIO * GRAVITY), "cm/s"))  # fmt: skip
        if origin.shaking or (origin.site_ground and origin.site_ground.pgv_cm_s):
            ratio = _("as the source of the ground motion has it")
    period = _("1.4 times ASCE 7-22 Eq. 12.8-7 for the height of the roof, standard deviation of ln 0.35")
    if building.period is not None:
        period = _("{period} s, standard deviation of ln 0.10", period=number(building.period, "g"))
    elif any("unknown_building" in one.flags for one in results.motions):
        period = _("drawn from 0.15 to 3 s, as nothing is known of the building")
    return [
        (_name_served(floors), _(DRAWN)),
        (_("PGV over PGA of the ground"), ratio),
        (_("Period T1 of the drawn buildings"), period),
        (_("Structure of the drawn buildings"), _(building.structure or "unknown")),
    ]


PEAKS = ("ground_pga", "sds")
"""Fields of the building that serve floors without a record, chances a year, and the code's force on anchors."""


def say_peak(results: Results, name: str, given: str) -> str:
    """Return a peak of the ground, one of `PEAKS`, in words: as `given` with its unit, or what is used, and why."""
    building, levels = results.building, {one.floor: one.elevation_m for one in results.floor_rows}
    at_grade = [one for one in results.motions if (level := levels.get(one.floor)) is not None and level <= 0]
    if name == "ground_pga" and building.hazard:
        return given
    if all(one.source == "record" or one.between for one in results.motions):
        reason = _("every floor has a record")
    elif any(one.source in ("record", "given") for one in at_grade):
        reason = _("the motion at grade is known")
    elif name == "sds" and building.ground_pga is not None:
        reason = _("Ground PGA is given")
    else:  # a floor's motion follows it
        return given
    ground = [one for one in results.motions if levels.get(one.floor) == 0 and name == "ground_pga"]
    used = max(ground, key=lambda one: (one.pfa_g, not one.is_borrowed), default=None)  # of the axis known along
    of_anchors = name == ("sds" if building.sds is not None else "ground_pga")
    if used is None:
        if of_anchors:
            return _("{given}, used for the code's force on anchors only: {reason}", given=given, reason=reason)
        return _("{given} in the workbook, not used: {reason}", given=given, reason=reason)
    names = {"used": words.in_g(used.pfa_g), "floor": words.cut(used.floor, 20), "source": describe_source(used)}
    if of_anchors:
        return _("{used} g on floor {floor}, {source}; {given} of the workbook is used for the code's force on anchors "
                 "only: {reason}", **names, given=given, reason=reason)  # fmt: skip
    return _("{used} g on floor {floor}, {source}; {given} of the workbook is not used: {reason}", **names, given=given,
             reason=reason)  # fmt: skip


# ---------------------------------------------------------------- the ground motion


def say_ground_source(results: Results) -> str:
    """Return on which map, scenarios or assumed intensity the ground motion rests, in a paragraph; "" for none."""
    found, shaking = results.provenance.site_ground, results.provenance.shaking
    if found is None:
        return _say_shaking(shaking, results) if shaking else ""
    values = {
        "sigma": number(found.dispersion, ".3g"), "source": _(found.dispersion_source), "measure": found.measure,
    }  # fmt: skip
    if not uses_scatter(results):
        scatter = _("The standard deviation of ln {measure} there is {sigma} ({source}); the chances hold for the "
                    "median alone and leave it out.", **values)  # fmt: skip
    elif own := results.building.own_dispersion:
        scatter = _("The standard deviation of ln {measure} there is {sigma} ({source}); with {own}, Motion "
                    "uncertainty, the dispersion of the motions is {motion}, the root of the sum of their squares.",
                    own=number(own, ".3g"), motion=number(results.provenance.uncertainty.motion, ".3g"),
                    **values)  # fmt: skip
    else:
        scatter = _("The standard deviation of ln {measure} there is {sigma} ({source}), which is drawn.", **values)
    cautions = (f"{_(text)[:1].upper()}{_(text)[1:]}." for text in found.cautions)
    return " ".join((*_say_site(found, results), scatter, *cautions))


def say_ground(results: Results, *, shortly: bool = False) -> str:
    """Return the same, and where it rests on none of these the peaks that are filled in or recorded; "" for none."""
    found, shaking = results.provenance.site_ground, results.provenance.shaking
    if found is not None and shortly:
        return " ".join(_say_site(found, results))
    if shaking is not None and shortly:
        values = {
            "intensity": _(shaking.choice), "pga": words.in_g(shaking.pga_g),
            "pgv": measures.say(shaking.pgv_cm_s, "cm/s"), "sources": ", ".join(shaking.sources),
        }  # fmt: skip
        if uses_scatter(results):
            text = _("Assumed shaking: {intensity}, by its median PGV of {pgv} and PGA of {pga} g, scatter of ln "
                     "PGV {scatter} ({sources}).", scatter=number(shaking.scatter, "g"), **values)  # fmt: skip
        else:
            text = _("Assumed shaking: {intensity}, by its median PGV of {pgv} and PGA of {pga} g ({sources}); "
                     "scatter is not in the results.", **values)  # fmt: skip
        return " ".join((text, *_say_factor(results)))
    if source := say_ground_source(results):
        return source
    building, pgv = results.building, None
    at_grade = {one.floor for one in results.floor_rows if one.elevation_m is not None and one.elevation_m <= 0}
    if own := [one for one in results.motions if one.floor in at_grade and one.source == "record"]:
        pga_g, pgv = max(one.pfa_g for one in own), max(one.pfv_cm_s or 0.0 for one in own)
        text = _("Ground motion: recorded, with a PGA of {pga} g and a PGV of {pgv}.", pga=words.in_g(pga_g),
                 pgv=measures.say(pgv, "cm/s"))  # fmt: skip
    elif building.known_pga is None:
        return ""
    else:
        pga_g = building.known_pga / GRAVITY
        if building.ground_pgv is not None:
            pgv = 100 * building.ground_pgv
            text = _("Ground motion: PGA {pga} g and PGV {pgv} as filled in.", pga=words.in_g(pga_g),
                     pgv=measures.say(pgv, "cm/s"))  # fmt: skip
        elif any(one.source != "record" for one in results.motions):
            text = _("Ground motion: PGA {pga} g as filled in, taken as from an earthquake of magnitude 6.5 to 7.5.",
                     pga=words.in_g(pga_g))  # fmt: skip
        else:
            text = _("Ground motion: PGA {pga} g as filled in.", pga=words.in_g(pga_g))
    return " ".join((text, *_say_strength(pga_g, pgv, results), *(() if own else _say_factor(results))))


def name_source(found: "SiteGround") -> str:
    """Return what kind of ground motion it is, with its file, for a line."""
    file = words.cut(found.file, 60)
    return _("ShakeMap {file}", file=file) if found.kind == "shakemap" else _("scenarios {file}", file=file)


def _say_site(found: "SiteGround", results: Results) -> Iterator[str]:
    source = name_source(found)
    if found.kind == "shakemap" and found.facts:
        event = words.cut(_(found.facts[0][1]), 120)
        source = _("{source} of the earthquake {event}", source=source, event=event)
    values = {"source": source, "pga": words.in_g(found.pga_g)}
    if found.pgv_cm_s is None:
        yield _("Ground motion: {source}, with a median PGA of {pga} g at the building.", **values)
    else:
        yield _("Ground motion: {source}, with a median PGA of {pga} g and PGV of {pgv} at the building.",
                pgv=measures.say(found.pgv_cm_s, "cm/s"), **values)  # fmt: skip
    yield from _say_strength(found.pga_g, found.pgv_cm_s, results)
    yield from _say_factor(results)


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


def uses_scatter(results: Results) -> bool:
    """Return whether motions are drawn with the scatter of the intensity: the formulas take the median alone."""
    return results.has_simulated and not results.settings.ideal


def _say_shaking(found: Shaking, results: Results) -> str:
    scatter = number(found.scatter, "g")
    texts = [_("Assumed shaking: no motion of the ground is known for this building. {intensity} is assumed, with its "
               "median PGV of {pgv} and PGA of {pga} g ({sources}).", intensity=_(found.choice),
               pga=words.in_g(found.pga_g), pgv=measures.say(found.pgv_cm_s, "cm/s"),
               sources=", ".join(found.sources)), *_say_factor(results)]  # fmt: skip
    if uses_scatter(results):
        texts.append(_("PGV scatters about this median by {scatter} (standard deviation of ln PGV), which is drawn.",
                       scatter=scatter))  # fmt: skip
    elif results.has_simulated:
        texts.append(_("PGV scatters about this median by {scatter} (standard deviation of ln PGV); the simulation "
                       "leaves this scatter out: its chances hold for the median alone.", scatter=scatter))  # fmt: skip
    else:
        texts.append(_("PGV scatters about this median by {scatter} (standard deviation of ln PGV). The formula takes "
                       "the median; the scatter is not in it.", scatter=scatter))  # fmt: skip
    return " ".join(texts)


def _say_factor(results: Results) -> Iterator[str]:
    if results.settings.scale != 1:
        factor = number(results.settings.scale, "g")
        yield _("The results are for these medians times {factor}.", factor=factor)


# ---------------------------------------------------------------- cautions

UNLIKE = 0.10
"""Difference between the median PFA of the user's own motions and the PFA of a floor above which it is reported [-]."""
MOST_WARNINGS = 5
"""Warnings that are given in full."""


class Caution(NamedTuple):
    """A caution: the whole `text`, and `short`, what a summary has room for."""

    text: str
    short: str


def build_cautions(results: Results) -> list[Caution]:
    """Return what a reader must know about the floors' motion before trusting a class."""
    motions, mixed = results.motions, _("The floors' motion comes from mixed sources: compare floors with care.")
    profiles = ", ".join(_with_status(one.key, one) for one in used_profiles(results))
    warnings = list(dict.fromkeys(map(_, results.underestimates)))
    short = ngettext("More is known than is used: {n:,} warning, see the data-quality log.",
                     "More is known than is used: {n:,} warnings, see the data-quality log.",
                     len(warnings))  # fmt: skip
    further = ngettext("More is known than is used: {n:,} further warning of this kind, see the data-quality log.",
                       "More is known than is used: {n:,} further warnings of this kind, see the data-quality log.",
                       len(warnings) - MOST_WARNINGS)  # fmt: skip
    unused = [_("More is known than is used: {warning}", warning=words.clip(one, 400))
              for one in warnings[:MOST_WARNINGS]]  # fmt: skip
    cautions = [
        *_of_floors(
            (one.floor for one in motions if one.source == "profile"),
            lambda floors: " ".join((_("{floors}: the motion is that of {profile}.", floors=floors, profile=profiles),
                                     _(ENVELOPES))),
            lambda floors: _("{floors}: the motion is a code's design profile, an envelope.", floors=floors),
        ),
        *_of_floors(
            (one.floor for one in motions if one.between and not one.is_level),
            lambda floors: _("{floors}: no motion is known there; it is interpolated between the floors above and "
                             "below. This {caution}.", floors=floors, caution=MAY_BE_LOWER),
            lambda floors: _("{floors}: interpolated between floors; it may be lower than the truth.", floors=floors),
        ),
        *_of_floors(
            (one.floor for one in motions if one.is_level),
            lambda floors: _("{floors}: no motion is known there; it is that of a known floor at the same height.",
                             floors=floors),
            lambda floors: _("{floors}: the same as a known floor at the same height.", floors=floors),
        ),
        *(Caution(one, short) for one in (*unused, *([further] if len(warnings) > MOST_WARNINGS else []))),
        *([Caution(mixed, mixed)] if len({motion.source for motion in motions}) > 1 else []),
    ]  # fmt: skip
    if not results.has_simulated:
        return cautions
    suite = results.provenance.suite
    return [*cautions, *(_list_generated(results) if suite is None else _list_own(results, suite))]


def _of_floors(floors: Iterable[str], say: Callable[[str], str], shortly: Callable[[str], str]) -> list[Caution]:
    """Return a caution on floors, of which a short text names the first; nothing where there are none."""
    each = list(dict.fromkeys(floors))
    if not each:
        return []
    some = words.name_first([words.cut(floor, 10) for floor in each], 6)
    named, short = (
        ngettext("Floor {floors}", "Floors {floors}", len(each), floors=text) for text in (", ".join(each), some)
    )
    return [Caution(say(words.clip(named, 300)), shortly(short))]


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


def _list_generated(results: Results) -> list[Caution]:
    made = [(one.floor, one.ensemble) for one in results.motions if one.ensemble is not None]
    ways = list_narrowing(results)
    narrow = " " + _("What would narrow it: {ways}.", ways=", ".join(ways)) if ways else ""
    return [
        *_of_floors(
            (floor for floor, one in made if one.unknown_building),
            lambda floors: _("{floors}: assumed motion, and neither T1, Height, Storeys nor an Elevation is known; "
                             "buildings of every period were drawn, and no class is confirmed.", floors=floors),
            lambda floors: _("{floors}: assumed motion, nothing known of the building; no class is confirmed.",
                             floors=floors),
        ),
        *_of_floors(
            (floor for floor, one in made if one.assumed_motion and not one.unknown_building),
            lambda floors: _("{floors}: assumed motion: earthquakes with the known peaks of the ground and buildings "
                             "of about this period were drawn.", floors=floors) + narrow,
            lambda floors: _("{floors}: assumed motion (ground and building drawn).", floors=floors),
        ),
        *_of_floors(
            (floor for floor, one in made if one.weak_motions),
            lambda floors: _("{floors}: the generated motions have a smaller PFV than the floor's; simulation may "
                             "raise a class there, never lower it.", floors=floors),
            lambda floors: _("{floors}: weaker motions than the floor's; simulation may raise a class there, never "
                             "lower it.", floors=floors),
        ),
    ]  # fmt: skip


def _list_own(results: Results, suite: SuiteInfo) -> Iterator[Caution]:
    text = _("Simulation uses {motions}.", motions=describe_suite(results))
    yield Caution(text, _("Simulation uses the user's own motions."))
    median, places = suite.median_pfa_g, []
    for one in results.motions:
        off = median / one.pfa_g - 1 if one.ensemble and one.pfa_g > 0 else 0.0
        place = {"floor": words.cut(one.floor, 20), "axis": one.axis, "pfa": words.in_g(one.pfa_g)}
        if off > UNLIKE:
            places.append(_("floor {floor} {axis} ({pfa} g), {off:.0f} % above", **place, off=100 * off))
        elif off < -UNLIKE:
            places.append(_("floor {floor} {axis} ({pfa} g), {off:.0f} % below", **place, off=-100 * off))
    if places and not suite.is_scaled:
        text = _("The median PFA of these motions, {pfa} g, differs from that of {places}. Where it is below, chances "
                 "come out too low; they lower no class.", pfa=words.in_g(median),
                 places=words.name_first(places, 8, "; "))  # fmt: skip
        short = _("The user's own motions are not as strong as the floors': where weaker, chances come out too low.")
        yield Caution(text, short)


def say_motions(floor: FloorRow, motions: Sequence[MotionRow]) -> str:
    """Return the motion of a floor: elevation, peaks along both axes, and where they come from."""
    peaks, speeds = [], []
    for axis in AXES:
        own = [one for one in motions if one.axis == axis]
        known = [one.pfv_cm_s for one in own if one.pfv_cm_s is not None]
        if own:
            peak = _("PFA {axis} {pfa} g", axis=axis, pfa=words.in_g(max(one.pfa_g for one in own)))
            is_one = len({one.pfa_g for one in own}) < 2
            peaks.append(peak if is_one else _("{peak} (the largest of {n})", peak=peak, n=len(own)))
        if known:
            speeds.append(_("PFV {axis} {pfv}", axis=axis, pfv=measures.say(max(known), "cm/s")))
    sources = list(dict.fromkeys(map(describe_source, motions)))
    text = ": ".join(filter(None, ("; ".join([*peaks, *speeds]), words.name_first(sources, 3, "; "))))
    if floor.elevation_m is None:
        return f"{text}."
    return _("{elevation} above ground. {motion}.", elevation=measures.say(floor.elevation_m, "m"), motion=text)
