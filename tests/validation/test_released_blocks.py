"""Blocks of Cocuzza Avellino et al. (2022): what is computed for them, and that the integration rocks that way."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from assess.rocking import block
from assess.rocking.ensemble import follow_block
from assess.studies import Options, build_page
from assess.studies.released_blocks import list_released
from assess.units import GRAVITY

BLOCKS = {one.name: one for one in list_released()}
PAGE = (Path(__file__).parents[2] / "docs" / "validation.md").read_text(encoding="utf-8")


def test_the_nominal_blocks_are_those_of_the_integration():
    assert list(BLOCKS) == ["A2", "B1", "B2", "C2"]
    for one in BLOCKS.values():
        breadth, height = 2 * one.nominal.half_base, 2 * one.nominal.centre
        assert one.nominal.critical_angle == pytest.approx(block.critical_angle(breadth, height))
        assert one.nominal.frequency_parameter == pytest.approx(block.frequency_parameter(breadth, height))
        assert one.nominal.restitution == pytest.approx(block.restitution(breadth, height))
        assert one.nominal.restitution == pytest.approx(1 - 1.5 * math.sin(one.nominal.critical_angle) ** 2)


def test_a_corrected_block_keeps_its_inertia():
    """A2 by hand: b 19.95 mm, z 142.3 mm, I0/m = (28.5^2 + 142.3^2)/3 + 19.95^2 + 142.3^2 = 27668 mm2."""
    found = BLOCKS["A2"].corrected
    assert found.critical_angle == pytest.approx(math.atan(19.95 / 142.3))
    assert found.frequency_parameter == pytest.approx(math.sqrt(GRAVITY * 0.143692 / 0.027668), rel=1e-4)
    assert found.restitution == pytest.approx(1 - 2 * 398.0 / 27668, abs=1e-5)


def hop(alpha, p, peak):
    """Time from an impact to the next [s] with a peak between them, by the energy."""

    def slowness(u):  # of theta = peak (1 - u2), at whose end the velocity vanishes
        speed = math.sqrt(2 * (math.cos(alpha - peak) - math.cos(alpha - peak * (1 - u * u))))
        return 2 * peak * u / speed if u else peak * 2 / math.sqrt(2 * peak * math.sin(alpha - peak))

    return 2 * quad(slowness, 0, 1)[0] / p


@pytest.mark.parametrize("name", BLOCKS)
def test_the_integration_rocks_freely_as_the_rebounds_say(name):
    """A pulse sets the block rocking; every impact comes after it, and each hop tells its peak."""
    body = BLOCKS[name].nominal
    alpha, p, step = body.critical_angle, body.frequency_parameter, 0.001
    count = round(0.6 / p / step)
    pulse = 2 * GRAVITY * math.tan(alpha) * np.sin(np.linspace(0, math.pi, count + 1))
    motion = np.concatenate([pulse, np.zeros(4000)])
    found = follow_block(2 * body.half_base, 2 * body.centre, motion, step)
    assert not found.overturned
    assert found.impact_times[0] > count * step
    hops = np.diff(found.impact_times)[:4]
    peak = bisect(lambda theta: hop(alpha, p, theta) - hops[0], 1e-3 * alpha, 0.99 * alpha)
    assert peak / alpha == pytest.approx(body.rebound(found.rotation * alpha) / alpha, rel=1e-5)
    for measured in hops[1:]:
        peak = body.rebound(peak)
        assert measured == pytest.approx(hop(alpha, p, peak), rel=1e-5)


def bisect(function, low, high):
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return middle


def test_the_page_says_why_nothing_is_compared():
    page = build_page([], {}, Options(out=Path()), "figures/")
    start, end = (page.index(f"## {head}") for head in ("Released blocks", "Limits of this validation"))
    assert page[start:end] in PAGE, "run: python docs/validation.py"
    assert page.count("**Computed, not compared.**") == 1
