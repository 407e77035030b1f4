"""How each floor shakes, in the words of reports: sources, what stands behind each number, and what to beware of."""

import statistics
from collections.abc import Iterator, Sequence

from assess.demand import FLAGS, MAY_BE_LOWER, Demand, Demands, Ground, find_ground
from assess.language import fill, ngettext, number
from assess.language import gettext as _
from assess.motion.record import treatment
from assess.motion.scenario import PROFILES, UNVERIFIED, VERIFIED, Profile
from assess.remarks import MOST, list_floors, list_too_low
from assess.report import words
from assess.results import Assessment

ENVELOPES = fill(
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
    lower, upper = (words.clip(name, 40) for name in demand.between)
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
    return f"{words.clip(demand.name, 60)}: {words.clip(demand.record.station, 60)}{azimuth}"


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
            kinds.setdefault(source, []).append(f"{floor} {axis}")
    return [f"{source}: {', '.join(places)}" for source, places in kinds.items()]


def list_cautions(assessment: Assessment) -> list[str]:
    """Return what a reader must know of the floors' motion before trusting a class."""
    demands = assessment.demands
    cautions = []
    profiled = list_floors(demands, "profile")
    if profiled:
        names = ", ".join(_with_status(profile) for profile in used_profiles(demands))
        text = _("{floors}: the motion is that of {profile}.", floors=_name(profiled), profile=names)
        cautions.append(f"{text} {_(ENVELOPES)}")
    cautions += _interpolated(demands)
    told = list_too_low(assessment.inventory, demands, assessment.scenario, assessment.settings.ductility_reduction)
    cautions += _more_known(list(dict.fromkeys(_(problem.message) for problem in told)))
    if len({demand.source for ones in demands.values() for demand in ones}) > 1:
        cautions.append(_("The floors' motion comes from mixed sources: compare floors with care."))
    return cautions + _verification(assessment)


def _more_known(messages: Sequence[str]) -> Iterator[str]:
    """Say that more is known than is used, as warnings have it; the first of them, and how many more there are."""
    for message in messages[:MOST]:
        yield _("More is known than is used: {warning}", warning=words.clip(message, 400))
    if len(messages) > MOST:
        yield ngettext(
            "More is known than is used: {n:,} warning of this kind beside these, see the data-quality log.",
            "More is known than is used: {n:,} warnings of this kind beside these, see the data-quality log.",
            len(messages) - MOST,
        )


def _verification(assessment: Assessment) -> list[str]:
    """Say under which motions pieces were verified where these are not made for the floor's own record."""
    joints, ensembles = assessment.joints, assessment.cases.ensembles
    if assessment.suite is not None:
        text = _("Verification uses {motions}.", motions=describe_suite(assessment))
        return [text, *_unlike(assessment)] if joints else []
    generic = [demand.floor.floor for demand, joint in joints.items() if ensembles[joint.ensemble].is_generic]
    if not generic:
        return []
    floors = _name(list(dict.fromkeys(generic)))
    return [
        _(
            "{floors}: motions follow a generic spectrum; verification may raise a class there, never lower it.",
            floors=floors,
        )
    ]


def describe_suite(assessment: Assessment) -> str:
    """Return the user's own motions in words: their number, folder and names, and whether they are scaled."""
    if assessment.suite is None:
        return _("no motions of the user's own")
    names = ", ".join(words.clip(name, 60) for name, _ in assessment.suite.motions)
    is_scaled = assessment.settings.scale_motions
    return ngettext(
        "{n:,} motion of the folder {folder}, {scaled}: {names}",
        "{n:,} motions of the folder {folder}, {scaled}: {names}",
        len(assessment.suite),
        folder=words.clip(assessment.suite.folder, 60),
        scaled=_("scaled to each floor's PFA") if is_scaled else _("as they are, not scaled"),
        names=words.clip(names, 400),
    )


def _unlike(assessment: Assessment) -> list[str]:
    """Say where the user's own motions, not scaled, have another PFA than the floor."""
    if assessment.suite is None or assessment.settings.scale_motions:
        return []
    median = statistics.median(motion.pfa for __, motion in assessment.suite.motions)
    off = {demand: median / demand.pfa - 1 for demand in assessment.joints if demand.pfa > 0}
    places = [_off(demand, ratio) for demand, ratio in off.items() if abs(ratio) > UNLIKE]
    if not places:
        return []
    named, more = "; ".join(places[:MOST_PLACES]), len(places) - MOST_PLACES
    return [
        _(
            "The median PFA of these motions, {pfa} g, is not that of {places}. Where it is below, chances come out "
            "too low; they lower no class.",
            pfa=words.in_g(median),
            places=_("{names} and {more:,} more", names=named, more=more) if more > 0 else named,
        )
    ]


def _off(demand: Demand, ratio: float) -> str:
    """Say by how much the user's own motions are above or below a floor's."""
    floor, pfa, off = words.clip(demand.floor.floor, 20), words.in_g(demand.pfa), 100 * abs(ratio)
    if ratio > 0:
        return _("floor {floor} {axis} ({pfa} g), {off:.0f} % above", floor=floor, axis=demand.axis, pfa=pfa, off=off)
    return _("floor {floor} {axis} ({pfa} g), {off:.0f} % below", floor=floor, axis=demand.axis, pfa=pfa, off=off)


def _interpolated(demands: Demands) -> list[str]:
    """Say which floors are interpolated, and which have the motion of another floor at their height."""
    found: dict[bool, dict[str, None]] = {False: {}, True: {}}
    for (floor, __), ones in demands.items():
        for demand in ones:
            if demand.between:
                found[demand.is_level][floor] = None
    between, level = (_name(list(found[is_level])) for is_level in (False, True))
    texts = {
        False: _(
            "{floors}: nothing is known of the motion there, it is interpolated between the floors above and below. "
            "This {caution}.",
            floors=between,
            caution=_(MAY_BE_LOWER),
        ),
        True: _(
            "{floors}: nothing is known of the motion there, it is the same as that of a known floor at the same "
            "height.",
            floors=level,
        ),
    }
    return [texts[is_level] for is_level, floors in found.items() if floors]


def _with_status(profile: Profile) -> str:
    return profile.key + ("" if profile.verified else f" ({_(UNVERIFIED)})")


def _name(floors: Sequence[str]) -> str:
    return words.clip(ngettext("Floor {floors}", "Floors {floors}", len(floors), floors=", ".join(floors)), 300)


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
        chosen = _("design profile of {code}, the default, as nothing is known of them", code=_with_status(used[0]))
    else:
        chosen = _("design profile of {code}, the scenario", code=_with_status(used[0]))
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
