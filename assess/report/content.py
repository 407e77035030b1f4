"""Every number and word of a report, gathered once; HTML, PDF and Excel show what stands here."""

import datetime
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from assess.adoption import FORMULA
from assess.cases import FLAGS as ITEM_FLAGS
from assess.demand import FLAGS as DEMAND_FLAGS
from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.columns import BUILDING, ITEMS
from assess.inventory.model import Floor
from assess.methods import Method
from assess.ranking import count_pieces, fix_first
from assess.report import motions, trials, words
from assess.report.provenance import versions
from assess.report.trials import Trials
from assess.report.verified import WILSON, Verified, build_verified
from assess.results import Assessment, ItemResult
from assess.risk import LIMITS, RiskClass
from assess.version import __version__

WORST = 10
"""Pieces in the lists of the summary."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Pieces (not rows) of a floor, or of the building, by class; anchored ones stand outside the classes.

    `lowered` of those with a class were lowered by verification, and `may_be` may be of a higher one.
    """

    label: str
    by_class: Mapping[RiskClass, int]
    anchored: int
    lowered: int = 0
    may_be: int = 0

    @property
    def total(self) -> int:
        """All pieces."""
        return sum(self.by_class.values()) + self.anchored

    def share(self, risk: RiskClass) -> str:
        """Share of a class among the pieces that have one."""
        free = sum(self.by_class.values())
        return f"{100 * self.by_class[risk] / free:.0f} %" if free else words.DASH


@dataclass(frozen=True, slots=True)
class FloorPage:
    """One floor: what shakes it, its pieces, and whether the plan can be drawn."""

    floor: Floor
    title: str
    demands: Sequence[Demand]
    counts: Counts
    results: Sequence[ItemResult]

    @property
    def placed(self) -> int:
        """Rows with a position on the plan."""
        return sum(one.item.x is not None and one.item.y is not None for one in self.results)


@dataclass(frozen=True, slots=True)
class Content:
    """The content of a report; every sequence is in the order in which it is shown."""

    assessment: Assessment
    title: str
    date: str
    version: str
    platform: Mapping[str, str]
    building: Sequence[tuple[str, str]]
    results: Sequence[ItemResult]
    total: Counts
    by_floor: Sequence[Counts]
    worst: Sequence[ItemResult]
    fix_first: Sequence[ItemResult]
    sources: Sequence[str]
    cautions: Sequence[str]
    floors: Sequence[FloorPage]
    methods: Sequence[Method]
    flags: Mapping[str, str]
    assumptions: Sequence[tuple[str, str]]
    limits: Sequence[str]
    problems: Sequence[Problem]
    verified: Verified
    trials: Trials
    notes: Sequence[ItemResult] = field(default_factory=tuple)

    @property
    def cannot_rock(self) -> tuple[int, int, int]:
        """Pieces of high and very high class by formula; those that the static criterion says cannot start to rock.

        Of these last ones, third, those that direct integration gave a lower class, which was not adopted.
        """
        risky = [
            one
            for one in self.results
            if not (one.is_anchored or one.does_not_rock)
            and one.adopted.risk >= RiskClass.HIGH
            and one.adopted.method == FORMULA
        ]
        still = [one for one in risky if one.governing.methods["static"].value == 0]
        kept = [one for one in still if one.is_verified]
        all_risky, all_still, all_kept = (sum(one.item.quantity for one in ones) for ones in (risky, still, kept))
        return all_risky, all_still, all_kept

    @property
    def may_be_risky(self) -> int:
        """Pieces of a lower class than high of which the interval reaches into high or very high."""
        free = [one for one in self.results if not one.is_anchored]
        return sum(one.item.quantity for one in free if one.adopted.risk < RiskClass.HIGH <= one.adopted.upper)

    @property
    def references(self) -> Sequence[str]:
        """What the methods and the interval were taken from."""
        return list(dict.fromkeys([*(str(method.reference) for method in self.methods), str(WILSON)]))

    @property
    def class_limits(self) -> Sequence[tuple[RiskClass, str]]:
        """The classes with their limits in words."""
        medium, high, very_high = (f"{100 * limit:g} %" for limit in LIMITS)
        texts = (
            f"below {medium}",
            f"{medium} to below {high}",
            f"{high} to below {very_high}",
            f"{very_high} and above",
        )
        return tuple(zip(RiskClass, texts, strict=True))


def build_content(assessment: Assessment) -> Content:
    """Gather the content of a report."""
    results = tuple(assessment)
    floors, verified = _floors(assessment, results), build_verified(assessment, results)
    free = [one for one in results if not one.is_anchored]
    return Content(
        assessment=assessment,
        title=assessment.inventory.building.building or assessment.inventory.source.stem,
        date=report_date(),
        version=__version__,
        platform=versions(has_rocked=bool(assessment.joints)),
        building=_building(assessment),
        results=results,
        total=count("All floors", results),
        by_floor=tuple(page.counts for page in floors),
        worst=sorted(free, key=lambda one: (-one.adopted.upper, -one.adopted.probability, one.item.item))[:WORST],
        fix_first=tuple(fix_first(iter(results))),
        sources=motions.list_sources(assessment.demands),
        cautions=motions.list_cautions(assessment),
        floors=floors,
        methods=assessment.methods,
        flags=_flags(assessment),
        assumptions=[*_assumptions(assessment), *trials.list_assumptions(assessment, verified)],
        limits=(*LIMITS_OF_THE_METHOD, *(LIMITS_OF_VERIFICATION if verified.done else ())),
        problems=assessment.problems,
        verified=verified,
        trials=trials.build_trials(assessment, verified),
        notes=tuple(one for one in results if one.item.notes),
    )


def report_date() -> str:
    """Return today's date, or that of SOURCE_DATE_EPOCH where it is set (reproducible-builds.org)."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if epoch.isdigit():
        return datetime.datetime.fromtimestamp(int(epoch), datetime.UTC).date().isoformat()
    return datetime.datetime.now().astimezone().date().isoformat()


def _building(assessment: Assessment) -> list[tuple[str, str]]:
    lines = []
    for column in BUILDING.columns:
        value = getattr(assessment.inventory.building, column.name)
        if column.name == "scenario_kind":
            value = _scenario_kind(value, assessment.scenario)
        if value not in (None, "") and column.kind != "file":
            shown = f"{value / column.factor:g} {column.unit}" if column.quantity else str(value)
            lines.append((column.label, words.clip(shown)))
    return lines


def _scenario_kind(chosen: str, used: str) -> str:
    return used if used == (chosen or "as filled") else f"{used} (the workbook: {chosen or 'as filled'})"


def floor_title(floor: Floor) -> str:
    """Return the floor's name for people."""
    return words.clip(f"{floor.floor} – {floor.name}" if floor.name else f"Floor {floor.floor}", 60)


def count(label: str, results: Sequence[ItemResult]) -> Counts:
    """Count pieces by class, and of those that have one how many were lowered, or may be of a higher one."""
    free = [one for one in results if not one.is_anchored]
    lowered = sum(one.item.quantity for one in free if one.adopted.lowered_from is not None)
    may_be = sum(one.item.quantity for one in free if one.adopted.upper != one.adopted.risk)
    return Counts(label, *count_pieces(results), lowered=lowered, may_be=may_be)


def _floors(assessment: Assessment, results: Sequence[ItemResult]) -> tuple[FloorPage, ...]:
    by_floor: dict[str, list[ItemResult]] = {floor.floor: [] for floor in assessment.inventory.floors}
    for one in results:
        by_floor[one.item.floor].append(one)
    pages = []
    for floor in assessment.inventory.floors:
        demands = [demand for axis in ("X", "Y") for demand in assessment.demands[floor.floor, axis]]
        own = by_floor[floor.floor]
        pages.append(FloorPage(floor, floor_title(floor), demands, count(floor_title(floor), own), own))
    return tuple(pages)


def has_worse_motion(one: ItemResult, key: str) -> bool:
    """Tell whether a method gives more under another motion of the item than under the governing one."""
    governing, worst = one.governing.methods[key].value, one.worst(key)
    return worst is not None and (governing is None or worst > governing + 0.0005)


def _flags(assessment: Assessment) -> dict[str, str]:
    """Return what every mark means; where methods mean different things by one, each with its method."""
    meanings: dict[str, dict[str, str]] = {}
    for method in assessment.methods:
        for flag, meaning in method.flags.items():
            meanings.setdefault(flag, {}).setdefault(meaning, method.title)
    told = {
        flag: next(iter(by_meaning))
        if len(by_meaning) == 1
        else "; ".join(f"{title}: {text}" for text, title in by_meaning.items())
        for flag, by_meaning in meanings.items()
    }
    return told | dict(ITEM_FLAGS) | dict(DEMAND_FLAGS)


def _assumptions(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed, and for how many rows or where."""
    settings, items = assessment.settings, assessment.inventory.items
    counted = Counter(name for item in items for name in item.assumed)
    lines = motions.list_assumptions(assessment)
    for name, text in _ASSUMED.items():
        if counted[name]:
            label = ITEMS.column(name).label
            lines.append((f"{label} blank in {words.plural(counted[name], 'row')}", text))
    axes = words.plural(sum(item.axis is None for item in items), "row")
    frictions = words.plural(sum(item.friction is None for item in items), "row")
    lines += [
        (f"Axis unknown in {axes}", "the worse of X and Y governs"),
        (f"Friction unknown in {frictions}", "no sliding, as the paper assumes"),
        ("Kaneko-Hayashi, standard deviations (not printed in the source)",
         f"ζ_A = {settings.zeta_acceleration:g}, ζ_V = {settings.zeta_velocity:g}"),
        ("Kaneko-Hayashi, slide coefficient α", f"{settings.slide_coefficient:g}"),
        ("Gravity", "9.80665 m/s²"),
        ("A class limit belongs to", "the higher class (the paper leaves this open)"),
    ]  # fmt: skip
    return lines


_ASSUMED = {
    "breadth": "taken from the Catalogue by Type",
    "width": "taken from the Catalogue by Type",
    "height": "taken from the Catalogue by Type",
    "quantity": "1 piece",
    "axis": "set from Angle, which lies within 15° of X or Y",
    "anchored": "unknown, which counts as free-standing",
    "friction": "the building's default friction",
}

LIMITS_OF_THE_METHOD = (
    "The chance is that of overturning in this scenario. It is not a chance per year, and says nothing of how likely "
    "the scenario is.",
    "Every piece is a rigid block on a rigid floor, moving in one vertical plane, with its centroid at mid-height. A "
    "top-heavy piece falls sooner, a bottom-heavy one later.",
    "No piece slides. On a smooth floor (friction below B/H) a piece slides before it rocks, and may still hit people "
    "or block a way.",
    "Vertical motion is left out.",
    "Not covered: castors, stacked or leaning pieces, pieces linked to each other, open drawers, spilt contents, "
    "fastenings that fail.",
    "The proposed OR formula was fitted in three steel buildings and is checked by shaking-table tests for B/H 0.14 to "
    "0.39 and PFA 0.10 to 0.90 g only; results outside are marked.",
    "The proposed OR formula knows no size: a large piece and a small one of the same proportions get the same value, "
    "although the larger is harder to overturn.",
    "The proposed OR formula calls pieces high below the acceleration at which they can start to rock; the comparison "
    "shows the static criterion beside it.",
    "A piece marked as anchored is only as safe as its anchor; its free-standing risk is shown, never zero.",
)

LIMITS_OF_VERIFICATION = (
    "A verified chance is that of the rigid block under motions that meet the floor's spectrum and peak. Its interval "
    "covers the number of motions only.",
    "Rocking depends on details of a motion that a response spectrum does not hold, such as long pulses. What a piece "
    "does under the recorded motion itself therefore stands beside its chance.",
)
