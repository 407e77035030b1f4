"""Signs between the floors of a building: whether two of them move together or against each other, octave by octave.

In a mode of vibration all floors move at the same moment, some of them the other way. Motions that are generated with
the same phases on all floors lose that sign. Where floors have records along one axis of the building, made in one
earthquake and on one clock, the real parts of their cross spectra have it. A floor without a record has no sign.

Two floors may both move with a third one, or both against it, and still be compared better with each other: a floor
near a node of a mode hardly moves in it. So no floor is compared with one reference. In each octave floors are joined
in the order of how coherent they are, the most coherent two first, until all are joined or no more is known.

References
----------
Bendat JS, Piersol AG (2010). Random data: analysis and measurement procedures, 4th ed. Wiley. Section 8.4 (the standard
deviation of the correlation of unrelated noise of bandwidth B over a time T is 1/sqrt(2 B T)).
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.arrays import FloatArray
from assess.motion.target import PAD, husid_envelopes, octaves, split

DEVIATIONS = 2.0
"""Coherence below as many standard deviations of that of unrelated noise has no sign [-]."""
SPACING = 0.1
"""Envelopes are compared at this spacing [s]: they are smoothed over five times as much."""


def find_coherence(accelerations: FloatArray, time_step: float) -> FloatArray:
    """Return how alike floors move, by octave: the real part of the coherence of each two [-], (k, k, b).

    It is the sum over the octave of the real part of the cross spectrum, over the root of the product of the sums of
    the two spectra: 1 where two floors move alike, -1 where one moves against the other.

    `accelerations` (k, n) are records of k floors along one axis [m/s2], with a common start; `time_step` is in s.
    Raises ValueError if there is no floor, or a record is not finite or without motion.
    """
    from scipy.fft import rfft

    rows, length, weights = _prepare(accelerations, time_step)
    spectra = rfft(rows, length, axis=1)
    cross = np.stack([((spectra * one) @ spectra.conj().T).real for one in weights], axis=2)
    own = np.sqrt(np.maximum(np.einsum("iib->ib", cross), 1e-300))
    return np.asarray(cross / (own[:, None] * own), dtype=np.float64)


def find_levels(accelerations: FloatArray, time_step: float) -> FloatArray:
    """Return which coherence of each two floors unrelated noise stays below, in size, in 95 % of cases [-], (k, k, b).

    It is two standard deviations of the correlation of unrelated noise (Bendat and Piersol 2010) of the octave's
    bandwidth, over the time in which both floors shake in that octave. Errors as of `find_coherence`.
    """
    rows, length, weights = _prepare(accelerations, time_step)
    every = max(1, round(SPACING / time_step))
    powers = np.stack([husid_envelopes(row, time_step).values[:, ::every] ** 2 for row in rows])
    together = np.einsum("ibt,jbt->ijb", powers, powers) / powers.shape[2]
    bandwidths = weights.sum(axis=1) ** 2 / np.square(weights).sum(axis=1) / (length * time_step)
    return np.asarray(DEVIATIONS * np.sqrt(together / (2 * bandwidths * rows.shape[1] * time_step)), dtype=np.float64)


def find_signs(accelerations: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Return the signs of floors: 1 or -1, (k, b), by octave of `octaves`.

    Two floors whose coherence is clear have the product of their signs as its sign, unless two chains of floors
    disagree: the more coherent one decides then. Signs are relative: that of the floor of the largest PFA is 1 in every
    octave. Where the coherence is below that of unrelated noise (`find_levels`) there is none to be known: floors, or
    groups of them, that are joined to no other keep 1, each group at its own floor of the largest PFA. Errors as of
    `find_coherence`.
    """
    coherence = find_coherence(accelerations, time_step)
    is_clear = np.abs(coherence) > find_levels(accelerations, time_step)
    peaks = np.abs(np.asarray(accelerations)).max(axis=1)
    found = np.ones((len(peaks), coherence.shape[2]), dtype=np.int64)
    ones, others = np.triu_indices(len(coherence), 1)
    for octave, signs in enumerate(found.T):
        alike, groups = coherence[..., octave], np.arange(len(peaks))
        order = np.argsort(-np.abs(alike[ones, others]), kind="stable")  # the most coherent two first
        for one, other in zip(ones[order].tolist(), others[order].tolist(), strict=True):
            if is_clear[one, other, octave] and groups[one] != groups[other]:
                joined = groups == groups[other]
                if signs[one] * signs[other] * alike[one, other] < 0:
                    signs[joined] *= -1
                groups[joined] = groups[one]
        for group in np.unique(groups):
            members = np.flatnonzero(groups == group)
            signs[members] *= signs[members[peaks[members].argmax()]]
    return found


def _prepare(accelerations: FloatArray, time_step: float) -> tuple[FloatArray, int, FloatArray]:
    """Return the rows checked, the length of transforms, and the weight of each octave at their frequencies, (b, f)."""
    from scipy.fft import next_fast_len

    rows = np.asarray(accelerations, dtype=np.float64)
    if rows.ndim != 2 or not rows.size or not np.isfinite(rows).all() or not rows.any(axis=1).all():
        raise ValueError(f"accelerations have shape {rows.shape}, expected (k, n) finite samples, each row with motion")
    length = int(next_fast_len(rows.shape[1] + math.ceil(PAD / time_step), real=True))
    return rows, length, split(np.asarray(np.fft.rfftfreq(length, time_step), dtype=np.float64), octaves())


def turn_phases(frequencies: FloatArray, signs: Sequence[int] | ArrayLike) -> NDArray[np.complex128]:
    """Return the factors (f,) of modulus 1 that give motions of common phases the signs (b,) of one floor.

    At the centre of an octave the factor is its sign. Between two centres of opposite signs the phase turns by half a
    cycle, so that no amplitude is lost there, which it would be if one octave faded into the other. It always turns the
    same way, so that two floors that both turn there keep their relation. Frequencies are in Hz, signs 1 or -1.
    """
    places = np.log2(np.maximum(frequencies, 1e-9))
    half_cycles = np.cumsum(np.abs(np.diff(np.asarray(signs), prepend=1)) // 2)
    turned = np.interp(places, np.log2(octaves()), np.pi * half_cycles)
    return np.asarray(np.exp(1j * turned), dtype=np.complex128)
