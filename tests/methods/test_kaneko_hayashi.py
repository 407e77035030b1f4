"""Kaneko and Hayashi's formula: the switch, its jump, and what stands in for an unknown velocity."""

import math

import numpy as np
import pytest
from numpy.typing import ArrayLike

from assess.methods import Cases, Outcome
from assess.methods.expression import normal_cdf
from assess.methods.kaneko_hayashi import METHOD
from assess.settings import Settings
from assess.units import GRAVITY

BREADTH, HEIGHT = 0.4, 1.8
B_H = BREADTH / HEIGHT
MEDIAN_PFA = B_H * GRAVITY * (1 + B_H)
MEDIAN_PFV = 10 * 40 / math.sqrt(180) * (1 + B_H) ** 2.5 * 0.01
BOUNDARY = 15.6 / math.sqrt(180) * (1 + B_H) ** -1.5


def evaluate(settings: Settings | None = None, /, **given: ArrayLike) -> Outcome:
    piece: dict[str, ArrayLike] = {"breadth": BREADTH, "height": HEIGHT}
    return METHOD.evaluate(Cases.of(**{**piece, **given}), settings or Settings())


def at_frequency(ratio: float, strength: float) -> dict[str, ArrayLike]:
    """A motion of `strength` medians of PFA whose F_f is `ratio` times F_b."""
    pfa = strength * MEDIAN_PFA
    return {"pfa": pfa, "pfv": pfa / (2 * math.pi * ratio * BOUNDARY)}


def raised(outcome: Outcome) -> set[str]:
    return {name for name, flag in outcome.flags.items() if flag[0]}


class TestBranches:
    def test_slow_motion_goes_by_acceleration(self):
        outcome = evaluate(**at_frequency(0.5, math.exp(0.2)))
        assert outcome.detail["branch"][0] == "pfa"
        assert outcome.value[0] == pytest.approx(0.841344746)  # Φ(0.2/0.2)
        assert raised(outcome) == set()

    def test_fast_motion_goes_by_velocity_and_the_median_overturns_half(self):
        outcome = evaluate(pfa=10.0, pfv=MEDIAN_PFV * math.exp(-0.5))
        assert outcome.detail["branch"][0] == "pfv"
        assert outcome.value[0] == pytest.approx(0.158655254)  # Φ(-0.5/0.5)
        assert evaluate(pfa=MEDIAN_PFA, pfv=100.0).value[0] == pytest.approx(0.5)
        assert evaluate(pfa=100.0, pfv=MEDIAN_PFV).value[0] == pytest.approx(0.5)

    def test_detail(self):
        detail = evaluate(pfa=3.0, pfv=0.5).detail
        assert detail["median_pfa_g"][0] == pytest.approx(MEDIAN_PFA / GRAVITY)
        assert detail["median_pfv_cm_s"][0] == pytest.approx(MEDIAN_PFV * 100)
        assert detail["floor_frequency_hz"][0] == pytest.approx(3.0 / (2 * math.pi * 0.5))
        assert detail["boundary_frequency_hz"][0] == pytest.approx(BOUNDARY)

    @pytest.mark.parametrize("unknown", ["breadth", "height", "pfa"])
    def test_unknown_input_raises_no_flag(self, unknown):
        outcome = evaluate(**{"pfa": 3.0, "friction": 0.1, unknown: math.nan})
        assert math.isnan(outcome.value[0])
        assert outcome.detail["branch"][0] == ""
        assert raised(outcome) == set()


class TestJump:
    """The published formula jumps at F_f = F_b, since ζ_A and ζ_V differ: pinned, not mended."""

    @pytest.mark.parametrize("breadth_to_height", [0.1, 0.25, 0.5, 1.0])
    @pytest.mark.parametrize("height", [0.6, 1.8, 2.4])
    def test_both_medians_are_one_motion_there(self, breadth_to_height, height):
        detail = evaluate(breadth=breadth_to_height * height, height=height, pfa=3.0).detail
        boundary, median_pfv = detail["boundary_frequency_hz"].item(), detail["median_pfv_cm_s"].item()
        pfa_there = 2 * math.pi * boundary * median_pfv / 100 / GRAVITY
        assert pfa_there == pytest.approx(detail["median_pfa_g"].item(), rel=0.002)

    @pytest.mark.parametrize(
        ("strength", "by_acceleration", "by_velocity"),
        [
            (math.exp(-0.2), 0.1587, 0.3449),  # one ζ_A below the median: Φ(-1) and Φ(-0.4)
            (1.0, 0.5000, 0.5004),
            (math.exp(0.2), 0.8413, 0.6558),  # Φ(1) and Φ(0.4)
        ],
    )
    def test_risk_on_either_side(self, strength, by_acceleration, by_velocity):
        slower, faster = evaluate(**at_frequency(1 - 1e-6, strength)), evaluate(**at_frequency(1 + 1e-6, strength))
        assert (slower.detail["branch"][0], faster.detail["branch"][0]) == ("pfa", "pfv")
        assert slower.value[0] == pytest.approx(by_acceleration, abs=1e-4)
        assert faster.value[0] == pytest.approx(by_velocity, abs=1e-4)
        assert raised(slower) == raised(faster) == {"near_switch"}

    def test_a_thinner_piece_may_come_out_safer_across_it(self):
        motion = at_frequency(1 + 1e-6, math.exp(-0.2))
        pieces = evaluate(breadth=[BREADTH, BREADTH * 0.99], **motion)
        assert pieces.detail["branch"].tolist() == ["pfv", "pfa"]
        assert pieces.value[1] < pieces.value[0] - 0.15
        assert pieces.flags["near_switch"].all()

    @pytest.mark.parametrize(
        ("ratio", "near"), [(1.0, True), (1.099, True), (1 / 1.099, True), (1.101, False), (1 / 1.101, False)]
    )
    def test_within_ten_per_cent_is_flagged(self, ratio, near):
        assert evaluate(**at_frequency(ratio, 1.0)).flags["near_switch"][0] == near


class TestUnknownVelocity:
    @pytest.mark.parametrize("strength", [0.3, 0.8, 1.0, 1.3, 2.5])
    def test_no_velocity_gives_more(self, strength):
        pfa = strength * MEDIAN_PFA
        bound = evaluate(pfa=pfa)
        every = evaluate(pfa=pfa, pfv=np.geomspace(1e-3, 30.0, 4000))
        assert raised(bound) == {"pfv_unknown_upper_bound"}
        assert bound.detail["branch"][0] == "bound"
        assert bound.value[0] == pytest.approx(every.value.max(), abs=0.002)
        assert every.value.max() <= bound.value[0] + 5e-4  # 15.6 is rounded: both medians differ by 0.05 %


class TestSettings:
    def test_zetas(self):
        settings = Settings(zeta_acceleration=0.4, zeta_velocity=1.0)
        assert evaluate(settings, **at_frequency(0.5, math.exp(0.4))).value[0] == pytest.approx(0.841344746)
        assert evaluate(settings, pfa=10.0, pfv=MEDIAN_PFV / math.e).value[0] == pytest.approx(0.158655254)

    def test_the_slide_coefficient_scales_every_branch(self):
        half = Settings(slide_coefficient=0.5)
        for motion in (at_frequency(0.5, 1.2), at_frequency(2.0, 1.2), {"pfa": 1.2 * MEDIAN_PFA}):
            assert evaluate(half, **motion).value == pytest.approx(0.5 * evaluate(**motion).value)

    def test_the_words_name_the_defaults(self):
        words = " ".join(METHOD.assumptions)
        assert f"ζ_A = {Settings().zeta_acceleration:.2f} unless" in words
        assert f"ζ_V = {Settings().zeta_velocity:g} unless" in words
        assert f"α is {Settings().slide_coefficient:g} unless" in words

    @pytest.mark.parametrize(
        ("friction", "slides"),
        [(math.nan, False), (0.5, False), (0.303, False), (0.301, True), (0.299, True), (0.1, True)],
    )
    def test_a_piece_that_slides_by_shentons_limits_is_flagged_and_nothing_changes(self, friction, slides):
        """At 0.306 g its critical friction is 0.3026: between B/H, 0.3, and that it slides and rocks."""
        outcome = evaluate(breadth=0.54, pfa=3.0, pfv=0.3, friction=friction)  # 0.54/1.8 is a little above 0.3
        assert outcome.flags["slides"][0] == slides
        assert outcome.value[0] == evaluate(breadth=0.54, pfa=3.0, pfv=0.3).value[0]


def test_normal_cdf():
    below, above = 0.9750021048517795, 9.865876450376946e-10
    for x, probability in ((0.0, 0.5), (1.96, below), (-6.0, above), (-math.inf, 0.0), (math.inf, 1.0)):
        assert normal_cdf(np.array([x]))[0] == pytest.approx(probability, rel=1e-12), x
    assert np.isnan(normal_cdf(np.array([math.nan]))[0])
