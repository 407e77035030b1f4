"""Inputs that are refused: one loop over many, each with the message that it ought to have."""

import re
from collections.abc import Callable, Iterable
from typing import Any


def check_refusals(error: type[Exception], read: Callable[[Any], object], cases: Iterable[tuple[Any, str]]) -> None:
    """Assert that every input is refused by an error whose message matches its pattern."""
    for given, pattern in cases:
        found = None
        try:
            read(given)
        except error as refusal:
            found = str(refusal)
        assert found is not None, f"not refused, expected {pattern!r}: {given!r:.200}"
        assert re.search(pattern, found), f"expected {pattern!r}, found: {found}"
