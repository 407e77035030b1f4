"""White noise in octaves, each at a sampling rate of its own, and its transforms under the envelopes of a floor.

The noise of a realisation comes from (seed, axis, number) only: it is drawn once for all floors of a building along an
axis, and kept while there is room. Where the signs of floors are known (`assess.motion.floor_signs`), the phases of a
floor are turned by them before anything else is done to the noise.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray, Single
from assess.compiled import compiled
from assess.motion.floor_signs import turn_phases
from assess.motion.kept import Kept
from assess.motion.rows import GROUP
from assess.motion.target import PAD, STRETCH, Envelopes, Grid, octaves, split
from assess.progress import Progress

Transforms = NDArray[np.complex64]

DEEPEST = 64
"""The lowest octaves are made of every 64th sample."""
ROOM = 3.9
"""The Nyquist frequency of an octave's own rate over its centre at least [-]: its weight ends at 2, and its envelope
widens it."""
PHASES = 4096
"""Random phases are multiples of a turn over this number."""
_AXES = {"X": 0, "Y": 1}


@dataclass(frozen=True, slots=True)
class Phases:
    """The samples of motions, and what draws their phases; those of (seed, axis) are the same on all floors.

    * `seed`: 0 or above. Phases and durations come from (seed, axis, number of the realisation) only.
    * `axis`: "X" or "Y", or KeyError: each axis has its own phases.
    * `signs` (b,): of a floor, 1 or -1 by octave, from `assess.motion.floor_signs.find_signs`, by which its phases are
      turned; None where they turn nothing.
    """

    grid: Grid
    seed: int
    axis: str
    signs: tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        _AXES[self.axis]
        if self.signs is not None and min(self.signs) > 0:
            object.__setattr__(self, "signs", None)


@dataclass(frozen=True, slots=True, eq=False)
class Rates:
    """How noise is made on a grid.

    * `length`: samples of the transforms: those of the grid and zeros, so that what is filtered does not come round.
    * `frequencies` (f,): of the transforms [Hz].
    * `weights` (b, f): of each octave [-].
    * `depths`: each octave is made of every such sample.
    """

    length: int
    frequencies: FloatArray
    weights: Single
    depths: tuple[int, ...]


@lru_cache(maxsize=4)
def find_rates(grid: Grid) -> Rates:
    """Return how noise is made on a grid."""
    from scipy.fft import next_fast_len

    length = DEEPEST * next_fast_len(math.ceil((grid.count + PAD / grid.time_step) / DEEPEST), real=True)
    frequencies = np.asarray(np.fft.rfftfreq(length, grid.time_step), np.float64)
    widest = np.log2(0.5 / grid.time_step / ROOM / octaves())
    depths = [int(2**depth) for depth in np.clip(np.floor(widest), 0, math.log2(DEEPEST))]
    depths[-1] = 1  # it has all higher frequencies
    return Rates(length, frequencies, split(frequencies, octaves()).astype(np.float32), tuple(depths))


@dataclass(frozen=True, slots=True, eq=False)
class Bands:
    """The noise of a group: the stretch of each motion's time [-], (GROUP,), and the octaves at their own rates."""

    stretches: FloatArray
    octaves: tuple[Single, ...]

    @property
    def nbytes(self) -> int:
        """Bytes."""
        return sum(band.nbytes for band in self.octaves)


KEPT: Kept[Bands] = Kept(96_000_000)
"""Noise for further floors: 200 motions of 12,000 samples on two axes are 55 million bytes."""


def draw_bands(phases: Phases, group: int, progress: Progress) -> Bands:
    """Return the white noise of a group of realisations, and how the time of each motion is stretched."""
    return KEPT.find_or_make((phases, group), lambda: _draw(phases, group, progress), progress)


def _draw(phases: Phases, group: int, progress: Progress) -> Bands:
    from scipy.fft import irfft

    rates = find_rates(phases.grid)
    turns = np.exp(2j * np.pi * np.arange(PHASES) / PHASES).astype(np.complex64)
    white = np.empty((GROUP, rates.frequencies.size), np.complex64)
    stretches = np.empty(GROUP)
    for row in range(GROUP):
        draw = np.random.default_rng([phases.seed, _AXES[phases.axis], group * GROUP + row])
        stretches[row] = math.exp(STRETCH * draw.standard_normal())
        turns.take(draw.integers(0, PHASES, rates.frequencies.size, dtype=np.uint16), out=white[row], mode="wrap")
    if phases.signs is not None:
        white *= turn_phases(rates.frequencies, phases.signs).astype(np.complex64)
    bands = []
    for weights, depth in zip(rates.weights, rates.depths, strict=True):
        progress.check()
        length = rates.length // depth
        bands.append(irfft(white[:, : length // 2 + 1] * weights[: length // 2 + 1], length, axis=1, overwrite_x=True))
    return Bands(stretches, tuple(bands))


def draw_noise(
    envelopes: Envelopes, phases: Phases, group: int, progress: Progress, *, stretches: FloatArray | None = None
) -> Transforms:
    """Return the transforms (GROUP, f), at the frequencies of `find_rates`, of a group of white noise under envelopes.

    `stretches` (GROUP,) of the time of each motion are drawn unless they are given [-].
    """
    from scipy.fft import rfft

    rates, bands = find_rates(phases.grid), draw_bands(phases, group, progress)
    noise = np.zeros((GROUP, rates.frequencies.size), np.complex64)
    by = 1 / (bands.stretches if stretches is None else stretches)
    for number, (band, depth) in enumerate(zip(bands.octaves, rates.depths, strict=True)):
        progress.check()
        values = envelopes.values[min(number, len(envelopes.values) - 1)]
        under = np.zeros_like(band)
        _modulate(band, values, by, envelopes.half_time / phases.grid.time_step, depth, under)
        transform = rfft(under, axis=1, overwrite_x=True)
        noise[:, : transform.shape[1]] += transform
    return noise


@compiled
def _modulate(
    band: Single, values: FloatArray, rates: FloatArray, half: float, depth: int, under: Single
) -> None:  # pragma: no cover
    """Fill `under` with noise under an envelope (n,) whose time is stretched about sample `half`."""
    last = values.size - 1
    for k in range(band.shape[0]):
        for i in range(last // depth + 1):
            at = min(max(half + (i * depth - half) * rates[k], 0.0), last - 1e-9)
            j = int(at)
            under[k, i] = band[k, i] * np.float32(values[j] + (at - j) * (values[j + 1] - values[j]))
