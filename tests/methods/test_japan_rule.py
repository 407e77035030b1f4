"""Japanese rule: B/√H up to 4 must be fixed, whatever the motion."""

import numpy as np
import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.japan_rule import LIMIT, METHOD
from assess.settings import Settings


def evaluate(breadth_cm: ArrayLike, height_cm: ArrayLike, **given: ArrayLike) -> Outcome:
    cases = Cases.of(breadth=np.asarray(breadth_cm) * 0.01, height=np.asarray(height_cm) * 0.01, **given)
    return METHOD.evaluate(cases, Settings())


def test_the_limit_itself_must_be_fixed_whatever_the_binary_dust():
    assert LIMIT == 4
    assert evaluate([39.9, 40.0, 40.1], 100).value.tolist() == [1, 1, 0]
    root = np.arange(5, 25)  # 4·14 = 56 cm at 196 cm, as 0.56 m: 56.00000000000001
    assert evaluate(4.0 * root, root**2).value.tolist() == [1] * len(root)
    assert evaluate(32.1, 73.7).detail["breadth_over_root_height"][0] == pytest.approx(3.74, abs=0.005)


def test_no_motion_enters():
    assert evaluate(40, 180).value.tolist() == evaluate(40, 180, pfa=0.0, pfv=0.0).value.tolist() == [1]
    assert METHOD.needs == {"breadth", "height"}
