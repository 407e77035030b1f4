"""Make the table of floor medians, assess/motion/floor_table.csv: ``python docs/floor_table.py``, an hour.

Median PFA over the ground's PGA and median PFV over its PGV, by T1, structure, PGV/PGA and z/h, over `DRAWS`
earthquakes through drawn buildings. What is drawn of T1 about its median, by `SCATTER`, lies between what is drawn
where T1 is given and where it follows from the height; their medians differ by 4 % at most. No run has this seed.
"""

import csv
from collections.abc import Iterable, Sequence
from itertools import product
from pathlib import Path

import numpy as np

from assess.motion.assumed import Building, Ground, draw_places
from assess.motion.beam import find_shares, swing_modes
from assess.motion.drawn_ground import build_beam_grid, draw_ground
from assess.motion.floor_medians import COLUMNS, PERIODS, PLACES, RATIOS, STRUCTURES, TABLE
from assess.motion.noise import Phases
from assess.motion.rows import GROUP
from assess.motion.target import Grid
from assess.motion.target_fit import measure_peaks
from assess.progress import SILENT

DRAWS, SEED, SCATTER = 20_000, 2**31, 0.2

Entry = tuple[str, float | None, float]
"""Structure, T1 [s] and PGV/PGA [s]."""


def find_medians(entries: Iterable[Entry]) -> dict[Entry, np.ndarray]:
    """Return the median PFA/PGA and PFV/PGV at every z/h, (z, 2), the last of them of an unknown height."""
    by_grid: dict[Grid, list[Entry]] = {}
    for entry in entries:
        by_grid.setdefault(build_beam_grid(_build(entry).longest), []).append(entry)
    found: dict[Entry, np.ndarray] = {}
    for grid, own in by_grid.items():
        peaks = np.empty((len(own), DRAWS, len(PLACES) + 1, 2), np.float32)
        for group in range(DRAWS // GROUP):
            peaks[:, group * GROUP : (group + 1) * GROUP] = _find_peaks(own, grid, group)
        found |= dict(zip(own, np.median(peaks, axis=1), strict=True))
    return found


def _build(entry: Entry) -> Building:
    return Building(period=entry[1], scatter=SCATTER, structure=entry[0])


def _find_peaks(entries: Sequence[Entry], grid: Grid, group: int) -> np.ndarray:
    """Return PFA/PGA and PFV/PGV of a group of draws, (entries, GROUP, z, 2)."""
    first, grounds, found = group * GROUP, {}, np.empty((len(entries), GROUP, len(PLACES) + 1, 2), np.float32)
    every = [*(np.full(GROUP, place) for place in PLACES), draw_places(SEED, first, GROUP)]
    for row, entry in zip(found, entries, strict=True):
        building, ratio = _build(entry), entry[2]
        if ratio not in grounds:
            motion = Ground(pga=1.0, pgv=ratio)
            grounds[ratio] = draw_ground(motion, Phases(grid, SEED, "X"), group, SILENT)
        periods, alphas = (one(SEED, first, GROUP) for one in (building.draw_periods, building.draw_alphas))
        basis = swing_modes(grounds[ratio], grid.time_step, periods, alphas)
        for at, places in enumerate(every):
            shares = np.pad(find_shares(alphas, places), ((0, 0), (1, 0)), constant_values=1.0).astype(np.float32)
            floor = np.matmul(shares[:, None], basis)[:, 0]
            row[:, at] = measure_peaks(floor, grid.time_step) / (1.0, ratio)
    return found


def main() -> None:
    """Write the table."""
    entries = list(product(STRUCTURES, (*PERIODS, None), RATIOS))
    found = find_medians(entries)
    with Path(TABLE).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(write_row(one, found[one]) for one in entries)


def write_row(entry: Entry, medians: np.ndarray) -> list[object]:
    """Return a row of the table."""
    structure, period, ratio = entry
    values = [f"{value:.4g}" for value in (*medians[:, 0], *medians[:, 1])]
    return [structure, "" if period is None else period, f"{ratio:.6g}", *values]


if __name__ == "__main__":
    main()
