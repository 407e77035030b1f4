"""Pieces counted by class: of the building, a floor or a room."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from assess.i18n import gettext as _, ngettext, number
from assess.report import words
from assess.results import ROLLS, ItemResult, count_pieces, sum_falls
from assess.risk import RiskClass, find_ends

Span = tuple[int, int]
"""The least and the largest number of something."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Pieces (not rows) of a room, a floor, or of the building, by class; anchored ones stand outside the classes.

    Classes never mix bases: `by_class` are the simulated pieces, or those by formula in a run that simulated nothing.
    `unconfirmed`, `by_formula` (not simulated in a run that simulated others) and `rolls` (on castors, not covered) are
    counted apart. Of those with a
    class, `may_be` could be of a higher one. `spans` are, by class, how many belong to it over their whole sampling
    intervals, and how many could, `risky_span` of high and very high together. `expected` is the expected number of
    them that fall, `falls_low` and `falls_high` what 5 and 95 % of the draws do not exceed, None without draws.
    """

    label: str
    by_class: Mapping[RiskClass, int]
    anchored: int
    unconfirmed: int = 0
    by_formula: int = 0
    rolls: int = 0
    lowered: int = 0
    may_be: int = 0
    cannot_rock: int = 0
    expected: float = 0.0
    falls_low: float | None = None
    falls_high: float | None = None
    spans: Mapping[RiskClass, Span] = field(default_factory=dict)
    risky_span: Span = (0, 0)

    @property
    def free(self) -> int:
        """Free-standing pieces that have a class of the run's basis."""
        return sum(self.by_class.values())

    @property
    def total(self) -> int:
        """All pieces."""
        return self.free + self.unconfirmed + self.by_formula + self.rolls + self.anchored

    @property
    def has_apart(self) -> bool:
        """Whether pieces are counted apart, as they are unconfirmed or not simulated."""
        return bool(self.unconfirmed or self.by_formula)

    def say_cannot_rock(self) -> list[str]:
        """Return how many are low as they cannot rock, in one sentence; nothing where none is."""
        return [ngettext(
            "{n:,} piece cannot rock: it is too stocky, or not even the strongest motion that may be drawn can start "
            "it. Its class is low, whatever a formula says.",
            "{n:,} pieces cannot rock: they are too stocky, or not even the strongest motion that may be drawn can "
            "start them. Their class is low, whatever a formula says.",
            self.cannot_rock,
        )] if self.cannot_rock else []  # fmt: skip

    def share(self, risk: RiskClass) -> str:
        """Share of a class among the pieces that have one."""
        return f"{number(100 * self.by_class[risk] / self.free, '.0f')} %" if self.free else words.DASH

    @property
    def falls(self) -> str:
        """The expected falls, and up to how many unconfirmed pieces besides."""
        expected = words.say_falls(self.expected, self.falls_low, self.falls_high)
        return expected if not self.unconfirmed else _("{expected}, and up to {n:,} more", expected=expected,
                                                       n=self.unconfirmed)  # fmt: skip

    def say(self, risk: RiskClass) -> str:
        """Return the number of a class for a table, as a range where intervals span a limit: ``7–12``."""
        return "–".join(number(one, ",.0f") for one in dict.fromkeys(self.span(risk)))

    def span(self, risk: RiskClass) -> Span:
        """Return how many are of a class whatever the sampling intervals, and how many could be."""
        return self.spans.get(risk, (self.by_class[risk],) * 2)


def count(label: str, results: Iterable[ItemResult]) -> Counts:
    """Count pieces, not rows, by class, those that stand apart, and those whose class could be another."""
    groups: dict[str, list[ItemResult]] = {basis: [] for basis in ("", "anchored", "unconfirmed", "formula", ROLLS)}
    for one in results:
        groups["anchored" if one.is_anchored else one.apart].append(one)
    main = groups[""]
    low, high = find_ends(sum_falls(main))
    return Counts(
        label, {risk: count_pieces(one for one in main if one.adopted.risk == risk) for risk in RiskClass},
        anchored=count_pieces(groups["anchored"]), unconfirmed=count_pieces(groups["unconfirmed"]),
        by_formula=count_pieces(groups["formula"]), rolls=count_pieces(groups[ROLLS]),
        lowered=count_pieces(one for one in main if one.adopted.lowered_from is not None),
        may_be=count_pieces(one for one in main if words.find_highest(one) != one.adopted.risk),
        cannot_rock=count_pieces(one for one in main if not one.adopted.can_rock),
        expected=sum(one.adopted.probability * one.item.quantity for one in main), falls_low=low, falls_high=high,
        spans={risk: _find_span(main, risk, risk) for risk in RiskClass},
        risky_span=_find_span(main, RiskClass.HIGH, RiskClass.VERY_HIGH),
    )  # fmt: skip


def _find_span(results: Sequence[ItemResult], first: RiskClass, last: RiskClass) -> Span:
    """Return how many pieces are of the classes from `first` to `last` with their whole intervals, and in part."""
    surely = count_pieces(one for one in results if first <= one.adopted.lower and one.adopted.upper <= last)
    return surely, count_pieces(one for one in results if one.adopted.lower <= last and one.adopted.upper >= first)
