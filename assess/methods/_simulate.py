"""What simulations of many pieces under many motions share: batches, threads, and how many motions are enough."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, Cases, FloatArray, Motions
from assess.progress import SILENT, Progress
from assess.risk import NORMAL_95
from assess.rocking.draws import DrawnBodies, draw_bodies
from assess.settings import AUTO, Settings

LOOKS = (125, 250, 500, 1000, 2500, 5000)
"""Numbers of motions at which runs="auto" checks whether the interval of a piece lies within one class."""
LOOKS_Z = 2.64
"""Half width of the intervals of "auto" [-]: 95 % for all six checks together (Bonferroni, 0.83 % each)."""

_Result = TypeVar("_Result")


def interval_width(settings: Settings) -> float:
    """Return z, the half width of the intervals in standard deviations [-]."""
    return LOOKS_Z if settings.runs == AUTO else NORMAL_95


def run_side_by_side(work: Callable[..., _Result], tasks: list[Any], threads: int) -> Iterator[_Result]:
    """Yield the results of `work` in the order of `tasks`, several of which are worked on at once.

    Never in the calling thread: a Ctrl-C that arrives during a compilation would be lost there.
    """
    if not tasks:
        return
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(threads)
    try:
        yield from [future.result() for future in [pool.submit(work, *task) for task in tasks]]
    finally:
        pool.shutdown(wait=False, cancel_futures=True)  # after Ctrl-C nobody waits for the rest


def make_batches(motions: Motions, first: int, last: int, size: int) -> Iterator[tuple[int, FloatArray, float]]:
    """Yield motions `first` to `last` - 1: the number of the first of a batch, the batch, its time step."""
    at = first
    for start in range(first, last, size):
        for batch, time_step in motions.realise(start, min(size, last - start)):
            yield at, batch, time_step
            at += len(batch)


def rock_cases(
    cases: Cases,
    own: NDArray[np.intp],
    motions: NDArray[Any],
    time_step: float,
    threads: int,
    progress: Progress = SILENT,
) -> tuple[BoolArray, FloatArray]:
    """Return whether each of the cases `own`, as it is given, overturns under each motion, and how far it turns.

    (m, k) each.
    """
    from assess.rocking.ensemble import rock_blocks

    found = rock_blocks(
        cases.breadth[own], cases.height[own], motions, time_step,
        restitution=cases.restitution[own], centre=cases.centre[own], threads=threads, progress=progress,
    )  # fmt: skip
    return found.overturned, found.rotation


def draw_body(cases: Cases, own: NDArray[np.intp], seed: int, first: int, count: int) -> DrawnBodies:
    """Return the bodies of the cases `own` in each draw, (m, k) each: as given where pieces are not uncertain."""
    shape = cases.breadth[own], cases.height[own], cases.centre[own], cases.restitution[own]
    if cases.uncertainty.piece:
        return draw_bodies(*shape, cases.name[own], seed=seed, first=first, count=count, scanned=cases.scanned[own])
    return DrawnBodies(*(np.repeat(one[:, None], count, axis=1) for one in shape))


def rock_draws(
    cases: Cases,
    own: NDArray[np.intp],
    motions: NDArray[Any],
    time_step: float,
    *,
    first: int,
    dispersions: Sequence[float | FloatArray],
    seed: int,
    threads: int,
    progress: Progress = SILENT,
) -> tuple[BoolArray, FloatArray]:
    """Return whether each of the cases `own` overturns in each draw, and how far it turns: (d, m, k) each.

    Motion k of `motions`, draw `first` + k, is scaled by one factor for the whole building, and the pieces are those of
    that draw where they are uncertain; once for each of d `dispersions` of the motion, of all cases or of each (m,).
    """
    from assess.rocking.ensemble import rock_blocks

    count = len(motions)
    drawn = draw_body(cases, own, seed, first, count)
    b, h, z, eta = drawn.breadth, drawn.height, drawn.centre, drawn.restitution
    numbers = cases.earthquakes.draw(seed, first, count)
    scales = [np.exp(np.broadcast_to(one, own.size)[:, None] * numbers) for one in dispersions]
    every = len(dispersions), 1
    found = rock_blocks(
        np.tile(b, every), np.tile(h, every), motions, time_step,
        restitution=np.tile(eta, every), centre=np.tile(z, every), scale=np.concatenate(scales),
        threads=threads, progress=progress,
    )  # fmt: skip
    wanted = len(dispersions), own.size, count
    return found.overturned.reshape(wanted), found.rotation.reshape(wanted)
