"""Short records for the tests of the verification, made up; a generator of ten seconds takes half a second."""

from pathlib import Path

import numpy as np

from assess.arrays import FloatArray

STEP = 0.01
TIMES = np.arange(0, 10, STEP)
FADING = np.exp(-(((TIMES - 4) / 2) ** 2))
RECORDS = {
    "fast": 0.3 * np.sin(2 * np.pi * 8 * TIMES) * FADING,
    "slow": 0.19 * np.sin(2 * np.pi * TIMES) * FADING,
    "still": 0.05 * np.sin(2 * np.pi * 2 * TIMES) * FADING,
    "pulse": 0.3 * np.sin(2 * np.pi * (TIMES - 4) / 1.2) * ((TIMES > 4) & (TIMES < 5.2))
    + 0.01 * np.random.default_rng(0).standard_normal(TIMES.size) * FADING,
}
"""[g]: a peak too short to overturn much; one that is long; one under which nothing rocks; one strong long pulse."""


def write_record(path: Path, acceleration: FloatArray, step: float = STEP) -> Path:
    """Write a record [g] as a plain table."""
    lines = [f"{at * step:.4f},{value:.6f}" for at, value in enumerate(acceleration)]
    path.write_text("\n".join(["time [s],x [g]", *lines]) + "\n", encoding="utf-8")
    return path


def write_records(folder: Path, *names: str) -> None:
    """Write some of `RECORDS`, all where none are named, as ``fast.csv`` and so on."""
    for name in names or tuple(RECORDS):
        write_record(folder / f"{name}.csv", RECORDS[name])
