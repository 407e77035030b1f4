"""What a method is: one published way to tell whether a piece of furniture overturns."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.settings import Settings
from assess.units import ROUNDING

if TYPE_CHECKING:
    from assess.motion.fit import Fit, Spectra

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

ALIKE = 9
"""Decimals to which two PFA [g] or two probabilities are held against each other when one of them has to govern."""
DECIMALS = 3
"""Of the errors of fitted models, as they are shown."""


class Ensemble(Protocol):
    """The motions of one floor along one axis, for methods that integrate; they are made when asked for."""

    @property
    def is_generic(self) -> bool:
        """Whether its spectrum is a generic one, of a floor of which only peaks are known."""
        ...

    @property
    def is_weak(self) -> bool:
        """Whether its motions are known to be weaker than the floor's."""
        ...

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion (n,) [m/s2] and its time step [s], where one is known."""
        ...

    def open(self, threads: int) -> "Motions":
        """Prepare the motions; what that takes is given back when the result is dropped."""
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

    def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
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
    pfv_estimated : (n,) boolean array
        Where `pfv` was estimated from PFA and the building's period.
    restitution : (n,) array
        Angular velocity after an impact over that before it [-]; NaN is Housner's.
    ensemble : (n,) integer array
        Which of `ensembles` is the case's motion; -1 where it is not to be integrated.
    ensembles : sequence of Ensemble
        Motions of floors.
    """

    breadth: FloatArray
    height: FloatArray
    pfa: FloatArray
    pfv: FloatArray
    friction: FloatArray
    pfv_estimated: BoolArray
    restitution: FloatArray
    ensemble: NDArray[np.intp]
    ensembles: Sequence[Ensemble] = ()

    @classmethod
    def of(
        cls,
        *,
        breadth: ArrayLike,
        height: ArrayLike,
        pfa: ArrayLike = math.nan,
        pfv: ArrayLike = math.nan,
        friction: ArrayLike = math.nan,
        pfv_estimated: ArrayLike = False,
        restitution: ArrayLike = math.nan,
        ensemble: ArrayLike = -1,
        ensembles: Sequence[Ensemble] = (),
    ) -> Self:
        """Build a batch from numbers and arrays, brought to one length; what is left out is unknown."""
        given = np.broadcast_arrays(
            *np.atleast_1d(breadth, height, pfa, pfv, friction, restitution, pfv_estimated, ensemble)
        )
        b, h, a, v, mu, eta = (np.array(values, dtype=np.float64) for values in given[:6])
        estimated, which = np.array(given[6], dtype=np.bool_), np.array(given[7], dtype=np.intp)
        return cls(b, h, a, v, mu, estimated, eta, which, ensembles)

    @property
    def breadth_to_height(self) -> FloatArray:
        """B/H [-]."""
        return self.breadth / self.height


@dataclass(frozen=True, slots=True)
class Range:
    """Where a method has been checked: both ends belong to it. `unit` is how the ends are written."""

    low: float
    high: float
    unit: str = ""

    def holds(self, values: FloatArray) -> BoolArray:
        """Tell for each of `values` (in this range's own unit) whether it lies inside; NaN does not."""
        above, below = values >= self.low * (1 - ROUNDING), values <= self.high * (1 + ROUNDING)
        return np.asarray(above & below, dtype=np.bool_)


@dataclass(frozen=True, slots=True)
class Reference:
    """The publication: who, when, what and where; `doi` where one is known.

    `remark` is what is not bibliographic, in sentences: the place in the publication, or how it came to be known.
    Reports translate it; the rest stands as the publication has it.
    """

    authors: str
    year: str
    title: str
    source: str
    doi: str = ""
    remark: str = ""

    @property
    def bibliographic(self) -> str:
        """The reference without its remark: the same in every language."""
        year = f" ({self.year})" if self.year else ""
        lead = f"{self.authors}{year}. " if self.authors else ""
        source = f" {self.source}." if self.source else ""
        return f"{lead}{self.title}.{source}" + (f" doi:{self.doi}" if self.doi else "")

    def __str__(self) -> str:
        return f"{self.bibliographic} {self.remark}".strip()


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
        Whether it overturned; False beyond its runs.
    rotation : (m, k) array
        Largest |theta| over the critical angle [-]; 0 beyond its runs.
    examples : sequence of ((n,) array, float)
        The first three motions [m/s2] and their time steps [s].
    fit : Fit, optional
        How the motions meet their target.
    spectra : Spectra, optional
        Response spectra of the first motions, at most 100, under which a case was integrated, and of their target.
    """

    ensemble: int
    cases: NDArray[np.intp]
    runs: NDArray[np.int64]
    fell: BoolArray
    rotation: NDArray[np.float32]
    examples: Sequence[tuple[NDArray[np.float32], float]]
    fit: "Fit | None"
    spectra: "Spectra | None" = None


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


@dataclass(frozen=True, slots=True, kw_only=True)
class FittedOn:
    """What a model was fitted on, in words, and its root mean square errors where a building is left out [-].

    `spread` is the standard error of `error`; `constant` is the error of a constant, the mean chance of the others.
    """

    data: str
    error: float
    spread: float
    constant: float

    @property
    def is_no_better(self) -> bool:
        """Whether a constant does as well, to the decimals that are shown."""
        return round(self.error, DECIMALS) >= round(self.constant, DECIMALS)


@dataclass(frozen=True, slots=True)
class Method:
    """One method: what it is called, needs and assumes, and the function that evaluates it.

    Parameters
    ----------
    key, title : str
        Name in results.json and in reports.
    kind : "probability" or "criterion"
        A probability has a class; a criterion is met or not met.
    order : int
        Place in reports.
    predicts : str
        One sentence: what a reader learns from it.
    reference : Reference
        The publication.
    needs : frozenset of str
        Fields of `Cases` it cannot do without.
    valid : mapping of str to Range
        Where it has been checked, by quantity.
    equations, assumptions, departures : tuple of str
        In the symbols of the publication; for the methods appendix.
    flags : mapping of flag to str
        Every flag it can raise, and what that means.
    words : pair of str
        A criterion's outcome in words: met, not met.
    tier : "screening" or "verification"
        Whether it tells at once for every case, or integrates those that have an ensemble.
    evaluate : callable
        ``evaluate(cases, settings) -> Outcome``; inputs are left untouched.
    fitted : FittedOn, optional
        Of a model that a study fitted; None of a published method.
    """

    key: str
    title: str
    kind: Literal["probability", "criterion"]
    order: int
    predicts: str
    reference: Reference
    needs: frozenset[str]
    evaluate: Callable[[Cases, Settings], Outcome]
    valid: Mapping[str, Range] = field(default_factory=dict)
    equations: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    departures: tuple[str, ...] = ()
    flags: Mapping[str, str] = field(default_factory=dict)
    words: tuple[str, str] = ("", "")
    tier: Literal["screening", "verification"] = "screening"
    fitted: FittedOn | None = None


_erfc = np.frompyfunc(math.erfc, 1, 1)


def normal_cdf(x: FloatArray) -> FloatArray:
    """Standard normal distribution function of `x` [-], accurate in both tails; NaN stays NaN."""
    return np.asarray(0.5 * np.asarray(_erfc(-x / math.sqrt(2)), dtype=np.float64))
