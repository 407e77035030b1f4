"""What several outputs show of a run, worked out once, in the language in use."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from assess.environment import find_source_date
from assess.errors import Problem
from assess.i18n import gettext as _
from assess.report import statements, words
from assess.report.counts import Counts, count
from assess.report.provenance import report_time, say_date
from assess.report.say import annual, ground
from assess.report.say.piece import order_rows
from assess.report.say.simulation import Verified, list_assumed_draws
from assess.report.say.work import Entry, list_entries
from assess.results import FloorRow, ItemResult, MotionRow, Results
from assess.workbook.habits import group_problems


@dataclass(frozen=True, slots=True)
class FloorPage:
    """One floor: what shakes it, and its pieces."""

    floor: FloorRow
    title: str
    motions: Sequence[MotionRow]
    counts: Counts
    results: Sequence[ItemResult]


class Content:
    """A run with what several outputs show of it; every sequence is in the order in which it is shown.

    `results` are its rows of furniture, `drawn` the figures that an output has drawn already, by name.
    """

    def __init__(self, run: Results) -> None:
        self.run = run
        self.results: Sequence[ItemResult] = tuple(run)
        self.title = run.building.building or Path(run.provenance.workbook).stem
        self.date = say_date(report_date(run.building.report_date))
        self.total = count(_("All floors"), self.results)
        self.drawn: dict[str, Any] = {}
        self._further: Sequence[Problem] = ()

    def with_problems(self, problems: Sequence[Problem]) -> "Content":
        """Return content whose data-quality log lists further problems, which concern one format alone."""
        found = copy(self)
        found._further = problems
        return found

    @property
    def problems(self) -> Sequence[Problem]:
        """Warnings and notes about the input, those of one habit as one."""
        return group_problems((*self.run.problem_rows, *self._further))

    @cached_property
    def verified(self) -> Verified:
        """The rows by what simulation found."""
        return Verified(self.run, self.results)

    @cached_property
    def annual(self) -> annual.Annual | None:
        """The chances a year; None where the workbook names no hazard file."""
        return annual.list_annual(self.run, self.results)

    @cached_property
    def fixes(self) -> Sequence[Entry]:
        """What to fix, the most urgent first."""
        return list_entries(self.run, self.results)

    @cached_property
    def cautions(self) -> Sequence[ground.Caution]:
        """What a reader must know about the motion of the floors."""
        return ground.build_cautions(self.run)

    @cached_property
    def assumptions(self) -> Sequence[tuple[str, str]]:
        """What was assumed, and where."""
        return [*statements.list_assumptions(self.run), *list_assumed_draws(self.run, self.verified)]

    @cached_property
    def listed(self) -> Sequence[ItemResult]:
        """All rows in the order of the tables of pieces: by floor and name, with identical rows together."""
        return order_rows(self.results, [page.floor.floor for page in self.floors])

    @cached_property
    def floors(self) -> Sequence[FloorPage]:
        """All floors, by elevation where all have one, from the top or from the ground as the workbook begins."""
        by_floor: dict[str, list[ItemResult]] = {floor.floor: [] for floor in self.run.floor_rows}
        for one in self.results:
            by_floor[one.item.floor].append(one)
        pages = []
        for floor in order_floors(self.run.floor_rows):
            named = f"{floor.floor} – {floor.name}" if floor.name else _("Floor {floor}", floor=floor.floor)
            title, own = words.cut(named, 60), by_floor[floor.floor]
            motions = [one for one in self.run.motions if one.floor == floor.floor]
            pages.append(FloorPage(floor, title, motions, count(title, own), own))
        return pages

    @cached_property
    def shown_floors(self) -> Sequence[FloorPage]:
        """Floors that have pieces, or a segment of a route on the plan: each has a page."""
        drawn = {one.floor for one in self.run.route_tables.segments if one.length_m is not None}
        return [page for page in self.floors if page.results or page.floor.floor in drawn]


def order_floors(floors: Sequence[FloorRow]) -> list[FloorRow]:
    """Return floors by elevation, or in the order of the workbook where one is missing."""
    heights = [floor.elevation_m for floor in floors if floor.elevation_m is not None]
    if len(heights) < len(floors) or not heights:
        return list(floors)
    return sorted(floors, key=lambda floor: floor.elevation_m or 0.0, reverse=heights[0] > heights[-1])


def report_date(given: str = "") -> str:
    """Return the given date, else that of the report in the reader's own time zone (of SOURCE_DATE_EPOCH in UTC)."""
    return given or (find_source_date() or report_time().astimezone()).date().isoformat()
