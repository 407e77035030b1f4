"""ODE23s, the solver that the paper chose, which scipy lacks; `scipy.integrate.solve_ivp` takes it as its `method`.

Reference: Shampine L F, Reichelt M W (1997). The MATLAB ODE Suite. SIAM Journal on Scientific Computing 18(1):1-22,
section 4.1: a linearly implicit (modified Rosenbrock) formula of order 2, with an error estimate of order 3. It is
meant for stiff equations and coarse tolerances.

With F(t, y) = y', J its derivative by y and T by t, a step of length h solves for k1, k2, k3 in turn:

    W  = I - h d J,                                       d = 1 / (2 + sqrt 2)
    W k1 = F0 + h d T,                                    F0 = F(t, y)
    W (k2 - k1) = F1 - k1,                                F1 = F(t + h/2, y + h/2 k1)
    y1 = y + h k2
    W k3 = F2 - e32 (k2 - F1) - 2 (k1 - F0) + h d T,      F2 = F(t + h, y1),  e32 = 6 + sqrt 2
    error = h/6 (k1 - 2 k2 + k3)

F2 is the next step's F0. J and T are evaluated at every step, by differences unless J is given.

Departures: neither mass matrices nor sparse or constant J; the step size control is chosen here where the reference
leaves it open.

This module imports scipy: import it only where equations are solved.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import DenseOutput, OdeSolver
from scipy.linalg.lapack import dgetrf, dgetrs

from assess.arrays import FloatArray

D, E32 = 1 / (2 + math.sqrt(2)), 6 + math.sqrt(2)
SAFETY, SHRINK, GROW = 0.8, 0.1, 5.0
"""A step is `SAFETY` of what the last error allows, at least `SHRINK` and at most `GROW` times the previous one."""
ROOT = math.sqrt(np.finfo(float).eps)
"""Relative length of a difference."""

Rates = Callable[[float, FloatArray], FloatArray]
Jacobian = Callable[[float, FloatArray], FloatArray]


class Ode23s(OdeSolver):  # type: ignore[misc]  # scipy is not typed
    """The modified Rosenbrock pair of orders 2 and 3 of ODE23s.

    The error of every component is at most max(rtol |y|, atol), as in MATLAB, where |y| is the larger value of both
    ends of the step. `nfev` counts the evaluations of the steps alone, as in scipy, without `jac` and differences.

    * `fun`: F(t, y), (n,).
    * `t0`, `t_bound`: start and end.
    * `y0` (n,): initial state.
    * `rtol`, `atol`: relative and absolute tolerance, above 0.
    * `jac`: J(t, y), (n, n); default: forward differences.
    * `first_step`: length of the first step; default: by the second derivative of y.
    * `max_step`: longest step.
    * `vectorized`: whether `fun` accepts several y at once.

    Raises ValueError if a tolerance or the length of a step is not above 0, `y0` is not a list of finite numbers, or an
    option is unknown.
    """

    t: float
    y: FloatArray
    n: int
    direction: float

    def __init__(
        self, fun: Rates, t0: float, y0: FloatArray, t_bound: float, *, rtol: float = 1e-3, atol: float = 1e-6,
        jac: Jacobian | None = None, first_step: float | None = None, max_step: float = math.inf,
        vectorized: bool = False, **unknown: object,
    ) -> None:  # fmt: skip
        if unknown:
            raise ValueError(f"Ode23s has no option {', '.join(unknown)}: leave it out")
        if not (rtol > 0 and atol > 0 and max_step > 0 and (first_step is None or first_step > 0)):
            raise ValueError("rtol, atol, first_step and max_step of Ode23s must be above 0")
        super().__init__(fun, t0, y0, t_bound, vectorized)
        self.rtol, self.atol, self.jac, self.max_step = rtol, atol, jac, max_step
        self.unit = np.eye(self.n)
        self.rates = self.fun(self.t, self.y)
        self.ahead = abs(t_bound - t0) if first_step is None else first_step
        if first_step is None and self.n:
            by_t, by_y = self._differentiate(min(self.ahead, self.max_step))
            bend = float(np.max(np.abs(by_t + by_y @ self.rates) / self._scale(self.y))) / 2
            self.ahead = min(self.ahead, SAFETY * (self.rtol ** (1 / 3)) / math.sqrt(bend) if bend > 0 else math.inf)
        self.path: _Parabola | None = None

    def _scale(self, y: FloatArray) -> FloatArray:
        """Return the reference size of each component of y for its error: |y|, at least atol / rtol."""
        return np.maximum(np.abs(y), self.atol / self.rtol)

    def _differentiate(self, h: float) -> tuple[FloatArray, FloatArray]:
        """Return T (n,) and J (n, n) at the current state, before a step of about `h`."""
        step = self.direction * min(ROOT * max(abs(self.t), abs(self.t + self.direction * h)), h)
        step = (self.t + step) - self.t or self.direction * h
        by_t = (self.fun_single(self.t + step, self.y) - self.rates) / step
        self.njev += 1
        if self.jac is not None:
            return by_t, np.asarray(self.jac(self.t, self.y), dtype=float)
        steps = (self.y + ROOT * self._scale(self.y)) - self.y
        moved = self.fun_vectorized(self.t, self.y[:, np.newaxis] + np.diag(steps))
        return by_t, (moved - self.rates[:, np.newaxis]) / steps

    def _step_impl(self) -> tuple[bool, str | None]:
        shortest = 16 * abs(np.nextafter(self.t, math.inf) - self.t)
        ahead = max(min(self.ahead, self.max_step), shortest)
        (by_t, by_y), grow, t, f0 = self._differentiate(ahead), GROW, self.t, self.rates
        while True:
            left = abs(self.t_bound - self.t)
            h = left if ahead >= 0.9 * left and left <= self.max_step else min(ahead, left)
            step = self.direction * h
            hdt, (lu, order, _) = step * D * by_t, dgetrf(self.unit - step * D * by_y)
            self.nlu += 1
            k1 = dgetrs(lu, order, f0 + hdt)[0]
            f1 = self.fun(t + step / 2, self.y + step / 2 * k1)
            k2 = dgetrs(lu, order, f1 - k1)[0] + k1
            y1 = self.y + step * k2
            f2 = self.fun(t + step, y1)
            k3 = dgetrs(lu, order, f2 - E32 * (k2 - f1) - 2 * (k1 - f0) + hdt)[0]
            error = step / 6 * (k1 - 2 * k2 + k3)
            size = np.max(np.abs(error) / np.maximum(self._scale(self.y), self._scale(y1))) / self.rtol
            better = SAFETY * size ** (-1 / 3) if size > 0 else GROW
            if size <= 1:
                break
            if h <= shortest or not np.isfinite(size):
                return False, self.TOO_SMALL_STEP
            ahead, grow = max(shortest, h * max(SHRINK, better)), 1.0
        self.ahead = h * min(grow, max(SHRINK, better))
        self.path = _Parabola(t, t + step, self.y, k1, k2)
        self.t, self.y, self.rates = self.t_bound if h == left else t + step, y1, f2
        return True, None

    def _dense_output_impl(self) -> Any:
        return self.path


class _Parabola(DenseOutput):  # type: ignore[misc]
    """The path within a step by the reference's parabola, of order 2 like the step."""

    def __init__(self, t_old: float, t: float, y: FloatArray, k1: FloatArray, k2: FloatArray) -> None:
        super().__init__(t_old, t)
        self.h, self.y, self.k1, self.k2 = t - t_old, y, k1, k2

    def _call_impl(self, t: FloatArray) -> FloatArray:
        s = np.asarray((t - self.t_old) / self.h)
        parts = np.multiply.outer(self.k1, s * (1 - s)) + np.multiply.outer(self.k2, s * (s - 2 * D))
        start = self.y.reshape(-1, *(1,) * s.ndim)
        return np.asarray(start + self.h / (1 - 2 * D) * parts)
