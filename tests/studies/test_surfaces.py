"""Surfaces that are fitted and ranked: known ones come back, and noise is shown from a surface."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from assess.errors import InputError
from assess.methods import Cases, proposed_or
from assess.methods.fitted import expand
from assess.studies.fit import CANDIDATES, CONSTANT, EQUATION_8, LeftOut, Points, fit_surface, leave_out, rank_surfaces
from assess.units import ACCELERATION

RATIOS, PEAKS = np.linspace(0.10, 0.50, 17), np.linspace(98.1, 882.9, 9)
X, Y = (np.tile(one.ravel(), 3) for one in np.meshgrid(RATIOS, PEAKS))
GROUP = np.repeat(np.array(["a", "b", "c"]), RATIOS.size * PEAKS.size)


def points(z):
    return Points(X, Y, np.broadcast_to(z, X.shape).astype(float), GROUP)


def columns_of(candidate, x=X, y=Y):
    return np.column_stack(expand(candidate.base, candidate.powers, x, y))


def eq9(x, y):
    """Equation (9) as printed: PFA in cm/s2."""
    return (
        -0.97758451 + 0.30856415 / x + 0.0032112873 * y - 0.018590461 / x**2 - 0.000001941 * y**2
        - 0.00010152672 * y / x
    )  # fmt: skip


PLANE = next(one for one in CANDIDATES if one.equation == "z = a + b·x + c·y")


class TestCandidates:
    def test_they_are_all_different_and_equation_8_is_that_of_the_paper(self):
        assert CANDIDATES[0] == CONSTANT
        assert len(CANDIDATES) == len({(one.base, one.powers) for one in CANDIDATES}) == 35
        assert len({one.name for one in CANDIDATES}) == len({one.equation for one in CANDIDATES}) == 35
        assert EQUATION_8.equation == "z = a + b/x + c·y + d/x² + e·y² + f·y/x"
        assert EQUATION_8.powers == ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2), (1, 1))
        assert EQUATION_8.name == "1/x to order 2, y to order 2, with cross terms"

    def test_terms_keep_to_orders_and_degree(self):
        for one in CANDIDATES:
            assert one.powers[0] == (0, 0)
            for i, j in one.powers:
                assert i <= one.order_u
                assert j <= one.order_y
                assert i + j <= max(one.order_u, one.order_y)
                assert one.is_crossed or 0 in (i, j)
            assert one.is_crossed == any(i and j for i, j in one.powers)

    def test_the_equation_computes_what_the_columns_do(self):
        letters = {letter: 1.0 + at for at, letter in enumerate("abcdefghij")}
        for one in CANDIDATES:
            text = one.equation.removeprefix("z = ").replace("·", "*").replace("²", "**2").replace("³", "**3")
            said = eval(text, {}, letters | {"x": 0.3, "y": 7.0})
            columns = columns_of(one, np.array([0.3]), np.array([7.0]))[0]
            assert said == pytest.approx(columns @ np.arange(1.0, columns.size + 1)), one.name


class TestFit:
    @settings(deadline=None, max_examples=60)
    @given(candidate=st.sampled_from(CANDIDATES), seed=st.integers(0, 2**32 - 1))
    def test_coefficients_of_a_known_surface_come_back(self, candidate, seed):
        random, columns = np.random.default_rng(seed), columns_of(candidate)
        size = random.uniform(0.1, 1.0, columns.shape[1]) * random.choice([-1, 1], columns.shape[1])
        known = size / np.linalg.norm(columns, axis=0)
        found = fit_surface(candidate, points(columns @ known))
        np.testing.assert_allclose(found.coefficients, known, rtol=1e-6)
        assert found.left_out.error < 1e-9

    def test_equation_9_comes_back_with_its_six_coefficients_and_predicts_as_the_method(self):
        found = fit_surface(EQUATION_8, points(eq9(X, Y)))
        np.testing.assert_allclose(found.coefficients, dataclasses.astuple(proposed_or.COEFFICIENTS), rtol=1e-8)
        assert found.r2 == pytest.approx(1)
        cases = Cases.of(breadth=X, height=1.0, pfa=Y * ACCELERATION["cm/s2"])
        np.testing.assert_allclose(found.predict(X, Y), eq9(X, Y), atol=1e-9)
        np.testing.assert_allclose(found.polynomial.evaluate(cases), eq9(X, Y), atol=1e-9)

    def test_a_plane_by_the_normal_equations(self):
        x, y = np.array([1.0, 2, 3, 4, 1, 2]), np.array([1.0, 1, 1, 1, 2, 2])
        z, group = np.array([1.0, 2, 3, 5, 1, 2]), np.array([1, 2, 1, 2, 1, 2])
        with pytest.raises(InputError, match="do not determine"):  # three cases are left for three coefficients
            fit_surface(PLANE, Points(x, y, z, group))
        x, y, z, group = (np.tile(one, 2) for one in (x, y, z, group))
        found = fit_surface(PLANE, Points(x, y, z, np.repeat([1, 2], 6)))
        rows = np.column_stack([np.ones(12), x, y])
        by_hand = np.linalg.inv(rows.T @ rows) @ rows.T @ z
        rss, tss = np.sum((z - rows @ by_hand) ** 2), np.sum((z - z.mean()) ** 2)
        np.testing.assert_allclose(found.coefficients, by_hand, rtol=1e-10)
        assert found.r2 == pytest.approx(1 - rss / tss)
        assert found.adjusted_r2 == pytest.approx(1 - (rss / 9) / (tss / 11))
        assert found.aic == pytest.approx(12 * np.log(rss / 12) + 6)
        # both groups hold the same cases, so that what is left out is predicted as well as it was fitted
        assert found.left_out.error == pytest.approx(np.sqrt(rss / 12))

    def test_high_powers_of_a_narrow_range_are_flagged(self):
        cubic = next(one for one in CANDIDATES if (one.order_u, one.order_y, one.is_crossed) == (3, 3, True))
        assert fit_surface(cubic, points(eq9(X, Y))).is_ill_conditioned
        wide = Points(
            np.array([0.01, 1, 0.01, 1] * 2), np.array([0.0, 0, 1, 1] * 2), np.arange(8.0), np.repeat([0, 1], 4)
        )
        found = fit_surface(PLANE, wide)
        assert not found.is_ill_conditioned
        assert 1 < found.condition < 10

    def test_too_few_values_are_reported(self):
        two = RATIOS[[0, -1]]
        x, y = (np.tile(one.ravel(), 3) for one in np.meshgrid(two, PEAKS))
        group = np.repeat([0, 1, 2], two.size * PEAKS.size)
        with pytest.raises(InputError, match="with cross terms: the cases do not determine 6 coefficients"):
            fit_surface(EQUATION_8, Points(x, y, eq9(x, y), group))

    def test_bad_points_are_reported(self):
        for change, match in (
            ({"z": np.zeros(3)}, "different lengths"),
            ({"z": np.full(X.size, np.nan)}, "not finite"),
            ({"x": np.zeros(X.size)}, "x is not above 0"),
            ({"group": np.zeros(X.size)}, "at least two"),
        ):
            with pytest.raises(InputError, match=match):
                Points(**{"x": X, "y": Y, "z": eq9(X, Y), "group": GROUP} | change)


class TestLeftOut:
    def test_worked_by_hand(self):
        # the mean of the others: 2.5 for the first group (errors 1.5, 0.5), 1.5 for the second (0.5, 1.5)
        z, group = np.array([1.0, 2, 2, 3]), np.array(["a", "a", "b", "b"])
        found = leave_out(z, group, lambda mask: lambda chosen: np.full(int(chosen.sum()), z[mask].mean()))
        assert found.squares == pytest.approx((1.25, 1.25))
        assert found.error == pytest.approx(1.25**0.5)
        assert found.spread == 0

    def test_error_and_spread_worked_by_hand(self):
        found = LeftOut((0.01, 0.04, 0.04))  # mean 0.03, deviation 0.0173, over the root of 3: 0.01
        assert found.error == pytest.approx(0.03**0.5)
        assert found.spread == pytest.approx(0.01 / (2 * 0.03**0.5))

    def test_one_standard_error_above_the_best_and_what_is_negligible_is_level(self):
        best = LeftOut((0.01, 0.04, 0.04))  # error 0.1732, standard error 0.0289
        assert LeftOut((0.2020**2,) * 3).is_level(best)
        assert not LeftOut((0.2022**2,) * 3).is_level(best)
        best = LeftOut((0.01, 0.01, 0.01))
        assert LeftOut((0.1009**2,) * 3).is_level(best)
        assert not LeftOut((0.1011**2,) * 3).is_level(best)

    def test_no_surface_of_a_smaller_error_ranks_behind_one_that_is_not_level(self):
        noise = np.random.default_rng(5).normal(0.0, 0.1, X.size)
        ranked = rank_surfaces(points(eq9(X, Y) + noise + np.where(GROUP == "c", 0.2, 0.0)))
        highest = max(one.surface.left_out.error for one in ranked if one.is_level)
        assert all(one.surface.left_out.error > highest for one in ranked if not one.is_level)

    def test_a_building_that_differs_shows(self):
        shifted = points(eq9(X, Y) + np.where(GROUP == "c", 0.3, 0.0))
        found = fit_surface(EQUATION_8, shifted)
        # c is predicted by the others: 0.3 off; a and b by a fit to one of their kind and c: 0.15 off
        assert found.left_out.squares == pytest.approx((0.0225, 0.0225, 0.09))


class TestRanking:
    @pytest.mark.parametrize("seed", range(5))
    def test_of_noise_the_simplest_comes_first(self, seed):
        ranked = rank_surfaces(points(np.random.default_rng(seed).normal(0.5, 0.1, X.size)))
        assert len(ranked[0].surface.coefficients) == min(len(one.powers) for one in CANDIDATES) == 1

    def test_a_surface_in_noise_is_found(self):
        noise = np.random.default_rng(1).normal(0.0, 0.02, X.size)
        ranked = rank_surfaces(points(eq9(X, Y) + noise))
        assert ranked[0].surface.candidate == EQUATION_8

    def test_order_and_places(self):
        noise = np.random.default_rng(2).normal(0.0, 0.1, X.size)
        ranked = rank_surfaces(points(eq9(X, Y) + noise))
        assert [one.place for one in ranked] == list(range(1, 36))
        for name in ("place_adjusted_r2", "place_aic"):
            assert sorted(getattr(one, name) for one in ranked) == list(range(1, 36))
        level = [one for one in ranked if one.is_level]
        assert level == list(ranked[: len(level)])
        keys = [(len(one.surface.coefficients), one.surface.left_out.error) for one in level]
        assert keys == sorted(keys)
        errors = [one.surface.left_out.error for one in ranked[len(level) :]]
        assert errors == sorted(errors)
        best = max(ranked, key=lambda one: one.surface.adjusted_r2)
        assert best.place_adjusted_r2 == 1
        assert min(ranked, key=lambda one: one.surface.aic).place_aic == 1

    def test_more_terms_never_fit_worse_where_they_were_fitted(self):
        ranked = rank_surfaces(points(np.random.default_rng(3).random(X.size)))
        by_powers = {
            (one.surface.candidate.base, frozenset(one.surface.candidate.powers)): one.surface for one in ranked
        }
        for (base, few), small in by_powers.items():
            for (other, many), large in by_powers.items():
                if base == other and few < many:
                    assert large.r2 >= small.r2 - 1e-12
