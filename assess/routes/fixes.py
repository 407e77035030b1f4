"""The smallest set of pieces to anchor or move that brings a route under the chosen risk."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray
from assess.routes.couplings import ROUNDED, Couplings, Draws
from assess.routes.gaps import Key, find_distinct
from assess.routes.model import RouteFix

Blocked = Callable[[Draws], BoolArray]
"""Tells for each of m draws whether the route is blocked (m,)."""
NOTHING: Mapping[int, Set[int]] = {}


def find_fixes(
    couplings: Couplings, is_blocked: Blocked, risk: float, reaching: Mapping[int, Set[int]] = NOTHING
) -> tuple[list[RouteFix], bool]:
    """Return the pieces to fix, in the order in which they gain most, and whether they bring a route under `risk` [-].

    At every step the piece is taken that lowers the chance most; where pieces fall together and no single one lowers
    it, the one that would most if they fell independently. What turns out not to be needed is left out again.

    Parameters
    ----------
    couplings : Couplings
        How the pieces that reach the route fall together.
    is_blocked : callable
        Tells from draws whether the route is blocked.
    risk : float
        The chosen risk [-].
    reaching : mapping of int to set of int
        The pieces that reach each of the segments that `is_blocked` looks at, by the segments' numbers.
    """
    begin = trial = _Trial.begin(couplings, is_blocked, reaching)
    if begin.chance < risk or not begin.is_mended(begin.items, risk):
        return [], begin.chance < risk
    fixed: list[int] = []
    while trial.chance >= risk:
        fixed.append(trial.best())
        trial = trial.fix(fixed[-1])
    for item in tuple(fixed):
        rest = [other for other in fixed if other != item]
        if begin.is_mended(rest, risk):
            fixed = rest
    return list(_steps(begin, fixed)), True


def _steps(trial: "_Trial", fixed: Sequence[int]) -> Iterator[RouteFix]:
    before = trial.chance
    for count, item in enumerate(fixed, 1):
        left = trial.left(fixed[:count])
        yield RouteFix(item=item, gain=max(0.0, before - left), left=left)
        before = left


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A route with some of its pieces fixed, and the draws in which it is blocked all the same.

    `draws` are those that the chance of a report goes by, the joint ones, or all three of which the largest counts;
    `independent` those in which every piece falls independently, which show every gain.
    """

    draws: Sequence[Draws]
    independent: Draws
    is_blocked: Blocked
    reaching: Mapping[int, Set[int]]

    @classmethod
    def begin(cls, couplings: Couplings, is_blocked: Blocked, reaching: Mapping[int, Set[int]]) -> "_Trial":
        every = (couplings.joint, couplings.independent, couplings.correlated)
        ways = (couplings.joint,) if couplings.is_joint else tuple({id(one): one for one in every}.values())
        kept = {
            id(one): _keep(_narrow(one, couplings.keys, reaching), is_blocked) for one in (*ways, couplings.independent)
        }
        return cls([kept[id(one)] for one in ways], kept[id(couplings.independent)], is_blocked, reaching)

    @property
    def chance(self) -> float:
        """The chance that the route is blocked [-]."""
        return max(_round(one.weight.sum()) for one in self.draws)

    @property
    def items(self) -> list[int]:
        """The pieces that fall in any of the draws."""
        there = np.any([one.fell.any(axis=0) for one in (*self.draws, self.independent)], axis=0)
        return sorted({item for (item, _), one in zip(self.independent.keys, there, strict=True) if one})

    def left(self, items: Collection[int]) -> float:
        """Return the chance with more pieces fixed [-]."""
        return max(self._with(one, items) for one in self.draws)

    def is_mended(self, items: Collection[int], risk: float) -> bool:
        """Tell whether more pieces fixed bring the chance under a risk [-]."""
        return all(self._with(one, items) < risk for one in self.draws)

    def fix(self, *items: int) -> "_Trial":
        """Return the trial with more pieces fixed."""
        every = (*self.draws, self.independent)
        of = {id(one): _keep(self._without(one, items), self.is_blocked) for one in every}
        return replace(self, draws=[of[id(one)] for one in self.draws], independent=of[id(self.independent)])

    def best(self) -> int:
        """Return the piece whose fixing lowers the chance most, the largest of the three; else the independent one."""
        least = self.items
        for draws in (max(self.draws, key=lambda one: float(one.weight.sum())), self.independent):
            scores = self._scores(draws, least)
            lowest = min(scores.values())
            least = [item for item, score in scores.items() if score == lowest]
            if len(least) == 1:
                break
        return least[0]

    def _scores(self, draws: Draws, items: Sequence[int]) -> dict[int, float]:
        """Return the chance left with each of some pieces fixed."""
        beside = {item: frozenset(at for at, own in self.reaching.items() if item in own) for item in items}
        can_open = {segments: self._can_open(draws, segments) for segments in set(beside.values())}
        return {item: self._left(draws, item, can_open[beside[item]]) for item in items}

    def _can_open(self, draws: Draws, segments: Set[int]) -> BoolArray:
        """Tell in which draws the route would be open were nothing at all on some segments."""
        if not segments:
            return np.ones(len(draws.weight), dtype=np.bool_)  # which those are is not known
        free = dict.fromkeys(segments, np.full(len(draws.weight), np.inf))
        return ~self.is_blocked(Draws(draws.keys, draws.fell, draws.weight, draws.widths | free))

    def _with(self, draws: Draws, items: Collection[int]) -> float:
        return _round(float(draws.weight @ self.is_blocked(self._without(draws, items)))) if len(draws.weight) else 0.0

    def _left(self, draws: Draws, item: int, can_open: BoolArray) -> float:
        """Return the chance left with one more piece fixed: it can open the route only where it falls."""
        own = [at for at, key in enumerate(draws.keys) if key[0] == item]
        at = np.flatnonzero(draws.fell[:, own].any(axis=1) & can_open)
        if not len(at):
            return _round(draws.weight.sum())
        opened = ~self.is_blocked(self._without(_pick(draws, at), (item,)))
        return _round(draws.weight.sum() - draws.weight[at][opened].sum())

    def _without(self, draws: Draws, items: Collection[int]) -> Draws:
        """Return draws in which some pieces stand; the widths of segments that they do not reach stay known."""
        free = np.array([item not in items for item, _ in draws.keys], dtype=np.bool_)
        known = {at: width for at, width in draws.widths.items() if self.reaching[at].isdisjoint(items)}
        return Draws(draws.keys, draws.fell & free, draws.weight, known)


def _keep(draws: Draws, is_blocked: Blocked) -> Draws:
    """Keep the draws in which a route is blocked, each pattern once: fixing more can only open it."""
    kept = _pick(draws, np.flatnonzero(is_blocked(draws)) if len(draws.weight) else np.zeros(0, dtype=np.intp))
    first, back = find_distinct(kept.fell)
    weight = np.bincount(back, weights=kept.weight, minlength=len(first)).astype(np.float64)
    return replace(_pick(kept, first), weight=weight)


def _pick(draws: Draws, at: NDArray[np.intp]) -> Draws:
    """Return some of the draws."""
    return Draws(draws.keys, draws.fell[at], draws.weight[at], {one: wide[at] for one, wide in draws.widths.items()})


def _narrow(draws: Draws, keys: tuple[Key, ...], segments: Collection[int]) -> Draws:
    """Return the draws of some pieces and segments only."""
    fell = draws.fell[:, [draws.place[key] for key in keys]]
    return Draws(keys, fell, draws.weight, {at: width for at, width in draws.widths.items() if at in segments})


def _round(chance: float) -> float:
    return round(float(chance), ROUNDED)
