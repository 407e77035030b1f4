"""Pieces counted by class, and put in the order in which they are to be fixed."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from assess.results import ItemResult
from assess.risk import RiskClass

if TYPE_CHECKING:
    from assess.routes.model import Routes


@dataclass(frozen=True, slots=True)
class RouteStep:
    """One step of what to fix for a route: step `place` of `steps`, of which the first is 1.

    `item` is the index of the piece in the inventory. The chance [-] that the route is blocked is `before` before this
    step, `after` once this step and those before it are taken, `at_last` once all are.
    """

    route: str
    item: int
    place: int
    steps: int
    before: float
    after: float
    at_last: float


def list_steps(routes: "Routes | None") -> list[RouteStep]:
    """Return what to fix for every route, step by step."""
    return [
        RouteStep(one.route, fix.item, place, len(one.fixes), fix.left + fix.gain, fix.left, one.fixes[-1].left)
        for one in (routes.routes if routes else ())
        for place, fix in enumerate(one.fixes, 1)
    ]


def count_pieces(results: Iterable[ItemResult]) -> tuple[dict[RiskClass, int], int]:
    """Count pieces, not rows: the free-standing ones by class, and the anchored ones, which have no class."""
    by_class, anchored = dict.fromkeys(RiskClass, 0), 0
    for one in results:
        if one.is_anchored:
            anchored += one.item.quantity
        else:
            by_class[one.adopted.risk] += one.item.quantity
    return by_class, anchored


def fix_first(results: Iterable[ItemResult], needed: Collection[int] = ()) -> list[ItemResult]:
    """Return the free-standing pieces of at least medium class and those that a route needs fixed, what first on top.

    Those of high or very high class, or that may be, come before all others; among both, life safety and routes first;
    then the upper class; then probability times quantity; then name. So what a route needs of low class comes behind
    the urgent pieces of medium class, and before those of it that are not urgent.

    Parameters
    ----------
    results : iterable of ItemResult
        All pieces, in the order of the inventory.
    needed : collection of int
        The pieces that are to be fixed for a route whatever their class, by their index.
    """
    chosen = [
        one
        for at, one in enumerate(results)
        if not one.is_anchored and (one.adopted.upper >= RiskClass.MEDIUM or at in needed)
    ]
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
