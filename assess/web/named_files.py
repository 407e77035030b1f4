"""The files that a workbook names: which are missing, and taking in one that is."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from assess.errors import InputError, OutputError
from assess.i18n import fill
from assess.model import split_names
from assess.web.columns import PageSheet
from assess.workbook.habits import CellError
from assess.workbook.held import HeldSheets
from assess.workbook.records import find_place, list_beside
from assess.workbook.values import is_blank, read_text

FILES = {
    ("Building", "logo"): "logo", ("Building", "hazard"): "hazard",
    ("Building", "shakemap"): "hazard", ("Floors", "plan"): "plan",
    ("Floors", "record_x"): "record", ("Floors", "record_y"): "record", ("Items", "photo"): "photo",
}  # fmt: skip
"""What a file is for, by the sheet and the field that name it."""


def list_missing(held: HeldSheets, sheets: Mapping[str, PageSheet], folder: Path) -> list[dict[str, Any]]:
    """Return the files that a workbook names and that are not in its folder, each with the cells that name it.

    Names that lead out of the folder are left out: no file can be added under them.
    """
    found: dict[str, dict[str, Any]] = {}
    known: dict[str, bool] = {}
    for name, kind, cell in _list_named(held, sheets):
        if name not in known:
            path = _find(name, folder)
            known[name] = path is not None and not path.exists()
        if known[name]:
            found.setdefault(name, {"name": name, "kind": kind, "cells": []})["cells"].append(cell)
    return list(found.values())


def list_present(held: HeldSheets, sheets: Mapping[str, PageSheet], folder: Path) -> dict[str, Path]:
    """Return the files that a workbook names and that are in its folder, by their names.

    With the grid of a ShakeMap the file of its uncertainties is listed, which lies beside it and is named by nobody.
    """
    named = [(name, kind) for name, kind, _ in _list_named(held, sheets)]
    beside = [other for name, kind in named if kind == "hazard" for other in list_beside(name)]
    names = dict.fromkeys([*(name for name, _ in named), *beside])
    return {name: path for name in names if (path := _find(name, folder)) is not None and path.is_file()}


def _find(name: str, folder: Path) -> Path | None:
    """Return where a file lies or would lie; None of a name that leads out of the folder."""
    try:
        return find_place(name, folder)
    except CellError:
        return None


def _list_named(held: HeldSheets, sheets: Mapping[str, PageSheet]) -> Iterator[tuple[str, str, list[Any]]]:
    for (sheet, field), kind in FILES.items():
        column = sheets[sheet].field(field)
        if column is None:
            continue
        rows = held.cells[sheet].cells
        numbers = [column.row] if column.row else [row for row in rows if row > sheets[sheet].header]
        for row in numbers:
            value = rows.get(row, {}).get(column.at)
            if not isinstance(value, str) or is_blank(value):
                continue
            text = read_text(value)
            names = [one.partition("#")[0].strip() for one in split_names(text)] if kind == "record" else [text]
            yield from ((one, kind, [sheet, row, column.at]) for one in dict.fromkeys(names) if one)


def add_file(name: str, data: bytes, missing: list[dict[str, Any]], folder: Path) -> None:
    """Write a file that a workbook names into its folder.

    Raises InputError if the workbook does not name it, or it is there already; OutputError if it cannot be written.
    """
    if name not in {one["name"] for one in missing}:
        raise InputError(fill("the workbook names no missing file of this name: {name}.", name=repr(name[:100])))
    try:
        path = find_place(name, folder)
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            file.write(data)
    except CellError as error:
        raise InputError(error.message) from None
    except FileExistsError:
        raise InputError(fill("{name} is there already; it was left as it is.", name=repr(name[:100]))) from None
    except OSError as error:
        raise OutputError(
            fill("{name} cannot be written: {why}.", name=repr(name[:100]), why=error.strerror or error)
        ) from None
