"""Benchmark of floors without records: their draws through beams, as a ratio to the same filters by scipy."""

from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path

import numpy as np
from scipy.fft import irfft
from scipy.signal import lfilter

from assess.arrays import Single
from assess.motion import beam, noise
from assess.motion.assumed import Building, FloorTarget, Ground
from assess.motion.beam import DAMPING, MODES, Beams, open_floor, solve_beam
from assess.motion.drawn_ground import build_beam_grid, draw_ground, fit_noise
from assess.motion.floor_medians import find_medians
from assess.motion.noise import Phases
from assess.progress import SILENT
from tests.benchmarks.measuring import compare, spent

AXES, DRAWS, ROUNDS = ("X", "Y"), 200, 5
FLOORS = {10: "at most 5", 60: "at most 20"}
GROUND, BUILDING = Ground(pga=3.0), Building(period=1.5, structure="frame")
GRID = build_beam_grid(BUILDING.longest)


def rows(_folder: Path) -> Iterator[str]:
    """Yield a table in Markdown: one thread, compiled before, earthquakes drawn afresh."""
    yield (
        f"| {DRAWS} draws of {GRID.count:,} samples, {len(AXES)} axes | processor seconds | "
        f"over scipy: FFT filtering and {MODES} recursions a draw | aim |\n|---|---|---|---|"
    )
    for floors, aim in FLOORS.items():
        seconds, _, ratio = compare(partial(_shake, floors), _filter, spent, ROUNDS)
        yield f"| {floors} floors without records | {seconds:.2f} | {ratio:.1f} | {aim} |"


def _shake(floors: int) -> None:
    """Draw the earthquakes, and make the motions of all floors, half of them with a PFA of their own."""
    noise.KEPT.forget()
    beam.KEPT.forget()
    for axis in AXES:

        def draw(group: int, axis: str = axis) -> Single:
            return draw_ground(GROUND, Phases(GRID, 1, axis), group, SILENT)

        beams = Beams(BUILDING, GRID, 1, axis, draw)
        for at in range(1, floors + 1):
            by_pfa, by_pfv = find_medians(BUILDING.period, at / floors, BUILDING.structure, GROUND.ratio)
            pga, pgv = GROUND.peaks
            target = FloorTarget(
                place=at / floors, pfa=pga * by_pfa, pfv=pgv * by_pfv, meets="medians" if at % 2 else "pfa"
            )
            open_floor(beams, target, 1, SILENT).realise(0, DRAWS, 1, SILENT)


@cache
def _steps() -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray]]]:
    """Return the gain of the filter, and numerator and denominator of each mode."""
    frequencies, logs = fit_noise(GROUND.ratio)
    gain = np.exp(np.interp(np.fft.rfftfreq(2 * GRID.count, GRID.time_step), frequencies, logs)).astype(np.float32)
    modes = []
    for period in (BUILDING.period or 1.0) * solve_beam(10.0)[0]:
        angle = 2 * np.pi * GRID.time_step / period
        damped, decay = angle * np.sqrt(1 - DAMPING**2), np.exp(-DAMPING * angle)
        cos, sin = decay * np.cos(damped), decay * np.sin(damped) / damped
        modes.append((np.array([1 - sin, 2 * (sin - cos), decay**2 - sin]), np.array([1, -2 * cos, decay**2])))
    return gain, modes


def _filter() -> None:
    """Make as many ground motions of white noise, and run the modes of each: no floor, no peak, no median."""
    gain, modes = _steps()
    for _ in AXES:
        random = np.random.default_rng(1)
        transforms = random.standard_normal((DRAWS, gain.size, 2), np.float32).view(np.complex64)[..., 0] * gain
        ground = irfft(transforms, 2 * GRID.count, axis=1, overwrite_x=True)[:, : GRID.count]
        for numerator, denominator in modes:
            lfilter(numerator.astype(np.float32), denominator.astype(np.float32), ground, axis=1)
