"""Another scale, another scenario, further pieces anchored: classes and routes next to the present ones.

Nothing is written: the workbook as it is held is assessed anew with other settings, and simulated as it is itself.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from assess.errors import AssessError, InputError
from assess.i18n import gettext, load_catalogue, speaking
from assess.model import Inventory
from assess.pipeline.anchors import anchor_named, spell_names
from assess.pipeline.run import list_first_fixes
from assess.settings import SCENARIOS, Settings, show_given
from assess.web.evaluation import AS_RUN, Evaluation, evaluate, tabulate_routes, wait_for_simulation
from assess.web.live import count_classes, describe_failure, describe_rows, list_rows
from assess.web.route_states import describe_states, describe_unknown
from assess.workbook.names import key
from assess.workbook.parse import Tables

if TYPE_CHECKING:
    from assess.web.snapshot import Snapshot

ASKED = ("scale", "scenario", "anchor", "first")
"""What a request may hold: of the last two names of pieces, and a number of fixes."""
SOON = 1.0
"""How long the simulation is waited for before an answer goes by the formula where it lacks [s]."""
FAR = 1e6
"""A scale beyond this is no number that anyone means [-]."""


def try_out(snapshot: "Snapshot", request: object) -> dict[str, Any]:
    """Return the answer of `POST /api/what-if`; InputError if the request is wrong, or a piece is not assessed."""
    inventory = snapshot.inventory
    with speaking(load_catalogue(inventory.language)):
        settings, first = _read_request(inventory, snapshot.tables, request)
        present = evaluate(snapshot)
        before = snapshot.keep("before", lambda: _describe_side(snapshot, inventory, present), present.arrived)
        entries = snapshot.keep("entries", lambda: _name_entries(snapshot, present), present.arrived)
        if first and settings != AS_RUN:
            wait_for_simulation(snapshot, settings, seconds=SOON)
            entries = _name_entries(snapshot, evaluate(snapshot, settings), settings)
        anchored = settings.anchor if isinstance(settings.anchor, tuple) else ()
        named = tuple(dict.fromkeys((*anchored, *(one for each in entries[:first] for one in each))))
        settings = replace(settings, anchor=named)
        after, found = before, present
        if settings != AS_RUN:
            wait_for_simulation(snapshot, settings, seconds=SOON)
            found = evaluate(snapshot, settings)
            after = _describe_side(snapshot, anchor_named(inventory, named), found, settings)
        own = inventory.building.scenario_kind or SCENARIOS[0]
        scenarios = [
            [one, gettext("{scenario} (the workbook's own)", scenario=gettext(one)) if one == own else gettext(one)]
            for one in SCENARIOS
        ]
    return {
        "version": snapshot.version, "scenarios": scenarios, "scenario": settings.scenario or own,
        "entries": len(entries), "first": len(entries[:first]), "before": before["side"], "after": after["side"],
        "anchored": [one.row for one in inventory.items if one.item in named], "simulation": found.describe(),
        "error": after["error"],
    }  # fmt: skip


def _read_request(inventory: Inventory, tables: Tables, request: object) -> tuple[Settings, int]:
    """Return the settings that a request asks for, and how many of the first fixes it has anchored besides."""
    if not isinstance(request, Mapping):
        raise InputError.about("The request cannot be read.")
    unknown = [str(name) for name in request if name not in ASKED]
    if unknown:
        name, listed = show_given(unknown[0]), ", ".join(ASKED)
        raise InputError.about("{name} is not known, expected one of: {known}.", name=name, known=listed)
    given = {name: value for name, value in request.items() if value is not None}
    anchor, scale, first = (given.get(name, usual) for name, usual in (("anchor", ()), ("scale", 1.0), ("first", 0)))
    if isinstance(anchor, str) or not isinstance(anchor, Sequence) or not all(isinstance(one, str) for one in anchor):
        raise InputError.about("anchor is {value}, expected a list of names of items.", value=show_given(anchor))
    names = tuple(dict.fromkeys(one.strip() for one in anchor if one.strip()))
    known = {key(one.item) for one in inventory.items}
    rows = {key(row.get("item")): row.number for row in tables["Items"].with_all("item")}
    if left := next((name for name in names if key(name) not in known and key(name) in rows), None):
        raise InputError.about("{name} cannot be anchored: its row {row} has an error or a blank.",
                               name=show_given(left), row=rows[key(left)])  # fmt: skip
    if not isinstance(scale, int | float) or isinstance(scale, bool) or not abs(scale) < FAR:  # NaN among them
        raise InputError.about("scale is {value}, expected a number.", value=show_given(scale))
    scenario = given.get("scenario") or None
    settings = replace(AS_RUN, scale=float(scale), scenario=scenario, anchor=spell_names(inventory, names))
    if isinstance(first, float) and first.is_integer():
        first = int(first)
    if isinstance(first, bool) or not isinstance(first, int) or first < 0:
        raise InputError.about("first is {value}, expected a whole number, 0 or above.", value=show_given(first))
    return settings, first


def _name_entries(snapshot: "Snapshot", found: Evaluation, settings: Settings = AS_RUN) -> list[list[str]]:
    """Return the pieces of each entry of the schedule by their names."""
    if found.assessment is None:
        return []
    items, routes = found.assessment.inventory.items, tabulate_routes(snapshot, found, settings)
    return [[items[at].item for at in entry] for entry in list_first_fixes(found.assessment, routes)]


def _describe_side(
    snapshot: "Snapshot", inventory: Inventory, found: Evaluation, settings: Settings = AS_RUN
) -> dict[str, Any]:
    """Return classes, counts and routes, and the error where nothing can be computed."""
    tables = snapshot.tables
    rows = list_rows(tables, inventory, found)
    items = describe_rows(rows)
    del items["values"]
    try:
        routes = describe_states(snapshot, inventory, found, settings)
    except AssessError as error:
        routes = describe_unknown(tables, gettext(error.message))
    counts = count_classes(rows, tables["Items"])
    side = {"counts": counts, "items": items, "routes": routes["routes"], "rooms": routes["rooms"]}
    return {"side": side, "error": describe_failure(snapshot.problems, found) or routes["error"]}
