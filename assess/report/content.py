"""Every number and word of a report, gathered once; HTML, PDF and Excel show what stands here."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.columns import BUILDING
from assess.inventory.model import Floor
from assess.language import gettext as _
from assess.language import number
from assess.methods import Method
from assess.report import statements, words
from assess.report.counts import Bars, CannotRock, Counts, build_bars, count, count_cannot_rock, count_rooms
from assess.report.findings import cautions, motions, trials
from assess.report.findings.trials import Trials
from assess.report.findings.verified import WILSON, Verified, build_verified
from assess.report.provenance import report_time, say_date, say_reference, versions
from assess.report.summary import FLOORS, Summary, build_summary, list_risky
from assess.results import Assessment, ItemResult
from assess.risk import LIMITS, RiskClass
from assess.version import __version__


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

    @property
    def rooms(self) -> Bars | None:
        """The pieces of each room as bars: what is shown where no piece has a position."""
        return build_bars(count_rooms(self.results))

    @property
    def risky(self) -> Sequence[ItemResult]:
        """Free-standing pieces of high or very high class, or that may be, the worst first."""
        return list_risky(self.results)


@dataclass(frozen=True)
class Content:
    """The content of a report; every sequence is in the order in which it is shown."""

    assessment: Assessment
    title: str
    date: str
    version: str
    platform: Mapping[str, str]
    building: Mapping[str, tuple[str, str]]
    results: Sequence[ItemResult]
    total: Counts
    by_floor: Sequence[Counts]
    summary: Summary
    sources: Sequence[str]
    cautions: Sequence[str]
    short_cautions: Sequence[str]
    floors: Sequence[FloorPage]
    methods: Sequence[Method]
    flags: Mapping[str, str]
    assumptions: Sequence[tuple[str, str]]
    limits: Sequence[str]
    problems: Sequence[Problem]
    verified: Verified
    trials: Trials
    notes: Sequence[ItemResult]
    making: Sequence[tuple[str, str]]

    @cached_property
    def shown_floors(self) -> Sequence[FloorPage]:
        """Floors that have pieces, or a segment of a route on the plan: each has a page."""
        segments = self.assessment.routes.segments if self.assessment.routes else ()
        drawn = {one.segment.floor for one in segments if one.length is not None}
        return [page for page in self.floors if page.results or page.floor.floor in drawn]

    @cached_property
    def furnished(self) -> Sequence[FloorPage]:
        """Floors that have pieces."""
        return [page for page in self.floors if page.results]

    @cached_property
    def worst_floors(self) -> Sequence[Counts]:
        """The floors that the summary has room for: in their order, or those with most risky pieces."""
        there = [page.counts for page in self.furnished]
        if len(there) <= FLOORS:
            return there
        return sorted(there, key=lambda one: (-one.risky, -one.expected))[:FLOORS]

    @cached_property
    def cannot_rock(self) -> CannotRock:
        """Pieces of high and very high class by formula that cannot start to rock, or are too stocky to."""
        return count_cannot_rock(self.results)

    @property
    def references(self) -> Sequence[str]:
        """What the methods and the interval were taken from."""
        return list(dict.fromkeys(map(say_reference, (*(method.reference for method in self.methods), WILSON))))

    @property
    def class_limits(self) -> Sequence[tuple[RiskClass, str]]:
        """The classes with their limits in words."""
        medium, high, very_high = (f"{number(100 * limit, 'g')} %" for limit in LIMITS)
        texts = (
            _("below {limit}", limit=medium),
            _("{lower} to below {upper}", lower=medium, upper=high),
            _("{lower} to below {upper}", lower=high, upper=very_high),
            _("{limit} and above", limit=very_high),
        )
        return tuple(zip(RiskClass, texts, strict=True))


def build_content(assessment: Assessment) -> Content:
    """Gather the content of a report, in the language in use."""
    results = tuple(assessment)
    floors, verified = _floors(assessment, results), build_verified(assessment, results)
    platform = versions(has_rocked=bool(assessment.joints), has_routes=assessment.routes is not None)
    total = count(_("All floors"), results)
    return Content(
        assessment=assessment,
        title=assessment.inventory.building.building or assessment.inventory.source.stem,
        date=say_date(report_date(assessment.inventory.building.report_date)),
        version=__version__,
        platform=platform,
        building=_building(assessment),
        results=results,
        total=total,
        by_floor=tuple(page.counts for page in floors),
        summary=build_summary(assessment, results, total),
        sources=motions.list_sources(assessment.demands),
        cautions=cautions.list_cautions(assessment),
        short_cautions=cautions.list_short_cautions(assessment),
        floors=floors,
        methods=assessment.methods,
        flags=statements.list_flags(assessment),
        assumptions=[*statements.list_assumptions(assessment), *trials.list_assumptions(assessment, verified)],
        limits=statements.list_limits(has_verified=bool(verified.done), has_routes=assessment.routes is not None),
        problems=assessment.problems,
        verified=verified,
        trials=trials.build_trials(assessment, verified),
        notes=tuple(one for one in results if one.item.notes),
        making=statements.list_making(assessment, platform),
    )


def report_date(given: str = "") -> str:
    """Return the date that the workbook gives, else that of the report in the reader's own time zone.

    Where SOURCE_DATE_EPOCH is set, it is that day in UTC.
    """
    moment = report_time()
    return given or (moment if "SOURCE_DATE_EPOCH" in os.environ else moment.astimezone()).date().isoformat()


def _building(assessment: Assessment) -> dict[str, tuple[str, str]]:
    """Return what the workbook says of the building: the field of each line, its label and what it holds."""
    lines = {}
    for column in BUILDING.columns:
        value = getattr(assessment.inventory.building, column.name)
        if column.name == "scenario_kind":
            value = _scenario_kind(value, assessment.scenario)
        if value not in (None, "") and column.kind != "file":
            shown = number(value / column.factor, ".4g") if isinstance(value, float) else str(value)
            shown += f" {column.unit}" if column.quantity else ""
            lines[column.name] = (_(column.label), words.clip(_(shown) if column.kind == "choice" else shown))
    return lines


def _scenario_kind(chosen: str, used: str) -> str:
    if used == (chosen or "as filled"):
        return used
    return _("{used} (the workbook: {chosen})", used=_(used), chosen=_(chosen or "as filled"))


def floor_title(floor: Floor) -> str:
    """Return the floor's name for people."""
    named = f"{floor.floor} – {floor.name}" if floor.name else _("Floor {floor}", floor=floor.floor)
    return words.cut(named, 60)


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
