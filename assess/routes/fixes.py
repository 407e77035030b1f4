"""The smallest set of pieces to anchor or move that brings a route under the chosen risk."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from assess.methods._method import BoolArray
from assess.routes.couplings import ROUNDED, Couplings, Draws
from assess.routes.gaps import Key
from assess.routes.model import RouteFix

Blocked = Callable[[BoolArray], BoolArray]
"""Tells for each of m draws (m, n) of which pieces fell whether the route is blocked (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A route with some of its pieces fixed: draws in which it is blocked with nothing fixed, and what tells more."""

    keys: tuple[Key, ...]
    draws: Sequence[Draws]
    independent: Draws
    is_blocked: Blocked

    def chance(self, fixed: frozenset[int]) -> float:
        """Return the chance that a report goes by: the joint one, or the largest of the three [-]."""
        return max(self._share(one, fixed) for one in self.draws)

    def score(self, fixed: frozenset[int]) -> tuple[float, float]:
        """Return that chance, and the one where every piece falls independently, which shows every gain."""
        return self.chance(fixed), self._share(self.independent, fixed)

    def _share(self, draws: Draws, fixed: frozenset[int]) -> float:
        free = np.array([item not in fixed for item, _ in self.keys], dtype=np.bool_)
        return round(float(draws.weight @ self.is_blocked(draws.fell & free)), ROUNDED) if len(draws.weight) else 0.0


def find_fixes(couplings: Couplings, is_blocked: Blocked, risk: float) -> tuple[list[RouteFix], bool]:
    """Return the pieces to fix, in the order in which they gain most, and whether they bring a route under `risk` [-].

    At every step the piece is taken that lowers the chance most; where pieces fall together and no single one lowers
    it, the one that would most if they fell independently. What turns out not to be needed is left out again.
    """
    ways = (couplings.joint,) if couplings.is_joint else (couplings.joint, couplings.independent, couplings.correlated)
    kept = [_keep(one, is_blocked) for one in (*ways, couplings.independent)]
    trial = _Trial(couplings.keys, kept[:-1], kept[-1], is_blocked)
    open_items = {item for item, _ in couplings.keys}
    if trial.chance(frozenset()) < risk or trial.chance(frozenset(open_items)) >= risk:
        return [], trial.chance(frozenset()) < risk
    fixed: list[int] = []
    while trial.chance(frozenset(fixed)) >= risk:
        left = sorted(open_items.difference(fixed))
        fixed.append(min(left, key=lambda item: (trial.score(frozenset((*fixed, item))), item)))
    for item in tuple(fixed):
        if trial.chance(frozenset(fixed) - {item}) < risk:
            fixed.remove(item)
    return list(_steps(trial, fixed)), True


def _steps(trial: _Trial, fixed: Sequence[int]) -> list[RouteFix]:
    left = [trial.chance(frozenset(fixed[:count])) for count in range(len(fixed) + 1)]
    pairs = zip(fixed, left, left[1:], strict=False)
    return [RouteFix(item=item, gain=max(0.0, before - after), left=after) for item, before, after in pairs]


def _keep(draws: Draws, is_blocked: Blocked) -> Draws:
    """Keep the draws in which a route is blocked, each pattern once: fixing more can only open it."""
    at = np.flatnonzero(is_blocked(draws.fell))
    fell, weight = draws.fell[at], draws.weight[at]
    if not len(at):
        return Draws(fell, weight)
    distinct, back = np.unique(fell, axis=0, return_inverse=True)
    return Draws(distinct, np.bincount(back.ravel(), weights=weight).astype(np.float64))
