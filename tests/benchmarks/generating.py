"""Benchmark of motions: spectra and realisations against eqsig, 200 for one floor against Fourier transforms."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from eqsig import sdof
from scipy.fft import irfft

from assess.motion import noise
from assess.motion.generate import build_generator
from assess.motion.spectrum import build_periods, response_spectrum
from assess.motion.target import Grid, recorded_target
from tests.benchmarks.measuring import compare, spent, timed
from tests.motion.motions import cut, read_motion

STEP, SAMPLES, SHORT, MOTIONS, ROUNDS = 0.005, 12_000, 4000, 200, 7
PERIODS = build_periods(count=100)
AIM = "at most 0.4 s, better 0.25 s"


def rows(_folder: Path) -> Iterator[str]:
    """Yield tables in Markdown; all is compiled before."""
    yield f"| motions of {SHORT:,} samples | seconds | rival | seconds | times as fast | aim |"
    yield "|---|---|---|---|---|---|"
    yield from _against_eqsig()
    yield ""
    yield from _against_transforms()


def _against_eqsig() -> Iterator[str]:
    """Yield the rows of one spectrum of 575 Market Street's 42nd floor, and of 100 realisations on two threads."""
    grid = Grid(STEP, SHORT)
    motion = cut("a", 0, grid.duration)
    ours, theirs, ratio = compare(
        lambda: [response_spectrum(motion.acceleration, STEP, PERIODS) for _ in range(50)],
        lambda: sdof.pseudo_response_spectra(motion.acceleration, STEP, PERIODS, 0.05), timed, ROUNDS,
    )  # fmt: skip
    yield f"| spectrum, 100 periods | {ours / 50:.5f} | eqsig | {theirs:.3f} | {50 / ratio:.0f} | at least 50 |"
    target = recorded_target(motion, grid)
    made = build_generator(target, grid, seed=1, axis="X", threads=2).realise()
    ours, theirs, ratio = compare(
        lambda: build_generator(target, grid, seed=1, axis="X", threads=2),
        lambda: [sdof.pseudo_response_spectra(one, STEP, PERIODS, 0.05) for one in made], timed, 2,
    )  # fmt: skip
    rival = "eqsig: the 100 spectra of these motions"
    yield f"| 100 realisations, two threads | {ours:.2f} | {rival} | {theirs:.1f} | {1 / ratio:.1f} | at most 2 s |"


def _against_transforms() -> Iterator[str]:
    """Yield the rows of 200 motions of one floor on one thread: the target, its fit and its spectra included."""
    motion, grid = read_motion("a"), Grid(STEP, SAMPLES)

    def make() -> None:
        target = recorded_target(motion, grid)
        build_generator(target, grid, seed=1, axis="X").realise(0, MOTIONS)

    def make_afresh() -> None:
        noise.KEPT.forget()
        make()

    values = np.random.default_rng(1).standard_normal((2 * MOTIONS, SAMPLES // 2 + 1)).astype(np.complex64)
    name = f"{MOTIONS} motions of {SAMPLES:,} samples"
    yield f"| {name} | processor seconds | over {2 * MOTIONS} inverse FFTs of that length | aim |\n|---|---|---|---|"
    for words, work in (("first floor of a building", make_afresh), ("further floors", make)):
        seconds, _, ratio = compare(work, lambda: irfft(values, SAMPLES, axis=1), spent, ROUNDS)
        yield f"| {words} | {seconds:.3f} | {ratio:.0f} | {AIM} |"
