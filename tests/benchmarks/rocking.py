"""Benchmarks of rocking: block-steps a second, and the time of one pair against other ways to integrate it."""

import math
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

from assess.motion.generate import build_generator
from assess.motion.target import Grid, recorded_target
from assess.rocking import block, ensemble, kernel
from assess.rocking.ensemble import rock_blocks
from assess.units import GRAVITY
from tests.benchmarks.measuring import timed
from tests.motion.motions import TWELFTH, cut
from tests.rocking.pairs import ground, read_table
from tests.rocking.reference import of_sizes, scaled

Array = np.ndarray
STEP, SAMPLES, PEAK = 0.01, 4000, 0.6
BLOCKS, MOTIONS, ROUNDS = 200, 100, 5


def rows(_folder: Path) -> Iterator[str]:
    """Yield tables in Markdown."""
    motions, (breadth, height) = _motions(), _blocks()
    yield "| rocking | block-steps a second, all samples | block-steps a second, those integrated |"
    yield "|---|---|---|"
    nominal = BLOCKS * MOTIONS * SAMPLES
    for threads in (1, 2):
        steps, seconds = _steps(breadth, height, motions), _rock(breadth, height, motions, threads)
        yield (
            f"| {BLOCKS} blocks, {MOTIONS} motions of {SAMPLES:,} samples, threads: {threads} | "
            f"{nominal / seconds / 1e6:,.0f} million | {steps / seconds / 1e6:,.0f} million |"
        )
    ours = _rock(breadth, height, motions, 1) / (BLOCKS * MOTIONS)
    yield "\n| one pair, mean | seconds | rival | seconds | times as fast | aim | verdicts of the rival that are ours |"
    yield "|---|---|---|---|---|---|---|"
    yield _against("scipy solve_ivp, RK45, rtol 1e-5, events", slow, 100, ours, "at least 3,000")
    yield _against("plain RK4, compiled, 10 sub-steps a sample", plain, 2000, ours, "")
    yield "\n| pairs of block and real record | verdicts that are the reference's |\n|---|---|"
    yield from _verdicts()


def _motions() -> Array:
    """Return motions like that of the 12th floor at Alhambra [m/s2], each with the same peak."""
    grid = Grid(STEP, SAMPLES)
    target = recorded_target(cut(TWELFTH, 0, 30), grid)
    made = build_generator(target, grid, seed=1, axis="X", threads=2).realise(0, MOTIONS)
    return np.asarray(made * (PEAK * GRAVITY / np.abs(made).max(axis=1, keepdims=True)))


def _blocks() -> tuple[Array, Array]:
    """Return sizes of furniture [m] whose threshold is 1/3 to 2/3 of the peak."""
    rng = np.random.default_rng(1)
    height = rng.uniform(0.6, 2.2, BLOCKS)
    return height * rng.uniform(PEAK / 3, PEAK / 1.5, BLOCKS), height


def _rock(breadth: Array, height: Array, motions: Array, threads: int) -> float:
    """Return the median of the seconds it takes, compiled before."""
    work = lambda: rock_blocks(breadth, height, motions, STEP, threads=threads)  # noqa: E731
    return statistics.median([timed(work) for _ in range(ROUNDS + 1)][1:])


def _steps(breadth: Array, height: Array, motions: Array) -> int:
    blocks = ensemble.to_kernel(ensemble.stack_bodies(breadth, height, math.nan, block.MIDDLE, 1.0), STEP)
    outcome = np.zeros((BLOCKS, MOTIONS, 3))
    return int(kernel.rock(blocks, ensemble.divide(motions, 1), 0, MOTIONS, outcome, np.zeros((0, 3))))


def _against(
    name: str, rival: Callable[[float, float, float, Array, float], bool], count: int, ours: float, aim: str
) -> str:
    """Return the row of a rival that follows `count` pairs one by one."""
    motions, (breadth, height) = _motions() / GRAVITY, _blocks()
    expected = rock_blocks(breadth, height, motions * GRAVITY, STEP).overturned
    alpha, eta = block.critical_angle(breadth, height), block.restitution(breadth, height)
    p, seconds, same = block.frequency_parameter(breadth, height), [], 0
    rival(alpha[0], p[0], eta[0], motions[0][:50], STEP)  # compiled here
    for pair in range(count):
        b, m = pair * 7 % BLOCKS, pair % MOTIONS
        start = time.perf_counter()
        same += rival(alpha[b], p[b], eta[b], motions[m], STEP) == expected[b, m]
        seconds.append(time.perf_counter() - start)
    mean = statistics.mean(seconds)
    return f"| kernel | {ours:.2e} | {name} | {mean:.2e} | {mean / ours:,.0f} | {aim} | {same} of {count} |"


def _verdicts() -> Iterator[str]:
    """Yield how often kernel and plain rule say what the reference says of the pairs of tests/rocking/pairs.py."""
    same, table = {"kernel": 0, "plain RK4": 0}, read_table()
    for row in table:
        one, (values, step) = of_sizes(float(row["breadth_m"]), float(row["height_m"])), ground(row["record"])
        motion, over = scaled(values, one, float(row["times_threshold"])), row["overturned"] == "1"
        found = rock_blocks(float(row["breadth_m"]), float(row["height_m"]), motion[None] * GRAVITY, step)
        same["kernel"] += bool(found.overturned[0, 0]) == over
        same["plain RK4"] += plain(one.alpha, one.p, one.eta, motion, step) == over
    for name, count in same.items():
        yield f"| {name} | {count} of {len(table)} ({count / len(table):.2%}) |"


def slow(alpha: float, p: float, eta: float, motion: Array, step: float) -> bool:
    """Tell whether a block overturns, as one would write it with scipy: impacts are events, and it starts again."""
    times, edge = np.arange(motion.size + 1) * step, 1.0
    values = np.append(motion, 0.0)
    now, state, end = 0.0, None, times[-1] + 60 * 0.05 / p

    def rates(t: float, y: Array) -> list[float]:
        ground = edge * np.interp(t, times, values, right=0.0)
        return [y[1], -p * p * (math.sin(alpha - y[0]) + ground * math.cos(alpha - y[0]))]

    def impact(t: float, y: Array) -> float:
        return float(y[0])

    def fall(t: float, y: Array) -> float:
        return float(y[0] - math.pi / 2)

    impact.terminal, impact.direction, fall.terminal = True, -1, True  # type: ignore[attr-defined]
    while now < end:
        if state is None:
            later = np.flatnonzero((np.abs(values) > math.tan(alpha)) & (times > now))
            if not later.size:
                return False
            at = int(later[0])
            before, edge = values[at - 1] if at else 0.0, -np.sign(values[at])
            share = (-edge * math.tan(alpha) - before) / (values[at] - before)
            now, state = max(now, times[at] - step * (1 - max(0.0, share))), [1e-12, 0.0]
        found = solve_ivp(rates, (now, end), state, events=(impact, fall), max_step=step, rtol=1e-5, atol=1e-7)
        if found.t_events[1].size:
            return True
        now, edge = found.t[-1], -edge
        speed = eta * abs(found.y[1, -1])
        state = [1e-12, speed] if speed > 1e-3 * p * alpha else None
    return False


@njit(fastmath=True, error_model="numpy")
def plain(alpha: float, p: float, eta: float, motion: Array, step: float) -> bool:
    """Tell whether a block overturns, by ten steps of Runge and Kutta a sample, with impacts at their ends."""
    dt, tan, pp = step / 10, math.tan(alpha), p * p
    phi, speed, edge, rests, sample = 0.0, 0.0, 1.0, True, -1
    while True:
        sample += 1
        here = motion[sample] if sample < motion.size else 0.0
        there = motion[sample + 1] if sample + 1 < motion.size else 0.0
        for part in range(10):
            ground = here + (there - here) * part / 10
            if rests:
                if abs(ground) <= tan:
                    continue
                rests, edge, phi, speed = False, -math.copysign(1.0, ground), 0.0, 0.0
            b0, half = edge * ground, edge * (there - here) / 20
            k1 = -pp * (math.sin(alpha - phi) + b0 * math.cos(alpha - phi))
            at = phi + dt / 2 * speed
            k2 = -pp * (math.sin(alpha - at) + (b0 + half) * math.cos(alpha - at))
            at = phi + dt / 2 * (speed + dt / 2 * k1)
            k3 = -pp * (math.sin(alpha - at) + (b0 + half) * math.cos(alpha - at))
            at = phi + dt * (speed + dt / 2 * k2)
            k4 = -pp * (math.sin(alpha - at) + (b0 + 2 * half) * math.cos(alpha - at))
            phi += dt * speed + dt * dt / 6 * (k1 + k2 + k3)
            speed += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            if phi < 0:
                phi, speed, edge = 0.0, -eta * speed, -edge
                rests = speed < pp * alpha * dt
            elif phi >= math.pi / 2:
                return True
        if sample >= motion.size:
            energy = speed * speed / 2 + pp * math.cos(alpha - phi)
            if rests or (phi < alpha and energy < pp):
                return False
