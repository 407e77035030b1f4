"""Benchmark of the workbook store: a workbook read, changed and written, against openpyxl, which rewrites all of it."""

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path

import openpyxl

from assess.web import book as page
from assess.workbook.open import MAX_MERGED, Book
from assess.workbook.read import open_workbook
from assess.workbook.template import Content, write_workbook
from tests.benchmarks.measuring import compare, list_items, spent
from tests.workbooks import FLOORS

MARKET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"
ROUNDS = 5
EDITED = range(10, 60)
"""Rows in which a breadth is changed."""


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; workbooks are written into `folder`."""
    yield ("| workbook | work | processor [ms] | openpyxl [ms] | ratio (median) |\n|---|---|---|---|---|")
    paths = {"121 rows, live": MARKET}
    for count in (1_000, 20_000):
        paths[f"{count:,} rows"] = folder / f"stored-{count}.xlsx"
        write_workbook(paths[f"{count:,} rows"], Content({"Floors": FLOORS, "Items": list_items(count)}))
    data = paths["1,000 rows"].read_bytes()
    merged = _merge(data)
    ours, theirs, ratio = compare(lambda: _edit(merged), lambda: _edit(data), spent, ROUNDS)
    yield f"| 16,384 merged cells, or none | 4,000 cells set | {1e3 * ours:.0f} | {1e3 * theirs:.0f} | {ratio:.3f} |"
    for name, path in paths.items():
        data = path.read_bytes()
        for work, own, other in (
            ("read, 50 cells set, written", _set, _set_elsewhere),
            ("read, a row inserted, written", _insert, _insert_elsewhere),
        ):
            ours, theirs, ratio = compare(lambda: own(data), lambda: other(data), spent, ROUNDS)  # noqa: B023 - at once
            yield f"| {name} | {work} | {1e3 * ours:.0f} | {1e3 * theirs:.0f} | {ratio:.3f} |"


def _merge(data: bytes) -> bytes:
    """Return a workbook with as many merged cells in Items as are read."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {info.filename: archive.read(info) for info in archive.infolist()}
    areas = "".join(f'<mergeCell ref="GA{row}:GB{row}"/>' for row in range(50_000, 50_000 + MAX_MERGED))
    with Book(data, "book.xlsx") as book:
        path = book.sheets["Items"]
    parts[path] = parts[path].replace(b"</sheetData>", f"</sheetData><mergeCells>{areas}</mergeCells>".encode())
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return packed.getvalue()


def _edit(data: bytes) -> None:
    book = page.Book.hold("book.xlsx", data, Path())
    book.edit(book.version, [["Items", row, 3, "x"] for row in range(2000, 6000)], "paste")


def _set(data: bytes) -> None:
    open_workbook(data, "book.xlsx").set({"Items": {(row, 6): 40.5 for row in EDITED}}).to_bytes()


def _set_elsewhere(data: bytes) -> None:
    book = openpyxl.load_workbook(io.BytesIO(data))
    for row in EDITED:
        book["Items"].cell(row, 7).value = 40.5
    book.save(io.BytesIO())


def _insert(data: bytes) -> None:
    open_workbook(data, "book.xlsx").insert_rows("Items", 10, like=9).to_bytes()


def _insert_elsewhere(data: bytes) -> None:
    """Insert a row; openpyxl leaves every formula and reference as it is."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    book["Items"].insert_rows(10)
    book.save(io.BytesIO())
