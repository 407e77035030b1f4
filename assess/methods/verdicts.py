"""What simulated pieces did, kept from one assessment to the next: only what has changed is rocked again.

Draw k is motion k, one scale from the seed and k, and one body from the seed, the piece and k. So what a case did in
every draw depends on the motions of its floor and on the piece alone, not on the other pieces, nor on their order. It
is kept under what it is computed from; the chance, which pieces that are alike share, is formed anew each time.
"""

import threading
from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods.cases import Cases
from assess.methods.simulate import make_batches, rock_cases, rock_draws
from assess.progress import SILENT, Progress
from assess.settings import Settings

MOST = 96_000_000
"""Bytes that are kept: a case takes some 300 with 200 draws."""
OF_A_CASE = 250
"""Bytes that a case takes beside its draws."""
BATCH = 100
"""Motions that are rocked under at once."""


@dataclass(slots=True)
class _Kept:
    """What the cases under one ensemble did: a row each of the draws in which they fell, as bits."""

    places: dict[bytes, int] = field(default_factory=dict)
    fell: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 0), np.uint8))
    ideal: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 0), np.uint8))
    record: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    speeds: FloatArray | None = None
    is_weak: bool = False

    @property
    def nbytes(self) -> int:
        """Bytes."""
        return self.fell.nbytes + self.ideal.nbytes + OF_A_CASE * len(self.places)


@dataclass(frozen=True, slots=True, eq=False)
class Recalled:
    """What m cases did under one ensemble.

    * `fell`, `ideal` (m, runs): whether each overturned in each draw; as given, under each motion as it is.
    * `record` (m, 2): whether it overturned under the record itself, and how far it turned; NaN without a record.
    * `speeds` (runs,): PFV/PFA of drawn motions [s]; None of others.
    * `is_weak`: whether the motions are weaker than the floor's.
    """

    fell: BoolArray
    ideal: BoolArray
    record: FloatArray
    speeds: FloatArray | None
    is_weak: bool


class Verdicts:
    """The verdicts of a session, for a fixed number of draws; all methods may be called from any thread."""

    def __init__(self, most: int = MOST) -> None:
        self._most, self._lock = most, threading.RLock()
        self._kept: OrderedDict[Hashable, _Kept] = OrderedDict()

    def find_known(self, cases: Cases, settings: Settings) -> BoolArray:
        """Return which cases (n,) with an ensemble are known."""
        found = np.zeros(cases.breadth.size, dtype=np.bool_)
        names = _name(cases)
        with self._lock:
            for number in np.unique(cases.ensemble[cases.ensemble >= 0]).tolist():
                own = np.flatnonzero(cases.ensemble == number)
                places = self._find(cases, number, settings).places
                found[own] = [name in places for name in names[own].tolist()]
        return found

    def recall(self, cases: Cases, number: int, own: NDArray[np.intp], settings: Settings) -> Recalled:
        """Return what the cases `own` did under an ensemble; KeyError if one of them is not known."""
        runs = int(settings.runs)
        with self._lock:
            kept = self._find(cases, number, settings)
            rows = [kept.places[name] for name in _name(cases)[own].tolist()]
            fell, ideal = (
                np.unpackbits(one[rows], axis=1, count=runs).astype(np.bool_) for one in (kept.fell, kept.ideal)
            )
            return Recalled(fell, ideal, kept.record[rows], kept.speeds, kept.is_weak)

    def rock(
        self, cases: Cases, own: NDArray[np.intp], settings: Settings, *, threads: int = 1, progress: Progress = SILENT
    ) -> None:
        """Rock cases, under the ensemble of each, and keep what they did; CancelledError keeps nothing of them."""
        from assess.motion.target_fit import measure_peaks

        runs = int(settings.runs)
        for number in np.unique(cases.ensemble[own]).tolist():
            here, ensemble = own[cases.ensemble[own] == number], cases.ensembles[number]
            motions = ensemble.open(threads, progress)
            fell, ideal = (np.zeros((here.size, runs), np.bool_) for _ in range(2))
            speeds, record = [], np.full((here.size, 2), np.nan)
            for at, batch, time_step in make_batches(motions, 0, runs, BATCH):
                draws = slice(at, at + len(batch))
                fell[:, draws] = rock_draws(
                    cases, here, batch, time_step, first=at, dispersions=(cases.dispersion[here],), seed=settings.seed,
                    threads=threads, progress=progress,
                )[0][0]  # fmt: skip
                if ensemble.is_assumed:
                    pfa, pfv = measure_peaks(batch, time_step).T
                    speeds.append(np.asarray(pfv / pfa))
                if settings.ideal or not ensemble.is_assumed:
                    ideal[:, draws], _ = rock_cases(cases, here, batch, time_step, threads, progress)
            if ensemble.record is not None:
                motion, time_step = ensemble.record
                turned = rock_cases(cases, here, motion[np.newaxis], time_step, threads, progress)
                record = np.column_stack([one[:, 0] for one in turned])
            with self._lock:
                kept = self._find(cases, number, settings)
                names, first = _name(cases)[here].tolist(), len(kept.record)
                kept.places |= {name: first + row for row, name in enumerate(names)}
                packed = [np.packbits(one, axis=1) for one in (fell, ideal)]
                kept.fell, kept.ideal = (
                    np.concatenate([old.reshape(first, new.shape[1]), new])
                    for old, new in zip((kept.fell, kept.ideal), packed, strict=True)
                )
                kept.record = np.concatenate([kept.record, record])
                kept.speeds, kept.is_weak = np.concatenate(speeds) if speeds else None, motions.is_weak
                while len(self._kept) > 1 and sum(one.nbytes for one in self._kept.values()) > self._most:
                    self._kept.popitem(last=False)

    def _find(self, cases: Cases, number: int, settings: Settings) -> _Kept:
        """Return what is kept of the cases under one ensemble; that which was asked for last is dropped last."""
        of = cases.ensembles[number].key, cases.earthquakes, cases.uncertainty, settings.seed, settings.runs
        key = (*of, settings.ideal)
        self._kept.setdefault(key, _Kept())
        self._kept.move_to_end(key)
        return self._kept[key]


def _name(cases: Cases) -> NDArray[np.void]:
    """Return all that tells each case from the others under its ensemble, (n,), as bytes."""
    numbers = cases.breadth, cases.height, cases.centre, cases.restitution, cases.dispersion, cases.scanned
    rows = np.column_stack([*(one.astype(np.float64) for one in numbers), cases.name.view(np.float64)])
    rows = np.ascontiguousarray(rows)
    return rows.view(f"V{rows.shape[1] * rows.itemsize}").ravel()
