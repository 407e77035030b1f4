"""Trials of real channels whose outcomes are made up, so that what is fitted to them or said of them is known."""

from collections.abc import Callable

import numpy as np

from assess.studies._buildings import all_buildings
from assess.studies._judged import Judged, find_levels, judge
from assess.studies._study import Options
from assess.studies._trials import Trials, build_blocks
from assess.units import GRAVITY

MANY = 10**12
"""Motions: so many that a share is as good as a chance."""


def make_judged(chance: Callable[..., np.ndarray], options: Options, runs: int = MANY) -> list[Judged]:
    """Return every channel of every building with chances ``chance(breadth, height, pfa, pfv)`` [m], [m/s2], [m/s]."""
    found = []
    for building in all_buildings():
        for channel, levels in find_levels(building).items():
            motion, (breadth, height) = channel.read(), build_blocks()
            pfa = np.array(levels) * GRAVITY
            pfv = pfa / motion.pfa * motion.pfv
            grid = chance(breadth[None], height[None], pfa[:, None], pfv[:, None])
            fallen = np.rint(np.clip(np.broadcast_to(grid, (pfa.size, breadth.size)), 0, 1) * runs).astype(np.int64)
            trials = Trials(
                channel=channel, pfa=pfa, pfv=pfv, breadth=breadth, height=height, fallen=fallen,
                fell_in_record=fallen > runs / 2, runs=runs, mean_pfa=1.0, mean_pfv=1.0,
            )  # fmt: skip
            found.append(judge(building, trials, options))
    return found
