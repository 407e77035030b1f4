"""The kernel against the reference on 2,116 pairs of block and real record, and the reference against its table."""

import numpy as np
import pytest
from scipy.stats import binomtest

from assess.rocking.ensemble import rock_blocks
from assess.units import GRAVITY
from tests.rocking.pairs import COUNT, HEADS, ROOT, TABLE, draw_pairs, find, ground, read_table
from tests.rocking.reference import integrate, of_sizes, scaled

ROWS = read_table()
OVER = np.array([row["overturned"] == "1" for row in ROWS])
ROBUST = np.array([row["robust"] == "1" for row in ROWS])
ROTATION = np.array([float(row["max_rotation_ratio"]) for row in ROWS])
TIMES = np.array([float(row["times_threshold"]) for row in ROWS])


def sizes(row: dict[str, str]) -> tuple[float, float]:
    return float(row["breadth_m"]), float(row["height_m"])


def motion(row):
    """Return the accelerations of a row [g] and their time step [s]."""
    values, step = ground(row["record"])
    return scaled(values, of_sizes(*sizes(row)), float(row["times_threshold"])), step


@pytest.fixture(scope="module")
def found():
    """Return verdicts, rotations and impacts by the kernel."""
    results = []
    for row in ROWS:
        values, step = motion(row)
        one = rock_blocks(*sizes(row), values[None] * GRAVITY, step)
        results.append((one.overturned[0, 0], one.rotation[0, 0], one.impacts[0, 0]))
    return [np.array(column) for column in zip(*results, strict=True)]


# --- the table ---


@pytest.mark.slow
def test_the_table_is_of_the_pairs_that_are_drawn():
    assert tuple(ROWS[0]) == HEADS
    assert len(ROWS) == COUNT >= 2000
    drawn = [(name, f"{b}", f"{h}", f"{times}") for name, b, h, times in draw_pairs()]
    assert [tuple(row[head] for head in HEADS[:4]) for row in ROWS] == drawn
    assert all((ROOT / row["record"]).is_file() for row in ROWS)
    assert TABLE.stat().st_size < 500_000


def test_the_table_is_worth_comparing():
    assert 0.05 < OVER.mean() < 0.95
    assert ROBUST.mean() > 0.5
    assert ((ROTATION > 0.1) & ~OVER).sum() > 200
    assert len({row["record"] for row in ROWS}) >= 20


@pytest.mark.parametrize("count", [pytest.param(8, marks=pytest.mark.slow), pytest.param(25, marks=pytest.mark.long)])
def test_the_table_is_what_the_reference_says(count):
    """Pairs of few impacts, which take it the least time and do not hang on rounding."""
    few = [row for row in ROWS if 0 < int(row["impacts"]) <= 40 and row["robust"] == "1"]
    for row in few[:: len(few) // count]:
        values, step = motion(row)
        one = integrate(of_sizes(*sizes(row)), values, step)
        assert (one.overturned, one.impacts) == (row["overturned"] == "1", int(row["impacts"]))
        assert one.rotation == pytest.approx(float(row["max_rotation_ratio"]), rel=1e-6)


@pytest.mark.parametrize(
    "robust", [pytest.param("0", marks=pytest.mark.slow), pytest.param("1", marks=pytest.mark.long)]
)
def test_robust_is_what_the_reference_says(robust):
    """A pair is robust if it does the same at all of seven amplitudes within 2 %."""
    row = next(row for row in ROWS if row["robust"] == robust and 0 < int(row["impacts"]) <= 40)
    pair = (row["record"], *sizes(row), float(row["times_threshold"]))
    assert find(pair)[-1] == int(robust)


# --- the kernel ---


def test_robust_pairs_agree_as_many_overturn_and_disagreements_go_to_both_sides(found):
    assert (found[0] == OVER)[ROBUST].mean() >= 0.995
    assert abs(found[0].mean() - OVER.mean()) <= 0.005
    more, fewer = int((found[0] & ~OVER).sum()), int((~found[0] & OVER).sum())
    assert more + fewer == 0 or binomtest(more, more + fewer).pvalue > 0.05


def test_rotations_of_robust_pairs_agree(found):
    both = ROBUST & ~OVER & ~found[0] & (ROTATION < 1) & ((ROTATION > 0) | (found[1] > 0))
    assert both.sum() > 500
    error = np.abs(found[1][both] / ROTATION[both] - 1)
    assert np.median(error) <= 1e-6
    assert np.quantile(error, 0.9) <= 1e-4


def test_below_the_threshold_nothing_moves(found):
    below = TIMES < 1
    assert below.sum() > 100
    assert not found[0][below].any()
    assert not found[1][below].any()
    assert not found[2][below].any()
    assert not ROTATION[below].any()
    assert found[1][TIMES > 1].all()
