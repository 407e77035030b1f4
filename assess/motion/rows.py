"""Work on the rows of an array, one motion each, in threads: no result depends on their number or on the other rows."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.progress import Progress


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


LANES = 4
"""Rows that a Fourier transform takes at once."""


def transform_rows(
    transform: Callable[..., Any], rows: NDArray[Any], length: int, threads: int, progress: Progress
) -> NDArray[Any]:
    """Return `scipy.fft.rfft` or its like of every row: equal to the bit whatever the other rows and the threads are.

    The library takes rows a few at a time with vector instructions and the last ones without: where one of the two
    fuses multiplications with additions (arm64), their last digits differ. So every call takes equally many rows.
    """
    groups = -(-len(rows) // LANES)
    parts: list[NDArray[Any]] = [rows[:0]] * groups

    def run(group: int) -> None:
        taken = rows[group * LANES : (group + 1) * LANES]
        padded = np.concatenate([taken, np.zeros((LANES - len(taken), rows.shape[1]), dtype=rows.dtype)])
        parts[group] = transform(padded, length, axis=1)[: len(taken)]

    run_rows(run, groups, threads, progress)
    return np.concatenate(parts)
