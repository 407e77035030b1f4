"""What falls together: as the motions say, independently of each other, or as closely tied as can be."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, FloatArray
from assess.risk import wilson_interval
from assess.routes.falls import Falls
from assess.routes.gaps import Key
from assess.routes.model import Chance

EXACT = 4096
"""Outcomes of all pieces together up to which every one is gone through; above, they are drawn."""
DRAWS = 4000
"""Draws where they are more: the 95 % interval of a chance of 0.5 is then 0.5 +- 0.016."""

MOST_PATTERNS = 20_000
"""Motions up to which pieces of different numbers of motions are made to meet evenly."""
ROUNDED = 12
"""Decimals that chances keep: sums of weights leave a hair."""

Happens = Callable[[BoolArray], BoolArray]
"""Tells for each of m draws (m, n) of which pieces fell whether something happens: (m,), or (m, r) for r things."""


@dataclass(frozen=True, slots=True, eq=False)
class Draws:
    """m draws of which of n pieces fall, with their weights (m,), which add up to 1."""

    fell: BoolArray
    weight: FloatArray


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


def build_couplings(falls: Falls, keys: Sequence[Key], seed: int) -> Couplings:
    """Return how the pieces of `keys` fall together; draws depend on `seed` and on the piece alone."""
    keys = tuple(keys)
    rows = sorted({item for item, _number in keys})
    groups = sorted({int(falls.group[item]) for item in rows} - {-1})
    alone = [item for item in rows if falls.group[item] < 0]
    units = [_group_unit(falls, keys, [item for item in rows if falls.group[item] == one]) for one in groups]
    single = {item: _row_unit(falls, keys, item) for item in rows}
    joint = _combine([*units, *(single[item] for item in alone)], len(keys), seed)
    independent = _combine(list(single.values()), len(keys), seed)
    runs = [falls.fell[item].size for item in rows if falls.group[item] >= 0]
    return Couplings(
        keys=keys,
        joint=joint,
        independent=independent,
        correlated=_correlate(falls.probability[np.array([item for item, _ in keys], dtype=np.intp)]),
        is_joint=not alone and len(groups) <= 1,
        runs=min(runs, default=0),
        is_drawn=bool(alone or len(groups) > 1) and DRAWS in (len(joint.weight), len(independent.weight)),
        pieces=int(falls.quantity[rows].sum()),
        unverified=int(falls.quantity[alone].sum()),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Unit:
    """Pieces that fall together in a known way: their columns (c,), the patterns (k, c) and the weights of those.

    `first` is the first of the pieces, by which draws are told apart.
    """

    first: int
    columns: list[int]
    fell: BoolArray
    weight: FloatArray


def _group_unit(falls: Falls, keys: Sequence[Key], items: Sequence[int]) -> _Unit:
    """Return the outcomes of verified pieces, motion by motion.

    A piece that was decided after fewer motions than another repeats its own, so that its chance stays what it is.
    """
    members = set(items)
    columns = [at for at, (item, _) in enumerate(keys) if item in members]
    sizes = [falls.fell[item].size for item in items]
    runs = math.lcm(*sizes)
    runs = runs if runs <= MOST_PATTERNS else max(sizes)
    fell = np.column_stack([np.resize(falls.fell[keys[at][0]], runs) for at in columns])
    return _Unit(min(members), columns, fell, np.full(runs, 1.0 / runs))


def _row_unit(falls: Falls, keys: Sequence[Key], item: int) -> _Unit:
    """Return the outcomes of one row: none, one, or two or more of its pieces fall, independently of each other."""
    columns = [at for at, key in enumerate(keys) if key[0] == item]
    p, q = float(falls.probability[item]), int(falls.quantity[item])
    none = (1 - p) ** q
    if len(columns) == 1:
        return _Unit(item, columns, np.array([[False], [True]]), np.array([none, 1 - none]))
    one = q * p * (1 - p) ** (q - 1)
    patterns = np.array([[False, False], [True, False], [True, True]])
    return _Unit(item, columns, patterns, np.array([none, one, max(0.0, 1 - none - one)]))


def _combine(units: Sequence[_Unit], width: int, seed: int) -> Draws:
    """Combine units that fall independently: every combination where they are few, else `DRAWS` of them."""
    sizes = [len(unit.weight) for unit in units]
    if not units:
        return Draws(np.zeros((1, 0), dtype=np.bool_), np.ones(1))
    if len(units) == 1 or math.prod(sizes) <= EXACT:
        at = np.indices(sizes).reshape(len(sizes), -1)
        weight = np.ones(at.shape[1])
        for unit, chosen in zip(units, at, strict=True):
            weight = weight * unit.weight[chosen]
    else:
        at = np.array([_draw(unit, seed) for unit in units])
        weight = np.full(DRAWS, 1.0 / DRAWS)
    fell = np.zeros((len(weight), width), dtype=np.bool_)
    for unit, chosen in zip(units, at, strict=True):
        fell[:, unit.columns] = unit.fell[chosen]
    return Draws(fell, weight)


def _draw(unit: _Unit, seed: int) -> NDArray[np.intp]:
    """Draw patterns of a unit, each as often as its weight says, in an order of the unit's own."""
    levels = (np.random.default_rng([seed, unit.first]).permutation(DRAWS) + 0.5) / DRAWS
    return np.minimum(np.searchsorted(np.cumsum(unit.weight), levels), len(unit.weight) - 1)


def _correlate(probability: FloatArray) -> Draws:
    """Return the draws where one level decides for all: what falls at a chance falls at every higher one."""
    levels = np.unique(np.concatenate(([0.0, 1.0], probability)))
    middle = (levels[:-1] + levels[1:]) / 2
    return Draws(probability > middle[:, np.newaxis], np.diff(levels))


def find_chances(couplings: Couplings, happens: Happens, z: float) -> list[Chance]:
    """Return the chance of everything that `happens` tells of; `z` is the half width of intervals [-].

    What cannot happen with every piece fallen, or happens with none, is certain, and so is without an interval.
    """
    n = len(couplings.keys)
    ends = _rows(happens(np.array([[False] * n, [True] * n], dtype=np.bool_).reshape(2, n)))
    ways = (couplings.joint, couplings.independent, couplings.correlated)
    shares = np.round([one.weight @ _rows(happens(one.fell)) for one in ways], ROUNDED)
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
