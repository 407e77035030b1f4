"""Work on the rows of an array, one motion each, in threads: no result depends on their number or on the other rows."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from assess.progress import Progress

GROUP = 20
"""Generated motions are made in groups of as many, always whole, from multiples of it. A group stays in the processor's
cache. Fourier transforms take rows a few at a time with vector instructions and the last ones without, and where one of
the two fuses multiplications with additions (arm64) their last digits differ: in whole groups the row alone decides."""


def run_rows(work: Callable[[int], object], count: int, threads: int, progress: Progress) -> None:
    """Call `work` with 0 to `count` - 1, in `threads` threads; `work` should release the interpreter's lock."""

    def run(row: int) -> None:
        progress.check()
        work(row)

    if threads == 1 or count == 1:
        for row in range(count):
            run(row)
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(run, range(count)))


def run_groups(work: Callable[[slice], object], count: int, threads: int, progress: Progress) -> None:
    """Call `work` with the rows of each group of `count` motions, in `threads` threads."""
    groups = -(-count // GROUP)
    run_rows(lambda at: work(slice(at * GROUP, min((at + 1) * GROUP, count))), groups, threads, progress)


def make_groups(
    make: Callable[[int], NDArray[np.float32]], first: int, count: int, samples: int, threads: int, progress: Progress
) -> NDArray[np.float32]:
    """Return motions `first` to `first + count - 1`, (count, samples); `make` returns a whole group by its number."""
    start, end = first // GROUP, -(-(first + count) // GROUP)
    motions = np.empty(((end - start) * GROUP, samples), np.float32)

    def fill(at: int) -> None:
        motions[at * GROUP : (at + 1) * GROUP] = make(start + at)

    run_rows(fill, end - start, threads, progress)
    return motions[first - start * GROUP :][:count]
