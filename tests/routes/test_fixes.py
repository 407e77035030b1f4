"""The set of pieces to fix: enough, and no piece in it too many."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.routes.couplings import Draws, build_couplings
from assess.routes.falls import Falls
from assess.routes.fixes import find_fixes

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
    falls = Falls.of([count / RUNS for count in counts], fell=fell)
    sets = draw(st.lists(st.lists(st.integers(0, n - 1), min_size=1, max_size=3, unique=True), min_size=1, max_size=5))
    return build_couplings(falls, [(at, 0) for at in range(n)], 1), sets


def blocked_by(sets):
    return lambda draws: np.any([draws.fell[:, one].all(axis=1) for one in sets], axis=0)


def chance(couplings, is_blocked, fixed):
    """Return the chance that a report goes by once these pieces are fixed."""
    free = np.array([item not in fixed for item, _ in couplings.keys])
    ways = [couplings.joint] if couplings.is_joint else [couplings.joint, couplings.independent, couplings.correlated]
    return max(float(one.weight @ is_blocked(Draws(one.keys, one.fell & free, one.weight))) for one in ways)


@QUICK
@given(routes(), st.sampled_from([0.005, 0.031, 0.11, 0.33, 0.77]))
def test_enough_and_none_too_many(drawn, risk):
    couplings, sets = drawn
    is_blocked = blocked_by(sets)
    steps, is_mended = find_fixes(couplings, is_blocked, risk)
    fixed = [step.item for step in steps]
    assert is_mended
    assert len(fixed) == len(set(fixed))
    assert chance(couplings, is_blocked, fixed) < risk
    for one in fixed:
        assert chance(couplings, is_blocked, [other for other in fixed if other != one]) >= risk
    left = chance(couplings, is_blocked, [])
    assert (left < risk) == (not steps)
    for count, step in enumerate(steps, 1):
        after = chance(couplings, is_blocked, fixed[:count])
        assert abs(step.left - after) < 1e-9
        assert abs(step.gain - (left - after)) < 1e-9
        left = after


@QUICK
@given(routes())
def test_what_no_piece_blocks_cannot_be_mended(drawn):
    couplings, _ = drawn
    assert find_fixes(couplings, lambda draws: np.ones(len(draws.fell), dtype=np.bool_), 0.03) == ([], False)
