"""Compares generated pages and results made on two kinds of processor: words exactly, numbers within their error.

The last digits of sums and of libm differ between processors, so that now and then a motion under which a piece only
just stands overturns it on another: a probability out of 200 motions moves by half a percentage point, a count by one.
"""

import difflib
import math
import re
from collections.abc import Iterable, Iterator
from typing import Any

_NUMBER = re.compile(r"(?<![A-Za-z0-9_])([+-]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[+-]?\d+)?)( ?%)?")
POINTS = 5.0
"""Percentage points: below the sampling error of 100 to 200 motions, far above what a processor changes."""


def strip_numbers(line: str) -> str:
    """Return the words of a line, with # in place of each number."""
    return _NUMBER.sub("#", line)


def list_differences(now: list[str], kept: list[str]) -> list[str]:
    """Return how the lines of an output differ from what is kept, as diff does, without what stands around."""
    marks = difflib.unified_diff(kept, [line for text in now for line in text.splitlines()], n=0, lineterm="")
    return list(marks)[2:]


def differences(now: Iterable[str], then: Iterable[str]) -> list[str]:
    """Return the pairs of lines whose words differ, or whose numbers differ by more than their sampling error."""
    first, second = list(now), list(then)
    found = [] if len(first) == len(second) else [f"{len(first)} lines, expected {len(second)}"]
    found += [
        f"{one!r}, expected {other!r}" for one, other in zip(first, second, strict=False) if not _alike(one, other)
    ]
    return found


def _alike(one: str, other: str) -> bool:
    if one == other:
        return True
    if strip_numbers(one) != strip_numbers(other):
        return False
    return all(map(_close, _NUMBER.findall(one), _NUMBER.findall(other)))


def _close(one: tuple[str, str], other: tuple[str, str]) -> bool:
    first, second = (float(text.replace(",", "")) for text, _ in (one, other))
    if one[1] or other[1]:
        return abs(first - second) <= POINTS
    whole = not any(mark in text for text, _ in (one, other) for mark in ".e")
    return math.isclose(first, second, rel_tol=0.05, abs_tol=2 if whole else POINTS / 100)


def flatten(value: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every value of a JSON document with its place, such as ``items/3/pfa_g``."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from flatten(part, f"{place}/{key}")
    else:
        yield place, value
