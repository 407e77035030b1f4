"""Benchmark of buildings of a city in one process: reading, formulas only and simulated, in processor time.

The workbooks are as `assess new` writes them, with all prepared
rows, 12 to 40 pieces on two or three floors and an evacuation route. Each building has a height of its own, so that
none shares a motion with another; "shared" are buildings of one height. The rival is openpyxl, which hands over the
cells of the same workbook.
"""

import statistics
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import openpyxl

from assess.pipeline.live_values import with_live
from assess.pipeline.run import run
from assess.workbook.example import example_content
from assess.workbook.read import read_inventory
from assess.workbook.template import ROWS, Content, write_workbook
from tests.benchmarks.measuring import compare, spent

READ, SIMULATED, MANY, RUNS = 24, 6, 300, 200
"""Workbooks that are read, that are simulated, formulas only whose memory is measured, and motions."""
FORMULA_AIM, SIMULATED_AIM, MEMORY_AIM = 50, 2000, 600
"""Processor time [ms] of a workbook, and memory of a process [MB], at most."""
PIECES = (12, 19, 26, 33, 40)
STOREY = 3.6

MEMORY = """
import pathlib, re, sys
from assess.pipeline.run import run
for path in sys.argv[2:]:
    run(path, verify=sys.argv[1], runs=200, figures=False, jobs=1)
print(int(re.search(r"VmHWM:\\s+(\\d+)", pathlib.Path("/proc/self/status").read_text())[1]) / 1024)
"""
"""Linux alone: `resource` would count what the process was before it became this command."""


def rows(folder: Path) -> Iterator[str]:
    """Yield tables in Markdown; the workbooks are written into `folder`."""
    yield from _read_example(folder)
    yield ""
    own = [write_building(folder, number, 7.2 + 0.1 * number) for number in range(READ)]
    same = [write_building(folder, READ + number, 9.9) for number in range(SIMULATED + 1)]
    inventories = [read_inventory(path) for path in own]
    for inventory in inventories[:2]:
        run(inventory, verify="none", figures=False, jobs=1)
    run(same[0], verify="all", runs=RUNS, figures=False, jobs=1)  # compiles, and makes the motions of one height
    yield "| a workbook of 12 to 40 pieces | processor [ms], median | longest | aim [ms] |\n|---|---|---|---|"
    yield _row("openpyxl, read-only: its cells", _time(read_cells, own), None)
    yield _row("read and checked", _time(read_inventory, own), None)
    yield _row("run, formulas only", _time(lambda one: _run(one, "none"), inventories), None)
    yield _row("read and run, formulas only", _time(lambda one: _run(one, "none"), own), FORMULA_AIM)
    yield _row("read and run, simulated, motions shared", _time(lambda one: _run(one, "all"), same[1:]), SIMULATED_AIM)
    yield _row("read and run, simulated, motions its own", _time(lambda one: _run(one, "all"), own[:SIMULATED]),
               SIMULATED_AIM)  # fmt: skip
    yield f"\n| one process | peak memory [MB] | aim |\n|---|---|---|\n{_memory('none', own, MANY)}"
    yield _memory("all", own, READ)


def _read_example(folder: Path) -> Iterator[str]:
    """Yield how reading and checking the example, prepared rows and all, compares with openpyxl, mode for reading."""
    path, content = folder / "example.xlsx", example_content()
    write_workbook(path, with_live(content))
    ours, theirs, ratio = compare(lambda: read_inventory(path), lambda: read_cells(path), spent, 20)
    name = f"{len(content.rows['Items'])} pieces, {ROWS['Items']} rows prepared"
    yield "| read | processor [ms] | rival | processor [ms] | ratio (median) | aim |\n|---|---|---|---|---|---|"
    yield f"| {name} | {1e3 * ours:.0f} | openpyxl, read-only | {1e3 * theirs:.0f} | {ratio:.2f} | at most 40 ms |"


def read_cells(path: Path) -> int:
    """Return how many cells of a workbook hold a value."""
    book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    rows = (row for page in book.worksheets for row in page.iter_rows(values_only=True))
    count = sum(value is not None for row in rows for value in row)
    book.close()
    return count


def write_building(folder: Path, number: int, height: float) -> Path:
    """Write the workbook of a building of a height [m], with pieces and floors by its number."""
    content, floors = example_content(), 2 + number % 2
    rows = content.rows | {
        "Building": [{"building": f"Building {number}", "height": height, "ground_pga": 0.15 + 0.01 * (number % 20)}],
        "Floors": [{"floor": str(floor + 1), "elevation": round(STOREY * floor, 2)} for floor in range(floors)],
        "Items": list(_pieces(content.rows["Items"], PIECES[number % len(PIECES)], floors)),
    }
    path = folder / f"building-{number}.xlsx"
    write_workbook(path, with_live(Content(rows)))
    return path


def _pieces(known: Sequence[Mapping[str, Any]], count: int, floors: int) -> Iterator[dict[str, Any]]:
    for at in range(count):
        piece, turn = known[at % len(known)], at // len(known)
        floor = piece["floor"] if turn == 0 else str(1 + at % floors)
        yield {**piece, "item": f"{piece['item']}-{turn}", "floor": floor,
               **({} if turn == 0 else {"x": None, "y": None, "angle_deg": None, "route": None, "segment": None,
                                        "edge_distance": None})}  # fmt: skip


def _run(source: Any, verify: str) -> None:
    run(source, verify=verify, runs=RUNS, figures=False, jobs=1)


def _time(work: Callable[[Any], object], sources: Sequence[Any]) -> list[float]:
    return [1e3 * spent(lambda one=one: work(one)) for one in sources]  # type: ignore[misc]


def _row(name: str, times: Sequence[float], aim: int | None) -> str:
    shown = "" if aim is None else f"at most {aim}"
    return f"| {name} | {statistics.median(times):.0f} | {max(times):.0f} | {shown} |"


def _memory(verify: str, paths: Sequence[Path], count: int) -> str:
    """Return the row of a process that assesses `count` workbooks one after the other."""
    every = [str(paths[at % len(paths)]) for at in range(count)]
    done = subprocess.run([sys.executable, "-c", MEMORY, verify, *every], check=True, capture_output=True, text=True)
    name = {"none": "formulas only", "all": "simulated"}[verify]
    return f"| {count} workbooks, {name} | {float(done.stdout):.0f} | at most {MEMORY_AIM} |"
