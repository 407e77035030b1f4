"""What benchmarks share: clocks, whole processes, and rows of furniture."""

import subprocess
import sys
import time
from collections.abc import Callable

_CHILD = """
import resource, subprocess, sys, time
start = time.perf_counter()
done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
wall, used = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
print(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3))
sys.exit(done.stderr[-2000:] if done.returncode else 0)
"""
"""Run from a small process: a child's peak counts that of the process which started it."""


def measure(command: list[str]) -> tuple[float, float, float]:
    """Return wall time [s], time of the processor [s] and memory at the peak [MB] of a command."""
    done = subprocess.run([sys.executable, "-c", _CHILD, *command], capture_output=True, text=True, check=False)
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
