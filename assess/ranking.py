"""Pieces counted by class, and put in the order in which they are to be fixed."""

from collections.abc import Iterable, Iterator

from assess.results import ItemResult
from assess.risk import RiskClass


def count_pieces(results: Iterable[ItemResult]) -> tuple[dict[RiskClass, int], int]:
    """Count pieces, not rows: the free-standing ones by class, and the anchored ones, which have no class."""
    by_class, anchored = dict.fromkeys(RiskClass, 0), 0
    for one in results:
        if one.is_anchored:
            anchored += one.item.quantity
        else:
            by_class[one.adopted.risk] += one.item.quantity
    return by_class, anchored


def fix_first(results: Iterator[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces of at least medium class, what to fix first at the top.

    Those of high or very high class, or that may be, come before all others; among both, life safety and routes first;
    then the upper class; then probability times quantity; then name.
    """
    chosen = [one for one in results if not one.is_anchored and one.adopted.upper >= RiskClass.MEDIUM]
    return sorted(
        chosen,
        key=lambda one: (
            one.adopted.upper < RiskClass.HIGH,
            not one.is_urgent,
            -one.adopted.upper,
            -one.adopted.probability * one.item.quantity,
            one.item.item.casefold(),
        ),
    )
