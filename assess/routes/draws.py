"""Draws of which pieces fall, and what happens in them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from assess.methods._method import BoolArray, FloatArray
from assess.routes.bits import to_array, to_sets
from assess.routes.gaps import Key


@dataclass(frozen=True, slots=True, eq=False)
class Draws:
    """m draws with their weights (m,), which add up to 1, and for each piece the set of those in which it falls.

    Sets are those of `assess.routes.bits`. `narrower` keeps what has been worked out: by the number of a segment and a
    width, the set of the draws in which less than that is left.
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
        """Return what a set of the draws weighs [-]."""
        if self.is_even:
            return draws.bit_count() * float(self.weight[0])
        return float(self.weight @ to_array(draws, len(self.weight)))
