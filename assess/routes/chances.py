"""What falls together, and how likely that is: as the draws say, independently, or fully correlated.

Draw k is one earthquake for the whole building: the simulated pieces of all floors and axes share its scale, and fall
draw by draw. A piece that was not simulated falls independently of the others, at the chance of its formula. A piece
whose chance is not confirmed has none here: all of them stand, or all of them fall.

What happens in which of many draws is kept as one whole number, a set: bit k stands for draw k. Sets are joined by `|`,
intersected by `&` and counted at once. The complement is `every & ~set`, of the set of all draws: no set is negative.
"""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial, reduce
from operator import or_

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.progress import SILENT, Progress
from assess.risk import wilson_interval
from assess.route_results import Chance

Key = tuple[int, int]
"""A piece that could fall: its index in the inventory, and 0, or 1 for a second piece of the same row."""

EXACT = 4096
"""Combinations of falling pieces up to which all are evaluated; above, they are drawn."""
DRAWS = 2000
"""Draws where they are more: the 95 % interval of a chance of 0.5 is then 0.5 +- 0.022."""

MOST_PATTERNS = 20_000
"""Draws up to which pieces of different numbers of draws are repeated to a common multiple."""
ROUNDED = 12
"""Decimals that chances keep: the rest is rounding in sums of weights."""
NONE, EVERY = 0b01, 0b10
"""The two draws of `Couplings.ends`: nothing falls, and everything does."""


@dataclass(frozen=True, slots=True, eq=False)
class Falls:
    """How the n pieces of an inventory fall, each under its governing motion.

    * `high` (n,): the upper end of its interval; the chance itself where there is none [-].
    * `fell`: for a simulated piece (by its index) whether it overturned, draw by draw.
    * `unconfirmed`: for a piece whose adopted chance is the formula's, as a lower one was simulated that cannot be
      relied on: why, as keys of `assess.route_results.FLAGS`. It is not in `fell`.
    * `in_record` (n,): 1 where it overturns under the recorded motion itself, 0 where it does not, NaN where that is
      not known.
    * `stands` (n,): pieces that cannot rock: they block nothing.
    * `anchored` (n,): pieces whose fall depends on an anchor; their outcomes are those of a free-standing piece.
    """

    probability: FloatArray
    high: FloatArray
    fell: Mapping[int, BoolArray]
    unconfirmed: Mapping[int, tuple[str, ...]]
    in_record: FloatArray
    stands: BoolArray
    anchored: BoolArray
    quantity: NDArray[np.intp]


def to_sets(happens: BoolArray) -> list[int]:
    """Return the sets of the draws in which each of r things happens (m draws, r)."""
    packed = np.packbits(happens, axis=0, bitorder="little")
    return [int.from_bytes(packed[:, at].tobytes(), "little") for at in range(happens.shape[1])]


def to_array(draws: int, count: int) -> NDArray[np.uint8]:
    """Return for each of `count` draws whether a set holds it (count,): 1 or 0."""
    flat = np.frombuffer(draws.to_bytes(-(-count // 8), "little"), dtype=np.uint8)
    return np.unpackbits(flat, count=count, bitorder="little")


def union(sets: Iterable[int]) -> int:
    """Return the set of the draws that any of some sets holds."""
    return reduce(or_, sets, 0)


@dataclass(frozen=True, slots=True, eq=False)
class Draws:
    """m draws with their weights (m,), which add up to 1, and for each piece the set of those in which it falls.

    `narrower` keeps results: by the number of a segment and a width, the set of the draws in which less than that is
    left.
    """

    fallen: Mapping[Key, int]
    weight: FloatArray
    narrower: dict[tuple[int, float], int] = field(default_factory=dict)
    every: int = field(init=False)
    """The set of all draws."""
    is_even: bool = field(init=False)
    """Whether all draws weigh the same."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "every", (1 << len(self.weight)) - 1)
        object.__setattr__(self, "is_even", bool((self.weight == self.weight[0]).all()))

    @classmethod
    def of(cls, keys: Sequence[Key], fell: BoolArray, weight: FloatArray) -> "Draws":
        """Build them from which of n pieces fall (m, n)."""
        return cls(dict(zip(keys, to_sets(fell), strict=True)), weight)

    def share(self, draws: int) -> float:
        """Return the weight of a set of the draws [-], rounded."""
        if self.is_even:
            return round(draws.bit_count() * float(self.weight[0]), ROUNDED)
        return round(float(self.weight @ to_array(draws, len(self.weight))), ROUNDED)


Happens = Callable[[Draws], Sequence[int]]
"""Returns for some draws the sets of those in which each of several things happens."""


@dataclass(frozen=True, slots=True, eq=False)
class Couplings:
    """The same pieces falling together in three ways.

    The draws may be of more pieces than `keys`: what depends on another piece must not be asked of them. `ends` are the
    draws `NONE` and `EVERY`. `runs` is the least number of draws of a simulated piece, 0 without one; `is_joint` holds
    where all were simulated, in the same draws; `sizes` is the number of draws of each of those; `is_drawn` tells
    whether any of the three was drawn rather than evaluated in full. `pieces`, `unverified` and `unconfirmed` count
    pieces, not rows; the first leaves out the last.
    """

    keys: tuple[Key, ...]
    joint: Draws
    independent: Draws
    correlated: Draws
    ends: Draws
    is_joint: bool
    runs: int
    is_drawn: bool
    sizes: Mapping[int, int]
    pieces: int
    unverified: int
    unconfirmed: int

    @property
    def decisive(self) -> tuple[Draws, ...]:
        """Those whose largest chance is reported: the joint one where it is known, else all three."""
        return (self.joint,) if self.is_joint else (self.joint, self.independent, self.correlated)


def build_couplings(
    falls: Falls, keys: Sequence[Key], seed: int, of_all: Callable[[], Couplings] | None = None,
    progress: Progress = SILENT, *, unconfirmed_fall: bool = False,
) -> Couplings:  # fmt: skip
    """Return how the pieces of `keys` fall together; draws depend on `seed` and on the piece alone.

    `of_all` returns the couplings of more pieces, whose draws are shared wherever the combinations of `keys` are drawn.
    `progress` is checked for a cancel. Unconfirmed pieces stand in every draw, or fall in every one.
    """
    keys, whole = tuple(keys), of_all() if of_all else None
    columns: dict[int, list[int]] = {}
    for at, (item, _number) in enumerate(keys):
        columns.setdefault(item, []).append(at)
    known = [item for item in columns if item not in falls.unconfirmed]
    fallen = frozenset(key for key in keys if unconfirmed_fall and key[0] in falls.unconfirmed)
    simulated = {item: columns[item] for item in known if item in falls.fell}
    alone = [item for item in known if item not in simulated]
    sizes = {item: int(falls.fell[item].size) for item in simulated}
    # outcomes of a piece that was decided after fewer draws than another are repeated, so that its chance is kept
    runs = common if (common := math.lcm(*sizes.values())) <= MOST_PATTERNS else max(sizes.values())
    together = [_Unit((0, 1), [at for own in simulated.values() for at in own], runs)] if simulated else []
    rows = {item: _Unit((item, 0), columns[item], 1 + len(columns[item])) for item in known}
    lone, mixed = list(rows.values()), [*together, *(rows[item] for item in alone)]
    combine = partial(_combine, falls, keys, fallen, seed, progress)
    joint = independent = whole.independent if whole and _is_drawn(lone) else combine(lone)
    if whole and _is_drawn(mixed):
        joint = whole.joint
    elif simulated:
        joint = combine(mixed)
    if whole:
        correlated, ends = whole.correlated, whole.ends
    else:
        certain = {key: key in fallen for key in keys if key[0] in falls.unconfirmed}
        # one level decides for all: what falls at a chance falls at every higher one
        chance = {key: float(certain.get(key, falls.probability[key[0]])) for key in keys}
        levels = sorted({0.0, 1.0, *chance.values()})
        under = {level: (1 << at) - 1 for at, level in enumerate(levels)}
        correlated = Draws({key: under[level] for key, level in chance.items()}, np.diff(levels))
        surely = {key: NONE | EVERY if falls_always else 0 for key, falls_always in certain.items()}
        ends = Draws({**dict.fromkeys(keys, EVERY), **surely}, np.array([0.5, 0.5]))
    return Couplings(
        keys=keys, joint=joint, independent=independent, correlated=correlated, ends=ends,
        is_joint=(is_joint := not alone and len(set(sizes.values())) <= 1), runs=min(sizes.values(), default=0),
        is_drawn=not is_joint and (_is_drawn(mixed) or _is_drawn(lone)), sizes=sizes,
        pieces=int(falls.quantity[known].sum()), unverified=int(falls.quantity[alone].sum()),
        unconfirmed=int(falls.quantity[[item for item in columns if item in falls.unconfirmed]].sum()),
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Unit:
    """Pieces that fall together in one of `count` patterns, independently of other units; `columns` are their places.

    `key` identifies it in draws: the row and 0, or for all simulated pieces 0 and 1.
    """

    key: tuple[int, int]
    columns: Sequence[int]
    count: int


def _find_patterns(falls: Falls, unit: _Unit, keys: Sequence[Key]) -> tuple[BoolArray, FloatArray]:
    """Return which pieces of a unit fall in each of its patterns (count, pieces), and the weights (count,).

    Simulated pieces fall draw by draw. The pieces of a row fall independently of each other: none, one, or two or more.
    """
    item, is_joint = unit.key
    if is_joint:
        fell = [np.resize(falls.fell[keys[at][0]], unit.count) for at in unit.columns]
        return np.column_stack(fell), np.full(unit.count, 1.0 / unit.count)
    p, q = float(falls.probability[item]), int(falls.quantity[item])
    none, one = (1 - p) ** q, q * p * (1 - p) ** (q - 1)
    if len(unit.columns) == 1:
        return np.array([[False], [True]]), np.array([none, 1 - none])
    return (np.array([[False, False], [True, False], [True, True]]), np.array([none, one, max(0.0, 1 - none - one)]))


def _is_drawn(units: Sequence[_Unit]) -> bool:
    return len(units) > 1 and math.prod(unit.count for unit in units) > EXACT


def _combine(
    falls: Falls, keys: tuple[Key, ...], fallen: Collection[Key], seed: int, progress: Progress, units: Sequence[_Unit]
) -> Draws:
    """Combine units that fall independently: every combination where they are few, else `DRAWS` of them.

    Of pieces in no unit, those of `fallen` fall in each of them, and others stand.
    """
    always = np.array([key in fallen for key in keys], dtype=np.bool_)
    if not units:
        return Draws.of(keys, always[np.newaxis], np.ones(1))
    progress.check()
    patterns = [_find_patterns(falls, unit, keys) for unit in units]
    progress.check()
    if _is_drawn(units):  # patterns of a unit, each as often as its weight says, in an order of the unit's own
        at = np.array([
            np.minimum(np.searchsorted(np.cumsum(own), _levels(seed, *unit.key)), len(own) - 1)
            for unit, (_, own) in zip(units, patterns, strict=True)
        ])  # fmt: skip
        weight = np.full(DRAWS, 1.0 / DRAWS)
    else:
        at = np.indices([unit.count for unit in units]).reshape(len(units), -1)
        weight = np.prod([own[chosen] for (_, own), chosen in zip(patterns, at, strict=True)], axis=0)
    fell = np.repeat(always[np.newaxis], len(weight), axis=0)
    for unit, (pattern, _), chosen in zip(units, patterns, at, strict=True):
        progress.check()
        fell[:, unit.columns] = pattern[chosen]
    return Draws.of(keys, fell, weight)


@lru_cache(maxsize=8192)
def _levels(seed: int, name: int, is_joint: int) -> FloatArray:
    return (np.random.default_rng([seed, name, is_joint]).permutation(DRAWS) + 0.5) / DRAWS


def find_chances(couplings: Couplings, happens: Happens, z: float) -> list[Chance]:
    """Return the chance of everything that `happens` returns; `z` is the half width of intervals [-].

    What cannot happen with every piece fallen, or happens with none, is certain, and has no interval.
    """
    ways = (couplings.joint, couplings.independent, couplings.correlated)
    counts = [*([couplings.runs] if couplings.runs else []), *([DRAWS] if couplings.is_drawn else [])]
    found = []
    for end, *happened in zip(happens(couplings.ends), *map(happens, ways), strict=True):
        joint, independent, correlated = (way.share(one) for way, one in zip(ways, happened, strict=True))
        values = (joint,) if couplings.is_joint else (joint, independent, correlated)
        low, high = min(values), max(values)
        if counts and end & EVERY and not end & NONE:
            low, high = (
                float(wilson_interval(one * min(counts), min(counts), z)[at]) for at, one in enumerate((low, high))
            )
        chance = Chance(
            probability=max(values), low=min(low, max(values)), high=max(high, *values), joint=joint,
            independent=independent, correlated=correlated, runs=couplings.runs, is_joint=couplings.is_joint,
            pieces=couplings.pieces, unverified=couplings.unverified, unconfirmed=couplings.unconfirmed,
        )  # fmt: skip
        found.append(chance)
    return found
