"""A workbook with its corrections written into it: the cells that were understood although typed in another way.

Only those cells change, and the stored results of the live columns, which rest on them.
"""

import hashlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from assess.errors import Correction, WorkbookError
from assess.i18n import LANGUAGES, load_catalogue, speaking
from assess.model import Inventory
from assess.pipeline.live_values import live_values
from assess.progress import SILENT, Progress
from assess.workbook.names import find_live, is_live, plain, split_header
from assess.workbook.open import UNSAVED, Place
from assess.workbook.parse import Tables
from assess.workbook.patch import Value
from assess.workbook.plain_rows import split_address
from assess.workbook.read import build_inventory, open_workbook, parse_workbook, read_inventory
from assess.workbook.records import Files
from assess.workbook.schema import ITEMS, LISTS, LIVE
from assess.workbook.store import Workbook

LiveRows = Mapping[int, list[float | str]]
"""What the live columns show, by the row of the item."""


@dataclass(frozen=True, slots=True)
class Corrected:
    """A corrected workbook.

    * `inventory`: what it holds, read with ``strict=False``; its `data` are the corrected bytes.
    * `changed`, `kept`: what was written, and what was not, as the cell holds a formula.
    """

    inventory: Inventory
    changed: tuple[Correction, ...]
    kept: tuple[Correction, ...]


def correct_workbook(path: Path, progress: Progress = SILENT) -> Corrected:
    """Read a workbook and write its corrections into a copy of its bytes; no file is written.

    Files that it names are looked for in its folder. `progress` gets the stage "reading". Raises WorkbookError if it
    cannot be opened, or if a cell cannot be changed with certainty.
    """
    found = read_inventory(path, strict=False, progress=progress)
    if not found.corrections:
        return Corrected(found, (), ())
    workbook = open_workbook(found.data or b"", path.name, progress)
    values: dict[str, dict[Place, Value]] = {}
    changed, kept = list[Correction](), list[Correction]()
    for one in found.corrections:
        column, row = split_address(one.cell) or (0, 0)
        if (row, column - 1) in workbook.sheet(one.sheet).marks.formulas:
            kept.append(one)
        else:
            changed.append(one)
            values.setdefault(one.sheet, {})[row, column - 1] = one.value
    if not changed:
        return Corrected(found, (), tuple(kept))
    workbook = workbook.set(workbook.by_english(values))
    data, inventory = write_workbook(workbook, path, path.resolve().parent, progress)
    hashed = hashlib.sha256(data).hexdigest()
    return Corrected(replace(inventory, sha256=hashed, data=data), tuple(changed), tuple(kept))


def write_workbook(
    workbook: Workbook, path: Path, records: Files, progress: Progress = SILENT
) -> tuple[bytes, Inventory]:
    """Return the bytes of an edited workbook with the stored results that follow, and what it holds now.

    `records` are the files that it names, or their folder. Raises WorkbookError if a cell cannot be changed with
    certainty.
    """
    tables, problems = parse_workbook(workbook)
    inventory = build_inventory(tables, problems, path, records, progress)
    return workbook.store(find_results(workbook, tables, inventory)).to_bytes(progress), inventory


# ---------------------------------------------------------------- stored results

_WIDE = frozenset({"Building", "Floors", "Catalogue"})
"""Sheets on which the live columns of every row, and the helper columns of Lists, rest."""
_IDLE = ("latitude", "longitude", "azimuth_deg", "report_date", "logo", "hazard", "language")
"""Lines of Building on which no live column rests, and that may be wrong: a logo is missing until it is handed over."""
_CLOSE = 1e-9
"""Relative difference up to which a stored number is left as it is: programs write 15 to 17 digits."""


def find_results(
    workbook: Workbook, tables: Tables, inventory: Inventory, was: LiveRows | None = None
) -> dict[str, dict[Place, Value]]:
    """Return the stored results of live formulas that edits have made wrong, by sheet and cell, for `Workbook.store`.

    LibreOffice keeps stored results when it opens a workbook, although the workbook asks for recalculation. Those of
    the live columns of Items become what the core computes; those of the columns that they rest on, and of the sheet
    Lists, are taken out, so that every program computes them. `was` is what the live columns showed before the edits:
    rows that were not edited and show the same keep what is stored; None: every row is compared.
    """
    edited = {name for name, one in workbook.sheets.items() if one.is_changed}
    is_wide = not _WIDE.isdisjoint(edited)
    found: dict[str, dict[Place, Value]] = {}
    for title in workbook.titles if is_wide else ():
        if plain(title) in {plain(load_catalogue(code).find(LISTS)) for code in LANGUAGES}:
            lists = workbook.sheet(title)
            filled = (place for place in lists.marks.formulas if lists.value(place) not in (None, UNSAVED))
            found[title] = dict.fromkeys(filled)
    items, header = workbook.sheets.get(ITEMS.name), tables[ITEMS.name].header
    heads = items.cells.get(header, {}).items() if items and header else ()
    labels = {at: split_header(text)[0] for at, text in heads if isinstance(text, str)}
    columns = {at: find_live(text) or "" for at, text in labels.items() if is_live(ITEMS, text)}
    if items is None or not columns:
        return found
    rows, results = find_live_rows(tables, inventory), dict[Place, Value]()
    for row, at in sorted(items.marks.formulas):
        if at not in columns or row <= header:
            continue
        now, stored = rows.get(row), items.value((row, at))
        if was is not None and not is_wide and row not in items.edited and was.get(items.opened_row(row) or 0) == now:
            continue
        shown = None if now is None or columns[at] not in LIVE else now[LIVE.index(columns[at])]
        if shown is None and stored not in (None, UNSAVED):
            results[row, at] = None
        elif shown is not None and not _is_stored(stored, shown):
            results[row, at] = shown
    return {**found, ITEMS.name: results}


def _is_stored(stored: object, shown: float | str) -> bool:
    if isinstance(shown, str) or isinstance(stored, bool) or not isinstance(stored, int | float):
        return (stored or "") == shown
    return math.isclose(stored, shown, rel_tol=_CLOSE)


def find_live_rows(tables: Tables, inventory: Inventory) -> LiveRows:
    """Return the results of the live columns by the row of the item.

    None where the building lacks its motion, or where a line of Building on which they rest is wrong: the formulas tell
    of it, the core leaves it out.
    """
    building = tables["Building"]
    harmless = {building.cell(name, 0) for name in _IDLE if name in building.places}
    wrong = (one.cell for one in inventory.problems if one.severity == "error" and one.sheet == building.sheet.name)
    if not harmless.issuperset(wrong):
        return {}
    try:
        with speaking(load_catalogue(inventory.language)):
            rows = live_values(inventory)
    except WorkbookError:
        return {}
    return {item.row: row for item, row in zip(inventory.items, rows, strict=True)}


# ---------------------------------------------------------------- what was done, in words


def group_corrections(corrections: Iterable[Correction]) -> list[list[Correction]]:
    """Return corrections of one kind in one column of a sheet together, each in the order of the cells."""
    groups: dict[tuple[str, str, str], list[Correction]] = {}
    for one in corrections:
        groups.setdefault((one.sheet, one.cell.rstrip("0123456789"), str(one.why)), []).append(one)
    return [sorted(group, key=lambda one: (split_address(one.cell) or (0, 0))[1]) for group in groups.values()]
