"""A workbook to the inventory: bytes, cells, typed rows, problems, in that order."""

import hashlib
import io
import json
import re
import zipfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.errors import InputError, Problem, WorkbookError
from assess.i18n import fill
from assess.model import CatalogueType, Inventory, Passage, Place, Segment
from assess.motion.site_ground import GroundField
from assess.progress import SILENT, Progress, Stage
from assess.workbook import check, check_routes, draft_names
from assess.workbook.check import Check
from assess.workbook.kept_files import KeptFiles
from assess.workbook.names import ENGLISH, find_near, find_sheet, is_cobie_list, plain, translate, versions
from assess.workbook.open import DAMAGE, WORKBOOK, Book, read_file
from assess.workbook.parse import CodeCells, Source, Table, Tables, first_row, parse_sheet
from assess.workbook.picture_files import PictureReader
from assess.workbook.records import FileReader, Files, fill_building, replace_ground
from assess.workbook.resolve import (
    build_building,
    build_costs,
    build_floors,
    build_items,
    build_rows,
    correct_names,
    leave_out,
    resolve,
    types_by_name,
)
from assess.workbook.schema import SHEETS, Sheet

if TYPE_CHECKING:
    import pandas as pd

    from assess.workbook.store import Workbook

_MAX_LIST = 2**20
_SHEET = re.compile(rb"<(?:\w+:)?sheet\s[^>]*?\bname=[\"']([^\"']*)", re.IGNORECASE)
IN_CODE = "inventory.xlsx"
"""What an inventory without a file is called in reports."""

Rows = Mapping[str, "Sequence[Mapping[str, Any]] | Mapping[str, Any] | pd.DataFrame"]
"""Rows in code: by the name of the sheet, each a value by field or header; or a table of pandas."""


def read_inventory(
    source: str | Path | bytes | Rows,
    *,
    records: Mapping[str, bytes] | str | Path | None = None,
    building: Mapping[str, Any] | None = None,
    ground: GroundField | None = None,
    strict: bool = True,
    progress: Progress = SILENT,
) -> Inventory:
    """Read and check a workbook, or rows that are given in code.

    * `source`: The .xlsx (or .xlsm, whose macros are never run), its bytes, or rows by sheet: ``{"Items": [{"item":
      "A1", "Height [m]": 1.8}], "Floors": [...], "Building": {...}}``, where a table of pandas serves as well. A key is
      a field of `assess.workbook.schema`, its value in the unit of an empty workbook's header, or a header with its
      unit.
    * `records`: The recorded motions and pictures that the workbook names: their bytes by name, or the folder that
      holds them. By default they are looked for in the folder of the workbook.
    * `building`: Values for the lines of Building that the workbook leaves blank, as rows in code have them.
    * `ground`: The ground motion of the run, such as a `assess.motion.shakemap.ShakeMap`: at Latitude and Longitude it
      takes the place of Ground PGA, SDS, Ground PGV, ShakeMap file and Shaking. Floors keep a motion of their own.
    * `strict`: Whether an error stops the reading. If not, faulty rows are left out, and `Inventory.problems` holds the
      errors.
    * `progress`: Reports the stage "reading"; obeys a cancel.

    In SI units, with the warnings and notes of the check.

    Raises WorkbookError if it cannot be opened as a workbook or, if `strict`, anything in it cannot be used; its
    `problems` name every sheet and cell.
    """
    path = Path(source) if isinstance(source, str | Path) else Path(IN_CODE)
    files = Path(records) if isinstance(records, str | Path) else records
    with progress.stage("reading", path.name) as stage:
        return progress.wait_for(lambda: _read(source, path, files, stage, building, ground, strict=strict))


def _read(
    source: str | Path | bytes | Rows, path: Path, files: Files, stage: Stage, building: Mapping[str, Any] | None,
    ground: GroundField | None, *, strict: bool,
) -> Inventory:  # fmt: skip
    data = read_file(path) if isinstance(source, str | Path) else source if isinstance(source, bytes) else None
    if isinstance(source, Mapping):
        rows = {name: _list_rows(name, content) for name, content in source.items()}
        tables, problems = _tables_in_code(rows)
        hashed = json.dumps(rows, sort_keys=True, default=str).encode()
    else:
        tables, problems = read_tables(data or b"", path.name, stage.progress)
        hashed = data or b""
    stage.at(0.5)
    if files is None and isinstance(source, str | Path):
        files = path.resolve().parent
    reader = FileReader(files, stage.progress, ground=ground)
    pictures = PictureReader(reader.folder, stage.progress)
    tables, problems = fill_building(tables, problems, building)
    if ground is not None:
        tables, notes = replace_ground(tables, ground)
        problems += notes
    tables, problems = _check(tables, problems, _checks(reader, pictures), strict=strict)
    return _make(path, hashlib.sha256(hashed).hexdigest(), data, tables, problems, reader, pictures)


def _make(
    path: Path, digest: str, data: bytes | None, tables: Tables, problems: Sequence[Problem], files: FileReader,
    pictures: PictureReader,
) -> Inventory:  # fmt: skip
    return Inventory(
        source=path,
        sha256=digest,
        data=data,
        problems=tuple(problems),
        corrections=tuple(one for table in tables.values() for one in table.corrections),
        building=build_building(tables, pictures.logo),
        floors=build_floors(tables["Floors"], files.records, pictures.plans),
        items=build_items(tables["Items"], types_by_name(tables["Catalogue"])),
        places=build_rows(Place, tables["Places"], "place", "floor"),
        routes=build_rows(Segment, tables["Routes"], "route", "segment"),
        catalogue=build_rows(CatalogueType, tables["Catalogue"], "type"),
        costs=build_costs(tables["Costs"]),
        texts=build_rows(Passage, tables["Text"], "text"),
        hazard=files.hazard,
        site_ground=files.site_ground,
        photos=pictures.photos,
        extra_columns=tables["Items"].extra,
        files=files.hashes,
        language=_language(tables),
        sheets={name: table.sheet.name for name, table in tables.items()},
        letters={name: table.letters for name, table in tables.items()},
    )


def read_tables(data: bytes, name: str, progress: Progress = SILENT) -> tuple[Tables, list[Problem]]:
    """Read every sheet of a workbook; raises WorkbookError if the file cannot be opened as a workbook at all."""
    with Book(data, name, progress) as book:
        found, language, problems = _find_sheets(list(book.sheets), book.hidden)
        return _parse({name: (book.cells(own), code) for name, (own, code) in found.items()}, language, problems)


def open_workbook(data: bytes, name: str, progress: Progress = SILENT) -> "Workbook":
    """Read the cells of every sheet of a workbook and hold them in memory, for `parse_workbook` and to be changed.

    Raises WorkbookError if the file cannot be opened as a workbook at all.
    """
    from assess.workbook.store import Workbook, read_sheet

    with Book(data, name, progress) as book:
        found, language, problems = _find_sheets(list(book.sheets), book.hidden)
        return Workbook(
            name=name,
            data=data,
            sheets={sheet: read_sheet(book, own) for sheet, (own, _) in found.items()},
            languages={sheet: code for sheet, (_, code) in found.items()},
            language=language,
            problems=tuple(problems),
            titles=tuple(book.sheets),
        )


def parse_workbook(workbook: "Workbook") -> tuple[Tables, list[Problem]]:
    """Return the tables of a workbook in memory, and all problems, as `read_tables` does."""
    found: dict[str, tuple[Source, str]] = {
        name: (one, workbook.languages[name]) for name, one in workbook.sheets.items() if name in workbook.languages
    }
    return _parse(found, workbook.language, workbook.problems)


def build_inventory(
    tables: Tables,
    problems: Sequence[Problem],
    path: Path,
    records: Files,
    progress: Progress = SILENT,
    kept: KeptFiles | None = None,
) -> Inventory:
    """Return the inventory of tables that `parse_workbook` returned, as ``read_inventory(strict=False)`` does.

    The workbook, `path`, is not read. `records` are the files that it names or their folder, `kept` what earlier
    readings made of them.
    """
    reader = FileReader(records, progress, kept)
    pictures = PictureReader(reader.folder, progress, kept)
    checked, found = _check(tables, [*problems], _checks(reader, pictures), strict=False)
    return _make(path, "", None, checked, found, reader, pictures)


def _parse(
    found: Mapping[str, tuple[Source, str]], language: str, problems: Sequence[Problem]
) -> tuple[Tables, list[Problem]]:
    tables, listed = {}, [*problems]
    for sheet in SHEETS:
        if sheet.name in found:
            cells, code = found[sheet.name]
            tables[sheet.name], more = parse_sheet(sheet, translate(sheet, code), code, cells)
            listed += more
        else:
            tables[sheet.name] = Table(sheet=translate(sheet, language))
    return {name: table.with_failed(listed) for name, table in tables.items()}, listed


def is_cobie(source: Path | bytes) -> bool:
    """Tell whether a file looks like a COBie spreadsheet; only its list of sheets is read. Never an error."""
    try:
        with zipfile.ZipFile(io.BytesIO(source) if isinstance(source, bytes) else source) as archive:
            is_small = archive.getinfo(WORKBOOK).file_size <= _MAX_LIST
            names = _SHEET.findall(archive.read(WORKBOOK)) if is_small else []
    except DAMAGE:
        return False
    return is_cobie_list([name.decode("utf-8", "replace") for name in names])


def _find_sheets(
    present: Sequence[str], hidden: Collection[str]
) -> tuple[dict[str, tuple[str, str]], str, list[Problem]]:
    if is_cobie_list(present):
        fault = fill("this is a COBie handover file, not an inventory workbook.")
        fix = fill("Make an inventory workbook of it with `assess import`, and use that.")
        raise WorkbookError([Problem("error", "", "", fault, fix)])
    known = [(name, *found) for name in present if (found := find_sheet(name))]
    own: dict[str, tuple[str, str]] = {}
    problems = []
    for sheet in SHEETS:
        names = [(name, code) for name, english, code in known if english == sheet.name]
        if names:
            own[sheet.name] = names[0]
        if len(names) > 1:
            problems.append(_describe_twice(translate(sheet, names[0][1]).name, [name for name, _ in names]))
    language = find_language([code for _, code in own.values()])
    unknown = [name for name in present if name not in {name for name, *_ in known}]
    for sheet in (one for one in SHEETS if one.name not in own):
        problems += _describe_missing(sheet, language, unknown)
    return own, language, [*problems, *_note_hidden(own, hidden)]


def find_language(codes: Sequence[str]) -> str:
    """Return the language of most of the sheets, English where no other has more than half."""
    return next((code for code in codes if codes.count(code) * 2 > len(codes)), ENGLISH)


def _note_hidden(found: Mapping[str, tuple[str, str]], hidden: Collection[str]) -> Iterator[Problem]:
    for own, code in ((own, code) for own, code in found.values() if own in hidden):
        name = next(said.name for sheet in SHEETS if plain((said := translate(sheet, code)).name) == plain(own))
        yield Problem("note", name, "", fill("the sheet is hidden; it is read as well."))


def _describe_twice(sheet: str, names: Sequence[str]) -> Problem:
    spelt = {plain(name): name for name in names}
    message = fill("there are {n} sheets of this name.", n=len(names))
    if len(spelt) > 1:
        one, other = list(spelt.values())[:2]
        message = fill("the sheets {one} and {other} are the same in two languages.", one=one, other=other)
    return Problem("error", sheet, "", message, fill("Delete all but one, or rename them."))


def _describe_missing(sheet: Sheet, language: str, unknown: Sequence[str]) -> Iterable[Problem]:
    by_name = {plain(name): name for name in reversed(unknown)}
    for name in (said.name for said in versions(sheet)) if unknown else ():
        if near := find_near(plain(name), by_name):
            message = fill("there is no sheet named {name}.", name=name)
            yield Problem("error", by_name[near], "", message, fill("Did you mean {name}? Rename it.", name=name))
            return
    if sheet.required:
        fix = fill("Add it, or start from a workbook made with `assess new`.")
        yield Problem("error", translate(sheet, language).name, "", fill("the sheet is missing."), fix)


def _list_rows(name: str, content: Any) -> list[Mapping[str, Any]]:
    if hasattr(content, "to_dict"):
        content = content.astype(object).where(content.notna(), None).to_dict("records")
    listed = [content] if isinstance(content, Mapping) else list(content)
    if not all(isinstance(row, Mapping) for row in listed):
        raise InputError(fill("{name}: every row has to be a mapping of fields to values.", name=name))
    return listed


def _tables_in_code(rows: Mapping[str, Sequence[Mapping[str, Any]]]) -> tuple[Tables, list[Problem]]:
    given: dict[str, tuple[Source, str]] = {}
    for name, content in rows.items():
        found = find_sheet(name)
        if found is None:
            names = ", ".join(sheet.name for sheet in SHEETS)
            raise InputError(fill("the sheet {name} is not known, expected: {names}.", name=repr(name), names=names))
        english = next(sheet for sheet in SHEETS if sheet.name == found[0])
        given[found[0]] = (CodeCells(english, content), found[1])
    missing = (one for sheet in SHEETS if sheet.name not in given for one in _describe_missing(sheet, ENGLISH, ()))
    return _parse(given, ENGLISH, [*missing])


# ---------------------------------------------------------------- tables to the inventory


def _checks(files: FileReader, pictures: PictureReader) -> tuple[Check, ...]:
    return (
        pictures.check_logo,
        files.check_hazard,
        files.check_ground,
        check.check_catalogue,
        check.check_costs,
        partial(check.check_anchor_code, is_shaken=files.ground is not None),
        partial(check.check_floors, is_shaken=files.ground is not None),
        files.check_records,
        check.check_velocities,
        pictures.check_plans,
        check_routes.check_names,
        check_routes.check_segments,
        check_routes.check_segment_rooms,
        check_routes.check_network,
        draft_names.check_drafts,
        check.check_source_ids,
        check.check_item_names,
        check_routes.check_next_to_routes,
        check_routes.check_positions,
        check_routes.check_item_rooms,
        check.check_items,
        pictures.check_photos,
    )


def _check(
    tables: Tables, found: list[Problem], checks: Sequence[Check], *, strict: bool
) -> tuple[Tables, list[Problem]]:
    tables, notes = correct_names(tables)
    tables, more = check.run_checks(resolve(tables), checks)
    problems = [*found, *notes, *more]
    if not any(one.severity == "error" for one in problems):
        return tables, problems
    listed = [table.sheet.name for table in tables.values() if table.found or not table.sheet.required]
    order = {name: at for at, name in enumerate(listed)}  # before all: required sheets that are missing
    problems.sort(key=lambda one: (order.get(one.sheet, -1), first_row(one.cell)))
    if strict:
        raise WorkbookError(problems, _language(tables))
    tables, more = leave_out(tables)
    return tables, [*problems, *more]


def _language(tables: Tables) -> str:
    return find_language([table.language for table in tables.values() if table.found])
