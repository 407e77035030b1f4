"""How each floor shakes, in the words of reports: the source of each motion, what it was computed from, assumptions."""

from collections.abc import Iterable

from assess.i18n import fill, ngettext, number
from assess.i18n import gettext as _
from assess.intensity import RATIO
from assess.model import AXES
from assess.report import words
from assess.report.findings.ground_source import name_source
from assess.results import MOTION_FLAGS, MotionRow, ProfileInfo, Results
from assess.units import GRAVITY

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


def list_assumptions(results: Results) -> list[tuple[str, str]]:
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
