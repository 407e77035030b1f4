"""The workbook as its sheets: which of them it has, and in which language.

Every problem is collected with its cell; reading goes on, so that one run names them all.
"""

import difflib
import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import IO, Any
from zipfile import ZipFile

from openpyxl import DEFUSEDXML
from openpyxl.reader.excel import ExcelReader
from openpyxl.styles.stylesheet import apply_stylesheet

from assess.errors import Problem
from assess.inventory.archive import DAMAGE, check_parts, explain, open_archive, sheet_paths, unreadable
from assess.inventory.columns import SHEETS
from assess.inventory.scan import scan_sheet
from assess.inventory.tables import SheetReader, Table
from assess.inventory.wording import ENGLISH, find_sheet, plain, translate, versions


def read_tables(path: Path) -> tuple[dict[str, Table], list[Problem]]:
    """Read every sheet of the workbook; the tables stand under the English names of their sheets.

    Raises
    ------
    WorkbookError
        If the file cannot be opened as a workbook at all.
    """
    if not DEFUSEDXML:
        raise unreadable(
            "defusedxml is missing, without which a hostile workbook could do harm.", "pip install defusedxml"
        )
    problems: list[Problem] = []
    try:
        with open_archive(path) as archive, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # openpyxl's remarks on drawings and the like mean nothing to a user
            return _read_sheets(path, archive, problems), problems
    except DAMAGE as error:
        raise explain(error, path.name) from error


def find_language(tables: Iterable[Table]) -> str:
    """Return the language of most of the sheets that were found, English where no other has more than half."""
    spoken = [table.language for table in tables if table.found]
    return next((code for code in spoken if spoken.count(code) * 2 > len(spoken)), ENGLISH)


def _read_sheets(path: Path, archive: ZipFile, problems: list[Problem]) -> dict[str, Table]:
    check_parts(archive, path.name)
    paths = sheet_paths(archive)
    tables = {sheet.name: Table(sheet, problems) for sheet in SHEETS}
    found = _find_sheets(tables, list(paths))
    scans = {name: scan_sheet(archive, paths[sheet]) for name, sheet in found.items()}
    with path.open("rb") as file:
        workbook = _open(file, [paths[sheet] for sheet in found.values()])
        for sheet in (sheet for sheet in SHEETS if sheet.name in scans):
            worksheet = workbook[found[sheet.name]]
            worksheet.reset_dimensions()
            SheetReader(tables[sheet.name], sheet, scans[sheet.name]).read(worksheet)
    return tables


def _open(file: IO[bytes], parts: list[str]) -> Any:
    """Open the workbook as openpyxl's `load_workbook` does, but with these sheets alone and nothing beside them.

    Other sheets, properties, themes and print areas need memory, and may be damaged, without being of use here.
    """
    reader = ExcelReader(file, read_only=True, data_only=True, keep_links=False)
    reader.valid_files = parts
    reader.read_manifest()
    reader.read_strings()
    reader.read_workbook()
    apply_stylesheet(reader.archive, reader.wb)
    reader.read_worksheets()
    return reader.wb


def _find_sheets(tables: Mapping[str, Table], present: Sequence[str]) -> dict[str, str]:
    """Return the names, as the workbook spells them, of the tables' sheets; report those that are missing."""
    known = {name: found for name in present if (found := find_sheet(name))}
    own = {
        english: names
        for english in tables
        if (names := [name for name, found in known.items() if found[0] == english])
    }
    for english, names in own.items():
        table, code = tables[english], known[names[0]][1]
        table.found, table.language, table.sheet = True, code, translate(table.sheet, code)
        if len(names) > 1:
            _report_twice(table, names)
    language, unknown = find_language(tables.values()), [name for name in present if name not in known]
    for table in (table for table in tables.values() if not table.found):
        _report_missing(table, language, unknown)
    return {english: names[0] for english, names in own.items()}


def _report_twice(table: Table, names: Sequence[str]) -> None:
    spelt = {plain(name): name for name in names}
    message = f"there are {len(names)} sheets of this name."
    if len(spelt) > 1:
        message = f"the sheets {' and '.join(spelt.values())} are the same in two languages."
    table.report("", message, "Delete all but one, or rename them.")


def _report_missing(table: Table, language: str, unknown: Sequence[str]) -> None:
    """Report a sheet that is missing, or that is there under a name that is nearly its own."""
    english, table.sheet = table.sheet, translate(table.sheet, language)
    for name in (sheet.name for sheet in versions(english)) if unknown else ():
        near = difflib.get_close_matches(plain(name), [plain(one) for one in unknown], 1, 0.75)
        if near:
            wrong = next(one for one in unknown if plain(one) == near[0])
            message, mend = f"there is no sheet named {name}.", f"Did you mean {name}? Rename it."
            table.problems.append(Problem("error", wrong, "", message, mend))
            return
    if english.required:
        table.report("", "the sheet is missing.", "Add it, or start from a workbook made with `assess new`.")
