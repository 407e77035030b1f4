"""The set of pieces to fix: enough, and no piece in it too many."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from assess.routes.chances import Key, build_couplings, to_array, union
from assess.routes.fixes import find_fixes
from tests.routes.buildings import make_falls

QUICK = settings(max_examples=60, deadline=None)
RUNS = 20


@st.composite
def routes(draw):
    """Draw pieces, and which sets of them block a route (none of which is empty)."""
    n = draw(st.integers(1, 6))
    counts = [draw(st.integers(0, RUNS)) for _ in range(n)]
    rng = np.random.default_rng(draw(st.integers(0, 999)))
    fell = {
        at: rng.permutation(RUNS) < count
        for at, count in enumerate(counts)
        if draw(st.booleans()) or draw(st.booleans())
    }
    falls = make_falls([count / RUNS for count in counts], fell=fell)
    sets = draw(st.lists(st.lists(st.integers(0, n - 1), min_size=1, max_size=3, unique=True), min_size=1, max_size=5))
    return build_couplings(falls, [(at, 0) for at in range(n)], 1), sets


@dataclass(frozen=True)
class Together:
    """A segment that is blocked where all of some pieces fall."""

    pieces: list[int]

    @property
    def keys(self) -> tuple[Key, ...]:
        return tuple((item, 0) for item in self.pieces)

    def blocked(self, fallen: Mapping[Key, int], every: int) -> int:
        for key in self.keys:
            every &= fallen.get(key, 0)
        return every


def lanes(sets):
    return {at: Together(one) for at, one in enumerate(sets)}


def chance(couplings, sets, fixed):
    """Return the chance that a report goes by once these pieces are fixed."""
    ways = [couplings.joint] if couplings.is_joint else [couplings.joint, couplings.independent, couplings.correlated]
    found = []
    for one in ways:
        count = len(one.weight)
        fell = {item: to_array(0 if item in fixed else falls, count) == 1 for (item, _), falls in one.fallen.items()}
        happens = [np.all([fell[item] for item in own], axis=0) for own in sets]
        found.append(float(one.weight @ np.any(happens, axis=0)) if sets else 0.0)
    return max(found)


@QUICK
@given(routes(), st.sampled_from([0.005, 0.031, 0.11, 0.33, 0.77]))
def test_enough_and_none_too_many(drawn, risk):
    couplings, sets = drawn
    steps, is_fixed = find_fixes(couplings, lanes(sets), lambda blocked, _: union(blocked.values()), risk)
    fixed = [item for item, _, _ in steps]
    assert is_fixed
    assert len(fixed) == len(set(fixed))
    assert chance(couplings, sets, fixed) < risk
    for one in fixed:
        assert chance(couplings, sets, [other for other in fixed if other != one]) >= risk
    left = chance(couplings, sets, [])
    assert (left < risk) == (not steps)
    for count, (_, gain, after_step) in enumerate(steps, 1):
        after = chance(couplings, sets, fixed[:count])
        assert abs(after_step - after) < 1e-9
        assert abs(gain - (left - after)) < 1e-9
        left = after


@QUICK
@given(routes(), st.sampled_from([0.005, 0.11, 0.33]), st.data())
def test_with_another_way_open(drawn, risk, data):
    """The route is blocked only where two lanes are, one of each half: what is fixed on one may open it or not."""
    couplings, sets = drawn
    half = data.draw(st.integers(0, len(sets)))
    first, second = sets[:half], sets[half:]

    def both(blocked, _every):
        return union(blocked[at] for at in range(half)) & union(blocked[at] for at in range(half, len(sets)))

    steps, is_fixed = find_fixes(couplings, lanes(sets), both, risk)
    pairs = [sorted({*one, *other}) for one in first for other in second]
    fixed = [item for item, _, _ in steps]
    assert is_fixed
    left = chance(couplings, pairs, [])
    assert (left < risk) == (not steps)
    for count, (_, _, after_step) in enumerate(steps, 1):
        assert after_step == pytest.approx(chance(couplings, pairs, fixed[:count]), abs=1e-9)
        least = min(
            chance(couplings, pairs, [*fixed[: count - 1], other]) for other in {one for own in pairs for one in own}
        )
        if len(steps) == 1 and least < left:
            assert after_step == pytest.approx(least, abs=1e-9)  # the first step takes the piece that gains most
    assert chance(couplings, pairs, fixed) < risk or not pairs
    for one in fixed:
        assert chance(couplings, pairs, [other for other in fixed if other != one]) >= risk


@QUICK
@given(routes())
def test_what_no_piece_blocks_cannot_be_mended(drawn):
    couplings, sets = drawn
    assert find_fixes(couplings, lanes(sets), lambda _, every: every, 0.03) == ([], False)
