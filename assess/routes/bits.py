"""What happens in which of many draws, as one whole number: bit k tells of draw k.

Such sets are joined by `|`, met by `&` and counted at once: what is asked most often of draws is then quick. What a set
leaves out is `every & ~set`, of the set of all draws: no set is negative.
"""

from collections.abc import Iterable
from functools import reduce
from operator import or_

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray


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
