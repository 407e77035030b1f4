"""The smallest set of pieces to anchor or move that brings a route under the chosen risk, its interval included.

Pieces whose chance is not confirmed are taken as fallen in it, which is on the safe side.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import pairwise

from assess.progress import SILENT, Progress
from assess.risk import wilson_interval
from assess.routes.chances import DRAWS, EVERY, NONE, Couplings, Draws, Key
from assess.routes.network import IsBlocked
from assess.routes.obstructions import Obstructions

Fixed = frozenset[int]
"""Pieces that are fixed, by their index in the inventory."""


def find_fixes(
    couplings: Couplings, lanes: Mapping[int, Obstructions], is_blocked: IsBlocked, risk: float, z: float = 0.0,
    progress: Progress = SILENT,
) -> tuple[list[tuple[int, float, float]], bool]:  # fmt: skip
    """Return the pieces to fix, in order of their gain, and whether a route can be brought under `risk` [-].

    Each comes with its gain and the chance left [-]. At every step the piece is taken that lowers the chance most;
    where pieces fall together and no single one lowers it, the one that would most if they fell independently. The
    upper end of the chance is to be under `risk`, or no draw left in which the route is blocked. What turns out not to
    be needed is left out again.

    `couplings`: how the pieces that reach the route fall together. `lanes`: the segments of the route by their number.
    `z`: half width of intervals [-].
    """

    def sample(draws: Draws) -> _Sample:
        return _Sample(draws, couplings.keys, lanes, is_blocked, progress)

    every = {id(draws): sample(draws) for draws in (*couplings.decisive, couplings.independent)}
    decisive, independent = [every[id(draws)] for draws in couplings.decisive], every[id(couplings.independent)]
    ends = sample(couplings.ends)

    def chance(fixed: Collection[int]) -> float:
        """Return the chance that the route is blocked [-]."""
        return max(one.chance(Fixed(fixed)) for one in decisive)

    def upper(fixed: Collection[int]) -> float:
        """Return the upper end of its interval [-]; what is certain has none."""
        value, end = chance(fixed), ends.happened(Fixed(fixed))
        counts = [runs for item, runs in couplings.sizes.items() if item not in fixed]
        runs = min([*counts, *([DRAWS] if couplings.is_drawn else [])], default=0)  # of the pieces that are left
        if end & NONE or not end & EVERY or not runs:
            return value
        return max(value, float(wilson_interval(value * runs, runs, z)[1]))

    def involved(fixed: Collection[int]) -> list[int]:
        own = Fixed(fixed)
        return sorted({item for one in every.values() for item in one.falling(one.happened(own), own)})

    if chance(involved(())) >= risk:
        return [], False
    fixed: list[int] = []
    while upper(fixed) >= risk and (best := involved(fixed)):
        for one in (max(decisive, key=lambda one: one.chance(Fixed(fixed))), independent):
            left = one.chances_left(best, Fixed(fixed))
            least = min(left.values())
            best = [item for item in best if left[item] == least]
            if len(best) == 1:
                break
        fixed.append(best[0])
    goal = upper(fixed)  # at the risk or above where there are too few draws to show less
    for item in tuple(fixed):
        rest = [other for other in fixed if other != item]
        if (now := upper(rest)) < risk or now <= goal:
            fixed = rest
    chances = [chance(fixed[:count]) for count in range(len(fixed) + 1)]
    steps = zip(fixed, pairwise(chances), strict=True)
    return [(item, max(0.0, before - after), after) for item, (before, after) in steps], True


class _Sample:
    """Draws of which pieces fall, and when the route is blocked in them with some pieces fixed; results are kept."""

    def __init__(
        self, draws: Draws, keys: Iterable[Key], lanes: Mapping[int, Obstructions], is_blocked: IsBlocked,
        progress: Progress,
    ) -> None:  # fmt: skip
        self._draws, self._lanes, self._is_blocked, self._progress = draws, lanes, is_blocked, progress
        self._reach = {at: frozenset(item for item, _ in lane.keys) for at, lane in lanes.items()}
        reaching = frozenset[int]().union(*self._reach.values())
        self._fallen = {key: draws.fallen[key] for key in keys if key[0] in reaching}
        self._blocked: dict[tuple[int, Fixed], int] = {}
        self._happened: dict[Fixed, int] = {}

    def blocked(self, fixed: Fixed) -> dict[int, int]:
        found = {}
        for at, reach in self._reach.items():
            own = fixed & reach
            if (at, own) not in self._blocked:
                self._progress.check()
                fallen = {key: falls for key, falls in self._fallen.items() if key[0] not in own}
                self._blocked[at, own] = self._lanes[at].blocked(fallen, self._draws.every)
            found[at] = self._blocked[at, own]
        return found

    def happened(self, fixed: Fixed) -> int:
        if fixed not in self._happened:
            self._happened[fixed] = self._is_blocked(self.blocked(fixed), self._draws.every)
        return self._happened[fixed]

    def chance(self, fixed: Fixed) -> float:
        """Return the chance that the route is blocked [-]."""
        return self._draws.share(self.happened(fixed))

    def falling(self, draws: int, fixed: Fixed) -> set[int]:
        return {item for (item, _), falls in self._fallen.items() if item not in fixed and falls & draws}

    def chances_left(self, items: Sequence[int], fixed: Fixed) -> dict[int, float]:
        """Return the chance left with each of some pieces fixed: it can open the route only where it falls."""
        near = {item: tuple(at for at, reach in self._reach.items() if item in reach) for item in items}
        blocked, happened = self.blocked(fixed), self.happened(fixed)
        opens = {
            own: happened & ~self._is_blocked({**blocked, **dict.fromkeys(own, 0)}, self._draws.every)
            for own in set(near.values())
        }
        helping = {own: self.falling(draws, fixed) for own, draws in opens.items()}
        return {
            item: self.chance(fixed | {item}) if item in helping[own] else self.chance(fixed)
            for item, own in near.items()
        }
