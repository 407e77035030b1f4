"""The smallest set of pieces to anchor or move that brings a route under the chosen risk."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from assess.routes.couplings import ROUNDED, Couplings
from assess.routes.draws import Draws
from assess.routes.gaps import Key
from assess.routes.model import RouteFix
from assess.routes.network import Blocked

IsBlocked = Callable[[Blocked, int], int]
"""Tells from the draws in which segments are blocked, and from all draws, in which of them the route is."""


class Lane(Protocol):
    """A segment of a route."""

    @property
    def keys(self) -> tuple[Key, ...]:
        """The pieces that may fall onto it."""

    def blocked(self, fallen: Mapping[Key, int], every: int) -> int:
        """Return the set of the draws, of `every`, in which it is blocked where pieces fall in sets of them."""


def find_fixes(
    couplings: Couplings, lanes: Mapping[int, Lane], is_blocked: IsBlocked, risk: float
) -> tuple[list[RouteFix], bool]:
    """Return the pieces to fix, in the order in which they gain most, and whether they bring a route under `risk` [-].

    At every step the piece is taken that lowers the chance most; where pieces fall together and no single one lowers
    it, the one that would most if they fell independently. What turns out not to be needed is left out again.

    Parameters
    ----------
    couplings : Couplings
        How the pieces that reach the route fall together.
    lanes : mapping of int to Lane
        The segments of the route by their number.
    is_blocked : callable
        Tells from the draws in which they are blocked, and from all draws, in which of them the route is.
    risk : float
        The chosen risk [-].
    """
    begin = trial = _Trial.begin(couplings, lanes, is_blocked)
    if begin.chance < risk or begin.left(begin.items) >= risk:
        return [], begin.chance < risk
    fixed: list[int] = []
    while trial.chance >= risk:
        fixed.append(trial.best())
        trial = trial.fix(fixed[-1:])
    for item in tuple(fixed):
        rest = [other for other in fixed if other != item]
        if begin.left(rest) < risk:
            fixed = rest
    return list(_steps(begin, fixed)), True


def _steps(trial: "_Trial", fixed: Sequence[int]) -> Iterator[RouteFix]:
    before = trial.chance
    for count, item in enumerate(fixed, 1):
        left = trial.left(fixed[:count])
        yield RouteFix(item=item, gain=max(0.0, before - left), left=left)
        before = left


@dataclass(frozen=True, slots=True, eq=False)
class _Route:
    """The segments of a route, when it is blocked, and which of its segments each piece reaches."""

    lanes: Mapping[int, Lane]
    is_blocked: IsBlocked
    beside: Mapping[int, tuple[int, ...]]

    @classmethod
    def of(cls, lanes: Mapping[int, Lane], is_blocked: IsBlocked) -> "_Route":
        beside: dict[int, list[int]] = {}
        for at, lane in lanes.items():
            for item in {item for item, _ in lane.keys}:
                beside.setdefault(item, []).append(at)
        return cls(lanes, is_blocked, {item: tuple(own) for item, own in beside.items()})


@dataclass(frozen=True, slots=True, eq=False)
class _Sample:
    """Draws with some pieces fixed: in which of them each piece still falls, each segment and the route are blocked.

    `chance` is that of the last [-].
    """

    route: _Route
    draws: Draws
    fallen: Mapping[Key, int]
    blocked: Blocked
    happened: int
    chance: float

    @classmethod
    def of(cls, route: _Route, draws: Draws, fallen: Mapping[Key, int], blocked: Blocked) -> "_Sample":
        happened = route.is_blocked(blocked, draws.every)
        return cls(route, draws, fallen, blocked, happened, round(draws.share(happened), ROUNDED))

    @classmethod
    def begin(cls, route: _Route, draws: Draws, keys: Sequence[Key]) -> "_Sample":
        fallen = {key: draws.fallen[key] for key in keys if key[0] in route.beside}
        return cls.of(route, draws, fallen, {at: one.blocked(fallen, draws.every) for at, one in route.lanes.items()})

    def fix(self, items: Collection[int]) -> "_Sample":
        """Return it with more pieces fixed."""
        fallen = {key: falls for key, falls in self.fallen.items() if key[0] not in items}
        near = {at for item in items for at in self.route.beside[item]}
        blocked = {at: self.route.lanes[at].blocked(fallen, self.draws.every) for at in near}
        return _Sample.of(self.route, self.draws, fallen, {**self.blocked, **blocked})

    def left(self, items: Sequence[int]) -> dict[int, float]:
        """Return the chance left with each of some pieces fixed: it can open the route only where it falls."""
        opens: dict[tuple[int, ...], int] = {}
        for near in {self.route.beside[item] for item in items}:
            clear = {**self.blocked, **dict.fromkeys(near, 0)}
            opens[near] = self.happened & ~self.route.is_blocked(clear, self.draws.every)
        can = {item for (item, _), falls in self.fallen.items() if falls & opens.get(self.route.beside[item], 0)}
        return {item: self.fix((item,)).chance if item in can else self.chance for item in items}


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A route with some of its pieces fixed.

    `samples` are those that the chance of a report goes by, the joint one, or all three of which the largest counts;
    `independent` is the one in which every piece falls independently, which shows every gain.
    """

    samples: Sequence[_Sample]
    independent: _Sample

    @classmethod
    def begin(cls, couplings: Couplings, lanes: Mapping[int, Lane], is_blocked: IsBlocked) -> "_Trial":
        route = _Route.of(lanes, is_blocked)
        bounds = () if couplings.is_joint else (couplings.independent, couplings.correlated)
        made = {
            id(draws): _Sample.begin(route, draws, couplings.keys)
            for draws in (couplings.joint, couplings.independent, *bounds)
        }
        samples = {id(draws): made[id(draws)] for draws in (couplings.joint, *bounds)}
        return cls(list(samples.values()), made[id(couplings.independent)])

    @property
    def chance(self) -> float:
        """The chance that the route is blocked [-]."""
        return max(one.chance for one in self.samples)

    @property
    def items(self) -> list[int]:
        """The pieces that fall in any of the draws in which it is blocked."""
        every = (*self.samples, self.independent)
        return sorted({item for one in every for (item, _), falls in one.fallen.items() if falls & one.happened})

    def left(self, items: Collection[int]) -> float:
        """Return the chance with more pieces fixed [-]."""
        return max(one.fix(items).chance for one in self.samples)

    def fix(self, items: Collection[int]) -> "_Trial":
        """Return the trial with more pieces fixed."""
        fixed = {id(one): one.fix(items) for one in (*self.samples, self.independent)}
        return _Trial([fixed[id(one)] for one in self.samples], fixed[id(self.independent)])

    def best(self) -> int:
        """Return the piece whose fixing lowers the chance most, the largest of the three; else the independent one."""
        least = self.items
        for sample in (max(self.samples, key=lambda one: one.chance), self.independent):
            left = sample.left(least)
            lowest = min(left.values())
            least = [item for item in least if left[item] == lowest]
            if len(least) == 1:
                break
        return least[0]
