"""Random numbers that are stratified: of few draws each part of a distribution has its share.

Draw k of a stream is the same whatever else is drawn, and however many draws there are.
"""

from collections.abc import Sequence

import numpy as np

from assess.arrays import FloatArray

BLOCK, BLOCKS = 25, 8
"""Draws among which each part of equal chance of the distribution comes once, and how many such blocks in turn divide
each part in the same way [-]."""


def draw_uniform(stream: Sequence[int], first: int, count: int) -> FloatArray:
    """Return draws of a stream, (count,), uniform from 0 to 1: of each `BLOCK` one in each of as many equal parts.

    Of `BLOCKS` blocks in turn those in one part lie in different ones of as many parts of it: 200 draws have one in
    each 200th. Draw k is the same whatever else is drawn.
    """
    each = BLOCK * BLOCKS
    start, last = first // each, -(-(first + count) // each)
    found = []
    for number in range(start, last):
        generator = np.random.default_rng([*stream, number])
        part = generator.permuted(np.tile(np.arange(BLOCK), (BLOCKS, 1)), axis=1)  # (blocks, draws of a block)
        within = generator.permuted(np.tile(np.arange(BLOCKS), (BLOCK, 1)), axis=1)  # (parts, blocks)
        inside = (np.take_along_axis(within.T, part, axis=1) + generator.random(part.shape)) / BLOCKS
        found.append(((part + inside) / BLOCK).ravel())
    return np.concatenate(found)[first - start * each :][:count]


def draw_normal(stream: Sequence[int], first: int, count: int, cut: float) -> FloatArray:
    """Return normal numbers of a stream, (count,), cut at `cut` standard deviations, stratified as `draw_uniform`."""
    return to_normal(draw_uniform(stream, first, count), -cut, cut)


def to_normal(uniform: FloatArray, low: FloatArray | float, high: FloatArray | float) -> FloatArray:
    """Return normal numbers between `low` and `high` from numbers that are uniform from 0 to 1."""
    from scipy.special import ndtr, ndtri

    first, last = ndtr(low), ndtr(high)
    return np.asarray(np.clip(ndtri(first + uniform * (last - first)), low, high))
