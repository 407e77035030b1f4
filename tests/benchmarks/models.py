"""Benchmark of building models: ``assess import`` as a whole against a plain script that takes the shapes one by one.

The rival does what most tutorials do: it opens the model and asks
for the shape of each furnishing element, space, door and wall with the settings as they are. It writes nothing; ours
writes the workbook and the plans. Processor time is that of a process and its child, memory the sum of their peaks.
"""

import statistics
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from tests.bim.ifc_files import ModelWriter

MODELS = Path(__file__).parents[2] / "samples" / "models"
ROUNDS = 3
SECONDS_AIM, MEMORY_AIM = 10, 1000
"""Processor time [s] and memory [MB] that a model of the samples takes at most."""
ROOMS, PIECES = 200, 25
"""Rooms of the larger model, and pieces in each."""

_COUNT = """
import resource, sys
def count():
    every = [resource.getrusage(one) for one in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    unit = 1e6 if sys.platform == "darwin" else 1e3
    print(sum(one.ru_utime + one.ru_stime for one in every), sum(one.ru_maxrss for one in every) / unit)
"""
OURS = f"""{_COUNT}
from assess.__main__ import main
try:
    main()
except SystemExit as ended:  # 1: some pieces were left out
    if ended.code not in (None, 0, 1):
        raise
count()
"""
RIVAL = f"""{_COUNT}
import ifcopenshell, ifcopenshell.geom
model = ifcopenshell.open(sys.argv[1])
settings = ifcopenshell.geom.settings()
for kind in ("IfcFurnishingElement", "IfcSpace", "IfcDoor", "IfcWall"):
    for one in model.by_type(kind):
        if one.Representation:
            ifcopenshell.geom.create_shape(settings, one)
count()
"""


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; models and workbooks are written into `folder`."""
    yield (
        "| model | assess import: processor [s] | peak memory [MB] | rival: shapes one by one, processor [s] | "
        "peak memory [MB] | ratio of processor times (median) | aim |"
    )
    yield "|---|---|---|---|---|---|---|"
    aim = f"at most {SECONDS_AIM} s and {MEMORY_AIM:,} MB"
    for name in ("duplex.ifc", "LargeBuilding.ifc"):
        yield _row(name, MODELS / name, folder, ROUNDS, aim)
    large = write_rooms(folder / "rooms.ifc")
    name = f"{ROOMS * PIECES:,} pieces in {ROOMS} rooms ({large.stat().st_size / 1e6:.0f} MB)"
    yield _row(name, large, folder, 1, "")


def _row(name: str, model: Path, folder: Path, rounds: int, aim: str) -> str:
    ours = [OURS, "import", str(model), "--out", str(folder / "book.xlsx"), "--force"]
    pairs = [(_measure(ours), _measure([RIVAL, str(model)])) for _ in range(rounds)]
    own, other = (_take_medians(side) for side in zip(*pairs, strict=True))
    ratio = statistics.median(mine[0] / theirs[0] for mine, theirs in pairs)
    return f"| {name} | {own[0]:.1f} | {own[1]:.0f} | {other[0]:.1f} | {other[1]:.0f} | {ratio:.2f} | {aim} |"


def _take_medians(measured: Sequence[tuple[float, float]]) -> list[float]:
    return [statistics.median(values) for values in zip(*measured, strict=True)]


def _measure(command: list[str]) -> tuple[float, float]:
    """Return processor time [s] and memory [MB] of a program with its arguments."""
    done = subprocess.run([sys.executable, "-c", *command], check=True, capture_output=True, text=True)
    seconds, peak = map(float, done.stdout.splitlines()[-1].split())
    return seconds, peak


def write_rooms(path: Path, rooms: int = ROOMS, pieces: int = PIECES) -> Path:
    """Write a model of one storey with rooms of 6 x 5 m in rows of 20, and boxes in each."""
    model = ModelWriter()
    storey = model.storey()
    for number in range(rooms):
        x, y = 6.2 * (number % 20), 5.2 * (number // 20)
        room = model.space(storey, (x + 3, y + 2.5, 0, 6, 5, 3), f"{number:03}")
        for at in range(pieces):
            size = (0.3 + 0.01 * (at % 7), 0.8, 0.7 + 0.05 * at)
            model.piece(f"Cabinet {at}", (0, 0, 0, *size), within=room, at=(x + 0.6 + at % 5, y + 0.5 + at // 5, 0))
    return model.write(path)
