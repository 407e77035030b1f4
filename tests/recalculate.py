"""Recalculates a workbook, in formualizer and where it is installed in LibreOffice, to hold its stored results against.

LibreOffice keeps the results that a file stores unless its profile says otherwise, so that a comparison would compare
a file with itself; the profile written here says: always recalculate.
"""

import re
import shutil
import subprocess
import tempfile
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import formualizer
import openpyxl
import pytest

from assess.report.content import Content
from assess.report.xlsx import write_xlsx
from assess.results import Results
from tests.waiting import PATIENCE

_SOFFICE = shutil.which("soffice") or shutil.which("libreoffice")

needs_libreoffice = pytest.mark.skipif(_SOFFICE is None, reason="LibreOffice is not installed")

_PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse">
<value>0</value></prop></item>
</oor:items>
"""


def write_report(results: Results, path: Path) -> None:
    """Write the Excel report."""
    write_xlsx(Content(results), path)


def libreoffice(path: Path, out: Path, *, recalculates: bool = True) -> Path:
    """Open `path` in LibreOffice with every formula recalculated, or as its users do, and save it as `out`."""
    with tempfile.TemporaryDirectory() as box:
        shutil.copy(libreoffice_all([path], Path(box), recalculates=recalculates)[0], out)
    return out


def libreoffice_all(paths: Sequence[Path], folder: Path, *, recalculates: bool = True) -> list[Path]:
    """Do so with many workbooks at once, as it takes long to start; save them in `folder` by their names."""
    with tempfile.TemporaryDirectory() as profile:
        user = Path(profile) / "user"
        user.mkdir()
        if recalculates:
            (user / "registrymodifications.xcu").write_text(_PROFILE, encoding="utf-8")
        command = [
            str(_SOFFICE), f"-env:UserInstallation=file://{profile}", "--headless",
            "--convert-to", "xlsx", "--outdir", str(folder), *map(str, paths),
        ]  # fmt: skip
        subprocess.run(command, check=True, capture_output=True, timeout=PATIENCE * len(paths))
    written = [folder / f"{path.stem}.xlsx" for path in paths]
    assert all(path.is_file() for path in written)
    return written


def stored_cells(path: Path) -> dict[tuple[str, str], Any]:
    """Return what a file stores, results of formulas included, by sheet and cell."""
    book = openpyxl.load_workbook(path, data_only=True)
    return {(sheet.title, cell.coordinate): cell.value for sheet in book for row in sheet.iter_rows() for cell in row
            if cell.value is not None}  # fmt: skip


def poison(path: Path) -> None:
    """Replace every stored result by nonsense, so that agreement can only come from recalculation."""
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            if name.startswith("xl/worksheets/sheet"):
                plain = re.sub(rb' t="str"(?=[^>]*><f>)', b"", data)
                archive.writestr(name, re.sub(rb"(</f>)<v>[^<]*</v>", rb"\1<v>0.123</v>", plain))
            else:
                archive.writestr(name, data)


def evaluate(path: Path, edits: Iterable[tuple[str, int, int, Any]] = ()) -> Any:
    """Return a workbook as formualizer computes it after cells (sheet, row, column) were given values."""
    book = formualizer.load_workbook(str(path))
    for sheet, row, column, value in edits:
        book.set_value(sheet, row, column, value)
    book.evaluate_all()
    return book


def compare_formulas(path: Path) -> int:
    """Hold every stored result of a formula against what formualizer computes; return how many there are."""
    stored = stored_cells(path)
    poison(path)
    book = evaluate(path)
    formulas = [(sheet.title, cell) for sheet in openpyxl.load_workbook(path) for row in sheet.iter_rows()
                for cell in row if cell.data_type == "f"]  # fmt: skip
    for title, cell in formulas:
        found = book.get_value(title, cell.row, cell.column)
        assert same(found, stored.get((title, cell.coordinate), "")), (title, cell.coordinate)
    return len(formulas)


def same(first: Any, second: Any) -> bool:
    """Tell whether two values of cells are the same, numbers to 1e-9."""
    if isinstance(first, int | float) and isinstance(second, int | float):
        return abs(first - second) <= 1e-9
    return bool(first == second)
