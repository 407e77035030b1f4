"""One piece under one motion: what every method says of it, and the risk adopted, read from the arrays of a batch."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from numpy.typing import NDArray

from assess.adoption import FORMULA, VERIFICATION, Adoption
from assess.demand import Demand
from assess.methods import Method, Outcome
from assess.methods.housner_monte_carlo import METHOD as HOUSNER
from assess.risk import RiskClass

Detail = float | str | bool | None


@dataclass(frozen=True, slots=True)
class MethodResult:
    """What one method says of one case; `value` is None where it was not evaluated."""

    value: float | None
    detail: Mapping[str, Detail]
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class VerificationResult:
    """What direct integration found of one case.

    Parameters
    ----------
    runs, overturned : int
        Motions, and those under which it overturned.
    probability, low, high : float
        Their ratio and its interval [-].
    record_overturned, record_rotation : bool, float, optional
        Whether it overturns under the recorded motion itself, and the largest |theta| over the critical angle there
        [-]; None where no record is known.
    """

    runs: int
    overturned: int
    probability: float
    low: float
    high: float
    record_overturned: bool | None
    record_rotation: float | None


@dataclass(frozen=True, slots=True)
class Adopted:
    """The risk that the report goes by.

    `low` and `high` bound the interval of a verified risk, and are None where the formula's is adopted. `upper` is the
    class by the upper bound. `lowered_from` is the class by formula where verification lowered it. Verification may not
    lower the class of a doubtful one.
    """

    method: str
    probability: float
    low: float | None
    high: float | None
    risk: RiskClass
    upper: RiskClass
    lowered_from: RiskClass | None
    is_doubtful: bool
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CaseResult:
    """One piece under one motion: the demand, every method's result by key, and the verification where one ran."""

    demand: Demand
    methods: Mapping[str, MethodResult]
    verification: VerificationResult | None
    adopted: Adopted


FLAGS: Mapping[str, str] = {
    "does_not_rock": HOUSNER.flags["does_not_rock"],
    "slides": "friction is below B/H: it slides before it rocks, which no method here counts",
    **{flag: HOUSNER.flags[flag] for flag in ("fell_in_record", "generic_spectrum", "weak_motions", "undecided")},
    "not_lowered": "verification gave a lower class, which is not adopted: the floor's spectrum is generic, its PFV an "
    "estimate, or the motions are weaker than the floor's",
}
"""Meanings of the flags that belong to a piece rather than to one method."""


class CaseReader:
    """Reads a batch case by case, from lists: indexing arrays one by one is slow."""

    def __init__(
        self,
        demands: Sequence[Demand],
        methods: Sequence[Method],
        outcomes: Mapping[str, Outcome],
        adoption: Adoption,
    ) -> None:
        self._demands = demands
        self._methods = {method.key: _MethodReader(outcomes[method.key], method) for method in methods}
        self._verification = _VerificationReader(outcomes[VERIFICATION])
        self._adopted = {field.name: _known(getattr(adoption, field.name)) for field in fields(adoption)}

    def __call__(self, case: int) -> CaseResult:
        """Return the result of one case."""
        methods = {key: result(case) for key, result in self._methods.items()}
        demand, has_run = self._demands[case], methods[VERIFICATION].value is not None
        adopted = _adopt(self._adopted, case, methods, demand)
        return CaseResult(demand, methods, self._verification(case) if has_run else None, adopted)


class _MethodReader:
    """Reads one method's outcome."""

    def __init__(self, outcome: Outcome, method: Method) -> None:
        detail = outcome.detail if method.tier == "screening" else {}  # a verification has its own reader
        self.values = _known(outcome.value)
        self.detail = {name: _known(array) for name, array in detail.items()}
        self.flags = {flag: array.tolist() for flag, array in outcome.flags.items() if array.any()}

    def __call__(self, case: int) -> MethodResult:
        return MethodResult(
            self.values[case],
            {name: values[case] for name, values in self.detail.items()},
            tuple([flag for flag, raised in self.flags.items() if raised[case]]),
        )


class _VerificationReader:
    """Reads what the verification found."""

    def __init__(self, outcome: Outcome) -> None:
        self.values = _known(outcome.value)
        self.detail = {name: _known(array) for name, array in outcome.detail.items()}

    def __call__(self, case: int) -> VerificationResult:
        found = {name: values[case] for name, values in self.detail.items()}
        fell = found["record_overturned"]
        return VerificationResult(
            int(found["runs"]), int(found["overturned"]), self.values[case], found["low"], found["high"],
            None if fell is None else bool(fell), found["record_rotation"],
        )  # fmt: skip


def _known(array: NDArray[Any]) -> list[Any]:
    """Return an array as a list, None in place of NaN; words pass through."""
    return [None if value != value else value for value in array.tolist()]


def _adopt(adopted: Mapping[str, list[Any]], case: int, methods: Mapping[str, MethodResult], demand: Demand) -> Adopted:
    if adopted["probability"][case] is None:
        raise ValueError("the proposed OR formula gave no value")
    piece = [flag for flag in FLAGS if any(flag in method.flags for method in methods.values())]
    piece += ["not_lowered"] if adopted["not_lowered"][case] else []
    return Adopted(
        method=VERIFICATION if adopted["verified"][case] else FORMULA,
        probability=adopted["probability"][case],
        low=adopted["low"][case],
        high=adopted["high"][case],
        risk=RiskClass(adopted["risk"][case]),
        upper=RiskClass(adopted["upper"][case]),
        lowered_from=None,
        is_doubtful=adopted["doubtful"][case],
        flags=tuple(dict.fromkeys((*methods[FORMULA].flags, *demand.flags, *piece))),
    )
