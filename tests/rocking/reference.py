"""The reference that the kernel is held to: eq. 3 by scipy's DOP853, one sample at a time, impacts located as events.

Plain and slow on purpose; nothing is shared with the kernel but the equation and these conventions. The record is
linear between its samples and followed by zeros, to which it falls within one step. A block rests once the hop after an
impact would be lower than `REST` times the critical angle. After the end it is followed until it can no longer fall.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from assess.units import GRAVITY

RTOL, ATOL, REST = 1e-10, 1e-13, 1e-9
FALLEN, NO_TIME = math.pi / 2, 1e-10


@dataclass(frozen=True)
class Found:
    overturned: bool
    rotation: float  # largest |theta| / alpha
    impacts: int
    time: float = math.nan  # of overturning [s]


@dataclass
class Block:
    """A block and how it stands; `linear` is the slender-block equation."""

    alpha: float
    p: float
    eta: float
    linear: bool = False
    edge: float = 1.0  # sign of theta
    phi: float = 0.0
    velocity: float = 0.0
    rests: bool = True
    peak: float = 0.0
    impacts: int = 0

    @property
    def threshold(self):
        return self.alpha if self.linear else math.tan(self.alpha)

    def acceleration(self, phi, ground):
        """phi'' at a ground acceleration [g]: eq. 3, or its form for slender blocks."""
        if self.linear:
            return -(self.p**2) * (self.alpha - phi + self.edge * ground)
        return -(self.p**2) * (math.sin(self.alpha - phi) + self.edge * ground * math.cos(self.alpha - phi))

    def depth(self, phi):
        """How far the energy of position is below its top, which is at the critical angle."""
        return self.p**2 * ((self.alpha - phi) ** 2 / 2 if self.linear else 1 - math.cos(self.alpha - phi))


def of_sizes(breadth: float, height: float) -> Block:
    alpha = math.atan(breadth / height)
    return Block(alpha, math.sqrt(3 * GRAVITY / (2 * math.hypot(breadth, height))), 1 - 1.5 * math.sin(alpha) ** 2)


def integrate(block: Block, ground: np.ndarray, time_step: float) -> Found:
    """Integrate a block under accelerations [g], one every `time_step` [s]."""
    values = [*(float(one) for one in ground), 0.0, 0.0]
    at = -1
    while True:
        at += 1
        here, there = values[min(at, len(values) - 2) :][:2]
        slope, since = (there - here) / time_step, 0.0
        while since < time_step * (1 - NO_TIME):
            if block.rests:
                since = _start(block, here, there, slope, since)
                if since is None:
                    break
            since = _fly(block, here, slope, since, time_step)
            if block.phi >= FALLEN:
                return Found(True, FALLEN / block.alpha, block.impacts, at * time_step + since)
        if at >= len(values) - 3 and (block.rests or _is_safe(block)):
            return Found(False, block.peak / block.alpha, block.impacts)


def _start(block, here, there, slope, since):
    """Return when a block at rest starts within a sample; None if it does not."""
    now = here + slope * since
    if abs(now) <= block.threshold:
        if abs(there) <= block.threshold:
            return None
        since = (math.copysign(block.threshold, there) - here) / slope
        now = there
    block.rests, block.edge, block.phi, block.velocity = False, -math.copysign(1, now), 0.0, 0.0
    return since


def _fly(block, here, slope, since, end):
    """Follow a block to the end of the sample, its impact or its fall; return when that is."""
    if since >= end * (1 - NO_TIME):
        return end

    def rates(time, state):
        return [state[1], block.acceleration(state[0], here + slope * time)]

    solver = DOP853(rates, since, [block.phi, block.velocity], end, rtol=RTOL, atol=ATOL, first_step=end - since)
    while solver.status == "running":
        solver.step()
        if solver.y[0] < 0:
            return _strike(block, solver, here, slope, end)
        if solver.y[0] >= FALLEN:
            block.phi = FALLEN
            return _find(solver.dense_output(), 0, FALLEN, solver.t_old, solver.t)
        _note_peak(block, solver, solver.t)
        block.phi, block.velocity = float(solver.y[0]), float(solver.y[1])
    return end


def _find(path, which, value, first, last):
    return brentq(lambda time: path(time)[which] - value, first, last, xtol=1e-15)


def _note_peak(block, solver, until):
    path = solver.dense_output()
    block.peak = max(block.peak, float(path(until)[0]))
    if block.velocity > 0 > path(until)[1]:
        turn = _find(path, 1, 0.0, solver.t_old, until)
        block.peak = max(block.peak, float(path(turn)[0]))


def _strike(block, solver, here, slope, end):
    path, first = solver.dense_output(), solver.t_old
    if block.phi == 0:  # a hop begins at zero: look for its other end
        first += 1e-6 * (solver.t - first)
    when = _find(path, 0, 0.0, first, solver.t) if path(first)[0] > 0 else solver.t_old
    _note_peak(block, solver, when)
    block.velocity = block.eta * max(0.0, -float(path(when)[1]))
    block.edge, block.phi, block.impacts = -block.edge, 0.0, block.impacts + 1
    back = -block.acceleration(0.0, here + slope * when)
    block.rests = block.velocity**2 < 2 * back * REST * block.alpha
    return when


def _is_safe(block):
    """Tell whether a block without ground motion can no longer fall; its last peak counts."""
    depth, energy = block.depth(block.phi), block.velocity**2 / 2
    if block.phi >= block.alpha or energy >= depth:
        return False
    if block.velocity < 0:  # over the other edge
        depth, energy = block.depth(0.0), block.eta**2 * (energy + block.depth(0.0) - depth)
    left = (depth - energy) / block.p**2
    block.peak = max(block.peak, block.alpha - (math.sqrt(2 * left) if block.linear else math.acos(1 - left)))
    return True


def scaled(ground: np.ndarray, block: Block, times: float) -> np.ndarray:
    """Return accelerations [g] whose peak is so many times the rocking threshold."""
    return np.asarray(ground * (times * block.threshold / np.abs(ground).max()))
