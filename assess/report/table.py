"""items.csv: the items of results.json as one flat table."""

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from assess.report.data import item_record
from assess.results import Assessment


def write_csv(assessment: Assessment, path: Path) -> None:
    """Write items.csv: one row an item, UTF-8 with a byte order mark, by which Excel knows it.

    A text that a spreadsheet would take for a formula is written behind an apostrophe; numbers stay numbers.
    """
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        heads: list[str] = []
        for result in assessment:
            record = item_record(result)
            if not heads:
                heads = list(flatten(record))
                writer.writerow(heads)
            writer.writerow([one if type(one) in _PLAIN else disarm(one) for one in _flat_values(record)])
        if not heads:
            writer.writerow(["item"])  # a table without rows still has a heading


def flatten(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return an item's record as one flat row: nested names joined by ``_``."""
    return dict(zip(_flat_names(record), _flat_values(record), strict=True))


def _flat_names(record: Mapping[str, Any]) -> Iterator[str]:
    for name, value in record.items():
        if name == "methods":
            for key, method in value.items():
                yield from (key if part == "value" else f"{key}_{part}" for part in method)
        elif name == "verification":
            yield from (f"{name}_{part}" for part in _VERIFICATION)
        elif isinstance(value, Mapping):
            yield from (f"{name}_{part}" for part in value)
        else:
            yield name


def _flat_values(record: Mapping[str, Any]) -> Iterator[Any]:
    for name, value in record.items():
        if name == "methods":
            for method in value.values():
                yield from method.values()
        elif name == "axes":
            yield [f"{axis['axis']}: {axis['source']} {axis['pfa_g']} g" for axis in value]
        elif name == "verification":
            yield from _flat_verification(value)
        elif isinstance(value, dict):
            yield from value.values()
        else:
            yield value


_VERIFICATION = (
    "runs", "overturned", "probability", "low", "high", "record_overturned", "record_max_rotation_ratio",
)  # fmt: skip


def _flat_verification(value: Mapping[str, Any] | None) -> Iterator[Any]:
    if value is None:
        yield from (None for _ in _VERIFICATION)
        return
    yield from (value.get(name) for name in _VERIFICATION[:5])
    record = value.get("record") or {}
    yield from (record.get("overturned"), record.get("max_rotation_ratio"))


_PLAIN = frozenset({float, int, bool, type(None)})


def disarm(value: object) -> object:
    """Return a value so that a spreadsheet takes none for a formula: such a text goes behind an apostrophe.

    A list becomes one text, joined by "; ".
    """
    if isinstance(value, list):
        value = "; ".join(map(str, value))
    if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r", "\n"):
        return "'" + value
    return value
