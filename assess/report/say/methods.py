"""Where the methods disagree, and why."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, zip_longest
from typing import TYPE_CHECKING, Literal

from assess.i18n import gettext as _
from assess.i18n import ngettext, number, placeholders
from assess.natural import natural_key
from assess.report import words
from assess.results import ItemResult, Results
from assess.risk import RiskClass, classify

if TYPE_CHECKING:
    from assess.methods import MethodInfo, Reason


MOST_REASONS = 4
"""Reasons that are given at most, the most important first."""
NAMED = 12
"""Pieces of a group that a report names."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The probability [-] that a method gives, and its class."""

    method: "MethodInfo"
    risk: RiskClass
    value: float

    @property
    def title(self) -> str:
        """Title of the method."""
        return _(self.method.title)


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A piece for which the `highest` and the `lowest` method differ by more than one class, with their `reasons`."""

    result: ItemResult
    highest: Verdict
    lowest: Verdict
    reasons: "tuple[tuple[MethodInfo, Reason], ...]"

    @property
    def model(self) -> "MethodInfo | None":
        """The fitted model among the two."""
        return next((one.method for one in (self.highest, self.lowest) if one.method.fitted), None)

    @property
    def spread(self) -> int:
        """Classes between the two, 2 or 3."""
        return int(self.highest.risk) - int(self.lowest.risk)


@dataclass(frozen=True, slots=True)
class Group:
    """Disagreements of the same two methods, classes and reasons."""

    rows: Sequence[Disagreement]

    @property
    def highest(self) -> str:
        """The higher method, its class and its range of values."""
        return self._describe([row.highest for row in self.rows])

    @property
    def lowest(self) -> str:
        """The lower method, its class and its range of values."""
        return self._describe([row.lowest for row in self.rows])

    def _describe(self, verdicts: Sequence[Verdict]) -> str:
        first = verdicts[0]
        return f"{first.title}: {words.risk_label(first.risk)}, {words.percents([one.value for one in verdicts])}"

    @property
    def reasons(self) -> Sequence[str]:
        """Sentences that hold for all rows, with their numbers or ranges of them."""
        return [_say(method, reason, [row.result for row in self.rows]) for method, reason in self.rows[0].reasons]

    @property
    def named(self) -> Sequence[str]:
        """Names of the pieces that a report has room for."""
        return [words.cut(row.result.item.item, 40) for row in self.rows[:NAMED]]

    @property
    def left(self) -> int:
        """Rows that are not named."""
        return max(0, len(self.rows) - NAMED)


@dataclass(frozen=True, slots=True)
class Disagreements:
    """All disagreements: a summary, and groups, the widest first and those of fitted models last."""

    summary: str
    groups: Sequence[Group]


def find_disagreements(results: Results, rows: Sequence[ItemResult]) -> Disagreements:
    """Compare the methods row by row."""
    methods = [one for one in results.methods if one.kind == "probability"]
    published = [one for one in methods if one.fitted is None]
    rocks = next((one.key for one in results.methods if one.tells_rocking), "")
    found = [one for row in rows if (one := _compare(row, _list_verdicts(row, published), rocks))]
    texts = [_summarise(found, len(rows))]
    for model in methods:
        if model.fitted is not None:
            own = [one for row in rows if (one := _compare(row, _list_farthest(row, model, published), rocks))]
            texts += [_summarise_model(model, own, len(rows))] if own else []
            found += own
    return Disagreements(" ".join(texts), group_disagreements(found))


def _list_verdicts(row: ItemResult, methods: "Iterable[MethodInfo]") -> list[Verdict]:
    verdicts = []
    for method in methods:
        value = row.governing.methods[method.key].value
        risk = None if value is None else classify(value)
        if value is not None and risk is not None:
            verdicts.append(Verdict(method, risk, value))
    return verdicts


def _list_farthest(row: ItemResult, model: "MethodInfo", published: "Sequence[MethodInfo]") -> list[Verdict]:
    """Return the verdict of a fitted model, and that of the published method that lies farthest from it."""
    own, others = _list_verdicts(row, [model]), _list_verdicts(row, published)
    if not (own and others):
        return []
    return [max(others, key=lambda one: (abs(one.risk - own[0].risk), abs(one.value - own[0].value))), *own]


def _compare(row: ItemResult, verdicts: Sequence[Verdict], rocks: str) -> Disagreement | None:
    """Return the disagreement of the highest and the lowest verdict; `rocks` is the criterion for rocking."""
    if not verdicts:
        return None
    highest = max(verdicts, key=lambda one: (one.risk, one.value))
    lowest = min(verdicts, key=lambda one: (one.risk, one.value))
    if highest.risk - lowest.risk <= 1:
        return None
    can_rock = bool(rocks) and row.governing.methods[rocks].value == 1
    above = _list_reasons(row, highest.method, "above", can_rock)
    below = _list_reasons(row, lowest.method, "below", can_rock)
    first, second = (below, above) if lowest.method.fitted else (above, below)
    once: dict[str, tuple[MethodInfo, Reason]] = {}
    for one in filter(None, chain.from_iterable(zip_longest(first, second))):
        once.setdefault(one[1].text, one)
    return Disagreement(row, highest, lowest, tuple(once.values())[:MOST_REASONS])


# ---------------------------------------------------------------- reasons


def _list_reasons(
    row: ItemResult, method: "MethodInfo", side: Literal["above", "below"], can_rock: bool
) -> "list[tuple[MethodInfo, Reason]]":
    found = row.governing.methods[method.key]
    return [(method, one) for one in method.reasons if one.applies(side, found.detail, found.flags, can_rock=can_rock)]


_FACTS: Mapping[str, tuple[str, Callable[[ItemResult], float | None]]] = {
    "pfa_g": (".3f", lambda one: one.governing.motion.pfa_g),
    "pfv_cm_s": (".1f", lambda one: one.governing.motion.pfv_cm_s),
    "breadth_to_height": (".3f", lambda one: one.item.breadth_to_height),
    "height_cm": (".0f", lambda one: one.item.height_cm),
    "pfa_to_start": (".2f", lambda one: one.governing.motion.pfa_g / one.item.breadth_to_height),
}
"""Format and reader of each number that a `Reason` may name besides the method's own columns."""


def _say(method: "MethodInfo", reason: "Reason", rows: Sequence[ItemResult]) -> str:
    """Return a reason with the numbers of the rows, as ranges where they differ."""
    formats = {column.name: column.format for column in method.columns}
    numbers = {
        name: (formats[name], _reader(method, name)) if name in formats else _FACTS[name]
        for name in placeholders(reason.text) - {"value"}
    }
    values = {name: span([read(row) for row in rows], spec) for name, (spec, read) in numbers.items()}
    value = words.percents([row.governing.methods[method.key].value or 0.0 for row in rows])
    return _(reason.text, **values, value=value)


def _reader(method: "MethodInfo", name: str) -> Callable[[ItemResult], float | None]:
    """Return what reads a number that a method gives; that of a simulation has a row of its own."""

    def read(row: ItemResult) -> float | None:
        detail = row.governing.methods[method.key].detail
        value = detail[name] if name in detail else getattr(row.governing.simulation, name)
        return None if value is None else float(value)

    return read


def span(values: Sequence[float | None], spec: str) -> str:
    """Return a number, or the range of several, as a format writes them: ``0.25`` or ``0.25 to 0.31``."""
    there = [value for value in values if value is not None]
    if not there:
        return words.DASH
    low, high = number(min(there), spec), number(max(there), spec)
    return low if low == high else _("{low} to {high}", low=low, high=high)


# ---------------------------------------------------------------- groups


def group_disagreements(disagreements: Iterable[Disagreement]) -> Sequence[Group]:
    """Return groups of rows, the widest first, then the largest; those of fitted models last."""
    groups: dict[tuple[object, ...], list[Disagreement]] = {}
    for one in disagreements:
        reasons = tuple((method.key, reason.text) for method, reason in one.reasons)
        key = (one.highest.method.key, one.highest.risk, one.lowest.method.key, one.lowest.risk, reasons)
        groups.setdefault(key, []).append(one)
    for rows in groups.values():
        rows.sort(key=lambda row: (-int(row.result.adopted.upper), natural_key(row.result.item.item)))
    return tuple(map(Group, sorted(groups.values(), key=_rank)))


def _rank(rows: Sequence[Disagreement]) -> tuple[bool, int, int, int]:
    first = rows[0]
    return first.model is not None, -first.spread, -int(first.highest.risk), -len(rows)


def _summarise(found: Sequence[Disagreement], rows: int) -> str:
    """Return on how many of `rows` the published methods disagree, and which two most often."""
    if not found:
        return ngettext(
            "On the {n:,} row, the methods lie within one class of each other.",
            "On all {n:,} rows, the methods lie within one class of each other.",
            rows,
        )
    highest, lowest, count = _commonest(found)
    return ngettext(
        "On {found:,} of {n:,} row, methods differ by more than one class; most often {highest} lies above {lowest} "
        "(on {count:,}).",
        "On {found:,} of {n:,} rows, methods differ by more than one class; most often {highest} lies above {lowest} "
        "(on {count:,}).",
        rows, found=len(found), highest=highest, lowest=lowest, count=count,
    )  # fmt: skip


def _summarise_model(model: "MethodInfo", found: Sequence[Disagreement], rows: int) -> str:
    highest, lowest, count = _commonest(found)
    return ngettext(
        "Counted separately: {model} differs by more than one class from a published method on {found:,} of {n:,} row; "
        "most often {highest} lies above {lowest} (on {count:,}).",
        "Counted separately: {model} differs by more than one class from a published method on {found:,} of {n:,} "
        "rows; most often {highest} lies above {lowest} (on {count:,}).",
        rows, found=len(found), model=_(model.title), highest=highest, lowest=lowest, count=count,
    )  # fmt: skip


def _commonest(found: Sequence[Disagreement]) -> tuple[str, str, int]:
    (pair, count), *_others = Counter((one.highest.title, one.lowest.title) for one in found).most_common(1)
    return *pair, count
