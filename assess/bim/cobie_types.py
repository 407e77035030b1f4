"""The types of a COBie file: what is furniture, its sizes, and the unit of the whole file."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from assess.bim.cobie_sheets import CobieSheet, say
from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill
from assess.units import LENGTH, read_unit
from assess.workbook.habits import CellError
from assess.workbook.names import key
from assess.workbook.open import UNSAVED
from assess.workbook.ranges import is_within
from assess.workbook.schema import CATALOGUE, Column
from assess.workbook.values import read_cell, shorten

MOVEABLE, FIXED = frozenset({"moveable", "movable", "mobile"}), frozenset({"fixed"})
"""AssetType as COBie 2.4 writes it, and as files have it."""
SIZES = ("NominalLength", "NominalWidth", "NominalHeight")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)


@dataclass(frozen=True, slots=True)
class CobieType:
    """One type: sizes in m, or the reason why its components are left out.

    `is_furniture` is False where the file says that it is fixed.
    """

    name: str
    breadth: float = math.nan
    width: float = math.nan
    height: float = math.nan
    reason: Text | None = None
    is_furniture: bool = True

    def sizes_cm(self) -> dict[str, float]:
        """Return its sizes by field, in cm."""
        return {name: round(100 * getattr(self, name), 2) for name in ("breadth", "width", "height")}


def find_unit(sheet: CobieSheet) -> str:
    """Return the unit of lengths of the file, one of `assess.units.LENGTH`.

    Raises WorkbookError if LinearUnits is blank or names no unit that sizes of furniture are given in.
    """
    number, row = sheet.rows[0] if sheet.rows else (2, {})
    typed = say(row.get("LinearUnits"))
    found = next((unit for text in (typed, f"{typed}s") if (unit := read_unit(text)) in LENGTH), None)
    if found is None:
        message = fill("LinearUnits is blank, so that no size can be read.")
        if typed:
            message = fill("LinearUnits is {unit}, which is not read.", unit=shorten(typed))
        fix = fill("Write the unit of NominalHeight: millimeters, centimeters, meters, inches or feet.")
        cell = f"{sheet.letters['LinearUnits']}{number}"
        raise WorkbookError([Problem("error", sheet.name, cell, message, fix)])
    return found


def check_unit(facility: CobieSheet, types: CobieSheet, unit: str) -> None:
    """Refuse the unit of a file if no size of its furniture is in range in it, and most are in another.

    Raises WorkbookError if so; it names the cell of LinearUnits.
    """
    sizes = [
        (say(row.get("Name")), column, number)
        for _, row in types.rows
        if say(row.get("AssetType")).casefold() in MOVEABLE
        for column in SIZES
        if (number := read_number(row.get(column)))
    ]
    fits = {one: sum(is_within(CATALOGUE.column("height"), size, one) for *_, size in sizes) for one in LENGTH}
    others = [one for one in LENGTH if 2 * fits[one] > len(sizes)]
    if fits[unit] or not others:
        return
    name, column, number = sizes[0]
    line, row = facility.rows[0]
    message = fill(
        "LinearUnits is {unit}, but all sizes of furniture are out of range in that unit: {column} of {name} would be "
        "{number:g} {short}.",
        unit=shorten(say(row.get("LinearUnits"))), column=column, name=shorten(name), number=number, short=unit,
    )  # fmt: skip
    fix = fill("Check LinearUnits: in {units} most of them are in range.", units=", ".join(others))
    raise WorkbookError([Problem("error", facility.name, f"{facility.letters['LinearUnits']}{line}", message, fix)])


def read_types(sheet: CobieSheet, unit: str) -> dict[str, CobieType]:
    """Return the types by their names as names are compared; of two alike the first."""
    found: dict[str, CobieType] = {}
    for _, row in sheet.rows:
        name = say(row.get("Name"))
        if name:
            found.setdefault(key(name), _read_type(name, row, unit))
    return found


def _read_type(name: str, row: Mapping[str, Any], unit: str) -> CobieType:
    kind = CobieType(name)
    asset = say(row.get("AssetType"))
    if asset.casefold() in FIXED:
        return replace(kind, reason=fill("AssetType is Fixed"), is_furniture=False)
    if asset.casefold() not in MOVEABLE:
        reason = fill("AssetType is blank, so that it is not known whether they are furniture")
        if asset:
            reason = fill("AssetType is {value}, expected Fixed or Moveable", value=shorten(asset))
        return replace(kind, reason=reason)
    missing = [column for column in SIZES if _is_missing(row.get(column))]
    if missing:
        return replace(kind, reason=fill("no {columns}", columns=", ".join(missing)))
    try:
        length, width, height = (read_length(CATALOGUE.column("height"), one, row[one], unit) for one in SIZES)
    except CellError as error:
        return replace(kind, reason=fill("{message}", message=error.message.rstrip(".")))
    return replace(kind, breadth=min(length, width), width=max(length, width), height=height)


def read_length(column: Column, label: str, value: object, unit: str) -> float:
    """Return a length [m] within the limits of a column of the inventory.

    Numbers stored as texts are read as programs write them, with a point as the decimal sign.

    Raises CellError if it is no number, or out of the limits.
    """
    typed = read_number(value)
    found, _ = read_cell(replace(column, label=label), value if typed is None else typed, unit)
    if not isinstance(found, float):
        raise CellError(fill("{label} is blank.", label=label))
    return found


def read_number(value: object) -> float | None:
    """Return the number of a cell, also where it is stored as a text; None where it is none."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    text = value.strip() if isinstance(value, str) else ""
    number = float(text) if _NUMBER.fullmatch(text) else math.nan
    return number if math.isfinite(number) else None


def _is_missing(value: object) -> bool:
    """Tell whether a size is blank or 0, as programs write one that they do not know."""
    return value is None or value is UNSAVED or read_number(value) == 0
