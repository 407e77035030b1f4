"""Where the methods disagree on a piece by more than one class, and why.

Compared are the probabilities under the motion that governs the piece. Rows of which the same may be said stand in one
group, so that a large inventory has few.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from assess.language import gettext as _
from assess.language import ngettext
from assess.methods import all_methods
from assess.report import words
from assess.report.findings.facts import Facts
from assess.report.findings.reasons import KINDS, find_kinds
from assess.results import ItemResult
from assess.risk import RiskClass, classify

MOST_REASONS = 4
"""Reasons that are given at most, the most telling first."""
NAMED = 12
"""Pieces of a group that a report names."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What one method says of a piece: its key and title, the class, and the probability [-]."""

    key: str
    title: str
    risk: RiskClass
    value: float


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A piece on which the `highest` and the `lowest` method differ by more than one class.

    `kinds` names the reasons, for grouping; `reasons` says them of this piece.
    """

    result: ItemResult
    highest: Verdict
    lowest: Verdict
    kinds: tuple[str, ...]
    reasons: Sequence[str]

    @property
    def spread(self) -> int:
        """Classes between the two, 2 or 3."""
        return int(self.highest.risk) - int(self.lowest.risk)


@dataclass(frozen=True, slots=True)
class Group:
    """Disagreements of the same two methods, classes and kinds of reasons.

    `highest_value` and `lowest_value` are ranges in words, ``34.5 to 48.7 %``; `reasons` hold for all its `rows`.
    """

    highest: str
    highest_class: RiskClass
    highest_value: str
    lowest: str
    lowest_class: RiskClass
    lowest_value: str
    reasons: Sequence[str]
    rows: Sequence[Disagreement]

    @property
    def items(self) -> Sequence[str]:
        """Names of its pieces."""
        return tuple(words.cut(row.result.item.item, 40) for row in self.rows)

    @property
    def named(self) -> Sequence[str]:
        """Names that a report has room for."""
        return self.items[:NAMED]

    @property
    def left(self) -> int:
        """Rows that it does not name."""
        return max(0, len(self.rows) - NAMED)


def find_disagreements(results: Iterable[ItemResult]) -> Sequence[Disagreement]:
    """Return the rows on which methods differ by more than one class; the widest first, then the highest class."""
    found = [one for result in results if (one := _compare(result)) is not None]
    return tuple(sorted(found, key=lambda one: (-one.spread, -int(one.result.adopted.upper))))


def _compare(result: ItemResult) -> Disagreement | None:
    verdicts = _verdicts(result)
    if not verdicts:
        return None
    highest = max(verdicts, key=lambda one: (one.risk, one.value))
    lowest = min(verdicts, key=lambda one: (one.risk, one.value))
    if highest.risk - lowest.risk <= 1:
        return None
    facts = Facts(result, highest.key, lowest.key)
    kinds = find_kinds(facts)[:MOST_REASONS]
    return Disagreement(result, highest, lowest, kinds, tuple(KINDS[kind].say([facts]) for kind in kinds))


def _verdicts(result: ItemResult) -> list[Verdict]:
    """Return what the methods that give a probability say under the governing motion."""
    verdicts = []
    for method in all_methods():
        value = result.governing.methods[method.key].value
        risk = None if value is None or method.kind != "probability" else classify(value)
        if value is not None and risk is not None:
            verdicts.append(Verdict(method.key, _(method.title), risk, value))
    return verdicts


def group_disagreements(disagreements: Iterable[Disagreement]) -> Sequence[Group]:
    """Return groups of rows of which the same may be said; the widest first, then the largest."""
    groups: dict[tuple[object, ...], list[Disagreement]] = {}
    for one in disagreements:
        key = (one.highest.key, one.highest.risk, one.lowest.key, one.lowest.risk, one.kinds)
        groups.setdefault(key, []).append(one)
    ordered = sorted(groups.values(), key=lambda rows: (-rows[0].spread, -int(rows[0].highest.risk), -len(rows)))
    return tuple(_group(rows) for rows in ordered)


def _group(rows: Sequence[Disagreement]) -> Group:
    first = rows[0]
    facts = [Facts(row.result, row.highest.key, row.lowest.key) for row in rows]
    return Group(
        highest=first.highest.title,
        highest_class=first.highest.risk,
        highest_value=words.percents([row.highest.value for row in rows]),
        lowest=first.lowest.title,
        lowest_class=first.lowest.risk,
        lowest_value=words.percents([row.lowest.value for row in rows]),
        reasons=tuple(KINDS[kind].say(facts) for kind in first.kinds),
        rows=tuple(rows),
    )


def summarise_disagreements(disagreements: Sequence[Disagreement], rows: int) -> str:
    """Return in one sentence how many of `rows` the methods disagree on, and which two most often."""
    if not disagreements:
        return ngettext(
            "On the {n:,} row, the methods lie within one class of each other.",
            "On all {n:,} rows, the methods lie within one class of each other.",
            rows,
        )
    pairs = Counter((one.highest.title, one.lowest.title) for one in disagreements)
    (highest, lowest), count = pairs.most_common(1)[0]
    if count == len(disagreements):
        return ngettext(
            "On {n:,} of {rows:,} rows, methods differ by more than one class: {highest} lies above {lowest}.",
            "On {n:,} of {rows:,} rows, methods differ by more than one class: in every case {highest} lies above "
            "{lowest}.",
            count,
            rows=rows,
            highest=highest,
            lowest=lowest,
        )
    return ngettext(
        "On {n:,} of {rows:,} rows, methods differ by more than one class; most often {highest} lies above {lowest} "
        "(on {count:,}).",
        "On {n:,} of {rows:,} rows, methods differ by more than one class; most often {highest} lies above {lowest} "
        "(on {count:,}).",
        len(disagreements),
        rows=rows,
        highest=highest,
        lowest=lowest,
        count=count,
    )
