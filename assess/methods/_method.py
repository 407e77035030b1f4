"""What a method is: one published way to tell whether a piece of furniture overturns."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.methods._info import (
    PFV_FLAGS,
    Column,
    FittedOn,
    MethodInfo,
    Parameter,
    Range,
    Reason,
    Reference,
)
from assess.progress import SILENT, Progress
from assess.rocking.block import MIDDLE, stocky_limit, threshold
from assess.rocking.draws import PEAK, STILL, STILL_SCANNED, Earthquakes, Uncertainty
from assess.settings import Settings

__all__ = [
    "ALIKE", "NORMAL_CDF", "PFV_FLAGS", "BoolArray", "Cases", "Column", "Ensemble",
    "Example", "FittedOn", "FloatArray", "Joint", "LiveCells", "Method", "MethodInfo", "Motions", "Outcome",
    "Parameter", "Range", "Reason", "Reference", "normal_cdf",
]  # fmt: skip

if TYPE_CHECKING:
    from assess.motion.target_fit import Fit, Spectra

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

ALIKE = 9
"""Decimals to which two PFA [g] or two probabilities are held against each other when one of them has to govern."""
NO_WALL, SIDE_UNKNOWN = 0, 2
"""Of `Cases.wall`: nothing at the back of a piece, or a wall of which the side is not known."""


class Ensemble(Protocol):
    """The motions of one floor along one axis, for methods that integrate; they are made when asked for."""

    @property
    def is_assumed(self) -> bool:
        """Whether ground motion and building are drawn, of a floor without a record."""
        ...

    @property
    def is_unknown(self) -> bool:
        """Whether nothing is known of the building, nor of the floor's height."""
        ...

    @property
    def signs(self) -> tuple[int, ...] | None:
        """By which the phases that all floors share are turned, 1 or -1 by octave; None where they are not known."""
        ...

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion (n,) [m/s2] and its time step [s], where one is known."""
        ...

    def open(self, threads: int, progress: Progress = SILENT) -> "Motions":
        """Prepare the motions; their memory is released with the result."""
        ...


class Motions(Protocol):
    """What an `Ensemble` opens."""

    @property
    def fit(self) -> "Fit | None":
        """How they meet the spectrum that they were made for; None for motions that were given."""
        ...

    @property
    def spectra(self) -> "Spectra | None":
        """Response spectra of the first of them, and the one that they were made for; None where unknown."""
        ...

    @property
    def is_weak(self) -> bool:
        """Whether they are weaker than the floor's motion."""
        ...

    @property
    def bands(self) -> tuple[float, float] | None:
        """Factors above and below the corner by which drawn motions are brought to the floor's peaks [-]."""
        ...

    def realise(self, first: int, count: int) -> list[tuple[NDArray[Any], float]]:
        """Return motions `first` to `first + count - 1` in batches: (k, n) [m/s2], and their time step [s]."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """A batch of (piece, floor motion) pairs as arrays of one length n, in SI; NaN is unknown.

    Parameters
    ----------
    breadth, height : (n,) arrays
        Sizes of the piece [m]; breadth is the side parallel to the motion.
    pfa, pfv : (n,) arrays
        Peak floor acceleration [m/s2] and velocity [m/s].
    friction : (n,) array
        Coefficient of friction [-]; NaN where no sliding is assumed.
    restitution : (n,) array
        Angular velocity after an impact over that before it [-]; NaN is Housner's.
    ensemble : (n,) integer array
        Which of `ensembles` is the case's motion; -1 where it is not to be integrated.
    centre : (n,) array
        Height of the centre of gravity as a share of the piece's [-].
    name : (n,) integer array
        The piece, from `assess.rocking.draws.name_number`: by it what is not known of it is drawn.
    scanned : (n,) boolean array
        Where the sizes were measured by a scan, so that they are less certain.
    slides_under : (n,) integer array
        Which of `ensembles` the slip of the piece is to be found under; -1 where it is not.
    alike : (n,) integer array
        Cases of one number differ in nothing that is computed with: they have one chance.
    quantity : (n,) integer array
        Pieces of the row.
    wall : (n,) integer array
        `NO_WALL`; else the direction along the motion in which a wall at its back leaves it free to turn, 1 or -1; or
        `SIDE_UNKNOWN`.
    dispersion : (n,) array
        Standard deviation of ln amplitude of the floor's motion from one earthquake to the next [-].
    peak : (n,) array
        That of ln of the peaks of its motions over `pfa` [-].
    ensembles : sequence of Ensemble
        Motions of floors.
    uncertainty : Uncertainty
        What is drawn.
    earthquakes : Earthquakes
        By which numbers the draws of an earthquake scale the motions.
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
        given = np.broadcast_arrays(
            *np.atleast_1d(breadth, height, pfa, pfv, friction, restitution, centre, ensemble, name, slides_under, wall,
                           scanned)
        )  # fmt: skip
        b, h, a, v, mu, eta, z = (np.array(values, dtype=np.float64) for values in given[:7])
        which, names = np.array(given[7], dtype=np.intp), np.array(given[8], dtype=np.int64)
        slides, walls = np.array(given[9], dtype=np.intp), np.array(given[10], dtype=np.int8)
        by_scan, drawn = np.array(given[11], dtype=np.bool_), uncertainty or Uncertainty()
        alike, quantity = np.arange(b.size), np.ones(b.size, dtype=np.int64)
        spread, peak = (np.full(b.size, one) for one in (drawn.motion, PEAK))
        return cls(
            b, h, a, v, mu, eta, which, z, names, by_scan, slides, alike, quantity, walls, spread, peak, ensembles,
            drawn,
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

    Parameters
    ----------
    ensemble : int
        Its place in `Cases.ensembles`.
    cases : (m,) integer array
        Places in the batch.
    runs : (m,) integer array
        Motions that each case was integrated under, the first ones.
    fell : (m, k) boolean array
        Whether it overturned in each draw, of the motion and of the piece; False beyond its runs.
    ideal : (m, k) boolean array
        Whether it overturned, as it is given, under each motion itself; False beyond its runs.
    rotation : (m, k) array
        Largest |theta| over the critical angle in each draw [-]; 0 beyond its runs.
    examples : sequence of ((n,) array, float)
        The first three motions [m/s2] and their time steps [s].
    fit : Fit, optional
        How the motions meet their target.
    spectra : Spectra, optional
        Response spectra of the first motions, at most 100, under which a case was integrated, and of their target.
    is_weak : bool
        Whether the motions are weaker than the floor's.
    bands : tuple of two floats, optional
        Factors by which drawn motions were brought to the floor's peaks [-].
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
class Outcome:
    """What a method says of a batch of n cases.

    Parameters
    ----------
    value : (n,) array
        For a probability: the chance of overturning in [0, 1]. For a criterion: 1 met, 0 not met. NaN: not evaluated.
    detail : mapping of name to (n,) array
        What stands beside the value, ``raw`` or a median, under the name it has in results.json.
    flags : mapping of flag to (n,) boolean array
        Where a caution holds; the flag's meaning stands in `Method.flags`.
    joints : sequence of Joint
        What a method that integrates found, motion by motion.
    """

    value: FloatArray
    detail: Mapping[str, NDArray[np.generic]] = field(default_factory=dict)
    flags: Mapping[str, BoolArray] = field(default_factory=dict)
    joints: Sequence[Joint] = ()


Detail = float | str | bool | None
"""One value of `Outcome.detail`; None is unknown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Example:
    """One case that is worked through in a report: sizes [cm], peaks [cm/s2] and [cm/s], NaN where unknown.

    `value`, `detail` and `flags` are what the method found; `restitution` is the building's own [-], NaN for Housner's;
    `centre` is the height of the centre of gravity as a share of the piece's [-].
    """

    breadth: float
    height: float
    pfa: float
    pfv: float
    restitution: float
    settings: Settings
    value: float
    detail: Mapping[str, Detail]
    flags: Collection[str]
    centre: float = MIDDLE

    def number(self, name: str) -> float:
        """Return a number of `detail`; NaN where it is unknown."""
        value = self.detail[name]
        return math.nan if value is None else float(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveCells:
    """What a live formula may read, as operands that accept operators and numpy functions.

    `parameters` are the method's own, by setting. A `pfv_cm_s` that is no number is unknown (`numpy.isnan`).
    """

    breadth_to_height: Any
    height_cm: Any
    pfa_g: Any
    pfv_cm_s: Any
    parameters: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Method(MethodInfo):
    """One method: what it says of itself, and the functions that evaluate it.

    Parameters
    ----------
    evaluate : callable
        ``evaluate(cases, settings) -> Outcome``; inputs are left untouched. That of the simulation takes the keyword
        arguments ``threads: int = 1`` and ``stage: Stage | None = None`` as well, of which each ensemble is a part.
    steps : callable, optional
        ``steps(example) -> sequence of texts``: the calculation for one piece, with its numbers. A step that computes
        reads ``symbol = numbers = result [unit]``, so that a reader with a calculator finds the result again. Each is
        passed through `assess.i18n.gettext` where it is shown.
    live : callable, optional
        ``live(cells) -> mapping``: the expression of "value", and of columns, from `LiveCells`.
    """

    evaluate: Callable[..., Outcome]
    steps: Callable[[Example], Sequence[str]] | None = None
    live: Callable[[LiveCells], Mapping[str, Any]] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "is_live", self.live is not None)

    @property
    def info(self) -> MethodInfo:
        """The method without its functions: it can be pickled."""
        return MethodInfo(**{one.name: getattr(self, one.name) for one in fields(MethodInfo)})


def _normal_cdf(x: float) -> float:
    return 0.5 * math.erfc(-x / math.sqrt(2))


NORMAL_CDF = np.frompyfunc(_normal_cdf, 1, 1)
"""Standard normal distribution function as a numpy function; `normal_cdf` gives floats."""


def normal_cdf(x: Any) -> Any:
    """Standard normal distribution function of `x` [-], accurate in both tails; NaN stays NaN."""
    found = NORMAL_CDF(x)
    return np.asarray(found, dtype=np.float64) if isinstance(found, (float, np.ndarray)) else found
