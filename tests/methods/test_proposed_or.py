"""Proposed OR formula: what equation (9) does as printed, and what our departures make of it."""

import numpy as np
import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.proposed_or import (
    COEFFICIENTS,
    METHOD,
    THIN_PFA_CAP,
    _eq9,
    turning_breadth_to_height,
    turning_pfa,
)  # fmt: skip
from assess.settings import Settings
from assess.units import GRAVITY

GAL_PER_G = 981.0
"""g [cm/s2] of the paper, by which the published peaks are told."""


def evaluate(breadth_to_height: ArrayLike, pfa_g: ArrayLike) -> Outcome:
    cases = Cases.of(breadth=breadth_to_height, height=1.0, pfa=np.asarray(pfa_g) * GRAVITY)
    return METHOD.evaluate(cases, Settings())


def raised(outcome: Outcome) -> set[str]:
    return {name for name, flag in outcome.flags.items() if flag[0]}


@pytest.fixture(scope="module")
def grid():
    """Every tenth of a per cent of B/H 0.02..2 by PFA 0..3 g; rows are B/H."""
    breadth_to_height, pfa_g = np.linspace(0.02, 2.0, 991), np.linspace(0.0, 3.0, 601)
    rows, columns = np.meshgrid(breadth_to_height, pfa_g, indexing="ij")
    outcome = evaluate(rows.ravel(), columns.ravel())
    return {"value": outcome.value.reshape(rows.shape), "raw": outcome.detail["raw"].reshape(rows.shape)}


class TestAsPrinted:
    def test_coefficients_in_the_words_are_those_computed_with(self):
        text = " ".join(METHOD.equations)
        digits = {"a": "-0.97758451", "b": "0.30856415", "c": "0.0032112873", "d": "-0.018590461", "e": "-0.000001941",
                  "f": "-0.00010152672"}  # fmt: skip
        for letter, printed in digits.items():
            assert f"{letter} = {printed}" in text
            assert getattr(COEFFICIENTS, letter) == float(printed)

    def test_one_value_by_hand(self):
        # B/H 0.25, PFA 400: -0.97758451 + 1.2342566 + 1.28451492 - 0.297447376 - 0.31056 - 0.162442752
        assert _eq9(np.array([0.25]), np.array([400.0]))[0] == pytest.approx(0.770736882, abs=1e-9)

    def test_raw_and_value_agree_where_nothing_departs(self):
        outcome = evaluate(0.25, 0.4)
        assert outcome.value[0] == outcome.detail["raw"][0]
        assert raised(outcome) == set()


class TestKnownWeaknesses:
    def test_raw_peaks_and_falls_with_more_shaking(self):
        for breadth_to_height, peak_g, top in (
            (0.10, 0.58, 0.87), (0.14, 0.65, 1.07), (0.20, 0.71, 1.04), (0.30, 0.75, 0.91), (0.40, 0.78, 0.80),
            (0.50, 0.79, 0.73), (1.00, 0.82, 0.56),
        ):  # fmt: skip
            B_H = np.array([breadth_to_height])
            peak = turning_pfa(B_H)
            assert peak[0] / GAL_PER_G == pytest.approx(peak_g, abs=0.005), breadth_to_height
            assert _eq9(B_H, peak)[0] == pytest.approx(top, abs=0.005), breadth_to_height
            assert _eq9(B_H, 0.99 * peak)[0] < _eq9(B_H, peak)[0] > _eq9(B_H, 1.01 * peak)[0], breadth_to_height

    @pytest.mark.parametrize(("pfa_g", "largest_at"), [(0.1, 0.125), (0.6, 0.15)])
    def test_raw_calls_thinner_pieces_safer(self, pfa_g, largest_at):
        B_H = np.linspace(0.04, 0.4, 3601)
        raw = evaluate(B_H, pfa_g).detail["raw"]
        assert B_H[raw.argmax()] == pytest.approx(largest_at, abs=0.003)
        assert np.all(np.diff(raw[: raw.argmax()]) > 0)
        assert turning_breadth_to_height(np.array([pfa_g * GAL_PER_G]))[0] == pytest.approx(largest_at, abs=0.003)

    def test_raw_of_a_very_thin_piece_falls_to_nothing(self):
        assert evaluate(0.06, [0.0, 0.1, 0.3, 0.6]).detail["raw"].max() < 0

    @pytest.mark.parametrize(("breadth_to_height", "risk"), [(0.20, 0.10), (0.14, 0.28)])
    def test_some_risk_with_no_shaking_at_all(self, breadth_to_height, risk):
        outcome = evaluate(breadth_to_height, 0.0)
        assert outcome.value[0] == outcome.detail["raw"][0] == pytest.approx(risk, abs=0.005)
        assert raised(outcome) == {"extrapolated"}

    def test_high_below_the_threshold_of_rocking_but_a_stocky_piece_is_never_very_high(self):
        breadth_to_height = np.array([0.14, 0.2, 0.3, 0.39])
        assert np.all(evaluate(breadth_to_height, 0.99 * breadth_to_height).value > 0.45)
        assert evaluate(0.56, np.linspace(0, 5, 200)).value.max() < 0.7


class TestDepartures:
    def test_never_below_the_printed_formula_within_its_bounds(self, grid):
        assert np.all(grid["value"] >= np.clip(grid["raw"], 0, 1) - 1e-12)

    def test_the_cap_hides_behind_the_clip(self):
        # between B/H*(640 cm/s2) and B/H*(656 cm/s2) the value still rises with B/H, but above 1
        B_H = np.linspace(turning_breadth_to_height(np.array([THIN_PFA_CAP]))[0], 0.155, 200)
        assert _eq9(B_H, turning_pfa(B_H)).min() > 1.05

    def test_flags(self):
        for breadth_to_height, pfa_g, flags in (
            (0.25, 0.40, set()), (0.30, 0.90, {"held"}), (0.30, 1.00, {"held", "extrapolated"}),
            (0.10, 0.30, {"thin", "extrapolated"}), (0.145, 0.55, {"thin", "clipped"}),
            (0.06, 2.00, {"thin", "held", "clipped", "extrapolated"}), (0.50, 0.10, {"clipped", "extrapolated"}),
        ):  # fmt: skip
            assert raised(evaluate(breadth_to_height, pfa_g)) == flags, (breadth_to_height, pfa_g)

    def test_the_ends_of_the_checked_range_belong_to_it(self):
        # sizes and accelerations that leave binary dust: 27.3/70 = 0.39, 0.9 g
        cases = Cases.of(
            breadth=np.array([27.3, 54.6, 39, 14, 9.8]) * 0.01,
            height=np.array([70, 140, 100, 100, 70]) * 0.01,
            pfa=np.array([0.9, 0.9, 0.1, 0.1, 0.9]) * GRAVITY,
        )
        assert not METHOD.evaluate(cases, Settings()).flags["extrapolated"].any()
        for breadth_to_height, pfa_g in ((0.1399, 0.5), (0.3901, 0.5), (0.3, 0.0999), (0.3, 0.901)):  # just outside
            assert evaluate(breadth_to_height, pfa_g).flags["extrapolated"][0], (breadth_to_height, pfa_g)

    def test_held_at_the_peak(self):
        value = evaluate(0.3, [0.7546, 0.9, 3.0]).value
        assert value == pytest.approx(0.90743, abs=1e-5)
