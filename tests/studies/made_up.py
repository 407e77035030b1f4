"""Trials of real channels with made-up outcomes, so that fits to them and statements on them are known."""

from collections.abc import Callable

import numpy as np

from assess.studies.agreement import Compared, evaluate_trials
from assess.studies.buildings import Trials, all_buildings, build_blocks, find_levels
from assess.studies.study import Options
from assess.units import GRAVITY

MANY = 10**12
"""Motions: so many that a share is as good as a chance."""


def make_compared(chance: Callable[..., np.ndarray], options: Options, runs: int = MANY) -> list[Compared]:
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
                fallen_uncertain=fallen // 2,
                fell_in_record=fallen > runs / 2, runs=runs, mean_pfa=1.0, mean_pfv=1.0,
            )  # fmt: skip
            found.append(evaluate_trials(building, trials, options))
    return found
