"""The width left between fallen pieces, against every chain of them and against a person who walks through."""

import math
from itertools import pairwise, permutations

import numpy as np
import shapely
from hypothesis import given, settings, strategies as st

from assess.routes.chances import to_array, to_sets
from assess.routes.obstructions import Gaps, find_obstructions
from tests.routes.buildings import CORRIDOR, building, corridor, piece

QUICK = settings(max_examples=40, deadline=None)
WIDTHS = st.sampled_from([0.0, 0.1, 0.25, 0.5, 0.9, 1.0, 1.3, 2.0, math.inf])


@st.composite
def gaps(draw, most=5):
    """Draw obstacles with any gaps: some stand there anyway, some reach in from a wall, as one of three pieces."""
    m = draw(st.integers(1, most))
    sided = np.array([draw(st.sampled_from([0, 0, 1, -1, 2, -2, 3, -3])) for _ in range(m)], dtype=np.intp)
    between = np.full((m, m), math.inf)
    for at in range(m):
        for other in range(at):
            one, two = sided[at], sided[other]
            if not (one and two) or (one * two < 0 and one != -two):
                between[at, other] = between[other, at] = draw(WIDTHS)
    column = np.array([draw(st.sampled_from([-1, at, at, at])) for at in range(m)], dtype=np.intp)
    left, right = (np.array([draw(WIDTHS) for _ in range(m)]) for _ in range(2))
    left[sided > 0], right[sided < 0] = 0.0, 0.0
    clear = draw(st.sampled_from([0.9, 1.5, 3.0]))
    return Gaps(tuple((at, 0) for at in range(m)), column, left, right, between, sided, clear)


def by_every_chain(one, fell):
    """Return the least of the widest gaps of all chains from wall to wall in which no piece is on both sides."""
    there = [at for at, needs in enumerate(one.column) if needs < 0 or fell[needs]]
    least = one.clear
    for size in range(1, len(there) + 1):
        for chain in permutations(there, size):
            own = {int(one.sided[at]) for at in chain}
            if not any(-number in own for number in own - {0}):
                steps = [one.between[pair] for pair in pairwise(chain)]
                least = min(least, max(one.left[chain[0]], *steps, one.right[chain[-1]]))
    return least


def patterns(n):
    return np.array([[(at >> bit) & 1 for bit in range(n)] for at in range(2**n)], dtype=np.bool_)


@QUICK
@given(gaps())
def test_against_every_chain(one):
    """The width that is left in every pattern, and in which patterns it is under a given one."""
    fell = patterns(len(one.keys))
    left = [one.residual(row) for row in fell]
    assert left == [by_every_chain(one, row) for row in fell]
    fallen = dict(zip(one.keys, to_sets(fell), strict=True))
    for width in (0.0, 0.05, 0.2, 0.25, 0.26, 0.7, 0.95, 1.2, 1.5, 2.5, 3.1):
        found = to_array(one.narrower(fallen, 2 ** len(fell) - 1, width), len(fell))
        assert found.tolist() == [least < width for least in left]


@QUICK
@given(gaps(most=8), st.data())
def test_more_fallen_pieces_never_widen(one, data):
    fell = np.array(data.draw(st.lists(st.booleans(), min_size=len(one.keys), max_size=len(one.keys))), dtype=np.bool_)
    more = fell | np.array(data.draw(st.lists(st.booleans(), min_size=fell.size, max_size=fell.size)), dtype=np.bool_)
    assert one.residual(more) <= one.residual(fell) <= one.clear


def test_many_pieces_in_many_draws():
    """70 pieces in 100 draws: in each, what is left is under a hair more than its width, and not under a hair less.

    Pieces that are not told of stand.
    """
    rng = np.random.default_rng(1)
    m = 70
    between = rng.uniform(0.3, 3, (m, m))
    left, right = rng.uniform(0.3, 3, (2, m))
    keys, between = tuple((at, 0) for at in range(m)), np.maximum(between, between.T)
    one = Gaps(keys, np.arange(m), left, right, between, np.zeros(m, dtype=np.intp), 2.0)
    fell = rng.random((100, m)) < 0.2
    fell[:, 7] = False
    fallen = {key: falls for key, falls in zip(keys, to_sets(fell), strict=True) if key != (7, 0)}
    widths = [one.residual(row) for row in fell]
    assert len(set(widths)) > 10
    for at, width in enumerate(widths):
        for limit, is_under in ((width - 1e-9, False), (width + 1e-9, True)):
            assert bool(one.narrower(fallen, 2**100 - 1, limit) >> at & 1) == is_under


def passes(width, obstacles):
    """Tell whether a person of a width walks from end to end of the corridor between obstacles."""
    half = width / 2
    room = shapely.box(-3, -0.9 + half, 13, 0.9 - half)
    free = room.difference(shapely.union_all([one.buffer(half, quad_segs=64) for one in obstacles]))
    return any(part.bounds[0] < -2.9 and part.bounds[2] > 12.9 for part in getattr(free, "geoms", [free]))


placed = st.builds(
    lambda x, y, angle, height: piece(height, x=x, y=y, angle_deg=angle, breadth=0.3, width=0.6),
    st.floats(4, 6), st.floats(-1.5, 1.5), st.floats(0, 180), st.floats(0.2, 0.9),
)  # fmt: skip


@QUICK
@given(st.lists(placed, min_size=1, max_size=5))
def test_as_wide_as_a_person_can_be(items):
    """On the plan: somewhat less than what is left passes, somewhat more does not."""
    (one,) = find_obstructions(building(items, [corridor()], CORRIDOR))
    inside = shapely.box(-1, -0.9, 11, 0.9)
    shapes = []
    for item in items:  # what each may cover, standing and fallen either way, worked out from its corners
        along = np.array([math.cos(math.radians(item.angle_deg)), math.sin(math.radians(item.angle_deg))])
        across, reach = np.array([-along[1], along[0]]) * 0.3, along * (0.15 + item.height)
        signs = ((1, 1), (1, -1), (-1, -1), (-1, 1))
        corners = [(item.x, item.y) + sign * reach + side * across for sign, side in signs]
        shapes.append(shapely.Polygon(corners).intersection(inside))
    left = one.gaps.residual(np.ones(len(one.gaps.keys), dtype=np.bool_))
    shapes = [shape for shape in shapes if shape.area > 1e-6]
    if left > 0.05:
        assert passes(left - 0.02, shapes)
    if left < 1.75:
        assert not passes(left + 0.02, shapes)
