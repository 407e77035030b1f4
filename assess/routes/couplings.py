"""What falls together: as the motions say, independently of each other, or as closely tied as can be."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, FloatArray
from assess.risk import wilson_interval
from assess.routes.draws import Draws
from assess.routes.falls import Falls
from assess.routes.gaps import Key
from assess.routes.model import Chance

EXACT = 4096
"""Outcomes of all pieces together up to which every one is gone through; above, they are drawn."""
DRAWS = 2000
"""Draws where they are more: the 95 % interval of a chance of 0.5 is then 0.5 +- 0.022."""

MOST_PATTERNS = 20_000
"""Motions up to which pieces of different numbers of motions are made to meet evenly."""
ROUNDED = 12
"""Decimals that chances keep: sums of weights leave a hair."""
NONE, EVERY = 0b01, 0b10
"""The two draws of `Couplings.ends`: nothing falls, and everything does."""


Happens = Callable[[Draws], Sequence[int]]
"""Tells for some draws in which of them each of several things happens, as sets of `assess.routes.bits`."""


@dataclass(frozen=True, slots=True, eq=False)
class Couplings:
    """The same pieces falling together in three ways.

    The draws may be of more pieces than `keys`: nothing may be asked of them that depends on another. `ends` are the
    draws `NONE` and `EVERY`. `runs` is the least number of motions of a verified piece, 0 without one; `is_drawn` tells
    whether any of the three was drawn rather than gone through. `pieces` and `unverified` count pieces, not rows.
    """

    keys: tuple[Key, ...]
    joint: Draws
    independent: Draws
    correlated: Draws
    ends: Draws
    is_joint: bool
    runs: int
    is_drawn: bool
    pieces: int
    unverified: int


def build_couplings(
    falls: Falls, keys: Sequence[Key], seed: int, of_all: "Callable[[], Couplings] | None" = None
) -> Couplings:
    """Return how the pieces of `keys` fall together; draws depend on `seed` and on the piece alone.

    `of_all` gives those of more pieces, if wanted: what has been worked out for them is shared, wherever not every
    outcome of `keys` alone is gone through.
    """
    keys, whole = tuple(keys), of_all() if of_all else None
    columns: dict[int, list[int]] = {}
    for at, (item, _number) in enumerate(keys):
        columns.setdefault(item, []).append(at)
    groups = sorted({int(falls.group[item]) for item in columns} - {-1})
    alone = [item for item in columns if falls.group[item] < 0]
    singles = {item: _Single(falls, item, own) for item, own in columns.items()}
    members = {one: {item: own for item, own in columns.items() if falls.group[item] == one} for one in groups}
    mixed: list[_Unit] = [
        *(_Group(falls, one, own) for one, own in members.items()),
        *(singles[item] for item in alone),
    ]
    lone = list(singles.values())
    independent = whole.independent if whole and _is_drawn(lone) else _combine(lone, keys, seed)
    joint = whole.joint if whole and _is_drawn(mixed) else _combine(mixed, keys, seed) if groups else independent
    rows = list(columns)
    return Couplings(
        keys=keys,
        joint=joint,
        independent=independent,
        correlated=whole.correlated if whole else _correlate(falls, keys),
        ends=whole.ends if whole else _ends(keys),
        is_joint=not alone and len(groups) <= 1,
        runs=min((falls.fell[item].size for own in members.values() for item in own), default=0),
        is_drawn=bool(alone or len(groups) > 1) and (_is_drawn(mixed) or _is_drawn(lone)),
        pieces=int(falls.quantity[rows].sum()),
        unverified=int(falls.quantity[alone].sum()),
    )


class _Unit(Protocol):
    """Pieces that fall together in a known way.

    `key` tells it apart in draws: the row and 0, or the group and 1. `count` is the number of its patterns; `patterns`
    returns the columns of its pieces (c,), which of those fall (count, c), and the weights (count,).
    """

    @property
    def key(self) -> tuple[int, int]: ...
    @property
    def count(self) -> int: ...
    def patterns(self) -> tuple[list[int], BoolArray, FloatArray]: ...


@dataclass(frozen=True, slots=True, eq=False)
class _Group:
    """Verified pieces of one group, of which `columns` tells the columns.

    A piece that was decided after fewer motions than another repeats its own, so that its chance stays what it is.
    """

    falls: Falls
    group: int
    columns: Mapping[int, list[int]]

    @property
    def key(self) -> tuple[int, int]:
        return self.group, 1

    @property
    def count(self) -> int:
        sizes = {self.falls.fell[item].size for item in self.columns}
        runs = math.lcm(*sizes)
        return runs if runs <= MOST_PATTERNS else max(sizes)

    def patterns(self) -> tuple[list[int], BoolArray, FloatArray]:
        """Return what falls motion by motion."""
        runs, fell = self.count, self.falls.fell
        every = [at for own in self.columns.values() for at in own]
        found = np.column_stack([np.resize(fell[item], runs) for item, own in self.columns.items() for _ in own])
        return every, found, np.full(runs, 1.0 / runs)


@dataclass(frozen=True, slots=True, eq=False)
class _Single:
    """The pieces of one row, which fall independently of each other: none, one, or two or more of them."""

    falls: Falls
    item: int
    columns: list[int]

    @property
    def key(self) -> tuple[int, int]:
        return self.item, 0

    @property
    def count(self) -> int:
        return 1 + len(self.columns)

    def patterns(self) -> tuple[list[int], BoolArray, FloatArray]:
        """Return none of them, one of them, two or more."""
        p, q = float(self.falls.probability[self.item]), int(self.falls.quantity[self.item])
        none = (1 - p) ** q
        if len(self.columns) == 1:
            return self.columns, np.array([[False], [True]]), np.array([none, 1 - none])
        one = q * p * (1 - p) ** (q - 1)
        fell = np.array([[False, False], [True, False], [True, True]])
        return self.columns, fell, np.array([none, one, max(0.0, 1 - none - one)])


def _is_drawn(units: Sequence[_Unit]) -> bool:
    return len(units) > 1 and math.prod(unit.count for unit in units) > EXACT


def _combine(units: Sequence[_Unit], keys: tuple[Key, ...], seed: int) -> Draws:
    """Combine units that fall independently: every combination where they are few, else `DRAWS` of them."""
    if not units:
        return Draws.of(keys, np.zeros((1, 0), dtype=np.bool_), np.ones(1))
    is_drawn, every = _is_drawn(units), [unit.patterns() for unit in units]
    if is_drawn:
        at = np.array([_draw(unit.key, one[2], seed) for unit, one in zip(units, every, strict=True)])
        weight = np.full(DRAWS, 1.0 / DRAWS)
    else:
        at = np.indices([unit.count for unit in units]).reshape(len(units), -1)
        weight = np.prod([own[chosen] for (_, _, own), chosen in zip(every, at, strict=True)], axis=0)
    fell = np.zeros((len(weight), len(keys)), dtype=np.bool_)
    for (columns, patterns, _), chosen in zip(every, at, strict=True):
        fell[:, columns] = patterns[chosen]
    return Draws.of(keys, fell, weight)


def _draw(key: tuple[int, int], weight: FloatArray, seed: int) -> NDArray[np.intp]:
    """Draw patterns of a unit, each as often as its weight says, in an order of the unit's own."""
    return np.minimum(np.searchsorted(np.cumsum(weight), _order(seed, *key)), len(weight) - 1)


@lru_cache(maxsize=8192)
def _order(seed: int, name: int, is_group: int) -> FloatArray:
    """Return the levels, from 0 to 1, by which the draws of a piece or of a group go."""
    return (np.random.default_rng([seed, name, is_group]).permutation(DRAWS) + 0.5) / DRAWS


def _correlate(falls: Falls, keys: tuple[Key, ...]) -> Draws:
    """Return the draws where one level decides for all: what falls at a chance falls at every higher one."""
    chance = {key: float(falls.probability[key[0]]) for key in keys}
    levels = sorted({0.0, 1.0, *chance.values()})
    under = {level: (1 << at) - 1 for at, level in enumerate(levels)}
    return Draws({key: under[level] for key, level in chance.items()}, np.diff(levels))


def _ends(keys: tuple[Key, ...]) -> Draws:
    return Draws(dict.fromkeys(keys, EVERY), np.array([0.5, 0.5]))


def find_chances(couplings: Couplings, happens: Happens, z: float) -> list[Chance]:
    """Return the chance of everything that `happens` tells of; `z` is the half width of intervals [-].

    What cannot happen with every piece fallen, or happens with none, is certain, and so is without an interval.
    """
    ways = (couplings.joint, couplings.independent, couplings.correlated)
    happened = [happens(one) for one in ways]
    return [
        _chance(couplings, [round(way.share(one), ROUNDED) for way, one in zip(ways, own, strict=True)], z,
                is_certain=bool(end & NONE) or not end)
        for end, *own in zip(happens(couplings.ends), *happened, strict=True)
    ]  # fmt: skip


def _chance(couplings: Couplings, shares: Sequence[float], z: float, *, is_certain: bool) -> Chance:
    joint, independent, correlated = shares
    values = (joint,) if couplings.is_joint else (joint, independent, correlated)
    low, high = min(values), max(values)
    counts = [*([couplings.runs] if couplings.runs else []), *([DRAWS] if couplings.is_drawn else [])]
    if counts and not is_certain:
        low = float(wilson_interval(low * min(counts), min(counts), z)[0])
        high = float(wilson_interval(high * min(counts), min(counts), z)[1])
    return Chance(
        probability=max(values), low=min(low, max(values)), high=max(high, *values), joint=joint,
        independent=independent, correlated=correlated, runs=couplings.runs, is_joint=couplings.is_joint,
        pieces=couplings.pieces, unverified=couplings.unverified,
    )  # fmt: skip
