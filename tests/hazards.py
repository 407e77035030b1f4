"""Hazard curves for tests: a power law, as files that a workbook can name."""

from pathlib import Path

import numpy as np

from assess.hazard import HazardCurve, parse_hazard, read_bytes

K, K_0 = 2.5, 2.13038e-4
"""Exponent, and annual rate at 1 g [1/year]: once in 475 years above 0.4 g."""


def write_hazard(
    folder: Path, first: float = 0.01, last: float = 3.0, points: int = 20, name: str = "hazard.csv"
) -> Path:
    """Write the curve from a first to a last PGA [g]."""
    path = folder / name
    rows = (f"{pga!r},{K_0 * pga**-K!r}\n" for pga in np.geomspace(first, last, points).tolist())
    path.write_text("pga_g,annual_rate\n" + "".join(rows), encoding="utf-8")
    return path


def read_hazard(path: Path, **place: float) -> HazardCurve:
    """Read the curve of a file."""
    return parse_hazard(read_bytes(path), path.name, **place)
