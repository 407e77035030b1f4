"""How much more a floor moves than the ground: median PFA/PGA and PFV/PGV, in one table.

The table holds what `assess.motion.beam` gives over thousands of earthquakes of `assess.motion.drawn_ground`: by T1, by
structure, by PGV/PGA and by z/h, made once by docs/floor_table.py. So formulas, the workbook and every print take one
number for a floor, whatever the seed; the draws of a run are brought to it. Between its entries numbers are straight in
ln T1, in ln PGV/PGA and in z/h; beyond them the nearest entry holds. On the ground both are 1.
"""

import csv
from functools import lru_cache
from pathlib import Path

import numpy as np

from assess.arrays import FloatArray
from assess.units import GRAVITY

TABLE = Path(__file__).with_name("floor_table.csv")

STRUCTURES = ("unknown", "frame", "walls", "dual")
"""Structures of the table; the others are as one of these."""
ALIKE = {"timber": "frame", "masonry": "dual"}
"""Structures that have the alpha of another."""
PERIODS = (0.06, 0.1, 0.16, 0.25, 0.4, 0.63, 1.0, 1.6, 2.5, 4.0, 6.5)
"""T1 [s]; the table has one more entry, for a building of which nothing is known."""
RATIOS = tuple(one / 100 / GRAVITY for one in (12.0, 30.0, 60.0, 105.0, 190.0, 400.0))
"""PGV/PGA [s]; in cm/s per g 12 to 400."""
PLACES = (0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0)
"""z/h [-]; the table has one more entry, for a floor of which the height is not known."""
COLUMNS = (
    "structure", "T1 [s]", "PGV/PGA [s]", *(f"PFA/PGA at {place}" for place in PLACES), "PFA/PGA unknown",
    *(f"PFV/PGV at {place}" for place in PLACES), "PFV/PGV unknown",
)  # fmt: skip
SCATTER = 0.35
"""Standard deviation of ln PFA over the draws of a floor above the ground [-]: the largest of the table's, which begin
at 0.07; that of a building of which nothing is known is taken for as much."""


@lru_cache(maxsize=1)
def read_table() -> dict[str, FloatArray]:
    """Return by structure PFA/PGA and PFV/PGV, (T1 and unknown, PGV/PGA, z/h and unknown, 2) [-]."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))[1:]
    found = {}
    for structure in STRUCTURES:
        values = np.array([row[3:] for row in rows if row[0] == structure], dtype=np.float64)
        found[structure] = np.moveaxis(values.reshape(len(PERIODS) + 1, len(RATIOS), 2, len(PLACES) + 1), 2, 3)
    return found


def find_medians(period: float | None, place: float | None, structure: str, ratio: float) -> tuple[float, float]:
    """Return median PFA/PGA and PFV/PGV of a floor [-].

    * `period`: T1 [s]; None where nothing is known of the building.
    * `place`: z/h [-]; None where it is not known.
    * `structure`: key of `assess.motion.beam.STIFFNESS`.
    * `ratio`: PGV/PGA of the ground [s].
    """
    if place is not None and place <= 0:
        return 1.0, 1.0
    table = read_table()[ALIKE.get(structure, structure)]
    by_period = table[-1] if period is None else _between(period, PERIODS, table)
    by_place = _between(ratio, RATIOS, by_period)
    if place is None:
        found = by_place[-1]
    else:
        nodes = np.vstack([np.ones(2), by_place[:-1]])
        found = np.array([np.interp(place, (0.0, *PLACES), column) for column in nodes.T])
    return float(found[0]), float(found[1])


def _between(value: float, nodes: tuple[float, ...], table: FloatArray) -> FloatArray:
    """Return the entries of a table at a value, straight in logarithms between its nodes."""
    at = float(np.interp(np.log(value), np.log(nodes), np.arange(len(nodes))))
    low = min(int(at), len(nodes) - 2)
    return np.asarray(table[low] + (at - low) * (table[low + 1] - table[low]))


def is_within(period: float | None, ratio: float) -> bool:
    """Return whether T1 [s] and PGV/PGA [s] lie within the table."""
    return (period is None or PERIODS[0] <= period <= PERIODS[-1]) and RATIOS[0] <= ratio <= RATIOS[-1]
