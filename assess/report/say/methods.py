"""Where the methods disagree, and why."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain, zip_longest
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from assess.i18n import gettext as _, ngettext, number, placeholders
from assess.report import words
from assess.results import ItemResult, Results
from assess.risk import RiskClass, classify
from assess.text import natural_key

if TYPE_CHECKING:
    from assess.methods import MethodInfo, Reason


class Verdict(NamedTuple):
    """The probability [-] that a method gives, and its class."""

    method: "MethodInfo"
    risk: RiskClass
    value: float


class Disagreement(NamedTuple):
    """A piece for which the `highest` and the `lowest` method differ by more than one class, with their `reasons`."""

    result: ItemResult
    highest: Verdict
    lowest: Verdict
    reasons: "tuple[tuple[MethodInfo, Reason], ...]"


class Group(NamedTuple):
    """Disagreements of the same two methods, classes and reasons; `named` are the pieces that a report has room for.

    `highest` and `lowest` are a method, its class and its range of values; the sentences `reasons` hold for all rows.
    """

    rows: Sequence[Disagreement]
    named: Sequence[str]
    highest: str
    lowest: str
    reasons: Sequence[str]


def _sum_up(rows: Sequence[Disagreement]) -> Group:
    results, reasons = [row.result for row in rows], []
    for method, reason in rows[0].reasons:
        formats, values = {column.name: column.format for column in method.columns}, dict[str, str]()
        for name in placeholders(reason.text) - {"value"}:
            found: list[Any] = []
            if name in formats:  # results of a simulation are in a separate row
                for one in results:
                    detail = one.governing.methods[method.key].detail
                    found.append(detail[name] if name in detail else getattr(one.governing.simulation, name))
                spec = formats[name]
            else:
                spec, read = _FACTS[name]
                found += map(read, results)
            known = [float(one) for one in found if one is not None]
            ends = [number(end(known), spec) for end in (min, max)] if known else [words.DASH]
            values[name] = ends[0] if ends[0] == ends[-1] else _("{low} to {high}", low=ends[0], high=ends[1])
        value = words.percents([one.governing.methods[method.key].value or 0.0 for one in results])
        reasons.append(_(reason.text, **values, value=value))
    highest, lowest = (
        f"{_(own[0].method.title)}: {words.risk_label(own[0].risk)}, {words.percents([one.value for one in own])}"
        for own in ([row.highest for row in rows], [row.lowest for row in rows])
    )
    return Group(rows, [words.cut(one.item.item, 40) for one in results[:12]], highest, lowest, reasons)


def find_disagreements(results: Results, rows: Sequence[ItemResult]) -> tuple[str, list[Group]]:
    """Compare the methods row by row; return a summary, and groups, the widest first and those of fitted models last.

    A fitted model is compared with the published method that lies farthest from it.
    """
    methods = [one for one in results.methods if one.kind == "probability"]
    published = [one for one in methods if one.fitted is None]
    rocks = next((one.key for one in results.methods if one.tells_rocking), "")
    found = [one for row in rows if (one := _compare(row, _list_verdicts(row, published), rocks))]
    if found:
        text = ngettext("On {found:,} of {n:,} row, methods differ by more than one class; most often {highest} lies "
                        "above {lowest} (on {count:,}).",
                        "On {found:,} of {n:,} rows, methods differ by more than one class; most often {highest} lies "
                        "above {lowest} (on {count:,}).", len(rows), found=len(found),
                        **_find_commonest(found))  # fmt: skip
    else:
        text = ngettext("On the {n:,} row, the methods lie within one class of each other.",
                        "On all {n:,} rows, the methods lie within one class of each other.", len(rows))  # fmt: skip
    texts = [text]
    for model in methods:
        if model.fitted is None:
            continue
        own = []
        for row in rows:
            mine, others = _list_verdicts(row, [model]), _list_verdicts(row, published)
            if mine and others:
                other = max(others, key=lambda each: (abs(each.risk - mine[0].risk), abs(each.value - mine[0].value)))
                own += [differs] if (differs := _compare(row, [other, *mine], rocks)) else []
        if own:
            texts.append(ngettext("Counted separately: {model} differs by more than one class from a published method "
                                  "on {found:,} of {n:,} row; most often {highest} lies above {lowest} (on {count:,}).",
                                  "Counted separately: {model} differs by more than one class from a published method "
                                  "on {found:,} of {n:,} rows; most often {highest} lies above {lowest} (on "
                                  "{count:,}).", len(rows), found=len(own), model=_(model.title),
                                  **_find_commonest(own)))  # fmt: skip
        found += own
    groups: dict[tuple[object, ...], list[Disagreement]] = {}
    for each in found:
        reasons = tuple((method.key, reason.text) for method, reason in each.reasons)
        key = (each.highest.method.key, each.highest.risk, each.lowest.method.key, each.lowest.risk, reasons)
        groups.setdefault(key, []).append(each)
    for same in groups.values():
        same.sort(key=lambda one: (-int(one.result.adopted.upper), natural_key(one.result.item.item)))

    def rank(rows: Sequence[Disagreement]) -> tuple[bool, int, int, int]:
        _result, highest, lowest, _reasons = rows[0]
        is_model = any(one.method.fitted is not None for one in (highest, lowest))
        return is_model, int(lowest.risk) - int(highest.risk), -int(highest.risk), -len(rows)

    return " ".join(texts), list(map(_sum_up, sorted(groups.values(), key=rank)))


def _find_commonest(found: Sequence[Disagreement]) -> dict[str, Any]:
    pairs = Counter((_(one.highest.method.title), _(one.lowest.method.title)) for one in found)
    ((highest, lowest), count), *_others = pairs.most_common(1)
    return {"highest": highest, "lowest": lowest, "count": count}


def _list_verdicts(row: ItemResult, methods: "Iterable[MethodInfo]") -> list[Verdict]:
    values = ((method, row.governing.methods[method.key].value) for method in methods)
    return [Verdict(method, risk, value) for method, value in values
            if value is not None and (risk := classify(value)) is not None]  # fmt: skip


def _compare(row: ItemResult, verdicts: Sequence[Verdict], rocks: str) -> Disagreement | None:
    """Return the disagreement of the highest and the lowest verdict; `rocks` is the criterion for rocking."""
    if not verdicts:
        return None
    highest = max(verdicts, key=lambda one: (one.risk, one.value))
    lowest = min(verdicts, key=lambda one: (one.risk, one.value))
    if highest.risk - lowest.risk <= 1:
        return None
    can_rock = bool(rocks) and row.governing.methods[rocks].value == 1

    def list_reasons(method: "MethodInfo", side: Literal["above", "below"]) -> "list[tuple[MethodInfo, Reason]]":
        found = row.governing.methods[method.key]
        return [
            (method, one) for one in method.reasons if one.applies(side, found.detail, found.flags, can_rock=can_rock)
        ]

    above, below = list_reasons(highest.method, "above"), list_reasons(lowest.method, "below")
    first, second = (below, above) if lowest.method.fitted else (above, below)
    once: dict[str, tuple[MethodInfo, Reason]] = {}
    for one in filter(None, chain.from_iterable(zip_longest(first, second))):
        once.setdefault(one[1].text, one)
    return Disagreement(row, highest, lowest, tuple(once.values())[:4])  # the most important ones


_FACTS: Mapping[str, tuple[str, Callable[[ItemResult], float | None]]] = {
    "pfa_g": (".3f", lambda one: one.governing.motion.pfa_g),
    "pfv_cm_s": (".1f", lambda one: one.governing.motion.pfv_cm_s),
    "breadth_to_height": (".3f", lambda one: one.item.breadth_to_height),
    "height_cm": (".0f", lambda one: one.item.height_cm),
    "pfa_to_start": (".2f", lambda one: one.governing.motion.pfa_g / one.item.breadth_to_height),
}
"""Format and reader of each number that a `Reason` may name in addition to the method's columns."""
