"""The study of solvers: limits in closed form, bands, physics of a flight, and what it writes."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st

from assess.studies.solver import (
    ALPHA,
    ETA,
    EXACT,
    KERNEL,
    LOOSE,
    NEAR,
    ODE23S,
    POINT,
    RK45,
    SIDE,
    STUDY,
    TIGHT,
    Case,
    Limit,
    P,
    Response,
    Solver,
    find_limit,
    follow,
    follow_near,
    read_limits,
    sample,
    solve_half_sine,
    tabulate_histories,
)  # fmt: skip
from assess.studies.study import Options, render_block
from tests.rocking.reference import Block, integrate

LINEAR, NONLINEAR = (Case("one_sine", equation, 5.0) for equation in ("linear", "nonlinear"))
LIMITS = read_limits()


def name(limit: Limit) -> str:
    return f"{limit.case.pulse}-{limit.case.equation}-{limit.printed}"


def test_limits_of_the_table_and_half_sines_in_closed_form():
    assert len(LIMITS) == 10
    assert [one.over_below for one in LIMITS[:3]] == [False, True, False]
    assert {one.case.ratio for one in LIMITS} == {1, 2, 4, 5, 8}
    for ratio, limit in ((1, 1.3224), (2, 1.8007), (4, 2.7908), (8, 4.7871)):
        found = solve_half_sine(ratio)
        assert found == pytest.approx(limit, abs=5e-5)
        left = found * math.exp(-(math.pi - math.asin(1 / found)) / ratio) + math.sqrt(found**2 - 1)
        assert left == pytest.approx(ratio)


@pytest.mark.parametrize("limit", [one for one in LIMITS if one.case.pulse == "half_sine"], ids=name)
@pytest.mark.parametrize(
    ("solver", "within"), [(EXACT, 1e-6), (KERNEL, 5e-6), (TIGHT, 5e-6), (RK45, 1e-3), (ODE23S, 1e-3)]
)
def test_half_sines_by_every_solver(limit, solver, within):
    exact = solve_half_sine(limit.case.ratio)
    for side in (-within, within):
        assert follow(limit.case, exact + side, solver).overturned == (side > 0)


@pytest.mark.parametrize(
    "limit",
    [
        pytest.param(one, marks=() if at in (0, 3) else pytest.mark.slow if at in (1, 4) else pytest.mark.long)
        for at, one in enumerate(LIMITS[:6])
    ],
    ids=name,
)
def test_one_sines_by_every_solver(limit):
    """DOP853 and the kernel share nothing but the equation; the others are as near as the page tells."""
    exact, kernel = find_limit(limit, EXACT), find_limit(limit, KERNEL)
    assert exact.limit == pytest.approx(limit.listed, abs=1.1e-3)
    assert kernel.limit == pytest.approx(exact.limit, abs=1e-5)
    assert exact.changes == kernel.changes == 1
    for solver, within in ((RK45, 3e-3), (ODE23S, 5e-4), (TIGHT, 5e-5)):
        for side in (-within, within):
            falls = follow(limit.case, exact.limit + side, solver).overturned
            assert falls == (limit.over_below if side < 0 else not limit.over_below)


@pytest.mark.parametrize("case", [LINEAR, NONLINEAR], ids=["linear", "nonlinear"])
@pytest.mark.parametrize("solver", [EXACT, RK45, ODE23S, KERNEL], ids=lambda one: one.name)
def test_verdicts_are_not_monotone(case, solver):
    """Safe, over with one impact, safe, over without."""
    seen = [follow(case, amplitude, solver) for amplitude in (2.5, 4.0, 6.95, 8.0)]
    assert [one.overturned for one in seen] == [False, True, False, True]
    assert (seen[1].impacts, seen[3].impacts) == (1, 0)


def check_verdict(amplitude, is_linear):
    """Assert that `tests.rocking.reference`, which integrates a record sample by sample, has the same verdict.

    No case here is nearer than 0.01 to a limit.
    """
    case = LINEAR if is_linear else NONLINEAR
    assume(all(abs(amplitude - one.listed) > 0.01 for one in LIMITS[:6] if one.case == case))
    assume(amplitude * ALPHA > 1.01 * case.threshold)
    values = amplitude * ALPHA * np.sin(np.linspace(0, 2 * math.pi, 401))
    values[-1] = 0.0
    found = integrate(Block(ALPHA, P, ETA, linear=is_linear), values, case.end / 400)
    one = follow(case, amplitude, TIGHT)
    assert one.overturned == found.overturned
    if one.overturned:
        assert one.impacts == found.impacts


@pytest.mark.slow
@settings(deadline=None, max_examples=8)
@given(st.floats(1.02, 9.0), st.booleans())
def test_the_same_verdicts_as_the_reference_of_the_kernel(amplitude, is_linear):
    check_verdict(amplitude, is_linear)


@pytest.mark.long
@settings(deadline=None, max_examples=30)
@given(st.floats(1.02, 9.0), st.booleans())
def test_many_of_the_same_verdicts(amplitude, is_linear):
    check_verdict(amplitude, is_linear)


@pytest.mark.parametrize("case", [LINEAR, NONLINEAR], ids=["linear", "nonlinear"])
def test_a_block_starts_where_the_sine_passes_its_threshold(case):
    start = case.start(3.0, 0.0)
    assert 3 * ALPHA * math.sin(5 * P * start) == pytest.approx(case.threshold)
    assert case.accelerate(0.0, -case.threshold) == pytest.approx(0.0, abs=1e-14)
    assert case.start(3.0, 0.1) == 0.1
    assert case.start(3.0, 0.3) == pytest.approx(start + math.pi / (5 * P))  # in the second lobe
    assert case.start(3.0, 0.57) == math.inf
    assert case.start(0.99, 0.0) == math.inf
    assert not follow(case, 0.99, RK45).impacts
    assert replace(case, pulse="half_sine").start(3.0, 0.3) == math.inf  # it has one lobe


def test_free_motion_of_the_linear_equation():
    """After the pulse, between impacts, theta - alpha sgn(theta) is a sum of exp(pt) and exp(-pt)."""
    response = follow(LINEAR, 2.5, EXACT, until=4.0)
    signs = np.sign(response.theta)
    inside = np.flatnonzero((response.times > LINEAR.end) & (signs != 0))
    h = POINT
    checked = 0
    for at in inside[1:-1]:
        steps = np.diff(response.times[at - 1 : at + 2])
        if np.allclose(steps, h, rtol=1e-9) and abs(signs[at - 1 : at + 2].sum()) == 3:
            left, here, right = response.theta[at - 1 : at + 2] - signs[at] * ALPHA
            assert left + right == pytest.approx(2 * math.cosh(P * h) * here, abs=1e-9)
            checked += 1
    assert checked > 200


def test_paths_agree_between_solvers():
    limit = LIMITS[4]
    paths = [sample(follow(limit.case, 5.0, one, until=5.4)) for one in (KERNEL, TIGHT, EXACT)]
    assert np.isnan(paths[2]).any()
    for one in paths[:2]:
        assert one == pytest.approx(paths[2], abs=2e-3, nan_ok=True)
    assert np.isnan(sample(Response(overturned=True))[1:]).all()


def test_histories_tell_the_pulse_and_stop_at_the_fall():
    limit = LIMITS[0]
    table = tabulate_histories([limit], follow_near([limit], Options(out=Path("unused"))))
    rows = list(table.rows)
    assert all(len(row) == len(table.columns) for row in rows)
    assert max(float(str(row[4])) for row in rows) == pytest.approx((limit.listed + NEAR) * ALPHA, rel=0.02)
    assert rows[0][5:] == (0.0, 0.0, 0.0)
    assert rows[-1][5] is None or abs(float(str(rows[-1][5]))) < math.pi / 2 / ALPHA


def test_a_loose_solver_moves_a_limit_and_one_that_fails_is_reported():
    found = find_limit(LIMITS[0], LOOSE[0])
    assert not abs(found.limit - LIMITS[0].listed) < 0.1
    assert not found.above.overturned
    with pytest.raises(ArithmeticError, match="at 3 alpha g"):
        follow(LINEAR, 3.0, Solver("RK45", "RK45", 1e-5, math.nan))


def test_limits_that_are_not_found_are_counted():
    found = find_limit(replace(LIMITS[0], printed="4.5"), RK45)
    assert math.isnan(found.limit)
    assert found.changes == 0
    assert render_block("solver", "missing", missing={"DOP853": 0, "RK45": 0}, side=SIDE) == []
    shown = render_block("solver", "missing", missing={"DOP853": 0, "RK45": 1, "RK45 loose": 2}, side=SIDE)
    assert shown == ["Not found within 0.16 alpha g of the listed limits, and left out: 1 by RK45, 2 by RK45 loose."]


@pytest.mark.long
@pytest.mark.slow
def test_the_study(tmp_path):
    shares: list[float] = []
    finding = STUDY.run(Options(out=tmp_path, report_share=shares.append))
    page = "\n".join(finding.page)
    assert "The paper chose ODE23s" in page
    assert "| ODE23s | 1e-05, 1e-07 | 0.0003" in page
    assert "20 of 20" in page
    assert "3.033 (+0.0007), 6.744 (+0.0010)" in page
    assert "nan" not in page
    assert "ot found" not in page
    assert len(finding.tables["solver-limits"].rows) == 70
    for table in finding.tables.values():
        assert {len(row) for row in table.rows} == {len(table.columns)}
    assert finding.figures["solver-histories.svg"].startswith(b"<?xml")
    assert shares == sorted(shares)
    assert shares[0] == 0 < shares[-1] < 1
