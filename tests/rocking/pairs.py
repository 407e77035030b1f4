"""Pairs of block and real record, and what the reference makes of them: `tests/data/rocking_reference.csv`.

``python tests/rocking/pairs.py`` computes the table again, some hours on one core.
"""

import csv
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.units import GRAVITY
from tests.rocking.reference import integrate, of_sizes, scaled

TABLE = ROOT / "tests" / "data" / "rocking_reference.csv"
NOT_DRAWN = "samples/records/np01002p_4225c_a.smc"
"""A record that came with the package after the pairs were drawn."""
FOLDERS = ("inventories/records/575-market", "samples/buildings/berkeley-1103", "samples/records")
COUNT, WINDOW, SEED = 2116, 25.0, 20261121
ROBUST = (0.98, 0.99, 0.995, 1.0, 1.005, 1.01, 1.02)
HEADS = ("record", "breadth_m", "height_m", "times_threshold", "overturned", "max_rotation_ratio", "impacts", "robust")

Pair = tuple[str, float, float, float]
"""Record, breadth and height [m], and peak over the threshold."""


@cache
def ground(name: str) -> tuple[np.ndarray, float]:
    """Return the strongest 25 s of a record [g], 5 s of which are before its peak, and the time step [s]."""
    motion = treat(read_records(ROOT / name)[0])
    values, step = motion.acceleration / GRAVITY, motion.time_step
    first = max(0, int(np.abs(values).argmax()) - round(5 / step))
    return values[first : first + round(WINDOW / step)], step


def record_names() -> list[str]:
    found = [
        path
        for folder in FOLDERS
        for path in sorted((ROOT / folder).glob("*_a.smc")) + sorted((ROOT / folder).glob("*0210*.smc"))
    ]
    names = [path.relative_to(ROOT).as_posix() for path in found] + ["samples/records/0165a_u.smc"]
    names = [name for name in names if name != NOT_DRAWN]
    return [name for name in names if not read_records(ROOT / name)[0].vertical]


def draw_pairs() -> list[Pair]:
    """Return the pairs: every record as often, sizes of furniture, 0.5 to 4 times the rocking threshold."""
    rng, names = np.random.default_rng(SEED), record_names()
    pairs = []
    for number in range(COUNT):
        height = rng.uniform(0.6, 2.2)
        breadth = height * rng.uniform(0.1, 0.6)
        times = rng.uniform(0.5, 4)
        pairs.append((names[number % len(names)], round(breadth, 3), round(height, 3), round(times, 3)))
    return pairs


def find(pair: Pair) -> tuple[str, float, float, float, int, str, int, int]:
    """Return the reference's row of a pair."""
    name, breadth, height, times = pair
    values, step = ground(name)
    found = {}
    for factor in ROBUST:
        block = of_sizes(breadth, height)
        found[factor] = integrate(block, scaled(values, block, times * factor), step)
    one = found[1.0]
    robust = len({other.overturned for other in found.values()}) == 1
    return (*pair, int(one.overturned), f"{one.rotation:.9g}", one.impacts, int(robust))


def read_table() -> list[dict[str, str]]:
    with TABLE.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def main() -> None:
    with ProcessPoolExecutor(int(sys.argv[1]) if len(sys.argv) > 1 else 1) as pool:
        rows = list(pool.map(find, draw_pairs(), chunksize=4))
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
