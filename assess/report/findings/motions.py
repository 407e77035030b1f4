"""How each floor shakes, in the words of reports: sources, what stands behind each number, and what to beware of."""

from assess.demand import FLAGS, Demand, Demands, Ground, find_ground
from assess.language import fill, ngettext, number
from assess.language import gettext as _
from assess.motion.record import treatment
from assess.motion.scenario import PROFILES, UNVERIFIED, VERIFIED, Profile
from assess.remarks import list_floors
from assess.report import words
from assess.results import Assessment

ENVELOPES = fill(
    "Profiles of building codes are design envelopes, not expected values: they mostly lie above what is recorded, and "
    "so bias a scenario high. Not on every floor, nor for every code: as long as T1 is unknown, the profiles of EN "
    "1998-1 and NTC 2018 for rigid pieces are the lowest of the four; a long T1 lowers that of ASCE 7-22."
)
"""What must be said wherever a code's profile was used."""


MOST_PLACES = 20
"""Floors and axes of a source that are named."""


def describe_source(demand: Demand) -> str:
    """Return where a motion comes from, in words, with its flags."""
    source = _("recorded motion")
    if demand.profile:
        source = _("design profile of {code}", code=demand.profile.key)
    elif demand.between:
        source = _between(demand)
    elif demand.source == "given":
        is_pfv_given = demand.pfv == demand.pfv and "pfv_estimated" not in demand.flags
        source = _("given PFA and PFV") if is_pfv_given else _("given PFA")
    told = _CARRIED if demand.between else _OWN
    flags = [_(told[flag]) for flag in demand.flags if flag in told]
    return source + (f" ({'; '.join(flags)})" if flags else "")


_OWN = {"one_axis_only": FLAGS["one_axis_only"], "pfv_estimated": fill("PFV estimated from T1")}
_CARRIED = _OWN | {"one_axis_only": fill("one axis only")}
"""Flags beside a source, in short where they come from a neighbour."""


def _between(demand: Demand) -> str:
    lower, upper = (words.cut(name, 40) for name in demand.between)
    if demand.is_level:
        return _("the same as floor {floor}, at the same height", floor=lower)
    return _("interpolated between floors {lower} and {upper}", lower=lower, upper=upper)


def describe_origin(demand: Demand) -> str:
    """Return what stands behind a motion: the record, or what was computed from what."""
    if demand.profile and demand.height_ratio is not None and demand.amplification is not None:
        return _(
            "{code}, {clause}: {factors} of ground PGA {pga} g",
            code=demand.profile.key,
            clause=demand.clause + ("" if demand.profile.verified else f" ({_(UNVERIFIED)})"),
            factors=factors(demand),
            pga=words.in_g(demand.pfa / demand.amplification),
        )
    if demand.is_level:
        return _between(demand)
    if demand.between:
        return _("linear over elevation, PFA and PFV each: {source}", source=_between(demand))
    if demand.record is None:
        return words.DASH
    azimuth = "" if demand.record.azimuth_deg is None else f", {number(demand.record.azimuth_deg, 'g')}°"
    return f"{words.cut(demand.name, 60)}: {words.cut(demand.record.station, 60)}{azimuth}"


def factors(demand: Demand) -> str:
    """Return where a floor stands in the building and what a code's profile gave it."""
    ratio, amplification = words.fixed(demand.height_ratio, 3), words.fixed(demand.amplification, 3)
    return _("z/h {ratio}, amplification {amplification}", ratio=ratio, amplification=amplification)


def describe_treatment(demand: Demand) -> str:
    """Say what was done to the record of a demand."""
    if demand.record is None:
        return ""
    parts = (treatment(demand.record), *demand.record.notes)
    return "; ".join(_(part).rstrip(".") for part in parts) + "."


def list_sources(demands: Demands) -> list[str]:
    """Say which floors got their motion from where: mixed sources are listed, not hidden."""
    kinds: dict[str, list[str]] = {}
    for (floor, axis), ones in demands.items():
        for source in dict.fromkeys(describe_source(demand) for demand in ones):
            kinds.setdefault(source, []).append(f"{words.cut(floor, 20)} {axis}")
    return [f"{source}: {words.name_first(places, MOST_PLACES)}" for source, places in kinds.items()]


def describe_suite(assessment: Assessment) -> str:
    """Return the user's own motions in words: their number, folder and names, and whether they are scaled."""
    if assessment.suite is None:
        return _("no motions of the user's own")
    names = ", ".join(words.cut(name, 60) for name, _ in assessment.suite.motions)
    is_scaled = assessment.settings.scale_motions
    return ngettext(
        "{n:,} motion of the folder {folder}, {scaled}: {names}",
        "{n:,} motions of the folder {folder}, {scaled}: {names}",
        len(assessment.suite),
        folder=words.cut(assessment.suite.folder, 60),
        scaled=_("scaled to each floor's PFA") if is_scaled else _("as they are, not scaled"),
        names=words.clip(names, 400),
    )


def with_status(profile: Profile) -> str:
    """Return the name of a profile, and that it was not held against its source where that is so."""
    return profile.key + ("" if profile.verified else f" ({_(UNVERIFIED)})")


def used_profiles(demands: Demands) -> list[Profile]:
    """Return the codes' profiles that serve a floor."""
    return [
        profile
        for profile in PROFILES.values()
        if any(demand.profile is profile for ones in demands.values() for demand in ones)
    ]


def list_clauses(profile: Profile) -> str:
    """Return every clause of a profile, and when each applies."""
    if not profile.clause_without_period:
        return profile.clause
    return _("{known} (T1 known); {unknown} (T1 unknown)", known=profile.clause, unknown=profile.clause_without_period)


def profile_status(profile: Profile) -> str:
    """Say whether a profile was held against its source, and what was left out of it."""
    status = _(VERIFIED if profile.verified else UNVERIFIED)
    return f"{status[0].upper()}{status[1:]}. {_(profile.remark)}"


def list_assumptions(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed of the floors that a code's profile serves."""
    used = used_profiles(assessment.demands)
    if not used:
        return []
    ground, floors = find_ground(assessment.inventory), ", ".join(list_floors(assessment.demands, "profile"))
    if assessment.scenario == "as filled":
        chosen = _("design profile of {code}, the default, as nothing is known of them", code=with_status(used[0]))
    else:
        chosen = _("design profile of {code}, the scenario", code=with_status(used[0]))
    pga = _("0.4 SDS, as Ground PGA is blank") if ground.is_from_sds else _("Ground PGA")
    lines = [
        (_("Motion of floors {floors}", floors=words.clip(floors, 300)), chosen),
        (
            _("Ground motion of the profile"),
            _("{pga} g, {source}; it stands for 0.4 SDS and for αS", pga=words.in_g(ground.pga), source=pga),
        ),
        (_("Roof height h of the profile"), _describe_roof(ground)),
    ]
    return lines + (_list_reduction(assessment) if any(profile.reduced for profile in used) else [])


def _describe_roof(ground: Ground) -> str:
    height = words.in_m(ground.roof)
    if not ground.is_highest_floor:
        return _("{height} m, Height", height=height)
    if ground.roof:
        return _("{height} m, the highest floor, as Height is blank", height=height)
    return _("{height} m, no floor above the ground, Height is blank", height=height)


def _list_reduction(assessment: Assessment) -> list[tuple[str, str]]:
    period, reduction = assessment.inventory.building.period, assessment.settings.ductility_reduction
    known = _("unknown: Eq. 13.3-5, which is never below Eq. 13.3-4")
    if period:
        known = f"{number(period, 'g')} s"
    factor = number(reduction, "g")
    if reduction == 1:
        factor = _("{factor}: no reduction for the building's ductility", factor=factor)
    return [(_("Period T1 in the profile"), known), (_("R_μ of ASCE 7-22"), factor)]
