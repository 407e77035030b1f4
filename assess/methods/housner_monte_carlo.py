"""Housner Monte Carlo (key ``housner_monte_carlo``): the rocking of each piece, integrated under many motions.

Reference
---------
Sections 2.1 and 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas", equations (1) to (4); the block
is Housner's (1963).

Equations
---------
theta'' = -p2 [sin(alpha sgn theta - theta) + (a_g/g) cos(alpha sgn theta - theta)]; risk = overturned / N, with its
Wilson interval.

Validity
--------
Rigid, free-standing pieces that neither slide nor bounce, with B/H below 1.41, in plane motion.

Departures
----------
N is 200 by default; the paper's is 100, of which none fallen cannot show "low". With N "auto", the interval is that of
six looks. What the piece does under the recorded motion itself is found too.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, Cases, Ensemble, FloatArray, Joint, Method, Motions, Outcome, Reference
from assess.risk import NORMAL_95, classify_all, wilson_interval
from assess.rocking.block import STOCKY
from assess.settings import AUTO, Settings

LOOKS = (125, 250, 500, 1000, 2500, 5000)
"""Numbers of motions at which "auto" looks whether the interval of a piece lies within one class."""
LOOKS_Z = 2.64
"""Half width of the intervals of "auto" [-]: 95 % for all six looks together (Bonferroni, 0.83 % each)."""
BATCH = 500
"""Motions made at once."""
MOST_PAIRS = 2_000_000
"""Pairs of case and motion that are rocked at once; they take some 70 bytes each."""
SHOWN = 3
"""Motions kept for reports."""

_Result = TypeVar("_Result")
Tell = Callable[[str, int, float], None]
"""Called with "motions", "rocking" or "done", the number of the ensemble, and the share of it that is done [-]."""


def interval_width(settings: Settings) -> float:
    """Return z, the half width of the intervals in standard deviations [-]."""
    return LOOKS_Z if settings.runs == AUTO else NORMAL_95


def evaluate(cases: Cases, settings: Settings, *, threads: int = 1, tell: Tell | None = None) -> Outcome:
    """Integrate the cases that have an ensemble; the others have no value."""
    known = (cases.ensemble >= 0) & (cases.breadth_to_height < STOCKY)
    found = _Found.empty(cases.breadth.size)
    owns = [(number, np.flatnonzero(known & (cases.ensemble == number))) for number in range(len(cases.ensembles))]
    owns = [(number, own) for number, own in owns if own.size]
    side_by_side = min(threads, len(owns))

    def work(number: int, own: NDArray[np.intp]) -> tuple[Joint, tuple[FloatArray, FloatArray]]:
        inner, ensemble = max(1, threads // side_by_side), cases.ensembles[number]
        joint = _integrate(cases, own, number, ensemble, settings, inner, tell or _say_nothing)
        return joint, _under_record(cases, own, ensemble, inner)

    joints = []
    for joint, record in run_side_by_side(work, owns, side_by_side):
        found.take(joint, record, cases.ensembles[joint.ensemble])
        joints.append(joint)
    return _summarise(found, cases, settings, joints)


def _summarise(found: "_Found", cases: Cases, settings: Settings, joints: list[Joint]) -> Outcome:
    done, runs = found.runs > 0, np.maximum(found.runs, 1)
    low, high = (
        np.where(done, end, np.nan) for end in wilson_interval(found.overturned, runs, interval_width(settings))
    )
    detail = {
        "runs": np.where(done, runs, np.nan),
        "overturned": np.where(done, found.overturned, np.nan),
        "low": low,
        "high": high,
        "record_overturned": found.record_fell,
        "record_rotation": found.record_rotation,
    }
    flags = {
        "fell_in_record": found.record_fell == 1,
        "generic_spectrum": found.generic,
        "weak_motions": found.weak,
        "undecided": done & (settings.runs == AUTO) & (classify_all(low) != classify_all(high)),
        "does_not_rock": cases.breadth_to_height >= STOCKY,
    }
    return Outcome(np.where(done, found.overturned / runs, np.nan), detail, flags, tuple(joints))


def run_side_by_side(work: Callable[..., _Result], tasks: list[Any], threads: int) -> Iterator[_Result]:
    """Yield the results of `work` in the order of `tasks`, several of which are worked on at once.

    Never in the thread that called: a Ctrl-C that meets a compilation there would be lost.
    """
    if not tasks:
        return
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(threads)
    try:
        yield from [future.result() for future in [pool.submit(work, *task) for task in tasks]]
    finally:
        pool.shutdown(wait=False, cancel_futures=True)  # after Ctrl-C nobody waits for what is left


def _say_nothing(what: str, number: int, share: float) -> None:
    """Keep to oneself how far it is."""


@dataclass(slots=True)
class _Found:
    """What was found, case by case."""

    runs: NDArray[np.int64]
    overturned: NDArray[np.int64]
    record_fell: FloatArray
    record_rotation: FloatArray
    generic: BoolArray
    weak: BoolArray

    @classmethod
    def empty(cls, count: int) -> "_Found":
        numbers, unknown, no = np.zeros(count, dtype=np.int64), np.full(count, np.nan), np.zeros(count, dtype=np.bool_)
        return cls(numbers, numbers.copy(), unknown, unknown.copy(), no, no.copy())

    def take(self, joint: Joint, record: tuple[FloatArray, FloatArray], ensemble: Ensemble) -> None:
        self.runs[joint.cases], self.overturned[joint.cases] = joint.runs, joint.fell.sum(axis=1)
        self.record_fell[joint.cases], self.record_rotation[joint.cases] = record
        self.generic[joint.cases], self.weak[joint.cases] = ensemble.is_generic, ensemble.is_weak


def _integrate(
    cases: Cases, own: NDArray[np.intp], number: int, ensemble: Ensemble, settings: Settings, threads: int, tell: Tell
) -> Joint:
    """Integrate the cases `own` under one ensemble, look by look; those that are decided leave."""
    tell("motions", number, 0.0)
    motions = ensemble.open(threads)
    looks = LOOKS if settings.runs == AUTO else (int(settings.runs),)
    fell, rotation = np.zeros((own.size, 0), np.bool_), np.zeros((own.size, 0), np.float32)
    size = min(BATCH, max(1, MOST_PAIRS // own.size))
    runs, going = np.zeros(own.size, dtype=np.int64), np.arange(own.size)
    for first, last in zip((0, *looks), looks, strict=False):
        wider = ((0, 0), (0, last - first))
        fell, rotation = np.pad(fell, wider), np.pad(rotation, wider)
        for at, batch, time_step in make_batches(motions, first, last, size):
            tell("rocking", number, at / looks[-1])
            one = rock_cases(cases, own[going], batch, time_step, threads)
            fell[going, at : at + len(batch)], rotation[going, at : at + len(batch)] = one
            tell("motions", number, (at + len(batch)) / looks[-1])
        runs[going] = last
        going = going[_is_open(fell[going], settings)]
        if not going.size:
            break
    tell("done", number, 1.0)
    return Joint(
        ensemble=number, cases=own, runs=runs, fell=fell, rotation=rotation,
        examples=_examples(motions, fell.shape[1]), fit=motions.fit,
        spectra=motions.spectra and motions.spectra.first(fell.shape[1]),
    )  # fmt: skip


def make_batches(motions: Motions, first: int, last: int, size: int) -> Iterator[tuple[int, FloatArray, float]]:
    """Yield motions `first` to `last` - 1: the number of the first of a batch, the batch, its time step."""
    at = first
    for start in range(first, last, size):
        for batch, time_step in motions.realise(start, min(size, last - start)):
            yield at, batch, time_step
            at += len(batch)


def _examples(motions: Motions, count: int) -> list[tuple[NDArray[np.float32], float]]:
    batches = motions.realise(0, min(SHOWN, count))
    return [(one.astype(np.float32), time_step) for batch, time_step in batches for one in batch]


def _is_open(fell: BoolArray, settings: Settings) -> BoolArray:
    """Tell which cases' intervals reach over more than one class."""
    low, high = wilson_interval(fell.sum(axis=1), fell.shape[1], interval_width(settings))
    return np.asarray(classify_all(low) != classify_all(high), dtype=np.bool_)


def rock_cases(
    cases: Cases, own: NDArray[np.intp], motions: FloatArray, time_step: float, threads: int
) -> tuple[BoolArray, FloatArray]:
    """Return whether each of the cases `own` overturns under each motion, and how far it turns: (m, k) each."""
    from assess.rocking.ensemble import rock_blocks

    found = rock_blocks(
        cases.breadth[own], cases.height[own], motions, time_step, restitution=cases.restitution[own], threads=threads
    )
    return found.overturned, found.rotation


def _under_record(
    cases: Cases, own: NDArray[np.intp], ensemble: Ensemble, threads: int
) -> tuple[FloatArray, FloatArray]:
    """Return whether each case overturns under the recorded motion itself, and how far it turns; NaN without one."""
    if ensemble.record is None:
        return np.full(own.size, np.nan), np.full(own.size, np.nan)
    motion, time_step = ensemble.record
    fell, rotation = rock_cases(cases, own, motion[np.newaxis], time_step, threads)
    return fell[:, 0].astype(np.float64), rotation[:, 0]


METHOD = Method(
    key="housner_monte_carlo",
    title="Housner Monte Carlo",
    kind="probability",
    order=70,
    predicts="The chance that a free-standing piece overturns, from its rocking integrated under many motions that are "
    "compatible with the floor's response spectrum.",
    reference=Reference(
        authors="Housner G",
        year="1963",
        title="The behavior of inverted pendulum structures during earthquakes",
        source="Bulletin of the Seismological Society of America 53(2):403-417",
        remark='The Monte Carlo is section 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas".',
    ),
    needs=frozenset({"breadth", "height", "ensemble"}),
    evaluate=evaluate,
    tier="verification",
    equations=(
        "I₀·θ″ + m·g·r·sin(-α - θ) = -m·a_g·r·cos(-α - θ), θ < 0   (1)",
        "I₀·θ″ + m·g·r·sin(α - θ) = -m·a_g·r·cos(α - θ), θ > 0   (2), I₀ = (4/3)·m·r², tan α = B/H, r = ½·√(B² + H²)",
        "θ″ = -p²·[sin(α·sgn θ - θ) + (a_g/g)·cos(α·sgn θ - θ)]   (3)",
        "p = √(3g/4r)   (4)",
        "Rocking starts where |a_g|/g > B/H",
        "After an impact: θ′ = (1 - 1.5·sin²α) · θ′ before; overturned: |θ| ≥ π/2",
        "Risk = overturned / N; interval: (R + z²/2N ± z·√(R(1 - R)/N + z²/4N²)) / (1 + z²/N)",
    ),
    assumptions=(
        "The piece is rigid and free-standing, its centroid at mid-height; it neither slides nor bounces, and moves in "
        "one plane; vertical motion is left out.",
        "Motions are linear between samples. A block at rest can start again. After the end of a motion it is followed "
        "until it can no longer fall.",
        "The interval is Wilson's, 95 % (z = 1.96): it covers the number of motions only, not the model, the floor "
        "motion or the earthquake.",
        'With N "auto", motions are added at 125, 250, 500, 1,000, 2,500 and 5,000, and a piece is done once its '
        "interval (z = 2.64: 95 % for all six looks together) lies within one class.",
    ),
    departures=(
        'N is 200 by default; the paper\'s is 100. None of 100 fallen cannot show "low": the interval then reaches to '
        "0.037.",
        "What the piece does under the recorded motion itself is found as well: one that overturns there is at least "
        "high.",
    ),
    flags={
        "fell_in_record": "it overturns under the recorded motion itself, so its class is at least high",
        "generic_spectrum": "the motions of this floor were made for a generic spectrum: verification may raise a "
        "class, never lower it",
        "weak_motions": "the user's own motions are weaker than the floor's: verification may raise a class, never "
        "lower it",
        "undecided": "after 5,000 motions its interval still reaches over more than one class",
        "does_not_rock": "B/H is 1.41 or more: too stocky to rock, direct integration and FEMA P-58 do not apply",
    },
)
