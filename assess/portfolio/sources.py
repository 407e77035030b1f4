"""Which buildings a portfolio has: the workbooks of a folder, or the rows of an index.

An index is a CSV file that lists buildings, and fills in what their workbooks leave blank. A name of a file is data: it
is shown, and looked up below the folder, but never leads out of it. What cannot be used is a building as well,
`refused` with the reason, so that it is reported and does not end the run.
"""

import csv
import difflib
import errno
import io
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from itertools import islice
from pathlib import Path
from typing import Any, Literal

from assess.errors import InputError
from assess.i18n import Text, fill, join
from assess.motion.formats.plain_csv import decode, is_comment
from assess.resources import read_input
from assess.text import plain_line
from assess.workbook.schema import BUILDING
from assess.workbook.values import read_digits, straighten

ENDINGS = (".xlsx", ".xlsm")
OTHER_ENDINGS = (".xls", ".xlsb", ".ods", ".numbers")
"""Of workbooks in formats that are not read: they are named, not passed over."""
MOST_BUILDINGS = 200_000
OURS = {"report.xlsx": "results.json", "ranking.xlsx": "portfolio.json", "compare.xlsx": "compare.json"}
"""Workbooks that are results of `assess`, where the file that lists them lies next to them."""

LARGEST_FILE = 64_000_000  # bytes: some hundred thousand rows
MOST_ROWS = 200_000
LONGEST = 4000  # characters of a cell
MOST_FAULTS = 20  # faults that one message lists

MOST_LINES = 10  # lines that a message on a repeated name lists

_NUMBER = re.compile(r"([+-]?)(\d[\d.,' ]*|[.,]\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)
_FIELDS: Mapping[str, str] = {
    "building": "building", "latitude": "latitude", "longitude": "longitude", "use": "use", "storeys": "storeys",
    "height_m": "height", "ground_pga_g": "ground_pga",
}  # fmt: skip
"""Columns of the index, and the line of the sheet Building that each fills in, whose limits hold for numbers."""
_LARGEST_AREA = 10_000_000.0  # gross floor area [m2] above which a number is a slip


@dataclass(frozen=True, slots=True, kw_only=True)
class IndexRow:
    """One row of an index, on a line of the file; "" and None where it is blank.

    `path` is the workbook, relative to the folder of the index, "" for a building without a survey; degrees are north
    and east positive.
    """

    line: int = 0
    path: str = ""
    building: str = ""
    latitude: float | None = None
    longitude: float | None = None
    use: str = ""
    storeys: int | None = None
    height_m: float | None = None
    floor_area_m2: float | None = None
    ground_pga_g: float | None = None

    def as_building(self) -> dict[str, Any]:
        """Return what it fills in of the sheet Building, in the units of an empty workbook, blanks left out."""
        values = {field: getattr(self, name) for name, field in _FIELDS.items()}
        return {field: value for field, value in values.items() if value not in (None, "")}


COLUMNS = tuple(one.name for one in fields(IndexRow) if one.name != "line")
_TEXTS = ("path", "building", "use")


def read_index(file: Path) -> tuple[IndexRow, ...]:
    """Read an index, in the order of its rows, each on one line.

    Cells are separated by commas, semicolons or tabs; columns are found by their names, in any order; lines that begin
    with # are comments. Numbers are read as those of a workbook, refused where they can be read in two ways.

    Raises InputError, with the line, if it cannot be read, has another column than `COLUMNS`, a cell cannot be used, or
    a path or the name of a building without one stands there twice.
    """
    try:
        try:
            data = read_input(file, LARGEST_FILE)
        except (OSError, ValueError) as error:  # ValueError: a zero character in the name
            why = getattr(error, "strerror", None) or str(error)
            raise InputError.about("the index cannot be read: {why}.", why=why) from None
        if len(data) > LARGEST_FILE:
            raise InputError.about("the index is larger than {most:.0f} MB. Split it.", most=LARGEST_FILE / 1e6)
        if b"\0" in data or data.startswith((b"PK", b"\xff\xfe", b"\xfe\xff")):
            raise InputError.about("the index is not plain text. Save it as CSV UTF-8.")
        lines = _split(decode(data))
        line, heading = next(lines, (0, []))
        if not line:
            raise InputError.about("the index is empty. Its first line holds the names of the columns.")
        names = _read_heading(line, heading)
        rows = list(islice(lines, MOST_ROWS + 1))
        if not rows:
            raise InputError.about("no building is listed below the headings.")
        if len(rows) > MOST_ROWS:
            raise InputError.about("more than {most:,} buildings are listed. Split the index.", most=MOST_ROWS)
        faults: list[Text] = []
        found = tuple(_read_row(number, names, cells, faults) for number, cells in rows)
        if every := [*faults, *_list_repeated(found)]:
            more = (fill("and {n:,} more.", n=len(every) - MOST_FAULTS),) if len(every) > MOST_FAULTS else ()
            raise InputError(join("\n", (*every[:MOST_FAULTS], *more)))
        return found
    except InputError as error:
        raise InputError(join(": ", (plain_line(file.name), error.message))) from None


def _split(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the cells of each line that is neither blank nor a comment, without spaces around them, with its number."""
    numbered = enumerate(io.StringIO(text, newline=None), 1)
    lines = [(number, line.rstrip("\n")) for number, line in numbered if line.strip() and not is_comment(line)]
    heading = lines[0][1] if lines else ""
    mark = next((one for one in "\t;" if one in heading), ",")
    for number, line in lines:
        try:
            (cells,) = csv.reader([line], delimiter=mark, strict=True)
        except csv.Error as error:
            fault = fill("line {line} cannot be read: {why}.", line=number, why=error)
            if "unexpected end" in str(error):
                fault = fill("line {line}: a quotation mark is not closed. Close it on the same line, or remove it: a "
                             "cell cannot hold a line break.", line=number)  # fmt: skip
            elif "expected after" in str(error):
                fault = fill("line {line}: characters follow a closing quotation mark. Write a quotation mark inside a "
                             "quoted cell twice, or remove the marks.", line=number)  # fmt: skip
            raise InputError(fault) from None
        if any(len(cell) > LONGEST for cell in cells):
            raise InputError.about("line {line}: a cell is longer than {most:,} characters.", line=number, most=LONGEST)
        if any(cell.strip() for cell in cells):
            yield number, [cell.strip() for cell in cells]


def _read_heading(line: int, heading: Sequence[str]) -> list[str]:
    names = [cell.lower() for cell in heading]
    while names and not names[-1]:
        names.pop()
    for name, cell in zip(names, heading, strict=False):
        if name not in COLUMNS:
            fault = fill("line {line}: {name!r} is an unknown column", line=line, name=cell[:40])
            if near := difflib.get_close_matches(name, COLUMNS, 1, 0.6):
                raise InputError(join(". ", (fault, fill("Did you mean {name}?", name=near[0]))))
            raise InputError(join(", ", (fault, fill("expected some of: {names}", names=", ".join(COLUMNS)))))
        if names.count(name) > 1:
            raise InputError.about("line {line}: the column {name} is there twice.", line=line, name=name)
    if not {"path", "building"} & set(names):
        raise InputError.about(
            "line {line}: expected the column path, or building for buildings without a survey.", line=line
        )
    return names


def _read_row(line: int, names: Sequence[str], cells: Sequence[str], faults: list[Text]) -> IndexRow:
    """Return a row; what is wrong with it is added to `faults`."""
    if any(cells[len(names) :]):
        faults.append(fill("line {line}: there are more cells than headings.", line=line))
    given = {name: text for name, text in zip(names, cells, strict=False) if text}
    values: dict[str, Any] = {}
    for name, text in given.items():
        try:
            values[name] = text if name in _TEXTS else _read_number(name, text)
        except InputError as error:
            faults.append(join(": ", (fill("line {line}", line=line), error.message)))
    if not {"path", "building"} & set(given):
        faults.append(fill("line {line}: give a path, or the name of a building without a survey.", line=line))
    if ("latitude" in given) != ("longitude" in given):
        faults.append(fill("line {line}: give both latitude and longitude, or neither.", line=line))
    return IndexRow(line=line, **values)


def _read_number(name: str, text: str) -> float | int:
    """Return a number within the limits of the column; InputError if it is none, or can be read in two ways."""
    match = _NUMBER.fullmatch(straighten(text))
    digits = read_digits(match[2].rstrip()) if match else []
    if match is None or not digits:
        raise InputError.about("{name} is {text!r}, not a number.", name=name, text=text[:40])
    low, high = 1.0, _LARGEST_AREA
    if name in _FIELDS:
        column = BUILDING.column(_FIELDS[name])
        low, high = column.low or 0.0, float("inf") if column.high is None else column.high
    readings = [float(f"{match[1]}1{match[3] or ''}") * one for one in digits]
    within = [one for one in readings if low <= one <= high]
    if len(within) > 1:  # both are given as they can be written: three decimals with a zero after them
        one, other = (f"{number:.10g}" for number in within)
        raise InputError.about(
                "{name}: {text} can be {one:,.10g} or {other:,.10g}: write {plain_one} or {plain_other}.",
                name=name, text=text[:40], one=within[0], other=within[1],
                plain_one=f"{one}0" if len(read_digits(one)) > 1 else one, plain_other=other)  # fmt: skip
    value = (within or readings)[0]
    if not within:
        raise InputError.about(
            "{name} is {value:g}, expected {low:g} to {high:g}.", name=name, value=value, low=low, high=high
        )
    if name == "storeys" and value != int(value):
        raise InputError.about("{name} is {value:g}, expected a whole number.", name=name, value=value)
    return int(value) if name == "storeys" else value


def _list_repeated(rows: Sequence[IndexRow]) -> Iterator[Text]:
    """Yield a fault for each path, and each name of a building without one, that stands there more than once."""
    paths: dict[str, list[int]] = {}
    names: dict[str, list[int]] = {}
    for row in rows:
        if row.path:
            paths.setdefault(tidy_path(row.path), []).append(row.line)
        elif row.building:
            names.setdefault(row.building, []).append(row.line)
    same = fill(
        "lines {lines} and {last} list the same workbook, {name}: keep one of them.", lines="", last="", name=""
    )
    bare = fill("lines {lines} and {last} list the same building without a workbook, {name}: keep one of them.",
                lines="", last="", name="")  # fmt: skip
    for text, name, lines in [*((same, *one) for one in paths.items()), *((bare, *one) for one in names.items())]:
        if len(lines) > 1:
            many = len(lines) > MOST_LINES
            last = fill("{n:,} more", n=len(lines) - MOST_LINES) if many else str(lines[-1])
            listed = ", ".join(map(str, lines[:MOST_LINES] if many else lines[:-1]))
            yield fill(text.template, lines=listed, last=last, name=plain_line(name[:80]))
    for name in (one for one in names if one in paths):
        yield fill("line {line}: {name!r} is also the path of a workbook.", line=names[name][0], name=name[:80])


def tidy_path(text: str) -> str:
    """Return a path of the index with / alone, without empty parts and dots."""
    parts = [one for one in text.replace("\\", "/").split("/") if one not in ("", ".")]
    return ("/" if text.startswith(("/", "\\")) else "") + "/".join(parts)


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
    `assess`; workbooks in other formats are refused, as are links that lead out of it or to folders.

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
