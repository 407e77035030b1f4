"""Names of files: those that came from elsewhere made safe for any folder, and the files that a workbook names."""

import re
import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from assess.errors import InputError, OutputError
from assess.i18n import fill
from assess.model import split_names
from assess.web.columns import PageSheet
from assess.web.request_errors import UNUSABLE, RequestError
from assess.workbook.habits import CellError
from assess.workbook.records import find_place, list_beside
from assess.workbook.store import Workbook
from assess.workbook.values import is_blank, read_text

LONGEST = 120
ENDINGS = (".xlsx", ".xlsm")
_RESERVED = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)", re.IGNORECASE)
_FORBIDDEN = frozenset('<>:"/\\|?*')
FILES = {
    ("Building", "logo"): "logo", ("Building", "hazard"): "hazard",
    ("Building", "shakemap"): "hazard", ("Floors", "plan"): "plan",
    ("Floors", "record_x"): "record", ("Floors", "record_y"): "record", ("Items", "photo"): "photo",
}  # fmt: skip
"""What a file is for, by the sheet and the field that name it."""


def make_safe(name: str) -> str:
    """Return the name of a workbook without folders, and without signs that file systems refuse."""
    shown = _take_last(name)
    stem, ending = (shown[:-5], shown[-5:]) if shown.lower().endswith(ENDINGS) else (shown, ENDINGS[0])
    stem = stem.strip(". ")[: LONGEST - len(ending)]
    return f"{stem}{ending}" if stem and not _RESERVED.match(stem) else f"workbook{ending}"


def clean_name(name: str) -> str:
    """Return the name of a file without folders, and without signs that file systems refuse, cut to `LONGEST`."""
    shown = _take_last(name)
    stem, dot, ending = shown.rpartition(".")
    return f"{stem[: LONGEST - len(ending) - 1]}{dot}{ending}" if stem and len(ending) < LONGEST else shown[:LONGEST]


def _take_last(name: str) -> str:
    last = PureWindowsPath(PurePosixPath(name).name).name
    return "".join(one for one in last if one not in _FORBIDDEN and not _is_unseen(one)).rstrip(". ")


def _is_unseen(sign: str) -> bool:
    return unicodedata.category(sign)[0] == "C"


def check_name(name: object) -> str:
    """Return the name of a new workbook; RequestError if it is not that of an .xlsx file alone."""
    text = name.strip() if isinstance(name, str) else ""
    if text and not text.lower().endswith(ENDINGS[0]):
        text = f"{text}{ENDINGS[0]}"
    stem = text[: -len(ENDINGS[0])]
    if not stem.strip(". "):
        fix = fill("Choose a name, such as office.xlsx.")
    elif signs := " ".join(dict.fromkeys(one for one in text if one in _FORBIDDEN)):
        fix = fill("A name cannot have {signs}: leave it out.", signs=signs)
    elif any(map(_is_unseen, text)):
        fix = fill("It has signs that cannot be seen: type it again.")
    elif len(text) > LONGEST:
        fix = fill("A name has at most {most} signs: shorten it.", most=LONGEST)
    elif stem.endswith((".", " ")) or text.startswith((".", "-", "~")):
        fix = fill("A name cannot begin with . - or ~, and cannot end with a point or a space.")
    elif make_safe(text) != text:
        fix = fill("Windows keeps that name for itself: choose another, such as office.xlsx.")
    else:
        return text
    raise RequestError(fill("{name} cannot be the name of a workbook.", name=repr(text[:LONGEST])), UNUSABLE, fix)


def list_missing(workbook: Workbook, sheets: Mapping[str, PageSheet], folder: Path) -> list[dict[str, Any]]:
    """Return the files in the folder that a workbook names and that are not there, with the cells that name them."""
    found: dict[str, dict[str, Any]] = {}
    for name, kind, cell in _list_named(workbook, sheets):
        found.setdefault(name, {"name": name, "kind": kind, "cells": []})["cells"].append(cell)
    paths = {name: _find(name, folder) for name in found}
    return [one for name, one in found.items() if (path := paths[name]) is not None and not path.exists()]


def list_present(workbook: Workbook, sheets: Mapping[str, PageSheet], folder: Path) -> dict[str, Path]:
    """Return the files that a workbook names and its folder has, by name, and the uncertainties next to a ShakeMap."""
    named = [(name, kind) for name, kind, _ in _list_named(workbook, sheets)]
    beside = [other for name, kind in named if kind == "hazard" for other in list_beside(name)]
    names = dict.fromkeys([*(name for name, _ in named), *beside])
    return {name: path for name in names if (path := _find(name, folder)) is not None and path.is_file()}


def _find(name: str, folder: Path) -> Path | None:
    """Return where a file lies or would lie; None of a name that leads out of the folder."""
    try:
        return find_place(name, folder)
    except CellError:
        return None


def _list_named(workbook: Workbook, sheets: Mapping[str, PageSheet]) -> Iterator[tuple[str, str, list[Any]]]:
    for (sheet, field), kind in FILES.items():
        column = sheets[sheet].field(field)
        if column is None:
            continue
        rows = workbook.sheets[sheet].cells
        numbers = [column.row] if column.row else [row for row in rows if row > sheets[sheet].header]
        for row in numbers:
            value = rows.get(row, {}).get(column.at)
            if not isinstance(value, str) or is_blank(value):
                continue
            text = read_text(value)
            names = [one.partition("#")[0].strip() for one in split_names(text)] if kind == "record" else [text]
            yield from ((one, kind, [sheet, row, column.at]) for one in dict.fromkeys(names) if one)


def add_file(name: str, data: bytes, missing: list[dict[str, Any]], folder: Path) -> None:
    """Write a missing file that a workbook names; InputError if it names none so, OutputError if it fails."""
    shown = repr(name[:100])
    if name not in {one["name"] for one in missing}:
        raise InputError.about("the workbook names no missing file of this name: {name}.", name=shown)
    try:
        path = find_place(name, folder)
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            file.write(data)
    except CellError as error:
        raise InputError(error.message) from None
    except FileExistsError:
        raise InputError.about("{name} is there already; it was left as it is.", name=shown) from None
    except OSError as error:
        why = error.strerror or error
        raise OutputError.about("{name} cannot be written: {why}.", name=shown, why=why) from None
