"""Pieces counted by class: of the building, a floor or a room, and drawn as bars."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.natural import natural_key
from assess.report import words
from assess.results import ItemResult, sum_falls
from assess.risk import RiskClass, find_ends

Span = tuple[int, int]
"""The least and the largest number of something."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Pieces (not rows) of a room, a floor, or of the building, by class; anchored ones stand outside the classes.

    Classes never mix bases: `by_class` are the simulated pieces, or those by formula in a run that simulated nothing.
    `unconfirmed` and `by_formula` (not simulated in a run that simulated others) are counted apart. Of those with a
    class, `lowered` were lowered by simulation, `may_be` could be of a higher one, and `cannot_rock` are low as they
    cannot rock. `spans` tells of each class how many are of it whatever the sampling intervals, and how many could be,
    `risky_span` of high and very high together. `expected` is the expected number of them that fall, `falls_low` and
    `falls_high` what 5 and 95 % of the draws do not exceed, None without draws.
    """

    label: str
    by_class: Mapping[RiskClass, int]
    anchored: int
    unconfirmed: int = 0
    by_formula: int = 0
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
        return self.free + self.unconfirmed + self.by_formula + self.anchored

    @property
    def risky(self) -> int:
        """Pieces of high and very high class."""
        return self.by_class[RiskClass.HIGH] + self.by_class[RiskClass.VERY_HIGH]

    @property
    def say_cannot_rock(self) -> str:
        """How many are low as they cannot rock, in one sentence."""
        return ngettext(
            "{n:,} piece cannot rock: it is too stocky, or not even the strongest motion that may be drawn can start "
            "it. Its class is low, whatever a formula says.",
            "{n:,} pieces cannot rock: they are too stocky, or not even the strongest motion that may be drawn can "
            "start them. Their class is low, whatever a formula says.",
            self.cannot_rock,
        )

    def share(self, risk: RiskClass) -> str:
        """Share of a class among the pieces that have one."""
        return f"{number(100 * self.by_class[risk] / self.free, '.0f')} %" if self.free else words.DASH

    @property
    def falls(self) -> str:
        """The expected falls, and up to how many unconfirmed pieces besides."""
        expected = words.fixed(self.expected, 1)
        if self.falls_low is not None and self.falls_high is not None:
            expected = f"{expected} ({words.say_span((round(self.falls_low), round(self.falls_high)))})"
        if not self.unconfirmed:
            return expected
        return _("{expected} and up to {n:,}", expected=expected, n=self.unconfirmed)

    def say(self, risk: RiskClass) -> str:
        """Return the number of a class for a table, as a range where intervals span a limit: ``7–12``."""
        return "–".join(number(one, ",.0f") for one in dict.fromkeys(self.span(risk)))

    def span(self, risk: RiskClass) -> Span:
        """Return how many are of a class whatever the sampling intervals, and how many could be."""
        return self.spans.get(risk, (self.by_class[risk],) * 2)


def count_pieces(results: Iterable[ItemResult]) -> tuple[dict[RiskClass, int], int]:
    """Count pieces, not rows: the free-standing ones by class, and the anchored ones, which have no class.

    Those that stand apart (`ItemResult.apart`) are in neither.
    """
    by_class, anchored = dict.fromkeys(RiskClass, 0), 0
    for one in results:
        if one.is_anchored:
            anchored += one.item.quantity
        elif not one.apart:
            by_class[one.adopted.risk] += one.item.quantity
    return by_class, anchored


def count_apart(results: Iterable[ItemResult], basis: str) -> int:
    """Count the free-standing pieces that stand apart with a basis, "unconfirmed" or "formula"."""
    return sum(one.item.quantity for one in results if not one.is_anchored and one.apart == basis)


def count(label: str, results: Sequence[ItemResult]) -> Counts:
    """Count pieces by class, those that stand apart, and those whose class was lowered, or could be higher."""
    free = [one for one in results if not one.is_anchored]
    main = [one for one in free if not one.apart]
    low, high = find_ends(sum_falls(main))
    return Counts(
        label,
        *count_pieces(results),
        unconfirmed=count_apart(results, "unconfirmed"),
        by_formula=count_apart(results, "formula"),
        lowered=sum(one.item.quantity for one in main if one.adopted.lowered_from is not None),
        may_be=sum(one.item.quantity for one in main if words.find_highest(one) != one.adopted.risk),
        cannot_rock=sum(one.item.quantity for one in main if not one.adopted.can_rock),
        expected=sum(one.adopted.probability * one.item.quantity for one in main),
        falls_low=low,
        falls_high=high,
        spans={risk: _find_span(main, risk, risk) for risk in RiskClass},
        risky_span=_find_span(main, RiskClass.HIGH, RiskClass.VERY_HIGH),
    )


def _find_span(results: Iterable[ItemResult], first: RiskClass, last: RiskClass) -> Span:
    """Return how many pieces are of the classes from `first` to `last` with their whole intervals, and in part."""
    surely = possibly = 0
    for one in results:
        lower, upper = one.adopted.lower, one.adopted.upper
        surely += one.item.quantity * (first <= lower and upper <= last)
        possibly += one.item.quantity * (lower <= last and upper >= first)
    return surely, possibly


def count_rooms(results: Sequence[ItemResult]) -> list[Counts]:
    """Count the pieces of each room, the rooms with most of high and very high class first, then by name."""
    rooms: dict[str, list[ItemResult]] = {}
    for one in results:
        rooms.setdefault(one.item.room, []).append(one)
    named = sorted(rooms.items(), key=lambda one: natural_key(one[0]))
    counts = [count(words.cut(room, 40) if room else _("no room named"), own) for room, own in named]
    return sorted(counts, key=lambda one: -one.risky)
