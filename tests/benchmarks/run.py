"""Benchmarks: whole processes, motions made and blocks rocked, as ratios against a rival in the same run.

Run: ``make benchmark``, or in half a minute ``python tests/benchmarks/run.py start``. Times on a shared machine vary;
each pair runs in turn, and the median of the ratios is what counts.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from eqsig import sdof

sys.path.insert(0, str(Path(__file__).parents[2]))

from assess.motion.generate import build_generator
from assess.motion.spectrum import build_periods, response_spectrum
from assess.motion.target import Grid, recorded_target
from tests.benchmarks import (
    beam_floors,
    cancel,
    generating,
    live_answers,
    models,
    portfolio,
    report,
    rocking,
    routes,
    verified,
    workbooks_read,
)
from tests.benchmarks.measuring import list_items, measure, timed
from tests.motion.motions import cut
from tests.workbooks import write

ROUNDS = 7
START = "start"
"""Argument with which only the start-up and a small run are measured, in half a minute."""


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as box:
        folder = Path(box)
        thousand = write(folder / "1000.xlsx", list_items(1000))
        out = ["--out", str(folder / "out")]
        assess = str(Path(sys.executable).with_name("assess"))
        run = [assess, "run"]
        rows = [
            _compare("assess --help", [assess, "--help"], "import typer", 3),
            _compare(
                "assess run, 1,000 items, json,csv",
                [*run, str(thousand), "--formats", "json,csv", "--verify", "none", *out],
                "import numpy, openpyxl",
                3,
            ),
        ]
        print("| command | median [s] | rival | median [s] | ratio (median) | aim |\n|---|---|---|---|---|---|")
        for row in rows:
            print(row)
        for row in ("", *workbooks_read.rows(folder)):
            print(row)
        if sys.argv[1:] == [START]:
            return
        twenty = write(folder / "20000.xlsx", list_items(20_000))
        print("\n| one run | seconds | peak memory [MB] |\n|---|---|---|")
        out += ["--verify", "none"]
        print(
            _once("20,000 items, not verified, json,csv,xlsx", [*run, str(twenty), "--formats", "json,csv,xlsx", *out])
        )
        print(_once("1,000 items, not verified, json,csv", [*run, str(thousand), "--formats", "json,csv", *out]))
        print()
        for row in (
            *report.rows(folder),
            "",
            *verified.rows(folder),
            "",
            *routes.rows(folder),
            "",
            *cancel.rows(folder),
            "",
            *live_answers.rows(folder),
            "",
            *portfolio.rows(folder),
            "",
            *models.rows(folder),
        ):
            print(row)
    print("\n| motions of 4,000 samples | seconds | rival | seconds | times as fast | aim |\n|---|---|---|---|---|---|")
    print(_spectrum())
    print(_ensemble())
    print()
    for row in (*generating.rows(), "", *beam_floors.rows(), "", *rocking.rows()):
        print(row)


def _compare(name: str, command: list[str], rival: str, aim: int) -> str:
    pairs = [(_seconds(command), _seconds([sys.executable, "-c", rival])) for _ in range(ROUNDS + 1)][1:]
    ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
    ratio = statistics.median(own / other for own, other in pairs)
    return f"| {name} | {ours:.2f} | python -c '{rival}' | {theirs:.2f} | {ratio:.2f} | at most {aim} |"


def _seconds(command: list[str]) -> float:
    """Return the time of a command as a user has it, who keeps what Python has compiled."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True, env=environment)
    return time.perf_counter() - start


STEP, SAMPLES = 0.005, 4000
PERIODS = build_periods(count=100)


def _spectrum() -> str:
    """Return the row of one spectrum of 575 Market Street's 42nd floor, on one thread, compiled before."""
    motion = cut("a", 0, (SAMPLES - 1) * STEP).acceleration
    pairs = [
        (
            timed(lambda: [response_spectrum(motion, STEP, PERIODS) for _ in range(50)]) / 50,
            timed(lambda: sdof.pseudo_response_spectra(motion, STEP, PERIODS, 0.05)),
        )
        for _ in range(ROUNDS + 1)
    ][1:]
    ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
    ratio = statistics.median(other / own for own, other in pairs)
    return f"| spectrum, 100 periods | {ours:.5f} | eqsig | {theirs:.3f} | {ratio:.0f} | at least 50 |"


def _ensemble() -> str:
    """Return the row of 100 realisations of the same, found, made and measured on two threads, compiled before."""
    grid = Grid(STEP, SAMPLES)
    target = recorded_target(cut("a", 0, grid.duration), grid)
    generator = build_generator(target, grid, seed=1, axis="X", threads=2)
    ours = statistics.median(
        timed(lambda: build_generator(target, grid, seed=1, axis="X", threads=2)) for _ in range(ROUNDS)
    )
    made = generator.realise()
    theirs = timed(lambda: [sdof.pseudo_response_spectra(motion, STEP, PERIODS, 0.05) for motion in made])
    name, rival = "100 realisations, two threads", "eqsig: the 100 spectra of these motions"
    return f"| {name} | {ours:.2f} | {rival} | {theirs:.1f} | {theirs / ours:.1f} | at most 2 s |"


def _once(name: str, command: list[str]) -> str:
    seconds, _, peak = measure(command)
    return f"| {name} | {seconds:.1f} | {peak:.0f} |"


if __name__ == "__main__":
    main()
