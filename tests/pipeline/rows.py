"""Inventories of rows in code, with the files of a folder that they name: a hundredth of the time of a workbook."""

from pathlib import Path
from typing import Any

import assess
from assess.model import Inventory
from assess.motion.site_ground import GroundField
from assess.results import Results
from assess.settings import Settings
from tests.workbooks import FLOORS, UNVERIFIED

Rows = list[dict[str, Any]]


def read(
    items: Rows, floors: Rows = FLOORS, folder: Path | None = None, ground: GroundField | None = None, **building: Any
) -> Inventory:
    """Return the inventory of such rows."""
    return read_sheets(folder, ground, Building=[building], Floors=floors, Items=items)


def read_sheets(folder: Path | None = None, ground: GroundField | None = None, **sheets: Rows) -> Inventory:
    """Return the inventory of rows of sheets."""
    return assess.read_inventory(sheets, records=folder, ground=ground)


def assessed(
    items: Rows, floors: Rows = FLOORS, folder: Path | None = None, settings: Settings = UNVERIFIED, **building: Any
) -> Results:
    """Return the results of such rows, by the formulas alone where no settings are given."""
    return assess.run(read(items, floors, folder, **building), settings, figures=False)
