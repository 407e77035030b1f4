"""The study of fits on chances that are known: from a surface, from a probit, and from nothing at all."""

from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtr

from assess.methods import Cases
from assess.methods.fitted import read_model, write_model
from assess.settings import Settings
from assess.studies import fit
from assess.studies.fit import EQUATION_8, find_errors, fit_all
from assess.studies.study import Options
from assess.units import ACCELERATION, GRAVITY
from tests.studies.made_up import make_compared

OPTIONS = Options(out=Path("unused"))
POWERS = EQUATION_8.powers
KNOWN = {(0, 0): 0.30, (1, 0): 0.02, (0, 1): 4e-4, (2, 0): -1e-3, (0, 2): -3e-7, (1, 1): 2e-5}
"""Coefficients of an equation (8) that stays between 0 and 1."""


def surface(breadth, height, pfa, _pfv):
    x, y = breadth / height, pfa / ACCELERATION["cm/s2"]
    return sum(c * x**-i * y**j for (i, j), c in KNOWN.items())


def probit(breadth, height, pfa, pfv):
    start = GRAVITY * breadth / height
    p = np.sqrt(3 * GRAVITY / (2 * np.hypot(breadth, height)))
    return ndtr(0.4 + 1.5 * np.log(pfa / start) + 2.5 * np.log(p * pfv / start))


@pytest.fixture(scope="module")
def on_surface():
    return fit_all(make_compared(surface, OPTIONS), OPTIONS)


@pytest.mark.slow
def test_a_known_surface_gives_its_coefficients_back(on_surface):
    values = dict(zip(POWERS, on_surface.equation_8.surface.coefficients, strict=True))
    for powers, known in KNOWN.items():
        assert values[powers] == pytest.approx(known, rel=1e-6)
    assert on_surface.equation_8.surface.left_out.error < 1e-6
    assert on_surface.equation_8.is_level


@pytest.mark.slow
def test_a_known_probit_gives_its_coefficients_back_and_beats_every_surface():
    found = fit_all(make_compared(probit, OPTIONS, runs=10**6), OPTIONS)
    formula = found.probit.probit
    assert (formula.b0, formula.b1, formula.b2) == pytest.approx((0.4, 1.5, 2.5), rel=1e-3)
    assert found.probit.left_out.error < 1e-3 < min(one.surface.left_out.error for one in found.ranked)


@pytest.mark.slow
@pytest.mark.parametrize("of_channels", [False, True])
def test_noise_ranks_the_simplest_first(of_channels):
    """Of cases, or of channels, under which all blocks are alike in what no candidate knows of."""
    rng = np.random.default_rng(0)

    def noise(breadth, _height, pfa, _pfv):
        return rng.uniform(0.2, 0.8) if of_channels else rng.uniform(0, 1, (pfa.size, breadth.size))

    found = fit_all(make_compared(noise, OPTIONS, runs=100), OPTIONS)
    assert found.ranked[0] == found.constant
    assert len(found.constant.surface.coefficients) == 1


def test_saved_models_say_the_same_as_what_was_fitted(on_surface, tmp_path):
    counts = on_surface.counts
    cases = Cases.of(breadth=counts.breadth, height=counts.height, pfa=counts.pfa, pfv=counts.pfv)
    expected = {
        "fitted_eq8": on_surface.equation_8.surface.predict(on_surface.points.x, on_surface.points.y),
        "fitted_probit": on_surface.probit.probit.evaluate(cases),
    }
    for one in fit.build_models(on_surface, OPTIONS):
        file = tmp_path / f"{one.key}.toml"
        file.write_text(write_model(one), encoding="utf-8")
        method = read_model(file)
        outcome = method.evaluate(cases, Settings())
        assert outcome.detail["raw"] == pytest.approx(expected[method.key], abs=1e-9)
        assert not outcome.flags["extrapolated"].any()


def test_errors_by_building_are_roots_of_mean_squares(on_surface):
    """Off by 0.1 for the cases of one building, by nothing for the others."""
    first = on_surface.buildings[0]
    off = np.where(on_surface.points.group == first, 0.1, 0.0)
    found = find_errors(on_surface.points.z + off, on_surface.points)
    assert found.squares == pytest.approx((0.01, 0, 0))
    assert found.error == pytest.approx((0.01 / 3) ** 0.5)
