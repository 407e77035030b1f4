"""Motions for the tests of methods that integrate: made up, in memory, the same however they are asked for."""

from collections.abc import Hashable
from dataclasses import dataclass, field

import numpy as np

from assess.arrays import FloatArray
from assess.methods import Motions
from assess.motion.target_fit import Fit, Spectra
from assess.progress import SILENT, Progress

STEP = 0.01
SAMPLES = 300


def make_motion(seed: int, number: int, peak: float = 6.0) -> FloatArray:
    """Return motion `number` of an ensemble [m/s2]: a pulse of a random period and phase that fades away."""
    random = np.random.default_rng((seed, number))
    time = np.arange(SAMPLES) * STEP
    wave = np.sin(2 * np.pi * (time / random.uniform(0.4, 1.6) + random.random()))
    return np.asarray(peak * random.random() * wave * np.exp(-time / 1.5))


@dataclass(frozen=True, slots=True, eq=False)
class MadeUp:
    """An ensemble; `asked` lists what was asked for: (first, count)."""

    seed: int
    is_assumed: bool = False
    is_unknown: bool = False
    is_weak: bool = False
    has_record: bool = False
    signs: tuple[int, ...] | None = None
    fit: Fit | None = None
    spectra: Spectra | None = None
    bands: tuple[float, float] | None = None
    asked: list[tuple[int, int]] = field(default_factory=list)
    opened: list[int] = field(default_factory=list)

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion, and its time step."""
        return (make_motion(self.seed, 10**6), STEP) if self.has_record else None

    @property
    def key(self) -> Hashable:
        """All that the motions depend on."""
        return self.seed, self.has_record

    def open(self, threads: int, progress: Progress = SILENT) -> Motions:
        """Note with how many threads."""
        self.opened.append(threads)
        return Motions(self.realise, self.fit, self.spectra, self.is_weak, self.bands)

    def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
        """Return motions in one batch."""
        self.asked.append((first, count))
        return [(np.stack([make_motion(self.seed, number) for number in range(first, first + count)]), STEP)]
