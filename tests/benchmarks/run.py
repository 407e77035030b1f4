"""Benchmarks: whole-process times as ratios against a rival in the same run. Run: ``make benchmark``.

Times on a shared machine vary; each pair runs in turn, and the median of the ratios is what counts.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.workbooks import write

ROUNDS = 7


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as box:
        folder = Path(box)
        thousand = write(folder / "1000.xlsx", _items(1000))
        twenty = write(folder / "20000.xlsx", _items(20_000))
        out = ["--out", str(folder / "out")]
        assess = str(Path(sys.executable).with_name("assess"))
        run = [assess, "run"]
        rows = [
            _compare("assess --help", [assess, "--help"], "import typer", 3),
            _compare(
                "assess run, 1,000 items, json,csv",
                [*run, str(thousand), "--verify", "none", "--formats", "json,csv", *out],
                "import numpy, openpyxl",
                4,
            ),
        ]
        print("| command | median [s] | rival | median [s] | ratio (median) | aim |\n|---|---|---|---|---|---|")
        for row in rows:
            print(row)
        print("\n| one run | seconds | peak memory [MB] |\n|---|---|---|")
        print(_once("20,000 items, json,csv,xlsx", [*run, str(twenty), "--formats", "json,csv,xlsx", *out]))
        print(_once("1,000 items, json,csv", [*run, str(thousand), "--formats", "json,csv", *out]))


def _items(count: int) -> list[dict[str, object]]:
    return [
        {"item": f"i{at}", "floor": str(1 + at % 2), "room": f"room {at % 97}", "description": "Bookcase, steel",
         "breadth": 20 + at % 70, "width": 120, "height": 100 + at % 130, "axis": "XY"[at % 2], "notes": "by the door"}
        for at in range(count)
    ]  # fmt: skip


def _compare(name: str, command: list[str], rival: str, aim: int) -> str:
    pairs = [(_seconds(command), _seconds([sys.executable, "-c", rival])) for _ in range(ROUNDS + 1)][1:]
    ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
    ratio = statistics.median(own / other for own, other in pairs)
    return f"| {name} | {ours:.2f} | python -c '{rival}' | {theirs:.2f} | {ratio:.2f} | at most {aim} |"


def _seconds(command: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


_MEASURE = (
    "import resource, subprocess, sys\n"
    "subprocess.run(sys.argv[1:], check=True, capture_output=True)\n"
    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)"
)
"""Run from a small process: a child's peak counts that of the process which started it."""


def _once(name: str, command: list[str]) -> str:
    start = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", _MEASURE, *command], check=True, capture_output=True, text=True)
    return f"| {name} | {time.perf_counter() - start:.1f} | {float(done.stdout):.0f} |"


if __name__ == "__main__":
    main()
