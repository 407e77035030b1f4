"""Benchmark of motions: 200 for one floor and axis, in processor time and as a ratio to Fourier transforms."""

import statistics
from collections.abc import Iterator

import numpy as np
from scipy.fft import irfft

from assess.motion import noise
from assess.motion.generate import build_generator
from assess.motion.target import Grid, recorded_target
from tests.benchmarks.measuring import spent
from tests.motion.motions import read_motion

STEP, SAMPLES, MOTIONS, ROUNDS = 0.005, 12_000, 200, 7
AIM = "at most 0.4 s, better 0.25 s"


def rows() -> Iterator[str]:
    """Yield a table in Markdown: one thread, compiled before, the target, its fit and its spectra included."""
    motion, grid = read_motion("a"), Grid(STEP, SAMPLES)

    def make() -> None:
        target = recorded_target(motion, grid)
        build_generator(target, grid, seed=1, axis="X").realise(0, MOTIONS)

    def make_afresh() -> None:
        noise.KEPT.forget()
        make()

    values = np.random.default_rng(1).standard_normal((2 * MOTIONS, SAMPLES // 2 + 1)).astype(np.complex64)
    make()
    name = f"{MOTIONS} motions of {SAMPLES:,} samples"
    yield f"| {name} | processor seconds | over {2 * MOTIONS} inverse FFTs of that length | aim |\n|---|---|---|---|"
    for words, work in (("first floor of a building", make_afresh), ("further floors", make)):
        pairs = [(spent(work), spent(lambda: irfft(values, SAMPLES, axis=1))) for _ in range(ROUNDS)]
        seconds, ratio = statistics.median(own for own, _ in pairs), statistics.median(a / b for a, b in pairs)
        yield f"| {words} | {seconds:.3f} | {ratio:.0f} | {AIM} |"


if __name__ == "__main__":
    for row in rows():
        print(row)
