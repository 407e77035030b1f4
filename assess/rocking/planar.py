"""Bodies in general: any centre of gravity, vertical motion of the floor, a wall at the back.

`assess.rocking.ensemble` integrates many blocks under horizontal motion alone, and does so several times faster. What
is found beside a wall stands next to its results and lowers none: the wall's own motion and pounding feed in energy
that is left out here. Importing this imports numba: do so where bodies are to be rocked.

Reference: Sorrentino L, AlShawa O, Decanini LD (2011). The relevance of energy damping in unreinforced masonry rocking
mechanisms. Experimental and analytic investigations. Bulletin of Earthquake Engineering 9(5):1617-1642.
doi:10.1007/s10518-011-9291-1. The restitution of the one-sided motion is assumed: not compared with the printed paper.
"""

import math
from dataclasses import dataclass
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from assess.arrays import FloatArray
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress
from assess.rocking import block
from assess.rocking import planar_kernel as kernel
from assess.rocking.ensemble import MOST_TRACED, Response, Rocking, check_motions
from assess.units import GRAVITY

Away = Literal[-1, 0, 1]
"""To which side a body may turn: 1 is that of positive acceleration, with the wall on the other; 0 without a wall."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Body:
    """A rigid body as it rocks; each field a number or an array, which broadcast.

    * `critical_angle`: angle alpha between the side and the line from an edge to the centre of gravity [rad]:
      tan(alpha) = b/z_c is the acceleration [g] that lifts an edge.
    * `frequency_parameter`: p [rad/s]: p2 = m g R/I_0.
    * `restitution`: angular velocity after an impact on the floor over that before it [-], 0 to 1.
    * `rebound`: angular velocity after an impact on a wall over that before it, in the other direction [-], 0 to 1.
    """

    critical_angle: FloatArray
    frequency_parameter: FloatArray
    restitution: FloatArray
    rebound: FloatArray

    @classmethod
    def of(
        cls,
        *,
        half_base: ArrayLike,
        centre_height: ArrayLike,
        frequency_parameter: ArrayLike,
        restitution: ArrayLike = math.nan,
    ) -> Self:
        """Build a body of given half base b, height of the centre of gravity z_c [m] and p [rad/s].

        With 2 m R2/I_0 = 2 p2 R/g, restitution is 1 - (2 m R2/I_0) sin2(alpha) where it is NaN; the rebound from a wall
        is that of `wall_restitution`.

        Raises ValueError if a number is not finite and above 0, or the restitution is outside 0 to 1.
        """
        b, z, p, eta = (
            np.asarray(values, dtype=np.float64)
            for values in (half_base, centre_height, frequency_parameter, restitution)
        )
        for name, values in (("half_base", b), ("centre_height", z), ("frequency_parameter", p)):
            if not (np.isfinite(values) & (values > 0)).all():
                raise ValueError(f"{name} must be finite and above 0")
        alpha, shape = np.arctan2(b, z), 2 * p**2 * np.hypot(b, z) / GRAVITY
        eta = np.where(np.isnan(eta), 1 - shape * np.sin(alpha) ** 2, eta)
        if not ((eta >= 0) & (eta <= 1)).all():
            raise ValueError("restitution must be 0 to 1")
        rebound = np.clip(-wall_restitution(alpha, eta, shape=shape), 0, 1)
        return cls(critical_angle=alpha, frequency_parameter=p, restitution=eta, rebound=rebound)

    @classmethod
    def rectangular(
        cls, breadth: ArrayLike, height: ArrayLike, *, centre: ArrayLike = 0.5, restitution: ArrayLike = math.nan
    ) -> Self:
        """Build a body of sizes [m], its centre of gravity at `centre` times the height, I_cg = m (B2 + H2)/12."""
        B, H = np.asarray(breadth, dtype=np.float64), np.asarray(height, dtype=np.float64)
        p = block.frequency_parameter(B, H, np.asarray(centre))
        return cls.of(
            half_base=B / 2, centre_height=np.asarray(centre) * H, frequency_parameter=p, restitution=restitution
        )


def wall_restitution(critical_angle: ArrayLike, restitution: ArrayLike, *, shape: ArrayLike = 1.5) -> FloatArray:
    """Angular velocity after an impact on a wall over that before it [-]: below 0 where the body rebounds.

    e = eta2 (1 - 1.5 cos2(alpha)); with Housner's eta = 1 - 1.5 sin2(alpha) that of Sorrentino et al. (2011), to be
    checked against the printed paper. A body strikes the floor, the wall and the floor again.

    * `critical_angle`: alpha [rad].
    * `restitution`: eta of an impact on the floor [-].
    * `shape`: 2 m R2/I_0 [-]; 1.5 for a homogeneous rectangle.
    """
    eta, alpha = np.asarray(restitution, dtype=np.float64), np.asarray(critical_angle, dtype=np.float64)
    return np.asarray(eta**2 * (1 - np.asarray(shape) * np.cos(alpha) ** 2))


def rock_bodies(
    body: Body,
    motions: FloatArray,
    time_step: float,
    *,
    vertical: FloatArray | None = None,
    away: Away = 0,
    scale: ArrayLike = 1.0,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Rocking:
    """Integrate m bodies under k motions each, from rest.

    A motion is linear between its samples and followed by rest, to which it falls within one step; a body that is still
    rocking then is followed until it can no longer fall.

    * `body`: of arrays that broadcast to (m, k); (m, 1) for bodies that are the same under all motions.
    * `motions` (k, n): horizontal accelerations of the floor [m/s2].
    * `time_step`: [s].
    * `vertical` (k, n): vertical accelerations, upwards positive [m/s2].
    * `away`: -1 or 1 beside a wall; see `Away`.
    * `scale` (k,): each motion is multiplied by its own [-], the vertical one too.
    * `threads`: share the motions; they do not change a result.
    * `progress`: asked before each motion whether to stop; CancelledError then.

    Raises ValueError if the motions, their scale or their time step are
    not finite numbers of that shape, or the vertical acceleration is 1 g or more downwards, where a body leaves the
    floor.
    """
    across, up = _check_motions(motions, vertical, time_step, scale)
    fields = (body.critical_angle, body.frequency_parameter, body.restitution, body.rebound)
    shape = np.broadcast_shapes(*(np.shape(field) for field in fields), (1, len(across)))
    bodies = np.stack([np.broadcast_to(field, shape) for field in fields], axis=-1)
    states = np.zeros((*shape, kernel.STATES))

    def run(row: int) -> None:
        for at in range(shape[0]):
            _rock(bodies[at, row], across[row], up[row], time_step, away, states[at, row], 0)

    run_rows(run, len(across), threads, progress)
    return _build(bodies[..., 0], states)


def follow_body(
    body: Body, acceleration: FloatArray, time_step: float, *, vertical: FloatArray | None = None, away: Away = 0
) -> Response:
    """Integrate one body under one motion, as `rock_bodies` does, and keep its path.

    Parameters and errors are those of `rock_bodies`: a `body` of numbers, and accelerations (n,) [m/s2].
    """
    both = (np.asarray(acceleration)[np.newaxis], None if vertical is None else np.asarray(vertical)[np.newaxis])
    (across,), (up,) = _check_motions(*both, time_step, 1.0)
    numbers = np.array(
        [float(one) for one in (body.critical_angle, body.frequency_parameter, body.restitution, body.rebound)]
    )
    states = np.zeros((2, kernel.STATES))
    _rock(numbers, across, up, time_step, away, states[0], 0)
    trace = _rock(numbers, across, up, time_step, away, states[1], min(int(states[0, kernel.ROWS]), MOST_TRACED))
    found = _build(numbers[:1, np.newaxis], states[:1, np.newaxis])
    struck = np.diff(trace[:, 2], prepend=0.0) > 0
    end = (np.size(acceleration) - 1) * time_step
    ends = [end] if not found.overturned[0, 0] and (not len(trace) or trace[-1, 0] < end) else []
    return Response(
        critical_angle=float(numbers[0]), frequency_parameter=float(numbers[1]), restitution=float(numbers[2]),
        overturned=bool(found.overturned[0, 0]), rotation=float(found.rotation[0, 0]),
        fall_time=float(found.fall_time[0, 0]), impacts=int(found.impacts[0, 0]),
        times=np.concatenate([[0.0], trace[:, 0], ends]),
        theta=np.concatenate([[0.0], trace[:, 1], np.zeros(len(ends))]), impact_times=trace[struck, 0],
    )  # fmt: skip


def _check_motions(
    motions: FloatArray, vertical: FloatArray | None, time_step: float, scale: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return both motions, scaled [g] and padded as the kernel takes them, (k, n + 2); ValueError as `rock_bodies`."""
    across = check_motions(np.asarray(motions, dtype=np.float64), time_step)
    up = np.zeros_like(across) if vertical is None else np.asarray(vertical, dtype=np.float64)
    if up.shape != across.shape or not np.isfinite(up).all():
        raise ValueError(f"vertical motions have shape {up.shape}, expected {across.shape} finite samples")
    factors = np.array(np.broadcast_to(scale, len(across)), dtype=np.float64)[:, np.newaxis] / GRAVITY
    if not np.isfinite(factors).all():
        raise ValueError("scale must be finite numbers")
    if (up * factors).min() <= -1:
        raise ValueError(f"the vertical acceleration is {(up * factors).min():.3g} g, expected above -1 g")
    pad = ((0, 0), (0, 2))
    return np.pad(across * factors, pad), np.pad(up * factors, pad)


def _rock(
    body: FloatArray, across: FloatArray, up: FloatArray, time_step: float, away: Away, state: FloatArray, points: int
) -> FloatArray:
    """Integrate one body and fill its `state`; returns `points` points of its path, (t, 3)."""
    trace = np.zeros((points, 3))
    state[kernel.RESTS], state[kernel.FALL] = 1.0, -1.0
    kernel.rock(np.ascontiguousarray(body), across, up, time_step, away, state, trace)
    return trace


def _build(critical_angle: FloatArray, states: FloatArray) -> Rocking:
    """Return what bodies of angles (m, k) did, from their states (m, k, 9)."""
    fell = states[..., kernel.FALL] >= 0
    return Rocking(
        overturned=fell,
        rotation=np.where(fell, math.pi / 2, states[..., kernel.PEAK]) / critical_angle,
        fall_time=np.where(fell, states[..., kernel.FALL], math.nan),
        impacts=states[..., kernel.IMPACTS].astype(np.int64),
    )
