"""One state of a workbook assessed by the formulas: what the page's classes, routes and plans are read from.

A workbook that is being filled in is rarely whole. Rows with errors have been left out when it was read; floors of
which the shaking is not known yet are left out here, with what stands on them, so that everything else has its class.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from assess.errors import Gap, Problem
from assess.model import Inventory
from assess.pipeline.adopt import Assessment
from assess.pipeline.demand import serve_floors
from assess.pipeline.run import compute
from assess.settings import SCENARIOS, Settings
from assess.workbook.names import key
from assess.workbook.parse import Row, Tables, first_row

if TYPE_CHECKING:
    from assess.web.snapshot import Snapshot

BY_FORMULAS = Settings(verify="none")
"""How the page assesses while one types."""


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """What is known of the pieces of a workbook by the formulas: the assessment of the floors whose motion is known.

    `unserved` are the other floors, as names are compared; `problems` tell why, and of motions and walls, but are not
    those of the reading.
    """

    assessment: Assessment | None
    unserved: frozenset[str]
    problems: tuple[Problem, ...]


def evaluate(snapshot: "Snapshot", settings: Settings = BY_FORMULAS, *, routes: bool = True) -> Evaluation:
    """Return what is known of a snapshot, without annual chances, and without routes, which no class needs, on demand.

    What follows from the page's own settings is worked out once for all who ask. Raises InputError if a setting does
    not fit the inventory, as an unknown piece that is to be anchored, or a record is gone.
    """
    inventory = replace(snapshot.inventory, hazard=None)
    inventory = inventory if routes else replace(inventory, routes=())
    if settings != BY_FORMULAS:
        return _evaluate(snapshot, inventory, settings)
    return snapshot.keep(("formulas", bool(inventory.routes)), lambda: _evaluate(snapshot, inventory, settings))


def _evaluate(snapshot: "Snapshot", inventory: Inventory, settings: Settings) -> Evaluation:
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
    assessment = compute(inventory, settings)
    return Evaluation(assessment, frozenset(unserved), (*faults, *assessment.problems[known:]))


def list_floors(tables: Tables) -> list[Row]:
    """Return the rows of Floors that have a name, the first of each name, whatever errors they have."""
    found: dict[str, Row] = {}
    for row in tables["Floors"].with_all("floor"):
        found.setdefault(key(row.get("floor")), row)
    return list(found.values())
