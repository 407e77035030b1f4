"""Where the methods disagree on a piece by more than one class, and why.

Compared are the probabilities under the motion that governs the piece. Rows of which the same may be said stand in one
group, so that a large inventory has few. The published methods are compared with each other; a fitted model is compared
with them and told apart, so that it hides nothing of theirs.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from assess.language import gettext as _
from assess.language import ngettext
from assess.methods import Method, all_methods
from assess.report import words
from assess.report.findings.facts import Facts
from assess.report.findings.fitted import find_reasons, say_reason, summarise_fitted
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

    `kinds` names the reasons, for grouping; `reasons` says them of this piece. `model` is the fitted one of the two.
    """

    result: ItemResult
    highest: Verdict
    lowest: Verdict
    kinds: tuple[str, ...]
    reasons: Sequence[str]
    model: Method | None = None

    @property
    def facts(self) -> Facts:
        """What is known of the piece."""
        return Facts(self.result, self.highest.key, self.lowest.key, self.model)

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


def find_disagreements(
    results: Iterable[ItemResult], methods: Sequence[Method] | None = None
) -> Sequence[Disagreement]:
    """Return the rows on which methods differ by more than one class; the widest first, then the highest class.

    Compared are the published methods among `methods`, which are all of them by default. The rows on which a fitted
    model differs from one of them come last, model by model.
    """
    compared = all_methods() if methods is None else methods
    published = [method for method in compared if method.fitted is None]
    rows = tuple(results)
    found = _sort(_compare(result, _verdicts(result, published)) for result in rows)
    for method in compared:
        if method.fitted is not None:
            found += _sort(_compare_fitted(result, method, _verdicts(result, published)) for result in rows)
    return tuple(found)


def _sort(found: Iterable[Disagreement | None]) -> list[Disagreement]:
    return sorted((one for one in found if one), key=lambda one: (-one.spread, -int(one.result.adopted.upper)))


def _compare_fitted(result: ItemResult, model: Method, published: Sequence[Verdict]) -> Disagreement | None:
    """Compare a fitted model with the published method that lies farthest from it."""
    own = _verdicts(result, [model])
    if not (own and published):
        return None
    farthest = max(published, key=lambda one: (abs(one.risk - own[0].risk), abs(one.value - own[0].value)))
    return _compare(result, [farthest, *own], model)


def _compare(result: ItemResult, verdicts: Sequence[Verdict], model: Method | None = None) -> Disagreement | None:
    if not verdicts:
        return None
    highest = max(verdicts, key=lambda one: (one.risk, one.value))
    lowest = min(verdicts, key=lambda one: (one.risk, one.value))
    if highest.risk - lowest.risk <= 1:
        return None
    facts = Facts(result, highest.key, lowest.key, model)
    kinds = find_reasons(facts)[:MOST_REASONS]
    return Disagreement(result, highest, lowest, kinds, tuple(say_reason(kind, [facts]) for kind in kinds), model)


def _verdicts(result: ItemResult, methods: Sequence[Method]) -> list[Verdict]:
    """Return what the methods that give a probability say under the governing motion."""
    verdicts = []
    for method in methods:
        value = result.governing.methods[method.key].value
        risk = None if value is None or method.kind != "probability" else classify(value)
        if value is not None and risk is not None:
            verdicts.append(Verdict(method.key, _(method.title), risk, value))
    return verdicts


def group_disagreements(disagreements: Iterable[Disagreement]) -> Sequence[Group]:
    """Return groups of rows of which the same may be said; the widest first, then the largest; fitted models last."""
    groups: dict[tuple[object, ...], list[Disagreement]] = {}
    for one in disagreements:
        key = (one.highest.key, one.highest.risk, one.lowest.key, one.lowest.risk, one.kinds)
        groups.setdefault(key, []).append(one)
    ordered = sorted(groups.values(), key=_rank)
    return tuple(_group(rows) for rows in ordered)


def _rank(rows: Sequence[Disagreement]) -> tuple[bool, int, int, int]:
    first = rows[0]
    return first.model is not None, -first.spread, -int(first.highest.risk), -len(rows)


def _group(rows: Sequence[Disagreement]) -> Group:
    first = rows[0]
    facts = [row.facts for row in rows]
    return Group(
        highest=first.highest.title,
        highest_class=first.highest.risk,
        highest_value=words.percents([row.highest.value for row in rows]),
        lowest=first.lowest.title,
        lowest_class=first.lowest.risk,
        lowest_value=words.percents([row.lowest.value for row in rows]),
        reasons=tuple(say_reason(kind, facts) for kind in first.kinds),
        rows=tuple(rows),
    )


def summarise_disagreements(disagreements: Sequence[Disagreement], rows: int) -> str:
    """Return on how many of `rows` the published methods disagree, and which two most often; then each fitted model."""
    published = [one for one in disagreements if one.model is None]
    pairs: dict[str, list[tuple[str, str]]] = {}
    for one in disagreements:
        if one.model is not None:
            title = one.highest.title if one.highest.key == one.model.key else one.lowest.title
            pairs.setdefault(title, []).append((one.highest.title, one.lowest.title))
    told = [summarise_fitted(title, found, rows) for title, found in pairs.items()]
    return " ".join((_summarise_published(published, rows), *told))


def _summarise_published(disagreements: Sequence[Disagreement], rows: int) -> str:
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
