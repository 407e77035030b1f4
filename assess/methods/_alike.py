"""Pieces that are exactly alike: they have one chance, from the draws of all of them."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.methods._method import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Alike:
    """Which of m rows are alike, and how much each counts among them.

    Parameters
    ----------
    group : (m,) integer array
        The number of the group of each, from 0.
    weight : (m,) integer array
        The pieces of each over the largest number that divides those of its whole group [-].
    """

    group: NDArray[np.intp]
    weight: NDArray[np.int64]

    @classmethod
    def of(cls, numbers: ArrayLike, quantity: ArrayLike) -> Self:
        """Return the groups of rows with the same of `numbers` (m,); `quantity` (m,) are the pieces of each."""
        _, group = np.unique(np.asarray(numbers), return_inverse=True)
        group, pieces = group.ravel(), np.asarray(quantity, dtype=np.int64)
        common = np.zeros(group.max(initial=-1) + 1, dtype=np.int64)
        np.gcd.at(common, group, pieces)
        return cls(group, pieces // common[group])

    @property
    def total(self) -> NDArray[np.int64]:
        """The weight of the whole group of each, (m,)."""
        return self._add_up(self.weight)

    def add_up(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return for each row the weighted sum over its group: of values (m,), or (d, m) of each of d rows."""
        return self._add_up(self.weight * values)

    def average(self, values: NDArray[Any]) -> FloatArray:
        """Return for each row the weighted mean over its group, (m,)."""
        return np.asarray(self.add_up(values) / self.total)

    def _add_up(self, values: NDArray[Any]) -> NDArray[Any]:
        sums = np.zeros((*values.shape[:-1], self.group.max(initial=-1) + 1), dtype=values.dtype)
        np.add.at(sums.T, self.group, values.T)
        return sums[..., self.group]
