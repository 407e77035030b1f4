"""Benchmark of the workbook store: a workbook read, changed and written, against openpyxl, which rewrites all of it."""

import io
from collections.abc import Iterator
from pathlib import Path

import openpyxl

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
    for name, path in paths.items():
        data = path.read_bytes()
        for work, own, other in (
            ("read, 50 cells set, written", _set, _set_elsewhere),
            ("read, a row inserted, written", _insert, _insert_elsewhere),
        ):
            ours, theirs, ratio = compare(lambda: own(data), lambda: other(data), spent, ROUNDS)  # noqa: B023 - at once
            yield f"| {name} | {work} | {1e3 * ours:.0f} | {1e3 * theirs:.0f} | {ratio:.3f} |"


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
