"""Every number and word of a report, gathered once for HTML, PDF and Excel, in the language in use."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.environment import find_source_date
from assess.errors import Problem
from assess.i18n import gettext as _
from assess.i18n import number
from assess.report import statements, words
from assess.report.counts import Counts, count, count_rooms
from assess.report.provenance import report_time, say_date, say_reference
from assess.report.row_order import order_floors, order_rows
from assess.report.say import ground, simulation
from assess.report.say.ground import PEAKS, say_ground_source, say_peak
from assess.report.say.methods import Disagreements, find_disagreements
from assess.report.say.piece import list_apart, list_parts
from assess.report.say.simulation import (
    WILSON,
    AnnualChances,
    Trials,
    Verified,
    build_annual,
    build_verified,
    list_references,
)
from assess.report.summary import FLOORS, FLOORS_BESIDE, Summary, build_summary, list_risky
from assess.results import FloorRow, ItemResult, MotionRow, Results, WorkedMethod
from assess.risk import LIMITS, RiskClass, classify
from assess.workbook.habits import group_problems
from assess.workbook.schema import BUILDING, NO, YES

if TYPE_CHECKING:
    from assess.methods import MethodInfo


class ByBasis:
    """Lists of the pieces in `results` by what their class rests on."""

    __slots__ = ()
    results: Sequence[ItemResult]

    @property
    def risky(self) -> Sequence[ItemResult]:
        """Free-standing pieces that reach high by the upper estimate, the worst first."""
        return list_risky(self.results)

    @property
    def unconfirmed(self) -> Sequence[ItemResult]:
        """Free-standing pieces whose lower simulated class cannot be relied on, the worst by formula first."""
        return list_apart(self.results, "unconfirmed")

    @property
    def risky_by_formula(self) -> Sequence[ItemResult]:
        """Free-standing pieces that were not simulated, of high and very high class by formula, the worst first."""
        return list_risky(self.results, "formula")


@dataclass(frozen=True, slots=True)
class FloorPage(ByBasis):
    """One floor: what shakes it, and its pieces."""

    floor: FloorRow
    title: str
    motions: Sequence[MotionRow]
    counts: Counts
    results: Sequence[ItemResult]

    @property
    def placed(self) -> int:
        """Rows with a position on the plan."""
        return sum(one.item.x_m is not None and one.item.y_m is not None for one in self.results)

    @property
    def rooms(self) -> Sequence[Counts]:
        """The pieces of each room: what is shown where no piece has a position."""
        return count_rooms(self.results)


@dataclass(frozen=True, slots=True)
class WorkedExample:
    """The calculation of one method for the piece of the worked example."""

    method: "MethodInfo"
    steps: Sequence[str]
    result: str

    @property
    def title(self) -> str:
        """Title of the method."""
        return _(self.method.title)


@dataclass(frozen=True, kw_only=True)
class Content(ByBasis):
    """The content of a report; every sequence is in the order in which it is shown.

    `run` is what it was made from, `results` its rows of furniture, `building` the lines about the building as label
    and value by the field of the workbook, `flags` the meaning of every mark, `making` what the run is made again from.
    """

    run: Results
    title: str
    date: str
    building: Mapping[str, tuple[str, str]]
    results: Sequence[ItemResult]
    total: Counts
    floors: Sequence[FloorPage]
    summary: Summary
    sources: Sequence[str]
    cautions: Sequence[str]
    short_cautions: Sequence[str]
    flags: Mapping[str, str]
    assumptions: Sequence[tuple[str, str]]
    limits: Sequence[str]
    verified: Verified
    trials: Trials
    disagreements: Disagreements
    annual: AnnualChances | None
    worked: Sequence[WorkedExample]
    making: Sequence[tuple[str, str]]
    drawn: dict[str, Any] = field(default_factory=dict, compare=False, repr=False)
    """Figures that one of the reports has drawn already, by name."""

    @property
    def methods(self) -> "Sequence[MethodInfo]":
        """The methods."""
        return self.run.methods

    @property
    def problems(self) -> Sequence[Problem]:
        """Warnings and notes about the input, those of one habit as one."""
        return group_problems(self.run.problem_rows)

    @property
    def version(self) -> str:
        """Version of `assess` that computed the results."""
        return self.run.provenance.version

    @property
    def shaking(self) -> str:
        """What a ShakeMap, scenarios or an assumed intensity gives, and whose; "" where the motion rests on none."""
        return say_ground_source(self.run)

    @property
    def by_floor(self) -> Sequence[Counts]:
        """The counts of every floor."""
        return [page.counts for page in self.floors]

    @property
    def notes(self) -> Sequence[ItemResult]:
        """The rows that the workbook has a note on."""
        return [one for one in self.results if one.item.notes]

    @cached_property
    def listed(self) -> Sequence[ItemResult]:
        """All rows in the order of the tables of pieces: by floor and name, with identical rows together."""
        return order_rows(self.results, [page.floor.floor for page in self.floors])

    def parts(self, most: int) -> list[tuple[str, list[ItemResult]]]:
        """Return the first `most` rows by their basis, with the heading of each part but the first."""
        return list_parts(self.listed[:most])

    @property
    def example(self) -> ItemResult | None:
        """The piece of the worked example."""
        return None if self.run.worked_item is None else self.results[self.run.worked_item]

    @cached_property
    def shown_floors(self) -> Sequence[FloorPage]:
        """Floors that have pieces, or a segment of a route on the plan: each has a page."""
        drawn = {one.floor for one in self.run.route_tables.segments if one.length_m is not None}
        return [page for page in self.floors if page.results or page.floor.floor in drawn]

    @cached_property
    def furnished(self) -> Sequence[FloorPage]:
        """Floors that have pieces."""
        return [page for page in self.floors if page.results]

    @cached_property
    def worst_floors(self) -> Sequence[Counts]:
        """The floors that the summary has room for: in their order, or those with most risky pieces."""
        there = [page.counts for page in self.furnished]
        most = FLOORS if not self.total.unconfirmed else FLOORS_BESIDE
        if len(there) <= most:
            return there
        return sorted(there, key=lambda one: (-one.risky, -one.expected, -one.unconfirmed))[:most]

    @property
    def references(self) -> Sequence[str]:
        """Publications of the methods, of the interval, of draws by place, and of an assumed intensity."""
        shaking = self.run.provenance.shaking
        others = (WILSON, *list_references(self.run), *(shaking.references if shaking else ()))
        return list(dict.fromkeys((*(say_reference(method.reference) for method in self.methods), *others)))

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


def build_content(results: Results) -> Content:
    """Gather the content of a report, in the language in use: once for all its renderers."""
    rows = tuple(results)
    floors, verified, total = _list_floors(results, rows), build_verified(results, rows), count(_("All floors"), rows)
    found = ground.build_cautions(results)
    return Content(
        run=results,
        title=results.building.building or Path(results.provenance.workbook).stem,
        date=say_date(report_date(results.building.report_date)),
        building=_describe_building(results),
        results=rows,
        total=total,
        floors=floors,
        summary=build_summary(results, rows, total),
        sources=ground.list_sources(results.motions),
        cautions=[one.text for one in found],
        short_cautions=list(dict.fromkeys(one.short for one in found)),
        flags=statements.list_flags(results),
        assumptions=[*statements.list_assumptions(results), *simulation.list_assumed_draws(results, verified)],
        limits=statements.list_limits(results),
        verified=verified,
        trials=simulation.build_trials(results, verified),
        disagreements=find_disagreements(results, rows),
        annual=build_annual(results, rows),
        worked=tuple(_work(results, one) for one in results.worked),
        making=statements.list_making(results),
    )


def report_date(given: str = "") -> str:
    """Return the date that the workbook gives, else that of the report in the reader's own time zone.

    Where SOURCE_DATE_EPOCH is set, it is that day in UTC.
    """
    return given or (find_source_date() or report_time().astimezone()).date().isoformat()


def _describe_building(results: Results) -> dict[str, tuple[str, str]]:
    """Return what the workbook says of the building: label and value by field."""
    lines = {}
    for column in BUILDING.columns:
        value = getattr(results.building, column.name)
        if column.name == "scenario_kind":
            used, chosen = results.provenance.scenario, value or "as filled"
            value = used if used == chosen else _("{used} (the workbook: {chosen})", used=_(used), chosen=_(chosen))
        if value not in (None, "") and column.kind != "file":
            shown = number(value / column.factor, ".4g") if isinstance(value, float) else str(value)
            shown = (YES if value else NO) if column.kind == "flag" else shown
            shown += f" {column.unit}" if column.quantity else ""
            shown = say_peak(results, column.name, shown) if column.name in PEAKS else shown
            lines[column.name] = (_(column.label), words.clip(_(shown) if column.kind in ("choice", "flag") else shown))
    return lines


def _list_floors(results: Results, rows: Sequence[ItemResult]) -> tuple[FloorPage, ...]:
    by_floor: dict[str, list[ItemResult]] = {floor.floor: [] for floor in results.floor_rows}
    for one in rows:
        by_floor[one.item.floor].append(one)
    pages = []
    for floor in order_floors(results.floor_rows):
        named = f"{floor.floor} – {floor.name}" if floor.name else _("Floor {floor}", floor=floor.floor)
        title, own = words.cut(named, 60), by_floor[floor.floor]
        found = [one for one in results.motions if one.floor == floor.floor]
        pages.append(FloorPage(floor, title, found, count(title, own), own))
    return tuple(pages)


def _work(results: Results, worked: WorkedMethod) -> WorkedExample:
    """Return the steps of a method in the language in use, and its result in words."""
    method = next(one for one in results.methods if one.key == worked.key)
    risk = classify(worked.value)
    if method.kind == "criterion" or risk is None:
        result = _(method.words[0] if worked.value else method.words[1])
    else:
        result = _(
            "{symbol} = {value:.4f}, that is {percent}: {risk}", symbol=method.symbol, value=worked.value,
            percent=words.percent(worked.value), risk=words.risk_word(risk),
        )  # fmt: skip
    return WorkedExample(method, tuple(map(_, worked.steps)), result)
