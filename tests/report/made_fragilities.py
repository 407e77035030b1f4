"""Fragilities of a small building, and curves of any shape in place of those found."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import assess
from assess.fragility import fit_fragility
from assess.pipeline.adopt import Assessment
from assess.pipeline.piece_fragility import UNITS, By, Measure, PieceFragilities, find_piece_fragilities
from assess.pipeline.run import compute

FLOORS: list[dict[str, Any]] = [
    {"floor": "1", "PFA X [g]": 0.3, "PFA Y [g]": 0.2, "PFV X [cm/s]": 40, "PFV Y [cm/s]": 30},
    {"floor": "2", "PFA X [g]": 0.5, "PFV X [cm/s]": 60},
]
SHAPE = {"Width [cm]": 80, "Height [cm]": 180}
ITEMS: list[dict[str, Any]] = [
    {"item": "a1", "floor": "1", "Breadth [cm]": 40, "type": "Shelf", "quantity": 2, **SHAPE},
    {"item": "a2", "floor": "2", "Breadth [cm]": 30, "type": "Shelf", "axis": "X", **SHAPE},
    {"item": "b", "floor": "1", "Breadth [cm]": 60, "axis": "X", **SHAPE},
]
GROUND = {"Ground PGA [g]": 0.25, "Height [m]": 9}
LEVELS = [round(0.12 * 1.25**at, 3) for at in range(14)]
"""[g], or in m/s against PFV."""


BARE: list[dict[str, Any]] = [{"floor": "1", "Elevation [m]": 3}, {"floor": "2", "Elevation [m]": 6}]
"""Floors without motions of their own."""


def assess_small(
    building: dict[str, Any] = GROUND,
    by: By = "type",
    im: Measure = "pfa",
    floors: list[dict[str, Any]] = FLOORS,
    **settings: Any,
) -> tuple[Assessment, PieceFragilities]:
    """Return an assessment and its fragilities at `LEVELS`, by 60 draws."""
    inventory = assess.read_inventory(
        {"Building": [building], "Floors": floors, "Items": ITEMS, "Catalogue": [{"type": "Shelf"}]}
    )
    inventory = replace(inventory, source=Path("small office.xlsx"))
    assessment = compute(inventory, assess.Settings(verify="none", runs=60, seed=3, **settings))
    levels = [one * UNITS[im] * (1 if im == "pfa" else 100) for one in LEVELS]
    found = find_piece_fragilities(assessment, by=by, im=im, levels=levels)
    return assessment, found


def shape_curves(found: PieceFragilities, *named: tuple[str, Sequence[float]]) -> PieceFragilities:
    """Return fragilities with a curve for each name and its shares of 100 draws at 0.1, 0.2, 0.4, ... g."""
    one, curves = found.curves[0], []
    for name, shares in named:
        levels = [0.1 * 2**at * UNITS[found.im] for at in range(len(shares))]
        curve = fit_fragility(levels, [100 * share for share in shares], [100] * len(shares))
        curves.append(replace(one, name=name, curve=curve))
    return replace(found, curves=tuple(curves))


RISING = (0.0, 0.16, 0.5, 0.84, 1.0)
"""Near a lognormal of median 0.4 g and beta 0.7."""
STEEP = (0.0, 0.01, 0.5, 0.99, 1.0)
"""Near a lognormal of median 0.4 g and beta 0.3."""
UNEVEN = (0.0, 0.4, 0.4, 0.3, 1.0)
"""Which no lognormal is near to."""
