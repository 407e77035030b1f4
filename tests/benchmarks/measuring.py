"""What benchmarks share: clocks, whole processes, and rows of furniture."""

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from assess.workbook.template import Content, write_workbook

ROOT = Path(__file__).parents[2]

_CHILD = """
import resource, subprocess, sys, time
start = time.perf_counter()
done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
wall, used = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
print(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3))
sys.exit(done.stderr[-2000:] if done.returncode else 0)
"""
"""Run from a small process: a child's peak counts that of the process which started it."""


def measure(command: list[str], environment: Mapping[str, str] | None = None) -> tuple[float, float, float]:
    """Return wall time [s], time of the processor [s] and memory at the peak [MB] of a command."""
    done = subprocess.run(
        [sys.executable, "-c", _CHILD, *command], capture_output=True, text=True, check=False, env=environment
    )
    if done.returncode:
        raise RuntimeError(done.stderr)
    wall, processor, peak = map(float, done.stdout.split())
    return wall, processor, peak


def spent(work: Callable[[], object]) -> float:
    """Return the processor time that some work takes [s]."""
    start = time.process_time()
    work()
    return time.process_time() - start


def timed(work: Callable[[], object]) -> float:
    """Return the wall time that some work takes [s]."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def list_items(count: int) -> list[dict[str, object]]:
    """Return rows of Items on the floors 1 and 2."""
    return [
        {"item": f"i{at}", "floor": str(1 + at % 2), "room": f"room {at % 97}", "description": "Bookcase, steel",
         "breadth": 20 + at % 70, "width": 120, "height": 100 + at % 130, "axis": "XY"[at % 2], "notes": "by the door"}
        for at in range(count)
    ]  # fmt: skip


def compare(own: Callable[[], object], other: Callable[[], object], clock: Callable[[Callable[[], object]], float],
            rounds: int) -> tuple[float, float, float]:  # fmt: skip
    """Return the median times of two pieces of work, in turn after one of each [s], and that of their ratios."""
    pairs = [(clock(own), clock(other)) for _ in range(rounds + 1)][1:]
    ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
    return ours, theirs, statistics.median(one / two for one, two in pairs)


def write_thousand(path: Path, count: int = 1000, floors: int = 10) -> Path:
    """Write a workbook of `count` pieces on as many floors, half of them with a position on the plan."""
    kinds = ("Bookcase", "Filing cabinet with four drawers", "Server rack in the corner", "Wardrobe", "Display cabinet")
    levels = [
        {"floor": str(at), "elevation": 3.5 * at, "pfa_x": 0.12 + 0.03 * at, "pfv_x": 18.0 + 4 * at, "pfa_y": 0.3}
        for at in range(1, floors + 1)
    ]
    pieces = [
        {"item": f"P{at:04d}", "floor": str(1 + at % floors), "room": f"Room {at % 23}",
         "description": kinds[at % len(kinds)], "breadth": 28 + at % 37, "width": 90, "height": 110 + at % 97,
         "axis": "XY"[at % 2], "anchored": "yes" if at % 11 == 0 else "no",
         "x": float(at * 7 % 31) if at % 20 < 10 else None, "y": float(at * 3 % 23) if at % 20 < 10 else None}
        for at in range(count)
    ]  # fmt: skip
    write_workbook(path, Content(rows={"Building": [{"building": "Ten floors"}], "Floors": levels, "Items": pieces}))
    return path
