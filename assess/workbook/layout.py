"""Where the columns stand in a workbook that `assess new` writes; reading finds them by their labels, in any order.

In Items the class stands next to the item, so that it stays in view while the row is filled in; the other columns that
Excel computes stand at the right.
"""

from collections.abc import Iterator

from xlsxwriter.utility import xl_col_to_name

from assess.workbook.schema import CLASS, ITEMS, LIVE, SHEETS, WORKINGS, Sheet

FROZEN = {ITEMS.name: 2}
"""Columns that stay in view while a table is scrolled; one where a sheet is not named."""


def list_columns(sheet: Sheet) -> list[str]:
    """Return the columns of a sheet from the left: the field of each to fill in, the label of each that is computed."""
    return list(_order(sheet))


def _order(sheet: Sheet) -> Iterator[str]:
    first, *others = (column.name for column in sheet.columns)
    yield first
    if sheet is ITEMS:
        others = [CLASS, *others, *(label for label in LIVE if label != CLASS), *WORKINGS]
    yield from others


PLACES = {(sheet.name, name): at for sheet in SHEETS for at, name in enumerate(list_columns(sheet))}
"""Column, from 0, in which the workbook has a field or a column that is computed; of a form, the line."""

LETTERS = {where: xl_col_to_name(at) for where, at in PLACES.items()}
"""The same as letters."""
