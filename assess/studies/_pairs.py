"""Two channels of one floor, held against each other: the paper finds that under integration they agree."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from assess.studies._formulas import FORMULAS, INTEGRATION
from assess.studies._judged import FIRST_TOGETHER, TOGETHER, Judged


@dataclass(frozen=True, slots=True)
class Pair:
    """Two channels of a floor, moved by one factor: how far chances of blocks are apart by method, mean [-]."""

    building: str
    level: str
    names: tuple[str, str]
    is_along: bool
    pfa: float
    apart: Mapping[str, float]


def find_pairs(judged: Sequence[Judged]) -> list[Pair]:
    """Return every two channels of a floor at each PFA of `TOGETHER`."""
    found = []
    for one, other in combinations(judged, 2):
        a, b = one.trials.channel, other.trials.channel
        if (a.building, a.level) != (b.building, b.level):
            continue
        for at, pfa in enumerate(TOGETHER, FIRST_TOGETHER):
            apart = {
                key: float(np.nanmean(np.abs(one.formulas[key][at] - other.formulas[key][at]))) for key in FORMULAS
            }
            apart[INTEGRATION] = float(np.mean(np.abs(one.trials.risk[at] - other.trials.risk[at])))
            found.append(Pair(a.building, a.level, (a.name, b.name), a.axis == b.axis, pfa, apart))
    return found
