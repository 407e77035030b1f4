"""Benchmark of reading a workbook with a dozen pieces, prepared rows and all, against openpyxl in its mode for reading.

Run it alone: ``python tests/benchmarks/workbooks_read.py``. Ours finds every value of the inventory and checks it;
openpyxl hands over the cells.
"""

import statistics
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

import openpyxl

sys.path.insert(0, str(Path(__file__).parents[2]))

from assess.pipeline.live_values import with_live
from assess.workbook.example import example_content
from assess.workbook.read import read_inventory
from assess.workbook.template import ROWS, write_workbook
from tests.benchmarks.measuring import spent

AIM, ROUNDS = 40, 20
"""Longest median time to read it [ms of processor time], and how often it is read."""

ITEMS_PART = "xl/worksheets/sheet4.xml"


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; the workbook is written into `folder`."""
    path, content = folder / "example.xlsx", example_content()
    write_workbook(path, with_live(content))
    pairs = [(1e3 * spent(lambda: read_inventory(path)), 1e3 * spent(lambda: read_cells(path)))
             for _ in range(ROUNDS + 1)][1:]  # fmt: skip
    ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
    ratio = statistics.median(own / other for own, other in pairs)
    with zipfile.ZipFile(path) as archive:
        size = archive.getinfo(ITEMS_PART).file_size / 1e6
    name = f"{len(content.rows['Items'])} pieces, {ROWS['Items']} rows prepared ({size:.2f} MB)"
    yield "| read | processor [ms] | rival | processor [ms] | ratio (median) | aim |\n|---|---|---|---|---|---|"
    yield f"| {name} | {ours:.0f} | openpyxl, read-only | {theirs:.0f} | {ratio:.2f} | at most {AIM} ms |"


def read_cells(path: Path) -> int:
    """Return how many cells of a workbook hold a value."""
    book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    rows = (row for page in book.worksheets for row in page.iter_rows(values_only=True))
    count = sum(value is not None for row in rows for value in row)
    book.close()
    return count


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as box:
        print(*rows(Path(box)), sep="\n")
