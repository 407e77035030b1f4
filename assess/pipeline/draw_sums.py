"""What happens in each draw of an earthquake, summed over a building: sums over buildings are sums draw by draw.

Counted are the pieces that the classes count: free-standing ones whose simulated chance is adopted. All pieces of a row
fall together in a draw. Of routes those are counted draw by draw that have joint outcomes; of others only the expected
number is known, which is kept apart. People are counted once for each route that they leave by.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray
from assess.pipeline.adopt import Assessment
from assess.progress import SILENT, Progress
from assess.results import Results, sum_falls
from assess.route_results import RouteRow, RouteState, RouteTables
from assess.settings import AUTO

Numbers = NDArray[np.int64]

SIMULATED = "simulated"
"""Of `assess.results.BASES`: what counts rest on where pieces were simulated."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DrawSums:
    """Sums over the pieces and routes of a building.

    * `falls` (runs,): pieces that fall in each draw, of those in the classes; None where nothing was simulated, or each
      piece in a number of draws of its own.
    * `people_blocked`, `routes_blocked` (runs,): people whose route is blocked in each draw, and routes, of those with
      joint outcomes; None in the same cases.
    * `people_expected`, `routes_expected`: expected numbers of the same, of all routes that are known.
    * `people_apart`, `routes_apart`: the part of them that is in no draw: of routes without joint outcomes.
    * `people_not_known`: people on routes whose state is not known: they are in none of these numbers.
    """

    falls: Numbers | None
    people_blocked: Numbers | None
    routes_blocked: Numbers | None
    joint_routes: tuple[str, ...]
    people_expected: float
    routes_expected: float
    people_apart: float
    routes_apart: float
    people_not_known: int


def sum_draws(assessment: Assessment, results: Results, *, progress: Progress = SILENT) -> DrawSums:
    """Return the sums of a building; `results` are those of the assessment. CancelledError if it is stopped."""
    tables, runs = results.route_tables, assessment.settings.runs
    chances = {
        one.route: one.blocked.probability
        for one in tables.routes
        if one.state != RouteState.NOT_KNOWN and one.blocked is not None
    }
    people = {one.route: count_people(tables, one) or 0 for one in tables.routes}
    blocked: Mapping[str, BoolArray] = {}
    fallen = people_blocked = routes_blocked = None
    if results.main_basis == SIMULATED and runs != AUTO:
        if assessment.obstructions:
            from assess.routes.evaluate import find_joint_draws

            found = find_joint_draws(
                assessment.inventory, assessment.obstructions, assessment.find_falls(), assessment.settings, int(runs),
                progress=progress,
            )  # fmt: skip
            blocked = {route: found[route] for route in chances if route in found}
        none = np.zeros(int(runs), dtype=np.int64)
        fallen = sum_falls(one for one in results if not one.is_anchored and not one.apart)
        fallen = none if fallen is None else fallen
        people_blocked = sum((people[route] * draws for route, draws in blocked.items()), none)
        routes_blocked = sum((draws.astype(np.int64) for draws in blocked.values()), none)
    apart = {route: chance for route, chance in chances.items() if route not in blocked}
    expected, alone = (float(sum(people[route] * one for route, one in of.items())) for of in (chances, apart))
    return DrawSums(
        falls=fallen, people_blocked=people_blocked, routes_blocked=routes_blocked, joint_routes=tuple(blocked),
        people_expected=expected, routes_expected=sum(chances.values()), people_apart=alone,
        routes_apart=sum(apart.values()),
        people_not_known=sum(number for route, number in people.items() if route not in chances),
    )  # fmt: skip


def count_people(tables: RouteTables, route: RouteRow) -> int | None:
    """Return how many people leave by a route: the largest Occupants of its segments; None where all are blank."""
    given = [tables.segments[at].occupants for at in route.segment_indices]
    return max((one for one in given if one is not None), default=None)
