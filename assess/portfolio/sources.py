"""Which buildings a portfolio has: the workbooks of a folder, or the rows of an index.

A name of a file is data: it is shown, and looked up below the folder, but never leads out of it. What cannot be used is
a building as well, `refused` with the reason, so that it is reported and does not end the run.
"""

import errno
import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Literal

from assess.errors import InputError
from assess.i18n import Text, fill
from assess.portfolio.index_file import IndexRow, read_index, tidy_path
from assess.text import plain_line

ENDINGS = (".xlsx", ".xlsm")
OTHER_ENDINGS = (".xls", ".xlsb", ".ods", ".numbers")
"""Of workbooks in formats that are not read: they are named, not passed over."""
MOST_BUILDINGS = 200_000
OURS = {"report.xlsx": "results.json", "ranking.xlsx": "portfolio.json", "compare.xlsx": "compare.json"}
"""Workbooks that are results of `assess`, where the file that lists them lies next to them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """One building; `refused` is why it cannot be used, "" if it can, and `fix` what to do about it.

    `path` is what tables call it, unique: its workbook (also one of COBie), relative to the folder, with /; or the name
    of a row of the index without one, whose pieces are assumed by use and floor area.
    """

    path: str
    kind: Literal["workbook", "assumed"] = "workbook"
    file: Path | None = None
    index: IndexRow | None = None
    refused: Text | str = ""
    fix: Text | str = ""


def find_sources(source: Path, out: Path | None = None) -> tuple[Source, ...]:
    """Return the buildings of a folder, searched with the folders in it, or of an index (.csv), in the order of paths.

    Left out of a folder are hidden files and folders, lock files (~$), the folder `out` of the results and results of
    `assess`; workbooks in other formats, such as .xls, are refused. Links to workbooks inside the folder count; links
    that lead out of it, and links to folders, are refused.

    Raises InputError if there is no such folder or index, the index cannot be used, or there is no building in it.
    """
    root, shown = _resolve(source), plain_line(str(source))
    if root.is_dir():
        found = _search(root, None if out is None else _resolve(out))
    elif source.suffix.lower() in ENDINGS:
        raise InputError.about(
            "{path} is a workbook: name the folder that holds it, or assess it by itself with `assess run`.", path=shown
        )
    elif root.exists():
        found = (_take_row(row, root.parent) for row in read_index(root))
    else:
        raise InputError.about("{path} is neither a folder nor an index (.csv).", path=shown)
    listed = list(islice(found, MOST_BUILDINGS + 1))
    if len(listed) > MOST_BUILDINGS:
        raise InputError.about("there are more than {most:,} buildings. Split the folder.", most=MOST_BUILDINGS)
    if not listed:
        raise InputError.about("{path}: there is no workbook (.xlsx or .xlsm) in this folder.", path=shown)
    return tuple(sorted(listed, key=lambda one: one.path))


def _resolve(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError, ValueError) as error:  # links in a circle; a zero character
        why = getattr(error, "strerror", None) or str(error)
        raise InputError.about("{path} cannot be used: {why}.", path=plain_line(str(path)), why=why) from None


def _search(root: Path, out: Path | None) -> Iterator[Source]:
    waiting = [root]
    while waiting:
        folder = waiting.pop()
        try:
            entries = sorted(os.scandir(folder), key=lambda one: one.name)
        except OSError as error:
            fault = fill("the folder cannot be read: {why}.", why=error.strerror)
            yield Source(path=_name(folder, root), refused=fault, fix=fill("Check its name and its access rights."))
            continue
        names = {one.name for one in entries}
        for entry in entries:
            path, lower = folder / entry.name, entry.name.lower()
            if entry.name.startswith((".", "~$")) or path == out:
                continue
            name = _name(path, root)
            if entry.is_dir(follow_symlinks=False):
                waiting.append(path)
            elif lower.endswith(OTHER_ENDINGS):
                fix = fill("Save it as .xlsx (Excel Workbook) and remove this file.")
                yield Source(path=name, refused=_refuse_format(lower), fix=fix)
            elif entry.is_symlink() and path.is_dir():
                fault = fill("it is a link to a folder, which is not searched.")
                yield Source(path=name, refused=fault, fix=fill("Copy the folder here."))
            elif lower.endswith(ENDINGS) and OURS.get(entry.name) not in names:
                refused, hint = _judge(path, root)
                yield Source(path=name, file=path, refused=refused, fix=hint)


def _take_row(row: IndexRow, root: Path) -> Source:
    if not row.path:
        return Source(path=row.building, kind="assumed", index=row)
    name = tidy_path(row.path)
    lower = name.lower()
    # before the file system sees the path
    if name.startswith("/") or name[1:2] == ":" or ".." in name.split("/") or "\0" in name:
        refused = fill("the path leads out of the folder of the index.")
        return Source(path=name, index=row, refused=refused, fix=fill("Write it relative to that folder."))
    if lower.endswith(OTHER_ENDINGS):
        fix = fill("Save it as .xlsx (Excel Workbook) and name that file.")
        return Source(path=name, index=row, refused=_refuse_format(lower), fix=fix)
    if not lower.endswith(ENDINGS):
        refused = fill("it is not a workbook: its name has to end in .xlsx or .xlsm.")
        return Source(path=name, index=row, refused=refused, fix=fill("Correct the path in the index."))
    fault, hint = _judge(root / name, root)
    return Source(path=name, file=root / name, index=row, refused=fault, fix=hint)


def _name(path: Path, root: Path) -> str:
    """Return a path below the folder as a text; bytes that are not UTF-8 stand as escapes of their number."""
    text = path.relative_to(root).as_posix()
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def _refuse_format(name: str) -> Text:
    return fill("workbooks ending in {ending} are not read.", ending=Path(name).suffix)


def _judge(path: Path, root: Path) -> tuple[Text | str, Text | str]:
    """Return why a workbook below the folder cannot be used, and what to do; "" if it can."""
    try:
        real = path.resolve(strict=True)
    except (OSError, RuntimeError) as error:
        with suppress(OSError):  # a name that is too long
            if path.is_symlink():
                fault = fill("it is a link that leads to no file, or in a circle.")
                return fault, fill("Copy the workbook here in place of the link.")
        if getattr(error, "errno", None) == errno.ENOENT:
            return fill("there is no such file."), fill("Check the name and the folder.")
        fault = fill("the file cannot be found: {why}.", why=getattr(error, "strerror", None) or str(error))
        return fault, fill("Check its name and its access rights.")
    if not real.is_relative_to(root):
        return fill("it is a link that leads out of the folder."), fill("Copy the workbook here.")
    return ("", "") if real.is_file() else (fill("it is not a file."), fill("Check the name and the folder."))
