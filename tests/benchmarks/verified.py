"""Benchmark of a whole verified run: pieces of different size on ten floors with records along both axes."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from assess.motion.record import resample
from assess.units import GRAVITY
from tests.hazards import write_hazard
from tests.motion.motions import MARKET, ROOT, read_motion
from tests.workbooks import write

STEP, SAMPLES, PEAK, FLOORS, RUNS = 0.01, 4000, 0.35, 10, 200

TIMED = """
import json, resource, sys, threading, time
from assess.rocking import ensemble
real, lock, spent = ensemble.rock_blocks, threading.Lock(), [0.0, 0]
def timed(*given, **named):
    start = time.perf_counter()
    found = real(*given, **named)
    with lock:
        spent[0] += time.perf_counter() - start
        spent[1] += found.overturned.size
    return found
ensemble.rock_blocks = timed
start = time.perf_counter()
from typer.testing import CliRunner
from assess.cli.app import app
result = CliRunner().invoke(app, sys.argv[1:])
assert result.exit_code == 0, result.output
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps([time.perf_counter() - start, time.process_time(), *spent, peak]))
"""


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; workbooks and records are written into `folder`."""
    names = _write_records(folder)
    yield "| simulated run | seconds | processor | rocking [thread-seconds] | pairs | peak memory [MB] | aim |"
    yield "|---|---|---|---|---|---|---|"
    first = 0.0
    for count, aim in ((1000, "20 s on two processors, 1,500 MB"), (10_000, "5 times the line above")):
        book = _write_book(folder, count, names)
        out = ["--out", str(folder / "out"), "--formats", "json,csv"]
        command = ["run", str(book), "--verify", "all", "--runs", str(RUNS), *out]
        measured = _run(command)
        seconds, first = measured[0], first or measured[0]
        yield _row(f"{count:,} items, {FLOORS} floors, json,csv", measured, aim)
    book = _write_book(folder, 1000, names, ground_pga=0.2, hazard=write_hazard(folder).name)
    command = ["run", str(book), "--runs", str(RUNS), "--out", str(folder / "out"), "--formats", "json,csv"]
    yield _row("1,000 items, with chances a year", _run(command), "5 times the line of 1,000")
    yield f"\nThe second took {seconds / first:.1f} times the first."


def _run(command: list[str]) -> list[float]:
    done = subprocess.run([sys.executable, "-c", TIMED, *command], check=True, capture_output=True, text=True)
    return [float(one) for one in json.loads(done.stdout.splitlines()[-1])]


def _row(name: str, measured: list[float], aim: str) -> str:
    seconds, processor, rocking, pairs, peak = measured
    return f"| {name} | {seconds:.1f} | {processor:.1f} | {rocking:.1f} | {pairs:,.0f} | {peak:.0f} | {aim} |"


def _write_records(folder: Path) -> list[str]:
    """Write 20 floor motions of 40 s at 100 samples a second, made of recorded ones scaled to one peak."""
    market = sorted(path.stem[-1] for path in MARKET.glob("*.smc") if path.stem[-1] not in "fj")
    berkeley = sorted((ROOT / "samples" / "buildings" / "berkeley-1103").glob("*_a.smc"))
    names = [*market, *(str(Path("..") / "buildings" / "berkeley-1103" / path.stem) for path in berkeley), "0165a_u"]
    written = []
    for number, name in enumerate(names[: 2 * FLOORS]):
        motion = read_motion(name)
        times = np.arange(motion.acceleration.size) * motion.time_step
        values = resample(times, motion.acceleration, STEP)
        first = max(0, int(np.abs(values).argmax()) - 800)
        values = np.pad(values[first : first + SAMPLES], (0, max(0, SAMPLES - values[first:].size)))
        values *= PEAK * GRAVITY / np.abs(values).max()
        lines = (f"{at * STEP:.2f},{100 * value:.5f}" for at, value in enumerate(values))
        written.append(f"floor-{number}.csv")
        head = "# corrected: yes\ntime [s], along [cm/s2]\n"
        (folder / written[-1]).write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return written


def _write_book(folder: Path, count: int, names: list[str], **building: object) -> Path:
    rng = np.random.default_rng(count)
    height = rng.uniform(60, 220, count)
    breadth = np.maximum(5, height * rng.uniform(0.1, 0.5, count))
    floors = [
        {"floor": str(floor), "record_x": names[2 * floor], "record_y": names[2 * floor + 1]} for floor in range(FLOORS)
    ]
    items = [
        {"item": f"i{at}", "floor": str(at % FLOORS), "breadth": round(breadth[at], 2), "width": 150,
         "height": round(height[at], 2)}
        for at in range(count)
    ]  # fmt: skip
    return write(folder / f"{count}.xlsx", items, floors, **building)
