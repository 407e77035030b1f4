"""What to beware of in the floors' motion: in full where the floors are, in short on the summary."""

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from assess.demand import MAY_BE_LOWER, Demand, Demands
from assess.language import gettext as _
from assess.language import ngettext
from assess.remarks import MOST, list_floors, list_too_low
from assess.report import words
from assess.report.findings.motions import ENVELOPES, describe_suite, used_profiles, with_status
from assess.results import Assessment

UNLIKE = 0.10
"""Difference between the mean PFA of the user's own motions and that of a floor above which it is told [-]."""
MOST_PLACES = 8
"""Floors and axes that such a sentence names."""
MOST_FLOORS, LONGEST_FLOOR = 6, 10
"""Floors that a short caution names, and the characters of each."""


@dataclass(frozen=True, slots=True)
class Caution:
    """What a reader must know of the floors' motion: the whole `text`, and in `short` what a summary has room for."""

    text: str
    short: str


def build_cautions(assessment: Assessment) -> list[Caution]:
    """Return what a reader must know of the floors' motion before trusting a class."""
    demands = assessment.demands
    told = list_too_low(assessment.inventory, demands, assessment.scenario, assessment.settings.ductility_reduction)
    cautions = [
        *_profiled(demands),
        *_interpolated(demands),
        *_more_known(list(dict.fromkeys(_(problem.message) for problem in told))),
    ]
    if len({demand.source for ones in demands.values() for demand in ones}) > 1:
        text = _("The floors' motion comes from mixed sources: compare floors with care.")
        cautions.append(Caution(text, text))
    return cautions + _verification(assessment)


def list_cautions(assessment: Assessment) -> list[str]:
    """Return the cautions in full."""
    return [one.text for one in build_cautions(assessment)]


def list_short_cautions(assessment: Assessment) -> list[str]:
    """Return the cautions in short, each once."""
    return list(dict.fromkeys(one.short for one in build_cautions(assessment)))


def _profiled(demands: Demands) -> Iterator[Caution]:
    """Say which floors shake as a code has it."""
    floors = list_floors(demands, "profile")
    if floors:
        names = ", ".join(with_status(profile) for profile in used_profiles(demands))
        text = _("{floors}: the motion is that of {profile}.", floors=_name(floors), profile=names)
        short = _("{floors}: the motion is a code's design profile, an envelope.", floors=_name_some(floors))
        yield Caution(f"{text} {_(ENVELOPES)}", short)


def _more_known(messages: Sequence[str]) -> Iterator[Caution]:
    """Say that more is known than is used, as warnings have it; the first of them, and how many more there are."""
    short = ngettext(
        "More is known than is used: {n:,} warning, see the data-quality log.",
        "More is known than is used: {n:,} warnings, see the data-quality log.",
        len(messages),
    )
    for message in messages[:MOST]:
        yield Caution(_("More is known than is used: {warning}", warning=words.clip(message, 400)), short)
    if len(messages) > MOST:
        text = ngettext(
            "More is known than is used: {n:,} warning of this kind beside these, see the data-quality log.",
            "More is known than is used: {n:,} warnings of this kind beside these, see the data-quality log.",
            len(messages) - MOST,
        )
        yield Caution(text, short)


def _verification(assessment: Assessment) -> list[Caution]:
    """Say under which motions pieces were verified where these are not made for the floor's own record."""
    joints, ensembles = assessment.joints, assessment.cases.ensembles
    if assessment.suite is not None:
        text = _("Verification uses {motions}.", motions=describe_suite(assessment))
        own = Caution(text, _("Verification uses the user's own motions."))
        return [own, *_unlike(assessment)] if joints else []
    generic = list(
        dict.fromkeys(demand.floor.floor for demand, joint in joints.items() if ensembles[joint.ensemble].is_generic)
    )
    if not generic:
        return []
    text = _(
        "{floors}: motions follow a generic spectrum; verification may raise a class there, never lower it.",
        floors=_name(generic),
    )
    short = _(
        "{floors}: generic spectrum; verification may raise a class there, never lower it.", floors=_name_some(generic)
    )
    return [Caution(text, short)]


def _unlike(assessment: Assessment) -> list[Caution]:
    """Say where the user's own motions, not scaled, have another PFA than the floor."""
    if assessment.suite is None or assessment.settings.scale_motions:
        return []
    median = statistics.median(motion.pfa for __, motion in assessment.suite.motions)
    off = {demand: median / demand.pfa - 1 for demand in assessment.joints if demand.pfa > 0}
    places = [_off(demand, ratio) for demand, ratio in off.items() if abs(ratio) > UNLIKE]
    if not places:
        return []
    named, more = "; ".join(places[:MOST_PLACES]), len(places) - MOST_PLACES
    text = _(
        "The median PFA of these motions, {pfa} g, is not that of {places}. Where it is below, chances come out "
        "too low; they lower no class.",
        pfa=words.in_g(median),
        places=_("{names} and {more:,} more", names=named, more=more) if more > 0 else named,
    )
    short = _("The user's own motions are not as strong as the floors': where weaker, chances come out too low.")
    return [Caution(text, short)]


def _off(demand: Demand, ratio: float) -> str:
    """Say by how much the user's own motions are above or below a floor's."""
    floor, pfa, off = words.cut(demand.floor.floor, 20), words.in_g(demand.pfa), 100 * abs(ratio)
    if ratio > 0:
        return _("floor {floor} {axis} ({pfa} g), {off:.0f} % above", floor=floor, axis=demand.axis, pfa=pfa, off=off)
    return _("floor {floor} {axis} ({pfa} g), {off:.0f} % below", floor=floor, axis=demand.axis, pfa=pfa, off=off)


def _interpolated(demands: Demands) -> Iterator[Caution]:
    """Say which floors are interpolated, and which have the motion of another floor at their height."""
    found: dict[bool, dict[str, None]] = {False: {}, True: {}}
    for (floor, __), ones in demands.items():
        for demand in ones:
            if demand.between:
                found[demand.is_level][floor] = None
    between, level = (list(found[is_level]) for is_level in (False, True))
    if between:
        text = _(
            "{floors}: nothing is known of the motion there, it is interpolated between the floors above and below. "
            "This {caution}.",
            floors=_name(between),
            caution=_(MAY_BE_LOWER),
        )
        short = _("{floors}: interpolated between floors; it may be lower than the truth.", floors=_name_some(between))
        yield Caution(text, short)
    if level:
        text = _(
            "{floors}: nothing is known of the motion there, it is the same as that of a known floor at the same "
            "height.",
            floors=_name(level),
        )
        yield Caution(text, _("{floors}: the same as a known floor at the same height.", floors=_name_some(level)))


def _name(floors: Sequence[str]) -> str:
    return words.clip(ngettext("Floor {floors}", "Floors {floors}", len(floors), floors=", ".join(floors)), 300)


def _name_some(floors: Sequence[str]) -> str:
    """Return the first floors, and how many more there are."""
    named = words.name_first([words.cut(floor, LONGEST_FLOOR) for floor in floors], MOST_FLOORS)
    return ngettext("Floor {floors}", "Floors {floors}", len(floors), floors=named)
