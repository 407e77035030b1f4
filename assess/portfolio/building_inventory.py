"""The inventory of one building of a portfolio: surveyed (its workbook), handed over (COBie), or assumed.

What is assumed, was left out of a handover file, or is not as the index says, is among the problems of the inventory.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from assess.bim.cobie import is_cobie, read_cobie
from assess.bim.import_workbook import ImportedBuilding, list_remarks, list_rows
from assess.errors import Problem, WorkbookError
from assess.i18n import fill, join
from assess.model import Building, Inventory
from assess.motion.site_ground import GroundField
from assess.portfolio.assumed_inventory import build_assumed
from assess.portfolio.building_rows import Origin, spell_use
from assess.portfolio.index_file import IndexRow
from assess.portfolio.sources import Source
from assess.workbook.names import key
from assess.workbook.read import Rows, read_inventory
from assess.workbook.schema import BUILDING

APART = 0.01
"""Degrees, some 1 km, by which a place of the index may differ from that of the workbook."""
ROUGH = 0.01
"""Share by which a height of the index may differ."""


def read_building(source: Source, data: bytes | None, ground: GroundField | None) -> tuple[Origin, Inventory]:
    """Return where the pieces of a building come from, and its inventory; `data` is its file, where it can be read.

    Raises
    ------
    WorkbookError
        If its workbook or its COBie file cannot be used.
    InputError
        If no inventory can be assumed, or its place lies outside the ground motion of the run.
    """
    if source.kind == "assumed" and source.index is not None:
        assumed = build_assumed(source.index)
        origin = Origin(inventory="assumed", low=assumed.low, high=assumed.high)
        return origin, _read_rows(assumed.rows, assumed.problems, {}, ground)
    if source.file is None:
        raise WorkbookError([Problem("error", "", "", fill("it has no workbook."))])
    row = source.index or IndexRow()
    if data is not None and is_cobie(data):
        imported = read_cobie(data, source.file.name)
        left_out = sum(one.count for one in imported.skipped if one.is_furniture)
        origin = Origin(inventory="handover", left_out=left_out)
        return origin, _compare(_read_handover(imported, source.file, row, ground), row, is_survey=False)
    inventory = read_inventory(source.file, building=row.as_building(), ground=ground)
    return Origin(inventory="surveyed"), _compare(inventory, row, is_survey=True)


def _read_handover(imported: ImportedBuilding, file: Path, row: IndexRow, ground: GroundField | None) -> Inventory:
    """Return the inventory of a COBie file; WorkbookError with what was left out where no furniture is found."""
    if row.building:  # what a building model calls itself is no name that people gave it
        imported = replace(imported, building={**imported.building, "building": row.building})
    remarks = list_remarks(imported)
    if not imported.items:
        fault = fill("no furniture with sizes is found in the COBie file.")
        fix = fill("Fill in NominalLength, NominalWidth and NominalHeight of its Moveable types.")
        raise WorkbookError([Problem("error", "", "", fault, fix), *remarks])
    return replace(_read_rows(list_rows(imported), remarks, row.as_building(), ground), source=file)


def _read_rows(
    rows: Rows, problems: tuple[Problem, ...], filled: dict[str, Any], ground: GroundField | None
) -> Inventory:
    inventory = read_inventory(rows, building=filled, ground=ground)
    return replace(inventory, problems=(*problems, *inventory.problems))


def _compare(inventory: Inventory, row: IndexRow, *, is_survey: bool) -> Inventory:
    """Return an inventory with a warning where the index says something else of the building."""
    found = list(_list_other(row, inventory.building))
    if not found:
        return inventory
    index = join(", ", [join(" ", (fill(label), value)) for label, value, _ in found])
    own = join(", ", [value for _, _, value in found])
    if is_survey:
        fault = fill("the index says {index}; the workbook says {own}: the workbook holds.", index=index, own=own)
        fix = fill("Check that the line of the index belongs to this workbook.")
    else:
        fault = fill("the index says {index}; the COBie file says {own}: the COBie file holds.", index=index, own=own)
        fix = fill("Check that the line of the index belongs to this COBie file.")
    warning = Problem("warning", inventory.sheets.get(BUILDING.name, BUILDING.name), "", fault, fix)
    return replace(inventory, problems=(warning, *inventory.problems))


def _list_other(row: IndexRow, building: Building) -> Iterator[tuple[str, str, str]]:
    """Yield label, value in the index and value in the workbook of what the index gives and the workbook has other."""
    for name, value in row.as_building().items():
        own = getattr(building, name)
        if own not in (None, "") and name in _ALIKE and not _ALIKE[name](value, own):
            yield BUILDING.column(name).label, _show(value), _show(own)


def _show(value: str | float) -> str:
    return value if isinstance(value, str) else fill("{value:.7g}", value=value)


def _is_near(one: float, other: float) -> bool:
    """Tell whether two latitudes or longitudes are of one place, as far as registers give it."""
    return abs((one - other + 180) % 360 - 180) <= APART


_ALIKE: Mapping[str, Callable[[Any, Any], bool]] = {
    "building": lambda one, other: key(one) == key(other),
    "latitude": _is_near,
    "longitude": _is_near,
    "use": lambda one, other: key(spell_use(one)) == key(spell_use(other)),
    "storeys": lambda one, other: bool(one == other),
    "height": lambda one, other: math.isclose(one, other, rel_tol=ROUGH),
}
"""Whether the index and the workbook mean the same, by field of Building."""
