"""How a portfolio grows: with its buildings, and with the processes that work on it; and how fast its tables answer.

It takes some ten minutes on two processors that do nothing else. Workbooks are those of the worked city, 12 to 40
pieces each, copied under other names; whole commands are timed, with their start and all reports but the first table,
which has the tables alone.
"""

import resource
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import duckdb

from assess.portfolio.example_city import GRID, write_example_city
from assess.portfolio.run_portfolio import FORMATS

TABLES = "parquet"
QUERY = "SELECT type, count(*), sum(quantity * probability) FROM read_parquet('{}') GROUP BY type ORDER BY 3 DESC"


def rows(folder: Path) -> Iterator[str]:
    """Yield tables in Markdown; cities are written into `folder`."""
    yield from _measure(folder, 1000, 3, (100, 500, 1000, 2000, 5000))


def small(folder: Path) -> Iterator[str]:
    """Yield the same of small cities, for a trial in a minute."""
    yield from _measure(folder, 40, 1, (20, 40))


def _measure(folder: Path, count: int, rounds: int, counts: tuple[int, ...]) -> Iterator[str]:
    write_example_city(folder / "bay")
    yield from compare_processes(folder, count, rounds)
    yield from grow(folder, counts)


def fill(folder: Path, count: int) -> Path:
    """Return a folder with so many workbooks, copies of those of the worked city."""
    city = folder / f"city-{count}"
    city.mkdir(exist_ok=True)
    made = sorted((folder / "bay").glob("*/*.xlsx"))
    for at in range(count):
        shutil.copyfile(made[at % len(made)], city / f"{at:05}.xlsx")
    return city


def assess(folder: Path, city: Path, jobs: int, formats: str, verify: str = "none") -> float:
    """Return the wall time [s] of a whole command."""
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    words = ["portfolio", str(city), "--out", str(out), "--shakemap", str(folder / "bay" / GRID), "--verify", verify]
    start = time.perf_counter()
    subprocess.run(
        [str(Path(sys.executable).with_name("assess")), *words, "--jobs", str(jobs), "--formats", formats],
        check=True,
        capture_output=True,
    )
    return time.perf_counter() - start


def compare_processes(folder: Path, count: int, rounds: int) -> Iterator[str]:
    """Yield the wall times with one process and with two, in turn, and the median of their ratios."""
    yield "| buildings | verify | 1 process [s] | 2 processes [s] | ratio (median) | aim |\n|---|---|---|---|---|---|"
    for verify, number in (("none", count), ("all", max(4, count // 20))):
        city = fill(folder, number)
        pairs = [[assess(folder, city, jobs, TABLES, verify) for jobs in (1, 2)] for _ in range(rounds)]
        one, two = (statistics.median(times) for times in zip(*pairs, strict=True))
        ratio = statistics.median(first / second for first, second in pairs)
        yield f"| {number:,} | {verify} | {one:.1f} | {two:.1f} | {ratio:.2f} | 1.7 |"


def grow(folder: Path, counts: tuple[int, ...]) -> Iterator[str]:
    """Yield wall time, the largest memory of one process so far, and the time of a query, by buildings."""
    yield (
        "\n| buildings, formulas only, all results | rows of pieces | 2 processes [s] | ms a building | "
        "largest process so far [MB] | query [s] |\n|---|---|---|---|---|---|"
    )
    for count in counts:
        seconds = assess(folder, fill(folder, count), 2, ",".join(FORMATS))
        memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        files = str(folder / "out" / "pieces*.parquet")
        start = time.perf_counter()
        duckdb.sql(QUERY.format(files)).fetchall()
        query = time.perf_counter() - start
        ((rows,),) = duckdb.sql(f"SELECT count(*) FROM read_parquet('{files}')").fetchall()
        yield (f"| {count:,} | {rows:,} | {seconds:.1f} | {1000 * seconds / count:.0f} | {memory:.0f} | {query:.3f} |")
