"""Reasons why two methods disagree on a piece: each a condition on its facts, and a sentence with its numbers.

A sentence is made for one piece or for several of which it holds: their numbers then stand as ranges. Every sentence
states only what follows from the numbers of the piece, its motion, and the methods' formulas.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from assess.language import gettext as _
from assess.methods import fema_p58, proposed_or
from assess.methods.kaneko_hayashi import NEAR_SWITCH
from assess.report import words
from assess.report.findings.facts import (
    FEMA,
    INTEGRATION,
    KANEKO,
    OR,
    Facts,
    medians_of,
    span,
    spans,
    title_of,
    values_of,
)
from assess.risk import classify

NOTABLE = 1.25
"""Heights that differ by less than this factor are no reason."""


@dataclass(frozen=True, slots=True)
class Kind:
    """One reason: when it applies to a piece, and how it is said of several."""

    applies: Callable[[Facts], bool]
    say: Callable[[Sequence[Facts]], str]


def find_kinds(facts: Facts) -> tuple[str, ...]:
    """Return the names of the reasons that apply, the most telling first."""
    return tuple(name for name, kind in KINDS.items() if kind.applies(facts))


# ---------------------------------------------------------------- the proposed formula


def _say_or_below_start(rows: Sequence[Facts]) -> str:
    return _(
        "PFA {pfa} g is {to_start} times g·B/H = {ratio} g, above which rocking can start; the proposed formula is a "
        "surface fitted to results and knows no such threshold: it still gives {value}.",
        **spans(rows, "pfa", "ratio", "to_start"), value=values_of(rows, OR),
    )  # fmt: skip


def _say_or_at_start(rows: Sequence[Facts]) -> str:
    return _(
        "The proposed formula is a surface fitted to results: at g·B/H = {ratio} g, where rocking can only just start, "
        "it gives {start} already; PFA is {pfa} g.",
        **spans(rows, "pfa", "ratio"), start=words.percents([row.or_at_start for row in rows]),
    )  # fmt: skip


def _say_or_at_most(rows: Sequence[Facts]) -> str:
    return _(
        "At B/H {ratio} the proposed formula gives at most {most}, however strong the motion.",
        **spans(rows, "ratio"), most=words.percents([row.or_at_most for row in rows]),
    )  # fmt: skip


def _say_or_size(rows: Sequence[Facts]) -> str:
    return _(
        "The proposed formula knows neither size nor velocity: by FEMA P-58, PFV {pfv} cm/s overturns half of the "
        "pieces of this B/H that are {half_height} cm tall; here the height is {height} cm.",
        **spans(rows, "pfv", "half_height", "height"),
    )  # fmt: skip


def _say_or_alone(rows: Sequence[Facts]) -> str:
    return _(
        "The proposed formula goes by B/H {ratio} and PFA {pfa} g alone and gives {value}, whatever the size of the "
        "piece and the velocity of the floor.",
        **spans(rows, "pfa", "ratio"), value=values_of(rows, OR),
    )  # fmt: skip


def _say_or_extrapolated(rows: Sequence[Facts]) -> str:
    return _(
        "B/H {ratio} at PFA {pfa} g lies outside the range in which the proposed formula was checked (B/H {b_low:.2f} "
        "to {b_high:.2f}, PFA {a_low:.2f} to {a_high:.2f} g).",
        **spans(rows, "pfa", "ratio"),
        b_low=proposed_or.CHECKED_BREADTH_TO_HEIGHT.low, b_high=proposed_or.CHECKED_BREADTH_TO_HEIGHT.high,
        a_low=proposed_or.CHECKED_PFA.low, a_high=proposed_or.CHECKED_PFA.high,
    )  # fmt: skip


def _say_or_thin(rows: Sequence[Facts]) -> str:
    return _(
        "B/H {ratio} is thinner than the proposed formula can tell: its value is that of the B/H of largest risk.",
        **spans(rows, "ratio"),
    )


# ---------------------------------------------------------------- Kaneko-Hayashi


def _say_kaneko_bound(rows: Sequence[Facts]) -> str:
    return _(
        "PFV is unknown: the Kaneko-Hayashi formula shows the largest risk that any velocity could give; the risk at "
        "the true velocity may be much lower. PFA is {times} times its median, {median} g.",
        **medians_of(rows, KANEKO, "median_pfa_g", "pfa", ".3f"),
    )


def _say_kaneko_acceleration(rows: Sequence[Facts]) -> str:
    return _(
        "The Kaneko-Hayashi formula goes by acceleration here (F_f {floor_frequency} Hz, not above F_b "
        "{boundary_frequency} Hz): PFA {pfa} g is {times} times its median for such pieces, {median} g.",
        **spans(rows, "pfa", "floor_frequency", "boundary_frequency"),
        **medians_of(rows, KANEKO, "median_pfa_g", "pfa", ".3f"),
    )


def _say_kaneko_velocity(rows: Sequence[Facts]) -> str:
    return _(
        "The Kaneko-Hayashi formula goes by velocity here (F_f {floor_frequency} Hz, above F_b {boundary_frequency} "
        "Hz): PFV {pfv} cm/s is {times} times its median for such pieces, {median} cm/s.",
        **spans(rows, "pfv", "floor_frequency", "boundary_frequency"),
        **medians_of(rows, KANEKO, "median_pfv_cm_s", "pfv", ".1f"),
    )


def _say_near_switch(rows: Sequence[Facts]) -> str:
    return _(
        "F_f {floor_frequency} Hz lies within 10 % of F_b {boundary_frequency} Hz, where the Kaneko-Hayashi formula "
        "jumps between acceleration and velocity: a slightly different size or motion may change it much.",
        **spans(rows, "floor_frequency", "boundary_frequency"),
    )


# ---------------------------------------------------------------- FEMA P-58 and the velocity


def _say_fema(rows: Sequence[Facts]) -> str:
    return _(
        "FEMA P-58 goes by velocity alone: PFV {pfv} cm/s is {times} times its median for such pieces, {median} cm/s.",
        **spans(rows, "pfv"), **medians_of(rows, FEMA, "median_pfv_cm_s", "pfv", ".1f"),
    )  # fmt: skip


def _say_fema_extrapolated(rows: Sequence[Facts]) -> str:
    return _(
        "B/H {ratio} lies outside that of the pieces of FEMA P-58 ({low:.3f} to {high:.3f}).",
        **spans(rows, "ratio"),
        low=fema_p58.CHECKED_BREADTH_TO_HEIGHT.low, high=fema_p58.CHECKED_BREADTH_TO_HEIGHT.high,
    )  # fmt: skip


def _say_velocity_below_start(rows: Sequence[Facts]) -> str:
    return _(
        "PFA {pfa} g is {to_start} times g·B/H = {ratio} g, above which rocking can start; {method} goes by velocity "
        "here and knows no such threshold: it still gives {value}.",
        **spans(rows, "pfa", "ratio", "to_start"),
        method=title_of(rows[0].highest), value=values_of(rows, rows[0].highest),
    )  # fmt: skip


def _say_estimated(rows: Sequence[Facts]) -> str:
    return _(
        "PFV {pfv} cm/s was not given: it is an estimate from PFA and the building's period T1, on which every method "
        "that goes by velocity rests.",
        **spans(rows, "pfv"),
    )


# ---------------------------------------------------------------- direct integration


def _say_integration(rows: Sequence[Facts]) -> str:
    return _(
        "Direct integration follows each piece through whole motions of the floor, with its size: {value} of {runs} "
        "motions overturn it.",
        value=values_of(rows, INTEGRATION), runs=span([row.runs for row in rows], ",.0f"),
    )  # fmt: skip


def _say_peak_is_not_enough(rows: Sequence[Facts]) -> str:
    return _(
        "PFA is {to_start} times g·B/H = {ratio} g: rocking can start, but a short peak need not overturn, and under "
        "most of the integrated motions the piece comes back to rest.",
        **spans(rows, "to_start", "ratio"),
    )


def _say_peaks_above(rows: Sequence[Facts]) -> str:
    return _(
        "PFA {pfa} g is {to_start} times g·B/H = {ratio} g, above which rocking can start; the integrated motions that "
        "overturn the piece have higher peaks of their own.",
        **spans(rows, "pfa", "to_start", "ratio"),
    )


def _say_quick(rows: Sequence[Facts]) -> str:
    return _(
        "The motion is quick for a piece of this size (F_f {floor_frequency} Hz, above F_b {boundary_frequency} Hz): "
        "it tends to turn back before a rocking piece goes over.",
        **spans(rows, "floor_frequency", "boundary_frequency"),
    )


def _say_slow(rows: Sequence[Facts]) -> str:
    return _(
        "The motion is slow for a piece of this size (F_f {floor_frequency} Hz, not above F_b {boundary_frequency} "
        "Hz): once the piece rocks, a long pulse tends to carry it over.",
        **spans(rows, "floor_frequency", "boundary_frequency"),
    )


def _say_generic(rows: Sequence[Facts]) -> str:
    return _("Only peaks of this floor are known: the integrated motions follow a generic spectrum.")


def _say_weak(rows: Sequence[Facts]) -> str:
    return _("The motions that were integrated are weaker than the floor's.")


# ---------------------------------------------------------------- which apply


def _goes_by_velocity(facts: Facts, key: str) -> bool:
    return key == FEMA or (key == KANEKO and facts.branch == "pfv")


def _starts_high(facts: Facts) -> bool:
    """Tell whether the proposed formula is above the lowest method's class where rocking can only just start."""
    at_start, lowest = classify(facts.or_at_start), classify(facts.value(facts.lowest))
    return facts.highest == OR and facts.can_start and at_start is not None and lowest is not None and at_start > lowest


def _stays_low(facts: Facts) -> bool:
    """Tell whether the proposed formula cannot reach the highest method's class, however strong the motion."""
    most, highest = classify(facts.or_at_most), classify(facts.value(facts.highest))
    return facts.lowest == OR and most is not None and highest is not None and most < highest


def _size_counts(facts: Facts) -> bool:
    """Tell whether a tall piece is low, or a small one high, by a method that knows sizes."""
    if facts.highest == OR:
        return 1 <= facts.half_height < facts.height / NOTABLE  # below 1 cm it is no piece of furniture
    knows = facts.highest == INTEGRATION or _goes_by_velocity(facts, facts.highest)
    return facts.lowest == OR and knows and facts.half_height > facts.height * NOTABLE


def _is_quick(facts: Facts) -> bool:
    """Tell whether a piece that can rock is low by direct integration, the motion being quick for its size."""
    rocks = facts.lowest == INTEGRATION and facts.can_start
    return rocks and facts.floor_frequency > facts.boundary_frequency * NEAR_SWITCH


def _is_slow(facts: Facts) -> bool:
    """Tell whether a piece that can rock is high by direct integration, the motion being slow for its size."""
    rocks = facts.highest == INTEGRATION and facts.can_start
    return rocks and facts.floor_frequency * NEAR_SWITCH < facts.boundary_frequency


def _is_alone(facts: Facts) -> bool:
    """Tell whether nothing more particular is said of the proposed formula."""
    said = (_starts_high, _stays_low, _size_counts)
    is_below = facts.highest == OR and not facts.can_start
    return facts.about(OR) and not is_below and not any(one(facts) for one in said)


KINDS: Mapping[str, Kind] = {
    "or_below_start": Kind(lambda one: one.highest == OR and not one.can_start, _say_or_below_start),
    "velocity_below_start": Kind(
        lambda one: _goes_by_velocity(one, one.highest) and not one.can_start, _say_velocity_below_start
    ),
    "peaks_above": Kind(lambda one: one.highest == INTEGRATION and not one.can_start, _say_peaks_above),
    "or_at_start": Kind(_starts_high, _say_or_at_start),
    "or_at_most": Kind(_stays_low, _say_or_at_most),
    "kaneko_bound": Kind(lambda one: one.about(KANEKO) and one.branch == "bound", _say_kaneko_bound),
    "kaneko_velocity": Kind(lambda one: one.about(KANEKO) and one.branch == "pfv", _say_kaneko_velocity),
    "kaneko_acceleration": Kind(lambda one: one.about(KANEKO) and one.branch == "pfa", _say_kaneko_acceleration),
    "fema": Kind(lambda one: one.about(FEMA), _say_fema),
    "integration": Kind(lambda one: one.about(INTEGRATION), _say_integration),
    "size": Kind(_size_counts, _say_or_size),
    "or_alone": Kind(_is_alone, _say_or_alone),
    "peak_is_not_enough": Kind(lambda one: one.lowest == INTEGRATION and one.can_start, _say_peak_is_not_enough),
    "quick": Kind(_is_quick, _say_quick),
    "slow": Kind(_is_slow, _say_slow),
    "near_switch": Kind(lambda one: one.about(KANEKO) and one.has(KANEKO, "near_switch"), _say_near_switch),
    "estimated": Kind(lambda one: one.about(KANEKO, FEMA) and one.has(KANEKO, "pfv_estimated"), _say_estimated),
    "generic": Kind(lambda one: one.about(INTEGRATION) and one.has(INTEGRATION, "generic_spectrum"), _say_generic),
    "weak": Kind(lambda one: one.about(INTEGRATION) and one.has(INTEGRATION, "weak_motions"), _say_weak),
    "or_thin": Kind(lambda one: one.about(OR) and one.has(OR, "thin"), _say_or_thin),
    "or_extrapolated": Kind(lambda one: one.about(OR) and one.has(OR, "extrapolated"), _say_or_extrapolated),
    "fema_extrapolated": Kind(lambda one: one.about(FEMA) and one.has(FEMA, "extrapolated"), _say_fema_extrapolated),
}
"""The reasons by their names, the most telling first."""
