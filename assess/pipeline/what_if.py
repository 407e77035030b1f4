"""What if some pieces were anchored, and their anchors held."""

import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from difflib import get_close_matches
from typing import NoReturn

from assess.errors import Problem, SettingsError
from assess.i18n import fill, join
from assess.model import Inventory
from assess.pipeline.anchors import find_held, find_spread
from assess.pipeline.assessment import Assessment
from assess.schedule_results import ScheduleRow
from assess.workbook.names import key

_FIRST = re.compile(r"\s*first\s*(:|$)", re.IGNORECASE)
"""What begins as the form that names the first entries of the schedule."""


def spell_names(inventory: Inventory, names: Sequence[str]) -> tuple[str, ...]:
    """Return the names of items as the workbook spells them, each once.

    Raises SettingsError if there is no item of a name, or a name is meant as ``first:N`` and is not.
    """
    known = {key(one.item): one.item for one in inventory.items} if names else {}
    return tuple(dict.fromkeys(known[key(name)] if key(name) in known else _refuse(inventory, name) for name in names))


def _refuse(inventory: Inventory, name: str) -> NoReturn:
    if _FIRST.match(name):
        raise SettingsError.about(
            "anchor is {name!r}, expected first:N with a whole number N of at least 1, alone, or names of items.",
            name=name,
        )
    fault = fill("anchor: there is no item {name!r} in Items.", name=name)
    near = get_close_matches(name, [one.item for one in inventory.items], 1, 0.6)
    raise SettingsError(join(" ", (fault, *(fill("Did you mean {name}?", name=repr(one)) for one in near))))


def anchor_named(inventory: Inventory, names: Sequence[str]) -> Inventory:
    """Return an inventory in which the items of these names are anchored, with brackets that hold.

    Its problems get a note on each that the workbook has as anchored already. Raises SettingsError as `spell_names`.
    """
    if not names:
        return inventory
    wanted = set(spell_names(inventory, names))
    indices = {at for at, one in enumerate(inventory.items) if one.item in wanted}
    already = [inventory.items[at].item for at in sorted(indices) if inventory.items[at].anchored == "yes"]
    said = (fill("Item {name!r} is anchored already: its anchor is taken to hold.", name=name) for name in already)
    notes = [Problem("note", "Items", "", message) for message in said]
    return replace(_anchor(inventory, indices), problems=(*inventory.problems, *notes))


def anchor_first(assessment: Assessment, rows: Sequence[ScheduleRow]) -> Assessment:
    """Return an assessment in which the pieces of the first entries of its schedule are anchored and hold.

    Nothing is simulated again: whether a piece is anchored changes no motion and no rocking. Raises SettingsError if
    the schedule has fewer entries.
    """
    wanted = assessment.settings.anchor
    if isinstance(wanted, int) and wanted > len(rows):
        raise SettingsError.about(
            "anchor: first:{wanted:,} is more than the {n:,} entries of the schedule", wanted=wanted, n=len(rows)
        )
    held = {index for row in rows[: wanted if isinstance(wanted, int) else 0] for index in row.item_indices}
    inventory = _anchor(assessment.inventory, held)
    cases, governing = assessment.cases, assessment.governing
    found = find_held(inventory, cases.pfa[governing], find_spread(cases)[governing])
    return replace(assessment, inventory=inventory, held=found)


def _anchor(inventory: Inventory, indices: Collection[int]) -> Inventory:
    items = (
        replace(one, anchored="yes", bracket_capacity=None) if at in indices else one
        for at, one in enumerate(inventory.items)
    )
    return replace(inventory, items=tuple(items))
