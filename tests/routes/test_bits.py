"""Sets of draws as bits, against arrays of booleans."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from assess.routes.bits import to_array, to_sets, union
from assess.routes.draws import Draws


@given(st.tuples(st.integers(1, 70), st.integers(0, 4)).flatmap(lambda shape: arrays(np.bool_, shape)))
def test_sets(happens):
    sets, m = to_sets(happens), len(happens)
    for one, row in zip(sets, happens.T, strict=True):
        assert (to_array(one, m) == row).all()
        assert one.bit_count() == row.sum()
    assert (to_array(union(sets), m) == happens.any(axis=1)).all()


@given(st.integers(1, 70).flatmap(lambda m: arrays(np.bool_, (m, 1))), st.booleans())
def test_what_a_set_of_draws_weighs(fell, is_even):
    m = len(fell)
    weight = np.ones(m) if is_even else np.arange(1.0, m + 1)
    draws = Draws.of([(0, 0)], fell, weight / weight.sum())
    assert draws.share(draws.fallen[0, 0]) == pytest.approx(weight[fell[:, 0]].sum() / weight.sum(), abs=1e-12)
