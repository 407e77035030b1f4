"""How each floor shakes, in the words of reports: sources, what stands behind each number, and what to beware of."""

import statistics
from collections.abc import Sequence

from assess.demand import FLAGS, MAY_BE_LOWER, Demand, Demands, find_ground
from assess.motion.record import treatment
from assess.motion.scenario import PROFILES, UNVERIFIED, VERIFIED, Profile
from assess.remarks import MOST, list_floors, list_too_low
from assess.report import words
from assess.results import Assessment

ENVELOPES = (
    "Profiles of building codes are design envelopes, not expected values: they mostly lie above what is recorded, and "
    "so bias a scenario high. Not on every floor, nor for every code: as long as T1 is unknown, the profiles of EN "
    "1998-1 and NTC 2018 for rigid pieces are the lowest of the four; a long T1 lowers that of ASCE 7-22."
)
"""What must be said wherever a code's profile was used."""


UNLIKE = 0.10
"""Difference between the mean PFA of the user's own motions and that of a floor above which it is told [-]."""
MOST_PLACES = 8
"""Floors and axes that such a sentence names."""


def describe_source(demand: Demand) -> str:
    """Return where a motion comes from, in words, with its flags."""
    source = "recorded motion"
    if demand.profile:
        source = f"design profile of {demand.profile.key}"
    elif demand.between:
        source = _between(demand)
    elif demand.source == "given":
        source = "given PFA" + ("" if demand.pfv != demand.pfv or "pfv_estimated" in demand.flags else " and PFV")
    told = _CARRIED if demand.between else _OWN
    flags = [told[flag] for flag in demand.flags if flag in told]
    return source + (f" ({'; '.join(flags)})" if flags else "")


_OWN = {"one_axis_only": FLAGS["one_axis_only"], "pfv_estimated": "PFV estimated from T1"}
_CARRIED = _OWN | {"one_axis_only": "one axis only"}
"""Flags beside a source, in short where they come from a neighbour."""


def _between(demand: Demand) -> str:
    lower, upper = (words.clip(name, 40) for name in demand.between)
    if demand.is_level:
        return f"the same as floor {lower}, at the same height"
    return f"interpolated between floors {lower} and {upper}"


def describe_origin(demand: Demand) -> str:
    """Return what stands behind a motion: the record, or what was computed from what."""
    if demand.profile and demand.height_ratio is not None and demand.amplification is not None:
        clause = demand.clause + ("" if demand.profile.verified else f" ({UNVERIFIED})")
        pga = words.in_g(demand.pfa / demand.amplification)
        return f"{demand.profile.key}, {clause}: {factors(demand)} of ground PGA {pga} g"
    if demand.is_level:
        return _between(demand)
    if demand.between:
        return f"linear over elevation, PFA and PFV each: {_between(demand)}"
    if demand.record is None:
        return words.DASH
    azimuth = "" if demand.record.azimuth_deg is None else f", {demand.record.azimuth_deg:g}°"
    return f"{words.clip(demand.name, 60)}: {words.clip(demand.record.station, 60)}{azimuth}"


def factors(demand: Demand) -> str:
    """Return where a floor stands in the building and what a code's profile gave it."""
    return f"z/h {words.fixed(demand.height_ratio, 3)}, amplification {words.fixed(demand.amplification, 3)}"


def describe_treatment(demand: Demand) -> str:
    """Say what was done to the record of a demand."""
    if demand.record is None:
        return ""
    parts = (treatment(demand.record), *demand.record.notes)
    return "; ".join(part.rstrip(".") for part in parts) + "."


def list_sources(demands: Demands) -> list[str]:
    """Say which floors got their motion from where: mixed sources are listed, not hidden."""
    kinds: dict[str, list[str]] = {}
    for (floor, axis), ones in demands.items():
        for source in dict.fromkeys(describe_source(demand) for demand in ones):
            kinds.setdefault(source, []).append(f"{floor} {axis}")
    return [f"{source}: {', '.join(places)}" for source, places in kinds.items()]


def list_cautions(assessment: Assessment) -> list[str]:
    """Return what a reader must know of the floors' motion before trusting a class."""
    demands = assessment.demands
    cautions = []
    profiled = list_floors(demands, "profile")
    if profiled:
        names = " and ".join(_with_status(profile) for profile in used_profiles(demands))
        cautions.append(f"{_name(profiled)}: the motion is that of {names}. {ENVELOPES}")
    cautions += _interpolated(demands)
    told = list_too_low(assessment.inventory, demands, assessment.scenario, assessment.settings.ductility_reduction)
    messages = list(dict.fromkeys(problem.message for problem in told))
    cautions += [f"More is known than is used: {words.clip(message, 400)}" for message in messages[:MOST]]
    if len(messages) > MOST:
        more = words.plural(len(messages) - MOST, "warning")
        cautions.append(f"More is known than is used: {more} of this kind beside these, see the data-quality log.")
    if len({demand.source for ones in demands.values() for demand in ones}) > 1:
        cautions.append("The floors' motion comes from mixed sources: compare floors with care.")
    return cautions + _verification(assessment)


def _verification(assessment: Assessment) -> list[str]:
    """Say under which motions pieces were verified where these are not made for the floor's own record."""
    joints, ensembles = assessment.joints, assessment.cases.ensembles
    if assessment.suite is not None:
        return [f"Verification uses {describe_suite(assessment)}.", *_unlike(assessment)] if joints else []
    generic = [demand.floor.floor for demand, joint in joints.items() if ensembles[joint.ensemble].is_generic]
    if not generic:
        return []
    floors = _name(list(dict.fromkeys(generic)))
    return [f"{floors}: motions follow a generic spectrum; verification may raise a class there, never lower it."]


def describe_suite(assessment: Assessment) -> str:
    """Return the user's own motions in words: their number, folder and names, and whether they are scaled."""
    if assessment.suite is None:
        return "no motions of the user's own"
    names = ", ".join(words.clip(name, 60) for name, _ in assessment.suite.motions)
    scaled = "scaled to each floor's PFA" if assessment.settings.scale_motions else "as they are, not scaled"
    count, folder = words.plural(len(assessment.suite), "motion"), words.clip(assessment.suite.folder, 60)
    return f"{count} of the folder {folder}, {scaled}: {words.clip(names, 400)}"


def _unlike(assessment: Assessment) -> list[str]:
    """Say where the user's own motions, not scaled, have another PFA than the floor."""
    if assessment.suite is None or assessment.settings.scale_motions:
        return []
    median = statistics.median(motion.pfa for _, motion in assessment.suite.motions)
    off = {demand: median / demand.pfa - 1 for demand in assessment.joints if demand.pfa > 0}
    places = [
        f"floor {words.clip(demand.floor.floor, 20)} {demand.axis} ({words.in_g(demand.pfa)} g), "
        f"{100 * abs(ratio):.0f} % {'above' if ratio > 0 else 'below'}"
        for demand, ratio in off.items()
        if abs(ratio) > UNLIKE
    ]
    if not places:
        return []
    more = f" and {len(places) - MOST_PLACES:,} more" if len(places) > MOST_PLACES else ""
    return [
        f"The median PFA of these motions, {words.in_g(median)} g, is not that of "
        f"{'; '.join(places[:MOST_PLACES])}{more}. Where it is below, chances come out too low; they lower no class."
    ]


def _interpolated(demands: Demands) -> list[str]:
    """Say which floors are interpolated, and which have the motion of another floor at their height."""
    found: dict[bool, dict[str, None]] = {False: {}, True: {}}
    for (floor, _), ones in demands.items():
        for demand in ones:
            if demand.between:
                found[demand.is_level][floor] = None
    texts = {
        False: f"it is interpolated between the floors above and below. This {MAY_BE_LOWER}",
        True: "it is the same as that of a known floor at the same height",
    }
    return [
        f"{_name(list(floors))}: nothing is known of the motion there, {texts[is_level]}."
        for is_level, floors in found.items()
        if floors
    ]


def _with_status(profile: Profile) -> str:
    return profile.key + ("" if profile.verified else f" ({UNVERIFIED})")


def _name(floors: Sequence[str]) -> str:
    return words.clip(f"{'Floor' if len(floors) == 1 else 'Floors'} {', '.join(floors)}", 300)


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
    return f"{profile.clause} (T1 known); {profile.clause_without_period} (T1 unknown)"


def profile_status(profile: Profile) -> str:
    """Say whether a profile was held against its source, and what was left out of it."""
    status = VERIFIED if profile.verified else UNVERIFIED
    return f"{status[0].upper()}{status[1:]}. {profile.remark}"


def list_assumptions(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed of the floors that a code's profile serves."""
    used = used_profiles(assessment.demands)
    if not used:
        return []
    ground, building = find_ground(assessment.inventory), assessment.inventory.building
    roof = "Height"
    if ground.is_highest_floor:
        roof = "the highest floor, as Height is blank" if ground.roof else "no floor above the ground, Height is blank"
    pga = "0.4 SDS, as Ground PGA is blank" if ground.is_from_sds else "Ground PGA"
    floors = words.clip(", ".join(list_floors(assessment.demands, "profile")), 300)
    chosen = "the default, as nothing is known of them" if assessment.scenario == "as filled" else "the scenario"
    lines = [
        (f"Motion of floors {floors}", f"design profile of {_with_status(used[0])}, {chosen}"),
        ("Ground motion of the profile", f"{words.in_g(ground.pga)} g, {pga}; it stands for 0.4 SDS and for αS"),
        ("Roof height h of the profile", f"{words.in_m(ground.roof)} m, {roof}"),
    ]
    if any(profile.reduced for profile in used):
        period = f"{building.period:g} s" if building.period else "unknown: Eq. 13.3-5, which is never below Eq. 13.3-4"
        reduction = assessment.settings.ductility_reduction
        note = ": no reduction for the building's ductility" if reduction == 1 else ""
        lines += [("Period T1 in the profile", period), ("R_μ of ASCE 7-22", f"{reduction:g}{note}")]
    return lines
