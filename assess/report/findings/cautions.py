"""Cautions on the floors' motion: in full in the section on floors, in short on the summary."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.findings.motions import ENVELOPES, describe_suite, list_floors, used_profiles, with_status
from assess.results import MAY_BE_LOWER, MotionRow, Results, SuiteInfo
from assess.workbook.schema import BUILDING

UNLIKE = 0.10
"""Difference between the median PFA of the user's own motions and the PFA of a floor above which it is reported [-]."""
MOST_WARNINGS = 5
"""Warnings that are given in full."""
MOST_PLACES = 8
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
            pfa=words.in_g(median), places=words.name_first(places, MOST_PLACES, "; "),
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
