"""Signs between the floors of a building: whether two of them move together or against each other, octave by octave.

In a mode of vibration all floors move at the same moment, some of them the other way. Motions that are generated with
the same phases on all floors lose that sign. Where two floors have records along one axis of the building, made in one
earthquake and on one clock, the real part of their cross spectrum has it: the sign of its sum over each octave is kept.
A floor without a record has no sign.
"""

import math

import numpy as np
from numpy.typing import NDArray

from assess.motion.envelope import PAD, octaves, split
from assess.motion.record import FloatArray


def find_coherence(accelerations: FloatArray, time_step: float) -> FloatArray:
    """Return how alike floors move with their reference, by octave: the real part of the coherence [-], (k, b).

    It is the sum over the octave of the real part of the cross spectrum, over the root of the product of the sums of
    the two spectra: 1 where two floors move alike, -1 where one moves against the other. The reference is the floor of
    the largest PFA, the first of several; its own row is 1.

    Parameters
    ----------
    accelerations : (k, n) array
        Records of k floors along one axis [m/s2], with a common start.
    time_step : float
        [s]

    Raises
    ------
    ValueError
        If there is no floor, or a record is not finite or without motion.
    """
    rows = np.asarray(accelerations, dtype=np.float64)
    if rows.ndim != 2 or not rows.size or not np.isfinite(rows).all() or not rows.any(axis=1).all():
        raise ValueError(f"accelerations have shape {rows.shape}, expected (k, n) finite samples, each row with motion")
    from scipy.fft import next_fast_len, rfft

    count = rows.shape[1]
    length = next_fast_len(count + math.ceil(PAD / time_step), real=True)
    spectra = rfft(rows, length, axis=1)
    reference = spectra[np.abs(rows).max(axis=1).argmax()]
    weights = split(np.asarray(np.fft.rfftfreq(length, time_step), dtype=np.float64), octaves())
    cross = (spectra * reference.conj()).real @ weights.T
    own, other = (np.square(np.abs(one)) @ weights.T for one in (spectra, reference))
    return np.asarray(cross / np.sqrt(np.maximum(own * other, 1e-300)), dtype=np.float64)


def find_signs(accelerations: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Return the signs of floors relative to the floor of the largest PFA: 1 or -1, (k, b), by octave of `octaves`.

    Parameters and errors are those of `find_coherence`.
    """
    return np.where(find_coherence(accelerations, time_step) < 0, -1, 1).astype(np.int64)


def turn_phases(frequencies: FloatArray, signs: NDArray[np.int64]) -> NDArray[np.complex128]:
    """Return the factors (f,) of modulus 1 that give motions of common phases the signs (b,) of one floor.

    At the centre of an octave the factor is its sign. Between two centres of opposite signs the phase turns by half a
    cycle, so that no amplitude is lost there, which it would be if one octave faded into the other.

    Parameters
    ----------
    frequencies : (f,) array
        [Hz]
    signs : (b,) integer array
        By octave of `octaves`, 1 or -1.
    """
    places = np.log2(np.maximum(frequencies, 1e-9))
    turned = np.interp(places, np.log2(octaves()), np.pi * (np.asarray(signs) < 0))
    return np.asarray(np.exp(1j * turned), dtype=np.complex128)
