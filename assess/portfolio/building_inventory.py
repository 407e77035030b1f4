"""The inventory of one building of a portfolio: surveyed (its workbook), handed over (COBie), or assumed.

What is assumed, or was left out of a handover file, is among the problems of the inventory.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

from assess.bim.cobie import is_cobie, read_cobie
from assess.bim.import_workbook import ImportedBuilding, list_remarks, list_rows
from assess.errors import Problem, WorkbookError
from assess.i18n import fill
from assess.model import Inventory
from assess.motion.site_ground import GroundField
from assess.portfolio.assumed_inventory import build_assumed
from assess.portfolio.building_rows import Origin
from assess.portfolio.index_file import IndexRow
from assess.portfolio.sources import Source
from assess.workbook.read import Rows, read_inventory


def read_building(source: Source, data: bytes | None, ground: GroundField | None) -> tuple[Origin, Inventory]:
    """Return where the pieces of a building come from, and its inventory.

    Parameters
    ----------
    source : Source
        The building.
    data : bytes, optional
        Its file, where it could be read.
    ground : GroundField, optional
        The ground motion of the run.

    Raises
    ------
    WorkbookError
        If its workbook or its COBie file cannot be used.
    InputError
        If no inventory can be assumed, or its place lies outside the ground motion.
    """
    if source.kind == "assumed" and source.index is not None:
        return _read_assumed(source.path, source.index, ground)
    if source.file is None:
        raise WorkbookError([Problem("error", "", "", fill("it has no workbook."))])
    filled = {} if source.index is None else source.index.as_building()
    if data is not None and is_cobie(data):
        imported = read_cobie(data, source.file.name)
        left_out = sum(one.count for one in imported.skipped if one.is_furniture)
        origin = Origin(path=source.path, inventory="handover", index=source.index, left_out=left_out)
        return origin, _read_handover(imported, source.file, filled, ground)
    inventory = read_inventory(source.file, building=filled, ground=ground)
    return Origin(path=source.path, inventory="surveyed", index=source.index), inventory


def _read_assumed(path: str, row: IndexRow, ground: GroundField | None) -> tuple[Origin, Inventory]:
    assumed = build_assumed(row)
    origin = Origin(path=path, inventory="assumed", index=row, low=assumed.low, high=assumed.high)
    return origin, _read_rows(assumed.rows, assumed.problems, {}, ground)


def _read_handover(
    imported: ImportedBuilding, file: Path, filled: dict[str, Any], ground: GroundField | None
) -> Inventory:
    """Return the inventory of a COBie file; WorkbookError with what was left out where no furniture is found."""
    remarks = list_remarks(imported)
    if not imported.items:
        fault = fill("no furniture with sizes is found in the COBie file.")
        fix = fill("Fill in NominalLength, NominalWidth and NominalHeight of its Moveable types.")
        raise WorkbookError([Problem("error", "", "", fault, fix), *remarks])
    return replace(_read_rows(list_rows(imported), remarks, filled, ground), source=file)


def _read_rows(
    rows: Rows, problems: tuple[Problem, ...], filled: dict[str, Any], ground: GroundField | None
) -> Inventory:
    inventory = read_inventory(rows, building=filled, ground=ground)
    return replace(inventory, problems=(*problems, *inventory.problems))
