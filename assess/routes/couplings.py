"""What falls together: as the motions say, independently of each other, or as closely tied as can be."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, FloatArray
from assess.risk import wilson_interval
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


@dataclass(frozen=True, slots=True, eq=False)
class Draws:
    """m draws of which of n pieces fall (m, n), with their weights (m,), which add up to 1.

    `widths` and `blocked` keep what has been worked out for them, by the number of a segment: the clear width left (m,)
    [m], and a column of the array that tells which segments are blocked (m, all segments).
    """

    keys: tuple[Key, ...]
    fell: BoolArray
    weight: FloatArray
    widths: dict[int, FloatArray] = field(default_factory=dict)
    blocked: dict[int, BoolArray] = field(default_factory=dict)
    place: dict[Key, int] = field(init=False)
    """Where each piece stands among the columns."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "place", {key: at for at, key in enumerate(self.keys)})


Happens = Callable[[Draws], BoolArray]
"""Tells for each of m draws whether something happens: (m,), or (m, r) for r things."""


@dataclass(frozen=True, slots=True, eq=False)
class Couplings:
    """The same pieces falling together in three ways.

    `runs` is the least number of motions of a verified piece, 0 without one; `is_drawn` tells whether any of the three
    was drawn rather than gone through. `pieces` and `unverified` count pieces, not rows.
    """

    keys: tuple[Key, ...]
    joint: Draws
    independent: Draws
    correlated: Draws
    is_joint: bool
    runs: int
    is_drawn: bool
    pieces: int
    unverified: int


def build_couplings(
    falls: Falls, keys: Sequence[Key], seed: int, of_all: "Callable[[], Couplings] | None" = None
) -> Couplings:
    """Return how the pieces of `keys` fall together; draws depend on `seed` and on the piece alone.

    Where they are to be drawn, those of more pieces serve, if `of_all` gives them: what is known of those is shared.
    """
    keys = tuple(keys)
    columns: dict[int, list[int]] = {}
    for at, (item, _number) in enumerate(keys):
        columns.setdefault(item, []).append(at)
    rows = sorted(columns)
    groups = sorted({int(falls.group[item]) for item in rows} - {-1})
    alone = [item for item in rows if falls.group[item] < 0]
    members = {one: [item for item in rows if falls.group[item] == one] for one in groups}
    units = [_group_unit(falls, one, {item: columns[item] for item in own}) for one, own in members.items()]
    single = {item: _row_unit(falls, item, own) for item, own in columns.items()}
    lone = list(single.values())
    independent = of_all().independent if of_all and _is_drawn(lone) else _combine(lone, keys, seed)
    mixed = [*units, *(single[item] for item in alone)] if units else lone
    joint = of_all().joint if of_all and _is_drawn(mixed) else _combine(mixed, keys, seed) if units else independent
    runs = [falls.fell[item].size for item in rows if falls.group[item] >= 0]
    return Couplings(
        keys=keys,
        joint=joint,
        independent=independent,
        correlated=_correlate(falls, keys),
        is_joint=not alone and len(groups) <= 1,
        runs=min(runs, default=0),
        is_drawn=bool(alone or len(groups) > 1) and (_is_drawn(mixed) or _is_drawn(lone)),
        pieces=int(falls.quantity[rows].sum()),
        unverified=int(falls.quantity[alone].sum()),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Unit:
    """Pieces that fall together in a known way: their columns (c,), the patterns (k, c) and the weights of those.

    `name` is the piece, or the group, by which draws are told apart; `is_group` tells which of the two.
    """

    name: int
    columns: list[int]
    fell: BoolArray
    weight: FloatArray
    is_group: bool = False


def _group_unit(falls: Falls, group: int, columns: Mapping[int, list[int]]) -> _Unit:
    """Return the outcomes of verified pieces, motion by motion.

    A piece that was decided after fewer motions than another repeats its own, so that its chance stays what it is.
    """
    sizes = [falls.fell[item].size for item in columns]
    runs = math.lcm(*sizes)
    runs = runs if runs <= MOST_PATTERNS else max(sizes)
    fell = np.column_stack([np.resize(falls.fell[item], runs) for item, own in columns.items() for _ in own])
    every = [at for own in columns.values() for at in own]
    return _Unit(group, every, fell, np.full(runs, 1.0 / runs), is_group=True)


def _row_unit(falls: Falls, item: int, columns: list[int]) -> _Unit:
    """Return the outcomes of one row: none, one, or two or more of its pieces fall, independently of each other."""
    p, q = float(falls.probability[item]), int(falls.quantity[item])
    none = (1 - p) ** q
    if len(columns) == 1:
        return _Unit(item, columns, np.array([[False], [True]]), np.array([none, 1 - none]))
    one = q * p * (1 - p) ** (q - 1)
    patterns = np.array([[False, False], [True, False], [True, True]])
    return _Unit(item, columns, patterns, np.array([none, one, max(0.0, 1 - none - one)]))


def _is_drawn(units: Sequence[_Unit]) -> bool:
    return len(units) > 1 and math.prod(len(unit.weight) for unit in units) > EXACT


def _combine(units: Sequence[_Unit], keys: tuple[Key, ...], seed: int) -> Draws:
    """Combine units that fall independently: every combination where they are few, else `DRAWS` of them."""
    sizes = [len(unit.weight) for unit in units]
    if not units:
        return Draws(keys, np.zeros((1, 0), dtype=np.bool_), np.ones(1))
    if not _is_drawn(units):
        at = np.indices(sizes).reshape(len(sizes), -1)
        weight = np.ones(at.shape[1])
        for unit, chosen in zip(units, at, strict=True):
            weight = weight * unit.weight[chosen]
    else:
        at = np.array([_draw(unit, seed) for unit in units])
        weight = np.full(DRAWS, 1.0 / DRAWS)
    fell = np.zeros((len(weight), len(keys)), dtype=np.bool_)
    for unit, chosen in zip(units, at, strict=True):
        fell[:, unit.columns] = unit.fell[chosen]
    return Draws(keys, fell, weight)


def _draw(unit: _Unit, seed: int) -> NDArray[np.intp]:
    """Draw patterns of a unit, each as often as its weight says, in an order of the unit's own."""
    levels = _order(seed, unit.name, unit.is_group)
    return np.minimum(np.searchsorted(np.cumsum(unit.weight), levels), len(unit.weight) - 1)


@lru_cache(maxsize=8192)
def _order(seed: int, name: int, is_group: bool) -> FloatArray:
    """Return the levels, from 0 to 1, by which the draws of a piece or of a group go."""
    return (np.random.default_rng([seed, name, int(is_group)]).permutation(DRAWS) + 0.5) / DRAWS


def _correlate(falls: Falls, keys: tuple[Key, ...]) -> Draws:
    """Return the draws where one level decides for all: what falls at a chance falls at every higher one."""
    probability = falls.probability[np.array([item for item, _ in keys], dtype=np.intp)]
    levels = np.unique(np.concatenate(([0.0, 1.0], probability)))
    middle = (levels[:-1] + levels[1:]) / 2
    return Draws(keys, probability > middle[:, np.newaxis], np.diff(levels))


def find_chances(couplings: Couplings, happens: Happens, z: float) -> list[Chance]:
    """Return the chance of everything that `happens` tells of; `z` is the half width of intervals [-].

    What cannot happen with every piece fallen, or happens with none, is certain, and so is without an interval.
    """
    n = len(couplings.keys)
    none_and_every = np.array([[False] * n, [True] * n], dtype=np.bool_).reshape(2, n)
    ends = _rows(happens(Draws(couplings.keys, none_and_every, np.ones(2))))
    ways = (couplings.joint, couplings.independent, couplings.correlated)
    shares = np.round([one.weight @ _rows(happens(one)) for one in ways], ROUNDED)
    return [
        _chance(couplings, share, z, is_certain=bool(none) or not every)
        for share, (none, every) in zip(shares.T, ends.T, strict=True)
    ]


def _chance(couplings: Couplings, shares: FloatArray, z: float, *, is_certain: bool) -> Chance:
    joint, independent, correlated = (float(share) for share in shares)
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


def _rows(happened: BoolArray) -> BoolArray:
    return happened if happened.ndim == 2 else happened[:, np.newaxis]
