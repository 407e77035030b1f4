"""The bytes of an edited workbook: the cells that differ, and the stored results of live formulas that follow them.

LibreOffice keeps stored results when it opens a workbook, although the workbook asks for recalculation. Those that an
edit makes wrong are therefore replaced, too: of the live columns of Items by what the core computes; of the helper
columns beside them, and on the sheet Lists, by nothing, so that every program computes them. All others stay.
"""

import math
from collections.abc import Iterable, Iterator, Mapping

from assess.pipeline.corrected import find_live_rows, is_lists
from assess.web.cell_edits import CellPlace
from assess.web.columns import PageSheet
from assess.web.snapshot import Snapshot
from assess.workbook.held import list_formulas
from assess.workbook.open import UNSAVED, Book
from assess.workbook.patch import Value, patch_workbook
from assess.workbook.plain_rows import column_letters
from assess.workbook.schema import ITEMS, LIVE

LiveRows = Mapping[int, list[float | str]]
"""What the live columns show, by the row of the item."""

_WIDE = frozenset({"Building", "Floors", "Catalogue"})
"""Sheets on which the live columns of every row, and the helper columns of Lists, rest."""
_IDLE = ("latitude", "longitude", "azimuth_deg", "report_date", "logo", "hazard", "language")
"""Lines of Building on which no live column rests, and that may be wrong: a logo is missing until it is handed over."""
_CLOSE = 1e-9
"""Relative difference up to which a stored number is left as it is: programs write 15 to 17 digits."""


def find_live(snapshot: Snapshot) -> LiveRows:
    """Return what the live columns of a workbook show.

    Nothing where it has none, or where a line of Building on which they rest is wrong: the formulas tell of it, the
    core leaves it out.
    """
    building = snapshot.tables["Building"]
    harmless = {building.cell(name, 0) for name in _IDLE if name in building.places}
    wrong = (one.cell for one in snapshot.problems if one.severity == "error" and one.sheet == building.sheet.name)
    is_known = snapshot.sheets[ITEMS.name].live and harmless.issuperset(wrong)
    return find_live_rows(snapshot.inventory) if is_known else {}


def write_changes(data: bytes, base: Snapshot, now: Snapshot, different: Iterable[CellPlace], was: LiveRows) -> bytes:
    """Return the bytes of a workbook after edits of the cells `different`; `was` is what `find_live` returned before.

    Rows of Items below the last one that has live formulas get none: the program reads them all the same. Raises
    WorkbookError if a cell cannot be changed.
    """
    cells = list(different)
    changes: dict[str, dict[str, Value]] = {}
    for sheet, row, at in cells:
        held = now.cells.cells[sheet]
        changes.setdefault(held.title, {})[f"{column_letters(at)}{row}"] = held.as_written(held.value((row, at)))
    results = dict(_find_results(data, base, now, cells, was))
    return patch_workbook(data, changes, results, name=base.cells.name).data


def _find_results(
    data: bytes, base: Snapshot, now: Snapshot, cells: list[CellPlace], was: LiveRows
) -> Iterator[tuple[str, dict[str, Value]]]:
    is_wide = not _WIDE.isdisjoint(sheet for sheet, *_ in cells)
    name = base.cells.name
    if is_wide:
        with Book(data, name) as book:
            lists = [one for one in book.sheets if is_lists(one)]
        for one in lists:
            filled = [address for address, is_filled in list_formulas(data, one, name=name).items() if is_filled]
            yield one, dict.fromkeys(filled)
    items = now.sheets[ITEMS.name]
    if items.live:
        edited = {row for sheet, row, _ in cells if sheet == ITEMS.name}
        found = dict(_find_live(items, base, was, find_live(now), None if is_wide else edited))
        yield now.cells.cells[ITEMS.name].title, found


def _find_live(
    items: PageSheet, base: Snapshot, was: LiveRows, rows: LiveRows, edited: set[int] | None
) -> Iterator[tuple[str, Value]]:
    """Yield the results of the live columns that change; `edited` are the rows of edits, None for all."""
    held = base.cells.cells[ITEMS.name]
    for row, at in sorted(held.marks.formulas):
        column = items.columns.get(at)
        if column is None or not column.live or row <= items.header:
            continue
        stored, found = held.value((row, at)), rows.get(row)
        if edited is not None and row not in edited and was.get(row) == found:
            continue
        shown = None if found is None or column.live not in LIVE else found[LIVE.index(column.live)]
        is_changed = not _is_same(stored, shown) if shown is not None else stored is not None and stored is not UNSAVED
        if is_changed:
            yield f"{column_letters(at)}{row}", shown


def _is_same(stored: object, found: float | str) -> bool:
    if isinstance(found, str) or isinstance(stored, bool) or not isinstance(stored, int | float):
        return (stored or "") == found
    return math.isclose(stored, found, rel_tol=_CLOSE)
