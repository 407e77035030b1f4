"""Another scale, another scenario, further pieces anchored: classes and routes beside the present ones.

Nothing is written: the workbook as it is held is assessed anew with other settings, by the formulas.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from assess.errors import AssessError, InputError
from assess.i18n import fill, gettext, load_catalogue, speaking
from assess.model import Inventory
from assess.pipeline.run import evaluate_route_tables, list_first_fixes
from assess.pipeline.what_if import anchor_named, spell_names
from assess.progress import SILENT
from assess.settings import SCENARIOS, Settings
from assess.web.evaluation import BY_FORMULAS, Evaluation, evaluate_once, evaluate_other
from assess.web.live import count_classes, describe_rows, list_quantities, list_rows, say_fault
from assess.web.route_states import describe_states, describe_unknown
from assess.workbook.names import key
from assess.workbook.parse import Tables

if TYPE_CHECKING:
    from assess.web.snapshot import Snapshot

ASKED = ("scale", "scenario", "anchor", "first")
"""What a request may hold."""
FAR = 1e6
"""A scale beyond this is no number that anyone means [-]."""
LONGEST = 40
"""Characters of a wrong value that a message repeats."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is asked for: settings with the pieces to anchor by their names, and how many of the first fixes besides."""

    settings: Settings
    first: int


def try_out(snapshot: "Snapshot", request: object) -> dict[str, Any]:
    """Return the answer of `POST /api/what-if`.

    `request`: a mapping with any of "scale", "scenario", "anchor" (names of pieces) and "first" (a number of fixes).
    Raises InputError if the request is none of these, or names a piece that is not assessed.
    """
    inventory = snapshot.inventory
    with speaking(load_catalogue(inventory.language)):
        wanted = read_request(inventory, snapshot.tables, request)
        before = snapshot.keep("before", lambda: describe_present(snapshot))
        present = snapshot.keep("entries", lambda: _name_entries(evaluate_once(snapshot, BY_FORMULAS, routes=True)))
        entries = (
            present
            if wanted.settings == BY_FORMULAS or not wanted.first
            else _name_entries(evaluate_other(snapshot, wanted.settings))
        )
        first = entries[: wanted.first]
        settings = replace(wanted.settings, anchor=_join_names(wanted.settings, first))
        after = before if settings == BY_FORMULAS else describe_side(snapshot, settings)
        scenarios = _list_scenarios(inventory)
    named = set(settings.anchor if isinstance(settings.anchor, tuple) else ())
    return {
        "version": snapshot.version,
        "scenarios": scenarios,
        "scenario": settings.scenario or inventory.building.scenario_kind or SCENARIOS[0],
        "entries": len(entries),
        "first": len(first),
        "before": before["side"],
        "after": after["side"],
        "anchored": [one.row for one in inventory.items if one.item in named],
        "error": after["error"],
    }


def read_request(inventory: Inventory, tables: Tables, request: object) -> Wanted:
    """Return what a request asks for; InputError if it cannot be read, or names a piece that is not assessed."""
    if not isinstance(request, Mapping):
        raise InputError(fill("The request cannot be read."))
    unknown = [str(name) for name in request if name not in ASKED]
    if unknown:
        known = ", ".join(ASKED)
        raise InputError(fill("{name} is not known, expected one of: {known}.", name=_show(unknown[0]), known=known))
    given = {name: value for name, value in request.items() if value is not None}
    names = _read_names(given.get("anchor", ()))
    _check_left_out(inventory, tables, names)
    scale, scenario = _read_scale(given.get("scale", 1.0)), given.get("scenario") or None
    settings = replace(BY_FORMULAS, scale=scale, scenario=scenario, anchor=spell_names(inventory, names))
    return Wanted(settings, _read_first(given.get("first", 0)))


def _read_scale(value: Any) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not abs(value) < FAR:  # NaN among them
        raise InputError(fill("scale is {value}, expected a number.", value=_show(value)))
    return float(value)


def _read_first(value: object) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise InputError(fill("first is {value}, expected a whole number, 0 or above.", value=_show(value)))
    return value


def _read_names(value: object) -> tuple[str, ...]:
    if isinstance(value, str) or not isinstance(value, Sequence) or not all(isinstance(one, str) for one in value):
        raise InputError(fill("anchor is {value}, expected a list of names of items.", value=_show(value)))
    return tuple(dict.fromkeys(one.strip() for one in value if one.strip()))


def _check_left_out(inventory: Inventory, tables: Tables, names: Iterable[str]) -> None:
    known = {key(one.item) for one in inventory.items}
    rows = {key(row.get("item")): row.number for row in tables["Items"].with_all("item")}
    for name in names:
        if key(name) not in known and key(name) in rows:
            message = fill("{name} cannot be anchored: its row {row} has an error or a blank.", name=_show(name),
                           row=rows[key(name)])  # fmt: skip
            raise InputError(message)


def _show(value: object) -> str:
    shown = repr(value) if isinstance(value, str) else str(value)
    return shown if len(shown) <= LONGEST else f"{shown[:LONGEST]}..."


def _name_entries(found: Evaluation) -> list[list[str]]:
    if found.assessment is None:
        return []
    items, routes = found.assessment.inventory.items, evaluate_route_tables(found.assessment, SILENT)
    return [[items[at].item for at in entry] for entry in list_first_fixes(found.assessment, routes)]


def _join_names(settings: Settings, entries: Iterable[Iterable[str]]) -> tuple[str, ...]:
    named = settings.anchor if isinstance(settings.anchor, tuple) else ()
    return tuple(dict.fromkeys((*named, *(name for entry in entries for name in entry))))


def describe_present(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the side "before", which is the same for every request."""
    return _describe_side(snapshot, snapshot.inventory, evaluate_once(snapshot, BY_FORMULAS, routes=True))


def describe_side(snapshot: "Snapshot", settings: Settings) -> dict[str, Any]:
    """Return classes, counts and routes with other settings, and the error where nothing can be computed."""
    named = settings.anchor if isinstance(settings.anchor, tuple) else ()
    return _describe_side(snapshot, anchor_named(snapshot.inventory, named), evaluate_other(snapshot, settings))


def _describe_side(snapshot: "Snapshot", inventory: Inventory, found: Evaluation) -> dict[str, Any]:
    tables = snapshot.tables
    rows = list_rows(tables, inventory, found, ())
    items = describe_rows(rows.items())
    del items["values"]
    try:
        routes = describe_states(tables, inventory, found)
    except AssessError as error:
        routes = describe_unknown(tables, gettext(error.message))
    side = {
        "counts": count_classes(rows, list_quantities(tables["Items"])),
        "items": items,
        "routes": routes["routes"],
        "rooms": routes["rooms"],
    }
    return {"side": side, "error": say_fault(snapshot.problems, found) or routes["error"]}


def _list_scenarios(inventory: Inventory) -> list[list[str]]:
    own = inventory.building.scenario_kind or SCENARIOS[0]
    found = []
    for one in SCENARIOS:
        name = gettext(one)
        found.append([one, gettext("{scenario} (the workbook's own)", scenario=name) if one == own else name])
    return found
