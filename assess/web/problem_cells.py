"""The problems of a workbook as the page lists them: in the language in use, those of one habit as one, with cells."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from assess.errors import Gap, Problem
from assess.i18n import gettext
from assess.workbook.habits import list_groups
from assess.workbook.names import find_sheet
from assess.workbook.plain_rows import column_number
from assess.workbook.schema import SHEETS

_RANGE = re.compile(r"([A-Z]{1,3})(\d+)(?::([A-Z]{1,3})(\d+))?")
_FORMS = frozenset(sheet.name for sheet in SHEETS if sheet.layout == "form")
_SEVERITIES = ("error", "warning", "note")
MOST_OF_RANGE = 400
"""Cells of one range that are marked."""

Cell = tuple[int, int]
"""The row of a cell, from 1, and its column, from 0."""


def describe_problems(problems: Iterable[Problem], sheets: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return problems as `GET /api/live` answers them, the errors first; `sheets` are own names by English ones."""
    english = {own: name for name, own in sheets.items()}
    found = [_describe(shown, alike, english) for shown, alike in list_groups(dict.fromkeys(problems))]
    return sorted(found, key=lambda one: _SEVERITIES.index(one["severity"]))


def _describe(shown: Problem, alike: list[Problem], english: Mapping[str, str]) -> dict[str, Any]:
    sheet = english.get(shown.sheet) or (find_sheet(shown.sheet) or (shown.sheet,))[0]
    found = [(cell, one) for one in alike for cell in list_cells(sheet, one.cell)]
    cells = [cell for cell, _ in found]
    row, at = cells[0] if cells else (None, None)
    return {
        "severity": shown.severity,
        "sheet": sheet,
        "cell": shown.cell,
        "row": row,
        "at": at,
        "message": gettext(shown.message),
        "fix": gettext(shown.fix),
        "count": len(alike),
        "cells": cells,
        "own": [(gettext(one.message), gettext(one.fix)) for _, one in found] if len(alike) > 1 else [],
        "lacks": shown.lacks if isinstance(shown, Gap) else "",
    }


def list_cells(sheet: str, address: str) -> list[Cell]:
    """Return the cells of an address of a sheet, ``H14`` or ``A1:C2``; of a form the values stand in column 1."""
    found = _RANGE.fullmatch(address)
    if found is None:
        return []
    first, top, last, bottom = found.groups()
    columns = range(column_number(first) - 1, column_number(last or first))
    rows = range(int(top), int(bottom or top) + 1)
    if sheet in _FORMS:
        return list(dict.fromkeys((row, 1) for row in rows[:MOST_OF_RANGE]))
    every = ((row, at) for row in rows for at in columns)
    return [cell for _, cell in zip(range(MOST_OF_RANGE), every, strict=False)]
