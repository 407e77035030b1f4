"""Overturning limits of a block under sine and cosine pulses, published and in closed form.

Zhang J, Makris N (2001). Rocking response of free-standing blocks under cycloidal pulses. Journal of Engineering
Mechanics 127(5):473-483. Their limits are those of the linear equation of slender blocks; those of eq. 3 have the same
pattern: safe, over with an impact, safe again, over without one.
"""

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from assess.rocking.ensemble import rock_blocks
from assess.units import GRAVITY
from tests.rocking.reference import Block, integrate

FACTS = Path(__file__).parents[2] / "assess" / "studies" / "facts" / "rocking_pulses.csv"
with FACTS.open(encoding="utf-8") as file:
    ROWS = list(csv.DictReader(line for line in file if not line.startswith("#")))

P, ALPHA, ETA = 2.14, 0.25, 0.9


def chosen(pulse: str, equation: str) -> list[dict[str, str]]:
    return [row for row in ROWS if (row["pulse"], row["equation"]) == (pulse, equation)]


def name(row: dict[str, str]) -> str:
    return f"{row['pulse']}-{row['equation']}-{row['frequency_ratio']}-{row['limit']}"


def chosen_slow(pulse: str) -> list[Any]:
    """Return the linear rows of a pulse, which the reference takes seconds for: all but the first are long."""
    first, *others = chosen(pulse, "linear")
    rows = [(first, pytest.mark.slow), *((row, pytest.mark.long) for row in others)]
    return [pytest.param(row, marks=mark, id=name(row)) for row, mark in rows]


def sine(amplitude: float, threshold: float, omega: float, end: float, samples: int) -> tuple[np.ndarray, float]:
    """Return a sine of `amplitude` from the instant it passes `threshold` to the phase `end`, and the time step."""
    start = math.asin(threshold / amplitude)
    values = amplitude * np.sin(np.linspace(start, end, samples + 1))
    values[0], values[-1] = threshold, 0.0
    return values, (end - start) / omega / samples


def rock(values: np.ndarray, time_step: float, p: float, alpha: float, eta: float = math.nan) -> tuple[bool, int]:
    """Return verdict and impacts by the kernel, of accelerations [g]."""
    diagonal = 3 * GRAVITY / (2 * p**2)
    breadth, height = diagonal * math.sin(alpha), diagonal * math.cos(alpha)
    found = rock_blocks(breadth, height, values[None] * GRAVITY, time_step, restitution=eta)
    return bool(found.overturned[0, 0]), int(found.impacts[0, 0])


def check(row: dict[str, str], below: tuple[bool, int], above: tuple[bool, int]) -> None:
    assert below[0] == (row["below"] == "yes")
    assert above[0] == (row["above"] == "yes")
    if row["impacts_above"]:
        assert above[1] == int(row["impacts_above"])


def test_all_rows_are_checked_below() -> None:
    assert len(chosen("one_sine", "linear")) == len(chosen("one_sine", "nonlinear")) == 3
    assert len(chosen("half_sine", "linear")) == 4
    assert len(ROWS) == 10


@pytest.mark.parametrize("row", chosen_slow("one_sine"))
def test_one_sine_linear_by_the_reference(row: dict[str, str]) -> None:
    def follow(times: float) -> tuple[bool, int]:
        omega = P * float(row["frequency_ratio"])
        values, step = sine(times * ALPHA, ALPHA, omega, 2 * math.pi, 400)
        found = integrate(Block(ALPHA, P, ETA, linear=True), values, step)
        return found.overturned, found.impacts

    limit = float(row["limit"])
    check(row, follow(limit - 0.0015), follow(limit + 0.0015))


@pytest.mark.parametrize("row", chosen("one_sine", "nonlinear"), ids=name)
def test_one_sine_by_the_kernel(row: dict[str, str]) -> None:
    def follow(times: float) -> tuple[bool, int]:
        omega = P * float(row["frequency_ratio"])
        return rock(*sine(times * ALPHA, math.tan(ALPHA), omega, 2 * math.pi, 4000), P, ALPHA, ETA)

    limit = float(row["limit"])
    check(row, follow(limit - 0.0015), follow(limit + 0.0015))


@pytest.mark.parametrize("row", chosen("half_sine", "linear"), ids=name)
def test_half_sine_in_closed_form(row: dict[str, str]) -> None:
    """A block that leaves at alpha g and stands at the critical angle, at rest, infinitely long after the lobe."""

    def ratio(x: float) -> float:
        return x * math.exp(-(math.pi - math.asin(1 / x)) / omega) + math.sqrt(x**2 - 1)

    omega, limit = float(row["frequency_ratio"]), float(row["limit"])
    assert ratio(limit - 0.00005) < omega < ratio(limit + 0.00005)


@pytest.mark.parametrize("row", chosen_slow("half_sine"))
def test_half_sine_linear_by_the_reference(row: dict[str, str]) -> None:
    def follow(times: float) -> tuple[bool, int]:
        values, step = sine(times * ALPHA, ALPHA, P * float(row["frequency_ratio"]), math.pi, 400)
        found = integrate(Block(ALPHA, P, ETA, linear=True), values, step)
        return found.overturned, found.impacts

    limit = float(row["limit"])
    check(row, follow(limit - 0.0002), follow(limit + 0.0002))


@pytest.mark.parametrize(("alpha", "within"), [(0.02, 0.0002), (0.05, 0.0005), (0.1, 0.001)])
@pytest.mark.parametrize("row", chosen("half_sine", "linear"), ids=name)
def test_half_sine_by_the_kernel_for_slender_blocks(row: dict[str, str], alpha: float, within: float) -> None:
    """In units of tan(alpha) the limit of eq. 3 tends to that of the linear equation."""

    def follow(times: float) -> tuple[bool, int]:
        threshold = math.tan(alpha)
        omega = P * float(row["frequency_ratio"])
        return rock(*sine(times * threshold, threshold, omega, math.pi, 4000), P, alpha, ETA)

    limit = float(row["limit"])
    check(row, follow(limit * (1 - within)), follow(limit * (1 + within)))


@pytest.mark.parametrize(("amplitude", "falls"), [(0.310, False), (0.3150, False), (0.3151, True), (0.316, True)])
def test_one_cosine_by_the_kernel(amplitude: float, falls: bool) -> None:
    """p = 2 rad/s, alpha = 15 degrees, T = 2 s: 0.315034 g by others; Makris & Konstantinidis, PEER 2002/03, fig. 4.1.

    The pulse begins and ends at its crest, and a motion falls to zero within one step: hence so many samples.
    """
    values = amplitude * np.cos(np.linspace(0, 2 * math.pi, 20_001))
    assert rock(values, 2 / 20_000, 2.0, math.radians(15))[0] == falls


def test_limits_of_the_cosine_pulse_are_met_to_five_digits() -> None:
    def follow(amplitude: float) -> bool:
        return rock(amplitude * np.cos(np.linspace(0, 2 * math.pi, 200_001)), 1e-5, 2.0, math.radians(15))[0]

    assert not follow(0.31503)
    assert follow(0.31504)
