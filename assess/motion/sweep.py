"""Peak responses of oscillators to many motions, in single precision: what spectra are matched with.

An oscillator needs some samples in its period and no more: motions are halved again and again, and each octave of
periods is watched on the longest step that gives it enough. The recurrence is that of Nigam and Jennings, exact for
motions that are linear between samples, with velocity eliminated. `assess.motion.spectrum` is the reference: means of
an ensemble differ from it by 0.3 % on average, and by 2 to 5 % at long periods where a spectrum holds next to nothing.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray, Single
from assess.compiled import compiled, compiled_into
from assess.motion.spectrum import oscillator_step

FEWEST = 20
"""Samples in a period at least, where motions are halved [-]: a peak between samples is missed by 0.4 % on average."""
DEEPEST, SHORTEST = 3, 1000
"""Times that motions are halved at most [-]; they keep at least half as many samples as the second: in short motions
the ends count."""
BLOCK = 32
"""Samples between the states that are kept on the way."""
LANES = 8
"""Oscillators are filled up to multiples of it: vector loops take as many at once, and what is left one by one. Half of
the rounds of wavelets watch fewer than eight in an octave."""


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """Oscillators of 5 % damping with `periods` (m,) [s], ascending, that watch motions of one time step.

    `depths` tells how often motions are halved for each, and `steps` holds the coefficients (5, lanes) of each depth.
    """

    periods: FloatArray
    time_step: float
    depths: NDArray[np.int64]
    steps: tuple[tuple[int, Single], ...]

    @classmethod
    def of(cls, periods: FloatArray, time_step: float, count: int) -> "Sweep":
        """Return the sweep of these periods [s] under motions of `count` samples with this time step [s]."""
        deepest = min(max(math.ceil(math.log2(count / SHORTEST)), 0), DEEPEST)
        fewest = np.log2(np.maximum(periods / (FEWEST * time_step), 1.0))
        depths = np.minimum(np.floor(fewest + 1e-9), deepest).astype(np.int64)
        steps = []
        for depth in np.unique(depths).tolist():
            r0, r1, r2, r3, r4, r5, r6, r7, _, squared = oscillator_step(periods[depths == depth], time_step * 2**depth)
            # c of u'' = c0 u' + c1 u + c2 a'' + c3 a' + c4 a, u in pseudo-acceleration
            forced = squared * np.array([r5, r4 + r1 * r7 - r3 * r5, r1 * r6 - r3 * r4])
            own = np.concatenate([[r0 + r3, r1 * r2 - r0 * r3], forced])
            steps.append((depth, _fill_lanes(own.astype(np.float32))))
        return cls(periods, time_step, depths, tuple(steps))

    def take(self, places: NDArray[np.int64]) -> "Sweep":
        """Return the sweep of the periods at ascending `places`."""
        steps = []
        for depth, step in self.steps:
            of_depth = np.flatnonzero(self.depths == depth)
            own = np.isin(of_depth, places)
            if own.any():
                steps.append((depth, _fill_lanes(step[:, : of_depth.size].compress(own, axis=1))))
        return Sweep(self.periods[places], self.time_step, self.depths[places], tuple(steps))

    def peaks(self, motions: Single) -> tuple[Single, NDArray[np.int32]]:
        """Return the peak pseudo-accelerations to motions (k, n), with sign, and the samples of the peaks, (k, m).

        They are in the units of the motions; oscillators start at rest.
        """
        found = np.empty((len(motions), self.periods.size), np.float32)
        when = np.empty(found.shape, np.int32)
        halved = 0
        for depth, step in self.steps:
            while halved < depth:
                motions, halved = halve(motions), halved + 1
            own, lanes = self.depths == depth, (len(motions), step.shape[1])
            peak, at = np.empty(lanes, np.float32), np.empty(lanes, np.int32)
            _sweep(motions, step, peak, at)
            found[:, own], when[:, own] = peak[:, : own.sum()], at[:, : own.sum()] << depth
        return found, when

    def spectra(self, motions: Single) -> Single:
        """Return the pseudo-accelerations of motions (k, n), (k, m)."""
        return np.abs(self.peaks(motions)[0])


def _fill_lanes(step: Single) -> Single:
    return np.pad(step, ((0, 0), (0, -step.shape[1] % LANES)))


@compiled
def halve(motions: Single) -> Single:  # pragma: no cover
    """Return every second sample of motions (k, n) after the filter -1/8, 1/4, 3/4, 1/4, -1/8.

    It has a double zero at the old Nyquist frequency, and gives back to second order what straight lines between half
    as many samples take. The samples at the ends, where motions are at rest, are taken as they are.
    """
    rows, last = motions.shape[0], (motions.shape[1] - 1) // 2
    half = np.empty((rows, last + 1), np.float32)
    centre, near, far = np.float32(3 / 4), np.float32(1 / 4), np.float32(1 / 8)
    for k in range(rows):
        row, out = motions[k], half[k]
        out[0], out[last] = row[0], row[2 * last]
        for i in range(1, last):
            at = 2 * i
            out[i] = centre * row[at] + near * (row[at - 1] + row[at + 1]) - far * (row[at - 2] + row[at + 2])
    return half


@compiled
def _sweep(motions: Single, step: Single, peaks: Single, when: NDArray[np.int32]) -> None:  # pragma: no cover
    """Fill `peaks` (k, m), with sign, and `when`.

    Four steps are taken at once, which tells to four samples where the peak is. States are kept every `BLOCK` samples;
    from the one before it the recurrence is followed once more to the sample.
    """
    lanes, count = step.shape[1], motions.shape[1]
    kept = np.zeros((count // BLOCK + 1, 2, lanes), np.float32)
    state, top, turn = np.empty((2, lanes), np.float32), np.empty(lanes, np.float32), np.empty(lanes, np.int32)
    for k in range(motions.shape[0]):
        state[:], top[:], turn[:] = np.float32(0), np.float32(0), np.int32(1)
        done = _watch(motions[k], step, state[0], state[1], top, turn, kept)
        for j in range(lanes):
            peaks[k, j], when[k, j] = _locate(motions[k], step[:, j], kept[:, :, j], turn[j], count)
        for i in range(done, count):  # the last ones, where fewer than four are left
            for j in range(lanes):
                peak, at = _locate(motions[k], step[:, j], kept[:, :, j], i, count)
                if abs(peak) > abs(peaks[k, j]):
                    peaks[k, j], when[k, j] = peak, at


@compiled_into
def _watch(
    row: Single, step: Single, u: Single, v: Single, top: Single, turn: NDArray[np.int32], kept: Single
) -> int:  # pragma: no cover
    """Take steps as long as four are left; return the sample that is next. The inner loop runs in vector lanes."""
    c0, c1, c2, c3, c4 = step[0], step[1], step[2], step[3], step[4]
    a0, a1, i = row[0], row[0], 1
    while i < row.size:
        if i % BLOCK == 1:
            for j in range(top.size):
                kept[i // BLOCK, 0, j], kept[i // BLOCK, 1, j] = u[j], v[j]
        if i + 3 >= row.size:
            break
        a2, a3, a4, a5, now = row[i], row[i + 1], row[i + 2], row[i + 3], np.int32(i)
        for j in range(top.size):
            w = (c2[j] * a2 + c3[j] * a1 + c4[j] * a0 + c1[j] * u[j]) + c0[j] * v[j]
            x = (c2[j] * a3 + c3[j] * a2 + c4[j] * a1 + c1[j] * v[j]) + c0[j] * w
            y = (c2[j] * a4 + c3[j] * a3 + c4[j] * a2 + c1[j] * w) + c0[j] * x
            z = (c2[j] * a5 + c3[j] * a4 + c4[j] * a3 + c1[j] * x) + c0[j] * y
            most = max(max(abs(w), abs(x)), max(abs(y), abs(z)))  # noqa: PLW3301 - vector lanes need pairs
            turn[j] = now if most > top[j] else turn[j]
            top[j] = max(top[j], most)
            u[j], v[j] = y, z
        a0, a1, i = a4, a5, i + 4
    return i


@compiled_into
def _locate(row: Single, c: Single, kept: Single, turn: int, count: int) -> tuple[np.float32, int]:  # pragma: no cover
    """Return the largest of four responses from sample `turn` on, with sign, and its sample."""
    block = (turn - 1) // BLOCK
    before, own, best, when = kept[block, 0], kept[block, 1], np.float32(0), turn
    for i in range(1 + block * BLOCK, min(turn + 4, count)):
        x = (c[2] * row[i] + c[3] * row[i - 1] + c[4] * row[max(i - 2, 0)] + c[1] * before) + c[0] * own
        if i >= turn and abs(x) > abs(best):
            best, when = x, i
        before, own = own, x
    return best, when
