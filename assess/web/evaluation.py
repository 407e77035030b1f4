"""One version of a workbook assessed as it stands: the one source of all that the page shows of pieces and routes.

It is what `assess run` finds: every piece simulated. Until a piece has been, it goes by the formula; `Evaluation.waits`
says so. What has been simulated is kept over the versions of a workbook (`simulating`).

A workbook that is being filled in is rarely whole. Rows with errors have been left out when it was read; floors of
which the shaking is not known yet are left out here, with what stands on them, so that everything else has its class.
"""

import math
import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from assess.errors import Gap, Problem
from assess.i18n import gettext
from assess.model import Inventory
from assess.pipeline.adopt import Assessment
from assess.pipeline.demand import serve_floors
from assess.pipeline.run import compute, evaluate_route_tables
from assess.progress import SILENT
from assess.route_results import RouteTables
from assess.settings import SCENARIOS, Settings
from assess.web.simulating import Simulation
from assess.workbook.names import key
from assess.workbook.parse import Row, Tables, first_row

if TYPE_CHECKING:
    from assess.routes.evaluate import KeptRoutes
    from assess.web.snapshot import Snapshot

AS_RUN = Settings()
"""How the page assesses: as `assess run` does by itself."""
LIVE, WHAT_IF = "live", "what-if"
"""What is simulated: the workbook as it stands before anything else."""


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """What is known of the pieces of a workbook: the assessment of the floors whose motion is known.

    `unserved` are the other floors, as names are compared; `problems` tell why, and of motions and walls, but are not
    those of the reading. `arrived` counts what had been simulated then, `simulation` says how far it is.
    """

    assessment: Assessment | None
    unserved: frozenset[str]
    problems: tuple[Problem, ...]
    arrived: int = 0
    simulation: Simulation = field(default_factory=Simulation)

    @property
    def is_simulated(self) -> bool:
        """Whether every piece is simulated that is to be."""
        return self.simulation.state == "done"

    def describe(self) -> dict[str, Any]:
        """Return on what it rests, as the page is told: `simulation` of docs/page.md."""
        one = self.simulation
        return {"state": one.state, "done": one.done, "of": one.of, "message": gettext(one.message)}


def evaluate(snapshot: "Snapshot", settings: Settings = AS_RUN, *, routes: bool = True) -> Evaluation:
    """Return what is known of a snapshot, without annual chances, and without routes, which no class needs, on demand.

    It is worked out once for all who ask, and has the rest simulated. Raises InputError if a setting does not fit the
    inventory, as an unknown piece that is to be anchored, or a record is gone.
    """
    simulator, purpose = snapshot.simulator, LIVE if settings == AS_RUN else WHAT_IF
    found = _find(snapshot, settings, routes)
    simulator.want(purpose, (snapshot, settings), found.assessment, lambda: _find(snapshot, settings, False).assessment)
    return replace(found, simulation=simulator.describe(purpose, found.assessment))


def wait_for_simulation(
    snapshot: "Snapshot", settings: Settings = AS_RUN, *, seconds: float, most: float = math.inf
) -> None:
    """Wait for what is lacking, so long at most, where that is not more than `most` cases."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        found = evaluate(snapshot, settings, routes=False)
        lacking = None if found.assessment is None else found.assessment.lacking
        if lacking is None or not 0 < (lacking.ensemble >= 0).sum() <= most or found.simulation.state == "failed":
            return
        snapshot.simulator.wait(found.arrived, left)


def tabulate_routes(snapshot: "Snapshot", found: Evaluation, settings: Settings = AS_RUN) -> RouteTables:
    """Return the states of routes of an evaluation, once for all who ask: only of what has changed since the last."""
    if found.assessment is None or not found.assessment.obstructions:
        return RouteTables(risk=0.0)
    from assess.routes.evaluate import KeptRoutes  # it needs geometry, which a workbook without routes does not

    assessment, simulator, kind = found.assessment, snapshot.simulator, settings == AS_RUN

    def make() -> RouteTables:
        with simulator.routes_lock:
            kept = simulator.routes.setdefault(kind, KeptRoutes())
            return evaluate_route_tables(assessment, SILENT, kept=kept)

    return snapshot.keep(("route tables", settings), make, found.arrived)


def copy_kept(snapshot: "Snapshot", settings: Settings) -> "KeptRoutes | None":
    """Return the rows of routes as they were tabulated last, for what would come of them with pieces held."""
    with snapshot.simulator.routes_lock:
        kept = snapshot.simulator.routes.get(settings == AS_RUN)
        return None if kept is None else kept.copy()


def _find(snapshot: "Snapshot", settings: Settings, routes: bool) -> Evaluation:
    inventory, arrived = replace(snapshot.inventory, hazard=None), snapshot.simulator.arrived
    inventory = inventory if routes else replace(inventory, routes=())
    name = "evaluation", settings, bool(inventory.routes)
    return snapshot.keep(name, lambda: _evaluate(snapshot, inventory, settings, arrived), arrived)


def _evaluate(snapshot: "Snapshot", inventory: Inventory, settings: Settings, arrived: int) -> Evaluation:
    kind = settings.scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands, faults = serve_floors(inventory, kind, ductility_reduction=settings.ductility_reduction)
    served = {floor for floor, _axis in demands}
    left_out = {one.floor for one in inventory.floors} - served
    unserved = set(map(key, left_out))
    if snapshot.tables["Floors"].found:  # those that the reading left out, as nothing tells how they shake
        cells = {one.cell for one in snapshot.problems if isinstance(one, Gap) and one.severity == "error"}
        names = {row.number: key(row.get("floor")) for row in list_floors(snapshot.tables)}
        unserved |= {names[number] for number in map(first_row, cells) if number in names}
    if not served:
        return Evaluation(None, frozenset(unserved), tuple(faults))
    known = len(inventory.problems)
    if left_out:
        if isinstance(settings.anchor, tuple):
            on = {one.item: one.floor for one in inventory.items}
            settings = replace(settings, anchor=tuple(one for one in settings.anchor if on.get(one) in served))
        places = tuple(one for one in inventory.places if one.floor in served)
        named = {one.place for one in places} | {""}
        inventory = replace(
            inventory,
            floors=tuple(one for one in inventory.floors if one.floor in served),
            items=tuple(one for one in inventory.items if one.floor in served),
            places=places,
            routes=tuple(  # segments that have no floor of their own stay, if their places do
                one
                for one in inventory.routes
                if (not one.floor or one.floor in served) and {one.start, one.end} <= named
            ),
        )
    assessment = compute(inventory, settings, verdicts=snapshot.simulator.verdicts)
    return Evaluation(assessment, frozenset(unserved), (*faults, *assessment.problems[known:]), arrived)


def list_floors(tables: Tables) -> list[Row]:
    """Return the rows of Floors that have a name, the first of each name, whatever errors they have."""
    found: dict[str, Row] = {}
    for row in tables["Floors"].with_all("floor"):
        found.setdefault(key(row.get("floor")), row)
    return list(found.values())
