"""What methods are evaluated on: a batch of cases, the motions of their floors, and what a simulation finds of both."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.arrays import BoolArray, FloatArray
from assess.progress import SILENT, Progress
from assess.rocking.block import MIDDLE, stocky_limit, threshold
from assess.rocking.draws import PEAK, STILL, STILL_SCANNED, Earthquakes, Uncertainty

if TYPE_CHECKING:
    from assess.motion.target_fit import Fit, Spectra

ALIKE = 9
"""Decimals to which two PFA [g] or two probabilities are held against each other when one of them has to govern."""
NO_WALL, SIDE_UNKNOWN = 0, 2
"""Of `Cases.wall`: nothing at the back of a piece, or a wall of which the side is not known."""
_TYPES: Mapping[str, type] = {
    "ensemble": np.intp, "name": np.int64, "scanned": np.bool_, "slides_under": np.intp, "wall": np.int8,
}  # fmt: skip
"""Of the arrays of `Cases` that hold no real numbers."""


class Ensemble(Protocol):
    """The motions of one floor along one axis, for methods that integrate; they are made when asked for."""

    @property
    def is_assumed(self) -> bool:
        """Whether ground motion and building are drawn, of a floor without a record."""

    @property
    def is_unknown(self) -> bool:
        """Whether nothing is known of the building, nor of the floor's height."""

    @property
    def signs(self) -> tuple[int, ...] | None:
        """By which the phases that all floors share are turned, 1 or -1 by octave; None where they are not known."""

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion (n,) [m/s2] and its time step [s], where one is known."""

    @property
    def key(self) -> Hashable:
        """All that its motions, and the record, depend on."""

    def open(self, threads: int, progress: Progress = SILENT) -> "Motions":
        """Prepare the motions; their memory is released with the result."""


@dataclass(frozen=True, slots=True, eq=False)
class Motions:
    """What an `Ensemble` opens.

    * `realise`: returns motions from a number on, and a count of them, in batches: (k, n) [m/s2], and their time step
      [s].
    * `fit`: how they meet the spectrum that they were made for; None for motions that were given.
    * `spectra`: response spectra of the first 100, and the one that they were made for; None where unknown.
    * `is_weak`: whether they are weaker than the floor's motion.
    * `bands`: factors above and below the corner by which drawn motions are brought to the floor's peaks [-].
    """

    realise: Callable[[int, int], list[tuple[NDArray[Any], float]]]
    fit: "Fit | None" = None
    spectra: "Spectra | None" = None
    is_weak: bool = False
    bands: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """A batch of (piece, floor motion) pairs as arrays of one length n, in SI; NaN is unknown.

    * `breadth`, `height` (n,): sizes of the piece [m]; breadth is the side parallel to the motion.
    * `pfa`, `pfv` (n,): peak floor acceleration [m/s2] and velocity [m/s].
    * `friction` (n,): coefficient of friction [-]; NaN where no sliding is assumed.
    * `restitution` (n,): angular velocity after an impact over that before it [-]; NaN is Housner's.
    * `ensemble` (n,): which of `ensembles` is the case's motion; -1 where it is not to be integrated.
    * `centre` (n,): height of the centre of gravity as a share of the piece's [-].
    * `name` (n,): the piece, from `assess.rocking.draws.name_number`: by it what is not known of it is drawn.
    * `scanned` (n,): where the sizes were measured by a scan, so that they are less certain.
    * `slides_under` (n,): which of `ensembles` the slip of the piece is to be found under; -1 where it is not.
    * `alike` (n,): cases of one number differ in nothing that is computed with: they have one chance.
    * `quantity` (n,): pieces of the row.
    * `wall` (n,): `NO_WALL`; else the direction along the motion in which a wall at its back leaves it free to turn, 1
      or -1; or `SIDE_UNKNOWN`.
    * `dispersion` (n,): standard deviation of ln amplitude of the floor's motion from one earthquake to the next [-].
    * `peak` (n,): that of ln of the peaks of its motions over `pfa` [-].
    * `ensembles`: motions of floors.
    * `uncertainty`: what is drawn.
    * `earthquakes`: by which numbers the draws of an earthquake scale the motions.
    """

    breadth: FloatArray
    height: FloatArray
    pfa: FloatArray
    pfv: FloatArray
    friction: FloatArray
    restitution: FloatArray
    ensemble: NDArray[np.intp]
    centre: FloatArray
    name: NDArray[np.int64]
    scanned: BoolArray
    slides_under: NDArray[np.intp]
    alike: NDArray[np.intp]
    quantity: NDArray[np.int64]
    wall: NDArray[np.int8]
    dispersion: FloatArray
    peak: FloatArray
    ensembles: Sequence[Ensemble] = ()
    uncertainty: Uncertainty = field(default_factory=Uncertainty)
    earthquakes: Earthquakes = field(default_factory=Earthquakes)

    @classmethod
    def of(
        cls,
        *,
        breadth: ArrayLike,
        height: ArrayLike,
        pfa: ArrayLike = math.nan,
        pfv: ArrayLike = math.nan,
        friction: ArrayLike = math.nan,
        restitution: ArrayLike = math.nan,
        ensemble: ArrayLike = -1,
        centre: ArrayLike = MIDDLE,
        name: ArrayLike = 0,
        scanned: ArrayLike = False,
        slides_under: ArrayLike = -1,
        wall: ArrayLike = NO_WALL,
        ensembles: Sequence[Ensemble] = (),
        uncertainty: Uncertainty | None = None,
    ) -> Self:
        """Build a batch from numbers and arrays, brought to one length; what is left out is unknown."""
        given = {
            "breadth": breadth, "height": height, "pfa": pfa, "pfv": pfv, "friction": friction,
            "restitution": restitution, "ensemble": ensemble, "centre": centre, "name": name, "scanned": scanned,
            "slides_under": slides_under, "wall": wall,
        }  # fmt: skip
        rows = np.broadcast_arrays(*np.atleast_1d(*given.values()))
        columns: dict[str, Any] = {
            key: np.array(row, dtype=_TYPES.get(key, float)) for key, row in zip(given, rows, strict=True)
        }
        count, drawn = rows[0].size, uncertainty or Uncertainty()
        return cls(
            **columns, alike=np.arange(count), quantity=np.ones(count, dtype=np.int64),
            dispersion=np.full(count, drawn.motion), peak=np.full(count, PEAK), ensembles=ensembles, uncertainty=drawn,
        )  # fmt: skip

    @property
    def breadth_to_height(self) -> FloatArray:
        """B/H [-]."""
        return self.breadth / self.height

    @property
    def threshold(self) -> FloatArray:
        """Acceleration at which rocking starts [g]: b/z, half base over height of the centre of gravity."""
        return np.asarray(threshold(self.breadth, self.height, self.centre))

    @property
    def still(self) -> FloatArray:
        """Share of `threshold` below which a motion is taken not to start a piece, (n,) [-]: less of scanned sizes."""
        return np.where(self.scanned, STILL_SCANNED, STILL)

    @property
    def is_stocky(self) -> BoolArray:
        """Whether a piece is too stocky to rock: B/H of 1.41 or more, if it is uniform."""
        return np.asarray(self.breadth_to_height >= stocky_limit(self.centre))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Joint:
    """What m cases did motion by motion under one ensemble: motion k is one earthquake for the whole building.

    * `ensemble`: its place in `Cases.ensembles`.
    * `cases` (m,): places in the batch.
    * `runs` (m,): motions that each case was integrated under, the first ones.
    * `fell` (m, k): whether it overturned in each draw, of the motion and of the piece; False beyond its runs.
    * `ideal` (m, k): whether it overturned, as it is given, under each motion itself; False beyond its runs.
    * `rotation` (m, k): largest |theta| over the critical angle in each draw [-]; 0 beyond its runs.
    * `examples`: the first three motions [m/s2] and their time steps [s].
    * `fit`: how the motions meet their target.
    * `spectra`: response spectra of the first motions, at most 100, under which a case was integrated, and of their
      target.
    * `is_weak`: whether the motions are weaker than the floor's.
    * `bands`: factors by which drawn motions were brought to the floor's peaks [-].
    """

    ensemble: int
    cases: NDArray[np.intp]
    runs: NDArray[np.int64]
    fell: BoolArray
    ideal: BoolArray
    rotation: NDArray[np.float32]
    examples: Sequence[tuple[NDArray[np.float32], float]]
    fit: "Fit | None"
    spectra: "Spectra | None" = None
    is_weak: bool = False
    bands: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Alike:
    """Which of m rows are alike, and how much each counts among them.

    * `group` (m,): the number of the group of each, from 0.
    * `weight` (m,): the pieces of each over the largest number that divides those of its whole group [-].
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
        return self.add_up(np.ones_like(self.weight))

    def add_up(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return for each row the weighted sum over its group: of values (m,), or (d, m) of each of d rows."""
        weighted = self.weight * values
        sums = np.zeros((*weighted.shape[:-1], self.group.max(initial=-1) + 1), dtype=weighted.dtype)
        np.add.at(sums.T, self.group, weighted.T)
        return sums[..., self.group]

    def average(self, values: NDArray[Any]) -> FloatArray:
        """Return for each row the weighted mean over its group, (m,)."""
        return np.asarray(self.add_up(values) / self.total)
