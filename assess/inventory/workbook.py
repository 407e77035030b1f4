"""The workbook: from its tables to the inventory."""

import hashlib
from pathlib import Path

from assess.inventory.book import find_language, read_tables
from assess.inventory.cells import CellError
from assess.inventory.files import find_picture
from assess.inventory.floors import FloorReader
from assess.inventory.items import ItemReader, check_plan_sides
from assess.inventory.labels import key
from assess.inventory.model import Building, CatalogueType, Inventory
from assess.inventory.names import check_unique, check_wildcards
from assess.inventory.routes import read_places, read_routes
from assess.inventory.tables import Table, raise_errors


def read_inventory(path: str | Path) -> Inventory:
    """Read and check a workbook.

    Parameters
    ----------
    path : str or Path
        The .xlsx (or .xlsm, whose macros are never run). Records are looked for beside it.

    Returns
    -------
    Inventory
        In SI units, with the warnings and notes of the check.

    Raises
    ------
    WorkbookError
        If anything in it cannot be used; its `problems` name every sheet and cell.
    """
    path = Path(path)
    tables, problems = read_tables(path)
    folder = path.resolve().parent
    building = _read_building(tables["Building"], folder)
    catalogue = _read_catalogue(tables["Catalogue"])
    floors = FloorReader(tables["Floors"], folder, building, _has_ground(tables["Building"]))
    found = floors.read()
    places = read_places(tables)
    routes = read_routes(tables)
    items = ItemReader(tables, building, {key(one.type): one for one in catalogue}).read()
    raise_errors(problems, [table.sheet.name for table in tables.values()])
    return Inventory(
        source=path,
        sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
        building=building,
        floors=found,
        items=items,
        places=places,
        routes=routes,
        catalogue=catalogue,
        problems=tuple(problems),
        extra_columns=tables["Items"].extra,
        files=floors.hashes,
        language=find_language(tables.values()),
        sheets={name: table.sheet.name for name, table in tables.items()},
        letters={name: table.letters for name, table in tables.items()},
    )


def _read_building(table: Table, folder: Path) -> Building:
    values = {name: value for name, value in table.form.items() if value is not None}
    if "logo" in values:
        try:
            values["logo"] = find_picture(values["logo"], folder)
        except CellError as error:
            table.report(f"B{table.lines['logo']}", error.message, error.mend)
            values["logo"] = None
    return Building(**values, cells={name: f"B{line}" for name, line in table.lines.items()})


def _has_ground(table: Table) -> bool:
    """Tell whether the building's form says anything of the ground motion, be it readable or not."""
    return any(
        table.form.get(name) is not None or name in table.blind or f"B{table.lines.get(name)}" in table.failed
        for name in ("ground_pga", "sds")
    )


def _read_catalogue(table: Table) -> tuple[CatalogueType, ...]:
    check_unique(table, "type")
    check_wildcards(table, "type")
    for row in table.rows:
        check_plan_sides(table, row.number, row.values)
    return tuple(CatalogueType(row=row.number, **row.filled()) for row in table.with_all("type"))
