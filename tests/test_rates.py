"""Annual rates: published and closed forms, scipy's quadrature, the ends of the curve, and what is remarked."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from assess.fragility import fit_fragility, lognormal_chance
from assess.hazard import HazardCurve
from assess.i18n import Text
from assess.rates import AnnualRate, evaluate_rate, integrate_lognormal, integrate_table, list_remarks
from assess.units import GRAVITY as G
from tests.hazards import read_hazard

DATA = Path(__file__).parent / "data" / "hazard"
K0, K = 2.13038e-4, 2.5


def power_law(points, low=1e-3, high=50.0, k0=K0, k=K):
    """A curve of points [g] on one power law."""
    pga = np.geomspace(low, high, points)
    return HazardCurve(file="made", pga=pga * G, rate=k0 * pga**-k)


@pytest.mark.parametrize(("beta", "rate"), [(0.0, 1.20512e-3), (0.3, 1.59653e-3), (0.5, 2.63223e-3)])
@pytest.mark.parametrize("points", [2, 10, 37])
def test_cornell_2002_closed_form(beta, rate, points):
    """1/475 at 0.4 g, k 2.5; theta 0.5 g: k0 theta^-k exp(k2 beta2 / 2), whatever the number of points."""
    exact_k0 = 0.4**K / 475
    assert exact_k0 == pytest.approx(K0, rel=1e-5)
    closed = exact_k0 * 0.5**-K * math.exp(K**2 * beta**2 / 2)
    assert closed == pytest.approx(rate, rel=5e-6)
    found = integrate_lognormal(power_law(points, k0=exact_k0), median=0.5 * G, dispersion=beta)
    assert found.rate == pytest.approx(closed, rel=1e-6)
    assert found.rate == pytest.approx(rate, rel=5e-6)
    assert found.below < 1e-4


def test_cornell_2002_in_50_years():
    found = integrate_lognormal(power_law(20), median=0.5 * G, dispersion=0.5)
    assert found.chance_within(50) == pytest.approx(0.1233, abs=5e-5)
    assert found.chance_within(0) == 0
    assert AnnualRate(rate=1e-12, most=0, beyond=0, below=0).chance_within(1) == pytest.approx(1e-12, rel=1e-9)


def by_quadrature(curve, density, points=()):
    """∫ ν dP over the curve by scipy, segment by segment, and what its first point adds, for P by its density."""
    logs = np.log(curve.pga)

    def integrand(u):
        return math.exp(np.interp(u, logs, np.log(curve.rate))) * density(math.exp(u)) * math.exp(u)

    stops = np.unique(np.concatenate([logs, np.log([one for one in points if curve.pga[0] < one < curve.pga[-1]])]))
    return math.fsum(
        quad(integrand, low, high, epsabs=1e-15, epsrel=1e-12, limit=200)[0] for low, high in pairwise(stops)
    )


@pytest.mark.parametrize("name", ["oq-case33", "oq-case44"])
@pytest.mark.parametrize(("theta", "beta"), [(0.01, 0.4), (0.3, 0.5), (1.0, 0.2), (0.002, 0.9), (3.0, 1.2)])
def test_a_lognormal_on_a_real_curve_by_quadrature(name, theta, beta):
    curve = read_hazard(DATA / f"{name}-hazard_curve-mean-PGA.csv")

    def density(a):
        return norm.pdf(math.log(a / G / theta) / beta) / (beta * a)

    edges = theta * G * np.exp(beta * np.arange(-6, 7))  # where a narrow density is
    first = curve.rate[0] * norm.cdf(math.log(curve.pga[0] / G / theta) / beta)
    found = integrate_lognormal(curve, median=theta * G, dispersion=beta)
    assert found.rate == pytest.approx(first + by_quadrature(curve, density, edges), rel=1e-9, abs=1e-18)


@pytest.mark.parametrize("name", ["oq-case33", "oq-case44"])
def test_a_table_on_a_real_curve_by_quadrature(name):
    """Shares that are not monotone, at levels inside the curve and outside it."""
    curve = read_hazard(DATA / f"{name}-hazard_curve-mean-PGA.csv")
    levels = np.array([0.002, 0.01, 0.02, 0.3, 0.5, 0.9, 4.0]) * G
    shares = np.array([0.0, 0.1, 0.4, 0.35, 0.8, 0.95, 1.0])
    at, chance = np.append(0, levels), np.append(0, shares)

    def density(a):
        place = np.searchsorted(at, a) - 1
        return (chance[place + 1] - chance[place]) / (at[place + 1] - at[place]) if place + 1 < at.size else 0.0

    first = curve.rate[0] * np.interp(curve.pga[0], at, chance)
    found = integrate_table(curve, levels, shares)
    assert found.rate == pytest.approx(first + by_quadrature(curve, density, levels), rel=1e-9)


def test_by_the_definition_summed_up():
    """P times the rates of narrow classes of shaking, as a check on the integration by parts."""
    curve = power_law(8, low=0.02, high=2.0)
    edges = np.geomspace(0.02, 2.0, 200_001) * G
    rates = np.exp(np.interp(np.log(edges), np.log(curve.pga), np.log(curve.rate)))
    levels, shares = np.array([0.1, 0.4, 1.0]) * G, np.array([0.05, 0.3, 0.9])
    middle = np.sqrt(edges[1:] * edges[:-1])
    for chance, found in (
        (lognormal_chance(middle, 0.4 * G, 0.5), integrate_lognormal(curve, median=0.4 * G, dispersion=0.5)),
        (np.interp(middle, [0, *levels], [0, *shares]), integrate_table(curve, levels, shares)),
    ):
        last = rates[-1] * chance[-1]
        assert found.rate == pytest.approx((chance * -np.diff(rates)).sum() + last, rel=1e-6)
        assert found.beyond == pytest.approx(last / found.rate, rel=1e-4)


def test_a_table_of_many_points_tends_to_its_lognormal_and_a_narrow_lognormal_to_a_step():
    curve, levels = power_law(12, low=0.01, high=3), np.geomspace(0.01, 5, 3000) * G
    table = integrate_table(curve, levels, lognormal_chance(levels, 0.5 * G, 0.4))
    assert table.rate == pytest.approx(integrate_lognormal(curve, median=0.5 * G, dispersion=0.4).rate, rel=1e-5)
    curve = read_hazard(DATA / "oq-case44-hazard_curve-mean-PGA.csv")
    step = integrate_lognormal(curve, median=0.3 * G, dispersion=0)
    rate = math.exp(np.interp(math.log(0.3 * G), np.log(curve.pga), np.log(curve.rate)))
    assert step.rate == pytest.approx(rate, rel=1e-12)
    for beta in (1e-3, 1e-6):
        narrow = integrate_lognormal(curve, median=0.3 * G, dispersion=beta)
        assert narrow.rate == pytest.approx(step.rate, rel=20 * beta)
    assert integrate_lognormal(curve, median=5 * G, dispersion=0).rate == 0
    assert integrate_lognormal(curve, median=1e-4 * G, dispersion=0).rate == pytest.approx(curve.rate[0], rel=1e-12)


def test_steep_and_level_segments():
    """Slopes of 300 would overflow outside logarithms; a level segment adds nothing."""
    steep = HazardCurve(file="made", pga=np.array([0.1, 0.2]) * G, rate=np.array([1e-2, 1e-2 * 2.0**-300]))
    assert integrate_lognormal(steep, median=0.1 * G, dispersion=0.6).rate == pytest.approx(0.5e-2, rel=0.02)
    level = HazardCurve(file="made", pga=np.array([0.01, 0.1, 0.2]) * G, rate=np.array([1e-2, 1e-2, 1e-3]))
    short = HazardCurve(file="made", pga=level.pga[1:], rate=level.rate[1:])
    for median in (0.05, 0.3):
        found, expected = (integrate_lognormal(one, median=median * G, dispersion=0.5) for one in (level, short))
        assert found.rate == pytest.approx(expected.rate, rel=1e-12)
        assert found.below == 0 < expected.below
    table = [integrate_table(one, [0.05 * G, 0.5 * G], [0.2, 0.9]).rate for one in (level, short)]
    assert table[0] == pytest.approx(table[1], rel=1e-12)


def test_what_falls_more_often_has_a_larger_rate():
    curve = read_hazard(DATA / "oq-case44-hazard_curve-mean-PGA.csv")
    rates = [integrate_lognormal(curve, median=theta * G, dispersion=0.5).rate for theta in (0.1, 0.2, 0.5, 2)]
    assert rates == sorted(rates, reverse=True)
    # The dispersion counts: without it the rate comes out 2.2 times too low.
    both = [integrate_lognormal(power_law(20), median=0.5 * G, dispersion=beta).rate for beta in (0.0, 0.5)]
    assert both[1] / both[0] == pytest.approx(math.exp(0.5**2 * 2.5**2 / 2), rel=1e-5)


def test_the_ends_of_the_curve_and_what_never_falls():
    curve = power_law(6, low=0.2, high=0.6)
    found = integrate_lognormal(curve, median=0.5 * G, dispersion=0.5)
    whole = integrate_lognormal(power_law(40), median=0.5 * G, dispersion=0.5)
    assert found.rate < whole.rate < found.most / (1 - found.below)
    decade = integrate_lognormal(power_law(40, low=0.02, high=0.6), median=0.5 * G, dispersion=0.5)
    assert found.below == pytest.approx(1 - found.rate / decade.rate, rel=1e-9)
    last = curve.rate[-1]
    chance = norm.cdf(math.log(0.6 / 0.5) / 0.5)
    assert found.beyond == pytest.approx(last * chance / found.rate, rel=1e-9)
    assert found.most == pytest.approx(found.rate + last * (1 - chance), rel=1e-9)
    curve = power_law(5, low=0.01, high=1)
    found = integrate_table(curve, np.array([0.1, 1.0, 2.0]) * G, [0.0, 0.0, 0.0])
    assert (found.rate, found.beyond, found.below) == (0, 0, 0)
    assert found.chance_within(50) == 0
    assert found.most == pytest.approx(curve.rate[-1])


# --- a fragility ---


def test_a_fit_serves_where_it_is_near_and_the_table_elsewhere():
    curve, levels = power_law(20, low=0.01, high=5), np.geomspace(0.05, 2, 10)
    near = fit_fragility(levels * G, lognormal_chance(levels, 0.4, 0.5) * 1000, np.full(10, 1000))
    assert near.is_lognormal
    assert evaluate_rate(curve, near) == integrate_lognormal(curve, median=near.median, dispersion=near.dispersion)
    far = fit_fragility(levels * G, [0, 10, 80, 90, 90, 90, 90, 90, 95, 95], np.full(10, 100))
    none = fit_fragility(levels * G, np.zeros(10), np.full(10, 100))
    assert not far.is_lognormal
    for one in (far, none):
        assert evaluate_rate(curve, one) == integrate_table(curve, one.levels, one.shares)


# --- remarks ---


def made(low, high, **more):
    curve = power_law(10, low=low, high=high)
    return HazardCurve(file="made", pga=curve.pga, rate=curve.rate, **more)


def test_remarks():
    def remarks(curve, median=0.4):
        found = list_remarks(curve, integrate_lognormal(curve, median=median * G, dispersion=0.4))
        assert all(isinstance(one, Text) for one in found)
        return [str(one) for one in found]

    assert remarks(made(0.01, 10)) == []
    assert remarks(made(0.01, 10, distance=9_900.0)) == []
    assert remarks(made(0.01, 10, distance=12_400.0)) == ["the site of the hazard curve is 12 km from the building"]
    assert remarks(made(0.01, 10, notes=(Text("a note"),))) == ["a note"]
    (below,) = remarks(made(0.3, 10))
    assert below.startswith("the hazard curve begins at 0.3 g; what lies below is not counted and would be about ")
    (above,) = remarks(made(0.01, 0.5))
    assert above.startswith("the hazard curve ends at 0.5 g; the annual rate is 0.00")
    (beyond,) = remarks(made(0.001, 0.6), median=0.25)
    assert beyond == "7 % of the annual rate lie beyond the end of the hazard curve at 0.6 g"


def test_what_cannot_be():
    for median, dispersion in ((0.0, 0.5), (math.nan, 0.5), (1.0, -0.1), (1.0, math.inf)):
        with pytest.raises(ValueError, match="expected above 0"):
            integrate_lognormal(power_law(3), median=median, dispersion=dispersion)
    for levels in ([], [0.0, 1.0], [2.0, 1.0], [1.0, math.inf]):
        with pytest.raises(ValueError, match="levels must rise"):
            integrate_table(power_law(3), levels, [0.1, 0.2][: len(levels)])
    for shares in ([0.1, 1.2], [0.1], [0.1, math.nan]):
        with pytest.raises(ValueError, match="shares must be"):
            integrate_table(power_law(3), [1.0, 2.0], shares)
