"""The table of sums of ranking.xlsx: one line a number, one column a group of buildings."""

from collections.abc import Callable
from dataclasses import dataclass

from assess.i18n import fill
from assess.portfolio.city_totals import Group
from assess.report.xlsx.pen import COUNT
from assess.risk import RiskClass
from assess.route_results import RouteState

SUM = "#,##0.0"
"""How Excel shows an expected number."""


@dataclass(frozen=True, slots=True)
class SumLine:
    """One line: its label, what it reads from a group, and how Excel shows that."""

    label: str
    read: Callable[[Group], float | None]
    format: str = COUNT


LINES = (
    SumLine(fill("Buildings"), lambda group: group.buildings),
    SumLine(fill("Pieces"), lambda group: group.pieces),
    SumLine(fill("Pieces of class low"), lambda group: group.by_class[RiskClass.LOW]),
    SumLine(fill("Pieces of class medium"), lambda group: group.by_class[RiskClass.MEDIUM]),
    SumLine(fill("Pieces of class high"), lambda group: group.by_class[RiskClass.HIGH]),
    SumLine(fill("Pieces of class very high"), lambda group: group.by_class[RiskClass.VERY_HIGH]),
    SumLine(fill("Unconfirmed pieces, in no class"), lambda group: group.unconfirmed),
    SumLine(fill("Pieces by formula only, in no class"), lambda group: group.by_formula),
    SumLine(fill("Anchored pieces, in no class"), lambda group: group.anchored),
    SumLine(fill("Components left out of COBie files, in no number"), lambda group: group.left_out),
    SumLine(fill("Expected falls"), lambda group: group.falls.expected, SUM),
    SumLine(fill("Falls that 5 % of the earthquakes do not exceed"), lambda group: group.falls.low),
    SumLine(fill("Falls that 95 % of the earthquakes do not exceed"), lambda group: group.falls.high),
    SumLine(fill("Expected falls, sampling interval, low"), lambda group: group.falls.sampling_low, SUM),
    SumLine(fill("Expected falls, sampling interval, high"), lambda group: group.falls.sampling_high, SUM),
    SumLine(fill("Expected falls that are in no range"), lambda group: group.falls.apart, SUM),
    SumLine(fill("Expected falls with few pieces (10 % quantities)"), lambda group: group.falls_low_inventory, SUM),
    SumLine(fill("Expected falls with many pieces (90 % quantities)"), lambda group: group.falls_high_inventory, SUM),
    SumLine(fill("Falls that the work lists avoid"), lambda group: group.falls_avoided, SUM),
    SumLine(fill("People on routes whose state is known"), lambda group: group.people_known),
    SumLine(
        fill("Expected people on blocked routes"),
        lambda group: group.people.expected if group.people_known else None,
        SUM,
    ),
    SumLine(
        fill("People that 5 % of the earthquakes do not exceed"),
        lambda group: group.people.low if group.people_known else None,
    ),
    SumLine(
        fill("People that 95 % of the earthquakes do not exceed"),
        lambda group: group.people.high if group.people_known else None,
    ),
    SumLine(fill("People on routes whose state is not known"), lambda group: group.people_not_known),
    SumLine(fill("Routes open"), lambda group: group.routes[RouteState.OPEN]),
    SumLine(fill("Routes doubtful"), lambda group: group.routes[RouteState.DOUBTFUL]),
    SumLine(fill("Routes blocked"), lambda group: group.routes[RouteState.BLOCKED]),
    SumLine(fill("Routes not known"), lambda group: group.routes[RouteState.NOT_KNOWN]),
    SumLine(fill("Pieces on the work lists"), lambda group: group.works),
    SumLine(fill("Known costs of the work"), lambda group: group.cost),
    SumLine(fill("Pieces on the work lists without a cost"), lambda group: group.works_without_cost),
)
"""The table of groups."""
