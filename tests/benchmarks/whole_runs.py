"""Benchmark of whole runs, each a process of its own: against a rival, and against an older checkout if one is named.

All are run in turn, so that a machine that slows down slows all of them; the median of the ratios is what counts. The
rival is a Python that loads numpy and openpyxl. Python and numba have compiled everything before.
"""

import os
import statistics
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.bounds import plain
from tests.benchmarks.measuring import ROOT, list_items, measure, write_thousand
from tests.workbooks import write

RIVAL = "import numpy, openpyxl"
MARKET = ROOT / "inventories" / "market-street.xlsx"
FORMULAS = ("--verify", "none")


@dataclass(frozen=True, kw_only=True)
class Job:
    """A run: of which workbook, with which options, how often it is measured, and what it may take."""

    name: str
    book: Path = MARKET
    options: tuple[str, ...] = ()
    rounds: int = 3
    aim: str = ""


def jobs(folder: Path, *, is_quick: bool) -> Iterator[Job]:
    """Yield the runs, with their workbooks written into `folder`; those of half a minute alone where `is_quick`."""
    thousand, data = write(folder / "1000.xlsx", list_items(1000)), ("--formats", "json,csv")
    yield Job(name="1,000 rows by formulas, json,csv", book=thousand, options=(*FORMULAS, *data), rounds=7,
              aim="3 times the rival")  # fmt: skip
    if is_quick:
        return
    yield Job(name="121 rows simulated, json", options=("--formats", "json"), aim="8 s of processor time")
    yield Job(name="121 rows simulated, default formats", aim="18 s of processor time, 12 s of wall time")
    yield Job(name="121 rows simulated, the annex alone", options=("--formats", "annex"), aim="20 s above json")
    ten = write_thousand(folder / "floors.xlsx")
    yield Job(name="1,000 rows on 10 floors by formulas, default formats", book=ten, options=FORMULAS, rounds=1)
    many = plain(folder / "50000.xlsx", 50_000, 60)
    yield Job(name="50,000 rows on 60 floors by formulas, json,csv", book=many, options=(*FORMULAS, *data), rounds=1,
              aim="12 s of wall time, 300 MB")  # fmt: skip


def rows(folder: Path, before: Path | None = None, *, is_quick: bool = False) -> Iterator[str]:
    """Yield a table in Markdown; workbooks and reports are written into `folder`, `before` is an older checkout."""
    yield (
        "| whole run | wall [s] | processor [s] | peak memory [MB] | over the rival: wall | processor | "
        "over the older checkout: wall | processor | memory | aim: at most |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for job in jobs(folder, is_quick=is_quick):
        assess = [sys.executable, "-P", "-m", "assess"]  # not that of the folder in which this is called
        command = [*assess, "run", str(job.book), *job.options, "--out", str(folder / "out")]
        ways: dict[str, tuple[list[str], Path]] = {
            "own": (command, ROOT), "rival": ([sys.executable, "-c", RIVAL], ROOT)
        }  # fmt: skip
        ways |= {"before": (command, before)} if before else {}
        for way, root in ways.values():
            measure(way, environment(root))
        found = [{name: measure(way, environment(root)) for name, (way, root) in ways.items()}
                 for _ in range(job.rounds)]  # fmt: skip
        wall, processor, peak = (statistics.median(one["own"][at] for one in found) for at in range(3))
        ratios = [*(_divide(found, "rival", at) for at in range(2)), *(_divide(found, "before", at) for at in range(3))]
        cells = [job.name, f"{wall:.2f}", f"{processor:.2f}", f"{peak:.0f}", *ratios, job.aim]
        yield f"| {' | '.join(cells)} |"


def environment(root: Path) -> dict[str, str]:
    """Return the environment of a process that has the package of a checkout, and keeps what Python has compiled."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PYTHONPATH": str(root.resolve())}


def _divide(found: list[Mapping[str, tuple[float, ...]]], other: str, at: int) -> str:
    if other not in found[0]:
        return ""
    return f"{statistics.median(one['own'][at] / one[other][at] for one in found):.2f}"
