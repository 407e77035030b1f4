"""The smallest set of pieces to anchor or move that brings a route under the chosen risk, its interval included.

Pieces whose chance is not confirmed are taken as fallen in it, which is on the safe side.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise

from assess.progress import SILENT, Progress
from assess.routes.chances import EVERY, NONE, Couplings, Draws, Key, find_upper
from assess.routes.network import Blocked
from assess.routes.obstructions import Obstructions

IsBlocked = Callable[[Blocked, int], int]
"""Returns the set of the draws in which the route is blocked, from those in which segments are, and all draws."""
Fixed = frozenset[int]
"""Pieces that are fixed, by their index in the inventory."""


def find_fixes(
    couplings: Couplings,
    lanes: Mapping[int, Obstructions],
    is_blocked: IsBlocked,
    risk: float,
    z: float = 0.0,
    progress: Progress = SILENT,
) -> tuple[list[tuple[int, float, float]], bool]:
    """Return the pieces to fix, in order of their gain, and whether a route can be brought under `risk` [-].

    Each comes with its gain and the chance left [-]. At every step the piece is taken that lowers the chance most;
    where pieces fall together and no single one lowers it, the one that would most if they fell independently. The
    upper end of the chance is to be under `risk`, or no draw left in which the route is blocked. What turns out not to
    be needed is left out again.

    `couplings`: how the pieces that reach the route fall together. `lanes`: the segments of the route by their number.
    `z`: half width of intervals [-].
    """
    trial = _Trial(couplings, lanes, is_blocked, z, progress)
    if trial.chance(Fixed(trial.involved(Fixed()))) >= risk:
        return [], False
    fixed: list[int] = []
    while trial.upper(Fixed(fixed)) >= risk and trial.involved(Fixed(fixed)):
        fixed.append(trial.best(Fixed(fixed)))
    goal = trial.upper(Fixed(fixed))  # at the risk or above where there are too few draws to show less
    for item in tuple(fixed):
        rest = [other for other in fixed if other != item]
        upper = trial.upper(Fixed(rest))
        if upper < risk or upper <= goal:
            fixed = rest
    left = [trial.chance(Fixed(fixed[:count])) for count in range(len(fixed) + 1)]
    return [
        (item, max(0.0, before - now), now) for item, (before, now) in zip(fixed, pairwise(left), strict=True)
    ], True


class _Trial:
    """A route with some of its pieces fixed: its chances by each way of falling together that counts.

    `decisive` are those whose largest chance is reported; `independent` shows every gain, `ends` what is certain.
    """

    def __init__(
        self,
        couplings: Couplings,
        lanes: Mapping[int, Obstructions],
        is_blocked: IsBlocked,
        z: float,
        progress: Progress,
    ) -> None:
        samples = {
            id(draws): _Sample(draws, couplings.keys, lanes, is_blocked, progress)
            for draws in (*couplings.decisive, couplings.independent)
        }
        self.couplings, self.z = couplings, z
        self.items = frozenset(item for item, _ in couplings.keys)
        self.ends = _Sample(couplings.ends, couplings.keys, lanes, is_blocked, progress)
        self.every = list(samples.values())
        self.decisive = [samples[key] for key in dict.fromkeys(id(draws) for draws in couplings.decisive)]
        self.independent = samples[id(couplings.independent)]

    def chance(self, fixed: Fixed) -> float:
        """Return the chance that the route is blocked [-]."""
        return max(one.chance(fixed) for one in self.decisive)

    def upper(self, fixed: Fixed) -> float:
        """Return the upper end of its interval [-]; what is certain has none."""
        chance, end = self.chance(fixed), self.ends.happened(fixed)
        if end & NONE or not end & EVERY:
            return chance
        return find_upper(self.couplings, chance, self.items - fixed, self.z)

    def involved(self, fixed: Fixed) -> list[int]:
        return sorted({item for one in self.every for item in one.falling(one.happened(fixed), fixed)})

    def best(self, fixed: Fixed) -> int:
        """Return the piece whose fixing lowers the largest chance most; among equals, the independent one."""
        least = self.involved(fixed)
        for sample in (max(self.decisive, key=lambda one: one.chance(fixed)), self.independent):
            left = sample.chances_left(least, fixed)
            lowest = min(left.values())
            least = [item for item in least if left[item] == lowest]
            if len(least) == 1:
                break
        return least[0]


class _Sample:
    """Draws of which pieces fall, and when the route is blocked in them with some pieces fixed; results are kept."""

    def __init__(
        self,
        draws: Draws,
        keys: Iterable[Key],
        lanes: Mapping[int, Obstructions],
        is_blocked: IsBlocked,
        progress: Progress,
    ) -> None:
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
