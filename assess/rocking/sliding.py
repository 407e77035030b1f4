"""A rigid body on a floor with friction: how it starts to move, and how far it slides.

How it starts follows from the forces at the first instant of an acceleration; `peak_slip` follows a body that slides
and does not rock. Neither tells what a body does that slides and rocks at once, and neither lowers a chance of
overturning.

References
----------
Shenton HW (1996). Criteria for initiation of slide, rock, and slide-rock rigid-body modes. Journal of Engineering
Mechanics 122(7):690-693. doi:10.1061/(ASCE)0733-9399(1996)122:7(690)

Newmark NM (1965). Effects of earthquakes on dams and embankments. Géotechnique 15(2):139-160.
doi:10.1680/geot.1965.15.2.139
"""

from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.arrays import FloatArray
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress
from assess.rocking.block import MIDDLE
from assess.units import GRAVITY, ROUNDING

UNKNOWN = -1
"""In place of a `Branch`: friction, a size or the acceleration is not known."""


class Branch(IntEnum):
    """What a body at rest does first under an acceleration of the floor."""

    REST = 0
    SLIDE = 1
    ROCK = 2
    SLIDE_AND_ROCK = 3

    @property
    def word(self) -> str:
        """The branch in words, ``slide and rock``."""
        return ("rest", "slide", "rock", "slide and rock")[self]


def critical_friction(
    breadth: ArrayLike, height: ArrayLike, acceleration: ArrayLike, *, centre: ArrayLike = MIDDLE
) -> FloatArray:
    """Least friction with which a body starts to rock without sliding [-]: Shenton's mu*.

    With gamma = H/B and the acceleration a in g it is [a (4 + gamma2) + 3 gamma]/[1 + 4 gamma2 + 3 a gamma]. Where the
    centre of gravity is not in the middle, it follows in the same way from the forces at the first instant, with the
    moment of inertia m (B2 + H2)/12 about it.

    * `breadth`, `height` (n,): sizes [m]; breadth is the side parallel to the motion.
    * `acceleration` (n,): of the floor, of either sign [m/s2].
    * `centre` (n,): height of the centre of gravity over `height` [-].

    Returned (n,): NaN where the acceleration does not lift an edge, and where a number is unknown.
    """
    b, z = np.asarray(breadth) / 2, np.asarray(centre) * np.asarray(height)
    a = np.abs(acceleration) / GRAVITY
    inertia = (4 * b**2 + np.square(height)) / 12 + b**2 + z**2  # about the edge, over the mass [m2]
    turning = (a * z - b) / inertia  # angular acceleration over g [1/m]
    needed = (a - z * turning) / (1 + b * turning)  # horizontal over vertical force at the edge
    return np.asarray(np.where(a * z < b * (1 - ROUNDING), np.nan, needed), dtype=np.float64)


def branch(
    breadth: ArrayLike, height: ArrayLike, friction: ArrayLike, acceleration: ArrayLike, *, centre: ArrayLike = MIDDLE
) -> NDArray[np.int64]:
    """Tell how bodies at rest start to move when the floor's acceleration is applied at once.

    A body stays at rest up to the smaller of friction and b/z_c, half its base over the height of its centre of
    gravity. Above, it slides if friction is below b/z_c, rocks if friction is at least `critical_friction`, and slides
    and rocks in between.

    * `breadth`, `height`, `acceleration`, `centre`: as of `critical_friction`.
    * `friction` (n,): coefficient of friction [-]; resting and sliding friction are taken to be equal.

    Returned (n,): `Branch`, or `UNKNOWN` where a number is NaN. `is_outside_shenton` tells where it goes beyond the
    publication.
    """
    given = np.broadcast_arrays(*np.atleast_1d(breadth, height, friction, acceleration, centre))
    B, H, mu, a, share = (np.asarray(values, dtype=np.float64) for values in given)
    uplift = B / (2 * share * H)
    with np.errstate(invalid="ignore"):
        rests = np.abs(a) / GRAVITY <= np.minimum(mu, uplift) * (1 + ROUNDING)
        slides = mu < uplift * (1 - ROUNDING)
        rocks = mu >= critical_friction(B, H, a, centre=share) * (1 - ROUNDING)
    unknown = np.isnan(B + H + mu + a + share)
    choices = [UNKNOWN, Branch.REST, Branch.SLIDE, Branch.ROCK]
    return np.select([unknown, rests, slides, rocks], choices, Branch.SLIDE_AND_ROCK).astype(np.int64)


def is_outside_shenton(centre: ArrayLike) -> NDArray[np.bool_]:
    """Return where the centre of gravity, over the height [-], is not in the middle, as Shenton takes it to be."""
    return np.asarray(np.abs(np.asarray(centre) - MIDDLE) > ROUNDING)


def peak_slip(
    friction: ArrayLike,
    motions: FloatArray,
    time_step: float,
    *,
    scale: ArrayLike = 1.0,
    threads: int = 1,
    progress: Progress = SILENT,
) -> FloatArray:
    """Largest displacement relative to the floor of a rigid body that slides on it and does not rock [m].

    Newmark's sliding block in both directions, x'' = -a_g - mu g sgn x', from rest, in closed form between starts,
    stops and samples. A motion is linear between its samples and followed by rest, to which it falls within one step;
    a body that is still sliding then slides on until it stops.

    * `friction` (m,): coefficients of friction [-].
    * `motions` (k, n): accelerations of the floor [m/s2].
    * `time_step`: [s].
    * `scale` (k,): each motion is multiplied by its own [-].
    * `threads`: share the motions; they do not change a result.
    * `progress`: asked before each motion whether to stop; CancelledError then.

    Returned (m, k): of each friction under each motion [m].

    Raises ValueError if a coefficient of friction is not above 0, or the
    motions, their scale or their time step are not finite numbers of that shape.
    """
    from assess.rocking.slip import slide

    mu = np.atleast_1d(np.asarray(friction, dtype=np.float64))
    motions = np.ascontiguousarray(motions, dtype=np.float64)
    if mu.ndim != 1 or not (np.isfinite(mu) & (mu > 0)).all():
        raise ValueError("friction must be a list of finite numbers above 0")
    if motions.ndim != 2 or not motions.size or not np.isfinite(motions).all():
        raise ValueError(f"motions have shape {motions.shape}, expected (k, n) finite samples")
    if not 0 < time_step < np.inf:
        raise ValueError(f"time_step is {time_step} s, expected above 0")
    factors = np.array(np.broadcast_to(scale, len(motions)), dtype=np.float64)
    if not np.isfinite(factors).all():
        raise ValueError("scale must be finite numbers")
    found = np.zeros((mu.size, len(motions)))

    def run(row: int) -> None:
        for at, one in enumerate(mu):
            found[at, row] = slide(motions[row], factors[row], one * GRAVITY, time_step)

    run_rows(run, len(motions), threads, progress)
    return found
