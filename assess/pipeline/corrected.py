"""A workbook with its corrections written into it: the cells that were understood although typed in another way.

Only those cells change, and the stored results of the live columns, which rest on them.
"""

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

from assess.errors import Correction, WorkbookError
from assess.i18n import LANGUAGES, load_catalogue, speaking
from assess.model import Inventory
from assess.pipeline.live_values import live_values
from assess.progress import SILENT, Progress
from assess.workbook.held import list_formulas
from assess.workbook.names import find_live, is_live, plain, split_header
from assess.workbook.open import HEADER_ROWS, Book
from assess.workbook.patch import Value, Values, patch_workbook
from assess.workbook.plain_rows import column_letters, split_address
from assess.workbook.read import read_inventory
from assess.workbook.schema import ITEMS, LISTS, LIVE


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
    data, name = found.data or b"", path.name
    formulas = {sheet: list_formulas(data, sheet, name=name) for sheet in {one.sheet for one in found.corrections}}
    kept = tuple(one for one in found.corrections if one.cell in formulas[one.sheet])
    changed = tuple(one for one in found.corrections if one.cell not in formulas[one.sheet])
    if not changed:
        return Corrected(found, (), kept)
    changes: dict[str, dict[str, Value]] = {}
    for one in changed:
        changes.setdefault(one.sheet, {})[one.cell] = one.value
    patched = patch_workbook(data, changes, name=name, progress=progress).data
    inventory = read_inventory(patched, records=path.resolve().parent, strict=False, progress=progress)
    results = find_results(patched, inventory)
    patched = patch_workbook(patched, {}, results, name=name, progress=progress).data
    hashed = hashlib.sha256(patched).hexdigest()
    return Corrected(replace(inventory, source=path, sha256=hashed, data=patched), changed, kept)


# ---------------------------------------------------------------- stored results


def find_results(data: bytes, inventory: Inventory) -> dict[str, Values]:
    """Return what the live columns of a workbook have to store, by sheet and cell, for `patch_workbook`.

    The results of the live columns of each item; None, by which every program computes them, for columns that they rest
    on and for rows that cannot be used. LibreOffice keeps stored results when it opens a workbook, although the
    workbook asks for recalculation.
    """
    with Book(data, inventory.file_name) as book:
        sheets = list(book.sheets)
        lists = [name for name in sheets if is_lists(name)]
        items = inventory.sheets.get(ITEMS.name, ITEMS.name)
        columns = _find_columns(book, items) if items in sheets else {}
    results: dict[str, Values] = {name: dict.fromkeys(list_formulas(data, name)) for name in lists}
    if columns:
        rows, found = find_live_rows(inventory), dict[str, Value]()
        results[items] = found
        for address, is_filled in list_formulas(data, items).items():
            letters = address.rstrip("0123456789")
            if letters in columns:
                row, header = rows.get(int(address[len(letters) :])), columns[letters]
                if row is not None and header in LIVE:
                    found[address] = row[LIVE.index(header)]
                elif row is not None or is_filled:
                    found[address] = None
    return {sheet: values for sheet, values in results.items() if values}


def is_lists(name: str) -> bool:
    """Tell whether a sheet is the one that holds what drop-downs and live columns refer to."""
    return plain(name) in {plain(load_catalogue(code).find(LISTS)) for code in LANGUAGES}


def _find_columns(book: Book, sheet: str) -> dict[str, str]:
    """Return the header, of `LIVE` or `WORKINGS`, of each column that Excel computes, by its letters."""
    best: dict[str, str] = {}
    for _, cells in islice(book.cells(sheet).rows(), HEADER_ROWS):
        heads = {at: split_header(value)[0] for at, value in cells.items() if isinstance(value, str)}
        found = {column_letters(at): find_live(text) or "" for at, text in heads.items() if is_live(ITEMS, text)}
        best = max(best, found, key=len)
    return best


def find_live_rows(inventory: Inventory) -> dict[int, list[float | str]]:
    """Return the results of the live columns by the row of the item; none where the building lacks its motion."""
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
