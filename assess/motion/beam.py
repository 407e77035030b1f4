"""A building as a beam that bends and shears: how its floors move when a ground motion shakes it.

The beam is uniform and fixed at its base. Its shape is ruled by alpha, the ratio of shear to flexural stiffness: 0 is a
cantilever that bends, beyond 20 it shears alone. Eight modes of 5 % damping are taken, each as an oscillator on the
ground, exact for motions that are straight lines between samples; what they lack, and modes of short periods, move with
the ground. So the floors of a building have the phases and signs of one earthquake.

References
----------
Miranda E, Taghavi S (2005). Approximate floor acceleration demands in multistory buildings. I: Formulation. Journal of
Structural Engineering 131(2):203-211. doi:10.1061/(ASCE)0733-9445(2005)131:2(203).
Smallwood DO (1981). An improved recursive formula for calculating shock response spectra. Shock and Vibration Bulletin
51(2):211-217.
"""

import math
from functools import lru_cache

import numpy as np

from assess.arrays import FloatArray, Single
from assess.compiled import compiled
from assess.motion.assumed import Building, draw_places

DAMPING = 0.05
"""Share of critical damping of every mode [-]: assumed. 575 Market Street would want less, Berkeley 8 to 10 %."""
MODES, CELLS = 8, 80
"""Modes; cells of the beam."""
PASSED = 50
"""Beams by whose medians the peaks above a recorded ground are told."""
RIGID_BELOW = 0.03
"""Modes of shorter period move with the ground [s]."""


@lru_cache(maxsize=128)
def solve_beam(alpha: float) -> tuple[FloatArray, FloatArray]:
    """Return the period ratios T_m/T_1 (m,) and, at `CELLS` + 1 heights z/h, participation times shape of modes (m, c).

    Miranda and Taghavi's uniform beam u'''' - alpha^2 u'' = lambda u, fixed at the base, by its energy on cells.
    """
    from scipy.linalg import eigh

    h = 1 / CELLS
    slope = (np.eye(CELLS) - np.eye(CELLS, k=-1)) / h
    bend = np.diff(slope, axis=0, prepend=0.0) / h
    bend[0] = math.sqrt(2) * slope[0] / h  # half a cell of the curvature 2 u_1/h^2 at the base
    mass = np.full(CELLS, h)
    mass[-1] = h / 2
    root = np.sqrt(mass)
    values, vectors = eigh(h * (bend.T @ bend + alpha**2 * slope.T @ slope) / root[:, None] / root)
    shapes = vectors[:, :MODES] / root[:, None]
    shares = np.pad((shapes * (mass @ shapes)).T, ((0, 0), (1, 0)))
    return np.sqrt(values[0] / values[:MODES]), shares


def find_shares(alphas: FloatArray, places: FloatArray) -> FloatArray:
    """Return participation times shape of each mode at z/h `places` (k,) of beams `alphas` (k,), (k, m) [-]."""
    cells = np.clip(places, 0.0, 1.0) * CELLS
    low = np.minimum(cells.astype(int), CELLS - 1)
    found = np.empty((alphas.size, MODES))
    for k, (alpha, at, part) in enumerate(zip(alphas.tolist(), low.tolist(), (cells - low).tolist(), strict=True)):
        shares = solve_beam(alpha)[1]
        found[k] = (1 - part) * shares[:, at] + part * shares[:, at + 1]
    return found


def swing_modes(ground: Single, time_step: float, periods: FloatArray, alphas: FloatArray) -> Single:
    """Return ground motions (k, n) [m/s2] and after each what its modes move relative to it, (k, 1 + m, n).

    `periods` (k,) are T1 [s]. A floor is the ground and, each times its share, the modes.
    """
    found = np.zeros((len(ground), 1 + MODES, ground.shape[1]), np.float32)
    found[:, 0] = ground
    every = periods[:, None] * np.array([solve_beam(alpha)[0] for alpha in alphas.tolist()])
    angle = 2 * np.pi * time_step / np.where(every > RIGID_BELOW, every, np.inf)
    damped, decay = angle * math.sqrt(1 - DAMPING**2), np.exp(-DAMPING * angle)
    cosine = decay * np.cos(damped)
    sine = decay * np.divide(np.sin(damped), damped, out=np.ones_like(damped), where=damped > 0)
    steps = np.stack([1 - sine, 2 * (sine - cosine), decay**2 - sine, 2 * cosine, -(decay**2)], axis=-1)
    steps[angle == 0] = 0.0
    _swing(found, steps)
    return found


@compiled
def _swing(motions: Single, steps: FloatArray) -> None:  # pragma: no cover
    """Fill motions[:, 1:] with the absolute acceleration of each oscillator less that of the ground, motions[:, 0]."""
    for k in range(motions.shape[0]):
        ground = motions[k, 0]
        for m in range(steps.shape[1]):
            b_0, b_1, b_2, a_1, a_2 = steps[k, m]
            if a_1 == 0:
                continue  # moves with the ground
            x_1, x_2, y_1, y_2 = 0.0, 0.0, 0.0, 0.0
            out = motions[k, 1 + m]
            for i in range(ground.size):
                x = ground[i]
                y = b_0 * x + b_1 * x_1 + b_2 * x_2 + a_1 * y_1 + a_2 * y_2
                x_2, x_1, y_2, y_1 = x_1, x, y_1, y
                out[i] = y - x


def shake_record(
    acceleration: FloatArray, time_step: float, building: Building, place: float | None
) -> tuple[float, float]:
    """Return the median PFA [m/s2] and PFV [m/s] at z/h `place` of drawn beams on one ground motion (n,) [m/s2].

    The beams are the same whatever the seed of a run.
    """
    from assess.motion.target_fit import measure_peaks

    ground = np.tile(acceleration.astype(np.float32), (PASSED, 1))
    alphas = building.draw_alphas(0, 0, PASSED)
    places = draw_places(0, 0, PASSED) if place is None else np.full(PASSED, place)
    shares = np.pad(find_shares(alphas, places), ((0, 0), (1, 0)), constant_values=1.0).astype(np.float32)
    basis = swing_modes(ground, time_step, building.draw_periods(0, 0, PASSED), alphas)
    pfa, pfv = np.median(measure_peaks(np.matmul(shares[:, None], basis)[:, 0], time_step), axis=0).tolist()
    return pfa, pfv
